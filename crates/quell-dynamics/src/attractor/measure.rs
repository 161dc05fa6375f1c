//! What a settled run is on: a closed orbit of some periods, a closed curve, or neither.
//!
//! A state that returns after n periods, ever closer, is taken as the guess of an orbit of n periods; shooting closes it to 10⁻¹², and its
//! multipliers say whether it attracts. A section that is one state to rounding returns after any n; the shortest period that attracts
//! is the orbit's own, and a longer one that was found is reduced to it. Where nothing returns the motion fills a curve, if its rotation
//! number is the same in both halves of the record and the record is long enough for it to have passed every gap: a motion that creeps
//! along a nearly locked curve may be on its way to a locked orbit. Limit: an orbit of more than `MOST_PERIODS` periods is not distinguished from a curve.

use quell_model::Belt;
use quell_numerics::roots::{Closeness, find_root};

use super::average::Moments;
use super::quiet::STEPS;
use super::rotation::{Rotation, looks, looks_of_an_orbit};
use super::settle::{ONE_STATE, Outcome, Patience, Settled, block, settle};
use super::strobe::Scene;
use super::watch::Watch;
use crate::orbit::cycle::{FreeEnd, free_end};
use crate::orbit::{NoOrbit, Orbit, Verdict, from_sliding, near};
use crate::simulation::{DEFAULT_TOLERANCE, Observer, Segment, Stalled, Start, simulate};

/// Most periods of a closed orbit.
const MOST_PERIODS: usize = 200;

/// Fewest periods of the record in which returns are looked for, and blocks of settling in it.
const RECORD: usize = 1024;
const BLOCKS: usize = 5;

/// Distance of a return, relative to the size of the section, that is worth shooting.
const RETURNS: f64 = 1e-3;

/// Distance of the orbit from the guess, relative to the size of the section, at which it is the run's own.
const ITS_OWN: f64 = 2e-2;

/// Share to which a return must have shrunk over the record: on a curve it stays what it is.
const SHRINKS: f64 = 0.5;

/// Distance of a return, relative to the size, that is closed already.
const CLOSED: f64 = 1e-7;

/// Most numbers of periods that are shot for one section: beyond the first few returns a curve is filled.
const MOST_SHOTS: usize = 4;

/// Difference of the rotation number of the two halves of a record at which the motion is a curve's.
const STEADY: f64 = 1e-5;

/// Times that a record is continued.
const RECORDS: u32 = 8;

/// What an attractor is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// A closed orbit.
    Periodic {
        /// Its periods of the strobe.
        periods: u32,
        /// The larger modulus of its multipliers, once round.
        radius: f64,
    },
    /// A limit cycle of the belt without dither, which no strobe need return to.
    Cycle,
    /// A closed curve, filled.
    QuasiPeriodic,
    /// Rest: a belt that does not move holds the mass.
    Rest,
    /// Settled, but none of these.
    Unclassified,
}

impl Kind {
    /// In words.
    pub fn words(self) -> String {
        match self {
            Self::Periodic { periods, .. } => format!("period-{periods}"),
            Self::Cycle => "limit cycle".to_owned(),
            Self::QuasiPeriodic => "quasi-periodic".to_owned(),
            Self::Rest => "at rest".to_owned(),
            Self::Unclassified => "unclassified".to_owned(),
        }
    }
}

/// An attractor.
#[derive(Clone, Debug, PartialEq)]
pub struct Attractor {
    /// What it is.
    pub kind: Kind,
    /// Whether it is the response that sliding becomes.
    pub base: bool,
    /// Whether no slow motion of its own is left: it has the dither's own period, or so few that all its lines lie above the band
    /// of slow vibration; or without dither is steady sliding or rest.
    pub quiet: bool,
    /// A state on it at τ = 0.
    pub state: Start,
    /// States (x, x′), one a period: an orbit once round, a curve as far as the record goes.
    pub section: Vec<(f64, f64)>,
    /// Least x.
    pub lowest: f64,
    /// Largest x.
    pub highest: f64,
    /// Share of the time in stick.
    pub stick_fraction: f64,
    /// Turns of the slow motion a period; `None` for a response of one period, which does not turn.
    pub rotation: Option<Rotation>,
}

impl Attractor {
    /// Peak-to-peak of x.
    pub fn size(&self) -> f64 {
        self.highest - self.lowest
    }

    /// Frequency of the slow motion (ω₀), where it turns.
    pub fn frequency(&self, period: f64) -> Option<f64> {
        let rotation = self.rotation.as_ref()?;
        Some(rotation.turns_per_period.abs() * std::f64::consts::TAU / period)
    }
}

/// The attractor of a run that has settled; `None` for one that has not.
///
/// # Errors
/// [`Stalled`].
pub fn measure(scene: &Scene<'_>, settled: &Settled) -> Result<Option<Attractor>, Stalled> {
    match (settled.outcome, &scene.quiet) {
        (Outcome::Unsettled(_), _) => Ok(None),
        (Outcome::Quiet, Ok(quiet)) => {
            let state =
                Start { time: 0.0, displacement: quiet.displacement, velocity: quiet.velocity };
            let kind = Kind::Periodic { periods: 1, radius: quiet.radius };
            Ok(Some(Attractor { base: true, ..seen(scene, kind, state, 1)? }))
        }
        (Outcome::Quiet | Outcome::Elsewhere, _) => match settled.cycle {
            Some(period) => cycle(scene, settled.state, period).map(Some),
            None if settled.is_at_rest(scene) => {
                seen(scene, Kind::Rest, settled.state, 1).map(Some)
            }
            None => elsewhere(scene, settled.state).map(Some),
        },
    }
}

/// The limit cycle without dither through a state, of a known period: nothing has to be read from a section, whose moments have
/// no relation to it.
fn cycle(scene: &Scene<'_>, state: Start, period: f64) -> Result<Attractor, Stalled> {
    let attractor = seen(scene, Kind::Cycle, state, RECORD.max(BLOCKS * block(scene)))?;
    let rotation = Some(Rotation::of_cycle(scene.strobe.period / period));
    Ok(Attractor { rotation, ..attractor })
}

/// What the records of a settled run show.
enum Found {
    /// A closed orbit of so many periods.
    Orbit(u32, Orbit),
    /// None: the state before the last record, its length, and whether its rotation number is steady.
    Section { from: Start, periods: usize, steady: bool },
}

/// Records from a state on an attractor, until one shows an orbit or a steady rotation number.
fn records(scene: &Scene<'_>, state: Start) -> Result<Found, Stalled> {
    let mut from = state;
    let mut record = 1;
    loop {
        let (watch, end) = watched(scene, from)?;
        let section = watch.section();
        if let Some((periods, orbit)) = orbit(scene, &section, end, MOST_PERIODS) {
            return Ok(Found::Orbit(periods, orbit));
        }
        let looks = looks(scene.strobe.period);
        let rotation = Rotation::of_curve(&watch.states().collect::<Vec<_>>(), looks);
        let steady = rotation.error <= STEADY && rotation.fills(record as usize * section.len());
        if steady || record == RECORDS {
            return Ok(Found::Section { from, periods: section.len(), steady });
        }
        (from, record) = (end, record + 1);
    }
}

/// The attractor from a state on it.
fn elsewhere(scene: &Scene<'_>, state: Start) -> Result<Attractor, Stalled> {
    match records(scene, state)? {
        Found::Orbit(periods, orbit) => {
            let kind = Kind::Periodic { periods, radius: orbit.radius() };
            seen(scene, kind, orbit.start, periods as usize)
        }
        Found::Section { from, periods, steady } => {
            let kind = if steady { Kind::QuasiPeriodic } else { Kind::Unclassified };
            seen(scene, kind, from, periods)
        }
    }
}

/// A record, and the state after it.
fn watched<'a>(scene: &Scene<'a>, start: Start) -> Result<(Watch<'a>, Start), Stalled> {
    let period = scene.strobe.period;
    let periods = RECORD.max(BLOCKS * block(scene));
    let mut watch = Watch::looking(period, periods, looks(period));
    let until = periods as f64 * period;
    let end = simulate(scene.belt, start, until, DEFAULT_TOLERANCE, &mut watch)?;
    Ok((watch, Start { time: 0.0, ..end.restart() }))
}

/// Whether a run that has settled has no slow motion of its own left: it ends on the base response, at rest, or on a response of
/// the dither's own period or of so few that all its lines lie above the band.
///
/// # Errors
/// [`Stalled`].
pub(super) fn ends_quietly(scene: &Scene<'_>, settled: &Settled) -> Result<bool, Stalled> {
    match settled.outcome {
        Outcome::Quiet => Ok(true),
        Outcome::Unsettled(_) => Ok(false),
        Outcome::Elsewhere if scene.is_autonomous() => Ok(settled.is_at_rest(scene)),
        Outcome::Elsewhere => {
            let (watch, end) = watched(scene, settled.state)?;
            let most = scene.strobe.periods_above_the_band() as usize;
            Ok(orbit(scene, &watch.section(), end, most).is_some())
        }
    }
}

/// The closed orbit of at most so many periods to which the last states of a section return.
fn orbit(
    scene: &Scene<'_>,
    section: &[(f64, f64)],
    end: Start,
    most: usize,
) -> Option<(u32, Orbit)> {
    // A cycle without dither has its own period; at the strobe no state need return.
    if scene.is_autonomous() {
        return None;
    }
    // Below, the size of a section is rounding, and a distance relative to it says nothing.
    let least = ONE_STATE * scene.belt.normal_load();
    let size = Moments::of(section).size();
    // The largest return after n periods among the n states before a place.
    let returns = |n: usize, end: usize| {
        (end - n..end).map(|k| gap(section[k], section[k - n])).fold(0.0, f64::max)
    };
    let may_be_closed = |n: &usize| {
        let late = returns(*n, section.len());
        late <= (CLOSED * size).max(least)
            || (late <= RETURNS * size && late <= SHRINKS * returns(*n, 2 * n))
    };
    let own = (ITS_OWN * size).max(least);
    (1..=most).filter(may_be_closed).take(MOST_SHOTS).find_map(|n| {
        let periods = u32::try_from(n).ok()?;
        let orbit = near(scene.belt, end, periods).ok()?;
        let attracts =
            orbit.verdict() != Verdict::Unstable && gap(state(orbit.start), state(end)) <= own;
        attracts.then(|| shortest(scene, periods, orbit))
    })
}

/// The orbit with its own period, where it is a part of the one that was found.
fn shortest(scene: &Scene<'_>, periods: u32, orbit: Orbit) -> (u32, Orbit) {
    let same = |part: &Orbit| {
        gap(state(part.start), state(orbit.start)) <= ONE_STATE * scene.belt.normal_load()
    };
    let part = (1..periods)
        .filter(|part| periods.is_multiple_of(*part))
        .find_map(|part| Some((part, near(scene.belt, orbit.start, part).ok().filter(same)?)));
    part.unwrap_or((periods, orbit))
}

fn state(start: Start) -> (f64, f64) {
    (start.displacement, start.velocity)
}

/// Distance of two states.
fn gap(a: (f64, f64), b: (f64, f64)) -> f64 {
    libm::hypot(a.0 - b.0, a.1 - b.1)
}

/// The periodic orbit on which a run from a state at τ = 0 ends; a limit cycle of its own period where no dither acts.
///
/// # Errors
/// [`NoOrbit`]; [`NoOrbit::NoPeriod`] where the run does not end on a closed orbit of up to 200 common periods.
pub fn orbit_reached(belt: &Belt, start: Start) -> Result<Orbit, NoOrbit> {
    let scene = Scene::new(belt)?;
    if scene.is_autonomous()
        && let FreeEnd::Cycle(cycle) = free_end(belt, start)?
    {
        return Ok(cycle);
    }
    let settled = settle(&scene, start, Patience::SWEEP).map_err(NoOrbit::Stalled)?;
    match settled.outcome {
        Outcome::Unsettled(why) => Err(NoOrbit::Unsettled(why)),
        Outcome::Quiet => from_sliding(belt, STEPS),
        Outcome::Elsewhere if settled.is_at_rest(&scene) => Err(NoOrbit::AtRest),
        Outcome::Elsewhere => match records(&scene, settled.state).map_err(NoOrbit::Stalled)? {
            Found::Orbit(_, orbit) => Ok(orbit),
            Found::Section { .. } => {
                Err(NoOrbit::NoPeriod { most: u32::try_from(MOST_PERIODS).unwrap_or(u32::MAX) })
            }
        },
    }
}

/// An attractor as a run over it sees it.
fn seen(scene: &Scene<'_>, kind: Kind, state: Start, periods: usize) -> Result<Attractor, Stalled> {
    let period = scene.strobe.period;
    let length = periods as f64 * period;
    let is_orbit = matches!(kind, Kind::Periodic { .. });
    let looks = if is_orbit { looks_of_an_orbit(period) } else { looks(period) };
    let mut watch = (
        Watch::looking(period, periods, looks),
        Extremes { lowest: f64::INFINITY, highest: f64::NEG_INFINITY },
    );
    simulate(scene.belt, state, length, DEFAULT_TOLERANCE, &mut watch)?;
    let (watch, extremes) = watch;
    let stick_fraction = watch.stuck / length;
    // Held by a belt that does not move: nothing of the dither is seen in the motion.
    let rests = scene.belt.belt_velocity() == 0.0 && extremes.highest == extremes.lowest;
    let kind = if rests { Kind::Rest } else { kind };
    let section = watch.section();
    let states = || watch.states().collect::<Vec<_>>();
    let rotation = match kind {
        Kind::Periodic { periods: 1, .. } | Kind::Rest => None,
        Kind::Periodic { .. } => Some(Rotation::of_orbit(&states(), looks)),
        Kind::Cycle | Kind::QuasiPeriodic | Kind::Unclassified => {
            Some(Rotation::of_curve(&states(), looks))
        }
    };
    Ok(Attractor {
        kind,
        base: false,
        quiet: match kind {
            Kind::Periodic { periods, .. } => periods <= scene.strobe.periods_above_the_band(),
            Kind::Rest => true,
            Kind::Cycle | Kind::QuasiPeriodic | Kind::Unclassified => false,
        },
        state,
        section,
        lowest: extremes.lowest,
        highest: extremes.highest,
        stick_fraction,
        rotation,
    })
}

/// Least and largest x of a run, between the ends of steps too: where x′ changes sign inside one.
struct Extremes {
    lowest: f64,
    highest: f64,
}

/// Closeness of the moment at which x turns: x errs by its square.
const TURNS: Closeness = Closeness { absolute: 0.0, relative: 1e-9 };

impl Observer for Extremes {
    fn segment(&mut self, segment: &Segment<'_>) {
        let h = segment.duration();
        let mut take = |x: f64| {
            self.lowest = self.lowest.min(x);
            self.highest = self.highest.max(x);
        };
        take(segment.displacement(0.0));
        take(segment.displacement(h));
        if segment.velocity(0.0) * segment.velocity(h) < 0.0
            && let Ok(root) = find_root(|since| segment.velocity(since), 0.0, h, TURNS)
        {
            take(segment.displacement(root.location));
        }
    }
}
