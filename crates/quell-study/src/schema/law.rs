//! The schema of a friction law: one alternative a law.

use quell_model::LawKind;
use quell_model::friction::samples::FEWEST;
use quell_model::parameter::{Bounds, COEFFICIENT, Parameter};
use quell_model::units::Quantity;
use serde_json::{Map, Value as Json, json};

use super::object::object;
use super::table::{bounded, number_or_formula, one_of, property};
use crate::study::vocabulary::{Role, Section, law_keys};

/// The keys of friction that is given as a force.
pub(super) fn forces() -> impl Iterator<Item = &'static str> {
    law_keys()
        .filter(|key| matches!(key.role, Role::FrictionForce(..) | Role::Flag))
        .map(|key| key.name)
}

/// The table of a law.
pub(super) fn friction() -> Json {
    let laws: Vec<Json> = LawKind::ALL.iter().map(|law| one(*law)).collect();
    json!({ "description": Section::Friction.about(), "oneOf": laws })
}

fn one(law: LawKind) -> Json {
    let mut properties = Map::new();
    properties.insert("law".into(), json!({ "const": law.name(), "description": law.about() }));
    let numeric = LawKind::NUMERIC.contains(&law);
    let known = |parameter: Parameter| {
        let mut known = law.parameters().iter().chain(law.options());
        known.any(|known| known.path == parameter.path)
    };
    for key in law_keys() {
        let has = match key.role {
            Role::Coefficient => !numeric || known(COEFFICIENT),
            Role::FrictionForce(parameter, _) => numeric && known(parameter),
            Role::Flag => numeric,
            Role::Speeds { .. } | Role::Terms | Role::Text => law == LawKind::Samples,
            _ => key.parameter().is_some_and(known),
        };
        if has {
            properties.insert(key.name.to_owned(), text_or(property(key)));
        }
    }
    let mut relations = Vec::new();
    match law {
        LawKind::Expression => {
            properties["coefficient"] = json!({ "type": ["string", "number"] });
            properties.insert(
                "constants".into(),
                json!({
                    "type": "object",
                    "description": Section::Constants.about(),
                    "additionalProperties": { "anyOf": [{ "type": "number" }, { "type": "string" }] },
                }),
            );
            relations.push(json!({ "required": ["coefficient"] }));
        }
        LawKind::Samples => {
            let item = text_or(bounded(Bounds::NOT_NEGATIVE, Quantity::Ratio));
            properties["coefficient"] =
                json!({ "type": "array", "items": item, "minItems": FEWEST });
            relations.push(json!({ "oneOf": [
                { "required": ["file"] },
                { "required": ["slip_velocity", "coefficient"] },
                { "required": ["slip_velocity_m_per_s", "coefficient"] },
            ] }));
        }
        _ => {
            properties.extend(
                properties
                    .contains_key("coefficient")
                    .then(|| ("coefficient".to_owned(), number_or_formula(None))),
            );
            // A negative coefficient is that of a surface that moves in the other direction.
            let needed =
                law.parameters().iter().filter(|known| law.default_of(known.path).is_none());
            relations.extend(needed.map(|parameter| {
                let forces = law_keys().filter(|key| {
                    matches!(key.role, Role::FrictionForce(known, _) if known.path == parameter.path)
                });
                let keys: Vec<&str> = parameter.keys().chain(forces.map(|key| key.name)).collect();
                one_of(&keys)
            }));
        }
    }
    let mut whole = object(Section::Friction.about(), &properties, &["law"]);
    let levels: Vec<&str> = ["coefficient", "static_coefficient", "minimum_coefficient", "viscous"]
        .into_iter()
        .filter(|name| properties.contains_key(*name))
        .collect();
    if numeric {
        let forces: Vec<&str> = forces().filter(|name| *name != "friction_force").collect();
        // Levels are coefficients or forces.
        relations.push(json!({ "anyOf": [super::excluding(&forces), super::excluding(&levels)] }));
    }
    whole["allOf"] = relations.into();
    whole
}

/// A number that may be a formula, in a study of a system.
fn text_or(schema: Json) -> Json {
    match schema.get("anyOf").or(schema.get("type").filter(|kind| *kind == "number")) {
        Some(_) => {
            let about = schema["description"].clone();
            let number = schema.get("anyOf").map_or(schema.clone(), |list| list[0].clone());
            json!({ "anyOf": [number, { "type": "string" }], "description": about })
        }
        None => schema,
    }
}
