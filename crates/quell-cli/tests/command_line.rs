//! Tests of the binary: exit statuses, exactly one JSON object, no files left behind.

use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};

use serde_json::Value as Json;

use crate::place::Place;

const STUDY: &str = r#"schema = 1
title = "Stribeck belt"
[belt]
damping_ratio = 0.005
normal_load = 1.0
belt_velocity = 0.05
[friction]
law = "stribeck"
static_coefficient = 0.4
minimum_coefficient = 0.2857
reference_velocity = 0.2
[dither]
direction = "tangential"
waveform = "sine"
amplitude = 0.4
frequency_ratio = 10.0
[solver]
settle = 200
record_periods = 20
"#;

const SI: &str = r#"schema = 1
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
settle_s = 0.3
record_periods = 20
"#;

/// Verbs that read a study, with the arguments they need.
const VERBS: &[&[&str]] = &[
    &["check"],
    &["cite"],
    &["friction"],
    &["stability"],
    &["simulate", "--until", "20"],
    &["response"],
];

/// The command of a verb for a study; times are in seconds for the study in SI.
fn about(study: &'static str, verb: &[&'static str]) -> Vec<&'static str> {
    let seconds = |duration: &'static str| {
        if duration == "20" && study == "si.toml" { "30ms" } else { duration }
    };
    verb.iter().copied().map(seconds).chain([study]).collect()
}

/// A fresh folder with these studies.
fn place(name: &str) -> Place {
    Place::with(name, &[("study.toml", STUDY), ("si.toml", SI)])
}

/// Every null has its reason.
fn nulls_have_reasons(object: &Json) {
    fn walk(value: &Json, path: &str, why: &Json) {
        match value {
            Json::Null => {
                let named = |path: &str| why.get(path).is_some_and(Json::is_string);
                // An SI field is null for the reason of its dimensionless field.
                let of_twin =
                    why.as_object().is_some_and(|why| why.keys().any(|key| path.starts_with(key)));
                assert!(named(path) || of_twin, "null without a reason: {path}");
            }
            Json::Array(list) => {
                for (index, inner) in list.iter().enumerate() {
                    walk(inner, &format!("{path}[{index}]"), why);
                }
            }
            Json::Object(object) => {
                for (key, inner) in object {
                    let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
                    walk(inner, &path, why);
                }
            }
            _ => {}
        }
    }
    walk(object, "", &object["why"]);
}

#[test]
fn every_verb_answers_with_one_object() {
    let place = place("answers");
    for study in ["study.toml", "si.toml"] {
        for verb in VERBS {
            let arguments = about(study, verb);
            let object = place.good(&arguments);
            nulls_have_reasons(&object);
            let people = place.quell(&arguments);
            assert_eq!(people.status.code(), Some(0));
            assert!(!people.stdout.is_empty(), "{arguments:?}");
        }
    }
    assert_eq!(place.files(), ["si.toml", "study.toml"]);
}

#[test]
fn invalid_studies_are_rejected_by_every_verb() {
    let place = place("bad_studies");
    let with = |from: &str, to: &str| STUDY.replace(from, to).into_bytes();
    let cases: Vec<(&str, Vec<u8>, &str)> = vec![
        ("apart", with("\"tangential\"", "\"normal\""), "dither.amplitude"),
        ("damping", with("= 0.005", "= -0.005"), "belt.damping_ratio"),
        (
            "frequency",
            with("frequency_ratio = 10.0", "frequency_ratio = 0"),
            "dither.frequency_ratio",
        ),
        ("minimum", with("0.2857", "0.5"), "friction.minimum_coefficient"),
        ("nan", with("normal_load = 1.0", "normal_load = nan"), "belt.normal_load"),
        ("unknown", with("belt_velocity", "belt_velosity"), "belt.belt_velosity"),
        ("half", with("normal_load = 1.0", "normal_load = 1.0\nmass_kg = 1"), "belt.stiffness"),
        ("text", with("= 0.4\nfreq", "= \"0.4\"\nfreq"), "dither.amplitude"),
        ("empty", Vec::new(), "study file"),
        ("blank", b"\n \n\t\n".to_vec(), "study file"),
        ("binary", vec![0xff, 0xfe, 0x00, 0x80, 0x0a], "study file"),
        ("zeros", vec![0; 64], "study file"),
        ("broken", b"schema = \n[belt\n".to_vec(), "study"),
        ("comment", b"# nothing\n".to_vec(), "belt"),
    ];
    for (name, bytes, key) in &cases {
        let bytes = match *name {
            "apart" => String::from_utf8_lossy(bytes)
                .replace("amplitude = 0.4", "amplitude = 1.4")
                .into_bytes(),
            _ => bytes.clone(),
        };
        place.write("bad.toml", &bytes);
        for verb in VERBS {
            let mut arguments = verb.to_vec();
            arguments.push("bad.toml");
            let errors = place.refused(&arguments);
            assert!(errors.iter().any(|error| error["key"] == *key), "{name}: {errors:?}");
        }
    }
    for missing in ["nowhere.toml", ".", "study.toml/below"] {
        let errors = place.refused(&["check", missing]);
        assert_eq!(errors[0]["value"], missing);
    }
}

#[test]
fn invalid_arguments_are_rejected() {
    let place = place("bad_arguments");
    let cases: &[(&[&str], &str)] = &[
        (&["simulate", "study.toml", "--until", "-1"], "--until"),
        (&["simulate", "study.toml", "--until=-0.5s"], "--until"),
        (&["simulate", "si.toml", "--until", "-0.5s"], "--until"),
        (&["simulate", "study.toml", "--until", "nan"], "--until"),
        (&["simulate", "study.toml", "--until", "inf"], "--until"),
        (&["simulate", "study.toml", "--until", "soon"], "--until"),
        (&["simulate", "si.toml", "--until", "1e308h"], "--until"),
        (&["simulate", "study.toml", "--until", "0.5s"], "--until"),
        (&["simulate", "--until", "1"], "<STUDY>"),
        (&["friction", "study.toml", "--at", "fast"], "--at"),
        (&["friction", "study.toml", "--at", "0.1,20mm/s"], "--at"),
        (&["check", "study.toml", "--set", "belt.normal_load"], "--set"),
        (&["check", "study.toml", "--set", "belt.normal_laod=1"], "belt.normal_laod"),
        (&["check", "study.toml", "--set", "belt.normal_load=-1"], "belt.normal_load"),
        (&["check", "study.toml", "--tolerance", "1"], "solver.tolerance"),
        (&["check", "study.toml", "--tolerance", "-1e-9"], "solver.tolerance"),
        (&["check", "study.toml", "--tolerance", "tight"], "solver.tolerance"),
        (&["check", "study.toml", "--colour"], "--colour"),
        (&["chekc", "study.toml"], "chekc"),
        (&["response", "study.toml", "--save", "x.xlsx"], "--save"),
        (&["response", "study.toml", "--save", "nowhere/x.csv"], "--save"),
        (&["simulate", "study.toml", "--until", "1", "--save", "study.toml/x.csv"], "--save"),
    ];
    for (arguments, key) in cases {
        let errors = place.refused(arguments);
        assert!(errors.iter().any(|error| error["key"] == *key), "{arguments:?}: {errors:?}");
    }
    // All errors are reported at once, regardless of where they are.
    place.write("bad.toml", STUDY.replace("= 0.005", "= -1").as_bytes());
    let errors = place.refused(&[
        "simulate", "bad.toml", "--until", "-3", "--save", "no/x.csv", "--set", "belt.x=1",
    ]);
    let keys: Vec<&str> = errors.iter().filter_map(|error| error["key"].as_str()).collect();
    for key in ["belt.damping_ratio", "belt.x", "--until", "--save"] {
        assert!(keys.contains(&key), "{key} in {keys:?}");
    }
    assert_eq!(
        errors
            .iter()
            .find(|error| error["key"] == "belt.damping_ratio")
            .map(|error| &error["line"]),
        Some(&4.into())
    );
}

#[test]
fn outputs_are_checked_before_anything_is_computed() {
    let place = place("unwritable");
    fs::create_dir(place.folder.join("folder.csv")).expect("a folder");
    // A run of this length would take days.
    let errors =
        place.refused(&["simulate", "study.toml", "--until", "1e9", "--save", "folder.csv"]);
    assert_eq!(errors[0]["key"], "--save");
    assert_eq!(errors[0]["value"], "folder.csv");
}

#[test]
fn a_saved_trajectory_is_complete_and_reads_back() {
    let place = place("save");
    place.write("x.csv", b"what was there before");
    let object = place.good(&["simulate", "study.toml", "--until", "20", "--save", "x.csv"]);
    assert_eq!(object["saved"][0], "x.csv");
    let text = fs::read_to_string(place.folder.join("x.csv")).expect("saved");
    assert!(text.starts_with("# quell "), "{}", &text[..80]);
    assert!(text.contains("# units: time [dimensionless], displacement [dimensionless]"));
    let rows: Vec<&str> = text.lines().filter(|line| !line.starts_with('#')).collect();
    let names = "time,displacement,velocity,x,velocity.x,belt.slip_velocity,belt.friction,belt.normal,belt.phase";
    assert_eq!(rows[0], names);
    let cells = |row: &str| -> Vec<f64> {
        row.split(',').take(6).map(|cell| cell.parse().expect("a number")).collect()
    };
    assert_eq!(cells(rows[1]), [0.0, 0.0, 0.0, 0.0, 0.0, 0.05]);
    let last = cells(rows[rows.len() - 1]);
    assert_eq!(object["final"]["time"].as_f64(), Some(last[0]));
    assert_eq!(object["final"]["displacement"].as_f64(), Some(last[1]));
    let object = place.good(&["response", "si.toml", "--save", "r.csv"]);
    assert_eq!(object["saved"], serde_json::json!(["r.csv", "r_spectrum.csv"]));
    let spectrum = fs::read_to_string(place.folder.join("r_spectrum.csv")).expect("saved");
    assert!(
        spectrum.contains("frequency,amplitude,undithered_amplitude")
            && spectrum.contains("# units: frequency [rad/s], amplitude [m]"),
        "{}",
        &spectrum[..900]
    );
    assert!(place.files().iter().all(|name| !name.contains("part")));
}

#[test]
fn pictures_are_complete_or_absent() {
    let place = place("pictures");
    let before = place.files();
    for verb in &VERBS[2..] {
        for study in ["study.toml", "si.toml"] {
            let mut arguments = about(study, verb);
            arguments.extend(["--plot", "picture.svg"]);
            let object = place.good(&arguments);
            assert_eq!(object["plotted"], "picture.svg");
            let picture = fs::read_to_string(place.folder.join("picture.svg")).expect("drawn");
            assert!(picture.starts_with("<svg") && picture.trim_end().ends_with("</svg>"));
            let dashed = picture.contains("stroke-dasharray");
            assert!(dashed, "{arguments:?}: the undithered case is dashed");
            let unit = if study == "si.toml" { ["µm", "mm/s"] } else { ["τ", "slip"] };
            let has_axes = unit.iter().any(|unit| picture.contains(unit)) || verb[0] == "stability";
            assert!(has_axes, "{arguments:?}");
        }
    }
    place.good(&["friction", "study.toml", "--plot", "picture.PNG"]);
    let picture = fs::read(place.folder.join("picture.PNG")).expect("drawn");
    assert!(picture.starts_with(b"\x89PNG"));
    // Without dither there is one curve, and its label does not say "with dither".
    place.write("bare.toml", STUDY.split("[dither]").next().expect("a part").as_bytes());
    for verb in &VERBS[2..] {
        let mut arguments = verb.to_vec();
        arguments.extend(["bare.toml", "--plot", "bare.svg"]);
        place.good(&arguments);
        let picture = fs::read_to_string(place.folder.join("bare.svg")).expect("drawn");
        assert!(!picture.contains("with dither"), "{arguments:?}");
    }
    for name in ["picture.svg", "picture.PNG", "bare.svg", "bare.toml"] {
        fs::remove_file(place.folder.join(name)).expect("there");
    }
    assert_eq!(place.files(), before);
    for path in ["picture.jpg", "nowhere/picture.svg", "picture"] {
        let errors = place.refused(&["response", "study.toml", "--plot", path]);
        assert_eq!(errors[0]["key"], "--plot");
    }
}

#[cfg(unix)]
#[test]
fn devices_are_written_not_replaced() {
    use std::os::unix::fs::FileTypeExt;
    let place = place("devices");
    place.good(&["simulate", "study.toml", "--until", "5", "--save", "/dev/null"]);
    let kind = fs::metadata("/dev/null").expect("there").file_type();
    assert!(kind.is_char_device());
    place.good(&["response", "study.toml", "--save", "/dev/null"]);
    assert!(!Path::new("/dev/null_spectrum.csv").exists(), "both tables go to the device");
    if Path::new("/dev/full").exists() {
        let (object, status) =
            place.json(&["simulate", "study.toml", "--until", "5", "--save", "/dev/full"]);
        assert_eq!((status, &object["ok"]), (1, &Json::Bool(false)), "{object}");
        let output = place
            .command(&["check", "study.toml", "--json"])
            .stdout(fs::OpenOptions::new().write(true).open("/dev/full").expect("there"))
            .output()
            .expect("quell runs");
        assert_eq!(output.status.code(), Some(1));
        assert!(String::from_utf8_lossy(&output.stderr).contains("standard output"));
    }
    // Endless files are rejected as studies.
    place.refused(&["check", "/dev/zero"]);
}

/// The reader of a pipe receives one stream with both tables, and its end.
#[cfg(unix)]
#[test]
fn named_pipes_are_opened_once() {
    let place = place("named_pipes");
    let made = Command::new("mkfifo").arg(place.folder.join("numbers")).status();
    assert!(made.expect("mkfifo runs").success());
    let path = place.folder.join("numbers");
    let reader = std::thread::spawn(move || fs::read_to_string(path).expect("read to its end"));
    let before = place.files();
    let answer = place.good(&["response", "study.toml", "--save", "numbers"]);
    assert_eq!(answer["saved"].as_array().map(Vec::len), Some(2), "{answer}");
    let printed = reader.join().expect("read");
    let names = printed.lines().filter(|line| line.starts_with(char::is_alphabetic));
    assert_eq!(names.count(), 2, "{printed}");
    assert_eq!(place.files(), before);
}

#[cfg(unix)]
#[test]
fn links_are_followed_not_replaced() {
    let place = place("links");
    place.write("real.csv", b"");
    std::os::unix::fs::symlink("real.csv", place.folder.join("link.csv")).expect("a link");
    place.good(&["friction", "study.toml", "--save", "link.csv"]);
    assert!(fs::symlink_metadata(place.folder.join("link.csv")).expect("there").is_symlink());
    assert!(fs::metadata(place.folder.join("real.csv")).expect("there").len() > 100);
}

#[test]
fn a_closed_pipe_causes_no_panic() {
    let place = place("pipe");
    let mut child = place
        .command(&["friction", "study.toml", "--json"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("quell runs");
    drop(child.stdout.take());
    let mut printed = String::new();
    child.stderr.take().expect("piped").read_to_string(&mut printed).expect("text");
    assert_eq!(child.wait().expect("ends").code(), Some(0), "{printed}");
    assert_eq!(printed, "");
}

#[test]
fn a_study_is_read_from_standard_input() {
    let place = place("stdin");
    let file = fs::File::open(place.folder.join("study.toml")).expect("there");
    let output = place.command(&["check", "-", "--json"]).stdin(file).output().expect("quell runs");
    assert_eq!(output.status.code(), Some(0));
}

#[test]
fn changes_and_units_are_applied() {
    let place = place("changes");
    let changed = place.good(&[
        "check",
        "study.toml",
        "--set",
        "dither[0].amplitude=0.7",
        "--set",
        "friction.law=decreasing",
    ]);
    assert_eq!(changed["dithers"][0]["amplitude"], 0.7);
    assert_eq!(changed["contacts"][0]["friction"]["law"], "decreasing");
    let seconds = place.good(&["simulate", "si.toml", "--until", "50ms", "--events"]);
    let end = seconds["final"]["time"].as_f64().expect("a number");
    assert!((end - 0.05).abs() < 1e-15);
    assert_eq!(seconds["units"]["time"], "s");
    // A plain number is in seconds.
    let plain = place.good(&["simulate", "si.toml", "--until", "0.05", "--events"]);
    assert_eq!(plain["events"], seconds["events"]);
    assert!(
        seconds["event_count"].as_u64()
            == seconds["events"].as_array().map(|list| list.len() as u64)
    );
    let first = &seconds["events"][0];
    assert_eq!(
        (&first["kind"], &first["slip_sign"], &first["contact"]),
        (&"stick".into(), &0.into(), &0.into())
    );
    let coarse = place.good(&["simulate", "study.toml", "--until", "20", "--tolerance", "1e-6"]);
    let fine = place.good(&["simulate", "study.toml", "--until", "20"]);
    assert_eq!(coarse["tolerance"], 1e-6);
    assert!(coarse["steps"].as_u64() < fine["steps"].as_u64());
    let at = place.good(&["friction", "si.toml", "--at", "20mm/s,-0.03m/s"]);
    let v = at["contacts"][0]["slip_velocity"].as_array().expect("an array");
    assert!((v[0].as_f64().expect("a number") - 0.02).abs() < 1e-16);
    let plain = place.good(&["friction", "si.toml", "--at", "0.02,-0.03"]);
    assert_eq!(plain, at);
}

#[test]
fn fields_have_documented_names() {
    let place = place("names");
    let friction = place.good(&["friction", "study.toml", "--at", "0,0.1"]);
    for name in ["slip_velocity", "coefficient", "effective_coefficient", "effective_slope"] {
        assert_eq!(friction["contacts"][0][name].as_array().map(Vec::len), Some(2), "{name}");
    }
    assert!(friction["contacts"][0]["coefficient"][0].is_null());
    assert!(friction["why"]["contacts[0].coefficient[0]"].is_string());
    let response = place.good(&["response", "si.toml"]);
    for path in [
        "/amplitude",
        "/residual_vibration",
        "/undithered_amplitude",
        "/contacts/0/stick_fraction",
        "/contacts/0/mean_friction",
        "/contacts/0/mean_friction_undithered",
        "/contacts/0/steady_sliding_friction",
        "/contacts/0/least_normal",
        "/dithers/0/power",
        "/dithers/0/stroke",
    ] {
        assert!(response.pointer(path).is_some_and(Json::is_number), "{path}");
    }
    assert!(response["settled"].is_boolean() && response["sentence"].is_string());
    for name in ["frequency", "amplitude"] {
        assert!(response["peaks"][0][name].is_number(), "{name}");
        assert!(response["units"][name].is_string(), "{name}");
    }
    // Steady sliding far above the velocity scale: no vibration to compare with.
    let undefined = place.good(&["response", "study.toml", "--set", "belt.belt_velocity=0.5"]);
    assert!(
        undefined["residual_vibration"].is_null()
            && undefined["why"]["residual_vibration"].is_string()
    );
    let normal = place.good(&["response", "study.toml", "--set", "dither.direction=normal"]);
    assert!(normal["dithers"][0]["power"].is_null());
    assert!(normal["why"]["dithers[0].power"].is_string());
}

/// The dissertation's belt with the decreasing law at v₀ = 1: exact thresholds of the dither are
/// 4.322392624 and 9.900214849; finite-R averaging is within 4·10⁻⁵ of them, averaging in the limit R → ∞ within 1 %.
#[test]
fn averaging_finds_the_known_thresholds() {
    let place = place("thresholds");
    let at = |amplitude: &str| {
        let amplitude = format!("dither.amplitude={amplitude}");
        let law = "friction.law=decreasing";
        place.good(&[
            "stability",
            "study.toml",
            "--set",
            law,
            "--set",
            "belt.belt_velocity=1",
            "--set",
            &amplitude,
        ])
    };
    let (below, within, above) = (at("4"), at("6"), at("9.95"));
    let verdicts = [&below, &within, &above].map(|found| found["verdict"].clone());
    assert_eq!(verdicts, ["stable", "unstable", "stable"]);
    assert_eq!(above["limit"]["verdict"], "unstable");
    let amplitudes = |list: &Json| -> Vec<f64> {
        let list = list["critical_amplitudes"].as_array().expect("a list");
        list.iter().map(|critical| critical["amplitude"].as_f64().expect("a number")).collect()
    };
    let close = |found: Vec<f64>, share: f64| {
        assert_eq!(found.len(), 2, "{found:?}");
        for (found, exact) in found.iter().zip([4.322392624, 9.900214849]) {
            assert!((found / exact - 1.0).abs() < share, "{found} {exact}");
        }
    };
    close(amplitudes(&below), 4e-5);
    close(amplitudes(&below["limit"]), 0.0102);
    // The list does not depend on the study's own amplitude.
    assert_eq!(amplitudes(&below), amplitudes(&within));
    let kinds: Vec<&str> = below["critical_amplitudes"]
        .as_array()
        .expect("a list")
        .iter()
        .filter_map(|critical| critical["kind"].as_str())
        .collect();
    assert_eq!(kinds, ["root", "jump"]);
    assert_eq!(below["protocol"], "averaged");
    for found in [&below, &within, &above] {
        let sentence = found["sentence"].as_str().expect("a sentence");
        assert!(
            sentence.contains("averaging")
                && sentence.contains(found["verdict"].as_str().expect("a word"))
        );
    }
}

/// At rest the belt of the dissertation squeals without dither, and one that is dithered past its
/// threshold does not.
#[test]
fn dither_past_its_threshold_quenches() {
    let place = place("quench");
    let quenched = place.good(&[
        "response",
        "study.toml",
        "--set",
        "dither.amplitude=0.6",
        "--set",
        "solver.settle=600",
    ]);
    let ratio = quenched["residual_vibration"].as_f64().expect("a number");
    assert!(ratio < 0.01, "{ratio}");
    assert!(quenched["sentence"].as_str().is_some_and(|sentence| sentence.contains("quenches")));
    let weak = place.good(&["response", "study.toml", "--set", "dither.amplitude=0.3"]);
    let ratio = weak["residual_vibration"].as_f64().expect("a number");
    assert!(ratio > 0.1 && ratio < 1.0, "{ratio}");
}

#[test]
fn help_version_and_schema_succeed() {
    let place = place("help");
    for arguments in [&["--help"][..], &["--version"], &["simulate", "--help"]] {
        let output = place.quell(arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}");
        assert!(!output.stdout.is_empty() && output.stderr.is_empty());
    }
    assert_eq!(place.quell(&[]).status.code(), Some(2));
    let (schema, status) = place.json(&["schema"]);
    assert_eq!(status, 0);
    assert_eq!(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
}

/// What a newcomer types first is answered by what to type instead.
#[test]
fn first_guesses_are_answered_by_what_to_type() {
    let place = Place::with("first-guesses", &[("q.toml", STUDY)]);
    let says = |words: &[&str], wanted: &str| {
        let output = place.quell(words);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{words:?}");
        assert!(said.contains(wanted), "{words:?}: {said}");
        assert!(!said.contains("as a value"), "{words:?}: {said}");
    };
    says(&["q.toml"], "quell report q.toml");
    says(&["run", "q.toml"], "quell simulate STUDY");
    says(&["version"], "quell --version");
    says(&["friction", "q.toml", "-o", "friction.csv"], "`--save FILE`");
    says(&["response", "q.toml", "--amplitude", "0.5"], "`--set dither.amplitude=0.5`");
    says(&["response", "q.toml", "--belt-velocity=0.1"], "`--set belt.belt_velocity=0.1`");
    says(
        &["response", "q.toml", "--set", "dither.amplitude", "0.5"],
        "`--set dither.amplitude=0.5`",
    );
    says(&["response", "q.toml", "--loud"], "unexpected argument '--loud'");
    says(&["simulate"], "quell new");
}
