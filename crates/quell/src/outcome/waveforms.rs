//! `waveforms`: the least dither of each waveform and its cost.

use std::fmt::Write as _;

use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::Presented;
use super::table::figure;
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::picture;
use crate::plot::Figure;
use crate::run::waveforms::{COLUMNS, ComparedWaveform, WaveformComparison};
use crate::study::{BeltSetup, BeltStudy};

impl Presented<BeltSetup> for WaveformComparison {
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
        vec![("waveforms", self.dataset(study))]
    }

    fn figure(&self, study: &BeltStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::waveforms(study, self)))
    }
}

/// One line per waveform; the smallest value of each column has an asterisk.
fn table(study: &BeltStudy, done: &WaveformComparison) -> String {
    let scale = |quantity: Quantity| match study.scales().zip(quantity.si_unit()) {
        Some((scales, (unit, _))) => (scales.si_per_unit(quantity), format!(" {unit}")),
        None => (1.0, String::new()),
    };
    let width = done.rows.iter().map(|row| row.label().chars().count()).max().unwrap_or(0);
    let mut text = format!("  {:<width$}  {:>10}", "waveform", "duty cycle");
    for column in &COLUMNS {
        let heading = format!("{}{}", column.words, scale(column.quantity).1);
        let _ = write!(text, "  {heading:>14}");
    }
    let _ = writeln!(text, "  {:>14}", "exact");
    for row in &done.rows {
        let _ = write!(text, "  {:<width$}  {:>10}", row.label(), figure(row.duty_cycle));
        for column in &COLUMNS {
            let best = done.best(column).is_some_and(|best| std::ptr::eq(best, row));
            let cell = row.value(column).map_or_else(
                |_| "none".to_owned(),
                |value| {
                    let mark = if best { "*" } else { "" };
                    format!("{}{mark}", figure(value * scale(column.quantity).0))
                },
            );
            let _ = write!(text, "  {cell:>14}");
        }
        let exact = row.exact.as_ref();
        let exact = exact
            .map_or_else(|_| "none".to_owned(), |value| figure(value * scale(Quantity::Force).0));
        let _ = writeln!(text, "  {exact:>14}");
    }
    text.push_str(
        "  * smallest. Rms force: at the least amplitude by averaging; power, stroke (peak to peak) and velocity: of the structure \
         without friction.\n",
    );
    text.push_str(&notes(study, done));
    text
}

/// Why values are missing, and where larger amplitudes destabilise.
fn notes(study: &BeltStudy, done: &WaveformComparison) -> String {
    let (unit, scale) = match study.scales().zip(Quantity::Force.si_unit()) {
        Some((scales, (unit, _))) => (format!(" {unit}"), scales.si_per_unit(Quantity::Force)),
        None => (String::new(), 1.0),
    };
    let of = |row: &ComparedWaveform| match &row.averaged {
        Err(why) => vec![why.clone()],
        Ok(least) => {
            let power = least.power.as_ref().err();
            let power = power.map(|why| format!("no power, stroke and velocity: {why}"));
            let exact = row.exact.as_ref().err().map(|why| format!("no exact amplitude: {why}"));
            let until = least.until.map(|until| {
                format!("by averaging unstable again from {}{unit} on", figure(until * scale))
            });
            [power, exact, until].into_iter().flatten().collect()
        }
    };
    joined_notes(done.rows.iter().flat_map(|row| {
        let label = row.label();
        of(row).into_iter().map(move |why| (why, label.clone()))
    }))
}

/// Notes with the labels of the rows to which they apply, each note once, on a line of its own.
pub(super) fn joined_notes(notes: impl Iterator<Item = (String, String)>) -> String {
    let mut joined: Vec<(String, Vec<String>)> = Vec::new();
    for (why, label) in notes {
        match joined.iter_mut().find(|(known, _)| *known == why) {
            Some((_, labels)) => labels.push(label),
            None => joined.push((why, vec![label])),
        }
    }
    joined.into_iter().fold(String::new(), |mut text, (why, labels)| {
        let _ = writeln!(text, "  {}: {why}", labels.join(", "));
        text
    })
}
