//! The JSON Schema accepts what the reader accepts, and refuses what a schema can refuse.

use quell_model::units::measure;
use quell_study::schema::schema;
use quell_study::{BeltStudy, Study};
use serde_json::Value as Json;

/// Whether `value` is valid under `schema`: the keywords that our schema uses, and no others.
fn valid(value: &Json, schema: &Json, root: &Json) -> bool {
    let keywords = schema.as_object().expect("a schema is an object");
    keywords.iter().all(|(keyword, argument)| match keyword.as_str() {
        "$schema" | "$defs" | "title" | "description" => true,
        "$ref" => {
            let pointer = argument.as_str().expect("a reference").trim_start_matches('#');
            valid(value, root.pointer(pointer).expect(pointer), root)
        }
        "oneOf" => schemas(argument).filter(|schema| valid(value, schema, root)).count() == 1,
        "allOf" => schemas(argument).all(|schema| valid(value, schema, root)),
        // The one pattern there is: a number with a unit.
        "pattern" => value.as_str().is_none_or(measure::has_unit),
        "anyOf" => schemas(argument).any(|schema| valid(value, schema, root)),
        "not" => !valid(value, argument, root),
        "type" if argument.is_array() => {
            schemas(argument).any(|one| valid(value, &serde_json::json!({ "type": one }), root))
        }
        "type" => match argument.as_str() {
            Some("object") => value.is_object(),
            Some("array") => value.is_array(),
            Some("string") => value.is_string(),
            Some("boolean") => value.is_boolean(),
            Some("number") => value.is_number(),
            Some("integer") => value.as_f64().is_some_and(|number| number.fract() == 0.0),
            other => panic!("type {other:?}"),
        },
        "const" => value == argument,
        "enum" => schemas(argument).any(|allowed| value == allowed),
        "minimum" => compare(value, argument, |value, bound| value >= bound),
        "exclusiveMinimum" => compare(value, argument, |value, bound| value > bound),
        "maximum" => compare(value, argument, |value, bound| value <= bound),
        "maxItems" => value
            .as_array()
            .is_none_or(|list| list.len() as u64 <= argument.as_u64().expect("a count")),
        "minItems" => value
            .as_array()
            .is_none_or(|list| list.len() as u64 >= argument.as_u64().expect("a count")),
        "items" => {
            value.as_array().is_none_or(|list| list.iter().all(|item| valid(item, argument, root)))
        }
        "required" => {
            schemas(argument).all(|name| value.get(name.as_str().expect("a name")).is_some())
        }
        "properties" => {
            argument.as_object().expect("properties").iter().all(|(name, schema)| {
                value.get(name).is_none_or(|value| valid(value, schema, root))
            })
        }
        "additionalProperties" => value.as_object().is_none_or(|object| {
            let known = |name: &str| {
                keywords.get("properties").is_some_and(|known| known.get(name).is_some())
            };
            let others = || object.iter().filter(|(name, _)| !known(name));
            match argument {
                Json::Bool(allowed) => *allowed || others().next().is_none(),
                schema => others().all(|(_, value)| valid(value, schema, root)),
            }
        }),
        other => panic!("the schema uses {other}, which this test does not know"),
    })
}

fn schemas(list: &Json) -> impl Iterator<Item = &Json> {
    list.as_array().expect("a list").iter()
}

fn compare(value: &Json, bound: &Json, holds: fn(f64, f64) -> bool) -> bool {
    value.as_f64().is_none_or(|value| holds(value, bound.as_f64().expect("a number")))
}

const SCALED: &str = "schema = 1\ntitle = 'x'\n[belt]\ndamping_ratio = 0.1\nnormal_load = 1\nbelt_velocity = 1\n\
    [friction]\nlaw = 'stribeck'\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2\nreference_velocity = 1\n\
    [dither]\nwaveform = 'sine'\ndirection = 'normal'\namplitude = 0.1\nfrequency_ratio = 10\n";
const SI: &str = "schema = 1\n[belt]\nmass_kg = 1\nstiffness_n_per_m = 1\ndamping_n_s_per_m = 0.1\n\
    normal_force_n = 1\nbelt_velocity_m_per_s = 1\n[friction]\nlaw = 'decreasing'\nstatic_coefficient = 0.4\n\
    minimum_coefficient = 0.2\nreference_velocity_m_per_s = 1\n[[dither]]\nwaveform = 'square'\n\
    direction = 'normal'\namplitude_n_rms = 0.1\nfrequency_hz = 10\nphase = -1\n";

/// What a text is to the schema and to the reader.
fn judged(text: &str) -> (bool, bool) {
    let schema = schema();
    let value: Json = toml::from_str(text).expect(text);
    (valid(&value, &schema, &schema), BeltStudy::parse(text, &[]).is_ok())
}

const SYSTEM: &str = "[system]\nunits = 'SI'\ncoordinates = ['x', 'y']\nmass = [1, 'm']\nstiffness = [[1, 0], [0, '2kN/m']]\n\
    [system.initial]\ndisplacements_m = {x = 1}\n[parameters]\nm = 2\n[[contact]]\nname = 'pad'\ntangent = [1, 0]\n\
    normal = {y = 'm'}\nnormal_load_n = 1\nbelt_velocity = -1\n[contact.friction]\nlaw = 'coulomb'\ncoefficient = 'm/4'\n\
    [dither]\ncontact = 'pad'\ndirection = 'normal'\nreaction = false\nwaveform = 'sine'\namplitude = 0.1\nfrequency_hz = 10\n";

#[test]
fn schema_and_reader_agree_on_systems() {
    let schema = schema();
    let judged = |text: &str| {
        let value: Json = toml::from_str(text).expect(text);
        (valid(&value, &schema, &schema), Study::parse(text, &[]).is_ok())
    };
    assert_eq!(judged(SYSTEM), (true, true));
    for (from, to) in [
        ("'SI'", "'cgs'"),
        ("mass", "masses"),
        ("[1, 0],", "[true, 0],"),
        ("tangent = [1, 0]", "tangent = 3"),
        ("reaction = false", "reaction = 'no'"),
        ("law = 'coulomb'\n", ""),
        ("waveform = 'sine'", "waveform = 'noise'"),
        ("[dither]", "[belt]\n[dither]"),
        ("m = 2", "m = [2]"),
    ] {
        assert!(SYSTEM.contains(from), "{from}");
        assert_eq!(judged(&SYSTEM.replacen(from, to, 1)), (false, false), "{to}");
    }
    // The schema does not read files.
    for (value, is_right) in
        [("{ file = 'K.mtx' }", true), ("{ file = 3 }", false), ("{ path = 'K.mtx' }", false)]
    {
        let text = SYSTEM.replace("[[1, 0], [0, '2kN/m']]", value);
        assert_eq!(judged(&text), (is_right, false), "{value}");
    }
    let noise = SYSTEM.replace("'sine'", "'noise'").replace("amplitude = 0.1", "amplitude = 0.01");
    for (keys, is_right) in [
        ("band = [8, '2*m']", false),
        ("band = ['2*m', 12]", true),
        ("band_hz = [8, 12]\nlines = 5\nseed = 3", true),
        ("band = [8, 12]\nfrequency = 10", false),
        ("band = [8, 12]\nphase = 0", false),
    ] {
        let text = noise.replace("frequency_hz = 10", keys);
        // The schema does not compute formulas.
        let schema = is_right || keys.contains("'2*m']");
        assert_eq!(judged(&text), (schema, is_right), "{keys}");
    }
    let normal_load = SYSTEM.replace("normal_load_n = 1", "normal_load = -1");
    assert_eq!(judged(&normal_load), (false, false));
}

const LUGRE: &str = "law = 'lugre'\ncoefficient = 0.3\nbristle_stiffness = 100\nstatic_coefficient = 0.4\nreference_velocity = 0.1";

#[test]
fn schema_and_reader_agree() {
    let changed = |text: &str, from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    };
    let more = |lines: &str| format!("{SCALED}{lines}\n");
    let sweep = |lines: &str| more(&format!("[[sweep]]\nparameter = 'dither.phase'\n{lines}"));
    let law = |text: &str, law: &str| {
        let (start, rest) =
            (text.find("law").expect("a law"), text.find("[[dither]]").or(text.find("[dither]")));
        text[..start].to_owned()
            + law
            + "\n"
            + &text[rest.expect("a dither")..].replace("normal", "tangential")
    };
    let pressed = |text: String| text.replace("normal_force_n = 1\n", "");
    let forces = "law = 'coulomb'\nfriction_force_n = 3\nviscous_n_s_per_m = 1";
    for text in [
        SCALED.to_owned(),
        SI.to_owned(),
        changed(SI, "schema = 1\n", ""),
        law(SCALED, "law = 'coulomb'\ncoefficient = 0.3"),
        law(SCALED, "law = 'coulomb'\ncoefficient = 0.3\nstatic_coefficient = 0.4\nviscous = 0.1"),
        law(
            SCALED,
            "law = 'stribeck-exponential'\ncoefficient = 0.3\nstatic_coefficient = 0.4\nreference_velocity = 1",
        ),
        law(SCALED, LUGRE),
        law(SCALED, &format!("{LUGRE}\nbristle_damping = 2\nviscous = 0.1")),
        law(
            SI,
            &LUGRE
                .replace("bristle_stiffness", "bristle_stiffness_per_m")
                .replace("velocity", "velocity_m_per_s"),
        ),
        changed(SCALED, "normal_load = 1\n", "normal_load = 1\ntangential_stiffness = 20\n"),
        changed(
            SI,
            "normal_force_n = 1\n",
            "normal_force_n = 1\ntangential_stiffness_n_per_m = 20\n",
        ),
        law(SCALED, "law = 'expression'\ncoefficient = '0.3'\nmaximum_velocity = 3"),
        law(SI, forces),
        pressed(law(SI, forces)),
        changed(SI, "amplitude_n_rms", "amplitude_n"),
        changed(SI, "stiffness_n_per_m = 1", "natural_frequency_hz = 5"),
        changed(SI, "damping_n_s_per_m = 0.1", "damping_ratio = 0.1"),
        changed(SI, "normal_force_n = 1", "normal_force_n = '0.4 kN'"),
        more("[belt.initial]\nstate = 'sliding'"),
        more("[belt.initial]\nvelocity = -1"),
        more("[solver]\ntolerance = 1e-9\nsettle = 10\nrecord_periods = 10"),
        sweep("values = [1, 2.5]"),
        sweep("from = 1\nto = 2\npoints = 10\nspacing = 'log'"),
    ] {
        assert_eq!(judged(&text), (true, true), "{text}");
    }
    for text in [
        law(SCALED, "law = 'coulomb'\nviscous = 0.3"),
        law(SCALED, &LUGRE.replace("bristle_stiffness = 100\n", "")),
        law(SCALED, &LUGRE.replace("100", "0")),
        changed(SCALED, "normal_load = 1\n", "normal_load = 1\ntangential_stiffness = 0\n"),
        law(SCALED, "law = 'stribeck-exponential'\ncoefficient = 0.3\nreference_velocity = 1"),
        law(SI, &format!("{forces}\ncoefficient = 0.3")),
        pressed(law(SI, "law = 'coulomb'\ncoefficient = 0.3")),
        changed(SI, "normal_force_n = 1\n", ""),
        changed(SCALED, "schema = 1", "schema = 2"),
        changed(SCALED, "title = 'x'", "title = 1"),
        changed(SCALED, "title", "titel"),
        changed(SCALED, "damping_ratio = 0.1", "damping_ratio = -0.1"),
        changed(SCALED, "damping_ratio = 0.1", "damping_ratio = '0.1'"),
        changed(SCALED, "normal_load = 1", "normal_load = 0"),
        changed(SCALED, "normal_load = 1\n", ""),
        changed(SCALED, "'stribeck'", "'coulomb'"),
        changed(SCALED, "'sine'", "'noise'"),
        changed(SCALED, "waveform = 'sine'\n", ""),
        changed(SCALED, "amplitude = 0.1\n", ""),
        changed(SI, "mass_kg = 1\n", ""),
        changed(SI, "mass_kg = 1\n", "mass_kg = 1\nnatural_frequency_hz = 5\n"),
        changed(SI, "stiffness_n_per_m = 1\n", ""),
        changed(SI, "damping_n_s_per_m = 0.1\n", "damping_n_s_per_m = 0.1\ndamping_ratio = 0.1\n"),
        changed(SI, "damping_n_s_per_m = 0.1\n", ""),
        changed(SI, "normal_force_n = 1", "normal_force_n = 'kN'"),
        changed(SI, "amplitude_n_rms = 0.1\n", ""),
        changed(SI, "phase", "amplitude_n = 1\nphase"),
        more("[belt.initial]\nstate = 'sliding'\nvelocity = 1"),
        more("[solver]\ntolerance = 1"),
        more("[solver]\nrecord_periods = 2.5"),
        more("[disc]"),
        sweep("values = []"),
        sweep("values = [1]\nfrom = 1"),
        sweep("from = 1\nto = 2"),
        sweep("from = 1\nto = 2\npoints = 1"),
        sweep("from = 1\nto = 2\npoints = 3\nspacing = 'cubic'"),
    ] {
        assert_eq!(judged(&text), (false, false), "{text}");
    }
}

#[test]
fn every_form_of_a_number_is_right() {
    let changed = |text: &str, from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    };
    let law = |text: &str, law: &str| {
        let (start, end) =
            (text.find("law").expect("a law"), text.find("[[dither]]").or(text.find("[dither]")));
        let rest = &text[end.expect("a dither")..];
        format!("{}{law}\n{}", &text[..start], rest.replace("normal", "tangential"))
    };
    for text in [
        changed(SI, "amplitude_n_rms", "amplitude"),
        changed(SI, "mass_kg = 1\n", "units = 'SI'\nmass = '1 kg'\n"),
        changed(SI, "damping_n_s_per_m", "damping"),
        changed(SI, "normal_force_n = 1", "normal_load = '1 N'"),
        changed(SI, "frequency_hz = 10", "frequency = '10 Hz'"),
        law(
            SI,
            "law = 'stribeck'\nstatic_coefficient_n = 4\nminimum_coefficient_n = 3\nreference_velocity = 1",
        ),
        law(SCALED, "law = 'coulomb'\nfriction_force = true\ncoefficient = 3"),
    ] {
        assert_eq!(judged(&text), (true, true), "{text}");
    }
}

#[test]
fn schema_and_reader_agree_on_noise() {
    let small = SCALED.replace("'sine'", "'noise'").replace("amplitude = 0.1", "amplitude = 0.01");
    let noise = |lines: &str| small.replace("frequency_ratio = 10", lines);
    let si = SI
        .replace("'square'", "'noise'")
        .replace("amplitude_n_rms = 0.1", "amplitude_n_rms = 0.01");
    let in_hertz = si.replace("frequency_hz = 10\nphase = -1", "band_hz = ['1 kHz', 1100]");
    for text in [noise("band = [8, 12]\nlines = 64\nseed = 1"), noise("band = [8, 12]"), in_hertz] {
        assert_eq!(judged(&text), (true, true), "{text}");
    }
    for text in [
        noise(""),
        noise("band = [8, 12]\nfrequency_ratio = 10"),
        noise("band = [8, 12]\nphase = 1"),
        noise("band = [8]"),
        noise("band = [8, 12, 14]"),
        noise("band = [0, 12]"),
        noise("band = [8, 12]\nlines = 0"),
        noise("band = [8, 12]\nlines = 2000"),
        noise("band = [8, 12]\nseed = -1"),
        SCALED.replace("frequency_ratio = 10", "frequency_ratio = 10\nlines = 3"),
    ] {
        assert_eq!(judged(&text), (false, false), "{text}");
    }
}
