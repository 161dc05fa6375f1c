//! Averaging over a wide grid: stored 40-digit values, closed form against quadrature, limits and symmetries.

use quell_linear::averaging::{
    Averaging, AveragingError, FastMotion, FastWave, PeriodicMotion, SlipTerm, SlopeSide,
    effective, effective_by_quadrature,
};
use quell_model::{Direction, Friction, LawKind, Waveform};
use quell_zoo::belt::belt;
use quell_zoo::dither::{self, at_phase};
use quell_zoo::law::{REFERENCE_VELOCITY, build, dissertation};

const VM: f64 = REFERENCE_VELOCITY;

fn laws() -> [Friction; 2] {
    [LawKind::Stribeck, LawKind::Decreasing].map(dissertation)
}

fn plain(waveform: Waveform, alpha: f64) -> FastMotion {
    FastMotion::single(FastWave::Integral(waveform), alpha)
}

fn relative(value: f64, exact: f64) -> f64 {
    if value == exact { 0.0 } else { ((value - exact) / exact).abs() }
}

/// 40-digit values: μ̄ to 1e-11, slope to 1e-9, for α/v_m and v/v_m over nine decades.
#[test]
fn stored_wide_grid() {
    let table = include_str!("../../../reference/averaging_wide.csv");
    let (mut rows, mut worst, mut worst_slope) = (0, (0.0, ""), (0.0, ""));
    for line in table.lines().filter(|line| !line.starts_with('#')) {
        let field: Vec<&str> = line.split(',').collect();
        let law = dissertation(LawKind::from_name(field[0]).expect("a law"));
        let waveform = Waveform::from_name(field[1]).expect("a waveform");
        let number = |i: usize| -> f64 { field[i].parse().expect("a number") };
        let found = effective(&law, &plain(waveform, number(2)), number(3)).expect("a value");
        let e = relative(found.coefficient, number(4));
        let s = relative(found.slope, number(5));
        assert!(e < 1e-11, "{found:?}: {e:e} in {line}");
        assert!(s < 1e-9, "{found:?}: {s:e} in {line}");
        if e > worst.0 {
            worst = (e, line);
        }
        if s > worst_slope.0 {
            worst_slope = (s, line);
        }
        rows += 1;
    }
    assert!(rows > 1000, "{rows}");
    println!("{rows} rows, worst μ̄ {worst:?}, slope {worst_slope:?}");
}

/// The default laws, and more: deep, flat and without a minimum level.
fn more_laws() -> Vec<Friction> {
    let mut laws = laws().to_vec();
    for kind in [LawKind::Stribeck, LawKind::Decreasing] {
        for values in [[0.8, 0.05, 0.03], [0.5, 0.5, 1.0], [0.3, 0.0, 2.0]] {
            laws.push(build(kind, &values));
        }
    }
    laws
}

/// Closed form and quadrature of the definition agree, inside and outside, for every law and waveform.
#[test]
fn closed_forms_agree_with_quadrature() {
    let (mut worst, mut worst_slope) = (0.0_f64, 0.0_f64);
    for law in more_laws() {
        let vm = law.velocity_scale();
        for waveform in Waveform::NAMED {
            let wave = FastWave::Integral(waveform.clone());
            for ratio in [1e-6, 1e-3, 0.1, 0.5, 1.0, 2.15, 5.0, 20.0] {
                let alpha = ratio * vm;
                for part in [1e-6, 1e-3, 0.1, 0.5, 0.9, 0.999, 1.001, 1.5, 5.0] {
                    let v = part * alpha * waveform.peak_integral();
                    let closed =
                        effective(&law, &plain(waveform.clone(), alpha), v).expect("closed");
                    let numeric = effective_by_quadrature(&law, &wave, alpha, v).expect("ok");
                    // A value or slope that cancels is compared at the size of the law under this motion.
                    let largest = law.coefficient(v + alpha).abs().max(law.static_coefficient());
                    let size = largest * (v / alpha).min(1.0);
                    let e = (closed.coefficient - numeric.coefficient).abs()
                        / closed.coefficient.abs().max(0.01 * size);
                    let inside = if part < 1.0 { law.static_coefficient() / alpha } else { 0.0 };
                    let slope_size = law.slope(v + alpha).abs() + law.slope(v).abs() + inside;
                    let s = (closed.slope - numeric.slope).abs()
                        / closed.slope.abs().max(0.01 * slope_size).max(1e-300);
                    let at = format!("{law:?} {waveform:?} α/v_m {ratio} v/corner {part}");
                    assert!(e < 1e-11, "{at}: {closed:?} {numeric:?} {e:e}");
                    assert!(s < 1e-9, "{at}: {closed:?} {numeric:?} {s:e}");
                    worst = worst.max(e);
                    worst_slope = worst_slope.max(s);
                }
            }
        }
    }
    println!("closed against quadrature: μ̄ {worst:e}, slope {worst_slope:e}");
}

/// μ̄ is continuous at the corner; so is the slope outside, and the corner itself belongs to the outer side.
#[test]
fn corner() {
    for law in more_laws() {
        for waveform in Waveform::NAMED.iter().cloned() {
            for ratio in [1e-3, 0.5, 3.0, 50.0] {
                let alpha = ratio * law.velocity_scale();
                let v = alpha * waveform.peak_integral();
                let at =
                    |x: f64| effective(&law, &plain(waveform.clone(), alpha), x).expect("a value");
                let (inner, corner, outer) = (at(v * (1.0 - 1e-13)), at(v), at(v * (1.0 + 1e-13)));
                let scale = law.coefficient(v).abs() + law.static_coefficient();
                // Near a rounded peak the difference grows with a square root.
                assert!((inner.coefficient - corner.coefficient).abs() < 2e-6 * scale);
                assert!((outer.coefficient - corner.coefficient).abs() < 1e-11 * scale);
                let slope_scale = outer.slope.abs() + law.slope(0.0).abs();
                assert!((outer.slope - corner.slope).abs() <= 1e-11 * slope_scale);
                assert_eq!(corner.side, SlopeSide::Outer);
                assert_eq!((inner.side, outer.side), (SlopeSide::Both, SlopeSide::Both));
                let jump = 2.0 * law.static_coefficient() / (core::f64::consts::PI * alpha);
                if waveform == Waveform::Square {
                    let step = inner.slope - outer.slope;
                    assert!((step - jump).abs() < 1e-9 * (jump + slope_scale), "{step} {jump}");
                } else {
                    assert!(inner.slope > 1e3 * jump, "{law:?} {waveform:?} {inner:?}");
                }
            }
        }
    }
}

/// α → 0 recovers the law; the difference shrinks with α².
#[test]
fn without_dither() {
    for law in laws() {
        for waveform in Waveform::NAMED {
            for w in [0.05, 0.7, 1.4, 3.0] {
                let v = w * VM;
                let bare = effective(&law, &plain(waveform.clone(), 0.0), v).expect("slides");
                assert_eq!(bare.coefficient, law.coefficient(v));
                assert_eq!(bare.slope, law.slope(v));
                let difference = |alpha: f64| {
                    effective(&law, &plain(waveform.clone(), alpha), v).expect("slides").coefficient
                        - law.coefficient(v)
                };
                let (small, large) = (difference(1e-3 * VM), difference(1e-2 * VM));
                let ratio = large / small;
                assert!((ratio - 100.0).abs() < 0.05, "{law:?} {waveform:?} {w}: {ratio}");
                assert!(difference(1e-9 * VM).abs() < 1e-15);
            }
        }
        let still = effective(&law, &FastMotion::default(), 0.0);
        assert_eq!(still, Err(AveragingError::SetValued { static_coefficient: 0.4 }));
    }
}

/// μ̄ is odd, its slope even, and with dither it passes through zero with a finite slope.
#[test]
fn symmetry() {
    for law in laws() {
        for waveform in Waveform::NAMED.iter().cloned() {
            let motion = plain(waveform, 0.13);
            for v in [1e-7, 0.02, 0.11, 0.13, 0.4] {
                let (plus, minus) = (effective(&law, &motion, v), effective(&law, &motion, -v));
                let (plus, minus) = (plus.expect("ok"), minus.expect("ok"));
                assert_eq!((plus.coefficient, plus.slope), (-minus.coefficient, minus.slope));
            }
            let rest = effective(&law, &motion, 0.0).expect("dithered");
            assert_eq!(rest.coefficient, 0.0);
            let near = effective(&law, &motion, 1e-8).expect("dithered");
            assert!(relative(near.coefficient / 1e-8, rest.slope) < 1e-6);
        }
    }
}

fn term(wave: FastWave, amplitude: f64, harmonic: u32, phase: f64) -> SlipTerm {
    SlipTerm { wave, amplitude, harmonic, phase }
}

fn group(tangential: Vec<SlipTerm>) -> PeriodicMotion {
    PeriodicMotion { tangential, ..PeriodicMotion::default() }
}

/// Sums of dithers of one frequency, by the general method, against the closed form of the single dither they make.
#[test]
fn sums_of_equal_frequency() {
    let (mut worst, mut worst_slope) = (0.0_f64, 0.0_f64);
    for law in laws() {
        for v in [-0.3, -0.05, 0.0, 0.01, 0.1, 0.2, 0.5, 1.3] {
            let mut cases = Vec::new();
            // Two sines add like vectors.
            let sine = FastWave::Integral(Waveform::Sine);
            for phase in [0.3, 1.5, 2.8] {
                let (a, b) = (0.12, 0.2_f64);
                let total = (a * a + b * b + 2.0 * a * b * libm::cos(phase)).sqrt();
                let terms =
                    vec![term(sine.clone(), a, 1, 0.4), term(sine.clone(), b, 1, 0.4 + phase)];
                cases.push((terms, sine.clone(), total));
            }
            for waveform in Waveform::NAMED.iter().cloned() {
                for wave in [
                    FastWave::Integral(waveform.clone()),
                    FastWave::Oscillator { waveform, frequency_ratio: 4.0 },
                ] {
                    cases.push((
                        vec![term(wave.clone(), 0.05, 1, 1.0), term(wave.clone(), 0.1, 1, 1.0)],
                        wave.clone(),
                        0.15,
                    ));
                    // Twice the frequency is the same wave.
                    cases.push((
                        vec![term(wave.clone(), 0.07, 3, 0.2), term(wave.clone(), 0.03, 3, 0.2)],
                        wave,
                        0.1,
                    ));
                }
            }
            for (terms, wave, total) in cases {
                let sum = effective(&law, &FastMotion::new(vec![group(terms)]), v).expect("ok");
                let one = effective(&law, &FastMotion::single(wave.clone(), total), v).expect("ok");
                let e = (sum.coefficient - one.coefficient).abs();
                let s = relative(sum.slope, one.slope);
                assert!(e < 1e-12, "{law:?} {wave:?} {v}: {sum:?} {one:?}");
                assert!(s < 1e-10, "{law:?} {wave:?} {v}: {sum:?} {one:?}");
                assert!(e <= sum.coefficient_error + one.coefficient_error, "{sum:?} {one:?}");
                worst = worst.max(e);
                worst_slope = worst_slope.max(s);
            }
        }
        // Equal and opposite dithers cancel.
        let square = FastWave::Integral(Waveform::Square);
        let cancel = group(vec![
            term(square.clone(), 0.2, 1, 0.0),
            term(square, 0.2, 1, core::f64::consts::PI),
        ]);
        let left = effective(&law, &FastMotion::new(vec![cancel]), 0.1).expect("ok");
        assert!((left.coefficient - law.coefficient(0.1)).abs() < 1e-13);
        assert!((left.slope - law.slope(0.1)).abs() < 1e-12);
    }
    println!("sums: μ̄ {worst:e} absolute, slope {worst_slope:e} relative");
}

/// Two and three incommensurate sines beyond the corner, decreasing law: b₀ + b₁e^{−w} Π I₀(aᵢ).
#[test]
fn independent_sines_have_a_product_form() {
    let [_, law] = laws();
    let sine = FastWave::Integral(Waveform::Sine);
    let i0 = |a: f64| quell_numerics::special::bessel_i0_scaled(a) * libm::exp(a);
    for (alphas, v, close) in [
        (vec![0.1, 0.3], 0.45, 1e-12),
        (vec![0.05, 0.02], 0.071, 1e-12),
        (vec![0.1, 0.15, 0.06], 0.35, 1e-9),
    ] {
        let groups = alphas.iter().map(|a| group(vec![term(sine.clone(), *a, 1, 0.3)])).collect();
        let found = effective(&law, &FastMotion::new(groups), v).expect("ok");
        let product: f64 = alphas.iter().map(|a| i0(a / VM)).product();
        let tail = (0.4 - 0.2857) * libm::exp(-v / VM) * product;
        assert!(relative(found.coefficient, 0.2857 + tail) < close, "{found:?} {tail}");
        assert!(relative(found.slope, -tail / VM) < close * 10.0, "{found:?} {tail}");
    }
}

/// The order in which groups are averaged does not matter, inside, outside and between the corners. A wave split into two equal
/// halves is not recognised as one with a closed form and is integrated numerically: the split chooses the order.
#[test]
fn independent_groups_commute() {
    let mut worst = (0.0_f64, 0.0_f64);
    for law in laws() {
        for (one, two) in [
            (Waveform::Sine, Waveform::Triangle),
            (Waveform::Square, Waveform::Sine),
            (Waveform::Triangle, Waveform::Square),
        ] {
            let whole =
                |waveform, alpha| group(vec![term(FastWave::Integral(waveform), alpha, 1, 0.5)]);
            let halves = |waveform, alpha: f64| {
                let half = term(FastWave::Integral(waveform), 0.5 * alpha, 1, 0.5);
                group(vec![half.clone(), half])
            };
            for v in [0.01, 0.1, 0.17, 0.23, 0.6] {
                let motions = [
                    FastMotion::new(vec![whole(one.clone(), 0.2), halves(two.clone(), 0.07)]),
                    FastMotion::new(vec![whole(two.clone(), 0.07), halves(one.clone(), 0.2)]),
                ];
                let [a, b] = motions.map(|motion| effective(&law, &motion, v).expect("ok"));
                let e = (a.coefficient - b.coefficient).abs();
                let s = (a.slope - b.slope).abs();
                assert!(e < 1e-11, "{one:?} {two:?} {v}: {a:?} {b:?}");
                assert!(s < 1e-9 * (1.0 + a.slope.abs()), "{one:?} {two:?} {v}: {a:?} {b:?}");
                assert!(e <= a.coefficient_error + b.coefficient_error, "{v}: {a:?} {b:?}");
                assert!(s <= a.slope_error + b.slope_error, "{one:?} {two:?} {v}: {a:?} {b:?}");
                worst = (worst.0.max(e), worst.1.max(s));
            }
        }
        // A second group of negligible amplitude changes nothing.
        let first = group(vec![term(FastWave::Integral(Waveform::Sine), 0.2, 1, 0.0)]);
        let still = group(vec![term(FastWave::Integral(Waveform::Square), 1e-9, 1, 0.0)]);
        let both = effective(&law, &FastMotion::new(vec![first, still]), 0.1).expect("ok");
        let one = effective(&law, &plain(Waveform::Sine, 0.2), 0.1).expect("ok");
        assert!((both.coefficient - one.coefficient).abs() < 1e-11);
        assert!((both.slope - one.slope).abs() < 1e-8);
    }
    let groups = (0..4)
        .map(|k| group(vec![term(FastWave::Integral(Waveform::Sine), 0.1, 1, f64::from(k))]))
        .collect();
    println!("two groups, either order: μ̄ {:e}, slope {:e}", worst.0, worst.1);
    let many = effective(&laws()[0], &FastMotion::new(groups), 0.1);
    assert_eq!(many, Err(AveragingError::TooManyGroups { groups: 4, largest: 3 }));
}

/// Load and slip of one frequency in quadrature are correlated: decreasing law beyond the corner,
/// b₀ + b₁e^{−w}[I₀(a) − n sin φ I₁(a)] for s = −α cos θ, ν = n sin(θ + φ).
#[test]
fn correlated_load() {
    let [_, law] = laws();
    let (alpha, v, n) = (0.15, 0.3, 0.4);
    for phase in [0.0, 0.5, 1.7, 3.0] {
        let mut motion = group(vec![term(FastWave::Integral(Waveform::Sine), alpha, 1, 0.0)]);
        motion.load.push(quell_linear::averaging::LoadTerm {
            wave: quell_linear::averaging::LoadWave::Waveform(Waveform::Sine),
            amplitude: n,
            harmonic: 1,
            phase,
        });
        let found = effective(&law, &FastMotion::new(vec![motion]), v).expect("ok");
        let a = alpha / VM;
        let i0 = quell_numerics::special::bessel_i0_scaled(a);
        let i1 = quell_numerics::special::bessel_i1_scaled(a);
        let tail = (0.4 - 0.2857) * libm::exp(a - v / VM) * (i0 - n * libm::sin(phase) * i1);
        assert!(relative(found.coefficient, 0.2857 + tail) < 1e-13, "{phase}: {found:?}");
        assert!(relative(found.slope, -tail / VM) < 1e-12, "{phase}: {found:?}");
    }
}

/// From a belt: commensurate and incommensurate dithers are grouped, zero amplitudes are dropped, R ≤ 1 is rejected.
#[test]
fn motion_of_a_belt() {
    let dither = |direction, frequency_ratio: f64, amplitude| {
        at_phase(dither::dither(direction, Waveform::Triangle, amplitude, frequency_ratio), 0.3)
    };
    let belt = |dithers| belt(0.01, 0.3, &laws()[0], dithers);
    let (t, n) = (Direction::Tangential, Direction::Normal);
    let options = Averaging::Limit;
    let motion = |dithers| FastMotion::of(&belt(dithers), 0.3, options).expect("ok");
    assert_eq!(motion(vec![dither(t, 10.0, 0.0)]), FastMotion::default());
    assert_eq!(motion(vec![dither(t, 10.0, 0.5), dither(n, 20.0, 0.5)]).groups().len(), 1);
    assert_eq!(motion(vec![dither(t, 10.0, 0.5), dither(t, 31.4159, 0.5)]).groups().len(), 2);
    let normal = motion(vec![dither(n, 10.0, 0.5)]);
    let level = laws()[0].coefficient(0.3);
    assert!(relative(normal.groups()[0].normal[0].amplitude, 0.05 * level) < 1e-15);
    // With tangential dither the normal one is driven by the effective friction under it.
    let both = motion(vec![dither(t, 10.0, 4.0), dither(n, 10.0, 0.5)]);
    let tangential = effective(&laws()[0], &plain(Waveform::Triangle, 0.4), 0.3).expect("ok");
    assert!(relative(both.groups()[0].normal[0].amplitude, 0.05 * tangential.coefficient) < 1e-14);
    let slow = FastMotion::of(&belt(vec![dither(t, 0.9, 0.5)]), 0.3, Averaging::FiniteR);
    assert_eq!(slow, Err(AveragingError::NotFast { frequency_ratio: 0.9 }));
}
