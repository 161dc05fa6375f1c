//! The judge: settled runs against multipliers, orbits and other lengths.

use quell_dynamics::attractor::{
    AttractorKind, AttractorSettings, Patience, SettleOutcome, Settled, measure, outcome_of_run,
    settle, settle_many,
};
use quell_dynamics::orbit::OrbitVerdict;
use quell_dynamics::simulation::Start;
use quell_model::Belt;
use quell_zoo::{BeltExt, all_belts};

use crate::belt_orbits::{orbit_near, orbit_reached};

/// A start far from sliding.
fn afar(belt: &Belt) -> Start {
    Start { time: 0.0, displacement: 1.5 * belt.normal_load(), velocity: 0.0 }
}

/// A run from the base response stays there exactly where its multipliers say that it is stable.
#[test]
fn runs_stay_on_base_responses_that_are_stable() {
    let mut judged = [0, 0];
    for named in all_belts() {
        let settings = AttractorSettings::new(&named.model).expect("commensurate");
        let Ok(quiet) = &settings.base else { continue };
        if quiet.verdict == OrbitVerdict::Undecided {
            continue;
        }
        let start = Start { time: 0.0, displacement: quiet.displacement, velocity: quiet.velocity };
        let settled = settle(&settings, start, Patience::BASIN).expect("no stall");
        let stable = quiet.verdict == OrbitVerdict::Stable;
        let stays = settled.outcome == SettleOutcome::Base;
        assert_eq!(stays, stable, "{}: {quiet:?} {settled:?}", named.name);
        judged[usize::from(stable)] += 1;
    }
    assert!(judged[0] > 10 && judged[1] > 30, "{judged:?}");
}

/// Settling, measuring and shooting describe the same attractor.
#[test]
fn attractors_are_the_orbits_that_shooting_finds() {
    let mut orbits = 0;
    for named in all_belts() {
        let belt = &named.model;
        let settings = AttractorSettings::new(belt).expect("commensurate");
        let settled = settle(&settings, Start::REST, Patience::SWEEP).expect("no stall");
        let attractor = measure(&settings, &settled).expect("no stall");
        let outcome = outcome_of_run(&belt.system(), &[0.0, 0.0]);
        let is_quiet = outcome.ok().and_then(|outcome| outcome.is_quiet());
        assert_eq!(is_quiet, attractor.as_ref().map(|found| found.quiet), "{}", named.name);
        let Some(attractor) = attractor else { continue };
        assert_eq!(attractor.base, settled.outcome == SettleOutcome::Base, "{}", named.name);
        let orbit = orbit_reached(belt, Start::REST);
        match attractor.kind {
            AttractorKind::Periodic { periods, radius } if !belt.dithers().is_empty() => {
                let orbit = orbit.unwrap_or_else(|why| panic!("{}: {why}", named.name));
                let period = f64::from(periods) * settings.section.period;
                assert!((orbit.period - period).abs() < 1e-9, "{}", named.name);
                assert!((orbit.radius() - radius).abs() < 1e-6, "{}", named.name);
                assert_eq!(orbit.verdict(), OrbitVerdict::Stable, "{}: {orbit:?}", named.name);
                let again = orbit_near(belt, attractor.state, periods).expect("the same orbit");
                assert!((again.radius() - radius).abs() < 1e-6, "{}", named.name);
                orbits += 1;
            }
            AttractorKind::Cycle => {
                let cycle = orbit.unwrap_or_else(|why| panic!("{}: {why}", named.name));
                let frequency = attractor.frequency(settings.section.period).expect("it turns");
                let own = std::f64::consts::TAU / cycle.period;
                assert!((frequency - own).abs() < 1e-9, "{}: {frequency} {own}", named.name);
                orbits += 1;
            }
            AttractorKind::QuasiPeriodic => {
                let no_period = orbit.as_ref().is_err_and(|why| why.contains("QuasiPeriodic"));
                assert!(no_period, "{}: {orbit:?}", named.name);
            }
            _ => {}
        }
    }
    assert!(orbits > 40, "{orbits}");
}

/// A run settles with the same bits alone and in company, and doubled lengths double its end exactly.
#[test]
fn settled_runs_keep_their_bits_in_company_and_at_double_lengths() {
    for named in all_belts() {
        let settled = |belt: &Belt| -> Vec<Settled> {
            let settings = AttractorSettings::new(belt).expect("commensurate");
            let starts = [Start::REST, afar(belt)];
            let together = settle_many(&settings, &starts, Patience::BASIN);
            together.into_iter().map(|settled| settled.expect("no stall")).collect()
        };
        let one = settled(&named.model);
        let settings = AttractorSettings::new(&named.model).expect("commensurate");
        let alone = settle(&settings, afar(&named.model), Patience::BASIN).expect("no stall");
        assert_eq!(alone, one[1], "{}", named.name);
        for (one, two) in one.iter().zip(settled(&named.model.scaled(2.0))) {
            assert_eq!((one.outcome, one.periods), (two.outcome, two.periods), "{}", named.name);
            let doubled = 2.0 * one.state.displacement;
            assert_eq!(doubled, two.state.displacement, "{}", named.name);
        }
    }
}
