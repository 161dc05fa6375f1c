//! The exact quench amplitude of the first dither: its kind, and where quiet amplitudes end or begin again.

use quell_design::quench::{NoQuench, NotQuenched, QUENCH_KINDS, Quench, quench, quench_kind};
use quell_dynamics::simulation::within;
use quell_linear::averaging::DitheredSystem;
use quell_model::System;

use super::{critical, growth};
use crate::effort::STEPS_OF_MANY_SEARCHES;
use crate::needs::Needs;
use crate::range::outside_of_laws;
use crate::sweep::map_quantity::{FORCE, MapQuantity, VariableKind, variable};
use crate::sweep::points::{ChunkPoints, PointComputation, Subject};
use crate::sweep::status::Status;
use crate::words::digits;

/// The quantity.
#[rustfmt::skip]
pub(super) const QUANTITIES: &[MapQuantity] = &[
    MapQuantity::of::<QuenchNumbers>("quench-amplitude", "least amplitude of the first dither from which the base response is stable, exactly: its kind, that of finite-R averaging, and where quiet amplitudes end or begin again", Needs::MOTIONS, &[
        variable(("quench_amplitude", "D*"), "exact quench amplitude, the least one from which the base response is stable", FORCE, OF_QUENCH, |points| points.values(|found: &QuenchNumbers| found.least)),
        variable(("quench_kind", ""), "bifurcation of the base response at the quench amplitude", KINDS, OF_QUENCH, |points| points.values(QuenchNumbers::kind)),
        variable(("quench_amplitude_averaged", "D*"), "quench amplitude by finite-R averaging", FORCE, OF_QUENCH, |points| points.values(|found: &QuenchNumbers| found.averaged)),
        variable(("quench_lost", "D"), "amplitude at which the first range of quiet amplitudes ends", FORCE, OF_QUENCH, |points| points.values(|found: &QuenchNumbers| found.lost)),
        variable(("quench_last", "D"), "amplitude from which every larger one is quiet, up to the limit of the search", FORCE, OF_QUENCH, |points| points.values(|found: &QuenchNumbers| found.last)),
    ]),
];

/// Words of the kinds of bifurcation.
const KINDS: VariableKind = VariableKind::Word { words: &QUENCH_KINDS, unknown: "unknown" };

/// Statuses of exact amplitudes other than known.
const OF_QUENCH: &[Status] = &[
    Status::BeyondRange,
    Status::Stalled,
    Status::SetValued,
    Status::TooManyGroups,
    Status::NotFast,
    Status::NotConverged,
    Status::NoDither,
    Status::NoSteadySliding,
    Status::Resonance,
    Status::NoBaseResponse,
    Status::NoAverageOfWaveform,
    Status::FrictionFactor,
    Status::QuietWithoutDither,
    Status::NeverQuiet,
    Status::StaysQuiet,
    Status::LoudAtLimit,
    Status::NoReach,
];

/// Seconds in which the base response of four states is followed over the amplitude of a dither.
const QUENCH: f64 = 1e-1;

/// The quench amplitude; each number with the reason why it is unknown.
#[derive(Clone, Copy, Debug, PartialEq)]
struct QuenchNumbers {
    /// The least amplitude from which the base response is stable.
    least: Result<f64, Status>,
    /// The kind of bifurcation there, as its place in [`QUENCH_KINDS`].
    kind: Result<usize, Status>,
    /// Where the first quiet interval ends.
    lost: Result<f64, Status>,
    /// From where everything up to the limit of the search is quiet.
    last: Result<f64, Status>,
    /// The least amplitude by finite-R averaging.
    averaged: Result<f64, Status>,
    /// Whether slip leaves the range of a friction law at the least amplitude.
    beyond_range: bool,
}

impl QuenchNumbers {
    /// About one dither of a system, that of `input`.
    fn of(system: &System, input: usize) -> Result<Self, Status> {
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

    #[expect(clippy::cast_precision_loss, reason = "one of eight words")]
    fn kind(&self) -> Result<f64, Status> {
        Ok(self.kind? as f64)
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

impl PointComputation for QuenchNumbers {
    fn at(points: &ChunkPoints<'_>) -> Vec<Result<Self, Status>> {
        points.each(|point| Self::of(point.system()?, 0))
    }

    fn seconds(subject: &Subject) -> f64 {
        let following = QUENCH * subject.work_over(4.0);
        critical::SEARCH * growth::seconds(subject) + following
    }

    fn qualification(&self, _: f64) -> Status {
        Status::of_range(self.beyond_range)
    }
}

/// The exact quench amplitude of one dither of a system, that of `input`, as a number: 0 where sliding is stable without the dither,
/// infinite where no amplitude up to the limit of the search is quiet.
///
/// # Errors
/// Why it is unknown.
pub(crate) fn least_quiet(system: &System, input: usize) -> Result<f64, Status> {
    match QuenchNumbers::of(system, input)?.least {
        Err(Status::QuietWithoutDither) => Ok(0.0),
        Err(Status::NeverQuiet) => Ok(f64::INFINITY),
        other => other,
    }
}
