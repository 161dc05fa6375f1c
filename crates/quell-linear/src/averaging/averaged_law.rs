//! The averaged friction law of one contact: its mean over a fast motion that is frozen, as a function of the slow slip velocity.
//!
//! In the limit of high frequency the fast motion of a belt is that of its dithers alone ([`AveragedLaw::of_one_mass`]). At finite R, and
//! of a contact of a system, it is what the structure makes of all dithers there ([`super::FastInputs`]): the mean is T̄/N = ⟨μ(v + a)(1 +
//! Ñ/N)⟩ under the mean load N. Under noise slip and load are Gaussian, and ⟨μ(v + a)Ñ⟩ = ⟨aÑ⟩⟨μ′(v + a)⟩ (Stein's identity).

use quell_model::Friction;

use super::effective::{Effective, SlopeSide};
use super::error::AveragingError;
use super::fast_motion::FastMotion;
use super::mean_friction::effective;

/// Step of the differences, in standard deviations: their error is h⁴/30 of the fifth derivative of the slope, 10⁻⁹ relative.
const STEP: f64 = 0.01;

/// Mean friction of a contact over its mean load, over the slow slip velocity.
#[derive(Clone, Debug)]
pub struct AveragedLaw {
    law: Friction,
    /// Slip with the load that goes with it, over the mean load.
    whole: FastMotion,
    /// Slip alone.
    slip: FastMotion,
    /// ⟨aÑ⟩/N under noise.
    covariance: f64,
}

impl AveragedLaw {
    /// A law without dither.
    pub fn undithered(law: &Friction) -> Self {
        Self::new(law, [FastMotion::default(), FastMotion::default()], 0.0)
    }

    pub(super) fn new(law: &Friction, [whole, slip]: [FastMotion; 2], covariance: f64) -> Self {
        Self { law: law.clone(), whole, slip, covariance }
    }

    /// The friction law.
    pub fn law(&self) -> &Friction {
        &self.law
    }

    /// The fast motion, with the load that goes with it.
    pub fn motion(&self) -> &FastMotion {
        &self.whole
    }

    /// Largest fast slip velocity; of noise four standard deviations.
    ///
    /// # Errors
    /// A quadrature that did not converge.
    pub fn fast_velocity(&self) -> Result<f64, AveragingError> {
        let [low, high] = self.slip.slip_range()?;
        Ok(high.max(-low))
    }

    /// Number of incommensurate frequencies of the fast motion, noise counted as one.
    pub(super) fn groups(&self) -> usize {
        self.whole.groups().len() + usize::from(self.whole.noise() > 0.0)
    }

    /// Slip velocities at which it has a corner.
    pub(super) fn corners(&self) -> Result<Vec<f64>, AveragingError> {
        self.whole.corners()
    }

    /// The mean and its slope at a slip velocity.
    ///
    /// # Errors
    /// [`AveragingError`], in particular [`AveragingError::SetValued`] at rest without fast motion.
    pub fn at(&self, v: f64) -> Result<Effective, AveragingError> {
        let mut found = effective(&self.law, &self.whole, v)?;
        if self.covariance != 0.0 {
            let own = effective(&self.law, &self.slip, v)?;
            found.coefficient += self.covariance * own.slope;
            found.coefficient_error += self.covariance.abs() * own.slope_error;
            found.slope += self.covariance * curvature(&self.law, &self.slip, v)?;
        }
        Ok(found)
    }

    /// [`AveragedLaw::at`], at rest without dither the middle of the friction that is possible.
    pub(super) fn at_or_middle(&self, v: f64) -> Result<Effective, AveragingError> {
        match self.at(v) {
            Err(AveragingError::SetValued { .. }) => {
                Ok(Effective::closed([0.0; 2], [0.0; 2], 0.0, SlopeSide::Both))
            }
            found => found,
        }
    }
}

/// μ̄″ under noise, from the slope at four places: the average is smooth on the scale of the standard deviation.
pub(super) fn curvature(law: &Friction, slip: &FastMotion, v: f64) -> Result<f64, AveragingError> {
    let h = STEP * slip.noise();
    let slope =
        |k: f64| -> Result<f64, AveragingError> { Ok(effective(law, slip, v + k * h)?.slope) };
    let [near, far] = [slope(1.0)? - slope(-1.0)?, slope(2.0)? - slope(-2.0)?];
    Ok((8.0 * near - far) / (12.0 * h))
}
