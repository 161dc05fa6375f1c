//! Tests of the binary with studies of a disc: names in JSON, exit statuses, files that read back.

use std::fs;

use serde_json::Value as Json;

use crate::place::Place;

const STUDY: &str = r#"schema = 1
title = "Disc under a pad"
[disc]
inner_radius_ratio = 0.5
[disc.load]
radius_ratio = 0.75
mass = 0.1
damping = 0.1
stiffness = 0.1
friction = 0.05
speed = 0.3
[dither]
direction = "tangential"
frequency_ratio = 2.7
"#;

const AXES: &str = r#"[[sweep]]
parameter = "disc.load.speed"
from = 0.02
to = 1.0
points = 12
spacing = "log"
[[sweep]]
parameter = "disc.load.friction"
from = 0.0
to = 0.6
points = 6
"#;

/// A fresh folder with these studies.
fn place(name: &str) -> Place {
    Place::with(name, &[("disc.toml", STUDY), ("map.toml", &format!("{STUDY}{AXES}"))])
}

/// Standard output, standard error, exit status.
fn quell(place: &Place, arguments: &[&str]) -> (String, String, i32) {
    let output = place.quell(arguments);
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8");
    (text(output.stdout), text(output.stderr), output.status.code().expect("a status"))
}

/// The answer of a verb; the text answer is checked to exist too.
fn good(place: &Place, arguments: &[&str]) -> Json {
    let object = place.good(arguments);
    let (words, _, status) = quell(place, arguments);
    assert!(status == 0 && words.lines().count() > 1, "{words}");
    object
}

#[test]
fn every_verb_has_its_documented_fields() {
    let place = place("disc-verbs");
    assert_eq!(good(&place, &["check", "disc.toml"])["disc"]["modes"], 3);
    assert!(
        good(&place, &["cite", "disc.toml"])["corrections"].as_array().expect("a list").len() > 4
    );
    let modes = good(&place, &["modes", "disc.toml"]);
    for name in ["radial", "diameters", "frequency_parameter", "ratio", "shape_at_load"] {
        assert!(modes["modes"][1][name].is_number(), "{name}");
    }
    assert_eq!(modes["critical_mode"]["diameters"], 2);
    let stability = good(&place, &["stability", "disc.toml"]);
    assert_eq!(stability["verdict"], "stable");
    for name in ["growth_rate", "growth_rate_error", "frequency"] {
        assert!(stability[name].is_number(), "{name}");
    }
    // On a line of table 5.1 and Ω = 0 a motion is out of the load's reach.
    let marginal = good(&place, &["stability", "disc.toml", "--set", "disc.load.speed=0"]);
    assert_eq!(marginal["verdict"], "undecided");
    let resonances = good(&place, &["resonances", "disc.toml"]);
    assert_eq!(resonances["undithered"].as_array().expect("a list").len(), 7);
    assert_eq!(resonances["dithered"].as_array().expect("a list").len(), 8);
    for name in ["speed", "waves", "pair_can_be_unstable", "threshold", "edges", "peak_growth"] {
        assert!(resonances["dithered"][0].get(name).is_some(), "{name}");
    }
}

#[test]
fn a_clear_frequency_is_found_and_verified() {
    let place = place("disc-clear");
    let set = ["--set", "disc.load.friction=0.25"];
    let asked =
        [&["resonances", "disc.toml", "--clear", "0.25:0.6", "--frequency", "2:6"], &set[..]]
            .concat();
    let found = good(&place, &asked);
    let clear = &found["clear"];
    assert_eq!(clear["original_suppressed"], true);
    let ratio = clear["suggestion"].as_f64().expect("a frequency");
    let inside = |list: &Json| {
        list.as_array().expect("a list").iter().any(|part| {
            (part[0].as_f64().expect("from")..=part[1].as_f64().expect("to")).contains(&ratio)
        })
    };
    assert!(inside(&clear["clear"]), "{clear}");
    // The remaining instabilities are reported: none, by theory and by the exact exponents. If the range begins at 0.2, a
    // frequency is chosen for which the reappearing undithered tongue does not reach into the range.
    let left = |clear: &Json| {
        let there = clear["there"].as_array().expect("a list");
        there.iter().filter(|item| item["reaches_in"] == true).count()
    };
    assert_eq!(left(clear), 0, "{clear}");
    let mut wider = asked.clone();
    wider[3] = "0.2:0.6";
    let wider = &good(&place, &wider)["clear"];
    assert_eq!(left(wider), 0, "{wider}");
    for clear in [clear, wider] {
        assert!(clear["verified_growth_rate"].as_f64().is_some_and(|rate| rate < 0.0), "{clear}");
    }
    // The verdict of the exact equations at that frequency, over the range.
    for speed in ["0.25", "0.35", "0.45", "0.6"] {
        let (ratio, speed) =
            (format!("dither.frequency_ratio={ratio}"), format!("disc.load.speed={speed}"));
        let there =
            [&["stability", "disc.toml", "--set", &ratio, "--set", &speed], &set[..]].concat();
        assert_eq!(good(&place, &there)["verdict"], "stable", "{there:?}");
    }
    for (arguments, key) in [
        (["--clear", "0.6:0.2", "--frequency", "2:6"], "--clear"),
        (["--clear", "0.2:0.6", "--frequency", "0:6"], "--frequency"),
        (["--clear", "0.2:0.6", "--frequency", "six"], "--frequency"),
    ] {
        let errors = place.refused(&[&["resonances", "disc.toml"], &arguments[..]].concat());
        assert_eq!(errors[0]["key"], key);
    }
    place.write("plain.toml", STUDY.split("[dither]").next().expect("a part").as_bytes());
    let errors =
        place.refused(&["resonances", "plain.toml", "--clear", "0.2:0.6", "--frequency", "2:6"]);
    assert_eq!(errors[0]["key"], "dither");
}

/// Instabilities that no frequency removes are reported: tongues that reach into the range, and where it cannot be kept clear.
#[test]
fn remaining_instabilities_at_a_clear_frequency_are_reported() {
    let place = place("disc-left");
    let ask = |speeds: &str, friction: &str| {
        let set = format!("disc.load.friction={friction}");
        let asked = ["resonances", "disc.toml", "--clear", speeds, "--frequency", "2:6", "--set"];
        let asked = [&asked[..], &[set.as_str()]].concat();
        let clear = place.good(&asked)["clear"].clone();
        let (words, _, status) = quell(&place, &asked);
        assert_eq!(status, 0);
        (clear, words)
    };
    let reaching = |clear: &Json| -> Vec<Json> {
        let there = clear["there"].as_array().expect("a list");
        there.iter().filter(|item| item["reaches_in"] == true).cloned().collect()
    };
    let left = |words: &str| -> Vec<String> {
        words.lines().filter(|line| line.contains("remaining there:")).map(str::to_owned).collect()
    };
    // Tangential dither removes this tongue at first order only: it reappears at second order and ends at 0.27, and by the exact
    // equations no motion grows beyond 0.25.
    let (clear, words) = ask("0.25:0.6", "0.6");
    let found = reaching(&clear);
    assert_eq!(found.len(), 1, "{clear}");
    assert!(clear["there"].as_array().is_some_and(|there| there.len() > 1), "{clear}");
    assert_eq!(
        (&found[0]["harmonic"], &found[0]["pair_can_be_unstable"]),
        (&0.into(), &true.into())
    );
    let number = |item: &Json| item.as_f64().expect("a number");
    assert!(number(&found[0]["speed"]) < 0.25 && number(&found[0]["edges"][1]) > 0.25, "{clear}");
    assert!(number(&clear["verified_growth_rate"]) < 0.0, "{clear}");
    assert!(words.contains("verified: in the exact equations nothing grows there"), "{words}");
    let printed = left(&words);
    assert_eq!(printed.len(), 1, "{words}");
    let line =
        "remaining there: Ω = 0.1923353, forward (1,1) with forward (1,2), growth up to 0.00";
    assert!(printed[0].trim_start().starts_with(line), "{printed:?}");
    // Closer to it some motion grows at any frequency.
    let (clear, words) = ask("0.2:0.9", "0.6");
    assert!(number(&clear["verified_growth_rate"]) > 0.0, "{clear}");
    assert!(words.contains("not clear: in the exact equations"), "{words}");
    assert_eq!(left(&words).len(), reaching(&clear).len(), "{words}");
    // Over all speeds the theory finds no frequency either.
    let (clear, words) = ask("0.02:0.9", "0.4");
    assert!(clear["suggestion"].is_null() && clear["why"]["suggestion"].is_string(), "{clear}");
    assert!(words.contains("clear of dither-induced tongues at first order:\n  none\n"), "{words}");
    assert!(!words.contains("remaining there") && !words.contains("verified"), "{words}");
}

#[test]
fn modes_written_and_read_back_give_the_same_exponent() {
    let place = place("disc-modes");
    good(&place, &["modes", "disc.toml", "--save", "modes.csv", "--plot", "modes.png"]);
    place.write(
        "read.toml",
        STUDY.replace("inner_radius_ratio = 0.5", "modes_file = \"modes.csv\""),
    );
    let rate =
        |study: &str| good(&place, &["stability", study])["growth_rate"].as_f64().expect("a rate");
    assert!((rate("disc.toml") - rate("read.toml")).abs() <= 1e-12);
    assert!(fs::metadata(place.folder.join("modes.png")).expect("a picture").len() > 5000);
    let text = fs::read_to_string(place.folder.join("modes.csv")).expect("text");
    place.write("modes.csv", text.replace("diameters", "diametres"));
    let errors = place.refused(&["check", "read.toml"]);
    assert!(
        errors[0]["allowed"].as_str().expect("text").contains("column diameters"),
        "{errors:?}"
    );
}

#[test]
fn maps_of_a_disc_are_saved_and_drawn() {
    let place = place("disc-map");
    let map = good(
        &place,
        &[
            "map",
            "map.toml",
            "--quantity",
            "growth,verdict",
            "--save",
            "map.csv",
            "--plot",
            "map.png",
        ],
    );
    assert_eq!(map["axes"][1]["values"].as_array().expect("values").len(), 6);
    assert!(map["axes"][0]["values"].as_array().expect("values").len() > 40);
    assert!(map["growth"][0][0].is_number() && map["growth_verdict_status"].is_array());
    let errors = place.refused(&["map", "map.toml", "--quantity", "residual-vibration"]);
    assert!(errors[0]["allowed"].as_str().expect("text").contains("growth"), "{errors:?}");
    let store = ["map", "map.toml", "--quantity", "growth", "--save", "map.zarr"];
    let first = good(&place, &store[..4]);
    let (_, printed, status) = quell(&place, &store);
    assert_eq!(status, 0, "{printed}");
    let (text, printed, status) = quell(&place, &[&store[..], &["--resume", "--json"]].concat());
    assert_eq!(status, 0, "{printed}");
    let again: Json = serde_json::from_str(&text).expect("one object");
    assert_eq!(again["growth"], first["growth"]);
}

#[test]
fn invalid_discs_are_rejected_and_the_clamp_causes_a_warning() {
    let place = place("disc-bad");
    for (change, key) in [
        ("disc.inner_radius_ratio=1", "disc.inner_radius_ratio"),
        ("disc.load.radius_ratio=0.4", "disc.load.radius_ratio"),
        ("disc.load.radius_ratio=1.1", "disc.load.radius_ratio"),
        ("disc.load.damping=-0.1", "disc.load.damping"),
        ("disc.modal_damping=-1e-3", "disc.modal_damping"),
        ("disc.radial_modes=0", "disc.radial_modes"),
        ("disc.load.colour=1", "disc.load.colour"),
        ("dither.frequency_ratio=0", "dither.frequency_ratio"),
    ] {
        for verb in ["check", "modes", "stability", "resonances"] {
            let errors = place.refused(&[verb, "disc.toml", "--set", change]);
            assert!(errors.iter().any(|error| error["key"] == key), "{change}: {errors:?}");
        }
    }
    let normal = ["--set", "dither.direction=normal", "--set", "dither.amplitude=1.2"];
    let errors = place.refused(&[&["stability", "disc.toml"], &normal[..]].concat());
    assert_eq!(errors[0]["key"], "dither.amplitude");
    let (_, printed, status) =
        quell(&place, &["stability", "disc.toml", "--set", "disc.load.radius_ratio=0.5"]);
    assert!(
        status == 0 && printed.contains("warning") && printed.contains("couples to no mode"),
        "{printed}"
    );
    for verb in [&["friction"][..], &["response"]] {
        let errors = place.refused(&[verb, &["disc.toml"]].concat());
        assert_eq!(errors[0]["key"], "disc", "{errors:?}");
    }
    place.write("belt.toml", "schema = 1\n[belt]\ndamping_ratio = 0.01\nnormal_load = 1\nbelt_velocity = 0.1\n\
        [friction]\nlaw = \"stribeck\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2\nreference_velocity = \
                            0.2\n".as_bytes());
    let modes = good(&place, &["modes", "belt.toml"]);
    assert_eq!(modes["modes"].as_array().map(Vec::len), Some(1));
}

/// A brake disc of steel with its loads in SI.
const STEEL: &str = r#"schema = 1
[disc]
inner_radius_ratio = 0.5
youngs_modulus_pa = "210 GPa"
density_kg_per_m3 = 7850
thickness_m = "10 mm"
outer_radius_m = 0.14
[disc.load]
radius_ratio = 0.75
mass_kg = 0.2
damping_n_s_per_m = 400
stiffness_n_per_m = 2e7
friction_n = 500
speed_rpm = 600
[dither]
direction = "tangential"
frequency_hz = "20 kHz"
"#;

#[test]
fn a_disc_may_be_in_si() {
    let place = Place::with("disc-si", &[("steel.toml", STEEL)]);
    let check = place.good(&["check", "steel.toml"]);
    let modes = place.good(&["modes", "steel.toml"]);
    // Every number of an answer is in the units of the study, one under each name.
    let (turn, radius) = (2.0 * std::f64::consts::TAU * 5.0, 0.75 * 0.14);
    let load = &check["disc"]["loads"][0];
    for (name, wanted, unit) in [
        ("mass", 0.2, "kg"),
        ("damping", 400.0, "N·s/m"),
        ("stiffness", 2e7, "N/m"),
        ("friction", 500.0, "N"),
    ] {
        assert!((number(&load[name]) / wanted - 1.0).abs() < 1e-14, "{name}: {load}");
        assert_eq!(load["units"][name], unit);
    }
    assert!((number(&check["disc"]["speed"]) / turn - 1.0).abs() < 1e-14, "{check}");
    assert!((number(&check["dither"]["frequency"]) / (2e3 * turn) - 1.0).abs() < 1e-14, "{check}");
    let first = &modes["modes"][0];
    let ratio = number(&first["frequency"]) / number(&modes["reference"]);
    assert!((ratio / number(&first["ratio"]) - 1.0).abs() < 1e-14, "{first}");
    assert_eq!([&check["unit_system"], &modes["units"]["critical_speed"]], ["SI", "rad/s"]);
    // Every unstable mode; the table has Hz, rpm and km/h as well.
    let still = [
        "stability",
        "steel.toml",
        "--set",
        "disc.load.friction_n=50kN",
        "--set",
        "disc.without=[\"dither\"]",
    ];
    let found = place.good(&still[..4]);
    assert!((number(&found["speed"]) / turn - 1.0).abs() < 1e-12, "{found}");
    assert!((number(&found["speed_at_load"]) / (turn * radius) - 1.0).abs() < 1e-12, "{found}");
    for mode in found["unstable_modes"].as_array().expect("a list") {
        assert!(number(&mode["growth_rate"]) > 0.0 && number(&mode["frequency"]) > 100.0, "{mode}");
    }
    assert_eq!(found["units"]["growth_rate"], "1/s");
    let named = found.as_object().expect("an object").keys();
    assert!(named.clone().all(|name| !name.ends_with("_hz") && !name.ends_with("_rpm")), "{found}");
    let (words, _, _) = quell(&place, &still[..4]);
    assert!(words.contains(" rpm)") && words.contains("km/h") && words.contains("dB/s"), "{words}");
    // Options take units; plain numbers are in hertz here.
    let ask = |speeds: &str, clear: &str, frequency: &str| {
        let range = ["--speeds", speeds, "--clear", clear, "--frequency", frequency];
        place.good(
            &[&["resonances", "steel.toml", "--set", "disc.load.friction_n=100"][..], &range]
                .concat(),
        )
    };
    let units = ask("0rpm:60000rpm", "6000rpm:12000rpm", "18kHz:20kHz");
    assert_eq!(units, ask("0:1000", "100:200", "18000:20000"));
    assert!(number(&units["clear"]["frequencies"][0]) > 17_999.0 * std::f64::consts::TAU);
    // Each key may be in SI or not; both at once, or SI without a size, is refused.
    place.good(&[
        "check",
        "steel.toml",
        "--set",
        "disc.load.speed=0.1",
        "--set",
        "dither.frequency_ratio=3",
    ]);
    let twice = STEEL.replace("speed_rpm = 600", "speed_rpm = 600\nspeed = 0.1");
    place.write("twice.toml", twice);
    let errors = place.refused(&["check", "twice.toml"]);
    assert!(
        errors[0]["allowed"].as_str().is_some_and(|item| item.contains("not both")),
        "{errors:?}"
    );
    place.write("bare.toml", STUDY.replace("speed = 0.3", "speed_rpm = 600"));
    let errors = place.refused(&["check", "bare.toml"]);
    let allowed = errors[0]["allowed"].as_str().unwrap_or_default();
    assert!(
        errors[0]["key"] == "disc.load.speed_rpm"
            && allowed.contains("the size and material of the plate"),
        "{errors:?}"
    );
}

#[test]
fn each_load_may_have_a_phase_of_its_dither() {
    let two = STUDY.replace(
        "[disc.load]",
        "[[disc.load]]\nradius_ratio = 0.75\nangle_deg = 30\nfriction = 0.04\n[[disc.load]]",
    );
    let place = Place::with("disc-phase", &[("two.toml", &two)]);
    let rate = |phase: &str| {
        let set = format!("disc.load[0].dither_phase_deg={phase}");
        number(&place.good(&["stability", "two.toml", "--set", &set])["growth_rate"])
    };
    let turned = ["stability", "two.toml", "--set", "disc.load[0].friction=-0.04"];
    assert!((rate("180") - number(&place.good(&turned)["growth_rate"])).abs() < 1e-9);
    assert!((rate("90deg") - rate("0")).abs() > 1e-6);
}

fn number(value: &Json) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("a number: {value}"))
}

/// A point of a map of a disc in SI is the answer of `stability` there, in the same unit, and a motion has its time in seconds.
#[test]
fn maps_and_motions_of_a_disc_in_si_have_its_units() {
    let loud = STEEL.replace("friction_n = 500", "friction_n = \"50 kN\"");
    let place = Place::with("disc-units", &[("steel.toml", &loud)]);
    let axes =
        ["--set", "sweep[0].parameter=disc.load.speed_rpm", "--set", "sweep[0].values=[600, 1200]"];
    let map = place.good(&[&["map", "steel.toml", "--quantity", "growth"][..], &axes].concat());
    assert_eq!(map["units"]["growth"], "1/s");
    let speeds = map["axes"][0]["values"].as_array().expect("values");
    for (place_of, speed) in speeds.iter().enumerate() {
        let set = format!("disc.load.speed_rpm={speed}");
        let found = place.good(&["stability", "steel.toml", "--set", &set]);
        assert_eq!(map["growth"][place_of], found["growth_rate"], "{speed}");
    }
    let run = place.good(&["simulate", "steel.toml", "--until", "1ms"]);
    assert!((number(&run["final"]["time"]) / 1e-3 - 1.0).abs() < 1e-12, "{run}");
    assert_eq!([&run["units"]["time"], &run["units"]["mean_friction"]], ["s", "N"]);
    let sentence = run["sentence"].as_str().expect("words");
    assert!(sentence.contains("at t = 0.001 s"), "{sentence}");
}
