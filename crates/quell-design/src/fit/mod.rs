//! Friction laws fitted to measured coefficients by least squares, with what the measurement cannot determine.
//!
//! Minimises RSS = Σ [(cᵢ − μ(|vᵢ|))/σᵢ]² over the free parameters of a law within their bounds; σᵢ = 1 if no standard deviation is
//! given. Every law is linear in its coefficients, so that these are eliminated exactly (variable projection: Golub and Pereyra
//! 1973, with the step of Kaufman 1975), and a global search remains over the reference velocity and the exponent alone.
//! Covariance: s²(JᵀJ)⁻¹ with s² = RSS/(n − p). The standard deviations σᵢ are relative weights: s² is their common scale.
//! AIC = n ln(RSS/n) + n(1 + ln 2π) + 2 Σ ln σᵢ + 2(p + 1) (Akaike 1974), with the variance as one further parameter.
//!
//! Assumptions: friction is equal in both directions of slip; errors of the coefficient are independent, and the slip velocity has
//! none. Limits: standard errors are linearised at the minimum; a parameter on a bound has none.

mod covariance;
mod diagnosis;
mod model;
mod point;
mod projection;
mod search;
mod statistics;

use std::fmt;

use quell_model::friction::{Friction, LawKind};
use quell_model::parameter::Parameter;

use crate::{ExactFit, NoStandardError};

pub use covariance::Covariance;
pub use diagnosis::{FitFinding, diagnose};
pub use model::{Estimate, FitModel};
pub use point::FitPoint;
use statistics::ROUNDING;
pub use statistics::{runs, student_quantile};

/// Why a law cannot be fitted.
#[derive(Clone, Debug, PartialEq)]
pub enum Unfitted {
    /// The number of points does not exceed the number of free parameters.
    TooFewPoints {
        /// Number of points n.
        points: usize,
        /// Number of free parameters p.
        parameters: usize,
    },
    /// All points have one slip speed.
    OneSpeed {
        /// This slip speed.
        speed: f64,
    },
    /// No parameter is free.
    NothingFree,
    /// No set of parameters within the bounds can be computed.
    Unsolvable,
}

impl fmt::Display for Unfitted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFewPoints { points, parameters } => write!(
                f,
                "{points} point{} for {parameters} free parameter{}: at least {} points are needed; fix parameters or measure more",
                if *points == 1 { "" } else { "s" },
                if *parameters == 1 { "" } else { "s" },
                parameters + 1
            ),
            Self::OneSpeed { speed } => write!(
                f,
                "all points have the slip speed {speed}: a law that depends on it needs at least two different speeds"
            ),
            Self::NothingFree => f.write_str("every parameter is fixed: nothing is left to fit"),
            Self::Unsolvable => {
                f.write_str("the numbers are too large or too small for a least-squares solution")
            }
        }
    }
}

/// A parameter of a fitted law.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedParameter {
    /// The parameter.
    pub parameter: Parameter,
    /// Its value.
    pub value: f64,
    /// Its standard error, or why it has none.
    pub standard_error: Result<f64, NoStandardError>,
}

impl FittedParameter {
    /// Whether the value was estimated.
    pub fn is_free(&self) -> bool {
        self.standard_error != Err(NoStandardError::Fixed)
    }
}

/// A law fitted to points.
#[derive(Clone, Debug, PartialEq)]
pub struct LawFit {
    /// The law.
    pub kind: LawKind,
    /// Its parameters in the order of the law, without those that steady sliding does not depend on and that are not given.
    pub parameters: Vec<FittedParameter>,
    /// Covariance of the parameters that have a standard error.
    pub covariance: Covariance,
    /// Σ [(c − μ)/σ]².
    pub rss: f64,
    /// Number of points n.
    pub points: usize,
    /// Number of free parameters p.
    pub free: usize,
    /// c − μ of each point.
    pub residuals: Vec<f64>,
    /// Largest |c|.
    largest: f64,
    /// Σ ln σ.
    log_deviations: f64,
    /// The law in steady sliding.
    curve: Friction,
    model: FitModel,
}

impl LawFit {
    /// The name of the law in a study.
    pub fn name(&self) -> &'static str {
        self.kind.name()
    }

    /// The residual standard deviation √(RSS/(n − p)), in units of σ if standard deviations are given.
    pub fn residual(&self) -> f64 {
        (self.rss / (self.points - self.free) as f64).sqrt()
    }

    /// Whether the law passes through every point, up to rounding.
    pub fn is_exact(&self) -> bool {
        let largest = self.largest * ROUNDING;
        self.residuals.iter().all(|residual| residual.abs() <= largest)
    }

    /// Akaike's information criterion.
    ///
    /// # Errors
    /// The law passes through every point, so that the criterion has no lower bound.
    pub fn aic(&self) -> Result<f64, ExactFit> {
        if self.is_exact() {
            return Err(ExactFit::Points);
        }
        let count = self.points as f64;
        let likelihood = count * libm::log(self.rss / count)
            + count * (1.0 + libm::log(std::f64::consts::TAU))
            + 2.0 * self.log_deviations;
        Ok(likelihood + 2.0 * (self.free + 1) as f64)
    }

    /// μ at a slip speed ≥ 0.
    pub fn coefficient(&self, speed: f64) -> f64 {
        self.curve.coefficient(speed)
    }

    /// dμ/d|v| at a slip speed ≥ 0.
    pub fn slope(&self, speed: f64) -> f64 {
        self.curve.slope(speed)
    }

    /// The largest slip speed for which the law is intended; `None` if it holds for all.
    pub fn upper_limit(&self) -> Option<f64> {
        self.curve.range().map(|range| range.upper)
    }

    /// The parameter with a path, if the law has it.
    pub fn parameter(&self, path: &str) -> Option<&FittedParameter> {
        self.parameters.iter().find(|fitted| fitted.parameter.path == path)
    }

    /// Standard deviation of μ at a slip speed > 0 by the delta method, √(gᵀCg) with g = ∂μ/∂p. Parameters without a standard error
    /// count as known.
    pub fn standard_deviation(&self, speed: f64) -> f64 {
        let gradient = self.model.gradient(&self.values(), &[speed]);
        let at = |estimated: &covariance::Estimated| {
            gradient[estimated.place][0] + estimated.tied.map_or(0.0, |tied| gradient[tied][0])
        };
        let estimated = &self.covariance.estimated;
        let mut variance = 0.0;
        for (row, i) in self.covariance.matrix.iter().zip(estimated) {
            for (entry, j) in row.iter().zip(estimated) {
                variance += entry * at(i) * at(j);
            }
        }
        variance.max(0.0).sqrt()
    }

    /// Values in the order of the law, with stand-ins for what steady sliding does not depend on.
    fn values(&self) -> Vec<f64> {
        self.curve.values()
    }
}

/// Fits a law to points.
///
/// # Errors
/// [`Unfitted`].
pub fn fit(model: &FitModel, points: &[FitPoint]) -> Result<LawFit, Unfitted> {
    let free = model.free().count();
    if free == 0 {
        return Err(Unfitted::NothingFree);
    }
    if points.len() <= free {
        return Err(Unfitted::TooFewPoints { points: points.len(), parameters: free });
    }
    let speed = points[0].speed();
    if free > 1 && points.iter().all(|point| point.speed() == speed) {
        return Err(Unfitted::OneSpeed { speed });
    }
    let samples = projection::FitSamples::of(points);
    let found = search::least(model, &samples).ok_or(Unfitted::Unsolvable)?;
    let curve = model.law(&found.values).ok_or(Unfitted::Unsolvable)?;
    let scale = found.rss / (points.len() - free) as f64;
    let (covariance, errors) = covariance::covariance(model, &samples, &found, scale);
    let parameters = model
        .kind()
        .parameters()
        .iter()
        .zip(model.estimates())
        .zip(found.values.iter().zip(errors))
        .filter(|((_, estimate), _)| **estimate != Estimate::Unused)
        .map(|((parameter, _), (&value, standard_error))| FittedParameter {
            parameter: *parameter,
            value,
            standard_error,
        })
        .collect();
    Ok(LawFit {
        kind: model.kind(),
        parameters,
        covariance,
        rss: found.rss,
        points: points.len(),
        free,
        largest: points.iter().map(|point| point.coefficient.abs()).fold(0.0, f64::max),
        residuals: points
            .iter()
            .map(|point| point.coefficient - curve.coefficient(point.speed()))
            .collect(),
        log_deviations: points.iter().map(|point| libm::log(point.standard_deviation)).sum(),
        curve,
        model: model.clone(),
    })
}

/// Akaike weights: the relative likelihoods exp(−(AIC − least)/2) of fits to the same points, normalised to a sum of 1.
pub fn akaike_weights(criteria: &[f64]) -> Vec<f64> {
    let least = criteria.iter().copied().fold(f64::INFINITY, f64::min);
    let shares: Vec<f64> =
        criteria.iter().map(|criterion| libm::exp(-0.5 * (criterion - least))).collect();
    let sum: f64 = shares.iter().sum();
    shares.iter().map(|share| share / sum).collect()
}
