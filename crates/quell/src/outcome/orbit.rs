//! `orbit`: the periodic response and its Floquet multipliers.

use std::fmt::Write as _;

use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::Presented;
use super::table::TextTable;
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::picture;
use crate::plot::Figure;
use crate::run::orbit::{Orbit, PeriodicResponse, extremes, sentence};
use crate::study::{BeltSetup, BeltStudy};

impl Presented<BeltSetup> for PeriodicResponse {
    fn json(&self, study: &BeltStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &BeltStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, study: &BeltStudy) -> String {
        tables(study, self)
    }

    fn datasets(&self, study: &BeltStudy) -> Vec<(&'static str, Dataset)> {
        self.dataset(study).map(|dataset| ("orbit", dataset)).into_iter().collect()
    }

    fn figure(&self, study: &BeltStudy) -> Option<Result<Figure, Failure>> {
        Some(picture::periodic_response(study, self))
    }
}

fn tables(study: &BeltStudy, found: &PeriodicResponse) -> String {
    let mut text = String::new();
    if let Some(orbit) = &found.orbit {
        text += &table(study, orbit);
    }
    let others = found.cycles.iter().filter(|cycle| Some(*cycle) != found.orbit.as_ref());
    for other in others {
        let _ = write!(text, "\nAlso found: {}\n{}", sentence(study, other), table(study, other));
    }
    text
}

fn table(study: &BeltStudy, found: &Orbit) -> String {
    let mut table = TextTable::new(study.scales());
    table.word("verdict", found.verdict().name());
    for (re, im) in found.multipliers {
        let multiplier = format!("{re:.9} {} {:.9} i", if im < 0.0 { '−' } else { '+' }, im.abs());
        table.word("multiplier", &multiplier);
    }
    let modulus =
        if found.is_free { "modulus of the deciding one" } else { "modulus of the larger" };
    table.number(modulus, Quantity::Ratio, found.radius());
    table.number("displacement x at τ = 0", Quantity::Displacement, found.start.displacement);
    table.number("velocity x′ at τ = 0", Quantity::Velocity, found.start.velocity);
    table.number("period", Quantity::Time, found.period);
    if let Some((least, _)) = found.least_slip {
        table.number("least slip velocity |v_r|", Quantity::Velocity, least);
    }
    table.number("stick fraction", Quantity::Ratio, found.stick_fraction);
    let reach = extremes(study, found);
    table.number("lowest displacement", Quantity::Displacement, reach.displacement.0);
    table.number("highest displacement", Quantity::Displacement, reach.displacement.1);
    table.number("lowest velocity", Quantity::Velocity, reach.velocity.0);
    table.number("highest velocity", Quantity::Velocity, reach.velocity.1);
    table.number("residual", Quantity::Displacement, found.residual);
    table.number("error of the state", Quantity::Displacement, found.state_error);
    table.number("error of the multiplier", Quantity::Ratio, found.multiplier_error);
    table.text()
}
