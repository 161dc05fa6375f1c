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

mod passages;
mod walk;

use num_complex::Complex64;

use super::Family;
use super::arc::{self, cosine, distance};
use super::shooting::{NotClosed, Shooting, fixed_point};
use super::threshold::{Kind, SMOOTH};
pub(super) use walk::NUDGE;
use walk::{Found, Place, Step, Walk};

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
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
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
        /// The last parameter: beyond it steps became too short.
        at: f64,
    },
    /// After as many points as were allowed.
    TooLong {
        /// The last parameter.
        at: f64,
    },
}

/// A branch with what was passed on it, in order.
#[derive(Clone, Debug)]
pub struct Branch<S> {
    /// Points.
    pub points: Vec<Point<S>>,
    /// Thresholds and borders of signatures.
    pub passages: Vec<Passage<S>>,
    /// How it ended.
    pub end: End,
}

/// A branch of a family, or why there is none.
pub type Followed<F> = Result<Branch<<F as Family>::Signature>, NotClosed<<F as Family>::Error>>;

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
) -> Followed<F> {
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
        // A step over a border may end a little beyond the window.
        if points.len() > 1 && (here.unknowns[n] - towards_end) * here.tangent[n] >= 0.0 {
            break End::Window { at: walk.value(towards_end) };
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
                let (now, first) = (here.with_tangent(), begin.with_tangent());
                if arc::closes(points.len(), way, now, first) {
                    break End::Closed;
                }
            }
            Step::Over(Some(next)) => {
                looked = false;
                length = distance(&next.unknowns, &here.unknowns)
                    .clamp(10.0 * options.shortest, options.longest);
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
                let over = if looked { None } else { over_a_corner(&walk, &here, &mut passages) };
                let Some((next, way)) = over else { break End::Lost { at } };
                looked = true;
                length = way;
                points.push(walk.point(&next));
                before = None;
                here = next;
            }
        }
    };
    Ok(Branch { points, passages, end })
}

/// Beyond a corner that no step turns around, where the branch goes on there: the place and the way to it.
fn over_a_corner<F: Family>(
    walk: &Walk<'_, F>,
    here: &Place<F::Signature>,
    out: &mut Vec<Passage<F::Signature>>,
) -> Option<(Place<F::Signature>, f64)> {
    let Follow { from, to, shortest, .. } = walk.follow;
    let next = walk.beyond(here, here.tangent.last()?.signum())?;
    let way = distance(&next.unknowns, &here.unknowns).max(10.0 * shortest);
    out.push(walk.passage(Kind::Border, here, way * (to - from).abs(), here, Some(&next)));
    Some((next, way))
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
