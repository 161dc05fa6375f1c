//! Dither forces.

use quell_model::{Direction, Dither, Waveform};

/// A dither of phase 0.
pub fn dither(
    direction: Direction,
    waveform: Waveform,
    amplitude: f64,
    frequency_ratio: f64,
) -> Dither {
    Dither { direction, waveform, amplitude, frequency_ratio, phase: 0.0, envelope: None }
}

/// A tangential dither of phase 0.
pub fn tangential(waveform: Waveform, amplitude: f64, frequency_ratio: f64) -> Dither {
    dither(Direction::Tangential, waveform, amplitude, frequency_ratio)
}

/// A normal dither of phase 0.
pub fn normal(waveform: Waveform, amplitude: f64, frequency_ratio: f64) -> Dither {
    dither(Direction::Normal, waveform, amplitude, frequency_ratio)
}

/// A tangential sine of phase 0.
pub fn sine(amplitude: f64, frequency_ratio: f64) -> Dither {
    tangential(Waveform::Sine, amplitude, frequency_ratio)
}

/// The same dither with the phase φ at τ = 0, radians.
#[must_use]
pub fn at_phase(dither: Dither, phase: f64) -> Dither {
    Dither { phase, ..dither }
}
