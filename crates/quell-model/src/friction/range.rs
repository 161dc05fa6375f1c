//! The slip speeds for which a law holds, and the properties of the belt that a law depends on.

use std::fmt;

/// Slip speeds for which a law holds, |v_r| in the numbers of the equations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlipRange {
    /// Smallest slip speed; 0 if the law holds down to rest.
    pub lower: f64,
    /// Largest slip speed.
    pub upper: f64,
    /// What limits the range.
    pub limit: RangeLimit,
}

/// What limits the range of a law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RangeLimit {
    /// A cubic returns to its static level, at √3 v_m.
    BackAtStaticLevel,
    /// Measured samples.
    Samples,
    /// The speed up to which the formula holds according to the study.
    Declared,
    /// The speed up to which a formula was proven, if the study does not give one.
    Proven,
}

impl fmt::Display for RangeLimit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::BackAtStaticLevel => {
                "√3 v_m, where the cubic returns to the static level, unlike any Stribeck curve"
            }
            Self::Samples => "the slip speeds of the samples",
            Self::Declared => "the maximum velocity of the formula",
            Self::Proven => {
                "the range over which the formula was proven, 10 times the speed of belt and dither; a larger \
                 maximum_velocity extends it"
            }
        })
    }
}

/// The properties of a belt that its friction law depends on. Lengths as in the equations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surroundings {
    /// F, the normal load.
    pub normal_load: f64,
    /// v₀ plus the largest fast velocity of the dither: the slip that belt and dither reach together.
    pub slip: f64,
}
