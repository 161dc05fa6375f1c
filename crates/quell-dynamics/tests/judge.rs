//! One criterion for whether a run has settled and where it ends: response, orbit, thresholds, bifurcation, basins and starts
//! agree.

use quell_dynamics::attractor::{
    AttractorKind, AttractorSettings, NoStart, Patience, SettleOutcome, measure, outcome_of_run,
    settle,
};
use quell_dynamics::orbit::{
    FreeEnd, OrbitVerdict, ThresholdKind, base_response, cycles, free_end, keeps_vibrating,
    sliding_state, squealing_state,
};
use quell_dynamics::response::{Effect, Solver, Uncertain, Undefined};
use quell_dynamics::simulation::Start;
use quell_model::{LawKind, System, Waveform};
use quell_numerics::interval::RealInterval;
use quell_zoo::belt::{self, over_velocities, stribeck_under, undithered_belt};
use quell_zoo::dither::sine;
use quell_zoo::{BeltExt, law};

use crate::belt_orbits::{orbit_near, orbit_reached, start_of};
use crate::orbits::switches;
use crate::{local_thresholds, response_of};

/// A section that is a single state up to rounding closes after any number of periods; its period is one.
#[test]
fn a_response_of_one_period_is_not_called_locked() {
    let fast = belt::decreasing();
    for amplitude in [2.0, 2.25, 2.5] {
        let belt = fast.with_dither(sine(amplitude, 0.9));
        let settings = AttractorSettings::new(&belt).expect("a strobe");
        let settled = settle(&settings, Start::REST, Patience::SWEEP).expect("no stall");
        let attractor = measure(&settings, &settled).expect("no stall").expect("settled");
        let AttractorKind::Periodic { periods, radius } = attractor.kind else {
            panic!("{attractor:?}")
        };
        assert_eq!((periods, attractor.section.len(), attractor.rotation), (1, 1, None));
        // `orbit --from-rest` finds the same response with the same multiplier.
        let orbit = orbit_reached(&belt, Start::REST).expect("an orbit");
        assert_eq!(orbit.period, std::f64::consts::TAU / 0.9);
        assert!((orbit.radius() - radius).abs() < 1e-9, "{amplitude}: {radius}");
        assert_eq!(orbit.verdict(), OrbitVerdict::Stable);
    }
}

/// At v₀ = 0 a run from rest ends on the response that sticks twice per period, whose section is a single state to the last bit.
#[test]
fn a_driven_oscillator_settles_from_rest() {
    let still = undithered_belt(0.05, 0.0, law::formula("0.3"));
    for amplitude in [0.4, 0.5, 0.6, 0.8, 1.5] {
        let belt = still.with_dither(sine(amplitude, 0.5));
        let orbit = orbit_reached(&belt, Start::REST).unwrap_or_else(|why| panic!("{why}"));
        assert_eq!(orbit.period, std::f64::consts::TAU / 0.5, "{amplitude}");
        assert_eq!(orbit.verdict(), OrbitVerdict::Stable, "{amplitude}");
    }
}

/// The response at D = 7 creeps along a nearly locked curve to an orbit of ten periods, and is reported as that orbit.
#[test]
fn a_creep_along_a_nearly_locked_curve_ends_on_its_orbit() {
    let belt = belt::dissertation(LawKind::Decreasing).at_speed(1.5).with_dither(sine(7.0, 10.0));
    let orbit = orbit_reached(&belt, Start::REST).expect("an orbit");
    assert!((orbit.period - std::f64::consts::TAU).abs() < 1e-12, "{}", orbit.period);
    assert_eq!(orbit.verdict(), OrbitVerdict::Stable);
}

/// A dither of amplitude zero does not change a limit cycle, at any frequency: the times of the section are unrelated to the
/// cycle.
#[test]
fn a_limit_cycle_does_not_depend_on_the_frequency_of_a_silent_dither() {
    let belt = belt::dissertation(LawKind::Decreasing).at_speed(0.05);
    let frequency = std::f64::consts::TAU / cycles(&belt).expect("no stall")[0].period;
    for frequency_ratio in [10.0, 1.45, 1.396, 1.0, 0.6] {
        let belt = belt.with_dither(sine(0.0, frequency_ratio));
        let settings = AttractorSettings::new(&belt).expect("a strobe");
        let settled = settle(&settings, Start::REST, Patience::SWEEP).expect("no stall");
        let attractor = measure(&settings, &settled).expect("no stall").expect("settled");
        assert_eq!(attractor.kind, AttractorKind::Cycle, "{frequency_ratio}");
        let found = attractor.frequency(settings.section.period).expect("a slow phase");
        assert!((found - frequency).abs() < 1e-12, "{frequency_ratio}: {found} {frequency}");
        let orbit = orbit_reached(&belt, Start::REST).expect("a cycle");
        assert!(orbit.is_free && (orbit.period * frequency - std::f64::consts::TAU).abs() < 1e-12);
    }
}

/// Just below the threshold, at 0.4965619, the slow motion about the unstable base response is nearly as small as what counts as one
/// state. It is no motion in step with the dither, and not quiet.
#[test]
fn a_small_slow_motion_about_an_unstable_response_is_not_quiet() {
    let at = |amplitude| {
        let belt = stribeck_under(Waveform::Sine, amplitude);
        let settings = AttractorSettings::new(&belt).expect("a period");
        let settled = settle(&settings, Start::REST, Patience::SWEEP).expect("no stall");
        let found = measure(&settings, &settled).expect("no stall").expect("an attractor");
        let outcome = outcome_of_run(&belt.system(), &[0.0, 0.0]).expect("an end");
        assert_eq!(outcome.is_quiet(), Some(found.quiet), "{amplitude}");
        let effect = response_of(&belt, Start::REST, &Solver::default()).effect;
        let expected = if found.quiet { Effect::Quenches } else { Effect::Reduces };
        assert_eq!(effect, expected, "{amplitude}");
        found
    };
    let below = at(0.496_557);
    assert!(!below.quiet && !below.base, "{below:?}");
    assert!(matches!(below.kind, AttractorKind::Periodic { periods: 13, .. }), "{:?}", below.kind);
    let above = at(0.496_564);
    assert!(above.quiet && above.base, "{above:?}");
}

/// Friction so strong that unstable sliding is left without oscillation: slips take longer than periods of the structure, and the run
/// still ends on stick-slip, for every judge.
#[test]
fn strong_friction_keeps_vibrating() {
    for load in [15.0, 20.0, 100.0] {
        let belt = belt::stribeck().with_normal_load(load).expect("valid");
        assert_eq!(keeps_vibrating(&belt, Start::REST), Ok(true), "{load}");
        assert_eq!(cycles(&belt).expect("no stall").len(), 1, "{load}");
        let end = outcome_of_run(&belt.system(), &[0.0, 0.0]).expect("an end");
        assert_eq!(end.is_quiet(), Some(false), "{load}");
    }
}

/// The squeal of the Stribeck law shrinks to zero at the Hopf point and not before: starts, cycles, thresholds and orbits agree.
#[test]
fn squeal_ends_at_the_hopf_point() {
    let belt = belt::dissertation(LawKind::Stribeck).at_speed(0.15);
    let hopf = local_thresholds(&over_velocities(&belt), RealInterval::new(0.15, 0.25), 20);
    assert_eq!((hopf.len(), hopf[0].kind), (1, ThresholdKind::Hopf));
    let hopf = hopf[0].value;
    assert!((hopf - 0.198_830_1).abs() < 1e-7, "{hopf}");
    for (share, squeals) in [(1.0 - 1e-3, true), (1.0 - 1e-6, true), (1.0 + 1e-6, false)] {
        let at = belt::dissertation(LawKind::Stribeck).at_speed(share * hopf);
        assert_eq!(cycles(&at).expect("no stall").len(), usize::from(squeals), "{share}");
        assert_eq!(squealing_state(&at.system()).is_ok(), squeals, "{share}");
        let end = free_end(&at, Start::REST).expect("an end");
        assert_eq!(matches!(end, FreeEnd::Cycle(_)), squeals, "{share}");
        assert_eq!(keeps_vibrating(&at, Start::REST), Ok(squeals), "{share}");
        let ends = outcome_of_run(&at.system(), &[0.0, 0.0]).expect("an end");
        assert_eq!(ends.is_quiet(), Some(!squeals), "{share}");
    }
    // Beyond it nothing squeals, and a run from there starts from steady sliding.
    let at = |values: &[f64]| Ok(belt.with_belt_velocity(values[0]).expect("valid").system());
    let start = |_: f64, system: &System| {
        squealing_state(system).or_else(|_| sliding_state(system).map_err(NoStart::NoSliding))
    };
    let changes = switches(&at, &start, RealInterval::new(0.15, 0.25), 10).changes;
    assert_eq!((changes.len(), changes[0].becomes.is_quiet()), (1, Some(true)));
    assert!((changes[0].value / hopf - 1.0).abs() < 2e-6, "{changes:?}");
}

/// Near the fold of two limit cycles both lie between neighbouring points of any grid.
#[test]
fn a_pair_of_cycles_near_its_fold_is_found() {
    // The fold is at v₀ = 0.4766883.
    let count =
        |velocity| cycles(&undithered_belt(0.05, velocity, law::decreasing())).expect("runs");
    let near_fold = count(0.476_687);
    assert_eq!(near_fold.len(), 2);
    assert!(near_fold[0].radius() < 1.0 && near_fold[1].radius() > 1.0);
    assert!(count(0.476_69).is_empty());
}

/// ζ = 0, R = ½, pure slip through reversals at v₀ = 0: the multiplier is 1. Its distance from 1 in the thirteenth digit decides
/// nothing, because the state is known to six digits only.
#[test]
fn a_marginal_orbit_is_undecided() {
    let still = undithered_belt(0.0, 0.0, law::formula("0.3"));
    let belt = still.with_dither(sine(3.0, 0.5));
    let guess = Start { time: 0.0, displacement: -1.300_01, velocity: 2.0 };
    let orbit = orbit_near(&belt, guess, 1).expect("an orbit");
    assert!((orbit.radius() - 1.0).abs() < 1e-4, "{orbit:?}");
    assert_eq!(orbit.verdict(), OrbitVerdict::Undecided, "{orbit:?}");
    assert!(orbit.state_error > 1e3 * orbit.residual, "{orbit:?}");
    // An ordinary orbit is decided, with a small error.
    let belt = belt::decreasing().with_dither(sine(3.0, 10.0));
    let orbit =
        orbit_near(&belt, Start { displacement: 0.29, ..Start::REST }, 1).expect("an orbit");
    assert_eq!(orbit.verdict(), OrbitVerdict::Stable);
    assert!(orbit.state_error < 1e-10 && orbit.multiplier_error < 1e-9, "{orbit:?}");
}

/// One example of every effect: the effect of a dither is decided by the attractors on which the runs end.
#[test]
fn every_effect_is_recognised() {
    let solver = Solver::default();
    let slow = belt::stribeck();
    let fast = belt::decreasing();
    let base = base_response(&fast.with_dither(sine(3.5, 10.0)).system(), 8).expect("an orbit");
    for (belt, start, effect) in [
        (slow.with_dither(sine(0.6, 10.0)), Start::REST, Effect::Quenches),
        (slow.with_dither(sine(0.3, 10.0)), Start::REST, Effect::Reduces),
        (slow.clone(), Start::REST, Effect::Unknown(Uncertain::NoDither)),
        // Below resonance the forced motion lies in the band of slow vibration.
        (slow.with_dither(sine(0.6, 0.9)), Start::REST, Effect::Increases),
        // Sliding is stable at v₀ = 1; the same dither causes squeal from rest and none from the base response.
        (fast.with_dither(sine(3.5, 10.0)), Start::REST, Effect::Causes),
        (fast.with_dither(sine(3.5, 10.0)), start_of(&base), Effect::Quiet),
    ] {
        let found = response_of(&belt, start, &solver);
        assert_eq!(found.effect, effect, "{:?} {:?}", belt.dithers(), found.dithered.ending);
        let quiet = matches!(effect, Effect::Causes | Effect::Quiet);
        assert_eq!(found.residual_vibration.is_err(), quiet);
        if quiet {
            assert_eq!(found.residual_vibration, Err(Undefined::UnditheredSettles));
        }
    }
}

/// The cycle map predicts the outcomes of long undithered simulations from either side of the unstable cycle.
#[test]
fn undithered_runs_end_as_the_cycle_map_predicts() {
    let belt = belt::decreasing();
    let between = &cycles(&belt).expect("no stall")[1];
    let settings = AttractorSettings::new(&belt).expect("a strobe");
    for (share, outcome) in [(1.001, SettleOutcome::Elsewhere), (0.999, SettleOutcome::Base)] {
        let sliding = belt.steady_sliding();
        let displacement = sliding + share * (between.state[0] - sliding);
        let start = Start { time: 0.0, displacement, velocity: 0.0 };
        let settled = settle(&settings, start, Patience::SWEEP).expect("no stall");
        assert_eq!(settled.outcome, outcome, "{share}");
    }
}
