//! Whether a run ends quiet: the judge of [`end_of_run`](super::end_of_run()), without a record of the motion.

use std::fmt;

use quell_linear::steady::NoSteadySliding;
use quell_model::{OneMass, RefusedNumbers, System};

use super::end_of_run::{FreeMotion, NoEnd, free_motion, judged_mass, start_of_mass};
use super::measure::classified;
use super::settings::AttractorSettings;
use super::settle::{Patience, SettleOutcome, settle};
use crate::orbit::{NoOrbit, settled, sliding_state};
use crate::simulation::Stalled;

/// Why a run has no state from which it starts.
#[derive(Clone, Debug, PartialEq)]
pub enum NoStart {
    /// There is no steady sliding.
    NoSliding(NoSteadySliding),
    /// The study to which the run belongs has no such state, in its words.
    OfStudy(String),
}

impl fmt::Display for NoStart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoSliding(why) => why.fmt(f),
            Self::OfStudy(why) => f.write_str(why),
        }
    }
}

impl std::error::Error for NoStart {}

/// Why the outcome of a run over a parameter is unknown.
#[derive(Clone, Debug, PartialEq)]
pub enum NoOutcome {
    /// There is no system at this value.
    Refused(RefusedNumbers),
    /// The run has no start.
    NoStart(NoStart),
    /// The motion while its dither is ramped up is unknown.
    NoRamp(NoOrbit),
    /// The end of the run is unknown.
    NoEnd(NoEnd),
    /// No value was tried.
    NothingTried,
}

impl fmt::Display for NoOutcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Refused(why) => why.fmt(f),
            Self::NoStart(why) => why.fmt(f),
            Self::NoRamp(why) => why.fmt(f),
            Self::NoEnd(why) => why.fmt(f),
            Self::NothingTried => f.write_str("no value was tried"),
        }
    }
}

impl std::error::Error for NoOutcome {}

/// How a run ends.
#[derive(Clone, Debug, PartialEq)]
pub enum RunOutcome {
    /// Without slow motion: in step with the dither, or periodic with all frequencies above the band of the vibration; without dither at
    /// rest or in steady sliding. A state of it, and its number of common periods of the dithers.
    Quiet(Vec<f64>, u32),
    /// Vibrating.
    Vibrating,
    /// The run cannot be computed, or does not settle.
    Unknown(NoOutcome),
}

impl RunOutcome {
    /// Whether the run ends quiet; `None` if that is unknown.
    pub fn is_quiet(&self) -> Option<bool> {
        match self {
            Self::Quiet(..) => Some(true),
            Self::Vibrating => Some(false),
            Self::Unknown(_) => None,
        }
    }
}

/// How the run of a system from a state at t = 0 ends. Attractors coexist: unlike the verdict on the base response this depends on the
/// start.
///
/// # Errors
/// [`NoEnd`].
pub fn outcome_of_run(system: &System, start: &[f64]) -> Result<RunOutcome, NoEnd> {
    if let Some(mass) = judged_mass(system) {
        return outcome_of_one_mass(system, &mass, start);
    }
    if !system.is_dithered() {
        return of_free_motion(&system.undithered(), start);
    }
    match settled(system, start) {
        Ok(found) if found.is_quiet(system) => {
            Ok(RunOutcome::Quiet(found.orbit.state, found.multiple))
        }
        Ok(_) | Err(NoOrbit::Unsettled { is_steady: true, .. }) => Ok(RunOutcome::Vibrating),
        Err(why) => Err(NoEnd::NoOrbit(why)),
    }
}

fn of_free_motion(system: &System, start: &[f64]) -> Result<RunOutcome, NoEnd> {
    Ok(match free_motion(system, start)? {
        FreeMotion::Cycle(_) => RunOutcome::Vibrating,
        FreeMotion::Rest(state) => RunOutcome::Quiet(state, 1),
    })
}

fn outcome_of_one_mass(
    system: &System,
    mass: &OneMass,
    start: &[f64],
) -> Result<RunOutcome, NoEnd> {
    let settings = AttractorSettings::new(mass.belt()).map_err(NoEnd::NoOrbit)?;
    let stopped = |why: Stalled| NoEnd::of_mass(mass, &why);
    let settled = settle(&settings, start_of_mass(mass, start), Patience::SWEEP);
    let settled = settled.map_err(stopped)?;
    if settings.is_autonomous() && settled.outcome == SettleOutcome::Base {
        // Unstable sliding is left, as by the judge.
        let free = system.undithered();
        let sliding = sliding_state(&free).unwrap_or_else(|_| start.to_vec());
        return of_free_motion(&free, &sliding);
    }
    let found = classified(&settings, &settled).map_err(stopped)?;
    let found = found.ok_or_else(|| NoEnd::unsettled(&settings, &settled))?;
    if !found.is_quiet(&settings) {
        return Ok(RunOutcome::Vibrating);
    }
    let state = mass.state(found.state.displacement, found.state.velocity).to_vec();
    Ok(RunOutcome::Quiet(state, found.periods().unwrap_or(1)))
}
