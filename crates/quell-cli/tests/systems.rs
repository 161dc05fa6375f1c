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
        let form = answer(&["check", study])["form"].clone();
        assert!(form == "coordinates" || form == "states", "{study}: {form}");
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
    let why =
        complaint(&["stability", "two-mass-drive.toml", "--exact", "--save", save, "--plot", plot]);
    assert!(why.contains("--plot: this answer has no picture"), "{why}");
    assert!(!table.exists() && !picture.exists());
    let why = complaint(&["stability", "two-mass-drive.toml", "--exact", "--plot", plot]);
    assert!(why.contains("no picture"), "{why}");
    let help = quell(&["modes", "--help"]);
    assert!(String::from_utf8_lossy(&help.stdout).contains("of a belt, a disc or a system"));
    std::fs::remove_dir_all(&folder).expect("removed");
}

/// Every study of a system can be simulated, for the default time, with the state of every contact at the end.
#[test]
fn every_study_of_a_system_can_be_simulated() {
    for study in ALL {
        let found = answer(&["simulate", study]);
        let states = found["state_names"].as_array().expect("names").len();
        assert_eq!(found["final"]["state"].as_array().map(Vec::len), Some(states), "{study}");
        let contacts = found["contacts"].as_array().expect("contacts");
        for (contact, end) in
            contacts.iter().zip(found["final"]["contacts"].as_array().expect("ends"))
        {
            assert_eq!(contact["name"], end["name"], "{study}");
            let closed = end["normal"].as_f64().expect("a load") > 0.0;
            assert_eq!(end["open"], !closed, "{study}");
            let sum = ["stick_fraction", "open_fraction"]
                .map(|key| contact[key].as_f64().expect("a fraction"));
            assert!((0.0..=1.0 + 1e-12).contains(&(sum[0] + sum[1])), "{study}: {contact}");
        }
        let note = found["notes"][0].as_str().expect("a sentence");
        assert!(note.contains("100 periods of the slowest oscillation"), "{study}: {note}");
    }
    // The first events as another program finds them.
    let siconos = answer(&["simulate", "two-masses-siconos.toml", "--until", "10"]);
    close(&siconos["events"][0]["time"], 1.7153118187665, 1e-12);
    close(&siconos["events"][1]["time"], 5.7784921741816, 1e-12);
}

#[test]
fn times_and_starts_of_simulations_have_units() {
    let study = "bowed-string.toml";
    let found = answer(&["simulate", study, "--until", "5ms", "--start", "velocity.mode.1=2mm/s"]);
    assert_eq!(found["final"]["time"], 0.005);
    assert_eq!(found["start"]["state"][40], 0.002);
    for (options, part) in [
        (&["--until", "5m"][..], "in s"),
        (&["--until", "-1"], "a time from 0"),
        (&["--start", "velocity.mode.1=2N"], "m/s"),
        (&["--start", "velocity.mod.1=2"], "did you mean velocity.mode.1"),
        (&["--start", "x=1,y"], "name=value"),
    ] {
        let all: Vec<&str> = ["simulate", study].iter().chain(options).copied().collect();
        let why = complaint(&all);
        assert!(why.contains(part), "{options:?}: {why}");
    }
    let begin = |start: &str| {
        let belt = ["simulate", "stribeck-belt.toml", "--until", "1", "--start", start];
        answer(&belt)["start"].clone()
    };
    for start in ["0.2,-0.1", "x=0.2,velocity.x=-0.1"] {
        let begin = begin(start);
        assert_eq!((&begin["displacement"], &begin["velocity"]), (&0.2.into(), &(-0.1).into()));
        assert_eq!(begin["state"], serde_json::json!([0.2, -0.1]));
    }
    assert_eq!(begin("x=1")["velocity"], 0.0);
    // The usual duration.
    let usual = answer(&["simulate", "stribeck-belt.toml"])["final"]["time"].as_f64();
    assert!((usual.expect("a time") / (200.0 * std::f64::consts::PI) - 1.0).abs() < 1e-4);
}

/// The belt as a system has the response of the belt itself, with the record that the belt's solver has.
#[test]
fn a_belt_as_a_system_has_the_response_of_the_belt() {
    for amplitude in ["dither.amplitude=0.4", "dither.amplitude=0.52"] {
        let belt = answer(&["response", "stribeck-belt.toml", "--set", amplitude]);
        let length = (60.0 * std::f64::consts::TAU).to_string();
        let times = ["--set", amplitude, "--settle", "1200", "--record", &length];
        let system = answer(&[&["response", "belt-as-system.toml"], &times[..]].concat());
        assert_eq!(system["effect"], belt["effect"], "{amplitude}");
        for path in [
            "/amplitude",
            "/undithered_amplitude",
            "/residual_vibration",
            "/band_end",
            "/half_peak_to_peak",
            "/contacts/0/stick_fraction",
            "/contacts/0/mean_friction",
            "/contacts/0/friction_loss",
            "/dithers/0/power",
            "/dithers/0/stroke",
        ] {
            let [one, other] = [&system, &belt].map(|found| found.pointer(path).expect(path));
            close(one, other.as_f64().expect(path), 1e-7);
        }
    }
    // Both take other times.
    let short = answer(&["response", "stribeck-belt.toml", "--settle", "10", "--record", "200"]);
    assert_eq!((&short["settle"], &short["record_length"]), (&10.0.into(), &200.0.into()));
}

#[test]
fn responses_name_the_effect_of_a_dither() {
    for (study, amplitude, effect) in [
        ("two-mass-drive.toml", "dither.amplitude=5.2", "reduces"),
        ("two-mass-drive.toml", "dither.amplitude=5.6", "quenches"),
        ("two-mass-drive.toml", "dither.amplitude=0", "unknown"),
        ("mode-coupling-dither.toml", "dither.amplitude=21", "quenches"),
    ] {
        let found = answer(&["response", study, "--set", amplitude]);
        assert_eq!(found["effect"], effect, "{study} {amplitude}: {}", found["sentence"]);
        let (record, settle) = (&found["record_length"], &found["settle"]);
        close(record, 0.3 * settle.as_f64().expect("a time"), 1e-12);
        let half = found["half_peak_to_peak"].as_f64().expect("a length");
        assert!(half >= 0.9 * found["amplitude"].as_f64().expect("a length"), "{found}");
    }
    for (options, part) in [
        (&["--record", "0.1"][..], "of which a line lies in the band of slow vibration"),
        (&["--record", "1e9"], "at most"),
        (&["--settle", "x"], "--settle"),
    ] {
        let all: Vec<&str> =
            ["response", "two-mass-drive.toml"].iter().chain(options).copied().collect();
        let why = complaint(&all);
        assert!(why.contains(part), "{options:?}: {why}");
    }
}

/// The drive falls into step with its dither at the amplitude of `reference/motion.json`, a little above that of averaging.
#[test]
fn motions_of_the_drive_are_found_from_the_command_line() {
    let drive = "two-mass-drive.toml";
    let orbit = answer(&["orbit", drive]);
    assert_eq!((&orbit["response"], &orbit["verdict"]), (&"base".into(), &"unstable".into()));
    close(&orbit["period"], 0.628_318_530_717_958_8, 1e-12);
    let range = ["--parameter", "dither.amplitude", "--from", "5.3", "--to", "5.5"];
    let thresholds = answer(&[&["thresholds", drive][..], &range, &["--from-rest"]].concat());
    for found in [&thresholds["local"][0], &thresholds["from_rest"][0]] {
        close(&found["value"], 5.396_532_388_527_742, 1e-6);
        assert_eq!(found["kind"], "grazing");
    }
    let set = ["--set", "dither.amplitude=5.6"];
    let state = ["--near", "motor=0.36,carriage=0.45,velocity.motor=-1.25,velocity.carriage=0.05"];
    let near = answer(&[&["orbit", drive][..], &set, &state].concat());
    let base = answer(&[&["orbit", drive][..], &set].concat());
    close(&near["state"][0], base["state"][0].as_f64().expect("a number"), 1e-9);
    let sweep = answer(&[&["bifurcation", drive][..], &range, &["--points", "3", "--up"]].concat());
    assert_eq!(sweep["up"][2]["kind"], "period-1");
    let plane = ["--plane", "carriage=0.2:0.6,velocity.carriage=-0.1:0.1", "--grid", "2x2"];
    let basins = answer(&[&["basins", drive][..], &set, &plane].concat());
    assert_eq!(basins["quiet_fraction"], 1.0);
    let wrong = complaint(&["orbit", drive, "--start", "0.1,0.2"]);
    assert!(wrong.contains("--start") && wrong.contains("name=value"), "{wrong}");
    let wrong = complaint(&["basins", drive, "--plane", "carriage,nothing"]);
    assert!(wrong.contains("--plane"), "{wrong}");
}

/// `orbit`, `thresholds` and `response` judge one motion alike, also between the averaged thresholds (5.378463 and 20.60202) and the
/// exact ones (5.396532 and 20.71309), and where a response is approached slowly.
#[test]
fn verbs_agree_about_where_a_run_ends() {
    for (study, below, above) in
        [("two-mass-drive.toml", "5.385", "5.42"), ("mode-coupling-dither.toml", "20.65", "20.8")]
    {
        let range = ["--parameter", "dither.amplitude", "--from", below, "--to", above];
        let found = answer(&[&["thresholds", study][..], &range].concat());
        let threshold = &found["local"][0];
        assert_eq!(threshold["was"], "unstable");
        assert_eq!(threshold["becomes"], "stable");
        for (amplitude, verdict) in [(below, "unstable"), (above, "stable")] {
            let set = format!("dither.amplitude={amplitude}");
            let orbit = answer(&["orbit", study, "--set", &set]);
            assert_eq!(orbit["verdict"], verdict, "{study} {amplitude}");
            let response = answer(&["response", study, "--set", &set]);
            let at = format!("{study} {amplitude}: {}", response["sentence"]);
            let rest = response["residual_vibration"].as_f64().expect("a ratio");
            if verdict == "stable" {
                assert_eq!(response["base_response"], true, "{at}");
                assert_eq!(response["effect"], "quenches", "{at}");
                close(&response["period"], orbit["period"].as_f64().expect("a period"), 1e-12);
                assert!(rest < 1e-5, "{at}");
            } else {
                // A vibration remains, however small, and the base response is not where the run ends.
                assert!(rest > 1e-3 && response["period"] != orbit["period"], "{at}");
            }
        }
    }
    // The undithered vibration of the response is the limit cycle of `orbit`.
    let study = "mode-coupling-dither.toml";
    let free = answer(&["orbit", study, "--set", "dither.amplitude=0"]);
    let response = answer(&["response", study, "--set", "dither.amplitude=21"]);
    assert_eq!(response["undithered_ends_on"], "limit-cycle");
    close(&response["undithered_period"], free["period"].as_f64().expect("a period"), 1e-9);
}

/// The string ends on Helmholtz motion, whose period and shares of stick are those of the study's comments.
#[test]
fn the_bowed_string_sings() {
    let found = answer(&["orbit", "bowed-string.toml"]);
    assert_eq!(found["verdict"], "stable", "{}", found["sentence"]);
    close(&found["period"], 0.015_234_04, 1e-8);
    // The pitch is that of the lowest mode within a fiftieth of a semitone's frequency ratio, and the modes are inharmonic.
    let pitch = 1.0 / found["period"].as_f64().expect("a period");
    assert!((pitch / 65.43011 - 1.0).abs() < 0.004, "{pitch}");
    assert_eq!(found["events"].as_array().map(Vec::len), Some(2), "one stick and one release");
}

/// Without a stable cycle the unstable one is reported, with every start that was tried, disturbances of it included.
#[test]
fn a_chain_of_blocks_has_an_unstable_cycle_alone() {
    let found = answer(&["orbit", "burridge-knopoff.toml"]);
    close(&found["period"], 147.828_224_4, 1e-6);
    assert_eq!(found["verdict"], "unstable");
    let tried = found["tried"].as_array().expect("starts");
    let disturbed =
        |start: &&Json| start["start"].as_str().is_some_and(|s| s.contains("disturbance"));
    assert_eq!(tried.iter().filter(disturbed).count(), 3, "{tried:?}");
}

/// The observed row follows the tangent of the contact where the study gives none: a varied value answers as `--set` does.
#[test]
fn a_varied_tangent_is_observed_as_a_set_one() {
    let range = ["--parameter", "contact.tangent.x", "--from", "0.8", "--to", "1"];
    let swept = ["bifurcation", "belt-as-system.toml", "--up", "--points", "2"];
    let swept = answer(&[&swept[..], &range].concat());
    let set = answer(&["attractor", "belt-as-system.toml", "--set", "contact.tangent.x=0.8"]);
    let found = &swept["up"][0]["peak_to_peak"];
    assert!(found.is_number() && *found == set["attractor"]["peak_to_peak"], "{found} {set}");
}

/// A range of a number that changes none of the equations has no answer, in any verb and kind of study.
#[test]
fn numbers_without_effect_are_refused() {
    let range = ["--from", "100", "--to", "300"];
    let of_belt = ["thresholds", "does-it-squeal.toml", "--set", "solver.settle=200"];
    let of_belt = [&of_belt[..], &["--parameter", "solver.settle"]].concat();
    let initial = "system.initial.displacements.b1";
    let system = ["--set", "system.initial.displacements.b1=0.1", "--parameter", initial];
    let of_system = [&["thresholds", "two-blocks.toml"][..], &system].concat();
    let swept = [&["bifurcation", "two-blocks.toml"][..], &system].concat();
    for asked in [&of_belt, &of_system, &swept] {
        let words = complaint(&[&asked[..], &range].concat());
        assert!(words.contains("--parameter = ") && words.contains("changes none"), "{words}");
    }
}
