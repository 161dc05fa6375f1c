//! Averaging: identities of the criterion and of the critical amplitudes, and the criterion against Floquet multipliers.

use quell_dynamics::orbit::{Orbit, OrbitVerdict, base_response};
use quell_linear::averaging::{
    AveragedVerdict, Averaging, AveragingError, Becomes, Criterion, criterion, critical_amplitudes,
};
use quell_model::{Belt, Direction, Dither, Waveform};
use quell_zoo::dither::dither;
use quell_zoo::{BeltExt, all_belts, belt};

use crate::belt_orbits::monodromy;

/// Of the mass alone, R → ∞, and of the oscillator at its R.
const OPTIONS: [Averaging; 2] = [Averaging::Limit, Averaging::FiniteR];

/// Without amplitude the averaged slope is the law's own, and the criterion is 2ζ + Fμ′(v₀).
#[test]
fn dither_of_amplitude_zero_is_no_dither() {
    for named in all_belts() {
        let belt = &named.model;
        let none = |dither: &Dither| Dither { amplitude: 0.0, ..dither.clone() };
        let silent = belt.with_dithers(belt.dithers().iter().map(none).collect());
        for options in OPTIONS {
            let plain = criterion(&belt.undithered(), options).expect("slides");
            let other = criterion(&silent, options).expect("slides");
            assert_eq!(plain, other, "{}", named.name);
            let slope = belt.friction().slope(belt.belt_velocity());
            assert_eq!(plain.effective.slope, slope, "{}", named.name);
        }
    }
}

/// Just below and just above every critical amplitude the criterion has opposite verdicts.
#[test]
fn the_verdict_changes_at_every_critical_amplitude() {
    let mut changes = 0;
    for named in all_belts() {
        let [dither] = named.model.dithers() else { continue };
        for options in OPTIONS {
            for critical in critical_amplitudes(&named.model, options).expect("one dither") {
                if !critical.contact_stays_closed {
                    continue;
                }
                let verdict = |factor: f64| {
                    let amplitude = factor * critical.amplitude;
                    let belt =
                        named.model.with_dithers(vec![Dither { amplitude, ..dither.clone() }]);
                    criterion(&belt, options).expect("a criterion").verdict
                };
                let (below, above) = (verdict(1.0 - 1e-6), verdict(1.0 + 1e-6));
                let expected = match critical.becomes {
                    Becomes::Stable => (AveragedVerdict::Unstable, AveragedVerdict::Stable),
                    Becomes::Unstable => (AveragedVerdict::Stable, AveragedVerdict::Unstable),
                };
                assert_eq!((below, above), expected, "{}: {critical:?}", named.name);
                changes += 1;
            }
        }
    }
    assert!(changes > 20, "{changes}");
}

/// Critical amplitudes are lengths: multiplied by a power of two they are multiplied exactly.
#[test]
fn lengths_scale_out() {
    let scale = 2f64.powi(-17);
    for named in all_belts() {
        let found = |belt: &Belt| critical_amplitudes(belt, Averaging::Limit);
        let (one, small) = (found(&named.model), found(&named.model.scaled(scale)));
        let (one, small) = match (one, small) {
            (Ok(one), Ok(small)) => (one, small),
            // Where the tangential dither of two just reaches the belt's velocity, the quadrature over the jumps of the
            // normal one stops at an error of 10⁻¹⁰: at any scale.
            (Err(AveragingError::Quadrature(_)), Err(AveragingError::Quadrature(_)))
                if named.model.dithers().len() > 1 =>
            {
                continue;
            }
            (one, small) => panic!("{}: {one:?} {small:?}", named.name),
        };
        assert_eq!(one.len(), small.len(), "{}", named.name);
        for (one, small) in one.iter().zip(&small) {
            assert_eq!(one.amplitude_ratio * scale, small.amplitude_ratio, "{}", named.name);
            assert_eq!((one.crossing, one.becomes), (small.crossing, small.becomes));
        }
    }
}

/// The criterion of a belt and the rate −ln|det M|/T of its base response over the period T.
fn criterion_and_rate(belt: &Belt) -> (Criterion, f64, Orbit) {
    let averaged = criterion(belt, OPTIONS[1]).expect("a criterion");
    let orbit = base_response(&belt.system(), 8).unwrap_or_else(|why| panic!("{belt:?}: {why}"));
    let [[a, b], [c, d]] = monodromy(&orbit);
    let rate = -(a * d - b * c).ln() / orbit.period;
    (averaged, rate, orbit)
}

/// For fast dither, areas of nearby states shrink at the criterion's value 2ζ + Fμ̄′: −ln|det M|/T of the base response comes
/// to it with 1/R², and the local verdict of the multipliers is the averaged one.
#[test]
fn the_criterion_is_the_limit_of_the_multipliers() {
    let (mut judged, mut worst) = ([0, 0], 0.0_f64);
    for named in belt::undithered() {
        for waveform in Waveform::NAMED {
            for &direction in Direction::ALL {
                // Outside and inside the largest fast velocity for tangential dither.
                for reach in [0.3, 0.7, 1.4] {
                    let at = |ratio: f64| {
                        let alpha = reach * named.model.belt_velocity() / waveform.peak_integral();
                        let amplitude = match direction {
                            Direction::Tangential => alpha * ratio,
                            Direction::Normal => 0.6 * reach,
                        };
                        let dither = dither(direction, waveform.clone(), amplitude, ratio);
                        criterion_and_rate(&named.model.with_dither(dither))
                    };
                    let label = format!("{}, {direction:?} {waveform:?} {reach}", named.name);
                    let ((slow, slow_rate, _), (averaged, rate, orbit)) = (at(100.0), at(200.0));
                    let gap = (rate - averaged.value).abs();
                    let before = (slow_rate - slow.value).abs();
                    let size = averaged.value.abs().max(1.0);
                    assert!(gap < 5e-3 * size * size, "{label}: {rate} {averaged:?}");
                    assert!(gap < 0.4 * before + 1e-10, "{label}: {before:e} {gap:e}");
                    worst = worst.max(gap / size);
                    // A margin for the difference that is left at R = 200.
                    if averaged.value.abs() > 1e-3 {
                        let expected = match averaged.verdict {
                            AveragedVerdict::Stable => OrbitVerdict::Stable,
                            AveragedVerdict::Unstable => OrbitVerdict::Unstable,
                            AveragedVerdict::Undecided { .. } => panic!("{label}: {averaged:?}"),
                        };
                        assert_eq!(orbit.verdict(), expected, "{label}: {orbit:?}");
                        judged[usize::from(expected == OrbitVerdict::Stable)] += 1;
                    }
                }
            }
        }
    }
    println!("{judged:?} unstable and stable responses, largest relative gap {worst:.1e}");
    assert!(judged[0] > 30 && judged[1] > 90, "{judged:?}");
}
