//! Errors in the dissertation's words and numbers about motions: each printed statement against exact trajectories
//! and orbits.

use core::f64::consts::TAU;

use quell_dynamics::response::{PEAK_FLOOR, Solver};
use quell_dynamics::simulation::{EventKind, EventRecorder, Sampler, Start, simulate};
use quell_model::{Belt, Waveform};
use quell_numerics::interval::RealInterval;
use quell_zoo::BeltExt;
use quell_zoo::belt::{self, chapter_4, over_amplitudes, stribeck_under};
use quell_zoo::dither::{normal, sine};

use crate::{local_thresholds, response_of};

const TOLERANCE: f64 = 1e-12;

/// μ_m = 0.2587 is a misprint of 0.2857: the printed law squeals at 0.5925 ω₀, the text says 0.666 (measured: 0.6544).
#[test]
fn minimum_coefficient() {
    let frequency = |minimum: f64| {
        let belt = belt::stribeck().with_law_number("friction.minimum_coefficient", minimum);
        let mut recorder = EventRecorder::default();
        simulate(&belt, Start::REST, 600.0, TOLERANCE, &mut recorder).expect("no stall");
        let sticks: Vec<f64> = recorder
            .events
            .iter()
            .filter(|event| event.kind == EventKind::Stick)
            .map(|event| event.time)
            .collect();
        TAU / (sticks[sticks.len() - 1] - sticks[sticks.len() - 2])
    };
    let (printed, right) = (frequency(0.2587), frequency(0.2857));
    assert!((right - 0.654_435).abs() < 1e-6, "{right}");
    assert!((printed - 0.5925).abs() < 1e-4, "{printed}");
    assert!((right - 0.666).abs() < 0.02 * 0.666 && (printed - 0.666).abs() > 0.1 * 0.666);
}

/// "Reduced further by decreasing the frequency ratio": the forced part is D/(R² − 1) and grows.
#[test]
fn forced_amplitude_grows_as_the_ratio_falls() {
    let amplitude = |ratio: f64| {
        let belt = belt::stribeck().with_dither(sine(0.5, ratio));
        let response = response_of(&belt, Start::REST, &Solver::default());
        let peaks = response.dithered.spectrum.peaks(PEAK_FLOOR);
        let near = peaks.iter().filter(|peak| (peak.frequency - ratio).abs() < 0.1);
        near.map(|peak| peak.amplitude).fold(0.0, f64::max)
    };
    // At R = 10 the mass only just keeps sliding, and its forced motion is the linear one; at lower R, friction changes
    // sign within each period and reduces it.
    let linear = |ratio: f64| 0.5 / (ratio * ratio - 1.0);
    assert!((amplitude(10.0) / linear(10.0) - 1.0).abs() < 0.005, "{}", amplitude(10.0));
    for ratio in [9.0, 8.0] {
        assert!(amplitude(ratio) < linear(ratio) && amplitude(ratio) > 0.9 * linear(ratio));
    }
    assert!(amplitude(8.0) > amplitude(9.0) && amplitude(9.0) > amplitude(10.0));
}

/// Largest spectral amplitude of a record over 0 < ω ≤ 1.9, Hann window, with or without its mean.
fn largest(samples: &[f64], step: f64, mean_removed: bool) -> f64 {
    let count = samples.len() as f64;
    let window: Vec<f64> =
        (0..samples.len()).map(|k| 0.5 - 0.5 * (TAU * k as f64 / count).cos()).collect();
    let sum: f64 = window.iter().sum();
    let mean = samples.iter().zip(&window).map(|(x, w)| x * w).sum::<f64>() / sum;
    let mean = if mean_removed { mean } else { 0.0 };
    let at = |frequency: f64| {
        let (mut re, mut im) = (0.0, 0.0);
        for (k, (x, w)) in samples.iter().zip(&window).enumerate() {
            let angle = frequency * step * k as f64;
            re += w * (x - mean) * angle.cos();
            im += w * (x - mean) * angle.sin();
        }
        2.0 * re.hypot(im) / sum
    };
    (1..=1900).map(|k| at(1e-3 * f64::from(k))).fold(0.0, f64::max)
}

/// E = M₁/M₀ (2.27) exceeds 1 for any dither as long as the mean is left in the record.
#[test]
fn efficiency_needs_the_mean_removed() {
    let dithered = stribeck_under(Waveform::Sine, 0.45);
    let record = |belt: &Belt| -> Vec<f64> {
        let mut sampler = Sampler::new(600.0, 0.1, 1257);
        simulate(belt, Start::REST, 726.0, TOLERANCE, &mut sampler).expect("no stall");
        sampler.samples.iter().map(|sample| sample.displacement).collect()
    };
    let (with, without) = (record(&dithered), record(&dithered.undithered()));
    let residual_vibration =
        |removed: bool| largest(&with, 0.1, removed) / largest(&without, 0.1, removed);
    let (printed, right) = (residual_vibration(false), residual_vibration(true));
    assert!(printed > 1.0, "{printed}");
    assert!((right - 0.127).abs() < 0.01, "{right}");
}

/// "Stable without dither above v₂": from x = 1.5 the same belt continues to squeal.
#[test]
fn a_cycle_coexists_with_stable_sliding() {
    let belt = belt::decreasing();
    let spread = |displacement: f64| {
        let start = Start { displacement, ..Start::REST };
        let mut sampler = Sampler::new(1500.0, 0.05, 500);
        simulate(&belt, start, 1526.0, TOLERANCE, &mut sampler).expect("no stall");
        let values = sampler.samples.iter().map(|sample| sample.displacement);
        values.clone().fold(f64::MIN, f64::max) - values.fold(f64::MAX, f64::min)
    };
    assert!(spread(0.0) < 0.05);
    assert!((spread(1.5) - 2.09).abs() < 0.02, "{}", spread(1.5));
}

/// Figure 4.11 is captioned as a square wave; its pattern (stable at 0.6, unstable from 0.7, stable again at 0.9 to 0.95)
/// is the sine's.
#[test]
fn figure_4_11_shows_the_sine() {
    let found = |waveform: Waveform| -> Vec<f64> {
        let belt = chapter_4().with_dither(normal(waveform, 0.1, 5.0));
        let thresholds =
            local_thresholds(&over_amplitudes(&belt), RealInterval::new(0.1, 0.99), 60);
        thresholds.iter().map(|threshold| threshold.value).collect()
    };
    for (waveform, known) in [
        (Waveform::Square, [0.553_840_4, 0.614_698_468]),
        (Waveform::Sine, [0.710_299_1, 0.965_369_470]),
    ] {
        let found = found(waveform.clone());
        assert_eq!(found.len(), 2, "{waveform:?}: {found:?}");
        for (found, known) in found.iter().zip(known) {
            assert!((found - known).abs() < 1e-6, "{waveform:?}: {found} {known}");
        }
    }
}

/// The caption of figure 2.11 prints v₀ = 1.0. At 1.5 the run from rest settles with D = 6.5 and vibrates with 14, as shown; at
/// 1.0 it is the reverse.
#[test]
fn figure_2_11_is_at_one_and_a_half() {
    let settles = |velocity: f64, amplitude: f64| {
        let belt = belt::decreasing().at_speed(velocity).with_dither(sine(amplitude, 10.0));
        let solver = Solver { settle: 4000.0, ..Solver::default() };
        response_of(&belt, Start::REST, &solver).dithered.lines.whole < 1e-3
    };
    assert_eq!([settles(1.5, 6.5), settles(1.5, 14.0)], [true, false]);
    assert_eq!([settles(1.0, 6.5), settles(1.0, 14.0)], [false, true]);
}
