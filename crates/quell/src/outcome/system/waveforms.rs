//! `waveforms` of a system.

use std::fmt::Write as _;

use serde_json::Value as Json;

use crate::dataset::Dataset;
use crate::outcome::Presented;
use crate::outcome::table::figure;
use crate::run::system::waveforms::{COLUMNS, SystemWaveforms};
use crate::study::{SystemSetup, SystemStudy};

impl Presented<SystemSetup> for SystemWaveforms {
    const TITLED: bool = true;

    fn json(&self, study: &SystemStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, study: &SystemStudy) -> String {
        let mut text = format!("  {:<10}", "waveform");
        for (_, words, quantity, _) in &COLUMNS {
            let unit =
                study.units().unit(*quantity).map_or(String::new(), |unit| format!("/{unit}"));
            let _ = write!(text, "  {:>14}", format!("{words}{unit}"));
        }
        text.push('\n');
        for row in &self.rows {
            let _ = write!(text, "  {:<10}", row.waveform.name());
            for column in &COLUMNS {
                let best = self.best(column).is_some_and(|best| std::ptr::eq(best, row));
                let mark = if best { "*" } else { "" };
                let cell = row
                    .value(column)
                    .map_or_else(|_| "none".to_owned(), |value| format!("{}{mark}", figure(value)));
                let _ = write!(text, "  {cell:>14}");
            }
            text.push('\n');
        }
        text.push_str("  * smallest. Power and stroke (peak to peak) of the driven point of the sliding structure.\n");
        for row in &self.rows {
            match &row.averaged {
                Err(why) => {
                    let _ = writeln!(text, "  {}: {why}", row.waveform.name());
                }
                Ok(least) => {
                    if let Err(why) = &least.stroke {
                        let _ = writeln!(text, "  {}: {why}", row.waveform.name());
                    }
                    if let Some(until) = least.until {
                        let name = row.waveform.name();
                        let _ =
                            writeln!(text, "  {name}: unstable again from {} on", figure(until));
                    }
                }
            }
        }
        text
    }

    fn datasets(&self, study: &SystemStudy) -> Vec<(&'static str, Dataset)> {
        vec![("waveforms", self.dataset(study))]
    }
}
