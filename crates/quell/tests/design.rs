//! `design` of a belt: units, complaints with their keys, and several waveforms.

use quell::Study;
use quell::run::protocol::Protocol;
use quell::run::thresholds::ThresholdsRequest;
use quell::verbs::verbs;
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

use crate::designs::{complaint, facts};

const BELT: &str = "[belt]\ndamping_ratio = 0.005\nnormal_load = 1.0\nbelt_velocity = 0.1\n[friction]\nlaw = \"stribeck\"\n\
                    static_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n[dither]\n\
                    direction = \"tangential\"\nwaveform = \"sine\"\namplitude = 1.0\nfrequency_ratio = 10.0\n";

const DESIGN: &str = "[design]\nminimise = \"amplitude\"\nvary = [\"dither.amplitude\"]\nfrom = [0.01]\nto = [20.0]\n\
                      waveforms = [\"sine\", \"triangle\", \"square\"]\n[design.over]\n\"belt.belt_velocity\" = [0.05, 0.15]\n";

/// An independent program: 0.9486004564844978 for the square wave, which needs least.
#[test]
fn the_best_of_several_waveforms() {
    let found = facts(&format!("{BELT}{DESIGN}"));
    assert_eq!(found["feasible"], true);
    assert_eq!(found["waveform"], "square");
    let amplitude = found["critical"]["dither.amplitude"].as_f64().expect("a number");
    assert!((amplitude / 0.9486004564844978 - 1.0).abs() < 1e-6, "{amplitude}");
    assert_eq!(found["worst"]["belt.belt_velocity"], 0.15);
    let verified = found["parameters"]["dither.amplitude"].as_f64().expect("a number");
    assert!((verified / amplitude - 1.001).abs() < 1e-12);
    assert!(found["verified"]["multiplier"].as_f64().expect("a number") < 1.0);
    assert_eq!(found["waveforms"].as_array().map(Vec::len), Some(3));
}

/// The belt in SI with ω₀ = 10 rad/s and k = 200 N/m has the same answer: D k in newtons.
#[test]
fn a_study_in_si_has_the_same_answer() {
    let belt = "[belt]\nmass_kg = 2.0\nstiffness_n_per_m = 200.0\ndamping_ratio = 0.005\nnormal_force_n = 200.0\n\
                belt_velocity_m_per_s = 1.0\n[friction]\nlaw = \"stribeck\"\nstatic_coefficient = 0.4\n\
                minimum_coefficient = 0.2857\nreference_velocity_m_per_s = 2.0\n[dither]\ndirection = \"tangential\"\n\
                waveform = \"sine\"\namplitude_n = 200.0\nfrequency_hz = 15.915494309189533\n";
    let design = "[design]\nminimise = \"stroke\"\nvary = [\"dither.amplitude_n\"]\nfrom = [2.0]\nto = [4000.0]\n[design.over]\n\
                  \"belt.belt_velocity_m_per_s\" = [0.5, 1.5]\n[design.limits]\nstroke_m = 0.5\namplitude_n = 1000.0\nresponse_peak_m = 0.2\n";
    let found = facts(&format!("{belt}{design}"));
    let newtons = found["critical"]["dither.amplitude_n"].as_f64().expect("a number");
    assert!((newtons / (200.0 * 1.4863197137178406) - 1.0).abs() < 1e-6, "{newtons}");
    assert_eq!(found["worst"]["belt.belt_velocity_m_per_s"], 1.5);
    // 2 D/(R² − 1) metres, with the damping's part of 10⁻⁶.
    let stroke = found["objective"].as_f64().expect("a number");
    assert!((stroke / (2.0 * 1.4863197137178406 / 99.0) - 1.0).abs() < 1e-5, "{stroke}");
    assert_eq!(found["binding"].as_array().map(Vec::len), Some(0));
    // The exact response is about as large: 10 % above it nothing binds, and 10 % below it nothing is allowed.
    let peak = found["response_peak"].as_f64().expect("a number");
    assert!((2.0 * peak / stroke - 1.0).abs() < 0.05, "{peak} {stroke}");
    let limited = |factor: f64| {
        let limit = format!("response_peak_m = {}", factor * peak);
        facts(&format!("{belt}{design}").replace("response_peak_m = 0.2", &limit))
    };
    assert_eq!(limited(1.1)["critical"], found["critical"]);
    assert_eq!(limited(0.9)["feasible"], false);
    assert_eq!(found["schedule"].as_array().map(Vec::len), Some(33));
}

#[test]
fn wrong_designs_are_refused_with_their_keys() {
    let with = |from: &str, to: &str| complaint(&format!("{BELT}{DESIGN}").replace(from, to));
    for (from, to, key) in [
        ("minimise = \"amplitude\"", "minimise = \"amplitud\"", "design.minimise"),
        ("to = [20.0]", "to = [0.001]", "design.to[0]"),
        ("to = [20.0]", "to = [20.0, 3.0]", "design.vary"),
        ("[0.05, 0.15]", "[0.15, 0.05]", "design.over"),
        ("\"belt.belt_velocity\" = ", "\"belt.belt_velcity\" = ", "design.over"),
        ("\"belt.belt_velocity\" = ", "\"dither.amplitude\" = ", "design.over"),
        ("\"square\"]", "\"sqare\"]", "design.waveforms[2]"),
        ("\"square\"]", "\"burst\"]", "design.waveforms[2]"),
        ("vary = [\"dither.amplitude\"]", "vary = [\"dither.frequency_ratio\"]", "design.vary"),
        ("[0.05, 0.15]", "[-0.05, 0.15]", "design.over"),
        (
            "[design.over]",
            "[design.limits]\nresponse_rms = -1\n[design.over]",
            "limits.response_rms",
        ),
        (
            "[design.over]",
            "[design.limits]\nresponse_peak_m = 1.0\n[design.over]",
            "response_peak_m",
        ),
    ] {
        let said = with(from, to);
        assert!(said.contains(key), "{to}: {said}");
    }
    assert!(complaint(BELT).contains("design"));
    let without = BELT.split("[dither]").next().expect("a part");
    let said = complaint(&format!("{without}{}", DESIGN.replace("\"sine\", \"triangle\", ", "")));
    assert!(said.contains("dither"), "{said}");
}

/// Runs from rest and from squeal: the least amplitude is that of `thresholds` from the same start, whose runs have the same judge.
#[test]
fn designs_for_runs_agree_with_the_thresholds_of_runs() {
    for (start, protocol) in [("rest", Protocol::Rest), ("squeal", Protocol::Squeal)] {
        let design = format!(
            "[design]\nminimise = \"amplitude\"\nvary = [\"dither.amplitude\"]\nfrom = [0.01]\nto = [20.0]\nstart = \"{start}\"\n"
        );
        let found = facts(&format!("{BELT}{design}"));
        let least = found["critical"]["dither.amplitude"].as_f64().expect("a number");
        let request = ThresholdsRequest {
            parameter: "dither.amplitude".to_owned(),
            window: RealInterval::new(0.01, 20.0),
            protocols: vec![protocol.clone()],
            ..ThresholdsRequest::default()
        };
        let study = Study::parse(BELT, &[]).expect("a study");
        let json = verbs(&study).thresholds(&request).expect("thresholds").json();
        let changes = json[protocol.name()].as_array().expect("changes");
        let last = changes.last().and_then(|change| change["value"].as_f64()).expect("a number");
        assert!((least / last - 1.0).abs() < 2e-5, "{start}: {least} and {last}");
    }
}

/// Two limits that leave a narrow range of frequencies, between the points of the grid, and a range of amplitudes that ends between the
/// averaged and the exact least one: the answer is that of a wider range.
#[test]
fn narrow_choices_are_found() {
    let design = |to: f64, limits: &str| {
        facts(&format!(
            "{BELT}[design]\nminimise = \"amplitude\"\nvary = [\"dither.amplitude\", \"dither.frequency_ratio\"]\n\
             from = [0.01, 2.0]\nto = [{to}, 20.0]\n[design.over]\n\"belt.belt_velocity\" = [0.05, 0.2]\n\
             [design.limits]\nstroke = 0.04\n{limits}"
        ))
    };
    let amplitude = |found: &Json| found["critical"]["dither.amplitude"].as_f64();
    let wide = amplitude(&design(20.0, "")).expect("feasible");
    for found in [design(20.0, "amplitude = 1.31\n"), design(1.31, ""), design(1.302, "")] {
        let least = amplitude(&found).unwrap_or_else(|| panic!("{found}"));
        assert!((least / wide - 1.0).abs() < 1e-4, "{least} {wide}");
    }
    let too_small = design(20.0, "amplitude = 1.29\n");
    assert_eq!(too_small["feasible"], false, "{too_small}");
}

/// The largest amplitude of the range is the least stroke: more force at a higher frequency needs less of it.
#[test]
fn the_end_of_the_range_of_amplitudes_may_be_the_answer() {
    let found = facts(&format!(
        "{BELT}[design]\nminimise = \"stroke\"\nvary = [\"dither.amplitude\", \"dither.frequency_ratio\"]\n\
         from = [0.01, 2.0]\nto = [2.0, 20.0]\n[design.over]\n\"belt.belt_velocity\" = [0.05, 0.2]\n"
    ));
    let critical = &found["critical"];
    assert!(
        (critical["dither.amplitude"].as_f64().expect("feasible") - 2.0).abs() < 1e-3,
        "{found}"
    );
    assert!(critical["dither.frequency_ratio"].as_f64().expect("a number") > 12.0, "{found}");
    assert!(found["binding"].to_string().contains("amplitude"), "{found}");
}
