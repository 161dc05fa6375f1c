//! Why a system cannot be simulated, and why a run ends early.

use std::fmt;

/// Why the motion of a system cannot be computed at all.
#[derive(Clone, Debug, PartialEq)]
pub enum Immobile {
    /// The mass matrix is singular.
    NoMass,
    /// The friction law of a contact cannot be simulated.
    Law {
        /// Name of the contact.
        contact: String,
        /// The reason.
        why: &'static str,
    },
    /// Friction of a contact does not act against its own slip: t_cᵀg_c ≤ 0.
    Unopposed {
        /// Name of the contact.
        contact: String,
    },
    /// A contact without a tangent slips at the velocity of its surface, which is zero.
    AtRest {
        /// Name of the contact.
        contact: String,
    },
    /// The friction forces that hold a set of contacts are not unique, and neither is the motion: t_cᵀg_d is no P-matrix.
    NotUnique {
        /// Names of the contacts.
        contacts: Vec<String>,
    },
}

impl fmt::Display for Immobile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoMass => f.write_str("the mass matrix is singular"),
            Self::Law { contact, why } => {
                write!(f, "the friction law of contact {contact} cannot be simulated: {why}")
            }
            Self::Unopposed { contact } => write!(
                f,
                "the friction force of contact {contact} does not oppose its own slip (tᵀg must be positive), so that \
                 sticking has no solution"
            ),
            Self::AtRest { contact } => write!(
                f,
                "contact {contact} has no tangent and its surface does not move: its friction has no direction"
            ),
            Self::NotUnique { contacts } => write!(
                f,
                "which of the contacts {} stick is not decided by the equations: the matrix tᵀg of their friction forces \
                 is no P-matrix (every principal minor must be positive)",
                contacts.join(", ")
            ),
        }
    }
}

impl std::error::Error for Immobile {}

/// Why a run of a system ended early.
#[derive(Clone, Debug, PartialEq)]
pub enum StopReason {
    /// The numbers are too extreme, or the run would not end.
    Stalled(&'static str),
    /// Events of a contact accumulate: infinitely many in a finite time.
    Zeno {
        /// Name of the contact.
        contact: String,
    },
    /// A prescribed load falls to zero.
    LoadVanishes {
        /// Name of the contact.
        contact: String,
    },
    /// Which contacts stick is not decided by the equations there.
    NotUnique {
        /// Names of the contacts.
        contacts: Vec<String>,
    },
}

/// A run of a system that ended early, with the state there.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionStopped {
    /// Time at which it ended.
    pub time: f64,
    /// State there.
    pub state: Vec<f64>,
    /// The reason.
    pub reason: StopReason,
}

impl fmt::Display for MotionStopped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the integration stopped at t = {:?}: ", self.time)?;
        match &self.reason {
            StopReason::Stalled(why) => f.write_str(why),
            StopReason::Zeno { contact } => write!(
                f,
                "the events of contact {contact} accumulate, infinitely many in a finite time (Zeno behaviour)"
            ),
            StopReason::LoadVanishes { contact } => write!(
                f,
                "the prescribed normal load of contact {contact} falls to zero; a contact that may open needs a normal \
                 row and a normal_stiffness"
            ),
            StopReason::NotUnique { contacts } => write!(
                f,
                "which of the contacts {} stick is not decided by the equations there: the matrix of their friction \
                 forces, tilted by the slopes, is no P-matrix",
                contacts.join(", ")
            ),
        }
    }
}

impl std::error::Error for MotionStopped {}
