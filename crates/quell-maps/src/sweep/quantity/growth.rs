//! Growth rates of small motions about steady sliding, of averages under dither, and the verdicts on them.

use crate::needs::Needs;
use crate::run::sliding_growth::{PreparedDisc, SlidingGrowth, disc_growth};
use crate::status::Status;
use crate::sweep::map_quantity::{
    MapQuantity, OF_AVERAGES, RATIO, VERDICTS, VariableKind, variable,
};
use crate::sweep::points::{ChunkPoints, PointComputation, Subject};

/// The quantities.
#[rustfmt::skip]
pub(super) const QUANTITIES: &[MapQuantity] = &[
    MapQuantity::of::<SlidingGrowth>("growth", "largest growth rate of small motions, by averaging under dither, its verdict and the bound on its error", Needs::SLIDING, &[
        variable(("growth", "Re λ"), "largest growth rate", VariableKind::Rate, OF_AVERAGES, |points| points.values(|found: &SlidingGrowth| Ok(found.growth.rate))),
        variable(("growth_error", ""), "bound on the error of the growth rate", VariableKind::Rate, OF_AVERAGES, |points| points.values(|found: &SlidingGrowth| Ok(found.growth.error))),
        variable(("growth_verdict", ""), "whether the sign of the growth rate is certain within its error", VERDICTS, OF_AVERAGES, |points| points.values(verdict)),
    ]),
    MapQuantity::of::<SlidingGrowth>("frequency", "angular frequency of the fastest growing motion; of a disc under dither up to multiples of the dither frequency", Needs::SLIDING, &[
        variable(("frequency", "Im λ"), "angular frequency of the fastest growing motion", VariableKind::Rate, OF_AVERAGES, |points| points.values(|found: &SlidingGrowth| Ok(found.growth.frequency))),
    ]),
    MapQuantity::of::<SlidingGrowth>("verdict", "verdict on steady sliding, by averaging under dither: stable or unstable, undecided within its error", Needs::SLIDING, &[
        variable(("verdict", ""), "verdict on steady sliding", VERDICTS, OF_AVERAGES, |points| points.values(verdict)),
    ]),
    MapQuantity::of::<SlidingGrowth>("slip-ratio", "largest fast slip velocity over the velocity of its surface: from 1 on a contact reverses", Needs::CONTACTS, &[
        variable(("slip_ratio", "|â|/v"), "largest fast slip over the velocity of its surface", RATIO, OF_AVERAGES, |points| points.values(|found: &SlidingGrowth| Ok(found.slip_ratio))),
    ]),
    MapQuantity::of::<UnditheredGrowth>("growth-undithered", "largest growth rate without dither", Needs::SLIDING, &[
        variable(("growth_undithered", "Re λ_0"), "largest growth rate without dither", VariableKind::Rate, OF_SLIDING, |points| points.values(|found: &UnditheredGrowth| Ok(found.0.growth.rate))),
        variable(("growth_undithered_error", ""), "bound on the error of the growth rate without dither", VariableKind::Rate, OF_SLIDING, |points| points.values(|found: &UnditheredGrowth| Ok(found.0.growth.error))),
    ]),
];

/// Statuses of growth rates without dither other than known.
const OF_SLIDING: &[Status] = &[Status::BeyondRange, Status::NoSteadySliding];

/// Seconds of one growth rate of ten states: it grows slightly slower than their cube.
const GROWTH: f64 = 5e-5;

/// Seconds of one growth rate.
pub(super) fn seconds(subject: &Subject) -> f64 {
    GROWTH * subject.work_over(10.0)
}

/// The same without dither.
struct UnditheredGrowth(SlidingGrowth);

/// The code of a verdict in [`VERDICTS`].
fn verdict(found: &SlidingGrowth) -> Result<f64, Status> {
    Ok(if found.is_unstable()? { 0.0 } else { 1.0 })
}

impl PointComputation for SlidingGrowth {
    fn at(points: &ChunkPoints<'_>) -> Vec<Result<Self, Status>> {
        let mut prepared: Option<PreparedDisc> = None;
        let one = |subject: &Subject| match subject {
            Subject::System(system) => Self::averaged(system),
            Subject::Disc(of) => {
                let found = disc_growth(&of.disc, of.parts, &mut prepared)?;
                Ok(Self::in_units(found, of.rate))
            }
        };
        points.iter().map(|point| &point.subject).map(one).collect()
    }

    fn seconds(subject: &Subject) -> f64 {
        seconds(subject)
    }

    fn qualification(&self, _: f64) -> Status {
        self.doubts.first().copied().unwrap_or(Status::Known)
    }
}

impl PointComputation for UnditheredGrowth {
    fn at(points: &ChunkPoints<'_>) -> Vec<Result<Self, Status>> {
        let mut prepared: Option<PreparedDisc> = None;
        let one = |subject: &Subject| match subject {
            Subject::System(system) => Ok(Self(SlidingGrowth::undithered(system)?)),
            Subject::Disc(of) => {
                let found = disc_growth(&of.disc.undithered(), of.parts, &mut prepared)?;
                Ok(Self(SlidingGrowth::in_units(found, of.rate)))
            }
        };
        points.iter().map(|point| &point.subject).map(one).collect()
    }

    fn seconds(subject: &Subject) -> f64 {
        seconds(subject)
    }

    fn qualification(&self, value: f64) -> Status {
        self.0.qualification(value)
    }
}
