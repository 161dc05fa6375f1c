//! The steps of a run whose system has few coordinates and plain contacts: the coordinates side by side in one vector, the contacts in
//! another, whichever of them slip or stick.
//!
//! The equations are those of `step_recurrence` for such a system, with every operation on every number in the same order: a step has
//! the same bits here and there, so that a run may change from one to the other at any step, and machines without vectors of four
//! numbers take the other for all.

use quell_model::friction::FrictionConstants;
use quell_numerics::lane::Lane;

use super::contact_series::SeriesOf;
use super::engine::{MotionProgress, MotionRun, StepRoom};
use super::expansion::ExpandedStep;
use super::plain_equations::{MOST, PlainEquations, filled};
use super::plain_step::{PlainHolding, PlainPhases, PlainSeries, PlainStep, PushSeries};
use super::series::horner_states;
use super::step_recurrence::StepLimit;
use crate::simulation::ORDER;

/// A number of the coordinates or of the contacts side by side.
#[inline(always)]
fn vector<V: Lane>(numbers: &[f64]) -> V {
    V::load(&filled(numbers))
}

/// A run in vectors: its numbers, and the series of its last step.
pub(super) struct PlainVectors<'e, V: Lane> {
    equations: &'e PlainEquations,
    laws: FrictionConstants<V>,
    phases: PlainPhases<V>,
    surfaces_vary: bool,
    holding: PlainHolding<V>,
    /// N of the contacts.
    pressed: V,
    /// Scales of displacements and velocities.
    scales: [V; 2],
    pushes: PushSeries,
    series: PlainSeries<V>,
}

impl<'e, V: Lane> PlainVectors<'e, V> {
    /// Of a run, whose loads must be constant and whose laws must differ in numbers alone.
    pub(super) fn of(equations: &'e PlainEquations, run: &MotionRun<'_>) -> Option<Self> {
        let forcings = &run.forcings.contacts;
        let mut contacts = run.equations.contacts.iter().zip(forcings);
        if !contacts.all(|(contact, forcing)| contact.is_plain(forcing)) {
            return None;
        }
        let last = equations.contacts - 1;
        let laws: Vec<_> = (0..V::LANES)
            .map(|lane| run.system.contacts[lane.min(last)].friction.clone())
            .collect();
        let pressed: Vec<f64> =
            run.series.contacts.iter().map(|series| series.pressed[0]).collect();
        let zero = V::splat(0.0);
        let (states, series) = ([zero; ORDER + 2], [zero; ORDER + 1]);
        let mut vectors = Self {
            equations,
            laws: FrictionConstants::side_by_side(&laws)?,
            phases: PlainPhases::unknown(),
            surfaces_vary: !forcings.iter().all(|forcing| forcing.surface.is_constant()),
            holding: PlainHolding::none(),
            pressed: vector(&pressed),
            scales: [zero; 2],
            pushes: ([0.0; ORDER + 1], run.series.pushes.iter().skip(1).copied().collect()),
            series: PlainSeries {
                displacements: states,
                velocities: states,
                surfaces: states,
                slip: series,
                scaled: series,
                friction: series,
            },
        };
        for (place, contact) in run.series.contacts.iter().enumerate() {
            vectors.series.set_surface(place, &contact.surface);
        }
        vectors.read_scales(run);
        Some(vectors)
    }

    /// The run to its end, with as many coordinates and contacts as `N` at most.
    #[inline(always)]
    pub(super) fn run<const N: usize>(mut self, run: &mut MotionRun<'_>) -> MotionProgress {
        while !run.is_over() {
            let room = run.prepare()?;
            if self.follows(run) {
                let step = self.step::<N>(run, room);
                run.accept(step, room)?;
            } else {
                self.write_scales(run);
                let step = run.expand(room.longest, room.room);
                self.read_scales(run);
                run.accept(step, room)?;
                self.phases.are_known = false;
            }
        }
        self.write_scales(run);
        Ok(())
    }

    fn read_scales(&mut self, run: &MotionRun<'_>) {
        let (upper, lower) = run.series.scales.split_at(self.equations.coordinates);
        self.scales = [vector(upper), vector(lower)];
    }

    fn write_scales(&self, run: &mut MotionRun<'_>) {
        let (upper, lower) = run.series.scales.split_at_mut(self.equations.coordinates);
        for (scales, out) in self.scales.iter().zip([upper, lower]) {
            write(*scales, out);
        }
    }

    /// Reads what the contacts do now. Whether vectors follow it.
    #[inline(always)]
    fn follows(&mut self, run: &MotionRun<'_>) -> bool {
        if !self.phases.are_known {
            self.phases.set(&run.now);
        }
        if self.holding.refreshed != run.refreshed {
            self.holding.set(run.refreshed, &run.stuck);
        }
        self.phases.is_plain
    }

    /// A step of the run, whose end is in its `scratch`, and whose series are written to it if it is observed or a guard may end it.
    #[inline(always)]
    fn step<const N: usize>(&mut self, run: &mut MotionRun<'_>, room: StepRoom) -> ExpandedStep {
        self.begin(run);
        let StepRoom { longest, room, .. } = room;
        let MotionRun { tolerance, time_scale, .. } = *run;
        let limit = StepLimit { tolerance, time_scale, longest, room };
        let Self { equations, laws, phases, holding, pressed, scales, pushes, series, .. } = self;
        let (phases, holding, pressed) = (&*phases, &*holding, *pressed);
        let length = laws.visit(PlainStep::<V, N> {
            equations,
            phases,
            holding,
            pressed,
            scales,
            pushes,
            series,
            limit,
        });
        let is_clear = series.is_clear(equations, phases, pressed, length);
        if run.watched || !is_clear {
            series.write::<N>(equations, run);
        }
        if let (true, Some((first, others))) = (run.watched, run.series.pushes.split_first_mut()) {
            *first = pushes.0;
            others.copy_from_slice(&pushes.1);
        }
        let reached = if is_clear { None } else { run.guards().first(length) };
        let duration = reached.map_or(length, |reached| reached.after);
        series.end(duration, equations.coordinates, &mut run.scratch);
        self.phases.are_known = reached.is_none() && !self.phases.any_zeros;
        ExpandedStep { duration, reached }
    }

    /// The state at the start, and what varies in time.
    #[inline(always)]
    fn begin(&mut self, run: &MotionRun<'_>) {
        let (upper, lower) = run.series.start().split_at(self.equations.coordinates);
        self.series.displacements[0] = vector(upper);
        self.series.velocities[0] = vector(lower);
        if let Some((first, others)) = run.forcings.pushes.split_first() {
            self.pushes.0 = first.series(run.clock);
            for (series, forcing) in self.pushes.1.iter_mut().zip(others) {
                *series = forcing.series(run.clock);
            }
        }
        if self.surfaces_vary {
            for (place, forcing) in run.forcings.contacts.iter().enumerate() {
                self.series.set_surface(place, &forcing.surface.series(run.clock));
            }
        }
    }
}

/// Writes the first numbers of a vector.
#[inline(always)]
fn write<V: Lane>(numbers: V, out: &mut [f64]) {
    // One by one, because a copy of so few is a call.
    for (place, out) in out.iter_mut().enumerate().take(MOST) {
        *out = numbers.lane(place);
    }
}

impl<V: Lane> PlainSeries<V> {
    #[inline(always)]
    fn set_surface(&mut self, place: usize, surface: &SeriesOf<f64>) {
        for (out, term) in self.surfaces.iter_mut().zip(surface) {
            out.set_lane(place, *term);
        }
    }

    /// The state after a time.
    #[inline(always)]
    fn end(&self, since: f64, coordinates: usize, out: &mut [f64]) {
        let since = V::splat(since);
        let (upper, lower) = out.split_at_mut(coordinates);
        for (states, out) in [&self.displacements, &self.velocities].into_iter().zip([upper, lower])
        {
            let mut end = [V::splat(0.0)];
            horner_states(states, since, &mut end);
            write(end[0], out);
        }
    }

    /// Writes the series to a run.
    #[inline(always)]
    fn write<const N: usize>(&self, equations: &PlainEquations, run: &mut MotionRun<'_>) {
        let (coordinates, states) = (equations.coordinates, &mut run.series.states[..]);
        if coordinates == N {
            let orders = states.as_chunks_mut::<N>().0.as_chunks_mut::<2>().0.iter_mut();
            let known = self.displacements.iter().zip(&self.velocities);
            for ([upper, lower], (displacement, velocity)) in orders.zip(known) {
                *upper = std::array::from_fn(|i| displacement.lane(i));
                *lower = std::array::from_fn(|i| velocity.lane(i));
            }
        } else {
            for (k, states) in states.chunks_exact_mut(2 * coordinates).enumerate() {
                let (upper, lower) = states.split_at_mut(coordinates);
                write(self.displacements[k], upper);
                write(self.velocities[k], lower);
            }
        }
        for place in 0..N {
            let Some(contact) = run.series.contacts.get_mut(place) else { break };
            for k in 0..=ORDER {
                contact.slip[k] = self.slip[k].lane(place);
                contact.scaled[k] = self.scaled[k].lane(place);
                contact.friction[k] = self.friction[k].lane(place);
            }
            if !run.forcings.contacts[place].surface.is_constant() {
                for k in 0..=ORDER {
                    contact.surface[k] = self.surfaces[k].lane(place);
                }
            }
        }
    }
}
