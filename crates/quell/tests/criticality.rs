//! `attractor --lyapunov` and the criticality of thresholds through the front door.

use std::fs;
use std::path::Path;

use quell::Study;
use quell::run::exponents::ExponentTimes;
use quell::run::found_attractor::AttractorRequest;
use quell::run::thresholds::ThresholdsRequest;
use quell::verbs::verbs;
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

fn study(text: &str) -> Study {
    Study::parse(text, &[]).unwrap_or_else(|errors| panic!("{errors}"))
}

fn number(value: &Json) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

fn list(value: &Json) -> &[Json] {
    value.as_array().map_or(&[], Vec::as_slice)
}

fn exponents(study: &Study, times: (f64, f64)) -> Json {
    let lyapunov = ExponentTimes { settle: Some(times.0), record: Some(times.1) };
    let request = AttractorRequest { start: Vec::new(), lyapunov: Some(lyapunov) };
    verbs(study).attractor(&request).unwrap_or_else(|why| panic!("{why:?}")).json()
}

fn thresholds(study: &Study, parameter: &str, from: f64, to: f64) -> Json {
    let parameter = parameter.to_owned();
    let request = ThresholdsRequest {
        parameter,
        window: RealInterval::new(from, to),
        ..ThresholdsRequest::default()
    };
    verbs(study).thresholds(&request).unwrap_or_else(|why| panic!("{why:?}")).json()
}

/// Stable periodic motions of independent programs, with and without sticks: the exponents are those of the multipliers.
#[test]
fn exponents_of_periodic_motions_are_those_of_their_multipliers() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../reference/motion.json");
    let reference: Json =
        serde_json::from_str(&fs::read_to_string(path).expect("a file")).expect("JSON");
    let mut compared = 0;
    for case in list(&reference["orbits"]) {
        if case["verdict"] != "stable" {
            continue;
        }
        let study = study(case["study"].as_str().expect("a study"));
        let period = number(&case["period"]);
        let found = exponents(&study, (40.0 * period, 400.0 * period));
        let measured = &found["lyapunov"];
        let Some(agrees) = measured["agrees_with_multipliers"].as_bool() else { continue };
        compared += 1;
        assert!(agrees, "{}: {found}", case["name"]);
        assert_ne!(measured["verdict"], "irregular (chaotic)", "{found}");
        let exponents = list(&measured["exponents"]);
        for (index, exponent) in exponents.iter().enumerate() {
            let why = &found["why"][format!("lyapunov.exponents[{index}]")];
            assert_eq!(exponent.is_null(), why.is_string(), "{found}");
        }
        let known: Vec<f64> = exponents.iter().filter_map(Json::as_f64).collect();
        assert!(known.windows(2).all(|pair| pair[0] >= pair[1]), "{measured}");
    }
    assert!(compared >= 2, "{compared}");
}

const BELT: &str = r#"
[belt]
damping_ratio = 0.01
normal_load = 1.0
belt_velocity = 0.15
[friction]
law = "stribeck"
static_coefficient = 0.4
minimum_coefficient = 0.25
reference_velocity = 0.2
"#;

const SYSTEM: &str = r#"
[system]
coordinates = ["x"]
mass = [1.0]
damping = [[0.02]]
stiffness = [[1.0]]
[[contact]]
name = "belt"
tangent = { x = 1.0 }
normal_load = 1.0
belt_velocity = 0.15
[contact.friction]
law = "stribeck"
static_coefficient = 0.4
minimum_coefficient = 0.25
reference_velocity = 0.2
"#;

/// The Stribeck law has μ‴ = 3(μ_s − μ_m)/v_m³, and the Hopf bifurcation of one mass l₁ = −F μ‴/4.
#[test]
fn the_belt_and_the_belt_as_a_system_have_the_closed_coefficient() {
    let expected = -3.0 * 0.15 / 0.008 / 4.0;
    let belt = thresholds(&study(BELT), "belt.belt_velocity", 0.15, 0.21);
    let system = thresholds(&study(SYSTEM), "contact.belt.belt_velocity", 0.15, 0.21);
    for answer in [belt, system] {
        let [found] = list(&answer["local"]) else { panic!("{answer}") };
        assert_eq!(found["kind"], "hopf", "{answer}");
        assert_eq!(found["criticality"], "supercritical", "{answer}");
        assert!(found["criticality_reason"].is_null());
        let value = number(&found["first_lyapunov_coefficient"]);
        let error = number(&found["first_lyapunov_coefficient_error"]);
        assert!((value - expected).abs() <= error, "{found} {expected}");
        assert!(error < 1e-6 * expected.abs(), "{found}");
        let sentence = answer["sentence"].as_str().expect("a sentence");
        assert!(sentence.contains("supercritical"), "{sentence}");
    }
}

/// The formula of the book for any units: l₁ = −N μ‴ ω/(4m), with the mass, the load and the frequency of the study.
#[test]
fn the_coefficient_of_a_mass_scales_as_the_book_says() {
    let book = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/book/src/theory/orbits.md");
    let book = fs::read_to_string(book).expect("the book");
    assert!(book.contains("l₁ = −N μ‴ω/(4m)"), "the book states the formula that is tested here");
    let (mass, stiffness, load) = (2.5, 40.0, 3.0);
    let text = SYSTEM
        .replace("mass = [1.0]", &format!("mass = [{mass}]"))
        .replace("stiffness = [[1.0]]", &format!("stiffness = [[{stiffness}]]"))
        .replace("normal_load = 1.0", &format!("normal_load = {load}"));
    let answer = thresholds(&study(&text), "contact.belt.belt_velocity", 0.15, 0.21);
    let [found] = list(&answer["local"]) else { panic!("{answer}") };
    let third = 3.0 * 0.15 / 0.008;
    let expected = -load * third * f64::sqrt(stiffness / mass) / (4.0 * mass);
    let value = number(&found["first_lyapunov_coefficient"]);
    assert!((value / expected - 1.0).abs() < 1e-6, "{found} {expected}");
}

/// Under a small fast dither the threshold is a Neimark–Sacker bifurcation whose coefficient is close to T ω l₁.
#[test]
fn a_dithered_belt_keeps_the_criticality_of_the_belt() {
    let dither = "[[dither]]\ndirection = \"tangential\"\nwaveform = \"sine\"\namplitude = 0.001\nfrequency_ratio = 7.3\n";
    let answer = thresholds(&study(&format!("{BELT}{dither}")), "belt.belt_velocity", 0.15, 0.21);
    let [found] = list(&answer["local"]) else { panic!("{answer}") };
    assert_eq!(found["kind"], "neimark-sacker", "{answer}");
    assert_eq!(found["criticality"], "supercritical", "{answer}");
    let expected = -3.0 * 0.15 / 0.008 / 4.0 * std::f64::consts::TAU / 7.3;
    let value = number(&found["first_lyapunov_coefficient"]);
    assert!((value / expected - 1.0).abs() < 1e-2, "{found} {expected}");
}

/// Averaging under a fast dither makes the decreasing law an exponential of the same velocity v_m: at the threshold μ̄′F = −2ζ,
/// and so μ̄‴ = μ̄′/v_m². Over a period T the coefficient is −T F μ̄‴/4 = 2ζT/(4v_m²).
#[test]
fn the_threshold_of_the_dissertation_is_subcritical() {
    let text = "[belt]\ndamping_ratio = 0.005\nnormal_load = 1.0\nbelt_velocity = 1.0\n\
        [friction]\nlaw = \"decreasing\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n\
        [[dither]]\ndirection = \"tangential\"\nwaveform = \"sine\"\namplitude = 4.0\nfrequency_ratio = 10.0\n";
    let answer = thresholds(&study(text), "dither.amplitude", 4.2, 4.4);
    let [found] = list(&answer["local"]) else { panic!("{answer}") };
    assert_eq!(found["criticality"], "subcritical", "{answer}");
    let expected = 0.01 / (4.0 * 0.04) * std::f64::consts::TAU / 10.0;
    let value = number(&found["first_lyapunov_coefficient"]);
    assert!((value / expected - 1.0).abs() < 1e-6, "{value} {expected}");
}

/// Coulomb friction is constant in slip: nothing of second or third order decides.
#[test]
fn linear_equations_have_no_criticality() {
    let text = SYSTEM.replace("law = \"stribeck\"", "law = \"coulomb\"");
    let text = text
        .replace("minimum_coefficient = 0.25\n", "")
        .replace("static_coefficient", "coefficient");
    let text = text.replace("reference_velocity = 0.2\n", "");
    let answer = thresholds(&study(&text), "system.damping[0][0]", -0.1, 0.1);
    let [found] = list(&answer["local"]) else { panic!("{answer}") };
    assert!(found["criticality"].is_null(), "{found}");
    let why = found["criticality_reason"].as_str().expect("a reason");
    assert!(why.contains("linear until a contact sticks"), "{why}");
    assert!(found["first_lyapunov_coefficient"].is_null());
}

/// The limit cycle of the belt: the 0 of a shift in time decides nothing, and sticks erase the other direction.
#[test]
fn a_limit_cycle_is_regular() {
    for text in [BELT, SYSTEM] {
        let text = text.replace("belt_velocity = 0.15", "belt_velocity = 0.05");
        let text = if text.contains("[system]") {
            text + "[system.initial]\nvalues = [0.5, 0.0]\n"
        } else {
            text + "[belt.initial]\ndisplacement = 0.5\nvelocity = 0.0\n"
        };
        let found = exponents(&study(&text), (50.0, 1000.0));
        assert_eq!(found["attractor"]["kind"], "limit-cycle", "{found}");
        let measured = &found["lyapunov"];
        assert_eq!(measured["verdict"], "regular", "{found}");
        assert_eq!(measured["shift_in_time"], 0, "{found}");
        assert_eq!(number(&measured["kaplan_yorke_dimension"]), 1.0, "{found}");
    }
}
