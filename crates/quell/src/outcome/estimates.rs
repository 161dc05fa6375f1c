//! Estimates of a fit to a record: objects, rows and words, shared by the fits of decays and of studies.

use std::fmt::Write as _;

use quell_design::NoStandardError;
use serde_json::{Map, json};

use super::table::figure;
use quell_model::units::Quantity;

use crate::fields::Fields;
use crate::run::named_estimates::NamedEstimates;
use crate::words::{estimated, more_digits, quantity_at};

/// The parameters as an object, those for which `shown` holds.
pub(super) fn parameters(named: &NamedEstimates, shown: impl Fn(usize) -> bool) -> Fields {
    let mut inner = Fields::new();
    for place in (0..named.parameters.len()).filter(|place| shown(*place)) {
        let parameter = &named.parameters[place];
        let error = named.error(place);
        let mut object = Map::new();
        object.insert("value".to_owned(), named.value(place).into());
        object.insert("standard_error".to_owned(), error.ok().into());
        object.insert("fixed".to_owned(), (error == Err(NoStandardError::Fixed)).into());
        inner.measured(&parameter.name, &parameter.unit, object);
        if let Err(why) = error {
            inner.why(&format!("{}.standard_error", parameter.name), why);
        }
    }
    inner
}

/// Covariance, condition, residual and criterion.
pub(super) fn numbers(fields: &mut Fields, named: &NamedEstimates, unit: &str) {
    let (order, matrix) = named.covariance();
    let order: Vec<&str> =
        order.iter().map(|place| named.parameters[*place].name.as_str()).collect();
    fields.plain("covariance", json!({ "order": order, "matrix": matrix }));
    match named.estimates.condition {
        Some(condition) => fields.measured("condition", "1", condition),
        None => fields.unknown("condition", "the information matrix is singular"),
    };
    criteria(fields, named, unit);
    fields.plain("n", named.estimates.count);
}

/// Residual and criterion.
pub(super) fn criteria(fields: &mut Fields, named: &NamedEstimates, unit: &str) {
    fields
        .measured("residual", unit, named.estimates.residual())
        .known(
            "explained",
            Quantity::Ratio,
            named.estimates.explained.ok_or_else(|| "the record does not vary".to_owned()),
        )
        .measured("rss", format!("{unit}²").as_str(), named.estimates.rss)
        .plain("p", named.estimates.free);
    match named.estimates.aic() {
        Ok(aic) => fields.measured("aic", "1", aic),
        Err(why) => fields.unknown("aic", why),
    };
}

/// The share of the variance of a record that a model explains, as a percentage; `None` of a record that does not vary.
pub(super) fn explained_in_words(named: &NamedEstimates) -> Option<String> {
    let share = named.estimates.explained?;
    let percent = 100.0 * share;
    // A share that is not 1 is not printed as 100 %.
    let text = match more_digits(percent) {
        text if text == "100" && percent < 100.0 => "more than 99.9999".to_owned(),
        text => text.replacen('-', "−", 1),
    };
    Some(format!("{text} %"))
}

/// An Akaike weight; one that is not 1 is not printed as 1.
pub(super) fn weight_in_words(weight: f64) -> String {
    match quell_model::digits::digits(weight, 3) {
        text if text == "1" && weight < 1.0 => "more than 0.999".to_owned(),
        text => text,
    }
}

/// "damping ratio 0.01 ± 0.0002".
pub(super) fn in_words(named: &NamedEstimates, place: usize) -> String {
    let parameter = &named.parameters[place];
    let unit = match parameter.unit.as_str() {
        "1" => String::new(),
        unit => format!(" {unit}"),
    };
    let value = estimated(named.value(place), named.error(place).ok());
    format!("{} {value}{unit}", quantity_at(&parameter.name))
}

/// One row for each parameter.
pub(super) fn rows(named: &NamedEstimates, shown: impl Fn(usize) -> bool) -> String {
    let mut text = String::new();
    let places: Vec<usize> = (0..named.parameters.len()).filter(|place| shown(*place)).collect();
    let name = |place: &usize| named.parameters[*place].name.as_str();
    let width = places.iter().map(|place| name(place).chars().count()).max().unwrap_or(0);
    for place in &places {
        let known = match named.error(*place) {
            Ok(error) => format!("± {}", figure(error)),
            Err(why) => format!("({why})"),
        };
        let unit = named.parameters[*place].unit.as_str();
        let unit = if unit == "1" { String::new() } else { format!("  {unit}") };
        let value = figure(named.value(*place));
        let _ = writeln!(text, "  {:<width$}  {value:>12} {known}{unit}", name(place));
    }
    text
}
