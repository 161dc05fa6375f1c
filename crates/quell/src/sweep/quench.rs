//! The exact quench amplitude at a point of a map of belts or systems.

use quell_design::quench::{
    NoQuench, NotQuenched, Quench, quench_kind, quench_of_belt, quench_of_system,
};
use quell_dynamics::simulation::within;
use quell_linear::averaging::NoAverage;
use quell_model::{Belt, System};

use super::status::Status;
use crate::effort::STEPS_OF_MANY_SEARCHES;

/// The quench amplitude at a point; each number with the reason why it is unknown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuenchNumbers {
    /// The least amplitude from which the base response is stable.
    pub least: Result<f64, Status>,
    /// The kind of bifurcation there, as its place in [`quell_design::quench::QUENCH_KINDS`].
    pub kind: Result<usize, Status>,
    /// Where the first quiet interval ends.
    pub lost: Result<f64, Status>,
    /// From where everything up to the limit of the search is quiet.
    pub last: Result<f64, Status>,
    /// The least amplitude by finite-R averaging.
    pub averaged: Result<f64, Status>,
}

impl QuenchNumbers {
    fn of<E>(found: &Quench<E>, averaging: impl Fn(&E) -> Status) -> Self {
        let least = found.least().map_err(reason);
        let ends = found.branch.end.map(|_| Status::NoBaseResponse);
        let is_loud = found.branch.quiet().intervals().is_empty();
        let without_end = if is_loud { Status::NeverQuiet } else { Status::StaysQuiet };
        Self {
            least: least.map(|change| change.amplitude),
            kind: least.map(|change| quench_kind(change.kind)),
            lost: found.lost().ok_or(ends.filter(|_| is_loud).unwrap_or(without_end)),
            last: found.last().ok_or(ends.unwrap_or(Status::LoudAtLimit)),
            averaged: match found.averaged() {
                Ok(averaged) => averaged.map_err(reason),
                Err(why) => Err(averaging(why)),
            },
        }
    }
}

fn reason(why: NotQuenched) -> Status {
    match why {
        NotQuenched::QuietWithout => Status::QuietWithoutDither,
        NotQuenched::NeverQuiet => Status::NeverQuiet,
        NotQuenched::Ends => Status::NoBaseResponse,
    }
}

fn no_quench<E>(why: NoQuench<E>, averaging: impl Fn(&E) -> Status) -> Status {
    match why {
        NoQuench::NoDither => Status::NoDither,
        NoQuench::NoReach => Status::NoReach,
        NoQuench::NoSteadySliding => Status::NoSteadySliding,
        NoQuench::NoBaseResponse => Status::NoBaseResponse,
        NoQuench::Stalled => Status::Stalled,
        NoQuench::Averaging(why) => averaging(&why),
    }
}

pub(super) fn quench_numbers_of_belt(belt: &Belt) -> Result<QuenchNumbers, Status> {
    let found = within(STEPS_OF_MANY_SEARCHES, || quench_of_belt(belt));
    let status = |why: &_| Status::from(why);
    found.map(|found| QuenchNumbers::of(&found, status)).map_err(|why| no_quench(why, status))
}

pub(super) fn quench_numbers_of_system(
    system: &System,
    status: fn(&NoAverage) -> Status,
) -> Result<QuenchNumbers, Status> {
    let found = within(STEPS_OF_MANY_SEARCHES, || quench_of_system(system, 0));
    found.map(|found| QuenchNumbers::of(&found, status)).map_err(|why| no_quench(why, status))
}
