//! Classification of a settled run: a closed orbit of some periods, a closed curve, or neither.
//!
//! A state that returns after n periods, ever closer, is used as the initial guess of an orbit of n periods. Shooting closes it
//! to 10⁻¹², and its multipliers decide whether it attracts. A section that is one state to rounding returns after any n; the
//! shortest attracting period is the orbit's own, and a longer one that was found is reduced to it. Without returns the motion
//! fills a curve if its rotation number is the same in both halves of the record and the record is long enough for the motion
//! to have crossed every gap: a motion that creeps along a nearly locked curve may still converge to a locked orbit. Limit: an
//! orbit of more than `MOST_PERIODS` periods is not distinguished from a curve.

use quell_numerics::roots::{Closeness, find_root};

use super::average::Moments;
use super::block_observer::BlockObserver;
use super::rotation::{Rotation, samples_per_orbit_period, samples_per_period};
use super::settings::AttractorSettings;
use super::settle::{ONE_STATE, SettleOutcome, Settled, block};
use super::unsettled::Unsettled;
use crate::orbit::{Orbit, OrbitVerdict, near, shortened};
use crate::simulation::{DEFAULT_TOLERANCE, Observer, Segment, Stalled, Start, simulate};

/// Most periods of a closed orbit: the record holds five returns of an orbit of this length. A longer orbit is classified as a
/// curve, or not at all.
const MOST_PERIODS: usize = 200;

/// Fewest periods of the record in which returns are searched: five returns of the longest orbit, so that a trend of its returns
/// is visible. In a shorter record a slowly attracting orbit looks like a curve; a longer one only takes longer.
const RECORD: usize = 1024;

/// Fewest blocks of settling in a record: 100 slow revolutions, also where the section is slow. Fewer revolutions would not show
/// a steady rotation number.
const BLOCKS: usize = 5;

/// Distance of a return, relative to the size of the section, below which shooting is tried: Newton's method converges from
/// there. With a larger value shooting is wasted on curves; with a smaller one a slowly attracting orbit is found only in a later
/// record, or not at all.
const RETURNS: f64 = 1e-3;

/// Distance of the orbit from the guess, relative to the size of the section, within which the run ends on this orbit: that within
/// which two sections of a basin count as one attractor. With a larger value a neighbouring orbit would be accepted; with a
/// smaller one the orbit of a run that is still converging would be rejected.
const ITS_OWN: f64 = 2e-2;

/// Factor by which the distance of a return must have shrunk over the record; on a curve it stays the same. An orbit that attracts
/// more slowly is examined again in the next record. With a value nearer to 1, shooting would start from fluctuating returns on a
/// curve.
const SHRINKS: f64 = 0.5;

/// Distance of a return, relative to the size, that counts as closed: above the engine's error over a long orbit, which leaves no
/// trend to be measured. With a larger value a slow drift along a nearly locked curve would count as closed.
const CLOSED: f64 = 1e-7;

/// Most numbers of periods for which shooting is tried in one section: a section with more returns than this usually fills a
/// curve. An orbit that follows more than three unsuccessful attempts is missed in this record.
const MOST_SHOTS: usize = 4;

/// Difference of the rotation numbers of the two halves of a record below which the motion is on a curve: a hundredth of a
/// revolution over a record of 1024 periods. With a larger value a run that is still locking would count as a curve; with a
/// smaller one a curve with sticks, whose averages converge slowly, would remain unclassified.
const STEADY: f64 = 1e-5;

/// Range of the displacement, relative to F, up to which a mass on a belt at rest is at rest: a dither at the level of static friction moves it
/// by rounding, 10⁻⁶¹ where it was met. With a larger value a dither slightly above that level would be said to move nothing, with a much
/// smaller one rounding would be a motion.
const STILL: f64 = 1e-9;

/// Most records of one run: 32 768 periods or more. A motion that needs longer to close or to fill its curve is unclassified: with 8 records
/// starts that lock after 20 000 periods were.
const RECORDS: u32 = 32;

/// The kind of an attractor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AttractorKind {
    /// A closed orbit.
    Periodic {
        /// Its length in periods of the section.
        periods: u32,
        /// The larger modulus of its multipliers over the whole orbit.
        radius: f64,
    },
    /// A limit cycle of the belt without dither, whose period is unrelated to the section.
    Cycle,
    /// A closed curve, filled by the section.
    QuasiPeriodic,
    /// Rest: a belt that does not move holds the mass.
    Rest,
    /// Settled, but not classified.
    Unclassified,
}

impl AttractorKind {
    /// A description.
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
    /// Its kind.
    pub kind: AttractorKind,
    /// Whether it is the base response.
    pub base: bool,
    /// Whether it is quiescent, without slow motion of its own: it has the dither's own period, or so few periods that all its
    /// spectral lines are above the band of slow vibration; without dither it is steady sliding or rest.
    pub quiet: bool,
    /// A state on it at τ = 0.
    pub state: Start,
    /// States (x, x′), one per period: a complete orbit, or a curve for the length of the record.
    pub section: Vec<(f64, f64)>,
    /// Least x.
    pub lowest: f64,
    /// Largest x.
    pub highest: f64,
    /// Fraction of the time in stick.
    pub stick_fraction: f64,
    /// Revolutions of the slow motion per period; `None` for a response of one period, which has no slow motion.
    pub rotation: Option<Rotation>,
}

impl Attractor {
    /// Peak-to-peak of x.
    pub fn size(&self) -> f64 {
        self.highest - self.lowest
    }

    /// Frequency of the slow motion (ω₀), where there is one.
    pub fn frequency(&self, period: f64) -> Option<f64> {
        let rotation = self.rotation.as_ref()?;
        Some(rotation.turns_per_period.abs() * std::f64::consts::TAU / period)
    }
}

/// The motion on which a run ends, before it is observed.
pub(super) struct Classified {
    kind: AttractorKind,
    base: bool,
    /// A state on it at τ = 0.
    pub(super) state: Start,
    /// Periods over which it is observed.
    periods: usize,
}

impl Classified {
    /// Whether it is quiescent, as [`Attractor::quiet`].
    pub(super) fn is_quiet(&self, settings: &AttractorSettings) -> bool {
        match self.kind {
            AttractorKind::Periodic { periods, .. } => settings.is_quiet(periods),
            AttractorKind::Rest => true,
            AttractorKind::Cycle | AttractorKind::QuasiPeriodic | AttractorKind::Unclassified => {
                false
            }
        }
    }

    /// Its length in periods of the section, if it is periodic.
    pub(super) fn periods(&self) -> Option<u32> {
        match self.kind {
            AttractorKind::Periodic { periods, .. } => Some(periods),
            _ => None,
        }
    }
}

/// The attractor of a run that has settled; `None` for one that has not.
///
/// # Errors
/// [`Stalled`].
pub fn measure(
    settings: &AttractorSettings,
    settled: &Settled,
) -> Result<Option<Attractor>, Stalled> {
    let Some(found) = classified(settings, settled)? else { return Ok(None) };
    let observed = observed(settings, &found)?;
    // Nothing else is taken from the section of a limit cycle without dither, whose moments are unrelated to the cycle.
    let turns = settled.cycle.map(|period| Rotation::of_cycle(settings.section.period / period));
    Ok(Some(Attractor { rotation: turns.or(observed.rotation), ..observed }))
}

/// The motion on which a run that has settled ends; `None` for one that has not. One that still moved when its periods were over cannot
/// end on an unstable base response: it is on another motion, which is classified.
pub(super) fn classified(
    settings: &AttractorSettings,
    settled: &Settled,
) -> Result<Option<Classified>, Stalled> {
    let found = |kind, state, periods| Classified { kind, base: false, state, periods };
    Ok(match (settled.outcome, &settings.base) {
        (SettleOutcome::Unsettled(Unsettled::Moving), Ok(base))
            if base.verdict == OrbitVerdict::Unstable && !settings.is_autonomous() =>
        {
            Some(elsewhere(settings, settled.state, false)?)
        }
        (SettleOutcome::Unsettled(_), _) => None,
        (SettleOutcome::Base, Ok(base)) => {
            let state =
                Start { time: 0.0, displacement: base.displacement, velocity: base.velocity };
            let kind = AttractorKind::Periodic { periods: 1, radius: base.radius };
            Some(Classified { base: true, ..found(kind, state, 1) })
        }
        (SettleOutcome::Base | SettleOutcome::Elsewhere, _) => Some(match settled.cycle {
            Some(_) => {
                let periods = RECORD.max(BLOCKS * block(settings));
                found(AttractorKind::Cycle, settled.state, periods)
            }
            None if settled.is_at_rest(settings) => found(AttractorKind::Rest, settled.state, 1),
            None => elsewhere(settings, settled.state, true)?,
        }),
    })
}

/// The finding from the records of a settled run.
enum RecordFinding {
    /// A closed orbit of this number of periods.
    Orbit(u32, Orbit),
    /// No closed orbit: the state before the last record, its length, and whether its rotation number is steady.
    Section { from: Start, periods: usize, steady: bool },
}

/// Records from a state on an attractor, until one shows an orbit or a steady rotation number.
fn records(settings: &AttractorSettings, state: Start) -> Result<RecordFinding, Stalled> {
    let mut from = state;
    let mut number = 1;
    loop {
        let (observer, end) = record(settings, from)?;
        let section = observer.section();
        if let Some((periods, orbit)) = orbit(settings, &section, end) {
            return Ok(RecordFinding::Orbit(periods, orbit));
        }
        let samples = samples_per_period(settings.section.period);
        let rotation = Rotation::of_curve(&observer.states().collect::<Vec<_>>(), samples);
        let steady = rotation.error <= STEADY && rotation.fills(number as usize * section.len());
        if steady || number == RECORDS {
            return Ok(RecordFinding::Section { from, periods: section.len(), steady });
        }
        (from, number) = (end, number + 1);
    }
}

/// The motion through a state on it, with dither. A run that has not `settled` may still be converging to what looks like a curve.
fn elsewhere(
    settings: &AttractorSettings,
    state: Start,
    settled: bool,
) -> Result<Classified, Stalled> {
    let (kind, state, periods) = match records(settings, state)? {
        RecordFinding::Orbit(periods, orbit) => {
            let kind = AttractorKind::Periodic { periods, radius: orbit.radius() };
            (kind, Start::of_state(&orbit.state), periods as usize)
        }
        RecordFinding::Section { from, periods, steady: true } if settled => {
            (AttractorKind::QuasiPeriodic, from, periods)
        }
        RecordFinding::Section { from, periods, .. } => {
            (AttractorKind::Unclassified, from, periods)
        }
    };
    Ok(Classified { kind, base: false, state, periods })
}

/// A record, and the state after it.
fn record<'a>(
    settings: &AttractorSettings,
    start: Start,
) -> Result<(BlockObserver<'a>, Start), Stalled> {
    let period = settings.section.period;
    let periods = RECORD.max(BLOCKS * block(settings));
    let mut observer = BlockObserver::with_samples(period, periods, samples_per_period(period));
    let until = periods as f64 * period;
    let end = simulate(&settings.belt, start, until, DEFAULT_TOLERANCE, &mut observer)?;
    Ok((observer, Start { time: 0.0, ..end.restart() }))
}

/// The closed orbit to which the last states of a section return.
fn orbit(settings: &AttractorSettings, section: &[(f64, f64)], end: Start) -> Option<(u32, Orbit)> {
    // A cycle without dither has its own period; its section need not return.
    if settings.is_autonomous() {
        return None;
    }
    // Below this the size of a section is rounding, and a distance relative to it is meaningless.
    let least = ONE_STATE * settings.belt.normal_load();
    let size = Moments::of(section).size();
    // The largest distance of a return after n periods among the n states before `end`.
    let returns = |n: usize, end: usize| {
        (end - n..end).map(|k| gap(section[k], section[k - n])).fold(0.0, f64::max)
    };
    let may_be_closed = |n: &usize| {
        let late = returns(*n, section.len());
        late <= (CLOSED * size).max(least)
            || (late <= RETURNS * size && late <= SHRINKS * returns(*n, 2 * n))
    };
    let own = (ITS_OWN * size).max(least);
    (1..=MOST_PERIODS).filter(may_be_closed).take(MOST_SHOTS).find_map(|n| {
        let periods = u32::try_from(n).ok()?;
        let orbit = near(&settings.system, &[end.displacement, end.velocity], periods).ok()?;
        let attracts = orbit.verdict() != OrbitVerdict::Unstable
            && gap(state(&orbit), (end.displacement, end.velocity)) <= own;
        attracts.then(|| shortest(settings, periods, orbit))
    })
}

/// The orbit with its shortest period, if the period that was found is a multiple of it. An unstable orbit near one of its states is
/// another one: that about which a small slow motion turns.
fn shortest(settings: &AttractorSettings, periods: u32, orbit: Orbit) -> (u32, Orbit) {
    let same = |part: &Orbit| {
        let off = gap(state(part), state(&orbit));
        off <= ONE_STATE * settings.belt.normal_load() && part.verdict() != OrbitVerdict::Unstable
    };
    shortened(&settings.system, &orbit, periods, same).unwrap_or((periods, orbit))
}

fn state(orbit: &Orbit) -> (f64, f64) {
    let start = Start::of_state(&orbit.state);
    (start.displacement, start.velocity)
}

/// Distance of two states.
fn gap(a: (f64, f64), b: (f64, f64)) -> f64 {
    libm::hypot(a.0 - b.0, a.1 - b.1)
}

/// A motion as observed by a run on it.
fn observed(settings: &AttractorSettings, found: &Classified) -> Result<Attractor, Stalled> {
    let &Classified { kind, base, state, periods } = found;
    let period = settings.section.period;
    let length = periods as f64 * period;
    let is_orbit = matches!(kind, AttractorKind::Periodic { .. });
    let samples =
        if is_orbit { samples_per_orbit_period(period) } else { samples_per_period(period) };
    let mut observers = (
        BlockObserver::with_samples(period, periods, samples),
        DisplacementExtremes { lowest: f64::INFINITY, highest: f64::NEG_INFINITY },
    );
    simulate(&settings.belt, state, length, DEFAULT_TOLERANCE, &mut observers)?;
    let (observer, extremes) = observers;
    let stick_fraction = observer.stuck / length;
    // Held by friction on a belt that does not move: the dither does not show in the motion.
    let still = STILL * settings.belt.normal_load();
    let rests = settings.belt.belt_velocity() == 0.0 && extremes.highest - extremes.lowest <= still;
    let kind = if rests { AttractorKind::Rest } else { kind };
    let section = observer.section();
    let states = || observer.states().collect::<Vec<_>>();
    let rotation = match kind {
        AttractorKind::Periodic { periods: 1, .. } | AttractorKind::Rest => None,
        AttractorKind::Periodic { .. } => Some(Rotation::of_orbit(&states(), samples)),
        AttractorKind::Cycle | AttractorKind::QuasiPeriodic | AttractorKind::Unclassified => {
            Some(Rotation::of_curve(&states(), samples))
        }
    };
    Ok(Attractor {
        kind,
        base,
        quiet: rests || found.is_quiet(settings),
        state,
        section,
        lowest: extremes.lowest,
        highest: extremes.highest,
        stick_fraction,
        rotation,
    })
}

/// Least and largest x of a run, including those inside steps, where x′ changes sign.
struct DisplacementExtremes {
    lowest: f64,
    highest: f64,
}

/// Closeness of the moment at which x′ = 0: the error of x is of the order of its square, below rounding. Looser, a small
/// response would err relative to its size; closer only takes longer.
const TURNING_POINT: Closeness = Closeness { absolute: 0.0, relative: 1e-9 };

impl Observer for DisplacementExtremes {
    fn segment(&mut self, segment: &Segment<'_>) {
        let h = segment.duration();
        let mut take = |x: f64| {
            self.lowest = self.lowest.min(x);
            self.highest = self.highest.max(x);
        };
        take(segment.displacement(0.0));
        take(segment.displacement(h));
        if segment.velocity(0.0) * segment.velocity(h) < 0.0
            && let Ok(root) = find_root(|since| segment.velocity(since), 0.0, h, TURNING_POINT)
        {
            take(segment.displacement(root.location));
        }
    }
}
