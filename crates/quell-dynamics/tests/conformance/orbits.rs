//! Periodic responses: closure, determinants, differences, lengths, and simulation.

use quell_dynamics::orbit::{Orbit, OrbitVerdict, base_response, cycles};
use quell_dynamics::simulation::{EventKind, Start, simulate};
use quell_model::Belt;
use quell_zoo::{BeltExt, NamedModel, all_belts};

use crate::belt_orbits::{along, monodromy, start_of};

/// The base responses of all dithered belts: each has one.
fn base_responses() -> Vec<(NamedModel<Belt>, Orbit)> {
    let dithered = all_belts().into_iter().filter(|named| !named.model.dithers().is_empty());
    dithered
        .map(|named| {
            let orbit = base_response(&named.model.system(), 8);
            let orbit = orbit.unwrap_or_else(|why| panic!("{}: {why}", named.name));
            (named, orbit)
        })
        .collect()
}

fn moved(start: Start, displacement: f64, velocity: f64) -> Start {
    Start {
        displacement: start.displacement + displacement,
        velocity: start.velocity + velocity,
        ..start
    }
}

fn after(belt: &Belt, start: Start, time: f64) -> [f64; 2] {
    let end = simulate(belt, start, time, 1e-14, &mut ()).expect("no stall");
    [end.displacement, end.velocity]
}

fn determinant(orbit: &Orbit) -> f64 {
    let [[a, b], [c, d]] = monodromy(orbit);
    a * d - b * c
}

/// An orbit closes, its multipliers multiply to the determinant, and the determinant is exp(−∮(2ζ + μ′N)) in pure slip and 0
/// where the mass sticks.
#[test]
fn determinants_follow_from_the_contraction() {
    let (mut slipping, mut sticking) = (0, 0);
    for (named, orbit) in base_responses() {
        let name = &named.name;
        let [x, v] = after(&named.model, start_of(&orbit), orbit.period);
        assert!((x - orbit.state[0]).abs() < 1e-10, "{name}: {orbit:?}");
        assert!((v - orbit.state[1]).abs() < 1e-10, "{name}: {orbit:?}");
        let determinant = determinant(&orbit);
        let product = orbit.multipliers[0] * orbit.multipliers[1];
        assert!((product - determinant).norm() < 1e-10, "{name}: {orbit:?}");
        if orbit.signature.is_pure_slip() {
            let expected = (-along(&named.model, &orbit).damping).exp();
            assert!((determinant - expected).abs() < 1e-9 * expected, "{name}: {orbit:?}");
            slipping += 1;
        }
        if orbit.signature.count(EventKind::Stick) > 0 {
            assert!(determinant.abs() < 1e-9, "{name}: {orbit:?}");
            sticking += 1;
        }
    }
    assert!(slipping > 40 && sticking >= 1, "{slipping} {sticking}");
}

/// The derivative of the period map is that of differences, where the small steps keep the order of events.
#[test]
fn multipliers_agree_with_differences() {
    let mut checked = 0;
    for (named, orbit) in base_responses() {
        if orbit.signature.count(EventKind::Stick) > 0 {
            continue;
        }
        let (h, within) = if orbit.signature.is_pure_slip() { (2e-4, 1e-8) } else { (1e-5, 1e-6) };
        for column in 0..2 {
            let end = |steps: f64| {
                let change = if column == 0 { [steps * h, 0.0] } else { [0.0, steps * h] };
                let start = moved(start_of(&orbit), change[0], change[1]);
                after(&named.model, start, orbit.period)
            };
            let (far, near, back, behind) = (end(2.0), end(1.0), end(-1.0), end(-2.0));
            for row in 0..2 {
                let narrow = near[row] - back[row];
                let difference = (8.0 * narrow - (far[row] - behind[row])) / (12.0 * h);
                let own = monodromy(&orbit)[row][column];
                let gap = (own - difference).abs();
                assert!(gap < within, "{}: {own} {difference} {orbit:?}", named.name);
            }
        }
        checked += 1;
    }
    assert!(checked > 40, "{checked}");
}

/// A run from near a stable base response ends on it, and one from near an unstable base response leaves it.
#[test]
fn simulated_runs_approach_stable_orbits_and_leave_unstable_ones() {
    let (mut stable, mut unstable) = (0, 0);
    for (named, orbit) in base_responses() {
        let distance = 1e-7 * named.model.normal_load();
        // Enough periods to change the distance by a factor of 100.
        let periods = (100f64.ln() / orbit.radius().ln().abs()).ceil();
        if orbit.verdict() == OrbitVerdict::Undecided || periods > 3000.0 {
            continue;
        }
        let start = moved(start_of(&orbit), distance, 0.0);
        let [x, v] = after(&named.model, start, periods * orbit.period);
        let left = (x - orbit.state[0]).hypot(v - orbit.state[1]);
        if orbit.verdict() == OrbitVerdict::Stable {
            assert!(left < 0.1 * distance, "{}: {left:e} {orbit:?}", named.name);
            stable += 1;
        } else {
            assert!(left > 10.0 * distance, "{}: {left:e} {orbit:?}", named.name);
            unstable += 1;
        }
    }
    assert!(stable > 25 && unstable > 10, "{stable} {unstable}");
}

/// With all lengths doubled, base responses and limit cycles are doubled and have the same period and multipliers.
#[test]
fn lengths_scale_out() {
    for (named, orbit) in base_responses() {
        let doubled = base_response(&named.model.scaled(2.0).system(), 8).expect("an orbit");
        let gap = (2.0 * orbit.state[0] - doubled.state[0]).abs();
        assert!(gap < 1e-12, "{}: {gap:e}", named.name);
        assert_eq!((orbit.period, &orbit.signature), (doubled.period, &doubled.signature));
        assert!((orbit.radius() - doubled.radius()).abs() < 1e-9, "{}", named.name);
    }
    for named in quell_zoo::belt::undithered() {
        let found = cycles(&named.model).expect("no stall");
        let doubled = cycles(&named.model.scaled(2.0)).expect("no stall");
        assert_eq!(found.len(), doubled.len(), "{}", named.name);
        for (cycle, doubled) in found.iter().zip(&doubled) {
            assert!((cycle.period - doubled.period).abs() < 1e-9, "{}", named.name);
            assert_eq!(cycle.verdict(), doubled.verdict(), "{}", named.name);
            // Its own multiplier along the orbit is 1.
            let along = cycle.multipliers.iter().map(|multiplier| (multiplier - 1.0).norm());
            assert!(along.fold(f64::INFINITY, f64::min) < 1e-7, "{}: {cycle:?}", named.name);
        }
    }
}
