//! `compare`: lines and levels of a measured record against those of a study, and the reduction by its dither.

use std::fmt::Write as _;

use serde_json::Value as Json;

use super::Outcome;
use super::read_file::{read, read_in_words};
use super::table::figure;
use crate::complaint::Failure;
use crate::dataset::{Array, Dataset};
use crate::fields::Fields;
use crate::input::Inputs;
use crate::picture;
use crate::plot::Figure;
use crate::run::compare::{ComparedLine, ComparedRecord, Comparison, Reduction, decibels};
use crate::study::Study;
use crate::words::counted;

/// A comparison with its study.
#[derive(Clone, Debug)]
pub struct ComparedStudy {
    /// The study.
    pub study: Study,
    /// The result.
    pub done: Comparison,
}

/// Decibels in a sentence.
fn in_decibels(value: f64) -> String {
    if value.is_finite() {
        format!("{value:.1} dB")
    } else {
        "an unlimited number of dB".to_owned()
    }
}

impl Outcome for ComparedStudy {
    fn inputs(&self) -> Inputs {
        let files = std::iter::once(&self.done.before).chain(&self.done.after);
        self.study.inputs().with_files(files.map(|record| record.file.as_path()))
    }

    fn name(&self) -> &'static str {
        "comparison"
    }

    fn json(&self) -> Json {
        let mut fields = Fields::new();
        fields.plain("ok", true).plain("sentence", sentence(&self.done));
        fields.nested("before", record(&self.done.before));
        match &self.done.after {
            Some(after) => fields.nested("after", record(after)),
            None => fields.unknown("after", NO_SECOND),
        };
        for (name, found) in
            [("reduction", self.done.reduction()), ("slow_reduction", self.done.slow_reduction())]
        {
            match found {
                Some(found) => fields.nested(name, reduction(found)),
                None if self.done.after.is_none() => fields.unknown(name, NO_SECOND),
                None => fields.unknown(
                    name,
                    "the record is too short to separate vibration below the dither",
                ),
            };
        }
        fields.plain("warnings", warnings(&self.done));
        fields.finish()
    }

    fn title(&self) -> Option<&str> {
        self.study.title()
    }

    fn sentence(&self) -> Option<String> {
        Some(sentence(&self.done))
    }

    fn table(&self) -> String {
        let mut text = table(&self.done.before);
        text += &self.done.after.as_ref().map(table).unwrap_or_default();
        for (name, found) in [
            ("reduction of the whole vibration", self.done.reduction()),
            ("reduction below the dither", self.done.slow_reduction()),
        ] {
            let Some(found) = found else { continue };
            let _ = writeln!(
                text,
                "  {name:<34}  measured {:>10}  predicted {:>10}",
                in_decibels(found.measured),
                in_decibels(found.predicted)
            );
        }
        text
    }

    fn datasets(&self) -> Vec<(&'static str, Dataset)> {
        let mut found = vec![("before", self.dataset(&self.done.before, ""))];
        found
            .extend(self.done.after.as_ref().map(|after| ("after", self.dataset(after, "_after"))));
        found
    }

    fn figure(&self) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::compare(&self.study, &self.done)))
    }
}

/// Why there is no reduction.
const NO_SECOND: &str = "one file alone shows no reduction: --after takes the one under dither";

impl ComparedStudy {
    /// Lines of the computed spectrum, and of the measured one where it has the same grid.
    fn dataset(&self, record: &ComparedRecord, ending: &str) -> Dataset {
        let named = |name: &str| format!("{name}{ending}");
        let unit = record.unit.unwrap_or("1");
        let (frequencies, measured): (Vec<f64>, Vec<f64>) =
            record.measured.lines().into_iter().unzip();
        let dataset = Dataset::of(&self.study, "compare")
            .fact(format!("data: {}", record.file.display()))
            .with_axis(Array::new(
                named("frequency"),
                record.frequency_unit.unwrap_or("1"),
                frequencies.clone(),
            ))
            .with(Array::new(named("measured"), unit, measured));
        let computed = record.computed.lines();
        let same = computed.len() == frequencies.len();
        // Lines of a file are at frequencies of their own.
        let at = |frequency: &f64| {
            let place = computed.partition_point(|(own, _)| own < frequency);
            computed.get(place.min(computed.len().saturating_sub(1))).map_or(0.0, |line| line.1)
        };
        let values = if same {
            computed.iter().map(|(_, amplitude)| *amplitude).collect()
        } else {
            frequencies.iter().map(at).collect()
        };
        dataset.with(Array::new(named("computed"), unit, values))
    }
}

fn sentence(done: &Comparison) -> String {
    let before = &done.before;
    let matched = before.lines.iter().filter(|line| line.difference().is_ok()).count();
    let first = format!(
        "{} of the {} {} in both spectra{}, and {}.",
        counted(matched, "line"),
        before.quantity.name(),
        if matched == 1 { "is" } else { "are" },
        if done.after.is_some() { " before the dither" } else { "" },
        levels_compared(before.rms)
    );
    let Some(found) = done.reduction() else { return first };
    let slow = done.slow_reduction().map_or_else(String::new, |slow| {
        format!(
            "; below the dither by {} where the study predicts {}",
            in_decibels(slow.measured),
            in_decibels(slow.predicted)
        )
    });
    format!(
        "{first} Under the dither the measured vibration is smaller by {} where the study predicts {}{slow}.",
        in_decibels(found.measured),
        in_decibels(found.predicted)
    )
}

/// How far a measured root mean square is above a computed one.
fn levels_compared([measured, computed]: [f64; 2]) -> String {
    match (measured > 0.0, computed > 0.0) {
        (true, true) => {
            let level = decibels(measured / computed);
            let side = if level >= 0.0 { "above" } else { "below" };
            format!("the measured level is {} {side} that of the study", in_decibels(level.abs()))
        }
        (false, true) => "nothing vibrates in the measured record".to_owned(),
        (true, false) => "nothing vibrates in the study".to_owned(),
        (false, false) => "nothing vibrates in the measured record or in the study".to_owned(),
    }
}

/// A level, or null where nothing vibrates.
fn put_decibels(fields: &mut Fields, name: &str, unit: &str, value: f64) {
    if value.is_finite() {
        fields.measured(name, unit, value);
    } else {
        fields.unknown(name, "nothing vibrates in one of the two");
    }
}

fn reduction(found: Reduction) -> Fields {
    let mut fields = Fields::new();
    put_decibels(&mut fields, "measured", "dB", found.measured);
    put_decibels(&mut fields, "predicted", "dB", found.predicted);
    put_decibels(&mut fields, "difference", "dB", found.measured - found.predicted);
    fields
}

fn record(record: &ComparedRecord) -> Fields {
    let unit = record.unit.unwrap_or("1");
    let hertz = record.frequency_unit.unwrap_or("1/time");
    let mut fields = Fields::new();
    fields
        .plain("file", record.file.display().to_string())
        .plain("columns", record.columns.to_vec())
        .plain("read", read(&record.read))
        .plain("recorded_quantity", record.quantity.name())
        .plain("dithered", record.dithered)
        .plain("window", "hann")
        .measured("resolution", hertz, record.resolution)
        .measured("highest", hertz, record.highest)
        .measured(
            "length",
            if record.frequency_unit.is_some() { "s" } else { "time" },
            record.length,
        )
        .measured("measured_rms", unit, record.rms[0])
        .measured("computed_rms", unit, record.rms[1]);
    put_decibels(&mut fields, "difference", "dB", decibels(record.rms[0] / record.rms[1]));
    if let Some([measured, computed]) = record.slow_rms {
        fields.measured("measured_slow_rms", unit, measured);
        fields.measured("computed_slow_rms", unit, computed);
    }
    let reference = format!("dB re 1 {}", record.unit.unwrap_or("unit of the readings"));
    let lines =
        record.lines.iter().map(|line| {
            let mut entry = Fields::new();
            entry.measured("frequency", hertz, line.frequency());
            let level = |peak: Option<quell_numerics::spectrum::Peak>| {
                peak.map(|peak| decibels(peak.amplitude))
            };
            match level(line.measured) {
                Some(value) => entry.measured("measured", &reference, value),
                None => entry.unknown("measured", "the record has no line there"),
            };
            match (level(line.computed), line.computed) {
                (Some(value), Some(peak)) => entry
                    .measured("computed", &reference, value)
                    .measured("computed_frequency", hertz, peak.frequency),
                _ => entry
                    .unknown("computed", "the study has no line there")
                    .unknown("computed_frequency", "the study has no line there"),
            };
            match line.difference() {
                Ok(value) => entry.measured("difference", "dB", value),
                Err(why) => entry.unknown("difference", why),
            };
            entry
        });
    fields.list("lines", lines.collect::<Vec<_>>());
    fields.plain("not_comparable", record.not_comparable.clone());
    fields
}

/// What cannot be compared, as warnings.
fn warnings(done: &Comparison) -> Vec<String> {
    let records = std::iter::once(&done.before).chain(&done.after);
    let mut found: Vec<String> = Vec::new();
    for record in records {
        for what in &record.not_comparable {
            let words = format!("not comparable in {}: {what}", record.file.display());
            if !found.contains(&words) {
                found.push(words);
            }
        }
    }
    found
}

fn table(record: &ComparedRecord) -> String {
    let mut text = format!(
        "  {} of {}, {}; window Hann, resolution {} {}, up to {} {}\n",
        record.quantity.name(),
        record.file.display(),
        if record.dithered { "with dither" } else { "without dither" },
        figure(record.resolution),
        record.hertz(),
        figure(record.highest),
        record.hertz()
    );
    if let Some(said) = read_in_words(&record.read) {
        let _ = writeln!(text, "  {said}");
    }
    let _ = writeln!(
        text,
        "  {:>14}{:>14}{:>14}{:>14}",
        record.frequency_unit.map_or("frequency".to_owned(), |unit| format!("frequency {unit}")),
        "measured dB",
        "computed dB",
        "difference dB"
    );
    let shown = |value: Option<f64>| value.map_or_else(|| "—".to_owned(), |v| format!("{v:.2}"));
    for line in &record.lines {
        let level = |peak: Option<quell_numerics::spectrum::Peak>| {
            peak.map(|peak| decibels(peak.amplitude))
        };
        let _ = writeln!(
            text,
            "  {:>14}{:>14}{:>14}{:>14}",
            figure(line.frequency()),
            shown(level(line.measured)),
            shown(level(line.computed)),
            shown(ComparedLine::difference(line).ok())
        );
    }
    let level = |ratio: f64| shown(Some(decibels(ratio)).filter(|level| level.is_finite()));
    let _ = writeln!(
        text,
        "  {:>14}{:>14}{:>14}{:>14}",
        "rms",
        level(record.rms[0]),
        level(record.rms[1]),
        level(record.rms[0] / record.rms[1])
    );
    text
}
