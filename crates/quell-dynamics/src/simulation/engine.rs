//! One run: everything between its slip steps.
//!
//! The slip steps themselves are taken by [`super::lanes`], for one run or for many side by
//! side. An [`Engine`] provides the start and the limit of each step and accepts its end.
//!
//! Progress is guaranteed: every pass of the loop advances time or changes the contact at
//! the same moment, and after [`PATIENCE`] changes without advance the contact is held in stick for
//! [`HOLD`] of a dither period. A release that only grazes its threshold therefore cannot
//! loop indefinitely; the held time is below every tolerance in use. How far a pass advances time is a separate
//! matter: [`super::step_budget`] limits the steps.

use quell_model::Direction;
use quell_numerics::dispatch::{InstructionSet, Work, with_scalar_of};
use quell_numerics::lane::horner;
use quell_numerics::polynomial::first_crossing_after;

use super::clock::Clock;
use super::event::EventKind;
use super::forcing::{Forcing, ForcingShape};
use super::observer::{Observer, Segment};
use super::release::Release;
use super::run::{RunTerms, SimulationRun};
use super::run_state::{ContactState, PATIENCE, RunState};
use super::slip_step::{Next, SlipDue, SlipTaken, StepRoot};
use super::state::{FinalState, Stalled};
use super::step_budget::StepBudget;
use super::stick::{StickSearch, Stiction};
use super::taylor::ORDER;

/// Time for which the contact is held in stick after grazing, in units of 1/max(1, R).
const HOLD: f64 = 1e-8;

/// Guaranteed stick shorter than this is left to the search.
const WORTH_SKIPPING: f64 = 1e-3;

/// A sixteenth of the rounding unit of a number, relative to it: smaller terms do not change the number.
const INVISIBLE: f64 = f64::EPSILON / 16.0;

/// One run: its constants, its forcing and its state. Lengths are in units of the law's velocity scale.
pub(super) struct Engine<'a> {
    /// 2ζ.
    pub(super) damping: f64,
    pub(super) stiction: Stiction,
    /// The closed form of a release, where one exists.
    release: Option<Release>,
    pub(super) tangential: Forcing,
    pub(super) normal: Forcing,
    /// Tolerance in units of the velocity scale.
    pub(super) tolerance: f64,
    /// Length unit: the law's velocity scale.
    pub(super) unit: f64,
    /// v₀, not in `unit`.
    pub(super) belt_velocity: f64,
    /// ORDER/2 radians of the fastest oscillation.
    pub(super) longest_step: f64,
    pub(super) until: f64,
    pub(super) smooth_release: bool,
    /// Whether slip goes on through v_r = 0 on its branch.
    pub(super) keeps_branch: bool,
    /// Everything about the run that changes between events.
    pub(super) state: RunState,
    budget: StepBudget,
    pub(super) observer: &'a mut dyn Observer,
    /// Whether the observer receives segments.
    pub(super) watched: bool,
}

impl<'a> Engine<'a> {
    #[inline(never)]
    pub(super) fn new(run: SimulationRun<'a>, terms: RunTerms) -> Self {
        let SimulationRun { belt, start, until, observer } = run;
        let law = belt.friction();
        let unit = law.velocity_scale();
        let clock = Clock::at(start.time);
        let belt_velocity = belt.belt_velocity() / unit;
        let damping = 2.0 * belt.damping_ratio();
        let slip = (belt.belt_velocity() - start.velocity) / unit;
        let (tangential, normal) = Forcing::acting(belt, unit, clock);
        let stiction = Stiction {
            damper: damping * belt_velocity,
            belt_velocity,
            static_coefficient: law.static_coefficient(),
        };
        let fastest = tangential.highest_rate().max(normal.highest_rate());
        let budget = StepBudget::new(start.time, until, fastest);
        let shapes = [Direction::Tangential, Direction::Normal]
            .map(|direction| ForcingShape::of(belt.dithers(), direction));
        let mut engine = Self {
            damping,
            stiction,
            release: Release::of(&stiction, (&tangential, &normal), (shapes[0], shapes[1])),
            longest_step: longest_step(&tangential, &normal),
            tolerance: step_tolerance(
                terms.tolerance,
                (&tangential, &normal),
                start.displacement / unit,
                slip,
            ),
            tangential,
            normal,
            unit,
            belt_velocity: belt.belt_velocity(),
            until,
            smooth_release: law.starts_at_static_level(),
            keeps_branch: terms.branch.is_some(),
            state: RunState::new(clock, start.displacement / unit, slip),
            budget,
            watched: observer.watches(),
            observer,
        };
        if let Some(sign) = terms.branch {
            engine.state.contact = ContactState::Slip { sign, zeros: 0 };
        } else if slip == 0.0 {
            engine.state.contact = engine.decided();
        }
        engine
    }

    /// Continues through stick until a slip step is due or the run is over.
    ///
    /// This and [`Engine::accept`] are compiled once per scalar instruction set and called, rather than
    /// inlined into the loop of every law and lane type.
    pub(super) fn next(&mut self, set: InstructionSet) -> Next {
        with_scalar_of(set, Proceed(self))
    }

    #[inline(always)]
    fn proceed(&mut self) -> Next {
        if self.state.steps == 0
            && let Err(why) = StepBudget::begin()
        {
            return Next::Over(Err(self.stalled(why)));
        }
        while self.state.clock.until(self.until) > 0.0 {
            match self.state.contact {
                ContactState::Slip { sign, zeros } => return self.slip(sign, zeros),
                ContactState::Stick { held } => {
                    let before = self.state.clock;
                    self.stick_interval(held);
                    if let Err(stalled) = self.check_progress(before) {
                        return Next::Over(Err(stalled));
                    }
                }
            }
        }
        // The steps are counted, but a run that has ended is not stopped for them.
        let _ = self.budget.spend(self.state.steps);
        Next::Over(Ok(self.final_state()))
    }

    /// The slip step that is due.
    #[inline(always)]
    fn slip(&self, sign: f64, zeros: usize) -> Next {
        Next::Slip(SlipDue { sign, zeros, stop: self.next_stop() })
    }

    /// Counts passes of the loop without advance.
    #[inline(always)]
    fn check_progress(&mut self, before: Clock) -> Result<(), Stalled> {
        self.state.idle = if self.state.clock == before { self.state.idle + 1 } else { 0 };
        if self.state.idle > 4 * PATIENCE {
            return Err(self.stalled("no step advanced time"));
        }
        if !(self.state.displacement.is_finite() && self.state.slip.is_finite()) {
            return Err(self.stalled("the state left the finite numbers"));
        }
        if self.budget.is_due(self.state.steps) {
            let time = self.state.clock.time();
            return self.budget.check(self.state.steps, time).map_err(|why| self.stalled(why));
        }
        Ok(())
    }

    /// Checks the step budget while a lane takes steps without the engine: `steps` more than the state counts, up to the
    /// moment `time`.
    pub(super) fn check_budget(&mut self, steps: u64, time: f64) -> Result<(), Stalled> {
        let steps = self.state.steps + steps;
        if !self.budget.is_due(steps) {
            return Ok(());
        }
        self.budget.check(steps, time).map_err(|why| Stalled { time, ..self.stalled(why) })
    }

    fn stalled(&self, why: &'static str) -> Stalled {
        Stalled {
            time: self.state.clock.time(),
            displacement: self.unit * self.state.displacement,
            velocity: self.belt_velocity - self.unit * self.state.slip,
            why,
        }
    }

    fn final_state(&self) -> FinalState {
        FinalState {
            time: self.state.clock.time(),
            displacement: self.unit * self.state.displacement,
            velocity: self.belt_velocity - self.unit * self.state.slip,
            sticking: matches!(self.state.contact, ContactState::Stick { .. }),
            slip_sign: self.state.slip_sign(),
            events: self.state.events,
            steps: self.state.steps,
            near_tangential_releases: self.state.near_tangential_releases,
        }
    }

    /// The next moment that no step may pass: the end of the run, a kink or a jump.
    #[inline(always)]
    fn next_stop(&self) -> f64 {
        let stop = self.tangential.next_break();
        let other = self.normal.next_break();
        let stop = if other < stop { other } else { stop };
        if self.until < stop { self.until } else { stop }
    }

    #[inline(always)]
    fn pass_breaks(&mut self) {
        self.tangential.pass_breaks(self.state.clock);
        self.normal.pass_breaks(self.state.clock);
        self.state.at_break = true;
    }

    /// Accepts a slip step from the kernel and continues as [`Engine::next`].
    pub(super) fn accept(
        &mut self,
        set: InstructionSet,
        due: SlipDue,
        taken: &SlipTaken<'_>,
    ) -> Next {
        with_scalar_of(set, Accept { engine: self, set, due, taken })
    }

    /// Accepts a slip step, cut at the first root of v_r.
    ///
    /// # Errors
    /// [`Stalled`] where time does not advance or the state is not finite.
    #[inline(always)]
    fn accept_step(&mut self, due: SlipDue, taken: &SlipTaken<'_>) -> Result<(), Stalled> {
        let before = self.state.clock;
        let SlipDue { sign, zeros, stop } = due;
        let room = self.state.clock.until(stop);
        if zeros > 0 && taken.slip.coefficient(zeros) * sign <= 0.0 {
            // The zero is of higher order than its cause allows: rounding at a grazing contact. The
            // slip that was requested has no length.
            self.state.contact = ContactState::Stick { held: true };
            self.report(EventKind::Stick, false);
            return self.check_progress(before);
        }
        let (root, displacement) = match taken.root {
            StepRoot::None => (None, taken.end.0),
            StepRoot::At(root) => (Some(root), taken.end.0),
            StepRoot::Unknown => {
                let root = first_crossing_after(&taken.slip.gathered(), zeros, taken.length);
                let end = root.map(|root| horner(&taken.displacement.gathered(), root));
                (root, end.unwrap_or(taken.end.0))
            }
        };
        let duration = root.unwrap_or(taken.length);
        if self.watched {
            self.observer.segment(&Segment {
                clock: self.state.clock,
                duration,
                slip_sign: if sign > 0.0 { 1 } else { -1 },
                unit: self.unit,
                belt_velocity: self.belt_velocity,
                displacement: &taken.displacement.gathered(),
                slip: &taken.slip.gathered(),
            });
        }
        self.state.displacement = displacement;
        self.state.slip = if root.is_some() { 0.0 } else { taken.end.1 };
        self.state.contact = ContactState::Slip { sign, zeros: 0 };
        self.advance(duration, room, stop);
        if root.is_some() {
            self.arrive(sign);
        }
        self.check_progress(before)
    }

    /// Advances the clock by a segment, exactly to the stop if it is reached, which is `room` away.
    #[inline(always)]
    fn advance(&mut self, duration: f64, room: f64, stop: f64) {
        let later = self.state.clock.after(duration);
        self.state.steps += 1;
        self.state.at_break = false;
        if duration >= room || later.time() == stop {
            self.state.clock = Clock::at(stop);
            self.pass_breaks();
        } else {
            self.state.clock = later;
        }
    }

    /// One interval of stick, up to the release or the next stop.
    #[inline(always)]
    fn stick_interval(&mut self, held: bool) {
        let stop = self.next_stop();
        let room = self.state.clock.until(stop);
        if held {
            let rate = self.tangential.highest_rate().max(self.normal.highest_rate());
            self.stay(room.min(HOLD / rate.max(1.0)), stop, room);
            self.state.contact = ContactState::Stick { held: false };
            return;
        }
        if let Some(release) = &self.release {
            let search =
                release.search(&self.stiction, self.state.clock, self.state.displacement, room);
            self.end_of_stick(search, stop, room);
            return;
        }
        let sure =
            self.stiction.guaranteed_stick(self.state.displacement, &self.tangential, &self.normal);
        if sure > WORTH_SKIPPING {
            // Breaks of the dither inside are skipped: none of them can release the contact.
            let room = self.state.clock.until(self.until);
            self.stay(sure.min(room), self.until, room);
            self.pass_breaks();
            self.state.at_break = false;
            return;
        }
        let search = self.stiction.search(
            self.state.clock,
            self.state.displacement,
            room,
            self.tolerance,
            &self.tangential,
            &self.normal,
        );
        self.end_of_stick(search, stop, room);
    }

    /// Moves with the belt to the release, or to the end of the interval.
    #[inline(always)]
    fn end_of_stick(&mut self, search: StickSearch, stop: f64, room: f64) {
        match search {
            StickSearch::Holds(length) => self.stay(length, stop, room),
            StickSearch::Releases { after, sign, rate, at_once } => {
                let jumped = at_once && self.state.at_break;
                self.stay(after, stop, room);
                self.release(sign, rate, jumped);
            }
        }
    }

    /// Moves with the belt for `duration`.
    #[inline(always)]
    fn stay(&mut self, duration: f64, stop: f64, room: f64) {
        if duration <= 0.0 {
            return;
        }
        if self.watched {
            self.observer.segment(&Segment {
                clock: self.state.clock,
                duration,
                slip_sign: 0,
                unit: self.unit,
                belt_velocity: self.belt_velocity,
                displacement: &[self.state.displacement, self.stiction.belt_velocity],
                slip: &[0.0],
            });
        }
        self.state.displacement =
            f64::mul_add(self.stiction.belt_velocity, duration, self.state.displacement);
        self.advance(duration, room, stop);
    }
}

/// [`Engine::next`] as work.
struct Proceed<'e, 'a>(&'e mut Engine<'a>);

impl Work for Proceed<'_, '_> {
    type Output = Next;

    #[inline(always)]
    fn run(self) -> Next {
        self.0.proceed()
    }
}

/// [`Engine::accept`] as work.
struct Accept<'e, 'a, 's> {
    engine: &'e mut Engine<'a>,
    set: InstructionSet,
    due: SlipDue,
    taken: &'e SlipTaken<'s>,
}

impl Work for Accept<'_, '_, '_> {
    type Output = Next;

    #[inline(always)]
    fn run(self) -> Next {
        let Self { engine, set, due, taken } = self;
        if let Err(stalled) = engine.accept_step(due, taken) {
            return Next::Over(Err(stalled));
        }
        // Slip goes on without the code of stick and of the end.
        match engine.state.contact {
            ContactState::Slip { sign, zeros } if engine.state.clock.until(engine.until) > 0.0 => {
                engine.slip(sign, zeros)
            }
            _ => engine.next(set),
        }
    }
}

/// Longest step of slip: a series of order n is accurate for n/2 radians of the fastest oscillation.
#[inline(always)]
fn longest_step(tangential: &Forcing, normal: &Forcing) -> f64 {
    0.5 * ORDER as f64 / tangential.highest_rate().max(normal.highest_rate()).max(1.0)
}

/// Bound on the last retained terms of a step, relative to F. Terms too small to change the state (the initial state, or
/// the amplitude that the dither drives) need no bound: it would only shorten the steps, indefinitely where F is
/// negligible compared with the other forces.
#[inline(always)]
fn step_tolerance(
    tolerance: f64,
    (tangential, normal): (&Forcing, &Forcing),
    displacement: f64,
    slip: f64,
) -> f64 {
    let rate = tangential.highest_rate().max(1.0);
    let driven = tangential.amplitude() / (rate * rate);
    let rounding = INVISIBLE * displacement.abs().max(slip.abs()).max(driven);
    (tolerance * normal.mean()).max(rounding)
}
