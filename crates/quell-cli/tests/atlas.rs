//! `quell atlas`: studies in both systems of units, the exact computation next to the tables, refusals, and the table of round numbers.

use std::io::Read as _;

use flate2::read::GzDecoder;
use serde_json::Value as Json;

use crate::place::Place;

/// A belt that a Neimark–Sacker bifurcation quenches.
const BELT: &str = r#"
[belt]
damping_ratio = 0.05
normal_load = 1.0
belt_velocity = 0.17
[friction]
law = "stribeck"
static_coefficient = 0.4
minimum_coefficient = 0.2857
reference_velocity = 0.2
[dither]
direction = "tangential"
waveform = "sine"
amplitude = 0.4
frequency_ratio = 20.0
"#;

/// The same belt with m = 2 kg and ω₀ = 50 rad/s: a length 1 is a metre, a velocity 50 m/s, a force 5000 N.
const BELT_IN_SI: &str = r#"
[belt]
mass_kg = 2.0
stiffness_n_per_m = 5000.0
damping_ratio = 0.05
normal_force_n = 5000.0
belt_velocity_m_per_s = 8.5
[friction]
law = "stribeck"
static_coefficient = 0.4
minimum_coefficient = 0.2857
reference_velocity_m_per_s = 10.0
[dither]
direction = "tangential"
waveform = "sine"
amplitude_n = 2000.0
frequency_hz = 159.15494309189535
"#;

fn place(name: &str) -> Place {
    Place::with(name, &[("belt.toml", BELT), ("si.toml", BELT_IN_SI)])
}

fn number(object: &Json, key: &str) -> f64 {
    object[key].as_f64().unwrap_or_else(|| panic!("{key}: {object}"))
}

/// The groups and the dimensionless amplitudes are those of the twin without units; amplitudes in newtons are scaled.
#[test]
fn a_study_in_si() {
    let place = place("atlas-si");
    let [one, other] = ["belt.toml", "si.toml"].map(|file| place.good(&["atlas", file]));
    for key in ["relative_damping", "relative_velocity", "frequency_ratio", "friction_damping"] {
        let ratio = number(&one, key) / number(&other, key);
        assert!((ratio - 1.0).abs() < 1e-12, "{key} {ratio}");
    }
    let (one, other) = (&one["changes"][0], &other["changes"][0]);
    // The amplitude depends on κ, which rounds differently, by a factor of some tens.
    let same = |key: &str| (number(one, key) / number(other, key) - 1.0).abs() < 1e-10;
    assert!(same("relative_amplitude") && same("relative_amplitude_ratio"));
    let newtons = number(other, "amplitude") / number(one, "amplitude");
    assert!((newtons / 5000.0 - 1.0).abs() < 1e-10, "{newtons}");
    assert_eq!(one["kind"], "neimark-sacker");
    let saved = place.good(&["atlas", "si.toml", "--save", "curves.csv", "--plot", "plane.svg"]);
    assert_eq!(saved["saved"][0], "curves.csv");
    let text = std::fs::read_to_string(place.folder.join("curves.csv")).expect("a table");
    let rows: Vec<&str> = text.lines().filter(|line| !line.starts_with('#')).collect();
    assert!(rows[0].starts_with("belt_velocity,"), "{}", rows[0]);
    // From 2 % of v_m to v_m, in metres per second.
    assert!(rows[1].starts_with("0.2,") && rows[rows.len() - 1].starts_with("10.0,"), "{rows:?}");
}

/// `--exact` finds the same changes, within the error that the tables state.
#[test]
fn a_study_agrees_with_its_own_exact_thresholds() {
    let place = place("atlas-exact");
    for (file, changes) in [
        (&["belt.toml"][..], &[true][..]),
        (&["si.toml"], &[true]),
        // Sliding is stable without dither; a weak dither destabilises it, a strong one quenches again.
        (
            &[
                "belt.toml",
                "--set",
                "friction.law=decreasing",
                "--set",
                "belt.belt_velocity=0.7",
                "--set",
                "belt.damping_ratio=0.014",
            ],
            &[false, true],
        ),
        // Nothing to quench.
        (&["belt.toml", "--set", "belt.belt_velocity=0.2"], &[]),
    ] {
        let arguments = [&["atlas"], file, &["--exact"]].concat();
        let found = place.good(&arguments);
        assert_eq!(found["exact_agrees"], true, "{found}");
        let list = found["changes"].as_array().expect("changes");
        let directions: Vec<bool> =
            list.iter().map(|change| change["becomes_quiet"] == true).collect();
        assert_eq!(directions, changes, "{found}");
        for change in list {
            let (difference, error) =
                (number(change, "relative_difference"), number(change, "relative_error"));
            assert!(difference.abs() < error, "{change}");
        }
        assert_eq!(found["quiet_without"], changes.first() != Some(&true));
        assert_eq!(found["quench_amplitude"].is_null(), changes.is_empty());
    }
    let plain = place.good(&["atlas", "belt.toml"]);
    assert!(plain["exact_agrees"].is_null() && plain["why"]["exact_agrees"].is_string());
}

/// What is outside is refused by its key, with what is allowed in the units of the study.
#[test]
fn what_is_outside_is_refused() {
    let place = place("atlas-outside");
    let refused = |file: &str, change: &str| {
        let errors = place.refused(&["atlas", file, "--set", change]);
        assert_eq!(errors.len(), 1, "{errors:?}");
        let word = |key: &str| errors[0][key].as_str().expect("a text").to_owned();
        (word("key"), word("allowed"), errors[0]["value"].clone())
    };
    for (change, key, part) in [
        ("belt.damping_ratio=0.5", "belt.damping_ratio", "at most 0.428625"),
        ("belt.belt_velocity=0.001", "belt.belt_velocity", "from 0.004 to 0.2"),
        ("belt.belt_velocity=0.21", "belt.belt_velocity", "from 0.004 to 0.2"),
        ("dither.frequency_ratio=2", "dither.frequency_ratio", "from 5 to 200"),
        ("dither.frequency_ratio=201", "dither.frequency_ratio", "from 5 to 200"),
        ("belt.normal_load=20", "dither.frequency_ratio", "from 42.8625 to 200"),
        ("dither.direction=normal", "dither.direction", "tangential"),
        ("friction.minimum_coefficient=0.4", "friction.static_coefficient", "above"),
    ] {
        let (at, allowed, value) = refused("belt.toml", change);
        assert_eq!(at, key, "{change}: {allowed}");
        assert!(allowed.contains(part), "{change}: {allowed}");
        let word = change.split_once('=').expect("a change").1;
        if at == change.split_once('=').expect("a change").0 {
            let same = value.as_f64().map(|value| value == word.parse::<f64>().expect("a number"));
            assert!(same.unwrap_or_else(|| value == word), "{change}: {value}");
        }
    }
    let (key, allowed, value) = refused("si.toml", "dither.frequency_hz=20");
    assert_eq!(key, "dither.frequency_hz");
    assert!(allowed.starts_with("from 39.7887 Hz to 1591.55 Hz"), "{allowed}");
    assert!((value.as_f64().expect("a number") - 20.0).abs() < 1e-12);
    let (key, allowed, _) = refused("si.toml", "belt.belt_velocity_m_per_s=20");
    assert_eq!(key, "belt.belt_velocity");
    assert!(allowed.starts_with("from 0.2 m/s to 10 m/s"), "{allowed}");

    // Other laws, other waveforms, no dither; several at once.
    let law = BELT.split("[friction]").next().expect("a belt").to_owned();
    let coulomb = format!("{law}[friction]\nlaw = \"coulomb\"\ncoefficient = 0.3\n");
    let burst = BELT.replace(
        "waveform = \"sine\"",
        "waveform = \"burst\"\ncarrier = \"sine\"\non = 2\noff = 1",
    );
    place.write("coulomb.toml", &coulomb);
    place.write("burst.toml", burst);
    let keys = |file: &str| -> Vec<String> {
        let errors = place.refused(&["atlas", file]);
        errors.iter().map(|error| error["key"].as_str().expect("a key").to_owned()).collect()
    };
    assert_eq!(keys("coulomb.toml"), ["friction.law", "dither"]);
    assert_eq!(keys("burst.toml"), ["dither.waveform"]);
    // Options that need a study, and those that exclude one.
    assert_eq!(place.refused(&["atlas", "--exact"]).len(), 1);
    assert_eq!(place.refused(&["atlas", "belt.toml", "--compute"]).len(), 1);
    assert_eq!(place.refused(&["atlas", "--compute", "--threads", "0"])[0]["key"], "--threads");
    assert_eq!(place.refused(&["atlas", "belt.toml", "--save", "table.txt"])[0]["key"], "--save");
}

/// The tables without a study: every number of the table of round numbers is there, and the file of the tables is that of the program.
#[test]
fn the_table_of_round_numbers_is_whole() {
    let place = place("atlas-round");
    let found = place.good(&["atlas", "--save", "round.csv"]);
    assert_eq!(found["errors"].as_array().expect("errors").len(), 72);
    assert!(found["largest_difference"].is_null());
    let text = std::fs::read_to_string(place.folder.join("round.csv")).expect("a table");
    let mut rows = text.lines().filter(|line| !line.starts_with('#'));
    let names: Vec<&str> = rows.next().expect("a heading").split(',').collect();
    let column = |name: &str| names.iter().position(|known| *known == name).expect(name);
    let [speed, grazing, quench, lost, kappa] = [
        "relative_velocity",
        "grazing_amplitude",
        "quench_amplitude",
        "lost_amplitude",
        "relative_damping",
    ]
    .map(column);
    let (mut count, mut with_lost) = (0, 0);
    for row in rows {
        let cells: Vec<&str> = row.split(',').collect();
        let value = |at: usize| cells[at].parse::<f64>().unwrap_or_else(|_| panic!("{row}"));
        assert!(value(speed) > 0.0 && value(grazing) > 0.0, "{row}");
        // Without damping the base response is unstable or neutral up to the grazing, or sliding is stable.
        assert!((0.0..=value(grazing)).contains(&value(quench)), "{row}");
        if !cells[lost].is_empty() {
            assert!(value(lost) < value(quench) && value(kappa) > 0.0, "{row}");
            with_lost += 1;
        }
        count += 1;
    }
    assert_eq!(count, 9 * 5 * 5 * 7 * 11);
    assert!(with_lost > 100, "{with_lost}");
    place.good(&["atlas", "--save", "atlas.txt"]);
    let text = std::fs::read_to_string(place.folder.join("atlas.txt")).expect("the tables");
    let mut shipped = String::new();
    let file = include_bytes!("../../quell-design/data/atlas-1.txt.gz");
    GzDecoder::new(&file[..]).read_to_string(&mut shipped).expect("the shipped tables");
    assert_eq!(text, shipped);
}
