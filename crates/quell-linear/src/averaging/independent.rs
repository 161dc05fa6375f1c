//! Dithers of incommensurate frequencies, and noise: nested means over independent phases.
//!
//! μ̄(v) = ⟨…⟨μ(v − s₁ − s₂ − s₃)(1 + ν₁ + ν₂ + ν₃)⟩₁…⟩₃. The innermost group is noise, or one with a closed form, if there is any. Each
//! outer mean is a quadrature over the phase of its group, split where s is extremal and where the argument of the inner mean is
//! at one of its corners. Inside a corner the inner slope grows like an inverse square root; each interval is therefore mapped by
//! θ = a + (b − a)t²(3 − 2t), which makes such endpoints smooth.
//!
//! Cost: about 10² evaluations per level, hence the limit of [`MAX_GROUPS`] groups. Accuracy: 10⁻¹¹ (two groups) and 10⁻⁸ (three
//! groups) in units of μ_s and μ_s/v_m. Where |v| is a sum or difference of the groups' peaks the slope itself has a logarithmic
//! peak.

use core::f64::consts::TAU;
use quell_model::Friction;
use quell_numerics::order::{ascending, ascending_by};
use quell_numerics::quadrature::{QuadratureError, QuadratureOptions, integrate};

use super::effective::{Effective, SlopeSide};
use super::error::AveragingError;
use super::periodic::{Signal, mean};
use super::periodic_motion::PeriodicMotion;
use super::wave::FastWave;
use super::{gaussian, single_wave};

/// Largest number of incommensurate groups.
pub const MAX_GROUPS: usize = 3;

/// Relative noise of a slope that was integrated across corners of the inner mean, where rounding of the argument
/// is amplified. Measured over the grid of the tests: 5·10⁻¹².
const CORNER_NOISE: f64 = 1e-11;

/// Accuracy required of a mean over a closed form, in units of the law.
const INNER_CLOSENESS: f64 = 1e-12;

/// Largest number of evaluations per interval. An ordinary interval takes 21 to 400; only one with a corner within rounding of
/// its end takes more.
const EVALUATIONS: usize = 1500;

/// One level of the nested mean: a closed form, or a signal to integrate over.
enum NestedLevel<'a> {
    Closed {
        wave: FastWave,
        amplitude: f64,
    },
    /// A Gaussian velocity of a standard deviation: its mean is smooth.
    Gaussian(f64),
    Sampled(Signal<'a>),
}

impl NestedLevel<'_> {
    fn extrema(&self) -> Vec<f64> {
        match self {
            Self::Closed { wave, amplitude } => {
                let peak = amplitude.abs() * wave.peak();
                vec![-peak, peak]
            }
            Self::Gaussian(_) => Vec::new(),
            Self::Sampled(signal) => signal.extrema(),
        }
    }
}

/// Effective friction at slow slip velocity `v` under several independent groups, and noise of a standard deviation.
pub(super) fn effective(
    law: &Friction,
    (groups, noise): (&[PeriodicMotion], f64),
    v: f64,
) -> Result<Effective, AveragingError> {
    let count = groups.len() + usize::from(noise > 0.0);
    if count > MAX_GROUPS {
        return Err(AveragingError::TooManyGroups { groups: count, largest: MAX_GROUPS });
    }
    let mut order: Vec<&PeriodicMotion> = groups.iter().collect();
    // The closed form is innermost, that is, last. Of several, the largest one, so that the quadrature handles the smaller
    // motion.
    let reach = |group: &PeriodicMotion| {
        group.single_term().map_or(-1.0, |(wave, amplitude)| amplitude.abs() * wave.peak())
    };
    ascending_by(&mut order, |a| reach(a));
    let mut levels = Vec::new();
    for (depth, group) in order.iter().enumerate() {
        levels.push(match group.single_term() {
            Some((wave, amplitude)) if depth + 1 == order.len() && noise == 0.0 => {
                NestedLevel::Closed { wave: wave.clone(), amplitude }
            }
            _ => NestedLevel::Sampled(Signal::new(group)?),
        });
    }
    if noise > 0.0 {
        levels.push(NestedLevel::Gaussian(noise));
    }
    let corners = corner_sums(&levels);
    let context = NestedMean { law, levels: &levels, corners: &corners };
    let value = context.integral(0, 1.0, v, AveragedQuantity::Coefficient)?;
    let slope = context.integral(0, 1.0, v, AveragedQuantity::Slope)?;
    let outermost = corners[0].iter().map(|corner| corner.abs()).reduce(f64::max);
    Ok(Effective {
        coefficient: value.0,
        coefficient_error: value.1 + INNER_CLOSENESS * law.static_coefficient(),
        slope: slope.0,
        slope_error: slope.1 + CORNER_NOISE * slope.0.abs(),
        // Convolution with a second wave smooths the corner, but the slope stays one-sided at its outer edge.
        side: if Some(v.abs()) == outermost { SlopeSide::Outer } else { SlopeSide::Both },
    })
}

/// For each level, the corners of the mean over that level and all inner levels: sums of extrema.
fn corner_sums(levels: &[NestedLevel<'_>]) -> Vec<Vec<f64>> {
    let mut corners = vec![Vec::new(); levels.len()];
    let mut inner = vec![0.0];
    for (depth, level) in levels.iter().enumerate().rev() {
        let mut sums: Vec<f64> = Vec::new();
        for extremum in level.extrema() {
            sums.extend(inner.iter().map(|c| c + extremum));
        }
        ascending(&mut sums);
        sums.dedup();
        corners[depth].clone_from(&sums);
        inner = sums;
    }
    corners
}

#[derive(Clone, Copy, PartialEq)]
enum AveragedQuantity {
    Coefficient,
    Slope,
}

struct NestedMean<'a> {
    law: &'a Friction,
    levels: &'a [NestedLevel<'a>],
    corners: &'a [Vec<f64>],
}

impl NestedMean<'_> {
    /// Mean over the levels from `depth` inwards with the weight base + Σν, and its error bound.
    fn integral(
        &self,
        depth: usize,
        base: f64,
        v: f64,
        quantity: AveragedQuantity,
    ) -> Result<(f64, f64), AveragingError> {
        if depth + 1 == self.levels.len() {
            return self.innermost(base, v, quantity);
        }
        let NestedLevel::Sampled(signal) = &self.levels[depth] else {
            // Only the innermost level has a closed form. If another had one, its mean would still be correct.
            return self.innermost(base, v, quantity);
        };
        let mut cuts: Vec<f64> = signal.edges().collect();
        for corner in &self.corners[depth + 1] {
            cuts.extend(signal.crossings(v - corner));
        }
        ascending(&mut cuts);
        cuts.dedup_by(|a, b| (*a - *b).abs() < 1e-14);
        let scale = match quantity {
            AveragedQuantity::Coefficient => self.law.static_coefficient(),
            AveragedQuantity::Slope => self.law.static_coefficient() / self.law.velocity_scale(),
        };
        let inside = self.levels.len() - depth - 1;
        let closeness = if inside == 1 { INNER_CLOSENESS } else { 1e-9 };
        let intervals = (cuts.len() - 1) as f64;
        let options = QuadratureOptions {
            relative: closeness,
            absolute: closeness * scale * TAU / intervals,
            evaluations: EVALUATIONS,
            ..QuadratureOptions::default()
        };
        let mut failure = None;
        let (mut total, mut error, mut inner_error) = (0.0, 0.0, 0.0_f64);
        for pair in cuts.windows(2) {
            let (from, length) = (pair[0], pair[1] - pair[0]);
            let integrand = |t: f64| {
                let theta = from + length * t * t * (3.0 - 2.0 * t);
                let weight = length * 6.0 * t * (1.0 - t);
                let (s, _) = signal.value_and_slope(theta);
                match self.integral(depth + 1, base + signal.load(theta), v - s, quantity) {
                    Ok((value, error)) => {
                        inner_error = inner_error.max(error * weight);
                        value * weight
                    }
                    Err(error) => {
                        failure.get_or_insert(error);
                        0.0
                    }
                }
            };
            let part = match integrate(integrand, 0.0, 1.0, &[], &options) {
                Ok(part) => part,
                // Noise of the inner mean near a corner: keep the value with its error.
                Err(QuadratureError::Rounding { best } | QuadratureError::Evaluations { best }) => {
                    best
                }
                Err(error) => return Err(error.into()),
            };
            if let Some(error) = failure.take() {
                return Err(error);
            }
            total += part.value;
            error += part.error;
        }
        Ok((total / TAU, error / TAU + inner_error))
    }

    fn innermost(
        &self,
        base: f64,
        v: f64,
        quantity: AveragedQuantity,
    ) -> Result<(f64, f64), AveragingError> {
        let scaled = |mut e: Effective| {
            e.coefficient *= base;
            e.slope *= base;
            e.coefficient_error *= base.abs();
            e.slope_error *= base.abs();
            e
        };
        let effective = match &self.levels[self.levels.len() - 1] {
            NestedLevel::Closed { wave, amplitude } => {
                scaled(single_wave::effective(self.law, wave, *amplitude, v)?)
            }
            NestedLevel::Gaussian(deviation) => {
                scaled(gaussian::effective(self.law, *deviation, v)?)
            }
            NestedLevel::Sampled(signal) => mean(self.law, signal, base, v)?,
        };
        Ok(match quantity {
            AveragedQuantity::Coefficient => (effective.coefficient, effective.coefficient_error),
            AveragedQuantity::Slope => (effective.slope, effective.slope_error),
        })
    }
}
