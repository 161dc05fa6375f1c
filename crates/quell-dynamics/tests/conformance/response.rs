//! The steady response: against its orbit, its energy balance, and many at once.

use quell_dynamics::orbit::{OrbitVerdict, from_sliding};
use quell_dynamics::response::{Observables, ResponseCase, Solver, compare_many, respond};
use quell_dynamics::simulation::{Sampler, Start, simulate};
use quell_model::Belt;
use quell_zoo::all_belts;

const SOLVER: Solver = Solver { tolerance: 1e-12, settle: 60.0, record_periods: 6 };

/// A point of a map has the bits of the response that is computed alone.
#[test]
fn many_responses_have_the_bits_of_one_alone() {
    let belts = all_belts();
    let cases: Vec<ResponseCase> = belts
        .iter()
        .map(|named| ResponseCase { belt: named.model.clone(), start: Start::REST })
        .collect();
    let together = compare_many(&cases, &SOLVER, Observables { dither_cost: true });
    for (named, compared) in belts.iter().zip(together) {
        let alone = respond(&named.model, Start::REST, &SOLVER).expect("no stall");
        let compared = compared.expect("no stall");
        assert_eq!(compared.residual_vibration(), alone.residual_vibration, "{}", named.name);
        assert_eq!(compared.dithered.lines.whole, alone.amplitude, "{}", named.name);
        assert_eq!(compared.dithered.stick_fraction, alone.stick_fraction, "{}", named.name);
        assert_eq!(compared.dithered.mean_friction, alone.mean_friction, "{}", named.name);
        assert_eq!(compared.dithered.dither_power, alone.dither_power, "{}", named.name);
    }
}

/// Mean of x over one period of an orbit.
fn mean_over_a_period(belt: &Belt, start: Start, period: f64) -> f64 {
    const COUNT: usize = 4000;
    let mut sampler = Sampler::new(0.0, period / COUNT as f64, COUNT);
    simulate(belt, start, period, 1e-12, &mut sampler).expect("no stall");
    sampler.samples.iter().map(|sample| sample.displacement).sum::<f64>() / COUNT as f64
}

/// From a stable base response the record repeats that orbit: each sample is the orbit's state at its phase, no slow line is
/// left, and the mean friction carries the spring.
#[test]
fn the_steady_response_is_the_orbit() {
    let mut checked = 0;
    for named in all_belts() {
        let belt = &named.model;
        let Ok(orbit) = from_sliding(belt, 8) else { continue };
        if orbit.verdict() != OrbitVerdict::Stable {
            continue;
        }
        let found = respond(belt, orbit.start, &SOLVER).expect("no stall");
        for sample in found.record.samples.iter().step_by(37) {
            let since = sample.time.rem_euclid(orbit.period);
            let end = simulate(belt, orbit.start, since, 1e-12, &mut ()).expect("no stall");
            let gap = (end.displacement - sample.displacement).abs();
            assert!(gap < 1e-8, "{} at {}: {gap:e}", named.name, sample.time);
        }
        assert!(found.amplitude < 1e-6, "{}: {}", named.name, found.amplitude);
        let mean = mean_over_a_period(belt, orbit.start, orbit.period);
        let gap = (found.mean_friction - mean).abs();
        assert!(gap < 2e-4, "{}: ⟨f⟩ − ⟨x⟩ = {gap:e}", named.name);
        checked += 1;
    }
    assert!(checked > 30, "{checked}");
}
