//! The independent checker of systems with friction contacts: against reference trajectories, and its random systems.

mod cases;
mod checker;
mod comparison;
mod expected;
mod lanes;
mod variation;

use std::collections::BTreeMap;

use checker::{Unchecked, random_system, trajectory};

/// Largest difference of times and states.
const TOLERANCE: f64 = 1e-9;

/// Largest difference of two states.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).fold(0.0, |largest, (a, b)| f64::max(largest, (a - b).abs()))
}

#[test]
fn reference_trajectories_are_reproduced() {
    let systems = cases::systems();
    assert_eq!(systems.len(), expected::TRAJECTORIES.len());
    for ((system, start), expected) in systems.iter().zip(expected::TRAJECTORIES) {
        let name = expected.name;
        let checked = trajectory(system, start, expected.until);
        let checked = checked.unwrap_or_else(|unchecked| panic!("{name}: {unchecked:?}"));
        assert_eq!(checked.events.len(), expected.count, "{name}");
        for (event, &(time, contact, kind, slip_sign)) in checked.events.iter().zip(expected.first)
        {
            let found = (event.contact, event.kind, event.slip_sign);
            assert_eq!(found, (contact, kind, slip_sign), "{name} at {time}");
            assert!((event.time - time).abs() < TOLERANCE, "{name}: {} {time}", event.time);
        }
        let last = &checked.events[expected.first.len() - 1];
        assert!(difference(&last.state, expected.state_at_last) < TOLERANCE, "{name}: {last:?}");
        assert!(
            difference(&checked.state, expected.state) < TOLERANCE,
            "{name}: {:?}",
            checked.state
        );
    }
}

#[test]
fn random_systems_have_events_of_every_kind() {
    let count = 200;
    let (mut kinds, mut ambiguous, mut first_order) = (BTreeMap::new(), 0, 0);
    for seed in 0..count {
        let (system, start) = random_system(seed);
        assert_eq!(start.len(), system.structure.state_size(), "seed {seed}");
        assert_eq!((system.clone(), start.clone()), random_system(seed));
        first_order += usize::from(system.structure.mechanical().is_none());
        match trajectory(&system, &start, 10.0) {
            Ok(checked) => {
                for event in checked.events {
                    *kinds.entry(event.kind).or_insert(0) += 1;
                }
            }
            Err(Unchecked::Ambiguous(_)) => ambiguous += 1,
            Err(Unchecked::Failed(why)) => panic!("seed {seed}: {why}"),
        }
    }
    for kind in ["stick", "release", "reversal", "separation", "landing"] {
        assert!(kinds.get(kind).is_some_and(|&number| number > 50), "{kind}: {kinds:?}");
    }
    assert!(first_order > 10, "{first_order}");
    assert!(5 * ambiguous < count, "{ambiguous} ambiguous");
}
