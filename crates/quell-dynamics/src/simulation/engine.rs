//! One run: what happens between its slip steps, and what is decided at v_r = 0.
//!
//! The slip steps themselves are taken by [`super::lanes`], for one run or for many side by
//! side; an [`Engine`] says from where and how far, and takes the end of the step back.
//!
//! Progress is guaranteed: every turn of the loop advances time, or changes the contact at
//! the same moment, and after [`PATIENCE`] changes without advance the bond is held for
//! [`HOLD`] of a dither period. A release that only touches its threshold therefore cannot
//! loop; the held time is below every tolerance in use. How much time a turn advances is another
//! question: [`super::pace`] counts steps.

use quell_model::friction::SlidingLaw;
use quell_model::{Belt, Direction};
use quell_numerics::dispatch::{InstructionSet, Work, with_scalar_of};
use quell_numerics::lane::horner;
use quell_numerics::polynomial::first_crossing_after;

use super::clock::Clock;
use super::event::EventKind;
use super::forcing::{Forcing, Shape};
use super::observer::{Observer, Segment};
use super::pace::Pace;
use super::release::Release;
use super::slip_step::{Next, Root, SlipDue, SlipTaken};
use super::stick::{Bond, Search};
use super::transitions::{Contact, PATIENCE};
use super::{FinalState, ORDER, Run, Stalled};

/// Time for which a bond is held after a touch, in units of 1/max(1, R).
const HOLD: f64 = 1e-8;

/// Sure stick shorter than this is left to the search.
const WORTH_SKIPPING: f64 = 1e-3;

/// A sixteenth of the rounding of a number, relative to it: terms below this leave no trace.
const INVISIBLE: f64 = f64::EPSILON / 16.0;

/// State of one run. Lengths are in units of the law's velocity scale.
pub(super) struct Engine<'a> {
    /// 2ζ.
    pub(super) damping: f64,
    pub(super) bond: Bond,
    /// The closed form of a release, where there is one.
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
    pub(super) clock: Clock,
    pub(super) until: f64,
    pub(super) displacement: f64,
    pub(super) slip: f64,
    pub(super) contact: Contact,
    /// Whether the last thing that happened was a kink or a jump.
    pub(super) at_break: bool,
    pub(super) idle: u32,
    pub(super) smooth_release: bool,
    pub(super) events: u64,
    pub(super) steps: u64,
    pub(super) pace: Pace,
    pub(super) near_tangential_releases: u64,
    pub(super) observer: &'a mut dyn Observer,
    /// Whether the observer sees segments.
    pub(super) watched: bool,
}

impl<'a> Engine<'a> {
    pub(super) fn new<L: SlidingLaw>(run: Run<'a>, law: &L, tolerance: f64) -> Self {
        let Run { belt, start, until, observer } = run;
        let unit = law.velocity_scale();
        let clock = Clock::at(start.time);
        let belt_velocity = belt.belt_velocity() / unit;
        let damping = 2.0 * belt.damping_ratio();
        let slip = (belt.belt_velocity() - start.velocity) / unit;
        let (tangential, normal) = forcings(belt, unit, clock);
        let bond = Bond {
            damper: damping * belt_velocity,
            belt_velocity,
            static_coefficient: law.static_coefficient(),
        };
        let fastest = tangential.highest_rate().max(normal.highest_rate());
        let pace = Pace::new(start.time, until, fastest);
        let shapes = [Direction::Tangential, Direction::Normal]
            .map(|direction| Shape::of(belt.dithers(), direction));
        let mut engine = Self {
            damping,
            bond,
            release: Release::of(&bond, (&tangential, &normal), (shapes[0], shapes[1])),
            longest_step: longest_step(&tangential, &normal),
            tolerance: step_tolerance(
                tolerance,
                (&tangential, &normal),
                start.displacement / unit,
                slip,
            ),
            tangential,
            normal,
            unit,
            belt_velocity: belt.belt_velocity(),
            clock,
            until,
            displacement: start.displacement / unit,
            slip,
            contact: Contact::Slip { sign: 1f64.copysign(slip), zeros: 0 },
            at_break: false,
            idle: 0,
            smooth_release: law.starts_at_static_level(),
            events: 0,
            steps: 0,
            pace,
            near_tangential_releases: 0,
            watched: observer.watches(),
            observer,
        };
        if slip == 0.0 {
            engine.contact = engine.decided();
        }
        engine
    }

    /// Goes on through stick until a slip step is due or the run is over.
    ///
    /// This and [`Engine::take`] are compiled once per scalar instruction set and called, not
    /// once more into the loop of every law and lane type.
    pub(super) fn next(&mut self, set: InstructionSet) -> Next {
        with_scalar_of(set, GoOn(self))
    }

    #[inline(always)]
    fn go_on(&mut self) -> Next {
        if self.steps == 0
            && let Err(why) = Pace::begin()
        {
            return Next::Over(Err(self.stalled(why)));
        }
        while self.clock.until(self.until) > 0.0 {
            match self.contact {
                Contact::Slip { sign, zeros } => {
                    return Next::Slip(SlipDue { sign, zeros, stop: self.next_stop() });
                }
                Contact::Stick { held } => {
                    let before = self.clock;
                    self.stick_stretch(held);
                    if let Err(stalled) = self.check_progress(before) {
                        return Next::Over(Err(stalled));
                    }
                }
            }
        }
        // The steps are counted; a run that is over is over.
        let _ = self.pace.spend(self.steps);
        Next::Over(Ok(self.final_state()))
    }

    /// Counts turns without advance.
    #[inline(always)]
    fn check_progress(&mut self, before: Clock) -> Result<(), Stalled> {
        self.idle = if self.clock == before { self.idle + 1 } else { 0 };
        if self.idle > 4 * PATIENCE {
            return Err(self.stalled("no step advanced time"));
        }
        if !(self.displacement.is_finite() && self.slip.is_finite()) {
            return Err(self.stalled("the state left the finite numbers"));
        }
        if self.pace.is_due(self.steps) {
            let time = self.clock.time();
            return self.pace.look(self.steps, time).map_err(|why| self.stalled(why));
        }
        Ok(())
    }

    /// Looks at the clock while a lane takes steps without it: `steps` more than it knows, up to the moment `time`.
    pub(super) fn look(&mut self, steps: u64, time: f64) -> Result<(), Stalled> {
        let steps = self.steps + steps;
        if !self.pace.is_due(steps) {
            return Ok(());
        }
        self.pace.look(steps, time).map_err(|why| Stalled { time, why })
    }

    fn stalled(&self, why: &'static str) -> Stalled {
        Stalled { time: self.clock.time(), why }
    }

    fn final_state(&self) -> FinalState {
        FinalState {
            time: self.clock.time(),
            displacement: self.unit * self.displacement,
            velocity: self.belt_velocity - self.unit * self.slip,
            sticking: matches!(self.contact, Contact::Stick { .. }),
            slip_sign: self.slip_sign(),
            events: self.events,
            steps: self.steps,
            near_tangential_releases: self.near_tangential_releases,
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
        self.tangential.pass_breaks(self.clock);
        self.normal.pass_breaks(self.clock);
        self.at_break = true;
    }

    /// Slip steps were taken without it: no root, no stop, nobody watching. The last of them ended
    /// at `clock` with y and w as in `state`.
    #[inline(always)]
    pub(super) fn catch_up(&mut self, steps: u64, clock: Clock, state: (f64, f64), sign: f64) {
        if steps > 0 {
            self.steps += steps;
            self.idle = 0;
            self.clock = clock;
            (self.displacement, self.slip) = state;
            self.contact = Contact::Slip { sign, zeros: 0 };
        }
    }

    /// Takes a slip step back from the kernel and goes on as [`Engine::next`].
    pub(super) fn take(
        &mut self,
        set: InstructionSet,
        due: SlipDue,
        taken: &SlipTaken<'_>,
    ) -> Next {
        with_scalar_of(set, Take { engine: self, due, taken })
    }

    /// A slip step back from the kernel, cut at the first root of v_r.
    ///
    /// # Errors
    /// [`Stalled`] where time does not advance or the state is not finite.
    #[inline(always)]
    fn take_back(&mut self, due: SlipDue, taken: &SlipTaken<'_>) -> Result<(), Stalled> {
        let before = self.clock;
        let SlipDue { sign, zeros, stop } = due;
        let room = self.clock.until(stop);
        if zeros > 0 && taken.slip.coefficient(zeros) * sign <= 0.0 {
            // The zero is of higher order than its cause allows: rounding at a touch. The
            // slip that was announced has no length.
            self.contact = Contact::Stick { held: true };
            self.report(EventKind::Stick);
            return self.check_progress(before);
        }
        let (root, displacement) = match taken.root {
            Root::None => (None, taken.end.0),
            Root::At(root) => (Some(root), taken.end.0),
            Root::Unsure => {
                let root = first_crossing_after(&taken.slip.gathered(), zeros, taken.length);
                let end = root.map(|root| horner(&taken.displacement.gathered(), root));
                (root, end.unwrap_or(taken.end.0))
            }
        };
        let duration = root.unwrap_or(taken.length);
        let reaches_stop = duration >= room || self.clock.after(duration).time() == stop;
        self.steps += 1;
        if self.watched {
            self.observer.segment(&Segment {
                clock: self.clock,
                duration,
                slip_sign: if sign > 0.0 { 1 } else { -1 },
                unit: self.unit,
                belt_velocity: self.belt_velocity,
                displacement: &taken.displacement.gathered(),
                slip: &taken.slip.gathered(),
            });
        }
        self.displacement = displacement;
        self.slip = if root.is_some() { 0.0 } else { taken.end.1 };
        self.contact = Contact::Slip { sign, zeros: 0 };
        self.advance(duration, reaches_stop, stop);
        if root.is_some() {
            self.arrive(sign);
        }
        self.check_progress(before)
    }

    /// Moves the clock, exactly onto the stop where that is reached.
    #[inline(always)]
    fn advance(&mut self, duration: f64, reaches_stop: bool, stop: f64) {
        self.at_break = false;
        if reaches_stop {
            self.clock = Clock::at(stop);
            self.pass_breaks();
        } else {
            self.clock = self.clock.after(duration);
        }
    }

    /// One stretch of stick, up to a break of the bond or the next stop.
    #[inline(always)]
    fn stick_stretch(&mut self, held: bool) {
        let stop = self.next_stop();
        let room = self.clock.until(stop);
        if held {
            let rate = self.tangential.highest_rate().max(self.normal.highest_rate());
            self.stay(room.min(HOLD / rate.max(1.0)), stop, room);
            self.contact = Contact::Stick { held: false };
            return;
        }
        if let Some(release) = &self.release {
            let search = release.search(&self.bond, self.clock, self.displacement, room);
            self.end_of_stick(search, stop, room);
            return;
        }
        let sure = self.bond.surely_holds(self.displacement, &self.tangential, &self.normal);
        if sure > WORTH_SKIPPING {
            // Breaks of the dither inside are passed over: none of them can break the bond.
            let room = self.clock.until(self.until);
            self.stay(sure.min(room), self.until, room);
            self.pass_breaks();
            self.at_break = false;
            return;
        }
        let search = self.bond.search(
            self.clock,
            self.displacement,
            room,
            self.tolerance,
            &self.tangential,
            &self.normal,
        );
        self.end_of_stick(search, stop, room);
    }

    /// Moves with the belt to where the bond breaks, or to the end of the stretch.
    #[inline(always)]
    fn end_of_stick(&mut self, search: Search, stop: f64, room: f64) {
        match search {
            Search::Holds(length) => self.stay(length, stop, room),
            Search::Breaks { after, sign, rate, at_once } => {
                let jumped = at_once && self.at_break;
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
        let reaches_stop = duration >= room || self.clock.after(duration).time() == stop;
        self.steps += 1;
        if self.watched {
            self.observer.segment(&Segment {
                clock: self.clock,
                duration,
                slip_sign: 0,
                unit: self.unit,
                belt_velocity: self.belt_velocity,
                displacement: &[self.displacement, self.bond.belt_velocity],
                slip: &[0.0],
            });
        }
        self.displacement = f64::mul_add(self.bond.belt_velocity, duration, self.displacement);
        self.advance(duration, reaches_stop, stop);
    }
}

/// [`Engine::next`] as work.
struct GoOn<'e, 'a>(&'e mut Engine<'a>);

impl Work for GoOn<'_, '_> {
    type Output = Next;

    #[inline(always)]
    fn run(self) -> Next {
        self.0.go_on()
    }
}

/// [`Engine::take`] as work.
struct Take<'e, 'a, 's> {
    engine: &'e mut Engine<'a>,
    due: SlipDue,
    taken: &'e SlipTaken<'s>,
}

impl Work for Take<'_, '_, '_> {
    type Output = Next;

    #[inline(always)]
    fn run(self) -> Next {
        match self.engine.take_back(self.due, self.taken) {
            Ok(()) => self.engine.go_on(),
            Err(stalled) => Next::Over(Err(stalled)),
        }
    }
}

/// Longest step of slip: a series of this order stays good for half as many radians of the fastest oscillation.
#[inline(always)]
pub(super) fn longest_step(tangential: &Forcing, normal: &Forcing) -> f64 {
    0.5 * ORDER as f64 / tangential.highest_rate().max(normal.highest_rate()).max(1.0)
}

/// Bound on the last retained terms of a step: relative to F. Terms that leave no trace in the state (that of the
/// start, or as large as the dither makes it) need no bound: it would only shorten the steps, without end where F is
/// nothing beside the other forces.
#[inline(always)]
pub(super) fn step_tolerance(
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

/// The dithers of a belt in units of `unit`, tangential and normal, at the moment `clock`.
#[inline(always)]
pub(super) fn forcings(belt: &Belt, unit: f64, clock: Clock) -> (Forcing, Forcing) {
    let load = belt.normal_load() / unit;
    let forcing = |direction, mean| Forcing::new(belt.dithers(), direction, mean, unit, clock);
    (forcing(Direction::Tangential, 0.0), forcing(Direction::Normal, load))
}
