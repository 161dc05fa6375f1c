//! Marginal frictions, speeds and amplitudes under any waveform: exact exponents along a line against the D-partition, against the
//! Hill determinant of the Fourier coefficients, and in the limits in which waveforms say the same.

use std::f64::consts::{FRAC_PI_2, TAU};

use num_complex::Complex64;
use quell_disc::dithered;
use quell_disc::marginal::{
    MarginalValue, exponents, marginal_frictions, marginal_values, tongue_grid,
};
use quell_disc::partition::{FrictionCrossing, crossings};
use quell_disc::plate::{ModeSet, Plate, Reference};
use quell_model::disc::{DiscDither, DitherShape, Load, Mode, Patch};
use quell_model::waveform::{Burst, FourierWave, Harmonic, Hold, SampledWave};
use quell_model::{Disc, Waveform};
use quell_numerics::floquet::Effort;

const RATIO: f64 = 2.7;

fn modes(damping: f64) -> Vec<Mode> {
    let plate = Plate::new(0.5, 0.3).expect("valid");
    let set = ModeSet::new(&plate, 1, 2, Reference::Critical).expect("found");
    set.at_radius(0.75, damping).expect("on the plate")
}

fn disc(dither: DiscDither, waveform: &Waveform, speed: f64) -> Disc {
    let shape = DitherShape { waveform: waveform.clone(), envelope: None };
    let load = Load::new(0.1, 0.05, 0.1, 1.0);
    Disc::dithered_by(modes(1e-3), vec![load], (dither, shape), speed).expect("valid")
}

fn normal(amplitude: f64, frequency_ratio: f64) -> DiscDither {
    DiscDither::Normal { amplitude, frequency_ratio }
}

fn tangential(frequency_ratio: f64) -> DiscDither {
    DiscDither::Tangential { amplitude: 1.0, frequency_ratio }
}

fn fourier(harmonics: &[(u32, f64, f64)]) -> Waveform {
    let one = |&(order, sine, cosine): &(u32, f64, f64)| Harmonic { order, sine, cosine };
    let series = FourierWave::new(harmonics.iter().map(one).collect()).expect("valid");
    Waveform::Fourier(series.into())
}

fn samples(values: Vec<f64>, hold: Hold) -> Waveform {
    Waveform::Samples(SampledWave::new(values, hold).expect("valid").into())
}

fn burst(carrier: Waveform, on: u32, off: u32) -> Waveform {
    Burst::new(carrier, on, off).expect("valid").into_waveform()
}

fn of(disc: &Disc) -> Vec<MarginalValue> {
    marginal_frictions(disc).expect("finite").expect("dithered").factors
}

/// Two methods on the sine: the D-partition finds the frictions from the frequency, the line finds them from the friction. Two
/// crossings whose frequencies are within one step of the partition are missed by it; the Hill determinant confirms them.
#[test]
fn the_frictions_of_a_sine_are_those_of_the_d_partition() {
    let (mut checked, mut missed) = (0, 0);
    for speed in [0.05, 0.2, 0.37, 0.458, 0.61, 0.88] {
        for dither in [normal(0.8, RATIO), tangential(RATIO), normal(0.5, 0.9), tangential(1.3)] {
            let disc = disc(dither, &Waveform::Sine, speed);
            let found = marginal_frictions(&disc).expect("finite").expect("dithered");
            let known = crossings(&disc).expect("one load");
            let known: Vec<_> =
                known.into_iter().filter(|known| known.factor < found.up_to).collect();
            let what = format!("{dither:?} {speed}: {:?} {known:?}", found.factors);
            let same = |found: &MarginalValue, known: &FrictionCrossing| {
                (found.value / known.factor - 1.0).abs() < 1e-8
                    && (found.frequency - known.frequency).abs() < 1e-7
            };
            for known in &known {
                assert!(found.factors.iter().any(|found| same(found, known)), "{what}");
                checked += 1;
            }
            for found in &found.factors {
                if !known.iter().any(|known| same(found, known)) {
                    let (friction, omega) = by_hill(&disc, found, 24);
                    assert!((friction / found.value - 1.0).abs() < 1e-7, "{what}");
                    assert!((omega - found.frequency).abs() < 1e-7, "{what}");
                    missed += 1;
                }
            }
        }
    }
    assert!(checked > 30 && missed < checked / 4, "{checked} {missed}");
}

#[test]
fn waveforms_that_say_the_same_have_the_same_frictions() {
    for dither in [normal(0.8, RATIO), tangential(1.3)] {
        let frictions = |waveform: &Waveform| of(&disc(dither, waveform, 0.37));
        let same = |one: &[MarginalValue], other: &[MarginalValue], tolerance: f64| {
            assert_eq!(one.len(), other.len(), "{one:?} {other:?}");
            for (one, other) in one.iter().zip(other) {
                assert!((one.value / other.value - 1.0).abs() < tolerance, "{one:?} {other:?}");
                assert_eq!(one.grows_beyond, other.grows_beyond);
            }
        };
        let sine = frictions(&Waveform::Sine);
        same(&sine, &frictions(&fourier(&[(1, 1.0, 0.0)])), 1e-8);
        let held = samples(vec![1.0, -1.0], Hold::Zero);
        same(&frictions(&Waveform::Square), &frictions(&held), 1e-9);
        let corners = samples(vec![0.0, 1.0, 0.0, -1.0], Hold::Linear);
        same(&frictions(&Waveform::Triangle), &frictions(&corners), 1e-9);
        // Held values of a sine approach it; they lag by half a step, which shifts the time alone.
        let gap = |count: u32| {
            let value = |k: u32| (TAU * f64::from(k) / f64::from(count)).sin();
            let found = frictions(&samples((0..count).map(value).collect(), Hold::Zero));
            assert_eq!(found.len(), sine.len());
            let gaps = found.iter().zip(&sine).map(|(a, b)| (a.value / b.value - 1.0).abs());
            gaps.fold(0.0, f64::max)
        };
        let gaps = [gap(40), gap(160)];
        assert!(gaps[1] < 1e-3 && (gaps[0] / gaps[1] - 16.0).abs() < 3.0, "{gaps:?}");
    }
}

/// T(λ) of the load, from the sums over waves.
fn receptance(disc: &Disc, lambda: Complex64) -> Complex64 {
    let load = &disc.loads()[0];
    let (mut h1, mut h2) = (Complex64::new(0.0, 0.0), Complex64::new(0.0, 0.0));
    for mode in disc.modes() {
        let q = mode.diameters as f64;
        let waves: &[f64] = if mode.diameters == 0 { &[0.0] } else { &[q, -q] };
        for l in waves {
            let seen = lambda - Complex64::new(0.0, l * disc.speed());
            let stiffness =
                seen * seen + seen * (2.0 * mode.damping * mode.ratio) + mode.ratio * mode.ratio;
            let share = mode.shape_at_load * mode.shape_at_load / waves.len() as f64 / stiffness;
            h1 += share;
            h2 += share * Complex64::new(0.0, *l);
        }
    }
    h2 / (h1 * (lambda * lambda * load.mass + lambda * load.damping + load.stiffness) + 1.0)
}

/// det(1 − f𝒯F) at ρ = iω over the harmonics −H…H, F the Toeplitz matrix of the Fourier coefficients of the factor on friction.
fn hill(disc: &Disc, friction: f64, omega: f64, harmonics: i32) -> Complex64 {
    let (mean, amplitude) = disc.dither().mean_and_amplitude();
    let repetition = disc.repetition_ratio().expect("dithered");
    let cycles = f64::from(disc.waveform().cycles());
    let coefficient = |n: i32| {
        if n == 0 {
            return Complex64::new(mean, 0.0);
        }
        let [cosine, sine] = disc.waveform().fourier_coefficient(n.unsigned_abs());
        let turned = Complex64::new(0.0, FRAC_PI_2 * f64::from(n.abs()) / cycles).exp();
        let value = Complex64::new(0.5 * cosine, -0.5 * sine) * turned * amplitude;
        if n < 0 { value.conj() } else { value }
    };
    let size = usize::try_from(2 * harmonics + 1).expect("positive");
    let place = |index: usize| i32::try_from(index).expect("small") - harmonics;
    let mut rows: Vec<Vec<Complex64>> = (0..size)
        .map(|row| {
            let at = Complex64::new(0.0, repetition.mul_add(f64::from(place(row)), omega));
            let t = receptance(disc, at) * friction;
            let entry = |column: usize| {
                let one = if row == column { 1.0 } else { 0.0 };
                one - t * coefficient(place(row) - place(column))
            };
            (0..size).map(entry).collect()
        })
        .collect();
    let mut determinant = Complex64::new(1.0, 0.0);
    for k in 0..size {
        let pivot =
            (k..size).max_by(|a, b| rows[*a][k].norm_sqr().total_cmp(&rows[*b][k].norm_sqr()));
        let pivot = pivot.expect("rows");
        if pivot != k {
            rows.swap(pivot, k);
            determinant = -determinant;
        }
        determinant *= rows[k][k];
        let (above, below) = rows.split_at_mut(k + 1);
        let first = &above[k];
        for row in below {
            let factor = row[k] / first[k];
            for column in k..size {
                row[column] -= factor * first[column];
            }
        }
    }
    determinant
}

/// The friction and the frequency near those found at which the determinant vanishes, by Newton's method.
fn by_hill(disc: &Disc, found: &MarginalValue, harmonics: i32) -> (f64, f64) {
    let (mut friction, mut omega) = (found.value, found.frequency);
    for _ in 0..8 {
        let value = hill(disc, friction, omega, harmonics);
        let (df, dw) = (1e-6 * friction, 1e-7);
        let by_friction = (hill(disc, friction + df, omega, harmonics)
            - hill(disc, friction - df, omega, harmonics))
            / (2.0 * df);
        let by_omega = (hill(disc, friction, omega + dw, harmonics)
            - hill(disc, friction, omega - dw, harmonics))
            / (2.0 * dw);
        let scale = by_friction.re * by_omega.im - by_friction.im * by_omega.re;
        friction -= (value.re * by_omega.im - value.im * by_omega.re) / scale;
        omega -= (by_friction.re * value.im - by_friction.im * value.re) / scale;
    }
    (friction, omega)
}

#[test]
fn the_hill_determinant_vanishes_at_the_frictions_of_every_waveform() {
    // Coefficients that fall like 1/n leave errors like H⁻⁴ of the determinant, others less.
    let waves = [
        (Waveform::Triangle, 1e-8),
        (Waveform::Square, 1e-6),
        (fourier(&[(1, 0.6, 0.1), (2, 0.0, 0.5), (5, 0.1, 0.0)]), 1e-8),
        (samples(vec![0.3, 1.0, -0.4, 0.9, -2.0], Hold::Linear), 1e-7),
        (samples(vec![0.3, 1.0, -0.4, 0.9, -2.0], Hold::Zero), 1e-6),
        (burst(Waveform::Sine, 2, 1), 1e-7),
        (burst(Waveform::Square, 1, 1), 1e-5),
    ];
    let mut checked = 0;
    for (waveform, tolerance) in &waves {
        for dither in [normal(0.4, RATIO), tangential(RATIO)] {
            let disc = disc(dither, waveform, 0.37);
            // The smallest ones matter; a larger friction needs more harmonics.
            for found in of(&disc).iter().take(3) {
                // At ω = 0 and R′/2 the determinant is real and has no second equation.
                let half = 0.5 * disc.repetition_ratio().expect("dithered");
                if found.frequency < 1e-9 || half - found.frequency < 1e-9 {
                    continue;
                }
                let (friction, omega) = by_hill(&disc, found, 40);
                let what = format!("{} {dither:?} {found:?} {friction} {omega}", waveform.name());
                assert!((friction / found.value - 1.0).abs() < *tolerance, "{what}");
                assert!((omega - found.frequency).abs() < *tolerance, "{what}");
                checked += 1;
            }
        }
    }
    assert!(checked >= 14, "{checked}");
}

/// Between two marginal frictions the number of growing motions is constant, and changes by those found.
#[test]
fn the_number_of_growing_motions_changes_at_the_frictions_found() {
    let patch = |disc: Disc| {
        let loads = vec![disc.loads()[0].clone().over(Patch::sector(0.5, 3))];
        let shape = DitherShape { waveform: disc.waveform().clone(), envelope: None };
        Disc::dithered_by(modes(1e-3), loads, (disc.dither(), shape), 0.37).expect("valid")
    };
    let plain = |waveform: &Waveform| disc(normal(1.0, RATIO), waveform, 0.37);
    for disc in [
        plain(&Waveform::Square),
        plain(&burst(Waveform::Triangle, 1, 2)),
        patch(plain(&Waveform::Triangle)),
        disc(tangential(1.1), &Waveform::Square, 0.61),
    ] {
        let prepared = dithered::prepared(&disc).expect("finite").expect("dithered");
        let growing = |factor: f64| {
            let all = prepared.exponents(factor, Effort::default()).expect("finite");
            all.iter().filter(|exponent| exponent.growth_rate > 0.0).count()
        };
        let found = marginal_frictions(&disc).expect("finite").expect("dithered");
        assert!(!found.factors.is_empty());
        assert_eq!(growing(0.0), 0);
        let mut before = 0.0;
        for (place, marginal) in found.factors.iter().enumerate() {
            let next = found.factors.get(place + 1).map_or(found.up_to, |next| next.value);
            let near = 1e-4 * (marginal.value - before).min(next - marginal.value);
            let sides = [marginal.value - near, marginal.value + near].map(growing);
            assert_eq!(sides[0] < sides[1], marginal.grows_beyond, "{marginal:?} {sides:?}");
            assert_ne!(sides[0], sides[1], "{marginal:?}");
            // Between two of them whether any grows is constant; two real ones may merge into a pair.
            for share in [0.1, 0.3, 0.5, 0.7, 0.9] {
                let there = growing((next - marginal.value).mul_add(share, marginal.value));
                assert_eq!(there > 0, sides[1] > 0, "{marginal:?} {share}");
            }
            before = marginal.value;
        }
    }
}

/// Along speeds no tongue is missed: between the marginal speeds the sign of the growth is that of their middle.
#[test]
fn every_tongue_between_two_speeds_is_found() {
    for (waveform, ratio) in
        [(Waveform::Sine, RATIO), (Waveform::Square, 1.1), (Waveform::Triangle, 2.0)]
    {
        let shape = DitherShape { waveform: waveform.clone(), envelope: None };
        let load = Load::new(2e-3, 1e-4, 2e-3, 6e-3);
        let disc = Disc::dithered_by(modes(1e-5), vec![load], (tangential(ratio), shape), 0.2);
        let disc = disc.expect("valid");
        let line = |speed: f64| exponents(&disc.at_speed(speed).expect("in bounds"));
        let speeds = 0.2..=0.6;
        let grid = tongue_grid(&disc, &speeds, 32);
        let found = marginal_values(&line, &grid).expect("finite");
        assert!(found.len() >= 2, "{waveform:?}: {found:?}");
        let growth = |speed: f64| {
            let disc = disc.at_speed(speed).expect("in bounds");
            dithered::growth(&disc, Effort::default()).expect("finite").rate
        };
        for marginal in &found {
            let near = 1e-5 * if marginal.grows_beyond { 1.0 } else { -1.0 };
            assert!(growth(marginal.value + near) > 0.0, "{waveform:?} {marginal:?}");
        }
        let ends: Vec<f64> = std::iter::once(0.2)
            .chain(found.iter().map(|marginal| marginal.value))
            .chain([0.6])
            .collect();
        for pair in ends.windows(2) {
            let width = pair[1] - pair[0];
            let grows = growth(0.5 * (pair[0] + pair[1])) > 0.0;
            let steps = (width / 2e-3).ceil().min(200.0);
            let mut k = 0.5;
            while k < steps {
                let at = width.mul_add(k / steps, pair[0]);
                assert_eq!(growth(at) > 0.0, grows, "{waveform:?} {at} {pair:?}");
                k += 1.0;
            }
        }
    }
}

/// The amplitude at which a disc is marginal is that at which its friction is.
#[test]
fn amplitudes_and_frictions_agree() {
    let disc = disc(tangential(RATIO), &Waveform::Square, 0.37);
    // Without mean friction α f alone counts.
    let friction = of(&disc)[0];
    let line = |amplitude: f64| exponents(&disc.with_amplitude(amplitude).expect("valid"));
    let grid: Vec<f64> = (0..=20).map(|k| friction.value * 0.1 * f64::from(k)).collect();
    let found = marginal_values(&line, &grid).expect("finite");
    assert!((found[0].value / friction.value - 1.0).abs() < 1e-10, "{found:?} {friction:?}");
}
