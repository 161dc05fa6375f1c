//! `receptance`.

use std::fmt::Write as _;

use serde_json::Value as Json;

use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::outcome::Presented;
use crate::outcome::table::{NumberColumns, figure, frequency_heading, heading};
use crate::picture;
use crate::plot::Figure;
use crate::run::system::receptance::{Receptances, unit};
use crate::study::{SystemSetup, SystemStudy};

impl Presented<SystemSetup> for Receptances {
    const NAME: &'static str = "receptance";
    const TITLED: bool = true;

    fn json(&self, study: &SystemStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn notes(&self, _: &SystemStudy) -> Vec<String> {
        self.notes()
    }

    fn table(&self, study: &SystemStudy) -> String {
        let (frequency, factor) = frequency_heading(study.units());
        let largest = heading("largest receptance", unit(study));
        let (columns, headings) = NumberColumns::under(&[largest.as_str(), frequency]);
        let mut text = format!("{headings}  output/input\n");
        for pair in &self.pairs {
            let cells = pair.largest().map_or_else(
                || vec!["-".to_owned(); 2],
                |(place, size)| vec![figure(size), figure(factor * self.frequencies[place])],
            );
            let _ = writeln!(text, "{}  {}", columns.line(&cells), self.name_of(pair));
        }
        text
    }

    fn datasets(&self, study: &SystemStudy) -> Vec<(&'static str, Dataset)> {
        vec![("receptances", self.dataset(study))]
    }

    fn figure(&self, study: &SystemStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::receptance::receptances(study, self)))
    }
}
