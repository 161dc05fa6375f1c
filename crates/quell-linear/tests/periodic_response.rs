//! The periodic response of linear structures: against harmonic responses, closed forms, integration and other waveforms.

#![allow(clippy::unwrap_used, reason = "tests")]

use std::f64::consts::TAU;

use quell_linear::averaging::{
    Averaging, DitheredSystem, FastMotion, FastWave, criterion, critical_amplitudes,
};
use quell_linear::periodic_response::{NoPeriodicResponse, ResponseToWave};
use quell_model::waveform::{Burst, FourierWave, Harmonic, Hold, SampledWave};
use quell_model::{Belt, Direction, Dither, LawKind, Waveform};
use quell_numerics::matrix::Matrix;

/// A damped oscillator of unit frequency.
fn oscillator(damping_ratio: f64) -> Matrix {
    Matrix::from_fn(2, 2, |i, j| [[0.0, 1.0], [-1.0, -2.0 * damping_ratio]][i][j])
}

fn samples(values: Vec<f64>, hold: Hold) -> Waveform {
    Waveform::Samples(SampledWave::new(values, hold).unwrap().into())
}

fn dither(waveform: Waveform, amplitude: f64, frequency_ratio: f64) -> Dither {
    let (direction, phase) = (Direction::Tangential, 0.3);
    Dither { direction, waveform, amplitude, frequency_ratio, phase, envelope: None }
}

fn belt(damping_ratio: f64, dither: Dither) -> Belt {
    let law = LawKind::Stribeck.build(&[0.4, 0.2857, 0.2]).unwrap();
    Belt::new(damping_ratio, 1.0, 0.3, law, vec![dither]).unwrap()
}

#[test]
fn a_sine_and_a_sum_of_harmonics() {
    let (damping, ratio) = (0.05, 2.7);
    let harmonics = vec![
        Harmonic { order: 1, sine: 0.8, cosine: 0.1 },
        Harmonic { order: 5, sine: -0.3, cosine: 0.4 },
    ];
    let sum = Waveform::Fourier(FourierWave::new(harmonics.clone()).unwrap().into());
    let one = vec![Harmonic { order: 1, sine: 1.0, cosine: 0.0 }];
    for (waveform, harmonics) in [(Waveform::Sine, one), (sum, harmonics)] {
        let response =
            ResponseToWave::new(&oscillator(damping), &[0.0, 1.0], &waveform, ratio).unwrap();
        let outputs = response.outputs(&[(&[1.0, 0.0], 0.0), (&[0.0, 1.0], 0.0), (&[0.0; 2], 1.0)]);
        for k in 0..100 {
            let phase = 0.1 * f64::from(k);
            let exact = harmonics.iter().fold([0.0; 2], |[x, v], harmonic| {
                let order = f64::from(harmonic.order);
                let omega = order * ratio;
                let (elastic, loss) = (1.0 - omega * omega, 2.0 * damping * omega);
                let size = harmonic.amplitude() / elastic.hypot(loss);
                let angle = order * phase + harmonic.phase() - loss.atan2(elastic);
                [x + size * angle.sin(), v + size * omega * angle.cos()]
            });
            let state = response.state(phase);
            for i in 0..2 {
                assert!((state[i] - exact[i]).abs() < 1e-14, "{phase}: {state:?} {exact:?}");
                assert!((outputs[i].value_and_slope(phase).0 - exact[i]).abs() < 1e-14);
            }
            assert!((outputs[2].value_and_slope(phase).0 - waveform.value(phase)).abs() < 1e-14);
        }
    }
}

/// The undamped oscillator under a triangle and a square has the closed form of finite-R averaging.
#[test]
fn closed_forms_of_triangle_and_square() {
    for waveform in [Waveform::Triangle, Waveform::Square] {
        for ratio in [1.3, 10.0, 1e3] {
            let response =
                ResponseToWave::new(&oscillator(0.0), &[0.0, ratio], &waveform, ratio).unwrap();
            let velocity = response.outputs(&[(&[0.0, 1.0], 0.0)]).swap_remove(0);
            let shape = FastWave::Oscillator { waveform: waveform.clone(), frequency_ratio: ratio };
            let [least, largest] = velocity.range();
            assert!((largest / shape.peak() - 1.0).abs() < 1e-12, "{waveform:?} {ratio}");
            assert!((least / shape.peak() + 1.0).abs() < 1e-12, "{waveform:?} {ratio}");
            let law = LawKind::Stribeck.build(&[0.4, 0.2857, 0.2]).unwrap();
            let general = FastMotion::single(FastWave::Response(velocity.into()), 0.4);
            let closed = FastMotion::single(shape, 0.4);
            for v in [-0.5, 0.01, 0.2, 0.7] {
                let [a, b] = [&general, &closed]
                    .map(|motion| quell_linear::averaging::effective(&law, motion, v).unwrap());
                assert!((a.coefficient - b.coefficient).abs() < 1e-12, "{waveform:?} {ratio} {v}");
                assert!((a.slope - b.slope).abs() < 1e-10, "{waveform:?} {ratio} {v}");
            }
        }
    }
}

/// A burst in a three-state structure against Runge–Kutta over many periods.
#[test]
fn a_burst_against_integration() {
    let matrix =
        Matrix::from_fn(3, 3, |i, j| [[0.0, 1.0, 0.0], [-1.0, -0.4, 0.5], [0.3, 0.0, -0.8]][i][j]);
    let source = [0.0, 1.0, 0.2];
    let waveform = Burst::new(Waveform::Triangle, 2, 3).unwrap().into_waveform();
    let frequency = 4.0;
    let response = ResponseToWave::new(&matrix, &source, &waveform, frequency).unwrap();
    let steps = 4000;
    let h = waveform.period() / frequency / f64::from(steps);
    let rate = |time: f64, x: &[f64; 3]| -> [f64; 3] {
        let g = waveform.value(frequency * time);
        std::array::from_fn(|i| (0..3).map(|j| matrix[(i, j)] * x[j]).sum::<f64>() + source[i] * g)
    };
    let mut x = [0.0; 3];
    for _ in 0..40 {
        for k in 0..steps {
            let time = h * f64::from(k);
            let add =
                |y: &[f64; 3], by: f64| -> [f64; 3] { std::array::from_fn(|i| x[i] + by * y[i]) };
            let a = rate(time, &x);
            let b = rate(time + 0.5 * h, &add(&a, 0.5 * h));
            let c = rate(time + 0.5 * h, &add(&b, 0.5 * h));
            let d = rate(time + h, &add(&c, h));
            for i in 0..3 {
                x[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
            }
        }
    }
    let start = response.state(0.0);
    for i in 0..3 {
        assert!((start[i] - x[i]).abs() < 1e-9, "{start:?} {x:?}");
    }
}

/// The same wave in two descriptions.
#[test]
fn descriptions_of_one_wave() {
    let of = |waveform: &Waveform| {
        ResponseToWave::new(&oscillator(0.02), &[0.0, 1.0], waveform, 7.0).unwrap().state(0.0)
    };
    let held = samples(vec![1.0, 1.0, -1.0, -1.0], Hold::Zero);
    let lines = samples(vec![0.0, 1.0, 0.0, -1.0], Hold::Linear);
    let unbroken = Burst::new(Waveform::Sine, 3, 0).unwrap().into_waveform();
    let pairs = [(held, Waveform::Square), (lines, Waveform::Triangle), (unbroken, Waveform::Sine)];
    for (other, named) in pairs {
        let (a, b) = (of(&other), of(&named));
        for i in 0..2 {
            assert!((a[i] - b[i]).abs() < 1e-15, "{other:?}: {a:?} {b:?}");
        }
    }
}

#[test]
fn resonance_is_refused() {
    let burst = Burst::new(Waveform::Sine, 1, 3).unwrap().into_waveform();
    for (waveform, frequency) in
        [(&Waveform::Sine, 1.0), (&burst, 4.0), (&Waveform::Square, 1.0 / 3.0)]
    {
        let found = ResponseToWave::new(&oscillator(0.0), &[0.0, 1.0], waveform, frequency);
        assert_eq!(found.map(|_| ()), Err(NoPeriodicResponse::Resonance), "{waveform:?}");
        assert!(ResponseToWave::new(&oscillator(1e-3), &[0.0, 1.0], waveform, frequency).is_ok());
    }
    let found = ResponseToWave::new(&oscillator(0.0), &[0.0, 1.0], &Waveform::Square, 1e-7);
    assert_eq!(found.map(|_| ()), Err(NoPeriodicResponse::TooSlow));
}

/// Finite-R averaging of bursts and samples: close to the limit of high frequency at large R, with a difference like 1/R²,
/// and that of a belt as a system for ζ → 0.
#[test]
fn averages_of_bursts_and_samples() {
    let burst = Burst::new(Waveform::Sine, 2, 1).unwrap().into_waveform();
    let steps = samples(vec![0.9, 0.4, -0.2, -1.3, 0.2], Hold::Zero);
    let lines = samples(vec![0.9, 0.4, -0.2, -1.3, 0.2], Hold::Linear);
    for waveform in [burst, steps, lines] {
        let slope = |ratio: f64, response| {
            let belt = belt(1e-9, dither(waveform.clone(), 0.4 * ratio, ratio));
            criterion(&belt, response).unwrap().value
        };
        let limit = slope(10.0, Averaging::Limit);
        let [near, far] = [40.0, 160.0].map(|ratio| slope(ratio, Averaging::FiniteR) - limit);
        assert!(near.abs() < 0.1 && far.abs() > 1e-7, "{waveform:?}: {near} {far}");
        assert!((near / far - 16.0).abs() < 1.5, "{waveform:?}: {near} {far}");
        let belt = belt(1e-9, dither(waveform.clone(), 0.4 * 12.0, 12.0));
        let system = belt.system();
        let average = DitheredSystem::new(&system).unwrap().average().unwrap();
        let own = criterion(&belt, Averaging::FiniteR);
        let slope = average.contacts[0].slope_by_velocity;
        let exact = own.unwrap().value - 2e-9;
        assert!((slope - exact).abs() < 1e-7, "{waveform:?}: {slope} {exact}");
    }
}

/// A burst that repeats itself at the resonance of one mass: the damper bounds its motion, and without one it has no average.
#[test]
fn a_burst_at_resonance_keeps_the_damper() {
    let burst = || Burst::new(Waveform::Sine, 2, 1).unwrap().into_waveform();
    let of = |damping| criterion(&belt(damping, dither(burst(), 0.1, 3.0)), Averaging::FiniteR);
    assert!(of(0.05).is_ok() && of(0.0).is_err());
}

/// A thousand held samples of a sine have its critical amplitudes, in the limit and at finite R, as do lines between them.
#[test]
fn many_samples_of_a_sine() {
    let values: Vec<f64> = (0..1000).map(|k| (TAU * f64::from(k) / 1000.0).sin()).collect();
    for response in [Averaging::Limit, Averaging::FiniteR] {
        let options = response;
        let of = |waveform: Waveform| {
            critical_amplitudes(&belt(0.005, dither(waveform, 1.0, 10.0)), options).unwrap()
        };
        let sine = of(Waveform::Sine);
        for hold in [Hold::Zero, Hold::Linear] {
            let sampled = of(samples(values.clone(), hold));
            assert_eq!(sampled.len(), sine.len());
            for (a, b) in sampled.iter().zip(&sine) {
                assert!((a.amplitude / b.amplitude - 1.0).abs() < 1e-5, "{a:?} {b:?}");
            }
        }
    }
}
