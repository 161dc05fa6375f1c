//! The kinds of study, listed and matched here alone.

use quell_input::complaint::{Complaint, Origin};
use quell_input::document::Table;
use quell_model::System;
use quell_model::units::{Scales, UnitSystem};

use super::StudyOf;
use super::belt::{BeltSetup, BeltStudy};
use super::disc::{DiscSetup, DiscStudy};
use super::reader::Reader;
use super::study_kind::{StudyKind, wrong_kind};
use super::system::{self, SystemSetup, SystemStudy};
use super::template::Template;
use super::vocabulary::DocumentKind;

/// A checked study of any kind.
pub type Study = StudyOf<Kind>;

/// The kinds of study.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// A mass on a moving belt.
    Belt(Box<BeltSetup>),
    /// An annular disc under rotating loads.
    Disc(Box<DiscSetup>),
    /// A linear structure with friction contacts.
    System(Box<SystemSetup>),
}

impl Kind {
    /// Reads the system of a document and nothing else; `None` if something is wrong, which has then been reported.
    pub(super) fn assemble(reader: &mut Reader, document: &Table) -> Option<System> {
        match DocumentKind::of(document) {
            DocumentKind::Belt => {
                BeltSetup::assembled(reader, document).map(|setup| setup.system().system().clone())
            }
            DocumentKind::Disc => DiscSetup::read(reader, document).map(|setup| setup.equations()),
            DocumentKind::System => system::assemble(reader, document),
        }
    }

    /// Reads the system of a document with what its runs need; `None` if something is wrong, which has then been reported.
    pub(super) fn described(reader: &mut Reader, document: &Table) -> Option<SystemSetup> {
        Self::read(reader, document).map(|kind| kind.template().system(document))
    }

    /// What the equations are made from.
    pub(super) fn template(&self) -> &dyn Template {
        match self {
            Self::Belt(setup) => setup.as_ref(),
            Self::Disc(setup) => setup.as_ref(),
            Self::System(setup) => setup.as_ref(),
        }
    }

    /// Name of the kind.
    pub fn name(&self) -> &'static str {
        self.template().name()
    }
}

impl StudyKind for Kind {
    fn reader(document: &Table) -> Reader {
        match DocumentKind::of(document) {
            DocumentKind::Belt => BeltSetup::reader(document),
            DocumentKind::Disc => DiscSetup::reader(document),
            DocumentKind::System => SystemSetup::reader(document),
        }
    }

    fn read(reader: &mut Reader, document: &Table) -> Option<Self> {
        match DocumentKind::of(document) {
            DocumentKind::Belt => BeltSetup::read(reader, document).map(Self::from),
            DocumentKind::Disc => DiscSetup::read(reader, document).map(Self::from),
            DocumentKind::System => SystemSetup::read(reader, document).map(Self::from),
        }
    }
}

impl Study {
    /// The study of a belt.
    ///
    /// # Errors
    /// An error if it is of another kind.
    pub fn belt(&self) -> Result<BeltStudy, Box<Complaint>> {
        match self.kind() {
            Kind::Belt(setup) => Ok(self.narrowed(setup.as_ref())),
            _ => Err(self.not_a(BeltSetup::NAME)),
        }
    }

    /// The study of a disc.
    ///
    /// # Errors
    /// An error if it is of another kind.
    pub fn disc(&self) -> Result<DiscStudy, Box<Complaint>> {
        match self.kind() {
            Kind::Disc(setup) => Ok(self.narrowed(setup.as_ref())),
            _ => Err(self.not_a(DiscSetup::NAME)),
        }
    }

    /// The system that the study describes, in the units of its answers: a belt as one mass with its contact, a disc as its modes.
    pub fn system(&self) -> SystemStudy {
        self.map_kind(self.kind().template().system(&self.source.document))
    }

    /// The study as one of the kind of `setup`, which is its own setup as [`StudyOf::kind`] gives it.
    pub fn narrowed<K: StudyKind>(&self, setup: &K) -> StudyOf<K> {
        self.map_kind(setup.clone())
    }

    /// The error where a study of the kind `required` is needed.
    fn not_a(&self, required: &str) -> Box<Complaint> {
        Box::new(wrong_kind(required, self.kind().name(), Origin::Whole))
    }

    /// The units of the numbers of a study and of its answers, those of a belt with its mass and of a system.
    pub fn units(&self) -> UnitSystem {
        match self.kind() {
            Kind::Belt(setup) => setup.system().units(),
            Kind::Disc(_) => self.file_units(),
            Kind::System(setup) => setup.units(),
        }
    }

    /// Mass and stiffness of a belt's study in SI.
    pub fn scales(&self) -> Option<Scales> {
        match self.kind() {
            Kind::Belt(setup) => setup.belt().scales(),
            Kind::Disc(_) | Kind::System(_) => None,
        }
    }
}

impl From<BeltSetup> for Kind {
    fn from(setup: BeltSetup) -> Self {
        Self::Belt(Box::new(setup))
    }
}

impl From<DiscSetup> for Kind {
    fn from(setup: DiscSetup) -> Self {
        Self::Disc(Box::new(setup))
    }
}

impl From<SystemSetup> for Kind {
    fn from(setup: SystemSetup) -> Self {
        Self::System(Box::new(setup))
    }
}

impl From<BeltStudy> for Study {
    fn from(study: BeltStudy) -> Self {
        let kind = study.kind().clone().into();
        study.map_kind(kind)
    }
}

impl From<DiscStudy> for Study {
    fn from(study: DiscStudy) -> Self {
        let kind = study.kind().clone().into();
        study.map_kind(kind)
    }
}

impl From<SystemStudy> for Study {
    fn from(study: SystemStudy) -> Self {
        let kind = study.kind().clone().into();
        study.map_kind(kind)
    }
}

impl From<&SystemStudy> for Study {
    fn from(study: &SystemStudy) -> Self {
        study.clone().into()
    }
}

impl From<&BeltStudy> for Study {
    fn from(study: &BeltStudy) -> Self {
        study.clone().into()
    }
}

impl From<&DiscStudy> for Study {
    fn from(study: &DiscStudy) -> Self {
        study.clone().into()
    }
}

impl From<&Self> for Study {
    fn from(study: &Self) -> Self {
        study.clone()
    }
}
