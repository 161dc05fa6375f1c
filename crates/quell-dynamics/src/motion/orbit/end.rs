//! Whether a run ends quiet: one question, with one judge for each kind of system.
//!
//! | system | judge |
//! |---|---|
//! | one mass with a rigid contact | its stroboscopic section, without dither its cycle map: [`reached`](crate::attractor::reached) |
//! | any other, under dither | the periodic motion on which it ends, [`settled`] |
//! | any other, without dither | its limit cycle, or rest, [`free_cycle`] |

use quell_linear::growth::Verdict;
use quell_linear::linearised::Linearised;
use quell_linear::spectrum;
use quell_model::{OneMass, System};

use super::{NoCycle, NoMotionOrbit, SettledMotion, free_cycle, is_on_sliding, kicked_by, settled};
use crate::attractor::{Reached, reached_at};
use crate::band::is_above_the_band;
use crate::orbit::OrbitVerdict;
use crate::simulation::Start;

/// Velocity of the displacement of a start on unstable steady sliding, over that of the surface: far above rounding, so that the
/// run leaves in time, and far below that of a limit cycle.
const NUDGE: f64 = 1e-4;

/// How a run ends.
#[derive(Clone, Debug, PartialEq)]
pub enum RunOutcome {
    /// Without slow motion: in step with the dither, or periodic with all frequencies above the band of the vibration; without dither at
    /// rest or in steady sliding. A state of it, and its number of common periods of the dithers where that is known.
    Quiet(Vec<f64>, Option<u32>),
    /// Vibrating.
    Vibrating,
    /// The run cannot be computed, or does not settle.
    Unknown(String),
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

/// How the run of a system from a state at t = 0 ends.
///
/// # Errors
/// Why that is unknown.
pub(super) fn end_of(system: &System, start: &[f64]) -> Result<RunOutcome, String> {
    if let Some(mass) = system.one_mass() {
        return of_one_mass(&mass, start);
    }
    if !system.is_dithered() {
        return without_dither(&system.undithered(), start);
    }
    match settled(system, start) {
        Ok(SettledMotion { orbit, multiple, .. }) => {
            let is_quiet = multiple == 1 || is_above_the_band(system, orbit.period);
            let quiet = RunOutcome::Quiet(orbit.state, Some(multiple));
            Ok(if is_quiet { quiet } else { RunOutcome::Vibrating })
        }
        Err(NoMotionOrbit::Unsettled { is_steady: true, .. }) => Ok(RunOutcome::Vibrating),
        Err(why) => Err(why.to_string()),
    }
}

fn of_one_mass(mass: &OneMass, start: &[f64]) -> Result<RunOutcome, String> {
    let (displacement, velocity) = mass.of_state(start);
    let start = Start { time: 0.0, displacement, velocity };
    let (reached, state) = reached_at(mass.belt(), start).map_err(|why| why.to_string())?;
    let state = || mass.state(state.displacement, state.velocity).to_vec();
    match reached {
        Reached::Base => Ok(RunOutcome::Quiet(state(), Some(1))),
        Reached::Forced => Ok(RunOutcome::Quiet(state(), None)),
        Reached::Elsewhere => Ok(RunOutcome::Vibrating),
        Reached::Unsettled | Reached::Unknown => {
            Err("the run has not settled within its periods".to_owned())
        }
    }
}

fn without_dither(system: &System, start: &[f64]) -> Result<RunOutcome, String> {
    match free_cycle(system, &displaced(system, start)) {
        Ok(cycle) if cycle.verdict() == OrbitVerdict::Unstable => {
            Err("the run comes so near an unstable limit cycle that its end is not known"
                .to_owned())
        }
        Ok(_) => Ok(RunOutcome::Vibrating),
        Err(NoCycle::Rest { state, .. }) => Ok(RunOutcome::Quiet(state, Some(1))),
        Err(why) => Err(why.to_string()),
    }
}

/// A start without dither. A run from unstable steady sliding would stay there until rounding displaces it: such a start is
/// displaced first, by 10⁻⁴ times the velocity of the surface.
pub fn displaced(system: &System, start: &[f64]) -> Vec<f64> {
    if !is_on_sliding(system, start) || sliding_verdict(system) == Ok(Verdict::Stable) {
        return start.to_vec();
    }
    kicked_by(system, NUDGE).unwrap_or_else(|| start.to_vec())
}

/// The verdict on steady sliding of a system without dither, by its small motions.
///
/// # Errors
/// Why it is unknown: there is no steady sliding, or its eigenvalues overflow.
pub fn sliding_verdict(system: &System) -> Result<Verdict, String> {
    let linear = Linearised::new(system).map_err(|why| why.to_string())?;
    let growth = spectrum::growth(&linear, &linear.friction()).map_err(|why| why.to_string())?;
    Ok(growth.verdict())
}
