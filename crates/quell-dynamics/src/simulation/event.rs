//! Events of the contact.

/// Kind of an event of a contact. A belt, whose load is prescribed, has the first three.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EventKind {
    /// Slip ends, the mass moves with the belt.
    Stick,
    /// Stiction ends, slip begins.
    Release,
    /// v_r changes sign without sticking.
    Reversal,
    /// The normal load falls to zero and the contact opens.
    Separation,
    /// The contact closes again.
    Landing,
}

impl EventKind {
    /// Name in the output.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stick => "stick",
            Self::Release => "release",
            Self::Reversal => "reversal",
            Self::Separation => "separation",
            Self::Landing => "landing",
        }
    }
}

/// One event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// Time τ.
    pub time: f64,
    /// Number of the contact; a belt has one, number 0.
    pub contact: usize,
    /// Kind of the event.
    pub kind: EventKind,
    /// Sign of v_r afterwards; 0 in stick.
    pub slip_sign: i8,
    /// Displacement x.
    pub displacement: f64,
    /// Velocity x′; without a contact of its own state it is that of the belt.
    pub velocity: f64,
    /// Whether a jump of the dither has caused it.
    pub is_jump: bool,
}
