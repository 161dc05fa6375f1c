//! The guards of a step: the polynomials whose first root ends it.

use quell_numerics::dispatch::Work;
use quell_numerics::lane::horner;
use quell_numerics::polynomial::{derivative, first_crossing_after, value};

use super::contact_series::ContactSeries;
use super::equations::{Forcings, MotionEquations};
use super::observer::Trigger;
use super::phase::{ContactNow, ContactPhase};
use crate::simulation::{ORDER, Series};

/// Guards that reach zero within this share of the time scale after the first one are simultaneous: their order is below the
/// accuracy of a step.
const TOGETHER: f64 = 1e-12;

/// A guard, positive until its event.
#[derive(Clone, Copy, Debug)]
pub(super) struct Guard {
    pub(super) what: Trigger,
    series: Series,
    /// Multiplicity of its zero at the start, which is divided out.
    zeros: usize,
}

/// A guard that has reached zero.
#[derive(Clone, Copy, Debug)]
pub(super) struct GuardReached {
    pub(super) what: Trigger,
    /// Time after the start of the step.
    pub(super) after: f64,
    /// Rate at which it falls there.
    pub(super) rate: f64,
}

/// The guards of a step.
pub(super) struct Guards<'a> {
    pub(super) equations: &'a MotionEquations,
    pub(super) forcings: &'a Forcings,
    pub(super) now: &'a [ContactNow],
    pub(super) contacts: &'a [ContactSeries],
}

/// The search for the first root of all guards.
pub(super) struct FirstGuard<'a> {
    pub(super) guards: Guards<'a>,
    pub(super) length: f64,
}

impl Work for FirstGuard<'_> {
    type Output = Option<GuardReached>;

    #[inline(always)]
    fn run(self) -> Option<GuardReached> {
        let mut length = self.length;
        let mut first = None;
        for contact in 0..self.guards.now.len() {
            self.guards.of(contact, |guard| {
                if let Some(after) = guard.root(length) {
                    let rate = guard.rate(after);
                    if first.is_none_or(|known: GuardReached| after < known.after) {
                        first = Some(GuardReached { what: guard.what, after, rate });
                    }
                    length = after.max(f64::MIN_POSITIVE);
                }
            });
        }
        first
    }
}

impl Guards<'_> {
    /// Passes every guard of a contact to `visit`.
    #[inline(always)]
    fn of(&self, contact: usize, mut visit: impl FnMut(&Guard)) {
        let (now, series) = (&self.now[contact], &self.contacts[contact]);
        let equation = &self.equations.contacts[contact];
        let forcing = &self.forcings.contacts[contact];
        if equation.is_compliant() || !forcing.load.is_constant() {
            let sign = if now.is_open() { -1.0 } else { 1.0 };
            let guard = signed(Trigger::Load(contact), &series.load, sign, now.load_zeros);
            visit(&guard);
        }
        match now.phase {
            ContactPhase::Slip(sign) if equation.can_stick() => {
                let what = Trigger::Slip(contact);
                visit(&signed(what, &series.slip, f64::from(sign), now.slip_zeros));
            }
            ContactPhase::Stick if now.saturated == 0 && !now.held => {
                for side in [1_i8, -1] {
                    let level = equation.static_coefficient;
                    let mut margin = series.pressed;
                    for (margin, force) in margin.iter_mut().zip(&series.friction) {
                        *margin = f64::mul_add(level, *margin, -f64::from(side) * force);
                    }
                    let what = Trigger::Margin(contact, side);
                    visit(&Guard { what, series: margin, zeros: 0 });
                }
            }
            _ => {}
        }
    }

    /// Every guard that reaches zero together with the first one, at time `after` of the step.
    pub(super) fn together(&self, first: &GuardReached, time_scale: f64) -> Vec<GuardReached> {
        let mut found = Vec::new();
        for contact in 0..self.now.len() {
            self.of(contact, |guard| {
                if guard.what == first.what {
                    found.push(*first);
                    return;
                }
                let (height, rate) = (guard.height(first.after), guard.rate(first.after));
                let is_reached =
                    height <= 0.0 || rate > 0.0 && height <= rate * TOGETHER * time_scale;
                if is_reached {
                    found.push(GuardReached { what: guard.what, after: first.after, rate });
                }
            });
        }
        found
    }
}

#[inline(always)]
fn signed(what: Trigger, series: &Series, sign: f64, zeros: usize) -> Guard {
    Guard { what, series: series.map(|coefficient| sign * coefficient), zeros }
}

impl Guard {
    /// First root within `length`.
    #[inline(always)]
    fn root(&self, length: f64) -> Option<f64> {
        let mut zeros = self.zeros;
        while zeros <= ORDER && self.series[zeros] == 0.0 {
            zeros += 1;
        }
        if zeros > ORDER {
            return None;
        }
        if self.series[zeros] < 0.0 {
            return Some(0.0);
        }
        first_crossing_after(&self.series, zeros, length)
    }

    /// Without the zero at its start.
    fn quotient(&self) -> Series {
        let mut quotient = [0.0; ORDER + 1];
        quotient[..=ORDER - self.zeros].copy_from_slice(&self.series[self.zeros..]);
        quotient
    }

    fn height(&self, after: f64) -> f64 {
        if self.zeros == 0 { horner(&self.series, after) } else { horner(&self.quotient(), after) }
    }

    /// Rate at which it falls.
    #[inline(always)]
    fn rate(&self, after: f64) -> f64 {
        -value(&derivative(&self.series), after)
    }
}
