//! What a study has that decides which sources and corrections concern it.

use quell_model::system::InputTarget;
use quell_model::{Contact, Direction, LawKind, System};

use crate::study::{DiscStudy, Study};

/// A study as its sources see it: a belt is its system.
pub(super) enum CitedStudy {
    /// The system of a study, or of a belt.
    System(Box<System>),
    /// A disc.
    Disc(Box<DiscStudy>),
}

impl CitedStudy {
    /// That of a study.
    pub(super) fn of(study: &Study) -> Self {
        match study.disc() {
            Ok(disc) => Self::Disc(Box::new(disc)),
            Err(_) => Self::System(Box::new(study.system().system().clone())),
        }
    }

    /// The system, unless it is a disc.
    pub(super) fn system(&self) -> Option<&System> {
        match self {
            Self::System(system) => Some(system),
            Self::Disc(_) => None,
        }
    }

    /// The disc, if it is one.
    pub(super) fn disc(&self) -> Option<&DiscStudy> {
        match self {
            Self::System(_) => None,
            Self::Disc(disc) => Some(disc),
        }
    }

    /// Whether it is one mass on a moving surface, the belt of the dissertation.
    pub(super) fn is_one_mass(&self) -> bool {
        self.system().is_some_and(|system| {
            let mechanical = system.structure.mechanical();
            mechanical.is_some_and(|structure| structure.size() == 1) && system.contacts.len() == 1
        })
    }

    /// Whether it is a system of another structure.
    pub(super) fn is_larger(&self) -> bool {
        self.system().is_some() && !self.is_one_mass()
    }

    /// Whether a system has a contact of some kind.
    pub(super) fn has_contact(&self, is_so: impl Fn(&Contact) -> bool) -> bool {
        self.system().is_some_and(|system| system.contacts.iter().any(is_so))
    }

    /// Whether a contact of a system has a law of this kind.
    pub(super) fn has_law(&self, kind: LawKind) -> bool {
        self.has_contact(|contact| contact.friction.kind() == kind)
    }

    /// Whether a system has a dither, of any amplitude.
    pub(super) fn has_waves(&self) -> bool {
        self.system().is_some_and(System::has_waves)
    }

    /// Whether a system has dither that is noise.
    pub(super) fn has_noise(&self) -> bool {
        self.system().is_some_and(System::has_noise)
    }

    /// Whether a mass has dither along a direction, and of a waveform if one is given.
    pub(super) fn has_dither(&self, direction: Direction, waveform: Option<&str>) -> bool {
        let Some(system) = self.system().filter(|_| self.is_one_mass()) else { return false };
        let along = system.inputs.iter().filter(|input| match input.target {
            InputTarget::Force(_) => direction == Direction::Tangential,
            InputTarget::NormalLoad { .. } => direction == Direction::Normal,
            InputTarget::Friction { .. } => false,
        });
        along
            .flat_map(|input| input.profile.waves())
            .any(|wave| waveform.is_none_or(|name| wave.waveform.name() == name))
    }
}
