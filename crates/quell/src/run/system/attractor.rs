//! The motion on which a run of a system ends, as `attractor`, `bifurcation`, `basins` and `probability` report it.

use quell_dynamics::attractor::{
    Attractor, AttractorKind, AttractorSettings, Patience, Rotation, Settled, Unsettled, measure,
    settle_many,
};
use quell_dynamics::motion::orbit::{
    BASE_STEPS, MotionOrbit, NoCycle, NoMotionOrbit, SettledMotion, base_motion, displaced,
    free_cycle, settled, settled_many, sliding_state, sliding_verdict,
};
use quell_dynamics::motion::{MOTION_TOLERANCE, Motion, MotionStart};
use quell_dynamics::orbit::NoOrbit;
use quell_dynamics::response::is_above_the_band;
use quell_dynamics::simulation::{Stalled, Start};
use quell_linear::pure_slip::period;
use quell_model::units::Quantity;
use quell_model::{OneMass, System};
use serde_json::json;

use super::cycle_samples::CycleSamples;
use super::in_units;
use super::passing::nearest_distance;
use crate::fields::Fields;
use crate::study::{SystemStudy, UnitSystem};
use crate::words::{digits, plural};

/// Periods of the dither over which a motion that is not periodic is measured.
const MEASURED: f64 = 20.0;

/// Mismatch of states, relative to their size, of one motion.
const SAME: f64 = 1e-5;

/// The kind of a motion on which a run ends.
#[derive(Clone, Debug, PartialEq)]
pub enum MotionKind {
    /// It repeats after this number of periods of the dither.
    Periodic {
        /// The number of periods.
        periods: u32,
        /// Modulus of the deciding multiplier.
        radius: f64,
    },
    /// It fills a closed curve of the section, by its rotation number; known of one mass alone.
    QuasiPeriodic {
        /// Periods of the dither over which it was followed.
        tried: u32,
    },
    /// It does not repeat itself.
    NotPeriodic {
        /// Periods of the dither over which it was followed.
        tried: u32,
    },
    /// A limit cycle without dither.
    Cycle {
        /// Its period.
        period: f64,
        /// Modulus of the deciding multiplier.
        radius: f64,
    },
    /// Rest or steady sliding, without dither.
    Rest,
}

/// The motion on which a run ends.
#[derive(Clone, Debug, PartialEq)]
pub struct SystemAttractor {
    /// Its kind.
    pub kind: MotionKind,
    /// Whether it is the response that continues steady sliding as the dither grows; `None` where that is not known, and without dither.
    pub base: Option<bool>,
    /// Whether it is quiet: in step with the dither, or periodic with a frequency above the band of the vibration; at rest without it.
    pub quiet: bool,
    /// Slow revolutions per period of the dither; `None` of a motion in step with it, and where they are not known.
    pub rotation: Option<Rotation>,
    /// Angular frequency of the slow revolutions.
    pub slow: Option<f64>,
    /// A state of it at a whole period of the dither.
    pub state: Vec<f64>,
    /// Its states at whole periods; of a limit cycle also those at its events.
    pub states: Vec<Vec<f64>>,
    /// Observed displacement at whole periods.
    pub section: Vec<f64>,
    /// Least and largest observed displacement.
    pub extremes: (f64, f64),
    /// Share of the time that each contact sticks.
    pub stick: Vec<f64>,
    /// Largest slip speed of each contact.
    pub largest_slip: Vec<f64>,
}

/// The end of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct EndOfRun {
    /// The motion.
    pub attractor: SystemAttractor,
    /// Periods of the dither until the run was near it; 0 without dither.
    pub periods: u32,
}

/// The motion on which a run from a state ends.
///
/// # Errors
/// Why it cannot be computed.
pub fn end_of_run(system: &System, row: &[f64], start: &[f64]) -> Result<EndOfRun, String> {
    if let Some(mass) = judged_mass(system) {
        let ends = ends_of_one_mass((system, &mass), row, &[start.to_vec()]);
        return ends.into_iter().next().unwrap_or_else(|| Err("no run".to_owned()));
    }
    if !system.is_dithered() {
        // A dither of amplitude 0 gives the motion no period.
        return on_free_motion(&system.undithered(), row, start);
    }
    under_dither(system, row, start, settled(system, start))
}

/// The one mass of a system whose runs are judged by its section, without dither by its cycle map. Of a mass on a surface at rest that no
/// dither moves every state in stick is an end of its own: its runs are followed.
pub(in crate::run) fn judged_mass(system: &System) -> Option<OneMass> {
    let judges = |mass: &OneMass| system.is_dithered() || mass.belt().belt_velocity() != 0.0;
    system.one_mass().filter(judges)
}

/// The starts of runs of one mass.
pub(in crate::run) fn starts_of_mass(mass: &OneMass, states: &[Vec<f64>]) -> Vec<Start> {
    let starts = states.iter().map(|state| {
        let (displacement, velocity) = mass.of_state(state);
        Start { time: 0.0, displacement, velocity }
    });
    starts.collect()
}

/// [`end_of_run`] of several starts; those under dither go on side by side.
pub(in crate::run) fn ends_of_runs(
    system: &System,
    row: &[f64],
    starts: &[Vec<f64>],
) -> Vec<Result<EndOfRun, String>> {
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
) -> Vec<Result<EndOfRun, String>> {
    let settings = match AttractorSettings::new(mass.belt()) {
        Ok(settings) => settings,
        Err(why) => return vec![Err(why.to_string()); starts.len()],
    };
    let settled = settle_many(&settings, &starts_of_mass(mass, starts), Patience::SWEEP);
    let end = |settled: Result<Settled, Stalled>| {
        let stopped = |why: Stalled| {
            let time = why.time / mass.rate();
            format!("a run stopped at t = {}: {}", digits(time), why.why)
        };
        let settled = settled.map_err(stopped)?;
        let found = measure(&settings, &settled).map_err(stopped)?;
        let periods = u32::try_from(settled.periods).unwrap_or(u32::MAX);
        match found {
            Some(found) => {
                let attractor = measured_of_one_mass((system, mass), row, &found, periods)?;
                Ok(EndOfRun { attractor, periods })
            }
            None => Err(settled.why().unwrap_or(Unsettled::Moving).about().to_owned()),
        }
    };
    settled.into_iter().map(end).collect()
}

/// An attractor of one mass, with dither or without, as that of its system; `tried`: the periods over which it was followed.
pub(in crate::run) fn measured_of_one_mass(
    (system, mass): (&System, &OneMass),
    row: &[f64],
    found: &Attractor,
    tried: u32,
) -> Result<SystemAttractor, String> {
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
) -> Result<SystemAttractor, String> {
    let dither = period(system).ok_or("the dithers have no common period")?;
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
        extremes: (ends[0].min(ends[1]), ends[0].max(ends[1])),
        stick: vec![found.stick_fraction],
        ..seen
    })
}

/// The motion that the judge has found for a run under dither.
fn under_dither(
    system: &System,
    row: &[f64],
    start: &[f64],
    found: Result<SettledMotion, NoMotionOrbit>,
) -> Result<EndOfRun, String> {
    match found {
        Ok(SettledMotion { orbit, multiple, periods }) => {
            let states = at_periods(system, &orbit, multiple)?;
            let samples = CycleSamples::over(system, row, &orbit.state, orbit.period);
            let kind = MotionKind::Periodic { periods: multiple, radius: orbit.radius() };
            let seen = SystemAttractor::new(kind, row, states, &samples);
            let base = (multiple == 1).then(|| is_base(system, &orbit.state)).flatten();
            let quiet = multiple == 1 || is_above_the_band(system, orbit.period);
            Ok(EndOfRun { attractor: SystemAttractor { base, quiet, ..seen }, periods })
        }
        Err(NoMotionOrbit::Unsettled { periods, mut last, is_steady: true }) => {
            let length = MEASURED * period(system).ok_or("the dithers have no common period")?;
            let state = last.last().cloned().unwrap_or_else(|| start.to_vec());
            last.reverse();
            let samples = CycleSamples::over(system, row, &state, length);
            let kind = MotionKind::NotPeriodic { tried: periods };
            Ok(EndOfRun { attractor: SystemAttractor::new(kind, row, last, &samples), periods })
        }
        Err(why) => Err(why.to_string()),
    }
}

/// Whether a motion in step with the dither is the base response; `None` where that is not known.
fn is_base(system: &System, state: &[f64]) -> Option<bool> {
    let base = base_motion(system, BASE_STEPS).ok()?;
    let size = state.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let off = base.state.iter().zip(state).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
    Some(off <= SAME * size)
}

/// Why the base response is unknown, as text.
fn unknown(why: &NoOrbit) -> String {
    match why {
        NoOrbit::Ends { share } => {
            format!(
                "the base response ends at {} % of the dither's amplitude",
                digits(100.0 * share)
            )
        }
        NoOrbit::LostOnTheWay { share } => format!(
            "the base response could not be followed beyond {} % of the dither's amplitude",
            digits(100.0 * share)
        ),
        why => format!("the base response was not found: {why}"),
    }
}

/// Verdict on the base response of a dithered system, or on steady sliding without dither.
///
/// # Errors
/// Why it is unknown.
pub fn local_verdict(system: &System) -> Result<&'static str, String> {
    if system.is_dithered()
        && let Some(mass) = system.one_mass()
    {
        let settings = AttractorSettings::new(mass.belt()).map_err(|why| why.to_string())?;
        return settings.base.map(|base| base.verdict.name()).map_err(|why| unknown(&why));
    }
    if system.is_dithered() {
        let base = base_motion(system, BASE_STEPS).map_err(|why| why.to_string())?;
        return Ok(base.verdict().name());
    }
    Ok(sliding_verdict(system)?.name())
}

fn on_free_motion(system: &System, row: &[f64], start: &[f64]) -> Result<EndOfRun, String> {
    let (kind, state, length, passed) = match free_cycle(system, &displaced(system, start)) {
        Ok(cycle) => {
            let kind = MotionKind::Cycle { period: cycle.period, radius: cycle.radius() };
            let passed = cycle.events.into_iter().map(|event| event.state).collect();
            (kind, cycle.state, cycle.period, passed)
        }
        Err(NoCycle::Rest { state, .. }) => {
            // Long enough to show which contacts stick.
            let motion = Motion::new(system).map_err(|why| why.to_string())?;
            (MotionKind::Rest, state, motion.time_scale(), Vec::new())
        }
        Err(why) => return Err(why.to_string()),
    };
    let samples = CycleSamples::over(system, row, &state, length);
    let mut attractor = SystemAttractor::new(kind, row, vec![state], &samples);
    // A run may enter a symmetric cycle half a period later: the states at its events make both one motion.
    attractor.states.extend(passed);
    Ok(EndOfRun { attractor, periods: 0 })
}

/// The states of an orbit at whole periods of the dither.
fn at_periods(
    system: &System,
    orbit: &MotionOrbit,
    multiple: u32,
) -> Result<Vec<Vec<f64>>, String> {
    let motion = Motion::new(system).map_err(|why| why.to_string())?;
    let mut from = MotionStart { time: 0.0, state: orbit.state.clone() };
    let mut states = vec![orbit.state.clone()];
    for count in 1..multiple {
        let until = f64::from(count) * orbit.period / f64::from(multiple);
        let end = motion.run(&from, until, MOTION_TOLERANCE, &mut ());
        from = end.map_err(|why| why.to_string())?.restart();
        states.push(from.state.clone());
    }
    Ok(states)
}

/// Why the observed velocity is unknown.
const WITHOUT_VELOCITY: &str = "the states of first-order equations contain no velocity";

/// Adds a state, and the observed displacement and velocity in it.
pub(in crate::run) fn put_state(fields: &mut Fields, study: &SystemStudy, state: &[f64]) {
    let observe = study.observe();
    let displacement = observe.iter().zip(state).map(|(w, x)| w * x).sum();
    let is_mechanical = study.system().structure.mechanical().is_some();
    let velocity = is_mechanical.then(|| rate_of(&observe, state));
    fields
        .plain("state", state.to_vec())
        .number("displacement", Quantity::Displacement, displacement)
        .known("velocity", Quantity::Velocity, velocity.ok_or_else(|| WITHOUT_VELOCITY.to_owned()));
}

/// Rate of an observed displacement in a state of masses.
pub(in crate::run) fn rate_of(row: &[f64], state: &[f64]) -> f64 {
    row.iter().zip(&state[row.len()..]).map(|(weight, velocity)| weight * velocity).sum()
}

impl SystemAttractor {
    fn new(kind: MotionKind, row: &[f64], states: Vec<Vec<f64>>, samples: &CycleSamples) -> Self {
        let observed =
            |state: &Vec<f64>| -> f64 { row.iter().zip(state).map(|(w, x)| w * x).sum() };
        let section: Vec<f64> = states.iter().map(observed).collect();
        let [(least, most), _] = samples.extremes;
        let bounds = section.iter().fold((least, most), |(a, b), x| (a.min(*x), b.max(*x)));
        let means = samples.means().into_iter();
        let stick: Vec<f64> = means.map(|means| means.stick_fraction).collect();
        let largest_slip = (0..stick.len()).map(|contact| samples.largest_slip(contact)).collect();
        let state = states.first().cloned().unwrap_or_default();
        let (base, rotation, slow) = (None, None, None);
        let quiet = kind == MotionKind::Rest;
        Self {
            kind,
            base,
            quiet,
            rotation,
            slow,
            state,
            states,
            section,
            extremes: bounds,
            stick,
            largest_slip,
        }
    }

    /// Observed velocity at whole periods; `None` of first-order equations.
    pub fn section_rates(&self, study: &SystemStudy) -> Option<Vec<f64>> {
        study.system().structure.mechanical()?;
        let observe = study.observe();
        let states = self.states.iter().take(self.section.len());
        Some(states.map(|state| rate_of(&observe, state)).collect())
    }

    /// Peak-to-peak of the observed displacement.
    pub fn size(&self) -> f64 {
        self.extremes.1 - self.extremes.0
    }

    /// Whether it is steady sliding: without dither and at rest, while every contact slips.
    pub fn slides(&self) -> bool {
        self.kind == MotionKind::Rest && self.stick.iter().all(|share| *share == 0.0)
    }

    /// Its kind in words.
    pub fn words(&self, units: UnitSystem) -> String {
        let slow = self.slow.map_or_else(String::new, |slow| match units {
            UnitSystem::None => format!(", slow angular frequency {}", digits(slow)),
            _ => format!(", slow frequency {} Hz", digits(slow / std::f64::consts::TAU)),
        });
        match self.kind {
            MotionKind::Periodic { periods: 1, .. } if self.base == Some(true) => {
                "base response (period 1)".to_owned()
            }
            MotionKind::Periodic { periods: 1, .. } => {
                "period 1, in step with the dither".to_owned()
            }
            MotionKind::Periodic { periods, .. } => {
                let Some(ratio) = self.rotation.and_then(|rotation| rotation.ratio) else {
                    return format!("locked: repeats after {periods} periods");
                };
                let (turns, counted) = (ratio.turns, ratio.periods);
                let repeats = if counted == periods {
                    String::new()
                } else {
                    format!(", repeating after {periods}")
                };
                format!(
                    "locked: {turns} slow cycle{} in {counted} period{}{repeats}{slow}",
                    plural(turns),
                    plural(counted)
                )
            }
            MotionKind::QuasiPeriodic { .. } => format!("quasi-periodic{slow}"),
            MotionKind::NotPeriodic { tried } => {
                format!("a motion that does not repeat itself, followed over {tried} periods")
            }
            MotionKind::Cycle { period, .. } => {
                format!("limit cycle of period {}", in_units(units, Quantity::Time, period))
            }
            MotionKind::Rest if self.slides() => "steady sliding".to_owned(),
            MotionKind::Rest if self.stick.iter().all(|share| *share == 1.0) => {
                "rest, with every contact in stick".to_owned()
            }
            MotionKind::Rest => "rest, with some contacts in stick".to_owned(),
        }
    }

    /// Name of its kind in JSON.
    pub fn kind_name(&self) -> &'static str {
        KINDS[usize::from(self.kind_code())].1
    }

    /// Code of its kind in datasets.
    pub fn kind_code(&self) -> u8 {
        match self.kind {
            MotionKind::Periodic { periods: 1, .. } => 0,
            MotionKind::Periodic { .. } => 1,
            MotionKind::NotPeriodic { .. } => 2,
            MotionKind::Cycle { .. } => 3,
            MotionKind::Rest => 4,
            MotionKind::QuasiPeriodic { .. } => 6,
        }
    }

    /// Whether both are one motion of a system: periodic with the same states, perhaps after some periods of the dither, or the same
    /// cycle, found at another of its moments.
    pub fn is(&self, other: &Self, system: &System) -> bool {
        let size = self.state.iter().chain(&self.section).fold(0.0, |m: f64, x| m.max(x.abs()));
        let near = |state: &Vec<f64>| {
            let pairs = state.iter().zip(&self.state);
            pairs.fold(0.0, |m: f64, (a, b)| m.max((a - b).abs())) <= SAME * size
        };
        match (&self.kind, &other.kind) {
            (
                MotionKind::Periodic { periods, .. },
                MotionKind::Periodic { periods: others, .. },
            ) => periods == others && other.states.iter().any(near),
            (MotionKind::Cycle { period, .. }, MotionKind::Cycle { period: others, .. }) => {
                let passes =
                    || nearest_distance(system, (&other.state, *others), &self.state) <= SAME;
                (period - others).abs() <= SAME * period
                    && (other.states.iter().any(near) || passes())
            }
            // A record shows a part of a motion that is not periodic: such motions count as one.
            (MotionKind::Rest, MotionKind::Rest)
            | (MotionKind::QuasiPeriodic { .. }, MotionKind::QuasiPeriodic { .. })
            | (MotionKind::NotPeriodic { .. }, MotionKind::NotPeriodic { .. }) => true,
            _ => false,
        }
    }

    /// Adds its fields to an object.
    pub(in crate::run) fn put(&self, fields: &mut Fields, study: &SystemStudy) {
        fields
            .plain("words", self.words(study.units()))
            .plain("kind", self.kind_name())
            .plain("quiet", self.quiet);
        match self.base {
            Some(base) => fields.plain("base_response", base),
            None if self.kind_code() == 0 => {
                fields.unknown("base_response", "the base response was not found")
            }
            None => fields.plain("base_response", false),
        };
        self.put_turns(fields);
        match self.kind {
            MotionKind::Periodic { periods, radius } => {
                fields.plain("periods", periods).plain("multiplier", radius);
            }
            MotionKind::Cycle { period, radius } => {
                fields.unknown("periods", "a limit cycle has a period of its own");
                fields.number("period", Quantity::Time, period).plain("multiplier", radius);
            }
            MotionKind::QuasiPeriodic { .. }
            | MotionKind::NotPeriodic { .. }
            | MotionKind::Rest => {
                let why = self.words(study.units());
                fields.unknown("periods", why.clone()).unknown("multiplier", why);
            }
        }
        let contacts = study.system().contacts.iter().zip(&self.stick).map(|(contact, share)| {
            let mut inner = Fields::of_system(study.units());
            inner.plain("name", contact.name.clone()).number(
                "stick_fraction",
                Quantity::Ratio,
                *share,
            );
            inner
        });
        put_state(fields, study, &self.state);
        fields
            .number("lowest", Quantity::Displacement, self.extremes.0)
            .number("highest", Quantity::Displacement, self.extremes.1)
            .number("peak_to_peak", Quantity::Displacement, self.size())
            .numbers("section_displacement", Quantity::Displacement, &self.section);
        match self.section_rates(study) {
            Some(rates) => fields.numbers("section_velocity", Quantity::Velocity, &rates),
            None => fields.unknown("section_velocity", WITHOUT_VELOCITY),
        };
        fields.list("contacts", contacts);
    }
}

impl SystemAttractor {
    /// The slow revolutions, or why they are not known.
    fn put_turns(&self, fields: &mut Fields) {
        let why = match self.kind {
            MotionKind::Periodic { periods: 1, .. } => {
                "a motion in step with the dither has no slow rotation"
            }
            MotionKind::Cycle { .. } | MotionKind::Rest => {
                "rotation is counted in periods of a dither"
            }
            _ => "slow revolutions are counted for a single mass with a rigid contact alone",
        };
        let Some(rotation) = self.rotation else {
            for name in ["rotation_number", "rotation_error", "frequency", "locking"] {
                fields.unknown(name, why);
            }
            return;
        };
        fields.number("rotation_number", Quantity::Ratio, rotation.turns_per_period).number(
            "rotation_error",
            Quantity::Ratio,
            rotation.error,
        );
        if let Some(slow) = self.slow {
            fields.number("frequency", Quantity::FrequencyRatio, slow);
        }
        match rotation.ratio {
            Some(ratio) => {
                fields.plain("locking", json!({ "turns": ratio.turns, "periods": ratio.periods }));
            }
            None => {
                fields.unknown("locking", "the response is not locked");
            }
        }
    }
}

/// Words of the column `kind`.
pub(in crate::run) const KINDS: [(u8, &str); 7] = [
    (0, "period-1"),
    (1, "locked"),
    (2, "not-periodic"),
    (3, "limit-cycle"),
    (4, "rest"),
    (5, "unknown"),
    (6, "quasi-periodic"),
];

/// Words of the column `local_verdict`.
pub(in crate::run) const VERDICTS: [(u8, &str); 4] =
    [(0, "stable"), (1, "unstable"), (2, "undecided"), (3, "unknown")];

/// The code of a verdict in datasets.
pub(in crate::run) fn verdict_code(local: &Result<&'static str, String>) -> u8 {
    let word = local.as_ref().map_or("unknown", |word| *word);
    VERDICTS.iter().find(|(_, known)| *known == word).map_or(3, |(code, _)| *code)
}
