//! Dither: a fast force added to the system.

use crate::Invalid;
use crate::parameter::{
    DITHER_AMPLITUDE, DITHER_FREQUENCY_RATIO, DITHER_PHASE, indexed, split_index,
};
use crate::profile::{Knots, Wave};
use crate::waveform::{WaveSine, Waveform};

/// Direction of a dither force.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Direction {
    /// Along the belt, on the mass (chapters 2 and 3).
    Tangential,
    /// On the normal load (chapter 4).
    Normal,
}

impl Direction {
    /// Both directions.
    pub const ALL: &'static [Self] = &[Self::Tangential, Self::Normal];

    /// Name in a study file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tangential => "tangential",
            Self::Normal => "normal",
        }
    }

    /// The direction of a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|direction| direction.name() == name)
    }
}

/// D g(Rτ + φ), added to the tangential force or to the normal load.
#[derive(Clone, Debug, PartialEq)]
pub struct Dither {
    /// Along the belt or on the normal load.
    pub direction: Direction,
    /// Waveform g.
    pub waveform: Waveform,
    /// Peak amplitude D = A/k, a length, ≥ 0.
    pub amplitude: f64,
    /// Frequency ratio R = ω/ω₀ > 0; of noise that of the middle of its band.
    pub frequency_ratio: f64,
    /// Phase φ at τ = 0, radians.
    pub phase: f64,
    /// Share of the amplitude over time; `None` for the whole amplitude at all times.
    pub envelope: Option<Knots>,
}

impl Dither {
    /// The force as a wave of a profile.
    pub fn wave(&self) -> Wave {
        Wave {
            waveform: self.waveform.clone(),
            amplitude: self.amplitude,
            frequency: self.frequency_ratio,
            phase: self.phase,
            envelope: self.envelope.clone(),
        }
    }

    /// α = D/R, the amplitude of the fast velocity in the limit of high frequency (2.21).
    pub fn amplitude_ratio(&self) -> f64 {
        self.amplitude / self.frequency_ratio
    }

    /// Frequency ratio at which the force repeats itself: R, of a burst R over its cycles of the carrier.
    pub fn repetition_ratio(&self) -> f64 {
        self.frequency_ratio / f64::from(self.waveform.cycles())
    }

    /// The highest frequency ratio of the force: R, of a sum of harmonics or lines that of the highest one.
    pub fn highest_ratio(&self) -> f64 {
        self.frequency_ratio * self.waveform.highest_multiple()
    }

    /// The frequency ratio that the samples of a motion must resolve: the highest ratio; of a wave of samples, whose spectrum has no end,
    /// at least the root mean square frequency of the impulse that it gives to a mass, √(⟨g²⟩/⟨G²⟩) R.
    pub fn resolved_ratio(&self) -> f64 {
        let highest = self.highest_ratio();
        if !matches!(self.waveform, Waveform::Samples(_)) {
            return highest;
        }
        let mean_square = self.waveform.mean_square_integral();
        let multiple = self.waveform.root_mean_square() / mean_square.sqrt();
        highest.max(self.frequency_ratio * multiple)
    }

    /// R, of noise the frequency ratio of its first line: what must be high for averaging.
    pub fn lowest_ratio(&self) -> f64 {
        self.frequency_ratio * self.waveform.lowest_multiple()
    }

    /// The sines of which a dither by harmonics or lines consists, or the dither itself.
    pub fn by_harmonics(&self) -> Vec<Self> {
        let Some(sines) = self.waveform.sines() else { return vec![self.clone()] };
        let sine = |sine: &WaveSine| Self {
            direction: self.direction,
            waveform: Waveform::Sine,
            amplitude: self.amplitude * sine.amplitude,
            frequency_ratio: sine.multiple * self.frequency_ratio,
            phase: sine.multiple.mul_add(self.phase, sine.phase),
            envelope: self.envelope.clone(),
        };
        sines.iter().map(sine).collect()
    }

    /// The same dither in which the seed of noise is greater by a number; beyond the largest seed it continues from 0.
    #[must_use]
    pub fn reseeded(&self, by: u64) -> Self {
        Self { waveform: self.waveform.reseeded(by), ..self.clone() }
    }

    /// Errors of this dither as entry `index` of a list of `count`.
    pub(crate) fn complaints(&self, index: usize, count: usize) -> Vec<Invalid> {
        [
            (DITHER_AMPLITUDE, self.amplitude),
            (DITHER_FREQUENCY_RATIO, self.frequency_ratio),
            (DITHER_PHASE, self.phase),
        ]
        .into_iter()
        .filter_map(|(parameter, value)| parameter.check(value).err())
        .map(|mut complaint| {
            if let Some((_, key)) = split_index(&complaint.key, "dither") {
                complaint.key = indexed("dither", index, count, key);
            }
            complaint
        })
        .collect()
    }
}
