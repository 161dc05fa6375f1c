//! Profiles between two breaks: each wave is a sine or a straight line there.

use std::f64::consts::TAU;

use quell_model::Waveform;
use quell_model::profile::{Profile, Wave};

/// A profile between two breaks, where it is smooth; it continues smoothly beyond them.
#[derive(Clone, Debug)]
pub(super) struct Smooth {
    mean: f64,
    pieces: Vec<Piece>,
}

/// One wave between two breaks.
#[derive(Clone, Copy, Debug)]
enum Piece {
    /// A sin(ωt + φ).
    Sine { amplitude: f64, frequency: f64, phase: f64 },
    /// A straight line through `value` at the time `middle`.
    Line { value: f64, slope: f64, middle: f64 },
}

impl Smooth {
    /// The profile between two times without a break between them.
    pub(super) fn between(profile: &Profile, from: f64, to: f64) -> Self {
        let middle = 0.5 * (from + to);
        let pieces = profile.waves().iter().map(|wave| Piece::at(wave, middle)).collect();
        Self { mean: profile.mean(), pieces }
    }

    /// The value at the time t.
    pub(super) fn value(&self, time: f64) -> f64 {
        self.mean + self.pieces.iter().map(|piece| piece.value(time)).sum::<f64>()
    }

    /// The time derivative at the time t.
    pub(super) fn rate(&self, time: f64) -> f64 {
        self.pieces.iter().map(|piece| piece.rate(time)).sum()
    }
}

impl Piece {
    /// The piece of a wave that contains a time.
    fn at(wave: &Wave, middle: f64) -> Self {
        let &Wave { ref waveform, amplitude, frequency, phase, envelope: _ } = wave;
        if *waveform == Waveform::Sine {
            return Self::Sine { amplitude, frequency, phase };
        }
        let slope = amplitude * frequency * waveform.slope(frequency * middle + phase);
        Self::Line { value: wave.value(middle), slope, middle }
    }

    fn value(self, time: f64) -> f64 {
        match self {
            Self::Sine { amplitude, frequency, phase } => {
                amplitude * (frequency * time + phase).sin()
            }
            Self::Line { value, slope, middle } => value + slope * (time - middle),
        }
    }

    fn rate(self, time: f64) -> f64 {
        match self {
            Self::Sine { amplitude, frequency, phase } => {
                amplitude * frequency * (frequency * time + phase).cos()
            }
            Self::Line { slope, .. } => slope,
        }
    }
}

/// The first kink or jump of a profile after a time; infinite if the profile is smooth.
///
/// Breaks within 1e-9 of that time count as the break at that time.
pub(super) fn next_break(profile: &Profile, after: f64) -> f64 {
    let mut first = f64::INFINITY;
    for wave in profile.waves() {
        for at in wave.waveform.breaks() {
            let earlier = ((wave.frequency * after + wave.phase - at) / TAU).floor();
            for cycle in [earlier, earlier + 1.0, earlier + 2.0] {
                let time = (TAU * cycle + at - wave.phase) / wave.frequency;
                if time > after + 1e-9 {
                    first = first.min(time);
                }
            }
        }
    }
    first
}

/// Whether a profile jumps somewhere.
pub(super) fn jumps(profile: &Profile) -> bool {
    profile.waves().iter().any(|wave| wave.waveform == Waveform::Square)
}
