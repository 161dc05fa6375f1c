//! Why no stable slow vibration is known.

use std::fmt;

use quell_linear::averaging::NoSlowVibration;
use quell_model::units::{Quantity, UnitSystem};
use quell_numerics::eigen::EigenError;

use super::gains::NoSmallGain;
use crate::reasons::reasons;
use crate::run::system::in_units;

reasons! {
    /// Why the growth rate of small slow motions is unknown.
    pub enum NoSmallGrowth {
        /// The gain has no value.
        NoGain(NoSmallGain),
        /// The state matrix overflows.
        Eigenvalues(EigenError),
        ;
    }
}

/// The largest velocity amplitude at which slow motions are judged, in a study with these units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JudgedUpTo {
    /// The amplitude.
    pub amplitude: f64,
    /// The units.
    pub units: UnitSystem,
}

impl fmt::Display for JudgedUpTo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&in_units(self.units, Quantity::Velocity, self.amplitude))
    }
}

/// Why there is no stable limit cycle.
#[derive(Clone, Debug, PartialEq)]
pub enum NoStableCycle {
    /// Harmonic balance does not hold.
    NoBalance(NoSlowVibration),
    /// Slow motions of every amplitude decay.
    AllDecay(JudgedUpTo),
    /// Slow motions of every amplitude grow.
    AllGrow(JudgedUpTo),
    /// No limit cycle is stable.
    NoneStable(JudgedUpTo),
}

impl fmt::Display for NoStableCycle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoBalance(why) => why.fmt(f),
            Self::AllDecay(largest) => {
                write!(f, "slow motions of every velocity amplitude up to {largest} decay")
            }
            Self::AllGrow(largest) => {
                write!(f, "slow motions of every velocity amplitude up to {largest} grow")
            }
            Self::NoneStable(largest) => {
                write!(f, "no stable cycle has a velocity amplitude up to {largest}")
            }
        }
    }
}

impl std::error::Error for NoStableCycle {}
