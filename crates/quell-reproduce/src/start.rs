//! Where the runs of a study begin.

use quell_dynamics::simulation::Start;

use quell::complaint::Failure;
use quell::run::system::start::start_of;
use quell::study::{BeltStudy, Study};

/// Where the runs of a study without units begin.
pub(super) fn start(study: &BeltStudy) -> Result<Start, Failure> {
    Ok(Start::of_state(&start_of(&Study::from(study).system())?.state))
}
