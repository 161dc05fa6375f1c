//! The loop of a run: slip steps, stick stretches, and what is decided at v_r = 0.
//!
//! Progress is guaranteed: every turn of the loop advances time, or changes the contact at
//! the same moment, and after [`PATIENCE`] changes without advance the bond is held for
//! [`HOLD`] of a dither period. A release that only touches its threshold therefore cannot
//! loop; the held time is below every tolerance in use.

use quell_model::friction::SlidingLaw;
use quell_model::{Belt, Direction};
use quell_numerics::lane::horner;
use quell_numerics::polynomial::{first_crossing_after, step_length};

use super::clock::Clock;
use super::event::EventKind;
use super::forcing::{Forcing, Series};
use super::observer::{Observer, Segment};
use super::slip::{Load, SlipEquation, SlipStart};
use super::stick::{Bond, Search};
use super::transitions::{Contact, PATIENCE};
use super::{FinalState, ORDER, Stalled, Start};

/// Time for which a bond is held after a touch, in units of 1/max(1, R).
const HOLD: f64 = 1e-8;

/// Sure stick shorter than this is left to the search.
const WORTH_SKIPPING: f64 = 1e-3;

pub(super) struct Engine<'a, L> {
    pub(super) law: L,
    pub(super) equation: SlipEquation<f64>,
    pub(super) bond: Bond,
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
    pub(super) near_tangential_releases: u64,
    pub(super) observer: &'a mut dyn Observer,
}

impl<'a, L: SlidingLaw> Engine<'a, L> {
    #[inline(always)]
    pub(super) fn new(
        belt: &Belt,
        law: L,
        start: Start,
        until: f64,
        tolerance: f64,
        observer: &'a mut dyn Observer,
    ) -> Self {
        let unit = law.velocity_scale();
        let clock = Clock::at(start.time);
        let load = belt.normal_load() / unit;
        let belt_velocity = belt.belt_velocity() / unit;
        let damping = 2.0 * belt.damping_ratio();
        let slip = (belt.belt_velocity() - start.velocity) / unit;
        let forcing = |direction, mean| Forcing::new(belt.dithers(), direction, mean, unit, clock);
        let tangential = forcing(Direction::Tangential, 0.0);
        let normal = forcing(Direction::Normal, load);
        let fastest = tangential.highest_rate().max(normal.highest_rate()).max(1.0);
        Self {
            equation: SlipEquation { damping, belt_velocity },
            bond: Bond {
                damper: damping * belt_velocity,
                belt_velocity,
                static_coefficient: law.static_coefficient(),
            },
            tangential,
            normal,
            longest_step: 0.5 * ORDER as f64 / fastest,
            tolerance: tolerance * load,
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
            near_tangential_releases: 0,
            law,
            observer,
        }
    }

    #[inline(always)]
    pub(super) fn run(mut self) -> Result<FinalState, Stalled> {
        if self.slip == 0.0 {
            self.contact = self.decided();
        }
        while self.clock.until(self.until) > 0.0 {
            let before = self.clock;
            match self.contact {
                Contact::Slip { sign, zeros } => self.slip_step(sign, zeros),
                Contact::Stick { held } => self.stick_stretch(held),
            }
            if self.clock == before {
                self.idle += 1;
            } else {
                self.idle = 0;
            }
            if self.idle > 4 * PATIENCE {
                return Err(self.stalled("no step advanced time"));
            }
            if !(self.displacement.is_finite() && self.slip.is_finite()) {
                return Err(self.stalled("the state left the finite numbers"));
            }
        }
        Ok(self.final_state())
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

    /// One Taylor step of slip, cut at the first root of v_r and at the next stop.
    #[inline(always)]
    fn slip_step(&mut self, sign: f64, zeros: usize) {
        let stop = self.next_stop();
        let room = self.clock.until(stop);
        let dither = self.tangential.series(self.clock);
        let start = SlipStart {
            sign,
            displacement: self.displacement,
            slip: self.slip,
            first_slope: if zeros == 2 { 0.0 } else { 1.0 },
        };
        let load_series;
        let load = if self.normal.is_constant() {
            Load::Steady(self.normal.mean())
        } else {
            load_series = self.normal.series(self.clock);
            Load::Series(&load_series)
        };
        let series = self.equation.series(&self.law, start, &dither, load);
        let w = &series.slip;
        let length = self.slip_length(w, room);
        if zeros > 0 && w[zeros] * sign <= 0.0 {
            // The zero is of higher order than its cause allows: rounding at a touch. The slip
            // that was announced has no length.
            self.contact = Contact::Stick { held: true };
            self.report(EventKind::Stick);
            return;
        }
        let root = first_crossing_after(w, zeros, length);
        let duration = root.unwrap_or(length);
        let reaches_stop = duration >= room || self.clock.after(duration).time() == stop;
        self.steps += 1;
        self.observer.segment(&Segment {
            clock: self.clock,
            duration,
            slip_sign: if sign > 0.0 { 1 } else { -1 },
            unit: self.unit,
            belt_velocity: self.belt_velocity,
            displacement: &series.displacement,
            slip: w,
        });
        self.displacement = horner(&series.displacement, duration);
        self.slip = if root.is_some() { 0.0 } else { horner(w, duration) };
        self.contact = Contact::Slip { sign, zeros: 0 };
        self.advance(duration, reaches_stop, stop);
        if root.is_some() {
            self.arrive(sign);
        }
    }

    /// Length of a slip step: the last two retained terms within the tolerance, and no rate
    /// of the problem so far that they could be small by chance.
    #[inline(always)]
    fn slip_length(&self, w: &Series, room: f64) -> f64 {
        let mut length = step_length(self.tolerance, w[ORDER], w[ORDER - 1], ORDER)
            .min(self.longest_step)
            .min(room);
        let allowed = self.law.longest_change(ORDER);
        if allowed < f64::INFINITY {
            let mut change = 0.0;
            for k in (1..=ORDER).rev() {
                change = f64::mul_add(change, length, w[k].abs());
            }
            change *= length;
            if change > allowed {
                // Every term shrinks at least as the step does.
                length *= allowed / change;
            }
        }
        length
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
        self.observer.segment(&Segment {
            clock: self.clock,
            duration,
            slip_sign: 0,
            unit: self.unit,
            belt_velocity: self.belt_velocity,
            displacement: &[self.displacement, self.equation.belt_velocity],
            slip: &[0.0],
        });
        self.displacement = f64::mul_add(self.bond.belt_velocity, duration, self.displacement);
        self.advance(duration, reaches_stop, stop);
    }
}
