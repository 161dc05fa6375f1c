//! Time per simulated dither period on the two workloads that the peers run too.
//!
//! `cargo run --release --package quell-belt --example speed` prints one JSON line;
//! `benches/peers/compare.py` runs it beside SciPy and heyoka and prints the ratios.
//! Each workload is repeated and the fastest pass counts: other work on the machine only slows.

use std::f64::consts::TAU;
use std::time::Instant;

use quell_belt::simulation::{InstructionSet, Run, Start, simulate, simulate_many_with};
use quell_model::{Belt, Direction, Dither, LawKind, Waveform};

/// Tolerance of the published speed figures.
const TOLERANCE: f64 = 1e-10;

/// Passes over a workload.
const PASSES: u32 = 60;

fn belt(law: LawKind, belt_velocity: f64, amplitude: f64, frequency_ratio: f64) -> Belt {
    let dither = Dither {
        direction: Direction::Tangential,
        waveform: Waveform::Sine,
        amplitude,
        frequency_ratio,
        phase: 0.0,
    };
    law.build(&[0.4, 0.2857, 0.2])
        .and_then(|friction| Belt::new(0.005, 1.0, belt_velocity, friction, vec![dither]))
        .expect("the workload is valid")
}

/// Fastest pass, in µs per dither period, and events per period.
fn measure(cases: &[(Belt, Start)], until: f64) -> (f64, f64) {
    let periods: f64 =
        cases.iter().map(|(belt, _)| belt.dithers()[0].frequency_ratio * until / TAU).sum();
    let mut fastest = f64::INFINITY;
    let mut events = 0;
    for _ in 0..PASSES {
        let began = Instant::now();
        events = 0;
        for (belt, start) in cases {
            let end = simulate(belt, *start, until, TOLERANCE, &mut ()).expect("no stall");
            events += end.events;
        }
        fastest = fastest.min(began.elapsed().as_secs_f64());
    }
    (fastest * 1e6 / periods, events as f64 / periods)
}

/// The same work side by side, each case `copies` times with belts a little different; fastest
/// pass, in µs per dither period.
fn measure_batch(set: InstructionSet, cases: &[(Belt, Start)], until: f64, copies: usize) -> f64 {
    let belts: Vec<(Belt, Start)> = (0..copies)
        .flat_map(|copy| {
            let scale = 1.0 + 1e-3 * copy as f64;
            cases.iter().map(move |(belt, start)| {
                let path = "dither.amplitude";
                let amplitude = belt.dithers()[0].amplitude * scale;
                (belt.with(path, amplitude).expect("the workload is valid"), *start)
            })
        })
        .collect();
    let periods: f64 =
        belts.iter().map(|(belt, _)| belt.dithers()[0].frequency_ratio * until / TAU).sum();
    let mut fastest = f64::INFINITY;
    for _ in 0..PASSES.div_ceil(copies as u32) {
        let mut observers = vec![(); belts.len()];
        let runs = belts
            .iter()
            .zip(&mut observers)
            .map(|((belt, start), observer)| Run { belt, start: *start, until, observer })
            .collect();
        let began = Instant::now();
        let outcomes = simulate_many_with(set, runs, TOLERANCE);
        fastest = fastest.min(began.elapsed().as_secs_f64());
        assert!(outcomes.iter().all(Result::is_ok), "no stall");
    }
    fastest * 1e6 / periods
}

fn main() {
    let mut stick_slip = Vec::new();
    for amplitude in [0.1, 0.3, 0.5, 0.8] {
        for ratio in [5.0, 10.0] {
            stick_slip.push((belt(LawKind::Stribeck, 0.05, amplitude, ratio), Start::REST));
        }
    }
    let moved = Start { displacement: 0.2, ..Start::REST };
    let event_free = [(belt(LawKind::Decreasing, 1.0, 2.0, 10.0), moved)];
    let (slipping, events) = measure(&stick_slip, 200.0);
    let (free, _) = measure(&event_free, 2000.0);
    for set in InstructionSet::ALL.into_iter().filter(|set| {
        set.is_available() && (std::env::var("ONLY").map_or(true, |o| o == set.name()))
    }) {
        println!(
            "{} stick-slip {:.3} event-free {:.3}",
            set.name(),
            measure_batch(set, &stick_slip, 200.0, 32),
            measure_batch(set, &event_free, 2000.0, 32)
        );
    }
    println!(
        "{{\"stick_slip\": {slipping:.3}, \"events_per_period\": {events:.3}, \"event_free\": {free:.3}}}"
    );
}
