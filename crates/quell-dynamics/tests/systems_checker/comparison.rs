//! The engine against the independent checker on random systems.

use quell_dynamics::motion::{MOTION_TOLERANCE, Motion, MotionRecorder, MotionStart};

use crate::checker::{Unchecked, random_system, trajectory};
use crate::difference;

/// Number of random systems compared in every run; the reserve has a hundred times as many.
const SYSTEMS: u64 = 1000;

/// Time up to which they are compared.
const UNTIL: f64 = 10.0;

/// Differences of event times and states that rounding and the checker's own error explain.
const SAME: f64 = 1e-8;

/// What two programs agree on.
#[derive(Default)]
struct Agreement {
    systems: usize,
    events: usize,
    time: f64,
    state: f64,
}

/// Adds one system; `Ok` also where the checker finds the comparison meaningless.
fn compare(seed: u64, agreement: &mut Agreement) -> Result<(), String> {
    let (system, start) = random_system(seed);
    let checked = match trajectory(&system, &start, UNTIL) {
        Ok(checked) => checked,
        Err(Unchecked::Ambiguous(_)) => return Ok(()),
        Err(Unchecked::Failed(why)) => return Err(format!("the checker failed: {why}")),
    };
    let motion = Motion::new(&system).map_err(|why| why.to_string())?;
    let mut recorder = MotionRecorder::default();
    let from = MotionStart { time: 0.0, state: start };
    let end = motion.run(&from, UNTIL, MOTION_TOLERANCE, &mut recorder);
    let end = end.map_err(|why| why.to_string())?;
    let found = &recorder.events;
    for (place, (event, wanted)) in found.iter().zip(&checked.events).enumerate() {
        let state = difference(&event.state, &wanted.state);
        let time = (event.time - wanted.time).abs();
        let is_same = event.kind.name() == wanted.kind
            && (event.contact, event.slip_sign) == (wanted.contact, wanted.slip_sign);
        if !is_same || time > SAME || state > SAME {
            return Err(format!("event {place}: {event:?} {wanted:?}: {time:e} {state:e}"));
        }
        agreement.time = agreement.time.max(time);
        agreement.state = agreement.state.max(state);
    }
    if found.len() != checked.events.len() {
        return Err(format!("{} events instead of {}", found.len(), checked.events.len()));
    }
    let state = difference(&end.state, &checked.state);
    agreement.state = agreement.state.max(state);
    agreement.systems += 1;
    agreement.events += found.len();
    if state > SAME { Err(format!("final state off by {state:e}")) } else { Ok(()) }
}

fn compare_all(seeds: std::ops::Range<u64>) {
    let mut agreement = Agreement::default();
    let compared = seeds.map(|seed| (seed, compare(seed, &mut agreement)));
    let different: Vec<String> = compared
        .filter_map(|(seed, result)| Some(format!("system {seed}: {}", result.err()?)))
        .collect();
    let Agreement { systems, events, time, state } = agreement;
    println!(
        "{systems} systems, {events} events, times within {time:.1e}, states within {state:.1e}"
    );
    assert!(different.is_empty(), "{} differ:\n{}", different.len(), different.join("\n"));
    assert!(systems > 0 && events > systems);
}

#[test]
fn a_thousand_random_systems_miss_no_event() {
    compare_all(0..SYSTEMS);
}

/// The reserve: about 12 minutes on one core.
#[test]
#[ignore = "a hundred thousand systems: run with --ignored"]
fn a_hundred_thousand_random_systems_miss_no_event() {
    compare_all(SYSTEMS..101 * SYSTEMS);
}
