//! A law from measured samples of slip speed and coefficient, with a separate static level.
//!
//! The samples are replaced by one smooth approximant ([`Fit`]), never by a spline, because each knot
//! would be an event. The approximant is a formula, and the law is that formula ([`Expression`]): it
//! has the same values, derivatives and lanes, and its text can be used as a formula.
//!
//! Limits: friction is assumed odd, with one curve for both directions of slip; samples at negative
//! slip are rejected.

use std::sync::Arc;

use quell_numerics::interval::RealInterval;
use quell_numerics::order::ascending;

use super::numeric::not_a_number_of;
use super::{Expression, LawParameters, RangeLimit, SlidingLaw, SlipRange, Surroundings};
use crate::parameter::{Parameter, STATIC_COEFFICIENT};
use crate::{Invalid, InvalidValues};

mod fit;

pub use fit::{FEWEST, Fit, MOST_TERMS};

/// Path of the measured speeds in a study file.
pub const SPEEDS: &str = "friction.slip_velocity";

/// Path of the measured coefficients in a study file.
pub const COEFFICIENTS: &str = "friction.coefficient";

/// Path of the number of terms in a study file.
pub const TERMS: &str = "friction.terms";

/// Restates the errors of the formula of a fit for its samples.
fn of_samples(wrong: InvalidValues) -> InvalidValues {
    let said = |invalid: Invalid| {
        if invalid.key == STATIC_COEFFICIENT.path {
            return invalid;
        }
        let allowed = format!(
            "samples whose fit is {}; give more samples, or a different number of terms",
            invalid.allowed
        );
        Invalid::new(COEFFICIENTS, invalid.value, allowed)
    };
    wrong.map(said)
}

/// A law from measured samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Samples {
    curve: Expression,
    fit: Arc<Fit>,
}

impl Samples {
    /// From samples (slip speed, coefficient) in any order, the static level (μ(0⁺) of the fit if
    /// not given), the number of terms (the best of 1…[`MOST_TERMS`] if not given), and the
    /// dimensionless velocity of one unit of the speeds.
    ///
    /// # Errors
    /// Samples that are not finite or negative, by index; fewer than [`FEWEST`] distinct speeds;
    /// samples that do not determine a fit, or whose fit is negative somewhere.
    pub fn new(
        samples: &[(f64, f64)],
        static_coefficient: Option<f64>,
        terms: Option<usize>,
        velocity_unit: f64,
    ) -> Result<Self, InvalidValues> {
        let fit = Self::fitted(samples, static_coefficient, terms)?;
        Self::of_fit(fit, static_coefficient, velocity_unit)
    }

    /// The fit of samples (slip speed, coefficient), from which [`of_fit`](Self::of_fit) makes the law.
    ///
    /// # Errors
    /// Samples that are not finite or negative, by index; fewer than [`FEWEST`] distinct speeds; samples that do not determine a fit.
    pub fn fitted(
        samples: &[(f64, f64)],
        static_coefficient: Option<f64>,
        terms: Option<usize>,
    ) -> Result<Fit, InvalidValues> {
        let mut complaints: Vec<Invalid> = Vec::new();
        for (index, (speed, coefficient)) in samples.iter().enumerate() {
            if !(speed.is_finite() && *speed >= 0.0) {
                let allowed = "a finite slip speed ≥ 0: friction is assumed equal in both directions of slip, so give \
                               samples of one direction";
                complaints.push(Invalid::new(format!("{SPEEDS}[{index}]"), speed, allowed));
            }
            if !(coefficient.is_finite() && *coefficient >= 0.0) {
                let key = format!("{COEFFICIENTS}[{index}]");
                complaints.push(Invalid::new(key, coefficient, "a finite number ≥ 0"));
            }
        }
        if let Some(level) = static_coefficient {
            complaints.extend(STATIC_COEFFICIENT.check(level).err());
        }
        if let Some(count) = terms.filter(|count| !(1..=MOST_TERMS).contains(count)) {
            let allowed = format!("a whole number from 1 to {MOST_TERMS}");
            complaints.push(Invalid::new(TERMS, count, allowed));
        }
        if !complaints.is_empty() {
            return Err(InvalidValues::of(complaints));
        }
        let mut speeds: Vec<f64> = samples.iter().map(|(speed, _)| *speed).collect();
        ascending(&mut speeds);
        speeds.dedup();
        if speeds.len() < FEWEST {
            let allowed = format!("at least {FEWEST} distinct speeds");
            return Err(InvalidValues::from(Invalid::new(SPEEDS, speeds.len(), allowed)));
        }
        fit::fit(samples, static_coefficient, terms).ok_or_else(|| {
            let allowed =
                "a smaller number of terms, or give more samples: these do not determine the fit";
            InvalidValues::from(Invalid::new(TERMS, terms.unwrap_or(1), allowed))
        })
    }

    /// From a fit that was made before.
    ///
    /// # Errors
    /// A fit that is negative somewhere, or starts above the static level.
    pub fn of_fit(
        fit: Fit,
        static_coefficient: Option<f64>,
        velocity_unit: f64,
    ) -> Result<Self, InvalidValues> {
        // A pinned fit starts at the level up to rounding.
        let level =
            static_coefficient.map(|level| if fit.pinned { level.max(fit.start()) } else { level });
        let curve = Expression::new(&fit.formula(), &[], level, velocity_unit)
            .and_then(|curve| curve.proven_up_to(fit.range.upper * velocity_unit))
            .map_err(of_samples)?;
        Ok(Self { curve, fit: Arc::new(fit) })
    }

    /// The approximant and its error.
    pub fn fit(&self) -> &Fit {
        &self.fit
    }

    /// The approximant as a law of its own.
    pub fn curve(&self) -> &Expression {
        &self.curve
    }

    /// The same law with speeds in another unit.
    #[must_use]
    pub fn in_unit(&self, velocity_unit: f64) -> Self {
        Self { curve: self.curve.in_unit(velocity_unit), fit: Arc::clone(&self.fit) }
    }
}

impl LawParameters for Samples {
    const NAME: &'static str = "samples";
    const ABOUT: &'static str =
        "measured slip speeds and coefficients, fitted by one sum of exponentials";
    const PARAMETERS: &'static [Parameter] = &[STATIC_COEFFICIENT];

    fn values(&self) -> Vec<f64> {
        self.curve.values()
    }

    fn get(&self, path: &str) -> Option<f64> {
        (path == STATIC_COEFFICIENT.path).then(|| self.curve.static_coefficient())
    }

    fn with(&self, path: &str, value: f64) -> Result<Self, InvalidValues> {
        if path != STATIC_COEFFICIENT.path {
            return Err(not_a_number_of::<Self>(path, value));
        }
        Ok(Self { curve: self.curve.with(path, value)?, fit: Arc::clone(&self.fit) })
    }
}

impl SlidingLaw for Samples {
    type Recurrence = Expression;

    fn recurrence(&self) -> &Expression {
        &self.curve
    }

    /// Slip beyond the samples causes a warning; the trend of the fit is proven there as well.
    fn placed(&self, surroundings: &Surroundings) -> Result<Self, InvalidValues> {
        let data = self.fit.range.upper * self.curve.velocity_unit();
        let speed = data.max(super::expression::MULTIPLE * surroundings.slip);
        let curve = self.curve.proven_up_to(speed).map_err(of_samples)?;
        Ok(Self { curve, fit: Arc::clone(&self.fit) })
    }

    fn range(&self) -> Option<SlipRange> {
        let unit = self.curve.velocity_unit();
        let RealInterval { lower, upper } = self.fit.range;
        // Held at the static level, the fit runs from rest to the first sample.
        let lower = if self.fit.pinned { 0.0 } else { lower };
        Some(SlipRange { lower: lower * unit, upper: upper * unit, limit: RangeLimit::Samples })
    }

    #[inline(always)]
    fn velocity_scale(&self) -> f64 {
        self.curve.velocity_scale()
    }

    #[inline(always)]
    fn static_coefficient(&self) -> f64 {
        self.curve.static_coefficient()
    }

    fn alone(&self, speed: f64) -> (f64, f64) {
        self.curve.alone(speed)
    }
}
