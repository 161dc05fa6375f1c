//! Two numbers side by side: the smallest lane type, to see that a recurrence is the same in
//! every lane as alone.

use std::ops::{Add, Mul, Neg, Sub};

use quell_numerics::lane::Lane;

/// Two independent numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pair(pub(crate) f64, pub(crate) f64);

impl Add for Pair {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0, self.1 + other.1)
    }
}

impl Sub for Pair {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0, self.1 - other.1)
    }
}

impl Mul for Pair {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0, self.1 * other.1)
    }
}

impl Neg for Pair {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0, -self.1)
    }
}

impl Lane for Pair {
    fn splat(value: f64) -> Self {
        Self(value, value)
    }

    fn mul_add(self, factor: Self, addend: Self) -> Self {
        Self(self.0.mul_add(factor.0, addend.0), self.1.mul_add(factor.1, addend.1))
    }

    fn abs(self) -> Self {
        Self(self.0.abs(), self.1.abs())
    }

    fn max(self, other: Self) -> Self {
        Self(Lane::max(self.0, other.0), Lane::max(self.1, other.1))
    }

    fn power_of_two(self) -> Self {
        Self(self.0.power_of_two(), self.1.power_of_two())
    }
}
