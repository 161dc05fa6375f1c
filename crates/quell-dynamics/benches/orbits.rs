//! Cost of a period map, of exact thresholds and of curves of them, on one core.
//!
//! Before criterion measures, two limits are checked, each with the best of five attempts: a local threshold must take less than
//! 50 ms, a curve of 100 points less than 5 s.

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{Criterion, criterion_group};
use quell_dynamics::orbit::{
    ThresholdPlane, base_response, branch_thresholds, near, threshold_curves,
};
use quell_model::{Belt, Direction, Dither, LawKind, Waveform};
use quell_numerics::interval::RealInterval;

fn belt(waveform: Waveform, amplitude: f64) -> Belt {
    let friction = LawKind::Decreasing.build(&[0.4, 0.2857, 0.2]).expect("a valid law");
    let dither = Dither {
        direction: Direction::Tangential,
        waveform,
        amplitude,
        frequency_ratio: 10.0,
        phase: 0.0,
        envelope: None,
    };
    Belt::new(0.005, 1.0, 1.0, friction, vec![dither]).expect("a valid belt")
}

fn both_thresholds(belt: &Belt) -> usize {
    let at = |values: &[f64]| Ok(belt.with_amplitude(0, values[0])?.system());
    branch_thresholds(&at, 0.5, 10.5, 40, None).expect("followed").thresholds.len()
}

/// Both thresholds of the amplitude over the belt's velocity, and the number of points.
fn both_curves(belt: &Belt) -> usize {
    let at = |values: &[f64]| {
        let belt = belt.with_belt_velocity(values[1])?;
        Ok(belt.with_amplitude(0, values[0])?.system())
    };
    let plane = ThresholdPlane {
        at: &at,
        window: RealInterval::new(0.1, 16.0),
        between: RealInterval::new(0.85, 1.5),
        points: 100,
    };
    let found = threshold_curves(&plane, 3).expect("curves").curves;
    found.iter().map(|curve| curve.points.len()).sum()
}

fn orbits(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("orbits");
    group.sample_size(10).measurement_time(Duration::from_secs(3));
    let slip = belt(Waveform::Sine, 5.0).system();
    let orbit = base_response(&slip, 8).expect("an orbit");
    group.bench_function("orbit from its own state (two period maps)", |bencher| {
        bencher.iter(|| near(black_box(&slip), &orbit.state, 1));
    });
    for waveform in [Waveform::Sine, Waveform::Square] {
        let belt = belt(waveform.clone(), 1.0);
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

/// Shortest time of five attempts, s.
fn shortest(mut work: impl FnMut()) -> f64 {
    let attempt = |_| {
        let begun = Instant::now();
        work();
        begun.elapsed().as_secs_f64()
    };
    (0..5).map(attempt).fold(f64::INFINITY, f64::min)
}

/// Panics if a threshold or a curve exceeds its time limit.
fn check_limits() {
    let belt = belt(Waveform::Sine, 1.0);
    let each = shortest(|| assert_eq!(both_thresholds(black_box(&belt)), 2)) / 2.0;
    println!("a local threshold: {:.1} ms, at most 50", 1e3 * each);
    assert!(each < 0.05, "a local threshold is too slow");
    let mut points = 0;
    let all = shortest(|| points = both_curves(black_box(&belt)));
    let hundred = 100.0 * all / points as f64;
    println!("100 points of a curve: {hundred:.3} s, at most 5");
    assert!(hundred < 5.0, "a curve of thresholds is too slow");
}

fn main() {
    check_limits();
    benches();
    Criterion::default().configure_from_args().final_summary();
}
