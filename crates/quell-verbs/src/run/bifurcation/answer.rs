//! Sweeps in sentences, JSON and a dataset.

use quell_dynamics::attractor::{MotionKind, SystemAttractor};
use quell_dynamics::orbit::MOST_PERIODS;
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::shared::{changes, hysteresis_sentence, jump, put_comparison};
use super::{Bifurcation, SweepDirection, SweepPoint};
use crate::dataset::{Array, Dataset};
use crate::fields::Fields;
use crate::run::system::attractor::{
    VERDICTS, in_words, put_attractor, section_rates, verdict_code,
};
use crate::run::system::of_runs::beyond_laws;
use crate::run::system::value_at;
use crate::study::SystemStudy;
use crate::words::{quantity_at, quantity_is};

/// The motion of a point in words.
pub fn words(study: &SystemStudy, point: &SweepPoint) -> String {
    let attractor = point.attractor();
    attractor.map_or_else(|| "unknown".to_owned(), |attractor| in_words(attractor, study.units()))
}

/// The same as a sentence has it.
fn briefly(study: &SystemStudy, point: &SweepPoint) -> String {
    match point.quiet() {
        Some(false) => "vibrating".to_owned(),
        Some(true) if point.is_dithered => "in step with the dither".to_owned(),
        Some(true) | None => words(study, point),
    }
}

impl Bifurcation {
    /// A value of the parameter with its unit.
    fn value(&self, study: &SystemStudy, value: f64) -> String {
        value_at(study, &self.range.parameter, value)
    }

    /// A sentence with both directions, and one that compares them.
    pub fn sentence(&self, study: &SystemStudy) -> String {
        let quantity = quantity_at(&self.range.parameter);
        let mut sentences: Vec<String> = Vec::new();
        for branch in &self.branches {
            let way = branch.direction.name();
            let (Some(first), Some(last)) = (branch.points.first(), branch.points.last()) else {
                continue;
            };
            let begins = if sentences.is_empty() {
                format!("Sweeping the {quantity} {way}")
            } else {
                format!("sweeping {way}")
            };
            let mut parts = vec![format!(
                "{begins}, the motion is {} at {}",
                briefly(study, first),
                self.value(study, first.value)
            )];
            for (before, after) in changes(branch.points.iter().map(SweepPoint::quiet)) {
                let (before, after) = (&branch.points[before], &branch.points[after]);
                let verb = match (after.quiet() == Some(true), after.is_dithered) {
                    (true, true) => "falls into step with the dither",
                    (true, false) => "comes to rest or to steady sliding",
                    (false, true) if before.is_dithered => "leaves it",
                    (false, _) => "begins to vibrate",
                };
                let ends = [before, after].map(|point| self.value(study, point.value));
                parts.push(format!("{verb} between {} and {}", ends[0], ends[1]));
            }
            let end = self.value(study, last.value);
            sentences.push(format!(
                "{}, and is {} at {end}",
                parts.join(", "),
                briefly(study, last)
            ));
        }
        let mut sentences = match sentences.as_slice() {
            [] => Vec::new(),
            some => vec![format!("{}.", some.join("; "))],
        };
        if self.branches.len() == 2 {
            let value = |value| self.value(study, value);
            let known = self.both_known();
            sentences.push(hysteresis_sentence(&self.hysteresis, &known, "motions", value));
        }
        sentences.join(" ")
    }

    /// Whether the motion of both directions is known, at each value.
    fn both_known(&self) -> Vec<bool> {
        let [up, down] = self.branches.as_slice() else { return Vec::new() };
        let pairs = up.points.iter().zip(down.points.iter().rev());
        pairs.map(|(one, other)| one.end.is_ok() && other.end.is_ok()).collect()
    }

    /// Warnings: those of the study, and values at which the motion is unknown.
    pub fn warnings(&self, study: &SystemStudy) -> Vec<String> {
        let mut warnings = study.warnings().to_vec();
        let attractors = || {
            let points = self.branches.iter().flat_map(|branch| &branch.points);
            points.filter_map(SweepPoint::attractor)
        };
        // The laws are those of the study: a law that is swept itself keeps the range of its study here.
        warnings.extend(beyond_laws(study, |contact| {
            attractors().map(|attractor| attractor.largest_slip[contact]).fold(0.0, f64::max)
        }));
        for branch in &self.branches {
            for point in &branch.points {
                if let Err(why) = &point.end {
                    let path = &self.range.parameter;
                    let value = self.value(study, point.value);
                    let way = branch.direction.name();
                    warnings.push(format!(
                        "sweeping {way}, the motion at the {} is unknown: {why}",
                        quantity_is(path, &value)
                    ));
                }
            }
        }
        warnings
    }

    /// As JSON.
    pub fn json(&self, study: &SystemStudy) -> Json {
        let mut fields = Fields::in_units(study.units());
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("protocol", "the state is carried over from value to value; upward first, then downward from the final state")
            .plain("parameter", self.range.parameter.clone())
            .plain("unit", study.unit_of(&self.range.parameter).unwrap_or("1"))
            .plain("start", self.start.clone())
            .plain("most_periods", MOST_PERIODS);
        for branch in &self.branches {
            let points = branch.points.iter().map(|point| put(study, point));
            fields.list(branch.direction.name(), points);
        }
        let jumps = self.branches.iter().flat_map(|branch| {
            let points = &branch.points;
            let all = changes(points.iter().map(SweepPoint::quiet)).into_iter();
            all.map(|(before, after)| {
                let ends = (points[before].value, points[after].value);
                let to_quiet = points[after].quiet() == Some(true);
                jump(Fields::in_units(study.units()), branch.direction, ends, to_quiet)
            })
        });
        let hysteresis = (self.branches.len() == 2).then_some(self.hysteresis.as_slice());
        put_comparison(&mut fields, jumps.collect(), hysteresis);
        fields.plain("warnings", self.warnings(study));
        fields.finish()
    }

    /// One row for each state of the section of each point.
    pub fn dataset(&self, study: &SystemStudy) -> Dataset {
        let mut columns: [Vec<f64>; 11] = Default::default();
        let mut codes: [Vec<u8>; 4] = Default::default();
        let contacts = &study.system().contacts;
        let mut stick: Vec<Vec<f64>> = vec![Vec::new(); contacts.len()];
        for branch in &self.branches {
            for point in &branch.points {
                let code = [
                    u8::from(branch.direction == SweepDirection::Down),
                    point.attractor().map_or(5, SystemAttractor::kind_code),
                    point.quiet().map_or(2, u8::from),
                    verdict_code(&point.local),
                ];
                for row in rows(study, point) {
                    columns.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
                    codes.iter_mut().zip(code).for_each(|(column, code)| column.push(code));
                    for (contact, column) in stick.iter_mut().enumerate() {
                        let share =
                            |attractor: &SystemAttractor| attractor.stick.get(contact).copied();
                        column.push(point.attractor().and_then(share).unwrap_or(f64::NAN));
                    }
                }
            }
        }
        let rows: Vec<f64> = (0..columns[0].len()).map(|row| row as f64).collect();
        let [value, x, v, size, periods, turns, error, p, q, slow, settle] = columns;
        let [direction, kind, quiet, local] = codes;
        let unit = study.unit_of(&self.range.parameter).unwrap_or("1");
        let dataset = Dataset::of(&study.into(), "bifurcation")
            .fact(format!(
                "sweep of {}, the state carried over; {}",
                self.range.parameter, self.start
            ))
            .with_axis(Array::new("row", "1", rows))
            .with(Array::of_words("direction", vec![(0, "up"), (1, "down")], &direction))
            .with(Array::new("parameter", unit, value))
            .with(Array::of_words("kind", SystemAttractor::KINDS.to_vec(), &kind))
            .with(Array::of_words("quiet", vec![(0, "no"), (1, "yes"), (2, "unknown")], &quiet))
            .with(Array::of_words("local_verdict", VERDICTS.to_vec(), &local))
            .array("section_displacement", Quantity::Displacement, x)
            .array("section_velocity", Quantity::Velocity, v)
            .array("peak_to_peak", Quantity::Displacement, size)
            .array("periods", Quantity::Count, periods)
            .array("rotation_number", Quantity::Ratio, turns)
            .array("rotation_error", Quantity::Ratio, error)
            .array("locking_turns", Quantity::Count, p)
            .array("locking_periods", Quantity::Count, q)
            .array("frequency", Quantity::FrequencyRatio, slow)
            .array("periods_to_settle", Quantity::Count, settle);
        contacts.iter().zip(stick).fold(dataset, |dataset, (contact, column)| {
            dataset.with(Array::new(format!("{}.stick_fraction", contact.name), "1", column))
        })
    }
}

/// The rows of a point: one for each state of its section, NaN where a number is not known.
fn rows(study: &SystemStudy, point: &SweepPoint) -> Vec<[f64; 11]> {
    let Some(attractor) = point.attractor() else {
        let mut row = [f64::NAN; 11];
        row[0] = point.value;
        return vec![row];
    };
    let of = |value: Option<f64>| value.unwrap_or(f64::NAN);
    let rotation = attractor.rotation;
    let ratio = rotation.and_then(|rotation| rotation.ratio);
    let periods = match attractor.kind {
        MotionKind::Periodic { periods, .. } => f64::from(periods),
        _ => f64::NAN,
    };
    let settle = point.end.as_ref().map_or(f64::NAN, |end| f64::from(end.periods));
    let rates = section_rates(attractor, study);
    let rate = |place: usize| of(rates.as_ref().and_then(|rates| rates.get(place).copied()));
    let states = attractor.section.iter().enumerate();
    let row = |(place, x): (usize, &f64)| {
        [
            point.value,
            *x,
            rate(place),
            attractor.size(),
            periods,
            of(rotation.map(|rotation| rotation.turns_per_period)),
            of(rotation.map(|rotation| rotation.error)),
            of(ratio.map(|ratio| ratio.turns as f64)),
            of(ratio.map(|ratio| f64::from(ratio.periods))),
            of(attractor.slow),
            settle,
        ]
    };
    states.map(row).collect()
}

fn put(study: &SystemStudy, point: &SweepPoint) -> Fields {
    let mut fields = Fields::in_units(study.units());
    fields.plain("value", point.value);
    match &point.local {
        Ok(verdict) => fields.plain("local_verdict", *verdict),
        Err(why) => fields.unknown("local_verdict", why),
    };
    match &point.end {
        Ok(end) => {
            fields.plain("periods_to_settle", end.periods);
            put_attractor(&mut fields, &end.attractor, study);
        }
        Err(why) => {
            fields.unknown("kind", why);
        }
    }
    fields
}
