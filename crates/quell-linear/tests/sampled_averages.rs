//! Averages under waveforms by samples, which are summed piece by piece, against adaptive quadrature and against their limits.

use std::time::Instant;

use quell_linear::averaging::{
    Averaging, CrossingKind, Effective, FastMotion, FastWave, PeriodicMotion, SlipTerm,
    critical_amplitudes, effective,
};
use quell_model::waveform::{Hold, SampledWave};
use quell_model::{Friction, LawKind, Waveform};
use quell_zoo::belt::belt;
use quell_zoo::dither::tangential;
use quell_zoo::law;

fn sampled(values: Vec<f64>, hold: Hold) -> Waveform {
    Waveform::Samples(SampledWave::new(values, hold).expect("samples").into())
}

fn sine(count: u32, hold: Hold) -> Waveform {
    let angle = |k: u32| core::f64::consts::TAU * (f64::from(k) + 0.5) / f64::from(count);
    sampled((0..count).map(|k| angle(k).sin()).collect(), hold)
}

fn of(law: &Friction, motion: &FastMotion, v: f64) -> Effective {
    effective(law, motion, v).expect("a mean")
}

/// A second term that vanishes makes the motion a sum, which is averaged by adaptive quadrature over the period.
fn by_quadrature(waveform: &Waveform, alpha: f64) -> FastMotion {
    let term = |amplitude: f64| SlipTerm {
        wave: FastWave::Integral(waveform.clone()),
        amplitude,
        harmonic: 1,
        phase: 0.0,
    };
    let tangential = vec![term(0.5 * alpha), term(0.5 * alpha)];
    FastMotion::new(vec![PeriodicMotion { tangential, ..PeriodicMotion::default() }])
}

#[test]
fn pieces_agree_with_adaptive_quadrature() {
    let waves = [
        sampled(vec![0.3, 1.0, -0.4, -1.2, 0.5], Hold::Zero),
        sampled(vec![0.3, 1.0, -0.4, -1.2, 0.5], Hold::Linear),
        sampled(vec![1.0, 0.0, 0.0, 0.0], Hold::Zero),
        sine(40, Hold::Zero),
        sine(40, Hold::Linear),
    ];
    let mut laws: Vec<Friction> =
        [LawKind::Stribeck, LawKind::Decreasing].map(law::dissertation).to_vec();
    laws.push(law::coulomb(0.3, 0.4));
    laws.push(law::stribeck_exponential());
    laws.push(law::formula("0.3 + 0.1*exp(-abs(v)/0.2) + 0.05*tanh(v/0.1)"));
    for waveform in &waves {
        for law in &laws {
            for alpha in [0.02, 0.15, -0.4] {
                for v in [0.003, 0.05, -0.11, 0.31] {
                    let found = of(
                        law,
                        &FastMotion::single(FastWave::Integral(waveform.clone()), alpha),
                        v,
                    );
                    let exact = of(law, &by_quadrature(waveform, alpha), v);
                    let context = format!("{law:?} {alpha} {v} {found:?} {exact:?}");
                    assert!((found.coefficient - exact.coefficient).abs() < 2e-12, "{context}");
                    assert!(
                        (found.slope - exact.slope).abs() < 1e-9 * (1.0 + exact.slope.abs()),
                        "{context}"
                    );
                }
            }
        }
    }
}

/// Two samples that are held are the square, whose averages have closed forms.
#[test]
fn two_held_samples_are_a_square() {
    let held = sampled(vec![1.0, -1.0], Hold::Zero);
    for kind in [LawKind::Stribeck, LawKind::Decreasing] {
        let law = law::dissertation(kind);
        for (alpha, v) in [(0.1, 0.05), (0.03, 0.2), (0.7, 0.01)] {
            let [found, exact] = [held.clone(), Waveform::Square].map(|waveform| {
                of(&law, &FastMotion::single(FastWave::Integral(waveform), alpha), v)
            });
            assert!((found.coefficient - exact.coefficient).abs() < 1e-12, "{found:?} {exact:?}");
            assert!((found.slope - exact.slope).abs() < 1e-10, "{found:?} {exact:?}");
        }
    }
}

/// The critical amplitude under 1000 held samples of a sine is that of the sine to the accuracy of the samples, in a second.
#[test]
fn a_thousand_held_samples() {
    let started = Instant::now();
    let critical = |waveform| {
        let belt = belt(0.01, 0.1, law::stribeck(), vec![tangential(waveform, 0.5, 10.0)]);
        critical_amplitudes(&belt, Averaging::Limit).expect("an average")
    };
    let (held, sine) = (critical(sine(1000, Hold::Zero)), critical(Waveform::Sine));
    assert_eq!(held.len(), sine.len(), "{held:?} {sine:?}");
    for (held, sine) in held.iter().zip(&sine) {
        assert!(
            (held.amplitude_ratio / sine.amplitude_ratio - 1.0).abs() < 1e-5,
            "{held:?} {sine:?}"
        );
        assert_eq!(held.becomes, sine.becomes);
    }
    assert_eq!(sine[0].crossing, CrossingKind::Jump);
    // Two seconds even on a machine in full use; adaptive quadrature takes about a minute.
    assert!(started.elapsed().as_secs() < 10, "{:?}", started.elapsed());
}
