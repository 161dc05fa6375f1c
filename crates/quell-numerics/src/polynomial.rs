//! First root of a polynomial on a step, isolated or proven absent; length of a Taylor step.
//!
//! Scheme: p(t) = Σ cₖtᵏ on (0, h] is written in the Bernstein basis. Descartes' rule of
//! signs counts: no variation, no root; one variation, exactly one root; more, the interval
//! is halved (de Casteljau). The isolated root is polished by Newton's method kept inside
//! its bracket. Two roots inside one step (a grazing dip) are therefore found, which tests
//! of the end points alone miss.
//!
//! Limits: a double root (a touch without crossing) separated by less than 2⁻⁴⁸ of the
//! step counts as absent. Degree at most [`MAX_DEGREE`].

use crate::lane::horner;

/// Largest degree that [`first_crossing`] accepts.
pub const MAX_DEGREE: usize = 31;

/// Halvings before two roots count as a touch.
const MAX_DEPTH: u32 = 48;

type Bernstein = [f64; MAX_DEGREE + 1];

/// First t in (0, h] where Σ cₖtᵏ leaves the sign of c₀, or `None` if it keeps it.
///
/// `c[0]` must not be zero: divide known roots at t = 0 out first. The degree is
/// `c.len() − 1`, at most [`MAX_DEGREE`].
#[inline(always)]
pub fn first_crossing(c: &[f64], h: f64) -> Option<f64> {
    if keeps_sign(c, h) {
        return None;
    }
    let sign = 1f64.copysign(c[0]);
    let mut scaled = [0.0; MAX_DEGREE + 1];
    let mut power = sign;
    for (entry, &coefficient) in scaled.iter_mut().zip(c) {
        *entry = coefficient * power;
        power *= h;
    }
    let scaled = &scaled[..c.len()];
    let mut bernstein = to_bernstein(scaled);
    let ends_below = horner(scaled, 1.0) <= 0.0;
    let last = c.len() - 1;
    // The end value by Horner's rule is what the next step starts from: it decides.
    bernstein[last] = horner(scaled, 1.0);
    match isolate(&bernstein[..c.len()], 0.0, 1.0, 0) {
        Some((low, high)) => Some((polish(scaled, low, high) * h).min(h)),
        None if ends_below => Some(h),
        None => None,
    }
}

/// Whether |c₀| > Σ|cₖ|hᵏ: a cheap proof that there is no root in [0, h].
#[inline(always)]
pub fn keeps_sign(c: &[f64], h: f64) -> bool {
    let mut tail = 0.0;
    for &coefficient in c[1..].iter().rev() {
        tail = f64::mul_add(tail, h, coefficient.abs());
    }
    c[0].abs() > tail * h
}

/// Bernstein coefficients on [0, 1] of Σ aₖuᵏ.
#[inline(always)]
fn to_bernstein(a: &[f64]) -> Bernstein {
    let n = a.len() - 1;
    let mut b = [0.0; MAX_DEGREE + 1];
    // aₖ / C(n, k), then n passes of Pascal's triangle.
    let mut inverse_binomial = 1.0;
    for (k, &coefficient) in a.iter().enumerate() {
        b[k] = coefficient * inverse_binomial;
        inverse_binomial *= (k + 1) as f64 / (n - k).max(1) as f64;
    }
    for pass in 1..=n {
        for k in (pass..=n).rev() {
            b[k] += b[k - 1];
        }
    }
    b
}

/// The leftmost interval with exactly one root of p, where p falls from plus to minus.
fn isolate(b: &[f64], low: f64, high: f64, depth: u32) -> Option<(f64, f64)> {
    match variations(b) {
        0 => return None,
        1 if b[0] > 0.0 => return Some((low, high)),
        _ => {}
    }
    let n = b.len() - 1;
    if depth == MAX_DEPTH {
        return (b[0] > 0.0 && b[n] <= 0.0).then_some((low, high));
    }
    // De Casteljau: the diagonal of the averages is the left half, what remains the right.
    let mut right: Bernstein = [0.0; MAX_DEGREE + 1];
    right[..=n].copy_from_slice(b);
    let mut left: Bernstein = [0.0; MAX_DEGREE + 1];
    for pass in 0..=n {
        left[pass] = right[0];
        for k in 0..n - pass {
            right[k] = 0.5 * (right[k] + right[k + 1]);
        }
    }
    let middle = 0.5 * (low + high);
    isolate(&left[..=n], low, middle, depth + 1)
        .or_else(|| isolate(&right[..=n], middle, high, depth + 1))
}

/// Changes of sign in a row of coefficients, zeros passed over.
fn variations(b: &[f64]) -> usize {
    let mut count = 0;
    let mut last = 0.0;
    for &value in b {
        if value != 0.0 {
            if value * last < 0.0 {
                count += 1;
            }
            last = 1f64.copysign(value);
        }
    }
    count
}

/// The one root of Σ aₖuᵏ in [low, high], where it falls from plus to minus, to the last bits.
#[inline(always)]
fn polish(a: &[f64], mut low: f64, mut high: f64) -> f64 {
    let mut u = 0.5 * (low + high);
    for _ in 0..80 {
        let mut value = 0.0;
        let mut slope = 0.0;
        for &coefficient in a.iter().rev() {
            slope = f64::mul_add(slope, u, value);
            value = f64::mul_add(value, u, coefficient);
        }
        if value > 0.0 {
            low = u;
        } else {
            high = u;
        }
        let newton = u - value / slope;
        let next = if newton > low && newton < high {
            newton
        } else {
            0.5 * (low + high)
        };
        let moved = (next - u).abs();
        u = next;
        // Two units in the last place of the step: below them Newton only dithers.
        if moved <= 4.0 * f64::EPSILON * u || value == 0.0 {
            break;
        }
    }
    u
}

/// A lower bound of x^(1/k) within 12 %, from exponent bits alone: no powf, same bits everywhere.
///
/// log₂ and 2^ are replaced by their chords between powers of two; the first errs low by
/// up to 0.086, the second high by up to 6.2 %, which the factor 0.94 takes back.
#[inline(always)]
pub fn root_from_below(x: f64, k: usize) -> f64 {
    const UNIT: f64 = 4_503_599_627_370_496.0; // 2⁵²
    const BIAS: f64 = 1023.0 * UNIT;
    let logarithm = x.clamp(1e-280, 1e280).to_bits() as f64 - BIAS;
    let bits = logarithm / k as f64 + BIAS;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a clamped positive logarithm plus the bias is a positive integer below 2⁶³"
    )]
    let root = f64::from_bits(bits as u64);
    0.94 * root
}

/// Step for which |last|·hᵏ and |previous|·hᵏ⁻¹ both stay below `tolerance`, the last two
/// retained terms of a Taylor series of degree k.
#[inline(always)]
pub fn step_length(tolerance: f64, last: f64, previous: f64, k: usize) -> f64 {
    let by_last = root_from_below(tolerance / last.abs(), k);
    let by_previous = root_from_below(tolerance / previous.abs(), k - 1);
    if by_last < by_previous { by_last } else { by_previous }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Coefficients of a·Π(t − rᵢ).
    fn planted(roots: &[f64], leading: f64) -> Vec<f64> {
        let mut c = vec![leading];
        for &root in roots {
            let mut next = vec![0.0; c.len() + 1];
            for (k, &value) in c.iter().enumerate() {
                next[k + 1] += value;
                next[k] -= root * value;
            }
            c = next;
        }
        c
    }

    #[test]
    fn finds_the_first_of_many_planted_roots() {
        let c = planted(&[0.7, 0.31, 0.9, 1.4, -0.2, 0.55], 3.0);
        let root = first_crossing(&c, 1.0).expect("a root was planted");
        assert!((root - 0.31).abs() < 1e-14, "{root}");
        assert!(first_crossing(&c, 0.3).is_none());
    }

    #[test]
    fn finds_a_dip_that_both_ends_hide() {
        for gap in [1e-1, 1e-3, 1e-5] {
            let c = planted(&[0.5, 0.5 + gap, -1.0, 3.0], -1.0);
            let root = first_crossing(&c, 1.0).expect("a dip was planted");
            assert!((root - 0.5).abs() < 1e-15 / gap, "gap {gap}: {root}");
        }
        // Lifted clear of the axis there is nothing to find.
        let mut c = planted(&[0.5, 0.5, -1.0, 3.0], -1.0);
        c[0] += 1e-9;
        assert!(c[0] > 0.0 && first_crossing(&c, 1.0).is_none());
    }

    #[test]
    fn a_root_at_the_very_end_is_in_the_step() {
        let root = first_crossing(&[1.0, -2.0], 0.5).expect("root at the end");
        assert!((root - 0.5).abs() < 1e-15);
    }

    #[test]
    fn no_root_is_lost_against_a_dense_scan() {
        // A chirp-like family; the scan may only miss what lies closer than its step.
        let mut state = 0x9e37_79b9_7f4a_7c15_u64;
        let mut random = || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        for _ in 0..2000 {
            let c: Vec<f64> = (0..17).map(|k| random() * 1.5f64.powi(k)).collect();
            let found = first_crossing(&c, 1.0);
            let scan = (1..=4000)
                .map(|i| f64::from(i) / 4000.0)
                .find(|&t| horner(&c, t) * c[0] <= 0.0);
            match (found, scan) {
                (Some(root), Some(bracket)) => assert!(root <= bracket + 1e-12),
                (None, Some(bracket)) => panic!("lost the root before {bracket}"),
                (Some(root), None) => assert!(horner(&c, root).abs() < 1e-9),
                (None, None) => {}
            }
        }
    }

    #[test]
    fn the_bound_on_roots_holds_from_below() {
        for k in [2, 15, 16, 24] {
            for i in -400..400 {
                let x = 10f64.powf(f64::from(i) * 0.05);
                let ratio = root_from_below(x, k) / x.powf(1.0 / k as f64);
                assert!(ratio <= 1.0 && ratio > 0.88, "k = {k}, x = {x:e}: {ratio}");
            }
        }
    }
}
