//! A friction law as text and fields: its numbers, its formula, the error of its fit.

use quell_model::Friction;
use quell_model::friction::samples::Fit;
use quell_model::parameter::COEFFICIENT;
use quell_model::units::Quantity;
use quell_numerics::interval::RealInterval;
use serde_json::{Map, Value as Json};

use crate::fields::Fields;

/// A law under a load as an object; `empty` are fields in the units of the study.
pub(super) fn fields(law: &Friction, load: f64, empty: &dyn Fn() -> Fields) -> Fields {
    let mut fields = empty();
    fields.plain("law", law.kind().name());
    for (parameter, value) in law.kind().parameters().iter().zip(law.values()) {
        fields.number(parameter.key(), parameter.quantity, value);
    }
    match law {
        Friction::Expression(own) => {
            let constants: Map<String, Json> =
                own.named().map(|(name, value)| (name.to_owned(), value.into())).collect();
            fields.plain("coefficient", own.text()).plain("constants", constants).number(
                "coefficient_at_rest",
                Quantity::Ratio,
                law.coefficient(0.0),
            );
        }
        Friction::Samples(own) => {
            let unit = own.curve().velocity_unit();
            let fit = own.fit();
            let mut inner = empty();
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
                .number("slip_velocity_from", Quantity::Velocity, fit.range.lower * unit)
                .number("slip_velocity_to", Quantity::Velocity, fit.range.upper * unit);
            fields.nested("fit", inner);
        }
        // A level at which sliding friction is constant is a force.
        _ => {
            if let Some(level) = law.get(COEFFICIENT.path) {
                fields.number("friction_force", Quantity::Force, level * load).number(
                    "static_friction_force",
                    Quantity::Force,
                    law.static_coefficient() * load,
                );
            }
        }
    }
    if let Some(range) = law.range() {
        fields
            .number("range_from", Quantity::Velocity, range.lower)
            .number("range_to", Quantity::Velocity, range.upper)
            .plain("range_limit", range.limit.to_string());
    }
    fields
}

/// Further facts about a law besides its numbers, as label and text; `speed` writes a slip velocity.
pub fn words(law: &Friction, speed: &dyn Fn(f64) -> String) -> Vec<(String, String)> {
    let range = law.range().map(|range| {
        let words =
            format!("slip from {} to {}: {}", speed(range.lower), speed(range.upper), range.limit);
        ("  range".to_owned(), words)
    });
    of_own_law(law, speed).into_iter().chain(range).collect()
}

/// Further facts about a user-defined law; none for other laws.
fn of_own_law(law: &Friction, speed: &dyn Fn(f64) -> String) -> Vec<(String, String)> {
    let row = |label: &str, words: String| (label.to_owned(), words);
    match law {
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
            let RealInterval { lower: from, upper: to } = fit.range;
            vec![
                row(
                    "samples",
                    format!("{} from {} to {}", fit.samples, speed(from * unit), speed(to * unit)),
                ),
                row("  fit μ(v)", fit.formula()),
                row("  error of the fit", error(fit)),
            ]
        }
        _ => Vec::new(),
    }
}

fn error(fit: &Fit) -> String {
    let pinned = if fit.pinned { ", fixed to the static coefficient at v = 0" } else { "" };
    format!(
        "{:.2e} at most, {:.2e} rms, {:.2e} rms at left-out samples{pinned}",
        fit.largest_error, fit.rms_error, fit.left_out_error
    )
}
