//! Where the runs of a belt begin: the state of the mass, and that of a contact that has one.

use quell_dynamics::belt_motion::ContactStart;
use quell_dynamics::simulation::Start;

use super::{of_beginning, start};
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::study::{BeltStudy, InitialState};
use quell_dynamics::motion::orbit::squealing_state;

/// The initial state of a study with that of its contact: steady sliding and squeal have the contact's own number, and other starts
/// begin with a contact without load.
///
/// # Errors
/// As [`start`].
pub(super) fn begin(study: &BeltStudy) -> Result<(Start, ContactStart), Failure> {
    if study.initial() == InitialState::Squealing && study.belt().has_contact_state() {
        let first = study.belt().steady_at(0.0).map_err(|why| of_beginning("squealing", &why))?;
        let state = squealing_state(&first.system()).map_err(|allowed| {
            let key = "belt.initial.state";
            Complaint::new(Fault::Value, key, Origin::Whole, "squealing", allowed)
        })?;
        let start = Start { time: 0.0, displacement: state[0], velocity: state[1] };
        let own = state.get(2).map_or(ContactStart::Relaxed, |own| ContactStart::Carried(*own));
        return Ok((start, own));
    }
    let contact = match study.initial() {
        InitialState::Sliding => ContactStart::Sliding,
        _ => ContactStart::Relaxed,
    };
    Ok((start(study)?, contact))
}
