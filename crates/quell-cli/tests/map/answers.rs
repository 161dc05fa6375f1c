//! Answers of `quell map`.

use std::fs;

use serde_json::Value as Json;

use crate::place::{Place, SMALL, STUDY, same};

fn same_record(one: &Json, other: &Json) {
    let close = |(one, other): (f64, f64)| (one - other).abs() <= 1e-6 * one.abs() + 1e-14;
    let both = one.as_f64().zip(other.as_f64());
    assert!(both.map_or(one == other, close), "{one} {other}");
}

#[test]
fn a_point_of_a_map_has_the_same_bits_as_a_single_computation() {
    let place = Place::new("alone");
    let quantities = "residual-vibration,amplitude,stick-fraction,mean-friction,dither-power,criterion,\
                      growth,critical-amplitude,verdict";
    let map = place.good(&["map", "small.toml", "--quantity", quantities]);
    let (first, second) = (&map["axes"][0]["values"], &map["axes"][1]["values"]);
    assert_eq!(map["axes"][0]["parameter"], "dither.amplitude");
    assert_eq!(map["shape"], serde_json::json!([3, 4]));
    for (i, amplitude) in first.as_array().expect("values").iter().enumerate() {
        for (j, velocity) in second.as_array().expect("values").iter().enumerate() {
            let set =
                [format!("dither.amplitude={amplitude}"), format!("belt.belt_velocity={velocity}")];
            let alone =
                |verb: &str| place.good(&[verb, "study.toml", "--set", &set[0], "--set", &set[1]]);
            let (steady, averaged) = (alone("response"), alone("stability"));
            // Points side by side share the run without dither, on a grid of samples of its own.
            for name in ["residual_vibration", "amplitude"] {
                same_record(&map[name][i][j], &steady[name]);
            }
            let end = &alone("attractor")["attractor"]["contacts"][0];
            let (contact, dither) = (&steady["contacts"][0], &steady["dithers"][0]);
            for (name, fact) in [
                ("stick_fraction", &end["stick_fraction"]),
                ("mean_friction", &contact["mean_friction"]),
                ("dither_power", &dither["power"]),
                ("criterion", &averaged["criterion"]),
                ("verdict", &averaged["verdict"]),
                ("growth", &averaged["growth_rate"]),
                ("critical_amplitude", &averaged["critical_amplitudes"][0]["amplitude"]),
            ] {
                assert_eq!(&map[name][i][j], fact, "{name} {set:?}");
            }
            // The undithered belt at v₀ = 0.5 settles to sliding: E is reported as unknown.
            let known = map["residual_vibration_status"][i][j] == "known";
            assert_eq!(known, map["residual_vibration"][i][j].is_number());
        }
    }
    assert_eq!(map["residual_vibration_status"][0][3], "undithered_settles");
    assert!(
        map["why"]["residual_vibration"].as_str().is_some_and(|why| why.contains("without dither"))
    );
}

#[test]
fn any_number_of_threads_writes_the_same_bytes() {
    let place = Place::new("threads");
    for threads in ["1", "3"] {
        let save = format!("{threads}.zarr");
        place.good(&[
            "map",
            "small.toml",
            "--quantity",
            "residual-vibration",
            "--threads",
            threads,
            "--save",
            &save,
        ]);
    }
    same(&place.store("1.zarr"), &place.store("3.zarr"));
}

#[test]
fn a_store_describes_itself() {
    let place = Place::new("described");
    let set = "belt.damping_ratio=0.006";
    place.good(&[
        "map",
        "small.toml",
        "--set",
        set,
        "--quantity",
        "residual-vibration,verdict",
        "--save",
        "m.zarr",
    ]);
    let read = |name: &str| -> Json {
        let text = fs::read_to_string(place.folder.join("m.zarr").join(name)).expect("metadata");
        serde_json::from_str(&text).expect("JSON")
    };
    let group = read("zarr.json");
    let attributes = &group["attributes"];
    assert_eq!(attributes["study"], format!("{STUDY}{SMALL}"));
    assert_eq!(attributes["changes"], set);
    assert_eq!(attributes["quell_version"], env!("CARGO_PKG_VERSION"));
    assert!(attributes["references"].as_str().is_some_and(|text| text.contains("Michaux")));
    let arrays = group["consolidated_metadata"]["metadata"].as_object().expect("arrays");
    let expected = [
        "dither_amplitude",
        "belt_velocity",
        "residual_vibration",
        "residual_vibration_status",
        "verdict",
        "verdict_status",
        "settled",
        "settled_status",
    ];
    assert_eq!(arrays.keys().map(String::as_str).collect::<Vec<_>>(), expected);
    for (name, described) in arrays {
        // The consolidated metadata equal those of the array.
        assert_eq!(described, &read(&format!("{name}/zarr.json")));
    }
    let residual_vibration = &arrays["residual_vibration"];
    assert_eq!(
        residual_vibration["dimension_names"],
        serde_json::json!(["dither_amplitude", "belt_velocity"])
    );
    assert_eq!(
        residual_vibration["attributes"]["ancillary_variables"],
        "residual_vibration_status"
    );
    assert_eq!(residual_vibration["attributes"]["units"], "dimensionless");
    assert_eq!(residual_vibration["fill_value"], "NaN");
    let status = &arrays["residual_vibration_status"];
    assert_eq!(status["fill_value"], 255);
    let values = status["attributes"]["flag_values"].as_array().expect("codes");
    let meanings = status["attributes"]["flag_meanings"].as_str().expect("words");
    assert_eq!(values.len(), meanings.split(' ').count());
    assert!(meanings.starts_with("known ") && meanings.ends_with(" missing"));
}

#[test]
fn a_table_has_one_row_per_point() {
    let place = Place::new("table");
    let map = place.good(&[
        "map",
        "small.toml",
        "--quantity",
        "residual-vibration,verdict",
        "--save",
        "m.csv",
    ]);
    assert_eq!(map["saved"][0], "m.csv");
    let text = fs::read_to_string(place.folder.join("m.csv")).expect("a table");
    let rows: Vec<&str> = text.lines().filter(|line| !line.starts_with('#')).collect();
    assert_eq!(
        rows[0],
        "dither_amplitude,belt_velocity,residual_vibration,residual_vibration_status,verdict,verdict_status,settled,settled_status"
    );
    assert_eq!(rows.len(), 13);
    let residual_vibration = &map["residual_vibration"][1][2];
    assert!(rows[7].starts_with(&format!("0.5,0.15,{residual_vibration},known,")), "{}", rows[7]);
    assert!(rows[4].starts_with("0.1,0.5,,undithered_settles,"), "{}", rows[4]);
    assert!(text.contains("# units: dither_amplitude [dimensionless], "));
    assert!(text.contains("# scaling: dither_amplitude [length (force/k)], "));
}

#[test]
fn axes_may_be_in_si() {
    let place = Place::new("si");
    let study = r#"schema = 1
[belt]
mass_kg = 2.5
stiffness_n_per_m = 1.0e6
damping_n_s_per_m = 15.8
normal_force_n = 350.0
belt_velocity_m_per_s = 0.02
[friction]
law = "decreasing"
static_coefficient = 0.4
minimum_coefficient = 0.2857
reference_velocity_m_per_s = 0.03
[dither]
direction = "tangential"
waveform = "triangle"
amplitude_n_rms = 60.0
frequency_hz = 2000.0
[solver]
settle_s = 0.01
record_periods = 4
[[sweep]]
parameter = "dither.frequency_hz"
from = 1000
to = 4000
points = 3
spacing = "log"
[[sweep]]
parameter = "belt.mass_kg"
values = [1, 2.5]
"#;
    place.write("si.toml", study);
    let map = place.good(&["map", "si.toml", "--quantity", "mean-friction,growth"]);
    assert_eq!(map["axes"][0]["unit"], "Hz");
    assert_eq!(map["units"]["mean_friction"], "N");
    for (i, frequency) in [1000.0, 2000.0, 4000.0].into_iter().enumerate() {
        let written = map["axes"][0]["values"][i].as_f64().expect("a frequency");
        assert!((written / frequency - 1.0).abs() < 1e-14);
        for (j, mass) in [1.0, 2.5].into_iter().enumerate() {
            let set = [format!("dither.frequency_hz={written:?}"), format!("belt.mass_kg={mass}")];
            let alone = |verb| place.good(&[verb, "si.toml", "--set", &set[0], "--set", &set[1]]);
            let steady = &alone("response")["contacts"][0]["mean_friction"];
            assert_eq!(&map["mean_friction"][i][j], steady);
            assert_eq!(map["growth"][i][j], alone("stability")["growth_rate"]);
        }
    }
}

#[test]
fn an_invalid_point_does_not_end_the_map() {
    let place = Place::new("invalid");
    // Each axis alone is allowed, but together they pull the contact apart at one corner.
    let text = STUDY
        .replace("\"tangential\"", "\"normal\"")
        .replace("normal_load = 1.0", "normal_load = 0.5");
    place.write(
        "study.toml",
        format!(
            "{text}[[sweep]]\nparameter = \"dither.amplitude\"\nvalues = [0.1, 0.45]\n\
             [[sweep]]\nparameter = \"belt.normal_load\"\nvalues = [0.42, 0.5]\n"
        ),
    );
    let map = place.good(&["map", "study.toml", "--quantity", "verdict,dither-power"]);
    assert_eq!(map["verdict_status"][1][0], "invalid_study");
    assert_eq!(map["verdict"][1][0], "undecided");
    assert_eq!(map["counts"]["dither_power"]["only_normal_dither"], 3);
    assert!(map["verdict"][0][0].is_string() && map["dither_power"][0][0].is_null());
}

#[test]
fn a_map_over_one_axis_is_drawn_and_missing_requirements_are_reported() {
    let place = Place::new("drawn");
    let one: &[&str] =
        &["--set", "sweep[0].parameter=dither.amplitude", "--set", "sweep[0].values=[0, 0.3, 0.6]"];
    let mut arguments =
        vec!["map", "study.toml", "--quantity", "residual-vibration,verdict", "--plot", "m.svg"];
    arguments.extend(one);
    assert_eq!(place.good(&arguments)["plotted"], "m.svg");
    let svg = fs::read_to_string(place.folder.join("m.svg")).expect("a picture");
    assert!(svg.starts_with("<svg"));
}

#[test]
fn invalid_requests_are_rejected_at_once() {
    let place = Place::new("refused");
    let cases: &[(&[&str], &str)] = &[
        (&["map", "study.toml", "--quantity", "residual-vibration"], "[[sweep]]"),
        (&["map", "small.toml"], "--quantity"),
        (&["map", "small.toml", "--quantity", "eficiency"], "--quantity"),
        (&["map", "small.toml", "--quantity", "verdict", "--resume"], "--resume"),
        (
            &["map", "small.toml", "--quantity", "verdict", "--resume", "--save", "m.csv"],
            "--resume",
        ),
        (&["map", "small.toml", "--quantity", "verdict", "--threads", "0"], "--threads"),
        (&["map", "small.toml", "--quantity", "verdict", "--threads", "-1"], "--threads"),
        (&["map", "small.toml", "--quantity", "verdict", "--save", "m.xlsx"], "--save"),
        (&["map", "small.toml", "--quantity", "verdict", "--save", "nowhere/m.zarr"], "--save"),
        (&["map", "small.toml", "--quantity", "verdict", "--save", "study.toml/m.zarr"], "--save"),
        (
            &["map", "small.toml", "--quantity", "verdict", "--set", "belt.damping_ratio=-1"],
            "belt.damping_ratio",
        ),
    ];
    for (arguments, key) in cases {
        let errors = place.refused(arguments);
        assert!(errors.iter().any(|error| error["key"] == *key), "{arguments:?}: {errors:?}");
    }
    let printed = place.printed(&["map", "study.toml", "--quantity", "residual-vibration"]);
    assert!(printed.errors.contains("    parameter = \"dither.amplitude\""), "{}", printed.errors);
}

/// Exact quench amplitudes over two numbers are those that `thresholds` finds for each point, for any amplitude of the study.
#[test]
fn quench_amplitudes_are_those_of_thresholds() {
    let axes = "[[sweep]]\nparameter = \"dither.frequency_ratio\"\nvalues = [5.0, 10.0]\n[[sweep]]\n\
                parameter = \"belt.belt_velocity\"\nvalues = [0.05, 0.17, 0.5]\n";
    let (study, plane) = (STUDY.to_owned(), format!("{STUDY}{axes}"));
    let place =
        Place::with("map/quench", &[("study.toml", study.as_str()), ("plane.toml", &plane)]);
    let quench = ["map", "plane.toml", "--quantity", "quench-amplitude", "--plot", "plane.svg"];
    let map = place.good(&quench);
    for (i, ratio) in [5.0, 10.0].into_iter().enumerate() {
        for (j, velocity) in [0.05, 0.17, 0.5].into_iter().enumerate() {
            if j == 2 {
                assert_eq!(map["quench_amplitude_status"][i][j], "quiet_without_dither");
                assert_eq!(map["quench_last"][i][j], 0.0);
                continue;
            }
            let found = map["quench_amplitude"][i][j].as_f64().expect("an amplitude");
            let set = [
                format!("dither.frequency_ratio={ratio}"),
                format!("belt.belt_velocity={velocity}"),
            ];
            let (from, to) = (format!("{}", 0.7 * found), format!("{}", 1.4 * found));
            let thresholds = place.good(&[
                "thresholds",
                "study.toml",
                "--parameter",
                "dither.amplitude",
                "--from",
                &from,
                "--to",
                &to,
                "--set",
                &set[0],
                "--set",
                &set[1],
            ]);
            let exact = &thresholds["local"][0];
            let value = exact["value"].as_f64().expect("a threshold");
            assert!((found / value - 1.0).abs() < 1e-9, "{set:?} {found} {exact}");
            assert_eq!(exact["kind"], map["quench_kind"][i][j]);
            assert_eq!(map["quench_lost_status"][i][j], "stays_quiet");
            let averaged = map["quench_amplitude_averaged"][i][j].as_f64().expect("averaging");
            assert!((averaged / found - 1.0).abs() < 0.05, "{averaged} {found}");
        }
    }
    let other = ["--set", "dither.amplitude=7", "--set", "dither.phase=1"];
    let again = place.good(&[&quench[..4], &other[..]].concat());
    assert_eq!(again["quench_kind"], map["quench_kind"]);
}
