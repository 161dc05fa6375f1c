//! Where the runs of a response end, judged by periodic motions as `orbit` and `thresholds` judge them.

use quell_model::System;

use crate::motion::MotionStart;
use crate::motion::orbit::{MOST_PERIODS, NoCycle, free_cycle, settled};
use crate::orbit::OrbitVerdict;

/// Where a run ends.
#[derive(Clone, Debug, PartialEq)]
pub enum SystemEnding {
    /// On a stable periodic motion.
    Orbit {
        /// State at t = 0 of the dither's phase.
        state: Vec<f64>,
        /// Its period.
        period: f64,
    },
    /// At rest or in steady sliding, without dither.
    Rest,
    /// On no periodic motion that was found: its record decides.
    Record,
}

impl SystemEnding {
    /// The ending of a run from a start. An orbit that is not stable is not where a run ends.
    pub(super) fn of(system: &System, start: &MotionStart) -> Self {
        if !system.is_dithered() {
            return match free_cycle(&system.undithered(), &start.state) {
                Ok(cycle) if cycle.verdict() == OrbitVerdict::Stable => {
                    Self::Orbit { state: cycle.state, period: cycle.period }
                }
                Err(NoCycle::Rest { .. }) => Self::Rest,
                Ok(_) | Err(_) => Self::Record,
            };
        }
        // The phase of the dither of an orbit's state is that at t = 0.
        if start.time != 0.0 {
            return Self::Record;
        }
        match settled(system, &start.state, MOST_PERIODS) {
            Ok(found) => Self::Orbit { state: found.orbit.state, period: found.orbit.period },
            Err(_) => Self::Record,
        }
    }

    /// The word in outputs.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Orbit { .. } => "orbit",
            Self::Rest => "rest",
            Self::Record => "record",
        }
    }

    /// Period of the orbit.
    pub fn period(&self) -> Option<f64> {
        match self {
            Self::Orbit { period, .. } => Some(*period),
            Self::Rest | Self::Record => None,
        }
    }

    /// Whether it has no vibration slower than an angular frequency: every line of an orbit is a multiple of its own frequency.
    pub(super) fn is_faster_than(&self, frequency: f64) -> bool {
        self.period().is_some_and(|period| std::f64::consts::TAU / period > frequency)
    }
}
