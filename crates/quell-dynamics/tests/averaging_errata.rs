//! Where the dissertation's print is wrong: the printed formula, its value, and the right one.
//!
//! Each test computes the formula as printed, checks that it gives the printed number, and that Quell gives the right one,
//! which the definition (quadrature) confirms. Unless noted: v_r = 0.08, α = 0.2, the dissertation's parameters.

use core::f64::consts::{FRAC_PI_2, PI, TAU};

use quell_dynamics::orbit::ThresholdKind;
use quell_linear::averaging::{
    Averaging, Becomes, EverywhereStable, FastMotion, FastWave, closed_band, critical_amplitudes,
    effective, effective_by_quadrature, everywhere_stable_amplitude,
};
use quell_model::{Direction, LawKind, Waveform};
use quell_numerics::interval::RealInterval;
use quell_numerics::quadrature::{QuadratureOptions, integrate};
use quell_numerics::special::{dawson, erf, exp, ln};
use quell_zoo::belt::{belt, decreasing_under, over_amplitudes};
use quell_zoo::dither::{normal, sine};
use quell_zoo::law::{MINIMUM, REFERENCE_VELOCITY, STATIC, build, dissertation};

use crate::local_thresholds;

const VM: f64 = REFERENCE_VELOCITY;
const DIFFERENCE: f64 = STATIC - MINIMUM;

fn close(value: f64, exact: f64, tolerance: f64) {
    assert!(((value - exact) / exact).abs() < tolerance, "{value} should be {exact}");
}

fn erfi(x: f64) -> f64 {
    core::f64::consts::FRAC_2_SQRT_PI * exp(x * x) * dawson(x)
}

/// (μ̄, slope), by closed form and checked by quadrature.
fn right(kind: LawKind, waveform: Waveform, v: f64, alpha: f64) -> (f64, f64) {
    let (law, wave) = (dissertation(kind), FastWave::Integral(waveform));
    let closed = effective(&law, &FastMotion::single(wave.clone(), alpha), v).expect("a value");
    let numeric = effective_by_quadrature(&law, &wave, alpha, v).expect("a value");
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
    // As printed, and with the exponent and the second term corrected: the error functions of (3.38a) remain.
    let terms = exp(w - gamma) * erfi(t0) - exp(-w - gamma) * erf(t0)
        + exp(-w - gamma) * (erf(gamma.sqrt()) + erfi(gamma.sqrt()));
    let printed = |power: f64, factor: f64| {
        2.0 * MINIMUM / (PI * 0.2) * (1.0 - w / gamma).powf(power)
            + DIFFERENCE / (PI * VM * 0.2).sqrt() * (1.0 + exp(-2.0 * gamma)) * factor
            - 0.5 * DIFFERENCE / (VM * 0.2).sqrt() * terms
    };
    close(printed(0.5, 1.0), 0.739_040_811_589, 1e-11);
    close(printed(-0.5, 0.5 / t0), 1.324_435_458_176_6, 1e-12);
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
    close(jump + smooth(0.08, 0.2, PI * PI / 16.0), 1.2737830223029, 1e-12);
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
    let stribeck = dissertation(LawKind::Stribeck);
    let band = closed_band(&stribeck, 0.005, 1.0, &Waveform::Triangle, 0.15).expect("a band");
    let upper = band.upper.expect("it ends");
    close(upper, 0.17925174576154, 1e-13);
    let (_, slope) = right(LawKind::Stribeck, Waveform::Triangle, upper, 0.15);
    assert!((0.01 + slope).abs() < 1e-13);
    let (_, slope) = right(LawKind::Stribeck, Waveform::Triangle, edge(PI * PI / 48.0), 0.15);
    close(0.01 + slope, 0.0595, 1e-3);
}

/// (3.44) a nested root, (3.48) a wrong constant, (4.38) twice too large: the amplitude that stabilises every velocity.
#[test]
fn everywhere_stable_amplitudes() {
    let stribeck = dissertation(LawKind::Stribeck);
    let found = |zeta: f64, waveform: Waveform, direction: Direction| {
        let wave = FastWave::Integral(waveform);
        match everywhere_stable_amplitude(&stribeck, zeta, 1.0, wave, direction) {
            Ok(EverywhereStable::From { amplitude_ratio, .. }) => amplitude_ratio,
            other => panic!("{other:?}"),
        }
    };
    let kappa = |zeta: f64| 4.0 * VM * zeta / (3.0 * DIFFERENCE);
    for (zeta, print, exact) in
        [(0.005, 0.162820988505, 0.162344061917), (0.1, 0.152805906, 0.142986790037)]
    {
        let nested = VM * (2.0 / 3.0 * (1.0 - kappa(zeta)).sqrt()).sqrt();
        close(nested, print, 1e-8);
        close(found(zeta, Waveform::Sine, Direction::Tangential), exact, 3e-12);
    }
    let printed = 2.0 / PI * VM * (3.0 - 4.0 * VM * 0.005 / DIFFERENCE).sqrt();
    close(printed, 0.219241511662, 1e-11);
    close(found(0.005, Waveform::Triangle, Direction::Tangential), 0.204443763791, 3e-12);
    // (4.38) with μ at the tip v₀ = α^L G_max.
    let tangential = VM / PI * (3.0 * (1.0 - kappa(0.005))).sqrt();
    close(found(0.005, Waveform::Square, Direction::Tangential), tangential, 1e-14);
    let level = stribeck.coefficient(tangential * Waveform::Square.peak_integral());
    let printed = VM / level * 2.0 / PI * (3.0 - 4.0 * VM * 0.005 / DIFFERENCE).sqrt();
    close(printed / found(0.005, Waveform::Square, Direction::Normal), 2.0, 1e-13);
}

/// (4.34), (4.36), (4.38) hold μ(v₀): at the α_N that (4.34) gives for v₀ = 0.05 another velocity is unstable. With μ at the tip
/// v₀ = α_N μ G_max every one is stable.
#[test]
fn stable_everywhere_needs_the_tip() {
    let (stribeck, wave) = (dissertation(LawKind::Stribeck), FastWave::Integral(Waveform::Sine));
    let found =
        match everywhere_stable_amplitude(&stribeck, 0.005, 1.0, wave.clone(), Direction::Normal) {
            Ok(EverywhereStable::From { amplitude_ratio, .. }) => amplitude_ratio,
            other => panic!("{other:?}"),
        };
    close(found, 0.557_124_589_480, 1e-11);
    let least = |alpha: f64| {
        let criterion = |v: f64| {
            let fast = alpha * stribeck.coefficient(v);
            0.01 + effective_by_quadrature(&stribeck, &wave, fast, v).expect("a value").slope
        };
        (1..200).map(|k| criterion(0.001 * f64::from(k))).fold(f64::INFINITY, f64::min)
    };
    let printed = 0.162_344_061_917 / stribeck.coefficient(0.05);
    close(printed, 0.453, 1e-2);
    assert!(least(printed) < -0.01, "{}", least(printed));
    assert!(least(1.001 * found) > 0.0, "{}", least(1.001 * found));
}

/// (3.36a) for v_r < 0 counts the sign twice: μ̄ is odd.
#[test]
fn sign_for_negative_slip() {
    let (v, alpha) = (-0.08, 0.2);
    let (minus, _) = right(LawKind::Decreasing, Waveform::Square, v, alpha);
    close(minus, -0.0789661487, 1e-8);
    // As printed: sgn(v_r) before a bracket with v_r and θ₁(v_r) in it, where v_r + αG(θ₁) = 0.
    let crossing = FRAC_PI_2 - v / alpha;
    let mean = |from: f64, to: f64, sign: f64| {
        let excess = |x: f64| exp(sign * (v + alpha * Waveform::Square.integral(x)) / VM) / TAU;
        integrate(excess, from, to, &[PI], &QuadratureOptions::default()).expect("converges").value
    };
    let inner = mean(crossing, TAU - crossing, -1.0);
    let outer = mean(0.0, crossing, 1.0) + mean(TAU - crossing, TAU, 1.0);
    let bracket = MINIMUM * (1.0 - 2.0 * crossing / PI) + DIFFERENCE * (inner - outer);
    let printed = v.signum() * bracket;
    assert!((printed.abs() / minus.abs() - 1.0).abs() < 1e-9 && printed > 0.0, "{printed}");
}

/// (2.21), (3.19): x′ = Z′ + αG makes the slip v_r − αG. The printed + is harmless for antiperiodic G only; two sines at R and
/// 2R are not antiperiodic.
#[test]
fn sign_of_the_fast_motion() {
    let law = dissertation(LawKind::Decreasing);
    let dithers = vec![sine(1.0, 10.0), sine(1.0, 20.0)];
    let belt = belt(0.005, 0.3, &law, dithers);
    let fast = |theta: f64| -0.1 * theta.cos() - 0.05 * (2.0 * theta).cos();
    let average = |sign: f64| {
        let mean = |theta: f64| law.coefficient(0.3 + sign * fast(theta)) / TAU;
        integrate(mean, 0.0, TAU, &[PI], &QuadratureOptions::default()).expect("converges").value
    };
    let motion = FastMotion::of(&belt, 0.3, Averaging::Limit).expect("a motion");
    let found = effective(&law, &motion, 0.3).expect("a value").coefficient;
    close(found, average(-1.0), 1e-12);
    assert!((average(1.0) / average(-1.0) - 1.0).abs() > 1e-3, "the printed sign is seen");
}

/// Text after (3.25): G is even, and only for an even G is τ₂ = 2π − τ₁ the second phase at which αG takes a value.
#[test]
fn integral_of_a_waveform_is_even() {
    for waveform in [Waveform::Sine, Waveform::Triangle, Waveform::Square] {
        for k in 1..40 {
            let theta = 0.15 * f64::from(k);
            let (here, mirrored) = (waveform.integral(theta), waveform.integral(TAU - theta));
            assert!((here - mirrored).abs() < 1e-14);
            assert!(
                (waveform.value(theta) + waveform.value(TAU - theta)).abs() < 1e-14,
                "g is odd"
            );
        }
        assert!(waveform.integral(0.3) + waveform.integral(TAU - 0.3) < -0.5, "G is not odd");
    }
}

/// (B.3), (B.4), (B.5): wrong prefactors of the three integrals behind (3.38a).
#[test]
fn integrals_of_appendix_b() {
    let (v, alpha) = (0.08, 0.2);
    let crossing = (PI * (PI / 4.0 - v / alpha)).sqrt();
    let integral = |from: f64, to: f64, sign: f64| {
        let density = |x: f64| exp(sign * (v + alpha * Waveform::Triangle.integral(x)) / VM);
        integrate(density, from, to, &[FRAC_PI_2, 3.0 * FRAC_PI_2], &QuadratureOptions::default())
            .expect("converges")
            .value
    };
    let (gamma, w) = (PI * alpha / (4.0 * VM), v / VM);
    let first = 0.5 * PI * (VM / alpha).sqrt() * erfi((gamma - w).sqrt());
    let right = exp(w - gamma) * first;
    close(right, 0.856_800_506_592_44, 1e-12);
    close(integral(0.0, crossing, 1.0), right, 1e-12);
    close(integral(TAU - crossing, TAU, 1.0), right, 1e-12);
    let (b3, b5) = (exp((v - alpha * PI / VM) / VM) * first, exp(w - alpha * PI / 4.0) * first);
    assert!(b3 < 1e-6 && (b5 - 1.6060).abs() < 1e-4, "{b3} {b5}");
    let second = |sign: f64| {
        let jump = exp(sign * gamma - w) * (erf(gamma.sqrt()) - erf((gamma - w).sqrt()));
        PI * (VM / alpha).sqrt() * (jump + exp(-w - gamma) * erfi(gamma.sqrt()))
    };
    close(integral(crossing, TAU - crossing, -1.0), second(1.0), 1e-12);
    close(second(1.0), 2.068_384_752_523, 1e-12);
    close(second(-1.0), 1.446_860_439_5, 1e-10);
}

/// "μ̄′ ≥ 0 inside": for Stribeck iff (μ_s − μ_m)/μ_s ≤ √6/π (sine), √0.4 (triangle); always for the square.
#[test]
fn slope_inside_can_be_negative() {
    // The slope inside is least at v_r = 0.
    let least = |share: f64, waveform: Waveform| {
        let law = build(LawKind::Stribeck, &[STATIC, STATIC * (1.0 - share), VM]);
        let wave = FastWave::Integral(waveform);
        (1..400)
            .map(|k| {
                let motion = FastMotion::single(wave.clone(), 0.005 * f64::from(k));
                effective(&law, &motion, 0.0).expect("a value").slope
            })
            .fold(f64::INFINITY, f64::min)
    };
    for (waveform, limit) in
        [(Waveform::Sine, 6.0_f64.sqrt() / PI), (Waveform::Triangle, 0.4_f64.sqrt())]
    {
        assert!(least(limit - 0.01, waveform.clone()) > 0.0, "{waveform:?}");
        assert!(least(limit + 0.01, waveform.clone()) < 0.0, "{waveform:?}");
    }
    assert!(least(0.999, Waveform::Square) > 0.0);
}

/// (4.15), dw/dθ = α_N μ(V − w) g, "cannot be solved exactly": it separates. For the decreasing law
/// H(u) = (v_m/μ_m) ln(μ_m e^{u/v_m} + Δμ) has H′ = 1/μ, so that H(V − w) + α_N G is constant.
#[test]
fn fast_motion_under_normal_dither_separates() {
    let (law, slow, alpha) = (dissertation(LawKind::Decreasing), 0.3, 0.05);
    let primitive = |u: f64| VM / MINIMUM * ln(MINIMUM * exp(u / VM) + DIFFERENCE);
    let rate = |theta: f64, w: f64| alpha * law.coefficient(slow - w) * theta.sin();
    let (mut w, step) = (0.01_f64, TAU / 2000.0);
    let constant = primitive(slow - w) - alpha;
    for k in 0..2000 {
        let theta = step * f64::from(k);
        let a = rate(theta, w);
        let b = rate(theta + 0.5 * step, w + 0.5 * step * a);
        let c = rate(theta + 0.5 * step, w + 0.5 * step * b);
        let d = rate(theta + step, w + step * c);
        w += step / 6.0 * (a + 2.0 * b + 2.0 * c + d);
        let integral = -(theta + step).cos();
        let kept = primitive(slow - w) + alpha * integral;
        assert!((kept - constant).abs() < 1e-12, "{kept} {constant}");
    }
}

/// φ′ under normal dither of the decreasing law at v₀, from H(v₀ − φ′) + α_N G = constant with ⟨φ′⟩ = 0, and the averages ⟨h⟩
/// over one period.
struct FastSliding {
    alpha: f64,
    waveform: Waveform,
    slow: f64,
    constant: f64,
}

impl FastSliding {
    fn new(waveform: &Waveform, alpha: f64, slow: f64) -> Self {
        let at = |constant: f64| Self { alpha, waveform: waveform.clone(), slow, constant };
        let middle = VM / MINIMUM * ln(MINIMUM * exp(slow / VM) + DIFFERENCE);
        let (mut low, mut high) = (middle - 0.02, middle + 0.02);
        for _ in 0..60 {
            let constant = 0.5 * (low + high);
            let mean = at(constant).mean(|w| w);
            if mean > 0.0 { low = constant } else { high = constant }
        }
        at(0.5 * (low + high))
    }

    fn mean(&self, of: impl Fn(f64) -> f64) -> f64 {
        let value = |theta: f64| {
            let level = self.constant - self.alpha * self.waveform.integral(theta);
            let slip = VM * ln((exp(MINIMUM * level / VM) - DIFFERENCE) / MINIMUM);
            of(self.slow - slip) / TAU
        };
        // ⟨φ′⟩ is searched for its zero.
        let options = QuadratureOptions { absolute: 1e-15, ..QuadratureOptions::default() };
        integrate(value, 0.0, TAU, &[PI], &options).expect("converges").value
    }
}

/// (4.24) drops a term of order one: the load α_N R g on the next order of the velocity. With it the criterion for R → ∞ is
/// 2ζ + ⟨(μ′/μ)(2ζφ′ + Z)⟩, Z = (F − 2ζ⟨φ′/μ⟩)/⟨1/μ⟩. The exact orbits converge to it as 1/R²; the frozen criterion differs
/// beyond α_N², by 0.03 and 0.08 % here. Orbits of this crate reach to R = 6.7, where D = F would open the contact; those at
/// R = 20 and 40 are Floquet multipliers that were computed without Quell, of friction μN that changes sign with N.
#[test]
fn limit_of_high_frequency_under_normal_dither() {
    let (law, v, damping) = (dissertation(LawKind::Decreasing), 0.075, 0.2);
    let slope = |u: f64| -DIFFERENCE / VM * exp(-u / VM);
    for (waveform, limit, frozen, orbits) in [
        (Waveform::Square, 0.115_322_218_4, 0.115_282_211_8, [0.115_038, 0.115_251]),
        (Waveform::Sine, 0.147_976_949_6, 0.148_091_109_1, [0.147_607, 0.147_884]),
    ] {
        let root = |criterion: &dyn Fn(&FastSliding) -> f64| {
            let (mut low, mut high) = (0.08, 0.16);
            for _ in 0..50 {
                let alpha = 0.5 * (low + high);
                let stable = criterion(&FastSliding::new(&waveform, alpha, v)) > 0.0;
                if stable { low = alpha } else { high = alpha }
            }
            0.5 * (low + high)
        };
        let with_load = |fast: &FastSliding| {
            let inverse = fast.mean(|w| 1.0 / law.coefficient(v - w));
            let slow_force =
                (1.0 - 2.0 * damping * fast.mean(|w| w / law.coefficient(v - w))) / inverse;
            let share =
                |w: f64| slope(v - w) / law.coefficient(v - w) * (2.0 * damping * w + slow_force);
            2.0 * damping + fast.mean(share)
        };
        close(root(&with_load), limit, 1e-8);
        close(root(&|fast| 2.0 * damping + fast.mean(|w| slope(v - w))), frozen, 1e-8);
        // Richardson extrapolation in 1/R² of two orbits, the second at twice the R of the first; the rest is of order 1/R⁴.
        let orbit = |ratio: f64| {
            let belt = belt(damping, v, &law, vec![normal(waveform.clone(), 0.1 * ratio, ratio)]);
            let range = RealInterval::new(0.85 * limit * ratio, limit * ratio);
            let found = local_thresholds(&over_amplitudes(&belt), range, 10);
            let hopf =
                found.iter().find(|threshold| threshold.kind == ThresholdKind::NeimarkSacker);
            hopf.expect("a threshold in slip").value / ratio
        };
        for (pair, within) in [([orbit(3.3), orbit(6.6)], 1e-5), (orbits, 3e-6)] {
            let extrapolated = (4.0 * pair[1] - pair[0]) / 3.0;
            assert!((extrapolated - limit).abs() < within, "{extrapolated} {limit}");
            assert!((extrapolated - frozen).abs() > 2e-5, "the frozen one is not the limit");
        }
    }
}

/// (4.32): φ′ stays frozen while friction is differentiated. Square, ζ = 0.2, v₀ = 0.075: the limit R → ∞ is 0.115322, the
/// frozen criterion with the exact φ′ gives 0.115282, the total derivative 0.097.
#[test]
fn fast_motion_stays_frozen_in_the_slope() {
    let (law, v, exact) = (dissertation(LawKind::Decreasing), 0.075, 0.115_322);
    let belt = belt(0.2, v, &law, vec![normal(Waveform::Square, 0.1, 40.0)]);
    for (normal_order, known) in
        [(Averaging::Limit, 0.115_719), (Averaging::LimitToSecondOrder, 0.115_518)]
    {
        let options = normal_order;
        let found = critical_amplitudes(&belt, options).expect("found");
        let nearest = found
            .iter()
            .map(|change| change.amplitude_ratio)
            .min_by(|a, b| (a - exact).abs().total_cmp(&(b - exact).abs()))
            .expect("one");
        assert!((nearest - known).abs() < 1e-5, "{nearest}");
        assert!((nearest / exact - 1.0).abs() < 0.004, "{nearest}");
    }
    // As printed: d/dv of ⟨μ(v − α_N μ(v) G)⟩.
    let level = |v: f64, alpha: f64| {
        let wave = FastWave::Integral(Waveform::Square);
        effective_by_quadrature(&law, &wave, alpha * law.coefficient(v), v)
            .expect("a value")
            .coefficient
    };
    let criterion = |alpha: f64| 0.4 + (level(v + 1e-5, alpha) - level(v - 1e-5, alpha)) / 2e-5;
    let (mut low, mut high) = (0.06, 0.115);
    assert!(criterion(low) * criterion(high) < 0.0, "{} {}", criterion(low), criterion(high));
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if criterion(low) * criterion(middle) <= 0.0 { high = middle } else { low = middle }
    }
    assert!((low - 0.0967).abs() < 3e-4, "{low}");
    assert!((low / exact - 1.0).abs() > 0.15);
}

/// Text of figure 2.10: "0.98" for v₀ = 1 is a plotting-grid value; the averaged quench amplitude is α = v₀ exactly, by a jump.
#[test]
fn quench_amplitude_is_a_jump() {
    let belt = decreasing_under(Waveform::Sine, 1.0);
    let found = critical_amplitudes(&belt, Averaging::Limit).expect("found");
    assert_eq!((found[1].amplitude_ratio, found[1].becomes), (1.0, Becomes::Stable));
    let (_, slope) = right(LawKind::Decreasing, Waveform::Sine, 1.0, 0.98);
    close(0.01 + slope, -0.0859403, 1e-5);
}
