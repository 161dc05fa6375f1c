//! The motion of systems against numbers computed by independent programs.

use std::fs;
use std::path::Path;

use quell_dynamics::motion::orbit::{
    MotionOrbit, base_motion, free_cycle, motion_thresholds, settled,
};
use quell_dynamics::motion::{
    ContactPhase, Exponent, MOTION_TOLERANCE, Motion, MotionEnd, MotionRecorder, MotionStart,
    RecordedEvent,
};
use quell_study::study::system::{SystemStart, SystemStudy};
use serde_json::Value as Json;

/// Accuracy of event times and states.
const ACCURACY: f64 = 1e-9;

fn reference() -> Json {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../reference/motion.json");
    serde_json::from_str(&fs::read_to_string(path).expect("a file")).expect("JSON")
}

fn study(text: &str) -> SystemStudy {
    SystemStudy::parse(text, &[]).unwrap_or_else(|errors| panic!("{errors}"))
}

fn number(value: &Json) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

fn list(value: &Json) -> &[Json] {
    value.as_array().map_or(&[], Vec::as_slice)
}

fn moved(text: &str, until: f64) -> (MotionEnd, Vec<RecordedEvent>) {
    let study = study(text);
    let motion = Motion::new(study.system()).unwrap_or_else(|why| panic!("{why}"));
    let state = match study.initial() {
        SystemStart::Values(values) => values.clone(),
        _ => vec![0.0; motion.size()],
    };
    let mut recorder = MotionRecorder::default();
    let start = MotionStart { time: 0.0, state };
    let end = motion.run(&start, until, MOTION_TOLERANCE, &mut recorder);
    (end.unwrap_or_else(|why| panic!("{why}")), recorder.events)
}

/// Largest difference of two states.
fn distance(found: &[f64], wanted: &Json) -> f64 {
    assert_eq!(found.len(), list(wanted).len());
    found.iter().zip(list(wanted)).fold(0.0, |m: f64, (a, b)| m.max((a - number(b)).abs()))
}

/// Compares the events listed and the final state; returns the largest error of a time and of a state.
fn compared(name: &str, case: &Json) -> (f64, f64) {
    let text = case["study"].as_str().expect("a study");
    let (end, events) = moved(text, number(&case["until"]));
    let mut errors = (0.0_f64, 0.0_f64);
    for (place, wanted) in list(&case["events"]).iter().enumerate() {
        let found = events.get(place).unwrap_or_else(|| panic!("{name}: event {place} is missing"));
        let context = format!("{name}, event {place}: {found:?} {wanted}");
        assert_eq!(found.kind.name(), wanted["kind"], "{context}");
        assert_eq!(Some(found.contact as u64), wanted["contact"].as_u64(), "{context}");
        assert_eq!(Some(i64::from(found.slip_sign)), wanted["slip_sign"].as_i64(), "{context}");
        let time = (found.time - number(&wanted["time"])).abs();
        assert!(time <= ACCURACY, "{context}: time off by {time:e}");
        errors.0 = errors.0.max(time);
        if let Some(displacement) = wanted["displacement"].as_f64() {
            errors.1 = errors.1.max((found.state[0] - displacement).abs());
        } else {
            errors.1 = errors.1.max(distance(&found.state, &wanted["state"]));
        }
    }
    assert_eq!(Some(events.len() as u64), case["n_events"].as_u64(), "{name}: number of events");
    errors.1 = errors.1.max(distance(&end.state, &case["final"]["state"]));
    assert!(errors.1 <= ACCURACY, "{name}: state off by {:e}", errors.1);
    for (found, wanted) in end.contacts.iter().zip(list(&case["final"]["contacts"])) {
        let close = |a: f64, b: &Json| (a - number(b)).abs() <= ACCURACY;
        assert!(close(found.slip_velocity, &wanted["slip_velocity"]), "{name}: {found:?}");
        assert!(close(found.friction, &wanted["friction"]), "{name}: {found:?} {wanted}");
        assert!(close(found.normal_load, &wanted["normal"]), "{name}: {found:?} {wanted}");
        assert_eq!(found.phase == ContactPhase::Stick, wanted["sticking"], "{name}");
        assert_eq!(found.phase == ContactPhase::Open, wanted["open"], "{name}");
    }
    errors
}

#[test]
fn trajectories_are_those_of_the_reference() {
    let reference = reference();
    let selection = list(&reference["selection"]["trajectories"]).iter();
    let belts = list(&reference["belts"]).iter();
    for case in list(&reference["trajectories"]).iter().chain(selection).chain(belts) {
        let name = case["name"].as_str().expect("a name");
        let (time, state) = compared(name, case);
        println!("{name}: times within {time:.1e}, states within {state:.1e}");
    }
}

/// Two pads on one rigid body move like one pad that bears the sum of their loads, and list every event twice.
#[test]
fn dependent_contacts_move_as_one() {
    let reference = reference();
    let case = &reference["dependent_rows"];
    let (end, events) = moved(case["study"].as_str().expect("a study"), number(&case["until"]));
    let times = list(&case["event_times"]);
    assert_eq!(events.len(), 2 * times.len());
    for (place, (pair, wanted)) in events.chunks(2).zip(times).enumerate() {
        assert_eq!((pair[0].contact, pair[1].contact), (0, 1));
        assert_eq!((pair[0].kind, pair[0].time), (pair[1].kind, pair[1].time));
        assert_eq!(pair[0].kind.name(), case["kinds"][place]);
        let error = (pair[0].time - number(wanted)).abs();
        assert!(error <= ACCURACY, "event {place}: {error:e}");
    }
    assert!(distance(&end.state, &case["final_state"]) <= ACCURACY);
}

fn complex(value: &Json) -> (f64, f64) {
    (number(&value[0]), number(&value[1]))
}

/// Every multiplier of the reference is among those found.
fn same_multipliers(name: &str, orbit: &MotionOrbit, wanted: &Json) -> f64 {
    assert_eq!(orbit.multipliers.len(), list(wanted).len(), "{name}");
    let nearest = |wanted: &Json| {
        let (re, im) = complex(wanted);
        let off = orbit.multipliers.iter().map(|z| (z.re - re).hypot(z.im - im));
        off.fold(f64::INFINITY, f64::min)
    };
    let worst = list(wanted).iter().map(nearest).fold(0.0, f64::max);
    assert!(worst <= 1e-8, "{name}: multipliers off by {worst:e}: {:?}", orbit.multipliers);
    worst
}

fn same_events(name: &str, found: &[RecordedEvent], wanted: &Json) {
    assert_eq!(found.len(), list(wanted).len(), "{name}: {found:?}");
    for (found, wanted) in found.iter().zip(list(wanted)) {
        let is_same = found.kind.name() == wanted["kind"]
            && Some(found.contact as u64) == wanted["contact"].as_u64()
            && Some(i64::from(found.slip_sign)) == wanted["slip_sign"].as_i64();
        let off = (found.time - number(&wanted["time"])).abs();
        assert!(is_same && off <= ACCURACY, "{name}: {found:?} {wanted}");
    }
}

#[test]
fn orbits_and_multipliers_are_those_of_the_reference() {
    for case in list(&reference()["orbits"]) {
        let name = case["name"].as_str().expect("a name");
        let study = study(case["study"].as_str().expect("a study"));
        let base = base_motion(study.system(), 8);
        if let Err(why) = &base {
            println!("{name}: base: {why}");
        }
        let orbit = base.or_else(|_| {
            settled(study.system(), &vec![0.0; study.system().structure.state_size()], 4000)
                .map(|s| s.orbit)
        });
        let orbit = orbit.unwrap_or_else(|why| panic!("{name}: {why}"));
        let state = distance(&orbit.state, &case["state"]);
        println!("{name}: state {state:.1e} residual {:.1e} {:?}", orbit.residual, orbit.verdict());
        assert!(state <= ACCURACY, "{name}: {state:e}");
        same_events(name, &orbit.events, &case["events"]);
        let worst = same_multipliers(name, &orbit, &case["multipliers"]);
        println!("{name}: multipliers within {worst:.1e}");
        assert_eq!(orbit.verdict().name(), case["verdict"], "{name}");
    }
}

#[test]
fn limit_cycles_are_those_of_the_reference() {
    for case in list(&reference()["limit_cycles"]) {
        let name = case["name"].as_str().expect("a name");
        let study = study(case["study"].as_str().expect("a study"));
        let state = match study.initial() {
            SystemStart::Values(values) => values.clone(),
            _ => vec![0.0; study.system().structure.state_size()],
        };
        let cycle =
            free_cycle(study.system(), &state).unwrap_or_else(|why| panic!("{name}: {why}"));
        let off = (cycle.period - number(&case["period"])).abs();
        println!("{name}: period off by {off:.1e}, residual {:.1e}", cycle.residual);
        assert!(off <= ACCURACY, "{name}: {off:e}");
        same_events(name, &cycle.events, &case["events"]);
        let worst = same_multipliers(name, &cycle, &case["multipliers"]);
        println!("{name}: multipliers within {worst:.1e}");
        assert!((cycle.radius() - number(&case["second_multiplier"])).abs() <= 1e-8);
        assert_eq!(cycle.verdict().name(), case["verdict"], "{name}");
    }
}

#[test]
fn thresholds_are_those_of_the_reference() {
    for case in list(&reference()["thresholds"]) {
        let name = case["name"].as_str().expect("a name");
        let study = study(case["study"].as_str().expect("a study"));
        let path = case["parameter"].as_str().expect("a path");
        let at =
            |values: &[f64]| study.system_at(&[(path, values[0])]).map_err(|why| why.to_string());
        let window = (number(&case["from"]), number(&case["to"]));
        let found = motion_thresholds(&at, window, 8, None);
        let found = found.unwrap_or_else(|why| panic!("{name}: {why}"));
        println!("{name}: {:?} {:?}", found.thresholds, found.ending);
        let wanted = number(&case["value"]);
        let off = |value: f64| (value - wanted).abs() / wanted;
        let threshold = found
            .thresholds
            .iter()
            .min_by(|a, b| off(a.value).total_cmp(&off(b.value)))
            .unwrap_or_else(|| panic!("{name}: no threshold"));
        println!("{name}: off by {:.1e}", off(threshold.value));
        assert!(off(threshold.value) <= 1e-6, "{name}: {threshold:?}");
        assert_eq!(threshold.kind.name(), case["kind"], "{name}");
        assert_eq!(threshold.becomes.map(|v| v.name()), case["becomes"].as_str(), "{name}");
    }
}

/// The exponents of a periodic motion are the logarithms of its multipliers over its period; one that a stick erases is −∞.
#[test]
fn lyapunov_exponents_of_periodic_motions_are_those_of_their_multipliers() {
    for case in list(&reference()["orbits"]) {
        let name = case["name"].as_str().expect("a name");
        if case["verdict"] != "stable" {
            continue;
        }
        let study = study(case["study"].as_str().expect("a study"));
        let motion = Motion::new(study.system()).expect("movable");
        let state: Vec<f64> = list(&case["state"]).iter().map(number).collect();
        let period = number(&case["period"]);
        let start = MotionStart { time: 0.0, state };
        let periods = 400.0;
        let found = motion.lyapunov_exponents(&start, periods * period, motion.size());
        let found = found.unwrap_or_else(|why| panic!("{name}: {why}"));
        let sizes = list(&case["multipliers"]).iter().map(|z| number(&z[0]).hypot(number(&z[1])));
        let mut rates: Vec<f64> = sizes.map(|size| size.ln() / period).collect();
        rates.sort_by(|a, b| b.total_cmp(a));
        for (exponent, wanted) in found.exponents.iter().zip(rates) {
            match exponent {
                Exponent::Erased => assert!(wanted == f64::NEG_INFINITY, "{name}: {wanted}"),
                Exponent::Rate { value, error } => {
                    let off = (value - wanted).abs();
                    println!("{name}: {value} {wanted} ±{error:.1e}");
                    assert!(
                        off < 5.0 / (periods * period) + 3.0 * error,
                        "{name}: {value} {wanted}"
                    );
                }
            }
        }
    }
}
