//! Time per simulated dither period on the two workloads that are also run with the peers.
//!
//! `cargo run --release --package quell-dynamics --example speed` prints one JSON line: each workload
//! alone (one run after the other) and side by side on every instruction set of the machine.
//! `benches/peers/compare.py` runs it together with SciPy and heyoka and prints the ratios.
//! Each measurement is repeated and the fastest pass counts, because other work on the machine can only slow it down.

#[path = "../benches/workloads/mod.rs"]
mod workloads;

use quell_dynamics::simulation::InstructionSet;
use workloads::Workload;

fn main() {
    let mut fields = Vec::new();
    for workload in [Workload::stick_slip(), Workload::event_free()] {
        let alone = workload.time_alone();
        let mut times = vec![format!("\"alone\": {alone:.4}")];
        let many = workload.multiplied(32);
        for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
            times.push(format!("\"{}\": {:.4}", set.name(), many.time_together(set)));
        }
        fields.push(format!("\"{}\": {{{}}}", workload.name, times.join(", ")));
    }
    println!("{{{}}}", fields.join(", "));
}
