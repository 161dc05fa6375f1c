//! Drives, loads and envelopes: numbers that vary in time.
//!
//! Numbers: `reference/profiles.json` (source and tolerance in `reference/README.md`).

use quell::run::response::ResponseRequest;
use quell::run::simulate::MotionRequest;
use quell::study::Study;
use quell::verbs::verbs;
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

fn reference() -> Json {
    serde_json::from_str(include_str!("../../../reference/profiles.json")).expect("JSON")
}

fn number(value: &Json) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("a number: {value}"))
}

fn study(text: &str) -> Study {
    Study::parse(text, &[]).unwrap_or_else(|wrong| panic!("{text}\n{wrong:?}"))
}

fn refused(text: &str) -> String {
    let wrong = Study::parse(text, &[]).expect_err(text);
    wrong.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

/// The run of a study, as its JSON.
fn simulated(study: &Study, until: f64) -> Json {
    verbs(study).simulate(&MotionRequest::to(until)).expect("a run").json()
}

#[test]
fn events_and_states_agree_with_independent_integrators() {
    let reference = reference();
    let cases = reference["trajectories"].as_array().expect("cases");
    assert_eq!(cases.len(), 12);
    for case in cases {
        let name = case["name"].as_str().expect("a name");
        let run = simulated(&study(case["study"].as_str().expect("text")), number(&case["until"]));
        let events = run["events"].as_array().expect("events");
        assert_eq!(
            events.len() as u64,
            case["n_events"].as_u64().expect("a count"),
            "{name}: {run}"
        );
        let state = |moment: &Json| [0, 1].map(|place| number(&moment["state"][place]));
        let agree = |[x, v]: [f64; 2], expected: &Json| {
            let scale = 1.0_f64.max(number(&expected["displacement"]).abs());
            (x - number(&expected["displacement"])).abs() < 1e-9 * scale
                && (v - number(&expected["velocity"])).abs() < 1e-9 * scale
        };
        for (event, expected) in events.iter().zip(case["events"].as_array().expect("events")) {
            assert_eq!(event["kind"], expected["kind"], "{name}: {event} {expected}");
            assert_eq!(event["slip_sign"], expected["slip_sign"], "{name}: {event} {expected}");
            let late = number(&event["time"]) - number(&expected["time"]);
            assert!(late.abs() < 1e-9, "{name}: {event} {expected}");
            assert!(agree(state(event), expected), "{name}: {event} {expected}");
        }
        assert!(
            agree(state(&run["final"]), &case["final"]),
            "{name}: {} {}",
            run["final"],
            case["final"]
        );
    }
}

#[test]
fn the_study_of_a_moment_is_the_steady_one() {
    for case in reference()["at_time"].as_array().expect("cases") {
        let [profile, steady] =
            ["profile", "steady"].map(|name| study(case[name].as_str().expect("text")));
        let at = profile.at_time(number(&case["time"])).expect("a moment");
        assert_eq!(at.belt().expect("a belt").belt(), steady.belt().expect("a belt").belt());
        let growth =
            |study: &Study| verbs(study).stability().expect("an answer").json()["sentence"].clone();
        assert_eq!(growth(&at), growth(&steady));
    }
    // Load and amplitude of a moment, and a system.
    let belt = study(
        "[belt]\ndamping_ratio = 0.1\nbelt_velocity = 0.3\n[belt.load]\ntime = [0, 10]\nload = [1, 3]\nshape = \"smooth\"\n\
         [friction]\nlaw = \"coulomb\"\ncoefficient = 0.3\n[dither]\ndirection = \"tangential\"\nwaveform = \"sine\"\n\
         amplitude = 4\nfrequency_ratio = 10\n[dither.envelope]\ntime = [0, 20]\nshare = [0, 1]\n",
    );
    let at = belt.at_time(5.0).expect("a moment").belt().expect("a belt");
    assert!((at.belt().normal_load() - 2.0).abs() < 1e-15);
    assert_eq!(at.belt().dithers()[0].amplitude, 1.0);
    // A belt that moves backwards then is refused by the key of its drive.
    let reversing = study(
        "[belt]\ndamping_ratio = 0.1\nnormal_load = 1\n[belt.drive]\ntime = [0, 10]\nvelocity = [0.3, -0.3]\n\
         [friction]\nlaw = \"coulomb\"\ncoefficient = 0.3\n",
    );
    assert!(reversing.at_time(4.0).is_ok());
    let why = reversing.at_time(8.0).expect_err("backwards").to_string();
    assert!(why.contains("belt.drive") && why.contains("[system]"), "{why}");
    let system = study(
        "[system]\ncoordinates = [\"x\"]\nmass = [1]\nstiffness = [1]\n[[contact]]\ntangent = { x = 1 }\nnormal_load = 1\n\
         belt_velocity = 0.5\n[contact.drive]\noscillation = { amplitude = 0.2, frequency = 3, phase = 1 }\n\
         [contact.friction]\nlaw = \"coulomb\"\ncoefficient = 0.3\n",
    );
    assert_eq!(system.varies_by(), Some("contact.drive"));
    let at = system.at_time(2.0).expect("a moment").system();
    let velocity = at.system().contacts[0].surface_velocity.mean();
    assert!((velocity - (0.5 + 0.2 * libm::sin(7.0))).abs() < 1e-15);
}

/// A belt in SI has the motion of the same belt in numbers of the equations.
#[test]
fn keys_in_si_give_the_same_run() {
    let law = "[friction]\nlaw = \"coulomb\"\ncoefficient = 0.3\n";
    let plain = format!(
        "[belt]\ndamping_ratio = 0.05\n[belt.drive]\ntime = [0, 10, 40]\nvelocity = [0.2, 0.2, 0.1]\n[belt.load]\n\
         time = [0, 20]\nload = [1, 2]\n{law}"
    );
    // m = 4 kg, k = 100 N/m: ω₀ = 5 rad/s.
    let si = format!(
        "[belt]\nmass_kg = 4\nstiffness_n_per_m = 100\ndamping_n_s_per_m = 2\n[belt.drive]\ntime_s = [0, 2, 8]\n\
         velocity_m_per_s = [1, 1, 0.5]\n[belt.load]\ntime_s = [0, 4]\nload_n = [100, 200]\n{law}"
    );
    let plain = simulated(&study(&plain), 60.0);
    let si = simulated(&study(&si), 60.0 / 5.0);
    assert_eq!(plain["event_count"], si["event_count"]);
    for (a, b) in plain["events"]
        .as_array()
        .expect("events")
        .iter()
        .zip(si["events"].as_array().expect("events"))
    {
        assert!((number(&a["time"]) / 5.0 - number(&b["time"])).abs() < 1e-11, "{a} {b}");
    }
}

#[test]
fn wrong_tables_are_named_with_their_place() {
    let belt = |keys: &str| {
        format!(
            "[belt]\ndamping_ratio = 0.1\nnormal_load = 1\n{keys}\n[friction]\nlaw = \"coulomb\"\ncoefficient = 0.3\n"
        )
    };
    for (keys, key, why) in [
        (
            "belt_velocity = 1\n[belt.drive]\ntime = [0]\nvelocity = [1]",
            "belt.belt_velocity",
            "left out",
        ),
        (
            "[belt.drive]\ntime = [0, 2, 1]\nvelocity = [1, 1, 1]",
            "belt.drive.time[2]",
            "time does not go back",
        ),
        (
            "[belt.drive]\ntime = [0, 1, 1]\nvelocity = [1, 1, 2]",
            "belt.drive.time[2]",
            "cannot jump",
        ),
        (
            "[belt.drive]\ntime = [0, 1]\nvelocity = [1]",
            "belt.drive.velocity",
            "one value for each",
        ),
        ("[belt.drive]\ntime = []\nvelocity = []", "belt.drive.time", "a list of 1"),
        ("[belt.drive]\ntime = [0, 1]", "belt.drive.velocity", "lists of equal length"),
        (
            "[belt.drive]\ntime = [0]\nvelocity = [1]\nshape = \"round\"",
            "belt.drive.shape",
            "linear",
        ),
        ("[belt.drive]\ntime_s = [0]\nvelocity = [1]", "belt.drive.time_s", "dimensionless"),
        ("[belt.drive]\nspeed = [1]", "belt.drive.speed", "velocity"),
        ("[belt.drive]\nfile = \"nowhere.csv\"", "belt.drive.file", "cannot be read"),
        (
            "[belt.drive]\noscillation = { amplitude = 1, frequency_ratio = 2 }",
            "belt.belt_velocity",
            "belt velocity",
        ),
        (
            "belt_velocity = 1\n[belt.drive]\noscillation = { amplitude = 1 }",
            "belt.drive.oscillation.frequency",
            "",
        ),
        (
            "belt_velocity = 1\n[belt.drive]\noscillation = { amplitude = 1, speed = 2 }",
            "belt.drive.oscillation.speed",
            "",
        ),
        (
            "belt_velocity = 1\n[belt.load]\noscillation = { amplitude = 1, frequency_ratio = 2 }",
            "belt.load",
            "stays greater than 0",
        ),
    ] {
        let complaints = refused(&belt(keys));
        assert!(complaints.contains(key) && complaints.contains(why), "{keys}: {complaints}");
    }
    let load =
        |load: &str| belt(&format!("belt_velocity = 1\n{load}")).replace("normal_load = 1\n", "");
    for (keys, key, why) in [
        ("[belt.load]\ntime = [0, 1]\nload = [1, 0]", "belt.load.load[1]", "> 0"),
        (
            "normal_load = 1\n[dither]\ndirection = \"tangential\"\nwaveform = \"sine\"\namplitude = 0.7\nfrequency_ratio = 9\n\
             [dither.envelope]\ntime = [0, 1]\nshare = [1, -1]",
            "dither.envelope.share[1]",
            "≥ 0",
        ),
        (
            "[belt.load]\ntime = [0, 1]\nload = [1, 0.5]\n[dither]\ndirection = \"normal\"\nwaveform = \"sine\"\namplitude = 0.7\n\
             frequency_ratio = 9",
            "dither.amplitude",
            "apart",
        ),
    ] {
        let complaints = refused(&load(keys));
        assert!(complaints.contains(key) && complaints.contains(why), "{keys}: {complaints}");
    }
}

#[test]
fn questions_about_a_steady_study_are_refused_by_name() {
    let study = study(
        "[belt]\ndamping_ratio = 0.1\nnormal_load = 1\n[belt.drive]\ntime = [0, 9]\nvelocity = [1, 0.5]\n[friction]\n\
         law = \"coulomb\"\ncoefficient = 0.3\n[[sweep]]\nparameter = \"belt.normal_load\"\nfrom = 1\nto = 2\npoints = 3\n",
    );
    let verbs = verbs(&study);
    for reply in [
        verbs.stability(),
        verbs.response(&ResponseRequest::default()),
        verbs.friction(None, false),
    ] {
        let why = format!("{:?}", reply.map(|_| ()).expect_err("a refusal"));
        assert!(why.contains("belt.drive") && why.contains("--at-time"), "{why}");
    }
    let verdict = quell::sweep::MapQuantity::named("verdict", "--quantity").expect("a quantity");
    let why = quell::sweep::Plan::new(&study, &[verdict]).map(|_| ()).expect_err("a refusal");
    assert!(why.to_string().contains("belt.drive"), "{why}");
}

/// A window warns of slip beyond the range of the law, as the whole run does.
#[test]
fn a_window_warns_as_the_run_does() {
    let study = study(
        "[belt]\ndamping_ratio = 0.005\nnormal_load = 1\n[belt.drive]\ntime = [0, 50]\nvelocity = [0.3, 0.4]\n[friction]\n\
         law = \"stribeck\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n",
    );
    let run = simulated(&study, 50.0);
    let window =
        verbs(&study).response(&within(RealInterval::new(40.0, 50.0))).expect("a window").json();
    for answer in [run, window] {
        let warnings = answer["warnings"].to_string();
        assert!(warnings.contains("0.3464"), "{warnings}");
    }
}

/// A window of an elastic slider that begins in steady sliding stays there, as the whole run does.
#[test]
fn a_window_begins_as_the_run_does() {
    let study = study(
        "[belt]\ndamping_ratio = 0.05\nnormal_load = 1\nbelt_velocity = 0.1\ntangential_stiffness = 20\n[belt.initial]\n\
         state = \"sliding\"\n[friction]\nlaw = \"coulomb\"\ncoefficient = 0.3\n",
    );
    assert_eq!(simulated(&study, 20.0)["event_count"], 0);
    let window =
        verbs(&study).response(&within(RealInterval::new(0.0, 20.0))).expect("a window").json();
    assert!(number(&window["amplitude"]) < 1e-12, "{window}");
    assert!((number(&window["mean"]) - 0.3).abs() < 1e-12, "{window}");
}

/// A slow mass that nothing moves changes no interval of vibration, however little of its period the run contains.
#[test]
fn intervals_of_short_runs_are_judged_by_an_oscillation_that_they_contain() {
    let run = |coordinates: &str, numbers: &str| {
        let text = format!(
            "[system]\ncoordinates = [{coordinates}]\n{numbers}[[contact]]\ntangent = {{ mass = 1 }}\nnormal_load = 1\n\
             [contact.drive]\ntime = [0, 60, 150]\nvelocity = [0.1, 0.1, 0.4]\n[contact.friction]\nlaw = \"stribeck\"\n\
             static_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n"
        );
        simulated(&study(&text), 150.0)["manoeuvre"].clone()
    };
    let alone = run("\"mass\"", "mass = [1]\ndamping = [0.01]\nstiffness = [1]\n");
    let beside = run(
        "\"mass\", \"aside\"",
        "mass = [1, 1]\ndamping = [[0.01, 0], [0, 0.0002]]\nstiffness = [[1, 0], [0, 0.0004]]\n",
    );
    let vibration = alone["vibration"].as_array().expect("intervals");
    assert!(vibration.len() == 1 && number(&vibration[0]["to"]) < 120.0, "{alone}");
    assert_eq!(alone, beside);
}

/// The request of a window.
fn within(window: RealInterval) -> ResponseRequest {
    ResponseRequest { window: Some(window), ..ResponseRequest::default() }
}
