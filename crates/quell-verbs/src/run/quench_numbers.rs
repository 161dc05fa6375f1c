//! The exact quench amplitude of one dither where it is asked at many values, as maps and samples do: its kind, and where quiet amplitudes
//! end or begin again.

use quell_design::quench::{NoQuench, NotQuenched, Quench, quench, quench_kind};
use quell_dynamics::simulation::within;
use quell_linear::averaging::DitheredSystem;
use quell_model::System;

use crate::effort::STEPS_OF_MANY_SEARCHES;
use crate::range::outside_of_laws;
use crate::status::Status;
use crate::words::digits;

/// The quench amplitude; each number with the reason why it is unknown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuenchNumbers {
    /// The least amplitude from which the base response is stable.
    pub least: Result<f64, Status>,
    /// The kind of bifurcation there, as its place in `quell_design::quench::QUENCH_KINDS`.
    pub kind: Result<usize, Status>,
    /// Where the first quiet interval ends.
    pub lost: Result<f64, Status>,
    /// From where everything up to the limit of the search is quiet.
    pub last: Result<f64, Status>,
    /// The least amplitude by finite-R averaging.
    pub averaged: Result<f64, Status>,
    /// Whether slip leaves the range of a friction law at the least amplitude.
    pub beyond_range: bool,
}

impl QuenchNumbers {
    /// About one dither of a system, that of `input`.
    ///
    /// # Errors
    /// Why it is unknown.
    pub fn of(system: &System, input: usize) -> Result<Self, Status> {
        let found = within(STEPS_OF_MANY_SEARCHES, || quench(system, input)).map_err(no_quench)?;
        let least = found.least().map_err(reason);
        let ends = found.branch.end.map(|_| Status::NoBaseResponse);
        let is_loud = found.branch.quiet().intervals().is_empty();
        let without_end = if is_loud { Status::NeverQuiet } else { Status::StaysQuiet };
        let least_amplitude = least.map(|change| change.amplitude);
        Ok(Self {
            least: least_amplitude,
            kind: least.map(|change| quench_kind(change.kind)),
            lost: found.lost().ok_or(ends.filter(|_| is_loud).unwrap_or(without_end)),
            last: found.last().ok_or(ends.unwrap_or(Status::LoudAtLimit)),
            averaged: averaged(&found),
            beyond_range: least_amplitude.is_ok_and(|least| leaves_laws(system, (input, least))),
        })
    }
}

/// The exact quench amplitude of one dither of a system, that of `input`, as a number: 0 where sliding is stable without the dither,
/// infinite where no amplitude up to the limit of the search is quiet.
///
/// # Errors
/// Why it is unknown.
pub fn least_quiet(system: &System, input: usize) -> Result<f64, Status> {
    match QuenchNumbers::of(system, input)?.least {
        Err(Status::QuietWithoutDither) => Ok(0.0),
        Err(Status::NeverQuiet) => Ok(f64::INFINITY),
        other => other,
    }
}

fn averaged(found: &Quench) -> Result<f64, Status> {
    match found.averaged() {
        Ok(averaged) => averaged.map_err(reason),
        Err(why) => Err(why.clone().into()),
    }
}

/// Whether slip leaves the range of a friction law with a dither of this amplitude.
fn leaves_laws(system: &System, dither: (usize, f64)) -> bool {
    if system.contacts.iter().all(|contact| contact.friction.range().is_none()) {
        return false;
    }
    let average = DitheredSystem::new(system).and_then(|one| one.average_with(Some(dither)));
    average.is_ok_and(|at| !outside_of_laws(system, digits, Some(&at.contacts)).is_empty())
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
        NoQuench::Averaging(why) => why.into(),
    }
}
