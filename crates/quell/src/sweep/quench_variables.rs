//! The exact quench amplitude as a quantity of maps of belts and systems: its name, variables and statuses.

use quell_design::quench::QUENCH_KINDS;

use super::evaluate::Results;
use super::quantity::{Variable, VariableKind, variable};
use super::quench::QuenchNumbers;
use super::status::Status;

/// Its name.
pub(super) const NAME: &str = "quench-amplitude";

/// What it is.
pub(super) const ABOUT: &str = "least amplitude of the first dither from which the base response is stable, exactly: its kind, that \
     of finite-R averaging, and where quiet amplitudes end or begin again";

/// Statuses of exact amplitudes other than known.
const OF_QUENCH: &[Status] = &[
    Status::Stalled,
    Status::SetValued,
    Status::TooManyGroups,
    Status::NotFast,
    Status::NotConverged,
    Status::NoDither,
    Status::NoSteadySliding,
    Status::Resonance,
    Status::OnlyMeasured,
    Status::NoBaseResponse,
    Status::NoAverageOfWaveform,
    Status::FrictionFactor,
    Status::QuietWithoutDither,
    Status::NeverQuiet,
    Status::StaysQuiet,
    Status::LoudAtLimit,
    Status::NoReach,
];

/// Words of the kinds of bifurcation.
const KINDS: VariableKind = VariableKind::Word { words: &QUENCH_KINDS, unknown: "unknown" };

/// The number of variables.
pub(super) const VARIABLES: usize = 5;

/// The variables, whose amplitudes are of a kind.
#[rustfmt::skip]
pub(super) const fn variables(amplitude: VariableKind) -> [Variable; VARIABLES] {
    [
        variable(("quench_amplitude", "D*"), "exact quench amplitude, the least one from which the base response is stable", amplitude, OF_QUENCH, |r| numbers(r)?.least),
        variable(("quench_kind", ""), "bifurcation of the base response at the quench amplitude", KINDS, OF_QUENCH, kind),
        variable(("quench_amplitude_averaged", "D*"), "quench amplitude by finite-R averaging", amplitude, OF_QUENCH, |r| numbers(r)?.averaged),
        variable(("quench_lost", "D"), "amplitude at which the first range of quiet amplitudes ends", amplitude, OF_QUENCH, |r| numbers(r)?.lost),
        variable(("quench_last", "D"), "amplitude from which every larger one is quiet, up to the limit of the search", amplitude, OF_QUENCH, |r| numbers(r)?.last),
    ]
}

fn numbers(results: &Results) -> Result<QuenchNumbers, Status> {
    results.quench.unwrap_or(Err(Status::Missing))
}

#[expect(clippy::cast_precision_loss, reason = "one of eight words")]
fn kind(results: &Results) -> Result<f64, Status> {
    Ok(numbers(results)?.kind? as f64)
}
