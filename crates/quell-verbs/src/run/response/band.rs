//! The level of a steady response in the frequency band of a study.

use std::f64::consts::TAU;
use std::fmt;

use quell_dynamics::response::SettledRecord;
use quell_model::units::Quantity;

use super::MeasuredResponse;
use crate::fields::Fields;
use crate::run::effect_words::MOST_DECIBELS;
use crate::run::system::frequency_in_words;
use crate::study::{SystemStudy, UnitSystem};

impl MeasuredResponse {
    /// The levels in the frequency band of the study.
    pub fn in_band(&self, study: &SystemStudy) -> Option<InBand> {
        let band = study.record().band?;
        let [low, high] = band;
        let of = |record: &SettledRecord| record.spectrum.root_mean_square(low, high);
        let both = of(&self.response.dithered).zip(of(&self.response.undithered));
        // The window spreads a tone over four lines of the unpadded record.
        let resolved = 4.0 * TAU / self.plan.length;
        if high - low < resolved {
            let why = NoBandLevel::TooNarrow { resolved, units: study.units() };
            return Some(InBand { band, values: Err(why) });
        }
        let values = both.ok_or_else(|| {
            let last = self.response.dithered.spectrum.frequencies().last().unwrap_or_default();
            NoBandLevel::BeyondRecord { last, units: study.units() }
        });
        Some(InBand { band, values })
    }

    /// Adds the levels in the band; null without a band.
    pub(super) fn put_band(&self, study: &SystemStudy, fields: &mut Fields) {
        let band = self.in_band(study);
        let band = band.as_ref().ok_or(NoBandLevel::NoBand);
        let end = |place: usize| band.map(|band| band.band[place]);
        fields.known("band_from", Quantity::FrequencyRatio, end(0)).known(
            "band_to",
            Quantity::FrequencyRatio,
            end(1),
        );
        let values = band.and_then(|band| band.values);
        let names = [("displacement", Quantity::Displacement), ("velocity", Quantity::Velocity)];
        for (place, (name, quantity)) in names.into_iter().enumerate() {
            let both = values.map(|(with, without)| (with[place], without[place]));
            let (with, without) = (both.map(|pair| pair.0), both.map(|pair| pair.1));
            let level = both.and_then(|(with, without)| level(with, without));
            fields
                .known(&format!("band_{name}_rms"), quantity, with)
                .known(&format!("band_undithered_{name}_rms"), quantity, without)
                .known(&format!("band_{name}_level_db"), Quantity::Ratio, level);
        }
    }

    /// The levels in the band in a sentence of its own.
    pub(super) fn band_in_words(&self, study: &SystemStudy) -> Option<String> {
        let InBand { band, values } = self.in_band(study)?;
        let [low, high] = band.map(|end| frequency_in_words(study.units(), end));
        let levels = values.and_then(|(with, without)| {
            Ok([level(with[0], without[0])?, level(with[1], without[1])?])
        });
        let change = match levels {
            Ok([displacement, velocity]) => {
                let change = |level: f64| {
                    let way = if level > 0.0 { "rises" } else { "falls" };
                    format!("{way} by {}", decibels(level.abs()))
                };
                format!(
                    "the displacement level {} and the velocity level {}",
                    change(displacement),
                    change(velocity)
                )
            }
            Err(why) => format!("the level is undefined: {why}"),
        };
        Some(format!("From {low} to {high} {change}."))
    }
}

/// Levels in a frequency band.
#[derive(Clone, Debug, PartialEq)]
pub struct InBand {
    /// Its ends, angular frequencies.
    pub band: [f64; 2],
    /// Root mean square of displacement and velocity, with and without dither; or why they are undefined.
    pub values: Result<([f64; 2], [f64; 2]), NoBandLevel>,
}

/// Why the level in a frequency band is undefined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoBandLevel {
    /// The study has no band.
    NoBand,
    /// The record does not resolve the band.
    TooNarrow {
        /// The angular frequency that it resolves.
        resolved: f64,
        /// The units of the study.
        units: UnitSystem,
    },
    /// The band begins beyond the spectrum of the record.
    BeyondRecord {
        /// The largest angular frequency of the spectrum.
        last: f64,
        /// The units of the study.
        units: UnitSystem,
    },
    /// Without dither nothing vibrates in the band.
    QuietWithout,
    /// With dither nothing vibrates in the band.
    QuietWith,
}

impl fmt::Display for NoBandLevel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoBand => f.write_str("the study does not define a frequency band"),
            Self::TooNarrow { resolved, units } => {
                let resolved = frequency_in_words(*units, *resolved);
                write!(
                    f,
                    "the band is narrower than the resolution of the record, {resolved}; raise --record"
                )
            }
            Self::BeyondRecord { last, units } => {
                let last = frequency_in_words(*units, *last);
                write!(f, "the record has no frequencies above {last}")
            }
            Self::QuietWithout => f.write_str("nothing vibrates in the band without dither"),
            Self::QuietWith => f.write_str("nothing vibrates in the band with dither"),
        }
    }
}

impl std::error::Error for NoBandLevel {}

/// A change of level in a sentence.
fn decibels(size: f64) -> String {
    if size > MOST_DECIBELS {
        format!("more than {MOST_DECIBELS} dB")
    } else {
        format!("{size:.1} dB")
    }
}

/// 20 lg of two root mean squares, in dB.
fn level(with: f64, without: f64) -> Result<f64, NoBandLevel> {
    if without == 0.0 {
        return Err(NoBandLevel::QuietWithout);
    }
    if with == 0.0 {
        return Err(NoBandLevel::QuietWith);
    }
    Ok(20.0 * libm::log10(with / without))
}
