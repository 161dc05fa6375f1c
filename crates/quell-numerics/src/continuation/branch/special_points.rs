//! What is passed between two places of the run: smooth thresholds, touches, borders of signatures.

use super::super::PeriodMap;
use super::super::arc::{direction, distance};
use super::super::threshold::{BifurcationKind, SMOOTH, Tests, confirmed};
use super::points::{BranchSide, SpecialPoint};
use super::run::{BranchSolution, ContinuationRun, MaybeSolution};
use crate::roots::{Closeness, find_root, minimise};

/// First distance beyond a touch, and the last one, in scaled parameter.
const BEYOND: (f64, f64) = (1e-7, 2e-2);

impl<F: PeriodMap> ContinuationRun<'_, F> {
    /// Where a test changes sign between two places of one piece: the place, and how sure its parameter is.
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
                let place = self.interpolated(a, b, held, share);
                let value = place.as_ref().map_or(f64::NAN, &value);
                last = place;
                value
            },
            0.0,
            1.0,
            closeness,
        )
        .ok()?;
        let place = self.interpolated(a, b, held, root.location).or(last)?;
        let span = (b.parameter() - a.parameter()).abs().max(distance(&a.unknowns, &b.unknowns));
        Some((place, (root.width * span + 1e-12) * (self.follow.to - self.follow.from).abs()))
    }

    /// Smooth thresholds between two places of one piece.
    pub(super) fn thresholds(
        &self,
        a: &BranchSolution<F::Signature>,
        b: &BranchSolution<F::Signature>,
        out: &mut Vec<SpecialPoint<F::Signature>>,
    ) {
        let (at_a, at_b) = (Tests::of(&a.multipliers), Tests::of(&b.multipliers));
        let held = Some(&a.image.signature);
        let mut found: Vec<(f64, BifurcationKind, BranchSolution<F::Signature>, f64)> = Vec::new();
        for (index, kind) in SMOOTH.into_iter().enumerate() {
            let (before, after) = (at_a.values[index], at_b.values[index]);
            if before == 0.0 || before * after > 0.0 {
                continue;
            }
            let value =
                |place: &BranchSolution<F::Signature>| Tests::of(&place.multipliers).values[index];
            // A root that cannot be closed in on is told with the whole step as its error.
            let span = (b.parameter() - a.parameter()) * (self.follow.to - self.follow.from);
            let (place, error) =
                self.root(a, b, held, value).unwrap_or_else(|| (b.clone(), span.abs()));
            if !confirmed(kind, &place.multipliers) {
                continue;
            }
            let last = a.tangent.len() - 1;
            let turns = a.tangent[last] * b.tangent[last] < 0.0;
            let kind = if kind == BifurcationKind::Fold && !turns {
                BifurcationKind::Branching
            } else {
                kind
            };
            found.push((distance(&a.unknowns, &place.unknowns), kind, place, error));
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut before = a.clone();
        for number in 0..found.len() {
            let (_, kind, place, error) = &found[number];
            let after = match found.get(number + 1) {
                Some((_, _, next, _)) => {
                    self.interpolated(place, next, held, 0.5).unwrap_or_else(|| b.clone())
                }
                None => b.clone(),
            };
            out.push(self.special_point(*kind, place, *error, &before, Some(&after)));
            before = after;
        }
    }

    /// A special_point with its sides in the order of the parameter.
    pub(super) fn special_point(
        &self,
        kind: BifurcationKind,
        place: &BranchSolution<F::Signature>,
        error: f64,
        before: &BranchSolution<F::Signature>,
        after: Option<&BranchSolution<F::Signature>>,
    ) -> SpecialPoint<F::Signature> {
        let here = place.parameter();
        // The first side comes from where the run was, the second lies where it goes.
        let came_up = before.parameter() < here
            || (before.parameter() == here && before.tangent.last().is_some_and(|it| *it > 0.0));
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
        let (state, parameter) = self.unscaled(&place.unknowns);
        SpecialPoint { parameter, error, kind, state, below, above }
    }

    /// Where a test of one sign dips between three places: a place with the other sign, if there is one.
    pub(super) fn dip(
        &self,
        places: [&BranchSolution<F::Signature>; 3],
        index: usize,
    ) -> Option<(usize, BranchSolution<F::Signature>)> {
        let value =
            |place: &BranchSolution<F::Signature>| Tests::of(&place.multipliers).values[index];
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
            let mut other: MaybeSolution<F> = None;
            let _ = minimise(
                |share| {
                    let place = self.interpolated(a, b, held, share);
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

    /// The branch beyond a touch: on in the direction of the run, else back; where continuity proves it.
    pub(super) fn beyond(
        &self,
        touch: &BranchSolution<F::Signature>,
        towards: f64,
    ) -> MaybeSolution<F> {
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
        touch: &BranchSolution<F::Signature>,
        found: &BranchSolution<F::Signature>,
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
    pub(super) fn border(
        &self,
        a: &BranchSolution<F::Signature>,
        b: &BranchSolution<F::Signature>,
    ) -> (BranchSolution<F::Signature>, BranchSolution<F::Signature>) {
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
            let aside: f64 = normal
                .iter()
                .zip(predicted.iter().zip(&guess))
                .map(|(n, (p, g))| n * (p - g))
                .sum();
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
