//! `bifurcation`: the response along a parameter, swept up and down with the state carried over.
//!
//! At each value the run goes on from where the last one ended (on a closed orbit from its exact state), until a growth rate says
//! that it has settled. Sweeping down begins where sweeping up ended. Where the two differ, responses coexist.

use std::sync::atomic::Ordering;

use quell_belt::attractor::{Attractor, Patience, Unsettled, measure, settle};
use quell_belt::orbit::Verdict;
use quell_belt::simulation::Start;
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::attractor::{
    KINDS, VERDICTS, kind_code, number, put, put_section, scene, unknown, verdict_code, words,
};
use super::varied::{Range, Varied};
use super::{failed, start, start_in_words, stopped};
use crate::complaint::Failure;
use crate::dataset::{Array, Dataset};
use crate::fields::Fields;
use crate::study::Study;
use crate::sweep::Running;

/// Relative difference of size beyond which the two directions show different responses.
const APART: f64 = 0.02;

/// The same relative to F, for responses without slow motion.
const APART_AT_LEAST: f64 = 1e-4;

/// What is asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// The parameter and its values.
    pub range: Range,
    /// Whether it is swept up.
    pub up: bool,
    /// Whether it is swept down.
    pub down: bool,
}

/// Which way a parameter is swept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Direction {
    /// To larger values.
    Up,
    /// To smaller values.
    Down,
}

impl Direction {
    /// Word in outputs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Up => "up",
            Self::Down => "down",
        }
    }
}

/// The response at one value.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// The parameter.
    pub value: f64,
    /// Period of the section, τ.
    pub period: f64,
    /// Whether the response of sliding is stable here, whether or not the sweep is on it; or why that is not known.
    pub local: Result<Verdict, String>,
    /// What the sweep is on; or why it has not settled.
    pub response: Result<Attractor, Unsettled>,
    /// Periods until it had settled.
    pub periods: u64,
}

/// A sweep in one direction, in the order of the sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct Branch {
    /// Which way.
    pub direction: Direction,
    /// Its points.
    pub points: Vec<Point>,
}

/// Two neighbouring values of a branch between which the quiet response is left or reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jump {
    /// The last value before.
    pub before: f64,
    /// The first value after.
    pub after: f64,
    /// Whether the sweep is on the quiet response afterwards.
    pub to_quiet: bool,
}

/// Sweeps of one parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Bifurcation {
    /// The parameter and its values.
    pub varied: Varied,
    /// The sweeps that were asked for, up before down.
    pub branches: Vec<Branch>,
    /// First and last value of each stretch in which the two directions show different responses.
    pub hysteresis: Vec<(f64, f64)>,
}

/// Sweeps the belt of a study.
///
/// # Errors
/// Complaints about the question or the start; [`Failure::Failed`] if the engine stops or the work is stopped.
pub fn run(
    study: &Study,
    question: &Question,
    running: Running<'_>,
) -> Result<Bifurcation, Failure> {
    let varied = Varied::new(study, "--parameter", &question.range)?;
    // Both where none is asked for.
    let (up, down) =
        if question.up || question.down { (question.up, question.down) } else { (true, true) };
    let count = varied.values.len();
    let asked = [(up, Direction::Up), (down, Direction::Down)].into_iter().filter(|it| it.0);
    let directions: Vec<Direction> = asked.map(|it| it.1).collect();
    running.progress.begin(count * directions.len(), 0);
    let mut branches: Vec<Branch> = Vec::new();
    let mut state: Option<Start> = None;
    let swept = directions.into_iter().try_for_each(|direction| {
        let mut values = varied.values.clone();
        if direction == Direction::Down {
            values.reverse();
        }
        let mut found = Vec::with_capacity(count);
        for value in values {
            if running.stop.load(Ordering::Relaxed) {
                return Err(stopped("bifurcation"));
            }
            let at = varied.study_at(study, value)?;
            let begun = match state {
                Some(state) => state,
                None => start(&at)?,
            };
            let (point, end) = point(&at, value, begun)?;
            found.push(point);
            state = Some(end);
            running.progress.advance(1);
        }
        branches.push(Branch { direction, points: found });
        Ok(())
    });
    running.progress.end();
    swept?;
    let hysteresis = hysteresis(study, &branches);
    Ok(Bifurcation { varied, branches, hysteresis })
}

/// The response at one value, and the state with which the next one begins.
fn point(study: &Study, value: f64, begun: Start) -> Result<(Point, Start), Failure> {
    let scene = scene(study.belt())?;
    let patience = Patience { tolerance: study.solver().tolerance, ..Patience::SWEEP };
    let settled = settle(&scene, begun, patience).map_err(failed)?;
    let attractor = measure(&scene, &settled).map_err(failed)?;
    let end = attractor.as_ref().map_or(settled.state, |attractor| attractor.state);
    let response = attractor.ok_or_else(|| settled.why().unwrap_or(Unsettled::Moving));
    let local = scene.quiet.as_ref().map(|quiet| quiet.verdict).map_err(unknown);
    let period = scene.strobe.period;
    Ok((Point { value, period, local, response, periods: settled.periods }, end))
}

/// Stretches in which both directions were swept and show different responses.
fn hysteresis(study: &Study, branches: &[Branch]) -> Vec<(f64, f64)> {
    let [up, down] = branches else { return Vec::new() };
    let scale = study.belt().normal_load();
    let mut stretches: Vec<(f64, f64)> = Vec::new();
    let mut open = false;
    for (one, other) in up.points.iter().zip(down.points.iter().rev()) {
        let apart = match (&one.response, &other.response) {
            (Ok(one), Ok(other)) => {
                let most = one.size().max(other.size());
                (one.size() - other.size()).abs() > APART * most + APART_AT_LEAST * scale
            }
            _ => false,
        };
        match (apart, stretches.last_mut()) {
            (true, Some(last)) if open => last.1 = one.value,
            (true, _) => stretches.push((one.value, one.value)),
            (false, _) => {}
        }
        open = apart;
    }
    stretches
}

impl Point {
    /// Whether the sweep is on the response of sliding.
    pub fn quiet(&self) -> bool {
        self.response.as_ref().is_ok_and(|attractor| attractor.quiet)
    }
}

impl Branch {
    /// Where the quiet response is left or reached.
    pub fn jumps(&self) -> Vec<Jump> {
        let changes = self.points.windows(2).filter(|pair| pair[0].quiet() != pair[1].quiet());
        changes
            .map(|pair| Jump {
                before: pair[0].value,
                after: pair[1].value,
                to_quiet: pair[1].quiet(),
            })
            .collect()
    }
}

impl Bifurcation {
    /// What happens, in one sentence a direction and one for both.
    pub fn sentence(&self, study: &Study) -> String {
        let value = |value: f64| number(study, self.varied.unit, value);
        let path = &self.varied.path;
        let mut sentences: Vec<String> = Vec::new();
        for branch in &self.branches {
            let way = branch.direction.name();
            let (Some(first), Some(last)) = (branch.points.first(), branch.points.last()) else {
                continue;
            };
            let quiet = |point: &Point| if point.quiet() { "quiet" } else { "not quiet" };
            let mut parts = vec![format!(
                "Sweeping {path} {way}, the response is {} at {}",
                quiet(first),
                value(first.value)
            )];
            for jump in branch.jumps() {
                let word = if jump.to_quiet { "falls silent" } else { "is lost" };
                parts.push(format!(
                    "{word} between {} and {}",
                    value(jump.before),
                    value(jump.after)
                ));
            }
            parts.push(format!("ends {} at {}", quiet(last), value(last.value)));
            sentences.push(format!("{}.", parts.join(", ")));
        }
        if self.branches.len() == 2 {
            sentences.push(match self.hysteresis.as_slice() {
                [] => "Both directions show the same responses: no hysteresis.".to_owned(),
                stretches => {
                    let parts: Vec<String> = stretches
                        .iter()
                        .map(|(from, to)| format!("from {} to {}", value(*from), value(*to)))
                        .collect();
                    format!("Up and down differ {}: responses coexist there.", parts.join(" and "))
                }
            });
        }
        sentences.join(" ")
    }

    /// Points that have not settled, in words.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        for branch in &self.branches {
            for point in &branch.points {
                if let Err(why) = &point.response {
                    warnings.push(format!(
                        "{} at {} = {} has not settled after {} periods: {}",
                        branch.direction.name(),
                        self.varied.path,
                        point.value,
                        point.periods,
                        why.about()
                    ));
                }
            }
        }
        warnings
    }

    /// As JSON.
    pub fn json(&self, study: &Study) -> Json {
        let scales = study.scales();
        let mut fields = Fields::new(scales);
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("protocol", "the state is carried over from value to value; up first, then down from where that ended")
            .plain("parameter", self.varied.path.as_str())
            .plain("unit", self.varied.unit)
            .plain("start", start_in_words(study));
        for branch in &self.branches {
            let points = branch.points.iter().map(|point| {
                let mut inner = Fields::new(scales);
                inner.plain("value", point.value);
                match &point.local {
                    Ok(verdict) => inner.plain("local_verdict", verdict.name()),
                    Err(why) => {
                        inner.plain("local_verdict", Json::Null).why("local_verdict", why.as_str())
                    }
                };
                inner.plain("settled", point.response.is_ok());
                inner.plain("periods_to_settle", point.periods);
                match &point.response {
                    Ok(attractor) => {
                        inner.plain("words", words(attractor, point.period));
                        put(&mut inner, attractor, point.period);
                        put_section(&mut inner, attractor);
                    }
                    Err(why) => {
                        inner.plain("kind", Json::Null).why("kind", why.about());
                    }
                }
                inner
            });
            fields.list(branch.direction.name(), points);
        }
        let jumps = self.branches.iter().flat_map(|branch| {
            branch.jumps().into_iter().map(|jump| {
                let mut inner = Fields::new(scales);
                inner
                    .plain("direction", branch.direction.name())
                    .plain("before", jump.before)
                    .plain("after", jump.after)
                    .plain("becomes", if jump.to_quiet { "quiet" } else { "not quiet" });
                inner
            })
        });
        fields.list("jumps", jumps);
        if self.branches.len() == 2 {
            let pairs: Vec<Json> =
                self.hysteresis.iter().map(|(from, to)| vec![*from, *to].into()).collect();
            fields.plain("hysteresis", pairs);
        } else {
            let fields = fields.plain("hysteresis", Json::Null);
            fields.why("hysteresis", "it takes both directions to show it");
        }
        fields.plain("warnings", self.warnings());
        fields.finish()
    }

    /// One row for each state of the section of each point.
    pub fn dataset(&self, study: &Study) -> Dataset {
        let mut numbers: [Vec<f64>; 12] = Default::default();
        let mut codes: [Vec<u8>; 4] = Default::default();
        for branch in &self.branches {
            for point in &branch.points {
                let attractor = point.response.as_ref().ok();
                let none = [(f64::NAN, f64::NAN)];
                let section = attractor.map_or(&none[..], |it| it.section.as_slice());
                let rotation = attractor.and_then(|it| it.rotation);
                let ratio = rotation.and_then(|it| it.ratio);
                let of = |value: Option<f64>| value.unwrap_or(f64::NAN);
                for (x, v) in section {
                    let row = [
                        point.value,
                        *x,
                        *v,
                        of(attractor.map(Attractor::size)),
                        of(attractor.map(|it| it.stick_fraction)),
                        of(attractor.and_then(periods)),
                        of(rotation.map(|it| it.turns_per_period)),
                        of(rotation.map(|it| it.error)),
                        of(ratio.map(|it| it.turns as f64)),
                        of(ratio.map(|it| f64::from(it.periods))),
                        of(attractor.and_then(|it| it.frequency(point.period))),
                        point.periods as f64,
                    ];
                    numbers.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
                    let code = [
                        u8::from(branch.direction == Direction::Down),
                        kind_code(attractor),
                        u8::from(point.quiet()),
                        verdict_code(&point.local),
                    ];
                    codes.iter_mut().zip(code).for_each(|(column, code)| column.push(code));
                }
            }
        }
        let rows: Vec<f64> = (0..numbers[0].len()).map(|row| row as f64).collect();
        let [value, x, v, size, stick, periods, turns, error, p, q, frequency, settle] = numbers;
        let [direction, kind, quiet, local] = codes;
        Dataset::new(study, "bifurcation")
            .fact(format!(
                "sweep of {}, the state carried over; {}",
                self.varied.path,
                start_in_words(study)
            ))
            .with_axis(Array::new("row", "1", rows))
            .with(Array::of_words("direction", vec![(0, "up"), (1, "down")], &direction))
            .with(Array::new(self.varied.name(), self.varied.unit, value))
            .with(Array::of_words("kind", KINDS.to_vec(), &kind))
            .with(Array::of_words("quiet", vec![(0, "no"), (1, "yes")], &quiet))
            .with(Array::of_words("local_verdict", VERDICTS.to_vec(), &local))
            .array("section_displacement", Quantity::Displacement, x)
            .array("section_velocity", Quantity::Velocity, v)
            .array("peak_to_peak", Quantity::Displacement, size)
            .array("stick_fraction", Quantity::Ratio, stick)
            .array("periods", Quantity::Count, periods)
            .array("rotation_number", Quantity::Ratio, turns)
            .array("rotation_error", Quantity::Ratio, error)
            .array("locking_turns", Quantity::Count, p)
            .array("locking_periods", Quantity::Count, q)
            .array("frequency", Quantity::FrequencyRatio, frequency)
            .array("periods_to_settle", Quantity::Count, settle)
    }
}

/// Periods of a closed orbit.
fn periods(attractor: &Attractor) -> Option<f64> {
    match attractor.kind {
        quell_belt::attractor::Kind::Periodic { periods, .. } => Some(f64::from(periods)),
        _ => None,
    }
}
