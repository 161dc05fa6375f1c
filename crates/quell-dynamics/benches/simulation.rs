//! Speed of the event-exact engine on the workloads that are also run with the peers
//! (`benches/peers/`): time per simulated dither period, alone and side by side.
//!
//! Before criterion measures, the gains of running side by side are checked against the limits below:
//! ratios within one process, because absolute times depend more on the machine than on the code.

#[path = "workloads/mod.rs"]
mod workloads;

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group};
use quell_dynamics::simulation::InstructionSet;
use workloads::Workload;

/// Least speed-up of a workload side by side over alone, for each instruction set.
const GAINS: [(InstructionSet, [f64; 2]); 2] =
    [(InstructionSet::Avx512, [1.6, 5.0]), (InstructionSet::Avx2, [1.5, 3.2])];

/// Panics if a gain is below its limit in each of five attempts.
fn check_gains() {
    for (set, limits) in GAINS.into_iter().filter(|(set, _)| set.is_available()) {
        for (workload, limit) in
            [Workload::stick_slip(), Workload::event_free()].into_iter().zip(limits)
        {
            let many = workload.multiplied(32);
            let gain =
                (0..5).map(|_| workload.time_alone() / many.time_together(set)).fold(0.0, f64::max);
            println!("{}, {}: {gain:.2} × alone, at least {limit}", workload.name, set.name());
            assert!(gain >= limit, "{} on {}: too slow side by side", workload.name, set.name());
        }
    }
}

fn dither_periods(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("belt");
    for workload in [Workload::stick_slip(), Workload::event_free()] {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
        let periods = |workload: &Workload| Throughput::Elements(workload.periods() as u64);
        group.throughput(periods(&workload));
        group.bench_function(format!("{}, alone", workload.name), |bencher| {
            bencher.iter(|| black_box(&workload).pass_alone());
        });
        let many = workload.multiplied(32);
        group.throughput(periods(&many));
        for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
            group.bench_function(format!("{}, {}", workload.name, set.name()), |bencher| {
                bencher.iter(|| black_box(&many).pass_together(set));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, dither_periods);

fn main() {
    check_gains();
    benches();
    Criterion::default().configure_from_args().final_summary();
}
