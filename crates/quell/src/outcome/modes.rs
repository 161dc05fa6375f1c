//! `modes`: natural frequencies and shapes of a disc.

use std::fmt::Write as _;

use serde_json::Value as Json;

use super::Presented;
use super::table::figure;
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
    let _ =
        write!(text, "  (i, q)    {:>12}  {:>10}  {:>12}  {:>10}", "k²", "β", "φ at load", "β/q");
    let _ = writeln!(
        text,
        "{}",
        if hertz { format!("  {:>12}  {:>12}", "Hz", "rpm") } else { String::new() }
    );
    for (index, row) in done.rows.iter().enumerate() {
        let cell = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), figure);
        let _ = write!(
            text,
            "  ({}, {:>2})  {:>13}  {:>10}  {:>12}  {:>10}",
            row.radial,
            row.diameters,
            cell(row.frequency_parameter),
            figure(row.ratio),
            figure(row.shape_at_load),
            cell(row.critical_speed()),
        );
        if hertz {
            let _ = write!(
                text,
                "  {:>12}  {:>12}",
                cell(row.frequency_hz),
                cell(row.critical_speed_rpm())
            );
        }
        let _ = writeln!(
            text,
            "{}",
            if done.critical == Some(index) { "  lowest critical speed" } else { "" }
        );
    }
    text
}
