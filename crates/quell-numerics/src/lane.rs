//! The number type of the hot kernels: one `f64`, or several in SIMD lanes.
//!
//! Every kernel of the engine is generic over [`Lane`] and uses only the
//! operations below, in a fixed order. Addition, multiplication and the fused
//! [`Lane::mul_add`] are correctly rounded on every machine, so a kernel gives the same bits
//! in scalar form (`f64`), in any SIMD lane and with any instruction set ([`crate::dispatch`]).

use std::ops::{Add, Mul, Neg, Sub};

/// 1.5·2⁵²: adding and subtracting it rounds to the nearest integer, ties to even.
const ROUNDING_SHIFT: f64 = 6_755_399_441_055_744.0;

/// Maximum number of lanes of any type of this crate.
pub const MOST_LANES: usize = 16;

/// One real number per lane.
pub trait Lane:
    Copy
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Neg<Output = Self>
{
    /// Number of lanes.
    const LANES: usize;

    /// The same value in every lane.
    fn splat(value: f64) -> Self;

    /// The first [`Lane::LANES`] numbers of `from`, which has at least as many.
    fn load(from: &[f64]) -> Self;

    /// Writes the lanes to the first [`Lane::LANES`] entries of `to`, which has at least as many.
    fn store(self, to: &mut [f64]);

    /// The number of one lane, below [`Lane::LANES`].
    fn lane(&self, lane: usize) -> f64;

    /// Replaces the number of one lane, below [`Lane::LANES`].
    fn set_lane(&mut self, lane: usize, value: f64);

    /// The lanes in pairs, each with the number of its lane `place`, 0 or 1, in both; of one lane itself.
    #[must_use]
    fn pairwise(self, place: usize) -> Self;

    /// Applies `function` to every lane, for bit operations, divisions or roots. If the function has no branch,
    /// the compiler generates vector instructions for it.
    #[must_use]
    fn map(self, function: impl Fn(f64) -> f64) -> Self;

    /// Applies `function` to every pair of corresponding lanes.
    #[must_use]
    fn zip(self, other: Self, function: impl Fn(f64, f64) -> f64) -> Self;

    /// `self * factor + addend`, rounded once.
    #[must_use]
    fn mul_add(self, factor: Self, addend: Self) -> Self;

    /// Absolute value.
    #[must_use]
    fn abs(self) -> Self;

    /// The larger of two numbers; the second if they are equal.
    #[must_use]
    fn max(self, other: Self) -> Self;

    /// The smaller of two numbers; the second if they are equal.
    #[must_use]
    fn min(self, other: Self) -> Self;

    /// `yes` in the lanes where `self` > 0, otherwise `no`.
    #[must_use]
    fn where_positive(self, yes: Self, no: Self) -> Self;

    /// Whether any lane is > 0.
    fn any_positive(self) -> bool;

    /// 2ⁿ for integer `self` = n in −1022…1023.
    #[inline(always)]
    #[must_use]
    fn power_of_two(self) -> Self {
        // The low bits of n + 1.5·2⁵² are n in two's complement; the shift moves the
        // biased exponent to its position.
        self.map(|n| f64::from_bits((n + (ROUNDING_SHIFT + 1023.0)).to_bits() << 52))
    }

    /// Nearest integer, ties to even, for magnitudes below 2⁵¹.
    #[inline(always)]
    #[must_use]
    fn round(self) -> Self {
        let shift = Self::splat(ROUNDING_SHIFT);
        (self + shift) - shift
    }
}

impl Lane for f64 {
    const LANES: usize = 1;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn load(from: &[f64]) -> Self {
        from[0]
    }

    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        to[0] = self;
    }

    #[inline(always)]
    fn lane(&self, _: usize) -> f64 {
        *self
    }

    #[inline(always)]
    fn set_lane(&mut self, _: usize, value: f64) {
        *self = value;
    }

    #[inline(always)]
    fn pairwise(self, _: usize) -> Self {
        self
    }

    #[inline(always)]
    fn map(self, function: impl Fn(f64) -> f64) -> Self {
        function(self)
    }

    #[inline(always)]
    fn zip(self, other: Self, function: impl Fn(f64, f64) -> f64) -> Self {
        function(self, other)
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
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }

    #[inline(always)]
    fn where_positive(self, yes: Self, no: Self) -> Self {
        if self > 0.0 { yes } else { no }
    }

    #[inline(always)]
    fn any_positive(self) -> bool {
        self > 0.0
    }
}

/// Two groups of lanes processed alternately: while one waits for the result of an operation, the
/// other one is computed.
#[derive(Clone, Copy, Debug)]
pub struct LanePair<V>(V, V);

impl<V: Lane> Add for LanePair<V> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0, self.1 + other.1)
    }
}

impl<V: Lane> Sub for LanePair<V> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0, self.1 - other.1)
    }
}

impl<V: Lane> Mul for LanePair<V> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0, self.1 * other.1)
    }
}

impl<V: Lane> Neg for LanePair<V> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0, -self.1)
    }
}

impl<V: Lane> Lane for LanePair<V> {
    const LANES: usize = 2 * V::LANES;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self(V::splat(value), V::splat(value))
    }

    #[inline(always)]
    fn load(from: &[f64]) -> Self {
        Self(V::load(from), V::load(&from[V::LANES..]))
    }

    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        self.0.store(to);
        self.1.store(&mut to[V::LANES..]);
    }

    #[inline(always)]
    fn lane(&self, lane: usize) -> f64 {
        if lane < V::LANES { self.0.lane(lane) } else { self.1.lane(lane - V::LANES) }
    }

    #[inline(always)]
    fn set_lane(&mut self, lane: usize, value: f64) {
        if lane < V::LANES {
            self.0.set_lane(lane, value);
        } else {
            self.1.set_lane(lane - V::LANES, value);
        }
    }

    #[inline(always)]
    fn pairwise(self, place: usize) -> Self {
        Self(self.0.pairwise(place), self.1.pairwise(place))
    }

    #[inline(always)]
    fn map(self, function: impl Fn(f64) -> f64) -> Self {
        Self(self.0.map(&function), self.1.map(&function))
    }

    #[inline(always)]
    fn zip(self, other: Self, function: impl Fn(f64, f64) -> f64) -> Self {
        Self(self.0.zip(other.0, &function), self.1.zip(other.1, &function))
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        Self(self.0.mul_add(factor.0, addend.0), self.1.mul_add(factor.1, addend.1))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs(), self.1.abs())
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0), self.1.max(other.1))
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(self.0.min(other.0), self.1.min(other.1))
    }

    #[inline(always)]
    fn where_positive(self, yes: Self, no: Self) -> Self {
        Self(self.0.where_positive(yes.0, no.0), self.1.where_positive(yes.1, no.1))
    }

    #[inline(always)]
    fn any_positive(self) -> bool {
        self.0.any_positive() | self.1.any_positive()
    }
}

/// Σ aⱼ bₖ₋ⱼ over j = `from`…`to`: part of the k-th coefficient of a product of two series.
///
/// Order of summation: from the middle outwards, downwards in one accumulator and upwards in
/// another, then their sum. The newest coefficients of a recurrence are at both ends and are added
/// last, so that all other terms are summed while they are still being computed.
#[inline(always)]
pub fn partial_product<V: Lane>(a: &[V], b: &[V], k: usize, from: usize, to: usize) -> V {
    if to < from {
        return V::splat(0.0);
    }
    let middle = usize::midpoint(from, to);
    let mut down = a[middle] * b[k - middle];
    let mut j = middle;
    while j > from {
        j -= 1;
        down = a[j].mul_add(b[k - j], down);
    }
    if middle == to {
        return down;
    }
    let mut up = a[middle + 1] * b[k - middle - 1];
    let mut j = middle + 1;
    while j < to {
        j += 1;
        up = a[j].mul_add(b[k - j], up);
    }
    down + up
}

/// Half of Σ aⱼ aₖ₋ⱼ over j = 1…k−1: the square of a series without its newest coefficient, with
/// half the work of a product; the newest terms are added last.
#[inline(always)]
pub fn half_inner_square<V: Lane>(a: &[V], k: usize) -> V {
    if k < 2 {
        return V::splat(0.0);
    }
    let half = k / 2;
    let mut j = half;
    let mut sum =
        if k.is_multiple_of(2) { V::splat(0.5) * a[half] * a[half] } else { a[half] * a[half + 1] };
    while j > 1 {
        j -= 1;
        sum = a[j].mul_add(a[k - j], sum);
    }
    sum
}

/// Repeats a block for `$k` = 0…15 with constant `$k`, so that every loop inside has a
/// constant length and no bounds are checked at run time.
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
        // For small integers every order of summation is exact.
        let a: Vec<f64> = (0..17).map(|k| f64::from((k * 7 + 3) % 11) - 5.0).collect();
        let b: Vec<f64> = (0..17).map(|k| f64::from((k * 5 + 1) % 13) - 6.0).collect();
        for k in 0..17 {
            let plain: f64 = (0..=k).map(|j| a[j] * b[k - j]).sum();
            assert_eq!(partial_product(&a, &b, k, 0, k), plain, "product, k = {k}");
            let square: f64 = (1..k).map(|j| a[j] * a[k - j]).sum();
            assert_eq!(2.0 * half_inner_square(&a, k), square, "square, k = {k}");
        }
    }
}
