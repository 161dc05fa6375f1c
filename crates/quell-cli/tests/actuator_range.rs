//! `quell actuator`: closed forms of a sine, agreement of belt and system and with `design`, and what is said where nothing suffices.

use std::f64::consts::TAU;

use serde_json::Value as Json;

use crate::place::Place;

/// A pad of 0.1 kg on 370 N/µm, its stack included.
const BELT: &str = r#"
[belt]
mass_kg = 0.1
stiffness_n_per_m = 370e6
damping_ratio = 0.005
normal_force_n = 1500
belt_velocity_m_per_s = 0.1

[friction]
law = "stribeck"
static_coefficient = 0.4
minimum_coefficient = 0.2857
reference_velocity_m_per_s = 0.5

[dither]
direction = "tangential"
waveform = "sine"
amplitude_n = 1000
frequency_hz = 20000

[design]
minimise = "amplitude"
vary = ["dither.amplitude_n"]
from = [1.0]
to = [50000.0]
"#;

/// The same as a system, in millimetres.
const SYSTEM: &str = r#"
[system]
units = "mm-t-s"
coordinates = ["pad"]
mass_kg = [0.1]
stiffness_n_per_m = [370e6]
damping_n_s_per_m = [60.8276253029822]

[[contact]]
name = "shoe"
tangent = { pad = 1 }
normal_load = 1500
belt_velocity_m_per_s = 0.1

[friction]
law = "stribeck"
static_coefficient = 0.4
minimum_coefficient = 0.2857
reference_velocity_m_per_s = 0.5

[[dither]]
at = { pad = 1 }
waveform = "sine"
amplitude = 1000
frequency_hz = 20000

[design]
minimise = "amplitude"
vary = ["dither.amplitude"]
from = [1.0]
to = [50000.0]
"#;

/// The spring of the stack is part of the structure.
const STACK: &str = r#"
[actuator]
kind = "piezo"
blocked_force_n = 7000
capacitance_f = 2.1e-6
maximum_voltage = 150
maximum_current = 15
"#;

const RANGE: [&str; 2] = ["--frequency", "12kHz:40kHz"];

fn number(value: &Json, path: &str) -> f64 {
    let found = path.split('.').fold(value, |at, key| match key.parse::<usize>() {
        Ok(place) => &at[place],
        Err(_) => &at[key],
    });
    found.as_f64().unwrap_or_else(|| panic!("{path}: {value}"))
}

fn close(value: f64, exact: f64, within: f64, what: &str) {
    assert!((value / exact - 1.0).abs() < within, "{what}: {value} should be {exact}");
}

/// The largest force of the current: I F_b/(ω C U_max).
fn by_current(hertz: f64) -> f64 {
    15.0 * 7000.0 / (TAU * hertz * 2.1e-6 * 150.0)
}

#[test]
fn a_stack_gives_what_its_voltage_and_its_current_allow() {
    let place = Place::with(
        "range-piezo",
        &[("belt.toml", &format!("{BELT}{STACK}")), ("system.toml", &format!("{SYSTEM}{STACK}"))],
    );
    // Half of the range of the voltage on both sides of the bias: 3500 N, until the current allows less.
    let change = 15.0 * 7000.0 / (TAU * 3500.0 * 2.1e-6 * 150.0);
    let mut answers = Vec::new();
    for study in ["belt.toml", "system.toml"] {
        let done = place.good(&["actuator", study, RANGE[0], RANGE[1]]);
        let changes = done["changes"].as_array().expect("a list");
        assert_eq!(changes.len(), 1, "{done}");
        close(number(&changes[0], "frequency") / TAU, change, 1e-12, study);
        assert_eq!(changes[0]["below"], "actuator.maximum_voltage");
        assert_eq!(changes[0]["above"], "actuator.maximum_current");
        close(number(&done, "own.amplitude"), by_current(20000.0), 1e-12, study);
        close(number(&done, "own.used"), 1000.0 / by_current(20000.0), 1e-12, study);
        // The slip velocity of a sine is Fω/|k + iωd − mω²|.
        let omega = TAU * 20000.0;
        let (re, im) = (370e6 - 0.1 * omega * omega, omega * 60.8276253029822);
        // The system is in millimetres.
        let millimetres = if study == "system.toml" { 1e3 } else { 1.0 };
        let slip = millimetres * by_current(20000.0) * omega / re.hypot(im);
        close(number(&done, "own.contacts.0.slip_velocity"), slip, 1e-9, study);
        answers.push(done);
    }
    let [belt, system] = &answers[..] else { panic!("two answers") };
    for path in ["own.needed", "best.margin"] {
        close(number(system, path), number(belt, path), 1e-12, path);
    }
    close(number(belt, "best.frequency") / TAU, 12000.0, 1e-12, "the resonance is below the range");
    close(
        number(system, "best.frequency") / TAU,
        12000.0,
        1e-12,
        "the resonance is below the range",
    );
}

/// At the ends of a band inside the range the margin is 1; the requirement is that of a design at one operating point.
#[test]
fn ends_are_exact_and_the_requirement_is_that_of_design() {
    let place = Place::with("range-ends", &[("belt.toml", &format!("{BELT}{STACK}"))]);
    let done = place.good(&["actuator", "belt.toml", RANGE[0], RANGE[1]]);
    assert_eq!(done["can_quench"], true);
    let bands = done["sufficient"].as_array().expect("a list");
    let mut inner = 0;
    for band in bands {
        for end in ["from", "to"] {
            let at = number(band, end) / TAU;
            if [12000.0, 40000.0].iter().any(|end| (at / end - 1.0).abs() < 1e-12) {
                continue;
            }
            inner += 1;
            let set = format!("dither.frequency_hz={at:?}");
            let there = place.good(&["actuator", "belt.toml", RANGE[0], RANGE[1], "--set", &set]);
            close(number(&there, "own.margin"), 1.0, 1e-9, end);
        }
    }
    assert!(inner > 0, "{done}");
    let designed = place.good(&["design", "belt.toml", "--set", "actuator.maximum_current=1000"]);
    let averaged = &designed["averaged"]["dither.amplitude_n"];
    let needed = number(&done, "own.needed");
    close(averaged.as_f64().expect("a number"), needed, 1e-9, "averaged");
}

#[test]
fn a_controller_gives_nothing_beyond_half_its_rate() {
    let motor = "[actuator]\nkind = \"motor\"\nforce_per_ampere_n_per_a = 40\nrms_current = 100\nsample_rate_hz = 60000\n";
    let place = Place::with("range-motor", &[("belt.toml", &format!("{BELT}{motor}"))]);
    let done = place.good(&["actuator", "belt.toml", RANGE[0], RANGE[1]]);
    close(number(&done, "changes.0.frequency") / TAU, 30000.0, 1e-12, "half the rate");
    assert_eq!(done["changes"][0]["above"], "actuator.sample_rate");
    close(number(&done, "own.amplitude"), 40.0 * 100.0 * 2f64.sqrt(), 1e-12, "amplitude");
    let warnings = done["warnings"].to_string();
    assert!(warnings.contains("fewer than 10 samples"), "{warnings}");
    // A third harmonic needs three times the rate.
    let place = Place::with(
        "range-fourier",
        &[(
            "belt.toml",
            &format!("{BELT}{motor}").replace(
                "waveform = \"sine\"",
                "waveform = \"fourier\"\nharmonics = [{ order = 1, sine = 1.0 }, { order = 3, sine = 0.2 }]",
            ),
        )],
    );
    let done = place.good(&["actuator", "belt.toml", "--frequency", "5kHz:40kHz"]);
    close(number(&done, "changes.0.frequency") / TAU, 10000.0, 1e-12, "a sixth of the rate");
}

#[test]
fn what_cannot_be_answered_is_said() {
    let place =
        Place::with("range-none", &[("belt.toml", &format!("{BELT}{STACK}")), ("bare.toml", BELT)]);
    let quiet = place.good(&["actuator", "belt.toml", "--set", "belt.belt_velocity_m_per_s=2"]);
    assert_eq!(quiet["quiet_without"], true);
    assert!(quiet["sentence"].as_str().expect("words").contains("nothing to quench"), "{quiet}");
    assert_eq!(quiet["own"]["margin"], Json::Null);
    let weak = place.good(&[
        "actuator",
        "belt.toml",
        RANGE[0],
        RANGE[1],
        "--set",
        "actuator.maximum_current=10 mA",
    ]);
    assert_eq!(weak["can_quench"], false);
    assert!(weak["sentence"].as_str().expect("words").contains("cannot quench"), "{weak}");
    let square = place.json(&["actuator", "belt.toml", "--set", "dither.waveform=square"]);
    assert_eq!(square.1, 1, "{}", square.0);
    assert!(square.0.to_string().contains("the voltage jumps"), "{}", square.0);
    let missing = place.refused(&["actuator", "bare.toml"]);
    assert_eq!(missing[0]["key"], "actuator");
    let range = place.refused(&["actuator", "belt.toml", "--frequency", "3kHz:2kHz"]);
    assert_eq!(range[0]["key"], "--frequency");
}

/// What an elastic slider needs is no average of its law.
#[test]
fn contacts_with_a_state_are_refused() {
    let belt = format!("{BELT}{STACK}");
    let system = format!("{SYSTEM}{STACK}");
    let files = [("belt.toml", &belt), ("system.toml", &system)];
    let place = Place::with("range-state", &files.map(|(name, text)| (name, text.as_str())));
    for (file, key) in [
        ("belt.toml", "belt.tangential_stiffness"),
        ("system.toml", "contact.shoe.tangential_stiffness"),
    ] {
        let set = format!("{}=1e9", key.replace("stiffness", "stiffness_n_per_m"));
        let refused = place.refused(&["actuator", file, "--set", &set]);
        assert_eq!(refused[0]["key"], key, "{refused:?}");
        assert!(refused[0]["allowed"].as_str().expect("words").contains("rigid"), "{refused:?}");
    }
}

#[test]
fn a_measured_actuator_has_the_range_of_its_file() {
    let table = "[actuator]\nkind = \"frf\"\nfile = \"stack.csv\"\nmaximum_voltage = 75\n";
    let place = Place::with(
        "range-measured",
        &[
            ("belt.toml", &format!("{BELT}{table}")),
            (
                "stack.csv",
                "frequency_hz,force_per_volt_n_per_v,maximum_force_n\n13000,40,3500\n20000,45,3000\n30000,20,3000\n",
            ),
        ],
    );
    let done = place.good(&["actuator", "belt.toml"]);
    close(number(&done, "from") / TAU, 13000.0, 1e-12, "from");
    close(number(&done, "to") / TAU, 30000.0, 1e-12, "to");
    // Up to 20 kHz 3000 + 375 x N by the voltage against 3500 − 500 x N; beyond 3375 − 1875 y N against 3000 N.
    let changes = done["changes"].as_array().expect("a list");
    let at: Vec<f64> = changes.iter().map(|change| number(change, "frequency") / TAU).collect();
    assert_eq!(at.len(), 2, "{done}");
    close(at[0], 13000.0 + 7000.0 * 500.0 / 875.0, 1e-10, "the force binds");
    close(at[1], 22000.0, 1e-10, "the voltage binds");
}
