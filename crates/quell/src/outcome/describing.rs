//! `friction --describing`: averaged friction under a slow sinusoid.

use std::fmt::Write as _;

use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::Presented;
use super::table::{figure, figure_in_units};
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
    let unit =
        study.units().unit(Quantity::Velocity).map_or(String::new(), |unit| format!(" in {unit}"));
    let mut text = String::new();
    for (index, contact) in done.contacts.iter().enumerate() {
        let growth = done.balance.as_ref().ok().filter(|balance| balance.contact == index);
        let (velocity, load) = (
            figure_in_units(study.units(), Quantity::Velocity, contact.velocity),
            figure_in_units(study.units(), Quantity::Force, contact.normal_load),
        );
        let name = growth.map_or("", |_| "growth rate");
        let _ = write!(
            text,
            "Contact {}, slip velocity {velocity} + a sin φ, a{unit}, load {load}: mean coefficient, gain N₁ of the sinusoid, N₁ \
             without dither\n  {:>14}  {:>14}  {:>14}  {:>14}  {name:>14}\n",
            contact.name, "a", "mean", "N₁", "undithered"
        );
        for (row, point, bare) in contact.curve.tenths() {
            let rate = growth.map(|balance| balance.growth[row]);
            let cells = [point.amplitude, point.coefficient, point.gain, bare.gain];
            for cell in cells.into_iter().chain(rate) {
                let _ = write!(text, "  {:>14}", figure(cell));
            }
            text.push('\n');
        }
    }
    let trimmed: Vec<&str> = text.lines().map(str::trim_end).collect();
    trimmed.join("\n") + "\n"
}
