//! Limit cycles without dither, and folds of responses.

use quell_dynamics::attractor::outcome_of_run;
use quell_dynamics::orbit::{
    BranchEnding, CycleMapError, NoOrbit, Orbit, OrbitVerdict, ThresholdKind, base_response,
    branch_thresholds, cycles, free_end, ramped_motion,
};
use quell_dynamics::simulation::{EventKind, EventRecorder, Start, simulate};
use quell_model::LawKind;
use quell_zoo::belt::{self, over_amplitudes, undithered_belt};
use quell_zoo::dither::sine;
use quell_zoo::{BeltExt, law};

use crate::belt_orbits::{along, orbit_reached, start_of};

fn trivial(orbit: &Orbit) -> f64 {
    orbit
        .multipliers
        .iter()
        .map(|multiplier| (multiplier - 1.0).norm())
        .fold(f64::INFINITY, f64::min)
}

#[test]
fn squeal_is_an_orbit_of_known_period() {
    let belt = belt::stribeck();
    let found = cycles(&belt).expect("no stall");
    assert_eq!(found.len(), 1, "{found:?}");
    let cycle = &found[0];
    assert!((cycle.period - 9.600_930_182_576).abs() < 1e-10, "{}", cycle.period);
    assert!(cycle.is_free && cycle.residual < 1e-12);
    assert_eq!(
        (cycle.verdict(), cycle.signature.count(EventKind::Stick)),
        (OrbitVerdict::Stable, 1)
    );
    assert!(trivial(cycle) < 1e-9 && cycle.radius() < 1e-9, "{:?}", cycle.multipliers);
    // The mass moves with the belt from its stick to its release at x = μ_sF − 2ζv₀.
    let mut watch = EventRecorder::default();
    simulate(&belt, start_of(cycle), cycle.period, 1e-12, &mut watch).expect("no stall");
    let travel = watch.events[1].displacement - watch.events[0].displacement;
    assert!((watch.events[1].displacement - 0.3995).abs() < 1e-12);
    assert!((along(&belt, cycle).stuck - travel / 0.05).abs() < 1e-9);
}

/// Beyond v₂ sliding is stable, and an unstable cycle in slip separates it from the squeal.
#[test]
fn an_unstable_cycle_lies_between_sliding_and_squeal() {
    let belt = belt::decreasing();
    let found = cycles(&belt).expect("no stall");
    assert_eq!(found.len(), 2, "{found:?}");
    let (squeal, between) = (&found[0], &found[1]);
    assert_eq!(
        (squeal.verdict(), between.verdict()),
        (OrbitVerdict::Stable, OrbitVerdict::Unstable)
    );
    assert!(between.signature.is_pure_slip() && trivial(between) < 1e-9);
    // The other multiplier is the determinant, exp(−∮(2ζ + μ′N)).
    assert!((between.radius() - (-along(&belt, between).damping).exp()).abs() < 1e-9);
    // Runs from either side of it diverge.
    for (share, sticks) in [(1.001, true), (0.999, false)] {
        let sliding = belt.steady_sliding();
        let displacement = sliding + share * (between.state[0] - sliding);
        let start = Start { time: 0.0, displacement, velocity: 0.0 };
        let mut watch = EventRecorder::default();
        simulate(&belt, start, 3000.0, 1e-12, &mut watch).expect("no stall");
        assert_eq!(!watch.events.is_empty(), sticks, "{share}");
    }
}

/// Without damping and with constant friction every oscillation is periodic: a continuum has no limit cycle.
#[test]
fn a_continuum_of_free_oscillations_has_no_limit_cycle() {
    let belt = undithered_belt(0.0, 0.9767, law::coulomb(0.3, 0.3));
    assert_eq!(cycles(&belt), Ok(Vec::new()));
    assert_eq!(free_end(&belt, Start::REST), Err(CycleMapError::NoLimit));
}

/// With Coulomb friction and a static level, oscillations that slip throughout decay and those that stick grow: in between, the
/// growth jumps over zero, and no oscillation is periodic.
#[test]
fn a_jump_of_the_cycle_map_is_not_a_cycle() {
    for velocity in [0.001, 0.01, 0.1] {
        let belt = undithered_belt(0.02, velocity, law::coulomb(0.75, 1.0));
        for cycle in cycles(&belt).expect("no stall") {
            assert_eq!(cycle.signature.count(EventKind::Stick), 1, "{velocity}: {cycle:?}");
            assert!(cycle.residual < 1e-9, "{velocity}: {cycle:?}");
        }
    }
}

#[test]
fn cycles_end_at_their_belt_velocity() {
    // Folds of limit cycles from an independent program; 2.49990 has six digits.
    for (zeta, last) in [(0.005, 2.49990), (0.05, 0.476688), (0.07, 0.355485)] {
        let count = |velocity: f64| {
            cycles(&undithered_belt(zeta, velocity, law::decreasing())).expect("no stall").len()
        };
        let (mut low, mut high) = (0.8 * last, 1.2 * last);
        assert_eq!((count(low), count(high)), (2, 0));
        while high - low > 1e-7 * last {
            let middle = 0.5 * (low + high);
            if count(middle) > 0 { low = middle } else { high = middle }
        }
        println!("ζ = {zeta}: cycles up to v₀ = {low:.7}");
        assert!((low / last - 1.0).abs() < 2e-6, "{zeta}: {low}");
    }
    // The Stribeck law: no coexistence, the cycle ends where sliding becomes stable, v₂ = 0.1988.
    let count = |velocity: f64| {
        cycles(&belt::dissertation(LawKind::Stribeck).at_speed(velocity)).expect("no stall").len()
    };
    assert_eq!((count(0.198), count(0.1995), count(0.0)), (1, 0, 0));
}

/// At the natural frequency the base response folds at a small amplitude and does not exist beyond it.
#[test]
fn a_fold_is_not_stepped_over() {
    let belt = belt::decreasing().with_dither(sine(1e-4, 1.0));
    let found = branch_thresholds(&over_amplitudes(&belt), 1e-4, 3e-3, 20, None).expect("followed");
    let fold = found.thresholds.iter().find(|threshold| threshold.kind == ThresholdKind::Fold);
    println!("{:?}\n{:?}", found.thresholds, found.ending);
    let fold = fold.expect("a fold");
    assert!((fold.value - 0.001_572_4).abs() < 2e-7, "{fold:?}");
    assert_eq!((fold.was, fold.becomes), (Some(OrbitVerdict::Stable), None));
    assert!(
        matches!(found.ending, BranchEnding::TurnedBack { at } if at < 0.0016),
        "{:?}",
        found.ending
    );
    // Continuation from sliding reports this, rather than an orbit of another branch.
    let beyond = belt.undithered().with_dither(sine(2e-3, 1.0));
    let why = base_response(&beyond.system(), 8).expect_err("none");
    assert!(matches!(why, NoOrbit::Ends { share } if (share - 0.786).abs() < 1e-3), "{why}");
}

/// The large stick-slip cycle under dither is locked to it: an orbit of ten periods.
#[test]
fn squeal_under_dither_is_an_orbit_of_many_periods() {
    let belt = belt::decreasing().with_dither(sine(2.5, 10.0));
    let squeal = &cycles(&belt).expect("no stall")[0];
    let orbit = orbit_reached(&belt, start_of(squeal)).expect("an orbit");
    let tenth = orbit.period / (0.2 * std::f64::consts::PI);
    assert!((tenth - 10.0).abs() < 1e-9, "{tenth} periods of the dither");
    assert!(orbit.signature.count(EventKind::Stick) >= 1 && orbit.residual < 1e-9);
    assert_eq!(orbit.verdict(), OrbitVerdict::Stable);
    assert!(orbit.multipliers[1].norm() < 1e-9);
}

/// A dither that grows slowly leads a run from rest to the base response; one that is switched on at once does not.
#[test]
fn a_ramp_ends_on_the_base_response() {
    let belt = belt::decreasing().with_dither(sine(3.5, 10.0));
    let rest = Start { time: 0.0, displacement: belt.steady_sliding(), velocity: 0.0 };
    let system = belt.system();
    let state = [rest.displacement, rest.velocity];
    let is_quiet = |state: &[f64]| outcome_of_run(&system, state).expect("an end").is_quiet();
    let ramped = |over| ramped_motion(&system, &state, over).expect("a period");
    let grown = ramped(200.0);
    assert_eq!((is_quiet(&state), is_quiet(&grown)), (Some(false), Some(true)));
    assert_eq!(ramped(0.0), state);
}
