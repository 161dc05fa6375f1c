//! First root of a polynomial on a step, isolated or proven absent; length of a Taylor step.
//!
//! Scheme: for p(t) = Σ cₖtᵏ on (0, h], three tests in the order of their cost.
//! 1. The Bernstein coefficients of the cubic part exceed Σ|cₖ|hᵏ over k ≥ 4: no root.
//! 2. |c₁| > Σ k|cₖ|hᵏ⁻¹: p is monotone, so that the sign at h decides.
//! 3. Bernstein coefficients and Descartes' rule of signs: without a sign variation there is no root; with one
//!    variation, there is exactly one root; with more, the interval is halved (de Casteljau).
//!
//! The isolated root is refined by Newton's method, safeguarded by its bracket. Two roots
//! within one step (a grazing dip), which tests of the end points alone
//! miss, are therefore found. See Rouillier and Zimmermann (2004).
//!
//! [`side_by_side`] does the same for many polynomials at once.
//!
//! Limits: a double root (grazing without crossing), or two roots separated by less than 2⁻⁴⁸ of the
//! step, count as absent.

use crate::lane::Lane;

pub mod side_by_side;

/// Maximum number of halvings; two roots that are still not separated count as grazing.
const MAX_DEPTH: u32 = 48;

/// First t in (0, h] at which Σ cₖtᵏ no longer has the sign of c₀, or `None` if it keeps the sign.
///
/// c₀ must not be zero; for known roots at t = 0 use [`first_crossing_after`].
#[inline(always)]
pub fn first_crossing<const N: usize>(c: &[f64; N], h: f64) -> Option<f64> {
    first_crossing_after(c, 0, h)
}

/// [`first_crossing`] of Σ cₖ₊ₙtᵏ, that is, with n = `zeros` roots at t = 0 divided out.
#[inline(always)]
pub fn first_crossing_after<const N: usize>(c: &[f64; N], zeros: usize, h: f64) -> Option<f64> {
    // Scaled to [0, 1] and positive at 0.
    let a = match zeros {
        0 => scaled::<N, 0>(c, h),
        1 => scaled::<N, 1>(c, h),
        2 => scaled::<N, 2>(c, h),
        _ => {
            let mut quotient = [0.0; N];
            quotient[..N - zeros].copy_from_slice(&c[zeros..]);
            scaled::<N, 0>(&quotient, h)
        }
    };
    if margin_by_cubic(&[a[0], a[1], a[2], a[3]], absolute_sum(&a, 4)) > 0.0 {
        return None;
    }
    let mut slope_tail = 0.0;
    #[expect(clippy::needless_range_loop, reason = "k is a factor of the term")]
    for k in 2..N {
        slope_tail = f64::mul_add(k as f64, a[k].abs(), slope_tail);
    }
    // The next step starts from the value at the end, so its sign decides.
    let end = value(&a, 1.0);
    if a[1].abs() > slope_tail {
        if end > 0.0 {
            return None;
        }
        return Some(clipped(polish(&a, 0.0, 1.0, a[0] / (a[0] - end)), h));
    }
    let mut bernstein = to_bernstein(&a);
    bernstein[N - 1] = end;
    match isolate(&bernstein, 0.0, 1.0, 0) {
        Some(Bracket { low, high, guess }) => Some(clipped(polish(&a, low, high, guess), h)),
        None if end <= 0.0 => Some(h),
        None => None,
    }
}

/// cₖ₊ₙ hᵏ with the sign chosen such that the first one is positive, padded with zeros.
#[inline(always)]
fn scaled<const N: usize, const ZEROS: usize>(c: &[f64; N], h: f64) -> [f64; N] {
    let mut a = [0.0; N];
    let (mut even, mut odd) = (1f64.copysign(c[ZEROS]), h.copysign(c[ZEROS]));
    let square = h * h;
    for k in 0..N - ZEROS {
        if k % 2 == 0 {
            a[k] = c[k + ZEROS] * even;
            even *= square;
        } else {
            a[k] = c[k + ZEROS] * odd;
            odd *= square;
        }
    }
    a
}

/// Margin by which the Bernstein coefficients of the cubic part exceed the bound on the remaining terms.
#[inline(always)]
fn margin_by_cubic<V: Lane>(a: &[V; 4], tail: V) -> V {
    let third = V::splat(1.0 / 3.0);
    let b1 = a[1].mul_add(third, a[0]);
    let b2 = V::splat(2.0).mul_add(a[1], a[2]).mul_add(third, a[0]);
    let b3 = (a[0] + a[1]) + (a[2] + a[3]);
    // b3 last: it is NaN if any of the four is NaN, and then so is the result.
    (a[0] - tail).min(b1 - tail).min(b2 - tail).min(b3 - tail)
}

/// Σ |aₖ| over k ≥ `from`, in four accumulators.
#[inline(always)]
fn absolute_sum<V: Lane, const N: usize>(a: &[V; N], from: usize) -> V {
    let mut sums = [V::splat(0.0); 4];
    for k in from..N {
        sums[k % 4] = sums[k % 4] + a[k].abs();
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

/// The root as a time, at most h.
#[inline(always)]
fn clipped(u: f64, h: f64) -> f64 {
    let t = u * h;
    if t < h { t } else { h }
}

/// Σ aₖuᵏ as four interleaved sums in u⁴, with a quarter of the latency of Horner's rule.
#[inline(always)]
pub fn value<V: Lane, const N: usize>(a: &[V; N], u: V) -> V {
    let square = u * u;
    let fourth = square * square;
    let mut parts = [V::splat(0.0); 4];
    for k in (0..N).rev() {
        parts[k % 4] = parts[k % 4].mul_add(fourth, a[k]);
    }
    let odd = parts[3].mul_add(square, parts[1]);
    odd.mul_add(u, parts[2].mul_add(square, parts[0]))
}

/// Coefficients of the derivative of Σ aₖuᵏ.
#[inline(always)]
pub fn derivative<V: Lane, const N: usize>(a: &[V; N]) -> [V; N] {
    let mut d = [V::splat(0.0); N];
    for k in 1..N {
        d[k - 1] = a[k] * V::splat(k as f64);
    }
    d
}

/// Entry \[k\]\[j\] = C(j, k)/C(N−1, k): Bernstein coefficient j of uᵏ on [0, 1].
struct ToBernstein<const N: usize>;

impl<const N: usize> ToBernstein<N> {
    const MATRIX: [[f64; N]; N] = {
        let mut matrix = [[0.0; N]; N];
        let mut j = 0;
        while j < N {
            // C(j, k)/C(n, k) = Π (j − i)/(n − i) over i < k.
            matrix[0][j] = 1.0;
            let mut k = 1;
            while k <= j {
                matrix[k][j] = matrix[k - 1][j] * (j + 1 - k) as f64 / (N - k) as f64;
                k += 1;
            }
            j += 1;
        }
        matrix
    };
}

/// Bernstein coefficients on [0, 1] of Σ aₖuᵏ, summed by ascending k.
#[inline(always)]
fn to_bernstein<const N: usize>(a: &[f64; N]) -> [f64; N] {
    let matrix = &ToBernstein::<N>::MATRIX;
    let mut b = [a[0]; N];
    for k in 1..N {
        for j in 0..N {
            b[j] = f64::mul_add(matrix[k][j], a[k], b[j]);
        }
    }
    b
}

/// A subinterval of [0, 1] with exactly one root, and the zero crossing of the control polygon.
struct Bracket {
    low: f64,
    high: f64,
    guess: f64,
}

/// The leftmost interval with exactly one root of p, where p decreases from positive to negative values.
fn isolate<const N: usize>(b: &[f64; N], low: f64, high: f64, depth: u32) -> Option<Bracket> {
    match variations(b) {
        0 => return None,
        1 if b[0] > 0.0 => {
            let guess = low + (high - low) * polygon_zero(b);
            return Some(Bracket { low, high, guess });
        }
        _ => {}
    }
    let middle = 0.5 * (low + high);
    if depth == MAX_DEPTH {
        return (b[0] > 0.0 && b[N - 1] <= 0.0).then_some(Bracket { low, high, guess: middle });
    }
    // De Casteljau: the diagonal of the averages gives the left half, the remaining entries the right half.
    let mut right = *b;
    let mut left = [0.0; N];
    #[expect(clippy::needless_range_loop, reason = "the pass shortens the inner loop too")]
    for pass in 0..N {
        left[pass] = right[0];
        for k in 0..N - 1 - pass {
            right[k] = 0.5 * (right[k] + right[k + 1]);
        }
    }
    isolate(&left, low, middle, depth + 1).or_else(|| isolate(&right, middle, high, depth + 1))
}

/// Number of sign changes in a sequence of coefficients, ignoring zeros.
fn variations<const N: usize>(b: &[f64; N]) -> usize {
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

/// The point in [0, 1] at which the control polygon of `b` first decreases through zero.
fn polygon_zero<const N: usize>(b: &[f64; N]) -> f64 {
    let below = b.iter().position(|&value| value < 0.0).unwrap_or(N - 1).max(1);
    let (before, after) = (b[below - 1], b[below]);
    let share = if before > after { before / (before - after) } else { 0.5 };
    ((below - 1) as f64 + share) / (N - 1) as f64
}

/// The single root of Σ aₖuᵏ in [low, high], where it decreases from positive to negative values, to the last bits.
#[inline(always)]
fn polish<const N: usize>(a: &[f64; N], mut low: f64, mut high: f64, guess: f64) -> f64 {
    let mut u = guess;
    let derivative = derivative(a);
    for _ in 0..80 {
        let (value, slope) = (value(a, u), value(&derivative, u));
        if value > 0.0 {
            low = u;
        } else {
            high = u;
        }
        let newton = u - value / slope;
        let correction = (newton - u).abs();
        // Newton's method doubles the number of digits: after a correction this small the error is below rounding.
        if correction <= 1e-9 * u {
            return newton.clamp(low, high);
        }
        u = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if high - low <= 2.0 * f64::EPSILON * high {
            break;
        }
    }
    u
}

/// log₂ x of a positive number from its bits alone: the chord between powers of two, too low by up to
/// 0.086. No logarithm is called, so that the bits are the same on every machine.
#[inline(always)]
fn chord_logarithm<V: Lane>(x: V) -> V {
    /// 2⁵²: the lowest bits of its sum with a small integer are that integer.
    const SHIFT: f64 = 4_503_599_627_370_496.0;
    const SHIFT_BITS: u64 = SHIFT.to_bits();
    const ONE_BITS: u64 = 1f64.to_bits();
    const FRACTION: u64 = (1 << 52) - 1;
    // Clamped so that no exponent overflows below: steps beyond 10^±17 are useless at order 16.
    let x = x.max(V::splat(1e-280)).min(V::splat(1e280));
    let exponent = x.map(|x| f64::from_bits((x.to_bits() >> 52) | SHIFT_BITS));
    let significand = x.map(|x| f64::from_bits((x.to_bits() & FRACTION) | ONE_BITS));
    (exponent - V::splat(SHIFT + 1024.0)) + significand
}

/// Step for which the last two retained terms of a Taylor series of degree k, |last|·hᵏ and |previous|·hᵏ⁻¹, both stay below
/// `tolerance`, in every lane.
///
/// (tolerance/|last|)^(1/k) with chords for log₂ and 2^: the first has an error of ±0.086/k in the
/// exponent, the second is too high by up to 6.2 %; the factor 0.93 compensates both for k ≥ 8, at
/// the price of a step up to 8 % shorter than allowed.
#[inline(always)]
pub fn step_length<V: Lane>(tolerance: V, last: V, previous: V, k: usize) -> V {
    let tolerance = chord_logarithm(tolerance);
    let by_last = (tolerance - chord_logarithm(last.abs())) * V::splat(1.0 / k as f64);
    let by_previous =
        (tolerance - chord_logarithm(previous.abs())) * V::splat(1.0 / (k - 1) as f64);
    let exponent = by_last.min(by_previous);
    let whole = (exponent - V::splat(0.5)).round();
    let fraction = exponent - whole;
    (V::splat(0.93) + V::splat(0.93) * fraction) * whole.power_of_two()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lane::horner;

    /// Coefficients of a·Π(t − rᵢ), padded with zeros to degree 16.
    fn planted(roots: &[f64], leading: f64) -> [f64; 17] {
        let mut c = vec![leading];
        for &root in roots {
            let mut next = vec![0.0; c.len() + 1];
            for (k, &value) in c.iter().enumerate() {
                next[k + 1] += value;
                next[k] -= root * value;
            }
            c = next;
        }
        c.resize(17, 0.0);
        std::array::from_fn(|k| c[k])
    }

    #[test]
    fn the_first_of_many_known_roots_is_found() {
        let c = planted(&[0.7, 0.31, 0.9, 1.4, -0.2, 0.55], 3.0);
        let root = first_crossing(&c, 1.0).expect("a root was planted");
        assert!((root - 0.31).abs() < 1e-14, "{root}");
        assert!(first_crossing(&c, 0.3).is_none());
    }

    #[test]
    fn two_roots_within_one_step_are_found() {
        for gap in [1e-1, 1e-3, 1e-5] {
            let c = planted(&[0.5, 0.5 + gap, -1.0, 3.0], -1.0);
            let root = first_crossing(&c, 1.0).expect("a dip was planted");
            assert!((root - 0.5).abs() < 1e-15 / gap, "gap {gap}: {root}");
        }
        // Shifted clear of the axis, the polynomial has no root.
        let mut c = planted(&[0.5, 0.5, -1.0, 3.0], -1.0);
        c[0] += 1e-9;
        assert!(c[0] > 0.0 && first_crossing(&c, 1.0).is_none());
    }

    #[test]
    fn a_root_at_the_end_of_the_step_is_included() {
        let root = first_crossing(&[1.0, -2.0, 0.0, 0.0], 0.5).expect("root at the end");
        assert!((root - 0.5).abs() < 1e-15);
    }

    #[test]
    fn all_roots_of_a_dense_scan_are_found() {
        // A chirp-like family; the scan may only miss roots closer together than its step.
        let mut state = 0x9e37_79b9_7f4a_7c15_u64;
        let mut random = move || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        for _ in 0..2000 {
            let mut scale = 1.0;
            let c: [f64; 17] = std::array::from_fn(|_| {
                scale *= 1.5;
                random() * scale
            });
            let found = first_crossing(&c, 1.0);
            let scan =
                (1..=4000).map(|i| f64::from(i) / 4000.0).find(|&t| horner(&c, t) * c[0] <= 0.0);
            match (found, scan) {
                (Some(root), Some(bracket)) => assert!(root <= bracket + 1e-12),
                (None, Some(bracket)) => panic!("lost the root before {bracket}"),
                (Some(root), None) => assert!(horner(&c, root).abs() < 1e-9),
                (None, None) => {}
            }
        }
    }

    #[test]
    fn a_step_keeps_the_last_terms_below_the_tolerance() {
        for k in [8, 15, 16, 24] {
            for i in -200..200 {
                let last = 10f64.powf(f64::from(i) * 0.11);
                for previous in [0.0, 0.3 * last, 1e3 * last] {
                    let h = step_length(1e-12, last, previous, k);
                    let power = i32::try_from(k).expect("a small order");
                    let largest = |h: f64| (last * h.powi(power)).max(previous * h.powi(power - 1));
                    let terms = largest(h);
                    assert!(terms <= 1e-12, "k = {k}, last = {last:e}: {terms:e}");
                    // … and the step is not much shorter than necessary.
                    let terms = largest(1.16 * h);
                    assert!(terms >= 1e-12, "k = {k}, last = {last:e}: {terms:e}");
                }
            }
        }
        assert!(step_length(1e-12, 0.0, 0.0, 16) > 1e15);
    }
}
