//! An own implementation of exp, sin and cos with the same bits on every machine.
//!
//! Scheme: Cody–Waite reduction by fused multiply-add, then the Taylor polynomial on the
//! reduced interval (degree 13 on |r| ≤ ln 2 / 2; degrees 17 and 16 on |r| ≤ π/4), all with
//! [`Lane::mul_add`] and without branches or tables. The tests at the end of this file measure
//! the largest error against libm.

use crate::lane::Lane;

const LOG2_E: f64 = std::f64::consts::LOG2_E;
/// ln 2 with its last 20 bits cleared, so that n·LN_2_HIGH is exact for |n| < 2²⁰.
const LN_2_HIGH: f64 = 0.693_147_180_369_123_8;
const LN_2_LOW: f64 = 1.908_214_929_270_587_7e-10;

/// Below this the exponential is replaced by e^−708 ≈ 3·10⁻³⁰⁸: friction of that size is negligible.
const EXP_FLOOR: f64 = -708.0;

/// 1/k! for k = 0…17.
const INVERSE_FACTORIAL: [f64; 18] = {
    let mut table = [1.0; 18];
    let mut k = 2;
    // k! is exact up to 18!, so that every entry is rounded once.
    let mut factorial = 1.0;
    while k < 18 {
        factorial *= k as f64;
        table[k] = 1.0 / factorial;
        k += 1;
    }
    table
};

/// eˣ for x ≤ 708; below −708 the value at −708.
#[inline(always)]
pub fn exp<V: Lane>(x: V) -> V {
    let x = x.max(V::splat(EXP_FLOOR));
    let n = (x * V::splat(LOG2_E)).round();
    let r = n.mul_add(V::splat(-LN_2_HIGH), x);
    let r = n.mul_add(V::splat(-LN_2_LOW), r);
    let mut value = V::splat(INVERSE_FACTORIAL[13]);
    let mut k = 13;
    while k > 0 {
        k -= 1;
        value = value.mul_add(r, V::splat(INVERSE_FACTORIAL[k]));
    }
    value * n.power_of_two()
}

const FRAC_2_PI: f64 = std::f64::consts::FRAC_2_PI;
const FRAC_PI_2_HIGH: f64 = std::f64::consts::FRAC_PI_2;
/// π/2 minus its nearest double.
const FRAC_PI_2_LOW: f64 = 6.123_233_995_736_766e-17;

/// (sin θ, cos θ) of θ = rate·(time + time_low) + phase.
///
/// The product is computed exactly before it is reduced, so that the error stays at rounding
/// level for |θ| up to 2⁴⁰: long runs do not lose phase accuracy.
#[inline(always)]
pub fn sin_cos_of_phase<V: Lane>(rate: V, time: V, time_low: V, phase: V) -> (V, V) {
    let product = rate * time;
    let rest = rate.mul_add(time, -product);
    let rest = rate.mul_add(time_low, rest) + phase;
    let n = ((product + rest) * V::splat(FRAC_2_PI)).round();
    let r = n.mul_add(V::splat(-FRAC_PI_2_HIGH), product) + rest;
    let r = n.mul_add(V::splat(-FRAC_PI_2_LOW), r);

    let square = r * r;
    let mut sine = V::splat(INVERSE_FACTORIAL[17]);
    let mut cosine = V::splat(INVERSE_FACTORIAL[16]);
    let mut k = 16;
    while k >= 4 {
        let sign = if k % 4 == 0 { -1.0 } else { 1.0 };
        sine = sine.mul_add(square, V::splat(sign * INVERSE_FACTORIAL[k - 1]));
        cosine = cosine.mul_add(square, V::splat(sign * INVERSE_FACTORIAL[k - 2]));
        k -= 2;
    }
    let sine = (sine * square).mul_add(r, r);
    let cosine = cosine.mul_add(square, V::splat(1.0));

    // n mod 4 as −2…2, then cos(nπ/2) = 1 − |m| and sin(nπ/2) = m(2 − |m|): exact factors 0, ±1.
    let m = (n * V::splat(0.25)).round().mul_add(V::splat(-4.0), n);
    let cos_n = V::splat(1.0) - m.abs();
    let sin_n = m * (V::splat(2.0) - m.abs());
    (sine.mul_add(cos_n, cosine * sin_n), cosine.mul_add(cos_n, -(sine * sin_n)))
}

/// 2π minus its nearest double.
const TAU_LOW: f64 = 4.0 * FRAC_PI_2_LOW;

/// θ = rate·(time + time_low) + phase minus the nearest multiple of 2π: in [−π, π] up to rounding.
#[inline(always)]
pub fn reduced_phase(rate: f64, time: f64, time_low: f64, phase: f64) -> f64 {
    let product = rate * time;
    let rest = rate.mul_add(time, -product);
    let rest = rate.mul_add(time_low, rest) + phase;
    let n = ((product + rest) * (1.0 / std::f64::consts::TAU)).round_ties_even();
    let r = n.mul_add(-std::f64::consts::TAU, product) + rest;
    n.mul_add(-TAU_LOW, r)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phase_reduction_preserves_sine_and_cosine() {
        for i in 0..20_000_i32 {
            let time = f64::from(i * 977) / 1024.0;
            let reduced = reduced_phase(7.3, time, 1e-13, 0.4);
            let (sine, cosine) = sin_cos_of_phase(7.3, time, 1e-13, 0.4);
            assert!(reduced.abs() <= std::f64::consts::PI * (1.0 + 1e-15));
            assert!((libm::sin(reduced) - sine).abs() < 1e-15, "{time}");
            assert!((libm::cos(reduced) - cosine).abs() < 1e-15, "{time}");
        }
    }

    #[test]
    fn reduction_constants_sum_to_ln_2() {
        assert_eq!(LN_2_HIGH.to_bits() & 0xf_ffff, 0);
        assert_eq!(LN_2_HIGH + LN_2_LOW, std::f64::consts::LN_2);
    }

    #[test]
    fn exponential_is_within_two_units_of_the_last_place() {
        let mut worst: f64 = 0.0;
        for i in 0..200_000 {
            let x = f64::from(i) * -0.003_5 + 2.0;
            let reference = libm::exp(x);
            worst = worst.max(((exp(x) - reference) / reference).abs());
        }
        assert!(worst < 2.0 * f64::EPSILON, "largest relative error {worst:e}");
        assert_eq!(exp(0.0), 1.0);
        assert_eq!(exp(-1e9), exp(-708.0));
    }

    #[test]
    fn sine_and_cosine_are_accurate_for_large_arguments() {
        let mut worst: f64 = 0.0;
        for i in 0..100_000_i32 {
            // Multiples of 2⁻¹⁰ and an integral rate: the argument is exact in a double.
            let time = f64::from(i * 977) / 1024.0;
            let (sine, cosine) = sin_cos_of_phase(8.0, time, 0.0, 0.0);
            worst = worst.max((sine - libm::sin(8.0 * time)).abs());
            worst = worst.max((cosine - libm::cos(8.0 * time)).abs());
        }
        assert!(worst < 2.5e-16, "largest absolute error {worst:e}");
    }

    #[test]
    fn the_low_part_of_time_is_used() {
        let (time, low) = (1e6, 3e-11);
        let (sine, cosine) = sin_cos_of_phase(10.0, time, 0.0, 0.25);
        let (moved, _) = sin_cos_of_phase(10.0, time, low, 0.25);
        assert!((moved - sine - 10.0 * low * cosine).abs() < 3e-16);
    }
}
