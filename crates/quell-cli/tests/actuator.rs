//! `[actuator]`: what a designed dither demands, against closed forms of a sine, and complaints.

use std::f64::consts::{SQRT_2, TAU};

use serde_json::Value as Json;

use crate::place::Place;

/// A pad of 0.4 kg on 2 kN/mm whose dither has a range of 3 to 12 kHz.
const BELT: &str = r#"
[belt]
mass_kg = 0.4
stiffness_n_per_m = 2e6
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
frequency_hz = 3000

[design]
minimise = "amplitude"
vary = ["dither.amplitude_n"]
from = [10.0]
to = [5000.0]
"#;

/// The same as a system, in millimetres.
const SYSTEM: &str = r#"
[system]
units = "mm-t-s"
coordinates = ["pad"]
mass_kg = [0.4]
stiffness_n_per_m = [2e6]
damping_n_s_per_m = [8.94427190999916]

[[contact]]
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
frequency_hz = 3000

[design]
minimise = "amplitude"
vary = ["dither.amplitude"]
from = [10.0]
to = [5000.0]
"#;

const PIEZO: &str = r#"
[actuator]
kind = "piezo"
blocked_force_n = 7000
free_stroke_m = 20e-6
mass_kg = 0.05
capacitance_f = 2.1e-6
maximum_voltage = 150
maximum_current = 5
"#;

const COIL: &str = r#"
[actuator]
kind = "voice-coil"
force_per_ampere_n_per_a = 60
mass_kg = 0.1
resistance = 2
inductance_h = 1e-4
rms_current = 40
maximum_voltage = 400
sample_rate_hz = 20000
"#;

fn number(value: &Json, path: &str) -> f64 {
    let found = path.split('.').fold(value, |at, key| &at[key]);
    found.as_f64().unwrap_or_else(|| panic!("{path}: {value}"))
}

fn close(value: f64, exact: f64, what: &str) {
    assert!((value / exact - 1.0).abs() < 1e-9, "{what}: {value} should be {exact}");
}

fn modulus([re, im]: [f64; 2]) -> f64 {
    (re * re + im * im).sqrt()
}

/// ω, the amplitude that was verified and K + iωd − mω² over the frequency of a sine.
fn verified(done: &Json) -> (f64, f64, [f64; 2]) {
    let omega = TAU * 3000.0;
    let parameters = done["parameters"].as_object().expect("by path");
    let amplitude = parameters.values().next().and_then(Json::as_f64).expect("an amplitude");
    let damping = 2.0 * 0.005 * (0.4_f64 * 2e6).sqrt();
    (omega, amplitude, [2e6 - 0.4 * omega * omega, damping * omega])
}

#[test]
fn a_piezo_stack_gives_the_force_of_its_own_spring_and_mass_too() {
    let place = Place::with(
        "actuator-piezo",
        &[("belt.toml", &format!("{BELT}{PIEZO}")), ("system.toml", &format!("{SYSTEM}{PIEZO}"))],
    );
    for study in ["belt.toml", "system.toml"] {
        let done = place.good(&["design", study]);
        let (omega, amplitude, [re, im]) = verified(&done);
        let own = 7000.0 / 20e-6 - 0.05 * omega * omega;
        let force = amplitude * modulus([re + own, im]) / modulus([re, im]);
        let drive = &done["drive"];
        close(number(drive, "force.peak"), force, study);
        close(number(drive, "force.rms"), force / SQRT_2, study);
        let volts = 150.0 * force / 7000.0;
        close(number(drive, "voltage.peak_to_peak"), 2.0 * volts, study);
        let current = 2.1e-6 * omega * volts;
        close(number(drive, "current.peak"), current, study);
        let stroke = 2.0 * amplitude / modulus([re, im]);
        // The system is in millimetres.
        let millimetres = if study == "system.toml" { 1e3 } else { 1.0 };
        close(number(drive, "displacement.peak_to_peak"), millimetres * stroke, study);
        let rated = drive["rated"].as_array().expect("a list");
        assert_eq!(rated.len(), 2);
        close(number(&rated[0], "used"), 2.0 * volts / 150.0, study);
        close(number(&rated[1], "used"), current / 5.0, study);
        assert_eq!(drive["samples_per_period"], Json::Null);
        // 350 N/µm at a pad of 2 N/µm.
        let warnings = done["warnings"].to_string();
        assert!(warnings.contains("is 175 times that of the structure"), "{warnings}");
    }
}

#[test]
fn a_coil_has_an_induced_voltage_and_a_controller_few_samples() {
    let place = Place::with(
        "actuator-coil",
        &[("belt.toml", &format!("{BELT}{COIL}")), ("system.toml", &format!("{SYSTEM}{COIL}"))],
    );
    for study in ["belt.toml", "system.toml"] {
        let done = place.good(&["design", study]);
        let (omega, amplitude, [re, im]) = verified(&done);
        let size = re * re + im * im;
        let x = [amplitude * re / size, -amplitude * im / size];
        let force = [amplitude - 0.1 * omega * omega * x[0], -0.1 * omega * omega * x[1]];
        let current = force.map(|part| part / 60.0);
        let drive = &done["drive"];
        let peak = modulus([current[0], current[1]]);
        close(number(drive, "current.rms"), peak / SQRT_2, study);
        let voltage = [
            2.0 * current[0] - 1e-4 * omega * current[1] - 60.0 * omega * x[1],
            2.0 * current[1] + 1e-4 * omega * current[0] + 60.0 * omega * x[0],
        ];
        close(number(drive, "voltage.peak"), modulus([voltage[0], voltage[1]]), study);
        close(number(drive, "samples_per_period"), 20.0 / 3.0, study);
        let warnings = done["warnings"].to_string();
        assert!(warnings.contains("6.667 samples"), "{warnings}");
    }
}

/// A voltage makes a stack press with F_b U/U_max on the structure that contains its spring and mass.
#[test]
fn a_stack_in_the_structure_makes_the_force_of_its_voltage() {
    let stack = "[actuator]\nkind = \"piezo\"\nblocked_force_n = 7000\nmaximum_voltage = 150\n";
    let place = Place::with("actuator-within", &[("belt.toml", &format!("{BELT}{stack}"))]);
    let done = place.good(&["design", "belt.toml"]);
    let (_, amplitude, _) = verified(&done);
    close(number(&done["drive"], "voltage.peak"), 150.0 * amplitude / 7000.0, "voltage");
    let warnings = done["warnings"].to_string();
    assert!(warnings.contains("must be part of the structure"), "{warnings}");
}

#[test]
fn what_the_actuator_cannot_give_is_named() {
    let place = Place::with("actuator-weak", &[("belt.toml", &format!("{BELT}{PIEZO}"))]);
    let done = place.good(&["design", "belt.toml", "--set", "actuator.maximum_current=10 mA"]);
    assert_eq!(done["feasible"], false);
    assert_eq!(done["drive"], Json::Null);
    let sentence = done["sentence"].as_str().expect("words");
    assert!(sentence.contains("the maximum current of the actuator would be"), "{sentence}");
    // A square wave needs an unlimited current, which is not a large number but an answer that does not exist.
    let done = place.good(&["design", "belt.toml", "--set", "dither.waveform=square"]);
    assert_eq!(done["feasible"], false);
    assert!(done["sentence"].as_str().expect("words").contains("the voltage jumps"), "{done}");
}

#[test]
fn a_measured_actuator_holds_within_its_file() {
    let table = "[actuator]\nkind = \"frf\"\nfile = \"stack.csv\"\nmaximum_voltage = 100\n";
    let place = Place::with(
        "actuator-measured",
        &[
            ("belt.toml", &format!("{BELT}{table}")),
            ("system.toml", &format!("{SYSTEM}{table}")),
            ("stack.csv", "frequency_hz,force_per_volt_n_per_v\n1000,20\n5000,40\n"),
        ],
    );
    for study in ["belt.toml", "system.toml"] {
        let done = place.good(&["design", study]);
        let (_, amplitude, _) = verified(&done);
        close(number(&done["drive"], "voltage.peak"), amplitude / 30.0, study);
    }
    place.write("stack.csv", "frequency_hz,force_per_volt_n_per_v\n4000,20\n5000,40\n");
    let done = place.good(&["design", "belt.toml"]);
    assert_eq!(done["feasible"], false);
    assert!(done["sentence"].as_str().expect("words").contains("outside the measured"), "{done}");
}

#[test]
fn wrong_actuators_are_complained_about_with_the_key() {
    let place = Place::with("actuator-wrong", &[]);
    for (table, key, words) in [
        ("kind = \"piezo\"", "actuator.blocked_force", "limits the dither"),
        ("kind = \"magnet\"", "actuator.kind", "piezo"),
        ("blocked_force_n = 1", "actuator.kind", "one of"),
        (
            "kind = \"motor\"\nforce_per_ampere_n_per_a = 2",
            "actuator.rms_current",
            "without a limit",
        ),
        (
            "kind = \"motor\"\nforce_per_ampere_n_per_a = 2\nmaximum_voltage = 3",
            "actuator.resistance",
            "maximum_voltage",
        ),
        (
            "kind = \"piezo\"\nblocked_force_n = 7000\nfree_stroke_m = 2e-5\nstiffness_n_per_m = 5e8",
            "actuator.stiffness_n_per_m",
            "blocked_force/free_stroke",
        ),
        (
            "kind = \"piezo\"\nblocked_force_n = 7000\nfree_stroke_m = 2e-5\nmaximum_current = 3",
            "actuator.maximum_voltage",
            "C dU/dt",
        ),
        (
            "kind = \"piezo\"\nblocked_force_n = 7000\nfree_stroke_m = 2e-5\nresistance = 3",
            "actuator.resistance",
            "kind \"piezo\"",
        ),
        ("kind = \"frf\"", "actuator.file", "CSV"),
        (
            "kind = \"frf\"\nfile = \"none.csv\"\nmaximum_voltage = 3",
            "actuator.file",
            "cannot be read",
        ),
    ] {
        place.write("belt.toml", format!("{BELT}\n[actuator]\n{table}\n"));
        let (said, status) = place.json(&["check", "belt.toml"]);
        assert_ne!(status, 0, "{table}");
        let all = said["complaints"].as_array().or_else(|| said["errors"].as_array());
        let all = all.unwrap_or_else(|| panic!("{said}"));
        let found = all.iter().find(|complaint| {
            complaint["key"].as_str().is_some_and(|known| known.starts_with(key))
        });
        let found = found.unwrap_or_else(|| panic!("{table}: {said}"));
        assert!(found.to_string().replace("\\\"", "\"").contains(words), "{table}: {found}");
    }
    place.write(
        "belt.toml",
        format!("{BELT}{PIEZO}").replace(
            "to = [5000.0]",
            "to = [5000.0]\nover = { \"actuator.mass_kg\" = [0.1, 0.2] }",
        ),
    );
    let (said, _) = place.json(&["design", "belt.toml"]);
    assert!(said.to_string().contains("outside [actuator]"), "{said}");
}

/// A stack of 350 N/µm behind a contact of 200 N/µm: 75 V rms are 742.5 N of the blocked force, of which the contact feels 1/2.75.
#[test]
fn normal_dither_acts_through_the_stiffness_of_the_contact() {
    let volts = |text: &str, contact: &str| {
        let text = text
            .replace("direction = \"tangential\"", "direction = \"normal\"")
            .replace("at = { pad = 1 }", "contact = \"contact 1\"\ndirection = \"normal\"")
            .replace("amplitude_n = 1000", "amplitude_v_rms = 75")
            .replace("amplitude = 1000", "amplitude_v_rms = 75")
            .replace("normal_force_n = 1500", &format!("normal_force_n = 1500\n{contact}"))
            .replace("normal_load = 1500", &format!("normal_load = 1500\n{contact}"));
        text.split("[design]").next().expect("a study").to_owned()
    };
    let stack = PIEZO.replace("mass_kg = 0.05\n", "").replace("= 150", "= 1000");
    let place = Place::with("actuator-normal", &[]);
    let exact = 7.0 * 75.0 * SQRT_2 / (1.0 + 350.0 / 200.0);
    for (name, text) in [("belt.toml", BELT), ("system.toml", SYSTEM)] {
        let sprung = volts(text, "normal_stiffness_n_per_m = 200e6");
        place.write(name, format!("{sprung}{stack}"));
        let checked = place.good(&["check", name]);
        close(checked["dithers"][0]["amplitude"].as_f64().expect("a number"), exact, name);
        let response = place.good(&["response", name]);
        let cost = &response["dithers"][0];
        assert!(cost["power"].is_null() && cost["stroke"].is_null(), "{cost}");
        let unit = if name == "belt.toml" { 1.0 } else { 1e3 };
        close(number(cost, "actuator_stroke"), unit * 2.0 * exact / 200e6, name);
        // The moving mass of the stack takes force too: k_a/k_n − m_a ω²/k_n.
        place.write(name, format!("{sprung}{}", stack.replace("kind", "mass_kg = 0.05\nkind")));
        let omega = TAU * 3000.0;
        let heavier = 1.0 + (350e6 - 0.05 * omega * omega) / 200e6;
        let checked = place.good(&["check", name]);
        close(number(&checked["dithers"][0], "amplitude"), 7.0 * 75.0 * SQRT_2 / heavier, name);
        for (text, words) in [
            (format!("{}{stack}", volts(text, "")), "normal_stiffness"),
            (format!("{sprung}{}", stack.replace("free_stroke_m = 20e-6\n", "")), "free_stroke"),
            (format!("{}{stack}", sprung.replace("\"sine\"", "\"square\"")), "jumps"),
        ] {
            place.write(name, text);
            let errors = place.refused(&["check", name]);
            let allowed = errors[0]["allowed"].as_str().expect("text");
            assert!(allowed.contains(words), "{name}: {allowed}");
        }
        if name == "belt.toml" {
            // A stiffness that is wrong is one fault, not two.
            place.write(name, format!("{}{stack}", volts(text, "normal_stiffness_n_per_m = 0")));
            let errors = place.refused(&["check", name]);
            assert_eq!(errors.len(), 1, "{errors:?}");
            assert_eq!(errors[0]["key"], "belt.normal_stiffness_n_per_m");
        }
        // Without normal dither nothing presses through the contact.
        let tangential = text.replace(
            "normal_force_n = 1500",
            "normal_force_n = 1500\nnormal_stiffness_n_per_m = 2e8",
        );
        let tangential = tangential
            .replace("normal_load = 1500", "normal_load = 1500\nnormal_stiffness_n_per_m = 2e8");
        place.write(name, tangential);
        let errors = place.refused(&["check", name]);
        assert!(
            errors[0]["key"].as_str().expect("a key").contains("normal_stiffness"),
            "{errors:?}"
        );
    }
}
