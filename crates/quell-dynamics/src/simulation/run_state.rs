//! The state of a run between events, and the only owner of it.
//!
//! [`super::engine`] and [`super::transitions`] change it. While the lanes take slip steps without the engine, the lane
//! holds the working copy of clock, displacement and slip ([`super::lanes`]); [`RunState::catch_up`] brings it back before
//! anything is decided. The current piece of each forcing follows from the clock and is cached in [`super::forcing`].

use super::clock::Clock;

/// Changes of contact at one moment before the contact is held in stick. A jump of the dither that releases a
/// contact just made needs two; grazing of the threshold repeats indefinitely.
pub(super) const PATIENCE: u32 = 4;

/// State of the contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum ContactState {
    /// Moving with the belt; `held` after a grazing contact.
    Stick { held: bool },
    /// Slipping with this sign. `zeros` is the multiplicity of the zero of v_r at the start
    /// of the coming step, which is divided out: 2 after a smooth release, 1 after a reversal, a
    /// jump, or with a law with μ_k < μ_s.
    Slip { sign: f64, zeros: usize },
}

/// State of a run. Lengths are in units of the law's velocity scale.
#[derive(Clone, Copy, Debug)]
pub(super) struct RunState {
    /// The current moment.
    pub(super) clock: Clock,
    /// y.
    pub(super) displacement: f64,
    /// w.
    pub(super) slip: f64,
    /// What the contact does from here on.
    pub(super) contact: ContactState,
    /// Whether the last event was a kink or a jump of the dither.
    pub(super) at_break: bool,
    /// Number of changes since time last advanced.
    pub(super) idle: u32,
    /// Number of events.
    pub(super) events: u64,
    /// Number of segments.
    pub(super) steps: u64,
    /// Number of releases at which the threshold was barely crossed.
    pub(super) near_tangential_releases: u64,
}

impl RunState {
    /// At the start of a run.
    pub(super) fn new(clock: Clock, displacement: f64, slip: f64) -> Self {
        Self {
            clock,
            displacement,
            slip,
            contact: ContactState::Slip { sign: 1f64.copysign(slip), zeros: 0 },
            at_break: false,
            idle: 0,
            events: 0,
            steps: 0,
            near_tangential_releases: 0,
        }
    }

    /// Sign of v_r; 0 in stick.
    #[inline(always)]
    pub(super) fn slip_sign(&self) -> i8 {
        match self.contact {
            ContactState::Stick { .. } => 0,
            ContactState::Slip { sign, .. } if sign > 0.0 => 1,
            ContactState::Slip { .. } => -1,
        }
    }

    /// Takes over slip steps that a lane took without the engine: no root, no stop, no observer. The last of them ended
    /// at `clock` with y and w as in `state`.
    #[inline(always)]
    pub(super) fn catch_up(&mut self, steps: u64, clock: Clock, state: (f64, f64), sign: f64) {
        if steps > 0 {
            self.steps += steps;
            self.idle = 0;
            self.clock = clock;
            (self.displacement, self.slip) = state;
            self.contact = ContactState::Slip { sign, zeros: 0 };
        }
    }
}
