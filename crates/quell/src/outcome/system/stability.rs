//! `stability` of a system.

use std::fmt::Write as _;

use serde_json::Value as Json;

use super::{ListedMotion, motions};
use crate::complaint::Failure;
use crate::outcome::Presented;
use crate::outcome::table::figure;
use crate::picture;
use crate::plot::Figure;
use crate::run::stability::{becomes, kind};
use crate::run::system::stability::SystemStability;
use crate::study::{SystemSetup, SystemStudy};
use quell_model::units::Quantity;

impl Presented<SystemSetup> for SystemStability {
    const TITLED: bool = true;

    fn json(&self, study: &SystemStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, study: &SystemStudy) -> String {
        table(study, self)
    }

    fn figure(&self, study: &SystemStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::system::stability(study, self)))
    }
}

fn table(study: &SystemStudy, done: &SystemStability) -> String {
    let upper = done.spectrum.motions.iter().filter(|motion| motion.eigenvalue.im >= 0.0);
    let mut text = motions(study.units(), ListedMotion::Damped, upper);
    let with = |quantity: Quantity, value: f64| {
        let unit = study.units().unit(quantity).map_or(String::new(), |unit| format!(" {unit}"));
        format!("{}{unit}", figure(value))
    };
    for (contact, found) in study.system().contacts.iter().zip(&done.contacts) {
        let _ = write!(
            text,
            "  contact {}: friction {}, normal load {}",
            contact.name,
            with(Quantity::Force, found.friction),
            with(Quantity::Force, found.normal_load)
        );
        if let Some(dithered) = found.dithered {
            let velocity = with(Quantity::Velocity, contact.surface_velocity.mean());
            let slip = with(Quantity::Velocity, dithered.slip_amplitude);
            let _ = write!(text, ", slip amplitude {slip} at the belt velocity {velocity}");
        }
        text.push('\n');
    }
    if let Some(dither) = &done.dither {
        match &dither.critical {
            Err(why) => {
                let _ = writeln!(text, "  critical amplitudes: unknown: {why}");
            }
            Ok(critical) => {
                for found in critical {
                    let _ = writeln!(
                        text,
                        "  {} from the amplitude {} {}on ({}){}",
                        becomes(found.becomes),
                        with(Quantity::Force, found.amplitude),
                        if study.system().inputs.len() > 1 { "of the first dither " } else { "" },
                        kind(found.crossing),
                        if found.contacts_stay_closed {
                            ""
                        } else {
                            ", if every contact stayed closed"
                        }
                    );
                }
            }
        }
    }
    text
}
