//! Special points between two solutions on a branch: smooth thresholds, grazing, borders of signatures.

use super::super::arc::{MEETING, distance, normalised};
use super::super::threshold::{BifurcationKind, ON_THE_CIRCLE, SMOOTH, Tests, confirmed};
use super::super::{PeriodMap, spectral_radius};
use super::points::{BranchSide, SpecialPoint};
use super::run::{BranchSolution, ContinuationRun, MaybeSolution};
use crate::order::ascending_by;
use crate::polar::modulus;
use crate::roots::{Closeness, find_root, minimise};

/// First distance beyond a grazing point at which the branch is searched for, in the scaled parameter, and its growth. Where a stick begins
/// with a static level above μ(0⁺), no response exists next to the grazing, over 10⁻³ of the parameter in cases that were met: a larger
/// growth leaves more of the gap unknown than there is.
const NEAREST: f64 = 1e-7;
const GROWTH: f64 = 2.0;

/// The last of these distances, over the parameter, so that it does not depend on the window, or over this part of the window, where the
/// parameter is smaller. With a larger value another branch could be taken for the continuation.
const FARTHEST: f64 = 2e-2;
const LEAST_PART: f64 = 1e-2;

/// How many times faster than at the grazing point the state may change beyond a gap. Measured where friction begins below its static level:
/// 0.01 to 27, the largest with Coulomb friction under dither of 200 times the natural frequency. A response of another branch that a search
/// beyond the end of this one found, and that passed as joined to it, was 1300 times as far; others, at 41 and 83, are not joined
/// (`TENDING`). With a larger value the former is taken for the continuation; with 8 branches of the conformance suite end at their gaps.
const STEEPEST: f64 = 50.0;

/// Halvings of the interval in which the branch begins beyond a gap: its width is an error of a thousandth of the gap then.
const HALVINGS: u32 = 10;

/// Shares of the distance at which the state must be nearer to the grazing state, and by how much at most: like a square root, with a margin.
/// A motion that jumps at the border by as much as it moves beyond it gives 0.63 and 0.75.
const TENDING: [(f64, f64); 2] = [(0.25, 0.6), (0.5, 0.74)];

/// How many times further than the parameter the state may move before the first of these distances is shortened, and its least share: in
/// a wide window the next border may be nearer than the unshortened one, and the branch is then lost or leapt over. Windows that are not
/// wide have slopes far below the first; below the second rounding decides on which side of the border a solution is.
const STEEP: f64 = 1e3;
const LEAST_SHARE: f64 = 1e-4;

/// Distance from the first of two solutions, kind, solution and error of a threshold between them.
type FoundThreshold<S> = (f64, BifurcationKind, BranchSolution<S>, f64);

impl<F: PeriodMap> ContinuationRun<'_, F> {
    /// The solution at which a test function changes sign between two solutions of one piece, and the error of its parameter.
    pub(super) fn root(
        &self,
        a: &BranchSolution<F::Signature>,
        b: &BranchSolution<F::Signature>,
        held: Option<&F::Signature>,
        value: impl Fn(&BranchSolution<F::Signature>) -> f64,
    ) -> Option<(BranchSolution<F::Signature>, f64)> {
        let mut last: MaybeSolution<F> = None;
        let closeness = Closeness { absolute: 1e-11, relative: 0.0 };
        let root = find_root(
            |share| {
                let solution = self.interpolated(a, b, held, share);
                let value = solution.as_ref().map_or(f64::NAN, &value);
                last = solution;
                value
            },
            0.0,
            1.0,
            closeness,
        )
        .ok()?;
        let solution = self.interpolated(a, b, held, root.location).or(last)?;
        let span = (b.parameter() - a.parameter()).abs().max(distance(&a.unknowns, &b.unknowns));
        Some((solution, (root.width * span + 1e-12) * (self.follow.to - self.follow.from).abs()))
    }

    /// Smooth thresholds between two solutions of one piece.
    pub(super) fn thresholds(
        &self,
        a: &BranchSolution<F::Signature>,
        b: &BranchSolution<F::Signature>,
        out: &mut Vec<SpecialPoint<F::Signature>>,
    ) {
        self.thresholds_of((a, b), None, out);
    }

    /// Those of one test function, by its index, or of all.
    pub(super) fn thresholds_of(
        &self,
        (a, b): (&BranchSolution<F::Signature>, &BranchSolution<F::Signature>),
        only: Option<usize>,
        out: &mut Vec<SpecialPoint<F::Signature>>,
    ) {
        let last = a.tangent.len() - 1;
        let turns = a.tangent[last] * b.tangent[last] < 0.0;
        if self.follow.only_forwards && !turns {
            return;
        }
        let (at_a, at_b) = (Tests::of(&a.multipliers), Tests::of(&b.multipliers));
        let held = Some(&a.image.signature);
        let mut found: Vec<FoundThreshold<F::Signature>> = Vec::new();
        for (index, kind) in SMOOTH.into_iter().enumerate() {
            let (before, after) = (at_a.values[index], at_b.values[index]);
            let wanted = only.is_none_or(|only| only == index);
            if !wanted || before == 0.0 || before * after > 0.0 {
                continue;
            }
            let value = |solution: &BranchSolution<F::Signature>| {
                Tests::of(&solution.multipliers).values[index]
            };
            // A root that cannot be located is reported with the whole step as its error.
            let span = (b.parameter() - a.parameter()) * (self.follow.to - self.follow.from);
            let (solution, error) =
                self.root(a, b, held, value).unwrap_or_else(|| (b.clone(), span.abs()));
            if !confirmed(kind, &solution.multipliers) {
                continue;
            }
            let kind = if kind == BifurcationKind::Fold && !turns {
                BifurcationKind::Branching
            } else {
                kind
            };
            let at = self.value(solution.parameter());
            let is_known = |known: &SpecialPoint<F::Signature>| {
                known.kind == kind && (known.parameter - at).abs() <= known.error + error
            };
            // A dip may contain a point that a step has found.
            if only.is_some() && out.iter().any(is_known) {
                continue;
            }
            found.push((distance(&a.unknowns, &solution.unknowns), kind, solution, error));
        }
        if found.is_empty() && only.is_none() {
            found.extend(self.even_crossing(a, b));
        }
        ascending_by(&mut found, |a| a.0);
        let mut before = a.clone();
        for number in 0..found.len() {
            let (_, kind, solution, error) = &found[number];
            let after = match found.get(number + 1) {
                Some((_, _, next, _)) => {
                    self.interpolated(solution, next, held, 0.5).unwrap_or_else(|| b.clone())
                }
                None => b.clone(),
            };
            out.push(self.special_point(*kind, solution, *error, &before, Some(&after)));
            before = after;
        }
    }

    /// Several equal multipliers that cross the unit circle together, as those of equal parts of a structure do: the test functions
    /// keep their sign there, and the root is that of the largest modulus.
    fn even_crossing(
        &self,
        a: &BranchSolution<F::Signature>,
        b: &BranchSolution<F::Signature>,
    ) -> Option<FoundThreshold<F::Signature>> {
        let outside =
            |solution: &BranchSolution<F::Signature>| spectral_radius(&solution.multipliers) - 1.0;
        if outside(a) == 0.0 || outside(a) * outside(b) > 0.0 {
            return None;
        }
        let held = Some(&a.image.signature);
        let (solution, error) = self.root(a, b, held, outside)?;
        let largest = solution.multipliers.first()?;
        let kind = match () {
            () if (modulus(*largest) - 1.0).abs() > ON_THE_CIRCLE => return None,
            () if largest.im != 0.0 => BifurcationKind::NeimarkSacker,
            () if largest.re < 0.0 => BifurcationKind::Flip,
            () => BifurcationKind::Branching,
        };
        Some((distance(&a.unknowns, &solution.unknowns), kind, solution, error))
    }

    /// A special point with its sides in the order of the parameter.
    pub(super) fn special_point(
        &self,
        kind: BifurcationKind,
        solution: &BranchSolution<F::Signature>,
        error: f64,
        before: &BranchSolution<F::Signature>,
        after: Option<&BranchSolution<F::Signature>>,
    ) -> SpecialPoint<F::Signature> {
        let here = solution.parameter();
        // The first side is the one that the run comes from, the second is the one that it continues on.
        let came_up = before.parameter() < here
            || (before.parameter() == here
                && before.tangent.last().is_some_and(|slope| *slope > 0.0));
        let (mut below, mut above) = (None, None);
        let mut put = |is_below: bool, side: BranchSide<F::Signature>| {
            let slot = if is_below { &mut below } else { &mut above };
            if slot.as_ref().is_none_or(|there: &BranchSide<_>| side.unstable < there.unstable) {
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
        let (state, parameter) = self.unscaled(&solution.unknowns);
        SpecialPoint { parameter, error, gap: 0.0, kind, state, below, above }
    }

    /// A solution with the opposite sign of a function, if the function has one sign at three successive solutions but changes
    /// sign in a dip between them: the solution, and the number of the solution before it.
    pub(super) fn dip(
        &self,
        solutions: [&BranchSolution<F::Signature>; 3],
        value: impl Fn(&BranchSolution<F::Signature>) -> f64,
    ) -> Option<(usize, BranchSolution<F::Signature>)> {
        let [before, here, after] = solutions.map(&value);
        let sign = here.signum();
        if before * here <= 0.0
            || here * after <= 0.0
            || here.abs() > before.abs()
            || here.abs() > after.abs()
        {
            return None;
        }
        // The parabola through the three values shows whether the test function may come close to zero.
        let (left, right) = (
            distance(&solutions[0].unknowns, &solutions[1].unknowns),
            distance(&solutions[1].unknowns, &solutions[2].unknowns),
        );
        let (fall, rise) = ((here - before) / left, (after - here) / right);
        let bend = (rise - fall) / (left + right);
        let slope = (fall * right + rise * left) / (left + right);
        let lowest = here - slope * slope / (4.0 * bend);
        if sign * lowest > 0.5 * here.abs() {
            return None;
        }
        (0..2).find_map(|segment| {
            let (a, b) = (solutions[segment], solutions[segment + 1]);
            let held = Some(&a.image.signature);
            let mut other: MaybeSolution<F> = None;
            let _ = minimise(
                |share| {
                    let solution = self.interpolated(a, b, held, share);
                    let found =
                        solution.as_ref().map_or(f64::INFINITY, |solution| sign * value(solution));
                    if found < 0.0 {
                        other = solution;
                    }
                    found
                },
                0.0,
                1.0,
                Closeness { absolute: 1e-4, relative: 0.0 },
            );
            other.map(|solution| (segment, solution))
        })
    }

    /// The branch beyond a grazing point: forward in the direction of the run, otherwise backward; accepted only if it is
    /// continuous there. With it how far from the point nothing is known, in the parameter and with its sign: 0 where the branch was found at
    /// once.
    pub(super) fn beyond(
        &self,
        grazing: &BranchSolution<F::Signature>,
        towards: f64,
    ) -> Option<(BranchSolution<F::Signature>, f64)> {
        let n = grazing.unknowns.len() - 1;
        let (state, at) = self.unscaled(&grazing.unknowns);
        let share = grazing.unknowns[n];
        let slope = grazing.tangent[n].abs() * STEEP;
        // How fast the state changes with the parameter at the grazing point, and one where it hardly does.
        let rate = 1.0 / grazing.tangent[n].abs().max(f64::MIN_POSITIVE);
        let nearest = NEAREST * slope.clamp(LEAST_SHARE, 1.0);
        let span = self.follow.to - self.follow.from;
        let width = span.abs();
        let farthest = FARTHEST * (at.abs() / width).max(LEAST_PART);
        for side in [towards, -towards] {
            let mut away = nearest;
            while away <= farthest.max(nearest) {
                let far = share + side * away;
                if (0.0..=1.0).contains(&far)
                    && let Some(found) = self.standing(&state, far, side)
                    && (side == towards || found.image.signature != grazing.image.signature)
                    && (away == nearest || state_change(grazing, &found) <= STEEPEST * rate * away)
                    && self.is_joined(grazing, &found, side)
                {
                    let gap =
                        if away == nearest { 0.0 } else { self.gap(grazing, &found, (side, rate)) };
                    return Some((found, side * gap * span));
                }
                away *= GROWTH;
            }
        }
        None
    }

    /// The scaled distance beyond a grazing point at which the branch begins: from a solution on it halved towards the point.
    fn gap(
        &self,
        grazing: &BranchSolution<F::Signature>,
        found: &BranchSolution<F::Signature>,
        (side, rate): (f64, f64),
    ) -> f64 {
        let share = grazing.parameter();
        let (mut none, mut begins) = (share, found.clone());
        for _ in 0..HALVINGS {
            let middle = 0.5 * (none + begins.parameter());
            let part = (middle - share) / (begins.parameter() - share);
            // Where the line to the grazing state leads nowhere, the state itself may.
            let state = self.unscaled(&begins.unknowns).0;
            let nearer = self.part_way((grazing, &begins), part, side);
            let nearer = nearer.or_else(|| self.standing(&state, middle, side));
            let most = STEEPEST * rate * (begins.parameter() - middle).abs();
            match nearer.filter(|nearer| state_change(&begins, nearer) <= most) {
                Some(nearer) => begins = nearer,
                None => none = middle,
            }
        }
        (begins.parameter() - share).abs()
    }

    /// Whether the state tends to the grazing state as the parameter tends to the grazing value.
    fn is_joined(
        &self,
        grazing: &BranchSolution<F::Signature>,
        found: &BranchSolution<F::Signature>,
        side: f64,
    ) -> bool {
        let far = state_change(grazing, found);
        TENDING.into_iter().any(|(part, most)| {
            self.part_way((grazing, found), part, side)
                .is_some_and(|nearer| state_change(grazing, &nearer) <= most * far + 1e-8)
        })
    }

    /// The solution at a part of the way between two, sought from the straight line through them, with any signature.
    fn part_way(
        &self,
        (from, to): (&BranchSolution<F::Signature>, &BranchSolution<F::Signature>),
        part: f64,
        side: f64,
    ) -> MaybeSolution<F> {
        let pairs = from.unknowns.iter().zip(&to.unknowns);
        let guess: Vec<f64> = pairs.map(|(a, b)| a + part * (b - a)).collect();
        self.standing(&self.unscaled(&guess).0, *guess.last()?, side)
    }

    /// The border between two solutions of different signatures, neither of which can be extended, by bisection.
    pub(super) fn border(
        &self,
        a: &BranchSolution<F::Signature>,
        b: &BranchSolution<F::Signature>,
    ) -> (BranchSolution<F::Signature>, BranchSolution<F::Signature>) {
        let (mut near, mut far) = (a.clone(), b.clone());
        let heading: Vec<f64> = b.unknowns.iter().zip(&a.unknowns).map(|(b, a)| b - a).collect();
        let normal = normalised(heading);
        let (mut low, mut high) = (0.0, 1.0);
        // Where the place of the border is not wanted, that the two meet is enough.
        let is_found = |near: &BranchSolution<F::Signature>, far: &BranchSolution<F::Signature>| {
            self.follow.only_forwards && distance(&near.unknowns, &far.unknowns) <= MEETING
        };
        while high - low > 1e-9 && !is_found(&near, &far) {
            let share = 0.5 * (low + high);
            let predicted: Vec<f64> =
                a.unknowns.iter().zip(&b.unknowns).map(|(a, b)| a + share * (b - a)).collect();
            // The midpoint of the two, moved onto the hyperplane of this fraction.
            let mut guess: Vec<f64> =
                near.unknowns.iter().zip(&far.unknowns).map(|(a, b)| 0.5 * (a + b)).collect();
            let aside: f64 = normal
                .iter()
                .zip(predicted.iter().zip(&guess))
                .map(|(n, (p, g))| n * (p - g))
                .sum();
            for (entry, along) in guess.iter_mut().zip(&normal) {
                *entry += aside * along;
            }
            match self.at(&guess, &normal, None, None) {
                Some(solution) if solution.image.signature == a.image.signature => {
                    near = solution;
                    low = share;
                }
                Some(solution) if solution.image.signature == b.image.signature => {
                    far = solution;
                    high = share;
                }
                _ => break,
            }
        }
        (near, far)
    }
}

/// The scaled distance of the states of two solutions.
fn state_change<S>(one: &BranchSolution<S>, other: &BranchSolution<S>) -> f64 {
    let n = one.unknowns.len() - 1;
    distance(&one.unknowns[..n], &other.unknowns[..n])
}
