//! The slip speeds for which a law holds, and what a law learns from the belt it is put into.

use std::fmt;

/// Slip speeds for which a law holds, |v_r| in the numbers of the equations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlipRange {
    /// Slowest slip; 0 where the law holds down to rest.
    pub lower: f64,
    /// Fastest slip.
    pub upper: f64,
    /// What ends there.
    pub limit: RangeLimit,
}

/// What ends where a law's range ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RangeLimit {
    /// A cubic is back at its static level, at √3 v_m.
    BackAtStaticLevel,
    /// Measured samples.
    Samples,
    /// The speed up to which a study says that its formula holds.
    Declared,
    /// The speed up to which a formula was proven, where the study says none.
    Proven,
}

impl fmt::Display for RangeLimit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::BackAtStaticLevel => {
                "√3 v_m, where the cubic is back at the static level, which no Stribeck curve does"
            }
            Self::Samples => "the slip speeds of the samples",
            Self::Declared => "the maximum velocity of the formula",
            Self::Proven => {
                "as far as the formula was proven, 10 times the speed of belt and dither; a larger maximum_velocity extends it"
            }
        })
    }
}

/// The belt into which a law is put, as far as it bears on the law. Lengths as in the equations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surroundings {
    /// F, the normal load.
    pub normal_load: f64,
    /// v₀ plus the largest fast velocity of the dither: the slip that belt and dither reach together.
    pub slip: f64,
}
