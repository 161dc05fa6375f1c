//! Sweeps of a system in sentences, JSON and a dataset.

use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::attractor::{KINDS, SystemAttractor};
use super::bifurcation::{MOST_PERIODS_OF_A_VALUE, SystemBifurcation, SystemSweepPoint};
use crate::dataset::{Array, Dataset};
use crate::fields::Fields;
use crate::run::bifurcation::SweepDirection;
use crate::study::SystemStudy;
use crate::words::digits;

/// Words of the column `local_verdict`.
const VERDICTS: [(u8, &str); 4] =
    [(0, "stable"), (1, "unstable"), (2, "undecided"), (3, "unknown")];

/// The motion of a point in words.
pub fn words(point: &SystemSweepPoint) -> String {
    point.attractor().map_or_else(|| "unknown".to_owned(), SystemAttractor::words)
}

impl SystemBifurcation {
    /// A value of the parameter with its unit.
    fn value(&self, study: &SystemStudy, value: f64) -> String {
        let unit = study.unit_of(&self.range.parameter).filter(|unit| *unit != "1");
        format!("{}{}", digits(value), unit.map_or(String::new(), |unit| format!(" {unit}")))
    }

    /// One sentence for each direction and one that compares both.
    pub fn sentence(&self, study: &SystemStudy) -> String {
        let path = &self.range.parameter;
        let mut sentences: Vec<String> = Vec::new();
        for branch in &self.branches {
            let way = branch.direction.name();
            let (Some(first), Some(last)) = (branch.points.first(), branch.points.last()) else {
                continue;
            };
            let mut parts = vec![format!(
                "Sweeping {path} {way}, the motion is {} at {}",
                words(first),
                self.value(study, first.value)
            )];
            let quiet = |point: &SystemSweepPoint| point.attractor().map(SystemAttractor::is_quiet);
            for pair in branch.points.windows(2) {
                let (Some(before), Some(after)) = (quiet(&pair[0]), quiet(&pair[1])) else {
                    continue;
                };
                if before != after {
                    let verb = if after { "falls into step with the dither" } else { "leaves it" };
                    let ends = [&pair[0], &pair[1]].map(|point| self.value(study, point.value));
                    parts.push(format!("{verb} between {} and {}", ends[0], ends[1]));
                }
            }
            let end = self.value(study, last.value);
            sentences.push(format!("{}, and is {} at {end}.", parts.join(", "), words(last)));
        }
        if self.branches.len() == 2 {
            let ranges = self.hysteresis.iter().map(|(from, to)| {
                format!("from {} to {}", self.value(study, *from), self.value(study, *to))
            });
            let ranges: Vec<String> = ranges.collect();
            sentences.push(if ranges.is_empty() {
                "Both directions show motions of the same size: no hysteresis.".to_owned()
            } else {
                format!(
                    "The two directions differ {}, where motions coexist.",
                    ranges.join(" and ")
                )
            });
        }
        sentences.join(" ")
    }

    /// Warnings: those of the study, and values at which the motion is unknown.
    pub fn warnings(&self, study: &SystemStudy) -> Vec<String> {
        let mut warnings = study.warnings().to_vec();
        for branch in &self.branches {
            for point in &branch.points {
                if let Err(why) = &point.end {
                    let (path, value) = (&self.range.parameter, self.value(study, point.value));
                    let way = branch.direction.name();
                    warnings.push(format!(
                        "sweeping {way}, the motion at {path} = {value} is unknown: {why}"
                    ));
                }
            }
        }
        warnings
    }

    /// As JSON.
    pub fn json(&self, study: &SystemStudy) -> Json {
        let mut fields = Fields::of_system(study.units());
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("protocol", "the state is carried over from value to value; upward first, then downward from the final state")
            .plain("parameter", self.range.parameter.clone())
            .plain("unit", study.unit_of(&self.range.parameter).unwrap_or("1"))
            .plain("start", self.start.clone())
            .plain("most_periods", MOST_PERIODS_OF_A_VALUE);
        for branch in &self.branches {
            let points = branch.points.iter().map(|point| put(study, point));
            fields.list(branch.direction.name(), points);
        }
        if self.branches.len() == 2 {
            let pairs: Vec<Json> =
                self.hysteresis.iter().map(|(from, to)| vec![*from, *to].into()).collect();
            fields.plain("hysteresis", pairs);
        } else {
            fields.unknown("hysteresis", "hysteresis requires sweeps in both directions");
        }
        fields.plain("warnings", self.warnings(study));
        fields.finish()
    }

    /// One row for each state of the section of each point.
    pub fn dataset(&self, study: &SystemStudy) -> Dataset {
        let mut columns: [Vec<f64>; 5] = Default::default();
        let mut codes: [Vec<u8>; 3] = Default::default();
        for branch in &self.branches {
            for point in &branch.points {
                let attractor = point.attractor();
                let section = attractor.map_or(&[f64::NAN][..], |attractor| &attractor.section);
                let size = attractor.map_or(f64::NAN, SystemAttractor::size);
                let settle = point.end.as_ref().map_or(f64::NAN, |end| f64::from(end.periods));
                for (number, observed) in section.iter().enumerate() {
                    let row = [point.value, number as f64, *observed, size, settle];
                    columns.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
                    let code = [
                        u8::from(branch.direction == SweepDirection::Down),
                        attractor.map_or(5, SystemAttractor::kind_code),
                        verdict_code(&point.local),
                    ];
                    codes.iter_mut().zip(code).for_each(|(column, code)| column.push(code));
                }
            }
        }
        let rows: Vec<f64> = (0..columns[0].len()).map(|row| row as f64).collect();
        let [value, number, observed, size, settle] = columns;
        let [direction, kind, local] = codes;
        let length = study.units().unit(Quantity::Displacement).unwrap_or("1");
        let unit = study.unit_of(&self.range.parameter).unwrap_or("1");
        Dataset::of(&study.into(), "bifurcation")
            .fact(format!(
                "sweep of {}, the state carried over; {}",
                self.range.parameter, self.start
            ))
            .with_axis(Array::new("row", "1", rows))
            .with(Array::of_words("direction", vec![(0, "up"), (1, "down")], &direction))
            .with(Array::new("parameter", unit, value))
            .with(Array::of_words("kind", KINDS.to_vec(), &kind))
            .with(Array::of_words("local_verdict", VERDICTS.to_vec(), &local))
            .with(Array::new("state_of_section", "1", number))
            .with(Array::new("section_displacement", length, observed))
            .with(Array::new("peak_to_peak", length, size))
            .with(Array::new("periods_to_settle", "1", settle))
    }
}

fn verdict_code(local: &Result<&'static str, String>) -> u8 {
    let word = local.as_ref().map_or("unknown", |word| *word);
    VERDICTS.iter().find(|(_, known)| *known == word).map_or(3, |(code, _)| *code)
}

fn put(study: &SystemStudy, point: &SystemSweepPoint) -> Fields {
    let mut fields = Fields::of_system(study.units());
    fields.plain("value", point.value);
    match &point.local {
        Ok(verdict) => fields.plain("local_verdict", *verdict),
        Err(why) => fields.unknown("local_verdict", why.as_str()),
    };
    match &point.end {
        Ok(end) => {
            fields.plain("periods_to_settle", end.periods);
            end.attractor.put(&mut fields, study);
        }
        Err(why) => {
            fields.unknown("kind", why.as_str());
        }
    }
    fields
}
