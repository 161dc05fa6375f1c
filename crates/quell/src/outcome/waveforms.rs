//! `waveforms`: the least dither of each waveform and its cost.

use std::fmt::Write as _;

use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::Presented;
use super::table::{NumberColumns, figure, heading};
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::picture;
use crate::plot::Figure;
use crate::run::waveforms::{COLUMNS, ComparedWaveform, CostColumn, RankedBy, WaveformComparison};
use crate::study::{SystemSetup, SystemStudy};
use crate::words::unit_after;

impl Presented<SystemSetup> for WaveformComparison {
    const NAME: &'static str = "waveforms";
    const TITLED: bool = true;

    fn json(&self, study: &SystemStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, study: &SystemStudy) -> String {
        table(self, |quantity| study.units().unit(quantity))
    }

    fn datasets(&self, study: &SystemStudy) -> Vec<(&'static str, Dataset)> {
        vec![("waveforms", self.dataset(study))]
    }

    fn figure(&self, study: &SystemStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::waveforms(study, self)))
    }
}

/// One line per waveform, with the costs at the amplitude that ranks it; the smallest value of each column has an asterisk.
fn table(done: &WaveformComparison, unit_of: impl Fn(Quantity) -> Option<&'static str>) -> String {
    let width = done.rows.iter().map(|row| row.label().chars().count()).max().unwrap_or(0);
    let [_, costs @ ..] = &COLUMNS;
    let amplitudes = ["averaged", "exact"]
        .map(|words| heading(&format!("{words} amplitude"), unit_of(Quantity::Force)));
    let costs_headings = costs.iter().map(|column| heading(column.words, unit_of(column.quantity)));
    let headings: Vec<String> = amplitudes.into_iter().chain(costs_headings).collect();
    let (columns, line) = NumberColumns::under(&headings);
    let mut text = format!("  {:<width$}  {:>10}{line}\n", "waveform", "duty cycle");
    let by = done.ranked_by();
    let cell = |value: Option<f64>, is_best: bool| {
        let mark = if is_best { "*" } else { "" };
        let value = value.map(figure);
        value.map_or_else(|| "none".to_owned(), |value| format!("{value}{mark}"))
    };
    for row in &done.rows {
        let _ = write!(text, "  {:<width$}  {:>10}", row.label(), figure(row.duty_cycle));
        let is_best =
            |column: &CostColumn| done.best(column).is_some_and(|best| std::ptr::eq(best, row));
        let averaged = row.averaged.as_ref().ok().map(|least| least.amplitude);
        let amplitudes = [
            (RankedBy::Averaging, averaged),
            (RankedBy::Exact, row.exact.as_ref().ok().map(|least| least.amplitude)),
        ]
        .map(|(way, value)| cell(value, by == way && is_best(&COLUMNS[0])));
        let costs = costs.iter().map(|column| cell(done.ranked(row, column), is_best(column)));
        let cells: Vec<String> = amplitudes.into_iter().chain(costs).collect();
        text += &columns.line(&cells);
        text.push('\n');
    }
    let _ = writeln!(
        text,
        "  * smallest. Rms force, power, stroke (peak to peak) and velocity: at the {}, of the structure without friction.",
        match by {
            RankedBy::Exact => "exact amplitude",
            RankedBy::Averaging => "amplitude of averaging",
        }
    );
    text.push_str(&notes(done, unit_of(Quantity::Force)));
    text
}

/// Why values are missing, and where larger amplitudes destabilise.
fn notes(done: &WaveformComparison, unit: Option<&str>) -> String {
    let unit = unit_after(unit);
    let of = |row: &ComparedWaveform| {
        let averaged = row.averaged.as_ref().err().map(ToString::to_string);
        let power = row.unit.as_ref().err();
        let power = power.filter(|_| averaged.is_none());
        let power = power.map(|why| format!("no power, stroke and velocity: {why}"));
        // The same reason is said once.
        let exact = row.exact.as_ref().err().map(ToString::to_string);
        let exact = exact.filter(|why| Some(why) != averaged.as_ref());
        let exact = exact.map(|why| format!("no exact amplitude: {why}"));
        let ends = [("exactly", row.exact.as_ref()), ("by averaging", row.averaged.as_ref())];
        let [lost, until] = ends.map(|(by, least)| {
            let end = least.ok().and_then(|least| least.until)?;
            Some(format!("{by} unstable again from {}{unit} on", figure(end)))
        });
        [averaged, power, exact, lost, until].into_iter().flatten()
    };
    joined_notes(done.rows.iter().flat_map(|row| {
        let label = row.label();
        of(row).map(move |why| (why, label.clone()))
    }))
}

/// Notes with the labels of the rows to which they apply, each note once, on a line of its own.
fn joined_notes(notes: impl Iterator<Item = (String, String)>) -> String {
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
