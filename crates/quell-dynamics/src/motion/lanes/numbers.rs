//! The numbers of all lanes of a group, and the step that they take at once.

use quell_model::friction::{Friction, FrictionConstants};
use quell_numerics::lane::Lane;

use super::super::contact_equation::ContactEquation;
use super::super::contact_masks::ContactMasks;
use super::super::contact_series::ContactSeries;
use super::super::engine::{MotionRun, StepRoom};
use super::super::guards::proof_of_no_event;
use super::super::phase::{ContactNow, ContactPhase};
use super::super::rows::{LaneEntries, LaneStates};
use super::super::series::{StepSeries, horner_states};
use super::super::step_recurrence::{FEW_CONTACTS, SlipRecurrence, StepLimit, StepRecurrence};
use super::super::stuck::StuckForces;
use super::forcings::LaneForcings;
use super::holding::LaneHolding;
use super::shape::LaneShape;
use crate::simulation::ORDER;

/// The numbers of all lanes.
///
/// The state of a run between two steps belongs to its engine; a lane receives a copy for each step.
pub(super) struct LaneNumbers<V: Lane> {
    // Constants of a run.
    size: usize,
    columns: Vec<V>,
    constant: Vec<V>,
    pushes: Vec<LaneEntries<V>>,
    contacts: Vec<ContactEquation<LaneEntries<V>, V>>,
    forcings: LaneForcings<V>,
    /// The laws of every contact, lane by lane, and their constants.
    laws: Vec<Vec<Friction>>,
    constants: Vec<FrictionConstants<V>>,
    // Changed by events.
    masks: Vec<ContactMasks<V>>,
    holding: LaneHolding<V>,
    are_masks_new: bool,
    is_holding_new: bool,
    // The next step, and the step just taken.
    limit: StepLimit<V>,
    time: V,
    low: V,
    series: StepSeries<V>,
    length: V,
    /// Positive where no guard reaches zero within the step, as far as its tests show.
    clear: V,
    end: Vec<V>,
}

impl<V: Lane> LaneNumbers<V> {
    /// Zeros, for runs like this one.
    pub(super) fn like(shape: &LaneShape, run: &MotionRun<'_>) -> Self {
        let zero = V::splat(0.0);
        let equations = run.equations;
        let size = equations.size;
        let contacts = equations.contacts.iter().map(|contact| ContactEquation {
            tangent: LaneEntries::like(&contact.tangent),
            approach: LaneEntries::like(&contact.approach),
            slope: LaneEntries::like(&contact.slope),
            along: LaneEntries::like(&contact.along),
            across: LaneEntries::like(&contact.across),
            normal_load: zero,
            scale: zero,
            inverse_scale: zero,
            static_coefficient: zero,
            sliding_coefficient: zero,
            own: None,
        });
        let series = run.series.contacts.iter().map(|contact| ContactSeries {
            is_plain: contact.is_plain,
            load_varies: contact.load_varies,
            is_guided: contact.is_guided,
            has_factor: contact.has_factor,
            ..ContactSeries::zero()
        });
        let count = equations.contacts.len();
        Self {
            size,
            columns: vec![zero; size * size],
            constant: vec![zero; size],
            pushes: equations.pushes.iter().map(LaneEntries::like).collect(),
            contacts: contacts.collect(),
            forcings: LaneForcings::like(&run.forcings),
            laws: shape.laws().map(|law| vec![law.clone(); V::LANES]).collect(),
            constants: Vec::new(),
            masks: (0..count).map(|_| ContactMasks::empty()).collect(),
            holding: LaneHolding::new(count),
            are_masks_new: true,
            is_holding_new: true,
            limit: StepLimit { tolerance: zero, time_scale: zero, longest: zero, room: zero },
            time: zero,
            low: zero,
            series: StepSeries::with(size, equations.pushes.len(), series.collect()),
            length: zero,
            clear: zero,
            end: vec![zero; size],
        }
    }

    /// Writes the constants of a run; [`LaneNumbers::begin`] must follow.
    pub(super) fn admit(&mut self, lane: usize, run: &MotionRun<'_>) {
        let equations = run.equations;
        let columns = equations.matrix.columns(self.size).unwrap_or_default();
        for (number, entry) in self.columns.iter_mut().zip(columns) {
            number.set_lane(lane, *entry);
        }
        for (number, entry) in self.constant.iter_mut().zip(&equations.constant) {
            number.set_lane(lane, *entry);
        }
        for (entries, push) in self.pushes.iter_mut().zip(&equations.pushes) {
            entries.set(lane, push);
        }
        for (numbers, contact) in self.contacts.iter_mut().zip(&equations.contacts) {
            numbers.tangent.set(lane, &contact.tangent);
            numbers.approach.set(lane, &contact.approach);
            numbers.slope.set(lane, &contact.slope);
            numbers.along.set(lane, &contact.along);
            numbers.across.set(lane, &contact.across);
            numbers.normal_load.set_lane(lane, contact.normal_load);
            numbers.scale.set_lane(lane, contact.scale);
            numbers.inverse_scale.set_lane(lane, contact.inverse_scale);
            numbers.static_coefficient.set_lane(lane, contact.static_coefficient);
            numbers.sliding_coefficient.set_lane(lane, contact.sliding_coefficient);
        }
        for (laws, contact) in self.laws.iter_mut().zip(&run.system.contacts) {
            laws[lane] = contact.friction.clone();
        }
        self.forcings.admit(lane, &run.forcings, run.clock, &mut self.series);
        for (numbers, contact) in self.series.contacts.iter_mut().zip(&run.series.contacts) {
            // Of a plain contact the load is written here alone.
            for k in 0..=ORDER {
                numbers.load[k].set_lane(lane, contact.load[k]);
                numbers.pressed[k].set_lane(lane, contact.pressed[k]);
            }
        }
        for scale in &mut self.series.scales {
            scale.set_lane(lane, 0.0);
        }
        self.limit.tolerance.set_lane(lane, run.tolerance);
        self.limit.time_scale.set_lane(lane, run.time_scale);
    }

    /// Computes the constants of the laws, after new runs have been admitted.
    pub(super) fn begin(&mut self) {
        let constants = self.laws.iter().map(|laws| FrictionConstants::side_by_side(laws));
        // The laws of a group are alike, by its shape.
        self.constants = constants.flatten().collect();
    }

    /// Empties a lane: its contacts need no work.
    pub(super) fn evict(&mut self, lane: usize) {
        for masks in &mut self.masks {
            masks.set(lane, &ContactNow::of(ContactPhase::Open));
        }
        self.holding.set(lane, &StuckForces::default());
        (self.are_masks_new, self.is_holding_new) = (true, true);
    }

    /// Writes the phases of the contacts of a run.
    #[inline(always)]
    pub(super) fn set_phases(&mut self, lane: usize, now: &[ContactNow]) {
        for (masks, now) in self.masks.iter_mut().zip(now) {
            masks.set(lane, now);
        }
        self.are_masks_new = true;
    }

    /// Writes the forces of the sticking contacts of a run.
    #[inline(always)]
    pub(super) fn set_holding(&mut self, lane: usize, run: &MotionRun<'_>) {
        self.holding.set(lane, &run.stuck);
        self.is_holding_new = true;
    }

    /// Writes the start of the next step of a run.
    #[inline(always)]
    pub(super) fn load(&mut self, lane: usize, run: &MotionRun<'_>, room: StepRoom) {
        for (number, entry) in self.series.states[..self.size].iter_mut().zip(run.series.start()) {
            number.set_lane(lane, *entry);
        }
        self.time.set_lane(lane, run.clock.time());
        self.low.set_lane(lane, run.clock.low());
        self.limit.longest.set_lane(lane, room.longest);
        self.limit.room.set_lane(lane, room.room);
        self.forcings.load(lane, &run.forcings, run.clock, &mut self.series);
    }

    /// Takes a step in every lane.
    #[inline(always)]
    pub(super) fn step(&mut self) {
        if self.are_masks_new {
            self.masks.iter_mut().for_each(ContactMasks::combine);
            self.are_masks_new = false;
        }
        if self.is_holding_new {
            self.holding.combine();
            self.is_holding_new = false;
        }
        self.forcings.write(self.time, self.low, &mut self.series);
        let mut branches: [SlipRecurrence<'_, V>; FEW_CONTACTS] = [None, None, None, None];
        let mut recurrence = StepRecurrence {
            storage: LaneStates { size: self.size, columns: &self.columns },
            constant: &self.constant,
            pushes: &self.pushes,
            by_speed: None,
            contacts: &self.contacts,
            masks: &self.masks,
            holding: self.holding.forces(),
            series: &mut self.series,
        };
        let branches = &mut branches[..self.masks.len()];
        self.length = recurrence.run(&mut self.constants, branches, self.limit);
        self.clear =
            proof_of_no_event(&self.contacts, &self.masks, &self.series.contacts, self.length);
        horner_states(&self.series.states, self.length, &mut self.end);
    }

    /// Length of the step of a lane.
    #[inline(always)]
    pub(super) fn length(&self, lane: usize) -> f64 {
        self.length.lane(lane)
    }

    /// Whether no guard of a lane reaches zero within its step. If not, a root is possible.
    #[inline(always)]
    pub(super) fn is_clear(&self, lane: usize) -> bool {
        self.clear.lane(lane) > 0.0
    }

    /// Writes the end of the step of a lane to `out`.
    #[inline(always)]
    pub(super) fn end(&self, lane: usize, out: &mut [f64]) {
        for (entry, number) in out.iter_mut().zip(&self.end) {
            *entry = number.lane(lane);
        }
    }

    /// Writes the series of a lane's step to those of its run.
    #[inline(always)]
    pub(super) fn extract(&self, lane: usize, out: &mut StepSeries) {
        let states = (ORDER + 1) * self.size;
        copy_lane(lane, &self.series.states[..states], &mut out.states[..states]);
        for (numbers, push) in self.series.pushes.iter().zip(&mut out.pushes) {
            copy_lane(lane, numbers, push);
        }
        for (numbers, contact) in self.series.contacts.iter().zip(&mut out.contacts) {
            copy_lane(lane, &numbers.slip, &mut contact.slip);
            copy_lane(lane, &numbers.friction, &mut contact.friction);
            if !numbers.is_plain {
                copy_lane(lane, &numbers.load, &mut contact.load);
                copy_lane(lane, &numbers.pressed, &mut contact.pressed);
                copy_lane(lane, &numbers.tilt, &mut contact.tilt);
            }
        }
    }

    /// Lets a run go on alone: writes what its next step needs of the steps before.
    pub(super) fn release(&self, lane: usize, run: &mut MotionRun<'_>) {
        copy_lane(lane, &self.series.scales, &mut run.series.scales);
    }
}

#[inline(always)]
fn copy_lane<V: Lane>(lane: usize, from: &[V], to: &mut [f64]) {
    for (entry, number) in to.iter_mut().zip(from) {
        *entry = number.lane(lane);
    }
}
