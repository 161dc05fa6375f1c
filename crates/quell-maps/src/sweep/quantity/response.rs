//! The steady response with and without dither, as `response` measures it, and the effect of the dither.
//!
//! One mass is measured in lanes, the points of a chunk side by side; the result of a point still depends on its own study alone.

use std::any::TypeId;

use quell_dynamics::motion::MotionStart;
use quell_dynamics::response::{
    Effect, PlannedResponse, ResponsePlan, ResponseRefused, ResponseSummary, SteadyResponse,
    respond, respond_many,
};
use quell_dynamics::simulation::within;

use crate::cite::Task;
use crate::effort::STEPS_OF_A_SEARCH;
use crate::needs::Needs;
use crate::run::response::{RECORD_PERIODS, ResponseRequest, SETTLE_PERIODS, plan_of};
use crate::run::system::of_runs::beyond_laws;
use crate::run::system::start::start_of;
use crate::status::Status;
use crate::study::{SystemStart, SystemStudy};
use crate::sweep::map_quantity::{LENGTH, MapQuantity, RATIO, VariableKind, variable};
use crate::sweep::points::{ChunkPoints, Point, PointComputation, Subject};

/// The quantities.
#[rustfmt::skip]
pub(super) const QUANTITIES: &[MapQuantity] = &[
    MapQuantity::of::<EffectOfDither>("effect", "effect of the dither on the vibration: quenches, reduces, increases, causes, or quiet with and without it", Needs::MOTIONS, &[
        variable(("effect", ""), "effect of the dither", EFFECTS, OF_RESPONSE, |points| points.values(EffectOfDither::code)),
    ]),
    MapQuantity::of::<Responded>("residual-vibration", "residual vibration E = M₁/M₀ (2.27), the dissertation's efficiency metric: the share that remains under dither; 0 if quenched", Needs::MOTIONS, &[
        variable(("residual_vibration", "E"), "residual vibration E = M₁/M₀", RATIO, OF_RESPONSE, |points| points.values(|found: &Responded| Ok(found.summary.residual_vibration?))),
    ]),
    MapQuantity::of::<Responded>("amplitude", "largest spectral amplitude M of the observed displacement in the band of slow vibration: of one mass below 1.9 ω₀, of several below the dither", Needs::MOTIONS, &[
        variable(("amplitude", "M"), "spectral amplitude of the slow vibration", LENGTH, OF_RESPONSE, |points| points.values(|found: &Responded| Ok(found.summary.amplitude))),
    ]),
    MapQuantity::of::<Responded>("undithered-amplitude", "spectral amplitude M₀ of the run without dither", Needs::MOTIONS, &[
        variable(("undithered_amplitude", "M_0"), "spectral amplitude without dither", LENGTH, OF_RESPONSE, |points| points.values(|found: &Responded| Ok(found.summary.undithered_amplitude))),
    ]),
    MapQuantity::of::<Responded>(SETTLED, "whether the amplitudes of the two halves of the record agree", Needs::MOTIONS, &[
        variable((SETTLED, ""), "whether the response has settled", FLAG, OF_RESPONSE, |points| points.values(|found: &Responded| Ok(f64::from(u8::from(found.summary.settled))))),
    ]),
];

/// Whether a response has settled; added to every quantity of a response.
pub(in crate::sweep) const SETTLED: &str = "settled";

impl MapQuantity {
    /// Whether it is read from a record, which may not have settled.
    pub(in crate::sweep) fn is_of_response(&self) -> bool {
        [TypeId::of::<Responded>(), TypeId::of::<EffectOfDither>()].contains(&(self.computation)())
    }
}

/// Words of an effect; the first, the desired effect, is 0.
const EFFECTS: VariableKind = VariableKind::Word { words: &Effect::NAMES, unknown: "unknown" };

/// Words of a flag.
const FLAG: VariableKind = VariableKind::Word { words: &["no", "yes"], unknown: "unknown" };

/// Statuses of steady responses other than known.
const OF_RESPONSE: &[Status] = &[
    Status::BeyondRange,
    Status::Stalled,
    Status::NoSquealingStart,
    Status::UnditheredSettles,
    Status::UnditheredAtRest,
    Status::UnditheredUnknown,
    Status::StillChanging,
    Status::Unresolved,
    Status::NoDither,
    Status::RecordLength,
];

/// Seconds of one dither period of one mass with events, and of one slow period without dither.
const PERIOD: f64 = 1e-6;
const SLOW_PERIOD: f64 = 3e-6;

/// Seconds of one sample of a record that is observed but not stored.
const SAMPLE: f64 = 5e-8;

/// Cost of a response including the end of its run, relative to the response alone.
const SETTLING: f64 = 6.0;

/// Seconds of a steady response of four states, with and without dither.
const RESPONSE: f64 = 1e-1;

/// The steady response at a point.
struct Responded {
    /// What is measured.
    summary: ResponseSummary,
    start: MotionStart,
    plan: ResponsePlan,
    beyond_range: bool,
}

/// The effect of the dither at a point.
struct EffectOfDither {
    effect: Effect,
    beyond_range: bool,
}

impl EffectOfDither {
    #[expect(clippy::cast_precision_loss, reason = "one of five words")]
    fn code(&self) -> Result<f64, Status> {
        Ok(self.effect.place()? as f64)
    }
}

/// Start and plan of the response of a study.
fn prepared(study: &SystemStudy) -> Result<(MotionStart, ResponsePlan), Status> {
    let start = within(STEPS_OF_A_SEARCH, || start_of(study)).map_err(|_| no_start(study))?;
    let plan = plan_of(study, ResponseRequest::default()).map_err(|_| Status::InvalidStudy)?;
    Ok((start, plan))
}

/// Why a start does not exist.
fn no_start(study: &SystemStudy) -> Status {
    match study.initial() {
        SystemStart::Squealing => Status::NoSquealingStart,
        _ => Status::InvalidStudy,
    }
}

/// The whole response at a point.
pub(super) fn measured(point: &Point<'_>) -> Result<SteadyResponse, Status> {
    let study = point.study()?;
    let (start, plan) = prepared(study)?;
    respond(study.system(), &start, &plan).map_err(|why| refused(&why))
}

fn refused(why: &ResponseRefused) -> Status {
    match why {
        ResponseRefused::TooLong { .. } | ResponseRefused::TooShort { .. } => Status::RecordLength,
        ResponseRefused::Immobile(_) | ResponseRefused::Stopped(_) => Status::Stalled,
    }
}

impl PointComputation for Responded {
    const TASK: Task = Task::Response;

    fn at(points: &ChunkPoints<'_>) -> Vec<Result<Self, Status>> {
        let prepared = points.each(|point| Ok((point.study()?, prepared(point.study()?)?)));
        let known = prepared.iter().flatten();
        let planned: Vec<PlannedResponse<'_>> = known
            .map(|(study, (start, plan))| PlannedResponse { system: study.system(), start, plan })
            .collect();
        let mut found = respond_many(&planned).into_iter();
        let each = prepared.into_iter().map(|prepared| {
            let (study, (start, plan)) = prepared?;
            let summary = found.next().ok_or(Status::Missing)?;
            let summary = summary.map_err(|why| refused(&why))?;
            let beyond = beyond_laws(study, |contact| summary.largest_slip[contact]);
            Ok(Self { summary, start, plan, beyond_range: !beyond.is_empty() })
        });
        each.collect()
    }

    fn seconds(subject: &Subject) -> f64 {
        seconds(subject)
    }

    fn qualification(&self, _: f64) -> Status {
        Status::of_range(self.beyond_range)
    }
}

impl PointComputation for EffectOfDither {
    const TASK: Task = Task::Response;

    fn at(points: &ChunkPoints<'_>) -> Vec<Result<Self, Status>> {
        let found = points.found::<Responded>();
        let each = points.iter().zip(found.iter()).map(|(point, found)| {
            let Responded { summary, start, plan, beyond_range } =
                found.as_ref().map_err(|status| *status)?;
            let of = PlannedResponse { system: point.study()?.system(), start, plan };
            Ok(Self { effect: summary.effect(of), beyond_range: *beyond_range })
        });
        each.collect()
    }

    fn seconds(subject: &Subject) -> f64 {
        SETTLING * seconds(subject)
    }

    fn qualification(&self, _: f64) -> Status {
        Status::of_range(self.beyond_range)
    }
}

/// Seconds of a response of which a map shows a summary.
fn seconds(subject: &Subject) -> f64 {
    let mass = match subject {
        Subject::System(system) => system.one_mass(),
        Subject::Disc(_) => None,
    };
    mass.map_or_else(
        || seconds_alone(subject),
        |mass| {
            let waves = mass.belt().dithers().iter();
            let fastest = waves.fold(0.0_f64, |most, dither| most.max(dither.frequency_ratio));
            let samples = RECORD_PERIODS * (16.0 * fastest).max(128.0);
            let periods = SETTLE_PERIODS + RECORD_PERIODS;
            periods * (fastest * PERIOD + 2.0 * SLOW_PERIOD) + 2.0 * samples * SAMPLE
        },
    )
}

/// Seconds of a response with all that is measured.
pub(super) fn seconds_alone(subject: &Subject) -> f64 {
    RESPONSE * subject.work_over(4.0)
}
