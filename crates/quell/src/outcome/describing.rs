//! `friction --describing`: averaged friction under a slow sinusoid.

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
use crate::run::describing::DescribedFriction;
use crate::study::{BeltSetup, BeltStudy};

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
        Some(Ok(picture::describing(study, self)))
    }
}

fn table(study: &BeltStudy, done: &DescribedFriction) -> String {
    let mut head = TextTable::new(study.scales());
    head.known("gain for small amplitudes", Quantity::PerVelocity, done.small.clone());
    for cycle in &done.cycles {
        let label = if cycle.stable { "stable limit cycle" } else { "unstable limit cycle" };
        head.number(label, Quantity::Velocity, cycle.amplitude);
    }
    let (unit, per_unit) = match study.scales() {
        Some(scales) => ("m/s".to_owned(), scales.si_per_unit(Quantity::Velocity)),
        None => (quantity::unit_of(Quantity::Velocity, false), 1.0),
    };
    let mut text = head.text();
    let _ = write!(
        text,
        "Slip velocity v₀ + a sin φ, a in {unit}: mean coefficient, gain N₁ of the sinusoid, N₁ without dither, and 2ζ + FN₁\n  \
         {:>14}  {:>14}  {:>14}  {:>14}  {:>14}\n",
        "a", "mean", "N₁", "undithered", "2ζ + FN₁"
    );
    let balances = done.balances(study);
    // The full grid goes to files and programs; the table shows ten equal steps.
    let tenths = |amplitude: f64| 10.0 * amplitude / done.largest;
    let shown = |amplitude: f64| (tenths(amplitude) - tenths(amplitude).round()).abs() < 1e-9;
    let rows = done.points.iter().zip(&done.undithered).zip(balances);
    for ((point, bare), balance) in rows.filter(|((point, _), _)| shown(point.amplitude)) {
        let cells = [
            point.amplitude * per_unit,
            point.coefficient,
            point.gain / per_unit,
            bare.gain / per_unit,
            balance,
        ];
        for cell in cells {
            let _ = write!(text, "  {:>14}", figure(cell));
        }
        text.push('\n');
    }
    text
}
