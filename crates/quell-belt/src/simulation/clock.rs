//! Time as an unevaluated sum of two doubles.
//!
//! A long run adds many short steps; the low part keeps what each addition rounds off, so
//! that phases and event times do not drift (a plain sum is off by 10⁻¹¹ at τ = 10⁵).

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

    /// The nearest double.
    #[inline(always)]
    pub fn time(self) -> f64 {
        self.time
    }

    /// What the nearest double leaves out.
    #[inline(always)]
    pub fn low(self) -> f64 {
        self.low
    }

    /// `step` later.
    #[inline(always)]
    #[must_use]
    pub fn after(self, step: f64) -> Self {
        let sum = self.time + step;
        let back = sum - self.time;
        let rest = (self.time - (sum - back)) + (step - back) + self.low;
        let time = sum + rest;
        Self { time, low: rest - (time - sum) }
    }

    /// How long until `target`; negative if it has passed.
    #[inline(always)]
    pub fn until(self, target: f64) -> f64 {
        (target - self.time) - self.low
    }
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
