//! A run has the same bits alone, in any lane, next to any other runs, on any instruction set.

use quell_dynamics::response::{ResponseCase, Solver, compare_many};
use quell_dynamics::simulation::{
    Event, EventRecorder, FinalState, InstructionSet, Sample, Sampler, SimulationRun, Start,
    simulate, simulate_many_with,
};
use quell_model::{Belt, Direction, LawKind, Waveform};
use quell_zoo::belt::belt;
use quell_zoo::dither::{at_phase, dither};
use quell_zoo::law::build;

use crate::response_of;

const TOLERANCE: f64 = 1e-11;

/// Belts of every law, waveform and direction, with none, one or several dithers, and with different
/// friction, duration, start and phase.
fn cases() -> Vec<(Belt, Start, f64)> {
    let mut cases = Vec::new();
    for (i, &law) in LawKind::NUMERIC.iter().filter(|law| !law.has_state()).enumerate() {
        for (j, waveform) in Waveform::NAMED.iter().enumerate() {
            for k in 0..7_u32 {
                let x = f64::from(k) + 0.37 * i as f64 + 0.11 * j as f64;
                let wave = |direction, amplitude, frequency_ratio| {
                    at_phase(
                        dither(direction, waveform.clone(), amplitude, frequency_ratio),
                        0.4 * x,
                    )
                };
                let tangential = wave(Direction::Tangential, 0.1 + 0.13 * x, 5.0 + 1.3 * x);
                let normal = wave(Direction::Normal, 0.1 + 0.1 * x, 7.0 - 0.5 * x);
                let slower = wave(Direction::Tangential, 0.05, 3.1 + 0.1 * x);
                let dithers = match k {
                    0 => vec![],
                    1 | 2 => vec![tangential],
                    3 | 4 => vec![normal],
                    5 => vec![tangential, normal],
                    _ => vec![tangential, slower, normal],
                };
                let (level, velocity, viscous) = (0.4 - 0.01 * x, 0.2 + 0.02 * x, 0.02 * x);
                let values = match law {
                    LawKind::Coulomb => vec![0.28, level, viscous],
                    LawKind::StribeckExponential => {
                        vec![0.28, level, velocity, f64::from(1 + k % 4), viscous]
                    }
                    _ => vec![level, 0.28, velocity],
                };
                let belt = belt(0.005 * x, 0.05 + 0.02 * x, build(law, &values), dithers);
                let start = Start { time: 0.3 * x, displacement: 0.1 * x, velocity: 0.02 * x };
                cases.push((belt, start, 40.0 + 9.0 * x));
            }
        }
    }
    cases
}

/// Everything that identifies a run.
type Trace = (FinalState, Vec<Event>, Vec<Sample>);

fn watchers(cases: &[(Belt, Start, f64)]) -> Vec<(EventRecorder, Sampler)> {
    cases
        .iter()
        .map(|(_, start, _)| (EventRecorder::default(), Sampler::new(start.time, 0.7, 50)))
        .collect()
}

fn alone(cases: &[(Belt, Start, f64)]) -> Vec<Trace> {
    cases
        .iter()
        .zip(watchers(cases))
        .map(|((belt, start, until), mut watch)| {
            let end = simulate(belt, *start, *until, TOLERANCE, &mut watch).expect("no stall");
            (end, watch.0.events, watch.1.samples)
        })
        .collect()
}

fn together(set: InstructionSet, cases: &[(Belt, Start, f64)]) -> Vec<Trace> {
    let mut watches = watchers(cases);
    let runs = cases
        .iter()
        .zip(&mut watches)
        .map(|((belt, start, until), observer)| SimulationRun {
            belt,
            start: *start,
            until: *until,
            observer,
        })
        .collect();
    let ends = simulate_many_with(set, runs, TOLERANCE);
    ends.into_iter()
        .zip(watches)
        .map(|(end, watch)| (end.expect("no stall"), watch.0.events, watch.1.samples))
        .collect()
}

#[test]
fn every_run_has_the_same_bits_as_alone() {
    let mut cases = cases();
    let mut expected = alone(&cases);
    assert!(expected.iter().map(|(_, events, _)| events.len()).sum::<usize>() > 1000);
    for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
        // Other lanes and other neighbours: the order is rotated by a step that shares no
        // factor with the number of lanes.
        for shift in [0, 5] {
            cases.rotate_left(shift);
            expected.rotate_left(shift);
            for (number, (run, alone)) in together(set, &cases).iter().zip(&expected).enumerate() {
                assert_eq!(run, alone, "{}, run {number}: {:?}", set.name(), cases[number].0);
            }
        }
    }
}

#[test]
fn runs_without_observers_have_the_same_bits() {
    let cases = cases();
    let expected = alone(&cases);
    for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
        let mut observers = vec![(); cases.len()];
        let runs = cases
            .iter()
            .zip(&mut observers)
            .map(|((belt, start, until), observer)| SimulationRun {
                belt,
                start: *start,
                until: *until,
                observer,
            })
            .collect();
        let ends = simulate_many_with(set, runs, TOLERANCE);
        for (number, (end, (alone, ..))) in ends.into_iter().zip(&expected).enumerate() {
            assert_eq!(end.as_ref(), Ok(alone), "{}, run {number}", set.name());
        }
    }
}

/// A point of a map is the response of its belt: what both measure agrees where the run has settled on the motion that is found.
#[test]
fn a_point_of_a_map_is_the_response_of_its_belt() {
    let solver = Solver { tolerance: 1e-12, settle: 600.0, record_periods: 30 };
    let cases: Vec<ResponseCase> = cases()
        .into_iter()
        .map(|(belt, start, _)| ResponseCase { belt, start: Start { time: 0.0, ..start } })
        .collect();
    let compared = compare_many(&cases, &solver);
    let mut settled = 0;
    for (case, compared) in cases.iter().zip(compared) {
        let alone = response_of(&case.belt, case.start, &solver);
        let compared = compared.expect("no stall");
        let what = format!("{:?}", case.belt);
        if !compared.settled() || !compared.undithered_settled() {
            continue;
        }
        settled += 1;
        let near = |a: f64, b: f64, error: f64| {
            assert!((a - b).abs() <= error * a.abs().max(b.abs()) + 1e-12, "{what}: {a} {b}");
        };
        near(compared.dithered.lines.whole, alone.dithered.lines.whole, 1e-9);
        // A map samples the run without dither on a grid of its own.
        near(compared.undithered.lines.whole, alone.undithered.lines.whole, 1e-6);
        assert_eq!(compared.vibrates, alone.residual_vibration.map(|_| ()), "{what}");
    }
    assert!(settled > 3, "{settled}");
}
