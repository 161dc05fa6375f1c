//! Warnings about friction laws that give energy back.

use quell_model::Friction;
use quell_model::digits::digits;
use quell_model::parameter::BRISTLE_DAMPING;
use quell_model::system::Contact;
use quell_model::units::UnitSystem;

/// The warnings about contacts whose numbers are in these units: bristles of a LuGre law that are damped too much for the force to be
/// passive.
pub fn warnings(contacts: &[Contact], units: UnitSystem) -> Vec<String> {
    contacts.iter().filter_map(|contact| warning(contact, units)).collect()
}

fn warning(contact: &Contact, units: UnitSystem) -> Option<String> {
    let Friction::Lugre(law) = &contact.friction else { return None };
    let (most, damping) = (law.largest_passive_damping()?, law.bristle_damping());
    let unit = units.unit(BRISTLE_DAMPING.quantity);
    let unit = unit.filter(|unit| *unit != "1").map_or(String::new(), |unit| format!(" {unit}"));
    (damping > most).then(|| {
        format!(
            "the friction force of contact {} is not passive: the bristle damping {}{unit} exceeds viscous·coefficient/(static_coefficient \
             − coefficient) = {}{unit} (Barabanov and Ortega 2000)",
            contact.name,
            digits(damping, 6),
            digits(most, 6)
        )
    })
}
