//! Where runs of systems end, in cases that readers of the answers found wrong: each is compared with an identity, with the same belt,
//! or with numbers by hand.

use std::io::Write;
use std::process::{Command, Stdio};

use serde_json::Value as Json;

/// The answer about a study given on standard input.
fn answer(study: &str, arguments: &[&str]) -> Json {
    let (verb, options) = arguments.split_first().expect("a verb");
    let mut quell = Command::new(env!("CARGO_BIN_EXE_quell"))
        .args([verb, "-", "--json"])
        .args(options)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("quell runs");
    quell.stdin.take().expect("standard input").write_all(study.as_bytes()).expect("written");
    let output = quell.wait_with_output().expect("an end");
    serde_json::from_slice(&output.stdout).unwrap_or_else(|why| {
        panic!("{arguments:?}: {why}\n{}", String::from_utf8_lossy(&output.stderr))
    })
}

fn number(value: &Json) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// One mass on a belt with Coulomb friction 0.3.
fn block(damping: f64, velocity: f64) -> String {
    format!(
        "[system]\ncoordinates = [\"x\"]\nmass = [1.0]\ndamping = [{damping:?}]\nstiffness = [1.0]\n[[contact]]\nname = \"c\"\n\
         tangent = {{ x = 1.0 }}\nnormal_load = 1.0\nbelt_velocity = {velocity:?}\n[contact.friction]\nlaw = \"coulomb\"\ncoefficient = 0.3\n"
    )
}

/// A pad with normal coupling and a rotor, in SI.
const PAD: &str = r#"
[system]
units = "SI"
coordinates = ["x", "z", "r"]
mass = [0.4, 0.4, 2.0]
damping = [40.0, 40.0, 60.0]
stiffness = [[9.0e7, -3.0e7, 0], [-3.0e7, 2.4e8, 0], [0, 0, 2.4e8]]
[[contact]]
name = "pad"
tangent = { x = 1.0 }
normal = { z = 1.0, r = -1.0 }
normal_load = "2 kN"
normal_stiffness = 4e8
belt_velocity = 0.2
[contact.friction]
law = "stribeck-exponential"
static_coefficient = 0.1
coefficient = 0.08
reference_velocity = 0.3
"#;

/// A run that comes back to its states after nine periods is on a cycle of one.
#[test]
fn a_cycle_has_its_least_period_from_every_start() {
    let start = "x=4.58037e-6,z=2.06785e-7,r=3.14115e-8,velocity.x=0.2,velocity.z=-0.0354456,velocity.r=-0.0657394";
    let from_rest = answer(PAD, &["attractor"]);
    let from_there = answer(PAD, &["attractor", "--start", start]);
    let period = |found: &Json| number(&found["attractor"]["period"]);
    let (one, other) = (period(&from_rest), period(&from_there));
    assert!((one - other).abs() < 1e-9 * one, "{one} {other}");
    // Extremes are exact, not those of samples, so that both starts show the same.
    let size = |found: &Json| number(&found["attractor"]["peak_to_peak"]);
    assert!((size(&from_rest) - size(&from_there)).abs() < 1e-9 * size(&from_rest));
}

/// Two quiet sweeps show the same motion, however small the rounding that they compare.
#[test]
fn quiet_sweeps_have_no_hysteresis() {
    let sweep =
        ["--parameter", "contact.c.belt_velocity", "--from", "0.5", "--to", "2", "--points", "4"];
    let found = answer(&block(0.1, 1.0), &[&["bifurcation"], &sweep[..]].concat());
    assert_eq!(found["hysteresis"].as_array().map(Vec::len), Some(0), "{}", found["sentence"]);
    for point in found["up"].as_array().expect("points") {
        assert_eq!(point["words"], "steady sliding");
    }
}

/// The exponents of steady sliding under Coulomb friction are −c/2.
#[test]
fn exponents_of_steady_sliding_are_growth_rates() {
    for damping in [0.02, 0.2, 1.0] {
        let found = answer(&block(damping, 1.0), &["attractor", "--lyapunov"]);
        let exponents = found["lyapunov"]["exponents"].as_array().expect("exponents").clone();
        for exponent in exponents {
            assert!((number(&exponent) + 0.5 * damping).abs() < 1e-12, "{exponent}");
        }
        assert_eq!(found["lyapunov"]["verdict"], "regular");
    }
    let belt = "[belt]\ndamping_ratio = 0.05\nnormal_load = 1.0\nbelt_velocity = 1\n[friction]\nlaw = \"coulomb\"\ncoefficient = 0.3\n";
    let found = answer(belt, &["attractor", "--lyapunov"]);
    assert!((number(&found["lyapunov"]["deciding"]) + 0.05).abs() < 1e-12, "{found}");
}

/// A dither slower than the vibration leaves it in the band: the system and the belt find the same effect.
#[test]
fn a_slow_dither_is_judged_as_for_the_belt() {
    let friction = "law = \"stribeck\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.5\n";
    let system = format!(
        "[system]\ncoordinates = [\"x\"]\nmass = [1.0]\ndamping = [0.02]\nstiffness = [1.0]\n[[contact]]\nname = \"c\"\ntangent = {{ x = 1.0 }}\n\
         normal_load = 1.0\nbelt_velocity = 0.1\n[contact.friction]\n{friction}[[dither]]\nat = {{ x = 1.0 }}\nwaveform = \"sine\"\n\
         amplitude = 0.02\nfrequency = 0.5\n"
    );
    let belt = format!(
        "[belt]\ndamping_ratio = 0.01\nnormal_load = 1.0\nbelt_velocity = 0.1\n[friction]\n{friction}[dither]\ndirection = \"tangential\"\n\
         waveform = \"sine\"\namplitude = 0.02\nfrequency_ratio = 0.5\n"
    );
    let (system, belt) = (answer(&system, &["response"]), answer(&belt, &["response"]));
    assert_eq!(system["effect"], belt["effect"], "{}", system["sentence"]);
    let (one, other) = (number(&system["residual_vibration"]), number(&belt["residual_vibration"]));
    assert!((one - other).abs() < 0.01, "{one} {other}");
    assert_eq!(number(&system["band_end"]), 1.9);
    // The mean friction is compared with that of the undithered run, and with steady sliding under its own name.
    let contact = &system["contacts"][0];
    let (without, steady) =
        (&contact["mean_friction_undithered"], &contact["steady_sliding_friction"]);
    assert!(
        (number(without) - number(&belt["contacts"][0]["mean_friction_undithered"])).abs() < 1e-3
    );
    assert!(
        (number(steady) - number(&belt["contacts"][0]["steady_sliding_friction"])).abs() < 1e-12
    );
}

/// A mass that comes to rest at the very edge of stick stays there: no events accumulate, and no time is lost.
#[test]
fn a_mass_rests_at_the_edge_of_stick() {
    for velocity in ["1e-3", "1e-5", "1e-7", "1e-8", "1e-9", "0"] {
        let start = format!("x=0.3,velocity.x={velocity}");
        let found = answer(&block(0.2, 0.0), &["simulate", "--until", "20", "--start", &start]);
        assert_eq!(found["ok"], true, "{velocity}: {found}");
        assert!(found["events"].as_array().is_some_and(|events| events.len() <= 4), "{velocity}");
        let x = number(&found["final"]["state"][0]);
        assert!((x - 0.3).abs() < 1e-5, "{velocity}: {x}");
    }
}

/// A motion decays to nothing without a limit on its steps.
#[test]
fn a_decaying_motion_may_underflow() {
    let study = block(0.2, 1.0).replace("coefficient = 0.3", "coefficient = 0.0");
    let found = answer(&study, &["simulate", "--until", "20000", "--start", "x=0.3"]);
    assert_eq!(found["ok"], true, "{found}");
    assert!(number(&found["final"]["state"][0]).abs() < 1e-300);
}
