//! What a contact does during a step.

use super::phase::{ContactNow, ContactPhase, OwnNow};

/// What a contact does during a step, as the equations of its orders ask for it.
#[expect(clippy::struct_excessive_bools, reason = "each decides about terms of its own")]
#[derive(Clone, Debug)]
pub(super) struct ContactInStep {
    /// Sign of the slip velocity, of an elastic slider that of its branch; 0 where the contact does not slip.
    pub(super) sign: f64,
    pub(super) slips: bool,
    pub(super) sticks: bool,
    pub(super) is_open: bool,
    /// Sign of the bound at which the friction of a sticking contact stands; 0 where it is below its bound.
    pub(super) saturated: f64,
    /// Multiplicity of the zeros of γ and of the load at the start.
    pub(super) slip_zeros: usize,
    pub(super) load_zeros: usize,
    /// Whether the series of the law along γ is needed: where the contact slips, or adheres beyond its static bound.
    pub(super) follows_law: bool,
    /// Direction of an elastic slider's slip times the sign of γ; not read of rigid contacts.
    pub(super) turned: f64,
}

impl ContactInStep {
    #[inline(always)]
    pub(super) fn of(now: &ContactNow) -> Self {
        let slips = matches!(now.phase, ContactPhase::Slip(_));
        let is_saturated = now.sticks() && now.saturated != 0;
        let direction = f64::from(now.phase.slip_sign());
        // The law is evaluated on the branch of γ.
        let (sign, is_beyond) = match now.own {
            OwnNow::Elastic(own) => (f64::from(own.branch), own.beyond != 0),
            OwnNow::Rigid | OwnNow::Bristles => (direction, false),
        };
        Self {
            sign,
            slips,
            sticks: now.sticks(),
            is_open: now.is_open(),
            saturated: if is_saturated { f64::from(now.saturated) } else { 0.0 },
            slip_zeros: now.slip_zeros,
            load_zeros: now.load_zeros,
            follows_law: slips || is_beyond,
            turned: direction * sign,
        }
    }

    /// Of a contact that is open.
    #[inline(always)]
    pub(super) fn open() -> Self {
        Self::of(&ContactNow::of(ContactPhase::Open))
    }

    /// Whether slip velocity or bound give the friction.
    #[inline(always)]
    pub(super) fn acts(&self) -> bool {
        self.slips || self.saturated != 0.0
    }

    /// Whether the contact sticks below its bound: its margins are guards.
    #[inline(always)]
    pub(super) fn holds(&self) -> bool {
        self.sticks && self.saturated == 0.0
    }
}
