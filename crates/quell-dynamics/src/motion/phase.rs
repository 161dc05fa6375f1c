//! What each contact does between events.

/// What a contact does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ContactPhase {
    /// It slips; the sign of the slip velocity, 1 or −1.
    Slip(i8),
    /// It moves with the surface; an elastic slider adheres to it.
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
    /// Whether it keeps its phase beyond the borders of that phase: no guard ends it.
    pub(super) kept: bool,
    /// What else holds of a contact with a state of its own.
    pub(super) own: OwnNow,
}

/// What holds at the start of a step of a contact with a state of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum OwnNow {
    /// The contact is rigid: it has no state of its own.
    Rigid,
    /// An elastic slider.
    Elastic(ElasticNow),
    /// Bristles: it slips in either direction and never sticks.
    Bristles,
}

/// An elastic slider at the start of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct ElasticNow {
    /// Sign of γ while it slides, which can differ from the direction of its slip, and while it adheres beyond its static bound; else 0.
    pub(super) branch: i8,
    /// Side on which it adheres although T is beyond its static bound, because the sliding level μ(|γ|)N is still higher; else 0.
    pub(super) beyond: i8,
    /// Multiplicity of the zero of its own speed at the start of a slip.
    pub(super) speed_zeros: usize,
    /// Multiplicity of the zeros of its margins at the upper and at the lower bound.
    pub(super) margin_zeros: [usize; 2],
    /// Whether it has reached its static bound at this moment, so that T may jump to the sliding level.
    pub(super) is_released: bool,
}

impl ContactNow {
    pub(super) fn of(phase: ContactPhase) -> Self {
        Self {
            phase,
            slip_zeros: 0,
            load_zeros: 0,
            held: false,
            saturated: 0,
            kept: false,
            own: OwnNow::Rigid,
        }
    }

    /// A contact that keeps its phase.
    pub(super) fn keeping(phase: ContactPhase) -> Self {
        Self { kept: true, ..Self::of(phase) }
    }

    /// Forgets what held at the start of the last step alone.
    #[inline(always)]
    pub(super) fn advanced(&mut self) {
        self.slip_zeros = 0;
        self.load_zeros = 0;
        if let OwnNow::Elastic(now) = &mut self.own {
            let ElasticNow { branch, beyond, .. } = *now;
            *now = ElasticNow { branch, beyond, ..ElasticNow::default() };
        }
    }

    /// Whether a rigid contact is held at rest by its friction. An elastic slider that adheres moves.
    #[inline(always)]
    pub(super) fn sticks(&self) -> bool {
        self.phase == ContactPhase::Stick && self.is_rigid()
    }

    /// Whether the contact has no state of its own.
    #[inline(always)]
    pub(super) fn is_rigid(&self) -> bool {
        self.own == OwnNow::Rigid
    }

    #[inline(always)]
    pub(super) fn is_open(&self) -> bool {
        self.phase == ContactPhase::Open
    }
}
