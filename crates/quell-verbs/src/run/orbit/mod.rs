//! `orbit`: the base response under dither, a periodic motion near a state, or the one on which a run ends, with its
//! Floquet multipliers; without dither the limit cycle on which a run ends, or what was tried to find one.

use quell_dynamics::attractor::orbit_of_run;
use quell_dynamics::orbit::{
    BASE_STEPS, CycleSamples, CycleSearch, NamedStart, NoOrbit, NoSlidingVerdict, Orbit,
    OrbitVerdict, SettledMotion, TriedStart, base_response, limit_cycles, near, search_cycle,
    shortened, sliding_verdict, usual_starts,
};
use quell_dynamics::simulation::within;
use quell_linear::growth::Verdict;
use quell_model::System;
use quell_model::parameter::BELT_VELOCITY;

use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::effort::STEPS_OF_A_SEARCH;
use crate::run::protocol::Protocol;
use crate::run::system::start::{StateNumbers, start_with};
use crate::run::system::{failed, has_equations};
use crate::study::SystemStudy;

mod answer;

pub use answer::sentence;

/// Distance of the states of two orbits, relative to them, within which they are one: far above the error of an orbit, 10⁻¹², and far below
/// the distance of two.
const SAME_ORBIT: f64 = 1e-8;

/// The periodic motion to find.
#[derive(Clone, Debug, PartialEq)]
pub enum Wanted {
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
    After(Protocol),
}

impl Default for Wanted {
    fn default() -> Self {
        Self::Base { periods: 1 }
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
        instead: Option<NoOrbit>,
    },
    /// It is one of all limit cycles of a single mass.
    Map,
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
    pub orbit: Orbit,
    /// Common dither periods in its period; 1 without dither.
    pub multiple: u32,
    /// The least part of a number of periods that was asked for after which it repeats itself; `None` if it has none.
    pub repeats_after: Option<u32>,
    /// How it was found.
    pub by: FoundBy,
    /// Its samples over a period.
    pub samples: CycleSamples,
}

/// The answer of `orbit`.
#[derive(Clone, Debug)]
pub struct PeriodicResponse {
    /// The motion; `None` where no limit cycle was found.
    pub found: Option<FoundMotion>,
    /// Every limit cycle of an undithered system of one mass, stable or not, the largest first; `None` where they are not known.
    pub cycles: Option<Vec<FoundMotion>>,
    /// Starts from which no limit cycle was reached.
    pub tried: Vec<TriedStart>,
    /// Verdict on steady sliding of an undithered system, or why it is unknown.
    pub sliding: Option<Result<&'static str, NoSlidingVerdict>>,
}

/// The periodic motion of a study.
///
/// # Errors
/// Complaints about the request and the start; [`Failure::Failed`] if a motion under dither was not found.
pub fn run(study: &SystemStudy, wanted: &Wanted) -> Result<PeriodicResponse, Failure> {
    has_equations(study, "orbit")?;
    within(STEPS_OF_A_SEARCH, || periodic(study, wanted))
}

fn periodic(study: &SystemStudy, wanted: &Wanted) -> Result<PeriodicResponse, Failure> {
    if !study.system().is_dithered() {
        return undithered(study, wanted);
    }
    let system = study.system();
    let refused = |why: NoOrbit| failed("orbit", why);
    let (orbit, multiple, by) = match wanted {
        Wanted::Near { state, periods } => {
            let guess = start_with(study, state)?.state;
            let periods = (*periods).max(1);
            (near(system, &guess, periods).map_err(refused)?, periods, FoundBy::Shooting)
        }
        Wanted::After(protocol) => reached(study, protocol, None)?,
        Wanted::Base { periods } => match base_response(system, BASE_STEPS) {
            Ok(base) if *periods > 1 => {
                let found = near(system, &base.state, *periods).map_err(refused)?;
                (found, *periods, FoundBy::Continuation)
            }
            Ok(base) => (base, 1, FoundBy::Continuation),
            Err(why) if *periods > 1 => {
                let allowed = format!("1 without --near: there is no base response, {why}");
                return Err(Complaint::option("--periods", *periods, allowed).into());
            }
            Err(why) => reached(study, &Protocol::Study, Some(why))?,
        },
    };
    Ok(PeriodicResponse {
        found: Some(with_samples(study, orbit, multiple, by)),
        cycles: None,
        tried: Vec::new(),
        sliding: None,
    })
}

fn with_samples(study: &SystemStudy, orbit: Orbit, multiple: u32, by: FoundBy) -> FoundMotion {
    let samples = if orbit.is_free {
        CycleSamples::of(&study.system().undithered(), &study.observe(), &orbit)
    } else {
        CycleSamples::of(study.system(), &study.observe(), &orbit)
    };
    // What a run ends on has its least period already.
    let is_asked = matches!(by, FoundBy::Continuation | FoundBy::Shooting);
    let repeats_after = is_asked.then(|| repeats_after(study.system(), &orbit, multiple)).flatten();
    FoundMotion { orbit, multiple, repeats_after, by, samples }
}

/// The least part of a number of periods after which an orbit of so many repeats itself.
fn repeats_after(system: &System, orbit: &Orbit, multiple: u32) -> Option<u32> {
    let largest = orbit.state.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let is_same = |shorter: &Orbit| {
        let pairs = shorter.state.iter().zip(&orbit.state);
        pairs.fold(0.0, |m: f64, (a, b)| m.max((a - b).abs())) <= SAME_ORBIT * largest
    };
    shortened(system, orbit, multiple, is_same).map(|(part, _)| part)
}

/// The motion on which a run ends.
fn reached(
    study: &SystemStudy,
    protocol: &Protocol,
    instead: Option<NoOrbit>,
) -> Result<(Orbit, u32, FoundBy), Failure> {
    let system = study.system();
    let start = protocol.state(study, system)?;
    let words = protocol.words(study);
    match orbit_of_run(system, &start) {
        Ok(SettledMotion { orbit, multiple, periods }) => {
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
fn undithered(study: &SystemStudy, wanted: &Wanted) -> Result<PeriodicResponse, Failure> {
    let system = study.system();
    if let Wanted::Base { periods } | Wanted::Near { periods, .. } = wanted
        && *periods > 1
    {
        let allowed = "1: without dither there is no dither period to count";
        return Err(Complaint::option("--periods", *periods, allowed).into());
    }
    let free = system.undithered();
    if free.one_mass().is_some_and(|mass| mass.belt().belt_velocity() == 0.0) {
        let why = "above 0: without dither a mass on a surface at rest has equilibria throughout its stick band, so no response is periodic";
        let key = study.path_of(&system.contacts[0].name, BELT_VELOCITY);
        return Err(Complaint::new(Fault::Value, key, Origin::Whole, 0.0, why).into());
    }
    let given = |protocol: &Protocol| -> Result<NamedStart, Failure> {
        Ok((protocol.words(study), protocol.state(study, &free)?))
    };
    let cycles: Option<Vec<FoundMotion>> = limit_cycles(&free).map(|cycles| {
        cycles.into_iter().map(|cycle| with_samples(study, cycle, 1, FoundBy::Map)).collect()
    });
    let searched = |starts: Vec<NamedStart>| {
        let CycleSearch { found, tried } = search_cycle(&free, starts);
        let found =
            found.map(|(orbit, start)| with_samples(study, orbit, 1, FoundBy::FreeRun { start }));
        (found, tried)
    };
    let (found, tried) = match (wanted, &cycles) {
        (Wanted::Base { .. }, Some(cycles)) => (cycles.first().cloned(), Vec::new()),
        (Wanted::Near { state, .. }, Some(cycles)) => {
            let state = start_with(study, state)?.state;
            (nearest_cycle(&free, cycles, &state).cloned(), Vec::new())
        }
        (Wanted::After(Protocol::Squeal), Some(cycles)) => {
            // A complaint where nothing squeals.
            given(&Protocol::Squeal)?;
            let stable = |cycle: &&FoundMotion| cycle.orbit.verdict() == OrbitVerdict::Stable;
            (cycles.iter().find(stable).cloned(), Vec::new())
        }
        (Wanted::After(Protocol::Squeal), None) => searched(usual_starts(&free)),
        (Wanted::After(protocol), _) => searched(vec![given(protocol)?]),
        (Wanted::Near { state, .. }, None) => {
            searched(vec![given(&Protocol::From(state.clone()))?])
        }
        (Wanted::Base { .. }, None) => {
            let first = given(&Protocol::Study)?;
            let mut starts = usual_starts(&free);
            starts.retain(|other| other.1 != first.1);
            starts.insert(0, first);
            searched(starts)
        }
    };
    let sliding = sliding_verdict(&free).map(Verdict::name);
    Ok(PeriodicResponse { found, cycles, tried, sliding: Some(sliding) })
}

/// The cycle of a single mass that passes a state nearest, displacements in lengths of ω₀.
fn nearest_cycle<'c>(
    system: &System,
    cycles: &'c [FoundMotion],
    state: &[f64],
) -> Option<&'c FoundMotion> {
    let rate = system.one_mass().map_or(1.0, |mass| mass.rate());
    let off = |cycle: &FoundMotion| {
        let states = cycle.samples.states.chunks(state.len());
        let off = states.map(|at| libm::hypot(rate * (at[0] - state[0]), at[1] - state[1]));
        off.fold(f64::INFINITY, f64::min)
    };
    cycles.iter().min_by(|a, b| off(a).total_cmp(&off(b)))
}
