//! The equations of a step, order by order, and its length.
//!
//! They are written once, over the storage of the state. Small systems with plain contacts take the same steps in vectors (`plain_step`).

use quell_model::friction::{BranchSeries, FrictionConstants, FrictionSeries};
use quell_numerics::lane::{Lane, partial_product};
use quell_numerics::polynomial::step_length;

use super::contact_equation::ContactEquation;
use super::contact_in_step::ContactInStep;
use super::contact_series::{ContactSeries, SeriesOf};
use super::own_friction;
use super::own_state::OwnStateKind;
use super::rows::{RowEntries, StateStorage};
use super::series::StepSeries;
use super::speed_terms::SpeedMatrices;
use super::stuck::HoldingForces;
use crate::simulation::{ORDER, RECIPROCALS};

/// Share of the magnitude of a number that counts in the next step: a large transient is forgotten after some steps, so that it
/// does not loosen the tolerance of the motion that remains.
const FORGOTTEN: f64 = 0.8;

/// Numbers of the state below this are taken as zero: their higher terms are no longer normal floating-point numbers.
pub(super) const LEAST_SCALE: f64 = 1e-280;

/// Largest number of contacts whose recurrences need no memory of their own.
pub(super) const FEW_CONTACTS: usize = 4;

/// Limits on the length of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct StepLimit<V = f64> {
    /// Bound on the last two retained terms, relative to the scale of each number of the state.
    pub(super) tolerance: V,
    /// Time scale of the system.
    pub(super) time_scale: V,
    /// ORDER/2 radians of the fastest wave.
    pub(super) longest: V,
    /// Time to the next moment that no step may pass.
    pub(super) room: V,
}

/// The recurrence of a contact that slips.
pub(super) type SlipRecurrence<'c> = Option<FrictionSeries<'c, f64, { ORDER + 1 }>>;

/// What a step is computed from, and its series.
pub(super) struct StepRecurrence<'a, S: StateStorage> {
    pub(super) storage: S,
    pub(super) constant: &'a [f64],
    pub(super) pushes: &'a [RowEntries],
    /// What a speed over time adds to the matrix; none with a storage of few states.
    pub(super) by_speed: Option<&'a SpeedMatrices>,
    pub(super) contacts: &'a [ContactEquation],
    pub(super) phases: &'a [ContactInStep],
    pub(super) holding: HoldingForces<'a>,
    /// The last order: [`ORDER`], or 0 where only what holds at the start is asked for.
    pub(super) last: usize,
    /// The state at the start and the series of what varies in time are given, the others are written.
    pub(super) series: &'a mut StepSeries,
}

impl<S: StateStorage> StepRecurrence<'_, S> {
    /// Writes the series of a step within `limit`. Returns its length, 0 with the first order alone.
    #[inline(always)]
    pub(super) fn run<'c>(
        &mut self,
        laws: &'c mut [FrictionConstants],
        branches: &mut [SlipRecurrence<'c>],
        limit: StepLimit,
    ) -> f64 {
        self.start_branches(laws, branches);
        let mut state = self.storage.buffer(&mut self.series.buffers[0]);
        let mut rates = self.storage.buffer(&mut self.series.buffers[1]);
        let size = self.storage.size();
        state.as_mut()[..size].copy_from_slice(&self.series.states[..size]);
        self.orders(branches, state.as_mut(), rates.as_mut());
        self.storage.keep(state, &mut self.series.buffers[0]);
        self.storage.keep(rates, &mut self.series.buffers[1]);
        if self.last == 0 {
            return 0.0;
        }
        let mut length = Lane::min(Lane::min(self.length(&limit), limit.longest), limit.room);
        for (index, branch) in branches.iter().enumerate() {
            if let Some(branch) = branch {
                length = branch.trusted(&self.series.contacts[index].scaled, length);
            }
        }
        length
    }

    /// The laws' recurrences at the start of the step.
    #[inline(always)]
    fn start_branches<'c>(
        &mut self,
        laws: &'c mut [FrictionConstants],
        branches: &mut [SlipRecurrence<'c>],
    ) {
        for (index, (law, branch)) in laws.iter_mut().zip(branches).enumerate() {
            let (contact, phase) = (&self.contacts[index], &self.phases[index]);
            if !phase.follows_law {
                continue;
            }
            let start = &self.series.states[..self.storage.size()];
            let series = &mut self.series.contacts[index];
            let slip = series.surface[0] - self.storage.dot(&contact.tangent, start);
            let slip = if phase.slip_zeros > 0 { 0.0 } else { slip };
            let started = law.series::<{ ORDER + 1 }>(phase.sign, slip * contact.inverse_scale);
            series.drag = started.slope() * contact.inverse_scale * series.pressed[0];
            *branch = Some(started);
        }
    }

    /// All orders, one after the other.
    #[inline(always)]
    fn orders(
        &mut self,
        branches: &mut [SlipRecurrence<'_>],
        state: &mut [f64],
        rates: &mut [f64],
    ) {
        for k in 0..=self.last {
            self.order(k, branches, state, rates);
        }
    }

    /// One order: forces from the state, then the next order of the state.
    #[inline(always)]
    fn order(
        &mut self,
        k: usize,
        branches: &mut [SlipRecurrence<'_>],
        state: &mut [f64],
        rates: &mut [f64],
    ) {
        let storage = self.storage;
        let size = storage.size();
        storage.times(state, rates);
        if k == 0 {
            for (rate, constant) in rates[..size].iter_mut().zip(&self.constant[..size]) {
                *rate += constant;
            }
        }
        for (push, series) in self.pushes.iter().zip(&self.series.pushes) {
            storage.add(push, series[k], rates);
        }
        let contacts = self.contacts.iter().zip(self.phases);
        let StepSeries { states, contacts: series, by_speed, .. } = &mut *self.series;
        if S::TAKES_SPEED
            && let (Some(matrices), Some(series)) = (self.by_speed, by_speed)
        {
            matrices.add(k, series, state, rates);
        }
        let series = series.iter_mut().zip(branches);
        for ((contact, phase), (series, branch)) in contacts.zip(series) {
            let slip = series.surface[k] - storage.dot(&contact.tangent, state);
            series.slip[k] = if phase.sticks || k < phase.slip_zeros { 0.0 } else { slip };
            if !series.is_plain {
                read(storage, k, contact, phase, state, series, rates);
            }
            if let Some(own) = contact.own {
                own_friction::friction(
                    storage,
                    (k, own),
                    contact,
                    phase,
                    branch,
                    series,
                    (&mut *state, &mut *rates),
                );
                states[k * size + own.place] = state[own.place];
                continue;
            }
            friction(storage, k, contact, phase, branch, series, rates);
        }
        self.holding.hold(storage, self.contacts, k, &mut self.series.contacts, rates);
        let inverse = RECIPROCALS[k + 1];
        for (state, rate) in state[..size].iter_mut().zip(&rates[..size]) {
            *state = *rate * inverse;
        }
        self.series.states[(k + 1) * size..(k + 2) * size].copy_from_slice(&state[..size]);
    }

    /// Length over which the last retained terms stay below the tolerance.
    #[inline(always)]
    fn length(&mut self, limit: &StepLimit) -> f64 {
        let size = self.storage.size();
        let (mut last, mut previous) = (0.0, 0.0);
        let states = &self.series.states[..(ORDER + 1) * size];
        for (i, kept) in self.series.scales[..size].iter_mut().enumerate() {
            let mut terms = [0.0; SCALE_TERMS];
            for (k, term) in terms.iter_mut().enumerate() {
                *term = states[k * size + i];
            }
            let inverse = with_scale(kept, limit.time_scale, &terms);
            // A number that is not one is not the largest.
            last = Lane::max(states[ORDER * size + i].abs() * inverse, last);
            previous = Lane::max(states[(ORDER - 1) * size + i].abs() * inverse, previous);
        }
        for (index, contact) in self.contacts.iter().enumerate() {
            let (phase, series) = (&self.phases[index], &self.series.contacts[index]);
            let mut bound = |terms: &SeriesOf<f64>, scale: f64| {
                let share = |term: f64| if scale > 0.0 { term.abs() / scale } else { 0.0 };
                last = Lane::max(share(terms[ORDER]), last);
                previous = Lane::max(share(terms[ORDER - 1]), previous);
            };
            // Friction turns with a slope: it varies small motions also where the state stays at rest, and its series says nothing.
            if phase.sticks || !contact.slope.is_empty() {
                let level = contact.static_coefficient * series.pressed[0].abs();
                let rest = contact.static_coefficient * contact.normal_load;
                bound(&series.friction, Lane::max(level, rest));
            }
            if phase.follows_law && !phase.slips {
                // The level of an elastic slider that adheres ends the step, but does not act on the state.
                bound(&series.coefficient, series.coefficient[0].abs());
            }
            if phase.slips
                && let Some(OwnStateKind::Bristles { stiffness, .. }) = contact.own.map(|o| o.kind)
                && let Some(own) = &series.own
            {
                // Stiff bristles are faster than the time scale, with which their derivatives would be a scale too large: they slide at
                // the deflection g/σ₀.
                bound(&own.deflection, series.coefficient[0].abs() * (1.0 / stiffness));
            }
            if series.load_varies {
                bound(&series.load, Lane::max(series.load[0].abs(), contact.normal_load));
            }
        }
        step_length(limit.tolerance, last, previous, ORDER)
    }
}

/// Coefficients of a number of the state that count for its magnitude.
pub(super) const SCALE_TERMS: usize = 5;

/// Takes the magnitude of a number of the state into what is kept of it, by its first coefficients. Returns the inverse, 0 for a number
/// that vanishes.
#[inline(always)]
pub(super) fn with_scale<V: Lane>(kept: &mut V, time_scale: V, terms: &[V; SCALE_TERMS]) -> V {
    let mut scale = terms[SCALE_TERMS - 1].abs();
    for k in (0..SCALE_TERMS - 1).rev() {
        scale = (scale * time_scale).max(terms[k].abs());
    }
    scale = scale.max(V::splat(FORGOTTEN) * *kept);
    *kept = scale;
    scale.map(|scale| if scale > LEAST_SCALE { 1.0 / scale } else { 0.0 })
}

/// Load and tilt of a contact at order k, and its reaction on the structure.
#[inline(always)]
fn read<S: StateStorage>(
    storage: S,
    k: usize,
    contact: &ContactEquation,
    phase: &ContactInStep,
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
        let carried = if series.is_guided { rest + series.guided[k] } else { rest };
        let load = if phase.is_open { 0.0 } else { series.load[k] };
        storage.add(&contact.across, carried - load, rates);
    }
    if k < phase.load_zeros {
        series.load[k] = 0.0;
    }
    if !contact.slope.is_empty() {
        series.tilt[k] = storage.dot(&contact.slope, state);
    }
    // What the coefficient of friction multiplies.
    series.pressed[k] = if series.has_factor {
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
    phase: &ContactInStep,
    branch: &mut SlipRecurrence<'_>,
    series: &mut ContactSeries,
    rates: &mut [f64],
) {
    if phase.holds() && !contact.slope.is_empty() {
        // T of this order is not known yet; what it owes to the lower orders is.
        let known = partial_product(&series.tilt, &series.friction, k, 1, k);
        storage.add(&contact.across, known, rates);
    }
    let mut force = 0.0;
    if let Some(branch) = branch {
        let w = series.slip[k] * contact.inverse_scale;
        series.scaled[k] = w;
        force = if series.is_plain && k > 0 {
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
        };
    }
    if phase.saturated != 0.0 {
        force = phase.saturated * contact.static_coefficient * series.pressed[k];
    }
    if !phase.acts() {
        series.friction[k] = 0.0;
        return;
    }
    series.friction[k] = force;
    storage.add(&contact.along, force, rates);
    if !contact.slope.is_empty() {
        let tilted = partial_product(&series.tilt, &series.friction, k, 0, k);
        storage.add(&contact.across, tilted, rates);
    }
}
