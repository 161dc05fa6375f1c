//! Time as an unevaluated sum of two doubles.
//!
//! A long run adds many short steps. The low part keeps the rounding error of each addition, so
//! that phases and event times do not drift (a plain sum is off by 10⁻¹¹ at τ = 10⁵).

use quell_numerics::lane::Lane;

/// A moment τ = `time` + `low`, with |`low`| at most half a unit in the last place of `time`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clock {
    time: f64,
    low: f64,
}

impl Clock {
    /// Exactly `time`.
    #[inline(always)]
    pub fn at(time: f64) -> Self {
        Self { time, low: 0.0 }
    }

    /// τ rounded to the nearest double.
    #[inline(always)]
    pub fn time(self) -> f64 {
        self.time
    }

    /// The moment `time` + `low`, both taken from another clock.
    #[inline(always)]
    pub(super) fn of(time: f64, low: f64) -> Self {
        Self { time, low }
    }

    /// The rest that the nearest double leaves out.
    #[inline(always)]
    pub fn low(self) -> f64 {
        self.low
    }

    /// The moment `step` later.
    #[inline(always)]
    #[must_use]
    pub fn after(self, step: f64) -> Self {
        let (time, low) = after(self.time, self.low, step);
        Self { time, low }
    }

    /// The time until `target`; negative if `target` has passed.
    #[inline(always)]
    pub fn until(self, target: f64) -> f64 {
        until(self.time, self.low, target)
    }
}

/// [`Clock::after`] in every lane: the sum is rounded once, and its rounding error is added to the low part.
#[inline(always)]
pub(super) fn after<V: Lane>(time: V, low: V, step: V) -> (V, V) {
    let sum = time + step;
    let back = sum - time;
    let rest = (time - (sum - back)) + (step - back) + low;
    let later = sum + rest;
    (later, rest - (later - sum))
}

/// [`Clock::until`] in every lane.
#[inline(always)]
pub(super) fn until<V: Lane>(time: V, low: V, target: V) -> V {
    (target - time) - low
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_million_tenths_lose_nothing() {
        let mut clock = Clock::at(0.0);
        for _ in 0..1_000_000 {
            clock = clock.after(0.1);
        }
        // 0.1 in binary is 0.1 + 5.551115123125783e-18.
        let exact_low = 1e6 * 5.551_115_123_125_783e-18;
        assert_eq!(clock.time(), 1e5);
        assert!((clock.low() - exact_low).abs() < 1e-20);
    }
}
