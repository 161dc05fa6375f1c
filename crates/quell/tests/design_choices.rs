//! What a design tries in turn: places of the dither, and bursts of several numbers of periods. Each choice is the design of a study that
//! is written with it.

use quell::Study;
use serde_json::Value as Json;

use crate::designs::{complaint, facts};

/// A motor that drives a carriage with friction, dithered at one of them.
fn two_masses(dither: &str, design: &str) -> String {
    format!(
        "[system]\ncoordinates = [\"motor\", \"carriage\"]\nmass = [1.0, 1.0]\ndamping = [[0.02, -0.01], [-0.01, 0.02]]\n\
         stiffness = [[2.0, -1.0], [-1.0, 1.0]]\n[[contact]]\nname = \"guide\"\ntangent = {{ carriage = 1.0 }}\n\
         normal_load = 1.0\nbelt_velocity = 0.1\n[contact.friction]\nlaw = \"stribeck\"\nstatic_coefficient = 0.4\n\
         minimum_coefficient = 0.2857\nreference_velocity = 0.2\n[[dither]]\n{dither}\namplitude = 0.5\nfrequency = 10.0\n\
         [design]\nminimise = \"amplitude\"\n{design}\n"
    )
}

const BELT: &str = "[belt]\ndamping_ratio = 0.005\nnormal_load = 1.0\nbelt_velocity = 0.1\n[friction]\nlaw = \"stribeck\"\n\
                    static_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n[dither]\n\
                    direction = \"tangential\"\namplitude = 1.0\nfrequency_ratio = 10.0\n";

const SINE: &str = "waveform = \"sine\"";
const AMPLITUDE: &str = "vary = [\"dither.amplitude\"]\nfrom = [0.01]\nto = [400.0]";

#[test]
fn each_place_is_the_study_with_the_dither_there() {
    let at = |place: &str| format!("at = {{ {place} }}\n{SINE}");
    let several = "places = [{ at = { motor = 1.0 } }, { at = { carriage = 1.0 } }]";
    let found = facts(&two_masses(&at("motor = 1.0"), &format!("{AMPLITUDE}\n{several}")));
    let rows = found["waveforms"].as_array().expect("a list");
    assert_eq!(rows.len(), 2);
    for (row, place) in rows.iter().zip(["motor", "carriage"]) {
        let alone = facts(&two_masses(&at(&format!("{place} = 1.0")), AMPLITUDE));
        assert_eq!(row["place"], place);
        assert_eq!(row["critical"], alone["critical"], "{place}");
        assert!(alone["place"].is_null() && alone["why"]["place"].is_string());
        if place == "carriage" {
            // The better one, with everything that depends on the place.
            assert_eq!(found["place"], place);
            for name in ["critical", "parameters", "objective", "friction_loss", "response_rms"] {
                assert_eq!(found[name], alone[name], "{name}");
            }
            let (own, all) = (&alone["sensitivity"], &found["sensitivity"]);
            assert_eq!(own["system.mass[0]"], all["system.mass[0]"]);
            assert_eq!(own["dither.at.carriage"], all["dither.at.carriage"]);
            assert!(all.get("dither.at.motor").is_none());
            let sentence = found["sentence"].as_str().expect("a sentence");
            assert!(sentence.contains("a sine at carriage of amplitude"), "{sentence}");
        }
    }
}

#[test]
fn a_place_may_be_the_load_of_a_contact() {
    let several =
        "places = [{ at = { motor = 1.0 } }, { contact = \"guide\", direction = \"tangential\" }]";
    let design = format!("{AMPLITUDE}\n{several}");
    let found = facts(&two_masses(&format!("at = {{ motor = 1.0 }}\n{SINE}"), &design));
    assert_eq!(found["waveforms"][1]["place"], "guide (tangential)");
    let written = format!("contact = \"guide\"\ndirection = \"tangential\"\n{SINE}");
    assert_eq!(found["critical"], facts(&two_masses(&written, AMPLITUDE))["critical"]);
    // A name says the factors.
    let rows = "places = [{ at = { carriage = 2.0 } }, { at = { motor = 1.0, carriage = -0.5 } }]";
    let study = two_masses(&written, &format!("{AMPLITUDE}\n{rows}"));
    let study = Study::parse(&study, &[]).expect("valid").system();
    let names: Vec<&str> =
        study.design().expect("a design").places.iter().map(|place| place.name.as_str()).collect();
    assert_eq!(names, ["2 carriage", "motor − 0.5 carriage"]);
    // A prescribed load must stay positive, and the complaint names the place.
    let several = "places = [{ contact = \"guide\", direction = \"normal\" }]";
    let text = complaint(&two_masses(&written, &format!("{AMPLITUDE}\n{several}")));
    assert!(text.contains("dither.amplitude at guide (normal)"), "{text}");
    assert!(text.contains("a prescribed load must stay positive"), "{text}");
}

#[test]
fn each_burst_is_the_study_with_its_periods() {
    let burst = |on: u32, off: u32| {
        format!("{BELT}waveform = \"burst\"\ncarrier = \"sine\"\non = {on}\noff = {off}\n")
    };
    let vary = "[design]\nminimise = \"amplitude\"\nvary = [\"dither.amplitude\", \"dither.on\"]\nfrom = [0.01, 2]\nto = [20.0, 4]\n";
    let found = facts(&format!("{}{vary}", burst(3, 2)));
    let rows = found["waveforms"].as_array().expect("a list");
    assert_eq!(rows.len(), 3);
    let alone = "[design]\nminimise = \"amplitude\"\nvary = [\"dither.amplitude\"]\nfrom = [0.01]\nto = [20.0]\n";
    let mut least = (f64::INFINITY, 0);
    for (row, on) in rows.iter().zip(2_u32..) {
        let own = facts(&format!("{}{alone}", burst(on, 2)));
        assert_eq!((&row["on"], &row["off"]), (&on.into(), &2.into()));
        assert_eq!(row["critical"]["dither.on"], on);
        assert_eq!(row["critical"]["dither.amplitude"], own["critical"]["dither.amplitude"]);
        let objective = row["objective"].as_f64().expect("a number");
        if objective < least.0 {
            least = (objective, on);
        }
    }
    assert_eq!(
        (&found["objective"], &found["parameters"]["dither.on"]),
        (&least.0.into(), &least.1.into())
    );
}

#[test]
fn without_a_pause_a_burst_is_its_carrier() {
    let text = format!("{BELT}waveform = \"burst\"\ncarrier = \"sine\"\non = 3\noff = 2\n");
    let vary = "[design]\nminimise = \"amplitude\"\nvary = [\"dither.amplitude\", \"dither.on\", \"dither.off\"]\n\
                from = [0.01, 2, 0]\nto = [20.0, 3, 1]\n";
    let found = facts(&format!("{text}{vary}"));
    let rows = found["waveforms"].as_array().expect("a list");
    let labels: Vec<&str> = rows.iter().filter_map(|row| row["waveform"].as_str()).collect();
    assert_eq!(labels, ["sine", "burst", "burst"]);
    // A burst that repeats at 10/7 ω₀ is in the band of the vibration, and a warning says so.
    let alone = "[design]\nminimise = \"amplitude\"\nvary = [\"dither.amplitude\"]\nfrom = [0.01]\nto = [20.0]\n";
    let longer = text.replace("on = 3\noff = 2", "on = 4\noff = 3");
    let slow = facts(&format!("{longer}{alone}"));
    let warns = |found: &Json| {
        found["warnings"].to_string().contains("burst 4 : 3 repeats at or below 1.9 times")
    };
    assert!(warns(&slow) && !warns(&found), "{}", slow["warnings"]);
}

#[test]
fn wrong_choices_are_refused_with_their_keys() {
    let at = format!("at = {{ motor = 1.0 }}\n{SINE}");
    for (design, key, says) in [
        (format!("{AMPLITUDE}\nplaces = []"), "design.places", "at least one place"),
        (
            format!(
                "{AMPLITUDE}\nplaces = [{{ at = {{ motor = 1.0 }} }}, {{ at = {{ motor = 1 }} }}]"
            ),
            "design.places",
            "motor is given twice",
        ),
        (
            format!("{AMPLITUDE}\nplaces = [{{ at = {{ engine = 1.0 }} }}]"),
            "design.places",
            "engine",
        ),
        (format!("{AMPLITUDE}\nplaces = [{{ at = {{ motor = 0.0 }} }}]"), "design.places", "not 0"),
        (format!("{AMPLITUDE}\nplaces = [\"motor\"]"), "design.places", "a table"),
        (
            format!("{AMPLITUDE}\nplaces = [{{ contact = \"rail\", direction = \"normal\" }}]"),
            "design.places",
            "guide",
        ),
        (
            format!("{AMPLITUDE}\nplaces = [{{ at = {{ motor = 1.0 }}, amplitude = 2.0 }}]"),
            "design.places",
            "amplitude",
        ),
        (
            "vary = [\"dither.amplitude\", \"dither.on\"]\nfrom = [0.01, 1]\nto = [9.0, 4]"
                .to_owned(),
            "design.vary",
            "only bursts have it",
        ),
    ] {
        let text = complaint(&two_masses(&at, &design));
        assert!(text.contains(key) && text.contains(says), "{design}: {text}");
    }
    let burst = format!(
        "{BELT}waveform = \"burst\"\ncarrier = \"sine\"\non = 3\noff = 2\n[design]\nminimise = \"amplitude\"\n"
    );
    for (design, key, says) in [
        (
            "vary = [\"dither.amplitude\", \"dither.on\"]\nfrom = [0.01, 0]\nto = [9.0, 4]",
            "design.from[1]",
            "from 1 to 100",
        ),
        (
            "vary = [\"dither.amplitude\", \"dither.on\"]\nfrom = [0.01, 1.5]\nto = [9.0, 4]",
            "design.from[1]",
            "a whole number",
        ),
        (
            "vary = [\"dither.amplitude\", \"dither.on\"]\nfrom = [0.01, 4]\nto = [9.0, 1]",
            "design.to[1]",
            "at least the smallest value, 4",
        ),
        (
            "vary = [\"dither.amplitude\", \"dither.on\", \"dither.off\"]\nfrom = [0.01, 1, 1]\nto = [9.0, 20, 20]",
            "design",
            "at most 100 dithers",
        ),
        (
            "vary = [\"dither.amplitude\", \"dither.on\", \"dither.on\"]\nfrom = [0.01, 1, 1]\nto = [9.0, 2, 2]",
            "design.vary",
            "once",
        ),
        (
            "vary = [\"dither.amplitude\", \"dither[1].on\"]\nfrom = [0.01, 1]\nto = [9.0, 2]",
            "design.vary",
            "whose amplitude is chosen",
        ),
        (
            "vary = [\"dither.amplitude\"]\nfrom = [0.01]\nto = [9.0]\nplaces = [{ at = { x = 1.0 } }]",
            "design.places",
            "only in a system",
        ),
    ] {
        let text = complaint(&format!("{burst}{design}\n"));
        assert!(text.contains(key) && text.contains(says), "{design}: {text}");
    }
}

/// Friction falls with the amplitude and rises again: where the least quiet amplitude loses too much, a larger one may lose less. The
/// answer names it, and does not deny that it exists.
#[test]
fn a_larger_amplitude_may_keep_a_limit_that_the_least_exceeds() {
    let text = "[belt]\ndamping_ratio = 0.005\nnormal_load = 1.0\nbelt_velocity = 0.1\n[friction]\nlaw = \"stribeck\"\n\
                static_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n[dither]\ndirection = \"tangential\"\n\
                waveform = \"sine\"\namplitude = 1.0\nfrequency_ratio = 20.0\n[design]\nminimise = \"amplitude\"\n\
                vary = [\"dither.amplitude\"]\nfrom = [0.01]\nto = [20.0]\n[design.over]\n\"belt.belt_velocity\" = [0.05, 0.2]\n\
                [design.limits]\nstroke = 0.04\nfriction_loss = 0.82\n";
    let found = facts(text);
    assert_eq!(found["feasible"], false);
    assert_eq!(found["covered"]["belt.belt_velocity"], serde_json::json!([0.05, 0.2]));
    let sentence = found["sentence"].as_str().expect("a sentence");
    assert!(sentence.starts_with("No dither that has the least quiet amplitude"), "{sentence}");
    assert!(sentence.contains("A larger amplitude does"), "{sentence}");
    let larger = found["parameters"]["dither.amplitude"].as_f64().expect("an amplitude");
    let from_there = facts(&text.replace("from = [0.01]", &format!("from = [{larger}]")));
    assert_eq!(from_there["feasible"], true, "{from_there}");
    assert!(from_there["friction_loss"].as_f64().expect("a loss") < 0.82);
}
