//! The simulation: bits, work, lengths, and dither without amplitude.

use quell_dynamics::simulation::{
    DEFAULT_TOLERANCE, Event, EventRecorder, FinalState, InstructionSet, Sample, Sampler,
    SimulationRun, Start, simulate, simulate_many_with,
};
use quell_model::{Belt, Dither};
use quell_zoo::{BeltExt, all_belts};

use crate::balance::balanced;

/// How long the runs are, τ.
const UNTIL: f64 = 60.0;

/// A start that slips backwards, off every symmetric state.
const START: Start = Start { time: 0.0, displacement: 0.1, velocity: -0.2 };

fn run(belt: &Belt, start: Start) -> (FinalState, Vec<Event>) {
    let mut record = EventRecorder::default();
    let end = simulate(belt, start, UNTIL, DEFAULT_TOLERANCE, &mut record).expect("no stall");
    (end, record.events)
}

/// Everything that observers receive.
type Trace = (FinalState, Vec<Event>, Vec<Sample>);

#[test]
fn a_run_has_the_same_bits_alone_and_side_by_side() {
    let belts = all_belts();
    let watch = || (EventRecorder::default(), Sampler::new(0.0, 0.7, 80));
    let alone: Vec<Trace> = belts
        .iter()
        .map(|named| {
            let mut watch = watch();
            let end = simulate(&named.model, START, UNTIL, DEFAULT_TOLERANCE, &mut watch);
            (end.expect("no stall"), watch.0.events, watch.1.samples)
        })
        .collect();
    assert!(alone.iter().map(|(_, events, _)| events.len()).sum::<usize>() > 1000);
    for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
        let mut watches: Vec<_> = belts.iter().map(|_| watch()).collect();
        let runs = belts
            .iter()
            .zip(&mut watches)
            .map(|(named, observer)| SimulationRun {
                belt: &named.model,
                start: START,
                until: UNTIL,
                observer,
            })
            .collect();
        let ends = simulate_many_with(set, runs, DEFAULT_TOLERANCE);
        for (((end, watch), alone), named) in ends.into_iter().zip(watches).zip(&alone).zip(&belts)
        {
            let together = (end.expect("no stall"), watch.0.events, watch.1.samples);
            assert_eq!(together, *alone, "{}, {}", named.name, set.name());
        }
    }
}

/// Largest residual of a segment's balance, in its own units. Under both dithers the velocity of the decreasing belt has an
/// error of 87 tolerances after one step of h = 0.115 (47 in work), over which its exponential grows by e²: the last two
/// retained terms, below the tolerance, do not bound the rest there.
const RESIDUAL: f64 = 100.0;

/// The change of energy is the work of friction, damping and dither, segment by segment.
#[test]
fn work_closes_the_energy_balance() {
    let (mut steps, mut worst) = (0, 0.0_f64);
    for named in all_belts() {
        for start in [Start::REST, START] {
            let balanced = balanced(&named.model, start, UNTIL, RESIDUAL);
            steps += balanced.steps;
            worst = worst.max(balanced.worst);
        }
    }
    println!("{steps} steps, largest residual {worst:.1} tolerances");
    assert!(steps > 60_000, "{steps}");
}

/// With all lengths and velocities multiplied by a power of two, every event time is equal in the last bit, and every state is
/// multiplied exactly.
#[test]
fn lengths_scale_out_to_the_last_bit() {
    let scale = 2f64.powi(-20);
    for named in all_belts() {
        let scaled = |value: f64| value * scale;
        let small_start = Start {
            displacement: scaled(START.displacement),
            velocity: scaled(START.velocity),
            ..START
        };
        let (end, events) = run(&named.model, START);
        let (small, small_events) = run(&named.model.scaled(scale), small_start);
        assert_eq!(events.len(), small_events.len(), "{}", named.name);
        for (event, small) in events.iter().zip(&small_events) {
            assert_eq!(event.time.to_bits(), small.time.to_bits(), "{}", named.name);
            assert_eq!((event.kind, event.slip_sign), (small.kind, small.slip_sign));
            assert_eq!(scaled(event.displacement), small.displacement, "{}", named.name);
        }
        assert_eq!(scaled(end.displacement), small.displacement, "{}", named.name);
        assert_eq!(scaled(end.velocity), small.velocity, "{}", named.name);
    }
}

/// A dither of amplitude zero shortens steps, at most: events and states are those without dither.
#[test]
fn dither_of_amplitude_zero_is_no_dither() {
    for named in all_belts() {
        let belt = &named.model;
        let none = |dither: &Dither| Dither { amplitude: 0.0, ..dither.clone() };
        let silent = belt.with_dithers(belt.dithers().iter().map(none).collect());
        let (end, events) = run(&belt.undithered(), START);
        let (other, other_events) = run(&silent, START);
        assert_eq!(events.len(), other_events.len(), "{}", named.name);
        for (event, other) in events.iter().zip(&other_events) {
            assert_eq!((event.kind, event.slip_sign), (other.kind, other.slip_sign));
            assert!((event.time - other.time).abs() < 1e-9, "{}: {event:?}", named.name);
        }
        assert!((end.displacement - other.displacement).abs() < 1e-9, "{}", named.name);
        assert!((end.velocity - other.velocity).abs() < 1e-9, "{}", named.name);
    }
}
