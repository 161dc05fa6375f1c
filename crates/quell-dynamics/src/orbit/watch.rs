//! How long a run is watched for a limit cycle: as long as the slowest motion of the structure needs to settle.

use std::f64::consts::TAU;

use quell_linear::linearised::{FrictionSlopes, Linearised};
use quell_linear::spectrum::spectrum;
use quell_model::System;
use quell_numerics::polar::modulus;

use super::recurrence::NEAR;
use crate::motion::Motion;

/// Spans of a run, at whose ends its passages are compared, in the time that suffices for the slowest motion. Fewer find a cycle later;
/// more only cost attempts.
const SPANS: f64 = 60.0;

/// Time over the reciprocal of the fastest rate, at least: a motion whose period friction and drive alone decide, such as slow
/// stick–slip, takes many times the structure's own.
const FASTEST_TIMES: f64 = 12_000.0;

/// Periods of the slowest oscillation, at least: growth of a tenth per period from rounding to a cycle takes a few hundred, but
/// starts are kicks of the size of the cycle.
const PERIODS: f64 = 100.0;

/// Decays over more than this number of the slowest periods are not waited for: such a motion is undamped in practice, and its
/// cycle attracts by friction or not at all.
const MOST_DECAY_PERIODS: f64 = 1000.0;

/// Passages through the section that are wanted of a motion that passes it, however slowly. With fewer a cycle that attracts slowly is
/// reported as not found; more only take longer.
pub(super) const PASSAGES: usize = 100;

/// Time over that which suffices for the structure after which no more passages are waited for.
const MOST_TIMES: f64 = 50.0;

/// Steps of a run: some seconds of computation with a hundred states. A run that needs more is reported as not found, with its steps.
pub(super) const MOST_STEPS: u64 = 4_000_000;

/// The lengths of a watched run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WatchLengths {
    /// Time between comparisons of the passages.
    pub(super) span: f64,
    /// Time after which the slowest motion of the structure has settled.
    pub(super) enough: f64,
    /// Time after which a run is given up although it has passed its section seldom.
    pub(super) most: f64,
}

impl WatchLengths {
    /// For a system. Transients of the structure decay to the square of the mismatch at which Newton's method is tried, and the
    /// slowest oscillation repeats [`PERIODS`] times.
    pub(super) fn of(motion: &Motion<'_>) -> Self {
        let (period, decay) = slowest(motion.system());
        let decays = -2.0 * libm::log(NEAR) * decay;
        let fastest = FASTEST_TIMES * motion.time_scale();
        let enough = fastest.max(PERIODS * period).max(decays);
        Self { span: enough / SPANS, enough, most: MOST_TIMES * enough }
    }
}

/// Period of the slowest oscillation of the structure, contacts closed and without friction, and the longest time in which a motion
/// of it decays by e; 0 where nothing oscillates or decays.
fn slowest(system: &System) -> (f64, f64) {
    let Ok(linear) = Linearised::frictionless(system) else { return (0.0, 0.0) };
    let none = FrictionSlopes { force: 0.0, by_velocity: 0.0, by_load: 0.0, bristles: None };
    let Ok(found) = spectrum(&linear, &vec![none; system.contacts.len()]) else {
        return (0.0, 0.0);
    };
    let oscillating = found.motions.iter().filter(|motion| motion.eigenvalue.im > motion.error);
    let period = oscillating.map(|motion| TAU / modulus(motion.eigenvalue)).fold(0.0, f64::max);
    let decaying = found.motions.iter().filter(|motion| motion.eigenvalue.re < -motion.error);
    let times = decaying.map(|motion| -1.0 / motion.eigenvalue.re);
    let longest = if period > 0.0 { MOST_DECAY_PERIODS * period } else { f64::INFINITY };
    (period, times.filter(|time| *time <= longest).fold(0.0, f64::max))
}
