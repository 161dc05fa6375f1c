//! What a question needs of a study: the one place that decides which verbs and which quantities of maps a study has, and the list of
//! the verbs.

use crate::complaint::{Complaint, Origin};
use crate::said::{Mention, Said};
use crate::study::{Kind, Study, not_available, not_periodic, varies_in_time};

/// The equations that a question is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StudyEquations {
    /// Those of any study.
    Any,
    /// Those of contacts of known tangents: belts and systems.
    Contacts,
    /// Those of one mass on a moving surface.
    OneMass,
    /// Those of one mass on a moving surface, written as a belt.
    Belt,
}

/// What a question needs of a study.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Needs {
    /// Its equations.
    pub of: StudyEquations,
    /// Whether the dither may be noise.
    pub under_noise: bool,
    /// Whether the drive, the load and the dither may vary in time.
    pub over_time: bool,
}

impl Needs {
    /// One run, or the declaration itself: any study.
    pub const RUN: Self = Self { of: StudyEquations::Any, under_noise: true, over_time: true };
    /// One run under a slow change of a drive, a load or an amplitude.
    pub const COURSE: Self = Self { under_noise: false, of: StudyEquations::Contacts, ..Self::RUN };
    /// Small motions about steady sliding, or averages over a dither.
    pub const SLIDING: Self = Self { over_time: false, ..Self::RUN };
    /// Friction of contacts that is averaged over a dither.
    pub const CONTACTS: Self = Self { of: StudyEquations::Contacts, ..Self::SLIDING };
    /// Averages of one mass, of which the limit of high frequency is known.
    pub const ONE_MASS: Self = Self { of: StudyEquations::OneMass, ..Self::SLIDING };
    /// A steady study whose dither, if it has one, repeats itself.
    pub const STEADY: Self = Self { under_noise: false, ..Self::SLIDING };
    /// Motions that repeat themselves.
    pub const MOTIONS: Self = Self { under_noise: false, ..Self::CONTACTS };

    /// The equations and the dither that it needs, in words.
    pub fn about(self) -> &'static str {
        match (self.of, self.under_noise) {
            (StudyEquations::Any, _) => "any study",
            (StudyEquations::Contacts, true) => "any belt or system",
            (StudyEquations::Contacts, false) => "any belt or system whose dither repeats itself",
            (StudyEquations::OneMass, _) => "one mass on a moving surface",
            (StudyEquations::Belt, _) => "any belt",
        }
    }

    /// Whether the equations of a study are those that it needs.
    pub fn suit(self, study: &Study) -> bool {
        match self.of {
            StudyEquations::Any => true,
            StudyEquations::Belt => matches!(study.kind(), Kind::Belt(_)),
            StudyEquations::Contacts => !matches!(study.kind(), Kind::Disc(_)),
            StudyEquations::OneMass => {
                let system = study.model().at(&[]);
                system.is_ok_and(|system| system.one_averaged_mass().is_some())
            }
        }
    }

    /// Whether a study meets them.
    pub fn are_met(self, study: &Study) -> bool {
        self.refused(study, "").is_none()
    }

    /// The complaint of `what` about a study that does not meet them.
    pub fn refused(self, study: &Study, what: &str) -> Option<Complaint> {
        if let Some(table) = study.varies_by().filter(|_| !self.over_time) {
            return Some(varies_in_time(what, table));
        }
        if !self.suit(study) {
            return Some(not_available(verb_said(what), study.kind().name(), Origin::Whole));
        }
        study.noise().filter(|_| !self.under_noise).map(|key| not_periodic(what, key))
    }
}

/// The name of a verb in a text.
fn verb_said(name: &str) -> Said {
    Said::default().mention(Mention::Verb(name.to_owned()))
}

/// A verb, or an option of it with other needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StudyVerb {
    /// Its name on the command line, with the option.
    pub name: &'static str,
    /// What it needs of a study.
    pub needs: Needs,
    /// Whether its answer has a picture.
    pub draws: bool,
}

const fn verb(name: &'static str, needs: Needs) -> StudyVerb {
    StudyVerb { name, needs, draws: true }
}

/// The verbs about a study, in the order of lists.
pub const VERBS: &[StudyVerb] = &[
    StudyVerb { draws: false, ..verb("check", Needs::RUN) },
    verb("sketch", Needs::RUN),
    verb("report", Needs::SLIDING),
    StudyVerb { draws: false, ..verb("cite", Needs::RUN) },
    verb("modes", Needs::SLIDING),
    verb("receptance", Needs::CONTACTS),
    verb("friction", Needs::CONTACTS),
    verb("friction --measured", Needs::MOTIONS),
    verb("friction --describing", Needs::CONTACTS),
    verb("stability", Needs::SLIDING),
    StudyVerb { draws: false, ..verb("stability --exact", Needs::MOTIONS) },
    verb("stability --parameter", Needs::MOTIONS),
    verb("simulate", Needs::RUN),
    verb("response", Needs::CONTACTS),
    verb("response --window", Needs::RUN),
    verb("orbit", Needs::MOTIONS),
    verb("attractor", Needs::MOTIONS),
    verb("thresholds", Needs::MOTIONS),
    verb("waveforms", Needs::MOTIONS),
    verb("design", Needs::STEADY),
    verb("actuator", Needs::STEADY),
    verb("probability", Needs::SLIDING),
    verb("bifurcation", Needs::MOTIONS),
    verb("bifurcation --ramp", Needs::COURSE),
    verb("basins", Needs::MOTIONS),
    verb("resonances", Needs::SLIDING),
    verb("compare", Needs::RUN),
    verb("fit --record", Needs::RUN),
    verb("map", Needs::SLIDING),
];

impl StudyVerb {
    /// The verb with this name.
    pub fn named(name: &str) -> Option<&'static Self> {
        VERBS.iter().find(|verb| verb.name == name)
    }
}
