//! Initial-condition protocols: the state from which runs start.

use crate::study::InitialState;

/// The state from which a run starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Protocol {
    /// x = 0, x′ = 0.
    Rest,
    /// Steady sliding without dither.
    Sliding,
    /// The undithered limit cycle.
    Squeal,
    /// A given state (x, x′).
    From(f64, f64),
}

impl Protocol {
    /// Name of its field in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rest => "from_rest",
            Self::Sliding => "from_sliding",
            Self::Squeal => "from_squeal",
            Self::From(..) => "from_start",
        }
    }

    pub(super) fn initial(self) -> InitialState {
        match self {
            Self::Rest => InitialState::Rest,
            Self::Sliding => InitialState::Sliding,
            Self::Squeal => InitialState::Squealing,
            Self::From(displacement, velocity) => InitialState::Explicit { displacement, velocity },
        }
    }
}
