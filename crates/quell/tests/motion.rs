//! The motion of systems against numbers computed by independent programs.

use std::fs;
use std::path::Path;

use quell::Study;
use quell::run::simulate::{self, MotionRequest};
use quell::run::system::start::read_state;
use quell::verbs::verbs;
use quell_dynamics::motion::{
    ContactPhase, LyapunovExponent, MOTION_TOLERANCE, Motion, MotionEnd, MotionRecorder,
    MotionStart, RecordedEvent,
};
use quell_dynamics::orbit::{
    Orbit, OrbitVerdict, base_response, branch_thresholds, free_cycle, settled, settled_many,
};
use quell_model::RefusedNumbers;
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
fn same_multipliers(name: &str, orbit: &Orbit, wanted: &Json) -> f64 {
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
        let base = base_response(study.system(), 8);
        if let Err(why) = &base {
            println!("{name}: base: {why}");
        }
        let orbit = base.or_else(|_| {
            settled(study.system(), &vec![0.0; study.system().structure.state_size()])
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
        let model = study.model();
        let parameter = model.parameter(path).expect("a number of the study");
        let at = |values: &[f64]| {
            model.at(&[(parameter.clone(), values[0])]).map_err(RefusedNumbers::by_study)
        };
        let (from, to) = (number(&case["from"]), number(&case["to"]));
        let found = branch_thresholds(&at, from, to, 8, None);
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
        assert_eq!(threshold.becomes.map(OrbitVerdict::name), case["becomes"].as_str(), "{name}");
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
        let found = motion.lyapunov_exponents(&start, (0.0, periods * period), motion.size());
        let found = found.unwrap_or_else(|why| panic!("{name}: {why}"));
        let sizes = list(&case["multipliers"]).iter().map(|z| number(&z[0]).hypot(number(&z[1])));
        let mut rates: Vec<f64> = sizes.map(|size| size.ln() / period).collect();
        rates.sort_by(|a, b| b.total_cmp(a));
        for (exponent, wanted) in found.exponents.iter().zip(rates) {
            match exponent {
                LyapunovExponent::Erased => {
                    assert!(wanted == f64::NEG_INFINITY, "{name}: {wanted}");
                }
                LyapunovExponent::Rate { value, error } => {
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

/// The `simulate` verb reports the same events and the same end, under the published names.
#[test]
fn simulations_have_the_numbers_of_the_reference() {
    let reference = reference();
    for case in list(&reference["trajectories"]) {
        let name = case["name"].as_str().expect("a name");
        let study = Study::from(&study(case["study"].as_str().expect("a study")));
        let until = Some(number(&case["until"]));
        let request = MotionRequest { until, samples: true, ..MotionRequest::default() };
        let done = verbs(&study).simulate(&request).unwrap_or_else(|why| panic!("{why}"));
        let found = done.json();
        for (found, wanted) in list(&found["events"]).iter().zip(list(&case["events"])) {
            for key in ["contact", "kind", "slip_sign"] {
                assert_eq!(found[key], wanted[key], "{name}: {found} {wanted}");
            }
            assert!((number(&found["time"]) - number(&wanted["time"])).abs() <= ACCURACY, "{name}");
        }
        assert_eq!(found["event_count"], case["n_events"], "{name}");
        if case["event_counts"].is_object() {
            assert_eq!(found["event_counts"], case["event_counts"], "{name}");
        }
        let end = &found["final"];
        let state: Vec<f64> = list(&end["state"]).iter().map(number).collect();
        assert!(distance(&state, &case["final"]["state"]) <= ACCURACY, "{name}");
        for (found, wanted) in list(&end["contacts"]).iter().zip(list(&case["final"]["contacts"])) {
            for (key, wanted) in wanted.as_object().expect("an object") {
                match wanted.as_f64() {
                    Some(wanted) if key != "slip_sign" => {
                        assert!((number(&found[key]) - wanted).abs() <= ACCURACY, "{name}: {key}");
                    }
                    _ => assert_eq!(&found[key], wanted, "{name}: {key}"),
                }
            }
        }
        let datasets = done.datasets();
        assert_eq!(datasets[0].1.axes()[0].values.last(), Some(&number(&case["until"])), "{name}");
        assert_eq!(datasets[1].1.axes()[0].values.len(), list(&found["events"]).len());
        let figure = done.figure().expect("a picture").unwrap_or_else(|why| panic!("{why}"));
        assert!(figure.to_svg().len() > 1000, "{name}");
    }
}

/// Fractions and means are those of the samples.
#[test]
fn means_of_a_run_are_those_of_its_samples() {
    let reference = reference();
    let mut stuck_and_open = (0.0_f64, 0.0_f64);
    for case in list(&reference["trajectories"]).iter().take(4) {
        let study = study(case["study"].as_str().expect("a study"));
        let until = Some(number(&case["until"]));
        let request = MotionRequest { until, samples: true, ..MotionRequest::default() };
        let done = simulate::run(&study, &request).unwrap_or_else(|why| panic!("{why}"));
        let samples = done.samples.as_ref().expect("samples");
        let contacts = study.system().contacts.len();
        let count = samples.times.len() as f64;
        for (index, means) in done.means.as_ref().expect("a duration").iter().enumerate() {
            let of =
                |values: &[f64]| values.iter().skip(index).step_by(contacts).sum::<f64>() / count;
            let phases = samples.phases.iter().skip(index).step_by(contacts);
            let share = |phase| phases.clone().filter(|own| **own == phase).count() as f64 / count;
            let force = means.normal_load.max(means.friction.abs());
            let near =
                |a: f64, b: f64, scale: f64| (a - b).abs() <= 20.0 / count * scale + 2e-3 * scale;
            assert!(near(means.stick_fraction, share(ContactPhase::Stick), 1.0), "{means:?}");
            assert!(near(means.open_fraction, share(ContactPhase::Open), 1.0), "{means:?}");
            assert!(near(means.friction, of(&samples.friction), force), "{means:?}");
            assert!(near(means.normal_load, of(&samples.normal_loads), force), "{means:?}");
            let powers: Vec<f64> =
                samples.friction.iter().zip(&samples.slip_velocities).map(|(t, v)| t * v).collect();
            assert!(near(means.friction_power, of(&powers), force), "{means:?}");
            stuck_and_open.0 = stuck_and_open.0.max(means.stick_fraction);
            stuck_and_open.1 = stuck_and_open.1.max(means.open_fraction);
        }
    }
    assert!(stuck_and_open.0 > 0.1 && stuck_and_open.1 > 0.01, "{stuck_and_open:?}");
}

#[test]
fn dependent_contacts_are_named() {
    let reference = reference();
    let text = reference["dependent_rows"]["study"].as_str().expect("a study");
    let request = MotionRequest { until: Some(20.0), ..MotionRequest::default() };
    let found = verbs(&Study::from(&study(text))).simulate(&request).expect("a run").json();
    let warning = found["warnings"][0].as_str().expect("a warning");
    assert!(warning.contains("are not unique") && warning.contains(" and "), "{warning}");
}

/// A run from the end of another one continues it, and samples at given times are values of the polynomials of the steps.
#[test]
fn two_runs_are_one_long_run() {
    let reference = reference();
    let study = study(reference["dependent_rows"]["study"].as_str().expect("a study"));
    let run = |request: &MotionRequest| simulate::run(&study, request).expect("a run");
    let until = Some(20.0);
    let even = run(&MotionRequest { until, samples: true, ..MotionRequest::default() });
    let even = even.samples.expect("samples");
    let times: Vec<f64> = even.times.iter().step_by(7).copied().collect();
    let given = MotionRequest { until, samples: true, ..MotionRequest::default() };
    let whole = run(&MotionRequest { times: Some(times.clone()), ..given.clone() });
    let samples = whole.samples.expect("samples");
    let size = whole.start.state.len();
    assert_eq!(samples.times, times);
    for (place, state) in samples.states.chunks(size).enumerate() {
        assert_eq!(state, &even.states[7 * place * size..][..size]);
    }
    let half = run(&MotionRequest { until: Some(9.5), ..MotionRequest::default() });
    let from = Some(half.end.restart());
    let rest = run(&MotionRequest { from: from.clone(), ..given.clone() });
    assert_eq!(half.end.events + rest.end.events, whole.end.events);
    assert_eq!(rest.start.time, 9.5);
    for (state, wanted) in rest.end.state.iter().zip(&whole.end.state) {
        assert!((state - wanted).abs() < 1e-10, "{state} {wanted}");
    }
    let refused =
        |request: MotionRequest| simulate::run(&study, &request).expect_err("refused").to_string();
    let backwards = MotionRequest { until: Some(9.0), from, ..MotionRequest::default() };
    assert!(refused(backwards).contains("at or after that of the start, 9.5"));
    let beyond = MotionRequest { times: Some(vec![1.0, 30.0]), ..given.clone() };
    assert!(refused(beyond).contains("within the run, from 0 to 20"));
    let unsorted = MotionRequest { times: Some(vec![2.0, 1.0]), ..given };
    assert!(refused(unsorted).contains("in ascending order"));
}

/// Steady sliding is a start without motion, and every refusal has its reason.
#[test]
fn starts_are_those_of_the_study() {
    let text = "schema = 1\n[system]\ncoordinates = [\"x\"]\nmass = [1.0]\nstiffness = [4.0]\n\
        [system.initial]\nstate = \"sliding\"\n[[contact]]\nname = \"pad\"\ntangent = { x = 1.0 }\n\
        normal_load = 2.0\nbelt_velocity = 1.0\n[friction]\nlaw = \"coulomb\"\ncoefficient = 0.5\n";
    let end = |text: &str, start: &str| {
        let study = study(text);
        let start = read_state(&study, start).unwrap_or_else(|why| panic!("{why}"));
        let request = MotionRequest { start, ..MotionRequest::default() };
        simulate::run(&study, &request).map_err(|why| why.to_string())
    };
    let done = end(text, "velocity.x=0").expect("a run");
    assert_eq!((done.end.state.as_slice(), done.end.events), (&[0.25, 0.0][..], 0));
    // 100 periods of ω = 2.
    assert!((done.end.time - 100.0 * std::f64::consts::PI).abs() < 1e-9);
    let moved = end(text, "x=0.3, velocity.x=0.1").expect("a run");
    assert_eq!(moved.start.state, [0.3, 0.1]);
    let at_rest = text.replace("belt_velocity = 1.0", "belt_velocity = 0.0");
    assert!(end(&at_rest, "x=0").expect_err("no sliding").contains("does not move"));
    for state in ["squealing", "base"] {
        let why = end(&text.replace("sliding", state), "x=0").expect_err("no such motion");
        assert!(why.contains("system.initial.state") && why.contains("another state"), "{why}");
    }
    for (start, part) in [
        ("velocty.x=1", "did you mean velocity.x"),
        ("x", "name=value"),
        ("x=fast", "a finite number"),
        ("x=1,x=2", "one value for x"),
    ] {
        let why = read_state(&study(text), start).expect_err("wrong").to_string();
        assert!(why.contains(part), "{start}: {why}");
    }
}

/// A run that cannot go on reports time, contact, reason and state.
#[test]
fn failures_have_time_and_contact() {
    let text = "schema = 1\n[system]\ncoordinates = [\"x\"]\nmass = [1.0]\nstiffness = [1.0]\n\
        [[contact]]\nname = \"pad\"\nnormal = { x = 1.0 }\nnormal_load = 1.0\nbelt_velocity = 0.0\n\
        [friction]\nlaw = \"coulomb\"\ncoefficient = 0.5\n";
    let why = |text: &str| {
        simulate::run(&study(text), &MotionRequest::to(1e8)).expect_err("no run").to_string()
    };
    let at_rest = why(text);
    assert!(
        at_rest.contains("contact pad has no tangent and its surface does not move"),
        "{at_rest}"
    );
    let sliding = text.replace("normal = ", "tangent = ").replace("= 0.0", "= 0.1");
    let dithered =
        |wave: &str| format!("{sliding}[dither]\nat = {{ x = 1.0 }}\namplitude = 1.0\n{wave}");
    let growing = dithered("waveform = \"sine\"\nfrequency = 3.0\n")
        .replace("stiffness", "damping = [-4.0]\nstiffness");
    let stopped = why(&growing);
    for part in ["stopped at t = ", "the state there is x = ", "velocity.x = "] {
        assert!(stopped.contains(part), "{stopped}");
    }
    // The fastest oscillation is that of the dither, of a burst that of its carrier.
    for wave in ["\"sine\"", "\"burst\"\ncarrier = \"triangle\"\non = 3\noff = 2"] {
        let endless = why(&dithered(&format!("waveform = {wave}\nfrequency = 1e6\n")));
        assert!(endless.contains("--until") && endless.contains("at most 1000 after"), "{endless}");
    }
}

/// The judge of many starts gives every bit of that of one.
#[test]
fn runs_side_by_side_end_where_they_end_alone() {
    for name in ["belt-as-system.toml", "two-mass-drive.toml"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies").join(name);
        let text = fs::read_to_string(path).expect("a study");
        let study = study(&text);
        let size = study.system().structure.state_size();
        let start = |k: usize| -> Vec<f64> {
            (0..size).map(|i| 0.3 * libm::sin((1 + i) as f64 * (0.7 + k as f64))).collect()
        };
        let starts: Vec<Vec<f64>> = (0..20).map(start).collect();
        let together = settled_many(study.system(), &starts);
        assert_eq!(together.len(), starts.len());
        for (start, found) in starts.iter().zip(together) {
            let alone = settled(study.system(), start);
            match (&found, &alone) {
                (Ok(one), Ok(other)) => {
                    assert_eq!((one.multiple, one.periods), (other.multiple, other.periods));
                    let bits =
                        |state: &[f64]| state.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
                    assert_eq!(bits(&one.orbit.state), bits(&other.orbit.state), "{name}");
                }
                (Err(one), Err(other)) => assert_eq!(one, other, "{name}"),
                _ => panic!("{name}: {found:?} {alone:?}"),
            }
        }
    }
}
