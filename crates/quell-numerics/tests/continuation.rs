//! Fixed points, thresholds and their curves against exact solutions.

use std::f64::consts::FRAC_PI_3;

use quell_numerics::continuation::branch::{End, Follow, SpecialPoint, follow};
use quell_numerics::continuation::curve::{BifurcationCurve, CurveEnd, Trace, trace};
use quell_numerics::continuation::shooting::{NotClosed, Shooting, fixed_point};
use quell_numerics::continuation::threshold::BifurcationKind;
use quell_numerics::continuation::{Image, PeriodMap};
use quell_numerics::interval::RealInterval;
use quell_numerics::matrix::Matrix;

/// Hénon's map (x, y) → (1 − a x² + y, b x), parameters a and then b.
struct Henon {
    b: f64,
}

impl Henon {
    fn b(&self, parameters: &[f64]) -> f64 {
        parameters.get(1).copied().unwrap_or(self.b)
    }
}

impl PeriodMap for Henon {
    type Signature = ();
    type Error = String;

    fn dimension(&self) -> usize {
        2
    }

    fn scale(&self) -> f64 {
        1.0
    }

    fn image(
        &self,
        state: &[f64],
        parameters: &[f64],
        _: Option<&()>,
    ) -> Result<Image<()>, String> {
        let (x, y, a, b) = (state[0], state[1], parameters[0], self.b(parameters));
        if x.abs() > 1e3 {
            return Err(format!("x = {x} runs away"));
        }
        let derivative = [[-2.0 * a * x, 1.0], [b, 0.0]];
        Ok(Image {
            state: vec![1.0 - a * x * x + y, b * x],
            derivative: Matrix::from_fn(2, 2, |i, j| derivative[i][j]),
            distance: f64::INFINITY,
            signature: (),
        })
    }
}

/// Delayed logistic map (x, y) → (r x (1 − y), x), parameter r, with y weighted by an optional second parameter c.
struct Delayed;

impl PeriodMap for Delayed {
    type Signature = ();
    type Error = ();

    fn dimension(&self) -> usize {
        2
    }

    fn scale(&self) -> f64 {
        1.0
    }

    fn image(&self, state: &[f64], parameters: &[f64], _: Option<&()>) -> Result<Image<()>, ()> {
        let (x, y, r) = (state[0], state[1], parameters[0]);
        let c = parameters.get(1).copied().unwrap_or(1.0);
        let derivative = [[r * (1.0 - c * y), -r * c * x], [1.0, 0.0]];
        Ok(Image {
            state: vec![r * x * (1.0 - c * y), x],
            derivative: Matrix::from_fn(2, 2, |i, j| derivative[i][j]),
            distance: f64::INFINITY,
            signature: (),
        })
    }
}

/// The piecewise linear map x → slope·x + p with different slopes on the two sides of x = q: its fixed point reaches the border
/// at p = (1 − inside)·q. `continued` is true if the inner piece can be extended beyond its border.
struct Corner {
    inside: f64,
    outside: f64,
    continued: bool,
}

impl PeriodMap for Corner {
    type Signature = bool;
    type Error = ();

    fn dimension(&self) -> usize {
        1
    }

    fn scale(&self) -> f64 {
        1.0
    }

    fn image(
        &self,
        state: &[f64],
        parameters: &[f64],
        held: Option<&bool>,
    ) -> Result<Image<bool>, ()> {
        let (x, p) = (state[0], parameters[0]);
        let q = parameters.get(1).copied().unwrap_or(0.0);
        let is_inside = x > q || (self.continued && held == Some(&true));
        let slope = if is_inside { self.inside } else { self.outside };
        let known = is_inside && self.continued;
        Ok(Image {
            state: vec![slope * (x - q) + self.inside * q + p],
            derivative: Matrix::from_fn(1, 1, |_, _| slope),
            distance: if known { x - q } else { f64::INFINITY },
            signature: is_inside,
        })
    }
}

fn near(found: f64, wanted: f64, closeness: f64) {
    assert!((found - wanted).abs() < closeness, "{found} {wanted}: {:e}", found - wanted);
}

fn counts<S>(special_point: &SpecialPoint<S>) -> (Option<usize>, Option<usize>) {
    (
        special_point.below.as_ref().map(|side| side.unstable),
        special_point.above.as_ref().map(|side| side.unstable),
    )
}

#[test]
fn henon_map_has_its_flip_and_is_continued_around_its_fold() {
    let b = 0.3;
    let fold = -0.25 * (1.0 - b) * (1.0 - b);
    let flip = 0.75 * (1.0 - b) * (1.0 - b);
    let stable = |a: f64| (-(1.0 - b) + ((1.0_f64 - b).powi(2) + 4.0 * a).sqrt()) / (2.0 * a);
    // The stable fixed point of the two is continued downwards, around the fold and up again.
    let x = stable(-0.06);
    let window = Follow::window(-0.4, -0.05, 40);
    let branch = follow(&Henon { b }, &[x, b * x], -0.06, false, window).expect("a branch");
    assert_eq!(branch.special_points.len(), 1, "{:?}", branch.special_points);
    let special_point = &branch.special_points[0];
    assert_eq!(special_point.kind, BifurcationKind::Fold);
    near(special_point.parameter, fold, 1e-9);
    assert_eq!(counts(special_point), (None, Some(0)));
    assert!(matches!(branch.end, End::Window { at: -0.05 }), "{:?}", branch.end);
    let last = branch.points.last().expect("points");
    near(last.state[0], (-(1.0 - b) - ((1.0_f64 - b).powi(2) - 0.2).sqrt()) / -0.1, 1e-10);
    // Upwards there is a flip.
    let x = stable(0.2);
    let branch = follow(&Henon { b }, &[x, b * x], 0.2, true, Follow::window(-1.0, 1.0, 40))
        .expect("a branch");
    assert_eq!(branch.special_points.len(), 1, "{:?}", branch.special_points);
    assert_eq!(branch.special_points[0].kind, BifurcationKind::Flip);
    near(branch.special_points[0].parameter, flip, 1e-9);
    assert_eq!(counts(&branch.special_points[0]), (Some(0), Some(1)));
    assert!(branch.special_points[0].error < 1e-8);
}

/// A branch that is followed only forwards ends at the fold and at the turn at a border that the whole one passes, with the same
/// points up to there, and locates no flip.
#[test]
fn a_branch_followed_only_forwards_ends_where_the_whole_one_turns_back() {
    let b = 0.3;
    let x = |a: f64| (-(1.0 - b) + ((1.0_f64 - b).powi(2) + 4.0 * a).sqrt()) / (2.0 * a);
    let start = |a: f64| [x(a), b * x(a)];
    let window = Follow::window(-0.4, -0.05, 40);
    let whole = follow(&Henon { b }, &start(-0.06), -0.06, false, window).expect("a branch");
    let window = window.only_forwards();
    let forwards = follow(&Henon { b }, &start(-0.06), -0.06, false, window).expect("a branch");
    let End::TurnsBack { at } = forwards.end else { panic!("{:?}", forwards.end) };
    assert_eq!(at, whole.special_points[0].parameter);
    assert!(forwards.points.len() > 3 && forwards.points.len() < whole.points.len());
    for (a, b) in forwards.points.iter().zip(&whole.points) {
        assert_eq!((&a.state, a.parameter), (&b.state, b.parameter));
    }
    let window = Follow::window(-1.0, 1.0, 40);
    let whole = follow(&Henon { b }, &start(0.2), 0.2, true, window).expect("a branch");
    let window = window.only_forwards();
    let forwards = follow(&Henon { b }, &start(0.2), 0.2, true, window).expect("a branch");
    assert_eq!((whole.special_points.len(), forwards.special_points.len()), (1, 0));
    assert_eq!((forwards.end, forwards.points.len()), (whole.end, whole.points.len()));
    for continued in [true, false] {
        let turns = Corner { inside: 0.5, outside: 1.5, continued };
        let window = Follow::window(-1.0, 1.0, 20).only_forwards();
        let branch = follow(&turns, &[1.0], 0.5, false, window).expect("a branch");
        let End::TurnsBack { at } = branch.end else { panic!("{:?}", branch.end) };
        near(at, 0.0, 1e-7);
        let persists = Corner { inside: 0.5, outside: -0.3, continued };
        let branch = follow(&persists, &[1.0], 0.5, false, window).expect("a branch");
        assert!(matches!(branch.end, End::Window { at: -1.0 }), "{:?}", branch.end);
    }
}

/// The increment of the difference with respect to the parameter follows how far the state moves: in a wide window it led over the border.
#[test]
fn a_wide_window_has_the_border_of_a_narrow_one() {
    for continued in [true, false] {
        for to in [1.0, 1e3, 1e6] {
            let map = Corner { inside: 0.5, outside: -0.3, continued };
            let window = Follow::window(-0.1, to, 40);
            let branch = follow(&map, &[-0.1 / 1.3], -0.1, true, window).expect("a branch");
            // The length of a branch is that of its states: one of 10⁶ is too long.
            let is_window = branch.end == End::Window { at: to };
            assert!(is_window || matches!(branch.end, End::TooLong { .. }), "{:?}", branch.end);
            let [border] = branch.special_points.as_slice() else {
                panic!("{continued} {to}: {:?}", branch.special_points)
            };
            assert!(border.parameter.abs() < 1e-9 * to, "{continued} {to}: {border:?}");
            assert!(border.error < 1e-8 * to, "{continued} {to}: {border:?}");
        }
    }
}

/// The fixed point p below p = 0.5 and p + `jump` above it, with different signatures.
struct Jump {
    jump: f64,
}

impl PeriodMap for Jump {
    type Signature = bool;
    type Error = ();

    fn dimension(&self) -> usize {
        1
    }

    fn scale(&self) -> f64 {
        1.0
    }

    fn image(
        &self,
        state: &[f64],
        parameters: &[f64],
        _: Option<&bool>,
    ) -> Result<Image<bool>, ()> {
        let is_above = parameters[0] > 0.5;
        let fixed = parameters[0] + if is_above { self.jump } else { 0.0 };
        Ok(Image {
            state: vec![0.5 * (state[0] + fixed)],
            derivative: Matrix::from_fn(1, 1, |_, _| 0.5),
            distance: f64::INFINITY,
            signature: is_above,
        })
    }
}

/// Jumps above a fiftieth of the window, within which a corner is sought: one below and one above the largest leap.
#[test]
fn a_motion_that_jumps_is_not_the_continuation_of_a_branch() {
    for jump in [0.012, 0.1] {
        let window = Follow::window(0.1, 0.6, 20);
        let branch = follow(&Jump { jump }, &[0.2], 0.2, true, window).expect("a branch");
        let End::Lost { at } = branch.end else { panic!("{jump}: {:?}", branch.end) };
        near(at, 0.5, 1e-6);
    }
}

#[test]
fn delayed_logistic_map_has_its_neimark_sacker_bifurcation() {
    let window = Follow::window(1.2, 3.0, 30);
    let branch = follow(&Delayed, &[1.0 - 1.0 / 1.5; 2], 1.5, true, window).expect("a branch");
    assert_eq!(branch.special_points.len(), 1, "{:?}", branch.special_points);
    let special_point = &branch.special_points[0];
    assert_eq!(special_point.kind, BifurcationKind::NeimarkSacker);
    near(special_point.parameter, 2.0, 1e-9);
    assert_eq!(counts(special_point), (Some(0), Some(2)));
    // A run through a reversed window proceeds in the opposite direction and finds the same point.
    let window = Follow::window(3.0, 1.2, 30);
    let branch = follow(&Delayed, &[1.0 - 1.0 / 2.5; 2], 2.5, false, window).expect("a branch");
    near(branch.special_points[0].parameter, 2.0, 1e-9);
    assert_eq!(counts(&branch.special_points[0]), (Some(0), Some(2)));
    let angle = branch.points.iter().map(|point| point.multipliers[0].arg());
    assert!(
        angle.clone().any(|angle| angle > FRAC_PI_3)
            && angle.clone().any(|angle| angle < FRAC_PI_3)
    );
}

/// Persistence and a nonsmooth fold at grazing, approached from the piece that can be extended and from the other one.
#[test]
fn branches_persist_or_turn_back_at_grazing() {
    for continued in [true, false] {
        let kind = if continued { BifurcationKind::Grazing } else { BifurcationKind::Border };
        let closeness = if continued { 1e-10 } else { 1e-8 };
        let persists = Corner { inside: 0.5, outside: -0.3, continued };
        let window = Follow::window(-1.0, 1.0, 20);
        let down = follow(&persists, &[1.0], 0.5, false, window).expect("a branch");
        let up = follow(&persists, &[-0.5], -0.65, true, window).expect("a branch");
        for (branch, end) in [(down, -1.0), (up, 1.0)] {
            assert_eq!(branch.special_points.len(), 1, "{:?}", branch.special_points);
            assert_eq!(branch.special_points[0].kind, kind);
            near(branch.special_points[0].parameter, 0.0, closeness);
            assert_eq!(counts(&branch.special_points[0]), (Some(0), Some(0)));
            assert!(matches!(branch.end, End::Window { at } if at == end), "{:?}", branch.end);
        }
        // With an outer slope above 1, the fixed point of the outer piece exists for the same parameters: the branch turns back.
        let turns = Corner { inside: 0.5, outside: 1.5, continued };
        let branch = follow(&turns, &[1.0], 0.5, false, window).expect("a branch");
        assert_eq!(branch.special_points.len(), 1, "{:?}", branch.special_points);
        near(branch.special_points[0].parameter, 0.0, 1e-7);
        assert_eq!(counts(&branch.special_points[0]), (None, Some(0)));
        assert!(matches!(branch.end, End::Window { at: 1.0 }), "{:?}", branch.end);
        near(branch.points.last().expect("points").state[0], -2.0, 1e-10);
    }
}

fn all(curve: &BifurcationCurve, wanted: impl Fn(f64) -> f64) {
    assert!(curve.points.len() > 20);
    for point in &curve.points {
        near(point.parameters[0], wanted(point.parameters[1]), 1e-9);
    }
}

#[test]
fn curves_in_two_parameters() {
    let options = Trace::windows(RealInterval::new(-1.0, 2.0), RealInterval::new(-0.5, 0.6), 40);
    let b = 0.3_f64;
    for (kind, factor, sign) in
        [(BifurcationKind::Fold, -0.25, 0.0), (BifurcationKind::Flip, 0.75, 1.0)]
    {
        let a = factor * (1.0 - b) * (1.0 - b);
        let root = ((1.0 - b) * (1.0 - b) + 4.0 * a).max(0.0).sqrt();
        let x = (-(1.0 - b) + sign * root) / (2.0 * a);
        let curve = trace(&Henon { b }, kind, &(), &[x, b * x], [a, b], options).expect("a curve");
        assert_eq!(curve.ends, [CurveEnd::Window; 2]);
        all(&curve, |b| factor * (1.0 - b) * (1.0 - b));
        let ends = [&curve.points[0], curve.points.last().expect("points")];
        let mut reached = ends.map(|point| point.parameters[1]);
        reached.sort_by(f64::total_cmp);
        assert_eq!(reached, [-0.5, 0.6]);
    }
    // The weight of the delay scales the state alone.
    let options = Trace::windows(RealInterval::new(1.0, 3.0), RealInterval::new(0.5, 2.0), 40);
    let curve =
        trace(&Delayed, BifurcationKind::NeimarkSacker, &(), &[0.5, 0.5], [2.0, 1.0], options)
            .expect("a curve");
    all(&curve, |_| 2.0);
    // p = (1 − inside) q.
    let corner = Corner { inside: 0.5, outside: -0.3, continued: true };
    let options = Trace::windows(RealInterval::new(-1.0, 1.0), RealInterval::new(-1.0, 1.5), 40);
    let curve = trace(&corner, BifurcationKind::Grazing, &true, &[0.2], [0.1, 0.2], options)
        .expect("a curve");
    all(&curve, |q| 0.5 * q);
}

/// A map with a closed curve of folds: x → x + (x − q)² + p² + q² − 1 has its folds on p² + q² = 1.
struct Ring;

impl PeriodMap for Ring {
    type Signature = ();
    type Error = ();

    fn dimension(&self) -> usize {
        1
    }

    fn scale(&self) -> f64 {
        1.0
    }

    fn image(&self, state: &[f64], parameters: &[f64], _: Option<&()>) -> Result<Image<()>, ()> {
        let (x, p, q) = (state[0], parameters[0], parameters[1]);
        Ok(Image {
            state: vec![x + (x - q) * (x - q) + p * p + q * q - 1.0],
            derivative: Matrix::from_fn(1, 1, |_, _| 1.0 + 2.0 * (x - q)),
            distance: f64::INFINITY,
            signature: (),
        })
    }
}

#[test]
fn a_closed_curve_is_recognised() {
    let options = Trace::windows(RealInterval::new(-2.0, 2.0), RealInterval::new(-2.0, 2.0), 60);
    let curve =
        trace(&Ring, BifurcationKind::Fold, &(), &[0.6], [0.8, 0.6], options).expect("a curve");
    assert_eq!(curve.ends, [CurveEnd::Closed; 2]);
    for point in &curve.points {
        near(point.parameters[0].hypot(point.parameters[1]), 1.0, 1e-9);
    }
}

#[test]
fn shooting_reports_where_it_stopped() {
    let henon = Henon { b: 0.3 };
    // Below the fold there is no fixed point.
    let result = fixed_point(&henon, &[1.0, 0.3], &[-0.5], None, &Shooting::default());
    let Err(NotClosed::TooManySteps { steps, residual, at }) = result else {
        panic!("{result:?}");
    };
    assert!(steps == 40 && residual > 0.1 && at.iter().all(|x| x.is_finite()));
    let result = fixed_point(&henon, &[2e3, 0.0], &[0.2], None, &Shooting::default());
    assert!(matches!(&result, Err(NotClosed::NoImage { steps: 0, .. })), "{result:?}");
    // The fixed point that is found is too far from this guess.
    let near_one = Shooting { reach: 0.01, ..Shooting::default() };
    let result = fixed_point(&henon, &[0.5, 0.15], &[0.2], None, &near_one);
    assert!(matches!(&result, Err(NotClosed::Strayed { .. })), "{result:?}");
    let text = result.expect_err("strayed").to_string();
    assert!(text.contains("from the guess"), "{text}");
}
