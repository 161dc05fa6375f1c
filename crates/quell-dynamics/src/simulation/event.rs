//! What happens at the contact.

/// Kind of an event at v_r = 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EventKind {
    /// Slip ends, the mass moves with the belt.
    Stick,
    /// The bond breaks, slip begins.
    Release,
    /// v_r changes sign without sticking.
    Reversal,
}

impl EventKind {
    /// Name in output.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stick => "stick",
            Self::Release => "release",
            Self::Reversal => "reversal",
        }
    }
}

/// One event. The velocity at every event is that of the belt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// When, τ.
    pub time: f64,
    /// Which contact; a belt has one, number 0.
    pub contact: usize,
    /// What.
    pub kind: EventKind,
    /// Sign of v_r afterwards; 0 in stick.
    pub slip_sign: i8,
    /// Displacement x.
    pub displacement: f64,
}
