//! A study in SI: options without units are in SI, units are accepted for every number with a dimension, tables are in SI.

use std::f64::consts::TAU;
use std::fs;

use serde_json::Value as Json;

use crate::place::Place;

const PAD: &str = r#"schema = 1
title = "A pad in SI"
[belt]
mass_kg = 0.5
natural_frequency_hz = 5600
damping_ratio = 0.005
normal_force_n = 4000.0
belt_velocity_m_per_s = 0.1
[friction]
law = "decreasing"
static_coefficient = 0.4
minimum_coefficient = 0.2857
reference_velocity_m_per_s = 0.5
[dither]
direction = "tangential"
waveform = "sine"
amplitude_n = 4000.0
frequency_hz = 20000.0
[solver]
settle_s = "20 ms"
record_periods = 20
"#;

fn place(name: &str) -> Place {
    let scaled = "schema = 1\n[belt]\ndamping_ratio = 0.005\nnormal_load = 1\nbelt_velocity = 0.05\n[friction]\n\
        law = \"stribeck\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n\
        [dither]\ndirection = \"tangential\"\nwaveform = \"sine\"\namplitude = 0.4\nfrequency_ratio = 10\n";
    Place::with(name, &[("pad.toml", PAD), ("scaled.toml", scaled)])
}

/// The parts of answers that must be equal for two equivalent commands.
fn same(place: &Place, verb: &[&str], one: &[&str], other: &[&str]) -> Json {
    let ask = |more: &[&str]| place.good(&[verb, more].concat());
    let found = ask(one);
    assert_eq!(found, ask(other), "{verb:?} {one:?} {other:?}");
    found
}

#[test]
fn options_without_units_are_in_si() {
    let place = place("si_options");
    let at = same(
        &place,
        &["friction", "pad.toml"],
        &["--at", "0.1,-0.02"],
        &["--at", "0.36km/h,-20 mm/s"],
    );
    let first = at["contacts"][0]["slip_velocity"][0].as_f64();
    assert_eq!(first.map(|v| (v - 0.1).abs() < 1e-16), Some(true));
    let run = same(&place, &["simulate", "pad.toml"], &["--until", "0.002"], &["--until", "2ms"]);
    let end = run["final"]["time"].as_f64().expect("a time");
    assert!((end - 0.002).abs() < 1e-17, "{end}");
    let run = ["simulate", "pad.toml", "--until", "2ms"];
    let begun = same(&place, &run, &["--start", "1e-6,0.05"], &["--start", "0.001 mm, 5cm/s"]);
    let begin = begun["start"]["velocity"].as_f64().expect("a velocity");
    assert!((begin - 0.05).abs() < 1e-17, "{begin}");
    let start = ["orbit", "pad.toml", "--set", "dither.amplitude_n=6.5kN"];
    same(&place, &start, &["--near", "1e-6,0.05"], &["--near", "1um,50mm/s"]);
    same(&place, &start, &["--start", "1e-6,0.05"], &["--start", "0.001 mm, 5cm/s"]);
    let thresholds = ["thresholds", "pad.toml", "--parameter", "dither.amplitude_n"];
    let found = same(
        &place,
        &thresholds,
        &["--from", "5000", "--to", "6500"],
        &["--from", "5kN", "--to", "0.0065MN"],
    );
    assert_eq!(found["from"].as_f64().map(|n| (n - 5000.0).abs() < 1e-9), Some(true), "{found}");
    let basins = ["basins", "pad.toml", "--set", "dither.amplitude_n=6.5kN", "--grid", "2x2"];
    let window = ["--displacement", "-1e-6:5e-6", "--velocity", "0:0.1"];
    let units = ["--displacement=-1um:5um", "--velocity", "0:10cm/s"];
    same(&place, &basins, &window, &units);
    let set = ["check", "pad.toml"];
    same(
        &place,
        &set,
        &["--set", "dither.amplitude_n=5700"],
        &["--set", "dither.amplitude_n=5.7kN"],
    );
}

const DRIVE: &str = r#"title = "A drive in newtons"
[belt]
mass_kg = 20
natural_frequency_hz = 30
damping_ratio = 0.005
normal_force_n = 200
belt_velocity_m_per_s = 0.001
[friction]
law = "coulomb"
friction_force_n = "60N"
static_friction_force_n = 80
[dither]
direction = "tangential"
waveform = "sine"
frequency_hz = 300
amplitude_n = 45
[response]
band_hz = [10, "50Hz"]
"#;

/// The base response of this drive ends at 37.3 N; from 39.7 N on runs end on another response of the dither's period, without any
/// slow vibration. Every verb says so.
#[test]
fn quenched_means_the_same_in_every_verb() {
    let place = place("si_drive");
    place.write("drive.toml", DRIVE);
    let response = place.good(&["response", "drive.toml"]);
    assert_eq!(response["effect"], "quenches");
    assert_eq!(response["ends_on"], "period-1");
    assert_eq!((&response["base_response"], &response["quiet"]), (&false.into(), &true.into()));
    let range = ["--parameter", "dither.amplitude_n", "--from", "35", "--to", "50"];
    let found = place.good(&[&["thresholds", "drive.toml", "--from-rest"][..], &range].concat());
    let changes = found["from_rest"].as_array().expect("changes");
    assert_eq!((changes.len(), &changes[0]["becomes"]), (1, &"quenched".into()), "{found}");
    let value = changes[0]["value"].as_f64().expect("newtons");
    assert!((value - 39.673).abs() < 0.01, "{value}");
    let swept = ["bifurcation", "drive.toml", "--points", "4", "--up"];
    let swept = place.good(&[&swept[..], &range].concat());
    let quiet: Vec<_> =
        swept["up"].as_array().expect("points").iter().map(|item| item["quiet"].clone()).collect();
    assert_eq!(quiet, [false, true, true, true]);
    let basins = place.good(&["basins", "drive.toml", "--sample", "20"]);
    assert_eq!(
        (&basins["quiet_fraction"], &basins["attractors"][0]["base_response"]),
        (&1.0.into(), &false.into())
    );
    let printed = basins["sentence"].as_str().expect("words");
    assert!(
        printed.starts_with("All 20 starts fall quiet. The base response ends at 82.9"),
        "{printed}"
    );
}

/// If mass or stiffness are swept, frequencies and velocities are those of each value, as with `--set`.
#[test]
fn swept_scales_are_those_of_each_value() {
    let place = place("si_scales");
    let range = ["--parameter", "belt.natural_frequency_hz", "--from", "4kHz", "--to", "6kHz"];
    let swept = ["bifurcation", "pad.toml", "--up", "--points", "2", "--save", "up.csv"];
    let found = place.good(&[&swept[..], &range].concat());
    let amplitude = ["--parameter", "dither.amplitude_n", "--from", "4kN", "--to", "4.1kN"];
    for (point, hertz) in found["up"].as_array().expect("points").iter().zip(["4kHz", "6kHz"]) {
        let set = format!("belt.natural_frequency_hz={hertz}");
        let alone = ["bifurcation", "pad.toml", "--up", "--points", "2", "--set", &set];
        let alone = place.good(&[&alone[..], &amplitude].concat());
        let number = |point: &Json, name: &str| point[name].as_f64().expect(name);
        let (one, other) = (number(point, "frequency"), number(&alone["up"][0], "frequency"));
        assert!((one / other - 1.0).abs() < 1e-2, "{hertz}: {one} {other}");
    }
    place.write(
        "sweep.toml",
        format!("{PAD}[[sweep]]\nparameter = \"belt.natural_frequency_hz\"\nvalues = [4000, 5000, 6000]\n"),
    );
    let output =
        place.quell(&["map", "sweep.toml", "--quantity", "mean-friction", "--save", "map.csv"]);
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    let number = |word: &str| -> f64 {
        let line = text.lines().find(|line| line.trim_start().starts_with(word)).expect("a line");
        line.split_whitespace().nth(1).and_then(|item| item.parse().ok()).expect("a number")
    };
    let csv = fs::read_to_string(place.folder.join("map.csv")).expect("saved");
    let mut rows = csv.lines().filter(|line| !line.starts_with('#')).map(|row| row.split(','));
    let at = rows.next().expect("names").position(|name| name == "mean_friction").expect("N");
    let all: Vec<f64> = rows.map(|mut row| row.nth(at).expect("N").parse().expect("N")).collect();
    let (least, most) = all.iter().fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(*x), b.max(*x)));
    assert!((number("min") / least - 1.0).abs() < 1e-6, "{text}{all:?}");
    assert!((number("max") / most - 1.0).abs() < 1e-6, "{text}{all:?}");
}

/// Just above the band, the window spreads the line of the dither into it; that does not count as vibration.
#[test]
fn a_dither_just_above_the_band_does_not_leak_into_it() {
    let place = place("si_leak");
    for ratio in ["1.905", "1.95", "2.05"] {
        let set = format!("dither.frequency_ratio={ratio}");
        let found = place.good(&["response", "scaled.toml", "--set", &set]);
        assert_eq!((&found["effect"], &found["settled"]), (&"quenches".into(), &true.into()));
        assert!(found["residual_vibration"].as_f64().is_some_and(|ratio| ratio < 0.01), "{found}");
    }
    // For any length of the record, the band contains the vibration: this dither does not change it.
    for periods in ["2", "4", "8", "60"] {
        let periods = format!("solver.record_periods={periods}");
        let set = ["--set", "dither.frequency_ratio=2", "--set", "dither.amplitude=0.001"];
        let found =
            place.good(&[&["response", "scaled.toml", "--set", &periods][..], &set].concat());
        assert_ne!(found["effect"], "quenches");
        assert!(found["residual_vibration"].as_f64().is_some_and(|ratio| ratio > 0.9), "{found}");
    }
}

/// Outcomes of runs are reported if no base response exists at the beginning of the range.
#[test]
fn runs_are_classified_without_a_base_response() {
    let place = place("si_no_base");
    place.write("drive.toml", DRIVE);
    let ask = |from: &'static str, more: &[&'static str]| {
        let range = ["--parameter", "dither.amplitude_n", "--from", from, "--to", "45"];
        [&["thresholds", "drive.toml"][..], &range, more].concat()
    };
    let value = |found: &Json| found["from_rest"][0]["value"].as_f64().expect("a threshold");
    let without = place.good(&ask("38", &["--from-rest"]));
    let with = place.good(&ask("35", &["--from-rest"]));
    assert!((value(&without) / value(&with) - 1.0).abs() < 1e-4);
    let printed = without["sentence"].as_str().expect("words");
    assert!(printed.starts_with("At the dither amplitude 38 N the base response was not found: the base response ends at 98"), "{printed}");
    let (found, status) = place.json(&ask("38", &[]));
    assert_eq!((status, &found["errors"][0]["key"]), (1, &"thresholds".into()));
    assert!(found.to_string().contains("--from-rest"), "{found}");
}

/// Without damping and with a law of zero slope no vibration grows: no belt velocity is unstable.
#[test]
fn neutral_friction_is_not_unstable() {
    let place = place("si_neutral");
    let neutral = "[belt]\ndamping_ratio = 0\nnormal_load = 1\nbelt_velocity = 2\n[friction]\nlaw = \"coulomb\"\n\
        coefficient = 0.3\n[dither]\ndirection = \"tangential\"\nwaveform = \"sine\"\namplitude = 1.5\nfrequency_ratio = 10\n";
    place.write("neutral.toml", neutral);
    let found = place.good(&["stability", "neutral.toml"]);
    assert_eq!(found["limit"]["verdict"].as_str().or(found["verdict"].as_str()), Some("undecided"));
    let text =
        String::from_utf8(place.quell(&["stability", "neutral.toml"]).stdout).expect("UTF-8");
    assert!(text.contains("unstable surface velocities: none"), "{text}");
    assert!(text.contains("stable at every surface velocity: none: without damping"), "{text}");
}

/// A dither inside the band of slow vibration does not quench a response that follows it.
#[test]
fn a_slow_dither_does_not_end_the_vibration() {
    let place = place("si_slow");
    let slow = ["--set", "dither.frequency_ratio=0.9", "--set", "dither.amplitude=0.6"];
    let response = place.good(&[&["response", "scaled.toml"][..], &slow].concat());
    assert_eq!(response["effect"], "increases");
    let range =
        ["--parameter", "dither.amplitude", "--from", "0.01", "--to", "0.04", "--from-rest"];
    let found = place.good(&[&["thresholds", "scaled.toml"][..], &slow, &range].concat());
    let printed = found["sentence"].as_str().expect("words");
    assert!(
        !printed.contains("quench") && printed.contains("into step with the dither"),
        "{printed}"
    );
    assert!(
        found["warnings"].to_string().contains("`response` gives the remaining amplitude"),
        "{found}"
    );
}

/// The level in a band is that of the lines between its ends; it is given with its root mean squares, in hertz too.
#[test]
fn the_level_of_a_band_is_reported() {
    let place = place("si_band");
    place.write("drive.toml", DRIVE);
    let reduced = ["response", "drive.toml", "--set", "dither.amplitude_n=20"];
    let found = place.good(&reduced);
    let number = |name: &str| found[format!("band_{name}")].as_f64().expect(name);
    let ends = [("from", 10.0), ("to", 50.0)];
    assert!(ends.iter().all(|(end, hertz)| (number(end) / TAU - hertz).abs() < 1e-12));
    let level = 20.0 * (number("displacement_rms") / number("undithered_displacement_rms")).log10();
    assert!((number("displacement_level_db") - level).abs() < 1e-12);
    assert!(
        found["notes"][0]
            .as_str()
            .expect("words")
            .contains("From 10 Hz to 50 Hz the displacement level")
    );
    let in_ratios = place.good(
        &[&reduced[..], &["--set", "response.band=[62.83185307179586, 314.1592653589793]"]]
            .concat(),
    );
    assert!(
        (in_ratios["band_displacement_level_db"].as_f64().expect("a level") - level).abs() < 1e-9
    );
    let narrow = place.good(&[&reduced[..], &["--set", "response.band_hz=[20, 20.5]"]].concat());
    assert!(narrow["why"].to_string().contains("narrower than"), "{}", narrow["why"]);
    let beyond = place.good(&[&reduced[..], &["--set", "response.band_hz=[10, 1e6]"]].concat());
    assert!(beyond["band_displacement_level_db"].is_null());
    assert!(beyond["why"].to_string().contains("no frequencies above"), "{}", beyond["why"]);
    for (set, key) in [
        ("response.band_hz=[50, 10]", "response.band_hz"),
        ("response.band_hz=[10]", "response.band_hz"),
        ("response.band_hz=10", "response.band_hz"),
        ("response.band_hz=[-1, 10]", "response.band_hz[0]"),
        ("response.bend_hz=[1, 10]", "response.bend_hz"),
    ] {
        let errors = place.refused(&["check", "drive.toml", "--set", set]);
        assert_eq!(errors[0]["key"], key, "{set}: {errors:?}");
    }
    let errors = place.refused(&["check", "scaled.toml", "--set", "response.band_hz=[1, 10]"]);
    assert_eq!(errors[0]["suggestion"], "response.band", "{errors:?}");
}

#[test]
fn wrong_units_are_rejected_with_the_expected_ones() {
    let place = place("si_wrong");
    let range = |from: &'static str| {
        [
            "thresholds",
            "pad.toml",
            "--parameter",
            "dither.amplitude_n",
            "--to",
            "6kN",
            "--from",
            from,
        ]
    };
    let cases: &[(&[&str], &str, &str)] = &[
        (&["friction", "pad.toml", "--at", "0.1N"], "--at", "in m/s"),
        (&["simulate", "pad.toml", "--until", "0.1m"], "--until", "in s"),
        (&["simulate", "pad.toml", "--until", "1ms", "--start", "1um,50mm"], "--start", "in m/s"),
        (&["orbit", "pad.toml", "--near", "1um,50mm"], "--near", "in m/s"),
        (&["check", "pad.toml", "--set", "belt.mass_kg=5N"], "belt.mass_kg", "in kg"),
        (&range("5m"), "--from", "in N"),
        (&range("5 furlong"), "--from", "furlong is not a unit"),
        (
            &["friction", "scaled.toml", "--at", "20mm/s"],
            "--at",
            "units require a study with units",
        ),
        (
            &["orbit", "scaled.toml", "--near", "1um,0"],
            "--near",
            "units require a study with units",
        ),
        (
            &[
                "thresholds",
                "scaled.toml",
                "--parameter",
                "dither.amplitude",
                "--from",
                "5kN",
                "--to",
                "6",
            ],
            "--from",
            "units require a study with units",
        ),
        (
            &["check", "scaled.toml", "--set", "dither.amplitude=5kN"],
            "dither.amplitude",
            "units require belt.mass and belt.stiffness",
        ),
    ];
    for (arguments, key, printed) in cases {
        let errors = place.refused(arguments);
        let found = errors.iter().find(|error| error["key"] == *key);
        let allowed = found.and_then(|error| error["allowed"].as_str()).unwrap_or_default();
        assert!(allowed.contains(printed), "{arguments:?}: {errors:?}");
    }
}

/// Ranges reject the same values as `--set`: a unit in a study without units, a value out of bounds.
#[test]
fn ranges_reject_the_same_values_as_changes() {
    let place = place("si_ranges");
    for (study, path, from, to, hint) in [
        ("pad.toml", "dither.amplitud", "1", "2", Some("dither.amplitude")),
        ("scaled.toml", "dither.amplitude_n_rms", "1", "2", Some("dither.amplitude")),
        ("scaled.toml", "dither.amplitude_n", "1", "2", Some("dither.amplitude")),
        ("pad.toml", "dither.amplitude_n", "-1", "2", None),
        ("pad.toml", "dither.frequency_hz", "1", "1e12", None),
    ] {
        let set = format!("{path}={}", if hint.is_some() { from } else { from.min(to) });
        if hint.is_some() {
            place.refused(&["check", study, "--set", &set]);
        }
        for verb in ["thresholds", "bifurcation"] {
            let errors =
                place.refused(&[verb, study, "--parameter", path, "--from", from, "--to", to]);
            if let Some(hint) = hint.filter(|_| verb == "thresholds") {
                assert_eq!(errors[0]["suggestion"], hint, "{verb} {path}: {errors:?}");
            }
            let text = Json::from(errors.clone()).to_string();
            assert!(!text.contains("such as dither.amplitude_n or"), "{text}");
        }
    }
    // A root mean square is varied as such.
    let threshold = |path: &'static str, from: &'static str, to: &'static str| {
        let range = ["--parameter", path, "--from", from, "--to", to];
        let found = place.good(&[&["thresholds", "pad.toml"][..], &range].concat());
        found["local"][0]["value"].as_f64().expect("a threshold")
    };
    let peak = threshold("dither.amplitude_n", "5000", "6500");
    let rms = threshold("dither.amplitude_n_rms", "3500", "4500");
    assert!((rms * 2f64.sqrt() / peak - 1.0).abs() < 1e-9, "{rms} {peak}");
}

#[test]
fn tables_are_in_si_with_machine_readable_units() {
    let place = place("si_tables");
    let read = |name: &str| fs::read_to_string(place.folder.join(name)).expect("saved");
    let column = |text: &str, name: &str| -> Vec<String> {
        let mut rows = text.lines().filter(|line| !line.starts_with('#'));
        let names: Vec<&str> = rows.next().expect("names").split(',').collect();
        let at = names
            .iter()
            .position(|item| *item == name)
            .unwrap_or_else(|| panic!("{name}: {names:?}"));
        rows.map(|row| row.split(',').nth(at).expect("a cell").to_owned()).collect()
    };
    let number = |cell: &String| cell.parse::<f64>().expect("a number");
    let run =
        place.good(&["simulate", "pad.toml", "--until", "2ms", "--events", "--save", "run.csv"]);
    assert_eq!(run["saved"], serde_json::json!(["run.csv", "run_events.csv"]));
    let (run_csv, events) = (read("run.csv"), read("run_events.csv"));
    assert!(run_csv.contains("# units: time [s], displacement [m]"), "{}", &run_csv[..400]);
    let last = number(column(&run_csv, "time").last().expect("rows"));
    assert!((last - 0.002).abs() < 1e-17, "{last}");
    // Events: time, kind, sign and state, one row each, as in JSON.
    let listed = run["events"].as_array().expect("events");
    assert!(!listed.is_empty());
    let times = column(&events, "time");
    assert_eq!(times.len(), listed.len());
    for (k, event) in listed.iter().enumerate() {
        assert_eq!(event["time"].as_f64(), Some(number(&times[k])));
        assert_eq!(event["kind"], column(&events, "kind")[k].as_str());
        assert_eq!(event["slip_sign"].as_f64(), Some(number(&column(&events, "slip_sign")[k])));
        assert_eq!(
            event["displacement"].as_f64(),
            Some(number(&column(&events, "displacement")[k]))
        );
        assert!((number(&column(&events, "velocity")[k]) - 0.1).abs() < 1e-16);
    }
    for (verb, file) in [
        (&["friction", "pad.toml", "--at", "0.1"][..], "f.csv"),
        (&["response", "pad.toml"], "r.csv"),
        (&["orbit", "pad.toml", "--set", "dither.amplitude_n=6.5kN"], "o.csv"),
        (&["basins", "pad.toml", "--set", "dither.amplitude_n=6.5kN", "--grid", "2x2"], "b.csv"),
        (
            &[
                "bifurcation",
                "pad.toml",
                "--parameter",
                "dither.amplitude_n",
                "--from",
                "6kN",
                "--to",
                "6.5kN",
                "--points",
                "2",
                "--up",
            ],
            "v.csv",
        ),
    ] {
        place.good(&[verb, &["--save", file]].concat());
        let text = read(file);
        let header: Vec<&str> = text.lines().take_while(|line| *line != "# study:").collect();
        let units = header.iter().find(|line| line.starts_with("# units:")).expect("units");
        assert!(
            !units.contains("length") && !units.contains('ω') && !units.contains('('),
            "{units}"
        );
    }
    let velocity = number(&column(&read("f.csv"), "slip_velocity")[0]);
    assert!((velocity - 0.1).abs() < 1e-16);
}

#[test]
fn an_orbit_has_extremes_and_a_table() {
    let place = place("si_orbit");
    let orbit = ["orbit", "pad.toml", "--set", "dither.amplitude_n=6.5kN", "--save", "orbit.csv"];
    let found = place.good(&orbit);
    let text = fs::read_to_string(place.folder.join("orbit.csv")).expect("saved");
    let rows: Vec<&str> = text.lines().filter(|line| !line.starts_with('#')).collect();
    assert!(
        rows[0].starts_with("time,time_s,") || rows[0].starts_with("time,displacement,"),
        "{}",
        rows[0]
    );
    let names: Vec<&str> = rows[0].split(',').collect();
    let column = |name: &str| -> Vec<f64> {
        let at = names.iter().position(|item| *item == name).expect(name);
        rows[1..]
            .iter()
            .map(|row| row.split(',').nth(at).expect("a cell").parse().expect("a number"))
            .collect()
    };
    let period = found["period"].as_f64().expect("a period");
    let times = column("time");
    assert!((times[times.len() - 1] / period - 1.0).abs() < 1e-12);
    assert_eq!(column("belt.slip_velocity").len(), times.len());
    for (name, low, high) in
        [("displacement", "lowest", "highest"), ("velocity", "lowest_velocity", "highest_velocity")]
    {
        let (low, high) = (found[low].as_f64().expect(low), found[high].as_f64().expect(high));
        let values = column(name);
        let (least, most) = values
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(*v), b.max(*v)));
        // Samples approach the extremes and never exceed them.
        let span = high - low;
        assert!(low <= least && most <= high && span > 0.0, "{name}: {low} {least} {most} {high}");
        assert!(least - low < 1e-4 * span && high - most < 1e-4 * span, "{name}");
    }
    let people = String::from_utf8(place.quell(&orbit).stdout).expect("UTF-8");
    assert!(
        people.contains("highest displacement") && people.contains("lowest velocity"),
        "{people}"
    );
}

#[test]
fn stability_reports_growth_and_forces() {
    let place = place("si_stability");
    let found = place.good(&["stability", "pad.toml"]);
    let finite = &found;
    let rate = finite["growth_rate"].as_f64().expect("a rate");
    let decibels = finite["growth_rate_db_per_s"].as_f64().expect("a rate");
    assert!((decibels / rate - 20.0 * std::f64::consts::LOG10_E).abs() < 1e-12);
    let force = finite["critical_amplitudes"][0]["amplitude"].as_f64().expect("a force");
    let sentence = found["sentence"].as_str().expect("a sentence");
    assert!(sentence.starts_with("By averaging over the dither"), "{sentence}");
    assert!(
        sentence.contains(&format!("{force:.0}")) && sentence.contains(" N "),
        "{sentence} {force}"
    );
    let people = String::from_utf8(place.quell(&["stability", "pad.toml"]).stdout).expect("UTF-8");
    for word in ["growth rate in 1/s", "criterion", " N, normal load", "m/s to "] {
        assert!(people.contains(word), "{word}: {people}");
    }
    // Where averaging does not apply the answer is warned of, and what needs a fast dither is null with its reason.
    let slow = place.good(&["stability", "scaled.toml", "--set", "dither.frequency_ratio=0.9"]);
    let warned = slow["warnings"].to_string();
    assert!(warned.contains("is not far below the dither frequency"), "{warned}");
    assert!(slow["unstable_surface_velocities"].is_null(), "{slow}");
    let why = slow["why"]["unstable_surface_velocities"].as_str().expect("a reason");
    assert!(why.contains("requires a frequency ratio above 1, not 0.9"), "{why}");
    assert_eq!(slow["limit"]["verdict"], "stable");
}

/// A belt whose contact has a state, in the units of the arguments: every number is given in them.
fn bristles(units: &str, length: f64) -> String {
    let mass = 1.0 / length;
    let per_length = 1.0 / length;
    format!(
        "schema = 1\n[belt]\nunits = \"{units}\"\nmass = {mass:?}\nstiffness = {:?}\ndamping = {:?}\nnormal_load = 10.0\n\
         belt_velocity = {:?}\n[friction]\nlaw = \"lugre\"\ncoefficient = 0.3\nstatic_coefficient = 0.4\n\
         reference_velocity = {:?}\nbristle_stiffness = {:?}\n[dither]\ndirection = \"tangential\"\nwaveform = \"sine\"\n\
         amplitude = 5.0\nfrequency_hz = 200\n",
        1000.0 * per_length,
        per_length,
        0.05 * length,
        0.02 * length,
        1e5 * per_length,
    )
}

#[test]
fn a_belt_in_millimetres_is_that_in_metres() {
    let texts = [bristles("SI", 1.0), bristles("mm-t-s", 1000.0)];
    let place = Place::with("si_mm", &[("m.toml", &texts[0]), ("mm.toml", &texts[1])]);
    for (verb, names) in [
        (&["simulate", "--until", "0.2"][..], &["final.displacement", "final.velocity"][..]),
        (&["orbit"], &["lowest", "highest", "lowest_velocity", "highest_velocity"]),
        (&["response"], &["amplitude"]),
    ] {
        let [metres, millimetres] = ["m.toml", "mm.toml"].map(|file| {
            let (verb, options) = verb.split_first().expect("a verb");
            place.good(&[&[*verb, file], options].concat())
        });
        for name in names {
            let at = |answer: &Json| {
                let pointer = format!("/{}", name.replace('.', "/"));
                answer.pointer(&pointer).and_then(Json::as_f64).expect(name)
            };
            let (one, other) = (at(&metres), at(&millimetres));
            assert!((other / (1000.0 * one) - 1.0).abs() < 1e-9, "{verb:?} {name}: {one} {other}");
            let unit = |answer: &Json| {
                let key = name.rsplit('.').next().unwrap_or(name);
                answer["units"][key].as_str().expect(name).to_owned()
            };
            assert_eq!(unit(&metres).replacen('m', "mm", 1), unit(&millimetres), "{verb:?} {name}");
        }
    }
    let fast = ["--set", "belt.belt_velocity=200"];
    let warnings = |file: &str| {
        let told = place.good(&[&["check", file], &fast[..]].concat())["warnings"].to_string();
        told.contains("moves at 200 m/s")
    };
    assert_eq!([warnings("m.toml"), warnings("mm.toml")], [true, false]);
}

/// The largest slow velocity of a belt in SI is in metres per second, as its curve and its cycle are.
#[test]
fn a_slow_amplitude_is_in_metres_per_second() {
    let place = place("si_describing");
    let found = place.good(&["friction", "pad.toml", "--describing", "0.2m/s"]);
    let amplitudes = found["contacts"][0]["velocity_amplitude"].as_array().expect("a curve");
    assert_eq!(amplitudes.last(), Some(&0.2.into()));
    assert_eq!(found, place.good(&["friction", "pad.toml", "--describing", "0.2"]));
}
