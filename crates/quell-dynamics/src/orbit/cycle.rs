//! The limit cycles of an undithered belt, stable or not, with their periods, and the limit sets of undithered runs, which
//! the cycles decide.
//!
//! The period is unknown. The phase is fixed by the section x′ = 0 at the lowest displacement, so that a cycle is a fixed point
//! of a scalar map of the displacement there, the cycle map. Trajectories in the plane do not cross, so every cycle is inside
//! the revolution that follows a release, because a release has a unique state, x = μ_sF − 2ζv₀, x′ = v₀. The map is
//! searched on that whole interval: every change of sign is bracketed and refined, every dip towards zero is searched for a pair
//! of cycles, and below the smallest size of the grid the sign at size zero, that of −(2ζ + μ′(v₀)F), decides whether one more
//! cycle exists.
//!
//! One multiplier of a cycle is 1, along it; the other is the derivative of the map, 0 where the cycle sticks.
//! Limits: two pairs of cycles between neighbouring sizes of the grid are missed. Cycles that cross v_r = 0 without sticking
//! are outside the interval and are not searched for.

use std::f64::consts::TAU;
use std::fmt;

use quell_model::Belt;
use quell_numerics::roots::{Closeness, try_find_root, try_minimise};

use super::periodic::{Orbit, orbit_at};
use super::verdict::OrbitVerdict;
use crate::motion::Motion;
use crate::simulation::{
    Event, EventKind, EventRecorder, Stalled, Start, VelocitySection, simulate,
};

/// Bound on the last terms of a step, relative to the load: that of an orbit.
const TOLERANCE: f64 = 1e-14;

/// Largest error of a cycle's state, relative to F: with more its size is not determined, as in a continuum of free oscillations.
const DETERMINED: f64 = 1e-2;

/// Why the limit set of an undithered run is unknown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CycleMapError {
    /// The run converges neither to a known limit cycle nor to stable steady sliding.
    NoLimit,
    /// The engine stopped.
    Stalled(Stalled),
}

impl fmt::Display for CycleMapError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoLimit => f.write_str(
                "the run converges neither to a known limit cycle nor to stable steady sliding",
            ),
            Self::Stalled(stalled) => stalled.fmt(f),
        }
    }
}

impl std::error::Error for CycleMapError {}

/// Number of sizes at which the map is evaluated.
const SIZES: u32 = 60;

/// Most revolutions of a run that grows beyond every cycle, until it sticks and follows a release. A run that
/// grows for longer is rejected; more revolutions only take longer.
const MOST_REVOLUTIONS: u32 = 100;

/// Relative difference within which two sizes are equal: far above the engine's error of a revolution (10⁻¹²), so that a start on
/// an unstable cycle counts as on it, and below any intended distance from a cycle. If it were smaller, rounding would decide the
/// fate of such a start.
const SAME: f64 = 1e-9;

/// Least size on the grid, relative to the largest possible one.
const SMALLEST: f64 = 1e-3;

/// Least size of a cycle, relative to F: smaller ones count as steady sliding, because a state counts as the base response
/// within this distance everywhere. The map's relative rounding is 10⁻⁸ there, below the growth that the search compares.
const NEGLIGIBLE: f64 = 1e-6;

/// Relative growth over a revolution below which the size is a fixed point: a root is located to 10⁻¹⁴ of its size, so that
/// only a growth that jumps over zero leaves more than this.
const FIXED_POINT: f64 = 1e-6;

/// The next lowest point after a state, its time, and whether the mass stuck before it.
struct Revolution {
    displacement: f64,
    time: f64,
    sticks: bool,
}

/// The limit set of an undithered run.
#[derive(Clone, Debug, PartialEq)]
pub enum FreeEnd {
    /// Steady sliding.
    Sliding,
    /// Rest: the belt does not move.
    Rest,
    /// This limit cycle.
    Cycle(Orbit),
}

/// The state at which the contact of the undithered belt releases, independent of the history: x = μ_sF − 2ζv₀, x′ = v₀.
fn released(belt: &Belt) -> Start {
    let threshold = belt.friction().static_coefficient() * belt.normal_load();
    Start {
        time: 0.0,
        displacement: threshold - 2.0 * belt.damping_ratio() * belt.belt_velocity(),
        velocity: belt.belt_velocity(),
    }
}

/// The map from the size of one revolution of the slow phase to that of the next, for a belt without dither.
///
/// The size is the distance of the lowest displacement from steady sliding, a length.
struct CycleMap<'a> {
    belt: &'a Belt,
    sliding: f64,
}

impl CycleMap<'_> {
    fn lowest(&self, size: f64) -> Start {
        Start { time: 0.0, displacement: self.sliding - size, velocity: 0.0 }
    }

    fn size(&self, revolution: &Revolution) -> f64 {
        self.sliding - revolution.displacement
    }

    /// Relative growth of the size over one revolution.
    fn growth(&self, size: f64) -> Result<f64, CycleMapError> {
        let next = revolution(self.belt, self.lowest(size))?;
        Ok(next.map_or(-1.0, |next| self.size(&next) / size - 1.0))
    }

    /// The sign of the growth in the limit of size zero, from the linearised equation: −c with c = 2ζ + μ′(v₀)F, twice the
    /// growth rate.
    fn linear_growth(&self) -> f64 {
        -linear_damping(self.belt)
    }

    /// The size of the revolution that follows a release, the largest that a cycle can have; `None` if no revolution follows.
    fn largest(&self) -> Result<Option<f64>, CycleMapError> {
        let outermost = revolution(self.belt, released(self.belt))?;
        Ok(outermost.map(|outermost| self.size(&outermost)).filter(|size| *size > 0.0))
    }

    /// Whether the revolution from the lowest point after a release sticks: the release is then on a cycle.
    fn sticks(&self, largest: f64) -> Result<bool, CycleMapError> {
        Ok(revolution(self.belt, self.lowest(largest))?.is_some_and(|next| next.sticks))
    }

    /// Fixed points of the map below `largest`, the largest first.
    fn fixed_sizes(&self, largest: f64) -> Result<Vec<f64>, CycleMapError> {
        let size = |k: u32| {
            let share = f64::from(k) / f64::from(SIZES);
            largest * (SMALLEST + (1.0 - 1e-7 - SMALLEST) * share * (2.0 - share))
        };
        let grid = (0..=SIZES).rev().map(|k| Ok((size(k), self.growth(size(k))?)));
        let grid: Vec<(f64, f64)> = grid.collect::<Result<_, CycleMapError>>()?;
        let mut found = Vec::new();
        for (index, &(lower, below)) in grid.iter().enumerate().skip(1) {
            let (upper, above) = grid[index - 1];
            // Without any damping every size is a fixed point, and the signs are rounding.
            let is_significant = below.abs().max(above.abs()) > SAME;
            if is_significant && below * above < 0.0 {
                found.extend(self.root(lower, upper)?);
            } else if let Some(&next) = grid.get(index + 1).filter(|_| is_significant) {
                found.extend(self.pair([next, (lower, below), (upper, above)])?);
            }
        }
        if let Some(&(smallest, growth)) = grid.last() {
            found.extend(self.below(smallest, growth)?);
        }
        Ok(found)
    }

    /// The size between two at which the growth changes sign; `None` where it jumps over zero without a fixed point: larger
    /// revolutions stick and grow, smaller ones only slip and decay.
    fn root(&self, lower: f64, upper: f64) -> Result<Option<f64>, CycleMapError> {
        let closeness = Closeness { absolute: 0.0, relative: 1e-14 };
        // A change of sign of finite values brackets a root: the search itself cannot fail.
        let root = try_find_root(|size| self.growth(size), lower, upper, closeness)?;
        let fixed = root.ok().filter(|root| root.residual.abs() <= FIXED_POINT);
        Ok(fixed.map(|root| root.location))
    }

    /// Two sizes around a dip of the growth towards zero between three sizes of the grid, where it changes sign twice: near the
    /// fold of a stable and an unstable cycle both are between neighbours of the grid.
    fn pair(&self, [low, middle, high]: [(f64, f64); 3]) -> Result<Vec<f64>, CycleMapError> {
        let sign = middle.1.signum();
        let dips = sign * middle.1 <= sign * low.1 && sign * middle.1 <= sign * high.1;
        if !dips || low.1 * middle.1 <= 0.0 || middle.1 * high.1 <= 0.0 {
            return Ok(Vec::new());
        }
        let depth = |size: f64| Ok::<f64, CycleMapError>(sign * self.growth(size)?);
        let least = try_minimise(depth, low.0, high.0, Closeness::default())?;
        let Some(least) = least.ok().filter(|least| least.value < 0.0) else {
            return Ok(Vec::new());
        };
        let both = [self.root(least.location, high.0)?, self.root(low.0, least.location)?];
        Ok(both.into_iter().flatten().collect())
    }

    /// The cycle smaller than the grid: it exists if the growth at the smallest size and at size zero differ in sign.
    fn below(&self, smallest: f64, growth: f64) -> Result<Option<f64>, CycleMapError> {
        let least = NEGLIGIBLE * self.belt.normal_load();
        if growth * self.linear_growth() >= 0.0 || least >= smallest {
            return Ok(None);
        }
        if self.growth(least)? * growth >= 0.0 { Ok(None) } else { self.root(least, smallest) }
    }

    /// The cycle of a given size; `None` if the size is not determined.
    fn cycle(&self, size: f64) -> Result<Option<Orbit>, CycleMapError> {
        let start = self.lowest(size);
        let Some(next) = revolution(self.belt, start)? else { return Ok(None) };
        let system = self.belt.system();
        let Ok(motion) = Motion::new(&system) else { return Ok(None) };
        let state = [start.displacement, start.velocity];
        let cycle = orbit_at(&motion, &state, next.time, true).ok();
        Ok(cycle.filter(|cycle| cycle.state_error <= DETERMINED * self.belt.normal_load()))
    }
}

/// 2ζ + μ′(v₀)F of steady sliding without dither: small motions grow if it is negative.
fn linear_damping(belt: &Belt) -> f64 {
    let slope = belt.friction().slope(belt.belt_velocity());
    belt.damping_rate(slope, belt.normal_load())
}

/// Whether steady sliding without dither is stable. e^{−c/2}, c = 2ζ + μ′(v₀)F, is the modulus of both multipliers over unit
/// time of an underdamped belt, and is on the same side of 1 as the larger multiplier of an overdamped belt.
pub(crate) fn verdict_of_sliding(belt: &Belt) -> OrbitVerdict {
    OrbitVerdict::of(libm::exp(-0.5 * linear_damping(belt)), 0.0)
}

/// Every limit cycle of the belt without its dither, the largest first; empty if all motion settles to steady sliding.
///
/// Each starts at its lowest displacement, at τ = 0.
///
/// # Errors
/// [`CycleMapError::Stalled`].
pub fn cycles(belt: &Belt) -> Result<Vec<Orbit>, CycleMapError> {
    let belt = &belt.undithered();
    if belt.belt_velocity() == 0.0 {
        return Ok(Vec::new());
    }
    let map = CycleMap { belt, sliding: belt.steady_sliding() };
    let Some(largest) = map.largest()? else { return Ok(Vec::new()) };
    let mut sizes = Vec::new();
    if map.sticks(largest)? {
        sizes.push(largest);
    }
    sizes.extend(map.fixed_sizes(largest)?);
    let found = sizes.into_iter().filter_map(|size| map.cycle(size).transpose());
    found.collect()
}

/// The limit set of an undithered run from a state.
///
/// Trajectories do not cross: a run whose revolutions grow converges to the next larger cycle, one whose revolutions shrink to
/// the next smaller.
///
/// # Errors
/// [`CycleMapError::Stalled`]; [`CycleMapError::NoLimit`] if revolutions neither grow nor shrink, grow for long beyond every known cycle,
/// or shrink towards steady sliding that is not stable.
pub fn free_end(belt: &Belt, start: Start) -> Result<FreeEnd, CycleMapError> {
    if belt.belt_velocity() == 0.0 {
        return Ok(FreeEnd::Rest);
    }
    let reached = cycle_reached(belt, &cycles(belt)?, start)?.cloned();
    Ok(reached.map_or(FreeEnd::Sliding, FreeEnd::Cycle))
}

/// Whether an undithered run from a state keeps vibrating: whether [`free_end`] is a cycle. All cycles are computed only if
/// the first revolutions do not decide.
///
/// # Errors
/// As [`free_end`].
pub fn keeps_vibrating(belt: &Belt, start: Start) -> Result<bool, CycleMapError> {
    let belt = &belt.undithered();
    if belt.belt_velocity() == 0.0 {
        return Ok(false);
    }
    let map = CycleMap { belt, sliding: belt.steady_sliding() };
    let Some(first) = revolution(belt, start)? else { return Ok(false) };
    let Some(largest) = map.largest()? else { return Ok(false) };
    // A run that sticks is released, and then follows the revolution after a release.
    let size = if first.sticks { largest } else { map.size(&first) };
    if first.sticks && map.sticks(largest)? {
        return Ok(true);
    }
    let growth = if size > 0.0 { map.growth(size)? } else { -1.0 };
    if growth > SAME || map.linear_growth() > 0.0 && size > NEGLIGIBLE * belt.normal_load() {
        return Ok(true);
    }
    Ok(matches!(free_end(belt, start)?, FreeEnd::Cycle(_)))
}

/// The cycle, one of `cycles`, to which an undithered run from a state converges; `None` if it settles to steady sliding.
///
/// # Errors
/// As [`free_end`].
pub(crate) fn cycle_reached<'a>(
    belt: &Belt,
    cycles: &'a [Orbit],
    start: Start,
) -> Result<Option<&'a Orbit>, CycleMapError> {
    let belt = &belt.undithered();
    let sliding = belt.steady_sliding();
    let size_of = |cycle: &Orbit| sliding - cycle.state[0];
    let settled =
        || if linear_damping(belt) > 0.0 { Ok(None) } else { Err(CycleMapError::NoLimit) };
    let mut from = start;
    for _ in 0..MOST_REVOLUTIONS {
        let Some(first) = revolution(belt, from)? else { return Ok(None) };
        let size = sliding - first.displacement;
        let is_here = |cycle: &&Orbit| (size_of(cycle) - size).abs() <= SAME * size;
        if let Some(cycle) = cycles.iter().find(is_here) {
            return Ok(Some(cycle));
        }
        from = Start { time: 0.0, displacement: first.displacement, velocity: 0.0 };
        let Some(second) = revolution(belt, from)? else { return Ok(None) };
        let next = sliding - second.displacement;
        if (next - size).abs() <= SAME * size {
            return Err(CycleMapError::NoLimit);
        }
        if next < size {
            let smaller = cycles.iter().find(|cycle| size_of(cycle) < size);
            return smaller.map_or_else(settled, |cycle| Ok(Some(cycle)));
        }
        let larger = cycles.iter().rev().find(|cycle| size_of(cycle) > size);
        if larger.is_some() {
            return Ok(larger);
        }
    }
    Err(CycleMapError::NoLimit)
}

/// Time in slip within which a revolution reaches its lowest point, two periods of the undamped oscillator; a motion without
/// a lowest point is overdamped and approaches sliding.
const LONGEST_SLIP: f64 = 2.0 * TAU;

/// How much longer that is over 2ζ + μ′(v₀)F where this is negative: the motion leaves sliding at its inverse, slowly where friction is
/// strong, and goes on to a lowest point. Ten of these times are enough from a distance of 10⁻⁴.
const SLOWER: f64 = 10.0;

/// [`LONGEST_SLIP`] of a belt.
fn longest_slip(belt: &Belt) -> f64 {
    LONGEST_SLIP * (-SLOWER * linear_damping(belt)).max(1.0)
}

/// Integrates from a state to the next lowest point; `None` if it is not reached within [`longest_slip`].
///
/// A stick ends at the release, whose state is known: it is skipped, however slow the belt.
fn revolution(belt: &Belt, start: Start) -> Result<Option<Revolution>, CycleMapError> {
    let release = released(belt);
    let longest = longest_slip(belt);
    let mut from = Start { time: 0.0, ..start };
    let (mut elapsed, mut slipped, mut sticks) = (0.0, 0.0, false);
    while slipped < longest {
        let mut observer = (VelocitySection::upward(0.0), EventRecorder::default());
        let end = simulate(belt, from, 0.5 * TAU, TOLERANCE, &mut observer)
            .map_err(CycleMapError::Stalled)?;
        let lowest = observer.0.crossings.first();
        let until = lowest.map_or(f64::INFINITY, |lowest| lowest.time);
        let is_stick_before = |event: &Event| event.kind == EventKind::Stick && event.time < until;
        sticks |= observer.1.events.iter().any(is_stick_before);
        if let Some(lowest) = lowest {
            let (displacement, time) = (lowest.displacement, elapsed + lowest.time);
            return Ok(Some(Revolution { displacement, time, sticks }));
        }
        elapsed += end.time;
        slipped += end.time;
        from = Start { time: 0.0, ..end.restart() };
        if end.sticking {
            elapsed += (release.displacement - end.displacement).max(0.0) / belt.belt_velocity();
            from = release;
        }
    }
    Ok(None)
}
