//! Why friction has no value at a slip velocity.

use std::fmt;

use quell_dynamics::mean_friction::NoMeanFriction;
use quell_dynamics::response::{NoSteadyFriction, SteadyFriction};
use quell_linear::averaging::{AveragingError, Effective};

use crate::reasons::reasons;

/// At rest a friction coefficient has no single value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionAtRest {
    /// The largest value μ_s.
    pub static_coefficient: f64,
}

impl fmt::Display for FrictionAtRest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "at rest friction takes any value up to ±{}", self.static_coefficient)
    }
}

impl std::error::Error for FrictionAtRest {}

reasons! {
    /// Why a contact has no limit of high dither frequency.
    pub enum NotFreeMass {
        /// It is not that of a free mass.
        Mass(&'static str) => "the limit of high frequency is that of a free mass under its dither: {}",
        ;
    }
}

reasons! {
    /// Why the mean friction of a contact has no value at a slip velocity.
    pub enum NoMeanOfContact {
        /// The law has no average.
        NoAverage(AveragingError),
        /// The contact has a state, and is not that of a free mass.
        OfState(NotFreeMass) =>
            "the mean of a contact with a state of its own is that of its periodic state: {}; `response` gives its mean friction",
        /// The mean of its periodic state is unknown.
        NoMeanFriction(NoMeanFriction),
        ;
        /// The contact has a state, and the dither is noise.
        UnderNoise =>
            "the mean of a contact with a state of its own is that of its periodic state, and under noise it has none",
    }
}

reasons! {
    /// Why a steady response has no mean friction at a slip velocity.
    pub enum NoMeasuredFriction {
        /// The response has no value.
        NoResponse(NoSteadyFriction),
        ;
        /// The slip velocity is zero.
        SurfaceAtRest => "at zero slip velocity the surface does not move",
    }
}

/// Mean friction in the limit of high dither frequency, or why it is undefined.
pub type LimitMean = Result<Effective, AveragingError>;

/// Friction of a steady response, or why it has no value.
pub type MeasuredFriction = Result<SteadyFriction, NoMeasuredFriction>;
