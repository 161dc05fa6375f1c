//! Where the dissertation's print is wrong: the printed formula, its value, and the right one.
//!
//! Each test computes the formula as printed, checks that it gives the number the print gives, and that Quell gives the
//! right one, which the definition (quadrature) confirms. Unless said: v_r = 0.08, α = 0.2, the dissertation's parameters.

use core::f64::consts::PI;

use quell_belt::averaging::{
    Becomes, EverywhereStable, FastMotion, FastWave, closed_band, effective,
    effective_by_quadrature, everywhere_stable_amplitude,
};
use quell_model::{Direction, Friction, LawKind, Waveform};
use quell_numerics::special::{dawson, erf, exp};

const STATIC: f64 = 0.4;
const MINIMUM: f64 = 0.2857;
const VM: f64 = 0.2;
const DIFFERENCE: f64 = STATIC - MINIMUM;

fn law(kind: LawKind) -> Friction {
    kind.build(&[STATIC, MINIMUM, VM]).expect("valid")
}

fn close(value: f64, exact: f64, tolerance: f64) {
    assert!(
        ((value - exact) / exact).abs() < tolerance,
        "{value} should be {exact}"
    );
}

fn erfi(x: f64) -> f64 {
    core::f64::consts::FRAC_2_SQRT_PI * exp(x * x) * dawson(x)
}

/// (μ̄, slope), by closed form and checked by quadrature.
fn right(kind: LawKind, waveform: Waveform, v: f64, alpha: f64) -> (f64, f64) {
    let (law, wave) = (law(kind), FastWave::Integral(waveform));
    let closed = effective(&law, &FastMotion::single(wave, alpha), v).expect("a value");
    let numeric = effective_by_quadrature(&law, wave, alpha, v).expect("a value");
    close(closed.coefficient, numeric.coefficient, 1e-12);
    close(closed.slope, numeric.slope, 1e-11);
    (closed.coefficient, closed.slope)
}

/// (3.38a) = (B.10a), from (B.4): the error functions carry e^{γ−w}, not e^{−w−γ}. The print is not even continuous.
#[test]
fn effective_decreasing_triangle() {
    let printed = |v: f64, alpha: f64, sign: f64| {
        let (gamma, w) = (PI * alpha / (4.0 * VM), v / VM);
        let t0 = (gamma - w).max(0.0).sqrt();
        let bracket = exp(sign * gamma - w) * (erf(gamma.sqrt()) - erf(t0))
            + exp(-w - gamma) * erfi(gamma.sqrt())
            - exp(w - gamma) * erfi(t0);
        MINIMUM * (1.0 - (1.0 - w / gamma).max(0.0).sqrt())
            + 0.5 * DIFFERENCE * (VM / alpha).sqrt() * bracket
    };
    close(printed(0.08, 0.2, -1.0), 0.08071396100551, 1e-12);
    let (value, _) = right(LawKind::Decreasing, Waveform::Triangle, 0.08, 0.2);
    close(value, 0.09202036460588812, 1e-14);
    close(printed(0.08, 0.2, 1.0), value, 1e-13);
    let corner = 0.2 * PI / 4.0;
    close(printed(corner, 0.2, -1.0), 0.3109687685, 1e-9);
    let (value, _) = right(LawKind::Decreasing, Waveform::Triangle, corner, 0.2);
    close(value, 0.346727679552, 1e-12);
}

/// (3.53a): its slope inherits that, has a wrong sign in an exponent and lacks a factor.
#[test]
fn slope_decreasing_triangle() {
    let (_, slope) = right(LawKind::Decreasing, Waveform::Triangle, 0.08, 0.2);
    close(slope, 1.473609787898326, 1e-13);
    let (gamma, w): (f64, f64) = (PI / 4.0, 0.4);
    let t0 = (gamma - w).sqrt();
    let bracket = exp(gamma - w) * (erf(gamma.sqrt()) - erf(t0))
        + exp(-w - gamma) * erfi(gamma.sqrt())
        + exp(w - gamma) * erfi(t0);
    let corrected = 2.0 * MINIMUM / (PI * 0.2) / (1.0 - w / gamma).sqrt()
        + DIFFERENCE / ((PI * VM * 0.2).sqrt() * t0)
        - 0.5 * DIFFERENCE / (VM * 0.2).sqrt() * bracket;
    close(slope, corrected, 1e-12);
}

/// (3.45a), (3.45b): 3⟨G²⟩ of the triangle is π²/10, not π²/16.
#[test]
fn slope_stribeck_triangle() {
    let smooth = |v: f64, alpha: f64, constant: f64| {
        let (w, a) = (v / VM, alpha / VM);
        -1.5 * DIFFERENCE / VM * (1.0 - w * w - constant / 3.0 * a * a)
    };
    let jump = 2.0 * STATIC / (PI * 0.2) / (1.0_f64 - 4.0 * 0.08 / (PI * 0.2)).sqrt();
    close(
        jump + smooth(0.08, 0.2, PI * PI / 16.0),
        1.2737830223029,
        1e-12,
    );
    let (_, slope) = right(LawKind::Stribeck, Waveform::Triangle, 0.08, 0.2);
    close(slope, 1.3795420019633, 1e-12);
    close(smooth(0.18, 0.15, PI * PI / 16.0), -0.0637285, 1e-6);
    let (_, slope) = right(LawKind::Stribeck, Waveform::Triangle, 0.18, 0.15);
    close(slope, -0.00423903, 1e-6);
}

/// (3.46), (3.47), (4.35): ⟨G²⟩ = π²/30, not π²/48, in the upper edge of the unstable band (ζ = 0.005, α = 0.15).
#[test]
fn upper_edge_stribeck_triangle() {
    let kappa = 4.0 * VM * 0.005 / (3.0 * DIFFERENCE);
    let edge = |constant: f64| VM * (1.0 - constant * 0.5625 - kappa).sqrt();
    close(edge(PI * PI / 48.0), 0.18683419, 1e-7);
    let stribeck = law(LawKind::Stribeck);
    let band = closed_band(&stribeck, 0.005, 1.0, Waveform::Triangle, 0.15).expect("a band");
    let upper = band.upper.expect("it ends");
    close(upper, 0.17925174576154, 1e-13);
    let (_, slope) = right(LawKind::Stribeck, Waveform::Triangle, upper, 0.15);
    assert!((0.01 + slope).abs() < 1e-13);
    let (_, slope) = right(
        LawKind::Stribeck,
        Waveform::Triangle,
        edge(PI * PI / 48.0),
        0.15,
    );
    close(0.01 + slope, 0.0595, 1e-3);
}

/// (3.44) a nested root, (3.48) a wrong constant, (4.38) twice too large: the amplitude that stabilises every velocity.
#[test]
fn everywhere_stable_amplitudes() {
    let stribeck = law(LawKind::Stribeck);
    let found = |zeta: f64, waveform: Waveform, direction: Direction| {
        let wave = FastWave::Integral(waveform);
        match everywhere_stable_amplitude(&stribeck, zeta, 1.0, wave, direction) {
            Ok(EverywhereStable::From {
                amplitude_ratio, ..
            }) => amplitude_ratio,
            other => panic!("{other:?}"),
        }
    };
    let kappa = |zeta: f64| 4.0 * VM * zeta / (3.0 * DIFFERENCE);
    for (zeta, print, exact) in [
        (0.005, 0.162820988505, 0.162344061917),
        (0.1, 0.152805906, 0.142986790037),
    ] {
        let nested = VM * (2.0 / 3.0 * (1.0 - kappa(zeta)).sqrt()).sqrt();
        close(nested, print, 1e-8);
        close(
            found(zeta, Waveform::Sine, Direction::Tangential),
            exact,
            3e-12,
        );
    }
    let printed = 2.0 / PI * VM * (3.0 - 4.0 * VM * 0.005 / DIFFERENCE).sqrt();
    close(printed, 0.219241511662, 1e-11);
    close(
        found(0.005, Waveform::Triangle, Direction::Tangential),
        0.204443763791,
        3e-12,
    );
    // (4.38) with μ at the tip v₀ = α^L G_max.
    let tangential = VM / PI * (3.0 * (1.0 - kappa(0.005))).sqrt();
    close(
        found(0.005, Waveform::Square, Direction::Tangential),
        tangential,
        1e-14,
    );
    let level = stribeck.coefficient(tangential * Waveform::Square.peak_integral());
    let printed = VM / level * 2.0 / PI * (3.0 - 4.0 * VM * 0.005 / DIFFERENCE).sqrt();
    close(
        printed / found(0.005, Waveform::Square, Direction::Normal),
        2.0,
        1e-13,
    );
}

/// (3.36a) for v_r < 0 counts the sign twice: μ̄ is odd.
#[test]
fn sign_for_negative_slip() {
    let (minus, _) = right(LawKind::Decreasing, Waveform::Square, -0.08, 0.2);
    close(minus, -0.0789661487, 1e-8);
}

/// (3.61): "0.98" for v₀ = 1 is a plotting-grid value; the averaged quench amplitude is α = v₀ exactly, by a jump.
#[test]
fn quench_amplitude_is_a_jump() {
    let dither = quell_model::Dither {
        direction: Direction::Tangential,
        waveform: Waveform::Sine,
        amplitude: 1.0,
        frequency_ratio: 10.0,
        phase: 0.0,
    };
    let belt = quell_model::Belt::new(0.005, 1.0, 1.0, law(LawKind::Decreasing), vec![dither]);
    let found = quell_belt::averaging::critical_amplitudes(
        &belt.expect("valid"),
        quell_belt::averaging::AveragingOptions::default(),
    )
    .expect("found");
    assert_eq!(
        (found[1].amplitude_ratio, found[1].becomes),
        (1.0, Becomes::Stable)
    );
}
