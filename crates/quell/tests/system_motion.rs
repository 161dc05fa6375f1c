//! The verbs of systems that follow periodic motions, through the front door, against numbers computed by independent programs.

use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use quell::Study;
use quell::run::basins::{BasinsRequest, StartLayout, read_plane};
use quell::run::bifurcation::SweepRequest;
use quell::run::orbit::Wanted;
use quell::run::protocol::{Protocol, read_state_of};
use quell::run::thresholds::ThresholdsRequest;
use quell::run::varied::Range;
use quell::running::Running;
use quell::verbs::verbs;
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

/// Accuracy of states and event times.
const ACCURACY: f64 = 1e-9;

/// Accuracy of multipliers.
const OF_MULTIPLIERS: f64 = 1e-8;

fn reference() -> Json {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../reference/motion.json");
    serde_json::from_str(&fs::read_to_string(path).expect("a file")).expect("JSON")
}

fn study(text: &str) -> Study {
    Study::parse(text, &[]).unwrap_or_else(|errors| panic!("{errors}"))
}

fn number(value: &Json) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

fn list(value: &Json) -> &[Json] {
    value.as_array().map_or(&[], Vec::as_slice)
}

fn named<'a>(cases: &'a Json, name: &str) -> &'a Json {
    let found = list(cases).iter().find(|case| case["name"].as_str() == Some(name));
    found.unwrap_or_else(|| panic!("no case {name}"))
}

fn orbit(text: &str, wanted: &Wanted) -> Json {
    let answer = verbs(&study(text)).orbit(wanted);
    answer.unwrap_or_else(|why| panic!("{why:?}")).json()
}

/// Largest difference of two lists of numbers.
fn distance(found: &Json, wanted: &Json) -> f64 {
    assert_eq!(list(found).len(), list(wanted).len(), "{found} {wanted}");
    let pairs = list(found).iter().zip(list(wanted));
    pairs.fold(0.0, |most: f64, (a, b)| most.max((number(a) - number(b)).abs()))
}

/// Every multiplier of the reference is among those found.
fn same_multipliers(name: &str, found: &Json, wanted: &Json) {
    assert_eq!(list(found).len(), list(wanted).len(), "{name}");
    for wanted in list(wanted) {
        let nearest = list(found).iter().map(|found| distance(found, wanted));
        let off = nearest.fold(f64::INFINITY, f64::min);
        assert!(off <= OF_MULTIPLIERS, "{name}: {wanted} is off by {off:e}: {found}");
    }
}

fn same_events(name: &str, found: &Json, wanted: &Json) {
    assert_eq!(list(found).len(), list(wanted).len(), "{name}: {found}");
    for (found, wanted) in list(found).iter().zip(list(wanted)) {
        for key in ["contact", "kind", "slip_sign"] {
            assert_eq!(found[key], wanted[key], "{name}: {found} {wanted}");
        }
        let off = (number(&found["time"]) - number(&wanted["time"])).abs();
        assert!(off <= ACCURACY, "{name}: {found} {wanted}");
        if !wanted["state"].is_null() {
            assert!(distance(&found["state"], &wanted["state"]) <= ACCURACY, "{name}: {found}");
        }
    }
}

#[test]
fn orbits_of_dithered_systems_are_those_of_the_reference() {
    for case in list(&reference()["orbits"]) {
        let name = case["name"].as_str().expect("a name");
        let found = orbit(case["study"].as_str().expect("a study"), &Wanted::default());
        println!("{name}: {}", found["sentence"]);
        assert!((number(&found["period"]) - number(&case["period"])).abs() <= ACCURACY);
        let off = distance(&found["state"], &case["state"]);
        assert!(off <= ACCURACY, "{name}: {off:e}");
        same_events(name, &found["events"], &case["events"]);
        same_multipliers(name, &found["multipliers"], &case["multipliers"]);
        assert_eq!(found["verdict"], case["verdict"], "{name}");
        assert!((number(&found["radius"]) - number(&case["largest"])).abs() <= OF_MULTIPLIERS);
        assert!(number(&found["residual"]) <= ACCURACY, "{name}");
    }
}

#[test]
fn limit_cycles_are_those_of_the_reference() {
    for case in list(&reference()["limit_cycles"]) {
        let name = case["name"].as_str().expect("a name");
        let found = orbit(case["study"].as_str().expect("a study"), &Wanted::default());
        println!("{name}: {}", found["sentence"]);
        assert_eq!(found["free_phase"], true, "{name}");
        assert!((number(&found["period"]) - number(&case["period"])).abs() <= ACCURACY, "{name}");
        same_events(name, &found["events"], &case["events"]);
        same_multipliers(name, &found["multipliers"], &case["multipliers"]);
        assert!((number(&found["radius"]) - number(&case["second_multiplier"])).abs() <= 1e-8);
        assert_eq!(found["verdict"], case["verdict"], "{name}");
        assert_eq!(list(&found["state"]).len(), list(&found["state_names"]).len(), "{name}");
    }
}

/// Stable steady sliding of a damped mass on a belt has no limit cycle: the answer says what was tried.
#[test]
fn a_system_without_a_cycle_says_what_was_tried() {
    let one = "schema = 1\n[system]\ncoordinates = [\"x\"]\nmass = [1.0]\ndamping = [[0.2]]\nstiffness = [[1.0]]\n\
        [[contact]]\nname = \"pad\"\ntangent = { x = 1.0 }\nnormal_load = 1.0\nbelt_velocity = 0.1\n\
        [contact.friction]\nlaw = \"coulomb\"\ncoefficient = 0.3\n";
    // Of one mass all cycles are known.
    let found = orbit(one, &Wanted::default());
    assert_eq!((&found["cycles"], &found["verdict"]), (&Json::Array(Vec::new()), &"stable".into()));
    let two = one
        .replace("[\"x\"]\nmass = [1.0]", "[\"x\", \"y\"]\nmass = [1.0, 1.0]")
        .replace("damping = [[0.2]]", "damping = [[0.2, 0.0], [0.0, 0.2]]")
        .replace("stiffness = [[1.0]]", "stiffness = [[1.0, 0.0], [0.0, 1.0]]");
    let found = orbit(&two, &Wanted::default());
    assert!(found["period"].is_null() && found["why"]["period"].is_string(), "{found}");
    assert_eq!(found["verdict"], "stable");
    assert!(found["cycles"].is_null() && found["why"]["cycles"].is_string(), "{found}");
    assert!(list(&found["tried"]).len() >= 3, "{found}");
    assert!(
        found["sentence"].as_str().is_some_and(
            |text| text.contains("no limit cycle") || text.starts_with("No limit cycle")
        )
    );
}

/// A dithered run settles on the orbit near which shooting finds it, and starts of other names are rejected.
#[test]
fn runs_and_shooting_find_the_same_orbit() {
    let reference = reference();
    let case = list(&reference["orbits"]).iter().find(|case| case["verdict"] == "stable");
    let text = case.expect("a stable orbit")["study"].as_str().expect("a study");
    let rest = orbit(text, &Wanted::After(Protocol::Rest));
    assert_eq!(rest["response"], "reached");
    let system = study(text).system();
    let names = list(&rest["state_names"]).iter().zip(list(&rest["state"]));
    let state: Vec<String> = names
        .map(|(name, value)| {
            format!("{}={}", name.as_str().unwrap_or_default(), number(value) + 1e-4)
        })
        .collect();
    let state = read_state_of(&system, "--near", &state.join(",")).expect("a state");
    let near = orbit(text, &Wanted::Near { state, periods: 1 });
    assert!(distance(&near["state"], &rest["state"]) <= ACCURACY);
    let wrong = read_state_of(&system, "--near", "nothing=1").expect_err("no such name");
    assert!(wrong.iter().all(|complaint| complaint.key == "--near"));
}

#[test]
fn a_study_can_start_on_its_limit_cycle() {
    let reference = reference();
    let case = named(&reference["limit_cycles"], "two blocks, static level");
    let text = case["study"].as_str().expect("a study").replace(
        "[system.initial]\ndisplacements = { b1 = 0.1, b2 = -0.05 }",
        "[system.initial]\nstate = \"squealing\"",
    );
    let found = orbit(&text, &Wanted::default());
    assert!((number(&found["period"]) - number(&case["period"])).abs() <= ACCURACY, "{found}");
}

fn thresholds(text: &str, request: &ThresholdsRequest) -> Json {
    let answer = verbs(&study(text)).thresholds(request);
    answer.unwrap_or_else(|why| panic!("{why:?}")).json()
}

fn request_of(case: &Json) -> ThresholdsRequest {
    ThresholdsRequest {
        parameter: case["parameter"].as_str().expect("a path").to_owned(),
        window: RealInterval::new(number(&case["from"]), number(&case["to"])),
        ..ThresholdsRequest::default()
    }
}

#[test]
fn thresholds_of_dithered_systems_are_those_of_the_reference() {
    for case in list(&reference()["thresholds"]) {
        let name = case["name"].as_str().expect("a name");
        let found = thresholds(case["study"].as_str().expect("a study"), &request_of(case));
        println!("{name}: {}", found["sentence"]);
        let wanted = number(&case["value"]);
        let off = |found: &&Json| (number(&found["value"]) - wanted).abs() / wanted;
        let threshold = list(&found["local"]).iter().min_by(|a, b| off(a).total_cmp(&off(b)));
        let threshold = threshold.unwrap_or_else(|| panic!("{name}: no threshold"));
        assert!(off(&threshold) <= 1e-6, "{name}: {threshold}");
        assert_eq!(threshold["kind"], case["kind"], "{name}");
        assert_eq!(threshold["becomes"], case["becomes"], "{name}");
        let grazes = ["grazing", "separation"].iter().any(|kind| threshold["kind"] == *kind);
        assert_eq!(threshold["contacts"].is_array(), grazes, "{name}: {threshold}");
        assert_eq!(threshold["opens_towards"].is_string(), threshold["kind"] == "fold", "{name}");
        assert_eq!(found["ending"] == "covered", found["covered"] == true, "{name}");
    }
}

/// The threshold of a run from rest is that of the orbit on which it ends, and `dither.amplitude` names the only dither.
#[test]
fn runs_change_where_their_orbit_does() {
    let reference = reference();
    let case = &reference["thresholds"][0];
    let request = ThresholdsRequest {
        parameter: "dither.amplitude".to_owned(),
        protocols: vec![Protocol::Rest],
        ..request_of(case)
    };
    let found = thresholds(case["study"].as_str().expect("a study"), &request);
    println!("{}", found["sentence"]);
    let changes = list(&found["from_rest"]);
    assert_eq!(found["at_from"]["from_rest"], "not quenched", "{found}");
    let [change] = changes else { panic!("{found}") };
    let off = (number(&change["value"]) - number(&case["value"])).abs() / number(&case["value"]);
    assert!(off <= 1e-5, "{change}");
    assert_eq!(change["becomes"], "quenched");
}

/// Swept up and down, the drive falls into step with the dither at its threshold, and leaves it there.
#[test]
fn sweeps_change_at_the_threshold() {
    let reference = reference();
    let case = &reference["thresholds"][0];
    let range = Range { parameter: "dither.amplitude".into(), from: 5.3, to: 5.5, points: 5 };
    let request = SweepRequest { range, up: false, down: false };
    let stop = AtomicBool::new(false);
    let running = Running { threads: None, stop: &stop, progress: &() };
    let study = study(case["study"].as_str().expect("a study"));
    let found = verbs(&study).bifurcation(&request, running);
    let found = found.unwrap_or_else(|why| panic!("{why:?}")).json();
    println!("{}", found["sentence"]);
    for (point, value) in list(&found["up"]).iter().zip([5.3, 5.35, 5.4, 5.45, 5.5]) {
        // Below the threshold it may lock after many periods or not repeat.
        let kinds: &[&str] = if value > 5.39 { &["period-1"] } else { &["locked", "not-periodic"] };
        assert!(kinds.iter().any(|kind| point["kind"] == *kind), "{point}");
        assert_eq!(point["local_verdict"], if value > 5.39 { "stable" } else { "unstable" });
    }
    let differs = |value: f64| {
        let inside = |range: &Json| number(&range[0]) <= value && value <= number(&range[1]);
        list(&found["hysteresis"]).iter().any(inside)
    };
    let size = |point: &Json| number(&point["peak_to_peak"]);
    for (up, down) in list(&found["up"]).iter().zip(list(&found["down"]).iter().rev()) {
        let ratio = size(up) / size(down);
        assert!(differs(number(&up["value"])) || (0.79..1.27).contains(&ratio), "{up} {down}");
    }
}

fn basins(text: &str, plane: &str, grid: (usize, usize)) -> Json {
    let study = study(text);
    let system = study.system();
    let axes = read_plane(&system, plane).unwrap_or_else(|why| panic!("{why}"));
    let stop = AtomicBool::new(false);
    let running = Running { threads: Some(2), stop: &stop, progress: &() };
    let layout = StartLayout::Grid { columns: grid.0, rows: grid.1 };
    let request = BasinsRequest { axes: Some(axes), layout: Some(layout), over: None };
    let found = verbs(&study).basins(&request, running);
    found.unwrap_or_else(|why| panic!("{why:?}")).json()
}

/// Beyond the threshold of the drive every start of a plane ends on the base response; without dither on its limit cycle.
#[test]
fn starts_of_a_plane_end_on_their_motions() {
    let reference = reference();
    let case = list(&reference["orbits"])
        .iter()
        .find(|case| case["name"].as_str().is_some_and(|name| name.starts_with("drive 8")));
    let text = case.expect("the drive")["study"].as_str().expect("a study");
    let found = basins(text, "carriage=0.2:0.6,velocity.carriage=-0.5:0.5", (4, 3));
    println!("{}", found["sentence"]);
    assert_eq!(list(&found["ends"]).len(), 12);
    assert_eq!(list(&found["attractors"]).len(), 1, "{found}");
    assert_eq!(found["attractors"][0]["kind"], "period-1");
    assert_eq!(found["quiet_fraction"], 1.0);
    assert_eq!(found["local_verdict"], "stable");
    let free = basins(
        &text.replace("amplitude = 8.0", "amplitude = 0.0"),
        "carriage,velocity.carriage",
        (3, 3),
    );
    println!("{}", free["sentence"]);
}

/// A start whose transient sticks and whose limit cycle does not, because the pad opens, ends on that cycle all the same.
#[test]
fn a_transient_that_sticks_does_not_hide_the_cycle() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/mode-coupling.toml");
    let text = fs::read_to_string(path).expect("a study");
    let found = basins(&text, "x,velocity.x", (4, 3));
    assert_eq!(found["unknown_starts"], 0, "{}", found["sentence"]);
    assert_eq!(found["attractors"][0]["kind"], "limit-cycle");
}
