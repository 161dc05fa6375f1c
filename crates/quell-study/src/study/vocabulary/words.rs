//! Lists of words that keys take.

use quell_design::actuator::ActuatorKind;
use quell_design::least_dither::{DesignObjective, DesignStart};
use quell_model::disc::Contribution;
use quell_model::profile::KnotShape;
use quell_model::units::UnitSystem;
use quell_model::waveform::Hold;
use quell_model::{Direction, LawKind, Waveform};

/// The direction of a dither that is a factor on the friction of a contact.
pub const FRICTION: &str = "friction";

/// A list of words.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Choice {
    /// Initial states.
    State,
    /// Friction laws.
    Law,
    /// Directions of dither.
    Direction,
    /// What a dither of a contact acts on.
    ContactDirection,
    /// Waveforms of dither.
    Waveform,
    /// Waveforms of the carrier of bursts.
    Carrier,
    /// What is between two samples of a waveform.
    Hold,
    /// Shapes between the knots of a drive, a load or an envelope.
    KnotShape,
    /// Spacings of an axis.
    Spacing,
    /// Parts of the disc's equations.
    Contribution,
    /// Initial states of a system.
    SystemState,
    /// Units of bare numbers.
    Units,
    /// Normalisations of mode shapes.
    Normalisation,
    /// The part of a disc study that rotates.
    Rotating,
    /// What a design makes small.
    Objective,
    /// The runs that a design keeps quiet.
    DesignStart,
    /// Kinds of actuator.
    ActuatorKind,
}

impl Choice {
    /// The words.
    pub fn names(self) -> Vec<&'static str> {
        match self {
            Self::State => vec!["rest", "sliding", "squealing"],
            Self::Law => LawKind::ALL.iter().map(|law| law.name()).collect(),
            Self::Direction => Direction::ALL.iter().map(|direction| direction.name()).collect(),
            Self::ContactDirection => {
                Self::Direction.names().into_iter().chain([FRICTION]).collect()
            }
            Self::Waveform => Waveform::NAMES.to_vec(),
            Self::Carrier => Waveform::NAMED.iter().map(Waveform::name).collect(),
            Self::Hold => Hold::ALL.iter().map(|hold| hold.name()).collect(),
            Self::KnotShape => KnotShape::ALL.iter().map(|shape| shape.name()).collect(),
            Self::Spacing => vec!["linear", "log"],
            Self::SystemState => vec!["rest", "sliding", "squealing", "base"],
            Self::Units => UnitSystem::ALL.iter().map(|units| units.name()).collect(),
            Self::Normalisation => vec!["mass", "max"],
            Self::Contribution => Contribution::ALL.iter().map(|part| part.name()).collect(),
            Self::Rotating => vec!["loads", "disc"],
            Self::Objective => {
                DesignObjective::ALL.iter().map(|objective| objective.name()).collect()
            }
            Self::DesignStart => DesignStart::ALL.iter().map(|start| start.name()).collect(),
            Self::ActuatorKind => ActuatorKind::ALL.iter().map(|kind| kind.name()).collect(),
        }
    }
}
