//! Numbers of the sine that a drive or a load adds to its constant value.

use super::{Bounds, Parameter, si};
use crate::units::Quantity;

/// Amplitude of the sine, in the quantity of what it is added to.
pub const OSCILLATION_AMPLITUDE: Parameter = Parameter {
    path: "oscillation.amplitude",
    symbol: "a",
    about: "amplitude of the oscillation",
    quantity: Quantity::Ratio,
    bounds: Bounds::NOT_NEGATIVE,
    si: &[],
};

/// Frequency of the sine.
pub const OSCILLATION_FREQUENCY: Parameter = Parameter {
    path: "oscillation.frequency",
    symbol: "ω",
    about: "angular frequency of the oscillation",
    quantity: Quantity::FrequencyRatio,
    bounds: Bounds::POSITIVE,
    si: &[si("frequency_hz", "Hz"), si("frequency_ratio", "")],
};

/// Phase of the sine.
pub const OSCILLATION_PHASE: Parameter = Parameter {
    path: "oscillation.phase",
    symbol: "φ",
    about: "phase of the oscillation at the start",
    quantity: Quantity::Angle,
    bounds: Bounds::FINITE,
    si: &[],
};
