//! Averaged stability of steady sliding: the sign of 2ζ + Fμ̄′(v₀) (2.26, 4.32).
//!
//! A negative value means that steady sliding is unstable: friction feeds the oscillation. The slope is taken with the fast
//! motion frozen (see [`super::mean_friction`]). The verdict is local: it concerns small slow motions near steady sliding, and
//! holds to the order of the averaging. It does not exclude a coexisting stick-slip cycle.

use quell_model::Belt;

use super::averaged_law::AveragedLaw;
use super::dithers::Averaging;
use super::effective::{Effective, SlopeSide};
use super::error::AveragingError;

/// Why a criterion has no sign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum UndecidedBecause {
    /// Its magnitude is within its numerical error.
    WithinError,
    /// The belt velocity equals the largest fast velocity, where the criterion jumps: unstable on the outer side of the jump,
    /// stable on the inner side.
    AtCorner,
}

/// Averaged verdict on steady sliding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AveragedVerdict {
    /// Small slow motions decay.
    Stable,
    /// Small slow motions grow.
    Unstable,
    /// The sign is undetermined.
    Undecided {
        /// The reason.
        why: UndecidedBecause,
    },
}

/// Stability criterion of steady sliding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Criterion {
    /// 2ζ + Fμ̄′(v₀): twice the effective damping ratio. At a corner, the outer value.
    pub value: f64,
    /// Bound on its numerical error.
    pub error: f64,
    /// Effective friction at v₀; `effective.side` states whether the slope is one-sided.
    pub effective: Effective,
    /// Verdict that follows from the sign.
    pub verdict: AveragedVerdict,
}

impl Criterion {
    /// Criterion from ζ, F and the effective friction at the belt velocity.
    #[must_use]
    pub fn new(damping_ratio: f64, normal_load: f64, effective: Effective) -> Self {
        let value = 2.0 * damping_ratio + normal_load * effective.slope;
        let rounding =
            2.0 * f64::EPSILON * (2.0 * damping_ratio + (normal_load * effective.slope).abs());
        let error = normal_load * effective.slope_error + rounding;
        let verdict = if value > error {
            // At a corner the inner slope is even larger.
            AveragedVerdict::Stable
        } else if value >= -error {
            AveragedVerdict::Undecided { why: UndecidedBecause::WithinError }
        } else if effective.side == SlopeSide::Outer {
            AveragedVerdict::Undecided { why: UndecidedBecause::AtCorner }
        } else {
            AveragedVerdict::Unstable
        };
        Self { value, error, effective, verdict }
    }
}

/// Averaged stability criterion of steady sliding on a belt with its dithers.
///
/// # Errors
/// [`AveragingError`], in particular [`AveragingError::SetValued`] for a belt at rest without tangential dither.
pub fn criterion(belt: &Belt, averaging: Averaging) -> Result<Criterion, AveragingError> {
    let v = belt.belt_velocity();
    let law = AveragedLaw::of_one_mass(belt, v, averaging)?;
    let effective = law.at(law.motion().at_corner(v)?)?;
    Ok(Criterion::new(belt.damping_ratio(), belt.normal_load(), effective))
}
