//! Runs of random systems have the same bits alone, in any lane and next to any neighbours, on every instruction set.

use quell_dynamics::motion::{
    MOTION_TOLERANCE, Motion, MotionEnd, MotionRecorder, MotionSampler, MotionStart, MotionStopped,
    PlannedMotion, StopReason, run_many, run_many_with,
};
use quell_dynamics::simulation::InstructionSet;
use quell_model::System;
use quell_model::friction::{Coulomb, Friction};
use quell_model::profile::{Profile, Wave};
use quell_model::system::{Contact, Mechanical, StateSpace, Structure};
use quell_numerics::matrix::Matrix;

use crate::checker::random_system;

/// Number of random systems.
const SYSTEMS: u64 = 60;

/// Runs of each system: more than the lanes of any instruction set.
const VARIANTS: u32 = 21;

/// A run: its system, start, and end.
struct Case {
    system: System,
    start: MotionStart,
    until: f64,
}

fn scaled(matrix: &Matrix, factor: f64) -> Matrix {
    Matrix::from_fn(matrix.rows(), matrix.rows(), |i, j| factor * matrix[(i, j)])
}

fn scaled_profile(profile: &Profile, factor: f64) -> Profile {
    let waves = profile.waves().iter();
    waves.fold(Profile::constant(factor * profile.mean()), |profile, wave| {
        let (amplitude, frequency) = (factor * wave.amplitude, wave.frequency / factor);
        profile.with(Wave { amplitude, frequency, phase: wave.phase + factor, ..wave.clone() })
    })
}

/// The system with other numbers and the same structure.
fn varied(system: &System, factor: f64) -> System {
    let mut system = system.clone();
    system.structure = match &system.structure {
        Structure::Mechanical(given) => {
            let names = given.coordinates().to_vec();
            let (damping, stiffness) =
                (scaled(given.damping(), 1.0 / factor), scaled(given.stiffness(), factor));
            let force = given.force().to_vec();
            Mechanical::new(names, given.mass().clone(), damping, stiffness).under(force).into()
        }
        Structure::StateSpace(given) => {
            let matrix = scaled(given.matrix(), factor);
            StateSpace::new(given.names().to_vec(), matrix).under(given.force().to_vec()).into()
        }
    };
    for contact in &mut system.contacts {
        contact.normal_load *= factor;
        contact.surface_velocity = scaled_profile(&contact.surface_velocity, 1.0 / factor);
    }
    for input in &mut system.inputs {
        // A prescribed load stays positive.
        input.profile = scaled_profile(&input.profile, factor.min(1.0));
    }
    system
}

/// The variants of a random system, of different lengths.
fn variants(seed: u64) -> Vec<Case> {
    let (system, start) = random_system(seed);
    let variant = |number: u32| {
        let factor = 0.9 + 0.01 * f64::from(number);
        let state = start.iter().map(|entry| entry * factor).collect();
        let time = 0.3 * f64::from(number % 5);
        let until = time + 0.5 * f64::from((7 * number) % VARIANTS);
        Case { system: varied(&system, factor), start: MotionStart { time, state }, until }
    };
    (0..VARIANTS).map(variant).collect()
}

/// Everything that identifies a run, in numbers that distinguish all bits.
fn trace(
    end: &Result<MotionEnd, MotionStopped>,
    recorder: &MotionRecorder,
    sampler: &MotionSampler,
) -> String {
    format!("{end:?} {recorder:?} {sampler:?}")
}

fn observer(case: &Case) -> (MotionRecorder, MotionSampler) {
    (MotionRecorder::default(), MotionSampler::new(case.start.time, 0.17, 1000))
}

/// The runs alone.
fn alone(cases: &[Case]) -> Vec<String> {
    let run = |case: &Case| {
        let motion = Motion::new(&case.system).expect("movable");
        let mut observer = observer(case);
        let end = motion.run(&case.start, case.until, MOTION_TOLERANCE, &mut observer);
        trace(&end, &observer.0, &observer.1)
    };
    cases.iter().map(run).collect()
}

/// The runs side by side, observed or not: without samples the engines of the runs see the steps with events alone.
fn side_by_side(set: InstructionSet, cases: &[Case], is_sampled: bool) -> Vec<String> {
    let motions: Vec<Motion<'_>> =
        cases.iter().map(|case| Motion::new(&case.system).expect("movable")).collect();
    let mut observers: Vec<_> = cases.iter().map(observer).collect();
    let requests = cases.iter().zip(&motions).zip(&mut observers);
    let requests = requests.map(|((case, motion), observer)| PlannedMotion {
        motion,
        start: case.start.clone(),
        until: case.until,
        observer: if is_sampled { observer } else { &mut observer.0 },
    });
    let ends = run_many_with(set, requests.collect(), MOTION_TOLERANCE);
    ends.iter()
        .zip(&observers)
        .map(|(end, (events, samples))| trace(end, events, samples))
        .collect()
}

/// Compares all runs with those alone on every instruction set.
fn compare(cases: &[Case], what: &str) {
    let alone = alone(cases);
    for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
        for (number, (found, alone)) in
            side_by_side(set, cases, true).iter().zip(&alone).enumerate()
        {
            assert_eq!(found, alone, "{what}, run {number}, {}", set.name());
        }
    }
    // The end and the events come before the samples.
    let unobserved = side_by_side(InstructionSet::widest(), cases, false);
    for (number, (found, alone)) in unobserved.iter().zip(&alone).enumerate() {
        let found = found.split(" MotionSampler").next().expect("a part");
        assert!(alone.starts_with(found), "{what}, run {number}: {found} {alone}");
    }
}

#[test]
fn random_systems_have_the_same_bits_alone_and_in_lanes() {
    let mut counts = [0; 2];
    for seed in 0..SYSTEMS {
        let mut cases = variants(seed);
        // Loads that vanish stop some runs, and open contacts in others.
        for case in cases.iter_mut().skip(1).step_by(3) {
            for input in &mut case.system.inputs {
                input.profile = scaled_profile(&input.profile, 4.0);
            }
        }
        compare(&cases, &format!("system {seed}"));
        for case in &cases {
            let motion = Motion::new(&case.system).expect("movable");
            match motion.run(&case.start, case.until, MOTION_TOLERANCE, &mut ()) {
                Ok(end) => counts[0] += end.events,
                Err(_) => counts[1] += 1,
            }
        }
    }
    println!("{} events, {} runs stopped", counts[0], counts[1]);
    assert!(counts[0] > 2000 && counts[1] > 10, "{counts:?}");
}

#[test]
fn systems_of_many_shapes_are_sorted_into_lanes() {
    let cases: Vec<Case> = (0..12).flat_map(variants).collect();
    // Neighbours in the queue have different shapes.
    let count = VARIANTS as usize;
    let order = (0..cases.len()).map(|place| (place % 12) * count + place / 12);
    let mut slots: Vec<Option<Case>> = cases.into_iter().map(Some).collect();
    let mixed: Vec<Case> = order.filter_map(|place| slots[place].take()).collect();
    assert_eq!(mixed.len(), 12 * count);
    compare(&mixed, "mixed");
}

/// Two relays that drive each other: with large `a` their events accumulate.
fn relays(a: f64) -> System {
    let rows = [[1.0, a], [-a, 1.0]];
    let contact = |place: usize| Contact {
        name: format!("relay {place}"),
        tangent: Some((0..2).map(|i| f64::from(u8::from(i == place))).collect()),
        force: Some((0..2).map(|i| rows[i][place]).collect()),
        normal: None,
        slope: None,
        normal_load: 1.0,
        normal_stiffness: 0.0,
        tangential_stiffness: None,
        normal_damping: 0.0,
        surface_velocity: Profile::constant(0.0),
        friction: Friction::Coulomb(Coulomb::constant(0.3)),
        varying_load: None,
    };
    let matrix = Matrix::from_fn(2, 2, |i, j| if i == j { -1.0 } else { 0.0 });
    let structure = StateSpace::new(vec!["a".to_owned(), "b".to_owned()], matrix).into();
    System { structure, contacts: (0..2).map(contact).collect(), inputs: Vec::new() }
}

#[test]
fn a_neighbour_whose_events_accumulate_changes_no_bit() {
    let case = |number: u32| {
        let a = if number.is_multiple_of(2) { 2.0 } else { 60.0 } + 0.01 * f64::from(number);
        let state = vec![-1e-3 * f64::from(1 + number), 0.0];
        Case { system: relays(a), start: MotionStart { time: 0.0, state }, until: 1.0 }
    };
    let cases: Vec<Case> = (0..40).map(case).collect();
    let is_zeno = |case: &Case| {
        let motion = Motion::new(&case.system).expect("a P-matrix");
        let stopped = motion.run(&case.start, case.until, MOTION_TOLERANCE, &mut ()).err();
        stopped.is_some_and(|why| matches!(why.reason, StopReason::Zeno { .. }))
    };
    let zeno = cases.iter().filter(|case| is_zeno(case)).count();
    assert!((10..=30).contains(&zeno), "{zeno}");
    compare(&cases, "relays");
}

#[test]
fn nothing_and_one_run_are_batches_too() {
    assert!(run_many(Vec::new(), MOTION_TOLERANCE).is_empty());
    compare(&variants(7)[..1], "one");
}
