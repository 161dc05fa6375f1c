//! `friction --describing` of belts and systems: averaged friction under a slow sinusoid.

use std::fmt::Write as _;

use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::Presented;
use super::table::{TextTable, figure};
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::picture;
use crate::plot::Figure;
use crate::quantity;
use crate::run::describing::{DescribedContacts, DescribedFriction};
use crate::run::system::in_units;
use crate::study::{BeltSetup, BeltStudy, SystemSetup, SystemStudy};

impl Presented<BeltSetup> for DescribedFriction {
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
        vec![("friction", self.dataset(study))]
    }

    fn figure(&self, study: &BeltStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::describing::of_belt(study, self)))
    }
}

fn table(study: &BeltStudy, done: &DescribedFriction) -> String {
    let mut head = TextTable::new(study.scales());
    head.known("gain for small amplitudes", Quantity::PerVelocity, done.curve.small.clone());
    for cycle in &done.cycles {
        let label = if cycle.stable { "stable limit cycle" } else { "unstable limit cycle" };
        head.number(label, Quantity::Velocity, cycle.amplitude);
    }
    let (unit, per_unit) = match study.scales().and_then(|scales| scales.one(Quantity::Velocity)) {
        Some((one, unit)) => (unit.to_owned(), one),
        None => (quantity::unit_of(Quantity::Velocity, None), 1.0),
    };
    let mut text = head.text();
    let _ = write!(
        text,
        "Slip velocity v₀ + a sin φ, a in {unit}: mean coefficient, gain N₁ of the sinusoid, N₁ without dither, and 2ζ + FN₁\n  \
         {:>14}  {:>14}  {:>14}  {:>14}  {:>14}\n",
        "a", "mean", "N₁", "undithered", "2ζ + FN₁"
    );
    let balances = done.balances(study);
    for (index, point, bare) in done.curve.tenths() {
        let cells = [
            point.amplitude * per_unit,
            point.coefficient,
            point.gain / per_unit,
            bare.gain / per_unit,
            balances[index],
        ];
        for cell in cells {
            let _ = write!(text, "  {:>14}", figure(cell));
        }
        text.push('\n');
    }
    text
}

impl Presented<SystemSetup> for DescribedContacts {
    fn json(&self, study: &SystemStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, study: &SystemStudy) -> String {
        table_of_system(study, self)
    }

    fn datasets(&self, study: &SystemStudy) -> Vec<(&'static str, Dataset)> {
        vec![("friction", self.dataset(study))]
    }

    fn figure(&self, study: &SystemStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::describing::of_system(study, self)))
    }
}

fn table_of_system(study: &SystemStudy, done: &DescribedContacts) -> String {
    let unit =
        study.units().unit(Quantity::Velocity).map_or(String::new(), |unit| format!(" in {unit}"));
    let mut text = String::new();
    for (index, contact) in done.contacts.iter().enumerate() {
        let growth = done.balance.as_ref().ok().filter(|balance| balance.contact == index);
        let (velocity, load) = (
            in_units(study.units(), Quantity::Velocity, contact.velocity),
            in_units(study.units(), Quantity::Force, contact.normal_load),
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
