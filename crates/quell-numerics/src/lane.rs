//! The number type of the hot kernels: one `f64`, or several side by side.
//!
//! Every kernel of the engine is written once over [`Lane`] and uses only the
//! operations below, in a declared order. Addition, multiplication and the fused
//! [`Lane::mul_add`] are correctly rounded everywhere, so a kernel gives the same bits
//! alone (`f64`), in any SIMD lane and on any instruction set.

use std::ops::{Add, Mul, Neg, Sub};

/// 1.5·2⁵²: adding and subtracting it rounds to the nearest integer, ties to even.
const ROUNDING_SHIFT: f64 = 6_755_399_441_055_744.0;

/// One real number per lane.
pub trait Lane:
    Copy
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Neg<Output = Self>
{
    /// The same value in every lane.
    fn splat(value: f64) -> Self;

    /// `self * factor + addend`, rounded once.
    #[must_use]
    fn mul_add(self, factor: Self, addend: Self) -> Self;

    /// Absolute value.
    #[must_use]
    fn abs(self) -> Self;

    /// The larger of two numbers.
    #[must_use]
    fn max(self, other: Self) -> Self;

    /// 2ⁿ for integral `self` = n in −1022…1023.
    #[must_use]
    fn power_of_two(self) -> Self;

    /// Nearest integer, ties to even, for magnitudes below 2⁵¹.
    #[inline(always)]
    #[must_use]
    fn round(self) -> Self {
        let shift = Self::splat(ROUNDING_SHIFT);
        (self + shift) - shift
    }
}

impl Lane for f64 {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        f64::mul_add(self, factor, addend)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }

    #[inline(always)]
    fn power_of_two(self) -> Self {
        // The low bits of n + 1.5·2⁵² hold n in two's complement; the shift moves the
        // biased exponent into place.
        let shifted = (self + (ROUNDING_SHIFT + 1023.0)).to_bits();
        f64::from_bits(shifted << 52)
    }
}

/// Σ aⱼ bₖ₋ⱼ over j = `from`…`to`: part of the k-th coefficient of a product of two series.
///
/// Order of summation: j ascends, even and odd offsets in two accumulators, then their sum.
/// Two chains hide half of the latency of a fused multiply-add.
#[inline(always)]
pub fn partial_product<V: Lane>(a: &[V], b: &[V], k: usize, from: usize, to: usize) -> V {
    if to < from {
        return V::splat(0.0);
    }
    let mut first = a[from] * b[k - from];
    if to == from {
        return first;
    }
    let mut second = a[from + 1] * b[k - from - 1];
    let mut j = from + 2;
    while j < to {
        first = a[j].mul_add(b[k - j], first);
        second = a[j + 1].mul_add(b[k - j - 1], second);
        j += 2;
    }
    if j == to {
        first = a[j].mul_add(b[k - j], first);
    }
    first + second
}

/// Σ aⱼ aₖ₋ⱼ over j = 1…k−1: the square of a series without its newest coefficient, at half
/// the work of a product.
#[inline(always)]
pub fn inner_square<V: Lane>(a: &[V], k: usize) -> V {
    if k < 2 {
        return V::splat(0.0);
    }
    let half = k.div_ceil(2);
    let sum = partial_product(a, a, k, 1, half - 1);
    let twice = sum + sum;
    if k.is_multiple_of(2) { a[k / 2].mul_add(a[k / 2], twice) } else { twice }
}

/// Repeats a block for `$k` = 0…15 with `$k` a constant, so that every loop inside has a
/// constant length and no bound is checked at run time.
#[macro_export]
macro_rules! for_each_order_below_16 {
    ($k:ident, $body:block) => {
        $crate::for_each_order_below_16!(@ $k, $body, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15)
    };
    (@ $k:ident, $body:block, $($n:literal),+) => {
        $({
            const $k: usize = $n;
            $body
        })+
    };
}

/// Value of Σ cₖ tᵏ by Horner's rule.
#[inline(always)]
pub fn horner<V: Lane>(coefficients: &[V], t: V) -> V {
    let mut value = V::splat(0.0);
    for &coefficient in coefficients.iter().rev() {
        value = value.mul_add(t, coefficient);
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_two_are_exact() {
        for n in [-1022, -1021, -53, -1, 0, 1, 10, 1023] {
            assert_eq!(Lane::power_of_two(f64::from(n)), 2f64.powi(n), "2^{n}");
        }
    }

    #[test]
    fn rounding_is_to_nearest_even() {
        for (x, n) in [(0.5, 0.0), (1.5, 2.0), (-2.5, -2.0), (3.49, 3.0), (-7.51, -8.0)] {
            assert_eq!(Lane::round(x), n);
        }
    }

    #[test]
    fn products_of_series_agree_with_the_plain_sum() {
        // Small integers: every order of summation is exact.
        let a: Vec<f64> = (0..17).map(|k| f64::from((k * 7 + 3) % 11) - 5.0).collect();
        let b: Vec<f64> = (0..17).map(|k| f64::from((k * 5 + 1) % 13) - 6.0).collect();
        for k in 0..17 {
            let plain: f64 = (0..=k).map(|j| a[j] * b[k - j]).sum();
            assert_eq!(partial_product(&a, &b, k, 0, k), plain, "product, k = {k}");
            let square: f64 = (1..k).map(|j| a[j] * a[k - j]).sum();
            assert_eq!(inner_square(&a, k), square, "square, k = {k}");
        }
    }
}
