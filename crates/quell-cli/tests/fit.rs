//! `quell fit`: answers, refusals, files.

use std::fmt::Write as _;
use std::fs;

use serde_json::Value as Json;

use crate::place::Place;

/// The stored case with this index as a file.
fn place(name: &str, index: usize) -> (Place, Json) {
    let text = include_str!("../../../reference/fits.json");
    let cases: Json = serde_json::from_str(text).expect("valid JSON");
    let case = cases[index].clone();
    let csv = case["csv"].as_str().expect("text").to_owned();
    (Place::with(name, &[("data.csv", &csv)]), case)
}

#[test]
fn the_answer_has_the_stored_numbers_and_a_table_for_a_study() {
    let (place, case) = place("fit-stored", 4);
    let done = place.good(&["fit", "data.csv", "--law", "decreasing"]);
    for key in ["static_coefficient", "minimum_coefficient", "reference_velocity"] {
        for field in ["value", "standard_error"] {
            let own = done["parameters"][key][field].as_f64().expect("a number");
            let stored = case["parameters"][key][field].as_f64().expect("a number");
            assert!((own / stored - 1.0).abs() < 1e-10, "{key} {field}: {own}");
        }
    }
    for key in ["residual", "aic"] {
        let (own, stored) = (done[key].as_f64().expect("one"), case[key].as_f64().expect("one"));
        assert!((own / stored - 1.0).abs() < 1e-10, "{key}: {own}");
    }
    assert_eq!(done["n"], 41);
    assert_eq!(done["units"]["reference_velocity"], "m/s");
    assert_eq!(done["units"]["static_coefficient"], "1");
    // The table is that of a study.
    let friction = done["study"]["friction"].as_str().expect("text");
    let belt = "[belt]\nmass_kg = 1.0\nstiffness_n_per_m = 100.0\ndamping_ratio = 0.005\nnormal_force_n = 1.0\n\
                belt_velocity_m_per_s = 0.1\n";
    place.write("study.toml", format!("{belt}{friction}"));
    place.good(&["check", "study.toml"]);
    let uncertainty = done["study"]["uncertainty"].as_str().expect("text");
    assert!(uncertainty.contains("\"friction.reference_velocity_m_per_s\""), "{uncertainty}");
    // So is the other, of uncertain parameters.
    place.write("uncertain.toml", format!("{belt}{friction}{uncertainty}"));
    let found = place.good(&["probability", "uncertain.toml", "--samples", "200"]);
    assert_eq!(found["groups"][0]["of"].as_array().map(Vec::len), Some(3));
    assert_eq!(found["probability"], 1.0);
}

#[test]
fn laws_are_compared_and_the_best_is_first() {
    let (place, _) = place("fit-compared", 3);
    let done = place.good(&["fit", "data.csv", "--plot", "fit.png", "--save", "curve.csv"]);
    assert_eq!(done["law"], "stribeck-exponential");
    let compared = done["comparison"].as_array().expect("a list");
    assert_eq!(compared.len(), 4);
    let weights: f64 = compared.iter().filter_map(|one| one["weight"].as_f64()).sum();
    assert!((weights - 1.0).abs() < 1e-12);
    assert_eq!(compared[0]["difference"], 0.0);
    assert!(fs::read(place.folder.join("fit.png")).expect("a file").starts_with(b"\x89PNG"));
    let curve = fs::read_to_string(place.folder.join("curve.csv")).expect("a file");
    assert!(curve.contains("slip_velocity,coefficient,coefficient_low,coefficient_high"));
}

#[test]
fn advice_to_compare_laws_is_for_fits_that_have_not_compared_them() {
    // No law oscillates over the slip velocity.
    let mut csv = String::from("slip_velocity,coefficient\n");
    for k in 1..=60 {
        let v = 0.05 * f64::from(k);
        writeln!(csv, "{v},{}", 0.3 + 0.05 * (4.0 * v).sin()).expect("writable");
    }
    let place = Place::with("fit-advice", &[("data.csv", &csv)]);
    let advice = |options: &[&str]| -> String {
        let command = [&["fit", "data.csv"], options].concat();
        let done = place.good(&command);
        let warnings = done["warnings"].as_array().expect("a list");
        let of_runs =
            warnings.iter().filter_map(Json::as_str).find(|text| text.contains("runs of"));
        of_runs.expect("a warning about the residuals").to_owned()
    };
    for options in [&["--law", "coulomb"][..], &["--law", "coulomb", "--law", "lugre"]] {
        let said = advice(options);
        assert!(said.ends_with("Compare laws with --law all"), "{said}");
    }
    for options in [&[][..], &["--law", "all"]] {
        let said = advice(options);
        assert!(!said.contains("--law"), "{said}");
        assert!(said.contains("Every law has been compared"), "{said}");
    }
}

#[test]
fn steady_sliding_leaves_bristles_undetermined() {
    let (place, _) = place("fit-lugre", 3);
    let done = place.good(&["fit", "data.csv", "--law", "lugre"]);
    assert_eq!(
        done["not_determinable"],
        serde_json::json!(["bristle_stiffness", "bristle_damping"])
    );
    assert!(done["study"]["friction"].as_str().expect("text").contains("# bristle_stiffness = …"));
    let (refused, status) =
        place.json(&["fit", "data.csv", "--law", "lugre", "--free", "bristle_damping"]);
    assert_eq!(status, 2);
    let said = refused["errors"][0]["message"].as_str().expect("text");
    assert!(said.contains("contain no information"), "{said}");
}

#[test]
fn the_sign_of_the_coefficient_is_found() {
    let (place, _) = place("fit-signs", 1);
    let text = fs::read_to_string(place.folder.join("data.csv")).expect("a file");
    let values: Vec<Json> = ["signed", "opposed", "absolute"]
        .iter()
        .map(|sign| {
            let mut turned = String::from("slip_velocity,coefficient\n");
            for (index, line) in text.lines().skip(1).enumerate() {
                let (v, c) = line.split_once(',').expect("two columns");
                let (v, c): (f64, f64) = (v.parse().expect("one"), c.parse().expect("one"));
                let v = if index % 2 == 0 { -v } else { v };
                let c = match *sign {
                    "signed" => c.copysign(v),
                    "opposed" => c.copysign(-v),
                    _ => c,
                };
                let _ = writeln!(turned, "{v:?},{c:?}");
            }
            place.write("turned.csv", turned);
            let done = place.good(&["fit", "turned.csv", "--law", "stribeck"]);
            assert_eq!(done["sign"], *sign);
            done["parameters"].clone()
        })
        .collect();
    let once = place.good(&["fit", "data.csv", "--law", "stribeck"]);
    assert_eq!(once["sign"], "one-direction");
    assert!(values.iter().all(|own| *own == once["parameters"]));
}

#[test]
fn what_is_wrong_is_refused_by_name() {
    let (place, _) = place("fit-refused", 0);
    place.write("few.csv", "slip_velocity,coefficient\n0.1,0.4\n0.2,0.3\n");
    place.write("text.csv", "slip_velocity,coefficient\n0.1,0.4\n0.2,much\n");
    for (words, said) in [
        (&["data.csv", "--law", "viscous"][..], "one of stribeck, decreasing"),
        (&["data.csv", "--law", "decreasing", "--fix", "viscous=0.1"], "a parameter of the laws"),
        (&["data.csv", "--law", "decreasing", "--fix", "reference_velocity=0"], "--fix"),
        (&["data.csv", "--law", "decreasing", "--fix", "static_coefficient"], "NAME=VALUE"),
        (&["data.csv", "--free", "viscous", "--fix", "viscous=0.1"], "--free and to --fix"),
        (&["few.csv", "--law", "decreasing"], "2 points for 3 free parameters"),
        (&["text.csv"], "line 3, coefficient"),
        (&["missing.csv"], "cannot be read"),
        (&["data.csv", "--plot", "data.csv"], "--plot"),
    ] {
        let (refused, status) = place.json(&[&["fit"], words].concat());
        assert_eq!(status, 2, "{words:?}: {refused}");
        let message = refused["errors"][0]["message"].as_str().expect("text");
        assert!(message.contains(said), "{words:?}: {message}");
    }
    // Of all laws, those with too many parameters are left out.
    let done = place.good(&["fit", "few.csv"]);
    assert_eq!(done["law"], "coulomb");
    assert_eq!(done["left_out"].as_array().expect("a list").len(), 3);
}
