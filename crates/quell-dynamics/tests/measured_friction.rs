//! Effective friction measured on trajectories, against its exact value.

use std::f64::consts::TAU;

use quell_dynamics::response::measured_effective_friction;
use quell_dynamics::simulation::Start;
use quell_model::{Belt, Waveform};
use quell_zoo as zoo;
use quell_zoo::dither::normal;

fn belt(belt_velocity: f64, damping_ratio: f64, amplitude: f64) -> Belt {
    let dithers = vec![normal(Waveform::Sine, amplitude, 5.0)];
    zoo::belt::belt(damping_ratio, belt_velocity, zoo::law::decreasing(), dithers)
}

fn at(displacement: f64) -> Start {
    Start { time: 0.0, displacement, velocity: 0.0 }
}

/// Without dither the mean over a window is the mean of the law over the slip in it: a point of the law as long as
/// the velocity is nearly constant.
#[test]
fn without_dither_the_points_lie_on_the_law() {
    let belt = belt(1.5, 0.05, 0.0);
    let start = at(belt.steady_sliding() + 1e-4);
    let means = measured_effective_friction(&belt, 5.0, &[start], 40.0, 4, 1e-12).expect("runs");
    assert_eq!(means.len(), 124, "40 τ hold 127 quarter periods, hence 124 windows of four");
    for (index, mean) in means.iter().enumerate() {
        // The slow velocity changes by the difference of the windows half a period before and after.
        let ends =
            index.checked_sub(2).and_then(|before| Some((means[before], *means.get(index + 2)?)));
        let drift = ends.map(|(before, after)| after.slip_velocity - before.slip_velocity);
        assert_eq!(mean.drift, drift);
        let law = belt.friction().coefficient(mean.slip_velocity);
        assert!((mean.coefficient - law).abs() < 1e-9, "{mean:?} against {law}");
    }
}

/// The balance of momentum over one window: x′ + 2ζx and ∫x change by the friction impulse. With constant load
/// (D = 0) the impulse is the mean coefficient times F.
#[test]
fn the_impulse_closes_the_balance_of_momentum() {
    use quell_dynamics::simulation::{Sampler, simulate};
    let belt = belt(0.3, 0.01, 0.0);
    let start = at(0.45);
    let window = TAU / 5.0;
    let means =
        measured_effective_friction(&belt, 5.0, &[start], window * 1.01, 2, 1e-13).expect("runs");
    let mut sampler = Sampler::new(0.0, window / 4000.0, 4001);
    simulate(&belt, start, window * 1.01, 1e-13, &mut sampler).expect("runs");
    let samples = &sampler.samples;
    // Simpson's rule for ∫x.
    let integral: f64 = samples
        .iter()
        .enumerate()
        .map(|(k, sample)| {
            let weight = if k == 0 || k == 4000 {
                1.0
            } else if k % 2 == 1 {
                4.0
            } else {
                2.0
            };
            weight * sample.displacement
        })
        .sum::<f64>()
        * window
        / 4000.0
        / 3.0;
    let change = samples[4000].velocity - samples[0].velocity
        + 0.02 * (samples[4000].displacement - samples[0].displacement);
    let expected = (change + integral) / window;
    assert_eq!(means.len(), 1);
    assert!((means[0].coefficient - expected).abs() < 1e-11, "{} {expected}", means[0].coefficient);
}

/// Windows with stick are dropped: on a stick-slip cycle some of the time is missing, and no mean exceeds μ_s.
#[test]
fn windows_with_stick_are_dropped() {
    let belt = belt(0.05, 0.005, 0.3);
    let means = measured_effective_friction(&belt, 5.0, &[at(0.45)], 60.0, 8, 1e-12).expect("runs");
    assert!(means.len() > 20 && means.len() < 8 * 47, "{}", means.len());
    assert!(means.iter().all(|mean| mean.coefficient.abs() <= 0.4));
}
