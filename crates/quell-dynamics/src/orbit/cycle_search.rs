//! Limit cycles of systems without dither, and what was tried to find one.

use std::fmt;

use quell_model::System;

use super::verdict::OrbitVerdict;
use super::{NoOrbit, Orbit, base_response, free_cycle, limit_cycles, sliding_state};

/// Velocities of kicked starts, over that of the surface: at 1 the contact moves with it.
const KICKS: [f64; 3] = [1.0, 0.5, 2.0];

/// Share of a kick by which those of the contacts differ.
const UNEQUAL: f64 = 0.3;

/// Disturbances of an unstable cycle from which further runs start. They are pseudo-random, the same in every run of the program.
const DISTURBANCES: u64 = 3;

/// Largest disturbance of a number of the state, relative to the largest.
const DISTURBED: f64 = 1e-2;

/// Steps in which the base response is continued from steady sliding.
pub const BASE_STEPS: u32 = 8;

/// A start from which no limit cycle was reached.
#[derive(Clone, Debug, PartialEq)]
pub struct TriedStart {
    /// The start in words, such as "from rest".
    pub start: String,
    /// What became of the run.
    pub outcome: String,
}

/// A search for a limit cycle.
#[derive(Clone, Debug)]
pub struct CycleSearch {
    /// The cycle and the start of the run that reached it, in words.
    pub found: Option<(Orbit, String)>,
    /// The starts that reached none.
    pub tried: Vec<TriedStart>,
}

/// A start in words and its state.
pub type NamedStart = (String, Vec<f64>);

/// The limit cycle that a run from the first successful start reaches. A cycle that is not stable, on which only symmetric
/// runs end, is kept for the case that no other is found, neither from the other starts nor from small disturbances of it.
pub fn search_cycle(system: &System, starts: Vec<NamedStart>) -> CycleSearch {
    let mut search = CycleSearch { found: None, tried: Vec::new() };
    for start in starts {
        if search.is_stable_from(system, start) {
            return search;
        }
    }
    let unstable = search.found.as_ref().filter(|(c, _)| c.verdict() == OrbitVerdict::Unstable);
    let Some(state) = unstable.map(|(cycle, _)| cycle.state.clone()) else { return search };
    for number in 1..=DISTURBANCES {
        let start = format!("from the unstable cycle with disturbance {number}");
        if search.is_stable_from(system, (start, disturbed(&state, number))) {
            return search;
        }
    }
    search
}

impl CycleSearch {
    /// Whether the run from a start reaches a stable cycle, which is then the one found.
    fn is_stable_from(&mut self, system: &System, (start, state): NamedStart) -> bool {
        let outcome = match free_cycle(system, &state) {
            Ok(cycle) if cycle.verdict() == OrbitVerdict::Stable => {
                self.found = Some((cycle, start));
                return true;
            }
            Ok(cycle) if self.found.is_none() => {
                self.found = Some((cycle, start));
                return false;
            }
            Ok(cycle) => {
                format!("a cycle of period {:.6}, {}", cycle.period, cycle.verdict().name())
            }
            Err(why) => why.to_string(),
        };
        self.tried.push(TriedStart { start, outcome });
        false
    }
}

/// A state with pseudo-random disturbances of its numbers (xorshift64, Marsaglia 2003).
fn disturbed(state: &[f64], number: u64) -> Vec<f64> {
    let size = state.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    let mut bits = 0x9e37_79b9_7f4a_7c15_u64.wrapping_mul(2 * number + 1);
    let mut random = || {
        bits ^= bits << 13;
        bits ^= bits >> 7;
        bits ^= bits << 17;
        (bits >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    state.iter().map(|value| f64::mul_add(DISTURBED * size, random(), *value)).collect()
}

/// Steady sliding with velocities towards those of the surfaces; empty without steady sliding.
fn kicked(system: &System) -> Vec<NamedStart> {
    let kick = |factor: f64| {
        let start = format!("from steady sliding kicked by {factor} times the surface velocity");
        Some((start, kicked_by(system, factor)?))
    };
    KICKS.into_iter().filter_map(kick).collect()
}

/// Steady sliding with this share of the velocities of the surfaces; `None` without steady sliding.
pub fn kicked_by(system: &System, factor: f64) -> Option<Vec<f64>> {
    let mut state = sliding_state(system).ok()?;
    let size = system.structure.size();
    let offset = if system.structure.mechanical().is_some() { size } else { 0 };
    for (number, contact) in system.contacts.iter().enumerate() {
        let Some(row) = &contact.tangent else { continue };
        let length: f64 = row.iter().map(|weight| weight * weight).sum();
        // Equal contacts are not kicked equally: a run from a symmetric start remains symmetric.
        let share = 1.0 - UNEQUAL * number as f64 / system.contacts.len() as f64;
        let velocity = share * factor * contact.surface_velocity.mean();
        for (place, weight) in row.iter().enumerate() {
            state[offset + place] += velocity * weight / length;
        }
    }
    Some(state)
}

/// The starts of a search without a given start: kicked steady sliding, then rest.
pub fn usual_starts(system: &System) -> Vec<NamedStart> {
    let rest = vec![0.0; system.state_size()];
    kicked(system).into_iter().chain([("from rest".to_owned(), rest)]).collect()
}

/// Why a system without dither has no state from which it squeals.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NoSqueal {
    /// None of its limit cycles, which are all known, is stable.
    NoStableCycle,
    /// The only periodic motion that was found is not stable.
    NotStable(OrbitVerdict),
    /// No limit cycle was found from these starts, in words.
    NotFound(Vec<String>),
}

impl fmt::Display for NoSqueal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("another state: ")?;
        match self {
            Self::NoStableCycle => f.write_str("without dither there is no stable limit cycle"),
            Self::NotStable(verdict) => write!(
                f,
                "the only periodic motion without dither that was found is {}",
                verdict.name()
            ),
            Self::NotFound(starts) => f.write_str(&without_cycle_from(starts)),
        }
    }
}

impl std::error::Error for NoSqueal {}

/// A state of the stable limit cycle without dither.
///
/// # Errors
/// [`NoSqueal`].
pub fn squealing_state(system: &System) -> Result<Vec<f64>, NoSqueal> {
    let system = system.undithered();
    if let Some(cycles) = limit_cycles(&system) {
        let stable = cycles.into_iter().find(|cycle| cycle.verdict() == OrbitVerdict::Stable);
        return stable.map(|cycle| cycle.state).ok_or(NoSqueal::NoStableCycle);
    }
    let search = search_cycle(&system, usual_starts(&system));
    match search.found {
        Some((cycle, _)) if cycle.verdict() == OrbitVerdict::Stable => Ok(cycle.state),
        Some((cycle, _)) => Err(NoSqueal::NotStable(cycle.verdict())),
        None => {
            Err(NoSqueal::NotFound(search.tried.into_iter().map(|tried| tried.start).collect()))
        }
    }
}

/// The state of the base response at t = 0.
///
/// # Errors
/// [`NoOrbit`].
pub fn base_state(system: &System) -> Result<Vec<f64>, NoOrbit> {
    base_response(system, BASE_STEPS).map(|orbit| orbit.state)
}

/// What was tried, in one sentence without its full stop.
pub fn without_cycle(tried: &[TriedStart]) -> String {
    let starts: Vec<&str> = tried.iter().map(|tried| tried.start.as_str()).collect();
    without_cycle_from(&starts)
}

/// The same, of starts in words.
fn without_cycle_from<S: AsRef<str>>(starts: &[S]) -> String {
    let starts: Vec<&str> = starts.iter().map(AsRef::as_ref).collect();
    match starts.split_last() {
        None => "no limit cycle was found".to_owned(),
        Some((last, [])) => format!("no limit cycle was found by a run {last}"),
        Some((last, before)) => {
            format!("no limit cycle was found by runs {} and {last}", before.join(", "))
        }
    }
}
