//! Transitions of the contact: what is decided at v_r = 0 and when a bond breaks.

use super::engine::Engine;
use super::event::{Event, EventKind};

/// Changes of contact at one moment before the bond is held. A jump that breaks a bond just
/// made needs two; a touch of the threshold repeats for ever.
pub(super) const PATIENCE: u32 = 4;

/// Rate of |f_s| − μ_s N, relative to its scale, below which a release counts as nearly
/// tangential.
const NEARLY_TANGENTIAL: f64 = 1e-6;

/// State of the contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Contact {
    /// Moving with the belt; `held` after a touch.
    Stick { held: bool },
    /// Slipping with this sign; `zeros` is the multiplicity of the zero of v_r at the start
    /// of the coming step, to be divided out: 2 after a smooth release, 1 after a reversal, a
    /// jump or a law with μ_k < μ_s.
    Slip { sign: f64, zeros: usize },
}

impl Engine<'_> {
    #[inline(always)]
    pub(super) fn slip_sign(&self) -> i8 {
        match self.contact {
            Contact::Stick { .. } => 0,
            Contact::Slip { sign, .. } if sign > 0.0 => 1,
            Contact::Slip { .. } => -1,
        }
    }

    /// What the contact does at v_r = 0, by f_s alone.
    #[inline(always)]
    pub(super) fn decided(&self) -> Contact {
        let force = self.bond.force(self.displacement, self.tangential.value(self.clock));
        let limit = self.bond.static_coefficient * self.normal.value(self.clock);
        if force.abs() <= limit || self.idle >= PATIENCE {
            Contact::Stick { held: self.idle >= PATIENCE }
        } else {
            Contact::Slip { sign: 1f64.copysign(force), zeros: 1 }
        }
    }

    /// v_r has reached 0 from the side of `sign`.
    #[inline(always)]
    pub(super) fn arrive(&mut self, sign: f64) {
        self.contact = self.decided();
        match self.contact {
            Contact::Stick { .. } => self.report(EventKind::Stick),
            Contact::Slip { sign: after, .. } if after != sign => self.report(EventKind::Reversal),
            // A graze: v_r touches 0 and turns back to its own side. Nothing happens.
            Contact::Slip { .. } => {}
        }
    }

    /// The bond breaks now.
    #[inline(always)]
    pub(super) fn release(&mut self, sign: f64, rate: f64, jumped: bool) {
        let scale = self.bond.belt_velocity
            + self.tangential.amplitude() * self.tangential.highest_rate()
            + self.normal.amplitude() * self.normal.highest_rate();
        if !jumped && rate < NEARLY_TANGENTIAL * scale {
            self.near_tangential_releases += 1;
        }
        if !jumped && rate <= 0.0 {
            self.contact = Contact::Stick { held: true };
            return;
        }
        let zeros = if jumped || !self.smooth_release { 1 } else { 2 };
        self.contact = Contact::Slip { sign, zeros };
        self.report(EventKind::Release);
    }

    #[inline(always)]
    pub(super) fn report(&mut self, kind: EventKind) {
        self.events += 1;
        let event = Event {
            time: self.clock.time(),
            contact: 0,
            kind,
            slip_sign: self.slip_sign(),
            displacement: self.unit * self.displacement,
        };
        self.observer.event(&event);
    }
}
