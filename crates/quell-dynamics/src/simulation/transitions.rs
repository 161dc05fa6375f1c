//! Transitions of the contact: the decision at v_r = 0, and the release.

use super::engine::Engine;
use super::event::{Event, EventKind};
use super::run_state::{ContactState, PATIENCE};

/// Rate of |f_s| − μ_s N, relative to its scale, below which a release counts as nearly
/// tangential.
const NEARLY_TANGENTIAL: f64 = 1e-6;

impl Engine<'_> {
    /// The contact after v_r = 0, decided by f_s alone.
    #[inline(always)]
    pub(super) fn decided(&self) -> ContactState {
        let force =
            self.stiction.force(self.state.displacement, self.tangential.value(self.state.clock));
        let limit = self.stiction.static_coefficient * self.normal.value(self.state.clock);
        if force.abs() <= limit || self.state.idle >= PATIENCE {
            ContactState::Stick { held: self.state.idle >= PATIENCE }
        } else {
            ContactState::Slip { sign: 1f64.copysign(force), zeros: 1 }
        }
    }

    /// v_r has reached 0 from the side of `sign`.
    #[inline(always)]
    pub(super) fn arrive(&mut self, sign: f64) {
        self.state.contact = self.decided();
        match self.state.contact {
            ContactState::Stick { .. } => self.report(EventKind::Stick, false),
            ContactState::Slip { sign: after, .. } if after != sign => {
                self.report(EventKind::Reversal, false);
            }
            // Grazing: v_r touches 0 and returns to the same side, without an event.
            ContactState::Slip { .. } => {}
        }
    }

    /// The contact releases now.
    #[inline(always)]
    pub(super) fn release(&mut self, sign: f64, rate: f64, jumped: bool) {
        let scale = self.stiction.belt_velocity
            + self.tangential.amplitude() * self.tangential.highest_rate()
            + self.normal.amplitude() * self.normal.highest_rate();
        if !jumped && rate < NEARLY_TANGENTIAL * scale {
            self.state.near_tangential_releases += 1;
        }
        if !jumped && rate <= 0.0 {
            self.state.contact = ContactState::Stick { held: true };
            return;
        }
        let zeros = if jumped || !self.smooth_release { 1 } else { 2 };
        self.state.contact = ContactState::Slip { sign, zeros };
        self.report(EventKind::Release, jumped);
    }

    #[inline(always)]
    pub(super) fn report(&mut self, kind: EventKind, is_jump: bool) {
        self.state.events += 1;
        let event = Event {
            time: self.state.clock.time(),
            contact: 0,
            kind,
            slip_sign: self.state.slip_sign(),
            displacement: self.unit * self.state.displacement,
            velocity: self.belt_velocity,
            is_jump,
        };
        self.observer.event(&event);
    }
}
