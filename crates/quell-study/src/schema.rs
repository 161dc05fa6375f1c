//! The JSON Schema of a study file (draft 2020-12), made from the registry of parameters.
//!
//! A study is in one system, so the schema is one of two: in the numbers of the equations or
//! in SI. Relations between values (μ_m ≤ μ_s, ΣD_N ≤ F) are beyond a schema; `quell check`
//! judges them.

mod course;
mod list;
mod system;
mod uncertainty;
mod waveform;

use quell_model::LawKind;
use quell_model::friction::samples::{FEWEST, MOST_TERMS};
use quell_model::parameter::disc::DISC_DITHER_AMPLITUDE;
use quell_model::parameter::{
    BELT_VELOCITY, Bounds, COEFFICIENT, DITHER_FREQUENCY_RATIO, MASS, NORMAL_LOAD, Parameter,
};
use quell_model::units::Quantity;
use serde_json::{Map, Value as Json, json};

use crate::study::vocabulary::{
    self, Choice, Key, MOST_POINTS, Role, SCHEMA_ABOUT, SCHEMA_VERSION, Section, WAVE_KEYS,
};

/// The dialect of the schema.
const DIALECT: &str = "https://json-schema.org/draft/2020-12/schema";

/// The system of a study.
#[derive(Clone, Copy, PartialEq, Eq)]
enum UnitSystem {
    Scaled,
    Si,
}

impl UnitSystem {
    fn suffix(self) -> &'static str {
        match self {
            Self::Scaled => "scaled",
            Self::Si => "si",
        }
    }
}

/// The JSON Schema of a study file.
pub fn schema() -> Json {
    let mut definitions = Map::new();
    for system in [UnitSystem::Scaled, UnitSystem::Si] {
        for section in [
            Section::Belt,
            Section::Initial,
            Section::Drive,
            Section::Load,
            Section::Dither,
            Section::Envelope,
            Section::Solver,
            Section::Response,
            Section::Design,
            Section::DesignLimits,
            Section::Actuator,
        ] {
            definitions.insert(name(section, system), table(section, system));
        }
        definitions.insert(name(Section::Friction, system), friction(system));
        definitions.insert(name(Section::Root, system), root(system));
    }
    disc(&mut definitions);
    system::define(&mut definitions);
    definitions.insert("sweep".to_owned(), sweep());
    definitions.insert("uncertainty".to_owned(), uncertainty::uncertainty());
    definitions.insert("uncertainty_at".to_owned(), uncertainty::uncertainty_at());
    json!({
        "$schema": DIALECT,
        "title": "Quell study file",
        "description": "A mass on a moving belt with dither, dimensionless or in SI; an annular disc under rotating loads; or a linear \
                        structure with friction contacts.",
        "oneOf": [
            { "$ref": reference(Section::Root, UnitSystem::Scaled) },
            { "$ref": reference(Section::Root, UnitSystem::Si) },
            { "$ref": "#/$defs/study_disc" },
            { "$ref": "#/$defs/study_system" },
        ],
        "$defs": definitions,
    })
}

fn name(section: Section, system: UnitSystem) -> String {
    let table = match section {
        Section::Root => "study",
        Section::Initial => "initial",
        Section::Drive => "drive",
        Section::Load => "load",
        Section::Envelope => "envelope",
        Section::DesignLimits => "limits",
        _ => section.path(),
    };
    format!("{table}_{}", system.suffix())
}

fn reference(section: Section, system: UnitSystem) -> String {
    format!("#/$defs/{}", name(section, system))
}

fn root(system: UnitSystem) -> Json {
    let dither = reference(Section::Dither, system);
    let about = match system {
        UnitSystem::Scaled => "a dimensionless study",
        UnitSystem::Si => "a study in SI",
    };
    let mut whole = json!({
        "type": "object",
        "description": about,
        "properties": {
            "schema": { "const": SCHEMA_VERSION, "description": SCHEMA_ABOUT },
            "title": { "type": "string", "description": "subject of the study" },
            "belt": { "$ref": reference(Section::Belt, system) },
            "friction": { "$ref": reference(Section::Friction, system) },
            "dither": {
                "description": Section::Dither.about(),
                "oneOf": [
                    { "$ref": dither },
                    { "type": "array", "items": { "$ref": dither } },
                ],
            },
            "solver": { "$ref": reference(Section::Solver, system) },
            "response": { "$ref": reference(Section::Response, system) },
            "design": { "$ref": reference(Section::Design, system) },
            "actuator": { "$ref": reference(Section::Actuator, system) },
            "uncertainty": { "$ref": "#/$defs/uncertainty" },
            "sweep": { "type": "array", "items": { "$ref": "#/$defs/sweep" } },
        },
        "required": ["belt", "friction"],
        "additionalProperties": false,
    });
    if system == UnitSystem::Si {
        let needs =
            |table: &str, key: &str| json!({ "properties": { table: { "required": [key] } } });
        let load = NORMAL_LOAD.si.first().map_or(NORMAL_LOAD.key(), |twin| twin.key);
        // Friction in newtons may stand for the normal force.
        whole["anyOf"] =
            json!([needs("belt", load), needs("belt", "load"), needs("friction", FORCE)]);
    }
    whole
}

/// A study of a disc. Which keys exclude one another where modes are listed is left to `quell check`.
fn disc(definitions: &mut Map<String, Json>) {
    let table = |section: Section, required: &[&str]| {
        let keys = vocabulary::keys_of(section);
        let properties: Map<String, Json> =
            keys.map(|key| (key.name.to_owned(), property(key))).collect();
        object(section, &properties, required)
    };
    let mode = table(Section::DiscMode, &["diameters", "shape_at_load"]);
    let mut load = table(Section::DiscLoad, &[]);
    load["properties"]["envelope"] = json!({ "$ref": "#/$defs/disc_load_envelope" });
    let mut whole = table(Section::Disc, &[]);
    whole["properties"]["mode"] =
        json!({ "type": "array", "items": { "$ref": "#/$defs/disc_mode" }, "minItems": 1 });
    whole["properties"]["drive"] = json!({ "$ref": "#/$defs/disc_drive" });
    let one = json!({ "$ref": "#/$defs/disc_load" });
    whole["properties"]["load"] = json!({
        "description": Section::DiscLoad.about(),
        "oneOf": [one.clone(), { "type": "array", "items": one }],
    });
    let mut dither = json!({
        "type": "object",
        "description": "modulation of the friction of every load",
        "properties": {
            "direction": { "enum": Choice::Direction.names() },
            "amplitude": property_of(DISC_DITHER_AMPLITUDE),
            "frequency_ratio": property_of(DITHER_FREQUENCY_RATIO),
            "frequency_hz": vocabulary::key(Section::Dither, "frequency_hz").map_or(json!({}), property),
        },
        "required": ["direction"],
        "oneOf": [{ "required": ["frequency_ratio"] }, { "required": ["frequency_hz"] }],
        "additionalProperties": false,
    });
    for name in ["waveform"].into_iter().chain(WAVE_KEYS.iter().map(|(name, _)| *name)) {
        let described = vocabulary::key(Section::Dither, name).map_or(json!({}), property);
        dither["properties"][name] = described;
    }
    dither["properties"]["envelope"] = json!({ "$ref": "#/$defs/disc_dither_envelope" });
    let root = json!({
        "type": "object",
        "description": "a study of a disc",
        "properties": {
            "schema": { "const": SCHEMA_VERSION, "description": SCHEMA_ABOUT },
            "title": { "type": "string", "description": "subject of the study" },
            "disc": { "$ref": "#/$defs/disc" },
            "friction": {
                "anyOf": [
                    { "$ref": reference(Section::Friction, UnitSystem::Scaled) },
                    { "$ref": reference(Section::Friction, UnitSystem::Si) },
                ],
            },
            "dither": { "$ref": "#/$defs/disc_dither" },
            "design": { "$ref": reference(Section::Design, UnitSystem::Scaled) },
            "uncertainty": { "$ref": "#/$defs/uncertainty" },
            "sweep": { "type": "array", "items": { "$ref": "#/$defs/sweep" } },
        },
        "required": ["disc"],
        "additionalProperties": false,
    });
    for (name, definition) in [
        ("disc_mode", mode),
        ("disc_load", load),
        ("disc_drive", table(Section::DiscDrive, &[])),
        ("disc_load_envelope", table(Section::LoadEnvelope, &[])),
        ("disc_dither_envelope", table(Section::Envelope, &[])),
        ("disc", whole),
        ("disc_dither", dither),
        ("study_disc", root),
    ] {
        definitions.insert(name.to_owned(), definition);
    }
}

fn property_of(parameter: Parameter) -> Json {
    let mut schema = bounded(parameter.bounds, parameter.quantity);
    schema["description"] = format!("{}: {}", parameter.symbol, parameter.about).into();
    schema
}

/// A table with the keys of one system.
fn table(section: Section, system: UnitSystem) -> Json {
    let mut properties = Map::new();
    let mut required = Vec::new();
    // Keys that say the same: one of each list is needed.
    let mut either: Vec<(&str, Vec<&str>)> = Vec::new();
    let mut one_of = |what: &'static str, key: &'static str| match either
        .iter_mut()
        .find(|(known, _)| *known == what)
    {
        Some((_, keys)) => keys.push(key),
        None => either.push((what, vec![key])),
    };
    for key in vocabulary::keys_of(section).filter(|key| belongs(key, system)) {
        properties.insert(key.name.to_owned(), property(key));
        match key.role {
            // Friction in newtons may stand for it.
            Role::Twin(parameter, _) if parameter.path == NORMAL_LOAD.path => {}
            Role::Number(parameter) | Role::Twin(parameter, _) | Role::Size(parameter, _)
                if needed(parameter) =>
            {
                one_of(parameter.path, key.name);
            }
            // Noise has a band in place of a frequency.
            Role::Band { .. } if section == Section::Dither => {
                one_of(DITHER_FREQUENCY_RATIO.path, key.name);
            }
            Role::Scale(scale) if scale != MASS => one_of("stiffness", key.name),
            Role::Scale(_)
            | Role::Choice(Choice::Direction | Choice::Waveform | Choice::ActuatorKind) => {
                required.push(key.name);
            }
            _ => {}
        }
    }
    if section == Section::Belt {
        for (key, inner) in
            [("initial", Section::Initial), ("drive", Section::Drive), ("load", Section::Load)]
        {
            properties.insert(key.into(), json!({ "$ref": reference(inner, system) }));
        }
    }
    if section == Section::Design {
        properties
            .insert("limits".into(), json!({ "$ref": reference(Section::DesignLimits, system) }));
        required.extend(["minimise", "vary", "from", "to"]);
    }
    if section == Section::Dither {
        properties
            .insert("envelope".into(), json!({ "$ref": reference(Section::Envelope, system) }));
    }
    // A drive or a load over time may stand for the constant one, or be added to it.
    let mut over_time = Vec::new();
    for (path, table) in [(BELT_VELOCITY.path, "drive"), (NORMAL_LOAD.path, "load")] {
        if let Some(place) = either.iter().position(|(known, _)| *known == path) {
            let (_, mut keys) = either.remove(place);
            keys.push(table);
            over_time.push(keys);
        }
    }
    let (single, several): (Vec<_>, Vec<_>) =
        either.into_iter().map(|(_, keys)| keys).partition(|keys| keys.len() == 1);
    required.extend(single.concat());
    let mut object = object(section, &properties, &required);
    let each = |keys: Vec<&str>| -> Vec<Json> {
        keys.iter().map(|key| json!({ "required": [key] })).collect()
    };
    let one = several.into_iter().map(|keys| json!({ "oneOf": each(keys) }));
    let any = over_time.into_iter().map(|keys| json!({ "anyOf": each(keys) }));
    let noise = (section == Section::Dither)
        .then(|| waveform::noise_or_periodic(&["frequency_ratio", "frequency_hz", "phase"]));
    let relations: Vec<Json> = one.chain(any).chain(noise).collect();
    if !relations.is_empty() {
        object["allOf"] = relations.into();
    }
    if section == Section::Response {
        object["not"] = json!({ "required": ["band", "band_hz"] });
    }
    if section == Section::Initial {
        let numbers: Vec<Json> = vocabulary::keys_of(section)
            .filter(|key| key.parameter().is_some() && belongs(key, system))
            .map(|key| json!({ "required": [key.name] }))
            .collect();
        object["not"] = json!({ "required": ["state"], "anyOf": numbers });
    }
    object
}

fn object(section: Section, properties: &Map<String, Json>, required: &[&str]) -> Json {
    json!({
        "type": "object",
        "description": section.about(),
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    })
}

/// One alternative a law.
fn friction(system: UnitSystem) -> Json {
    let laws: Vec<Json> = LawKind::ALL
        .iter()
        .map(|law| {
            let mut properties = Map::new();
            properties
                .insert("law".into(), json!({ "const": law.name(), "description": law.about() }));
            let mut required = vec!["law"];
            for key in vocabulary::keys_of(Section::Friction).filter(|key| belongs(key, system)) {
                let known = |parameter: Parameter| {
                    let mut known = law.parameters().iter().chain(law.options());
                    known.any(|known| known.path == parameter.path)
                };
                if let Some(parameter) = key.parameter().filter(|&parameter| known(parameter)) {
                    let number = match key.role {
                        Role::Coefficient => property_of(parameter),
                        _ => property(key),
                    };
                    properties.insert(key.name.to_owned(), number);
                    // Where a law carries data, its static level is that of the data.
                    let needed =
                        LawKind::NUMERIC.contains(law) && law.default_of(parameter.path).is_none();
                    let also_as_force = system == UnitSystem::Si && as_force(*law, parameter);
                    if needed && !also_as_force {
                        required.push(key.name);
                    }
                } else if let Role::FrictionForce(parameter, _) = key.role {
                    if as_force(*law, parameter) {
                        properties.insert(key.name.to_owned(), property(key));
                    }
                } else if of_own_law(*law, key.role, key.name) {
                    properties.insert(key.name.to_owned(), property(key));
                }
            }
            match law {
                LawKind::Expression => {
                    required.push("coefficient");
                    properties["coefficient"]["type"] = json!(["string", "number"]);
                    properties.insert(
                        "constants".into(),
                        json!({
                            "type": "object",
                            "description": Section::Constants.about(),
                            "additionalProperties": { "type": "number" },
                        }),
                    );
                    object(Section::Friction, &properties, &required)
                }
                LawKind::Samples => {
                    let speeds = match system {
                        UnitSystem::Scaled => "slip_velocity",
                        UnitSystem::Si => "slip_velocity_m_per_s",
                    };
                    properties["coefficient"]["type"] = "array".into();
                    properties["coefficient"]["items"] = json!({ "type": "number", "minimum": 0 });
                    let mut whole = object(Section::Friction, &properties, &required);
                    whole["oneOf"] =
                        json!([{ "required": ["file"] }, { "required": [speeds, "coefficient"] }]);
                    whole
                }
                _ => {
                    let mut whole = object(Section::Friction, &properties, &required);
                    if properties.contains_key(FORCE) {
                        whole["oneOf"] =
                            json!([{ "required": ["coefficient"] }, { "required": [FORCE] }]);
                    }
                    whole
                }
            }
        })
        .collect();
    json!({ "description": Section::Friction.about(), "oneOf": laws })
}

/// The key of a law's level in newtons.
const FORCE: &str = "friction_force_n";

/// Whether a number of a law can be given as a force.
fn as_force(law: LawKind, parameter: Parameter) -> bool {
    let has = |path: &str| law.parameters().iter().any(|known| known.path == path);
    let as_force = |key: &Key| matches!(key.role, Role::FrictionForce(given, _) if given.path == parameter.path);
    has(COEFFICIENT.path)
        && has(parameter.path)
        && vocabulary::keys_of(Section::Friction).any(as_force)
}

/// Whether a key that is no number of the registry belongs to a law that carries data.
fn of_own_law(law: LawKind, role: Role, name: &str) -> bool {
    match law {
        LawKind::Expression => role == Role::Coefficient,
        LawKind::Samples => {
            matches!(role, Role::Coefficient | Role::Speeds { .. } | Role::Terms) || name == "file"
        }
        _ => false,
    }
}

fn sweep() -> Json {
    let properties: Map<String, Json> = vocabulary::keys_of(Section::Sweep)
        .map(|key| (key.name.to_owned(), property(key)))
        .collect();
    let mut object = object(Section::Sweep, &properties, &["parameter"]);
    object["oneOf"] = json!([
        {
            "required": ["values"],
            "not": { "anyOf": [
                { "required": ["from"] },
                { "required": ["to"] },
                { "required": ["points"] },
                { "required": ["spacing"] },
            ] },
        },
        { "required": ["from", "to", "points"], "not": { "required": ["values"] } },
    ]);
    object
}

/// Whether a key may stand in a study of a system.
fn belongs(key: &Key, system: UnitSystem) -> bool {
    match key.role {
        Role::Number(parameter) => {
            system == UnitSystem::Scaled || parameter.si.is_empty() || parameter.is_pure()
        }
        Role::Twin(..) | Role::Scale(_) | Role::FrictionForce(..) => system == UnitSystem::Si,
        Role::Size(_, size) => size.belongs(system == UnitSystem::Si),
        Role::Speeds { si } => si == (system == UnitSystem::Si),
        Role::Band { hertz } => !hertz || system == UnitSystem::Si,
        Role::Course(course) => course.si().is_none_or(|si| si == (system == UnitSystem::Si)),
        _ => true,
    }
}

/// Whether a parameter has to be given.
fn needed(parameter: Parameter) -> bool {
    let optional = [
        "belt.initial",
        "belt.tangential_stiffness",
        "solver",
        "dither.phase",
        // Those that are required are listed with the table.
        "design",
        "actuator",
    ];
    !optional.iter().any(|path| parameter.path.starts_with(path))
}

fn property(key: &Key) -> Json {
    let mut schema = match key.role {
        Role::Number(parameter) => bounded(parameter.bounds, parameter.quantity),
        // The bounds of a twin depend on the scales unless they are about the sign.
        Role::Twin(parameter, _) => match parameter.bounds {
            Bounds { lower: 0.0, upper: f64::INFINITY, .. } => {
                bounded(parameter.bounds, Quantity::Ratio)
            }
            Bounds { lower: 0.0, .. } => bounded(Bounds::NOT_NEGATIVE, Quantity::Ratio),
            _ => bounded(Bounds::FINITE, Quantity::Ratio),
        },
        Role::Scale(scale) => bounded(scale.bounds, Quantity::Ratio),
        Role::Size(parameter, _) => bounded(parameter.bounds, Quantity::Ratio),
        Role::Choice(choice) => json!({ "enum": choice.names() }),
        Role::Wave(wave) => waveform::property(wave),
        Role::Course(course) => course::property(course, key.section.course()),
        Role::Text => json!({ "type": "string" }),
        Role::Schema => json!({ "const": SCHEMA_VERSION }),
        Role::Choices(choice) => list::choices(choice),
        Role::Reference => {
            json!({ "oneOf": [{ "const": "critical" }, { "type": "number", "exclusiveMinimum": 0.0 }] })
        }
        Role::Coefficient => json!({}),
        Role::FrictionForce(..) => bounded(Bounds::NOT_NEGATIVE, Quantity::Ratio),
        Role::Speeds { .. } => {
            json!({ "type": "array", "items": { "type": "number", "minimum": 0 }, "minItems": FEWEST })
        }
        Role::Band { .. } => {
            let bounds = if key.section == Section::Dither {
                Bounds::POSITIVE
            } else {
                Bounds::NOT_NEGATIVE
            };
            let end = bounded(bounds, Quantity::FrequencyRatio);
            json!({ "type": "array", "items": end, "minItems": 2, "maxItems": 2 })
        }
        Role::Terms => json!({ "type": "integer", "minimum": 1, "maximum": MOST_TERMS }),
        Role::AxisNumber | Role::Constant => json!({ "type": "number" }),
        Role::AxisPoints => json!({ "type": "integer", "minimum": 2, "maximum": MOST_POINTS }),
        Role::AxisValues => list::numbers(),
        Role::Paths => json!({ "type": "array", "items": { "type": "string" }, "minItems": 1 }),
        Role::Ranges => list::ranges(),
    };
    if key.measured_in().is_some() {
        schema = with_units(schema);
    }
    schema["description"] = about(key).into();
    schema
}

/// Texts of a number followed by a unit; the reader checks the unit.
const WITH_UNIT: &str =
    "^\\s*[-+]?([0-9]+[.]?[0-9]*|[.][0-9]+)([eE][-+]?[0-9]+)?\\s*[^-+.\\s0-9eE]";

/// A number, or a text such as "5.7 kN".
fn with_units(number: Json) -> Json {
    match number["type"].as_str() {
        Some("number") => {
            json!({ "anyOf": [number, { "type": "string", "pattern": WITH_UNIT }] })
        }
        Some("array") => {
            let mut list = number;
            list["items"] = with_units(list["items"].clone());
            list
        }
        _ => number,
    }
}

fn about(key: &Key) -> String {
    match key.role {
        Role::Twin(_, twin) if twin.rms => {
            let symbol = key.symbol().unwrap_or_default();
            format!("{symbol}: {}, as root mean square, in N", key.about)
        }
        Role::Number(_) | Role::Twin(..) | Role::Size(..) => {
            let symbol = key.symbol().unwrap_or_default();
            format!("{symbol}: {}, in {}", key.about, key.unit_in_words())
        }
        Role::Scale(scale) => format!("{}: {}, in {}", scale.symbol, key.about, key.unit()),
        Role::Speeds { .. } | Role::Band { .. } | Role::FrictionForce(..) => {
            format!("{}, in {}", key.about, key.unit())
        }
        _ => key.about.to_owned(),
    }
}

fn bounded(bounds: Bounds, quantity: Quantity) -> Json {
    let whole = quantity == Quantity::Count;
    let mut schema = json!({ "type": if whole { "integer" } else { "number" } });
    if bounds.lower.is_finite() {
        let keyword = if bounds.lower_included { "minimum" } else { "exclusiveMinimum" };
        schema[keyword] = bounds.lower.into();
    }
    if bounds.upper.is_finite() {
        schema["maximum"] = bounds.upper.into();
    }
    schema
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
    fn a_design_needs_no_more_than_its_question() {
        let schema = schema();
        for name in ["design_scaled", "design_si", "system_design"] {
            let required = &schema["$defs"][name]["required"];
            assert_eq!(*required, json!(["minimise", "vary", "from", "to"]), "{name}");
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
            let found = defs.values().any(|table| {
                let inside = |table: &Json| table["properties"].get(key.name).is_some();
                inside(table)
                    || table["oneOf"].as_array().is_some_and(|laws| laws.iter().any(inside))
            });
            assert!(found, "{}", key.path());
        }
        let amplitude = &schema["$defs"]["dither_scaled"]["properties"]["amplitude"];
        assert_eq!(amplitude["minimum"], 0.0);
        let load = &schema["$defs"]["belt_scaled"]["properties"]["normal_load"];
        assert_eq!(load["exclusiveMinimum"], 0.0);
    }
}
