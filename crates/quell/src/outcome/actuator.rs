//! `actuator`: where over frequency the actuator can give the dither that quenches.

use std::fmt::Write as _;

use quell_design::NoAnswer;
use quell_design::actuator::ActuatorAtFrequency;
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::Presented;
use super::table::{NumberColumns, figure, heading};
use crate::complaint::Failure;
use crate::dataset::{Array, Dataset};
use crate::picture;
use crate::plot::Figure;
use crate::run::actuator::ActuatorFound;
use crate::run::design::StudyWithDesign;
use crate::study::{SystemSetup, SystemStudy};

impl Presented<SystemSetup> for ActuatorFound {
    const NAME: &'static str = "actuator";
    const TITLED: bool = true;

    fn json(&self, study: &SystemStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn notes(&self, study: &SystemStudy) -> Vec<String> {
        self.notes(study)
    }

    fn table(&self, study: &SystemStudy) -> String {
        table(self, study)
    }

    fn datasets(&self, study: &SystemStudy) -> Vec<(&'static str, Dataset)> {
        let frequencies = self.coverage.points.iter().map(|point| point.frequency).collect();
        let unit = |quantity| study.units().unit(quantity).unwrap_or("1");
        let axis = Array::new("frequency", unit(Quantity::FrequencyRatio), frequencies);
        let dataset = Dataset::of(&study.into(), "actuator").fact(self.sentence(study));
        let columns = columns(self).into_iter();
        let dataset = columns.fold(dataset.with_axis(axis), |dataset, (name, quantity, values)| {
            dataset.with(Array::new(name, unit(quantity), values))
        });
        vec![("actuator", with_limits(dataset, self))]
    }

    fn figure(&self, study: &SystemStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::actuator(study, self)))
    }
}

/// Ends, changes, resonances and the largest margin.
fn table(found: &ActuatorFound, study: &SystemStudy) -> String {
    let unit = study.units().unit(Quantity::Force);
    let scale = study.frequency_scale();
    let headings = [
        heading(scale.noun, Some(scale.unit.trim()).filter(|unit| !unit.is_empty())),
        heading("largest force", unit),
        heading("needed force", unit),
        "margin".to_owned(),
    ];
    let (columns, line) = NumberColumns::under(&headings);
    let mut text = format!("{line}  {:<15}  at\n", "limit");
    let number = |value: Result<f64, NoAnswer>| value.map_or_else(|_| "unknown".to_owned(), figure);
    for (what, at) in &found.notable {
        let reach = at.reach();
        let margin = match at.margin() {
            Ok(margin) if margin.is_infinite() => "-".to_owned(),
            margin => number(margin),
        };
        let cells = [
            figure(scale.of(at.frequency)),
            number(reach.clone().map(|reach| reach.amplitude)),
            number(at.needed.clone()),
            margin,
        ];
        let limit = reach.map_or("unknown", |reach| reach.limit.name()).replace('_', " ");
        let _ = writeln!(text, "{}  {limit:<15}  {what}", columns.line(&cells));
    }
    text
}

/// The arrays over frequency: amplitudes, margin, slip velocities, and what the largest amplitude takes.
fn columns(found: &ActuatorFound) -> Vec<(String, Quantity, Vec<f64>)> {
    let slip_of = |contact: &str| {
        format!("slip_of_{}", contact.replace(|letter: char| !letter.is_alphanumeric(), "_"))
    };
    let column = |value: &dyn Fn(&ActuatorAtFrequency) -> Result<f64, NoAnswer>| -> Vec<f64> {
        let points = found.coverage.points.iter();
        points
            .map(|point| value(point).ok().filter(|v| v.is_finite()).unwrap_or(f64::NAN))
            .collect()
    };
    let largest = |point: &ActuatorAtFrequency| Ok(point.reach()?.amplitude);
    let at_largest = |point: &ActuatorAtFrequency| {
        Ok::<_, NoAnswer>(point.demand.as_ref().map_err(Clone::clone)?.at(largest(point)?))
    };
    let named = |name: &str, quantity, values| (name.to_owned(), quantity, values);
    let mut columns = vec![
        named("amplitude", Quantity::Force, column(&largest)),
        named("needed", Quantity::Force, column(&|point| point.needed.clone())),
        named("margin", Quantity::Ratio, column(&ActuatorAtFrequency::margin)),
        named("voltage", Quantity::Voltage, column(&|point| Ok(at_largest(point)?.voltage?.peak))),
        named("current", Quantity::Current, column(&|point| Ok(at_largest(point)?.current?.peak))),
        named(
            "stroke",
            Quantity::Displacement,
            column(&|point| Ok(at_largest(point)?.displacement.peak_to_peak)),
        ),
    ];
    for (place, (name, _)) in found.contacts.iter().enumerate() {
        let values = column(&|point| point.reached_slip(place));
        columns.push((slip_of(name), Quantity::Velocity, values));
    }
    columns
}

/// Adds the limit that binds.
fn with_limits(dataset: Dataset, found: &ActuatorFound) -> Dataset {
    let mut names: Vec<(u8, &'static str)> = vec![(0, "unknown")];
    let codes: Vec<u8> = found
        .coverage
        .points
        .iter()
        .map(|point| {
            let name = point.reach().map_or("unknown", |reach| reach.limit.name());
            if let Some((code, _)) = names.iter().find(|(_, known)| *known == name) {
                return *code;
            }
            let code = u8::try_from(names.len()).unwrap_or(0);
            names.push((code, name));
            code
        })
        .collect();
    dataset.with(Array::of_words("limit", names, &codes))
}
