//! Amplitudes as root mean square and peak to peak, in volts, amperes and per cent of what the actuator can give.

use std::f64::consts::{SQRT_2, TAU};

use serde_json::Value as Json;

use crate::place::Place;

/// A pad whose stack is part of the structure, without the amplitude of its dither.
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
frequency_hz = 20000
"#;

const SYSTEM: &str = r#"
[system]
units = "SI"
coordinates = ["pad"]
mass = [0.1]
stiffness = [370e6]
damping = [60.8276253029822]

[[contact]]
tangent = { pad = 1 }
normal_load = 1500
belt_velocity = 0.1

[friction]
law = "stribeck"
static_coefficient = 0.4
minimum_coefficient = 0.2857
reference_velocity = 0.5

[[dither]]
at = { pad = 1 }
waveform = "sine"
frequency_hz = 20000
"#;

const STACK: &str = r#"
[actuator]
kind = "piezo"
blocked_force_n = 7000
capacitance_f = 2.1e-6
maximum_voltage = 150
maximum_current = 15
"#;

fn close(value: f64, exact: f64, what: &str) {
    assert!((value / exact - 1.0).abs() < 1e-12, "{what}: {value} should be {exact}");
}

/// The amplitude of the dither in newtons.
fn newtons(checked: &Json) -> f64 {
    checked["dithers"][0]["amplitude"].as_f64().unwrap_or_else(|| panic!("{checked}"))
}

/// The amplitude that each key gives: the force of a volt is F_b/U_max, that of an ampere F_b/(ω C U_max).
fn sizes() -> Vec<(&'static str, f64)> {
    let volt = 7000.0 / 150.0;
    let ampere = volt / (TAU * 20000.0 * 2.1e-6);
    vec![
        ("amplitude_n = 500", 500.0),
        ("amplitude_n_rms = 500", 500.0 * SQRT_2),
        ("amplitude_n_peak_to_peak = 500", 250.0),
        ("amplitude_v = 12", 12.0 * volt),
        ("amplitude_v = \"12 V\"", 12.0 * volt),
        ("amplitude_v = \"0.012 kV\"", 12.0 * volt),
        ("amplitude_v_rms = 12", 12.0 * SQRT_2 * volt),
        ("amplitude_v_peak_to_peak = 12", 6.0 * volt),
        ("amplitude_a = 3", 3.0 * ampere),
        ("amplitude_a_rms = \"3 A\"", 3.0 * SQRT_2 * ampere),
        ("amplitude_a_peak_to_peak = 3", 1.5 * ampere),
        ("amplitude_percent = 40", 0.4 * 15.0 * ampere),
        ("amplitude_percent = \"40 %\"", 0.4 * 15.0 * ampere),
    ]
}

#[test]
fn every_size_gives_its_force() {
    let place = Place::with("sizes", &[]);
    for (given, exact) in sizes() {
        for (study, frequency) in [(BELT, "frequency_hz"), (SYSTEM, "frequency_hz")] {
            let text = study.replace(frequency, &format!("{given}\n{frequency}"));
            place.write("study.toml", format!("{text}{STACK}"));
            let checked = place.good(&["check", "study.toml"]);
            close(newtons(&checked), exact, given);
            let sizes = checked["given_amplitudes"].as_array().expect("a list");
            let is_peak = given.starts_with("amplitude_n =");
            assert_eq!(sizes.len(), usize::from(!is_peak), "{given}: {checked}");
            if let Some(size) = sizes.first() {
                let key = given.split(' ').next().expect("a key");
                assert_eq!(size["key"], format!("dither.{key}"));
                let words = place.quell(&["check", "study.toml"]);
                let words = String::from_utf8_lossy(&words.stdout).into_owned();
                assert!(words.contains(&format!("dither.{key} = ")), "{words}");
                assert_eq!(
                    words.contains("by [actuator]"),
                    !key.starts_with("amplitude_n"),
                    "{words}"
                );
            }
        }
    }
}

/// Without units the sizes are in the unit of the amplitude; the waveform converts them.
#[test]
fn a_study_without_units_has_root_mean_squares_too() {
    let plain = "[belt]\ndamping_ratio = 0.01\nnormal_load = 1\nbelt_velocity = 0.1\n[friction]\nlaw = \"coulomb\"\n\
                 coefficient = 0.3\n[dither]\ndirection = \"tangential\"\nfrequency_ratio = 10\nwaveform = \"triangle\"\n";
    let place = Place::with("sizes-plain", &[]);
    for (given, exact) in
        [("amplitude_rms = 2", 2.0 * 3f64.sqrt()), ("amplitude_peak_to_peak = 2", 1.0)]
    {
        place.write("study.toml", format!("{plain}{given}\n"));
        let checked = place.good(&["check", "study.toml"]);
        close(newtons(&checked), exact, given);
        // A change by the plain key replaces it, and the other way round.
        let changed = place.good(&["check", "study.toml", "--set", "dither.amplitude=7"]);
        close(newtons(&changed), 7.0, given);
        let changed = place.good(&["check", "study.toml", "--set", "dither.amplitude_rms=1"]);
        close(newtons(&changed), 3f64.sqrt(), given);
    }
    place.write("study.toml", format!("{plain}amplitude_n_rms = 1\n"));
    let wrong = place.refused(&["check", "study.toml"]);
    assert_eq!(wrong[0]["key"], "dither.amplitude_n_rms");
}

#[test]
fn a_voltage_follows_the_frequency() {
    let text = BELT.replace("frequency_hz", "amplitude_a = 3\nfrequency_hz");
    let place = Place::with("sizes-set", &[("study.toml", &format!("{text}{STACK}"))]);
    let one = newtons(&place.good(&["check", "study.toml"]));
    let two = newtons(&place.good(&["check", "study.toml", "--set", "dither.frequency_hz=40000"]));
    close(two, 0.5 * one, "half of the force at twice the frequency");
    let set = place.good(&["check", "study.toml", "--set", "dither.amplitude_v=12 V"]);
    close(newtons(&set), 12.0 * 7000.0 / 150.0, "volts replace amperes");
}

#[test]
fn wrong_sizes_are_complained_about() {
    let place = Place::with("sizes-wrong", &[]);
    for (given, actuator, key, words) in [
        ("amplitude_v = 12", "", "dither.amplitude_v", "[actuator]"),
        ("amplitude_v = 12\namplitude_n = 3", STACK, "dither.amplitude_v", "not both"),
        ("amplitude_v = 12\namplitude_a_rms = 3", STACK, "dither.amplitude_v", "not both"),
        ("amplitude_rms = 12\namplitude = 3", STACK, "dither.amplitude_rms", "not both"),
        ("amplitude_v = \"12 A\"", STACK, "dither.amplitude_v", "another quantity"),
        ("amplitude_v = -3", STACK, "dither.amplitude_v", "≥ 0"),
        ("amplitude_percent = 50\nphase = \"x\"", "", "dither.amplitude_percent", "[actuator]"),
    ] {
        place.write(
            "study.toml",
            format!(
                "{}{actuator}",
                BELT.replace("frequency_hz", &format!("{given}\nfrequency_hz"))
            ),
        );
        let wrong = place.refused(&["check", "study.toml"]);
        let found = wrong.iter().find(|complaint| complaint["key"] == key);
        let found = found.unwrap_or_else(|| panic!("{given}: {wrong:?}"));
        assert!(found.to_string().contains(words), "{given}: {found}");
    }
    // A square wave would need an unlimited current.
    let square = BELT
        .replace("\"sine\"", "\"square\"")
        .replace("frequency_hz", "amplitude_a = 3\nfrequency_hz");
    place.write("study.toml", format!("{square}{STACK}"));
    let wrong = place.refused(&["check", "study.toml"]);
    assert!(wrong[0].to_string().contains("the voltage jumps"), "{wrong:?}");
    // A force is varied, not a voltage.
    let volts = BELT.replace("frequency_hz", "amplitude_v = 12\nfrequency_hz");
    place.write("study.toml", format!("{volts}{STACK}"));
    let varied = [
        "thresholds",
        "study.toml",
        "--parameter",
        "dither.amplitude_v",
        "--from",
        "1",
        "--to",
        "2",
    ];
    let wrong = place.refused(&varied);
    assert_eq!(wrong[0]["suggestion"], "dither.amplitude", "{wrong:?}");
}
