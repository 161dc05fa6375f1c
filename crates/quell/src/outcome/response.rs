//! `response`: the steady response, the effect of the dither and its cost.

use std::fmt::Write as _;

use quell_model::units::Quantity;
use quell_numerics::order::descending_by;
use serde_json::Value as Json;

use super::Presented;
use super::table::{TextTable, figure};
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::picture;
use crate::plot::Figure;
use crate::run::response::MeasuredResponse;
use crate::study::{BeltSetup, BeltStudy};

impl Presented<BeltSetup> for MeasuredResponse {
    fn json(&self, study: &BeltStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &BeltStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, study: &BeltStudy) -> String {
        table(study, self)
    }

    fn datasets(&self, study: &BeltStudy) -> Vec<(&'static str, Dataset)> {
        vec![("record", self.record(study)), ("spectrum", self.spectrum(study))]
    }

    fn figure(&self, study: &BeltStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::response(study, self)))
    }
}

/// Largest number of peaks in the table; JSON has them all.
const PEAKS: usize = 8;

fn table(study: &BeltStudy, done: &MeasuredResponse) -> String {
    let response = &done.response;
    let mut table = TextTable::new(study.scales());
    table.word("effect", response.effect.name());
    table.word("ends on", response.ending.name());
    table.known(
        "residual vibration E",
        Quantity::Ratio,
        response.residual_vibration.map_err(|why| why.to_string()),
    );
    table.number("amplitude M", Quantity::Displacement, response.amplitude);
    table.number("undithered amplitude M₀", Quantity::Displacement, response.undithered_amplitude);
    table.known("stick fraction", Quantity::Ratio, done.stick_fraction(study));
    table.word("settled", if response.settled { "yes" } else { "no" });
    table.number("mean friction", Quantity::Force, response.mean_friction);
    table.number("  without dither", Quantity::Force, response.mean_friction_undithered);
    table.number("  in steady sliding", Quantity::Force, response.steady_sliding_friction);
    table.known("friction loss", Quantity::Ratio, done.friction_loss());
    let only_normal = || "all dither is normal".to_owned();
    table.known("dither power", Quantity::Power, response.dither_power.ok_or_else(only_normal));
    table.known("dither stroke", Quantity::Displacement, done.dither_stroke(study, only_normal));
    table.number("smallest normal load", Quantity::Force, response.minimum_normal_load);
    let mut text = table.text();
    if !response.peaks.is_empty() {
        text.push_str("\nPeaks of the spectrum, largest first:\n");
        let mut peaks = response.peaks.clone();
        descending_by(&mut peaks, |a| a.amplitude);
        let hertz = study.scales().map(|scales| scales.per_unit(Quantity::FrequencyRatio));
        for peak in peaks.iter().take(PEAKS) {
            let hertz = hertz.map(|hertz| format!(" ({} Hz)", figure(peak.frequency * hertz)));
            let unit = study.scales().and_then(|scales| scales.unit(Quantity::Displacement));
            let unit = unit.unwrap_or("length");
            let (frequency, amplitude) = (figure(peak.frequency), figure(peak.amplitude));
            let hertz = hertz.unwrap_or_default();
            let _ = writeln!(text, "  {amplitude:>12} {unit} at {frequency} ω₀{hertz}");
        }
    }
    text
}
