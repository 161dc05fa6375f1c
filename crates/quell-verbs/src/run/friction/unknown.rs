//! Why friction has no value at a slip velocity.

use std::fmt;

use quell_dynamics::mean_friction::NoMeanFriction;
use quell_dynamics::response::{NoSteadyFriction, SteadyFriction};
use quell_linear::averaging::{AveragingError, Effective};

use crate::reasons::reasons;

/// Why the friction coefficient of a law has no value at a slip velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoCoefficient {
    /// At rest it has no single value.
    AtRest {
        /// The largest value μ_s.
        static_coefficient: f64,
    },
    /// The law gives no finite number.
    NotFinite(NotFinite),
}

impl fmt::Display for NoCoefficient {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::AtRest { static_coefficient } => {
                write!(f, "at rest friction takes any value up to ±{static_coefficient}")
            }
            Self::NotFinite(why) => why.fmt(f),
        }
    }
}

impl std::error::Error for NoCoefficient {}

/// A law gives no finite number so far beyond its velocities.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotFinite;

impl fmt::Display for NotFinite {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the law has no finite value so far beyond its velocities")
    }
}

impl std::error::Error for NotFinite {}

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
        /// The law gives no finite number.
        NotFinite(NotFinite),
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
pub type LimitMean = Result<Effective, NoMeanOfContact>;

/// Friction of a steady response, or why it has no value.
pub type MeasuredFriction = Result<SteadyFriction, NoMeasuredFriction>;
