//! `stability` of a system.

use std::fmt::Write as _;

use serde_json::Value as Json;

use super::motions;
use crate::complaint::Failure;
use crate::outcome::Presented;
use crate::outcome::table::figure;
use crate::picture;
use crate::plot::Figure;
use crate::run::stability::{becomes, kind};
use crate::run::system::stability::SystemStability;
use crate::study::{SystemSetup, SystemStudy};

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
    let mut text = motions(study.units(), upper);
    for (contact, found) in study.system().contacts.iter().zip(&done.contacts) {
        let _ = write!(
            text,
            "  contact {}: friction {}, normal load {}",
            contact.name,
            figure(found.friction),
            figure(found.normal_load)
        );
        if let Some(dithered) = found.dithered {
            let velocity = figure(contact.surface_velocity.mean());
            let slip = figure(dithered.slip_amplitude);
            let _ = write!(text, ", fast slip {slip} at the surface velocity {velocity}");
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
                        "  {} from the amplitude {} of the first dither on ({})",
                        becomes(found.becomes),
                        figure(found.amplitude),
                        kind(found.crossing)
                    );
                }
            }
        }
    }
    text
}
