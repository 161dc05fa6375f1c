//! The tables of drives, loads and envelopes: numbers over time.

use quell_model::parameter::course::{
    LOAD_AMPLITUDE, SHARE_AMPLITUDE, SPEED_AMPLITUDE, VELOCITY_AMPLITUDE,
};
use quell_model::parameter::{Bounds, Parameter};
use quell_model::units::Quantity;

/// A table that gives a number over time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CourseTable {
    /// The key of the values.
    pub value: &'static str,
    /// The quantity of the values.
    pub quantity: Quantity,
    /// The values that are allowed.
    pub bounds: Bounds,
    /// The amplitude of a sine that may be added to a constant instead.
    pub amplitude: Option<Parameter>,
    /// Whether the number may jump.
    pub jumps: bool,
}

/// `[belt.drive]`, `[contact.drive]`: velocity of the surface.
pub const DRIVE: CourseTable = CourseTable {
    value: "velocity",
    quantity: Quantity::Velocity,
    bounds: Bounds::FINITE,
    amplitude: Some(VELOCITY_AMPLITUDE),
    jumps: false,
};

/// `[belt.load]`, `[contact.load]`: normal load.
pub const LOAD: CourseTable = CourseTable {
    value: "load",
    quantity: Quantity::Force,
    bounds: Bounds::POSITIVE,
    amplitude: Some(LOAD_AMPLITUDE),
    jumps: true,
};

/// `[dither.envelope]`: share of the amplitude.
pub const ENVELOPE: CourseTable = CourseTable {
    value: "share",
    quantity: Quantity::Ratio,
    bounds: Bounds::NOT_NEGATIVE,
    amplitude: None,
    jumps: true,
};

/// `[disc.load.envelope]`: share of the normal load, and with it of friction.
pub const LOAD_ENVELOPE: CourseTable = CourseTable {
    value: "share",
    quantity: Quantity::Ratio,
    bounds: Bounds::POSITIVE,
    amplitude: Some(SHARE_AMPLITUDE),
    jumps: true,
};

/// `[disc.drive]`: speed of the disc under its loads.
pub const DISC_DRIVE: CourseTable = CourseTable {
    value: "speed",
    quantity: Quantity::FrequencyRatio,
    bounds: Bounds::FINITE,
    amplitude: Some(SPEED_AMPLITUDE),
    jumps: false,
};

/// A key of such a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CourseKey {
    /// The times, in seconds or not.
    Time {
        /// In seconds.
        si: bool,
    },
    /// The values at the times, in SI or not.
    Value {
        /// In SI.
        si: bool,
    },
    /// The shape between the knots.
    Shape,
    /// A CSV file of times and values.
    File,
}

impl CourseTable {
    /// The keys with their names: those in SI where the quantity has a unit.
    pub fn keys(self) -> Vec<(&'static str, CourseKey)> {
        let mut keys = vec![
            ("time", CourseKey::Time { si: false }),
            ("time_s", CourseKey::Time { si: true }),
            (self.value, CourseKey::Value { si: false }),
        ];
        if let Some(name) = self.value_in_si() {
            keys.push((name, CourseKey::Value { si: true }));
        }
        keys.extend([("shape", CourseKey::Shape), ("file", CourseKey::File)]);
        keys
    }

    /// The key of the values in SI.
    pub fn value_in_si(self) -> Option<&'static str> {
        match self.quantity {
            Quantity::Velocity => Some("velocity_m_per_s"),
            Quantity::Force => Some("load_n"),
            Quantity::FrequencyRatio => Some("speed_hz"),
            _ => None,
        }
    }
}

impl CourseKey {
    /// What it is, in one line.
    pub const fn about(self) -> &'static str {
        match self {
            Self::Time { .. } => {
                "times of the knots, from the start of the run, in ascending order"
            }
            Self::Value { .. } => {
                "values at these times; before and after them the first and the last hold"
            }
            Self::Shape => {
                "straight between the knots, or smooth with slope zero at them [default: linear]"
            }
            Self::File => "CSV file of times and values, relative to the study file",
        }
    }

    /// Whether it is in SI; `None` for a key without a unit.
    pub fn si(self) -> Option<bool> {
        match self {
            Self::Time { si } | Self::Value { si } => Some(si),
            _ => None,
        }
    }
}
