//! A study of whatever it is about.

use std::path::{Path, PathBuf};

use quell_model::units::Scales;
use serde_json::Value as Json;

use super::disc::DiscStudy;
use super::mirror::Table;
use super::{Change, Study, Sweep, file};
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::input::Inputs;

/// A checked study of a belt or of a disc.
#[derive(Clone, Debug)]
pub enum Subject {
    /// A mass on a moving belt.
    Belt(Box<Study>),
    /// An annular disc under rotating loads.
    Disc(DiscStudy),
}

impl Subject {
    /// Reads and checks a study file (`-` is standard input) after changing it; one with a table `[disc]` is of a disc.
    ///
    /// # Errors
    /// Every complaint at once.
    pub fn read(path: &Path, changes: &[Change]) -> Result<Self, Failure> {
        let text = file::text(path)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let subject = Self::parse(&text, changes, folder).map_err(Failure::Wrong)?;
        Ok(subject.read_from(file::place(path)))
    }

    /// The same study, which was read from this file.
    #[must_use]
    pub fn read_from(self, file: PathBuf) -> Self {
        match self {
            Self::Belt(study) => Self::Belt(Box::new(study.read_from(file))),
            Self::Disc(study) => Self::Disc(study.read_from(file)),
        }
    }

    /// The files that it was read from: none of them is an output.
    pub fn inputs(&self) -> Inputs {
        match self {
            Self::Belt(study) => study.inputs(),
            Self::Disc(study) => study.inputs(),
        }
    }

    /// Checks the text of a study after changing it; a file that it names is looked for in `folder`.
    ///
    /// # Errors
    /// Every complaint at once.
    pub fn parse(text: &str, changes: &[Change], folder: &Path) -> Result<Self, Vec<Complaint>> {
        if Table::parse(text)?.has("disc") {
            DiscStudy::parse(text, changes, folder).map(Self::Disc)
        } else {
            Study::parse_in(text, changes, folder).map(|study| Self::Belt(Box::new(study)))
        }
    }

    /// The belt's study, where it is of one.
    pub fn belt(&self) -> Option<&Study> {
        match self {
            Self::Belt(study) => Some(study),
            Self::Disc(_) => None,
        }
    }

    /// The disc's study, where it is of one.
    pub fn disc(&self) -> Option<&DiscStudy> {
        match self {
            Self::Belt(_) => None,
            Self::Disc(study) => Some(study),
        }
    }

    /// The belt's study, for a verb that is about belts.
    ///
    /// # Errors
    /// A complaint where it is of a disc.
    pub fn the_belt(&self) -> Result<&Study, Box<Complaint>> {
        self.belt().ok_or_else(|| Box::new(not_of_a_belt(Origin::Whole)))
    }

    /// The disc's study, for a verb that is about discs.
    ///
    /// # Errors
    /// A complaint where it is of a belt.
    pub fn the_disc(&self) -> Result<&DiscStudy, Box<Complaint>> {
        self.disc().ok_or_else(|| {
            let allowed =
                "a disc study: this verb is about a disc ([disc]), and the study is of a belt";
            Box::new(Complaint::new(Fault::Missing, "disc", Origin::Whole, Json::Null, allowed))
        })
    }

    /// The study with its numbers set and no axes: see [`Study::at`].
    ///
    /// # Errors
    /// Every complaint about the changed study.
    pub fn at<'a>(
        &self,
        numbers: impl IntoIterator<Item = (&'a str, f64)>,
    ) -> Result<Self, Vec<Complaint>> {
        match self {
            Self::Belt(study) => study.at(numbers).map(|study| Self::Belt(Box::new(study))),
            Self::Disc(study) => study.at(numbers).map(Self::Disc),
        }
    }

    /// The study with these axes in place of its own: see [`Study::sweeping`].
    ///
    /// # Errors
    /// Every complaint about the axes.
    pub fn sweeping(&self, axes: &[Table]) -> Result<Self, Vec<Complaint>> {
        match self {
            Self::Belt(study) => study.sweeping(axes).map(|study| Self::Belt(Box::new(study))),
            Self::Disc(study) => study.sweeping(axes).map(Self::Disc),
        }
    }

    /// Title, if the file gives one.
    pub fn title(&self) -> Option<&str> {
        match self {
            Self::Belt(study) => study.title(),
            Self::Disc(study) => study.title(),
        }
    }

    /// The text of the file as it was read, without changes.
    pub fn text(&self) -> &str {
        match self {
            Self::Belt(study) => study.text(),
            Self::Disc(study) => study.text(),
        }
    }

    /// Changes made to the text, as `path=value`.
    pub fn changes(&self) -> &[String] {
        match self {
            Self::Belt(study) => study.changes(),
            Self::Disc(study) => study.changes(),
        }
    }

    /// The axes of a map, in order.
    pub fn sweeps(&self) -> &[Sweep] {
        match self {
            Self::Belt(study) => study.sweeps(),
            Self::Disc(study) => study.sweeps(),
        }
    }

    /// Every value of the study after its changes: see [`Study::settings`].
    pub fn settings(&self) -> Vec<(String, String)> {
        match self {
            Self::Belt(study) => study.settings(),
            Self::Disc(study) => study.settings(),
        }
    }

    /// Mass and stiffness of a belt's study in SI.
    pub fn scales(&self) -> Option<Scales> {
        self.belt().and_then(Study::scales)
    }
}

/// What a verb that is about belts says of a study of a disc.
pub(super) fn not_of_a_belt(origin: Origin) -> Complaint {
    let allowed = "this verb is about a belt ([belt], [friction]), and the study is of a disc, which has the verbs check, cite, \
                   modes, stability, resonances and map";
    Complaint::new(Fault::Conflict, "disc", origin, Json::Null, allowed)
}

impl From<&Study> for Subject {
    fn from(study: &Study) -> Self {
        Self::Belt(Box::new(study.clone()))
    }
}

impl From<&DiscStudy> for Subject {
    fn from(study: &DiscStudy) -> Self {
        Self::Disc(study.clone())
    }
}

impl From<&Subject> for Subject {
    fn from(study: &Subject) -> Self {
        study.clone()
    }
}
