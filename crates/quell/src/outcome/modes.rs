//! `modes`: natural frequencies and shapes of a disc.

use std::fmt::Write as _;

use serde_json::Value as Json;

use super::Presented;
use super::table::{NumberColumns, figure};
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::disc_units::{dataset_in_units, in_units_of_study};
use crate::picture;
use crate::plot::Figure;
use crate::run::disc::modes::Modes;
use crate::study::{DiscSetup, DiscStudy};

impl Presented<DiscSetup> for Modes {
    const NAME: &'static str = "modes";
    const TITLED: bool = true;

    fn json(&self, study: &DiscStudy) -> Json {
        in_units_of_study(study, self.json(study))
    }

    fn sentence(&self, study: &DiscStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, _: &DiscStudy) -> String {
        table(self)
    }

    fn datasets(&self, study: &DiscStudy) -> Vec<(&'static str, Dataset)> {
        vec![("modes", dataset_in_units(study, self.dataset(study)))]
    }

    fn figure(&self, study: &DiscStudy) -> Option<Result<Figure, Failure>> {
        Some(picture::disc::modes(study, self))
    }
}

fn table(done: &Modes) -> String {
    let mut text = String::new();
    let hertz = done.reference_hz.is_some();
    let mut headings =
        vec!["k²", "frequency β in ω_ref", "shape φ at load", "critical speed β/q in ω_ref"];
    if hertz {
        headings.extend(["frequency in Hz", "critical speed in rpm"]);
    }
    let (columns, line) = NumberColumns::under(&headings);
    let _ = writeln!(text, "  (i, q) {line}");
    let cell = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), figure);
    for (index, row) in done.rows.iter().enumerate() {
        let mut cells = vec![
            cell(row.frequency_parameter),
            figure(row.ratio),
            figure(row.shape_at_load),
            cell(row.critical_speed()),
        ];
        if hertz {
            cells.extend([row.frequency_hz, row.critical_speed_rpm()].map(cell));
        }
        let lowest = if done.critical == Some(index) { "  lowest critical speed" } else { "" };
        let cells = columns.line(&cells);
        let _ = writeln!(text, "  ({}, {:>2}){cells}{lowest}", row.radial, row.diameters);
    }
    text
}
