//! The level of a steady response in the frequency band of a study.

use std::f64::consts::TAU;

use quell_dynamics::response::SettledRecord;
use quell_model::units::Quantity;

use super::MeasuredResponse;
use crate::fields::Fields;
use crate::run::effect_words::MOST_DECIBELS;
use crate::run::system::frequency_in_words;
use crate::study::SystemStudy;

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
            let resolved = frequency_in_words(study.units(), resolved);
            let why = format!(
                "the band is narrower than the resolution of the record, {resolved}; raise --record"
            );
            return Some(InBand { band, values: Err(why) });
        }
        let values = both.ok_or_else(|| {
            let last = self.response.dithered.spectrum.frequencies().last().unwrap_or_default();
            let last = frequency_in_words(study.units(), last);
            format!("the record has no frequencies above {last}")
        });
        Some(InBand { band, values })
    }

    /// Adds the levels in the band; null without a band.
    pub(super) fn put_band(&self, study: &SystemStudy, fields: &mut Fields) {
        let band = self.in_band(study);
        let band =
            band.as_ref().ok_or_else(|| "the study does not define a frequency band".to_owned());
        let end = |place: usize| band.clone().map(|band| band.band[place]);
        fields.known("band_from", Quantity::FrequencyRatio, end(0)).known(
            "band_to",
            Quantity::FrequencyRatio,
            end(1),
        );
        let values = band.and_then(|band| band.values.clone());
        let names = [("displacement", Quantity::Displacement), ("velocity", Quantity::Velocity)];
        for (place, (name, quantity)) in names.into_iter().enumerate() {
            let both = values.clone().map(|(with, without)| (with[place], without[place]));
            let (with, without) =
                (both.clone().map(|pair| pair.0), both.clone().map(|pair| pair.1));
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
    pub values: Result<([f64; 2], [f64; 2]), String>,
}

/// A change of level in a sentence.
fn decibels(size: f64) -> String {
    if size > MOST_DECIBELS {
        format!("more than {MOST_DECIBELS} dB")
    } else {
        format!("{size:.1} dB")
    }
}

/// 20 lg of two root mean squares, in dB.
fn level(with: f64, without: f64) -> Result<f64, String> {
    if without == 0.0 {
        return Err("nothing vibrates in the band without dither".to_owned());
    }
    if with == 0.0 {
        return Err("nothing vibrates in the band with dither".to_owned());
    }
    Ok(20.0 * (with / without).log10())
}
