//! The series of a step in vectors, order by order, and its length.

use quell_model::friction::{BranchSeries, ConstantsVisitor, LawSeries};
use quell_numerics::for_each_order_below_16;
use quell_numerics::lane::Lane;
use quell_numerics::polynomial::side_by_side::proof_of_no_root;
use quell_numerics::polynomial::step_length;

use super::contact_series::SeriesOf;
use super::phase::{ContactNow, ContactPhase};
use super::plain_equations::{MOST, PlainEquations};
use super::step_recurrence::{StepLimit, with_scale};
use super::stuck::StuckForces;
use crate::simulation::{ORDER, RECIPROCALS};

/// Most roots of a slip velocity at the start of a step.
const MOST_ZEROS: usize = 2;

/// Coefficients of one order more than a series keeps: of the state, from its rates.
pub(super) type RatedSeries<V> = [V; ORDER + 2];

/// 1 where a condition holds.
#[inline(always)]
fn mask(holds: [bool; MOST]) -> [f64; MOST] {
    holds.map(|holds| f64::from(u8::from(holds)))
}

/// What the contacts do during a step.
#[expect(
    clippy::struct_excessive_bools,
    reason = "each says of all contacts whether any needs some work"
)]
pub(super) struct PlainPhases<V> {
    /// Whether they are those of the coming step.
    pub(super) are_known: bool,
    /// Whether a slip velocity is zero at the start.
    pub(super) any_zeros: bool,
    /// Whether vectors follow: no contact keeps its phase beyond a border or stands at its bound.
    pub(super) is_plain: bool,
    pub(super) slips: [bool; MOST],
    pub(super) any_slips: bool,
    pub(super) any_sticks: bool,
    /// 1 where the contact slips, and where it sticks.
    pub(super) slipping: V,
    pub(super) sticking: V,
    /// ±1; 1 in stick.
    pub(super) sign: V,
    /// Multiplicity of the zero of γ at the start.
    pub(super) zeros: V,
}

/// The forces of sticking contacts.
pub(super) struct PlainHolding<V> {
    /// Of which [`MotionRun::refreshed`].
    pub(super) refreshed: u64,
    /// T of all contacts per γ̇ of one of them: zeros where its condition is not used.
    pub(super) gains: [V; MOST],
}

/// Coefficients of the first force, which is zero where no force acts, and of the others.
pub(super) type PushSeries = (SeriesOf<f64>, Vec<SeriesOf<f64>>);

/// The series of a step.
pub(super) struct PlainSeries<V> {
    pub(super) displacements: RatedSeries<V>,
    pub(super) velocities: RatedSeries<V>,
    /// Zero in the last order, which no surface has.
    pub(super) surfaces: RatedSeries<V>,
    pub(super) slip: SeriesOf<V>,
    pub(super) scaled: SeriesOf<V>,
    pub(super) friction: SeriesOf<V>,
}

impl<V: Lane> PlainPhases<V> {
    pub(super) fn unknown() -> Self {
        let zero = V::splat(0.0);
        Self {
            are_known: false,
            any_zeros: false,
            is_plain: false,
            slips: [false; MOST],
            any_slips: false,
            any_sticks: false,
            slipping: zero,
            sticking: zero,
            sign: zero,
            zeros: zero,
        }
    }

    #[inline(always)]
    pub(super) fn set(&mut self, now: &[ContactNow]) {
        let mut sign = [1.0; MOST];
        let (mut zeros, mut sticks) = ([0.0; MOST], [false; MOST]);
        self.slips = [false; MOST];
        (self.are_known, self.any_zeros, self.is_plain) = (true, false, true);
        for (place, now) in now.iter().enumerate().take(MOST) {
            self.is_plain &= !now.kept && now.saturated == 0;
            zeros[place] = now.slip_zeros as f64;
            self.any_zeros |= now.slip_zeros > 0;
            match now.phase {
                ContactPhase::Slip(direction) => {
                    self.slips[place] = true;
                    sign[place] = f64::from(direction);
                }
                ContactPhase::Stick => sticks[place] = true,
                ContactPhase::Open => self.is_plain = false,
            }
        }
        self.any_slips = self.slips.contains(&true);
        self.any_sticks = sticks.contains(&true);
        self.slipping = V::load(&mask(self.slips));
        self.sticking = V::load(&mask(sticks));
        (self.sign, self.zeros) = (V::load(&sign), V::load(&zeros));
    }
}

impl<V: Lane> PlainHolding<V> {
    pub(super) fn none() -> Self {
        Self { refreshed: 0, gains: [V::splat(0.0); MOST] }
    }

    pub(super) fn set(&mut self, refreshed: u64, stuck: &StuckForces) {
        let mut gains = [[0.0; MOST]; MOST];
        for (held, shares) in stuck.gains() {
            for (other, gain) in shares {
                gains[other][held] = gain;
            }
        }
        *self = Self { refreshed, gains: gains.map(|column| V::load(&column)) };
    }
}

/// Computes the series of a step, for laws of one recurrence.
pub(super) struct PlainStep<'s, V, const N: usize> {
    pub(super) equations: &'s PlainEquations,
    pub(super) phases: &'s PlainPhases<V>,
    pub(super) holding: &'s PlainHolding<V>,
    pub(super) pressed: V,
    pub(super) scales: &'s mut [V; 2],
    pub(super) pushes: &'s PushSeries,
    pub(super) series: &'s mut PlainSeries<V>,
    pub(super) limit: StepLimit,
}

impl<V: Lane, const N: usize> ConstantsVisitor<V> for PlainStep<'_, V, N> {
    /// The length of the step.
    type Output = f64;

    #[inline(always)]
    fn visit<L: LawSeries>(mut self, constants: &mut L::Constants<V>) -> f64 {
        let inverse_scale = V::load(&self.equations.inverse_scales);
        let mut branch = self.branch::<L>(constants, inverse_scale);
        let drag = branch.slope() * inverse_scale * self.pressed;
        self.order(0, &mut branch, drag, inverse_scale);
        if const { N == 2 } {
            const { assert!(ORDER == 16, "unrolled up to order 16") };
            for_each_order_below_16!(J, {
                const K: usize = J + 1;
                self.order(K, &mut branch, drag, inverse_scale);
            });
        } else {
            // In a third of the time to compile.
            for k in 1..=ORDER {
                self.order(k, &mut branch, drag, inverse_scale);
            }
        }
        self.length(&branch)
    }
}

#[expect(
    clippy::needless_range_loop,
    reason = "loops over indices are unrolled, with constant lanes; those over iterators are not"
)]
impl<V: Lane, const N: usize> PlainStep<'_, V, N> {
    /// Σ over the coordinates of a row of each contact times one vector.
    #[inline(always)]
    fn read(&self, vector: V) -> V {
        let tangents = &self.equations.tangents;
        let mut sum = V::load(&tangents[0]) * V::splat(vector.lane(0));
        for j in 1..N {
            sum = V::load(&tangents[j]).mul_add(V::splat(vector.lane(j)), sum);
        }
        sum
    }

    /// The laws' recurrence at the start of the step.
    #[inline(always)]
    fn branch<'c, L: LawSeries>(
        &self,
        constants: &'c mut L::Constants<V>,
        inverse_scale: V,
    ) -> L::Series<'c, V, { ORDER + 1 }> {
        let slip = self.series.surfaces[0] - self.read(self.series.velocities[0]);
        let rests = self.phases.sticking.max(self.phases.zeros);
        let slip = rests.where_positive(V::splat(0.0), slip);
        L::series(constants, self.phases.sign, slip * inverse_scale)
    }

    /// One order: forces from the state, then the next order of the state.
    #[inline(always)]
    fn order(&mut self, k: usize, branch: &mut impl BranchSeries<V>, drag: V, inverse_scale: V) {
        let zero = V::splat(0.0);
        let phases = self.phases;
        let velocity = self.series.velocities[k];
        let mut rates = self.free_rates(k);
        let slip = self.series.surfaces[k] - self.read(velocity);
        let mut rests = phases.sticking;
        if k < MOST_ZEROS {
            rests = rests.max(phases.zeros - V::splat(k as f64));
        }
        let slip = rests.where_positive(zero, slip);
        let scaled = slip * inverse_scale;
        self.series.slip[k] = slip;
        self.series.scaled[k] = scaled;
        let mut friction = zero;
        if phases.any_slips {
            let force = if k == 0 {
                branch.first() * self.pressed
            } else {
                // The newest coefficient of γ waits for one operation only.
                drag.mul_add(slip, branch.lower(k, &self.series.scaled) * self.pressed)
            };
            friction = phases.slipping.where_positive(force, zero);
            rates = self.acted(rates, friction);
        }
        if phases.any_sticks {
            let force = self.held(k, rates);
            rates = self.acted(rates, force);
            friction = phases.sticking.where_positive(force, friction);
        }
        self.series.friction[k] = friction;
        let inverse = V::splat(RECIPROCALS[k + 1]);
        self.series.displacements[k + 1] = velocity * inverse;
        self.series.velocities[k + 1] = rates * inverse;
    }

    /// ẍ of order k without friction.
    #[inline(always)]
    fn free_rates(&self, k: usize) -> V {
        let PlainEquations { columns, constant, pushes, .. } = self.equations;
        let mut rates = V::splat(0.0);
        let (displacement, velocity) = (self.series.displacements[k], self.series.velocities[k]);
        for j in 0..N {
            rates = V::load(&columns[j]).mul_add(V::splat(displacement.lane(j)), rates);
        }
        for j in 0..N {
            rates = V::load(&columns[MOST + j]).mul_add(V::splat(velocity.lane(j)), rates);
        }
        if k == 0 {
            rates = rates + V::load(constant);
        }
        let (first, others) = pushes;
        rates = V::load(first).mul_add(V::splat(self.pushes.0[k]), rates);
        for (push, series) in others.iter().zip(&self.pushes.1) {
            rates = V::load(push).mul_add(V::splat(series[k]), rates);
        }
        rates
    }

    /// Rates with the friction of the contacts, one after the other.
    #[inline(always)]
    fn acted(&self, mut rates: V, friction: V) -> V {
        for place in 0..N {
            let along = V::load(&self.equations.along[place]);
            rates = along.mul_add(V::splat(friction.lane(place)), rates);
        }
        rates
    }

    /// The forces of order k that hold the sticking contacts, 0 of the others.
    #[inline(always)]
    fn held(&self, k: usize, rates: V) -> V {
        let along = self.read(rates);
        let lost = V::splat((k + 1) as f64).mul_add(self.series.surfaces[k + 1], -along);
        let mut force = V::splat(0.0);
        for place in 0..N {
            force = self.holding.gains[place].mul_add(V::splat(lost.lane(place)), force);
        }
        force
    }

    /// Length over which the last retained terms stay below the tolerance.
    #[inline(always)]
    fn length(&mut self, branch: &impl BranchSeries<V>) -> f64 {
        let zero = V::splat(0.0);
        let (mut last, mut previous) = (zero, zero);
        let PlainSeries { displacements, velocities, friction, scaled, .. } = &*self.series;
        for (states, kept) in [displacements, velocities].into_iter().zip(self.scales.iter_mut()) {
            let inverse = with_scale(kept, V::splat(self.limit.time_scale), |k| states[k].abs());
            last = (states[ORDER].abs() * inverse).max(last);
            previous = (states[ORDER - 1].abs() * inverse).max(previous);
        }
        if self.phases.any_sticks {
            let level = V::load(&self.equations.static_coefficients);
            let pressed = level * self.pressed.abs();
            let scale = pressed.max(level * V::load(&self.equations.normal_loads));
            let share = |term: V| {
                let share = |term, scale| if scale > 0.0 { term / scale } else { 0.0 };
                self.phases.sticking.where_positive(term.abs().zip(scale, share), zero)
            };
            last = share(friction[ORDER]).max(last);
            previous = share(friction[ORDER - 1]).max(previous);
        }
        let StepLimit { tolerance, longest, room, .. } = self.limit;
        let length = step_length(tolerance, largest(last), largest(previous), ORDER);
        let mut length = Lane::min(Lane::min(length, longest), room);
        for (place, slips) in self.phases.slips.into_iter().enumerate() {
            if slips {
                length = branch.trusted(scaled, V::splat(length)).lane(place);
            }
        }
        length
    }
}

/// The largest of four numbers.
#[inline(always)]
fn largest<V: Lane>(numbers: V) -> f64 {
    let first = Lane::max(numbers.lane(0), numbers.lane(1));
    Lane::max(first, Lane::max(numbers.lane(2), numbers.lane(3)))
}

impl<V: Lane> PlainSeries<V> {
    /// Whether no guard is found that reaches zero within `length`, without halving the step.
    #[inline(always)]
    pub(super) fn is_clear(
        &self,
        equations: &PlainEquations,
        phases: &PlainPhases<V>,
        pressed: V,
        length: f64,
    ) -> bool {
        let (zero, one, length) = (V::splat(0.0), V::splat(1.0), V::splat(length));
        let (slipping, sticking) = (phases.slipping, phases.sticking);
        if !phases.any_sticks {
            let proof = proof_of_no_root(&self.slip, phases.zeros, phases.sign, length, slipping);
            return !slipping.where_positive(-proof, zero).any_positive();
        }
        // Of a contact that sticks the margin above its bounds stands in the place of γ: at the upper one first, then at the lower one.
        let level = V::load(&equations.static_coefficients);
        let mut clear = one;
        for (side, wanted) in [(one, slipping.max(sticking)), (-one, sticking)] {
            let mut guards = self.slip;
            for (k, (guard, friction)) in guards.iter_mut().zip(&self.friction).enumerate() {
                let pressed = if k == 0 { pressed } else { zero };
                let margin = level.mul_add(pressed, -(side * *friction));
                *guard = sticking.where_positive(margin, *guard);
            }
            let proof = proof_of_no_root(&guards, phases.zeros, phases.sign, length, wanted);
            clear = clear.min(wanted.where_positive(proof, one));
        }
        !(-clear).any_positive()
    }
}
