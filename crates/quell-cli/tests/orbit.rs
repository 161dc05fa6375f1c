//! Tests of the binary: periodic responses and thresholds.

use serde_json::Value as Json;

use crate::place::Place;
use crate::repository::{quell, words};

/// Decreasing law, v₀ = 1, ζ = 0.005, sine tangential dither with R = 10, D = 6.
const STUDY: &str = "studies/can-dither-make-it-worse.toml";

/// The belt of the decreasing law without dither.
const WITHOUT: &str = "studies/does-it-squeal.toml";

/// Thresholds of a study that has them.
fn thresholds(study: &str, parameter: &str, [from, to]: [&str; 2], more: &[&str]) -> Json {
    let asked = ["thresholds", study, "--parameter", parameter, "--from", from, "--to", to];
    let (found, status) = quell(&[&asked[..], more].concat());
    assert_eq!(status, 0, "{found}");
    found
}

/// A pad in SI with sine tangential dither of 4 kN.
const PAD: &str = "studies/squealing-pad-si.toml";

#[test]
fn the_fields_of_an_orbit_have_documented_names() {
    let (found, status) = quell(&["orbit", STUDY]);
    assert_eq!(status, 0);
    assert_eq!(found["verdict"], "unstable");
    let contact = &found["contacts"][0];
    assert_eq!((&contact["stick_episodes"], &contact["reversals"]), (&0.into(), &0.into()));
    let modulus = |item: &Json| item[0].as_f64().expect("re").hypot(item[1].as_f64().expect("im"));
    assert!(modulus(&found["multipliers"][0]) > 1.0);
    for name in ["displacement", "velocity", "residual", "period", "sentence"] {
        assert!(!found[name].is_null(), "{name}");
    }
    // Beyond the upper threshold the mass reverses twice a period, and the response is stable.
    let (found, _) = quell(&["orbit", STUDY, "--set", "dither.amplitude=12"]);
    let reversals = &found["contacts"][0]["reversals"];
    assert_eq!((found["verdict"].as_str(), reversals), (Some("stable"), &2.into()));
}

#[test]
fn without_dither_the_limit_cycle_is_the_orbit() {
    let study = ["orbit", "studies/does-it-squeal.toml"];
    let stribeck = ["--set", "friction.law=stribeck", "--set", "belt.belt_velocity=0.05"];
    let (found, status) = quell(&[&study[..], &stribeck].concat());
    assert_eq!(status, 0, "{found}");
    assert_eq!((&found["verdict"], &found["free_phase"]), (&"stable".into(), &true.into()));
    assert!((found["period"].as_f64().expect("a period") - 9.600_930_182_576).abs() < 1e-10);
    let off =
        |item: &Json| (item[0].as_f64().expect("re") - 1.0).hypot(item[1].as_f64().expect("im"));
    let multipliers = found["multipliers"].as_array().expect("multipliers");
    assert!(multipliers.iter().map(off).fold(f64::INFINITY, f64::min) < 1e-9);
    // Without squeal there is no limit cycle, and the reason is given.
    let (found, status) = quell(&[&study[..], &["--set", "belt.belt_velocity=3"]].concat());
    assert_eq!((status, found["verdict"].as_str()), (0, Some("stable")));
    assert!(found["period"].is_null() && found["why"]["period"].is_string());
    assert_eq!(found["cycles"], Json::Array(Vec::new()));
    // In addition to the squeal there is the unstable cycle that bounds its basin.
    let study = ["orbit", "studies/can-it-squeal-although-stable.toml"];
    let (found, _) = quell(&study);
    let cycles = found["cycles"].as_array().expect("cycles");
    let verdicts: Vec<_> = cycles.iter().map(|item| item["verdict"].as_str()).collect();
    assert_eq!(verdicts, [Some("stable"), Some("unstable")], "{found}");
    let near = format!("{},0", cycles[1]["displacement"]);
    let (found, _) = quell(&[&study[..], &["--near", &near]].concat());
    assert_eq!(found["verdict"], "unstable");
}

#[test]
fn the_orbit_that_a_run_reaches_is_found() {
    let set = ["orbit", STUDY, "--set", "dither.amplitude=2.5"];
    let (quiet, _) = quell(&[&set[..], &["--from-rest"]].concat());
    let (loud, status) = quell(&[&set[..], &["--from-squeal"]].concat());
    assert_eq!(status, 0, "{loud}");
    let sticks = |found: &Json| found["contacts"][0]["stick_episodes"].as_u64();
    assert_eq!((sticks(&quiet), &quiet["verdict"]), (Some(0), &"stable".into()));
    assert!(sticks(&loud) >= Some(1), "{loud}");
    let ratio = loud["period"].as_f64().expect("a period") / quiet["period"].as_f64().expect("one");
    assert!((ratio - 10.0).abs() < 1e-9, "{ratio}");
}

#[test]
fn thresholds_tell_each_protocol_apart() {
    let protocols = ["--from-rest", "--from-squeal", "--start", "0,0"];
    let found = thresholds(STUDY, "dither.amplitude", ["2", "10.5"], &protocols);
    let value = |item: &Json| item["value"].as_f64().expect("a value");
    let local = found["local"].as_array().expect("local");
    assert_eq!(local.len(), 2);
    assert!((value(&local[0]) / 4.322_392_624 - 1.0).abs() < 1e-8);
    assert_eq!(
        (&local[0]["kind"], &local[0]["becomes"]),
        (&"neimark-sacker".into(), &"unstable".into())
    );
    assert!((value(&local[1]) / 9.900_214_849 - 1.0).abs() < 1e-8);
    assert_eq!((&local[1]["kind"], &local[1]["becomes"]), (&"grazing".into(), &"stable".into()));
    assert!((value(&found["from_rest"][0]) - 2.868).abs() < 5e-3);
    assert_eq!(found["from_rest"], found["from_start"]);
    // A squealing run continues to squeal up to the upper local threshold.
    let squeal = found["from_squeal"].as_array().expect("from squeal");
    assert_eq!((squeal.len(), &squeal[0]["becomes"]), (1, &"quenched".into()));
    assert!((value(&squeal[0]) / 9.900_214_849 - 1.0).abs() < 2e-5, "{squeal:?}");
}

#[test]
fn threshold_curves_are_followed_and_saved() {
    let directory = tempfile::tempdir().expect("a directory");
    let (csv, svg) = (directory.path().join("curves.csv"), directory.path().join("curves.svg"));
    let (found, status) = quell(&[
        "thresholds",
        STUDY,
        "--parameter",
        "dither.amplitude",
        "--from",
        "0.5",
        "--to",
        "16",
        "--along",
        "belt.belt_velocity",
        "--between",
        "0.85:1.5",
        "--save",
        csv.to_str().expect("text"),
        "--plot",
        svg.to_str().expect("text"),
    ]);
    assert_eq!(status, 0, "{found}");
    let curves = found["curves"].as_array().expect("curves");
    let kinds: Vec<_> = curves.iter().filter_map(|item| item["kind"].as_str()).collect();
    assert!(kinds.contains(&"neimark-sacker") && kinds.contains(&"grazing"), "{kinds:?}");
    assert_eq!(found["averaged"].as_array().map(Vec::len), Some(2));
    let points: usize =
        curves.iter().map(|item| item["value"].as_array().expect("values").len()).sum();
    let text = std::fs::read_to_string(csv).expect("saved");
    let rows = text.lines().filter(|line| !line.starts_with('#')).count();
    assert_eq!(rows, points + 1);
    assert!(text.contains("belt.belt_velocity,dither.amplitude,multiplier_modulus"), "{text}");
    assert!(std::fs::read_to_string(svg).expect("drawn").contains("exact: grazing"));
}

#[test]
fn steady_sliding_has_a_hopf_bifurcation() {
    let (found, status) = quell(&[
        "thresholds",
        "studies/does-it-squeal.toml",
        "--parameter",
        "belt.belt_velocity",
        "--from",
        "0.5",
        "--to",
        "3",
        "--from-squeal",
    ]);
    assert_eq!(status, 0, "{found}");
    let local = &found["local"][0];
    assert_eq!((&local["kind"], &local["becomes"]), (&"hopf".into(), &"stable".into()));
    assert!((local["value"].as_f64().expect("a value") - 0.809_135_878_048).abs() < 1e-9);
    // A squealing run continues to squeal far beyond, as long as the cycle exists.
    let squeal = found["from_squeal"][0]["value"].as_f64().expect("a value");
    assert!((squeal - 2.4999).abs() < 2e-3, "{squeal}");
}

/// Two responses coexist without dither: the one that the run reaches is reported, and not the largest cycle.
#[test]
fn an_undithered_run_reaches_the_response_of_its_start() {
    let study = "studies/can-it-squeal-although-stable.toml";
    let ask = |arguments: &[&str]| quell(&[&["orbit", study], arguments].concat());
    for (start, cycle) in [
        (&["--from-rest"][..], false),
        (&["--from-sliding"], false),
        (&["--from-squeal"], true),
        (&["--start", "0.29,0"], false),
        (&["--start", "3,0"], true),
        (&[], true),
    ] {
        let (found, status) = ask(start);
        assert_eq!(status, 0, "{found}");
        assert_eq!(found["multipliers"].is_array(), cycle, "{start:?} {found}");
        // As in a run.
        if let ["--start", state] = start {
            let (x, v) = state.split_once(',').expect("two numbers");
            let (x, v) =
                (format!("belt.initial.displacement={x}"), format!("belt.initial.velocity={v}"));
            let (run, _) = quell(&[
                "simulate",
                study,
                "--set",
                "belt.initial.state=rest",
                "--set",
                &x,
                "--set",
                &v,
                "--until",
                "2000",
                "--events",
            ]);
            let last = run["events"].as_array().and_then(|events| events.last()?["time"].as_f64());
            assert_eq!(last.is_some_and(|time| time > 1900.0), cycle, "{state}: {last:?}");
        }
    }
    let (found, status) = ask(&["--set", "belt.belt_velocity=9", "--from-squeal"]);
    assert_eq!((status, found["errors"][0]["key"].as_str()), (2, Some("--from-squeal")), "{found}");
    let (found, status) = ask(&["--set", "belt.belt_velocity=0"]);
    assert_eq!(
        (status, found["errors"][0]["key"].as_str()),
        (2, Some("belt.belt_velocity")),
        "{found}"
    );
}

/// Every change is found, regardless of the values tried first.
#[test]
fn runs_from_rest_have_both_thresholds_in_any_window() {
    for range in [["0.1", "10.1"], ["2.1", "12.1"]] {
        let found = thresholds(STUDY, "dither.amplitude", range, &["--from-rest"]);
        let changes = found["from_rest"].as_array().expect("changes");
        let values: Vec<f64> = changes.iter().filter_map(|item| item["value"].as_f64()).collect();
        assert!(
            (values[0] - 2.868).abs() < 5e-3 && (values[1] / 9.900_214_849 - 1.0).abs() < 2e-5,
            "{found}"
        );
        let ends: Vec<&str> = changes.iter().filter_map(|item| item["becomes"].as_str()).collect();
        assert_eq!(ends, ["not quenched", "quenched"]);
        assert_eq!(found["warnings"].as_array().map(Vec::len), Some(0));
    }
}

/// If the base response is lost, thresholds found before are kept, and runs still report their outcomes: without slow vibration,
/// as `response` reports for the same runs, on orbits of one and of three periods of the dither.
#[test]
fn a_lost_branch_does_not_discard_other_results() {
    const OWN: &str = "studies/own-friction-law.toml";
    // Within 5·10⁻⁶ of the amplitude at which the response begins to reverse its slip no step follows it.
    let found = thresholds(OWN, "dither.amplitude", ["0.8", "1.13807"], &["--from-rest"]);
    assert_eq!(found["covered"], false);
    let wide = thresholds(OWN, "dither.amplitude", ["0.8", "2"], &[]);
    assert_eq!(wide["covered"], true);
    let local = found["local"][0]["value"].as_f64().expect("a threshold");
    assert!((local - 0.990_450_5).abs() < 1e-6, "{local}");
    assert_eq!(found["at_from"]["from_rest"], "not quenched");
    let changes = found["from_rest"].as_array().expect("changes");
    let becomes: Vec<_> = changes.iter().filter_map(|item| item["becomes"].as_str()).collect();
    assert_eq!((becomes, found["warnings"].as_array().map(Vec::len)), (vec!["quenched"], Some(1)));
    assert!(
        found["warnings"][0].as_str().is_some_and(|text| text.contains("no response")),
        "{found}"
    );
    for (amplitude, ends, is_base) in [("1.05", "period-1", true), ("1.13807", "locked", false)] {
        let set = format!("dither.amplitude={amplitude}");
        let (found, _) = quell(&["response", OWN, "--set", &set]);
        assert_eq!((&found["effect"], &found["ends_on"]), (&"quenches".into(), &ends.into()));
        assert_eq!((&found["base_response"], &found["quiet"]), (&is_base.into(), &true.into()));
    }
}

/// Where a stick begins with a static level above μ(0⁺) no response exists next to the grazing: the interval is stated, does not depend on the
/// range, and every verb knows the response beyond it.
#[test]
fn a_gap_beyond_a_grazing_is_stated() {
    for range in [["0.8", "2"], ["0.95", "1.05"], ["0.5", "20"]] {
        let found = thresholds("studies/own-friction-law.toml", "dither.amplitude", range, &[]);
        let local = &found["local"][0];
        let number = |value: &Json| value.as_f64().expect("a number");
        let [grazing, end] = ["from", "to"].map(|end| number(&found["gaps"][0][end]));
        assert_eq!(number(&local["value"]), grazing);
        assert!(
            (grazing - 0.990_450_492).abs() < 1e-8 && number(&local["error"]) < 1e-9,
            "{local}"
        );
        // A run from rest is in step with the dither from 0.991073 on.
        assert!((end - 0.991_073).abs() < 2e-6, "{end}");
        assert_eq!((&local["was"], &local["becomes"]), (&"unstable".into(), &"stable".into()));
        let [sentence, warning] = [&found["sentence"], &found["warnings"][0]];
        assert!(sentence.as_str().is_some_and(|text| text.contains("0.9911")), "{sentence}");
        assert!(
            warning.as_str().is_some_and(|text| text.contains("no response was found")),
            "{warning}"
        );
        // `orbit` knows the base response from the end of the gap on, and none in it.
        for (share, response) in
            [(-0.01_f64, "base"), (0.5, "reached"), (1.02, "base"), (2.0, "base")]
        {
            let amplitude = share.mul_add(end - grazing, grazing);
            let set = format!("dither.amplitude={amplitude}");
            let (orbit, _) = quell(&["orbit", "studies/own-friction-law.toml", "--set", &set]);
            assert_eq!(orbit["response"], response, "{share}: {orbit}");
        }
    }
}

/// A gap on whose sides the response is stable is no threshold, and yet not all of the range is stable.
#[test]
fn a_gap_between_stable_responses_is_not_stable() {
    let text = "schema = 1\n[belt]\nbelt_velocity = 0.1\ndamping_ratio = 0.01\nnormal_load = 1.0\n[friction]\nlaw = \"coulomb\"\n\
        static_coefficient = 0.4\ncoefficient = 0.3\n[[dither]]\ndirection = \"tangential\"\nwaveform = \"sine\"\namplitude = 0.99\n\
        frequency_ratio = 10.0\n";
    let place = Place::with("orbit-coulomb", &[("coulomb.toml", text)]);
    for [from, to] in [["0.98", "1"], ["0", "1.98"]] {
        let range = ["--parameter", "dither.amplitude", "--from", from, "--to", to];
        let found = place.good(&[&["thresholds", "coulomb.toml"][..], &range].concat());
        let gap = &found["gaps"][0];
        let ends = ["from", "to"].map(|end| gap[end].as_f64().expect("a number"));
        assert!((ends[0] - 0.990_002).abs() < 1e-6 && (ends[1] - 0.992_43).abs() < 2e-5, "{gap}");
        assert_eq!(found["local"], Json::Array(Vec::new()));
        let sentence = found["sentence"].as_str().expect("words");
        assert!(sentence.contains("up to the dither amplitude 0.99 and from"), "{sentence}");
    }
}

/// Where a stable response with a stick meets the unstable one in slip from below, both end: another stable response, of another branch, begins
/// at a larger distance of the state, and was taken for the continuation.
#[test]
fn no_response_of_another_branch_continues_this_one() {
    let set = "dither.frequency_ratio=0.5";
    let found = thresholds(
        "studies/stribeck-belt.toml",
        "dither.amplitude",
        ["0.01", "0.6"],
        &["--set", set],
    );
    let first = &found["local"][0];
    let value = first["value"].as_f64().expect("a number");
    assert!((value - 0.087_301_84).abs() < 1e-7, "{first}");
    assert_eq!((&first["was"], &first["becomes"]), (&"unstable".into(), &"none".into()), "{first}");
    for amplitude in ["0.0874", "0.1", "0.12", "0.4"] {
        let amplitude = format!("dither.amplitude={amplitude}");
        let study = "studies/stribeck-belt.toml";
        let (orbit, _) = quell(&["orbit", study, "--set", set, "--set", &amplitude]);
        assert_eq!(orbit["response"], "reached", "{amplitude}");
    }
}

/// Thresholds do not depend on the width of the range: the increments of the continuation follow how far the state moves.
#[test]
fn a_range_of_any_width_has_its_thresholds() {
    for to in ["0.6", "100"] {
        let found = thresholds("studies/stribeck-belt.toml", "dither.amplitude", ["0.4", to], &[]);
        let local = found["local"].as_array().expect("thresholds");
        assert_eq!((local.len(), &local[0]["kind"]), (1, &"grazing".into()), "{to}: {found}");
        let value = local[0]["value"].as_f64().expect("a number");
        assert!((value - 0.496_561_9).abs() < 1e-6, "{to}: {found}");
    }
}

/// A surface that stops and turns: the response is the mirrored one, and that multipliers are 1 where it rests is no threshold.
#[test]
fn a_surface_may_turn() {
    const SYSTEM: &str = "studies/belt-as-system.toml";
    for (range, values) in [
        (["-0.1", "0.1"], &[-0.040_270_12, 0.040_270_12][..]),
        (["-0.03", "0.1"], &[0.040_270_12]),
        (["-0.1", "-0.001"], &[-0.040_270_12]),
        (["-0.03", "0.03"], &[]),
    ] {
        let found = thresholds(SYSTEM, "contact.belt.belt_velocity", range, &[]);
        assert_eq!(found["covered"], true, "{range:?}: {found}");
        let local = found["local"].as_array().expect("thresholds").iter();
        let own: Vec<f64> = local.filter_map(|item| item["value"].as_f64()).collect();
        assert_eq!(own.len(), values.len(), "{range:?}: {found}");
        assert!(own.iter().zip(values).all(|(a, b)| (a - b).abs() < 1e-8), "{range:?}: {own:?}");
    }
}

/// The common period of two dithers, the frequency of one of which varies, is another at every value.
#[test]
fn a_period_that_jumps_is_not_followed() {
    let range = ["9", "12"];
    let path = "dither[0].frequency_ratio";
    let (found, _) = quell(&[
        "thresholds",
        "studies/two-dithers.toml",
        "--parameter",
        path,
        "--from",
        range[0],
        "--to",
        range[1],
    ]);
    let said = found.to_string();
    assert!(said.contains("common period"), "{said}");
}

/// A wide range is covered to its end, and has the thresholds of its part.
#[test]
fn a_wide_range_has_the_thresholds_of_its_part() {
    let ask = |from: &str| thresholds(STUDY, "belt.belt_velocity", [from, "3"], &[]);
    let (wide, part) = (ask("0.3"), ask("0.7"));
    for found in [&wide, &part] {
        assert_eq!((&found["covered"], &found["resumes"]), (&true.into(), &false.into()));
    }
    let values = |found: &Json| -> Vec<f64> {
        let local = found["local"].as_array().expect("thresholds").iter();
        local.map(|threshold| threshold["value"].as_f64().expect("a value")).collect()
    };
    let (all, some) = (values(&wide), values(&part));
    assert!(!some.is_empty());
    for value in some {
        assert!(all.iter().any(|other| (other - value).abs() < 1e-8), "{value} {all:?}");
    }
}

/// In a study in SI, options in newtons and seconds are equivalent to dimensionless ones.
#[test]
fn thresholds_accept_si_units() {
    let ask = |ends: [&str; 2], ramp: &str| {
        thresholds(PAD, "dither.amplitude_n", ends, &["--from-rest", "--ramp", ramp])
    };
    let range = [5000.0, 6500.0];
    let found = ask(["5000", "6500"], "0.05");
    assert_eq!(found, ask(["5kN", "6.5 kN"], "50ms"));
    let number = |item: &Json| item.as_f64().expect("a number");
    let local = &found["local"][0];
    // Finite-R averaging gives 5790.585 N.
    assert!((number(&local["value"]) / 5790.585 - 1.0).abs() < 1e-4, "{local}");
    assert_eq!(local["becomes"], "stable");
    assert_eq!(found["from_rest"].as_array().map(Vec::len), Some(1), "{found}");
    // A rounded quotient and a rounded product of numbers that were read to within one unit in the last place.
    let close = |si: &Json, value: f64| {
        assert!((number(si) - value).abs() <= 4.0 * f64::EPSILON * value.abs(), "{si} {value}");
    };
    assert_eq!(found["parameter"], "dither.amplitude_n");
    close(&found["from"], range[0]);
    close(&found["to"], range[1]);
    close(&found["ramp"], 0.05);
    let printed = words(&[
        "thresholds",
        PAD,
        "--parameter",
        "dither.amplitude_n",
        "--from",
        "5000",
        "--to",
        "6500",
    ]);
    assert!(printed.contains("\nDither amplitude from 5000 N to 6500 N,"), "{printed}");
    let newtons = format!("{:.3} N", number(&local["value"]));
    assert!(printed.contains(&newtons), "{newtons}: {printed}");
    for (name, unit) in [("value", "N"), ("from", "N"), ("displacement", "m")] {
        assert_eq!(found["units"][name], unit);
    }
}

#[test]
fn invalid_requests_are_reported() {
    for (arguments, key) in [
        (&["--parameter", "belt.colour", "--from", "1", "--to", "2"][..], "--parameter"),
        (&["--parameter", "dither.amplitude", "--from", "2", "--to", "1"], "--to"),
        (&["--parameter", "dither.amplitude", "--from", "nan", "--to", "1"], "--from"),
        (&["--parameter", "dither.amplitude", "--from", "-2", "--to", "1"], "--from"),
        (
            &["--parameter", "dither.amplitude", "--from", "1", "--to", "2", "--start", "1"],
            "--start",
        ),
        (
            &["--parameter", "dither.amplitude", "--from", "1", "--to", "2", "--ramp", "-1"],
            "--ramp",
        ),
        (
            &["--parameter", "dither.amplitude", "--from", "1", "--to", "2", "--ramp", "0.5s"],
            "--ramp",
        ),
        (
            &[
                "--parameter",
                "dither.amplitude",
                "--from",
                "1",
                "--to",
                "2",
                "--along",
                "belt.belt_velocity",
                "--between",
                "2:1",
            ],
            "--between",
        ),
        (
            &[
                "--parameter",
                "dither.amplitude",
                "--from",
                "1",
                "--to",
                "2",
                "--along",
                "dither.amplitude",
                "--between",
                "1:2",
            ],
            "--along",
        ),
    ] {
        let (printed, status) = quell(&[&["thresholds", STUDY], arguments].concat());
        assert_eq!((status, printed["errors"][0]["key"].as_str()), (2, Some(key)), "{printed}");
    }
    // For a missing study it is unknown whether it is in SI.
    let nowhere = ["thresholds", "studies/nowhere.toml", "--parameter", "dither.amplitude"];
    let (printed, status) =
        quell(&[&nowhere[..], &["--from", "1", "--to", "2", "--ramp", "0.5s"]].concat());
    assert_eq!((status, printed["errors"].as_array().map(Vec::len)), (2, Some(1)), "{printed}");
}

/// No request is silently ignored, and every rejected value is printed in the message.
#[test]
fn contradictory_options_are_rejected() {
    let range = ["--parameter", "dither.amplitude", "--from", "1", "--to", "2"];
    let below = ["--parameter", "dither.amplitude", "--from=-1", "--to", "2"];
    for (arguments, key, printed) in [
        ([&["thresholds", STUDY], &range[..], &["--ramp", "5"]].concat(), "--ramp", "--from-rest"),
        ([&["thresholds", STUDY], &range[..], &["--ramp", "nan"]].concat(), "--ramp", "nan"),
        ([&["thresholds", STUDY], &range[..], &["--ramp", "1e308"]].concat(), "--ramp", "1e+308"),
        (
            [&["thresholds", STUDY], &below[..]].concat(),
            "--from",
            "--from = -1: must be a value that dither.amplitude can take",
        ),
        (vec!["orbit", STUDY, "--from-rest", "--near", "0.1,0"], "--from-rest", "--near"),
        (vec!["orbit", STUDY, "--periods", "2", "--start", "0,0"], "--periods", "--start"),
        (vec!["orbit", WITHOUT, "--periods", "2"], "--periods", "without dither"),
        (
            vec!["orbit", STUDY, "--set", "belt.belt_velocity=9", "--from-squeal"],
            "--from-squeal",
            "choose another start",
        ),
    ] {
        let (object, status) = quell(&arguments);
        let error = &object["errors"][0];
        let message = error["message"].as_str().unwrap_or_default();
        assert_eq!((status, error["key"].as_str()), (2, Some(key)), "{object}");
        assert!(message.contains(printed) && !message.contains("null"), "{message}");
    }
}
