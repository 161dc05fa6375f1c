//! Time per piece of a sampled dither: a sine of n samples, linear between them or held, on the two workloads of `speed`.
//!
//! `cargo run --release --package quell-dynamics --example sampled_speed` prints one JSON line for each workload, hold and n: µs per
//! piece alone (one run after the other) and side by side on every instruction set of the machine.

#[path = "../benches/workloads/mod.rs"]
mod workloads;

use std::f64::consts::TAU;

use quell_dynamics::simulation::InstructionSet;
use quell_model::waveform::{Hold, SampledWave};
use quell_model::{Belt, Waveform};
use workloads::Workload;

/// The belt whose dither is a sampled sine.
fn sampled(belt: &Belt, count: u32, hold: Hold) -> Belt {
    let values = (0..count).map(|k| (TAU * f64::from(k) / f64::from(count)).sin()).collect();
    let wave = SampledWave::new(values, hold).expect("samples");
    let mut dithers = belt.dithers().to_vec();
    dithers[0].waveform = Waveform::Samples(wave.into());
    belt.dithered_by(dithers).expect("a belt")
}

fn main() {
    for workload in [Workload::stick_slip(), Workload::event_free()] {
        for hold in [Hold::Linear, Hold::Zero] {
            for count in [20_u32, 100, 1000] {
                let cases = workload.cases.iter();
                let cases = cases.map(|(belt, start)| (sampled(belt, count, hold), *start));
                // About as many pieces for every n, over several periods of the dither at least.
                let until = workload.until * (10.0 / f64::from(count) + 0.01);
                let one = Workload { name: workload.name, cases: cases.collect(), until };
                let each = |microseconds: f64| microseconds / f64::from(count);
                let mut times = vec![format!("\"alone\": {:.4}", each(one.time_alone()))];
                let many = one.multiplied(16);
                for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
                    times.push(format!("\"{}\": {:.4}", set.name(), each(many.time_together(set))));
                }
                println!(
                    "{{\"workload\": \"{}\", \"hold\": \"{}\", \"samples\": {count}, {}}}",
                    workload.name,
                    hold.name(),
                    times.join(", ")
                );
            }
        }
    }
}
