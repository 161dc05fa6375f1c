//! The motion on which the run of a study ends, by the judge of `attractor`.

use quell_dynamics::attractor::{SystemAttractor, end_of_run};
use quell_model::Contact;

use crate::needs::Needs;
use crate::run::protocol::Protocol;
use crate::run::slip::SlipReached;
use crate::run::system::of_runs::beyond_laws;
use crate::status::Status;
use crate::sweep::map_quantity::{LENGTH, MapQuantity, RATIO, VariableKind, variable};
use crate::sweep::points::{ChunkPoints, Point, PointComputation, Subject};

/// The quantities.
#[rustfmt::skip]
pub(super) const QUANTITIES: &[MapQuantity] = &[
    MapQuantity::of::<RunEnd>("ends-on", "the motion on which the run of the study ends: period-1 (in step with the dither), locked, quasi-periodic, not-periodic, limit-cycle, rest", Needs::MOTIONS, &[
        variable(("ends_on", ""), "motion on which the run ends", MOTIONS, OF_END, |points| points.values(RunEnd::code)),
    ]),
    MapQuantity::of::<RunEnd>("peak-to-peak", "peak-to-peak of the observed displacement of the motion on which the run ends", Needs::MOTIONS, &[
        variable(("peak_to_peak", ""), "peak-to-peak of the observed displacement", LENGTH, OF_END, |points| points.values(|found: &RunEnd| Ok(found.attractor.size()))),
    ]),
    MapQuantity::of::<RunEnd>("stick-fraction", "largest fraction of the time that a contact sticks, on the motion on which the run ends", Needs::MOTIONS, &[
        variable(("stick_fraction", ""), "largest fraction of the time that a contact sticks", RATIO, OF_END, |points| points.values(|found: &RunEnd| found.stick_fraction)),
    ]),
];

/// Names of the motions on which runs end, in the order of their codes.
const MOTION_NAMES: [&str; 6] =
    ["period-1", "locked", "not-periodic", "limit-cycle", "rest", "quasi-periodic"];

/// The same as words.
const MOTIONS: VariableKind = VariableKind::Word { words: &MOTION_NAMES, unknown: "unknown" };

/// Statuses of the motions on which runs end, other than known.
const OF_END: &[Status] =
    &[Status::BeyondRange, Status::Stalled, Status::NoSquealingStart, Status::NeverSticks];

/// Seconds of a run of four states to the motion on which it ends.
const END: f64 = 2e-2;

/// The motion on which a run ends.
struct RunEnd {
    attractor: SystemAttractor,
    /// Largest share of the time that a contact sticks; bristles never stick.
    stick_fraction: Result<f64, Status>,
    /// Whether slip leaves the range of a friction law, at the start or on the motion.
    beyond_range: bool,
}

impl RunEnd {
    #[expect(clippy::cast_precision_loss, reason = "one of six words")]
    fn code(&self) -> Result<f64, Status> {
        let name = self.attractor.kind_name();
        let place = MOTION_NAMES.iter().position(|known| *known == name);
        Ok(place.ok_or(Status::Missing)? as f64)
    }

    fn of(point: &Point<'_>) -> Result<Self, Status> {
        let (study, system) = (point.study()?, point.system()?);
        let start = Protocol::Study.state(study, system).map_err(|_| Status::NoSquealingStart)?;
        let end = end_of_run(system, &study.observe(), &start);
        let attractor = end.map_err(|_| Status::Stalled)?.attractor;
        let sticks = |contact: &Contact| contact.friction.bristles().is_none();
        let shares = system.contacts.iter().zip(&attractor.stick);
        let most = shares
            .filter(|(contact, _)| sticks(contact))
            .map(|(_, share)| *share)
            .max_by(f64::total_cmp);
        let mut slip = SlipReached::new(system);
        slip.add_all(system, &[start, attractor.state.clone()]);
        let slip = slip.largest();
        Ok(Self {
            stick_fraction: most.ok_or(Status::NeverSticks),
            beyond_range: !beyond_laws(study, |contact| slip[contact]).is_empty(),
            attractor,
        })
    }
}

impl PointComputation for RunEnd {
    fn at(points: &ChunkPoints<'_>) -> Vec<Result<Self, Status>> {
        points.each(Self::of)
    }

    fn seconds(subject: &Subject) -> f64 {
        END * subject.work_over(4.0)
    }

    fn qualification(&self, _: f64) -> Status {
        Status::of_range(self.beyond_range)
    }
}
