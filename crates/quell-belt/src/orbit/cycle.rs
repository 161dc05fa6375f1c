//! The limit cycles of an undithered belt, stable or not, with their periods.
//!
//! The period is unknown; the phase is fixed by the section x′ = 0 at the lowest displacement, so that a cycle is a fixed point of
//! a map of one number, the displacement there. Trajectories of the plane do not cross: every cycle lies inside
//! the turn that follows a release, for a release has one state, x = μ_sF − 2ζv₀, x′ = v₀. The map is
//! searched on all of that interval, and each change of sign is closed in on.
//!
//! One multiplier of a cycle is 1, along it; the other is the derivative of the map, 0 where the cycle sticks.
//! Limits: two cycles between neighbouring places of the search are missed; cycles that pass v_r = 0 without sticking
//! lie outside the turn after a release and are not looked for.

use std::f64::consts::TAU;

use quell_model::Belt;
use quell_numerics::roots::{Closeness, try_find_root};

use super::{NoOrbit, Orbit, TOLERANCE, orbit_at};
use crate::simulation::{EventKind, EventRecorder, Start, VelocitySection, simulate};
use crate::start::released;

/// Places at which the map is tried.
const PLACES: u32 = 60;

/// Most turns of a run that grows beyond every cycle, until it sticks and is one of the turns after a release. A run that
/// grows for longer is refused; more turns only take longer.
const MOST_TURNS: u32 = 100;

/// Sizes this close, relatively, are the same: far above the engine's error of a turn (10⁻¹²), so that a start on an unstable cycle
/// is on it, and below any distance from a cycle that is meant. Narrower, rounding would say which way such a start goes.
const SAME: f64 = 1e-9;

/// Least size of a cycle that is looked for, relative to the largest possible one.
const SMALLEST: f64 = 1e-3;

/// The next lowest point after a state, its time, and whether the mass stuck on the way.
struct Turn {
    displacement: f64,
    time: f64,
    sticks: bool,
}

/// Every limit cycle of the belt without its dither, the largest first; none where all motion settles to steady sliding.
///
/// Each starts at its lowest displacement, at τ = 0.
///
/// # Errors
/// [`NoOrbit::Stalled`].
pub fn cycles(belt: &Belt) -> Result<Vec<Orbit>, NoOrbit> {
    let belt = &belt.undithered();
    if belt.belt_velocity() == 0.0 {
        return Ok(Vec::new());
    }
    let sliding = belt.steady_sliding();
    let Some(outermost) = turn(belt, released(belt))? else { return Ok(Vec::new()) };
    let largest = sliding - outermost.displacement;
    if largest <= 0.0 {
        return Ok(Vec::new());
    }
    let lowest = |size: f64| Start { time: 0.0, displacement: sliding - size, velocity: 0.0 };
    let mut found = Vec::new();
    let again = turn(belt, lowest(largest))?;
    if let Some(turn) = again.filter(|turn| turn.sticks) {
        let start = lowest(largest);
        found.push(orbit_at(belt, &[start.displacement, start.velocity], turn.time)?.free());
    }
    // Relative growth of the size over a turn.
    let growth = |size: f64| -> Result<f64, NoOrbit> {
        let turn = turn(belt, lowest(size))?;
        Ok(turn.map_or(-1.0, |turn| (sliding - turn.displacement) / size - 1.0))
    };
    let size = |k: u32| {
        let share = f64::from(k) / f64::from(PLACES);
        largest * (SMALLEST + (1.0 - 1e-7 - SMALLEST) * share * (2.0 - share))
    };
    let (mut upper, mut above) = (size(PLACES), growth(size(PLACES))?);
    for k in (0..PLACES).rev() {
        let (lower, below) = (size(k), growth(size(k))?);
        if below * above < 0.0 {
            let closeness = Closeness { absolute: 0.0, relative: 1e-14 };
            // A change of sign of finite values has a place: the search itself has nothing to complain about.
            if let Ok(root) = try_find_root(growth, lower, upper, closeness)?
                && let Some(turn) = turn(belt, lowest(root.location))?
            {
                let start = lowest(root.location);
                found.push(orbit_at(belt, &[start.displacement, 0.0], turn.time)?.free());
            }
        }
        (upper, above) = (lower, below);
    }
    Ok(found)
}

/// The cycle, one of `cycles`, on which an undithered run from a state ends; `None` where it settles to steady sliding.
///
/// Turns do not cross: a run whose turns grow comes to the next larger cycle, one whose turns shrink to the next smaller.
///
/// # Errors
/// [`NoOrbit::Stalled`]; [`NoOrbit::NoLimit`] where turns neither grow nor shrink, grow for long beyond every cycle that is
/// known, or shrink towards steady sliding that is not stable.
pub fn cycle_reached<'a>(
    belt: &Belt,
    cycles: &'a [Orbit],
    start: Start,
) -> Result<Option<&'a Orbit>, NoOrbit> {
    let belt = &belt.undithered();
    let sliding = belt.steady_sliding();
    let size_of = |cycle: &Orbit| sliding - cycle.start.displacement;
    let mut from = start;
    for _ in 0..MOST_TURNS {
        let Some(first) = turn(belt, from)? else { return Ok(None) };
        let size = sliding - first.displacement;
        if let Some(cycle) = cycles.iter().find(|it| (size_of(it) - size).abs() <= SAME * size) {
            return Ok(Some(cycle));
        }
        from = Start { time: 0.0, displacement: first.displacement, velocity: 0.0 };
        let Some(second) = turn(belt, from)? else { return Ok(None) };
        let next = sliding - second.displacement;
        if (next - size).abs() <= SAME * size {
            return Err(NoOrbit::NoLimit);
        }
        if next < size {
            let smaller = cycles.iter().find(|cycle| size_of(cycle) < size);
            return if smaller.is_none() && !settles(belt) {
                Err(NoOrbit::NoLimit)
            } else {
                Ok(smaller)
            };
        }
        let larger = cycles.iter().rev().find(|cycle| size_of(cycle) > size);
        if larger.is_some() {
            return Ok(larger);
        }
    }
    Err(NoOrbit::NoLimit)
}

/// Whether small motions about steady sliding die out: 2ζ + μ′(v₀)F > 0.
fn settles(belt: &Belt) -> bool {
    let slope = belt.friction().slope(belt.belt_velocity());
    belt.damping_rate(slope, belt.normal_load()) > 0.0
}

/// From a state to the next lowest point; `None` where none comes within the longest possible turn.
fn turn(belt: &Belt, start: Start) -> Result<Option<Turn>, NoOrbit> {
    // A stick carries the mass from its lowest to its highest place at most.
    let reach = 2.0
        * (belt.friction().static_coefficient() * belt.normal_load() + start.displacement.abs());
    let longest = 2.0 * TAU + reach / belt.belt_velocity();
    let mut watch = (VelocitySection::upward(0.0), EventRecorder::default());
    let mut from = start;
    while from.time < start.time + longest {
        let end = simulate(belt, from, from.time + 0.5 * TAU, TOLERANCE, &mut watch)
            .map_err(NoOrbit::Stalled)?;
        if let Some(lowest) = watch.0.crossings.first() {
            let is_before = |time: f64| time < lowest.time;
            let sticks = watch
                .1
                .events
                .iter()
                .any(|event| event.kind == EventKind::Stick && is_before(event.time));
            let (displacement, time) = (lowest.displacement, lowest.time);
            return Ok(Some(Turn { displacement, time, sticks }));
        }
        from = end.restart();
    }
    Ok(None)
}
