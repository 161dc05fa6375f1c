//! Stick: x = x₀ + v₀(τ − τ₀), and the first moment at which stiction is lost.
//!
//! The friction force required is f_s = 2ζv₀ + x − Σ D_T g_T; the contact sticks while |f_s| ≤ μ_s N(τ).
//! The two margins ±f_s − μ_s N are analytic between breaks of the dither.

use quell_numerics::polynomial::{
    derivative, first_crossing, first_crossing_after, step_length, value,
};

use super::clock::Clock;
use super::forcing::Forcing;
use super::taylor::{ORDER, Series};

/// Constants of the sticking contact, in units of the law's velocity scale.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stiction {
    /// 2ζν, the damper's part of f_s.
    pub(super) damper: f64,
    /// ν = v₀/v_m.
    pub(super) belt_velocity: f64,
    /// μ_s.
    pub(super) static_coefficient: f64,
}

/// The result of a search over an interval of stick.
#[derive(Clone, Copy, Debug)]
pub(super) enum StickSearch {
    /// The contact sticks for at least this long.
    Holds(f64),
    /// The contact releases.
    Releases {
        /// Time until the release.
        after: f64,
        /// Slip direction, the sign of f_s.
        sign: f64,
        /// Rate of |f_s| − μ_s N at the release.
        rate: f64,
        /// Whether the threshold was already exceeded at the start of the interval.
        at_once: bool,
    },
}

impl Stiction {
    /// f_s at displacement `y`.
    #[inline(always)]
    pub(super) fn force(&self, y: f64, tangential: f64) -> f64 {
        self.damper + y - tangential
    }

    /// Time for which dither of any phase cannot release the contact; not positive if unknown.
    ///
    /// |f_s| ≤ |2ζv₀ + x| + ΣD_T and N ≥ F − ΣD_N. f_s rises with x, so that a lower
    /// side that is safe stays safe.
    #[inline(always)]
    pub(super) fn guaranteed_stick(&self, y: f64, tangential: &Forcing, normal: &Forcing) -> f64 {
        let capacity = self.static_coefficient * (normal.mean() - normal.amplitude());
        let reserve = capacity - tangential.amplitude();
        let force = self.damper + y;
        if -force >= reserve {
            return 0.0;
        }
        if force >= reserve {
            return 0.0;
        }
        // Shortened by some units in the last place, to be safe.
        (reserve - force) * (1.0 - 1e-12) / self.belt_velocity
    }

    /// The first release within `room`, on one Taylor series.
    #[inline(always)]
    pub(super) fn search(
        &self,
        clock: Clock,
        y: f64,
        room: f64,
        tolerance: f64,
        tangential: &Forcing,
        normal: &Forcing,
    ) -> StickSearch {
        let dither = tangential.series(clock);
        let mut force = [0.0; ORDER + 1];
        force[0] = self.force(y, dither[0]);
        force[1] = self.belt_velocity - dither[1];
        for k in 2..=ORDER {
            force[k] = -dither[k];
        }
        let mut limit = [0.0; ORDER + 1];
        limit[0] = self.static_coefficient * normal.mean();
        if !normal.is_constant() {
            let load = normal.series(clock);
            for k in 0..=ORDER {
                limit[k] = self.static_coefficient * load[k];
            }
        }
        let last = force[ORDER].abs() + limit[ORDER].abs();
        let previous = force[ORDER - 1].abs() + limit[ORDER - 1].abs();
        let length = step_length(tolerance, last, previous, ORDER).min(room);
        // |f_s| < μ_s N on the whole interval, or at least −f_s < μ_s N, by the sizes of the coefficients.
        let change = largest_change(&force, &limit, length);
        if force[0].abs() + change < limit[0] {
            return StickSearch::Holds(length);
        }
        let falls = -force[0] + change >= limit[0];
        let margin = |sign: f64| {
            let mut margin = [0.0; ORDER + 1];
            for k in 0..=ORDER {
                margin[k] = f64::mul_add(sign, force[k], -limit[k]);
            }
            margin
        };
        let (rise, fall) = (margin(1.0), margin(-1.0));
        let down = if falls { release_on(&fall, length) } else { None };
        let (sign, margin, after) = match (release_on(&rise, length), down) {
            (None, None) => return StickSearch::Holds(length),
            (Some(up), None) => (1.0, &rise, up),
            (Some(up), Some(down)) if up <= down => (1.0, &rise, up),
            (_, Some(down)) => (-1.0, &fall, down),
        };
        let (after, rate) = self.polish(sign, margin, after, length, clock, y, tangential, normal);
        StickSearch::Releases { after, sign, rate, at_once: margin[0] > 0.0 }
    }

    /// One Newton step on the closed form, which the series approximates to the tolerance only.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "one caller; the closed form needs them all")]
    fn polish(
        &self,
        sign: f64,
        margin: &Series,
        after: f64,
        length: f64,
        clock: Clock,
        y: f64,
        tangential: &Forcing,
        normal: &Forcing,
    ) -> (f64, f64) {
        let rate = slope(margin, after);
        if after == 0.0 || rate <= 0.0 {
            return (after, rate);
        }
        let moment = clock.after(after);
        let there = f64::mul_add(self.belt_velocity, after, y);
        let exact = sign * self.force(there, tangential.value(moment))
            - self.static_coefficient * normal.value(moment);
        let correction = -exact / rate;
        let polished = after + correction;
        // A correction beyond the series' own error means nearly tangential grazing: keep the root.
        if correction.abs() < 1e-4 * length && polished > 0.0 && polished <= length {
            (polished, slope(margin, polished))
        } else {
            (after, rate)
        }
    }
}

/// First moment at which a margin (negative during stick) becomes positive.
#[inline(always)]
fn release_on(margin: &Series, length: f64) -> Option<f64> {
    if margin[0] > 0.0 {
        return Some(0.0);
    }
    if margin[0] == 0.0 {
        // On the threshold: released now if the margin grows, otherwise the root is divided out.
        let mut next = 1;
        while next <= ORDER && margin[next] == 0.0 {
            next += 1;
        }
        return match margin.get(next) {
            Some(&first) if first > 0.0 => Some(0.0),
            Some(_) => first_crossing_after(margin, next, length),
            None => None,
        };
    }
    first_crossing(margin, length)
}

/// Upper bound on the decrease of μ_s N ∓ f_s on [0, h], by the sizes of the coefficients alone.
#[inline(always)]
fn largest_change(force: &Series, limit: &Series, h: f64) -> f64 {
    let mut sizes = [0.0; ORDER + 1];
    for k in 1..=ORDER {
        sizes[k] = force[k].abs() + limit[k].abs();
    }
    value(&sizes, h)
}

/// Derivative of Σ cₖtᵏ.
#[inline(always)]
fn slope(c: &Series, t: f64) -> f64 {
    value(&derivative(c), t)
}
