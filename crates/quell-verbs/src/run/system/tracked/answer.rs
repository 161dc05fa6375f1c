//! Eigenvalues followed over a parameter as sentence, JSON and datasets.

use quell_linear::growth::Verdict;
use quell_linear::tracking::{StabilityChange, ThresholdOfStability};
use quell_model::units::Quantity;
use quell_numerics::interval::RealInterval;
use serde_json::{Value as Json, json};

use super::{StabilityCurve, SurfaceAtRest, TrackRequest, TrackedStability};
use crate::dataset::{Array, Dataset};
use crate::fields::Fields;
use crate::run::criticality::{self, FoundLyapunov};
use crate::run::system::{oscillating, value_at};
use crate::study::{SystemStudy, UnitSystem};
use crate::words::{digits, plural, quantity_at, quantity_is};

impl TrackedStability {
    /// The protocol of the verdicts.
    pub fn protocol(&self) -> &'static str {
        if self.averaged { "averaged" } else { "linearised" }
    }

    /// The answer in one or two sentences.
    pub fn sentence(&self, study: &SystemStudy) -> String {
        let TrackRequest { parameter, window: RealInterval { lower: from, upper: to }, .. } =
            &self.request;
        let changes: Vec<String> = self
            .tracked
            .thresholds
            .iter()
            .zip(&self.first_lyapunov)
            .filter(|(found, _)| found.verdicts[0] != found.verdicts[1])
            .map(|(found, first_lyapunov)| {
                let motion = oscillating(study.units(), found.eigenvalue.im.abs());
                let how = match found.change {
                    StabilityChange::Hopf if found.verdicts[1] == Verdict::Stable => {
                        format!("where a motion {motion} ceases to grow")
                    }
                    StabilityChange::Hopf => format!("where a motion {motion} begins to grow"),
                    StabilityChange::Divergence => "by divergence, without oscillation".to_owned(),
                    StabilityChange::Coalescence => format!("where two motions {motion} merge"),
                    StabilityChange::Jump => "by a jump".to_owned(),
                };
                let at = self.value(study, found.value);
                let clause = criticality::clause(first_lyapunov, " (", ")");
                format!(
                    "{} at the {}, {how}{clause}",
                    found.verdicts[1].name(),
                    quantity_is(parameter, &at)
                )
            })
            .collect();
        let by = if self.averaged { "By averaging, steady" } else { "Steady" };
        let opening = self.contacts[0].opening(study.system());
        let condition = match opening.as_slice() {
            [] => String::new(),
            [name] => format!(" This holds only where contact {name} stays closed."),
            names => {
                format!(" This holds only where contacts {} stay closed.", names.join(" and "))
            }
        };
        let sentence = if changes.is_empty() {
            let known = self.verdicts().into_iter().map(|(verdict, from, to)| {
                let to = self.value(study, to);
                format!(
                    "{verdict} for the {} from {} to {to}",
                    quantity_at(parameter),
                    digits(from)
                )
            });
            let known = known.collect::<Vec<_>>().join(", ");
            let unknown = if self.tracked.unknown.is_empty() {
                "no threshold was found".to_owned()
            } else {
                let to = self.value(study, *to);
                format!("elsewhere between {} and {to} there is no answer", digits(*from))
            };
            format!("{by} sliding is {known}; {unknown}.")
        } else {
            format!("{by} sliding becomes {}.", changes.join("; it becomes "))
        };
        sentence + &condition
    }

    /// The number of curves, and where a surface reverses.
    pub fn notes(&self, study: &SystemStudy) -> Vec<String> {
        let count = self.curves.len();
        let curves = format!("Found {count} curve{} of thresholds.", plural(count));
        let path = &self.request.parameter;
        let rests = self.rests.iter().map(|SurfaceAtRest { value, contact }| {
            let value = self.value(study, *value);
            format!(
                "At the {} contact {contact} comes to rest: its surface reverses, and there is no steady sliding.",
                quantity_is(path, &value)
            )
        });
        (count > 0).then_some(curves).into_iter().chain(rests).collect()
    }

    /// The verdicts over the window, each with its first and last value; a single value in between is not listed.
    fn verdicts(&self) -> Vec<(&'static str, f64, f64)> {
        let mut ranges: Vec<(&'static str, f64, f64)> = Vec::new();
        for point in self.tracked.pieces.iter().flatten() {
            let verdict = point.growth.verdict().name();
            match ranges.last_mut() {
                Some((before, _, to)) if *before == verdict => *to = point.value,
                _ => ranges.push((verdict, point.value, point.value)),
            }
        }
        if ranges.len() > 1 {
            ranges.retain(|(_, from, to)| from < to);
        }
        ranges
    }

    /// A value of the parameter with its unit.
    pub(crate) fn value(&self, study: &SystemStudy, value: f64) -> String {
        value_at(study, &self.request.parameter, value)
    }

    /// As JSON.
    pub fn json(&self, study: &SystemStudy) -> Json {
        let mut fields = Fields::in_units(study.units());
        let TrackRequest { parameter, window: RealInterval { lower: from, upper: to }, along } =
            &self.request;
        let unit = study.unit_of(parameter).unwrap_or("1");
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("protocol", self.protocol())
            .plain("parameter", parameter.clone())
            .measured("from", unit, *from)
            .measured("to", unit, *to);
        let points: usize = self.tracked.pieces.iter().map(Vec::len).sum();
        fields.plain("points", points);
        fields.plain("covered", self.is_covered()).plain("resumes", self.resumes());
        fields.nested("at_from", self.at_from(study));
        let found = self.tracked.thresholds.iter().zip(&self.first_lyapunov);
        let found = found.map(|(found, first_lyapunov)| put(study, unit, found, first_lyapunov));
        let found: Vec<Fields> = found.collect();
        // The name of the list in the answer about a belt, and that of a system.
        fields.list("local", found.clone()).list("thresholds", found);
        if let Some((path, RealInterval { lower: first, upper: last })) = along {
            let other = study.unit_of(path).unwrap_or("1");
            fields.plain("along", path.clone()).measured("between", other, vec![*first, *last]);
            let curves = self.curves.iter().map(|curve| put_curve(study, [unit, other], curve));
            fields.list("curves", curves.collect::<Vec<_>>());
        }
        let rests = self.rests.iter().map(|SurfaceAtRest { value, contact }| {
            let mut inner = Fields::in_units(study.units());
            inner.measured("value", unit, *value).plain("contact", contact.clone());
            inner
        });
        fields.list("rests", rests);
        let unknown = self.tracked.unknown.iter();
        let unknown = unknown.map(
            |range| json!({ "from": range.from, "to": range.to, "why": range.why.to_string() }),
        );
        fields.plain("unknown", unknown.collect::<Vec<Json>>());
        fields.plain("warnings", self.warnings(study));
        fields.finish()
    }

    /// Whether every value has an answer and every close approach of two eigenvalues was examined.
    fn is_covered(&self) -> bool {
        self.tracked.unknown.is_empty() && self.tracked.unexamined == 0
    }

    /// Whether there is an answer at the last value again, after a range without one.
    fn resumes(&self) -> bool {
        let last = self.tracked.pieces.last().and_then(|piece| piece.last());
        let reached = last.is_some_and(|point| point.value >= self.request.window.upper);
        reached && !self.tracked.unknown.is_empty()
    }

    /// The verdict at the first value of the window.
    fn at_from(&self, study: &SystemStudy) -> Fields {
        let mut fields = Fields::in_units(study.units());
        let from = self.request.window.lower;
        let first = self.tracked.pieces.first().and_then(|piece| piece.first());
        match (first, self.tracked.unknown.first()) {
            (Some(point), _) if point.value <= from => {
                fields.plain("steady_sliding", point.growth.verdict().name());
            }
            (_, Some(range)) => {
                fields.unknown("steady_sliding", range.why.clone());
            }
            _ => {
                fields.unknown("steady_sliding", "the eigenvalues are not known there");
            }
        }
        fields
    }

    /// Warnings: those of the study, ranges without an answer, and approaches that were not examined.
    fn warnings(&self, study: &SystemStudy) -> Vec<String> {
        let unknown = self.tracked.unknown.iter().map(|range| {
            let path = &self.request.parameter;
            let to = self.value(study, range.to);
            if range.from == range.to {
                format!("at the {} there is no answer: {}", quantity_is(path, &to), range.why)
            } else {
                let from = digits(range.from);
                format!(
                    "for the {} from {from} to {to} there is no answer: {}",
                    quantity_at(path),
                    range.why
                )
            }
        });
        let unexamined = Some(self.tracked.unexamined).filter(|count| *count > 0).map(|count| {
            format!(
                "{count} close approach{} of two eigenvalues could not be examined, where pairs of thresholds may be missing: \
                 try a narrower window",
                if count == 1 { "" } else { "es" }
            )
        });
        let TrackRequest { parameter, along, .. } = &self.request;
        let [own, of_curves] = &self.contacts;
        let own = own.warnings(study, |range| between(study, parameter, range));
        let along = along.as_ref().map_or("", |(path, _)| path.as_str());
        let of_curves = of_curves.warnings(study, |range| {
            format!("on lines {} of the second parameter", between(study, along, range))
        });
        let listed = study.warnings().iter().cloned().chain(unknown).chain(unexamined);
        listed.chain(own).chain(of_curves).collect()
    }

    /// Growth rate and frequency of every branch over the parameter.
    pub fn dataset(&self, study: &SystemStudy) -> Dataset {
        let points: Vec<_> = self.tracked.pieces.iter().flatten().collect();
        let branches = points.first().map_or(0, |point| point.eigenvalues.len());
        let values = points.iter().map(|point| point.value).collect();
        let every = |pick: fn(&num_complex::Complex64) -> f64| -> Vec<f64> {
            points.iter().flat_map(|point| point.eigenvalues.iter().map(pick)).collect()
        };
        let parameter = &self.request.parameter;
        let branches = (0..branches).map(|index| index as f64).collect();
        let frequency = study.units().unit(Quantity::FrequencyRatio).unwrap_or("1");
        let rate = if study.units() == UnitSystem::None { "1" } else { "1/s" };
        Dataset::of(&study.into(), "stability")
            .fact(format!("parameter: {parameter}"))
            .with_axis(Array::new("parameter", study.unit_of(parameter).unwrap_or("1"), values))
            .with_axis(Array::new("branch", "1", branches))
            .with(Array::new("growth_rate", rate, every(|z| z.re)))
            .with(Array::new("frequency", frequency, every(|z| z.im)))
    }

    /// The curves along the second parameter, one row per point; `None` without one.
    pub fn dataset_of_curves(&self, study: &SystemStudy) -> Option<Dataset> {
        let (path, _) = self.request.along.as_ref()?;
        let parameter = &self.request.parameter;
        let points = || {
            let curves = self.curves.iter().enumerate();
            curves.flat_map(|(curve, all)| all.points.iter().map(move |point| (curve, point)))
        };
        let numbered = || (0_u8..).zip(StabilityChange::ALL);
        let code = |change: StabilityChange| numbered().find(|(_, other)| *other == change);
        let codes: Vec<u8> = points()
            .filter_map(|(_, (_, found))| code(found.change))
            .map(|(code, _)| code)
            .collect();
        let names = numbered().map(|(code, change)| (code, change.name())).collect();
        let rows = (0..points().count()).map(|index| index as f64).collect();
        let curves = points().map(|(curve, _)| curve as f64).collect();
        let unit = |path: &str| study.unit_of(path).unwrap_or("1");
        let along = points().map(|(_, (at, _))| *at).collect();
        let values = points().map(|(_, (_, found))| found.value).collect();
        let dataset = Dataset::of(&study.into(), "stability")
            .fact(self.sentence(study))
            .with_axis(Array::new("point", "1", rows))
            .with(Array::new("curve", "1", curves))
            .with(Array::of_words("kind", names, &codes))
            .with(Array::new(path.as_str(), unit(path), along))
            .with(Array::new(parameter.as_str(), unit(parameter), values));
        Some(dataset)
    }
}

/// A range of a parameter in words.
fn between(
    study: &SystemStudy,
    path: &str,
    RealInterval { lower: from, upper: to }: RealInterval,
) -> String {
    let to_in_words = value_at(study, path, to);
    if from == to {
        return format!("at the {}", quantity_is(path, &to_in_words));
    }
    format!("for the {} from {} to {to_in_words}", quantity_at(path), digits(from))
}

/// One threshold; `unit` is that of the parameter.
fn put(
    study: &SystemStudy,
    unit: &str,
    found: &ThresholdOfStability,
    first_lyapunov: &FoundLyapunov,
) -> Fields {
    let mut fields = Fields::in_units(study.units());
    fields
        .measured("value", unit, found.value)
        .measured("error", unit, found.error)
        .plain("kind", found.change.name())
        .number("frequency", Quantity::FrequencyRatio, found.eigenvalue.im.abs())
        .plain("was", found.verdicts[0].name())
        .plain("becomes", found.verdicts[1].name());
    let length = study.units().unit(Quantity::Displacement).unwrap_or("1");
    criticality::put(&mut fields, length, first_lyapunov);
    fields
}

/// One curve: its points as columns. The kind and the verdicts are those of all its points.
fn put_curve(study: &SystemStudy, [unit, along]: [&str; 2], curve: &StabilityCurve) -> Fields {
    let column = |of: &dyn Fn(&ThresholdOfStability) -> f64| -> Vec<f64> {
        curve.points.iter().map(|(_, found)| of(found)).collect()
    };
    let mut fields = Fields::in_units(study.units());
    if let Some((_, first)) = curve.points.first() {
        fields
            .plain("kind", first.change.name())
            .plain("was", first.verdicts[0].name())
            .plain("becomes", first.verdicts[1].name());
    }
    let positions: Vec<f64> = curve.points.iter().map(|(at, _)| *at).collect();
    let frequencies = column(&|found| found.eigenvalue.im.abs());
    fields
        .measured("value", unit, column(&|found| found.value))
        .measured("along", along, positions)
        .measured("error", unit, column(&|found| found.error))
        .numbers("frequency", Quantity::FrequencyRatio, &frequencies);
    criticality::put_criticalities(&mut fields, &curve.first_lyapunov);
    fields
}
