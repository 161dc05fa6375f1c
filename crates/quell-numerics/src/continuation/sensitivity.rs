//! Derivatives of a threshold with respect to the other parameters of its map.
//!
//! At a threshold the state x and the parameter a solve φ(x; a, p) = x and g(x; a, p) = 0, where g is the test function of the
//! bifurcation: the distance from the border at a grazing, λ − 1 at a fold, λ + 1 at a flip, |λ|² − 1 at a Neimark–Sacker bifurcation,
//! with λ the critical multiplier. Where k thresholds meet, k parameters and k test functions take part. By the implicit function
//! theorem the bordered system
//!
//! ```text
//! ( φ_x − 1   φ_a ) ( dx/dp )     ( φ_p )
//! (   g_x     g_a ) ( da/dp ) = − ( g_p )
//! ```
//!
//! gives da/dp. It stays regular at a fold, where φ_x − 1 is singular (H. B. Keller, *Lectures on Numerical Methods in Bifurcation
//! Problems*, 1987). φ_x comes from the variational equation. The other entries are central differences of φ and g at fixed state and
//! parameters, extrapolated to step zero with an estimate of their error: derivatives of the equations, to 10⁻¹⁰ where they are smooth.
//! No threshold is located twice, so that neither its tolerance nor a change of branch enters.

use std::fmt;

use num_complex::Complex64;

use super::shooting::largest;
use super::threshold::BifurcationKind;
use super::{Image, PeriodMap, multipliers};
use crate::matrix::Matrix;
use crate::polar::modulus;

/// First step of the differences over the typical size of what is moved.
const FIRST_STEP: f64 = 2e-3;

/// Steps of one difference at most, each half the one before.
const LEVELS: usize = 12;

/// Relative error of slopes at which no smaller step is tried, and up to which they are accepted.
const ACCURATE: f64 = 1e-10;
const ACCEPTED: f64 = 1e-5;

/// Part of the largest slope relative to which the errors of smaller ones count.
const SMALL: f64 = 1e-4;

/// Times that the first step is divided by four where a state next to the threshold has other events.
const RETREATS: usize = 4;

/// Distance of a multiplier from the unit circle up to which it is that of the threshold.
const CRITICAL: f64 = 1e-3;

/// Corrections of the threshold itself, and the size of the last one, relative to typical values.
const CORRECTIONS: (usize, f64) = (12, 1e-9);

/// Change of the threshold from which on the derivatives are computed again at the corrected point.
const MOVED: f64 = 1e-8;

/// Largest correction, relative to typical values: a threshold that moves further is another one.
const FARTHEST: f64 = 1e-2;

/// Why a threshold has no derivatives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoSensitivity {
    /// The threshold is not that of a multiplier or of one distance.
    OtherKind,
    /// States next to the threshold have no image or meet other events, however near.
    OtherEvents,
    /// No multiplier is on the unit circle.
    NotCritical,
    /// The bordered system is singular: the threshold moves infinitely fast, or two branches cross there.
    Singular,
    /// Newton's method did not return to the threshold.
    NotConverged,
    /// The equations have no slope there: differences with smaller and smaller steps do not agree.
    NotSmooth,
}

impl fmt::Display for NoSensitivity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::OtherKind => "the threshold has no single smooth test function",
            Self::OtherEvents => {
                "states next to the threshold have no response or meet other events"
            }
            Self::NotCritical => "no multiplier is on the unit circle",
            Self::Singular => "the equations of the threshold are singular",
            Self::NotSmooth => "the equations of the threshold have no slope there",
            Self::NotConverged => "Newton's method did not return to the threshold",
        })
    }
}

impl std::error::Error for NoSensitivity {}

/// A threshold whose derivatives are computed, or a point where several thresholds meet.
#[derive(Debug)]
pub struct ThresholdPoint<'a, S> {
    /// The thresholds that meet: one test function each.
    pub kinds: &'a [BifurcationKind],
    /// The events on its piece.
    pub held: &'a S,
    /// The fixed point.
    pub state: &'a [f64],
    /// The parameters: first those that the threshold determines, one for each kind, then those by which it is differentiated.
    pub parameters: &'a [f64],
    /// Typical sizes of the parameters, above zero.
    pub sizes: &'a [f64],
}

/// The derivatives of a threshold.
#[derive(Clone, Debug, PartialEq)]
pub struct ThresholdSensitivity {
    /// The fixed point at the threshold.
    pub state: Vec<f64>,
    /// The parameters that the threshold determines, corrected by Newton's method.
    pub determined: Vec<f64>,
    /// For each further parameter, the derivatives of the determined ones.
    pub derivatives: Vec<Result<Vec<f64>, NoSensitivity>>,
}

/// The equations of a threshold.
struct ThresholdEquations<'a, F: PeriodMap> {
    family: &'a F,
    point: &'a ThresholdPoint<'a, F::Signature>,
    /// The multiplier of each test function; `None` for a distance.
    critical: Vec<Option<Complex64>>,
}

/// The derivatives of a threshold with respect to the parameters that it does not determine.
///
/// # Errors
/// [`NoSensitivity`] where the threshold itself has no regular equations; of a single parameter in
/// [`ThresholdSensitivity::derivatives`].
pub fn threshold_sensitivity<F: PeriodMap>(
    family: &F,
    point: &ThresholdPoint<'_, F::Signature>,
) -> Result<ThresholdSensitivity, NoSensitivity> {
    let (n, k) = (point.state.len(), point.kinds.len());
    let mut unknowns: Vec<f64> = point.state.to_vec();
    unknowns.extend(&point.parameters[..k]);
    let image = image_at(family, point, &unknowns, &point.parameters[k..])?;
    let critical =
        point.kinds.iter().map(|kind| critical(*kind, &image)).collect::<Result<_, _>>()?;
    let equations = ThresholdEquations { family, point, critical };
    let mut bordered = equations.bordered(&unknowns)?;
    if equations.corrected(&mut unknowns, &bordered)? > MOVED {
        bordered = equations.bordered(&unknowns)?;
    }
    let derivative = |place: usize| -> Result<Vec<f64>, NoSensitivity> {
        let moved = |step: f64| {
            let mut others = point.parameters[k..].to_vec();
            others[place - k] += step;
            equations.values(&unknowns, &others)
        };
        let column = difference(FIRST_STEP * point.sizes[place], moved)?;
        let right = Matrix::from_fn(n + k, 1, |i, _| -column[i]);
        let solved = bordered.solve(&right).ok_or(NoSensitivity::Singular)?;
        let rates: Vec<f64> = (n..n + k).map(|row| solved[(row, 0)]).collect();
        let finite = rates.iter().all(|rate| rate.is_finite());
        finite.then_some(rates).ok_or(NoSensitivity::Singular)
    };
    let derivatives = (k..point.parameters.len()).map(derivative).collect();
    let determined = unknowns.split_off(n);
    Ok(ThresholdSensitivity { state: unknowns, determined, derivatives })
}

/// The image on the piece of a threshold.
fn image_at<F: PeriodMap>(
    family: &F,
    point: &ThresholdPoint<'_, F::Signature>,
    unknowns: &[f64],
    others: &[f64],
) -> Result<Image<F::Signature>, NoSensitivity> {
    let (state, determined) = unknowns.split_at(point.state.len());
    let parameters = [determined, others].concat();
    let image = family.image(state, &parameters, Some(point.held));
    let image = image.map_err(|_| NoSensitivity::OtherEvents)?;
    if image.signature == *point.held { Ok(image) } else { Err(NoSensitivity::OtherEvents) }
}

/// The multiplier on the unit circle; `None` of a threshold that is a distance.
fn critical<S>(
    kind: BifurcationKind,
    image: &Image<S>,
) -> Result<Option<Complex64>, NoSensitivity> {
    let distance = |z: &Complex64| match kind {
        BifurcationKind::Fold => modulus(*z - 1.0),
        BifurcationKind::Flip => modulus(*z + 1.0),
        _ if z.im > 0.0 => (modulus(*z) - 1.0).abs(),
        _ => f64::INFINITY,
    };
    match kind {
        BifurcationKind::Grazing => return Ok(None),
        BifurcationKind::Branching | BifurcationKind::Border => {
            return Err(NoSensitivity::OtherKind);
        }
        BifurcationKind::Fold | BifurcationKind::Flip | BifurcationKind::NeimarkSacker => {}
    }
    let found = multipliers(&image.derivative).ok_or(NoSensitivity::NotCritical)?;
    let nearest = found.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
    let nearest = nearest.filter(|z| distance(z) < CRITICAL).ok_or(NoSensitivity::NotCritical)?;
    Ok(Some(*nearest))
}

impl<F: PeriodMap> ThresholdEquations<'_, F> {
    /// The mismatch of the fixed point and the test functions.
    fn values(&self, unknowns: &[f64], others: &[f64]) -> Result<Vec<f64>, NoSensitivity> {
        let image = image_at(self.family, self.point, unknowns, others)?;
        let mut values: Vec<f64> =
            image.state.iter().zip(unknowns).map(|(to, from)| to - from).collect();
        let found = multipliers(&image.derivative).ok_or(NoSensitivity::NotCritical)?;
        for (kind, critical) in self.point.kinds.iter().zip(&self.critical) {
            let Some(critical) = critical else {
                values.push(image.distance);
                continue;
            };
            let distance = |z: &Complex64| modulus(*z - critical);
            let nearest = found.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
            let nearest = nearest.ok_or(NoSensitivity::NotCritical)?;
            values.push(match kind {
                BifurcationKind::Flip => nearest.re + 1.0,
                BifurcationKind::NeimarkSacker => nearest.norm_sqr() - 1.0,
                _ => nearest.re - 1.0,
            });
        }
        if values.iter().all(|value| value.is_finite()) {
            Ok(values)
        } else {
            Err(NoSensitivity::OtherEvents)
        }
    }

    /// The bordered matrix at a threshold.
    fn bordered(&self, unknowns: &[f64]) -> Result<Matrix, NoSensitivity> {
        let (n, k) = (self.point.state.len(), self.point.kinds.len());
        let others = &self.point.parameters[k..];
        let image = image_at(self.family, self.point, unknowns, others)?;
        let mut bordered = Matrix::zeros(n + k, n + k);
        for column in 0..n + k {
            let moved = |step: f64| {
                let mut moved = unknowns.to_vec();
                moved[column] += step;
                self.values(&moved, others)
            };
            let rates = difference(FIRST_STEP * self.size(column), moved)?;
            for (row, rate) in rates.into_iter().enumerate() {
                bordered[(row, column)] = if row < n && column < n {
                    image.derivative[(row, column)] - if row == column { 1.0 } else { 0.0 }
                } else {
                    rate
                };
            }
        }
        Ok(bordered)
    }

    fn size(&self, column: usize) -> f64 {
        let n = self.point.state.len();
        if column < n { self.family.scale() } else { self.point.sizes[column - n] }
    }

    /// Moves the unknowns to the threshold by Newton's method with a constant derivative, and returns how far they moved relative to
    /// their sizes.
    fn corrected(&self, unknowns: &mut [f64], bordered: &Matrix) -> Result<f64, NoSensitivity> {
        let others = &self.point.parameters[self.point.kinds.len()..];
        let mut moved = vec![0.0; unknowns.len()];
        for _ in 0..CORRECTIONS.0 {
            let values = self.values(unknowns, others)?;
            let right = Matrix::from_fn(values.len(), 1, |i, _| -values[i]);
            let step = bordered.solve(&right).ok_or(NoSensitivity::Singular)?;
            let mut relative = Vec::new();
            for (place, unknown) in unknowns.iter_mut().enumerate() {
                *unknown += step[(place, 0)];
                relative.push(step[(place, 0)] / self.size(place));
                moved[place] += step[(place, 0)] / self.size(place);
            }
            let total = largest(&moved);
            if !relative.iter().all(|change| change.is_finite()) || total > FARTHEST {
                return Err(NoSensitivity::NotConverged);
            }
            if largest(&relative) < CORRECTIONS.1 {
                return Ok(total);
            }
        }
        Err(NoSensitivity::NotConverged)
    }
}

/// The derivative at zero of a function of a step, by central differences extrapolated to step zero. A step that meets other events is
/// made smaller.
fn difference(
    first: f64,
    values: impl Fn(f64) -> Result<Vec<f64>, NoSensitivity>,
) -> Result<Vec<f64>, NoSensitivity> {
    let mut step = first;
    let mut last = NoSensitivity::OtherEvents;
    for _ in 0..=RETREATS {
        match extrapolated_difference(step, &values) {
            Ok(rates) => return Ok(rates),
            Err(why) => last = why,
        }
        step *= 0.25;
    }
    Err(last)
}

/// A slope with an estimate of its error.
#[derive(Clone, Copy)]
struct Slope {
    value: f64,
    error: f64,
}

/// The slopes at zero, each from the steps between truncation and rounding (C. J. F. Ridders, *Accurate computation of F'(x) and
/// F'(x)F''(x)*, 1982): steps are halved until no slope improves. How small a step must be depends on how near the border of the piece,
/// or another scale of the motion, is.
fn extrapolated_difference(
    first: f64,
    values: &impl Fn(f64) -> Result<Vec<f64>, NoSensitivity>,
) -> Result<Vec<f64>, NoSensitivity> {
    let mut step = first;
    let mut before: Vec<Vec<f64>> = Vec::new();
    let mut best: Vec<Slope> = Vec::new();
    for _ in 0..LEVELS {
        let (after, behind) = (values(step)?, values(-step)?);
        let slope: Vec<f64> =
            after.iter().zip(&behind).map(|(a, b)| (a - b) / (2.0 * step)).collect();
        if best.is_empty() {
            best =
                slope.iter().map(|value| Slope { value: *value, error: f64::INFINITY }).collect();
        }
        let mut row: Vec<Vec<f64>> = vec![slope];
        let mut power = 1.0;
        for (k, coarser) in before.iter().enumerate() {
            power *= 4.0;
            let finer = row[k].iter().zip(coarser);
            let next: Vec<f64> =
                finer.map(|(fine, coarse)| fine + (fine - coarse) / (power - 1.0)).collect();
            for (place, value) in next.iter().enumerate() {
                let error = (value - row[k][place]).abs().max((value - coarser[place]).abs());
                if error < best[place].error {
                    best[place] = Slope { value: *value, error };
                }
            }
            row.push(next);
        }
        before = row;
        step *= 0.5;
        if !before[1..].is_empty() && worst(&best) < ACCURATE {
            break;
        }
    }
    let accepted = worst(&best) < ACCEPTED;
    accepted.then(|| best.iter().map(|slope| slope.value).collect()).ok_or(NoSensitivity::NotSmooth)
}

/// The largest error of slopes, each relative to itself or to a part of the largest one.
fn worst(slopes: &[Slope]) -> f64 {
    let largest = slopes.iter().map(|slope| slope.value.abs()).fold(0.0, f64::max);
    let relative = |slope: &Slope| {
        let size = slope.value.abs().max(SMALL * largest);
        if size == 0.0 { 0.0 } else { slope.error / size }
    };
    slopes.iter().map(relative).fold(0.0, f64::max)
}
