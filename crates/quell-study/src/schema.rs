//! The JSON Schema of a study file (draft 2020-12), made from the keys of the vocabulary.
//!
//! One object with the tables of every kind, of which a study has those of one. Relations between values (μ_m ≤ μ_s, ΣD_N ≤ F), units
//! and formulas are beyond a schema; `quell check` judges them.

mod course;
mod law;
mod list;
mod object;
mod table;
mod uncertainty;
mod waveform;

use quell_model::parameter::{
    BELT_VELOCITY, DAMPING_RATIO, DITHER_AMPLITUDE, DITHER_FREQUENCY_RATIO, MASS,
    NATURAL_FREQUENCY, NORMAL_LOAD, Parameter, STIFFNESS,
};
use serde_json::{Map, Value as Json, json};

use crate::study::vocabulary::size::DITHER_SIZES;
use crate::study::vocabulary::{self, DocumentKind, Section};
use table::{excluding, of_section, one_of, reference, required, some_of};

/// The dialect of the schema.
const DIALECT: &str = "https://json-schema.org/draft/2020-12/schema";

/// The JSON Schema of a study file.
pub fn schema() -> Json {
    let mut definitions = Map::new();
    for section in Section::ALL.iter().copied() {
        let table = match section {
            Section::Root | Section::Constants => continue,
            Section::Friction => law::friction(),
            Section::Parameters => table::named(section),
            Section::Uncertainty => uncertainty::uncertainty(),
            Section::Mode => of_section(section, &["damping_ratio", "shape"]),
            Section::Component => of_section(section, &["name"]),
            _ => of_section(section, &[]),
        };
        definitions.insert(table::name(section), table);
    }
    relations(&mut definitions);
    definitions.insert("uncertainty_at".to_owned(), uncertainty::uncertainty_at());
    let mut root = of_section(Section::Root, &[]);
    root["$schema"] = DIALECT.into();
    root["title"] = "Quell study file".into();
    root["description"] = "A mass on a moving belt with dither; an annular disc under rotating loads; or a linear structure with \
                           friction contacts."
        .into();
    let kind = |kind: DocumentKind| {
        let name = kind.section().path();
        let dither = table::one_or_several(&reference(&format!("{name}_dither")));
        json!({
            "required": [name],
            "properties": { "dither": dither },
            "not": { "anyOf": required(&of_others(Section::Root, kind)) },
        })
    };
    let mut belt = kind(DocumentKind::Belt);
    belt["required"] = json!(["belt", "friction"]);
    // Friction that is given as a force may stand for the normal load.
    let loaded = |table: &str, keys: Vec<&str>| json!({ "properties": { table: { "anyOf": required(&keys) } } });
    let load: Vec<&str> = NORMAL_LOAD.keys().chain(["load"]).collect();
    belt["anyOf"] = json!([loaded("belt", load), loaded("friction", law::forces().collect())]);
    root["oneOf"] = json!([belt, kind(DocumentKind::Disc), kind(DocumentKind::System)]);
    root["$defs"] = definitions.into();
    root
}

/// The names of the keys of a table that studies of a kind do not have.
fn of_others(section: Section, kind: DocumentKind) -> Vec<&'static str> {
    let keys = vocabulary::keys().iter().filter(|key| key.section == section);
    let names = keys.map(|key| key.name);
    names.filter(|name| vocabulary::key(section, name, kind).is_none()).collect()
}

/// What the keys of a table have to do with each other.
fn relations(definitions: &mut Map<String, Json>) {
    let mut relate = |name: &str, relations: Vec<Json>| {
        if let Some(table) = definitions.get_mut(name) {
            table["allOf"] = relations.into();
        }
    };
    let of = |parameters: &[Parameter]| -> Vec<&'static str> {
        parameters.iter().flat_map(Parameter::keys).collect()
    };
    let scales = [of(&[MASS]), of(&[STIFFNESS, NATURAL_FREQUENCY])];
    let suffixed = |keys: &[&'static str]| -> Vec<&'static str> { keys.to_vec() };
    // Either both scales or none.
    let none = excluding(&scales.concat());
    let both = json!({ "allOf": scales.each_ref().map(|keys| one_of(&suffixed(keys))) });
    relate(
        "belt",
        vec![
            json!({ "anyOf": [none, both] }),
            one_of(&of(&[DAMPING_RATIO])),
            some_of(&[of(&[BELT_VELOCITY]), vec!["drive"]].concat()),
        ],
    );
    relate(
        "belt_initial",
        vec![json!({ "anyOf": [excluding(&["state"]), excluding(&[
        "displacement", "displacement_m", "velocity", "velocity_m_per_s"])] })],
    );
    relate("response", vec![json!({ "not": { "required": ["band", "band_hz"] } })]);
    relate("disc_mode", vec![json!({ "required": ["diameters", "shape_at_load"] })]);
    relate("design", vec![json!({ "required": ["minimise", "vary", "from", "to"] })]);
    relate("actuator", vec![json!({ "required": ["kind"] })]);
    let ends = ["from", "to", "points", "spacing"];
    relate(
        "sweep",
        vec![
            json!({ "required": ["parameter"] }),
            json!({ "oneOf": [
                { "required": ["values"], "not": { "anyOf": required(&ends) } },
                { "required": ["from", "to", "points"], "not": { "required": ["values"] } },
            ] }),
        ],
    );
    // A dither is periodic with a frequency, or noise with a band.
    let sizes = DITHER_SIZES.iter().map(|size| size.key);
    let amplitude: Vec<&str> = DITHER_AMPLITUDE.keys().chain(sizes).collect();
    let frequency: Vec<&str> = DITHER_FREQUENCY_RATIO.keys().chain(["band", "band_hz"]).collect();
    let periodic: Vec<&str> = DITHER_FREQUENCY_RATIO.keys().chain(["phase"]).collect();
    let wave = waveform::noise_or_periodic(&periodic);
    definitions.insert(
        "belt_dither".to_owned(),
        json!({ "allOf": [
            { "required": ["direction", "waveform"],
                "properties": table::properties(Section::Dither, DocumentKind::Belt),
                "not": { "anyOf": required(&of_others(Section::Dither, DocumentKind::Belt)) }, },
            one_of(&amplitude), one_of(&frequency), wave,
        ] }),
    );
    definitions.insert(
        "system_dither".to_owned(),
        json!({ "allOf": [{ "required": ["waveform"] }, one_of(&frequency), wave] }),
    );
    let properties = table::properties(Section::Dither, DocumentKind::Disc);
    definitions.insert(
        "disc_dither".to_owned(),
        json!({
            "type": "object",
            "description": "modulation of the friction of every load",
            "properties": properties,
            "required": ["direction"],
            "additionalProperties": false,
            "allOf": [one_of(&DITHER_FREQUENCY_RATIO.keys().collect::<Vec<_>>())],
        }),
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every `$ref` leads somewhere, and every object says what it does with other keys.
    fn walk(schema: &Json, root: &Json) {
        if let Some(target) = schema.get("$ref").and_then(Json::as_str) {
            let pointer = target.trim_start_matches('#');
            assert!(root.pointer(pointer).is_some(), "{target}");
        }
        // A table either lists its keys or, for names of the user's own, says what each holds.
        let named_freely = schema["additionalProperties"].is_object();
        if schema.get("type").is_some_and(|kind| kind == "object") && !named_freely {
            assert_eq!(schema["additionalProperties"], false);
            let required = schema["required"].as_array().expect("required");
            for key in required {
                let key = key.as_str().expect("a name");
                assert!(schema["properties"].get(key).is_some(), "{key}");
            }
        }
        match schema {
            Json::Object(object) => object.values().for_each(|inner| walk(inner, root)),
            Json::Array(list) => list.iter().for_each(|inner| walk(inner, root)),
            _ => {}
        }
    }

    #[test]
    fn references_lead_somewhere_and_required_keys_exist() {
        let schema = schema();
        walk(&schema, &schema);
    }

    #[test]
    fn every_key_of_the_registry_is_in_it() {
        let schema = schema();
        for key in vocabulary::keys() {
            let defs = schema["$defs"].as_object().expect("definitions");
            let root = schema["properties"].get(key.name).is_some();
            let found = defs.values().any(|table| {
                let inside = |table: &Json| table["properties"].get(key.name).is_some();
                inside(table)
                    || table["oneOf"].as_array().is_some_and(|laws| laws.iter().any(inside))
            });
            assert!(found || root, "{}", key.path());
        }
        let least = |pointer: &str| &schema["$defs"]["dither"]["properties"][pointer];
        assert_eq!(least("amplitude")["anyOf"][0]["minimum"], 0.0);
        let load = &schema["$defs"]["belt"]["properties"]["normal_load"];
        assert_eq!(load["anyOf"][0]["exclusiveMinimum"], 0.0);
    }
}
