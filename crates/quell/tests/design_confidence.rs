//! `design` with `confidence`: the least amplitude that is quiet in a share of random samples.

use quell::verbs::verbs;
use quell::{Failure, Study};
use serde_json::Value as Json;

const FRICTION: &str = "law = \"stribeck\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.25\n";

fn asked(text: &str) -> Result<Json, Failure> {
    let study = Study::parse(text, &[]).map_err(Failure::Wrong)?;
    Ok(verbs(&study).design()?.facts())
}

fn designed(text: &str) -> Json {
    asked(text).unwrap_or_else(|why| panic!("{why}: {text}"))
}

fn refused(text: &str) -> String {
    match asked(text) {
        Err(why) => why.to_string(),
        Ok(_) => panic!("accepted: {text}"),
    }
}

fn number(value: &Json) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("no number: {value}"))
}

/// A belt in SI whose dither must overcome its inertia: the heavier the mass, the larger the amplitude.
fn in_si(mass: f64, rest: &str) -> String {
    format!(
        "[belt]\nmass_kg = {mass}\nstiffness_n_per_m = 100.0\ndamping_n_s_per_m = 0.1\nnormal_force_n = 100.0\n\
         belt_velocity_m_per_s = 1.0\n[friction]\n{FRICTION}reference_velocity_m_per_s = 5.0\n[dither]\ndirection = \"tangential\"\n\
         waveform = \"sine\"\namplitude_n = 100.0\nfrequency_hz = 16.0\n[design]\nminimise = \"amplitude\"\n\
         vary = [\"dither.amplitude_n\"]\nfrom = [1.0]\nto = [2000.0]\n{rest}"
    )
}

/// The amplitude grows with the mass, so that the amplitude of a share of the samples is that of the mass of this share: in units that
/// do not change with the sample.
#[test]
fn a_confident_amplitude_is_that_of_the_quantile() {
    let over = "[design.over]\n\"belt.belt_velocity_m_per_s\" = [0.5, 1.0]\n";
    let uncertain = "[uncertainty]\n\"belt.mass_kg\" = { uniform = [0.5, 1.5] }\n";
    let found =
        designed(&in_si(1.0, &format!("confidence = 0.9\nsamples = 400\n{over}{uncertain}")));
    let confident = &found["confident"];
    let of_mass = |mass: f64| number(&designed(&in_si(mass, over))["objective"]);
    let (low, high) = (number(&confident["low"]), number(&confident["high"]));
    let amplitude = number(&confident["amplitude"]);
    assert_eq!(amplitude, number(&confident["parameters"]["dither.amplitude_n"]));
    assert!(low < amplitude && amplitude < high);
    let exact = of_mass(1.4);
    assert!(low < exact * 1.005 && exact < high, "{low} {exact} {high}");
    // The interval of a share of 0.9 of 400 samples is about 0.866 to 0.926.
    assert!(low > of_mass(1.355) && high < of_mass(1.435) * 1.005, "{low} {amplitude} {high}");
    let ratio = amplitude / number(&found["objective"]);
    assert!((number(&confident["over_least"]) / ratio - 1.0).abs() < 1e-12);
    assert_eq!(confident["allowed"], true);
}

/// A belt and the same equations as a system have the same samples.
#[test]
fn a_belt_and_its_system_agree() {
    let design = "[design]\nminimise = \"amplitude\"\nvary = [\"dither.amplitude\"]\nfrom = [0.1]\nto = [20.0]\nconfidence = 0.8\n\
                  samples = 60\nseed = 3\n";
    let belt = format!(
        "[belt]\ndamping_ratio = 0.005\nnormal_load = 1.0\nbelt_velocity = 0.3\n[friction]\n{FRICTION}reference_velocity = 0.5\n\
         [dither]\ndirection = \"tangential\"\nwaveform = \"sine\"\namplitude = 1.0\nfrequency_ratio = 10.0\n{design}\
         [uncertainty]\n\"friction.reference_velocity\" = {{ normal = [0.5, 0.02] }}\n"
    );
    let system = format!(
        "[system]\ncoordinates = [\"x\"]\nmass = [1.0]\ndamping = [0.01]\nstiffness = [1.0]\n[[contact]]\nname = \"pad\"\n\
         tangent = {{ x = 1.0 }}\nnormal_load = 1.0\nbelt_velocity = 0.3\n[contact.friction]\n{FRICTION}reference_velocity = 0.5\n\
         [[dither]]\nat = {{ x = 1.0 }}\nwaveform = \"sine\"\namplitude = 1.0\nfrequency = 10.0\n{design}\
         [uncertainty]\n\"contact.pad.friction.reference_velocity\" = {{ normal = [0.5, 0.02] }}\n"
    );
    let [belt, system] = [belt, system].map(|text| designed(&text)["confident"].clone());
    for key in ["amplitude", "low", "high"] {
        let (a, b) = (number(&belt[key]), number(&system[key]));
        assert!((a / b - 1.0).abs() < 1e-6, "{key}: {a} {b}");
    }
    assert!(number(&belt["over_least"]) > 1.0);
}

/// Where the larger amplitude of the samples exceeds a limit, the frequency is chosen again so that it does not.
#[test]
fn limits_hold_at_the_amplitude_of_the_samples() {
    let text = |limit: f64| {
        in_si(
            1.0,
            &format!(
                "confidence = 0.9\nsamples = 60\n[design.limits]\nstroke_m = {limit}\n[uncertainty]\n\
                 \"belt.mass_kg\" = {{ normal = [1.0, 0.05] }}\n"
            ),
        )
        .replace("[\"dither.amplitude_n\"]", "[\"dither.amplitude_n\", \"dither.frequency_hz\"]")
        .replace("from = [1.0]\nto = [2000.0]", "from = [1.0, 4.0]\nto = [2000.0, 40.0]")
    };
    let found = designed(&text(0.02));
    let confident = &found["confident"];
    assert_eq!(
        (&confident["allowed"], &found["binding"][0]),
        (&Json::from(true), &"stroke".into())
    );
    assert!((number(&confident["limits"][0]["used"]) - 1.0).abs() < 2e-3);
    let frequency = |value: &Json| number(&value["dither.frequency_hz"]);
    assert!(frequency(&confident["parameters"]) > frequency(&found["critical"]));
}

#[test]
fn complaints_name_the_place() {
    let uncertain = "[uncertainty]\n\"belt.mass_kg\" = { uniform = [0.5, 1.5] }\n";
    let of = |rest: &str| refused(&in_si(1.0, rest));
    assert!(of("confidence = 0.9\n").contains("uncertainty"));
    for (keys, expected) in [
        ("confidence = 1.0", "design.confidence"),
        ("confidence = 0.0", "design.confidence"),
        ("confidence = 0.9\nsamples = 5", "design.samples"),
        ("confidence = 0.9\nsamples = 40.5", "whole number"),
        ("confidence = 0.9\nseed = -1", "design.seed"),
        ("samples = 50", "design.confidence"),
        ("confidence = 0.9\nstart = \"rest\"", "design.start"),
    ] {
        let said = of(&format!("{keys}\n{uncertain}"));
        assert!(said.contains(expected), "{keys}: {said}");
    }
    let both = "confidence = 0.9\n[design.over]\n\"belt.belt_velocity_m_per_s\" = [0.5, 1.0]\n[uncertainty]\n\
                \"belt.belt_velocity_m_per_s\" = { uniform = [0.5, 1.0] }\n";
    assert!(of(both).contains("belt.belt_velocity_m_per_s"));
    let without = designed(&in_si(1.0, ""));
    assert!(without["confident"].is_null());
}
