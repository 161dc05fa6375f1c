//! Why a response could not be measured.

use std::fmt;

use crate::motion::{Immobile, MotionStopped};

/// Why a response could not be measured.
#[derive(Clone, Debug, PartialEq)]
pub enum ResponseRefused {
    /// The motion cannot be computed.
    Immobile(Immobile),
    /// A run ended early.
    Stopped(MotionStopped),
    /// The record would have too many samples.
    TooLong {
        /// The longest record of this system.
        most: f64,
    },
    /// The record is too short for a line of it to lie in the band of slow vibration.
    TooShort {
        /// The shortest record.
        least: f64,
    },
}

impl fmt::Display for ResponseRefused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Immobile(why) => why.fmt(f),
            Self::Stopped(why) => why.fmt(f),
            Self::TooLong { most } => {
                write!(f, "a record of this system is at most {most:.6e} long")
            }
            Self::TooShort { least } => {
                write!(f, "a record of this system is at least {least:.6e} long")
            }
        }
    }
}

impl std::error::Error for ResponseRefused {}
