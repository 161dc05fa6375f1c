//! `friction --describing`: averaged friction under a slow sinusoid.

use std::fmt::Write as _;

use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::Presented;
use super::table::{NumberColumns, figure, figure_in_units, heading, rate_heading};
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::picture;
use crate::plot::Figure;
use crate::run::describing::DescribedContacts;
use crate::study::{SystemSetup, SystemStudy};

impl Presented<SystemSetup> for DescribedContacts {
    const NAME: &'static str = "describing-function";

    fn json(&self, study: &SystemStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, study: &SystemStudy) -> String {
        table(study, self)
    }

    fn datasets(&self, study: &SystemStudy) -> Vec<(&'static str, Dataset)> {
        vec![("friction", self.dataset(study))]
    }

    fn figure(&self, study: &SystemStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::describing::describing(study, self)))
    }
}

fn table(study: &SystemStudy, done: &DescribedContacts) -> String {
    let mut text = String::new();
    for (index, contact) in done.contacts.iter().enumerate() {
        let growth = done.balance.as_ref().ok().filter(|balance| balance.contact == index);
        let (velocity, load) = (
            figure_in_units(study.units(), Quantity::Velocity, contact.velocity),
            figure_in_units(study.units(), Quantity::Force, contact.normal_load),
        );
        let unit = |quantity| study.units().unit(quantity);
        let headings = [
            heading("amplitude a", unit(Quantity::Velocity)),
            "mean coefficient".to_owned(),
            heading("gain N₁", unit(Quantity::PerVelocity)),
            heading("N₁ without dither", unit(Quantity::PerVelocity)),
        ];
        let rate = growth.map(|_| rate_heading(study.units()));
        let headings: Vec<String> = headings.into_iter().chain(rate).collect();
        let (columns, line) = NumberColumns::under(&headings);
        let _ = writeln!(
            text,
            "Contact {}, slip velocity {velocity} + a sin φ, load {load}: mean coefficient and gain N₁ of the sinusoid\n{line}",
            contact.name
        );
        for (row, point, bare) in contact.curve.tenths() {
            let rate = growth.map(|balance| balance.growth[row]);
            let cells = [point.amplitude, point.coefficient, point.gain, bare.gain];
            let cells: Vec<String> = cells.into_iter().chain(rate).map(figure).collect();
            let _ = writeln!(text, "{}", columns.line(&cells));
        }
    }
    let trimmed: Vec<&str> = text.lines().map(str::trim_end).collect();
    trimmed.join("\n") + "\n"
}
