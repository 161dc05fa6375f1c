//! What the measurements cannot determine, and where they contradict the law.

use quell_model::friction::LawKind;
use quell_model::parameter::{
    COEFFICIENT, MINIMUM_COEFFICIENT, REFERENCE_VELOCITY, STATIC_COEFFICIENT,
};
use quell_numerics::order::ascending_by;

use super::statistics::{ROUNDING, robust_deviation, runs};
use super::{FitPoint, LawFit};
use crate::NoStandardError;

/// Residuals above this multiple of the robust standard deviation are outliers.
const OUTLIER: f64 = 4.0;

/// Correlation of two estimates above which the data determine only a combination of them.
const CORRELATED: f64 = 0.99;

/// Condition of the scaled information matrix above which estimates lose half of their digits.
const ILL_CONDITIONED: f64 = 1e8;

/// The level at rest is interpolated if the slowest point is below this share of the reference velocity: the decreasing law falls
/// there by 1 − e^−½ = 39 % of its whole fall.
const SLOW: f64 = 0.5;

/// The level at high speed is interpolated if the fastest point is above this multiple of the reference velocity, where 1 − e⁻² =
/// 86 % of the fall is over.
const FAST: f64 = 2.0;

/// Deviation of the number of runs, and of the two directions, in standard deviations: by chance it occurs once in 370 fits.
const UNLIKELY: f64 = 3.0;

/// One thing to know about a fit.
#[derive(Clone, Debug, PartialEq)]
pub enum FitFinding {
    /// The standard error exceeds the value.
    Uncertain {
        /// Key of the parameter.
        key: &'static str,
        /// Its value.
        value: f64,
        /// Its standard error.
        error: f64,
    },
    /// A parameter is on a bound or not determined.
    WithoutError {
        /// Key of the parameter.
        key: &'static str,
        /// The reason.
        why: NoStandardError,
    },
    /// The law passes through every point: there is no scatter from which errors would follow.
    Exact,
    /// Two estimates are almost perfectly correlated.
    Correlated {
        /// Keys of the parameters.
        keys: [&'static str; 2],
        /// Their correlation.
        correlation: f64,
    },
    /// The information matrix is nearly singular.
    IllConditioned {
        /// Its condition with scaled columns.
        condition: f64,
    },
    /// No point is slow enough for the level at rest.
    NothingSlow {
        /// Slip speed of the slowest point.
        slowest: f64,
        /// The reference velocity.
        reference: f64,
        /// The largest slip speed that is slow enough.
        below: f64,
    },
    /// No point is fast enough for the level at high speed.
    NothingFast {
        /// Key of this level.
        key: &'static str,
        /// Slip speed of the fastest point.
        fastest: f64,
        /// The reference velocity.
        reference: f64,
        /// The least slip speed that is fast enough.
        above: f64,
    },
    /// Points are beyond the slip speeds for which the law is intended.
    BeyondRange {
        /// Number of such points.
        count: usize,
        /// The largest speed for which the law is intended.
        limit: f64,
    },
    /// Points whose residual exceeds four robust standard deviations.
    Outliers {
        /// Places of the points.
        places: Vec<usize>,
        /// The robust standard deviation, in units of σ if standard deviations are given.
        deviation: f64,
    },
    /// Residuals of neighbouring speeds have one sign too often: the law does not have the shape of the data.
    Pattern {
        /// Number of runs of equal sign.
        runs: usize,
        /// Number expected of independent errors.
        expected: f64,
    },
    /// Friction differs between the two directions of slip.
    Directions {
        /// Mean residual of forward slip less that of backward slip.
        difference: f64,
    },
}

/// The findings of a fit to these points, the most serious first.
pub fn diagnose(fit: &LawFit, points: &[FitPoint]) -> Vec<FitFinding> {
    let mut findings = errors(fit);
    // Given standard deviations are relative weights: without scatter errors are 0 with them too.
    findings.extend(fit.is_exact().then_some(FitFinding::Exact));
    findings.extend(extrapolations(fit, points));
    findings.extend(beyond_range(fit, points));
    findings.extend(residuals(fit, points));
    findings
}

fn errors(fit: &LawFit) -> Vec<FitFinding> {
    let mut findings = Vec::new();
    for fitted in &fit.parameters {
        let key = fitted.parameter.key();
        match fitted.standard_error {
            Ok(error) if error > fitted.value.abs() => {
                findings.push(FitFinding::Uncertain { key, value: fitted.value, error });
            }
            Err(why) if why.is_of_parameter() => {
                findings.push(FitFinding::WithoutError { key, why });
            }
            Ok(_) | Err(_) => {}
        }
    }
    let covariance = &fit.covariance;
    for i in 0..covariance.order.len() {
        for j in 0..i {
            let correlation = covariance.correlation(i, j);
            if correlation.abs() > CORRELATED {
                let keys = [covariance.order[j].key(), covariance.order[i].key()];
                findings.push(FitFinding::Correlated { keys, correlation });
            }
        }
    }
    let condition = covariance.condition.filter(|condition| *condition > ILL_CONDITIONED);
    findings.extend(condition.map(|condition| FitFinding::IllConditioned { condition }));
    findings
}

/// Levels that are determined only by the shape of the law.
fn extrapolations(fit: &LawFit, points: &[FitPoint]) -> Vec<FitFinding> {
    let mut findings = Vec::new();
    let free = |path: &str| fit.parameter(path).filter(|fitted| fitted.is_free());
    let Some(reference) = fit.parameter(REFERENCE_VELOCITY.path).map(|fitted| fitted.value) else {
        return findings;
    };
    let speeds = || points.iter().map(FitPoint::speed);
    let slowest = speeds().fold(f64::INFINITY, f64::min);
    let fastest = speeds().fold(0.0, f64::max);
    let below = SLOW * reference;
    if free(STATIC_COEFFICIENT.path).is_some() && slowest > below {
        findings.push(FitFinding::NothingSlow { slowest, reference, below });
    }
    // The cubic has its minimum at the reference velocity itself.
    let above = if fit.kind == LawKind::Stribeck { reference } else { FAST * reference };
    let level = free(MINIMUM_COEFFICIENT.path).or_else(|| free(COEFFICIENT.path));
    if let Some(level) = level.filter(|_| fastest < above) {
        let key = level.parameter.key();
        findings.push(FitFinding::NothingFast { key, fastest, reference, above });
    }
    findings
}

fn beyond_range(fit: &LawFit, points: &[FitPoint]) -> Option<FitFinding> {
    let limit = fit.upper_limit()?;
    let count = points.iter().filter(|point| point.speed() > limit).count();
    (count > 0).then_some(FitFinding::BeyondRange { count, limit })
}

fn residuals(fit: &LawFit, points: &[FitPoint]) -> Vec<FitFinding> {
    let mut findings = Vec::new();
    let scaled: Vec<f64> = fit
        .residuals
        .iter()
        .zip(points)
        .map(|(residual, point)| residual / point.standard_deviation)
        .collect();
    let deviation = robust_deviation(&scaled);
    // Residuals at rounding are no outliers of an exact fit.
    let rounding =
        ROUNDING * points.iter().map(|point| point.coefficient.abs()).fold(0.0, f64::max);
    let places: Vec<usize> = (0..scaled.len())
        .filter(|&place| {
            scaled[place].abs() > OUTLIER * deviation && fit.residuals[place].abs() > rounding
        })
        .collect();
    if !places.is_empty() {
        findings.push(FitFinding::Outliers { places, deviation });
    }
    let mut order: Vec<usize> = (0..points.len()).collect();
    ascending_by(&mut order, |a| points[*a].speed());
    let sorted: Vec<f64> = order.iter().map(|place| fit.residuals[*place]).collect();
    let exact = fit.is_exact();
    if let Some((runs, expected, score)) = runs(&sorted).filter(|_| !exact)
        && score < -UNLIKELY
    {
        findings.push(FitFinding::Pattern { runs, expected });
    }
    findings.extend(directions(fit, points).filter(|_| !exact));
    findings
}

/// The difference of the mean residuals of the two directions, if it is not by chance.
fn directions(fit: &LawFit, points: &[FitPoint]) -> Option<FitFinding> {
    let mean = |forward: bool| {
        let own = points.iter().zip(&fit.residuals);
        let own = own.filter(|(point, _)| (point.slip_velocity > 0.0) == forward);
        let (count, sum) =
            own.fold((0.0_f64, 0.0), |(count, sum), (_, residual)| (count + 1.0, sum + residual));
        (count > 0.0).then(|| (count, sum / count))
    };
    let ((forward, ahead), (backward, behind)) = mean(true).zip(mean(false))?;
    let difference = ahead - behind;
    let spread = fit.residuals.iter().map(|residual| residual * residual).sum::<f64>();
    let variance = spread / points.len() as f64 * (forward.recip() + backward.recip());
    (difference.abs() > UNLIKELY * variance.sqrt()).then_some(FitFinding::Directions { difference })
}
