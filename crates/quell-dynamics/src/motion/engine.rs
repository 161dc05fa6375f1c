//! The loop of a run: expand, search the guards, advance, decide.

use quell_model::System;
use quell_model::friction::FrictionConstants;

use super::equations::{Forcings, MotionEquations};
use super::expansion::{ExpandedStep, StepExpansion};
use super::few::Few;
use super::guards::Guards;
use super::observer::{MotionObserver, MotionSegment, SegmentSeries};
use super::own_state;
use super::phase::{ContactNow, ContactPhase};
use super::selection::first_minor_not_positive;
use super::series::StepSeries;
use super::state::{ContactEnd, MotionEnd, MotionStart};
use super::step_recurrence::{LEAST_SCALE, StepLimit};
use super::stopped::{MotionStopped, StopReason};
use super::stuck::{StuckForces, coupling, dependent};
use crate::simulation::{Clock, ORDER, StepBudget};

/// Default bound on the last retained terms of a step, relative to the size of each number of the state.
pub const MOTION_TOLERANCE: f64 = 1e-13;

/// Decisions at one moment after which the contacts are held in stick: a jump that releases a contact just made needs two;
/// grazing of a threshold repeats indefinitely.
pub(super) const PATIENCE: u32 = 4;

/// One run.
pub(super) struct MotionRun<'a> {
    pub(super) system: &'a System,
    pub(super) equations: &'a MotionEquations,
    pub(super) forcings: Forcings,
    pub(super) laws: Vec<FrictionConstants>,
    pub(super) now: Vec<ContactNow>,
    pub(super) clock: Clock,
    pub(super) series: StepSeries,
    pub(super) stuck: StuckForces,
    /// Whether the sets of sticking contacts have changed since `stuck` was computed.
    pub(super) is_stale: bool,
    /// How often `stuck` has been computed.
    pub(super) refreshed: u64,
    pub(super) until: f64,
    pub(super) tolerance: f64,
    pub(super) longest: f64,
    pub(super) time_scale: f64,
    pub(super) budget: StepBudget,
    pub(super) idle: u32,
    /// Time of the next kink or jump of a forcing.
    pub(super) next_break: f64,
    /// Time of the last kink or jump of a forcing.
    pub(super) last_break: f64,
    pub(super) events: u64,
    pub(super) steps: u64,
    pub(super) near_tangential_releases: u64,
    /// Whether the force of each contact in stick was not unique at some time.
    pub(super) dependent: Vec<bool>,
    /// Start of the current window of events, and their number in it.
    pub(super) window: (f64, u64),
    pub(super) observer: &'a mut dyn MotionObserver,
    pub(super) watched: bool,
    /// The state at the end of a step.
    pub(super) scratch: Vec<f64>,
}

/// How far the next step may go.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct StepRoom {
    /// The next moment that no step may pass.
    stop: f64,
    /// Time to it.
    pub(super) room: f64,
    /// Longest step.
    pub(super) longest: f64,
}

pub(super) type MotionProgress = Result<(), MotionStopped>;

impl<'a> MotionRun<'a> {
    pub(super) fn new(
        (system, equations): (&'a System, &'a MotionEquations),
        start: &MotionStart,
        until: f64,
        tolerance: f64,
        observer: &'a mut dyn MotionObserver,
    ) -> Self {
        let clock = Clock::at(start.time);
        let forcings = Forcings::of(system, clock);
        let waves = forcings.highest_rate();
        let fastest = equations.rates.of_all.max(waves);
        let mut series = StepSeries::new(equations, &forcings, clock);
        series.set_start(&start.state);
        Self {
            laws: system.contacts.iter().map(|c| own_state::law_of(&c.friction)).collect(),
            now: vec![ContactNow::of(ContactPhase::Stick); system.contacts.len()],
            clock,
            series,
            stuck: StuckForces::default(),
            is_stale: true,
            refreshed: 0,
            until,
            tolerance,
            longest: if waves > 0.0 { 0.5 * ORDER as f64 / waves } else { f64::INFINITY },
            time_scale: 1.0 / fastest,
            budget: StepBudget::new(start.time, until, equations.rates.of_oscillations.max(waves))
                .of_work(equations.matrix.work()),
            idle: 0,
            next_break: forcings.next_break(),
            last_break: f64::NEG_INFINITY,
            events: 0,
            steps: 0,
            near_tangential_releases: 0,
            dependent: vec![false; system.contacts.len()],
            window: (start.time, 0),
            watched: observer.watches(),
            observer,
            scratch: vec![0.0; equations.size],
            forcings,
            system,
            equations,
        }
    }

    /// Contacts with a phase here keep it throughout: the smooth continuation of a motion beyond the borders of these phases.
    pub(super) fn keeping(mut self, phases: &[Option<ContactPhase>]) -> Self {
        for (contact, phase) in phases.iter().enumerate() {
            let Some(phase) = *phase else { continue };
            if self.equations.contacts[contact].own.is_none() {
                self.now[contact] = ContactNow::keeping(phase);
            } else if let ContactPhase::Slip(direction) = phase {
                // A contact with a state of its own has no branch to continue: its phases follow from the state.
                self.begin_sliding(contact, direction);
            }
        }
        self
    }

    /// Decides what the contacts do at the start.
    pub(super) fn open(&mut self) -> MotionProgress {
        StepBudget::begin().map_err(|why| self.stalled(why))?;
        self.begin()
    }

    /// Whether the run has reached its end.
    #[inline(always)]
    pub(super) fn is_over(&self) -> bool {
        let goes_on = self.clock.until(self.until) > 0.0;
        !goes_on
    }

    pub(super) fn stopped(&self, reason: StopReason) -> MotionStopped {
        let state = self.series.start().to_vec();
        MotionStopped { time: self.clock.time(), state, reason }
    }

    fn stalled(&self, why: &'static str) -> MotionStopped {
        self.stopped(StopReason::Stalled(why))
    }

    pub(super) fn name(&self, contact: usize) -> String {
        self.system.contacts[contact].name.clone()
    }

    /// Slip velocity of a contact now, and the size of its terms.
    pub(super) fn slip(&self, contact: usize) -> (f64, f64) {
        let tangent = &self.equations.contacts[contact].tangent;
        let surface = self.forcings.contacts[contact].surface.value(self.clock);
        let state = self.series.start();
        (surface - tangent.dot(state), surface.abs() + tangent.size_at(state))
    }

    /// Load of a contact now, or that it would have if it is open.
    pub(super) fn load(&self, contact: usize) -> f64 {
        let equation = &self.equations.contacts[contact];
        let forcing = &self.forcings.contacts[contact].load;
        let given = if forcing.is_constant() { forcing.mean() } else { forcing.value(self.clock) };
        if !equation.is_compliant() {
            return given;
        }
        given + equation.approach.dot(self.series.start())
    }

    /// One pass of the loop: it advances time or changes contacts.
    pub(super) fn step(&mut self) -> MotionProgress {
        let room = self.prepare()?;
        let expanded = self.expand(room.longest, room.room);
        self.accept(expanded, room)
    }

    /// What the next step needs.
    pub(super) fn prepare(&mut self) -> Result<StepRoom, MotionStopped> {
        self.refresh()?;
        let stop = self.next_break.min(self.until);
        let room = self.clock.until(stop);
        Ok(StepRoom { stop, room, longest: self.longest })
    }

    /// Takes a step whose end is in `scratch`, and whose series are written if it is observed or a guard has been reached.
    pub(super) fn accept(
        &mut self,
        ExpandedStep { duration, reached }: ExpandedStep,
        StepRoom { stop, room, .. }: StepRoom,
    ) -> MotionProgress {
        let before = self.clock;
        let triggers = match &reached {
            Some(first) => self.guards().together(first, self.time_scale),
            None => Few::new(),
        };
        if duration > 0.0 {
            self.advance(duration, room, stop)?;
        }
        if let Some(first) = reached {
            self.moment(first, &triggers)?;
        }
        self.check_progress(before)
    }

    /// Computes a step from here, at most `longest` and `room` long.
    pub(super) fn expand(&mut self, longest: f64, room: f64) -> ExpandedStep {
        self.expand_to(ORDER, longest, room)
    }

    /// Writes the first coefficients of all series: what holds now.
    fn evaluate(&mut self) {
        self.expand_to(0, self.longest, self.time_scale);
    }

    fn expand_to(&mut self, last: usize, longest: f64, room: f64) -> ExpandedStep {
        let Self { tolerance, time_scale, .. } = *self;
        let step = StepExpansion {
            equations: self.equations,
            forcings: &self.forcings,
            laws: &mut self.laws,
            now: &self.now,
            stuck: &self.stuck,
            clock: self.clock,
            limit: StepLimit { tolerance, time_scale, longest, room },
            last,
            out: &mut self.series,
            end: &mut self.scratch,
        };
        step.run()
    }

    #[inline(always)]
    pub(super) fn guards(&self) -> Guards<'_> {
        Guards { equations: self.equations, now: &self.now, contacts: &self.series.contacts }
    }

    /// Computes the forces of the sticking contacts anew where they have changed.
    pub(super) fn refresh(&mut self) -> MotionProgress {
        let tilted = self.equations.follows && self.now.iter().any(ContactNow::sticks);
        if !(self.is_stale || tilted || self.stuck.is_dependent) {
            return Ok(());
        }
        if self.stuck.is_dependent || self.is_stale {
            self.share_forces();
        }
        let tilts = self.tilts();
        let sticking = || (0..self.now.len()).filter(|c| self.now[*c].sticks()).collect::<Few<_>>();
        if tilted {
            let members = sticking();
            self.check_unique(&members, &tilts)?;
        }
        let Some(stuck) = StuckForces::of(self.equations, &self.now, &tilts) else {
            let contacts = sticking().into_iter().map(|c| self.name(c)).collect();
            return Err(self.stopped(StopReason::NotUnique { contacts }));
        };
        if stuck.is_dependent && self.is_stale {
            self.note_dependent(&sticking(), &tilts);
        }
        self.stuck = stuck;
        self.refreshed += 1;
        self.is_stale = false;
        Ok(())
    }

    /// Lets dependent sticking contacts share their forces: those whose share would exceed its bound stand at it.
    fn share_forces(&mut self) {
        let members: Few<usize> = (0..self.now.len()).filter(|c| self.now[*c].sticks()).collect();
        // One that has just reached its bound stays there, although the forces are solved with less accuracy than that of a bound.
        let at_bounds: Few<(usize, i8)> =
            members.iter().map(|contact| (*contact, self.now[*contact].saturated)).collect();
        for &contact in &members {
            self.now[contact].saturated = 0;
        }
        if members.len() < 2 || self.are_apart(&members) {
            return;
        }
        let moment = self.moment_of(&members, &at_bounds);
        if !moment.is_dependent {
            return;
        }
        if let Some(selected) = moment.decide() {
            for (place, contact) in members.iter().enumerate() {
                self.now[*contact].saturated = selected.saturated[place];
            }
        }
    }

    fn note_dependent(&mut self, sticking: &[usize], tilts: &[f64]) {
        for place in dependent(&coupling(self.equations, sticking, tilts)) {
            self.dependent[sticking[place]] = true;
        }
    }

    pub(super) fn tilts(&self) -> Few<f64> {
        let contacts = &self.equations.contacts;
        if !self.equations.follows {
            return Few::from_elem(0.0, contacts.len());
        }
        let state = self.series.start();
        contacts.iter().map(|contact| contact.slope.dot(state)).collect()
    }

    /// Refuses a set of contacts whose decision is not unique.
    pub(super) fn check_unique(&self, members: &[usize], tilts: &[f64]) -> MotionProgress {
        let matrix = coupling(self.equations, members, tilts);
        match first_minor_not_positive(&matrix) {
            None => Ok(()),
            Some(set) => {
                let contacts = set.into_iter().map(|place| self.name(members[place])).collect();
                Err(self.stopped(StopReason::NotUnique { contacts }))
            }
        }
    }

    /// Advances by `duration`, exactly to the stop if it is reached.
    fn advance(&mut self, duration: f64, room: f64, stop: f64) -> MotionProgress {
        let mut is_finite = true;
        for value in &mut self.scratch {
            is_finite &= value.is_finite();
            if value.abs() < LEAST_SCALE {
                *value = 0.0;
            }
        }
        if !is_finite {
            // The last finite state, and its time.
            return Err(self.stalled("the state leaves the finite numbers in the next step"));
        }
        self.steps += 1;
        if self.watched {
            self.observer.segment(&MotionSegment {
                clock: self.clock,
                duration,
                size: self.equations.size,
                series: SegmentSeries::Known {
                    states: &self.series.states,
                    contacts: &self.series.contacts,
                    pushes: &self.series.pushes,
                },
                now: &self.now,
            });
        }
        let reaches_stop = duration >= room || self.clock.after(duration).time() == stop;
        if reaches_stop {
            self.last_break = stop;
            self.clock = Clock::at(stop);
            self.forcings.pass_breaks(self.clock);
            self.next_break = self.forcings.next_break();
        } else {
            self.clock = self.clock.after(duration);
        }
        for now in &mut self.now {
            now.advanced();
        }
        if !self.stuck.is_empty() {
            let (forcings, clock) = (&self.forcings, self.clock);
            let surface = |contact: usize| forcings.contacts[contact].surface.value(clock);
            self.stuck.project(self.equations, surface, &mut self.scratch);
        }
        self.series.set_start(&self.scratch);
        Ok(())
    }

    /// Counts passes without advance, and checks that the run can go on.
    fn check_progress(&mut self, before: Clock) -> MotionProgress {
        self.idle = if self.clock == before { self.idle + 1 } else { 0 };
        if self.idle > 4 * PATIENCE {
            return Err(self.stalled("no step advanced time"));
        }
        if self.budget.is_due(self.steps) {
            let time = self.clock.time();
            self.budget.check(self.steps, time).map_err(|why| self.stalled(why))?;
        }
        Ok(())
    }

    /// The state at the end of the run.
    pub(super) fn end(mut self) -> Result<MotionEnd, MotionStopped> {
        // The steps are counted, but a run that has ended is not stopped for them.
        let _ = self.budget.spend(self.steps);
        self.refresh()?;
        self.evaluate();
        self.keep_carried();
        let bristle = |contact: usize| {
            let own = self.equations.contacts[contact].own?;
            own.is_bristle().then(|| self.series.start()[own.place])
        };
        let ends = self.now.iter().zip(&self.series.contacts).enumerate();
        let contacts = ends.map(|(contact, (now, series))| ContactEnd {
            bristle: bristle(contact),
            phase: now.phase,
            slip_velocity: series.slip[0],
            friction: series.friction[0],
            normal_load: if now.is_open() { 0.0 } else { series.load[0] },
        });
        Ok(MotionEnd {
            time: self.clock.time(),
            contacts: contacts.collect(),
            state: self.series.start().to_vec(),
            events: self.events,
            steps: self.steps,
            near_tangential_releases: self.near_tangential_releases,
            dependent: (0..self.dependent.len()).filter(|c| self.dependent[*c]).collect(),
        })
    }
}
