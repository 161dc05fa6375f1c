//! Grazing points approached from either side, pairs of them within a step, and the side to which a fold opens.

use quell_numerics::continuation::branch::{BranchSide, End, Follow, follow};
use quell_numerics::continuation::criticality::NoFirstLyapunov;
use quell_numerics::continuation::fold::{FoldOpening, fold_coefficient};
use quell_numerics::continuation::threshold::BifurcationKind;
use quell_numerics::continuation::{Image, PeriodMap};
use quell_numerics::matrix::Matrix;

/// x → s x + h(p)/2 with s = ½ for x > 0, a piece that can be extended, and another slope beyond. In a strip next to the border the motion beyond
/// has no image, so that no step crosses it from there.
struct Torn {
    beyond: f64,
    height: fn(f64) -> f64,
    /// Width of the strip next to the border in which the motion beyond has no image.
    strip: f64,
}

impl PeriodMap for Torn {
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
        let x = state[0];
        let slips = x > 0.0 || held == Some(&true);
        if !slips && x > -self.strip {
            return Err(());
        }
        let slope = if slips { 0.5 } else { self.beyond };
        Ok(Image {
            state: vec![slope * x + 0.5 * (self.height)(parameters[0])],
            derivative: Matrix::from_fn(1, 1, |_, _| slope),
            distance: if slips { x } else { f64::INFINITY },
            signature: slips,
        })
    }

    fn smoother(&self, signature: &bool, _: &[f64]) -> Vec<bool> {
        if *signature { Vec::new() } else { vec![true] }
    }
}

/// The grazing at p = 0 is found from the side on which no step reaches it, in any window.
#[test]
fn grazing_is_located_from_the_side_with_events() {
    let torn = Torn { beyond: -0.3, height: |p| p, strip: 1e-9 };
    for (from, to) in [(-1.0, 1.0), (-0.7, 3.0), (-100.0, 40.0)] {
        let begin = 0.5 * from / 1.3;
        let branch = follow(&torn, &[begin], from, true, Follow::window(from, to, 20));
        let branch = branch.expect("a branch");
        let [point] = branch.special_points.as_slice() else { panic!("{branch:?}") };
        assert_eq!(point.kind, BifurcationKind::Grazing, "{from} {to}");
        assert!(point.parameter.abs() < 1e-9 * (to - from), "{point:?}");
        let signature = |side: &Option<BranchSide<bool>>| side.as_ref().map(|side| side.signature);
        assert_eq!((signature(&point.below), signature(&point.above)), (Some(false), Some(true)));
        assert!(matches!(branch.end, End::Window { at } if at == to), "{:?}", branch.end);
    }
    // Beyond a slope above 1 both pieces are on one side of the grazing: the branch turns back there.
    let torn = Torn { beyond: 1.5, ..torn };
    let branch = follow(&torn, &[-1.0], 1.0, false, Follow::window(-1.0, 1.0, 20));
    let branch = branch.expect("a branch");
    let [point] = branch.special_points.as_slice() else { panic!("{branch:?}") };
    assert!(point.kind == BifurcationKind::Grazing && point.parameter.abs() < 1e-9, "{point:?}");
    assert!(point.below.is_none() && point.above.is_some());
    assert!(matches!(branch.end, End::Window { at: 1.0 }), "{:?}", branch.end);
    assert!((branch.points.last().expect("points").state[0] - 1.0).abs() < 1e-9);
}

/// A pair of grazings much closer together than a step is found, wherever the steps fall.
#[test]
fn a_pair_of_grazings_within_a_step_is_found() {
    for steps in [7, 10, 16, 23] {
        let torn = Torn { beyond: -0.3, height: |p| (p - 0.513) * (p - 0.513) - 1e-5, strip: 0.0 };
        let branch = follow(&torn, &[0.263], 0.0, true, Follow::window(0.0, 1.0, steps));
        let branch = branch.expect("a branch");
        let found: Vec<f64> = branch.special_points.iter().map(|point| point.parameter).collect();
        assert_eq!(found.len(), 2, "{steps}: {found:?}");
        for (found, side) in found.iter().zip([-1.0, 1.0]) {
            let wanted = 0.513 + side * 1e-5_f64.sqrt();
            assert!((found - wanted).abs() < 1e-8, "{steps}: {found} {wanted}");
        }
    }
}

/// x → x + σ(p − c₂ x² − c₃ x³), whose fixed points are p = c₂ x² + c₃ x³.
struct Folded {
    sign: f64,
    quadratic: f64,
    cubic: f64,
}

impl PeriodMap for Folded {
    type Signature = ();
    type Error = ();

    fn dimension(&self) -> usize {
        1
    }

    fn scale(&self) -> f64 {
        1.0
    }

    fn image(&self, state: &[f64], parameters: &[f64], _: Option<&()>) -> Result<Image<()>, ()> {
        let (x, p) = (state[0], parameters[0]);
        let Self { sign, quadratic, cubic } = *self;
        let slope = 1.0 - sign * (2.0 * quadratic * x + 3.0 * cubic * x * x);
        Ok(Image {
            state: vec![x + sign * (p - quadratic * x * x - cubic * x * x * x)],
            derivative: Matrix::from_fn(1, 1, |_, _| slope),
            distance: f64::INFINITY,
            signature: (),
        })
    }
}

#[test]
fn a_fold_opens_to_the_side_of_its_fixed_points() {
    let at_zero = |map: &Folded| fold_coefficient(map, &[0.0], &[0.0], (0, 2.0), 1);
    for sign in [0.3, -0.3] {
        for (quadratic, wanted) in [(0.7, FoldOpening::Larger), (-0.02, FoldOpening::Smaller)] {
            let found = at_zero(&Folded { sign, quadratic, cubic: 0.4 }).expect("a fold");
            assert!((found.value - quadratic).abs() <= found.error + 1e-12, "{found:?}");
            assert!(found.error < 1e-6, "{found:?}");
            assert_eq!(found.opening(), Some(wanted), "{sign} {quadratic}");
        }
    }
    // At a cusp neither side is right.
    let cusp = at_zero(&Folded { sign: 0.3, quadratic: 0.0, cubic: 0.4 }).expect("a coefficient");
    assert_eq!(cusp.opening(), None, "{cusp:?}");
    // Away from the fold no multiplier is 1.
    let map = Folded { sign: 0.3, quadratic: 0.7, cubic: 0.0 };
    let away = fold_coefficient(&map, &[1.0], &[0.7], (0, 2.0), 1);
    assert_eq!(away, Err(NoFirstLyapunov::NotCritical));
}
