//! `atlas`: the thresholds of a belt from the tables, and the tables.

use std::fmt::Write as _;

use quell_design::atlas::{
    Atlas, AtlasAnswer, AtlasChange, AtlasLaw, AtlasPoint, RANGE, WAVEFORMS,
};
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::table::figure;
use super::{Outcome, Presented};
use crate::complaint::Failure;
use crate::dataset::{Array, Dataset};
use crate::input::Inputs;
use crate::picture;
use crate::plot::Figure;
use crate::run::atlas::{
    AtlasFound, AtlasTables, DAMPINGS_PER_CYCLE, FREQUENCY_RATIOS, RELATIVE_DAMPINGS,
    VELOCITY_SHARES, round_numbers,
};
use crate::study::{BeltSetup, BeltStudy};

/// Number of speeds of the curves of a study.
const SPEEDS: usize = 99;

/// Extension of the file of the tables.
const TEXT: &str = "txt";

impl Presented<BeltSetup> for AtlasFound {
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
        vec![("atlas", curves(study, self))]
    }

    fn figure(&self, study: &BeltStudy) -> Option<Result<Figure, Failure>> {
        Some(picture::atlas(study, self))
    }
}

impl Outcome for AtlasTables {
    fn inputs(&self) -> Inputs {
        Inputs::NONE
    }

    fn json(&self) -> Json {
        self.json()
    }

    fn sentence(&self) -> Option<String> {
        Some(self.sentence())
    }

    fn table(&self) -> String {
        errors(self)
    }

    fn datasets(&self) -> Vec<(&'static str, Dataset)> {
        vec![("atlas", round_table(&self.atlas))]
    }

    fn exported(&self, extension: &str) -> Option<Result<Vec<u8>, Failure>> {
        (extension == TEXT).then(|| Ok(self.atlas.text().into_bytes()))
    }

    fn figure(&self) -> Option<Result<Figure, Failure>> {
        Some(picture::atlas_tables())
    }
}

/// The groups, and one line per change.
fn table(study: &BeltStudy, found: &AtlasFound) -> String {
    let point = &found.answer.point;
    let mut text = format!(
        "  {} law, {} dither: κ = {}, v₀/v_m = {}, R = {}, ζ_f/R = {}\n",
        point.law.name(),
        point.waveform.name(),
        figure(point.relative_damping),
        figure(point.relative_velocity),
        figure(point.frequency_ratio),
        figure(point.damping_per_cycle())
    );
    let (unit, scale) = match study.scales().and_then(|scales| scales.one(Quantity::Force)) {
        Some((one, unit)) => (format!("amplitude/{unit}"), one),
        None => ("amplitude D".to_owned(), 1.0),
    };
    let _ = writeln!(
        text,
        "  {unit:>14}  {:>12}  {:>12}  {:>12}  {:>14}  {:<15}  above",
        "D/v_m", "α/v_m", "error", "exact", "kind"
    );
    let mut row = |relative: f64, error: Option<f64>, exact: Option<f64>, words: [&str; 2]| {
        let number = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), figure);
        let _ = writeln!(
            text,
            "  {:>14}  {:>12}  {:>12}  {:>12}  {:>14}  {:<15}  {}",
            figure(scale * found.amplitude(relative)),
            figure(relative),
            figure(relative / point.frequency_ratio),
            error.map_or_else(|| "unknown".to_owned(), |error| format!("{error:.1e}")),
            number(exact.map(|exact| scale * exact)),
            words[0],
            words[1]
        );
    };
    for change in &found.answer.changes {
        let verdict = if change.becomes_quiet { "stable" } else { "unstable" };
        let exact = found.exact_of(change).ok().map(|exact| exact.amplitude);
        row(change.amplitude, change.relative_error(), exact, [change.kind.name(), verdict]);
    }
    if found.answer.changes.is_empty() {
        let (grazing, error) = found.answer.grazing;
        row(grazing, Some(error / grazing), None, ["grazing", "stable"]);
    }
    text
}

/// Grazing, quench and lost amplitude over the belt's speed, at the other groups of a study.
fn curves(study: &BeltStudy, found: &AtlasFound) -> Dataset {
    let point = &found.answer.point;
    let largest = point.law.largest_velocity();
    let (low, high) = RANGE.velocity_share;
    let share = |k: usize| (high - low).mul_add(k as f64 / (SPEEDS - 1) as f64, low);
    let speeds: Vec<f64> = (0..SPEEDS).map(|k| share(k) * largest).collect();
    let answers: Vec<Option<AtlasAnswer>> = speeds
        .iter()
        .map(|speed| {
            Atlas::shipped().answer(&AtlasPoint { relative_velocity: *speed, ..point.clone() })
        })
        .collect();
    let each = |of: fn(&AtlasAnswer) -> Option<f64>| -> Vec<f64> {
        let value = |answer: &Option<AtlasAnswer>| answer.as_ref().and_then(of);
        let scaled = |value: Option<f64>| value.map_or(f64::NAN, |value| found.amplitude(value));
        answers.iter().map(|answer| scaled(value(answer))).collect()
    };
    let speeds = speeds.into_iter().map(|speed| found.amplitude(speed)).collect();
    Dataset::new(study, "atlas")
        .fact(found.sentence(study))
        .axis("belt_velocity", Quantity::Velocity, speeds)
        .array("grazing_curve", Quantity::Force, each(|answer| Some(answer.grazing.0)))
        .array("quench_curve", Quantity::Force, each(|answer| Some(quench(answer))))
        .array("lost_curve", Quantity::Force, each(lost))
}

/// The amplitude from which every larger one is quiet: 0 where every amplitude is.
fn quench(answer: &AtlasAnswer) -> f64 {
    answer.last().map_or(0.0, |change| change.amplitude)
}

fn lost(answer: &AtlasAnswer) -> Option<f64> {
    answer.lost().map(|change| change.amplitude)
}

/// The thresholds at round numbers of the groups.
fn round_table(atlas: &Atlas) -> Dataset {
    let answers = round_numbers(atlas);
    let each = |of: &dyn Fn(&AtlasAnswer) -> Option<f64>| -> Vec<f64> {
        let value = |answer: &Option<AtlasAnswer>| answer.as_ref().and_then(of);
        answers.iter().map(|answer| value(answer).unwrap_or(f64::NAN)).collect()
    };
    let words = |name: &str, words: Vec<&'static str>| {
        let codes: Vec<u8> = (0..).take(words.len()).collect();
        Array::of_words(name, codes.iter().copied().zip(words).collect(), &codes)
    };
    let numbers = |name: &str, values: &[f64]| Array::new(name, "1", values.to_vec());
    Dataset::without_study("atlas")
        .fact("the base response: quiet from quench_amplitude on; where lost_amplitude has a value, quiet below it too")
        .with_axis(words("law", AtlasLaw::ALL.map(AtlasLaw::name).to_vec()))
        .with_axis(words("waveform", WAVEFORMS.iter().map(quell_model::Waveform::name).collect()))
        .with_axis(numbers("frequency_ratio", &FREQUENCY_RATIOS))
        .with_axis(numbers("friction_damping_per_cycle", &DAMPINGS_PER_CYCLE))
        .with_axis(numbers("relative_damping", &RELATIVE_DAMPINGS))
        .with_axis(numbers("velocity_share", &VELOCITY_SHARES))
        .with(Array::new("relative_velocity", "1", each(&|answer| Some(answer.point.relative_velocity))))
        .with(Array::new("grazing_amplitude", "1", each(&|answer| Some(answer.grazing.0))))
        .with(Array::new("quench_amplitude", "1", each(&|answer| Some(quench(answer)))))
        .with(Array::new("lost_amplitude", "1", each(&lost)))
        .with(Array::new("relative_error", "1", each(&error)))
}

/// The largest relative error of the changes of an answer.
fn error(answer: &AtlasAnswer) -> Option<f64> {
    let errors = answer.changes.iter().map(AtlasChange::relative_error);
    errors.collect::<Option<Vec<f64>>>().map(|errors| errors.into_iter().fold(0.0, f64::max))
}

/// The errors of the tables, one line each.
fn errors(done: &AtlasTables) -> String {
    let mut text = format!(
        "  {:<19}  {:<8}  {:<15}  {:>12}  {:>8}  {:>8}  {:>8}\n",
        "law", "waveform", "surface", "ζ_f/R", "median", "90 %", "largest"
    );
    for errors in &done.atlas.errors {
        let (low, high) = errors.band;
        let [median, most, largest] = errors.quantiles;
        let _ = writeln!(
            text,
            "  {:<19}  {:<8}  {:<15}  {:>12}  {median:>8.1e}  {most:>8.1e}  {largest:>8.1e}",
            errors.law.name(),
            errors.waveform.name(),
            errors.surface.name(),
            format!("{low} to {high}")
        );
    }
    text
}
