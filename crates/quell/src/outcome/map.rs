//! `map`: quantities over the axes of a study.

use std::fmt::Write as _;

use serde_json::Value as Json;

use super::Outcome;
use super::table::figure;
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::input::Inputs;
use crate::map::{Extreme, FinishedMap};
use crate::picture;
use crate::plot::Figure;
use crate::status::Status;
use crate::sweep::{Grid, VariableArrays};
use crate::words::{capital, plural, quantity_at, quantity_is, unit_after};

impl Outcome for FinishedMap {
    fn inputs(&self) -> Inputs {
        self.plan().grid().study().inputs()
    }

    fn name(&self) -> &'static str {
        "map"
    }

    fn json(&self) -> Json {
        FinishedMap::json(self)
    }

    fn facts(&self) -> Json {
        FinishedMap::facts(self)
    }

    fn title(&self) -> Option<&str> {
        self.plan().grid().study().title()
    }

    fn table(&self) -> String {
        table(self)
    }

    fn datasets(&self) -> Vec<(&'static str, Dataset)> {
        vec![("map", self.dataset())]
    }

    fn figure(&self) -> Option<Result<Figure, Failure>> {
        Some(picture::sweep(self))
    }
}

fn table(done: &FinishedMap) -> String {
    let grid = done.plan().grid();
    let mut text = String::new();
    for axis in grid.axes() {
        let (first, last) = (axis.values.first(), axis.values.last());
        let ends: Vec<String> = first.into_iter().chain(last).map(|value| figure(*value)).collect();
        let spacing = if axis.logarithmic { ", equal ratios" } else { "" };
        let unit = unit_after(Some(axis.unit));
        let number = capital(&quantity_at(&axis.path));
        let count = axis.values.len();
        let _ = writeln!(text, "  {number}  {}{unit}, {count} values{spacing}", ends.join(" to "));
    }
    let seconds = done.elapsed.as_secs_f64();
    let _ = write!(text, "  {} points in {seconds:.2} s", grid.len());
    if done.resumed > 0 {
        let _ = write!(text, ", {} of them from the store", done.resumed);
    }
    text.push('\n');
    for (entry, summary) in done.plan().sheet().entries().iter().zip(done.summaries()) {
        let _ = writeln!(text, "\n{}", heading(entry, done));
        for (word, found) in [("min", &summary.least), ("max", &summary.most)] {
            if let Some(extreme) = found {
                let _ = writeln!(text, "  {word}  {}", place(extreme, grid));
            }
        }
        for (word, count) in &summary.words {
            let _ = writeln!(text, "  {word}  {count} point{}", plural(*count));
        }
        for (status, count) in &summary.states {
            if *status != Status::Known {
                let points = format!("{count} point{}", plural(*count));
                let _ = writeln!(text, "  {}  {points}: {}", status.name(), status.about());
            }
        }
    }
    text
}

fn heading(entry: &VariableArrays, done: &FinishedMap) -> String {
    let field = &done.plan().sheet().fields()[entry.value];
    let unit = match field.unit.as_str() {
        "" | "1" => String::new(),
        unit => format!(" [{unit}]"),
    };
    format!("{}{unit}: {}", field.name, entry.variable.about)
}

fn place(extreme: &Extreme, grid: &Grid) -> String {
    let places: Vec<String> = grid
        .axes()
        .iter()
        .zip(&extreme.place)
        .map(|(axis, value)| {
            quantity_is(&axis.path, &(figure(*value) + &unit_after(Some(axis.unit))))
        })
        .collect();
    format!("{}  at {}", figure(extreme.value), places.join(", "))
}
