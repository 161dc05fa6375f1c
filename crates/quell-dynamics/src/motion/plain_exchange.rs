//! What runs and their vectors exchange: where a step starts and what varies in time, its end, and its series.

use quell_numerics::for_each_order_below_16;
use quell_numerics::lane::Lane;

use super::contact_series::SeriesOf;
use super::engine::{MotionRun, StepRoom};
use super::plain_contacts::{HarmonicPush, MOST_RUNS, PlainVectors};
use super::plain_equations::MOST;
use super::plain_step::{runs_of, set_push, set_run};
use super::series::horner_states;
use crate::simulation::{Forcing, ORDER, harmonic_series};

impl<V: Lane, const N: usize> PlainVectors<V, N> {
    pub(super) fn read_scales(&mut self, number: usize, run: &MotionRun<'_>) {
        let (upper, lower) = run.series.scales.split_at(run.equations.size / 2);
        for at in self.places(number) {
            let first = Self::first_of(at);
            for (scales, known) in self.scales.iter_mut().zip([upper, lower]) {
                set_run::<V, N>(scales, first, known);
            }
        }
    }

    pub(super) fn write_scales(&self, number: usize, run: &mut MotionRun<'_>) {
        let (upper, lower) = run.series.scales.split_at_mut(run.equations.size / 2);
        for (scales, out) in self.scales.iter().zip([upper, lower]) {
            write(*scales, Self::first_of(number), out);
        }
    }

    /// The state at the start, and what varies in time.
    #[inline(always)]
    pub(super) fn begin(&mut self, runs: &[&mut MotionRun<'_>], rooms: &[StepRoom; MOST_RUNS]) {
        let mut states = [[0.0; MOST]; 2];
        let [mut longest, mut ends, mut times, mut lows] = [[0.0; MOST_RUNS]; 4];
        for (number, run) in runs.iter().enumerate().take(MOST_RUNS) {
            let coordinates = run.equations.size / 2;
            let start = run.series.start();
            for at in self.places(number) {
                let first = Self::first_of(at);
                for place in 0..N {
                    if place < coordinates {
                        states[0][first + place] = start[place];
                        states[1][first + place] = start[coordinates + place];
                    }
                }
            }
            (longest[number], ends[number]) = (rooms[number].longest, rooms[number].room);
            (times[number], lows[number]) = (run.clock.time(), run.clock.low());
        }
        self.series.displacements[0] = V::load(&states[0]);
        self.series.velocities[0] = V::load(&states[1]);
        (self.limit.longest, self.limit.room) = (self.of_runs(longest), self.of_runs(ends));
        let (time, low) = (self.of_runs(times), self.of_runs(lows));
        if let Some(HarmonicPush { mean, rate, phase, table }) = &self.harmonic {
            self.pushes.0 = harmonic_series(table, (*rate, *phase), time, low);
            self.pushes.0[0] = self.pushes.0[0] + *mean;
        }
        for (number, run) in runs.iter().enumerate() {
            self.begin_others(number, run);
        }
    }

    /// The forces and surfaces of a run that are not harmonic pushes of all.
    #[inline(always)]
    fn begin_others(&mut self, number: usize, run: &MotionRun<'_>) {
        let varying = |forcing: &Forcing| !forcing.is_constant();
        for (place, forcing) in run.forcings.pushes.iter().enumerate() {
            if (place == 0 && self.harmonic.is_some()) || !varying(forcing) {
                continue;
            }
            let series = forcing.series(run.clock);
            for at in self.places(number) {
                let first = Self::first_of(at);
                let push = match place.checked_sub(1) {
                    None => &mut self.pushes.0,
                    Some(place) => &mut self.pushes.1[place],
                };
                set_push::<V, N>(push, first, &series);
            }
        }
        if self.surfaces_vary {
            for (place, forcing) in run.forcings.contacts.iter().enumerate() {
                let series = forcing.surface.series(run.clock);
                for at in self.places(number) {
                    let first = Self::first_of(at);
                    self.series.set_surface(first + place, &series);
                }
            }
        }
    }

    /// Writes the states after these times.
    #[inline(always)]
    pub(super) fn end(&self, since: V, runs: &mut [&mut MotionRun<'_>]) {
        let [mut upper, mut lower] = [[V::splat(0.0)]; 2];
        horner_states(&self.series.displacements, since, &mut upper);
        horner_states(&self.series.velocities, since, &mut lower);
        for (number, run) in runs.iter_mut().enumerate() {
            let (displacements, velocities) = run.scratch.split_at_mut(run.equations.size / 2);
            write(upper[0], Self::first_of(number), displacements);
            write(lower[0], Self::first_of(number), velocities);
        }
    }

    /// Writes to a run the series that its guards read, and all that observers read if it has one.
    #[inline(always)]
    pub(super) fn write<const RUN: usize>(&self, run: &mut MotionRun<'_>) {
        let first = const { if RUN < runs_of(N) { RUN * N } else { 0 } };
        for place in 0..N {
            let Some(contact) = run.series.contacts.get_mut(place) else { break };
            let lane = first + place;
            contact.slip = series_of_lane(&self.series.slip, lane);
            contact.friction = series_of_lane(&self.series.friction, lane);
        }
        if run.watched {
            self.show::<RUN>(run);
        }
    }

    /// Writes to a run what observers read besides slip and friction.
    #[inline(always)]
    fn show<const RUN: usize>(&self, run: &mut MotionRun<'_>) {
        let first = const { if RUN < runs_of(N) { RUN * N } else { 0 } };
        let coordinates = run.equations.size / 2;
        let states = &mut run.series.states[..];
        let known = self.series.displacements.iter().zip(&self.series.velocities);
        if coordinates == N {
            let orders = states.as_chunks_mut::<N>().0.as_chunks_mut::<2>().0.iter_mut();
            for ([upper, lower], (displacement, velocity)) in orders.zip(known) {
                for i in 0..N {
                    (upper[i], lower[i]) = (displacement.lane(first + i), velocity.lane(first + i));
                }
            }
        } else {
            for (states, (displacement, velocity)) in
                states.chunks_exact_mut(2 * coordinates).zip(known)
            {
                let (upper, lower) = states.split_at_mut(coordinates);
                write(*displacement, first, upper);
                write(*velocity, first, lower);
            }
        }
        for place in 0..N {
            let Some(contact) = run.series.contacts.get_mut(place) else { break };
            let lane = first + place;
            contact.scaled = series_of_lane(&self.series.scaled, lane);
            if !run.forcings.contacts[place].surface.is_constant() {
                for k in 0..=ORDER {
                    contact.surface[k] = self.series.surfaces[k].lane(lane);
                }
            }
        }
        for (place, out) in run.series.pushes.iter_mut().enumerate() {
            let push = if place == 0 { &self.pushes.0 } else { &self.pushes.1[place - 1] };
            *out = series_of_lane(push, first);
        }
    }
}

/// The series of one lane, without a loop.
#[inline(always)]
fn series_of_lane<V: Lane>(series: &SeriesOf<V>, lane: usize) -> SeriesOf<f64> {
    let mut out = [0.0; ORDER + 1];
    const { assert!(ORDER == 16, "unrolled up to order 16") };
    for_each_order_below_16!(K, {
        out[K] = series[K].lane(lane);
    });
    out[ORDER] = series[ORDER].lane(lane);
    out
}

/// Writes the numbers of a vector from a lane on.
#[inline(always)]
fn write<V: Lane>(numbers: V, first: usize, out: &mut [f64]) {
    // One by one, because a copy of so few is a call.
    for (place, out) in out.iter_mut().enumerate().take(MOST - first) {
        *out = numbers.lane(first + place);
    }
}
