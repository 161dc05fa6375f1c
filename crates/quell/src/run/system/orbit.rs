//! `orbit` of a system: the base response under dither, a periodic motion near a state, or the one on which a run ends, with its
//! Floquet multipliers; without dither the limit cycle on which a run ends, or what was tried to find one.

use quell_dynamics::motion::orbit::{
    BASE_STEPS, CycleSearch, MotionOrbit, NamedStart, NoMotionOrbit, SettledMotion, TriedStart,
    base_motion, motion_near, search_cycle, settled, usual_starts,
};
use quell_linear::linearised::Linearised;
use quell_linear::spectrum;

use super::cycle_samples::CycleSamples;
use super::protocol::{SystemProtocol, unnamed};
use super::start::{StateNumbers, start_with};
use super::{failed, has_equations};
use crate::complaint::{Complaint, Failure};
use crate::run::orbit::Wanted;
use crate::study::SystemStudy;

/// The periodic motion to find.
#[derive(Clone, Debug, PartialEq)]
pub enum WantedMotion {
    /// The base response, or the motion reached from the study's start where it does not exist; without dither the limit cycle.
    Base {
        /// Number of common dither periods in a period of the motion.
        periods: u32,
    },
    /// A motion near the study's start with these numbers; without dither the cycle that a run from there reaches.
    Near {
        /// Numbers of the state.
        state: StateNumbers,
        /// Number of common dither periods in a period of the motion.
        periods: u32,
    },
    /// The motion on which a run ends, of any number of periods.
    After(SystemProtocol),
}

impl Default for WantedMotion {
    fn default() -> Self {
        Self::Base { periods: 1 }
    }
}

impl WantedMotion {
    /// The request about a belt for a system.
    ///
    /// # Errors
    /// A state given by two numbers.
    pub fn of(wanted: Wanted) -> Result<Self, Failure> {
        match wanted {
            Wanted::OfSliding { periods } => Ok(Self::Base { periods }),
            Wanted::Near { state, .. } => Err(unnamed("--near", state).into()),
            Wanted::After(protocol) => Ok(Self::After(SystemProtocol::of(protocol)?)),
        }
    }
}

/// How a periodic motion was found.
#[derive(Clone, Debug, PartialEq)]
pub enum FoundBy {
    /// It continues steady sliding.
    Continuation,
    /// It is near the given state.
    Shooting,
    /// A run under dither ends on it.
    Run {
        /// The start in words.
        start: String,
        /// Dither periods until the run was near it.
        periods: u32,
        /// Why it replaces the base response, if that was wanted.
        instead: Option<String>,
    },
    /// A run without dither ends on it.
    FreeRun {
        /// The start in words.
        start: String,
    },
}

/// A periodic motion with its samples.
#[derive(Clone, Debug)]
pub struct FoundMotion {
    /// The motion.
    pub orbit: MotionOrbit,
    /// Common dither periods in its period; 1 without dither.
    pub multiple: u32,
    /// How it was found.
    pub by: FoundBy,
    /// Its samples over a period.
    pub samples: CycleSamples,
}

/// The answer of `orbit`.
#[derive(Clone, Debug)]
pub struct OrbitOfSystem {
    /// The motion; `None` where no limit cycle was found.
    pub found: Option<FoundMotion>,
    /// Starts from which no limit cycle was reached.
    pub tried: Vec<TriedStart>,
    /// Verdict on steady sliding of an undithered system, or why it is unknown.
    pub sliding: Option<Result<&'static str, String>>,
}

/// The periodic motion of a study.
///
/// # Errors
/// Complaints about the request and the start; [`Failure::Failed`] if a motion under dither was not found.
pub fn run(study: &SystemStudy, wanted: &WantedMotion) -> Result<OrbitOfSystem, Failure> {
    has_equations(study, "orbit")?;
    if !study.system().is_dithered() {
        return undithered(study, wanted);
    }
    let system = study.system();
    let refused = |why: NoMotionOrbit| failed("orbit", why);
    let (orbit, multiple, by) = match wanted {
        WantedMotion::Near { state, periods } => {
            let guess = start_with(study, state)?.state;
            let periods = (*periods).max(1);
            (motion_near(system, &guess, periods).map_err(refused)?, periods, FoundBy::Shooting)
        }
        WantedMotion::After(protocol) => reached(study, protocol, None)?,
        WantedMotion::Base { periods } => match base_motion(system, BASE_STEPS) {
            Ok(base) if *periods > 1 => {
                let found = motion_near(system, &base.state, *periods).map_err(refused)?;
                (found, *periods, FoundBy::Continuation)
            }
            Ok(base) => (base, 1, FoundBy::Continuation),
            Err(why) if *periods > 1 => return Err(refused(why)),
            Err(why) => reached(study, &SystemProtocol::Study, Some(why))?,
        },
    };
    Ok(OrbitOfSystem {
        found: Some(with_samples(study, orbit, multiple, by)),
        tried: Vec::new(),
        sliding: None,
    })
}

fn with_samples(
    study: &SystemStudy,
    orbit: MotionOrbit,
    multiple: u32,
    by: FoundBy,
) -> FoundMotion {
    let samples = if orbit.is_free {
        CycleSamples::of(&study.system().undithered(), &study.observe(), &orbit)
    } else {
        CycleSamples::of(study.system(), &study.observe(), &orbit)
    };
    FoundMotion { orbit, multiple, by, samples }
}

/// The motion on which a run ends.
fn reached(
    study: &SystemStudy,
    protocol: &SystemProtocol,
    instead: Option<NoMotionOrbit>,
) -> Result<(MotionOrbit, u32, FoundBy), Failure> {
    let system = study.system();
    let start = protocol.state(study, system)?;
    let words = protocol.words(study);
    match settled(system, &start) {
        Ok(SettledMotion { orbit, multiple, periods }) => {
            let instead = instead.map(|why| why.to_string());
            Ok((orbit, multiple, FoundBy::Run { start: words, periods, instead }))
        }
        Err(why) => Err(match instead {
            None => failed("orbit", format!("the run {words}: {why}")),
            Some(base) => failed(
                "orbit",
                format!("there is no base response: {base}; and the run {words}: {why}"),
            ),
        }),
    }
}

/// The limit cycle of an undithered system.
fn undithered(study: &SystemStudy, wanted: &WantedMotion) -> Result<OrbitOfSystem, Failure> {
    let system = study.system();
    if let WantedMotion::Base { periods } | WantedMotion::Near { periods, .. } = wanted
        && *periods > 1
    {
        let allowed = "1: without dither there is no dither period to count";
        return Err(Complaint::option("--periods", *periods, allowed).into());
    }
    let free = system.undithered();
    let given = |protocol: &SystemProtocol| -> Result<NamedStart, Failure> {
        Ok((protocol.words(study), protocol.state(study, &free)?))
    };
    let CycleSearch { found, tried } = match wanted {
        WantedMotion::After(SystemProtocol::Squeal) => search_cycle(&free, usual_starts(&free)),
        WantedMotion::After(protocol) => search_cycle(&free, vec![given(protocol)?]),
        WantedMotion::Near { state, .. } => {
            search_cycle(&free, vec![given(&SystemProtocol::From(state.clone()))?])
        }
        WantedMotion::Base { .. } => {
            let first = given(&SystemProtocol::Study)?;
            let mut starts = usual_starts(&free);
            starts.retain(|other| other.1 != first.1);
            starts.insert(0, first);
            search_cycle(&free, starts)
        }
    };
    let found =
        found.map(|(orbit, start)| with_samples(study, orbit, 1, FoundBy::FreeRun { start }));
    let sliding = Linearised::new(&free).map_err(|why| why.to_string()).and_then(|linear| {
        let growth =
            spectrum::growth(&linear, &linear.friction()).map_err(|why| why.to_string())?;
        Ok(growth.verdict().name())
    });
    Ok(OrbitOfSystem { found, tried, sliding: Some(sliding) })
}
