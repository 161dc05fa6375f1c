//! `bifurcation`: the response along a parameter, swept up and down with the state carried over.
//!
//! At each value the run continues from the end of the last one (on a closed orbit from its exact state) until a growth rate
//! shows that it has settled. The downward sweep begins where the upward sweep ended. Where the two differ, responses coexist.

mod answer;
pub(in crate::run) mod shared;

use std::sync::atomic::Ordering;

use quell_dynamics::attractor::{Attractor, AttractorKind, Patience, Unsettled, measure, settle};
use quell_dynamics::orbit::OrbitVerdict;
use quell_dynamics::simulation::{Start, within};
use quell_model::units::Scales;

use super::attractor::{settings, unknown};
use super::varied::Varied;
use super::{failed, start, stopped};
use crate::complaint::Failure;
use crate::contact_state::refused_of_belt;
use crate::effort::STEPS_OF_A_SEARCH;
use crate::range::SlipMet;
use crate::study::BeltStudy;
use crate::sweep::Running;
pub use shared::{SweepDirection, SweepRequest};

/// Relative difference of size beyond which the two directions show different responses.
const APART: f64 = 0.02;

/// The same limit relative to F, for responses without slow motion.
const APART_AT_LEAST: f64 = 1e-4;

/// Largest difference of rotation numbers (revolutions per period) of two closed curves that count as one: ten times the
/// tolerance within a steady record.
const TURN_ALIKE: f64 = 1e-4;

/// The response at one value.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepPoint {
    /// The parameter.
    pub value: f64,
    /// Scales at this value, of a study in SI: mass and stiffness may be varied.
    pub scales: Option<Scales>,
    /// Period of the section, τ.
    pub period: f64,
    /// Whether responses of the dither's own period may vibrate in the band of slow vibration (R ≤ 1.9).
    pub in_band: bool,
    /// Whether the base response is stable here, whether or not the sweep is on it; or why this is unknown.
    pub local: Result<OrbitVerdict, String>,
    /// The response that the sweep is on, or why it has not settled.
    pub response: Result<Attractor, Unsettled>,
    /// Periods until it had settled.
    pub periods: u64,
}

/// A sweep in one direction, in the order of the sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct Branch {
    /// Direction.
    pub direction: SweepDirection,
    /// Its points.
    pub points: Vec<SweepPoint>,
}

/// Two neighbouring values of a branch with known responses, between which the sweep leaves or reaches quiescence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jump {
    /// The last value before.
    pub before: f64,
    /// The first value after.
    pub after: f64,
    /// Whether the response is quiet afterwards.
    pub to_quiet: bool,
    /// Whether the dither lies in the band of slow vibration there.
    pub in_band: bool,
}

/// Sweeps of one parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Bifurcation {
    /// The parameter and its values.
    pub varied: Varied,
    /// The requested sweeps, up before down.
    pub branches: Vec<Branch>,
    /// First and last value of each range in which the two directions show different responses. Values at which one of them
    /// has not settled do not count.
    pub hysteresis: Vec<(f64, f64)>,
    /// The slip reached by the responses.
    pub slip: SlipMet,
}

/// Sweeps the belt of a study.
///
/// # Errors
/// Complaints about the request or the start; [`Failure::Failed`] if the engine stops or the work is interrupted.
pub fn run(
    study: &BeltStudy,
    question: &SweepRequest,
    running: Running<'_>,
) -> Result<Bifurcation, Failure> {
    refused_of_belt(study, "bifurcation")?;
    let varied = Varied::new(study, "--parameter", &question.range)?;
    let count = varied.values.len();
    let directions = shared::directions(question);
    running.progress.begin(count * directions.len(), 0);
    let mut branches: Vec<Branch> = Vec::new();
    let mut state: Option<Start> = None;
    let mut slip = SlipMet::default();
    let swept = directions.into_iter().try_for_each(|direction| {
        let mut values = varied.values.clone();
        if direction == SweepDirection::Down {
            values.reverse();
        }
        let mut found = Vec::with_capacity(count);
        for value in values {
            if running.stop.load(Ordering::Relaxed) {
                return Err(stopped("bifurcation"));
            }
            let at = varied.study_at(study, value)?;
            let begun = match state {
                Some(state) => state,
                None => start(&at)?,
            };
            let (point, end) = within(STEPS_OF_A_SEARCH, || point(&at, value, begun))?;
            slip.add_attractor(at.belt(), end);
            found.push(point);
            state = Some(end);
            running.progress.advance(1);
        }
        branches.push(Branch { direction, points: found });
        Ok(())
    });
    running.progress.end();
    swept?;
    let hysteresis = hysteresis(study, &branches);
    Ok(Bifurcation { varied, branches, hysteresis, slip })
}

/// The response at one value, and the state from which the next one starts.
fn point(study: &BeltStudy, value: f64, begun: Start) -> Result<(SweepPoint, Start), Failure> {
    let settings = settings(study.belt())?;
    let patience = Patience { tolerance: study.solver().tolerance, ..Patience::SWEEP };
    let settled = settle(&settings, begun, patience).map_err(failed)?;
    let attractor = measure(&settings, &settled).map_err(failed)?;
    let end = attractor.as_ref().map_or(settled.state, |attractor| attractor.state);
    let response = attractor.ok_or_else(|| settled.why().unwrap_or(Unsettled::Moving));
    let local = settings.base.as_ref().map(|base| base.verdict).map_err(unknown);
    let period = settings.section.period;
    let in_band = settings.reaches_the_band();
    let scales = study.scales();
    Ok((
        SweepPoint { value, scales, period, in_band, local, response, periods: settled.periods },
        end,
    ))
}

/// Ranges in which both directions were swept and show different responses.
fn hysteresis(study: &BeltStudy, branches: &[Branch]) -> Vec<(f64, f64)> {
    let [up, down] = branches else { return Vec::new() };
    let scale = study.belt().normal_load();
    let pairs = up.points.iter().zip(down.points.iter().rev());
    shared::ranges(pairs.map(|(one, other)| {
        let apart = match (&one.response, &other.response) {
            (Ok(one), Ok(other)) if is_one_torus(one, other) => one.quiet != other.quiet,
            (Ok(one), Ok(other)) => {
                let most = one.size().max(other.size());
                one.quiet != other.quiet
                    || (one.size() - other.size()).abs() > APART * most + APART_AT_LEAST * scale
            }
            _ => false,
        };
        (one.value, apart)
    }))
}

/// Whether two responses may be the same although their records differ in size: closed curves with the same rotation, or
/// responses that are neither a closed orbit nor a curve, of which a record shows only a part.
fn is_one_torus(one: &Attractor, other: &Attractor) -> bool {
    let turns =
        |attractor: &Attractor| attractor.rotation.map(|rotation| rotation.turns_per_period);
    match (one.kind, other.kind) {
        (AttractorKind::Unclassified, _) | (_, AttractorKind::Unclassified) => true,
        (AttractorKind::QuasiPeriodic, AttractorKind::QuasiPeriodic) => turns(one)
            .zip(turns(other))
            .is_some_and(|(one, other)| (one - other).abs() <= TURN_ALIKE),
        _ => false,
    }
}

impl SweepPoint {
    /// Whether the response is quiet; `None` if it has not settled.
    pub fn quiet(&self) -> Option<bool> {
        self.response.as_ref().ok().map(|attractor| attractor.quiet)
    }
}

impl Branch {
    /// The jumps at which the sweep leaves or reaches quiescence.
    pub fn jumps(&self) -> Vec<Jump> {
        let changes = shared::changes(self.points.iter().map(SweepPoint::quiet));
        let jump = |(before, after): (usize, usize)| {
            let (before, after) = (&self.points[before], &self.points[after]);
            let (to_quiet, in_band) = (after.quiet() == Some(true), after.in_band);
            Jump { before: before.value, after: after.value, to_quiet, in_band }
        };
        changes.into_iter().map(jump).collect()
    }
}
