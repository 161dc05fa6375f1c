//! The real binary: periodic responses and thresholds.

use std::path::Path;
use std::process::Command;

use serde_json::Value as Json;

/// Decreasing law, v₀ = 1, ζ = 0.005, sine tangential dither with R = 10, D = 6.
const STUDY: &str = "studies/can-dither-make-it-worse.toml";

fn quell(arguments: &[&str]) -> (Json, i32) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let done = Command::new(env!("CARGO_BIN_EXE_quell"))
        .args(arguments)
        .arg("--json")
        .current_dir(root)
        .output()
        .expect("the binary runs");
    let text = String::from_utf8(done.stdout).expect("text");
    (serde_json::from_str(&text).expect("one object"), done.status.code().expect("a status"))
}

#[test]
fn an_orbit_has_its_names() {
    let (found, status) = quell(&["orbit", STUDY]);
    assert_eq!(status, 0);
    assert_eq!(found["verdict"], "unstable");
    assert_eq!((&found["stick_episodes"], &found["reversals"]), (&0.into(), &0.into()));
    let modulus = |it: &Json| it[0].as_f64().expect("re").hypot(it[1].as_f64().expect("im"));
    assert!(modulus(&found["multipliers"][0]) > 1.0);
    for name in ["displacement", "velocity", "residual", "period", "sentence"] {
        assert!(!found[name].is_null(), "{name}");
    }
    // Beyond the upper threshold the mass reverses twice a period, and the response is stable.
    let (found, _) = quell(&["orbit", STUDY, "--set", "dither.amplitude=12"]);
    assert_eq!((found["verdict"].as_str(), &found["reversals"]), (Some("stable"), &2.into()));
}

#[test]
fn without_dither_there_is_no_orbit() {
    let (told, status) = quell(&["orbit", "studies/does-it-squeal.toml"]);
    assert_eq!(status, 2);
    assert_eq!(told["errors"][0]["key"], "dither");
}

#[test]
fn thresholds_tell_each_protocol_apart() {
    let (found, status) = quell(&[
        "thresholds",
        STUDY,
        "--parameter",
        "dither.amplitude",
        "--from",
        "2",
        "--to",
        "10.5",
        "--from-rest",
        "--from-squeal",
        "--start",
        "0,0",
    ]);
    assert_eq!(status, 0, "{found}");
    let value = |it: &Json| it["value"].as_f64().expect("a value");
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
    // What squeals stays so up to the upper local threshold.
    let squeal = found["from_squeal"].as_array().expect("from squeal");
    assert_eq!((squeal.len(), &squeal[0]["becomes"]), (1, &"quenched".into()));
    assert!((value(&squeal[0]) - 9.9).abs() < 2e-3, "{squeal:?}");
}

#[test]
fn wrong_questions_are_told() {
    for (arguments, key) in [
        (&["--parameter", "belt.colour", "--from", "1", "--to", "2"][..], "--parameter"),
        (&["--parameter", "dither.amplitude", "--from", "2", "--to", "1"], "--to"),
        (&["--parameter", "dither.amplitude", "--from", "nan", "--to", "1"], "--from"),
        (&["--parameter", "dither.amplitude", "--from", "-2", "--to", "1"], "--from"),
        (
            &["--parameter", "dither.amplitude", "--from", "1", "--to", "2", "--start", "1"],
            "--start",
        ),
    ] {
        let (told, status) = quell(&[&["thresholds", STUDY], arguments].concat());
        assert_eq!((status, told["errors"][0]["key"].as_str()), (2, Some(key)), "{told}");
    }
}
