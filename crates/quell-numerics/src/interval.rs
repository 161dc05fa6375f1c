//! Intervals of real numbers: windows, ranges and bounds, and their arithmetic with outward rounding, for proofs about formulas.
//!
//! Every operation of the arithmetic returns an interval that contains the exact result for all real numbers in its arguments. The four
//! operations and the square root are correctly rounded, so their bounds are moved outward by one unit in the last place;
//! the functions of libm have errors below one unit, so their bounds are moved by two. An infinite bound means "unbounded":
//! the numbers inside are still finite. An operation that is not defined on the whole argument returns `None`.

use std::f64::consts::TAU;
use std::ops::{Add, Mul, Neg, Sub};

/// All real numbers from `lower` to `upper`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RealInterval {
    /// Lower bound.
    pub lower: f64,
    /// Upper bound, at least the lower one; of a window that a user gives, once it is checked.
    pub upper: f64,
}

impl RealInterval {
    /// All real numbers.
    pub const WHOLE: Self = Self { lower: f64::NEG_INFINITY, upper: f64::INFINITY };

    /// The interval with these bounds, `lower` ≤ `upper`.
    pub const fn new(lower: f64, upper: f64) -> Self {
        Self { lower, upper }
    }

    /// The interval of a single number.
    pub const fn point(value: f64) -> Self {
        Self { lower: value, upper: value }
    }

    /// Distance of the bounds, rounded to nearest.
    pub fn width(self) -> f64 {
        self.upper - self.lower
    }

    /// The largest absolute value.
    pub fn magnitude(self) -> f64 {
        self.lower.abs().max(self.upper.abs())
    }

    /// The number at a fraction of the interval; exact at both ends.
    pub fn at(self, share: f64) -> f64 {
        if share == 1.0 { self.upper } else { self.width().mul_add(share, self.lower) }
    }

    /// The fraction of the interval at which a number is.
    pub fn share_of(self, value: f64) -> f64 {
        (value - self.lower) / self.width()
    }

    /// The number halfway between finite bounds, rounded to nearest.
    pub fn middle(self) -> f64 {
        0.5 * (self.lower + self.upper)
    }

    /// Whether both bounds are finite.
    pub fn is_bounded(self) -> bool {
        self.lower.is_finite() && self.upper.is_finite()
    }

    /// Whether the interval contains a number.
    pub fn contains(self, value: f64) -> bool {
        self.lower <= value && value <= self.upper
    }

    /// Moves the bounds outward by one unit in the last place.
    fn outward(lower: f64, upper: f64) -> Self {
        Self { lower: lower.next_down(), upper: upper.next_up() }
    }

    /// The image under an increasing function of libm.
    fn increasing(self, function: fn(f64) -> f64) -> Self {
        let wide = Self::outward(function(self.lower), function(self.upper));
        Self::outward(wide.lower, wide.upper)
    }

    /// Clamps both bounds to a range that the exact result cannot leave.
    fn within(self, lower: f64, upper: f64) -> Self {
        Self { lower: self.lower.clamp(lower, upper), upper: self.upper.clamp(lower, upper) }
    }

    /// The smallest interval that contains both.
    #[must_use]
    pub fn hull(self, other: Self) -> Self {
        Self { lower: self.lower.min(other.lower), upper: self.upper.max(other.upper) }
    }

    /// The numbers in both; `None` if no number is.
    pub fn intersection(self, other: Self) -> Option<Self> {
        let (lower, upper) = (self.lower.max(other.lower), self.upper.min(other.upper));
        (lower <= upper).then_some(Self { lower, upper })
    }

    /// Quotient; `None` if the divisor may be zero.
    #[must_use]
    pub fn over(self, divisor: Self) -> Option<Self> {
        if divisor.contains(0.0) {
            return None;
        }
        let inverse = Self::outward(1.0 / divisor.upper, 1.0 / divisor.lower);
        // The exact inverse has the sign of the divisor.
        let inverse = if divisor.lower > 0.0 {
            inverse.within(0.0, f64::INFINITY)
        } else {
            inverse.within(f64::NEG_INFINITY, 0.0)
        };
        Some(self * inverse)
    }

    /// Absolute value.
    #[must_use]
    pub fn abs(self) -> Self {
        if self.lower >= 0.0 {
            self
        } else if self.upper <= 0.0 {
            -self
        } else {
            Self { lower: 0.0, upper: self.upper.max(-self.lower) }
        }
    }

    /// Integer power, n ≥ 0.
    #[must_use]
    pub fn power(self, n: u32) -> Self {
        if n == 0 {
            return Self::point(1.0);
        }
        if n.is_multiple_of(2) && self.contains(0.0) {
            let most = self.abs();
            return Self { lower: 0.0, upper: most.power_of_bounds(n).upper };
        }
        let bounds = if n.is_multiple_of(2) { self.abs() } else { self };
        bounds.power_of_bounds(n)
    }

    /// The power of both bounds, on a range where it is increasing.
    fn power_of_bounds(self, n: u32) -> Self {
        let of =
            |bound: f64| (1..n).fold(Self::point(bound), |product, _| product * Self::point(bound));
        Self { lower: of(self.lower).lower, upper: of(self.upper).upper }
    }

    /// e^x.
    #[must_use]
    pub fn exp(self) -> Self {
        self.increasing(libm::exp).within(0.0, f64::INFINITY)
    }

    /// log x; `None` if the interval contains numbers that are not positive.
    pub fn log(self) -> Option<Self> {
        (self.lower > 0.0).then(|| self.increasing(libm::log))
    }

    /// √x; `None` if the interval contains negative numbers.
    pub fn sqrt(self) -> Option<Self> {
        (self.lower >= 0.0)
            .then(|| Self::outward(self.lower.sqrt(), self.upper.sqrt()).within(0.0, f64::INFINITY))
    }

    /// sin x.
    #[must_use]
    pub fn sin(self) -> Self {
        // Maxima at π/2 + 2πn, minima at −π/2 + 2πn; their positions are known to a few rounding errors.
        let meets = |extremum: f64| {
            let cycles = |x: f64| (x - extremum) / TAU;
            let (from, to) = (cycles(self.lower), cycles(self.upper));
            let rounding = 8.0 * f64::EPSILON * (1.0 + from.abs().max(to.abs()));
            (from - rounding).ceil() <= (to + rounding).floor()
        };
        if !(self.is_bounded() && self.upper - self.lower < TAU) {
            return Self::new(-1.0, 1.0);
        }
        let ends = Self::point(libm::sin(self.lower)).hull(Self::point(libm::sin(self.upper)));
        let wide = Self::outward(ends.lower, ends.upper);
        let wide = Self::outward(wide.lower, wide.upper);
        Self {
            lower: if meets(-0.25 * TAU) { -1.0 } else { wide.lower },
            upper: if meets(0.25 * TAU) { 1.0 } else { wide.upper },
        }
        .within(-1.0, 1.0)
    }

    /// cos x.
    #[must_use]
    pub fn cos(self) -> Self {
        // The shift is rounded once; the bounds of the sum include this error.
        (self + Self::outward(0.25 * TAU, 0.25 * TAU)).sin()
    }

    /// tanh x.
    #[must_use]
    pub fn tanh(self) -> Self {
        self.increasing(libm::tanh).within(-1.0, 1.0)
    }

    /// 1/cosh x.
    #[must_use]
    pub fn sech(self) -> Self {
        let size = self.abs();
        let falling = |x: f64| 1.0 / libm::cosh(x);
        let wide = Self::outward(falling(size.upper), falling(size.lower));
        let wide = Self::outward(wide.lower, wide.upper);
        Self::outward(wide.lower, wide.upper).within(0.0, 1.0)
    }

    /// atan x.
    #[must_use]
    pub fn atan(self) -> Self {
        self.increasing(libm::atan)
    }
}

impl Neg for RealInterval {
    type Output = Self;

    fn neg(self) -> Self {
        Self { lower: -self.upper, upper: -self.lower }
    }
}

impl Add for RealInterval {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::outward(self.lower + other.lower, self.upper + other.upper)
    }
}

impl Sub for RealInterval {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for RealInterval {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        // The numbers inside are finite: zero times an unbounded interval is zero.
        let product = |a: f64, b: f64| if a == 0.0 || b == 0.0 { 0.0 } else { a * b };
        let corners = [
            product(self.lower, other.lower),
            product(self.lower, other.upper),
            product(self.upper, other.lower),
            product(self.upper, other.upper),
        ];
        let lower = corners.into_iter().fold(f64::INFINITY, f64::min);
        let upper = corners.into_iter().fold(f64::NEG_INFINITY, f64::max);
        // A product with exactly zero is exact.
        let zero = |x: Self| x.lower == 0.0 && x.upper == 0.0;
        if zero(self) || zero(other) {
            return Self::point(0.0);
        }
        let wide = Self::outward(lower, upper);
        if (self.lower >= 0.0 && other.lower >= 0.0) || (self.upper <= 0.0 && other.upper <= 0.0) {
            return wide.within(0.0, f64::INFINITY);
        }
        wide
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The interval contains all values of a function at points of its argument, and is not much wider than needed.
    #[test]
    fn images_are_tight_enclosures() {
        type Image = fn(RealInterval) -> RealInterval;
        type Function = fn(f64) -> f64;
        let functions: [(&str, Image, Function); 8] = [
            ("exp", RealInterval::exp, f64::exp),
            ("sin", RealInterval::sin, f64::sin),
            ("cos", RealInterval::cos, f64::cos),
            ("tanh", RealInterval::tanh, f64::tanh),
            ("sech", RealInterval::sech, |x| 1.0 / x.cosh()),
            ("atan", RealInterval::atan, f64::atan),
            ("abs", RealInterval::abs, f64::abs),
            ("fourth power", |x| x.power(4), |x| x.powi(4)),
        ];
        for (name, image, function) in functions {
            for (from, to) in [(-3.0, 0.5), (0.1, 0.1), (1.5, 1.7), (-0.2, 7.1), (4.0, 5.0)] {
                let found = image(RealInterval::new(from, to));
                let values: Vec<f64> = (0..=2000)
                    .map(|k| function(from + (to - from) * f64::from(k) / 2000.0))
                    .collect();
                let low = values.iter().copied().fold(f64::INFINITY, f64::min);
                let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                assert!(found.lower <= low && high <= found.upper, "{name} on [{from}, {to}]");
                // The minimum of |x| lies between two of the points.
                let slack = 1e-5 * (high.abs() + low.abs()) + (to - from) / 2000.0;
                assert!(
                    low - found.lower < slack && found.upper - high < slack,
                    "{name}: {found:?}"
                );
            }
        }
    }

    #[test]
    fn undefined_operations_return_none() {
        let around = RealInterval::new(-1e-9, 1e-9);
        assert!(RealInterval::point(1.0).over(around).is_none());
        assert!(around.log().is_none() && around.sqrt().is_none());
        assert!(RealInterval::point(0.0).over(RealInterval::point(0.0)).is_none());
    }

    #[test]
    fn unbounded_intervals_contain_only_finite_numbers() {
        let large = RealInterval::new(800.0, 900.0).exp();
        assert!(large.lower > 0.0 && large.lower.is_finite() && large.upper.is_infinite());
        assert_eq!(RealInterval::point(0.0) * RealInterval::WHOLE, RealInterval::point(0.0));
        let small = RealInterval::point(1.0)
            .over(RealInterval::new(1e300, f64::INFINITY))
            .expect("above 0");
        assert!(small.lower == 0.0 && small.upper < 1e-299);
    }
}
