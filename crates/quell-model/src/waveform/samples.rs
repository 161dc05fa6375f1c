//! One period by samples: value i at i/n of the period, joined by straight lines or held until the next sample.

use std::f64::consts::TAU;

use super::WaveformError;
use super::shape::Piece;
use super::table::WaveTable;

/// Most samples of a period, whose table takes about 50 MB (48 bytes each).
pub(super) const MOST_SAMPLES: usize = 1_000_000;

/// What is between two samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Hold {
    /// A straight line; the last sample is joined to the first.
    #[default]
    Linear,
    /// The value of the sample, as from a controller.
    Zero,
}

impl Hold {
    /// Both, in the order of their names.
    pub const ALL: &'static [Self] = &[Self::Linear, Self::Zero];

    /// Name in a study file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::Zero => "zero",
        }
    }

    /// The hold of a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|hold| hold.name() == name)
    }
}

/// A waveform by samples, without its mean.
#[derive(Clone, Debug, PartialEq)]
pub struct SampledWave {
    values: Vec<f64>,
    hold: Hold,
    mean: f64,
    table: WaveTable,
}

impl SampledWave {
    /// The waveform of samples at equal distances; their mean is taken out, and nothing is scaled.
    ///
    /// # Errors
    /// Fewer than two samples, more than a million, a sample that is not finite, or samples that are all equal.
    pub fn new(values: Vec<f64>, hold: Hold) -> Result<Self, WaveformError> {
        let wrong = |allowed: String| Err(WaveformError { key: "values", allowed });
        if !(2..=MOST_SAMPLES).contains(&values.len()) {
            return wrong(format!("a list of 2 to {MOST_SAMPLES} samples; got {}", values.len()));
        }
        if let Some(place) = values.iter().position(|value| !value.is_finite()) {
            return wrong(format!("finite numbers; sample {place} is not"));
        }
        let count = values.len();
        // Around the first sample, so that equal samples have exactly their value as mean.
        let offsets: f64 = values.iter().map(|value| value - values[0]).sum();
        let mean = values[0] + offsets / count as f64;
        if !mean.is_finite() || values.iter().all(|value| *value == values[0]) {
            return wrong(
                "samples that differ: without its mean a constant is no dither".to_owned(),
            );
        }
        Ok(Self::of(values, hold, mean))
    }

    /// −g.
    pub(super) fn negated(&self) -> Self {
        Self::of(self.values.iter().map(|value| -value).collect(), self.hold, -self.mean)
    }

    fn of(values: Vec<f64>, hold: Hold, mean: f64) -> Self {
        let count = values.len();
        let step = TAU / count as f64;
        let breaks: Vec<f64> =
            (0..count).map(|place| TAU * (place as f64 / count as f64)).collect();
        let pieces = (0..count).map(|place| {
            let (value, next) = (values[place] - mean, values[(place + 1) % count] - mean);
            match hold {
                Hold::Linear => Piece::Affine { value, slope: (next - value) / step },
                Hold::Zero => Piece::Affine { value, slope: 0.0 },
            }
        });
        let table = WaveTable::new(breaks, pieces.collect(), TAU);
        Self { values, hold, mean, table }
    }

    /// The samples as given.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// What is between them.
    pub fn hold(&self) -> Hold {
        self.hold
    }

    /// The mean that was taken out.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    pub(super) fn table(&self) -> &WaveTable {
        &self.table
    }
}
