//! Below which body a contact is drawn, and how much room the contacts of a row need.

use quell_model::Contact;

use super::body::SketchBody;
use crate::picture::sketch::contact_state::StateMark;
use crate::study::SystemStudy;

/// Length of the rod or the spring of a contact.
pub(super) const ROD: f64 = 10.0;
pub(super) const SPRING: f64 = 30.0;
/// Height of the pad.
pub(super) const PAD: f64 = 6.0;
/// Height of a note that a contact elsewhere acts on a body.
const NOTE: f64 = 20.0;
/// Height below the surface for the load and the velocity.
const BELOW: f64 = 36.0;

/// The row that determines where a contact is drawn: its tangent, or what friction acts on, or its normal.
fn main_row(contact: &Contact) -> &[f64] {
    let rows = [&contact.force, &contact.tangent, &contact.normal, &contact.slope];
    rows.into_iter().flatten().next().map_or(&[], Vec::as_slice)
}

/// The body of a contact among some bodies: the one with the largest entry of its row.
pub(super) fn home(contact: &Contact, bodies: &[SketchBody]) -> Option<usize> {
    let row = main_row(contact);
    let entries = row.iter().enumerate().filter(|(_, factor)| **factor != 0.0);
    let largest =
        entries.reduce(|best, next| if next.1.abs() > best.1.abs() { next } else { best })?;
    bodies.iter().position(|body| body.indices.contains(&largest.0))
}

pub(super) fn is_compliant(contact: &Contact) -> bool {
    contact.normal.is_some() && contact.normal_stiffness != 0.0
}

/// The spring or the bristles of a contact with a state.
pub(super) fn mark(contact: &Contact) -> Option<StateMark> {
    StateMark::of(&contact.friction, contact.tangential_stiffness)
}

/// Their height.
pub(super) fn state_height(contact: &Contact) -> f64 {
    mark(contact).map_or(0.0, StateMark::height)
}

/// Height of the contacts below a row of bodies.
pub(super) fn depth(
    study: &SystemStudy,
    bodies: &[SketchBody],
    members: std::ops::Range<usize>,
) -> f64 {
    let here: Vec<&Contact> = study
        .system()
        .contacts
        .iter()
        .filter(|contact| home(contact, bodies).is_some_and(|body| members.contains(&body)))
        .collect();
    if here.is_empty() {
        let acts = |contact: &Contact| {
            let rows = [&contact.tangent, &contact.normal, &contact.slope, &contact.force];
            let touched =
                |place: usize| rows.iter().copied().flatten().any(|row| row[place] != 0.0);
            bodies[members.clone()]
                .iter()
                .flat_map(|body| &body.indices)
                .any(|&place| touched(place))
        };
        // Notes that name the contacts of other rows.
        return if study.system().contacts.iter().any(acts) { NOTE } else { 0.0 };
    }
    let rod = if here.iter().any(|contact| is_compliant(contact)) { SPRING } else { ROD };
    let state = here.iter().map(|contact| state_height(contact)).fold(0.0, f64::max);
    rod + PAD + state + BELOW
}
