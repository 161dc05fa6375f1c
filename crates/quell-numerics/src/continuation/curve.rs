//! The curve of a threshold in two parameters, by pseudo-arclength.
//!
//! The unknowns are the state and both parameters; the equations are φ(x) = x and the test function of the bifurcation. The
//! derivative of the image with respect to the state is exact; the derivative with respect to the parameters and the gradient
//! of the test function are finite differences, computed once per step: they steer Newton's method and do not limit the
//! accuracy of the result.
//!
//! A curve of folds, flips or Neimark–Sacker bifurcations ends where its orbit grazes the border of its signature; a curve of
//! Neimark–Sacker bifurcations also ends where its pair becomes real, at ±1.

use crate::interval::RealInterval;
use num_complex::Complex64;

use super::arc::{
    self, NEAR, NUDGE, Solved, TURN, UnderdeterminedSystem, cosine, distance, tangent,
};
use super::threshold::{BifurcationKind, confirmed, test};
use super::{Image, PeriodMap, multipliers};
use crate::matrix::Matrix;

/// Settings for tracing a curve: the windows of the two parameters and the step lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trace {
    /// Window of the first parameter.
    pub first: RealInterval,
    /// Window of the second parameter.
    pub second: RealInterval,
    /// Longest step in scaled coordinates, in which both windows have width 1.
    pub longest: f64,
    /// Shortest step; below it the curve counts as lost.
    pub shortest: f64,
    /// Maximum number of points on each side of the first one.
    pub most_points: u32,
}

impl Trace {
    /// Settings for two windows with at least `steps` points across each of them.
    pub fn windows(first: RealInterval, second: RealInterval, steps: u32) -> Self {
        let longest = 1.0 / f64::from(steps.max(1));
        Self { first, second, longest, shortest: 1e-7, most_points: 2000 }
    }
}

/// A point of a curve.
#[derive(Clone, Debug)]
pub struct BifurcationCurvePoint {
    /// The fixed point.
    pub state: Vec<f64>,
    /// The two parameters.
    pub parameters: [f64; 2],
    /// Multipliers, the largest modulus first; at grazing, those of the piece inside the border.
    pub multipliers: Vec<Complex64>,
    /// Largest mismatch of the equations, scaled.
    pub residual: f64,
}

/// End of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurveEnd {
    /// At the border of a window.
    Window,
    /// At its start: the curve is closed.
    Closed,
    /// The orbit grazes the border of its signature.
    Grazing,
    /// The pair of multipliers becomes real: a resonance 1 : 1 or 1 : 2.
    Resonance,
    /// The steps became too short.
    Lost,
    /// After the maximum number of points.
    TooLong,
}

/// A curve, from one of its ends to the other.
#[derive(Clone, Debug)]
pub struct BifurcationCurve {
    /// Kind of the bifurcation.
    pub kind: BifurcationKind,
    /// Points in order.
    pub points: Vec<BifurcationCurvePoint>,
    /// Ends before the first and after the last point.
    pub ends: [CurveEnd; 2],
}

/// The equations of a threshold in scaled unknowns.
struct Equations<'a, F: PeriodMap> {
    family: &'a F,
    trace: Trace,
    kind: BifurcationKind,
    held: &'a F::Signature,
}

impl<F: PeriodMap> Equations<'_, F> {
    fn unscaled(&self, unknowns: &[f64]) -> (Vec<f64>, [f64; 2]) {
        let n = unknowns.len() - 2;
        let state = unknowns[..n].iter().map(|x| x * self.family.scale()).collect();
        let Trace { first, second, .. } = self.trace;
        (state, [first.at(unknowns[n]), second.at(unknowns[n + 1])])
    }

    /// The test function at an image; a distance is scaled as a length.
    fn test(&self, image: &Image<F::Signature>) -> f64 {
        let value = test(self.kind, image).unwrap_or(f64::NAN);
        if self.kind == BifurcationKind::Grazing { value / self.family.scale() } else { value }
    }
}

impl<F: PeriodMap> UnderdeterminedSystem for Equations<'_, F> {
    type Known = Image<F::Signature>;
    type Error = F::Error;

    fn mismatch(&self, unknowns: &[f64]) -> Result<(Vec<f64>, Self::Known), F::Error> {
        let (state, parameters) = self.unscaled(unknowns);
        let image = self.family.image(&state, &parameters, Some(self.held))?;
        let scale = self.family.scale();
        let mismatch = image.state.iter().zip(&state).map(|(to, from)| (to - from) / scale);
        Ok((mismatch.chain([self.test(&image)]).collect(), image))
    }

    fn derivative(
        &self,
        unknowns: &[f64],
        image: &Self::Known,
        before: Option<&Matrix>,
        _: &[f64],
    ) -> Result<Matrix, F::Error> {
        let n = self.family.dimension();
        let mut derivative = if let Some(before) = before {
            before.clone()
        } else {
            let here = self.test(image);
            let mut fresh = Matrix::zeros(n + 1, n + 2);
            for column in 0..n + 2 {
                let inwards = column >= n && unknowns[column] + NUDGE > 1.0;
                let nudge = if inwards { -NUDGE } else { NUDGE };
                let mut moved = unknowns.to_vec();
                moved[column] += nudge;
                let (state, parameters) = self.unscaled(&moved);
                let other = self.family.image(&state, &parameters, Some(self.held))?;
                fresh[(n, column)] = (self.test(&other) - here) / nudge;
                for row in 0..n {
                    let change = other.state[row] - image.state[row];
                    fresh[(row, column)] = change / (self.family.scale() * nudge);
                }
            }
            fresh
        };
        for i in 0..n {
            for j in 0..n {
                derivative[(i, j)] = image.derivative[(i, j)] - if i == j { 1.0 } else { 0.0 };
            }
        }
        Ok(derivative)
    }
}

/// A solution on the curve with the data that the trace needs.
#[derive(Clone)]
struct CurveSolution<S> {
    unknowns: Vec<f64>,
    tangent: Vec<f64>,
    image: Image<S>,
    residual: f64,
    multipliers: Vec<Complex64>,
}

impl<S> CurveSolution<S> {
    fn with_tangent(&self) -> (&[f64], &[f64]) {
        (&self.unknowns, &self.tangent)
    }
}

/// The length at which a step first leaves a window, with the coordinate and the end through which it leaves.
fn leaves<S>(here: &CurveSolution<S>, length: f64) -> Option<(f64, usize, f64)> {
    let n = here.unknowns.len() - 2;
    (n..n + 2)
        .filter_map(|column| {
            let (at, speed) = (here.unknowns[column], here.tangent[column]);
            let end = if speed > 0.0 { 1.0 } else { 0.0 };
            let until = (end - at) / speed;
            (speed != 0.0 && until <= length).then_some((until, column, end))
        })
        .min_by(|a, b| a.0.total_cmp(&b.0))
}

impl<F: PeriodMap> Equations<'_, F> {
    fn at(&self, predicted: &[f64], normal: &[f64]) -> Option<CurveSolution<F::Signature>> {
        let solved = arc::corrected(self, predicted, normal, None)?;
        let Solved { unknowns, residual, known, derivative } = solved;
        let multipliers = multipliers(&known.derivative)?;
        let tangent = tangent(&derivative, normal)?;
        Some(CurveSolution { unknowns, tangent, image: known, residual, multipliers })
    }

    fn point(&self, solution: &CurveSolution<F::Signature>) -> BifurcationCurvePoint {
        let (state, parameters) = self.unscaled(&solution.unknowns);
        let multipliers = solution.multipliers.clone();
        BifurcationCurvePoint { state, parameters, multipliers, residual: solution.residual }
    }

    /// One step; `Err(None)` if it fails at this length, `Err(Some)` if the curve ends there.
    fn step(
        &self,
        here: &CurveSolution<F::Signature>,
        length: f64,
    ) -> Result<(CurveSolution<F::Signature>, bool), Option<CurveEnd>> {
        let leaving = leaves(here, length);
        let mut normal = here.tangent.clone();
        let step_length = leaving.map_or(length, |(until, ..)| until.max(0.0));
        let mut predicted: Vec<f64> =
            here.unknowns.iter().zip(&here.tangent).map(|(u, t)| u + step_length * t).collect();
        if let Some((_, column, end)) = leaving {
            predicted[column] = end;
            normal = vec![0.0; normal.len()];
            normal[column] = here.tangent[column].signum();
        }
        let mut next = self.at(&predicted, &normal).ok_or(None)?;
        if let Some((_, column, end)) = leaving {
            next.unknowns[column] = end;
        }
        if distance(&next.unknowns, &predicted) > NEAR * step_length.max(1e-7)
            || cosine(&next.tangent, &here.tangent) < TURN
        {
            return Err(None);
        }
        if next.image.signature != *self.held
            || (self.kind != BifurcationKind::Grazing && next.image.distance <= 0.0)
        {
            return Err(Some(CurveEnd::Grazing));
        }
        if !confirmed(self.kind, &next.multipliers) {
            return Err(Some(CurveEnd::Resonance));
        }
        let n = next.unknowns.len() - 2;
        let outside = |share: &f64| !(-1e-12..=1.0 + 1e-12).contains(share);
        if next.unknowns[n..].iter().any(outside) {
            return Err(None);
        }
        Ok((next, leaving.is_some()))
    }

    /// The curve from a solution in the direction of its tangent.
    fn side(&self, begin: &CurveSolution<F::Signature>) -> (Vec<BifurcationCurvePoint>, CurveEnd) {
        let mut here = begin.clone();
        let mut points = Vec::new();
        let mut length = self.trace.longest;
        loop {
            if points.len() >= self.trace.most_points as usize {
                return (points, CurveEnd::TooLong);
            }
            match self.step(&here, length) {
                Ok((next, leaves)) => {
                    points.push(self.point(&next));
                    if leaves {
                        return (points, CurveEnd::Window);
                    }
                    let step_length = distance(&next.unknowns, &here.unknowns);
                    let deviation = 1.0 - cosine(&next.tangent, &here.tangent);
                    if deviation < 3e-3 {
                        length = (2.0 * step_length).min(self.trace.longest);
                    }
                    here = next;
                    let (now, first) = (here.with_tangent(), begin.with_tangent());
                    if arc::closes(points.len(), step_length, now, first) {
                        return (points, CurveEnd::Closed);
                    }
                }
                Err(_) if length > self.trace.shortest => length *= 0.4,
                Err(end) => return (points, end.unwrap_or(CurveEnd::Lost)),
            }
        }
    }
}

/// The curve of a bifurcation through a fixed point with this bifurcation, on the piece of `signature`, in both directions
/// to the borders of the windows. The state and both parameters are unscaled, in the order of the windows of [`Trace`]; they
/// are the initial guess of Newton's method. `None` if no point of the curve is found from there.
pub fn trace<F: PeriodMap>(
    family: &F,
    kind: BifurcationKind,
    signature: &F::Signature,
    state: &[f64],
    parameters: [f64; 2],
    options: Trace,
) -> Option<BifurcationCurve> {
    let equations = Equations { family, trace: options, kind, held: signature };
    let mut unknowns: Vec<f64> = state.iter().map(|x| x / family.scale()).collect();
    unknowns.push(options.first.share_of(parameters[0]));
    unknowns.push(options.second.share_of(parameters[1]));
    let n = state.len();
    // The first point is computed at a fixed second parameter or, if that fails, at a fixed first parameter.
    let met = (0..2).find_map(|offset| {
        let mut normal = vec![0.0; n + 2];
        normal[n + 1 - offset] = 1.0;
        equations.at(&unknowns, &normal)
    })?;
    let back = CurveSolution { tangent: met.tangent.iter().map(|x| -x).collect(), ..met.clone() };
    let (forward, end) = equations.side(&met);
    let (backward, begin) = if end == CurveEnd::Closed {
        (Vec::new(), CurveEnd::Closed)
    } else {
        equations.side(&back)
    };
    let mut points: Vec<BifurcationCurvePoint> = backward.into_iter().rev().collect();
    points.push(equations.point(&met));
    points.extend(forward);
    Some(BifurcationCurve { kind, points, ends: [begin, end] })
}
