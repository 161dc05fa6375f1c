//! The steady response: against its orbit, its energy balance, and many at once.

use quell_dynamics::orbit::{OrbitVerdict, base_response};
use quell_dynamics::response::{ResponseCase, ResponsePlan, Solver, compare_many, respond};
use quell_dynamics::simulation::{Start, simulate};
use quell_zoo::all_belts;

use crate::belt_orbits::start_of;

const SOLVER: Solver = Solver { tolerance: 1e-12, settle: 60.0, record_periods: 6 };

/// A point of a map has the bits of that of a map of one point.
#[test]
fn many_responses_have_the_bits_of_one_alone() {
    let belts = all_belts();
    let cases: Vec<ResponseCase> = belts
        .iter()
        .map(|named| ResponseCase { belt: named.model.clone(), start: Start::REST })
        .collect();
    let together = compare_many(&cases, &SOLVER);
    for ((named, case), compared) in belts.iter().zip(&cases).zip(together) {
        let alone = compare_many(std::slice::from_ref(case), &SOLVER);
        assert_eq!(alone, [compared], "{}", named.name);
    }
}

/// From a stable base response the record repeats that orbit: each sample is the orbit's state at its phase, no slow line is
/// left, and the mean friction carries the spring.
#[test]
fn the_steady_response_is_the_orbit() {
    let mut checked = 0;
    for named in all_belts() {
        let belt = &named.model;
        let Ok(orbit) = base_response(&belt.system(), 8) else { continue };
        if orbit.verdict() != OrbitVerdict::Stable {
            continue;
        }
        let start = start_of(&orbit);
        let plan = ResponsePlan::from(&SOLVER);
        let found = respond(&belt.system(), &start.into(), &plan).expect("no stall");
        let found = &found.dithered;
        for (number, sample) in found.samples.iter().enumerate().step_by(37) {
            let time = (number as f64).mul_add(found.step, found.from);
            let since = time.rem_euclid(orbit.period);
            let end = simulate(belt, start, since, 1e-12, &mut ()).expect("no stall");
            let gap = (end.displacement - sample).abs();
            assert!(gap < 1e-8, "{} at {time}: {gap:e}", named.name);
        }
        assert!(found.lines.whole < 1e-6, "{}: {}", named.name, found.lines.whole);
        let gap = (found.contacts[0].friction - found.observed.mean()).abs();
        assert!(gap < 1e-9, "{}: ⟨f⟩ − ⟨x⟩ = {gap:e}", named.name);
        checked += 1;
    }
    assert!(checked > 30, "{checked}");
}
