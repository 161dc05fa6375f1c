//! The exact quench amplitude of the first dither: its kind, and where quiet amplitudes end or begin again.

use quell_design::quench::QUENCH_KINDS;

use super::{critical, growth};
use crate::needs::Needs;
use crate::run::quench_numbers::QuenchNumbers;
use crate::status::Status;
use crate::sweep::map_quantity::{FORCE, MapQuantity, VariableKind, variable};
use crate::sweep::points::{ChunkPoints, PointComputation, Subject};

/// The quantity.
#[rustfmt::skip]
pub(super) const QUANTITIES: &[MapQuantity] = &[
    MapQuantity::of::<QuenchNumbers>("quench-amplitude", "least amplitude of the first dither from which the base response is stable, exactly: its kind, that of finite-R averaging, and where quiet amplitudes end or begin again", Needs::MOTIONS, &[
        variable(("quench_amplitude", "D*"), "exact quench amplitude, the least one from which the base response is stable", FORCE, OF_QUENCH, |points| points.values(|found: &QuenchNumbers| found.least)),
        variable(("quench_kind", ""), "bifurcation of the base response at the quench amplitude", KINDS, OF_QUENCH, |points| points.values(kind)),
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

#[expect(clippy::cast_precision_loss, reason = "one of eight words")]
fn kind(found: &QuenchNumbers) -> Result<f64, Status> {
    Ok(found.kind? as f64)
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
