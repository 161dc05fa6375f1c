//! Times of the general engine: belts written as systems next to the own engine of belts, two masses on two contacts, and many modes.
//!
//! `cargo run --release --package quell-dynamics --example motion_speed` prints one JSON line: microseconds per dither period of a
//! belt by its own engine and as a system, of two masses alone and in a batch of 64, and microseconds per step over the number of modes.
//! Each measurement is repeated and the fastest pass counts, because other work on the machine can only slow it down.

use std::f64::consts::TAU;
use std::time::Instant;

use quell_dynamics::motion::{MOTION_TOLERANCE, Motion, MotionStart, PlannedMotion, run_many};
use quell_dynamics::simulation::{Start, simulate};
use quell_model::friction::Friction;
use quell_model::profile::{Profile, Wave};
use quell_model::system::{Contact, Input, InputTarget, MassMatrix, Mechanical};
use quell_model::{Belt, Direction, Dither, LawKind, System, Waveform};
use quell_numerics::matrix::Matrix;

const PASSES: u32 = 9;

/// Runs of a batch.
const BATCH: usize = 64;

/// The least time of several passes, in microseconds.
fn fastest(mut work: impl FnMut()) -> f64 {
    let pass = |work: &mut dyn FnMut()| {
        let begin = Instant::now();
        work();
        begin.elapsed().as_secs_f64() * 1e6
    };
    (0..PASSES).map(|_| pass(&mut work)).fold(f64::INFINITY, f64::min)
}

fn law() -> Friction {
    LawKind::Stribeck.build(&[0.4, 0.2857, 0.2]).expect("valid law")
}

fn sine(amplitude: f64, frequency: f64) -> Wave {
    Wave { waveform: Waveform::Sine, amplitude, frequency, phase: 0.0, envelope: None }
}

fn contact(tangent: Vec<f64>, velocity: f64) -> Contact {
    Contact {
        name: "pad".to_owned(),
        tangent: Some(tangent),
        force: None,
        normal: None,
        slope: None,
        normal_load: 1.0,
        normal_stiffness: 0.0,
        tangential_stiffness: None,
        normal_damping: 0.0,
        surface_velocity: Profile::constant(velocity),
        friction: law(),
        varying_load: None,
    }
}

/// Masses in a row with dither on the first.
fn chain(masses: usize, contacts: usize, amplitude: f64) -> System {
    let stiffness = Matrix::from_fn(masses, masses, |i, j| match i.abs_diff(j) {
        0 => 2.2,
        1 => -1.2,
        _ => 0.0,
    });
    let damping = Matrix::from_fn(masses, masses, |i, j| if i == j { 0.02 } else { 0.0 });
    let names = (0..masses).map(|i| format!("x{i}")).collect();
    let unit = |at: usize| (0..masses).map(|i| f64::from(u8::from(i == at))).collect::<Vec<_>>();
    let mass = MassMatrix::dense(Matrix::identity(masses));
    let input = Input {
        target: InputTarget::Force(unit(0)),
        profile: Profile::default().with(sine(amplitude, 10.0)),
    };
    System {
        structure: Mechanical::new(names, mass, damping, stiffness).into(),
        contacts: (0..contacts).map(|c| contact(unit(c), 0.05)).collect(),
        inputs: vec![input],
    }
}

/// Modes of a bowed string with one contact.
fn modes(count: usize) -> System {
    let frequency = |i: usize| 1.0 + i as f64 / count as f64;
    let diagonal = |entry: &dyn Fn(usize) -> f64| {
        Matrix::from_fn(count, count, |i, j| if i == j { entry(i) } else { 0.0 })
    };
    let row = (0..count).map(|i| (2.3 * (i + 1) as f64).sin() / (count as f64).sqrt()).collect();
    let names = (0..count).map(|i| format!("q{i}")).collect();
    let stiffness = diagonal(&|i| frequency(i) * frequency(i));
    let damping = diagonal(&|i| 0.002 * frequency(i));
    System {
        structure: Mechanical::new(names, MassMatrix::identity(count), damping, stiffness).into(),
        contacts: vec![contact(row, 0.05)],
        inputs: Vec::new(),
    }
}

fn run(system: &System, until: f64) -> (f64, u64, u64) {
    let motion = Motion::new(system).expect("movable");
    let start = MotionStart { time: 0.0, state: vec![0.0; motion.size()] };
    let mut counts = (0, 0);
    let time = fastest(|| {
        let end = motion.run(&start, until, MOTION_TOLERANCE, &mut ()).expect("an end");
        counts = (end.steps, end.events);
    });
    (time, counts.0, counts.1)
}

/// Times of a batch of two masses with different amplitudes: one run after the other, and side by side.
fn batch(until: f64) -> [f64; 2] {
    let systems: Vec<System> =
        (0..BATCH).map(|number| chain(2, 2, 0.3 + 0.2 * number as f64 / BATCH as f64)).collect();
    let motions: Vec<Motion<'_>> =
        systems.iter().map(|system| Motion::new(system).expect("movable")).collect();
    let start = MotionStart { time: 0.0, state: vec![0.0; 4] };
    let alone = fastest(|| {
        for motion in &motions {
            let _ = motion.run(&start, until, MOTION_TOLERANCE, &mut ()).expect("an end");
        }
    });
    let side_by_side =
        fastest(|| {
            let mut observers = [(); BATCH];
            let requests = motions.iter().zip(&mut observers).map(|(motion, observer)| {
                PlannedMotion { motion, start: start.clone(), until, observer }
            });
            let _ = run_many(requests.collect(), MOTION_TOLERANCE);
        });
    [alone, side_by_side]
}

fn main() {
    let until = 200.0;
    let (mut own, mut general, mut periods) = (0.0, 0.0, 0.0);
    let (mut steps, mut own_steps) = (0, 0);
    for amplitude in [0.1, 0.3, 0.5, 0.8] {
        for ratio in [5.0, 10.0] {
            let dither = Dither {
                direction: Direction::Tangential,
                waveform: Waveform::Sine,
                amplitude,
                frequency_ratio: ratio,
                phase: 0.0,
                envelope: None,
            };
            let belt = Belt::new(0.005, 1.0, 0.05, law(), vec![dither]).expect("valid");
            own += fastest(|| {
                let end = simulate(&belt, Start::REST, until, 1e-13, &mut ()).expect("an end");
                own_steps += end.steps;
            });
            let (time, count, _) = run(&belt.system(), until);
            general += time;
            steps += count;
            periods += until * ratio / TAU;
        }
    }
    let own_steps = own_steps / u64::from(PASSES);
    let two = run(&chain(2, 2, 0.4), until);
    let [alone, side_by_side] = batch(until);
    let batch_periods = BATCH as f64 * until * 10.0 / TAU;
    let mut modal = Vec::new();
    for count in [2, 10, 50, 100, 200] {
        let (time, steps, _) = run(&modes(count), 400.0);
        modal.push(format!("\"{count}\": {:.4}", time / steps as f64));
    }
    println!(
        "{{\"belt\": {:.4}, \"belt as a system\": {:.4}, \"steps\": [{own_steps}, {steps}], \"two masses\": {:.4}, \"two masses, per step\": {:.4}, \"two masses, events\": {}, \"64 times two masses\": {:.4}, \"64 times two masses, in lanes\": {:.4}, \"modes, per step\": {{{}}}}}",
        own / periods,
        general / periods,
        two.0 / (until * 10.0 / TAU),
        two.0 / two.1 as f64,
        two.2,
        alone / batch_periods,
        side_by_side / batch_periods,
        modal.join(", ")
    );
}
