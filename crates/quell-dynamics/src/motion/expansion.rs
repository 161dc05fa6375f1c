//! One step: its series order by order, its length, the first guard that ends it, and the state at its end.
//!
//! The equations are written once over [`StateStorage`], and compiled for the numbers of states of small systems.

use quell_model::friction::{BranchSeries, FrictionConstants, FrictionSeries};
use quell_numerics::dispatch::Work;
use quell_numerics::lane::partial_product;
use quell_numerics::polynomial::step_length;

use super::contact_series::ContactSeries;
use super::equations::{ContactEquation, ContactForcing, Forcings, MotionEquations};
use super::guards::{GuardReached, Guards};
use super::phase::{ContactNow, ContactPhase};
use super::rows::{FewStates, ManyStates, StateStorage};
use super::series::{StepSeries, horner_states};
use super::stuck::StuckForces;
use crate::simulation::{Clock, ORDER, RECIPROCALS, Series};

/// Share of the magnitude of a number that counts in the next step: a large transient is forgotten after some steps, so that it
/// does not loosen the tolerance of the motion that remains.
const FORGOTTEN: f64 = 0.8;

/// Limits on the length of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct StepLimit {
    /// Bound on the last two retained terms, relative to the scale of each number of the state.
    pub(super) tolerance: f64,
    /// Time scale of the system.
    pub(super) time_scale: f64,
    /// ORDER/2 radians of the fastest wave.
    pub(super) longest: f64,
    /// Time to the next moment that no step may pass.
    pub(super) room: f64,
}

/// Computes the series of a step, and what follows from them.
pub(super) struct StepExpansion<'a> {
    pub(super) equations: &'a MotionEquations,
    pub(super) forcings: &'a Forcings,
    pub(super) laws: &'a mut [FrictionConstants],
    pub(super) now: &'a [ContactNow],
    pub(super) stuck: &'a StuckForces,
    pub(super) clock: Clock,
    pub(super) limit: StepLimit,
    pub(super) out: &'a mut StepSeries,
    /// The state at the end of the step.
    pub(super) end: &'a mut [f64],
}

/// A step as its series and guards give it.
#[derive(Clone, Copy, Debug)]
pub(super) struct ExpandedStep {
    /// Its length, up to the first guard that reaches zero.
    pub(super) duration: f64,
    /// That guard.
    pub(super) reached: Option<GuardReached>,
}

/// The recurrence of a slipping contact.
type SlipRecurrence<'c> = Option<FrictionSeries<'c, { ORDER + 1 }>>;

/// Largest number of contacts whose recurrences need no memory of their own.
const FEW_CONTACTS: usize = 4;

impl Work for StepExpansion<'_> {
    type Output = ExpandedStep;

    #[inline(always)]
    fn run(self) -> ExpandedStep {
        let matrix = &self.equations.matrix;
        if self.now.len() <= FEW_CONTACTS {
            if let Some(storage) = FewStates::<2>::of(matrix) {
                return self.few(storage);
            }
            if let Some(storage) = FewStates::<4>::of(matrix) {
                return self.few(storage);
            }
            if let Some(storage) = FewStates::<6>::of(matrix) {
                return self.few(storage);
            }
            if let Some(storage) = FewStates::<8>::of(matrix) {
                return self.few(storage);
            }
        }
        let storage = ManyStates { size: self.equations.size, matrix };
        let mut branches: Vec<SlipRecurrence<'_>> = (0..self.now.len()).map(|_| None).collect();
        self.whole(storage, &mut branches)
    }
}

impl<'a> StepExpansion<'a> {
    /// The step of a system with few states and contacts: with constant loops, and no memory but the stack.
    #[inline(always)]
    fn few<const N: usize>(self, storage: FewStates<'a, N>) -> ExpandedStep {
        let mut branches: [SlipRecurrence<'_>; FEW_CONTACTS] = [None, None, None, None];
        let count = self.now.len();
        self.whole(storage, &mut branches[..count])
    }

    /// The step.
    #[inline(always)]
    fn whole<S: StateStorage>(
        mut self,
        storage: S,
        branches: &mut [SlipRecurrence<'a>],
    ) -> ExpandedStep {
        self.forcings();
        self.start_branches(branches);
        let mut state = storage.buffer(&mut self.out.buffers[0]);
        let mut rates = storage.buffer(&mut self.out.buffers[1]);
        state.as_mut().copy_from_slice(&self.out.states[..storage.size()]);
        self.orders(storage, branches, state.as_mut(), rates.as_mut());
        let mut length = self.length(storage).min(self.limit.longest).min(self.limit.room);
        for (branch, contact) in branches.iter().zip(&self.out.contacts) {
            if let Some(branch) = branch {
                length = branch.trusted(&contact.scaled, length);
            }
        }
        let reached = self.guards().first(length);
        let duration = reached.map_or(length, |reached| reached.after);
        horner_states(&self.out.states, duration, state.as_mut());
        self.end.copy_from_slice(state.as_mut());
        storage.keep(state, &mut self.out.buffers[0]);
        storage.keep(rates, &mut self.out.buffers[1]);
        ExpandedStep { duration, reached }
    }

    /// All orders, one after the other.
    #[inline(always)]
    fn orders<S: StateStorage>(
        &mut self,
        storage: S,
        branches: &mut [SlipRecurrence<'_>],
        state: &mut [f64],
        rates: &mut [f64],
    ) {
        if S::IS_UNROLLED {
            quell_numerics::for_each_order_below_16!(K, {
                self.order(storage, K, branches, state, rates);
            });
            self.order(storage, ORDER, branches, state, rates);
        } else {
            for k in 0..=ORDER {
                self.order(storage, k, branches, state, rates);
            }
        }
    }

    #[inline(always)]
    fn guards(&self) -> Guards<'_> {
        Guards {
            equations: self.equations,
            forcings: self.forcings,
            now: self.now,
            contacts: &self.out.contacts,
        }
    }

    /// Series of what varies in time; constant ones were written when the run began.
    #[inline(always)]
    fn forcings(&mut self) {
        for (series, forcing) in self.out.pushes.iter_mut().zip(&self.forcings.pushes) {
            *series = forcing.series(self.clock);
        }
        for (contact, forcing) in self.out.contacts.iter_mut().zip(&self.forcings.contacts) {
            if !forcing.surface.is_constant() {
                contact.surface = forcing.surface.series(self.clock);
            }
            if !forcing.load.is_constant() {
                contact.given = forcing.load.series(self.clock);
            }
            if !forcing.guided.is_constant() {
                contact.guided = forcing.guided.series(self.clock);
            }
            if let Some(factor) = &forcing.factor {
                contact.factor = factor.series(self.clock);
            }
        }
    }

    /// The laws' recurrences at the start of the step.
    #[inline(always)]
    fn start_branches(&mut self, branches: &mut [SlipRecurrence<'a>]) {
        let laws = std::mem::take(&mut self.laws);
        for (index, (law, branch)) in laws.iter_mut().zip(branches).enumerate() {
            let ContactPhase::Slip(sign) = self.now[index].phase else { continue };
            let contact = &self.equations.contacts[index];
            let slip = if self.now[index].slip_zeros > 0 {
                0.0
            } else {
                self.out.contacts[index].surface[0] - contact.tangent.dot(self.out.start())
            };
            let scaled = slip * contact.inverse_scale;
            let series = law.series::<{ ORDER + 1 }>(f64::from(sign), scaled);
            let load = self.out.contacts[index].pressed[0];
            self.out.contacts[index].drag = series.slope() * contact.inverse_scale * load;
            *branch = Some(series);
        }
    }

    /// One order: forces from the state, then the next order of the state.
    #[inline(always)]
    fn order<S: StateStorage>(
        &mut self,
        storage: S,
        k: usize,
        branches: &mut [SlipRecurrence<'_>],
        state: &mut [f64],
        rates: &mut [f64],
    ) {
        let size = storage.size();
        let Self { equations, forcings, now, stuck, out, .. } = self;
        storage.times(state, rates);
        if k == 0 {
            for (rate, constant) in rates[..size].iter_mut().zip(&equations.constant[..size]) {
                *rate += constant;
            }
        }
        for (push, series) in equations.pushes.iter().zip(&out.pushes) {
            storage.add(push, series[k], rates);
        }
        let contacts = equations.contacts.iter().zip(&forcings.contacts).zip(now.iter());
        let series = out.contacts.iter_mut().zip(branches);
        for (((contact, forcing), now), (series, branch)) in contacts.zip(series) {
            let is_zero = now.sticks() || k < now.slip_zeros;
            let slip = series.surface[k] - storage.dot(&contact.tangent, state);
            series.slip[k] = if is_zero { 0.0 } else { slip };
            if !series.is_plain {
                read(storage, k, (contact, forcing), now, state, series, rates);
            }
            friction(storage, k, contact, now, branch, series, rates);
        }
        stuck.hold(storage, equations, k, &mut out.contacts, rates);
        let inverse = RECIPROCALS[k + 1];
        for (state, rate) in state[..size].iter_mut().zip(&rates[..size]) {
            *state = rate * inverse;
        }
        out.states[(k + 1) * size..(k + 2) * size].copy_from_slice(&state[..size]);
    }

    /// Length over which the last retained terms stay below the tolerance.
    #[inline(always)]
    fn length<S: StateStorage>(&mut self, storage: S) -> f64 {
        let size = storage.size();
        let time = self.limit.time_scale;
        let (mut last, mut previous) = (0.0_f64, 0.0_f64);
        let (states, scales) = (&self.out.states[..(ORDER + 1) * size], &mut self.out.scales);
        for (i, kept) in scales[..size].iter_mut().enumerate() {
            let mut scale = states[4 * size + i].abs();
            for k in (0..4).rev() {
                scale = (scale * time).max(states[k * size + i].abs());
            }
            scale = scale.max(FORGOTTEN * *kept);
            *kept = scale;
            if scale > 0.0 {
                let inverse = 1.0 / scale;
                last = last.max(states[ORDER * size + i].abs() * inverse);
                previous = previous.max(states[(ORDER - 1) * size + i].abs() * inverse);
            }
        }
        for (index, contact) in self.equations.contacts.iter().enumerate() {
            let series = &self.out.contacts[index];
            let mut bound = |terms: &Series, scale: f64| {
                if scale > 0.0 {
                    last = (terms[ORDER].abs() / scale).max(last);
                    previous = (terms[ORDER - 1].abs() / scale).max(previous);
                }
            };
            if self.now[index].sticks() {
                let level = contact.static_coefficient * series.pressed[0].abs();
                bound(
                    &series.friction,
                    level.max(contact.static_coefficient * contact.normal_load),
                );
            }
            if contact.is_compliant() || !self.forcings.contacts[index].load.is_constant() {
                bound(&series.load, series.load[0].abs().max(contact.normal_load));
            }
        }
        step_length(self.limit.tolerance, last, previous, ORDER)
    }
}

/// Load and tilt of a contact at order k, and its reaction on the structure.
#[inline(always)]
fn read<S: StateStorage>(
    storage: S,
    k: usize,
    (contact, forcing): (&ContactEquation, &ContactForcing),
    now: &ContactNow,
    state: &[f64],
    series: &mut ContactSeries,
    rates: &mut [f64],
) {
    series.load[k] = if contact.is_compliant() {
        series.given[k] + storage.dot(&contact.approach, state)
    } else {
        series.given[k]
    };
    if !contact.across.is_empty() {
        let rest = if k == 0 { contact.normal_load } else { 0.0 };
        let carried = if forcing.guided.is_constant() { rest } else { rest + series.guided[k] };
        let load = if now.is_open() { 0.0 } else { series.load[k] };
        storage.add(&contact.across, carried - load, rates);
    }
    if k < now.load_zeros {
        series.load[k] = 0.0;
    }
    if !contact.slope.is_empty() {
        series.tilt[k] = storage.dot(&contact.slope, state);
    }
    // What the coefficient of friction multiplies.
    series.pressed[k] = if forcing.factor.is_some() {
        partial_product(&series.factor, &series.load, k, 0, k)
    } else {
        series.load[k]
    };
}

/// Friction of a contact at order k where its slip velocity or its bound gives it, and its action on the structure.
#[inline(always)]
fn friction<S: StateStorage>(
    storage: S,
    k: usize,
    contact: &ContactEquation,
    now: &ContactNow,
    branch: &mut SlipRecurrence<'_>,
    series: &mut ContactSeries,
    rates: &mut [f64],
) {
    let force = match (now.phase, branch) {
        (ContactPhase::Slip(_), Some(branch)) => {
            let w = series.slip[k] * contact.inverse_scale;
            series.scaled[k] = w;
            if series.is_plain && k > 0 {
                // The newest coefficient of γ waits for one operation only.
                let lower = branch.lower(k, &series.scaled) * series.pressed[0];
                f64::mul_add(series.drag, series.slip[k], lower)
            } else {
                series.coefficient[k] = if k == 0 {
                    branch.first()
                } else {
                    f64::mul_add(branch.slope(), w, branch.lower(k, &series.scaled))
                };
                partial_product(&series.coefficient, &series.pressed, k, 0, k)
            }
        }
        (ContactPhase::Stick, _) if now.saturated != 0 => {
            f64::from(now.saturated) * contact.static_coefficient * series.pressed[k]
        }
        _ => {
            series.friction[k] = 0.0;
            if !contact.slope.is_empty() && now.sticks() {
                // T of this order is not known yet; what it owes to the lower orders is.
                let known = partial_product(&series.tilt, &series.friction, k, 1, k);
                storage.add(&contact.across, known, rates);
            }
            return;
        }
    };
    series.friction[k] = force;
    storage.add(&contact.along, force, rates);
    if !contact.slope.is_empty() {
        let tilted = partial_product(&series.tilt, &series.friction, k, 0, k);
        storage.add(&contact.across, tilted, rates);
    }
}
