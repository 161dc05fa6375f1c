//! `quell convert`: a belt or a disc as a system has the equations and the answers of the original.

use std::f64::consts::{SQRT_2, TAU};
use std::fs;

use serde_json::Value as Json;

use crate::place::Place;

const DISC: &str = r#"
[disc]
inner_radius_ratio = 0.5
poisson_ratio = 0.3
radial_modes = 1
nodal_diameters = 3
modal_damping = 1e-4
youngs_modulus_pa = 1.95e11
density_kg_per_m3 = 7700
thickness_m = 0.021
outer_radius_m = 0.14
[disc.load]
radius_ratio = 0.75
mass_kg = 0.5
damping_n_s_per_m = 200
stiffness_n_per_m = 1e8
normal_load_n = 4000
speed_rpm = 60
[friction]
law = "coulomb"
coefficient = 0.4
[dither]
direction = "normal"
waveform = "sine"
frequency_hz = 20e3
"#;

const STACK: &str = r#"
[actuator]
kind = "piezo"
blocked_force_n = 7000
free_stroke_m = 20e-6
maximum_voltage = 1000
"#;

/// A stack behind the spring k and the damper d of the load lengthens by u with (k + iωd)u = ΔN, and makes ΔN + k_a u. The disc itself,
/// which friction pulls along its slope, moves by some 10⁻⁸ of that.
fn newtons(volts_rms: f64) -> f64 {
    let (stack, spring, damper) = (7000.0 / 20e-6, 1e8_f64, TAU * 20e3 * 200.0);
    volts_rms * SQRT_2 * 7.0 * spring.hypot(damper) / (spring + stack).hypot(damper)
}

/// A disc beyond what its stack can give is warned of, as the same disc written as a system is.
#[test]
fn a_disc_beyond_its_actuator_is_warned_of() {
    let text =
        format!("{DISC}amplitude_v_rms = 75\n{STACK}").replace("voltage = 1000", "voltage = 90");
    let place = Place::with("disc-beyond-its-stack", &[("disc.toml", &text)]);
    place.good(&["convert", "disc.toml", "--save", "system.toml"]);
    // A sine of 75 V root mean square has 212 V from peak to peak, of which 90 V are 1/2.357.
    let words = "demands 2.357 times what the actuator can give";
    for arguments in [
        &["check", "disc.toml"][..],
        &["simulate", "disc.toml", "--until", "1ms"],
        &["check", "system.toml"],
        &["simulate", "system.toml", "--until", "1ms"],
    ] {
        let answer = place.good(arguments);
        let warnings = answer["warnings"].as_array().expect("a list");
        let is_said = |warning: &Json| warning.as_str().is_some_and(|text| text.contains(words));
        assert!(warnings.iter().any(is_said), "{arguments:?}: {warnings:?}");
    }
}

#[test]
fn a_disc_takes_its_dither_in_volts() {
    let text = format!("{DISC}amplitude_v_rms = 75\n{STACK}");
    let place = Place::with("disc-in-volts", &[("disc.toml", &text)]);
    let checked = place.good(&["check", "disc.toml"]);
    let amplitude = checked["dither"]["amplitude"].as_f64().expect("a number");
    assert!((amplitude * 4000.0 / newtons(75.0) - 1.0).abs() < 1e-7, "{amplitude}");
    let words = String::from_utf8_lossy(&place.quell(&["check", "disc.toml"]).stdout).into_owned();
    assert!(words.contains("from dither.amplitude_v_rms = 75 V, by [actuator]"), "{words}");
    place.good(&["convert", "disc.toml", "--save", "system.toml"]);
    let system = place.good(&["check", "system.toml"]);
    let force = system["dithers"][0]["amplitude"].as_f64().expect("a number");
    assert!((force / (4000.0 * amplitude) - 1.0).abs() < 1e-12, "{force}");
    // In the system the same voltage gives the same force.
    let set = ["check", "system.toml", "--set", "dither.amplitude_v_rms=75"];
    let again = place.good(&set)["dithers"][0]["amplitude"].as_f64().expect("a number");
    assert!((again / force - 1.0).abs() < 1e-12, "{again}");
    let reach = place.good(&["actuator", "disc.toml"]);
    assert!(reach["ok"] == Json::Bool(true) && reach["units"].is_object(), "{reach}");
}

#[test]
fn a_disc_whose_load_is_unknown_takes_no_volts() {
    let given = DISC
        .replace("normal_load_n = 4000", "friction_n = 1600")
        .replace("[friction]\nlaw = \"coulomb\"\ncoefficient = 0.4\n", "");
    let mut scaled = DISC.to_owned();
    for (si, plain) in [
        ("youngs_modulus_pa = 1.95e11", ""),
        ("density_kg_per_m3 = 7700", ""),
        ("thickness_m = 0.021", ""),
        ("outer_radius_m = 0.14", ""),
        ("mass_kg = 0.5", "mass = 0.1"),
        ("damping_n_s_per_m = 200", "damping = 0.1"),
        ("stiffness_n_per_m = 1e8", "stiffness = 0.1"),
        ("normal_load_n = 4000", "normal_load = 1"),
        ("speed_rpm = 60", "speed = 0.05"),
        ("frequency_hz = 20e3", "frequency_ratio = 10"),
    ] {
        scaled = scaled.replace(si, plain);
    }
    let place = Place::with("disc-without-load", &[]);
    for (text, words) in [
        (given.clone(), "normal_load"),
        (scaled, "SI"),
        (DISC.replace("\"normal\"", "\"tangential\""), "normal dither"),
    ] {
        place.write("disc.toml", format!("{text}amplitude_v = 75\n{STACK}"));
        let errors = place.refused(&["check", "disc.toml"]);
        let said =
            errors.iter().any(|error| error["allowed"].as_str().expect("text").contains(words));
        assert!(said, "{words}: {errors:?}");
    }
    place.write("disc.toml", format!("{DISC}amplitude_v = 75\n"));
    let errors = place.refused(&["check", "disc.toml"]);
    assert_eq!(errors[0]["key"], "dither.amplitude_v", "{errors:?}");
    // Friction that is given as a force does not determine the load of the system.
    place.write("disc.toml", format!("{given}amplitude = 0.5\n"));
    let converted = place.good(&["convert", "disc.toml"]);
    let warnings = converted["warnings"].as_array().expect("a list");
    assert!(
        warnings.iter().any(|words| words.as_str().expect("text").contains("only their product")),
        "{converted}"
    );
}

#[test]
fn a_belt_keeps_what_is_asked_of_it() {
    let text = r#"
[belt]
mass_kg = 0.5
natural_frequency_hz = 5600
damping_ratio = 0.005
normal_force_n = 4000
belt_velocity_m_per_s = 0.1
[belt.initial]
state = "squealing"
[friction]
law = "stribeck"
static_coefficient = 0.4
minimum_coefficient = 0.2857
reference_velocity_m_per_s = 0.5
[dither]
direction = "tangential"
waveform = "sine"
amplitude_n = 5000
frequency_hz = 20000
[solver]
tolerance = 1e-9
[[sweep]]
parameter = "belt.belt_velocity_m_per_s"
values = [0.05, 0.1]
[uncertainty]
"belt.normal_force_n" = { normal = [4000, 100] }
"friction.static_coefficient" = { normal = [0.4, 0.01] }
[design]
minimise = "amplitude"
vary = ["dither.amplitude_n"]
from = [10]
to = [9000]
[design.over]
"belt.belt_velocity_m_per_s" = [0.05, 0.1]
"#;
    let place = Place::with("convert-asked", &[("belt.toml", text)]);
    let converted = place.good(&["convert", "belt.toml", "--save", "system.toml"]);
    assert_eq!(converted["left_out"], serde_json::json!(["[solver]"]));
    let study = fs::read_to_string(place.folder.join("system.toml")).expect("written");
    assert_eq!(converted["text"], study);
    for words in [
        "parameter = \"contact.belt.belt_velocity_m_per_s\"",
        "[uncertainty.\"contact.belt.normal_load_n\"]",
        "\"contact.belt.belt_velocity_m_per_s\" = [0.05, 0.1]",
        "state = \"squealing\"",
    ] {
        assert!(study.contains(words), "{words}: {study}");
    }
    place.good(&["check", "system.toml"]);
    // A damping ratio is no number of the system: what varies it is left out.
    let varied = text.replace(
        "\"belt.normal_force_n\" = { normal = [4000, 100] }",
        "\"belt.damping_ratio\" = { normal = [0.005, 1e-4] }",
    );
    place.write("varied.toml", varied);
    let converted = place.good(&["convert", "varied.toml"]);
    assert_eq!(
        converted["left_out"],
        serde_json::json!(["[uncertainty], by belt.damping_ratio", "[solver]"])
    );
}

#[test]
fn nothing_is_written_where_nothing_can_be_converted() {
    let curve = "slip_velocity,coefficient\n0,0.4\n0.1,0.37\n0.2,0.34\n0.3,0.32\n0.4,0.31\n0.5,0.3\n0.6,0.3\n";
    let belt = "[belt]\ndamping_ratio = 0.01\nnormal_load = 1\nbelt_velocity = 0.1\n[friction]\nlaw = 'samples'\nfile = 'curve.csv'\n";
    let place = Place::with("convert-refused", &[("belt.toml", belt), ("curve.csv", curve)]);
    fs::create_dir(place.folder.join("elsewhere")).expect("a folder");
    let errors = place.refused(&["convert", "belt.toml", "--save", "elsewhere/system.toml"]);
    assert_eq!(errors[0]["key"], "--save", "{errors:?}");
    place.good(&["convert", "belt.toml", "--save", "system.toml"]);
    place.good(&["check", "system.toml"]);
    let errors = place.refused(&["convert", "system.toml"]);
    assert!(errors[0]["allowed"].as_str().expect("text").contains("already"), "{errors:?}");
    place.refused(&["convert", "belt.toml", "--save", "belt.toml"]);
    place.refused(&["convert", "belt.toml", "--to", "belt"]);
    assert_eq!(fs::read_to_string(place.folder.join("belt.toml")).expect("kept"), belt);
}

/// A disc at rest under friction that varies: the multipliers of its orbit are the exponents of its series, at any phase of the dither.
#[test]
fn orbits_of_discs_have_the_exact_exponents() {
    let text = "[disc]\ninner_radius_ratio = 0.5\npoisson_ratio = 0.3\nradial_modes = 1\nnodal_diameters = 2\n\
                [disc.load]\nradius_ratio = 0.75\nmass = 0.127\ndamping = 0.127\nstiffness = 0.127\nfriction = 0.4\nspeed = 0.5\n\
                [dither]\ndirection = 'DIRECTION'\namplitude = 1.0\nfrequency_ratio = 2.7\n";
    let place = Place::with("disc-orbits", &[]);
    for direction in ["tangential", "normal"] {
        place.write("disc.toml", text.replace("DIRECTION", direction));
        let exact =
            place.good(&["stability", "disc.toml"])["growth_rate"].as_f64().expect("a rate");
        place.good(&["convert", "disc.toml", "--save", "system.toml"]);
        for phase in ["0", "0.7", "1.5707963267948966", "3"] {
            let set = format!("dither.phase={phase}");
            let orbit = place.good(&["orbit", "system.toml", "--set", &set]);
            let [radius, period] =
                ["radius", "period"].map(|name| orbit[name].as_f64().expect("a number"));
            let rate = radius.ln() / period;
            assert!((rate - exact).abs() < 1e-11, "{direction} at {phase}: {rate} against {exact}");
        }
    }
}

/// What the actuator gives is judged as a force would be: an amplitude that lifts the contact is refused at its own key.
#[test]
fn volts_that_lift_a_contact_are_refused_at_their_key() {
    let belt = "[belt]\nmass_kg = 0.5\nnatural_frequency_hz = 5600\ndamping_ratio = 0.005\nnormal_force_n = 4000\n\
                belt_velocity_m_per_s = 0.1\nnormal_stiffness_n_per_m = 2e8\n[friction]\nlaw = 'coulomb'\ncoefficient = 0.4\n[dither]\n\
                direction = 'normal'\nwaveform = 'sine'\namplitude_v_rms = 1200\nfrequency_hz = 20e3\n";
    let system = "[system]\nunits = 'SI'\ncoordinates = ['x', 'y']\nmass = [0.5, 1]\nstiffness = [6e8, 1e8]\n[[contact]]\nname = 'pad'\n\
                  tangent = { x = 1 }\nnormal_load = 4000\nnormal_stiffness = 2e8\nbelt_velocity = 0.1\n[contact.friction]\n\
                  law = 'coulomb'\ncoefficient = 0.4\n[[dither]]\ncontact = 'pad'\ndirection = 'normal'\nwaveform = 'sine'\n\
                  amplitude_v_rms = 1200\nfrequency_hz = 20e3\n";
    let place = Place::with("volts-that-lift", &[]);
    for (name, text) in [("belt.toml", belt), ("system.toml", system)] {
        place.write(name, format!("{text}{STACK}"));
        let errors = place.refused(&["check", name]);
        assert_eq!(errors[0]["key"], "dither.amplitude_v_rms", "{errors:?}");
        assert_eq!(errors[0]["value"], 1200.0, "{errors:?}");
        let allowed = errors[0]["allowed"].as_str().expect("text");
        assert!(allowed.contains("load") && allowed.contains("4319.7"), "{name}: {allowed}");
        place.good(&["check", name, "--set", "dither.amplitude_v_rms=1000"]);
    }
}

/// A stack behind the spring of its contact makes the same load whether the contacts slide or not, and whichever is listed first.
#[test]
fn volts_on_a_contact_at_rest_are_not_those_of_its_neighbour() {
    let pressed = "[[contact]]\nname = 'pressed'\ntangent = { x = 1 }\nnormal_load = 1000\nbelt_velocity = 0\n\
                   [contact.friction]\nlaw = 'coulomb'\ncoefficient = 0.3\n";
    let other = "[[contact]]\nname = 'other'\ntangent = { x = 1 }\nnormal = { y = 1 }\nnormal_load = 1000\nnormal_stiffness = 1e6\n\
                 belt_velocity = 1\n[contact.friction]\nlaw = 'coulomb'\ncoefficient = 0.3\n";
    let structure =
        "[system]\nunits = 'SI'\ncoordinates = ['x', 'y']\nmass = [1, 1]\nstiffness = [1e6, 1e6]\n";
    let place = Place::with("volts-at-rest", &[]);
    for (name, contacts) in [("first.toml", [pressed, other]), ("last.toml", [other, pressed])] {
        for contact in ["pressed", "other"] {
            let dither = format!(
                "[[dither]]\ncontact = '{contact}'\ndirection = 'normal'\nwaveform = 'sine'\namplitude_v = 1\nfrequency_hz = 20e3\n"
            );
            let spring = if contact == "pressed" { "normal_stiffness = 1e8\nbelt" } else { "belt" };
            let contacts =
                contacts.concat().replace("belt_velocity = 0", &format!("{spring}_velocity = 0"));
            place.write(name, [structure, &contacts, &dither, STACK].concat());
            let amplitude = |arguments: &[&str]| {
                let checked = place.good(&[&["check", name], arguments].concat());
                checked["dithers"][0]["amplitude"].as_f64().expect("a number")
            };
            let (at_rest, sliding) =
                (amplitude(&[]), amplitude(&["--set", "contact.pressed.belt_velocity=1"]));
            assert!((at_rest / sliding - 1.0).abs() < 1e-9, "{contact}: {at_rest}, {sliding}");
            if contact == "pressed" {
                let exact = 7.0 / (1.0 + 7000.0 / 20e-6 / 1e8);
                assert!((at_rest / exact - 1.0).abs() < 1e-12, "{at_rest} should be {exact}");
            }
        }
    }
}
