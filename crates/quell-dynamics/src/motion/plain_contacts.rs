//! The steps of runs whose systems have few coordinates and plain contacts: the coordinates of a run side by side in one vector, its
//! contacts in another, whichever of them slip or stick. Two runs of up to two coordinates and two contacts share the vectors; one that
//! is alone stands in them twice.
//!
//! The equations are those of `step_recurrence` for such a system, with every operation on every number in the same order: a step has
//! the same bits here and there, alone and next to any other run, so that a run may change from one to the other at any step, and
//! machines without vectors of four numbers take the other for all.

use std::ops::Range;

use quell_model::friction::{Friction, FrictionConstants};
use quell_numerics::lane::Lane;

use super::contact_series::SeriesOf;
use super::engine::{MotionProgress, MotionRun, StepRoom};
use super::expansion::ExpandedStep;
use super::phase::ContactNow;
use super::plain_equations::{MOST, PlainEquations};
use super::plain_step::{
    PlainNumbers, PlainPhases, PlainSeries, PlainStep, PushSeries, runs_of, set_push,
};
use super::step_recurrence::StepLimit;
use crate::simulation::ORDER;

/// Most runs in the vectors.
pub(super) const MOST_RUNS: usize = 2;

/// What is known of a run in its lanes.
#[derive(Clone, Copy, Debug, Default)]
struct RunInLanes {
    /// Whether its phases are those of the coming step.
    are_known: bool,
    /// Whether a slip velocity is zero at the start.
    any_zeros: bool,
    /// Whether vectors follow: no contact keeps its phase beyond a border or stands at its bound.
    is_plain: bool,
    /// Of the forces of its sticking contacts which [`MotionRun::refreshed`].
    refreshed: u64,
}

/// The first force of all runs, if each is one harmonic wave.
pub(super) struct HarmonicPush<V> {
    pub(super) mean: V,
    pub(super) rate: V,
    pub(super) phase: V,
    pub(super) table: SeriesOf<V>,
}

/// Runs in vectors: their numbers, and the series of their last step.
pub(super) struct PlainVectors<V: Lane, const N: usize> {
    /// Number of runs.
    count: usize,
    numbers: PlainNumbers<V>,
    /// The laws of all lanes, and their constants.
    laws: Vec<Friction>,
    constants: FrictionConstants<V>,
    phases: PlainPhases,
    runs: [RunInLanes; MOST_RUNS],
    pub(super) surfaces_vary: bool,
    pub(super) harmonic: Option<HarmonicPush<V>>,
    pub(super) limit: StepLimit<V>,
    /// Scales of displacements and velocities.
    pub(super) scales: [V; 2],
    pub(super) pushes: PushSeries<V>,
    pub(super) series: PlainSeries<V>,
}

/// The equations of a run in vectors; `None` if its loads vary.
pub(super) fn plain_of<'a>(run: &MotionRun<'a>) -> Option<&'a PlainEquations> {
    let plain = run.equations.plain.as_ref()?;
    let mut contacts = run.equations.contacts.iter().zip(&run.forcings.contacts);
    contacts.all(|(contact, forcing)| contact.is_plain(forcing)).then_some(plain)
}

impl<V: Lane, const N: usize> PlainVectors<V, N> {
    /// First lane of a run.
    pub(super) const fn first_of(run: usize) -> usize {
        run * N
    }

    /// The lanes in which a run stands, as numbers of runs: all where it is alone.
    #[inline(always)]
    pub(super) fn places(&self, run: usize) -> Range<usize> {
        if self.count == 1 { 0..runs_of(N) } else { run..run + 1 }
    }

    /// The lanes in which a run stands.
    #[inline(always)]
    fn lanes(&self, run: usize) -> Range<usize> {
        let places = self.places(run);
        Self::first_of(places.start)..Self::first_of(places.end)
    }

    /// A number of each run, in all of its lanes.
    #[inline(always)]
    pub(super) fn of_runs(&self, numbers: [f64; MOST_RUNS]) -> V {
        let [first, second] = numbers;
        if const { N == MOST } || self.count == 1 {
            return V::splat(first);
        }
        V::load(&[first, first, second, second])
    }

    /// Of one or two runs with equations; `None` if their laws differ in more than numbers.
    pub(super) fn of(runs: &[&mut MotionRun<'_>]) -> Option<Self> {
        let equations: Vec<&PlainEquations> =
            runs.iter().map(|run| plain_of(run)).collect::<Option<_>>()?;
        let zero = V::splat(0.0);
        let (states, series) = ([zero; ORDER + 2], [zero; ORDER + 1]);
        let others = equations.first()?.pushes.1.len();
        let run_of = |lane: usize| &*runs[(lane / N).min(runs.len() - 1)];
        let laws: Vec<Friction> =
            (0..V::LANES).map(|lane| law_at(run_of(lane), lane % N)).collect();
        let mut vectors = Self {
            count: runs.len(),
            numbers: PlainNumbers::zeros(others),
            constants: FrictionConstants::side_by_side(&laws)?,
            laws,
            phases: PlainPhases::none(),
            runs: [RunInLanes::default(); MOST_RUNS],
            surfaces_vary: false,
            harmonic: None,
            limit: StepLimit { tolerance: zero, time_scale: zero, longest: zero, room: zero },
            scales: [zero; 2],
            pushes: (series, vec![series; others]),
            series: PlainSeries {
                displacements: states,
                velocities: states,
                surfaces: states,
                slip: series,
                scaled: series,
                friction: series,
            },
        };
        for (number, (run, equations)) in runs.iter().zip(equations).enumerate() {
            vectors.admit(number, run, equations);
        }
        vectors.harmonic = vectors.harmonic_push(runs);
        Some(vectors)
    }

    /// Puts a run in the place of one that has ended; `None` if it does not suit the other.
    pub(super) fn replace(&mut self, number: usize, runs: &[&mut MotionRun<'_>]) -> Option<()> {
        let run = &*runs[number];
        let equations = plain_of(run)?;
        let first = Self::first_of(number);
        let is_new = |place: &usize| self.laws[first + place] != law_at(run, *place);
        if (0..N).any(|place| is_new(&place)) {
            for place in 0..N {
                self.laws[first + place] = law_at(run, place);
            }
            self.constants = FrictionConstants::side_by_side(&self.laws)?;
        }
        self.runs[number] = RunInLanes::default();
        self.admit(number, run, equations);
        self.harmonic = self.harmonic_push(runs);
        Some(())
    }

    /// Writes the numbers of a run.
    fn admit(&mut self, number: usize, run: &MotionRun<'_>, equations: &PlainEquations) {
        let surfaces = run.forcings.contacts.iter().map(|forcing| &forcing.surface);
        self.surfaces_vary |= surfaces.into_iter().any(|surface| !surface.is_constant());
        for at in self.places(number) {
            let first = Self::first_of(at);
            self.numbers.set::<N>(first, equations);
            for (place, contact) in run.series.contacts.iter().enumerate() {
                self.numbers.pressed.set_lane(first + place, contact.pressed[0]);
                self.series.set_surface(first + place, &contact.surface);
            }
            for place in 0..N {
                self.limit.tolerance.set_lane(first + place, run.tolerance);
                self.limit.time_scale.set_lane(first + place, run.time_scale);
            }
            let pushes = std::iter::once(&mut self.pushes.0).chain(&mut self.pushes.1);
            for (series, forcing) in pushes.zip(&run.forcings.pushes) {
                if forcing.is_constant() {
                    set_push::<V, N>(series, first, &forcing.series(run.clock));
                }
            }
        }
        self.read_scales(number, run);
    }

    /// The waves of the first force, if every run has one.
    fn harmonic_push(&self, runs: &[&mut MotionRun<'_>]) -> Option<HarmonicPush<V>> {
        let zero = V::splat(0.0);
        let mut push =
            HarmonicPush { mean: zero, rate: zero, phase: zero, table: [zero; ORDER + 1] };
        for (number, run) in runs.iter().enumerate() {
            let forcing = run.forcings.pushes.first().filter(|forcing| forcing.is_harmonic())?;
            let (rate, phase, table) = forcing.wave();
            for lane in self.lanes(number) {
                push.mean.set_lane(lane, forcing.mean());
                push.rate.set_lane(lane, rate);
                push.phase.set_lane(lane, phase);
                for (row, entry) in push.table.iter_mut().zip(table) {
                    row.set_lane(lane, entry);
                }
            }
        }
        Some(push)
    }

    /// Takes steps until a run is over or stops: how those ended that did.
    #[inline(always)]
    pub(super) fn advance(
        &mut self,
        runs: &mut [&mut MotionRun<'_>],
    ) -> [Option<MotionProgress>; MOST_RUNS] {
        let mut ended = [None, None];
        let mut goes_on = true;
        while goes_on {
            let mut rooms = [StepRoom::default(); MOST_RUNS];
            for (number, run) in runs.iter_mut().enumerate().take(MOST_RUNS) {
                if run.is_over() {
                    (ended[number], goes_on) = (Some(Ok(())), false);
                    continue;
                }
                match run.prepare() {
                    Ok(room) => rooms[number] = room,
                    Err(why) => (ended[number], goes_on) = (Some(Err(why)), false),
                }
            }
            if !goes_on {
                break;
            }
            if self.follow(runs) {
                let steps = self.step(runs, &rooms);
                for (number, run) in runs.iter_mut().enumerate().take(MOST_RUNS) {
                    if let Err(why) = run.accept(steps[number], rooms[number]) {
                        (ended[number], goes_on) = (Some(Err(why)), false);
                    }
                }
                continue;
            }
            // The others wait.
            for (number, run) in runs.iter_mut().enumerate() {
                if self.runs[number].is_plain {
                    continue;
                }
                if let Err(why) = self.step_alone(number, run, rooms[number]) {
                    (ended[number], goes_on) = (Some(Err(why)), false);
                }
            }
        }
        for (number, run) in runs.iter_mut().enumerate() {
            self.write_scales(number, run);
        }
        ended
    }

    /// A step of one run by the equations of any system.
    fn step_alone(
        &mut self,
        number: usize,
        run: &mut MotionRun<'_>,
        room: StepRoom,
    ) -> MotionProgress {
        self.write_scales(number, run);
        let step = run.expand(room.longest, room.room);
        self.read_scales(number, run);
        self.runs[number].are_known = false;
        run.accept(step, room)
    }

    /// Reads what the contacts of every run do now. Whether vectors follow all of them.
    #[inline(always)]
    fn follow(&mut self, runs: &[&mut MotionRun<'_>]) -> bool {
        let mut changed = false;
        for (number, run) in runs.iter().enumerate() {
            if !self.runs[number].are_known {
                let leaves = |now: &ContactNow| now.is_open() || now.kept || now.saturated != 0;
                self.runs[number].are_known = true;
                self.runs[number].any_zeros = run.now.iter().any(|now| now.slip_zeros > 0);
                self.runs[number].is_plain = !run.now.iter().any(leaves);
                for at in self.places(number) {
                    let first = Self::first_of(at);
                    self.phases.set::<N>(first, &run.now);
                }
                changed = true;
            }
            if self.runs[number].refreshed != run.refreshed {
                self.runs[number].refreshed = run.refreshed;
                for at in self.places(number) {
                    let first = Self::first_of(at);
                    self.numbers.hold::<N>(first, &run.stuck);
                }
            }
        }
        if changed {
            self.phases.combine::<N>();
        }
        let mut all = true;
        for known in &self.runs[..self.count] {
            all &= known.is_plain;
        }
        all
    }

    /// A step of every run, whose end is in its `scratch`, and whose series are written to it if it is observed or a guard may end it.
    #[inline(always)]
    fn step(
        &mut self,
        runs: &mut [&mut MotionRun<'_>],
        rooms: &[StepRoom; MOST_RUNS],
    ) -> [ExpandedStep; MOST_RUNS] {
        self.begin(runs, rooms);
        let Self { numbers, constants, phases, scales, pushes, series, limit, .. } = self;
        let (numbers, phases, limit) = (&*numbers, &*phases, *limit);
        let length =
            constants.visit(PlainStep::<V, N> { numbers, phases, scales, pushes, series, limit });
        let is_alone = const { N < MOST } && self.count == 1;
        let doubts = self.series.doubts(&self.numbers, &self.phases, (length, is_alone));
        let is_clear = !doubts.any_positive();
        let mut steps = [ExpandedStep { duration: 0.0, reached: None }; MOST_RUNS];
        let mut durations = length;
        for (number, run) in runs.iter_mut().enumerate() {
            let step = self.ended(number, run, (is_clear, doubts, length));
            if step.reached.is_some() {
                for lane in self.lanes(number) {
                    durations.set_lane(lane, step.duration);
                }
            }
            steps[number] = step;
        }
        self.end(durations, runs);
        steps
    }

    /// The length of the step of a run, up to the first guard that reaches zero.
    #[inline(always)]
    fn ended(
        &mut self,
        number: usize,
        run: &mut MotionRun<'_>,
        (all_clear, doubts, length): (bool, V, V),
    ) -> ExpandedStep {
        let length = length.lane(Self::first_of(number));
        let mut is_clear = true;
        if !all_clear {
            for lane in self.lanes(number) {
                is_clear &= doubts.lane(lane) <= 0.0;
            }
        }
        if run.watched || !is_clear {
            // By the place of the run at compile time, so that each number is read by one instruction.
            if number == 0 { self.write::<0>(run) } else { self.write::<1>(run) }
        }
        let may = |contact: usize| {
            let mut may = false;
            for at in self.places(number) {
                may |= doubts.lane(Self::first_of(at) + contact) > 0.0;
            }
            may
        };
        let reached = if is_clear { None } else { run.guards().first_among(may, length) };
        let known = &mut self.runs[number];
        known.are_known = reached.is_none() && !known.any_zeros;
        ExpandedStep { duration: reached.map_or(length, |reached| reached.after), reached }
    }
}

/// The law of the contact of a run at a place, or of its last contact.
fn law_at(run: &MotionRun<'_>, place: usize) -> Friction {
    let contacts = &run.system.contacts;
    contacts[place.min(contacts.len() - 1)].friction.clone()
}
