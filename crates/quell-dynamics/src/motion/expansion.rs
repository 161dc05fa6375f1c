//! One step of one run: its series, its length, the first guard that ends it, and the state at its end.
//!
//! The equations (`step_recurrence`) are compiled for the numbers of states of small systems.

use quell_model::friction::FrictionConstants;
use quell_numerics::dispatch::{
    InstructionSet, Work, only_with_fused_multiply_add, with_fused_multiply_add, with_scalar_of,
};

use super::contact_in_step::ContactInStep;
use super::equations::{Forcings, MotionEquations};
use super::guards::{GuardReached, Guards};
use super::phase::ContactNow;
use super::rows::{FewStates, ManyStates, SmallStates, StateStorage};
use super::series::{StepSeries, horner_states};
use super::step_recurrence::{FEW_CONTACTS, SlipRecurrence, StepLimit, StepRecurrence};
use super::stuck::StuckForces;
use crate::simulation::{Clock, ORDER};

/// Computes the series of a step, and what follows from them.
pub(super) struct StepExpansion<'a> {
    pub(super) equations: &'a MotionEquations,
    pub(super) forcings: &'a Forcings,
    pub(super) laws: &'a mut [FrictionConstants],
    pub(super) now: &'a [ContactNow],
    pub(super) stuck: &'a StuckForces,
    pub(super) clock: Clock,
    pub(super) limit: StepLimit,
    /// The last order of the series: less than [`ORDER`] only where nothing but the start is asked for.
    pub(super) last: usize,
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

impl<'a> StepExpansion<'a> {
    /// The step, by code that is compiled for the number of states of small systems: each has a function of its own, because
    /// compilers take more than in proportion for one function of all of them.
    pub(super) fn run(self) -> ExpandedStep {
        let MotionEquations { size, ref matrix, .. } = *self.equations;
        if self.now.len() <= FEW_CONTACTS && self.equations.by_speed.is_none() {
            if let Some(storage) = FewStates::<2>::of(matrix) {
                return FewStatesStep(self, storage).fused();
            }
            if let Some(storage) = FewStates::<4>::of(matrix) {
                return FewStatesStep(self, storage).fused();
            }
            if let Some(storage) = SmallStates::of(matrix, size) {
                return FewStatesStep(self, storage).fused();
            }
        }
        with_fused_multiply_add(ManyStatesStep { step: self, by_halves: false })
    }

    /// The step.
    #[inline(always)]
    fn whole<S: StateStorage>(
        mut self,
        storage: S,
        phases: &[ContactInStep],
        branches: &mut [SlipRecurrence<'a>],
    ) -> ExpandedStep {
        self.forcings();
        let laws = std::mem::take(&mut self.laws);
        let mut recurrence = StepRecurrence {
            storage,
            constant: &self.equations.constant,
            pushes: &self.equations.pushes,
            by_speed: self.equations.by_speed.as_ref(),
            contacts: &self.equations.contacts,
            phases,
            holding: self.stuck.holding(),
            last: self.last,
            series: &mut *self.out,
        };
        let length = recurrence.run(laws, branches, self.limit);
        if self.last < ORDER {
            return ExpandedStep { duration: 0.0, reached: None };
        }
        let reached = self.guards().first(length);
        let duration = reached.map_or(length, |reached| reached.after);
        horner_states(&self.out.states, duration, self.end);
        ExpandedStep { duration, reached }
    }

    #[inline(always)]
    fn guards(&self) -> Guards<'_> {
        Guards { equations: self.equations, now: self.now, contacts: &self.out.contacts }
    }

    /// Series of what varies in time; constant ones were written when the run began.
    #[inline(always)]
    fn forcings(&mut self) {
        for (series, forcing) in self.out.pushes.iter_mut().zip(&self.forcings.pushes) {
            *series = forcing.series(self.clock);
        }
        if let (Some(series), Some(speed)) = (&mut self.out.by_speed, &self.forcings.speed) {
            series.begin(speed, self.clock);
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
}

/// The step of a system with few states and contacts: with no memory but the stack.
struct FewStatesStep<'a, S>(StepExpansion<'a>, S);

impl<S: StateStorage> FewStatesStep<'_, S> {
    /// The step with fused multiply-add; without, with the same bits by the one function for any number of states.
    fn fused(self) -> ExpandedStep {
        only_with_fused_multiply_add(self).unwrap_or_else(|Self(step, _)| {
            with_scalar_of(InstructionSet::Baseline, ManyStatesStep { step, by_halves: true })
        })
    }
}

impl<S: StateStorage> Work for FewStatesStep<'_, S> {
    type Output = ExpandedStep;

    #[inline(always)]
    fn run(self) -> ExpandedStep {
        let Self(step, storage) = self;
        let mut branches: [SlipRecurrence<'_>; FEW_CONTACTS] = [None, None, None, None];
        let mut phases: [ContactInStep; FEW_CONTACTS] =
            std::array::from_fn(|_| ContactInStep::open());
        for (phase, now) in phases.iter_mut().zip(step.now) {
            *phase = ContactInStep::of(now);
        }
        let count = step.now.len();
        step.whole(storage, &phases[..count], &mut branches[..count])
    }
}

/// The step of any system; `by_halves` with the bits of [`FewStatesStep`].
struct ManyStatesStep<'a> {
    step: StepExpansion<'a>,
    by_halves: bool,
}

impl Work for ManyStatesStep<'_> {
    type Output = ExpandedStep;

    #[inline(always)]
    fn run(self) -> ExpandedStep {
        let Self { step, by_halves } = self;
        let MotionEquations { size, ref matrix, .. } = *step.equations;
        let storage = ManyStates { size, matrix, by_halves };
        let mut branches: Vec<SlipRecurrence<'_>> = (0..step.now.len()).map(|_| None).collect();
        let phases: Vec<ContactInStep> = step.now.iter().map(ContactInStep::of).collect();
        step.whole(storage, &phases, &mut branches)
    }
}
