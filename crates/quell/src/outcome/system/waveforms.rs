//! `waveforms` of a system.

use std::fmt::Write as _;

use serde_json::Value as Json;

use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::outcome::Presented;
use crate::outcome::table::figure;
use crate::outcome::waveforms::joined_notes;
use crate::picture;
use crate::plot::Figure;
use crate::run::system::waveforms::{COLUMNS, SystemWaveforms};
use crate::study::{SystemSetup, SystemStudy};
use quell_model::units::Quantity;

impl Presented<SystemSetup> for SystemWaveforms {
    const TITLED: bool = true;

    fn json(&self, study: &SystemStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, study: &SystemStudy) -> String {
        let width = self.rows.iter().map(|row| row.label().chars().count()).max().unwrap_or(0);
        let mut text = format!("  {:<width$}  {:>10}", "waveform", "duty cycle");
        for (_, words, quantity, _) in &COLUMNS {
            let unit =
                study.units().unit(*quantity).map_or(String::new(), |unit| format!("/{unit}"));
            let _ = write!(text, "  {:>14}", format!("{words}{unit}"));
        }
        let unit =
            study.units().unit(Quantity::Force).map_or(String::new(), |unit| format!("/{unit}"));
        let _ = writeln!(text, "  {:>14}", format!("exact{unit}"));
        for row in &self.rows {
            let _ = write!(text, "  {:<width$}  {:>10}", row.label(), figure(row.duty_cycle));
            for column in &COLUMNS {
                let best = self.best(column).is_some_and(|best| std::ptr::eq(best, row));
                let mark = if best { "*" } else { "" };
                let cell = row
                    .value(column)
                    .map_or_else(|_| "none".to_owned(), |value| format!("{}{mark}", figure(value)));
                let _ = write!(text, "  {cell:>14}");
            }
            let exact = row.exact.as_ref().map_or("none".to_owned(), |value| figure(*value));
            let _ = writeln!(text, "  {exact:>14}");
        }
        text.push_str("  * smallest. Power, stroke (peak to peak) and velocity of the driven point of the sliding structure.\n");
        let notes = self.rows.iter().flat_map(|row| {
            let label = row.label();
            let of = |why: &str| (why.to_owned(), label.clone());
            match &row.averaged {
                Err(why) => vec![of(why)],
                Ok(least) => {
                    let until = least
                        .until
                        .map(|until| format!("unstable again from {} on", figure(until)));
                    let exact = row.exact.as_ref().err();
                    let exact = exact.map(|why| of(&format!("no exact amplitude: {why}")));
                    let stroke = least.stroke.as_ref().err().map(|why| of(why));
                    stroke.into_iter().chain(exact).chain(until.map(|why| of(&why))).collect()
                }
            }
        });
        text.push_str(&joined_notes(notes));
        text
    }

    fn datasets(&self, study: &SystemStudy) -> Vec<(&'static str, Dataset)> {
        vec![("waveforms", self.dataset(study))]
    }

    fn figure(&self, study: &SystemStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::waveforms_of_system(study, self)))
    }
}
