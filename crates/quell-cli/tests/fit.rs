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

/// One table in the ways in which instruments and spreadsheets write it.
#[test]
fn one_table_is_read_however_it_is_written() {
    let (place, _) = place("fit-dialects", 1);
    let text = fs::read_to_string(place.folder.join("data.csv")).expect("a file");
    let rows: Vec<(&str, &str)> =
        text.lines().skip(1).map(|line| line.split_once(',').expect("two columns")).collect();
    let written = |header: &str, row: &dyn Fn(&str, &str) -> String| {
        rows.iter().fold(header.to_owned(), |text, (v, mu)| text + &row(v, mu) + "\r\n")
    };
    let comma = |number: &str| number.replace('.', ",");
    let scaled =
        |number: &str, factor: f64| format!("{:?}", factor * number.parse::<f64>().expect("one"));
    let plain = place.good(&["fit", "data.csv", "--law", "stribeck"]);
    assert_eq!(plain["read"]["separator"], ",");
    let decimal =
        written("slip_velocity;coefficient\r\n", &|v, mu| format!("{};{}", comma(v), comma(mu)));
    let tabs = written("# rig\r\nslip_velocity\tcoefficient (%)\r\n", &|v, mu| {
        format!("{v}\t{}", scaled(mu, 100.0))
    });
    let forces = written("Rig;4\r\nV;F;N\r\n", &|v, mu| {
        format!("{};{};20", comma(v), comma(&scaled(mu, 20.0)))
    });
    let gaps = written("slip_velocity coefficient\r\n1 NaN\r\n", &|v, mu| format!("{v}  {mu}"));
    let choice = "slip_velocity=V,friction_force=F,normal_load=N";
    for (text, columns, field, wanted) in [
        (decimal, &[][..], "decimal", serde_json::json!(",")),
        (tabs, &[], "units", serde_json::json!([null, "%"])),
        (forces, &["--columns", choice], "header_lines", serde_json::json!(1)),
        (gaps, &[], "left_out_lines", serde_json::json!([2])),
    ] {
        place.write("other.csv", text);
        let done = place.good(&[&["fit", "other.csv", "--law", "stribeck"], columns].concat());
        assert_eq!(done["read"][field], wanted, "{done}");
        for key in ["static_coefficient", "viscous"] {
            let of = |done: &Json| done["parameters"][key]["value"].as_f64();
            if let (Some(own), Some(plain)) = (of(&done), of(&plain)) {
                assert!((own / plain - 1.0).abs() < 1e-9, "{field} {key}: {own}");
            }
        }
    }
    // Units are converted, and what may mean two things is refused with its line.
    let text = written("slip_velocity,coefficient\r\nmm/s,1\r\n", &|v, mu| {
        format!("{},{mu}", scaled(v, 1e3))
    });
    place.write("other.csv", text);
    let done = place.good(&["fit", "other.csv", "--law", "stribeck-exponential"]);
    assert_eq!(done["units"]["reference_velocity"], "m/s");
    for (text, line) in [
        ("slip_velocity,coefficient\n0,01,0,39\n0,02,0,38\n", "line 2"),
        ("slip_velocity;coefficient\n0,01;0,39\n0,02;0,38\n0.2;0.3\n", "line 4"),
        ("slip_velocity;coefficient\n1.234;0,31\n2.345;0,30\n", "line 2"),
    ] {
        place.write("other.csv", text);
        let output = place.quell(&["fit", "other.csv"]);
        let said = String::from_utf8(output.stderr).expect("UTF-8");
        assert_eq!(output.status.code(), Some(2));
        assert!(said.contains("other.csv") && said.contains(line), "{said}");
    }
}

/// Means of records of a drive, whose torque is in per cent of the rated one.
#[test]
fn a_folder_of_records_is_fitted_as_forces_that_a_study_takes() {
    let place = Place::with("fit-folder", &[]);
    fs::create_dir_all(place.folder.join("records")).expect("a folder");
    for (index, speed) in [2.0_f64, 10.0, 20.0, 40.0, 80.0, 160.0].iter().enumerate() {
        let share = 30.0 + 8.0 * (-speed / 15.0).exp() + 0.01 * speed;
        let text = format!(
            "Date:;2026-03-04\r\n;Speed;Torque\r\nms;rpm;%\r\n0;{speed};{}\r\n50;{speed};{}\r\n",
            share + 0.5,
            share - 0.5
        );
        place.write(&format!("records/steady_{index}.csv"), text);
    }
    place.write("records/reversal.csv", ";Speed;Torque\nms;rpm;%\n0;-50;-30\n50;51;30\n");
    let choice = "slip_velocity=rpm,friction_force=%*9.84mNm";
    let command = ["fit", "records", "--law", "coulomb", "--columns", choice];
    let done = place.good(&command);
    assert_eq!((&done["n"], &done["friction_is"]), (&6.into(), &"torque".into()));
    assert_eq!(done["units"]["residual"], "Nm");
    assert_eq!(done["units"]["coefficient"], done["units"]["residual"]);
    let level = done["parameters"]["coefficient"]["value"].as_f64().expect("a number");
    assert!((level / 9.84e-3 - 0.32).abs() < 0.03, "{level}");
    let files = done["files"].as_array().expect("a list");
    assert_eq!(files.iter().filter(|file| file["readings"] == 2).count(), 6);
    assert!(
        files[6]["left_out"].as_str().is_some_and(|why| why.contains("both directions")),
        "{files:?}"
    );
    let said = String::from_utf8(place.quell(&command).stdout).expect("UTF-8");
    for words in [
        "friction torque 0.00",
        "No normal load was measured: friction is a torque in Nm.",
        "friction_force = true",
    ] {
        assert!(said.contains(words), "{said}");
    }
    let friction = done["study"]["friction"].as_str().expect("text");
    let belt = "[belt]\ndamping_ratio = 0.005\nbelt_velocity = 0.1\n";
    place.write("study.toml", format!("{belt}{friction}"));
    place.good(&["check", "study.toml"]);
    let (refused, status) =
        place.json(&["fit", "records", "--columns", "slip_velocity=rpm,friction_force=%"]);
    assert_eq!(status, 2);
    let message = refused["errors"][0]["message"].as_str().expect("text");
    assert!(message.contains("steady_0.csv") || message.contains("reversal.csv"), "{message}");
    assert!(message.contains("is in per cent"), "{message}");
}

#[test]
fn what_a_file_holds_is_said_where_it_cannot_be_fitted() {
    let files = [("record.csv", "t,mu\n0,0.25\n0.5,0.35\n1,0.45\n"), ("book.xlsx", "PK\u{3}\u{4}")];
    let place = Place::with("fit-holds", &files);
    place.write("array.npy", b"\x93NUMPY\x01\x00");
    place.write("old.mat", [&b"MATLAB 5.0 MAT-file"[..], &[b' '; 109]].concat());
    place.write("empty.csv", "");
    for (file, columns, words) in [
        (
            "record.csv",
            "time=t[s],coefficient=mu",
            "a record of friction over time: 3 samples at a mean step of 0.5 s",
        ),
        ("record.csv", "slip_velocity=v", "which has \"t\", \"mu\" with 3 rows"),
        ("book.xlsx", "slip_velocity=v", "this file is an archive"),
        ("array.npy", "slip_velocity=v", "np.savetxt"),
        ("old.mat", "slip_velocity=v", "this MATLAB file has no variables"),
        ("empty.csv", "slip_velocity=v", "a header line of column names"),
    ] {
        let (refused, status) = place.json(&["fit", file, "--columns", columns]);
        assert_eq!(status, 2, "{file}");
        let message = refused["errors"][0]["message"].as_str().expect("text");
        assert!(message.contains(words) && message.contains(file), "{file}: {message}");
    }
}
