//! Verbs under noise: those about a response that repeats refuse it by name, and say what answers instead.

use crate::place::Place;

const NOISE: &str = r#"
[belt]
damping_ratio = 0.005
normal_load = 1.0
belt_velocity = 0.1
[friction]
law = "stribeck"
static_coefficient = 0.4
minimum_coefficient = 0.2857
reference_velocity = 0.2
[dither]
direction = "tangential"
waveform = "noise"
amplitude = 3.0
band = [8.0, 12.0]
lines = 16
[solver]
settle = 100
record_periods = 10
[[sweep]]
parameter = "dither.amplitude"
from = 0.5
to = 3.0
points = 3
"#;

const SYSTEM: &str = r#"
[system]
coordinates = ["x"]
mass = [1.0]
damping = [0.01]
stiffness = [1.0]
[[contact]]
name = "belt"
tangent = { x = 1.0 }
normal_load = 1.0
belt_velocity = 0.1
[contact.friction]
law = "stribeck"
static_coefficient = 0.4
minimum_coefficient = 0.2857
reference_velocity = 0.2
[[dither]]
at = { x = 1.0 }
waveform = "noise"
amplitude = 3.0
band = [8.0, 12.0]
lines = 16
"#;

fn place(name: &str) -> Place {
    Place::with(name, &[("noise.toml", NOISE), ("system.toml", SYSTEM)])
}

#[test]
fn verbs_about_responses_that_repeat_are_refused() {
    let place = place("noise-refused");
    let range = ["--parameter", "dither.amplitude", "--from", "1", "--to", "2"];
    let with = |verb: &'static str, study: &'static str, more: &[&'static str]| {
        let mut all = vec![verb, study];
        all.extend(more);
        all
    };
    for study in ["noise.toml", "system.toml"] {
        for arguments in [
            with("orbit", study, &[]),
            with("attractor", study, &[]),
            with("thresholds", study, &range),
            with("bifurcation", study, &range),
            with("basins", study, &["--grid", "3x3"]),
            with("waveforms", study, &[]),
        ] {
            let errors = place.refused(&arguments);
            let allowed = errors[0]["allowed"].as_str().expect("a text");
            assert_eq!(errors[0]["key"], "dither.waveform", "{arguments:?}");
            assert!(allowed.contains(arguments[0]) && allowed.contains("simulate"), "{allowed}");
        }
    }
    // A report says which of them it leaves out.
    let report = place.good(&["report", "noise.toml", "--out", "report.html"]);
    assert!(report["answers"].as_array().is_some_and(|answers| answers.len() > 2), "{report}");
    assert!(report["not_examined"].to_string().contains("simulate"), "{report}");
    for arguments in [
        vec!["friction", "noise.toml", "--measured"],
        vec!["map", "noise.toml", "--quantity", "effect", "--save", "map.zarr"],
        vec!["stability", "system.toml", "--exact"],
    ] {
        let errors = place.refused(&arguments);
        assert_eq!(errors[0]["key"], "dither.waveform", "{arguments:?}");
    }
}

#[test]
fn runs_and_averages_have_answers() {
    let place = place("noise-answers");
    for arguments in [
        vec!["check", "noise.toml"],
        vec!["friction", "noise.toml"],
        vec!["friction", "noise.toml", "--describing", "0.3"],
        vec!["stability", "noise.toml"],
        vec!["simulate", "noise.toml", "--until", "20"],
        vec!["response", "noise.toml", "--window", "5:20"],
        vec!["sketch", "noise.toml", "--out", "sketch.svg"],
        vec!["check", "system.toml"],
        vec!["modes", "system.toml"],
        vec!["stability", "system.toml"],
        vec!["simulate", "system.toml", "--until", "20"],
        vec!["response", "system.toml", "--window", "5:20"],
    ] {
        place.good(&arguments);
    }
    let found = place.good(&["response", "noise.toml", "--seeds", "3", "--plot", "seeds.svg"]);
    assert_eq!(found["runs"], 3);
    assert_eq!(found["seeds"], serde_json::json!([1, 2, 3]));
    assert_eq!(found["residual_vibration"].as_array().expect("E").len(), 3);
    assert!(found["cost"]["stroke"].is_null());
    let again = place.good(&["response", "noise.toml", "--seeds", "3"]);
    assert_eq!(again["residual_vibration"], found["residual_vibration"]);
    assert_eq!(place.good(&["response", "noise.toml"])["runs"], 16);
}

#[test]
fn seeds_are_those_of_noise() {
    let place = place("noise-seeds");
    let sine = NOISE.replace("\"noise\"", "\"sine\"");
    let sine = sine.replace("band = [8.0, 12.0]\nlines = 16", "frequency_ratio = 10");
    place.write("sine.toml", &sine);
    let errors = place.refused(&["response", "sine.toml", "--seeds", "3"]);
    assert_eq!(errors[0]["key"], "--seeds");
    let errors = place.refused(&["response", "noise.toml", "--seeds", "0"]);
    assert_eq!(errors[0]["key"], "--seeds");
    let times = ["--settle", "50", "--record", "60"];
    for study in ["system.toml", "noise.toml"] {
        let found = place.good(&[&["response", study, "--seeds", "2"], &times[..]].concat());
        let record = found["record_length"].as_f64();
        assert_eq!((found["runs"].as_u64(), record), (Some(2), Some(60.0)), "{study}");
        assert_eq!(found["contacts"][0]["stick_fraction"].as_array().map(Vec::len), Some(2));
    }
}
