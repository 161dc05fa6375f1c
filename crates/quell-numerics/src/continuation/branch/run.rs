//! One step of a continuation run along a branch.

use num_complex::Complex64;

use super::super::arc::{
    self, FARTHEST_NUDGE, MEETING, NEAR, NUDGE, Solved, TURN, UnderdeterminedSystem, between,
    cosine, distance, normalised, tangent,
};
use super::super::threshold::BifurcationKind;
use super::super::{Image, PeriodMap, multipliers, spectral_radius, unstable};
use super::parameter_window::Follow;
use super::points::{BranchSide, ContinuationPoint, SpecialPoint};
use crate::matrix::Matrix;

/// A solution on the branch with the data that the continuation run needs.
#[derive(Clone, Debug)]
pub(super) struct BranchSolution<S> {
    pub(super) unknowns: Vec<f64>,
    pub(super) tangent: Vec<f64>,
    pub(super) derivative: Matrix,
    pub(super) image: Image<S>,
    pub(super) residual: f64,
    pub(super) multipliers: Vec<Complex64>,
}

impl<S: Clone> BranchSolution<S> {
    pub(super) fn side(&self) -> BranchSide<S> {
        BranchSide {
            unstable: unstable(&self.multipliers),
            radius: spectral_radius(&self.multipliers),
            signature: self.image.signature.clone(),
        }
    }

    pub(super) fn with_tangent(&self) -> (&[f64], &[f64]) {
        (&self.unknowns, &self.tangent)
    }

    pub(super) fn parameter(&self) -> f64 {
        self.unknowns.last().copied().unwrap_or(0.0)
    }
}

/// The equations φ(x) = x in scaled unknowns, on one piece.
struct FixedPointEquations<'a, F: PeriodMap> {
    run: &'a ContinuationRun<'a, F>,
    held: Option<&'a F::Signature>,
}

impl<F: PeriodMap> FixedPointEquations<'_, F> {
    /// The derivative of the image with respect to the parameter, as a difference over an increment of it.
    fn column(
        &self,
        unknowns: &[f64],
        image: &Image<F::Signature>,
        nudge: f64,
    ) -> Result<Vec<f64>, F::Error> {
        let mut moved = unknowns.to_vec();
        if let Some(parameter) = moved.last_mut() {
            *parameter += nudge;
        }
        let (state, parameter) = self.run.unscaled(&moved);
        let other = self.run.family.image_state(&state, &[parameter], self.held)?;
        let scale = self.run.family.scale() * nudge;
        Ok(other.iter().zip(&image.state).map(|(b, a)| (b - a) / scale).collect())
    }
}

impl<F: PeriodMap> UnderdeterminedSystem for FixedPointEquations<'_, F> {
    type Known = Image<F::Signature>;
    type Error = F::Error;

    fn mismatch(&self, unknowns: &[f64]) -> Result<(Vec<f64>, Self::Known), F::Error> {
        let (state, parameter) = self.run.unscaled(unknowns);
        let image = self.run.family.image(&state, &[parameter], self.held)?;
        let scale = self.run.family.scale();
        let mismatch = image.state.iter().zip(&state).map(|(to, from)| (to - from) / scale);
        Ok((mismatch.collect(), image))
    }

    fn derivative(
        &self,
        unknowns: &[f64],
        image: &Self::Known,
        before: Option<&Matrix>,
        heading: &[f64],
    ) -> Result<Matrix, F::Error> {
        let n = self.run.family.dimension();
        let column: Vec<f64> = if let Some(before) = before {
            (0..n).map(|i| before[(i, n)]).collect()
        } else {
            let inside = (0.0..=1.0).contains(&(unknowns[n] + NUDGE.copysign(heading[n])));
            let towards = if inside { heading[n] } else { -heading[n] };
            let column = self.column(unknowns, image, NUDGE.copysign(towards))?;
            let moves = NUDGE * column.iter().map(|entry| entry * entry).sum::<f64>().sqrt();
            if moves > FARTHEST_NUDGE {
                self.column(unknowns, image, (NUDGE * NUDGE / moves).copysign(towards))?
            } else {
                column
            }
        };
        Ok(Matrix::from_fn(n, n + 1, |i, j| match j {
            j if j == n => column[i],
            j => image.derivative[(i, j)] - if i == j { 1.0 } else { 0.0 },
        }))
    }
}

/// A continuation run along a branch.
pub(super) struct ContinuationRun<'a, F: PeriodMap> {
    pub(super) family: &'a F,
    pub(super) follow: Follow,
}

pub(super) type MaybeSolution<F> = Option<BranchSolution<<F as PeriodMap>::Signature>>;

impl<F: PeriodMap> ContinuationRun<'_, F> {
    pub(super) fn unscaled(&self, unknowns: &[f64]) -> (Vec<f64>, f64) {
        let n = unknowns.len() - 1;
        let state = unknowns[..n].iter().map(|x| x * self.family.scale()).collect();
        (state, self.value(unknowns[n]))
    }

    /// The parameter at a fraction of the window; exact at both ends.
    pub(super) fn value(&self, share: f64) -> f64 {
        let Follow { from, to, .. } = self.follow;
        if share == 1.0 { to } else { (to - from).mul_add(share, from) }
    }

    pub(super) fn scaled(&self, state: &[f64], share: f64) -> Vec<f64> {
        state.iter().map(|x| x / self.family.scale()).chain([share]).collect()
    }

    /// The point on the hyperplane through `predicted`, with its tangent along `normal`.
    pub(super) fn at(
        &self,
        predicted: &[f64],
        normal: &[f64],
        held: Option<&F::Signature>,
        before: Option<&Matrix>,
    ) -> MaybeSolution<F> {
        let system = FixedPointEquations { run: self, held };
        let solved = arc::corrected(&system, predicted, normal, before)?;
        let Solved { unknowns, residual, known, derivative } = solved;
        let multipliers = multipliers(&known.derivative)?;
        let tangent = tangent(&derivative, normal)?;
        Some(BranchSolution { unknowns, tangent, derivative, image: known, residual, multipliers })
    }

    /// The solution at a scaled parameter near a state, with any signature.
    pub(super) fn standing(&self, state: &[f64], share: f64, towards: f64) -> MaybeSolution<F> {
        self.standing_on(state, share, towards, None)
    }

    /// The solution at a scaled parameter near a state, on a piece if one is given.
    pub(super) fn standing_on(
        &self,
        state: &[f64],
        share: f64,
        towards: f64,
        held: Option<&F::Signature>,
    ) -> MaybeSolution<F> {
        self.at(&self.scaled(state, share), &upright(state.len(), towards), held, None)
    }

    pub(super) fn point(
        &self,
        solution: &BranchSolution<F::Signature>,
    ) -> ContinuationPoint<F::Signature> {
        let (state, parameter) = self.unscaled(&solution.unknowns);
        ContinuationPoint {
            state,
            parameter,
            multipliers: solution.multipliers.clone(),
            residual: solution.residual,
            distance: solution.image.distance,
            signature: solution.image.signature.clone(),
        }
    }

    /// The solution at a fraction of the distance between two solutions on one piece.
    pub(super) fn interpolated(
        &self,
        a: &BranchSolution<F::Signature>,
        b: &BranchSolution<F::Signature>,
        held: Option<&F::Signature>,
        share: f64,
    ) -> MaybeSolution<F> {
        let heading: Vec<f64> = b.unknowns.iter().zip(&a.unknowns).map(|(b, a)| b - a).collect();
        // At a border the derivative may be steep: then neither its cubic nor the derivative itself is that of the points beyond.
        let cubic = between((&a.unknowns, &a.tangent), (&b.unknowns, &b.tangent), share);
        let straight: Vec<f64> =
            a.unknowns.iter().zip(&heading).map(|(a, h)| h.mul_add(share, *a)).collect();
        let normal = normalised(heading);
        self.at(&cubic, &normal, held, Some(&a.derivative))
            .or_else(|| self.at(&straight, &normal, held, None))
    }
}

/// The normal of a hyperplane of constant parameter, for a state of `n` entries.
fn upright(n: usize, towards: f64) -> Vec<f64> {
    let mut normal = vec![0.0; n + 1];
    normal[n] = towards;
    normal
}

/// The outcome of a step.
pub(super) enum StepOutcome<S> {
    /// The next solution on the same piece.
    On(Box<BranchSolution<S>>),
    /// A border was reached; with the solution beyond it, if there is one.
    Over(Option<Box<BranchSolution<S>>>),
    /// The step failed at this length.
    Failed,
}

impl<F: PeriodMap> ContinuationRun<'_, F> {
    /// One step of a given length from `here`; the special points on it are added to `out`.
    pub(super) fn step(
        &self,
        here: &BranchSolution<F::Signature>,
        length: f64,
        out: &mut Vec<SpecialPoint<F::Signature>>,
    ) -> StepOutcome<F::Signature> {
        let n = here.unknowns.len() - 1;
        let mut normal = here.tangent.clone();
        let mut length = length;
        let end = if here.tangent[n] > 0.0 { 1.0 } else { 0.0 };
        let reaches = (here.unknowns[n] + length * here.tangent[n] - end) * here.tangent[n] >= 0.0;
        if reaches {
            length = (end - here.unknowns[n]) / here.tangent[n];
            normal = upright(n, here.tangent[n].signum());
        }
        let mut predicted: Vec<f64> =
            here.unknowns.iter().zip(&here.tangent).map(|(u, t)| u + length * t).collect();
        if reaches {
            predicted[n] = end;
        }
        let held = Some(&here.image.signature);
        let Some(mut next) = self.at(&predicted, &normal, held, None) else {
            return StepOutcome::Failed;
        };
        let corrected_past = (next.unknowns[n] - end) * here.tangent[n] > 0.0;
        if reaches {
            next.unknowns[n] = end;
        } else if corrected_past {
            // The correction overshot the end of the window: return to the end itself.
            let share = (end - here.unknowns[n]) / (next.unknowns[n] - here.unknowns[n]);
            predicted = between(here.with_tangent(), next.with_tangent(), share);
            predicted[n] = end;
            normal = upright(n, here.tangent[n].signum());
            let Some(at_end) = self.at(&predicted, &normal, held, None) else {
                return StepOutcome::Failed;
            };
            next = at_end;
            next.unknowns[n] = end;
        }
        let off = distance(&next.unknowns, &predicted);
        let same = next.image.signature == here.image.signature;
        if off > NEAR * length.max(1e-7) * if same { 1.0 } else { 5.0 } {
            return StepOutcome::Failed;
        }
        if !same {
            return self.across(here, &next, out);
        }
        if cosine(&next.tangent, &here.tangent) < TURN {
            return StepOutcome::Failed;
        }
        if next.image.distance <= 0.0 {
            let located = self.root(here, &next, held, |solution| solution.image.distance);
            let Some((grazing, error)) = located else { return StepOutcome::Failed };
            self.thresholds(here, &grazing, out);
            let (after, gap) = self.beyond(&grazing, here.tangent[n].signum()).unzip();
            let (kind, side) = (BifurcationKind::Grazing, grazing_side(here, &grazing));
            let point = self.special_point(kind, &grazing, error, &side, after.as_ref());
            out.push(SpecialPoint { gap: gap.unwrap_or(0.0), ..point });
            return StepOutcome::Over(after.map(Box::new));
        }
        self.thresholds(here, &next, out);
        StepOutcome::On(Box::new(next))
    }

    /// A step from one signature to another.
    fn across(
        &self,
        here: &BranchSolution<F::Signature>,
        next: &BranchSolution<F::Signature>,
        out: &mut Vec<SpecialPoint<F::Signature>>,
    ) -> StepOutcome<F::Signature> {
        let (near, far) = self.border(here, next);
        let meets = distance(&near.unknowns, &far.unknowns) <= MEETING;
        // If the distance from its border is defined on the piece beyond, this is grazing approached from outside.
        let mut grazing = self.root_of_distance(here, next);
        if grazing.is_none() && meets {
            let found = self.grazing_of(&near, &next.image.signature);
            grazing = found.map(|(grazing, error, _)| (grazing, error));
        }
        if grazing.is_none() && !meets {
            // The two points belong to different branches.
            return StepOutcome::Failed;
        }
        let before = self.short_of(&near);
        self.thresholds(here, &before, out);
        if let Some((grazing, error)) = grazing {
            let after = on_from(&grazing, next);
            let kind = BifurcationKind::Grazing;
            out.push(self.special_point(kind, &grazing, error, &before, Some(&after)));
            self.thresholds(&grazing, next, out);
        } else {
            let width = (far.parameter() - near.parameter()).abs() + 1e-12;
            let error = width * (self.follow.to - self.follow.from).abs();
            // As the beginning of the piece beyond, whose direction rounding hides so near the border.
            let (kind, after) = (BifurcationKind::Border, on_from(&far, next));
            out.push(self.special_point(kind, &near, error, &before, Some(&after)));
            // What changes between the border and the end of the step is on the piece beyond.
            self.thresholds(&far, next, out);
        }
        StepOutcome::Over(Some(Box::new(next.clone())))
    }

    /// The root of the distance from the border of the piece of `next`, extended to `here`, which has another signature.
    fn root_of_distance(
        &self,
        here: &BranchSolution<F::Signature>,
        next: &BranchSolution<F::Signature>,
    ) -> Option<(BranchSolution<F::Signature>, f64)> {
        if !next.image.distance.is_finite() {
            return None;
        }
        let signature = &next.image.signature;
        self.root(here, next, Some(signature), |solution| {
            // Events of other contacts may differ at the border, which then is none of this piece.
            let same = solution.image.signature == *signature;
            if same { solution.image.distance } else { f64::NAN }
        })
    }
}

/// A grazing point as the end of the piece before it: with its own multipliers, on the side that the run comes from.
fn grazing_side<S: Clone>(
    here: &BranchSolution<S>,
    grazing: &BranchSolution<S>,
) -> BranchSolution<S> {
    BranchSolution {
        unknowns: here.unknowns.clone(),
        tangent: here.tangent.clone(),
        ..grazing.clone()
    }
}

/// A grazing point as the beginning of the piece after it.
pub(super) fn on_from<S: Clone>(
    grazing: &BranchSolution<S>,
    next: &BranchSolution<S>,
) -> BranchSolution<S> {
    BranchSolution {
        unknowns: next.unknowns.clone(),
        tangent: next.tangent.clone(),
        ..grazing.clone()
    }
}
