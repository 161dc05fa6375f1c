//! The loop of a run: expand, search the guards, advance, decide.

use quell_model::System;
use quell_model::friction::FrictionConstants;
use quell_numerics::dispatch::{Work, with_fused_multiply_add};

use super::equations::{Equations, Forcings};
use super::guards::{FirstGuard, Guards, Reached};
use super::observer::{MotionEvent, MotionMoment, MotionObserver, MotionSegment, Trigger};
use super::phase::{ContactNow, ContactPhase};
use super::selection::{Moment, first_minor_not_positive};
use super::series::{Expansion, StepLimit, StepSeries};
use super::state::{ContactEnd, MotionEnd, MotionStart};
use super::stopped::{MotionStopped, StopReason};
use super::stuck::{StuckForces, coupling, dependent, independent};
use crate::simulation::{Clock, EventKind, ORDER, StepBudget};

/// Decisions at one moment after which the contacts are held in stick: a jump that releases a contact just made needs two;
/// grazing of a threshold repeats indefinitely.
const PATIENCE: u32 = 4;

/// Time for which contacts are held in stick after grazing, over the time scale of the system.
const HOLD: f64 = 1e-8;

/// Rate of a margin, over its size and the time scale, below which a release counts as nearly tangential.
const NEARLY_TANGENTIAL: f64 = 1e-6;

/// Slip velocities below this multiple of their rounding are zero at the start of a run.
const AT_REST: f64 = 32.0 * f64::EPSILON;

/// Time over the time scale within which a slip velocity is negligible at the start of a run if friction can stop it.
const NEGLIGIBLE: f64 = 1e-13;

/// A load beyond zero by this share of N₀ has jumped there.
const JUMP: f64 = 1e-9;

/// So many events within [`ACCUMULATED`] of the time scale are Zeno behaviour.
const MOST_EVENTS: u64 = 96;

/// Time within which events accumulate, over the time scale.
const ACCUMULATED: f64 = 1e-6;

/// One run.
pub(super) struct MotionRun<'a> {
    system: &'a System,
    equations: &'a Equations,
    forcings: Forcings,
    laws: Vec<FrictionConstants>,
    now: Vec<ContactNow>,
    clock: Clock,
    series: StepSeries,
    stuck: StuckForces,
    /// Whether the sets of sticking contacts have changed since `stuck` was computed.
    is_stale: bool,
    until: f64,
    tolerance: f64,
    longest: f64,
    time_scale: f64,
    budget: StepBudget,
    idle: u32,
    /// Time of the last kink or jump of a forcing.
    last_break: f64,
    events: u64,
    steps: u64,
    near_tangential_releases: u64,
    /// Whether the force of each contact in stick was not unique at some time.
    dependent: Vec<bool>,
    /// Start of the current window of events, and their number in it.
    window: (f64, u64),
    observer: &'a mut dyn MotionObserver,
    watched: bool,
    /// Whether guards end steps; otherwise every contact keeps its phase, whatever its slip velocity and load.
    is_guarded: bool,
    scratch: Vec<f64>,
}

type Progress = Result<(), MotionStopped>;

impl<'a> MotionRun<'a> {
    pub(super) fn new(
        (system, equations): (&'a System, &'a Equations),
        start: &MotionStart,
        until: f64,
        tolerance: f64,
        observer: &'a mut dyn MotionObserver,
    ) -> Self {
        let clock = Clock::at(start.time);
        let forcings = Forcings::of(system, clock);
        let waves = forcings.highest_rate();
        let fastest = equations.rate.max(waves);
        let mut series = StepSeries::new(equations, &forcings, clock);
        series.set_start(&start.state);
        Self {
            laws: system.contacts.iter().map(|c| FrictionConstants::of(&c.friction)).collect(),
            now: vec![ContactNow::of(ContactPhase::Stick); system.contacts.len()],
            clock,
            series,
            stuck: StuckForces::default(),
            is_stale: true,
            until,
            tolerance,
            longest: if waves > 0.0 { 0.5 * ORDER as f64 / waves } else { f64::INFINITY },
            time_scale: 1.0 / fastest,
            budget: StepBudget::new(start.time, until, fastest),
            idle: 0,
            last_break: f64::NEG_INFINITY,
            events: 0,
            steps: 0,
            near_tangential_releases: 0,
            dependent: vec![false; system.contacts.len()],
            window: (start.time, 0),
            watched: observer.watches(),
            is_guarded: true,
            observer,
            scratch: vec![0.0; equations.size],
            forcings,
            system,
            equations,
        }
    }

    /// The contacts keep these phases throughout: the smooth continuation of a motion beyond the borders of its phase.
    pub(super) fn keeping(mut self, phases: &[ContactPhase]) -> Self {
        self.is_guarded = false;
        self.now = phases.iter().map(|phase| ContactNow::of(*phase)).collect();
        self
    }

    /// Runs to the end.
    pub(super) fn run(mut self) -> Result<MotionEnd, MotionStopped> {
        StepBudget::begin().map_err(|why| self.stalled(why))?;
        if self.is_guarded {
            self.begin()?;
        }
        while self.clock.until(self.until) > 0.0 {
            self.step()?;
        }
        // The steps are counted, but a run that has ended is not stopped for them.
        let _ = self.budget.spend(self.steps);
        self.end()
    }

    fn stopped(&self, reason: StopReason) -> MotionStopped {
        let state = self.series.start().to_vec();
        MotionStopped { time: self.clock.time(), state, reason }
    }

    fn stalled(&self, why: &'static str) -> MotionStopped {
        self.stopped(StopReason::Stalled(why))
    }

    fn name(&self, contact: usize) -> String {
        self.system.contacts[contact].name.clone()
    }

    /// Slip velocity of a contact now, and the size of its terms.
    fn slip(&self, contact: usize) -> (f64, f64) {
        let tangent = &self.equations.contacts[contact].tangent;
        let surface = self.forcings.contacts[contact].surface.value(self.clock);
        let state = self.series.start();
        (surface - tangent.dot(state), surface.abs() + tangent.size_at(state))
    }

    /// Load of a contact now, or that it would have if it is open.
    fn load(&self, contact: usize) -> f64 {
        let approach = &self.equations.contacts[contact].approach;
        self.forcings.contacts[contact].load.value(self.clock) + approach.dot(self.series.start())
    }

    /// A slip velocity that friction brings to rest within a time too short to be told from zero.
    fn negligible_slip(&self, contact: usize, load: f64) -> f64 {
        let level = self.equations.contacts[contact].static_coefficient * load;
        let own = self.equations.coupling[(contact, contact)];
        NEGLIGIBLE * self.time_scale * own * level
    }

    /// The contacts at the start of a run: no event.
    fn begin(&mut self) -> Progress {
        let mut resting = Vec::new();
        for contact in 0..self.now.len() {
            let (slip, size) = self.slip(contact);
            let load = self.load(contact);
            let is_compliant = self.equations.contacts[contact].is_compliant();
            if !is_compliant && load <= 0.0 {
                let contact = self.name(contact);
                return Err(self.stopped(StopReason::LoadVanishes { contact }));
            }
            let phase = if load < 0.0 {
                ContactPhase::Open
            } else if self.equations.contacts[contact].can_stick()
                && slip.abs() <= (AT_REST * size).max(self.negligible_slip(contact, load))
            {
                resting.push(contact);
                ContactPhase::Stick
            } else {
                ContactPhase::Slip(if slip > 0.0 { 1 } else { -1 })
            };
            self.now[contact] = ContactNow::of(phase);
        }
        if resting.is_empty() { Ok(()) } else { self.decide(&resting, &[], false) }
    }

    /// One pass of the loop: it advances time or changes contacts.
    fn step(&mut self) -> Progress {
        let before = self.clock;
        self.refresh()?;
        let stop = self.forcings.next_break().min(self.until);
        let room = self.clock.until(stop);
        let holds = self.now.iter().any(|now| now.held);
        let limit = StepLimit {
            tolerance: self.tolerance,
            time_scale: self.time_scale,
            longest: if holds { self.longest.min(HOLD * self.time_scale) } else { self.longest },
            room,
        };
        let length = with_fused_multiply_add(Expansion {
            equations: self.equations,
            forcings: &self.forcings,
            laws: &mut self.laws,
            now: &self.now,
            stuck: &self.stuck,
            clock: self.clock,
            limit,
            out: &mut self.series,
        });
        let reached = if self.is_guarded {
            with_fused_multiply_add(FirstGuard { guards: self.guards(), length })
        } else {
            None
        };
        let duration = reached.map_or(length, |reached| reached.after);
        let triggers = match &reached {
            Some(first) => self.guards().together(first, self.time_scale),
            None => Vec::new(),
        };
        if duration > 0.0 {
            self.advance(duration, room, stop);
        }
        if let Some(first) = reached {
            self.moment(first, &triggers)?;
        }
        self.check_progress(before)
    }

    fn guards(&self) -> Guards<'_> {
        Guards {
            equations: self.equations,
            forcings: &self.forcings,
            now: &self.now,
            contacts: &self.series.contacts,
        }
    }

    /// Computes the forces of the sticking contacts anew where they have changed.
    fn refresh(&mut self) -> Progress {
        let tilted = self.equations.follows && self.now.iter().any(ContactNow::sticks);
        if !(self.is_stale || tilted || self.stuck.is_dependent) {
            return Ok(());
        }
        if self.stuck.is_dependent || self.is_stale {
            self.share_forces();
        }
        let tilts = self.tilts();
        let sticking = || (0..self.now.len()).filter(|c| self.now[*c].sticks()).collect::<Vec<_>>();
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
        self.is_stale = false;
        Ok(())
    }

    /// Lets dependent sticking contacts share their forces: those whose share would exceed its bound stand at it.
    fn share_forces(&mut self) {
        let members: Vec<usize> = (0..self.now.len()).filter(|c| self.now[*c].sticks()).collect();
        for &contact in &members {
            self.now[contact].saturated = 0;
        }
        if members.len() < 2 {
            return;
        }
        let moment = self.moment_of(&members, &[]);
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

    fn tilts(&self) -> Vec<f64> {
        let state = self.series.start();
        self.equations.contacts.iter().map(|contact| contact.slope.dot(state)).collect()
    }

    /// Refuses a set of contacts whose decision is not unique.
    fn check_unique(&self, members: &[usize], tilts: &[f64]) -> Progress {
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
    fn advance(&mut self, duration: f64, room: f64, stop: f64) {
        self.steps += 1;
        if self.watched {
            self.observer.segment(&MotionSegment {
                clock: self.clock,
                duration,
                size: self.equations.size,
                states: &self.series.states,
                contacts: &self.series.contacts,
                now: &self.now,
            });
        }
        with_fused_multiply_add(EndState {
            series: &self.series,
            since: duration,
            out: &mut self.scratch,
        });
        let reaches_stop = duration >= room || self.clock.after(duration).time() == stop;
        if reaches_stop {
            self.last_break = stop;
            self.clock = Clock::at(stop);
            self.forcings.pass_breaks(self.clock);
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
    }

    /// Counts passes without advance, and checks that the run can go on.
    fn check_progress(&mut self, before: Clock) -> Progress {
        self.idle = if self.clock == before { self.idle + 1 } else { 0 };
        if self.idle > 4 * PATIENCE {
            return Err(self.stalled("no step advanced time"));
        }
        if !self.series.start().iter().all(|value| value.is_finite()) {
            return Err(self.stalled("the state left the finite numbers"));
        }
        if self.budget.is_due(self.steps) {
            let time = self.clock.time();
            self.budget.check(self.steps, time).map_err(|why| self.stalled(why))?;
        }
        Ok(())
    }

    /// Decides what follows from guards that have reached zero.
    fn moment(&mut self, first: Reached, triggers: &[Reached]) -> Progress {
        let before: Vec<ContactPhase> = self.now.iter().map(|now| now.phase).collect();
        let mut arrived = Vec::new();
        let mut reached = Vec::new();
        // A load that jumps through zero changes forces at once, which may release others.
        let mut jumped = false;
        for trigger in triggers {
            match trigger.what {
                Trigger::Load(contact) => jumped |= self.open_or_close(contact)?,
                Trigger::Slip(contact) => arrived.push(contact),
                Trigger::Margin(contact, side) => {
                    self.count_tangential(contact, trigger);
                    reached.push((contact, side));
                }
            }
        }
        let open = |contact: &usize| self.now[*contact].is_open();
        arrived.retain(|contact| !open(contact));
        reached.retain(|(contact, _)| !open(contact));
        if jumped || !(arrived.is_empty() && reached.is_empty()) {
            let holds = self.idle >= PATIENCE;
            self.decide(&arrived, &reached, holds)?;
        }
        self.report(&before, first, triggers)
    }

    fn count_tangential(&mut self, contact: usize, trigger: &Reached) {
        let level = self.equations.contacts[contact].static_coefficient * self.load(contact);
        if trigger.after > 0.0 && trigger.rate * self.time_scale < NEARLY_TANGENTIAL * level {
            self.near_tangential_releases += 1;
        }
    }

    /// The load of a contact has reached zero, or jumped through it: whether it jumped.
    fn open_or_close(&mut self, contact: usize) -> Result<bool, MotionStopped> {
        if !self.equations.contacts[contact].is_compliant() {
            let contact = self.name(contact);
            return Err(self.stopped(StopReason::LoadVanishes { contact }));
        }
        self.is_stale = true;
        let phase = if self.now[contact].is_open() {
            ContactPhase::Slip(if self.slip(contact).0 < 0.0 { -1 } else { 1 })
        } else {
            ContactPhase::Open
        };
        let jumped = self.load(contact).abs() > JUMP * self.equations.contacts[contact].normal_load;
        let load_zeros = usize::from(!jumped);
        self.now[contact] = ContactNow { load_zeros, ..ContactNow::of(phase) };
        Ok(jumped)
    }

    /// The contacts at zero slip velocity decide together what they do.
    fn decide(&mut self, arrived: &[usize], reached: &[(usize, i8)], holds: bool) -> Progress {
        let members: Vec<usize> =
            (0..self.now.len()).filter(|c| self.now[*c].sticks() || arrived.contains(c)).collect();
        self.is_stale = true;
        if holds {
            for &contact in &members {
                let load_zeros = self.now[contact].load_zeros;
                let stick = ContactNow::of(ContactPhase::Stick);
                self.now[contact] = ContactNow { held: true, load_zeros, ..stick };
            }
            return Ok(());
        }
        if self.equations.follows {
            self.check_unique(&members, &self.tilts())?;
        }
        let Some(selected) = self.moment_of(&members, reached).decide() else {
            let contacts = members.iter().map(|c| self.name(*c)).collect();
            return Err(self.stopped(StopReason::NotUnique { contacts }));
        };
        for (place, &contact) in members.iter().enumerate() {
            let load_zeros = self.now[contact].load_zeros;
            let direction = selected.directions[place];
            let next = if direction == 0 {
                let stick = ContactNow::of(ContactPhase::Stick);
                ContactNow { saturated: selected.saturated[place], ..stick }
            } else {
                let slip = ContactNow::of(ContactPhase::Slip(direction));
                ContactNow { slip_zeros: if selected.is_smooth[place] { 2 } else { 1 }, ..slip }
            };
            self.now[contact] = ContactNow { load_zeros, ..next };
        }
        Ok(())
    }

    /// The conditions of a decision of some contacts.
    fn moment_of(&self, members: &[usize], reached: &[(usize, i8)]) -> Moment {
        let rates = self.rates_without(members);
        let tilts = self.tilts();
        let matrix = coupling(self.equations, members, &tilts);
        let places: Vec<usize> = (0..members.len()).collect();
        let is_dependent = independent(&matrix, &places).len() < members.len();
        let accelerations = members.iter().map(|&c| {
            let surface = self.forcings.contacts[c].surface.series(self.clock)[1];
            surface - self.equations.contacts[c].tangent.dot(&rates)
        });
        let pressed = |c: usize| self.load(c).max(0.0) * self.factor(c);
        let level = |c: usize, coefficient: f64| coefficient * pressed(c);
        let contacts = &self.equations.contacts;
        Moment {
            accelerations: accelerations.collect(),
            holding: members.iter().map(|&c| level(c, contacts[c].static_coefficient)).collect(),
            sliding: members.iter().map(|&c| level(c, contacts[c].sliding_coefficient)).collect(),
            reached: members
                .iter()
                .map(|c| reached.iter().find(|(at, _)| at == c).map_or(0, |(_, side)| *side))
                .collect(),
            coupling: matrix,
            is_dependent,
        }
    }

    fn factor(&self, contact: usize) -> f64 {
        let factor = &self.forcings.contacts[contact].factor;
        factor.as_ref().map_or(1.0, |factor| factor.value(self.clock))
    }

    /// ẋ now, without the friction of some contacts.
    fn rates_without(&self, members: &[usize]) -> Vec<f64> {
        let state = self.series.start();
        let mut rates = vec![0.0; state.len()];
        self.equations.matrix.times(state, &mut rates);
        for (rate, constant) in rates.iter_mut().zip(&self.equations.constant) {
            *rate += constant;
        }
        for (push, forcing) in self.equations.pushes.iter().zip(&self.forcings.pushes) {
            push.add_to(forcing.value(self.clock), &mut rates);
        }
        for (index, contact) in self.equations.contacts.iter().enumerate() {
            let forcing = &self.forcings.contacts[index];
            let load = if self.now[index].is_open() { 0.0 } else { self.load(index) };
            let carried = contact.normal_load + forcing.guided.value(self.clock);
            contact.across.add_to(carried - load, &mut rates);
            let ContactPhase::Slip(sign) = self.now[index].phase else { continue };
            if members.contains(&index) {
                continue;
            }
            let speed = self.slip(index).0.abs();
            let coefficient = self.system.contacts[index].friction.coefficient(speed);
            let force = f64::from(sign) * coefficient * load * self.factor(index);
            contact.along.add_to(force, &mut rates);
            contact.across.add_to(force * contact.slope.dot(state), &mut rates);
        }
        rates
    }

    /// Reports what has changed, in the order of contacts.
    fn report(
        &mut self,
        before: &[ContactPhase],
        first: Reached,
        triggers: &[Reached],
    ) -> Progress {
        let after: Vec<ContactPhase> = self.now.iter().map(|now| now.phase).collect();
        if after == before {
            return Ok(());
        }
        let state = self.series.start();
        let clock = self.clock;
        self.observer.moment(&MotionMoment {
            clock,
            state,
            before,
            after: &after,
            trigger: first.what,
            rate: first.rate,
            is_jump: first.after == 0.0 && self.last_break == clock.time(),
            is_one_sided: triggers.len() > 1 && !self.stuck.is_dependent,
        });
        let mut last = None;
        for (contact, (was, is)) in before.iter().zip(&after).enumerate() {
            let Some(kind) = kind_of(*was, *is) else { continue };
            self.events += 1;
            last = Some(contact);
            self.observer.event(&MotionEvent {
                time: clock.time(),
                contact,
                kind,
                slip_sign: is.slip_sign(),
                is_smooth: self.now[contact].slip_zeros == 2,
                state: self.series.start(),
            });
        }
        if clock.time() - self.window.0 > ACCUMULATED * self.time_scale {
            self.window = (clock.time(), 0);
        }
        self.window.1 += 1;
        match last {
            Some(contact) if self.window.1 > MOST_EVENTS => {
                let contact = self.name(contact);
                Err(self.stopped(StopReason::Zeno { contact }))
            }
            _ => Ok(()),
        }
    }

    /// The state at the end of the run.
    fn end(mut self) -> Result<MotionEnd, MotionStopped> {
        self.refresh()?;
        let limit = StepLimit {
            tolerance: self.tolerance,
            time_scale: self.time_scale,
            longest: self.longest,
            room: self.time_scale,
        };
        with_fused_multiply_add(Expansion {
            equations: self.equations,
            forcings: &self.forcings,
            laws: &mut self.laws,
            now: &self.now,
            stuck: &self.stuck,
            clock: self.clock,
            limit,
            out: &mut self.series,
        });
        let contacts = self.now.iter().zip(&self.series.contacts).map(|(now, series)| ContactEnd {
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

/// The event between two phases of a contact; `None` where nothing happened.
fn kind_of(was: ContactPhase, is: ContactPhase) -> Option<EventKind> {
    match (was, is) {
        (ContactPhase::Open, ContactPhase::Open) => None,
        (ContactPhase::Open, _) => Some(EventKind::Landing),
        (_, ContactPhase::Open) => Some(EventKind::Separation),
        (ContactPhase::Slip(_), ContactPhase::Stick) => Some(EventKind::Stick),
        (ContactPhase::Stick, ContactPhase::Slip(_)) => Some(EventKind::Release),
        (ContactPhase::Slip(a), ContactPhase::Slip(b)) if a != b => Some(EventKind::Reversal),
        _ => None,
    }
}

struct EndState<'a> {
    series: &'a StepSeries,
    since: f64,
    out: &'a mut [f64],
}

impl Work for EndState<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.series.state_at(self.since, self.out);
    }
}
