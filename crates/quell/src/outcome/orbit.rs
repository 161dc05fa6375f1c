//! `orbit`: the periodic response and its Floquet multipliers.

use std::fmt::Write as _;

use quell_model::units::Quantity;
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

use super::Presented;
use super::table::figure;
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::picture;
use crate::plot::Figure;
use crate::run::orbit::{FoundMotion, PeriodicResponse};
use crate::study::{SystemSetup, SystemStudy};
use crate::words::unit_after;

/// Numbers of a state, multipliers and contacts that a table lists.
const MOST_LISTED: usize = 12;

impl Presented<SystemSetup> for PeriodicResponse {
    const NAME: &'static str = "orbit";
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
        let mut text = String::new();
        if let Some(found) = &self.found {
            text += &table(study, found);
        }
        for tried in &self.tried {
            let _ = writeln!(text, "  tried {}: {}", tried.start, tried.outcome);
        }
        text
    }

    fn datasets(&self, study: &SystemStudy) -> Vec<(&'static str, Dataset)> {
        self.dataset(study).map(|dataset| ("orbit", dataset)).into_iter().collect()
    }

    fn figure(&self, study: &SystemStudy) -> Option<Result<Figure, Failure>> {
        Some(picture::orbit::orbit(study, self))
    }
}

fn table(study: &SystemStudy, found: &FoundMotion) -> String {
    let (orbit, samples) = (&found.orbit, &found.samples);
    let unit = |quantity: Option<Quantity>| {
        unit_after(quantity.and_then(|quantity| study.units().unit(quantity)))
    };
    let mut text = String::new();
    let mut row = |label: &str, value: String| {
        let _ = writeln!(text, "  {label:<36}{value}");
    };
    row("verdict", orbit.verdict().name().to_owned());
    for z in orbit.multipliers.iter().take(MOST_LISTED) {
        let sign = if z.im < 0.0 { '−' } else { '+' };
        // Without a minus sign before a zero.
        let real = if z.re.abs() < 5e-10 { 0.0 } else { z.re };
        row("multiplier", format!("{real:.9} {sign} {:.9} i", z.im.abs()));
    }
    row("modulus of the deciding multiplier", figure(orbit.radius()));
    row("period", figure(orbit.period) + &unit(Some(Quantity::Time)));
    let states = study.system().state_names().into_iter().zip(&orbit.state).enumerate();
    for (place, (name, value)) in states.take(MOST_LISTED) {
        let unit = unit(study.system().state_quantity(place));
        row(&format!("{name} at t = 0"), figure(*value) + &unit);
    }
    for (contact, means) in study.system().contacts.iter().zip(samples.means()).take(MOST_LISTED) {
        let name = &contact.name;
        row(&format!("stick fraction of {name}"), figure(means.stick_fraction));
        if means.open_fraction > 0.0 {
            row(&format!("open fraction of {name}"), figure(means.open_fraction));
        }
    }
    let [displacements, rates] = samples.extremes();
    let ranges = [
        ("displacement", Quantity::Displacement, displacements),
        ("velocity", Quantity::Velocity, rates),
    ];
    for (name, quantity, RealInterval { lower: low, upper: high }) in ranges {
        row(&format!("lowest {name}"), figure(low) + &unit(Some(quantity)));
        row(&format!("highest {name}"), figure(high) + &unit(Some(quantity)));
    }
    row("residual", figure(orbit.residual));
    row("error of the state", figure(orbit.state_error));
    row("error of the multiplier", figure(orbit.multiplier_error));
    if orbit.state.len() > MOST_LISTED {
        row("…", "--json lists every number".to_owned());
    }
    text
}
