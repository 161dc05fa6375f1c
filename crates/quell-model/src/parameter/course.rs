//! Numbers of the sine that a drive or a load adds to its constant value.

use super::{Bounds, Parameter, SiTwin, si};
use crate::units::Quantity;

/// Amplitude of the sine that is added to a velocity.
pub const VELOCITY_AMPLITUDE: Parameter =
    amplitude(Quantity::Velocity, &[si("amplitude_m_per_s", "m/s")]);

/// Amplitude of the sine that is added to a load.
pub const LOAD_AMPLITUDE: Parameter = amplitude(Quantity::Force, &[si("amplitude_n", "N")]);

/// Amplitude of the sine that is added to the speed of a disc.
pub const SPEED_AMPLITUDE: Parameter =
    amplitude(Quantity::FrequencyRatio, &[si("amplitude_hz", "Hz")]);

/// Amplitude of the sine that is added to a share.
pub const SHARE_AMPLITUDE: Parameter = amplitude(Quantity::Ratio, &[]);

const fn amplitude(quantity: Quantity, si: &'static [SiTwin]) -> Parameter {
    Parameter {
        path: "oscillation.amplitude",
        symbol: "a",
        about: "amplitude of the oscillation",
        quantity,
        bounds: Bounds::NOT_NEGATIVE,
        si,
    }
}

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
