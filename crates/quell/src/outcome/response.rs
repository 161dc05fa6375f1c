//! `response`: the steady response, the effect of the dither and its cost.

use std::fmt::Write as _;

use quell_dynamics::response::PEAK_FLOOR;
use quell_model::units::Quantity;
use quell_numerics::order::descending_by;
use serde_json::Value as Json;

use super::Presented;
use super::table::{figure, figure_in_units};
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::picture;
use crate::plot::Figure;
use crate::run::response::MeasuredResponse;
use crate::run::system::attractor::in_words;
use crate::run::system::oscillating;
use crate::study::{SystemSetup, SystemStudy};

/// Lines of the spectrum in the text; JSON has them all.
const PEAKS: usize = 4;

impl Presented<SystemSetup> for MeasuredResponse {
    const NAME: &'static str = "response";
    const TITLED: bool = true;

    fn json(&self, study: &SystemStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn notes(&self, study: &SystemStudy) -> Vec<String> {
        self.notes(study)
    }

    fn table(&self, study: &SystemStudy) -> String {
        let with = |quantity, value| figure_in_units(study.units(), quantity, value);
        let mut text = String::new();
        let records = [
            ("with dither", &self.response.dithered),
            ("without dither", &self.response.undithered),
        ];
        let first = usize::from(!self.response.has_dither());
        for (name, record) in &records[first..] {
            let length = |value| with(Quantity::Displacement, value);
            let _ = writeln!(
                text,
                "  {name}: slow amplitude {}, half peak-to-peak {}, rms {}, mean {}",
                length(record.lines.whole),
                length(0.5 * record.observed.range()),
                length(record.observed.deviation()),
                length(record.observed.mean())
            );
        }
        let ending = &self.response.dithered.ending;
        let found = ending.motion().map(|found| in_words(found, study.units()));
        let _ = writeln!(
            text,
            "  ends on: {}",
            found.unwrap_or_else(|| ending.name().replace('-', " "))
        );
        let mut peaks = self.response.dithered.spectrum.peaks(PEAK_FLOOR);
        descending_by(&mut peaks, |peak| peak.amplitude);
        let lines = peaks.iter().take(PEAKS).map(|peak| {
            let size = with(Quantity::Displacement, peak.amplitude);
            format!("{size} {}", oscillating(study.units(), peak.frequency))
        });
        let lines: Vec<String> = lines.collect();
        if !lines.is_empty() {
            let _ = writeln!(text, "  largest lines of the spectrum: {}", lines.join(", "));
        }
        for (contact, means) in study.system().contacts.iter().zip(&self.response.dithered.contacts)
        {
            let _ = writeln!(
                text,
                "  contact {}: mean friction {}, in stick {} of the time, open {}, friction power {}",
                contact.name,
                with(Quantity::Force, means.friction),
                figure(means.stick_fraction),
                figure(means.open_fraction),
                with(Quantity::Power, means.friction_power)
            );
        }
        for (index, cost) in self.response.dithered.inputs.iter().enumerate() {
            let in_series = match &cost.in_series {
                Some(Ok(series)) => format!(
                    "; actuator in series with the contact: power {}, stroke {}",
                    with(Quantity::Power, series.power),
                    with(Quantity::Displacement, series.stroke)
                ),
                Some(Err(why)) => format!("; actuator in series with the contact unknown: {why}"),
                None => String::new(),
            };
            let fed = match &cost.fed {
                Ok(fed) => format!(
                    "power {}, stroke {}",
                    with(Quantity::Power, fed.power),
                    with(Quantity::Displacement, fed.stroke)
                ),
                Err(why) => format!("power unknown: {}", why.why()),
            };
            let cost = fed + &in_series;
            let _ = writeln!(text, "  dither[{index}]: {cost}");
        }
        text
    }

    fn datasets(&self, study: &SystemStudy) -> Vec<(&'static str, Dataset)> {
        vec![("record", self.record(study)), ("spectrum", self.spectrum(study))]
    }

    fn figure(&self, study: &SystemStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::response(study, self)))
    }
}
