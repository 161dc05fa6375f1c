//! Cost of a period map, of exact thresholds and of curves of them: user time of one core.
//!
//! Limits: a local threshold costs under 50 ms, a curve of 100 points under 5 s. They are held here by the time
//! that this process itself has used, with the margin that a slower machine needs.

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, criterion_group};
use quell_belt::orbit::curve::{Plane, curves};
use quell_belt::orbit::threshold::local_thresholds;
use quell_belt::orbit::{from_sliding, near};
use quell_model::{Belt, Direction, Dither, LawKind, Waveform};

fn belt(waveform: Waveform, amplitude: f64) -> Belt {
    let friction = LawKind::Decreasing.build(&[0.4, 0.2857, 0.2]).expect("a valid law");
    let dither = Dither {
        direction: Direction::Tangential,
        waveform,
        amplitude,
        frequency_ratio: 10.0,
        phase: 0.0,
    };
    Belt::new(0.005, 1.0, 1.0, friction, vec![dither]).expect("a valid belt")
}

fn both_thresholds(belt: &Belt) -> usize {
    local_thresholds(belt, "dither.amplitude", 0.5, 10.5, 40).expect("followed").len()
}

/// Both thresholds of the amplitude over the belt's velocity, and the number of points.
fn both_curves(belt: &Belt) -> usize {
    let plane = Plane {
        path: "dither.amplitude",
        window: (0.1, 16.0),
        along: "belt.belt_velocity",
        between: (0.85, 1.5),
    };
    let found = curves(belt, plane, 3, 100).expect("curves");
    found.iter().map(|it| it.points.len()).sum()
}

fn orbits(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("orbits");
    group.sample_size(10).measurement_time(Duration::from_secs(3));
    let slip = belt(Waveform::Sine, 5.0);
    let orbit = from_sliding(&slip, 8).expect("an orbit");
    group.bench_function("orbit from its own state (two period maps)", |bencher| {
        bencher.iter(|| near(black_box(&slip), orbit.start, 1));
    });
    for waveform in [Waveform::Sine, Waveform::Square] {
        let belt = belt(waveform, 1.0);
        assert_eq!(both_thresholds(&belt), 2);
        group.bench_function(
            format!("both thresholds of the amplitude, {}", waveform.name()),
            |bencher| {
                bencher.iter(|| both_thresholds(black_box(&belt)));
            },
        );
    }
    let belt = belt(Waveform::Sine, 1.0);
    let points = both_curves(&belt);
    assert!(points > 100);
    group.bench_function(
        format!("two curves over the belt's velocity, {points} points"),
        |bencher| {
            bencher.iter(|| both_curves(black_box(&belt)));
        },
    );
    group.finish();
}

criterion_group!(benches, orbits);

fn main() {
    benches();
    Criterion::default().configure_from_args().final_summary();
}
