//! Continuation of a branch of fixed points by pseudo-arclength.

use super::super::arc::{self, cosine, distance};
use super::super::shooting::{NotClosed, Shooting, fixed_point};
use super::super::threshold::{BifurcationKind, SMOOTH, Tests};
use super::super::{PeriodMap, unstable};
use super::parameter_window::Follow;
use super::points::{End, FixedPointBranch, SpecialPoint};
use super::run::{BranchSolution, ContinuationRun, MaybeSolution, StepOutcome};

/// A branch of a period map, or why it could not be computed.
pub type Followed<F> =
    Result<FixedPointBranch<<F as PeriodMap>::Signature>, NotClosed<<F as PeriodMap>::Error>>;

/// The branch through a fixed point near `state` at `parameter`, followed upwards or downwards through its window.
///
/// # Errors
/// [`NotClosed`] if there is no fixed point to start from.
pub fn follow<F: PeriodMap>(
    family: &F,
    state: &[f64],
    parameter: f64,
    upwards: bool,
    options: Follow,
) -> Followed<F> {
    let run = ContinuationRun { family, follow: options };
    let first = fixed_point(family, state, &[parameter], None, &Shooting::default())?;
    let share = (parameter - options.from) / (options.to - options.from);
    let towards = if upwards == (options.to > options.from) { 1.0 } else { -1.0 };
    let stuck = || NotClosed::Singular {
        steps: first.steps,
        residual: first.residual,
        at: first.state.clone(),
    };
    let mut here = run.standing(&first.state, share, towards).ok_or_else(stuck)?;
    let begin = here.clone();
    let n = family.dimension();
    let mut points = vec![run.point(&here)];
    let mut special_points: Vec<SpecialPoint<F::Signature>> = Vec::new();
    // The solution before `here`, and the number of special points up to it.
    let mut before: MaybeSolution<F> = None;
    let mut passed_before = 0;
    let mut length = options.longest;
    let mut searches = ObstacleSearches::default();
    let end = loop {
        let at = run.value(here.unknowns[n]);
        let towards_end = if here.tangent[n] > 0.0 { 1.0 } else { 0.0 };
        // A step across a border may end slightly beyond the window.
        if points.len() > 1 && (here.unknowns[n] - towards_end) * here.tangent[n] >= 0.0 {
            break End::Window { at: run.value(towards_end) };
        }
        if points.len() > options.most_points as usize {
            break End::TooLong { at };
        }
        if options.only_forwards
            && let Some(turn) = special_points.iter().find(|point| point.is_turn())
        {
            break End::TurnsBack { at: turn.parameter };
        }
        let passed = special_points.len();
        match run.step(&here, length, &mut special_points) {
            StepOutcome::On(next) => {
                let grazes = before
                    .as_ref()
                    .filter(|_| length > options.shortest)
                    .and_then(|before| grazes_between(&run, [before, &here, &next]));
                if let Some((is_later, shorter)) = grazes {
                    // The step is repeated so that it ends beyond the border.
                    special_points.truncate(if is_later { passed } else { passed_before });
                    length = shorter;
                    if let (false, Some(before)) = (is_later, before.take()) {
                        points.pop();
                        here = before;
                    }
                    continue;
                }
                passed_before = passed;
                searches.beyond = false;
                if let Some(before) = before.as_ref().filter(|_| special_points.len() == passed) {
                    dips(&run, [before, &here, &next], &mut special_points);
                }
                let step_length = distance(&next.unknowns, &here.unknowns);
                let deviation = 1.0 - cosine(&next.tangent, &here.tangent);
                if deviation < 1e-3 {
                    length = (if deviation < 1e-5 { 4.0 } else { 1.6 } * step_length)
                        .min(options.longest);
                }
                points.push(run.point(&next));
                before = Some(std::mem::replace(&mut here, *next));
                let (now, first) = (here.with_tangent(), begin.with_tangent());
                if arc::closes(points.len(), step_length, now, first) {
                    break End::Closed;
                }
            }
            StepOutcome::Over(Some(next)) => {
                searches.beyond = false;
                length = distance(&next.unknowns, &here.unknowns)
                    .clamp(10.0 * options.shortest, options.longest);
                points.push(run.point(&next));
                before = None;
                here = *next;
            }
            StepOutcome::Over(None) => {
                let at =
                    special_points.last().map_or(at, |point: &SpecialPoint<_>| point.parameter);
                break End::Grazing { at };
            }
            StepOutcome::Failed if length > options.shortest => length *= 0.4,
            StepOutcome::Failed => {
                let over = over_an_obstacle(&run, &here, &mut searches, &mut special_points);
                let Some((next, step_length)) = over else { break End::Lost { at } };
                length = step_length;
                points.push(run.point(&next));
                before = None;
                here = next;
            }
        }
    };
    Ok(FixedPointBranch { points, special_points, end })
}

/// The searches that were made where no step follows a branch.
#[derive(Default)]
struct ObstacleSearches {
    /// Whether a smoother piece and a corner were sought at the obstacle that stopped the steps.
    beyond: bool,
    kinks: usize,
    leaps: usize,
}

/// The point beyond what stopped the steps, and the distance to it. A smoother piece and a corner are sought once.
fn over_an_obstacle<F: PeriodMap>(
    run: &ContinuationRun<'_, F>,
    here: &BranchSolution<F::Signature>,
    searches: &mut ObstacleSearches,
    out: &mut Vec<SpecialPoint<F::Signature>>,
) -> Option<(BranchSolution<F::Signature>, f64)> {
    searches.kinks += 1;
    if let Some(joined) = (searches.kinks <= MOST_KINKS).then(|| over_a_kink(run, here)).flatten() {
        return Some(joined);
    }
    if !std::mem::replace(&mut searches.beyond, true) {
        let smoother = run.onto_smoother_piece(here, out);
        let smoother = smoother.map(|next| (next, 100.0 * run.follow.shortest));
        if let Some(joined) = smoother.or_else(|| over_a_corner(run, here, out)) {
            return Some(joined);
        }
    }
    searches.leaps += 1;
    (searches.leaps <= MOST_LEAPS).then(|| over_a_steep_beginning(run, here, out)).flatten()
}

/// Searches for a kink along one branch, so that a branch that no step follows ends; beyond, it ends there as lost.
const MOST_KINKS: usize = 8;

/// Length of the steps over a kink, over the shortest one, at which a branch counts as stopped: with a shorter one rounding hides the kink,
/// with a longer one another branch could be taken for the continuation.
const KINK_STEPS: [f64; 2] = [10.0, 100.0];

/// Least cosine of the angle by which a branch turns at a kink, where it goes on in the same direction of the parameter (0.87 in the case
/// that was met): with less, a way back was followed at a border of another kind.
const KINK: f64 = 0.5;

/// The point just beyond a kink, and the distance to it: where an event passes t = 0, the state there changes its direction, and the
/// events stay what they are.
fn over_a_kink<F: PeriodMap>(
    run: &ContinuationRun<'_, F>,
    here: &BranchSolution<F::Signature>,
) -> Option<(BranchSolution<F::Signature>, f64)> {
    let n = run.family.dimension();
    KINK_STEPS.iter().find_map(|steps| {
        let length = steps * run.follow.shortest;
        let pairs = here.unknowns.iter().zip(&here.tangent);
        let predicted: Vec<f64> = pairs.map(|(u, t)| u + length * t).collect();
        let next = run.at(&predicted, &here.tangent, None, None)?;
        let is_joined = next.image.signature == here.image.signature
            && distance(&next.unknowns, &predicted) <= length
            && cosine(&next.tangent, &here.tangent) > KINK
            && next.tangent[n] * here.tangent[n] > 0.0
            && unstable(&next.multipliers) == unstable(&here.multipliers);
        is_joined.then_some((next, length))
    })
}

/// The point beyond a corner that no step can follow, and the distance to it, if the branch continues there.
fn over_a_corner<F: PeriodMap>(
    run: &ContinuationRun<'_, F>,
    here: &BranchSolution<F::Signature>,
    out: &mut Vec<SpecialPoint<F::Signature>>,
) -> Option<(BranchSolution<F::Signature>, f64)> {
    let Follow { from, to, shortest, .. } = run.follow;
    let (next, _) = run.beyond(here, here.tangent.last()?.signum())?;
    let step_length = distance(&next.unknowns, &here.unknowns).max(10.0 * shortest);
    let error = (next.parameter() - here.parameter()).abs() * (to - from).abs();
    out.push(run.special_point(BifurcationKind::Border, here, error, here, Some(&next)));
    Some((next, step_length))
}

/// Relative distances in the parameter at which the branch is sought beyond a border; between, no solution is known. The cases that were
/// met, an elastic slider and two laws whose static level is above μ(0⁺), were found at 10⁻⁴. With larger ones more of the branch
/// would stay unknown, with smaller ones Newton's method fails as the steps did.
const LEAPS: [f64; 3] = [1e-5, 1e-4, 5e-4];

/// Such leaps along one branch, so that a branch that no step follows ends.
const MOST_LEAPS: usize = 8;

/// Largest distance of the states of the longer leap, over the scale of the states: fifty times that of the cases above. With a larger
/// one another branch could be taken for the continuation.
const LARGEST_LEAP: f64 = 0.02;

/// How much longer a second leap is, and the largest share of its distance that the first one may have. A smooth branch gives 0.125 (the
/// cases above 0.11 to 0.14), one that begins like a square root 0.35. A motion that jumps at the border, which is another one, gives more,
/// unless it jumps by less than three times what it moves in the first leap.
const TENDING: (f64, f64) = (8.0, 0.36);

/// The point a little beyond a border next to which no step follows the branch, and the distance to it: the derivative of the map
/// changes there over distances below those at which it is known. An elastic slider begins to adhere so.
fn over_a_steep_beginning<F: PeriodMap>(
    run: &ContinuationRun<'_, F>,
    here: &BranchSolution<F::Signature>,
    out: &mut Vec<SpecialPoint<F::Signature>>,
) -> Option<(BranchSolution<F::Signature>, f64)> {
    let Follow { from, to, shortest, .. } = run.follow;
    let (share, towards) = (here.parameter(), here.tangent.last()?.signum());
    let (state, at) = run.unscaled(&here.unknowns);
    let n = state.len();
    let at_leap = |leap: f64, state: &[f64]| {
        let far = share + towards * leap * at.abs() / (to - from).abs();
        let next = run.standing(state, far, towards).filter(|_| (0.0..=1.0).contains(&far))?;
        Some((distance(&next.unknowns[..n], &here.unknowns[..n]), next))
    };
    let next = LEAPS.into_iter().find_map(|leap| {
        // At the parameter 0 a relative distance leads nowhere.
        let (near, next) = at_leap(leap, &state).filter(|(near, _)| *near > 0.0)?;
        let (beyond, _) = at_leap(TENDING.0 * leap, &run.unscaled(&next.unknowns).0)?;
        (beyond <= LARGEST_LEAP && near <= TENDING.1 * beyond).then_some(next)
    })?;
    let step_length = distance(&next.unknowns, &here.unknowns).max(10.0 * shortest);
    let error = (next.parameter() - share).abs() * (to - from).abs();
    out.push(run.special_point(BifurcationKind::Border, here, error, here, Some(&next)));
    Some((next, step_length))
}

/// Whether a motion grazes between three solutions on one piece and returns: if so, whether that is between the last two, and the
/// length of a step to a solution beyond the border.
fn grazes_between<F: PeriodMap>(
    run: &ContinuationRun<'_, F>,
    solutions: [&BranchSolution<F::Signature>; 3],
) -> Option<(bool, f64)> {
    if !solutions.iter().all(|solution| solution.image.distance.is_finite()) {
        return None;
    }
    let (segment, inside) = run.dip(solutions, |solution| solution.image.distance)?;
    Some((segment == 1, distance(&solutions[segment].unknowns, &inside.unknowns)))
}

/// Pairs of thresholds within a dip of a test function.
fn dips<F: PeriodMap>(
    run: &ContinuationRun<'_, F>,
    solutions: [&BranchSolution<F::Signature>; 3],
    out: &mut Vec<SpecialPoint<F::Signature>>,
) {
    // The first test function is that of a fold.
    let tests = if run.follow.only_forwards { 1 } else { SMOOTH.len() };
    for index in 0..tests {
        let value = |solution: &BranchSolution<F::Signature>| {
            Tests::of(&solution.multipliers).values[index]
        };
        if let Some((segment, inside)) = run.dip(solutions, value) {
            // Those of the other functions were found in the steps themselves.
            run.thresholds_of((solutions[segment], &inside), Some(index), out);
            run.thresholds_of((&inside, solutions[segment + 1]), Some(index), out);
        }
    }
}
