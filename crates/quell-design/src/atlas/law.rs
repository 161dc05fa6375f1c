//! The laws of the atlas: those that are one shape, scaled.

use std::f64::consts::FRAC_1_SQRT_2;

use quell_model::parameter::{EXPONENT, VISCOUS};
use quell_model::{Friction, InvalidValues, LawKind, LawParameters as _};

/// The exponent for which the atlas has the exponential law.
const EXPONENT_OF_ATLAS: f64 = 2.0;

/// A law whose shape the atlas knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum AtlasLaw {
    /// The cubic of eq. (2.7).
    Stribeck,
    /// The exponential fall of eq. (2.8).
    Decreasing,
    /// The Gaussian fall, of exponent 2.
    StribeckExponential,
}

impl AtlasLaw {
    /// Every law of the atlas.
    pub const ALL: [Self; 3] = [Self::Stribeck, Self::Decreasing, Self::StribeckExponential];

    /// The kind of the law.
    pub fn kind(self) -> LawKind {
        match self {
            Self::Stribeck => LawKind::Stribeck,
            Self::Decreasing => LawKind::Decreasing,
            Self::StribeckExponential => LawKind::StribeckExponential,
        }
    }

    /// Name in a study file.
    pub fn name(self) -> &'static str {
        self.kind().name()
    }

    /// The law of a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|law| law.name() == name)
    }

    /// The shape of a law of a study.
    ///
    /// # Errors
    /// The key that places it outside, and what the atlas has.
    pub fn of(friction: &Friction) -> Result<Self, (&'static str, String)> {
        let law = Self::ALL.into_iter().find(|law| law.kind() == friction.kind());
        let law = law.ok_or_else(|| {
            let names: Vec<&str> = Self::ALL.into_iter().map(Self::name).collect();
            ("friction.law", format!("one of {}: the atlas has no other law", names.join(", ")))
        })?;
        match friction {
            Friction::StribeckExponential(exponential)
                if exponential.get(EXPONENT.path) != Some(EXPONENT_OF_ATLAS) =>
            {
                Err((
                    EXPONENT.path,
                    format!("{EXPONENT_OF_ATLAS}: the atlas has no other exponent"),
                ))
            }
            _ => Ok(law),
        }
    }

    /// The law with v_m = 1 that falls from `minimum` + `fall` to `minimum`, without a viscous part.
    ///
    /// # Errors
    /// Coefficients that are not valid.
    pub fn build(self, minimum: f64, fall: f64) -> Result<Friction, InvalidValues> {
        let level = minimum + fall;
        match self {
            Self::Stribeck | Self::Decreasing => self.kind().build(&[level, minimum, 1.0]),
            Self::StribeckExponential => {
                self.kind().build(&[minimum, level, 1.0, EXPONENT_OF_ATLAS, 0.0])
            }
        }
    }

    /// The slip velocity of the steepest fall, over v_m.
    pub fn steepest(self) -> f64 {
        match self {
            Self::Stribeck | Self::Decreasing => 0.0,
            Self::StribeckExponential => FRAC_1_SQRT_2,
        }
    }

    /// max|μ′| of a law of this shape without its viscous part, per unit velocity.
    pub fn steepest_slope(self, friction: &Friction) -> f64 {
        let slope = friction.slope(self.steepest() * friction.velocity_scale());
        viscous(friction) - slope
    }

    /// Largest v₀/v_m of the atlas: the minimum of the cubic; where the excess has fallen to 0.7 % (decreasing) and to 0.2 %
    /// (exponential).
    pub fn largest_velocity(self) -> f64 {
        match self {
            Self::Stribeck => 1.0,
            Self::Decreasing => 5.0,
            Self::StribeckExponential => 2.5,
        }
    }
}

/// σ_v of a law, 0 where it has none.
pub(super) fn viscous(friction: &Friction) -> f64 {
    friction.get(VISCOUS.path).unwrap_or(0.0)
}
