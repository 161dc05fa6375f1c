//! The studies of systems in `studies/` give the numbers that their comments state, and wrong options are rejected.
//!
//! The numbers were found without Quell: by hand, or by the programs of `reference/`.

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value as Json;

fn quell(arguments: &[&str]) -> Output {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies");
    let quell =
        Command::new(env!("CARGO_BIN_EXE_quell")).args(arguments).current_dir(folder).output();
    quell.expect("quell runs")
}

fn answer(arguments: &[&str]) -> Json {
    let all: Vec<&str> = arguments.iter().copied().chain(["--json"]).collect();
    let output = quell(&all);
    serde_json::from_slice(&output.stdout).unwrap_or_else(|why| {
        panic!("{arguments:?}: {why}\n{}", String::from_utf8_lossy(&output.stderr))
    })
}

fn complaint(arguments: &[&str]) -> String {
    let output = quell(arguments);
    assert!(!output.status.success(), "{arguments:?}");
    String::from_utf8(output.stderr).expect("text")
}

fn close(found: &Json, wanted: f64, tolerance: f64) {
    let found = found.as_f64().expect("a number");
    assert!((found - wanted).abs() <= tolerance * wanted.abs().max(1.0), "{found}, {wanted}");
}

const ALL: &[&str] = &[
    "belt-as-system.toml",
    "disc-as-system.toml",
    "mode-coupling.toml",
    "mode-coupling-dither.toml",
    "damping-paradox.toml",
    "two-blocks.toml",
    "burridge-knopoff.toml",
    "two-mass-drive.toml",
    "pid-drive.toml",
    "two-masses-siconos.toml",
    "two-masses-nlvib.toml",
    "bowed-string.toml",
    "drill-string.toml",
    "pin-on-disc.toml",
    "sprag-slip.toml",
];

#[test]
fn every_study_of_a_system_is_valid_and_has_modes() {
    for study in ALL {
        assert_eq!(answer(&["check", study])["kind"], "system", "{study}");
        let modes = &answer(&["modes", study])["modes"];
        assert!(modes.as_array().is_some_and(|modes| !modes.is_empty()), "{study}");
    }
}

#[test]
fn growth_rates_are_those_of_the_comments() {
    for (arguments, verdict, rate) in [
        (&["belt-as-system.toml", "--set", "dither.amplitude=0"][..], "unstable", 0.3968359375),
        (&["disc-as-system.toml"], "stable", -0.0001754858707100011),
        (&["damping-paradox.toml"], "unstable", 0.0026036446532065037),
        (
            &["damping-paradox.toml", "--set", "parameters.disc_damping=0.5"],
            "unstable",
            0.00402439827435046,
        ),
        // λ² + μ′λ + 1 = 0, μ′ = -5/1.05².
        (&["burridge-knopoff.toml"], "unstable", {
            let slope: f64 = 5.0 / (1.05 * 1.05);
            0.5 * (slope + (slope * slope - 4.0).sqrt())
        }),
        (&["pid-drive.toml"], "stable", -0.5),
        (&["sprag-slip.toml"], "stable", -0.01),
    ] {
        let all: Vec<&str> = ["stability"].iter().chain(arguments).copied().collect();
        let found = answer(&all);
        assert_eq!(found["verdict"], verdict, "{arguments:?}");
        close(&found["growth_rate"], rate, 1e-12);
    }
    for study in ["bowed-string.toml", "drill-string.toml", "pin-on-disc.toml", "two-blocks.toml"] {
        assert_eq!(answer(&["stability", study])["verdict"], "unstable", "{study}");
    }
    for study in ["two-masses-siconos.toml", "two-masses-nlvib.toml"] {
        assert!(complaint(&["stability", study]).contains("does not move"), "{study}");
    }
}

#[test]
fn dither_suppresses_what_the_comments_state() {
    for (study, amplitude, kind) in [
        ("mode-coupling-dither.toml", 20.602022002124983, "root"),
        ("two-mass-drive.toml", 5.378463346883234, "jump"),
    ] {
        let found = answer(&["stability", study]);
        assert_eq!(
            (&found["verdict"], &found["protocol"]),
            (&"unstable".into(), &"averaged".into())
        );
        let critical = &found["critical_amplitudes"][0];
        close(&critical["amplitude"], amplitude, 1e-9);
        assert_eq!((&critical["kind"], &critical["becomes"]), (&kind.into(), &"stable".into()));
    }
}

#[test]
fn thresholds_are_those_of_the_comments() {
    let mu = "contact.pad.friction.coefficient";
    for (study, parameter, from, to, value) in [
        ("mode-coupling.toml", mu, "0.76", "1", None),
        ("mode-coupling.toml", mu, "0.5", "1", Some(0.75375)),
        ("pid-drive.toml", "parameters.ki", "0.5", "6", Some(4.0)),
        (
            "two-mass-drive.toml",
            "contact.guide.belt_velocity",
            "0.05",
            "0.25",
            Some(0.19827790542377544),
        ),
    ] {
        let found = answer(&[
            "stability",
            study,
            "--parameter",
            parameter,
            "--from",
            from,
            "--to",
            to,
            "--set",
            if study.starts_with("two") { "dither.amplitude=0" } else { "title=x" },
        ]);
        let thresholds = found["thresholds"].as_array().expect("a list");
        let hopf: Vec<&Json> = thresholds.iter().filter(|found| found["kind"] == "hopf").collect();
        match (value, hopf.as_slice()) {
            (Some(value), [one]) => close(&one["value"], value, 1e-10),
            (None, []) => {}
            _ => panic!("{study}: {found}"),
        }
    }
    // A pin that digs in, between 0 and arctan μ.
    let found = answer(&[
        "stability",
        "pin-on-disc.toml",
        "--parameter",
        "parameters.angle",
        "--from",
        "-0.2",
        "--to",
        "0.6",
    ]);
    close(&found["thresholds"][0]["value"], 0.0, 3e-4);
    close(&found["thresholds"][1]["value"], 0.4f64.atan(), 3e-4);
}

#[test]
fn frequencies_are_those_of_the_comments() {
    let tau = std::f64::consts::TAU;
    for (study, wanted) in [
        ("two-masses-siconos.toml", &[0.618033988749895, 1.618033988749895][..]),
        ("two-masses-nlvib.toml", &[24.156198, 45.348408]),
        ("mode-coupling.toml", &[1.0, 1.7320508075688772]),
        ("bowed-string.toml", &[65.43011 * tau, 130.97148 * tau, 196.73506 * tau]),
    ] {
        let found = answer(&["modes", study]);
        for (mode, wanted) in found["modes"].as_array().expect("modes").iter().zip(wanted) {
            close(&mode["frequency"], *wanted, 1e-7);
        }
    }
}

#[test]
fn values_of_options_have_the_unit_of_their_path() {
    let study = "bowed-string.toml";
    let found = answer(&[
        "stability",
        study,
        "--parameter",
        "contact.bow.belt_velocity",
        "--from",
        "5cm/s",
        "--to",
        "1.5",
    ]);
    assert_eq!((&found["from"], &found["to"]), (&0.05.into(), &1.5.into()));
    for (path, from, part) in [
        ("contact.bow.belt_velocity", "5N", "m/s"),
        ("contact.bow.belt_velocity", "five", "a finite number in m/s"),
        ("contact.bow.belt_velocty", "0.1", "did you mean contact.belt_velocity"),
    ] {
        let why =
            complaint(&["stability", study, "--parameter", path, "--from", from, "--to", "1"]);
        assert!(why.contains(part), "{path}: {why}");
    }
}

/// A picture that an answer lacks is refused before the table is written.
#[test]
fn outputs_are_tested_before_the_work_begins() {
    let folder = std::env::temp_dir().join(format!("quell-systems-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let [table, picture] = ["modes.csv", "modes.svg"].map(|name| folder.join(name));
    let [save, plot] = [&table, &picture].map(|path| path.to_str().expect("text"));
    let why = complaint(&["modes", "two-blocks.toml", "--save", save, "--plot", plot]);
    assert!(why.contains("--plot: this answer has no picture"), "{why}");
    assert!(!table.exists() && !picture.exists());
    let why = complaint(&["stability", "two-mass-drive.toml", "--exact", "--plot", plot]);
    assert!(why.contains("no picture"), "{why}");
    let help = quell(&["modes", "--help"]);
    assert!(String::from_utf8_lossy(&help.stdout).contains("of a disc or a system"));
    std::fs::remove_dir_all(&folder).expect("removed");
}
