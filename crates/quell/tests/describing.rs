//! The describing function of averaged friction against exact responses.

use quell::Study;
use quell::run::response::ResponseRequest;
use quell::study::BeltStudy;
use quell::verbs::verbs;
use serde_json::Value as Json;

const STUDY: &str = "[belt]\ndamping_ratio = 0.005\nnormal_load = 0.1\nbelt_velocity = 0.12\n[friction]\nlaw = \"stribeck\"\n\
     static_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n[dither]\ndirection = \"tangential\"\n\
     waveform = \"sine\"\namplitude = 2.0\nfrequency_ratio = 20.0\n";

fn study(text: &str) -> BeltStudy {
    BeltStudy::parse(text, &[]).unwrap_or_else(|wrong| panic!("{wrong:?}"))
}

fn describing(study: &BeltStudy, largest: f64) -> Json {
    verbs(&Study::from(study)).describing(largest).expect("a function").json()
}

/// The limit cycle under dither that the describing function predicts is the amplitude of the exact response, up to the orders
/// that averaging and the first harmonic neglect: 1/R = 5 % and F = 0.1 bound them; 0.8 % is found.
#[test]
fn the_limit_cycle_is_that_of_the_exact_response() {
    for (load, velocity, amplitude) in [(0.1, 0.12, 2.0), (0.1, 0.12, 2.2), (0.05, 0.13, 2.0)] {
        let mut study = study(STUDY);
        for (path, value) in [
            ("belt.normal_load", load),
            ("belt.belt_velocity", velocity),
            ("dither.amplitude", amplitude),
        ] {
            study = study.with(path, value).expect("a value");
        }
        let predicted = describing(&study, 0.4);
        let cycle = predicted["limit_cycle_amplitude"].as_f64().expect("a cycle");
        let exact = verbs(&Study::from(&study)).response(&ResponseRequest::default());
        let exact = exact.expect("a response").json();
        let measured = exact["amplitude"].as_f64().expect("an amplitude");
        let off = cycle / measured - 1.0;
        assert!(off.abs() < 0.05, "{load} {velocity} {amplitude}: {cycle} {measured}");
    }
}

#[test]
fn answers_for_every_reader() {
    let study = study(STUDY);
    let json = describing(&study, 0.4);
    let limit = json["limit"]["limit_cycle_velocity"].as_f64().expect("a cycle");
    assert!((limit - 0.02132568).abs() < 1e-8);
    // At the finite R of the study the amplitude changes by the order of 1/R².
    let own = json["limit_cycle_velocity"].as_f64().expect("a cycle");
    assert!(own != limit && (own / limit - 1.0).abs() < 0.05, "{own} {limit}");
    assert_eq!(json["limit_cycles"].as_array().map(Vec::len), Some(1));
    assert!(json["contacts"][0]["gain"].as_array().is_some_and(|gains| gains.len() > 100));
    // The cycle is larger than the largest amplitude.
    let small = describing(&study, 0.01);
    assert!(small["limit_cycle_velocity"].is_null());
    assert!(small["why"]["limit_cycle_velocity"].as_str().expect("why").contains("grow"));
    for wrong in [0.0, -1.0, f64::INFINITY] {
        assert!(verbs(&Study::from(&study)).describing(wrong).is_err());
    }
    // The load of mode coupling follows the motion: the contacts have gains, and no slow vibration follows.
    let coupled = Study::parse(include_str!("../../../studies/mode-coupling-dither.toml"), &[])
        .expect("a study");
    let found = verbs(&coupled).describing(0.1).expect("gains").json();
    assert!(found["limit_cycle_velocity"].is_null() && found["limit_cycles"].is_null());
    assert!(found["why"]["limit_cycles"].as_str().expect("why").contains("follows the motion"));
    assert!(found["contacts"][0]["gain"].as_array().is_some_and(|gains| gains.len() >= 100));
}
