//! `simulate` of discs: growth as `stability` gives it, limit cycles with separation, and loads that nothing bounds.

use std::path::Path;

use quell::run::disc::{motion, stability};
use quell::run::response::ResponseRequest;
use quell::run::simulate::MotionRequest;
use quell::run::system::start::read_state;
use quell::study::{DiscStudy, Study};
use quell::verbs::verbs;
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

const PLATE: &str = "schema = 1\n[disc]\ninner_radius_ratio = 0.5\n";

/// A disc that squeals without damping of its own.
const SQUEALING: &str =
    "[disc.load]\nradius_ratio = 0.75\nstiffness = 0.1\nfriction = 0.05\nspeed = 0.4\n";

/// A disc whose pad jumps.
const JUMPING: &str = "modal_damping = 0.01\n[disc.load]\nradius_ratio = 0.75\nmass = 0.5\nstiffness = 3\n\
    friction = 0.1\nspeed = 0.0641\n";

/// A disc under a falling friction law, whose slip follows the bending of the disc.
const UNDER_LAW: &str = "modal_damping = 0.001\n[disc.load]\nradius_ratio = 0.75\nmass = 0.5\ndamping = 0.1\n\
    stiffness = 1\nspeed = 0.5\nnormal_load = 0.5\nhalf_thickness = 0.1\n[friction]\nlaw = \"stribeck\"\n\
    static_coefficient = 0.5\nminimum_coefficient = 0.3\nreference_velocity = 0.5\n";

fn study(load: &str) -> DiscStudy {
    let text = format!("{PLATE}{load}");
    DiscStudy::parse_in(&text, &[], Path::new("")).unwrap_or_else(|errors| panic!("{errors:#?}"))
}

fn until(end: f64) -> MotionRequest {
    MotionRequest { until: Some(end), ..MotionRequest::default() }
}

fn simulated(load: &str, end: f64) -> Json {
    let study = study(load);
    motion::run(&study, &until(end)).expect("a motion").json(&study)
}

fn number(json: &Json, name: &str) -> f64 {
    json[name].as_f64().unwrap_or_else(|| panic!("{name} of {json}"))
}

#[test]
fn the_observed_growth_is_that_of_stability() {
    for (load, end) in [(SQUEALING, 300.0), (JUMPING, 1000.0), (UNDER_LAW, 400.0)] {
        let study = study(load);
        let wanted = stability::run(&study).expect("finite").growth.rate;
        let done = motion::run(&study, &until(end)).expect("a motion").json(&study);
        let (observed, leading) =
            (number(&done, "growth_observed"), number(&done, "leading_growth_rate"));
        assert!(wanted > 1e-3, "{wanted}");
        assert!((observed - wanted).abs() < 1e-6, "{observed} {wanted}");
        assert!((leading - wanted).abs() < 1e-10, "{leading} {wanted}");
        assert_eq!(done["event_count"], 0, "{load}");
    }
}

#[test]
fn a_contact_that_opens_bounds_the_motion() {
    for (load, end) in [(JUMPING, 5000.0), (UNDER_LAW, 2040.0)] {
        let (once, twice) = (simulated(load, end), simulated(load, 2.0 * end));
        let (first, second) = (number(&once, "amplitude"), number(&twice, "amplitude"));
        assert!((first / second - 1.0).abs() < 1e-5, "{first} {second}");
        assert!(first > 100.0 * number(&once["start"], "amplitude"), "{first}");
        for json in [&once, &twice] {
            let counts = &json["event_counts"];
            assert!(number(counts, "separation") > 500.0, "{counts}");
            assert!((number(counts, "separation") - number(counts, "landing")).abs() <= 1.0);
        }
    }
    let bounded = simulated(JUMPING, 5000.0);
    assert!(bounded["warnings"].as_array().expect("a list").is_empty(), "{}", bounded["warnings"]);
    assert!((number(&bounded, "amplitude") - 0.695_172).abs() < 1e-5);
}

#[test]
fn what_nothing_bounds_is_named() {
    let prescribed = "[disc.load]\nradius_ratio = 0.75\nfriction = 0.1\nspeed = 0.4\n";
    let done = simulated(prescribed, 100.0);
    assert!(
        done["warnings"].to_string().contains("nothing bounds the growth"),
        "{}",
        done["warnings"]
    );
    let why = motion::run(&study(SQUEALING), &until(900.0)).expect_err("no bound").to_string();
    assert!(why.contains("grows without bound"), "{why}");
    let brief = simulated(SQUEALING, 3.0);
    assert!(brief["growth_observed"].is_null() && brief["why"]["growth_observed"].is_string());
}

#[test]
fn a_patch_opens_point_by_point() {
    let growth =
        |more: &str| number(&simulated(&format!("{SQUEALING}{more}"), 200.0), "growth_observed");
    assert!((growth("extent_deg = 0.1\n") - growth("")).abs() < 1e-6);
    // The points share the load, so that a narrow patch opens as a whole, where the point does.
    let opens = |more: &str| {
        let done = simulated(&format!("{SQUEALING}{more}"), 650.0);
        let events = done["events"].as_array().expect("a list").clone();
        let first = events.into_iter().find(|event| event["kind"] == "separation");
        number(&first.expect("a separation"), "time")
    };
    let (point, patch) = (opens(""), opens("extent_deg = 0.01\n"));
    assert!((point - patch).abs() < 0.01, "{point} {patch}");
}

#[test]
fn names_start_units_and_files() {
    let disc = study(JUMPING);
    let any = Study::from(&disc);
    let system = any.system();
    let start = read_state(&system, "A3=0.001,velocity.B3=0.002").err();
    assert!(start.is_some(), "no such coordinate");
    let start = read_state(&system, "A2=0.001,velocity.B2=0.002").expect("coordinates");
    let request = MotionRequest { start, samples: true, ..until(50.0) };
    let done = verbs(&any).simulate(&request).expect("a motion");
    let json = done.json();
    assert_eq!(json["state_names"].as_array().map(Vec::len), Some(10));
    assert!(json["sentence"].as_str().is_some_and(|text| text.starts_with("From A2 = 0.001")));
    assert_eq!(json["units"]["time"], "1/ω_ref");
    let names: Vec<&str> = done.datasets().iter().map(|(name, _)| *name).collect();
    assert_eq!(names, ["trajectory", "events"]);
    assert!(done.sound().expect("a sound").is_ok() && done.figure().expect("a picture").is_ok());
    let chosen = verbs(&any).simulate(&MotionRequest::default()).expect("a motion").notes();
    assert!(chosen.iter().any(|text| text.contains("--until sets another")), "{chosen:?}");
}

/// What a disc does between two of its times: a growing motion is larger in a later window. It has no steady response.
#[test]
fn a_window_of_a_run() {
    let any = Study::from(&study(JUMPING));
    let within = |window| {
        let request = ResponseRequest { window: Some(window), ..ResponseRequest::default() };
        number(&verbs(&any).response(&request).expect("a window").json(), "amplitude")
    };
    let (early, late) =
        (within(RealInterval::new(0.0, 20.0)), within(RealInterval::new(40.0, 60.0)));
    assert!(early > 0.0 && late != early, "{early} {late}");
    assert!(verbs(&any).response(&ResponseRequest::default()).is_err());
}
