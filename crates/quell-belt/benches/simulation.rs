//! Speed of the event-exact engine on the workloads that the peers run too
//! (`benches/peers/`): time per simulated dither period.

use std::f64::consts::TAU;
use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use quell_belt::simulation::{Start, simulate};
use quell_model::{Belt, Direction, Dither, LawKind, Waveform};

/// Tolerance of the published speed figures.
const TOLERANCE: f64 = 1e-10;

fn belt(law: LawKind, belt_velocity: f64, amplitude: f64, frequency_ratio: f64) -> Belt {
    let friction = law.build(&[0.4, 0.2857, 0.2]).expect("valid law");
    let dither = Dither {
        direction: Direction::Tangential,
        waveform: Waveform::Sine,
        amplitude,
        frequency_ratio,
        phase: 0.0,
    };
    Belt::new(0.005, 1.0, belt_velocity, friction, vec![dither]).expect("valid belt")
}

/// Stribeck, v₀ = 0.05, D × R as below, from rest to τ = 200: about 1.7 events per period.
fn stick_slip(criterion: &mut Criterion) {
    let mut cases = Vec::new();
    let mut periods = 0.0;
    for amplitude in [0.1, 0.3, 0.5, 0.8] {
        for ratio in [5.0, 10.0] {
            cases.push(belt(LawKind::Stribeck, 0.05, amplitude, ratio));
            periods += ratio * 200.0 / TAU;
        }
    }
    let mut group = criterion.benchmark_group("belt");
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
    group.throughput(Throughput::Elements(periods as u64));
    group.bench_function("stick-slip, per dither period", |bencher| {
        bencher.iter(|| {
            for case in &cases {
                let end = simulate(black_box(case), Start::REST, 200.0, TOLERANCE, &mut ());
                black_box(end).expect("no stall");
            }
        });
    });
    group.finish();
}

/// Decreasing law, v₀ = 1, D = 2, R = 10, from x = 0.2 to τ = 2000: no event.
fn event_free(criterion: &mut Criterion) {
    let case = belt(LawKind::Decreasing, 1.0, 2.0, 10.0);
    let start = Start { displacement: 0.2, ..Start::REST };
    let mut group = criterion.benchmark_group("belt");
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
    group.throughput(Throughput::Elements((2000.0 * 10.0 / TAU) as u64));
    group.bench_function("event-free, per dither period", |bencher| {
        bencher.iter(|| {
            let end = simulate(black_box(&case), start, 2000.0, TOLERANCE, &mut ());
            black_box(end).expect("no stall");
        });
    });
    group.finish();
}

criterion_group!(benches, stick_slip, event_free);
criterion_main!(benches);
