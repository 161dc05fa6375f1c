//! Grazing approached from the side with more events.
//!
//! On that side the map has no distance from the border, and Newton's method fails on a step across it, because the derivative
//! jumps there. The piece beyond can be extended over its border to where the run stands: its distance is negative there, and
//! the grazing point is its root.

use super::super::PeriodMap;
use super::super::arc::distance;
use super::super::threshold::BifurcationKind;
use super::points::SpecialPoint;
use super::run::{BranchSolution, ContinuationRun, MaybeSolution, on_from};

/// First and last length of a step on the piece beyond, in scaled coordinates, and its growth: from below the distance at which steps
/// count as lost, and above the error of a solution, to far beyond the border.
const STEP: (f64, f64) = (1e-9, 1e-2);
const GROWTH: f64 = 8.0;

/// Largest distance of the grazing point from where the run stands, in scaled coordinates. The run stands at the border up to the
/// shortest step, but its state may vary like the square root of the distance from there. With a larger value a piece of another
/// branch could be taken for the continuation.
const JOINED: f64 = 1e-3;

/// Length of the steps away from a border, on the piece beyond, where the run continues, and on the piece before, where the
/// multipliers are evaluated: far above the error of the border, and so small that multipliers hardly change over it.
const AFTER: f64 = 1e-6;

/// A grazing point with its error, and a solution just inside the piece.
type GrazingFromOutside<S> = (BranchSolution<S>, f64, BranchSolution<S>);

impl<F: PeriodMap> ContinuationRun<'_, F> {
    /// The solution on a piece with fewer events beyond a grazing point next to `here`, if there is one; the point is added to `out`.
    pub(super) fn onto_smoother_piece(
        &self,
        here: &BranchSolution<F::Signature>,
        out: &mut Vec<SpecialPoint<F::Signature>>,
    ) -> MaybeSolution<F> {
        let parameter = self.value(here.parameter());
        let pieces = self.family.smoother(&here.image.signature, &[parameter]);
        let found = pieces.iter().filter_map(|piece| self.grazing_of(here, piece));
        let far =
            |found: &GrazingFromOutside<F::Signature>| distance(&found.0.unknowns, &here.unknowns);
        let (grazing, error, next) = found.min_by(|a, b| far(a).total_cmp(&far(b)))?;
        let kind = BifurcationKind::Grazing;
        let (before, after) = (self.short_of(here), on_from(&grazing, &next));
        out.push(self.special_point(kind, &grazing, error, &before, Some(&after)));
        self.thresholds(&grazing, &next, out);
        Some(next)
    }

    /// The solution on the same piece a little before a border: at the border itself the rates of the events that vanish there are
    /// zero to rounding, and so the multipliers are unknown.
    pub(super) fn short_of(
        &self,
        near: &BranchSolution<F::Signature>,
    ) -> BranchSolution<F::Signature> {
        let pairs = near.unknowns.iter().zip(&near.tangent);
        let predicted: Vec<f64> = pairs.map(|(u, t)| u - AFTER * t).collect();
        let held = Some(&near.image.signature);
        self.at(&predicted, &near.tangent, held, None)
            .filter(|found| found.image.signature == near.image.signature)
            .filter(|found| distance(&found.unknowns, &near.unknowns) <= 2.0 * AFTER)
            .unwrap_or_else(|| near.clone())
    }

    /// The grazing point next to `here` at the border of a piece.
    pub(super) fn grazing_of(
        &self,
        here: &BranchSolution<F::Signature>,
        piece: &F::Signature,
    ) -> Option<GrazingFromOutside<F::Signature>> {
        let held = Some(piece);
        let inside = |solution: &BranchSolution<F::Signature>| solution.image.signature == *piece;
        let value = |solution: &BranchSolution<F::Signature>| solution.image.distance;
        let n = here.unknowns.len() - 1;
        let towards = here.tangent[n].signum();
        let (state, _) = self.unscaled(&here.unknowns);
        let begin = self.standing_on(&state, here.unknowns[n], towards, held).filter(&inside)?;
        if !begin.image.distance.is_finite() {
            return None;
        }
        // Along the tangent where the run stands: over a step this short the tangent of the piece does not turn.
        let stepped = |from: &BranchSolution<F::Signature>, length: f64| {
            let pairs = from.unknowns.iter().zip(&begin.tangent);
            let predicted: Vec<f64> = pairs.map(|(u, t)| u + length * t).collect();
            self.at(&predicted, &begin.tangent, held, Some(&begin.derivative)).filter(&inside)
        };
        let mut length = STEP.0;
        while length <= STEP.1 {
            for side in [1.0, -1.0] {
                let Some(far) = stepped(&begin, side * length) else { continue };
                if begin.image.distance * far.image.distance > 0.0 {
                    continue;
                }
                let (grazing, error) = self.root(&begin, &far, held, value)?;
                if distance(&grazing.unknowns, &here.unknowns) > JOINED {
                    return None;
                }
                // The piece is on the side of positive distance.
                let onwards = if far.image.distance > begin.image.distance { side } else { -side };
                let mut next = stepped(&grazing, onwards * AFTER)?;
                if onwards < 0.0 {
                    next.tangent.iter_mut().for_each(|entry| *entry = -*entry);
                }
                return (next.image.distance > 0.0).then_some((grazing, error, next));
            }
            length *= GROWTH;
        }
        None
    }
}
