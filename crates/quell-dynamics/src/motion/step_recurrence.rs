//! The equations of a step, order by order, and its length.
//!
//! They are written once, over the storage of the state and over the number type of the lanes: a run has the same bits alone and in
//! a lane. What lanes have in common (which rows are empty, which contacts are plain, which numbers vary in time) decides which
//! operations are done; what differs between them (the phases of the contacts) decides by masks whose result counts.

use quell_model::friction::{BranchSeries, FrictionConstants, FrictionSeries};
use quell_numerics::lane::{Lane, partial_product};
use quell_numerics::polynomial::step_length;

use super::contact_equation::ContactEquation;
use super::contact_masks::{ContactMasks, chosen};
use super::contact_series::{ContactSeries, SeriesOf};
use super::own_friction;
use super::own_state::OwnStateKind;
use super::rows::{StateRow, StateStorage};
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

/// The recurrence of a contact that slips in some lane.
pub(super) type SlipRecurrence<'c, V = f64> = Option<FrictionSeries<'c, V, { ORDER + 1 }>>;

/// What a step is computed from, and its series.
pub(super) struct StepRecurrence<'a, V: Lane, S: StateStorage<V>> {
    pub(super) storage: S,
    pub(super) constant: &'a [V],
    pub(super) pushes: &'a [S::Row],
    /// What a speed over time adds to the matrix; none in lanes, and none with a storage of few states.
    pub(super) by_speed: Option<&'a SpeedMatrices>,
    pub(super) contacts: &'a [ContactEquation<S::Row, V>],
    pub(super) masks: &'a [ContactMasks<V>],
    pub(super) holding: HoldingForces<'a, V>,
    /// The state at the start and the series of what varies in time are given, the others are written.
    pub(super) series: &'a mut StepSeries<V>,
}

impl<V: Lane, S: StateStorage<V>> StepRecurrence<'_, V, S> {
    /// Writes the series of a step within `limit`. Returns its length.
    #[inline(always)]
    pub(super) fn run<'c>(
        &mut self,
        laws: &'c mut [FrictionConstants<V>],
        branches: &mut [SlipRecurrence<'c, V>],
        limit: StepLimit<V>,
    ) -> V {
        self.start_branches(laws, branches);
        let mut state = self.storage.buffer(&mut self.series.buffers[0]);
        let mut rates = self.storage.buffer(&mut self.series.buffers[1]);
        let size = self.storage.size();
        state.as_mut()[..size].copy_from_slice(&self.series.states[..size]);
        self.orders(branches, state.as_mut(), rates.as_mut());
        self.storage.keep(state, &mut self.series.buffers[0]);
        self.storage.keep(rates, &mut self.series.buffers[1]);
        let mut length = self.length(&limit).min(limit.longest).min(limit.room);
        for (index, branch) in branches.iter().enumerate() {
            if let Some(branch) = branch {
                let trusted = branch.trusted(&self.series.contacts[index].scaled, length);
                length = chosen(self.masks[index].slipping, trusted, length);
            }
        }
        length
    }

    /// The laws' recurrences at the start of the step.
    #[inline(always)]
    fn start_branches<'c>(
        &mut self,
        laws: &'c mut [FrictionConstants<V>],
        branches: &mut [SlipRecurrence<'c, V>],
    ) {
        for (index, (law, branch)) in laws.iter_mut().zip(branches).enumerate() {
            let (contact, masks) = (&self.contacts[index], &self.masks[index]);
            if !masks.follows_law {
                continue;
            }
            let start = &self.series.states[..self.storage.size()];
            let series = &mut self.series.contacts[index];
            let slip = series.surface[0] - self.storage.dot(&contact.tangent, start);
            let slip = without_zeros(masks.most_slip_zeros > 0, masks.slip_zeros, slip);
            let scaled = slip * contact.inverse_scale;
            let sign = chosen(masks.slipping, masks.sign, V::splat(1.0));
            let started = law.series::<{ ORDER + 1 }>(sign, scaled);
            series.drag = started.slope() * contact.inverse_scale * series.pressed[0];
            *branch = Some(started);
        }
    }

    /// All orders, one after the other.
    #[inline(always)]
    fn orders(&mut self, branches: &mut [SlipRecurrence<'_, V>], state: &mut [V], rates: &mut [V]) {
        for k in 0..=ORDER {
            self.order(k, branches, state, rates);
        }
    }

    /// One order: forces from the state, then the next order of the state.
    #[inline(always)]
    fn order(
        &mut self,
        k: usize,
        branches: &mut [SlipRecurrence<'_, V>],
        state: &mut [V],
        rates: &mut [V],
    ) {
        let storage = self.storage;
        let size = storage.size();
        storage.times(state, rates);
        if k == 0 {
            for (rate, constant) in rates[..size].iter_mut().zip(&self.constant[..size]) {
                *rate = *rate + *constant;
            }
        }
        for (push, series) in self.pushes.iter().zip(&self.series.pushes) {
            storage.add(push, series[k], rates);
        }
        let contacts = self.contacts.iter().zip(self.masks);
        let StepSeries { states, contacts: series, by_speed, .. } = &mut *self.series;
        if S::TAKES_SPEED
            && let (Some(matrices), Some(series)) = (self.by_speed, by_speed)
        {
            matrices.add(k, series, state, rates);
        }
        let series = series.iter_mut().zip(branches);
        for ((contact, masks), (series, branch)) in contacts.zip(series) {
            let slip = series.surface[k] - storage.dot(&contact.tangent, state);
            series.slip[k] = if masks.any_sticks || k < masks.most_slip_zeros {
                let rests = masks.slip_zeros - V::splat(k as f64);
                chosen(masks.sticking.max(rests), V::splat(0.0), slip)
            } else {
                slip
            };
            if !series.is_plain {
                read(storage, k, contact, masks, state, series, rates);
            }
            if let Some(own) = contact.own {
                own_friction::friction(
                    storage,
                    (k, own),
                    contact,
                    masks,
                    branch,
                    series,
                    (&mut *state, &mut *rates),
                );
                states[k * size + own.place] = state[own.place];
                continue;
            }
            friction(storage, k, contact, masks, branch, series, rates);
        }
        self.holding.hold(storage, self.contacts, k, &mut self.series.contacts, rates);
        let inverse = V::splat(RECIPROCALS[k + 1]);
        for (state, rate) in state[..size].iter_mut().zip(&rates[..size]) {
            *state = *rate * inverse;
        }
        self.series.states[(k + 1) * size..(k + 2) * size].copy_from_slice(&state[..size]);
    }

    /// Length over which the last retained terms stay below the tolerance.
    #[inline(always)]
    fn length(&mut self, limit: &StepLimit<V>) -> V {
        let size = self.storage.size();
        let zero = V::splat(0.0);
        let (mut last, mut previous) = (zero, zero);
        let states = &self.series.states[..(ORDER + 1) * size];
        for (i, kept) in self.series.scales[..size].iter_mut().enumerate() {
            let inverse = with_scale(kept, limit.time_scale, |k| states[k * size + i].abs());
            // A number that is not one is not the largest.
            last = (states[ORDER * size + i].abs() * inverse).max(last);
            previous = (states[(ORDER - 1) * size + i].abs() * inverse).max(previous);
        }
        for (index, contact) in self.contacts.iter().enumerate() {
            let (masks, series) = (&self.masks[index], &self.series.contacts[index]);
            let mut bound = |terms: &SeriesOf<V>, scale: V, mask: V| {
                let share = |term: V| {
                    let share = |term, scale| if scale > 0.0 { term / scale } else { 0.0 };
                    chosen(mask, term.abs().zip(scale, share), zero)
                };
                last = share(terms[ORDER]).max(last);
                previous = share(terms[ORDER - 1]).max(previous);
            };
            // Friction turns with a slope: it varies small motions also where the state stays at rest, and its series says nothing.
            let is_tilted = !contact.slope.is_empty();
            if masks.any_sticks || is_tilted {
                let level = contact.static_coefficient * series.pressed[0].abs();
                let level = level.max(contact.static_coefficient * contact.normal_load);
                let mask = if is_tilted { V::splat(1.0) } else { masks.sticking };
                bound(&series.friction, level, mask);
            }
            if masks.follows_law && !masks.any_slips {
                // The level of an elastic slider that adheres ends the step, but does not act on the state.
                bound(&series.coefficient, series.coefficient[0].abs(), V::splat(1.0));
            }
            if masks.any_slips
                && let Some(OwnStateKind::Bristles { stiffness, .. }) = contact.own.map(|o| o.kind)
                && let Some(own) = &series.own
            {
                // Stiff bristles are faster than the time scale, with which their derivatives would be a scale too large: they slide at
                // the deflection g/σ₀.
                let level = series.coefficient[0].abs() * V::splat(1.0 / stiffness);
                bound(&own.deflection, level, V::splat(1.0));
            }
            if series.load_varies {
                let level = series.load[0].abs().max(contact.normal_load);
                bound(&series.load, level, V::splat(1.0));
            }
        }
        step_length(limit.tolerance, last, previous, ORDER)
    }
}

/// Takes the magnitude of a number of the state, whose coefficients have the given absolute values, into what is kept of it. Returns the
/// inverse, 0 for a number that vanishes.
#[inline(always)]
pub(super) fn with_scale<V: Lane>(kept: &mut V, time_scale: V, term: impl Fn(usize) -> V) -> V {
    let mut scale = term(4);
    for k in (0..4).rev() {
        scale = (scale * time_scale).max(term(k));
    }
    scale = scale.max(V::splat(FORGOTTEN) * *kept);
    *kept = scale;
    scale.map(|scale| if scale > LEAST_SCALE { 1.0 / scale } else { 0.0 })
}

/// 0 where `zeros` is positive, which is so in some lane only if `any`.
#[inline(always)]
fn without_zeros<V: Lane>(any: bool, zeros: V, value: V) -> V {
    if any { chosen(zeros, V::splat(0.0), value) } else { value }
}

/// Load and tilt of a contact at order k, and its reaction on the structure.
#[inline(always)]
fn read<V: Lane, S: StateStorage<V>>(
    storage: S,
    k: usize,
    contact: &ContactEquation<S::Row, V>,
    masks: &ContactMasks<V>,
    state: &[V],
    series: &mut ContactSeries<V>,
    rates: &mut [V],
) {
    series.load[k] = if contact.is_compliant() {
        series.given[k] + storage.dot(&contact.approach, state)
    } else {
        series.given[k]
    };
    if !contact.across.is_empty() {
        let rest = if k == 0 { contact.normal_load } else { V::splat(0.0) };
        let carried = if series.is_guided { rest + series.guided[k] } else { rest };
        let load = without_zeros(masks.any_open, masks.open, series.load[k]);
        storage.add(&contact.across, carried - load, rates);
    }
    let zeros = masks.load_zeros - V::splat(k as f64);
    series.load[k] = without_zeros(k < masks.most_load_zeros, zeros, series.load[k]);
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
fn friction<V: Lane, S: StateStorage<V>>(
    storage: S,
    k: usize,
    contact: &ContactEquation<S::Row, V>,
    masks: &ContactMasks<V>,
    branch: &mut SlipRecurrence<'_, V>,
    series: &mut ContactSeries<V>,
    rates: &mut [V],
) {
    if masks.any_holds && !contact.slope.is_empty() {
        // T of this order is not known yet; what it owes to the lower orders is.
        let known = partial_product(&series.tilt, &series.friction, k, 1, k);
        storage.add_where(masks.holding, &contact.across, known, rates);
    }
    let mut force = V::splat(0.0);
    if let Some(branch) = branch {
        let w = series.slip[k] * contact.inverse_scale;
        series.scaled[k] = w;
        force = if series.is_plain && k > 0 {
            // The newest coefficient of γ waits for one operation only.
            let lower = branch.lower(k, &series.scaled) * series.pressed[0];
            series.drag.mul_add(series.slip[k], lower)
        } else {
            series.coefficient[k] = if k == 0 {
                branch.first()
            } else {
                branch.slope().mul_add(w, branch.lower(k, &series.scaled))
            };
            partial_product(&series.coefficient, &series.pressed, k, 0, k)
        };
    }
    if masks.any_saturated {
        let bound = masks.saturated * contact.static_coefficient * series.pressed[k];
        force = chosen(masks.saturated.abs(), bound, force);
    }
    if !(masks.any_slips || masks.any_saturated) {
        series.friction[k] = V::splat(0.0);
        return;
    }
    if masks.all_act {
        series.friction[k] = force;
        storage.add(&contact.along, force, rates);
    } else {
        series.friction[k] = chosen(masks.acting, force, V::splat(0.0));
        storage.add_where(masks.acting, &contact.along, force, rates);
    }
    if !contact.slope.is_empty() {
        let tilted = partial_product(&series.tilt, &series.friction, k, 0, k);
        storage.add_where(masks.acting, &contact.across, tilted, rates);
    }
}
