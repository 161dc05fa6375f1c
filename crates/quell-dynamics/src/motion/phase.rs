//! What each contact does between events.

/// What a contact does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ContactPhase {
    /// It slips; the sign of the slip velocity, 1 or −1.
    Slip(i8),
    /// It moves with the surface.
    Stick,
    /// It is open.
    Open,
}

impl ContactPhase {
    /// Sign of the slip velocity; 0 in stick and where the contact is open.
    pub fn slip_sign(self) -> i8 {
        match self {
            Self::Slip(sign) => sign,
            Self::Stick | Self::Open => 0,
        }
    }
}

/// A contact between events, with what the coming step must know about its start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ContactNow {
    pub(super) phase: ContactPhase,
    /// Multiplicity of the zero of γ at the start, which is divided out: 2 after a smooth release, 1 after a reversal, a jump,
    /// or for μ(0⁺) < μ_s.
    pub(super) slip_zeros: usize,
    /// Multiplicity of the zero of the load at the start: 1 after a separation or a landing.
    pub(super) load_zeros: usize,
    /// Whether the contact is held in stick although its force is at its bound to rounding, after decisions that repeat.
    pub(super) held: bool,
    /// Sign of the bound at which the friction of a sticking contact stands, if dependent contacts carry the rest.
    pub(super) saturated: i8,
}

impl ContactNow {
    pub(super) fn of(phase: ContactPhase) -> Self {
        Self { phase, slip_zeros: 0, load_zeros: 0, held: false, saturated: 0 }
    }

    /// Forgets what held at the start of the last step alone.
    #[inline(always)]
    pub(super) fn advanced(&mut self) {
        self.slip_zeros = 0;
        self.load_zeros = 0;
    }

    #[inline(always)]
    pub(super) fn sticks(&self) -> bool {
        self.phase == ContactPhase::Stick
    }

    #[inline(always)]
    pub(super) fn is_open(&self) -> bool {
        self.phase == ContactPhase::Open
    }
}
