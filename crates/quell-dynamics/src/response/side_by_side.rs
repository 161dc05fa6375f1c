//! Steady responses of many systems, those of one mass side by side: what a map shows of them.

use std::f64::consts::TAU;

use quell_model::{OneMass, System};

use super::effect::{Effect, Vibrations};
use super::measure::{Compared, ResponseCase, Undefined, compare_many};
use super::record_grid::RecordGrid;
use super::refused::ResponseRefused;
use super::response_plan::ResponsePlan;
use super::solver::Solver;
use super::spectral_meter::{WINDOW_REACH, band_end_of_mass};
use super::steady_response::{SteadyResponse, effect_of, respond};
use super::system_ending::SystemEnding;
use crate::motion::MotionStart;
use crate::simulation::{Start, largest_slips};

/// Time of the equations for which a start is observed: its first slow period, in which a decaying transient is largest.
const OF_START: f64 = TAU;

/// The response of one system, to be measured.
#[derive(Clone, Copy, Debug)]
pub struct PlannedResponse<'a> {
    /// The system.
    pub system: &'a System,
    /// The start.
    pub start: &'a MotionStart,
    /// How it is measured.
    pub plan: &'a ResponsePlan,
}

/// What a map shows of a steady response.
#[derive(Clone, Debug)]
pub struct ResponseSummary {
    /// E = M₁/M₀, or why it is undefined.
    pub residual_vibration: Result<f64, Undefined>,
    /// M with dither.
    pub amplitude: f64,
    /// M without dither.
    pub undithered_amplitude: f64,
    /// Whether both runs settled, as far as E requires.
    pub settled: bool,
    /// Largest slip speed of each contact in both runs, 0 where its law has no range.
    pub largest_slip: Vec<f64>,
    effect: SummaryEffect,
}

/// The effect of a dither, or what decides it together with the end of the run, which is not sought before it is asked for.
#[derive(Clone, Debug)]
enum SummaryEffect {
    Known(Effect),
    ByTheEnd { compared: Compared, band_end: f64 },
}

impl From<&SteadyResponse> for ResponseSummary {
    fn from(found: &SteadyResponse) -> Self {
        let contacts = 0..found.dithered.largest_slip.len();
        Self {
            residual_vibration: found.residual_vibration,
            amplitude: found.dithered.lines.whole,
            undithered_amplitude: found.undithered.lines.whole,
            settled: found.is_settled(),
            largest_slip: contacts.map(|contact| found.largest_slip(contact)).collect(),
            effect: SummaryEffect::Known(found.effect),
        }
    }
}

impl ResponseSummary {
    /// The effect of the dither, as [`respond`] decides it. `of` is what was measured.
    pub fn effect(&self, of: PlannedResponse<'_>) -> Effect {
        let (compared, band_end) = match &self.effect {
            SummaryEffect::Known(effect) => return *effect,
            SummaryEffect::ByTheEnd { compared, band_end } => (compared, *band_end),
        };
        let vibrates = compared.vibrates_in_band();
        let ending = SystemEnding::judged(of.system, &of.plan.row, of.start);
        let vibrations = Vibrations {
            dithered: compared.dithered.record(),
            undithered: compared.undithered.record(),
            quiet_without: vibrates.is_err_and(Undefined::is_quiet),
            quiet_with: ending.motion().map(|found| found.quiet),
        };
        effect_of(of.system.is_dithered(), vibrates, (&ending, band_end), &vibrations)
    }
}

/// One mass whose record is a whole number of its slow periods, so that it is measured in a lane.
struct MassLane {
    /// Its place among the planned responses.
    at: usize,
    mass: OneMass,
    case: ResponseCase,
    solver: Solver,
}

impl MassLane {
    fn of((at, planned): (usize, &PlannedResponse<'_>)) -> Option<Self> {
        let mass = planned.system.one_mass()?;
        let solver = planned.plan.solver_of(&mass)?;
        // A record that `respond` refuses is refused here.
        RecordGrid::of_mass(&mass, planned.plan).ok()?;
        let (displacement, velocity) = mass.of_state(&planned.start.state);
        let start = Start { time: mass.rate() * planned.start.time, displacement, velocity };
        let case = ResponseCase { belt: mass.belt().clone(), start };
        Some(Self { at, mass, case, solver })
    }

    /// What was measured, in the units of the system; `None` where the record has not settled.
    fn summary(
        &self,
        plan: &ResponsePlan,
        compared: Compared,
        first: f64,
    ) -> Option<ResponseSummary> {
        let residual_vibration = compared.residual_vibration();
        let (dithered, undithered) = (&compared.dithered, &compared.undithered);
        let settled =
            compared.settled() && (compared.undithered_settled() || residual_vibration.is_err());
        let length = (plan.row[0] * self.mass.displacement()).abs();
        let rate = self.mass.rate();
        let reach = WINDOW_REACH * TAU / plan.length / rate;
        settled.then(|| ResponseSummary {
            residual_vibration,
            amplitude: length * dithered.lines.whole,
            undithered_amplitude: length * undithered.lines.whole,
            settled,
            largest_slip: vec![dithered.largest_slip.max(undithered.largest_slip).max(first)],
            effect: SummaryEffect::ByTheEnd {
                compared,
                band_end: rate * band_end_of_mass(self.mass.belt(), reach),
            },
        })
    }
}

/// Measures the steady responses of many systems. One mass is measured in lanes; a record that has not settled there begins again on
/// the motion on which the run ends, as [`respond`] has it. The bits of a result do not depend on the other systems.
pub fn respond_many(
    planned: &[PlannedResponse<'_>],
) -> Vec<Result<ResponseSummary, ResponseRefused>> {
    let mut measured: Vec<Option<ResponseSummary>> = planned.iter().map(|_| None).collect();
    let mut rest: Vec<MassLane> = planned.iter().enumerate().filter_map(MassLane::of).collect();
    while let Some(solver) = rest.first().map(|lane| lane.solver) {
        let (alike, others): (Vec<MassLane>, Vec<MassLane>) =
            rest.into_iter().partition(|lane| lane.solver == solver);
        rest = others;
        let cases: Vec<ResponseCase> = alike.iter().map(|lane| lane.case.clone()).collect();
        let starts: Vec<_> = cases.iter().map(|case| (&case.belt, case.start)).collect();
        let firsts = largest_slips(&starts, OF_START);
        for ((lane, compared), first) in alike.iter().zip(compare_many(&cases, &solver)).zip(firsts)
        {
            let plan = planned[lane.at].plan;
            measured[lane.at] =
                compared.ok().and_then(|compared| lane.summary(plan, compared, first));
        }
    }
    let each = planned.iter().zip(measured).map(|(of, found)| match found {
        Some(found) => Ok(found),
        None => Ok(ResponseSummary::from(&respond(of.system, of.start, of.plan)?)),
    });
    each.collect()
}
