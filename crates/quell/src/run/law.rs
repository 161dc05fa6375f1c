//! The friction law of a study as text and fields: its numbers, its formula, the error of its fit.

use quell_model::Friction;
use quell_model::friction::samples::Fit;
use quell_model::parameter::COEFFICIENT;
use quell_model::units::Quantity;
use serde_json::{Map, Value as Json};

use crate::fields::Fields;
use crate::study::BeltStudy;
use crate::words::in_words;

/// The law as an object.
pub(super) fn fields(study: &BeltStudy) -> Fields {
    let law = study.belt().friction();
    let mut fields = Fields::new(study.scales());
    fields.plain("law", law.kind().name());
    for (parameter, value) in law.kind().parameters().iter().zip(law.values()) {
        fields.number(parameter.key(), parameter.quantity, value);
    }
    match law {
        Friction::Expression(law) => {
            let constants: Map<String, Json> =
                law.named().map(|(name, value)| (name.to_owned(), value.into())).collect();
            fields.plain("coefficient", law.text()).plain("constants", constants).number(
                "coefficient_at_rest",
                Quantity::Ratio,
                study.belt().friction().coefficient(0.0),
            );
        }
        Friction::Samples(law) => {
            let unit = law.curve().velocity_unit();
            let fit = law.fit();
            let mut inner = Fields::new(study.scales());
            inner
                .plain("coefficient", fit.formula())
                .plain("terms", fit.terms.len())
                .plain("samples", fit.samples)
                .number("largest_error", Quantity::Ratio, fit.largest_error)
                .number("rms_error", Quantity::Ratio, fit.rms_error)
                .number("left_out_error", Quantity::Ratio, fit.left_out_error)
                .plain("held_at_static_coefficient", fit.pinned)
                .number("coefficient_at_rest", Quantity::Ratio, fit.start())
                .number("coefficient_far_out", Quantity::Ratio, fit.limit)
                .number("slip_velocity_from", Quantity::Velocity, fit.range.0 * unit)
                .number("slip_velocity_to", Quantity::Velocity, fit.range.1 * unit);
            let file = study.measured().and_then(|measured| measured.file.as_ref());
            if let Some(file) = file {
                fields.plain("file", file.clone());
            }
            fields.nested("fit", inner);
        }
        Friction::Coulomb(_) | Friction::StribeckExponential(_) | Friction::Lugre(_) => {
            let load = study.belt().normal_load();
            let level = law.get(COEFFICIENT.path).unwrap_or_default();
            fields.number("friction_force", Quantity::Force, level * load).number(
                "static_friction_force",
                Quantity::Force,
                law.static_coefficient() * load,
            );
        }
        Friction::Stribeck(_) | Friction::Decreasing(_) => {}
    }
    if let Some(range) = law.range() {
        fields
            .number("range_from", Quantity::Velocity, range.lower)
            .number("range_to", Quantity::Velocity, range.upper)
            .plain("range_limit", range.limit.to_string());
    }
    fields
}

/// Further facts about a law besides its numbers, as label and text.
pub fn words(study: &BeltStudy) -> Vec<(String, String)> {
    let range = study.belt().friction().range().map(|range| {
        let speed = |speed: f64| in_words(study, Quantity::Velocity, speed);
        let words =
            format!("slip from {} to {}: {}", speed(range.lower), speed(range.upper), range.limit);
        ("  range".to_owned(), words)
    });
    of_own_law(study).into_iter().chain(range).collect()
}

/// Further facts about a user-defined law; none for other laws.
fn of_own_law(study: &BeltStudy) -> Vec<(String, String)> {
    let row = |label: &str, words: String| (label.to_owned(), words);
    match study.belt().friction() {
        Friction::Expression(law) => {
            let mut rows = vec![row("coefficient μ(v)", law.text().to_owned())];
            rows.extend(
                law.named().map(|(name, value)| row(&format!("  {name}"), value.to_string())),
            );
            rows
        }
        Friction::Samples(law) => {
            let fit = law.fit();
            let unit = law.curve().velocity_unit();
            let speed = |speed: f64| in_words(study, Quantity::Velocity, speed * unit);
            let (from, to) = fit.range;
            vec![
                row("samples", format!("{} from {} to {}", fit.samples, speed(from), speed(to))),
                row("  fit μ(v)", fit.formula()),
                row("  error of the fit", error(fit)),
            ]
        }
        Friction::Stribeck(_)
        | Friction::Decreasing(_)
        | Friction::Coulomb(_)
        | Friction::StribeckExponential(_)
        | Friction::Lugre(_) => Vec::new(),
    }
}

fn error(fit: &Fit) -> String {
    let pinned = if fit.pinned { ", fixed to the static coefficient at v = 0" } else { "" };
    format!(
        "{:.2e} at most, {:.2e} rms, {:.2e} rms at left-out samples{pinned}",
        fit.largest_error, fit.rms_error, fit.left_out_error
    )
}
