//! The guards of a step: the polynomials whose first root ends it.

use quell_numerics::dispatch::{Work, with_fused_multiply_add};
use quell_numerics::lane::{horner, partial_product};
use quell_numerics::polynomial::{derivative, first_crossing_after, value};

use super::contact_equation::ContactEquation;
use super::contact_series::{ContactSeries, SeriesOf};
use super::equations::MotionEquations;
use super::few::Few;
use super::observer::Trigger;
use super::own_friction::own_speed;
use super::own_state::{OwnState, OwnStateKind};
use super::phase::{ContactNow, ContactPhase, ElasticNow, OwnNow};
use super::selection::ZERO_ACCELERATION;
use crate::simulation::{ORDER, Series};

/// Guards that reach zero within this share of the time scale after the first one are simultaneous: their order is below the
/// accuracy of a step.
const TOGETHER: f64 = 1e-12;

/// Share of its bound by which the force of a contact that is held in stick may exceed it: above it a release has a slip acceleration
/// that is not zero to rounding, and its direction is certain. A mass that comes to rest at the very edge of stick stays there,
/// and one that leaves it does so later by the time that this share of the force takes.
const HELD_BEYOND: f64 = 4.0 * ZERO_ACCELERATION;

/// Share of the sliding level by which T of an elastic slider rises in a jump of its load: less is the rounding of a step.
const JUMPED_UP: f64 = 1e-9;

/// A guard, of the given sign until its event.
#[derive(Clone, Copy, Debug)]
struct Guard<'a> {
    what: Trigger,
    series: &'a Series,
    sign: f64,
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
    pub(super) now: &'a [ContactNow],
    pub(super) contacts: &'a [ContactSeries],
}

/// Most guards of one contact: the load, and the margins on both sides or at both bounds.
const GUARDS: usize = 3;

impl<'a> Guards<'a> {
    /// The first guard that reaches zero within `length`.
    #[inline(always)]
    pub(super) fn first(&self, length: f64) -> Option<GuardReached> {
        self.first_among(|_| true, length)
    }

    /// The same among contacts that may have one: of the others it is proven that they have none.
    #[inline(always)]
    pub(super) fn first_among(
        &self,
        may: impl Fn(usize) -> bool,
        mut length: f64,
    ) -> Option<GuardReached> {
        let mut first: Option<GuardReached> = None;
        let mut margin = [0.0; ORDER + 1];
        for contact in 0..self.now.len() {
            if !may(contact) {
                continue;
            }
            for place in 0..GUARDS {
                let Some(guard) = self.at(contact, place, &mut margin) else { continue };
                let Some(after) = guard.root(length) else { continue };
                if first.is_none_or(|known| after < known.after) {
                    let rate = guard.rate(after);
                    first = Some(GuardReached { what: guard.what, after, rate });
                }
                length = after.max(f64::MIN_POSITIVE);
            }
        }
        first
    }

    /// A guard of a contact: its load, then its slip velocity or its margins, which are written to `margin`.
    #[inline(always)]
    fn at<'m>(&self, contact: usize, place: usize, margin: &'m mut Series) -> Option<Guard<'m>>
    where
        'a: 'm,
    {
        let (now, series) = (&self.now[contact], &self.contacts[contact]);
        if now.kept {
            return None;
        }
        let equation = &self.equations.contacts[contact];
        if place > 0
            && let OwnNow::Elastic(elastic) = now.own
        {
            return self.elastic(contact, place, elastic, margin);
        }
        match (place, now.phase) {
            (0, _) if series.load_varies => {
                let (what, sign) = (Trigger::Load(contact), if now.is_open() { -1.0 } else { 1.0 });
                Some(Guard { what, series: &series.load, sign, zeros: now.load_zeros })
            }
            (1, ContactPhase::Slip(sign)) if equation.can_stick() || !now.is_rigid() => {
                let (what, sign) = (Trigger::Slip(contact), f64::from(sign));
                Some(Guard { what, series: &series.slip, sign, zeros: now.slip_zeros })
            }
            (1 | 2, ContactPhase::Stick) if now.saturated == 0 => {
                let side = if place == 1 { 1 } else { -1 };
                let level = equation.static_coefficient;
                *margin = margin_above(level, f64::from(side), series);
                if now.held && margin[0] <= 0.0 {
                    margin[0] =
                        f64::mul_add(HELD_BEYOND * level, series.pressed[0].abs(), margin[0]);
                }
                Some(Guard {
                    what: Trigger::Margin(contact, side),
                    series: margin,
                    sign: 1.0,
                    zeros: 0,
                })
            }
            _ => None,
        }
    }

    /// A guard of an elastic slider: its margins while it adheres, its own speed and γ while it slides.
    fn elastic<'m>(
        &self,
        contact: usize,
        place: usize,
        elastic: ElasticNow,
        margin: &'m mut Series,
    ) -> Option<Guard<'m>>
    where
        'a: 'm,
    {
        let (equation, series) = (&self.equations.contacts[contact], &self.contacts[contact]);
        match self.now[contact].phase {
            ContactPhase::Stick if elastic.beyond != 0 => {
                Some(beyond_static_bound(equation, (contact, place), elastic, series, margin))
            }
            ContactPhase::Stick => {
                let side = if place == 1 { 1 } else { -1 };
                *margin = margin_above(equation.static_coefficient, f64::from(side), series);
                let zeros = elastic.margin_zeros[place - 1];
                Some(Guard {
                    what: Trigger::Margin(contact, side),
                    series: margin,
                    sign: 1.0,
                    zeros,
                })
            }
            ContactPhase::Slip(direction) if place == 1 => {
                let Some(OwnState { kind: OwnStateKind::Elastic { stiffness }, .. }) = equation.own
                else {
                    return None;
                };
                own_speed(series, stiffness, margin);
                let sign = f64::from(direction);
                let mut zeros = elastic.speed_zeros;
                if carried_through_jump(&self.now[contact], series).is_some() {
                    // Its load has jumped: T cannot follow, and it adheres at once.
                    (margin[0], zeros) = (-sign, 0);
                }
                Some(Guard { what: Trigger::Slip(contact), series: margin, sign, zeros })
            }
            ContactPhase::Slip(_) => {
                let (what, sign) = (Trigger::Turn(contact), f64::from(elastic.branch));
                Some(Guard {
                    what,
                    series: &series.slip,
                    sign,
                    zeros: self.now[contact].slip_zeros,
                })
            }
            ContactPhase::Open => None,
        }
    }

    /// Every guard that reaches zero together with the first one, at time `after` of the step.
    pub(super) fn together(&self, first: &GuardReached, time_scale: f64) -> Few<GuardReached> {
        with_fused_multiply_add(SameMoment { guards: self, first, time_scale })
    }

    #[inline(always)]
    fn together_with(&self, first: &GuardReached, time_scale: f64) -> Few<GuardReached> {
        let mut found = Few::new();
        let mut margin = [0.0; ORDER + 1];
        for contact in 0..self.now.len() {
            for place in 0..GUARDS {
                let Some(guard) = self.at(contact, place, &mut margin) else { continue };
                if guard.what == first.what {
                    found.push(*first);
                    continue;
                }
                let (height, rate) = (guard.height(first.after), guard.rate(first.after));
                let is_reached =
                    height <= 0.0 || rate > 0.0 && height <= rate * TOGETHER * time_scale;
                if is_reached {
                    found.push(GuardReached { what: guard.what, after: first.after, rate });
                }
            }
        }
        found
    }
}

struct SameMoment<'g, 'a> {
    guards: &'g Guards<'a>,
    first: &'g GuardReached,
    time_scale: f64,
}

impl Work for SameMoment<'_, '_> {
    type Output = Few<GuardReached>;

    #[inline(always)]
    fn run(self) -> Few<GuardReached> {
        self.guards.together_with(self.first, self.time_scale)
    }
}

/// The guards of an elastic slider that adheres on one side beyond its static bound: T reaches the sliding level there, or returns to
/// the static bound.
fn beyond_static_bound<'m>(
    equation: &ContactEquation,
    (contact, place): (usize, usize),
    elastic: ElasticNow,
    series: &ContactSeries,
    margin: &'m mut Series,
) -> Guard<'m> {
    if place == 1 {
        *margin = level_margin(elastic, series);
        let mut zeros = elastic.margin_zeros[0];
        if f64::from(elastic.branch) * series.slip[0] < 0.0 {
            // The surface has reversed at once: the law goes on along its other branch.
            (margin[0], zeros) = (-1.0, 0);
        }
        let what = Trigger::Margin(contact, elastic.beyond);
        return Guard { what, series: margin, sign: 1.0, zeros };
    }
    *margin = margin_above(equation.static_coefficient, f64::from(elastic.beyond), series);
    let what = Trigger::Margin(contact, -elastic.beyond);
    Guard { what, series: margin, sign: -1.0, zeros: elastic.margin_zeros[1] }
}

/// T that an elastic slider carries through a jump of its load, which has raised its sliding level; `None` where it slides on.
pub(super) fn carried_through_jump(now: &ContactNow, series: &ContactSeries) -> Option<f64> {
    let (OwnNow::Elastic(elastic), ContactPhase::Slip(direction)) = (now.own, now.phase) else {
        return None;
    };
    let carried = series.own.as_ref().map_or(0.0, |own| own.carried);
    let rise = f64::from(direction) * (series.friction[0] - carried);
    let has_jumped = !elastic.is_released && rise > JUMPED_UP * series.friction[0].abs();
    has_jumped.then_some(carried)
}

/// The margin μ(|γ|)N ∓ T of an elastic slider that adheres beyond its static bound.
pub(super) fn level_margin(elastic: ElasticNow, series: &ContactSeries) -> Series {
    let (side, branch) = (f64::from(elastic.beyond), f64::from(elastic.branch));
    std::array::from_fn(|k| {
        let level = branch * partial_product(&series.coefficient, &series.pressed, k, 0, k);
        f64::mul_add(-side, series.friction[k], level)
    })
}

/// The margin μ_s N ∓ T of a sticking contact on one side.
#[inline(always)]
pub(super) fn margin_above(level: f64, side: f64, series: &ContactSeries) -> SeriesOf<f64> {
    let mut margin = [0.0; ORDER + 1];
    let sides = series.pressed.iter().zip(&series.friction);
    for (margin, (pressed, force)) in margin.iter_mut().zip(sides) {
        *margin = f64::mul_add(level, *pressed, -(side * *force));
    }
    margin
}

impl Guard<'_> {
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
        if self.sign * self.series[zeros] < 0.0 {
            return Some(0.0);
        }
        first_crossing_after(self.series, zeros, length)
    }

    /// Without the zero at its start.
    #[inline(always)]
    fn quotient(&self) -> Series {
        let mut quotient = [0.0; ORDER + 1];
        quotient[..=ORDER - self.zeros].copy_from_slice(&self.series[self.zeros..]);
        quotient
    }

    #[inline(always)]
    fn height(&self, after: f64) -> f64 {
        self.sign
            * if self.zeros == 0 {
                horner(self.series, after)
            } else {
                horner(&self.quotient(), after)
            }
    }

    /// Rate at which it falls.
    #[inline(always)]
    fn rate(&self, after: f64) -> f64 {
        -self.sign * value(&derivative(self.series), after)
    }
}
