//! The motion on which a run of any system ends: the one judge of it for every verb.

use std::fmt;

use quell_linear::pure_slip::period;
use quell_model::digits::digits;
use quell_model::{OneMass, System};
use quell_numerics::interval::RealInterval;

use super::measure::{Attractor, AttractorKind, measure};
use super::settings::AttractorSettings;
use super::settle::{Patience, Settled, settle_many};
use super::system_attractor::{MotionKind, SAME, SystemAttractor};
use super::unsettled::Unsettled;
use crate::motion::{Immobile, MOTION_TOLERANCE, Motion, MotionStart, MotionStopped};
use crate::orbit::{
    BASE_STEPS, CycleSamples, NoCycle, NoOrbit, Orbit, OrbitVerdict, SettledMotion, base_response,
    displaced, free_cycle, near, orbit_at, settled, settled_many, sliding_state,
};
use crate::simulation::{Stalled, Start};

/// Digits of a time in a message.
const DIGITS: usize = 6;

/// Periods of the dither over which a motion that is not periodic is measured.
const MEASURED: f64 = 20.0;

/// The end of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct EndOfRun {
    /// The motion.
    pub attractor: SystemAttractor,
    /// Periods of the dither until the run was near it; 0 without dither.
    pub periods: u32,
}

/// Why the motion on which a run ends is not known.
#[derive(Clone, Debug, PartialEq)]
pub enum NoEnd {
    /// A run stopped.
    Stopped {
        /// When, in the time of the system.
        time: f64,
        /// The reason.
        why: &'static str,
    },
    /// The motion cannot be computed.
    Immobile(Immobile),
    /// Another run stopped.
    Interrupted(Box<MotionStopped>),
    /// The dithers have no common period.
    NoPeriod,
    /// A run of one mass had not settled.
    Unsettled(Unsettled),
    /// No periodic motion under dither was found, or of one mass no base response to compare with.
    NoOrbit(NoOrbit),
    /// No limit cycle was found.
    NoCycle(NoCycle),
    /// Without dither the run is near an unstable limit cycle of this period, which it leaves at the slightest disturbance.
    UnstableCycle(f64),
}

impl NoEnd {
    /// A run of one mass stopped.
    pub(super) fn of_mass(mass: &OneMass, why: &Stalled) -> Self {
        Self::Stopped { time: why.time / mass.rate(), why: why.why }
    }

    /// A run of one mass had not settled; where the base response, to which it may converge, was not found, for that reason.
    pub(super) fn unsettled(settings: &AttractorSettings, settled: &Settled) -> Self {
        match &settings.base {
            Err(why) if !why.is_absence() => Self::NoOrbit(why.clone()),
            _ => Self::Unsettled(settled.why().unwrap_or(Unsettled::Moving)),
        }
    }
}

impl fmt::Display for NoEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stopped { time, why } => {
                write!(f, "a run stopped at t = {}: {why}", digits(*time, DIGITS))
            }
            Self::Immobile(why) => why.fmt(f),
            Self::Interrupted(why) => why.fmt(f),
            Self::NoPeriod => f.write_str("the dithers have no common period"),
            Self::Unsettled(why) => f.write_str(why.about()),
            Self::NoOrbit(why) => why.fmt(f),
            Self::NoCycle(why) => why.fmt(f),
            Self::UnstableCycle(period) => write!(
                f,
                "it comes so near an unstable limit cycle of period {} that its end is not known",
                digits(*period, DIGITS)
            ),
        }
    }
}

impl std::error::Error for NoEnd {}

/// The motion on which a run from a state ends.
///
/// # Errors
/// Why it cannot be computed.
pub fn end_of_run(system: &System, row: &[f64], start: &[f64]) -> Result<EndOfRun, NoEnd> {
    if let Some(mass) = judged_mass(system) {
        let ends = ends_of_one_mass((system, &mass), row, &[start.to_vec()]);
        return ends.into_iter().next().unwrap_or(Err(NoEnd::NoPeriod));
    }
    if !system.is_dithered() {
        // A dither of amplitude 0 gives the motion no period.
        return on_free_motion(&system.undithered(), row, start);
    }
    under_dither(system, row, start, settled(system, start))
}

/// The periodic motion on which the run of a dithered system from a state at t = 0 ends, by the same judge as [`end_of_run`].
///
/// # Errors
/// [`NoEnd`], and [`NoOrbit::Unsettled`] in it of a motion that does not repeat itself.
pub fn orbit_of_run(system: &System, start: &[f64]) -> Result<SettledMotion, NoEnd> {
    if judged_mass(system).is_none() {
        return settled(system, start).map_err(NoEnd::NoOrbit);
    }
    let EndOfRun { attractor, periods } = end_of_run(system, &[1.0], start)?;
    let unsettled = |tried| {
        let last = attractor.states.clone();
        NoEnd::NoOrbit(NoOrbit::Unsettled { periods: tried, last, is_steady: true })
    };
    let (orbit, multiple) = match attractor.kind {
        MotionKind::Periodic { periods, .. } => (near(system, &attractor.state, periods), periods),
        MotionKind::Rest => {
            // Shooting is undefined at rest: every state at which the contact sticks is one.
            let motion = Motion::new(system).map_err(NoEnd::Immobile)?;
            let period = period(system).ok_or(NoEnd::NoPeriod)?;
            (orbit_at(&motion, &attractor.state, period, false), 1)
        }
        MotionKind::QuasiPeriodic { tried } | MotionKind::NotPeriodic { tried } => {
            return Err(unsettled(tried));
        }
        MotionKind::Cycle { .. } => return Err(NoEnd::NoOrbit(NoOrbit::NoDither)),
    };
    Ok(SettledMotion { orbit: orbit.map_err(NoEnd::NoOrbit)?, multiple, periods })
}

/// The one mass of a system whose runs are judged by its section, without dither by its cycle map. Of a mass on a surface at rest that no
/// dither moves every state in stick is an end of its own: its runs are followed.
pub(super) fn judged_mass(system: &System) -> Option<OneMass> {
    let judges = |mass: &OneMass| system.is_dithered() || mass.belt().belt_velocity() != 0.0;
    system.one_mass().filter(judges)
}

/// The starts of runs of one mass.
pub fn starts_of_mass(mass: &OneMass, states: &[Vec<f64>]) -> Vec<Start> {
    states.iter().map(|state| start_of_mass(mass, state)).collect()
}

/// The start of a run of one mass.
pub(super) fn start_of_mass(mass: &OneMass, state: &[f64]) -> Start {
    let (displacement, velocity) = mass.of_state(state);
    Start { time: 0.0, displacement, velocity }
}

/// [`end_of_run`] of several starts; those under dither go on side by side.
pub(super) fn ends_of_runs(
    system: &System,
    row: &[f64],
    starts: &[Vec<f64>],
) -> Vec<Result<EndOfRun, NoEnd>> {
    if let Some(mass) = judged_mass(system) {
        return ends_of_one_mass((system, &mass), row, starts);
    }
    if !system.is_dithered() {
        return starts.iter().map(|start| end_of_run(system, row, start)).collect();
    }
    let found = settled_many(system, starts).into_iter().zip(starts);
    found.map(|(found, start)| under_dither(system, row, start, found)).collect()
}

/// The motions on which runs of one mass end: under dither by its stroboscopic section, its closed orbits and the rotation of its curves,
/// without by its cycle map.
fn ends_of_one_mass(
    (system, mass): (&System, &OneMass),
    row: &[f64],
    starts: &[Vec<f64>],
) -> Vec<Result<EndOfRun, NoEnd>> {
    let settings = match AttractorSettings::new(mass.belt()) {
        Ok(settings) => settings,
        Err(why) => return vec![Err(NoEnd::NoOrbit(why)); starts.len()],
    };
    let settled = settle_many(&settings, &starts_of_mass(mass, starts), Patience::SWEEP);
    let end = |settled: Result<Settled, Stalled>| {
        let stopped = |why: Stalled| NoEnd::of_mass(mass, &why);
        let settled = settled.map_err(stopped)?;
        let found = measure(&settings, &settled).map_err(stopped)?;
        let periods = u32::try_from(settled.periods).unwrap_or(u32::MAX);
        let found = found.ok_or_else(|| NoEnd::unsettled(&settings, &settled))?;
        let attractor = measured_of_one_mass((system, mass), row, &found, periods)?;
        Ok(EndOfRun { attractor, periods })
    };
    settled.into_iter().map(end).collect()
}

/// An attractor of one mass, with dither or without, as that of its system; `tried`: the periods over which it was followed.
///
/// # Errors
/// [`NoEnd`].
pub(super) fn measured_of_one_mass(
    (system, mass): (&System, &OneMass),
    row: &[f64],
    found: &Attractor,
    tried: u32,
) -> Result<SystemAttractor, NoEnd> {
    if system.is_dithered() {
        return of_one_mass((system, mass), row, found, tried);
    }
    // Without dither its section has no period: steady sliding is known exactly, and a limit cycle is closed from a state of it.
    let free = system.undithered();
    let reached = || mass.state(found.state.displacement, found.state.velocity).to_vec();
    let sliding = found.base.then(|| sliding_state(&free).ok()).flatten();
    Ok(on_free_motion(&free, row, &sliding.unwrap_or_else(reached))?.attractor)
}

/// An attractor of one mass under dither as that of its system.
fn of_one_mass(
    (system, mass): (&System, &OneMass),
    row: &[f64],
    found: &Attractor,
    tried: u32,
) -> Result<SystemAttractor, NoEnd> {
    let dither = period(system).ok_or(NoEnd::NoPeriod)?;
    let state = |(displacement, velocity): (f64, f64)| mass.state(displacement, velocity).to_vec();
    let at = state((found.state.displacement, found.state.velocity));
    let (kind, length) = match found.kind {
        AttractorKind::Periodic { periods, radius } => {
            (MotionKind::Periodic { periods, radius }, f64::from(periods) * dither)
        }
        AttractorKind::QuasiPeriodic => (MotionKind::QuasiPeriodic { tried }, MEASURED * dither),
        AttractorKind::Rest => (MotionKind::Rest, dither),
        AttractorKind::Cycle | AttractorKind::Unclassified => {
            (MotionKind::NotPeriodic { tried }, MEASURED * dither)
        }
    };
    let samples = CycleSamples::over(system, row, &at, length);
    let states = found.section.iter().copied().map(state).collect();
    let seen = SystemAttractor::new(kind, row, states, &samples);
    let ends = [found.lowest, found.highest].map(|x| row[0] * mass.state(x, 0.0)[0]);
    let rate = |turns: f64| turns.abs() * std::f64::consts::TAU / dither;
    Ok(SystemAttractor {
        base: Some(found.base),
        quiet: found.quiet,
        rotation: found.rotation,
        slow: found.rotation.map(|rotation| rate(rotation.turns_per_period)),
        state: at,
        extremes: RealInterval::new(ends[0].min(ends[1]), ends[0].max(ends[1])),
        stick: vec![found.stick_fraction],
        ..seen
    })
}

/// The motion that the judge has found for a run under dither.
fn under_dither(
    system: &System,
    row: &[f64],
    start: &[f64],
    found: Result<SettledMotion, NoOrbit>,
) -> Result<EndOfRun, NoEnd> {
    match found {
        Ok(found) => {
            let quiet = found.is_quiet(system);
            let SettledMotion { orbit, multiple, periods } = found;
            let states = at_periods(system, &orbit, multiple)?;
            let samples = CycleSamples::over(system, row, &orbit.state, orbit.period);
            let kind = MotionKind::Periodic { periods: multiple, radius: orbit.radius() };
            let seen = SystemAttractor::new(kind, row, states, &samples);
            let base = (multiple == 1).then(|| is_base(system, &orbit.state)).flatten();
            Ok(EndOfRun { attractor: SystemAttractor { base, quiet, ..seen }, periods })
        }
        Err(NoOrbit::Unsettled { periods, mut last, is_steady: true }) => {
            let length = MEASURED * period(system).ok_or(NoEnd::NoPeriod)?;
            let state = last.last().cloned().unwrap_or_else(|| start.to_vec());
            last.reverse();
            let samples = CycleSamples::over(system, row, &state, length);
            let kind = MotionKind::NotPeriodic { tried: periods };
            Ok(EndOfRun { attractor: SystemAttractor::new(kind, row, last, &samples), periods })
        }
        Err(why) => Err(NoEnd::NoOrbit(why)),
    }
}

/// Whether a motion in step with the dither is the base response; `None` where that is not known.
fn is_base(system: &System, state: &[f64]) -> Option<bool> {
    let base = match base_response(system, BASE_STEPS) {
        Ok(base) => base,
        Err(why) => return why.is_absence().then_some(false),
    };
    let size = state.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let off = base.state.iter().zip(state).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
    Some(off <= SAME * size)
}

/// The motion without dither on which a run ends.
pub(super) enum FreeMotion {
    /// A limit cycle.
    Cycle(Orbit),
    /// Rest or steady sliding, with its state.
    Rest(Vec<f64>),
}

/// The motion without dither on which a run from a state ends.
pub(super) fn free_motion(system: &System, start: &[f64]) -> Result<FreeMotion, NoEnd> {
    match free_cycle(system, &displaced(system, start)) {
        Ok(cycle) if cycle.verdict() == OrbitVerdict::Unstable => {
            Err(NoEnd::UnstableCycle(cycle.period))
        }
        Ok(cycle) => Ok(FreeMotion::Cycle(cycle)),
        Err(NoCycle::Rest { state, .. }) => Ok(FreeMotion::Rest(state)),
        Err(why) => Err(NoEnd::NoCycle(why)),
    }
}

fn on_free_motion(system: &System, row: &[f64], start: &[f64]) -> Result<EndOfRun, NoEnd> {
    let (kind, state, length, passed) = match free_motion(system, start)? {
        FreeMotion::Cycle(cycle) => {
            let kind = MotionKind::Cycle { period: cycle.period, radius: cycle.radius() };
            let passed = cycle.events.into_iter().map(|event| event.state).collect();
            (kind, cycle.state, cycle.period, passed)
        }
        FreeMotion::Rest(state) => {
            // Long enough to show which contacts stick.
            let motion = Motion::new(system).map_err(NoEnd::Immobile)?;
            (MotionKind::Rest, state, motion.time_scale(), Vec::new())
        }
    };
    let samples = CycleSamples::over(system, row, &state, length);
    let mut attractor = SystemAttractor::new(kind, row, vec![state], &samples);
    // A run may enter a symmetric cycle half a period later: the states at its events make both one motion.
    attractor.states.extend(passed);
    Ok(EndOfRun { attractor, periods: 0 })
}

/// The states of an orbit at whole periods of the dither.
fn at_periods(system: &System, orbit: &Orbit, multiple: u32) -> Result<Vec<Vec<f64>>, NoEnd> {
    let motion = Motion::new(system).map_err(NoEnd::Immobile)?;
    let mut from = MotionStart { time: 0.0, state: orbit.state.clone() };
    let mut states = vec![orbit.state.clone()];
    for count in 1..multiple {
        let until = f64::from(count) * orbit.period / f64::from(multiple);
        let end = motion.run(&from, until, MOTION_TOLERANCE, &mut ());
        from = end.map_err(|why| NoEnd::Interrupted(Box::new(why)))?.restart();
        states.push(from.state.clone());
    }
    Ok(states)
}
