//! The motion on which a run of a system ends, as `bifurcation` and `basins` report it.

use quell_dynamics::motion::orbit::{
    BASE_STEPS, MotionOrbit, NoCycle, NoMotionOrbit, SettledMotion, base_motion, free_cycle,
    is_on_sliding, kicked_by, settled, settled_many,
};
use quell_dynamics::motion::{MOTION_TOLERANCE, Motion, MotionStart};
use quell_linear::linearised::Linearised;
use quell_linear::pure_slip::period;
use quell_linear::spectrum;
use quell_model::System;
use quell_model::units::Quantity;

use super::cycle_samples::CycleSamples;
use super::in_units;
use super::passing::nearest_distance;
use crate::fields::Fields;
use crate::study::{SystemStudy, UnitSystem};

/// Periods of the dither over which a motion that is not periodic is measured.
const MEASURED: f64 = 20.0;

/// Mismatch of states, relative to their size, of one motion.
const SAME: f64 = 1e-5;

/// Velocity of the displacement of a start on unstable steady sliding, over that of the surface: far above rounding, so that the
/// run leaves in time, and far below that of a limit cycle.
const NUDGE: f64 = 1e-4;

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
    if !system.is_dithered() {
        // A dither of amplitude 0 gives the motion no period.
        return on_free_motion(&system.undithered(), row, start);
    }
    under_dither(system, row, start, settled(system, start))
}

/// [`end_of_run`] of several starts; those under dither go on side by side.
pub(super) fn ends_of_runs(
    system: &System,
    row: &[f64],
    starts: &[Vec<f64>],
) -> Vec<Result<EndOfRun, String>> {
    if !system.is_dithered() {
        return starts.iter().map(|start| end_of_run(system, row, start)).collect();
    }
    let found = settled_many(system, starts).into_iter().zip(starts);
    found.map(|(found, start)| under_dither(system, row, start, found)).collect()
}

/// The motion that the judge has found for a run under dither.
fn under_dither(
    system: &System,
    row: &[f64],
    start: &[f64],
    found: Result<SettledMotion, NoMotionOrbit>,
) -> Result<EndOfRun, String> {
    let (kind, state, states, length, periods) = match found {
        Ok(SettledMotion { orbit, multiple, periods }) => {
            let states = at_periods(system, &orbit, multiple)?;
            let kind = MotionKind::Periodic { periods: multiple, radius: orbit.radius() };
            (kind, orbit.state, states, orbit.period, periods)
        }
        Err(NoMotionOrbit::Unsettled { periods, mut last, is_steady: true }) => {
            let length = MEASURED * period(system).ok_or("the dithers have no common period")?;
            let state = last.last().cloned().unwrap_or_else(|| start.to_vec());
            last.reverse();
            (MotionKind::NotPeriodic { tried: periods }, state, last, length, periods)
        }
        Err(why) => return Err(why.to_string()),
    };
    let samples = CycleSamples::over(system, row, &state, length);
    Ok(EndOfRun { attractor: SystemAttractor::new(kind, row, states, &samples), periods })
}

/// Verdict on the base response of a dithered system, or on steady sliding without dither.
///
/// # Errors
/// Why it is unknown.
pub fn local_verdict(system: &System) -> Result<&'static str, String> {
    if system.is_dithered() {
        let base = base_motion(system, BASE_STEPS).map_err(|why| why.to_string())?;
        return Ok(base.verdict().name());
    }
    let linear = Linearised::new(system).map_err(|why| why.to_string())?;
    let growth = spectrum::growth(&linear, &linear.friction()).map_err(|why| why.to_string())?;
    Ok(growth.verdict().name())
}

/// A start without dither. A run from unstable steady sliding would stay there until rounding displaces it: such a start is
/// displaced first, by [`NUDGE`] times the velocity of the surface.
fn displaced(system: &System, start: &[f64]) -> Vec<f64> {
    if !is_on_sliding(system, start)
        || local_verdict(system).as_ref().is_ok_and(|verdict| *verdict == "stable")
    {
        return start.to_vec();
    }
    kicked_by(system, NUDGE).unwrap_or_else(|| start.to_vec())
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
        Self { kind, state, states, section, extremes: bounds, stick, largest_slip }
    }

    /// Peak-to-peak of the observed displacement.
    pub fn size(&self) -> f64 {
        self.extremes.1 - self.extremes.0
    }

    /// Whether it has the period of the dither, or is at rest without it.
    pub fn is_quiet(&self) -> bool {
        matches!(self.kind, MotionKind::Periodic { periods: 1, .. } | MotionKind::Rest)
    }

    /// Whether it is steady sliding: without dither and at rest, while every contact slips.
    pub fn slides(&self) -> bool {
        self.kind == MotionKind::Rest && self.stick.iter().all(|share| *share == 0.0)
    }

    /// Its kind in words.
    pub fn words(&self, units: UnitSystem) -> String {
        match self.kind {
            MotionKind::Periodic { periods: 1, .. } => {
                "period 1, in step with the dither".to_owned()
            }
            MotionKind::Periodic { periods, .. } => {
                format!("locked: repeats after {periods} periods")
            }
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
            | (MotionKind::NotPeriodic { .. }, MotionKind::NotPeriodic { .. }) => true,
            _ => false,
        }
    }

    /// Adds its fields to an object.
    pub(super) fn put(&self, fields: &mut Fields, study: &SystemStudy) {
        fields
            .plain("words", self.words(study.units()))
            .plain("kind", self.kind_name())
            .plain("quiet", self.is_quiet());
        match self.kind {
            MotionKind::Periodic { periods, radius } => {
                fields.plain("periods", periods).plain("multiplier", radius);
            }
            MotionKind::Cycle { period, radius } => {
                fields.unknown("periods", "a limit cycle has a period of its own");
                fields.number("period", Quantity::Time, period).plain("multiplier", radius);
            }
            MotionKind::NotPeriodic { .. } | MotionKind::Rest => {
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
        fields
            .plain("state", self.state.clone())
            .number("lowest", Quantity::Displacement, self.extremes.0)
            .number("highest", Quantity::Displacement, self.extremes.1)
            .number("peak_to_peak", Quantity::Displacement, self.size())
            .numbers("section_displacement", Quantity::Displacement, &self.section)
            .list("contacts", contacts);
    }
}

/// Words of the column `kind`.
pub(super) const KINDS: [(u8, &str); 6] = [
    (0, "period-1"),
    (1, "locked"),
    (2, "not-periodic"),
    (3, "limit-cycle"),
    (4, "rest"),
    (5, "unknown"),
];

/// Words of the column `local_verdict`.
pub(super) const VERDICTS: [(u8, &str); 4] =
    [(0, "stable"), (1, "unstable"), (2, "undecided"), (3, "unknown")];

/// The code of a verdict in datasets.
pub(super) fn verdict_code(local: &Result<&'static str, String>) -> u8 {
    let word = local.as_ref().map_or("unknown", |word| *word);
    VERDICTS.iter().find(|(_, known)| *known == word).map_or(3, |(code, _)| *code)
}
