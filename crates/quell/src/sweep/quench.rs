//! The exact quench amplitude at a point of a map.

use quell_design::quench::{NoQuench, NotQuenched, Quench, quench, quench_kind};
use quell_dynamics::simulation::within;
use quell_model::System;

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
    fn of(found: &Quench) -> Self {
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
                Err(why) => Err(why.into()),
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

fn no_quench(why: NoQuench) -> Status {
    match why {
        NoQuench::NoDither => Status::NoDither,
        NoQuench::NoReach => Status::NoReach,
        NoQuench::NoSteadySliding => Status::NoSteadySliding,
        NoQuench::NoBaseResponse => Status::NoBaseResponse,
        NoQuench::Stalled => Status::Stalled,
        NoQuench::Averaging(why) => (&why).into(),
    }
}

/// The numbers about one dither of a system, that of `input`.
pub(super) fn quench_numbers(system: &System, input: usize) -> Result<QuenchNumbers, Status> {
    let found = within(STEPS_OF_MANY_SEARCHES, || quench(system, input));
    found.map(|found| QuenchNumbers::of(&found)).map_err(no_quench)
}

/// The exact quench amplitude of one dither of a system, that of `input`, as a number: 0 where sliding is stable without the dither,
/// infinite where no amplitude up to the limit of the search is quiet.
///
/// # Errors
/// Why it is unknown.
pub(crate) fn least_quiet(system: &System, input: usize) -> Result<f64, Status> {
    as_number(quench_numbers(system, input)?.least)
}

fn as_number(least: Result<f64, Status>) -> Result<f64, Status> {
    match least {
        Err(Status::QuietWithoutDither) => Ok(0.0),
        Err(Status::NeverQuiet) => Ok(f64::INFINITY),
        other => other,
    }
}
