//! A branch of fixed points in one parameter, by pseudo-arclength: around folds, through borders of signatures.
//!
//! On one smooth piece the step is adapted to the bend of the branch: a corrected point may lie no further from the
//! predicted one than a share of the step, and the tangent may not turn by more than about 25°. That is the test of
//! nearness which keeps the walk from stepping onto another branch. Thresholds are sign changes of test functions,
//! located on the hyperplanes between two points; a pair of sign changes between two points is found where the test function dips
//! between its neighbours.
//!
//! At a touch the branch may go on with another signature, turn back with it, or end. What lies beyond is looked
//! for at distances that grow from very small ones, and believed where the state comes to the touch as the parameter
//! does: continuity, not convergence alone.

use num_complex::Complex64;

use super::arc::{self, NoStep, Solved, System, between, cosine, direction, distance, tangent};
use super::shooting::{NotClosed, Shooting, fixed_point};
use super::threshold::{Kind, SMOOTH, Tests, confirmed};
use super::{Family, Image, modulus, multipliers, unstable};
use crate::matrix::Matrix;
use crate::roots::{Closeness, find_root, minimise};

/// How a branch is followed. Steps are in scaled coordinates, in which the window of the parameter has width 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Follow {
    /// First value of the parameter's window.
    pub from: f64,
    /// Last value.
    pub to: f64,
    /// Longest step, and the first one.
    pub longest: f64,
    /// Shortest step: below it the branch counts as lost.
    pub shortest: f64,
    /// Most points.
    pub most_points: u32,
}

impl Follow {
    /// Through a window in at least `steps` steps.
    pub fn window(from: f64, to: f64, steps: u32) -> Self {
        let longest = 1.0 / f64::from(steps.max(1));
        Self { from, to, longest, shortest: 1e-8, most_points: 4000 }
    }
}

/// A point of a branch.
#[derive(Clone, Debug)]
pub struct Point<S> {
    /// The fixed point.
    pub state: Vec<f64>,
    /// The parameter.
    pub parameter: f64,
    /// Multipliers, the largest modulus first.
    pub multipliers: Vec<Complex64>,
    /// Mismatch after the period, relative to the scale.
    pub residual: f64,
    /// Distance from the border of the signature.
    pub distance: f64,
    /// What happens along the period.
    pub signature: S,
}

/// The branch on one side of a passage.
#[derive(Clone, Debug, PartialEq)]
pub struct Side<S> {
    /// Number of multipliers outside the unit circle.
    pub unstable: usize,
    /// Largest modulus.
    pub radius: f64,
    /// What happens along the period.
    pub signature: S,
}

/// A threshold, or a border of signatures.
#[derive(Clone, Debug)]
pub struct Passage<S> {
    /// The parameter.
    pub parameter: f64,
    /// Bound on its error.
    pub error: f64,
    /// What happens.
    pub kind: Kind,
    /// The state.
    pub state: Vec<f64>,
    /// The branch for slightly smaller parameters; of two, at a turning point, the one with fewer unstable multipliers.
    pub below: Option<Side<S>>,
    /// The same for slightly larger ones.
    pub above: Option<Side<S>>,
}

/// How a walk along a branch ends.
#[derive(Clone, Debug)]
pub enum End<E> {
    /// At an end of the window.
    Window {
        /// Which value.
        at: f64,
    },
    /// Where it began: the branch is closed.
    Closed,
    /// At a touch with no fixed point beyond it on either side.
    Touch {
        /// The parameter.
        at: f64,
    },
    /// The branch was lost.
    Lost {
        /// The last parameter.
        at: f64,
        /// Why, where there is a reason other than that steps became too short.
        why: Option<NotClosed<E>>,
    },
    /// After as many points as were allowed.
    TooLong {
        /// The last parameter.
        at: f64,
    },
}

/// A branch with what was passed on it, in order.
#[derive(Clone, Debug)]
pub struct Branch<S, E> {
    /// Points.
    pub points: Vec<Point<S>>,
    /// Thresholds and borders of signatures.
    pub passages: Vec<Passage<S>>,
    /// How it ended.
    pub end: End<E>,
}

/// A point with what the walk needs.
#[derive(Clone, Debug)]
struct Place<S> {
    unknowns: Vec<f64>,
    tangent: Vec<f64>,
    derivative: Matrix,
    image: Image<S>,
    residual: f64,
    multipliers: Vec<Complex64>,
}

impl<S: Clone> Place<S> {
    fn side(&self) -> Side<S> {
        Side {
            unstable: unstable(&self.multipliers),
            radius: self.multipliers.first().map_or(0.0, |&it| modulus(it)),
            signature: self.image.signature.clone(),
        }
    }

    fn parameter(&self) -> f64 {
        self.unknowns.last().copied().unwrap_or(0.0)
    }
}

/// The equations φ(x) = x in scaled unknowns, on one piece.
struct Closing<'a, F: Family> {
    walk: &'a Walk<'a, F>,
    held: Option<&'a F::Signature>,
}

/// Difference by which the derivative by a parameter is taken: it steers Newton's method only.
pub(super) const NUDGE: f64 = 1e-6;

impl<F: Family> System for Closing<'_, F> {
    type Known = Image<F::Signature>;
    type Error = F::Error;

    fn mismatch(&self, unknowns: &[f64]) -> Result<(Vec<f64>, Self::Known), F::Error> {
        let (state, parameter) = self.walk.unscaled(unknowns);
        let image = self.walk.family.image(&state, &[parameter], self.held)?;
        let scale = self.walk.family.scale();
        let mismatch = image.state.iter().zip(&state).map(|(to, from)| (to - from) / scale);
        Ok((mismatch.collect(), image))
    }

    fn derivative(
        &self,
        unknowns: &[f64],
        image: &Self::Known,
        before: Option<&Matrix>,
        way: &[f64],
    ) -> Result<Matrix, F::Error> {
        let n = self.walk.family.dimension();
        let column: Vec<f64> = if let Some(before) = before {
            (0..n).map(|i| before[(i, n)]).collect()
        } else {
            let towards = if way[n] < 0.0 { -NUDGE } else { NUDGE };
            let inside = (0.0..=1.0).contains(&(unknowns[n] + towards));
            let nudge = if inside { towards } else { -towards };
            let mut moved = unknowns.to_vec();
            moved[n] += nudge;
            let (state, parameter) = self.walk.unscaled(&moved);
            let other = self.walk.family.image(&state, &[parameter], self.held)?;
            let scale = self.walk.family.scale() * nudge;
            other.state.iter().zip(&image.state).map(|(b, a)| (b - a) / scale).collect()
        };
        Ok(Matrix::from_fn(n, n + 1, |i, j| match j {
            j if j == n => column[i],
            j => image.derivative[(i, j)] - if i == j { 1.0 } else { 0.0 },
        }))
    }
}

/// The walk along a branch.
struct Walk<'a, F: Family> {
    family: &'a F,
    follow: Follow,
}

/// A corrected point off the predicted one by more than this share of the step is not believed.
const NEAR: f64 = 0.1;

/// Least cosine of the turn of a step.
const TURN: f64 = 0.9;

/// First distance beyond a touch, and the last one, in scaled parameter.
const BEYOND: (f64, f64) = (1e-7, 2e-2);

type Found<F> = Option<Place<<F as Family>::Signature>>;

impl<F: Family> Walk<'_, F> {
    fn unscaled(&self, unknowns: &[f64]) -> (Vec<f64>, f64) {
        let n = unknowns.len() - 1;
        let state = unknowns[..n].iter().map(|it| it * self.family.scale()).collect();
        (state, self.value(unknowns[n]))
    }

    /// The parameter of a scaled one; the ends of the window exactly.
    fn value(&self, share: f64) -> f64 {
        let Follow { from, to, .. } = self.follow;
        if share == 1.0 { to } else { (to - from).mul_add(share, from) }
    }

    fn scaled(&self, state: &[f64], share: f64) -> Vec<f64> {
        state.iter().map(|it| it / self.family.scale()).chain([share]).collect()
    }

    /// The point on the hyperplane through `predicted`, with its tangent along `normal`.
    fn at(
        &self,
        predicted: &[f64],
        normal: &[f64],
        held: Option<&F::Signature>,
        before: Option<&Matrix>,
    ) -> Found<F> {
        let system = Closing { walk: self, held };
        let solved = arc::corrected(&system, predicted, normal, before);
        let Solved { unknowns, residual, known, derivative } = match solved {
            Ok(solved) => solved,
            Err(NoStep::NotConverged | NoStep::Failed(_)) => return None,
        };
        let multipliers = multipliers(&known.derivative)?;
        let tangent = tangent(&derivative, normal)?;
        Some(Place { unknowns, tangent, derivative, image: known, residual, multipliers })
    }

    /// The place at a scaled parameter, near a state, whatever its signature.
    fn standing(&self, state: &[f64], share: f64, towards: f64) -> Found<F> {
        let mut normal = vec![0.0; state.len() + 1];
        normal[state.len()] = towards;
        self.at(&self.scaled(state, share), &normal, None, None)
    }

    fn point(&self, place: &Place<F::Signature>) -> Point<F::Signature> {
        let (state, parameter) = self.unscaled(&place.unknowns);
        Point {
            state,
            parameter,
            multipliers: place.multipliers.clone(),
            residual: place.residual,
            distance: place.image.distance,
            signature: place.image.signature.clone(),
        }
    }

    /// The place at a share of the way between two on one piece.
    fn on_the_way(
        &self,
        a: &Place<F::Signature>,
        b: &Place<F::Signature>,
        held: Option<&F::Signature>,
        share: f64,
    ) -> Found<F> {
        let predicted =
            between((&a.unknowns, &a.tangent), (&b.unknowns, &b.tangent), share);
        let way: Vec<f64> = b.unknowns.iter().zip(&a.unknowns).map(|(b, a)| b - a).collect();
        self.at(&predicted, &direction(way), held, Some(&a.derivative))
    }

    /// Where a test changes sign between two places of one piece: the place, and how sure its parameter is.
    fn root(
        &self,
        a: &Place<F::Signature>,
        b: &Place<F::Signature>,
        held: Option<&F::Signature>,
        value: impl Fn(&Place<F::Signature>) -> f64,
    ) -> Option<(Place<F::Signature>, f64)> {
        let mut last: Found<F> = None;
        let closeness = Closeness { absolute: 1e-11, relative: 0.0 };
        let root = find_root(
            |share| {
                let place = self.on_the_way(a, b, held, share);
                let value = place.as_ref().map_or(f64::NAN, &value);
                last = place;
                value
            },
            0.0,
            1.0,
            closeness,
        )
        .ok()?;
        let place = self.on_the_way(a, b, held, root.location).or(last)?;
        let span = (b.parameter() - a.parameter()).abs().max(distance(&a.unknowns, &b.unknowns));
        Some((place, (root.width * span + 1e-12) * (self.follow.to - self.follow.from).abs()))
    }

    /// Smooth thresholds between two places of one piece.
    fn thresholds(
        &self,
        a: &Place<F::Signature>,
        b: &Place<F::Signature>,
        out: &mut Vec<Passage<F::Signature>>,
    ) {
        let (at_a, at_b) = (Tests::of(&a.multipliers), Tests::of(&b.multipliers));
        let held = Some(&a.image.signature);
        let mut found: Vec<(f64, Kind, Place<F::Signature>, f64)> = Vec::new();
        for (index, kind) in SMOOTH.into_iter().enumerate() {
            let (before, after) = (at_a.values[index], at_b.values[index]);
            if before == 0.0 || before * after > 0.0 {
                continue;
            }
            let value = |place: &Place<F::Signature>| Tests::of(&place.multipliers).values[index];
            // A root that cannot be closed in on is told with the whole step as its error.
            let span = (b.parameter() - a.parameter()) * (self.follow.to - self.follow.from);
            let (place, error) =
                self.root(a, b, held, value).unwrap_or_else(|| (b.clone(), span.abs()));
            if !confirmed(kind, &place.multipliers) {
                continue;
            }
            let last = a.tangent.len() - 1;
            let turns = a.tangent[last] * b.tangent[last] < 0.0;
            let kind = if kind == Kind::Fold && !turns { Kind::Branching } else { kind };
            found.push((distance(&a.unknowns, &place.unknowns), kind, place, error));
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut before = a.clone();
        for number in 0..found.len() {
            let (_, kind, place, error) = &found[number];
            let after = match found.get(number + 1) {
                Some((_, _, next, _)) => {
                    self.on_the_way(place, next, held, 0.5).unwrap_or_else(|| b.clone())
                }
                None => b.clone(),
            };
            out.push(self.passage(*kind, place, *error, &before, Some(&after)));
            before = after;
        }
    }

    /// A passage with its sides in the order of the parameter.
    fn passage(
        &self,
        kind: Kind,
        place: &Place<F::Signature>,
        error: f64,
        before: &Place<F::Signature>,
        after: Option<&Place<F::Signature>>,
    ) -> Passage<F::Signature> {
        let here = place.parameter();
        // The first side comes from where the walk was, the second lies where it goes.
        let came_up = before.parameter() < here
            || (before.parameter() == here && before.tangent.last().is_some_and(|it| *it > 0.0));
        let (mut below, mut above) = (None, None);
        let mut put = |is_below: bool, side: Side<F::Signature>| {
            let slot = if is_below { &mut below } else { &mut above };
            if slot.as_ref().is_none_or(|there: &Side<_>| side.unstable < there.unstable) {
                *slot = Some(side);
            }
        };
        put(came_up, before.side());
        if let Some(after) = after {
            put(after.parameter() < here, after.side());
        }
        if self.follow.to < self.follow.from {
            std::mem::swap(&mut below, &mut above);
        }
        let (state, parameter) = self.unscaled(&place.unknowns);
        Passage { parameter, error, kind, state, below, above }
    }

    /// Where a test of one sign dips between three places: a place with the other sign, if there is one.
    fn dip(
        &self,
        places: [&Place<F::Signature>; 3],
        index: usize,
    ) -> Option<(usize, Place<F::Signature>)> {
        let value = |place: &Place<F::Signature>| Tests::of(&place.multipliers).values[index];
        let [before, here, after] = places.map(value);
        let sign = here.signum();
        if before * here <= 0.0
            || here * after <= 0.0
            || here.abs() > before.abs()
            || here.abs() > after.abs()
        {
            return None;
        }
        // The parabola through the three says whether the test could come near to zero.
        let (left, right) = (
            distance(&places[0].unknowns, &places[1].unknowns),
            distance(&places[1].unknowns, &places[2].unknowns),
        );
        let (fall, rise) = ((here - before) / left, (after - here) / right);
        let bend = (rise - fall) / (left + right);
        let slope = (fall * right + rise * left) / (left + right);
        let lowest = here - slope * slope / (4.0 * bend);
        if sign * lowest > 0.5 * here.abs() {
            return None;
        }
        (0..2).find_map(|segment| {
            let (a, b) = (places[segment], places[segment + 1]);
            let held = Some(&a.image.signature);
            let mut other: Found<F> = None;
            let _ = minimise(
                |share| {
                    let place = self.on_the_way(a, b, held, share);
                    let found = place.as_ref().map_or(f64::INFINITY, |it| sign * value(it));
                    if found < 0.0 {
                        other = place;
                    }
                    found
                },
                0.0,
                1.0,
                Closeness { absolute: 1e-4, relative: 0.0 },
            );
            other.map(|place| (segment, place))
        })
    }

    /// The branch beyond a touch: on in the direction of the walk, else back; where continuity proves it.
    fn beyond(&self, touch: &Place<F::Signature>, towards: f64) -> Found<F> {
        let n = touch.unknowns.len() - 1;
        let (state, _) = self.unscaled(&touch.unknowns);
        let share = touch.unknowns[n];
        for side in [towards, -towards] {
            let mut away = BEYOND.0;
            while away <= BEYOND.1 {
                let far = share + side * away;
                if (0.0..=1.0).contains(&far)
                    && let Some(found) = self.standing(&state, far, side)
                    && (side == towards || found.image.signature != touch.image.signature)
                    && self.is_joined(touch, &found, side)
                {
                    return Some(found);
                }
                away *= 8.0;
            }
        }
        None
    }

    /// Whether the state comes to the touch as the parameter does.
    fn is_joined(
        &self,
        touch: &Place<F::Signature>,
        found: &Place<F::Signature>,
        side: f64,
    ) -> bool {
        let n = touch.unknowns.len() - 1;
        let far = distance(&touch.unknowns[..n], &found.unknowns[..n]);
        let middle: Vec<f64> =
            touch.unknowns.iter().zip(&found.unknowns).map(|(a, b)| a + 0.25 * (b - a)).collect();
        let (guess, _) = self.unscaled(&middle);
        self.standing(&guess, middle[n], side).is_some_and(|quarter| {
            distance(&touch.unknowns[..n], &quarter.unknowns[..n]) <= 0.6 * far + 1e-8
        })
    }

    /// Where two places of different signatures meet, neither of which can be continued: bisection.
    fn border(
        &self,
        a: &Place<F::Signature>,
        b: &Place<F::Signature>,
    ) -> (Place<F::Signature>, Place<F::Signature>) {
        let (mut near, mut far) = (a.clone(), b.clone());
        let way: Vec<f64> = b.unknowns.iter().zip(&a.unknowns).map(|(b, a)| b - a).collect();
        let normal = direction(way);
        let (mut low, mut high) = (0.0, 1.0);
        while high - low > 1e-9 {
            let share = 0.5 * (low + high);
            let predicted: Vec<f64> =
                a.unknowns.iter().zip(&b.unknowns).map(|(a, b)| a + share * (b - a)).collect();
            // The middle of the two, moved onto the plane of this share.
            let mut guess: Vec<f64> =
                near.unknowns.iter().zip(&far.unknowns).map(|(a, b)| 0.5 * (a + b)).collect();
            let aside: f64 = normal.iter().zip(predicted.iter().zip(&guess)).map(|(n, (p, g))| n * (p - g)).sum();
            for (entry, along) in guess.iter_mut().zip(&normal) {
                *entry += aside * along;
            }
            match self.at(&guess, &normal, None, None) {
                Some(place) if place.image.signature == a.image.signature => {
                    near = place;
                    low = share;
                }
                Some(place) if place.image.signature == b.image.signature => {
                    far = place;
                    high = share;
                }
                _ => break,
            }
        }
        (near, far)
    }
}

/// What a step led to.
enum Step<S> {
    /// On along the piece.
    On(Box<Place<S>>),
    /// To a border, and beyond it where there is something.
    Over(Option<Box<Place<S>>>),
    /// Nowhere at this length.
    Failed,
}

impl<F: Family> Walk<'_, F> {
    /// One step of a length from `here`, with what is passed on it.
    fn step(
        &self,
        here: &Place<F::Signature>,
        length: f64,
        out: &mut Vec<Passage<F::Signature>>,
    ) -> Step<F::Signature> {
        let n = here.unknowns.len() - 1;
        let mut normal = here.tangent.clone();
        let mut length = length;
        let end = if here.tangent[n] > 0.0 { 1.0 } else { 0.0 };
        let reaches = (here.unknowns[n] + length * here.tangent[n] - end) * here.tangent[n] >= 0.0;
        if reaches {
            length = (end - here.unknowns[n]) / here.tangent[n];
            normal = vec![0.0; n + 1];
            normal[n] = here.tangent[n].signum();
        }
        let mut predicted: Vec<f64> =
            here.unknowns.iter().zip(&here.tangent).map(|(u, t)| u + length * t).collect();
        if reaches {
            predicted[n] = end;
        }
        let held = Some(&here.image.signature);
        let Some(mut next) = self.at(&predicted, &normal, held, None) else {
            return Step::Failed;
        };
        if reaches {
            next.unknowns[n] = end;
        }
        let off = distance(&next.unknowns, &predicted);
        let same = next.image.signature == here.image.signature;
        if off > NEAR * length.max(1e-7) * if same { 1.0 } else { 5.0 } {
            return Step::Failed;
        }
        if !same {
            return self.across(here, &next, out);
        }
        if cosine(&next.tangent, &here.tangent) < TURN {
            return Step::Failed;
        }
        if next.image.distance <= 0.0 {
            let touched = self.root(here, &next, held, |it| it.image.distance);
            let Some((touch, error)) = touched else { return Step::Failed };
            self.thresholds(here, &touch, out);
            let after = self.beyond(&touch, here.tangent[n].signum());
            out.push(self.passage(Kind::Touch, &touch, error, &touch_side(here, &touch), after.as_ref()));
            return Step::Over(after.map(Box::new));
        }
        self.thresholds(here, &next, out);
        Step::On(Box::new(next))
    }

    /// From one signature to another.
    fn across(
        &self,
        here: &Place<F::Signature>,
        next: &Place<F::Signature>,
        out: &mut Vec<Passage<F::Signature>>,
    ) -> Step<F::Signature> {
        // Where the piece beyond knows its border, that is a touch met from outside.
        let held = Some(&next.image.signature);
        if next.image.distance.is_finite()
            && let Some((touch, error)) = self.root(here, next, held, |it| it.image.distance)
        {
            out.push(self.passage(Kind::Touch, &touch, error, here, Some(&on_from(&touch, next))));
            self.thresholds(&touch, next, out);
            return Step::Over(Some(Box::new(next.clone())));
        }
        let (near, far) = self.border(here, next);
        if distance(&near.unknowns, &far.unknowns) > 1e-8 {
            // The two do not meet: they belong to different branches.
            return Step::Failed;
        }
        self.thresholds(here, &near, out);
        let width = (far.parameter() - near.parameter()).abs() + 1e-12;
        let error = width * (self.follow.to - self.follow.from).abs();
        out.push(self.passage(Kind::Border, &near, error, here, Some(next)));
        Step::Over(Some(Box::new(next.clone())))
    }
}

/// A touch seen as the end of the piece before it: its own multipliers, on the side where the walk was.
fn touch_side<S: Clone>(here: &Place<S>, touch: &Place<S>) -> Place<S> {
    Place { unknowns: here.unknowns.clone(), tangent: here.tangent.clone(), ..touch.clone() }
}

/// A touch seen as the beginning of the piece after it.
fn on_from<S: Clone>(touch: &Place<S>, next: &Place<S>) -> Place<S> {
    Place { unknowns: next.unknowns.clone(), tangent: next.tangent.clone(), ..touch.clone() }
}

/// The branch through a fixed point near `state` at `parameter`, followed upwards or downwards through its window.
///
/// # Errors
/// [`NotClosed`] where there is no fixed point to begin with.
pub fn follow<F: Family>(
    family: &F,
    state: &[f64],
    parameter: f64,
    upwards: bool,
    options: Follow,
) -> Result<Branch<F::Signature, F::Error>, NotClosed<F::Error>> {
    let walk = Walk { family, follow: options };
    let first = fixed_point(family, state, &[parameter], None, &Shooting::default())?;
    let share = (parameter - options.from) / (options.to - options.from);
    let towards = if upwards == (options.to > options.from) { 1.0 } else { -1.0 };
    let stuck = || NotClosed::Singular {
        steps: first.steps,
        residual: first.residual,
        at: first.state.clone(),
    };
    let mut here = walk.standing(&first.state, share, towards).ok_or_else(stuck)?;
    let begin = here.clone();
    let n = family.dimension();
    let mut points = vec![walk.point(&here)];
    let mut passages = Vec::new();
    let mut before: Found<F> = None;
    let mut length = options.longest;
    // Whether what stopped the steps was looked beyond already.
    let mut looked = false;
    let end = loop {
        let at = walk.value(here.unknowns[n]);
        let towards_end = if here.tangent[n] > 0.0 { 1.0 } else { 0.0 };
        if points.len() > 1 && here.unknowns[n] == towards_end {
            break End::Window { at };
        }
        if points.len() > options.most_points as usize {
            break End::TooLong { at };
        }
        let passed = passages.len();
        match walk.step(&here, length, &mut passages) {
            Step::On(next) => {
                looked = false;
                if let Some(before) = before.as_ref().filter(|_| passages.len() == passed) {
                    dips(&walk, [before, &here, &next], &mut passages);
                }
                let way = distance(&next.unknowns, &here.unknowns);
                let turned = 1.0 - cosine(&next.tangent, &here.tangent);
                if turned < 1e-3 {
                    length = (if turned < 1e-5 { 4.0 } else { 1.6 } * way).min(options.longest);
                }
                points.push(walk.point(&next));
                before = Some(std::mem::replace(&mut here, *next));
                let closes = points.len() > 8
                    && distance(&here.unknowns, &begin.unknowns) < 0.6 * way
                    && cosine(&here.tangent, &begin.tangent) > TURN;
                if closes {
                    break End::Closed;
                }
            }
            Step::Over(Some(next)) => {
                looked = false;
                length = distance(&next.unknowns, &here.unknowns).clamp(10.0 * options.shortest, options.longest);
                points.push(walk.point(&next));
                before = None;
                here = *next;
            }
            Step::Over(None) => {
                let at = passages.last().map_or(at, |it: &Passage<_>| it.parameter);
                break End::Touch { at };
            }
            Step::Failed if length > options.shortest => length *= 0.4,
            Step::Failed => {
                // A corner that no step turns around: the branch may go on beyond it.
                let beyond = if looked { None } else { walk.beyond(&here, here.tangent[n].signum()) };
                let Some(next) = beyond else { break End::Lost { at, why: None } };
                looked = true;
                length = distance(&next.unknowns, &here.unknowns).max(10.0 * options.shortest);
                let error = length * (options.to - options.from).abs();
                passages.push(walk.passage(Kind::Border, &here, error, &here, Some(&next)));
                points.push(walk.point(&next));
                before = None;
                here = next;
            }
        }
    };
    Ok(Branch { points, passages, end })
}

/// Pairs of thresholds inside a dip of a test function.
fn dips<F: Family>(
    walk: &Walk<'_, F>,
    places: [&Place<F::Signature>; 3],
    out: &mut Vec<Passage<F::Signature>>,
) {
    for index in 0..SMOOTH.len() {
        if let Some((segment, inside)) = walk.dip(places, index) {
            walk.thresholds(places[segment], &inside, out);
            walk.thresholds(&inside, places[segment + 1], out);
        }
    }
}
