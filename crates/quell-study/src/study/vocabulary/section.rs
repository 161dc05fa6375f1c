//! The tables of a study file.

use quell_input::document::Table;
use quell_model::friction::expression;

use super::course::{CourseTable, DISC_DRIVE, DRIVE, ENVELOPE, LOAD, LOAD_ENVELOPE};
use super::distributions::{CORRELATED, DISTRIBUTIONS, JOINTLY_NORMAL};

/// A table of the study file, in its order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Section {
    /// Keys outside any table.
    Root,
    /// `[belt]`.
    Belt,
    /// `[belt.initial]`.
    Initial,
    /// `[belt.drive]`, `[contact.drive]`.
    Drive,
    /// `[belt.drive.oscillation]`, `[contact.drive.oscillation]`.
    DriveOscillation,
    /// `[belt.load]`, `[contact.load]`.
    Load,
    /// `[belt.load.oscillation]`, `[contact.load.oscillation]`.
    LoadOscillation,
    /// `[friction]`, `[contact.friction]`.
    Friction,
    /// `[friction.constants]`, whose names a study chooses.
    Constants,
    /// `[disc]`.
    Disc,
    /// `[[disc.mode]]`.
    DiscMode,
    /// `[disc.load]` or `[[disc.load]]`.
    DiscLoad,
    /// `[disc.drive]`.
    DiscDrive,
    /// `[disc.drive.oscillation]`.
    DiscDriveOscillation,
    /// `[disc.load.envelope]`.
    LoadEnvelope,
    /// `[disc.load.envelope.oscillation]`.
    LoadEnvelopeOscillation,
    /// `[system]`.
    System,
    /// `[[system.mode]]`.
    Mode,
    /// `[[system.component]]`.
    Component,
    /// `[system.initial]`.
    SystemInitial,
    /// `[[contact]]`.
    Contact,
    /// `[dither]` or `[[dither]]`.
    Dither,
    /// `[dither.envelope]`.
    Envelope,
    /// `[parameters]`, whose names a study chooses.
    Parameters,
    /// `[solver]`.
    Solver,
    /// `[response]`.
    Response,
    /// `[design]`.
    Design,
    /// `[design.limits]`.
    DesignLimits,
    /// `[[design.places]]`.
    DitherPlace,
    /// `[actuator]`.
    Actuator,
    /// `[uncertainty]`, which has a reader of its own.
    Uncertainty,
    /// `[[sweep]]`.
    Sweep,
}

impl Section {
    /// Every table, in the order of a study file.
    pub const ALL: &'static [Self] = &[
        Self::Root,
        Self::Belt,
        Self::Initial,
        Self::Drive,
        Self::DriveOscillation,
        Self::Load,
        Self::LoadOscillation,
        Self::Friction,
        Self::Constants,
        Self::Disc,
        Self::DiscMode,
        Self::DiscLoad,
        Self::DiscDrive,
        Self::DiscDriveOscillation,
        Self::LoadEnvelope,
        Self::LoadEnvelopeOscillation,
        Self::System,
        Self::Mode,
        Self::Component,
        Self::SystemInitial,
        Self::Contact,
        Self::Dither,
        Self::Envelope,
        Self::Parameters,
        Self::Solver,
        Self::Response,
        Self::Design,
        Self::DesignLimits,
        Self::DitherPlace,
        Self::Actuator,
        Self::Uncertainty,
        Self::Sweep,
    ];

    /// Path of the table; empty for the root.
    pub fn path(self) -> &'static str {
        match self {
            Self::Root => "",
            Self::Belt => "belt",
            Self::Initial => "belt.initial",
            Self::Drive => "belt.drive",
            Self::DriveOscillation => "belt.drive.oscillation",
            Self::Load => "belt.load",
            Self::LoadOscillation => "belt.load.oscillation",
            Self::Friction => "friction",
            Self::Constants => expression::CONSTANTS,
            Self::Disc => "disc",
            Self::DiscMode => "disc.mode",
            Self::DiscLoad => "disc.load",
            Self::DiscDrive => "disc.drive",
            Self::DiscDriveOscillation => "disc.drive.oscillation",
            Self::LoadEnvelope => "disc.load.envelope",
            Self::LoadEnvelopeOscillation => "disc.load.envelope.oscillation",
            Self::System => "system",
            Self::Mode => "system.mode",
            Self::Component => "system.component",
            Self::SystemInitial => "system.initial",
            Self::Contact => "contact",
            Self::Dither => "dither",
            Self::Envelope => "dither.envelope",
            Self::Parameters => "parameters",
            Self::Solver => "solver",
            Self::Response => "response",
            Self::Design => "design",
            Self::DesignLimits => "design.limits",
            Self::DitherPlace => "design.places",
            Self::Actuator => "actuator",
            Self::Uncertainty => "uncertainty",
            Self::Sweep => "sweep",
        }
    }

    /// Contents of the table, in one line.
    pub fn about(self) -> &'static str {
        match self {
            Self::Root => "a study: a belt with its friction law, a disc or a system, and dither",
            Self::Disc => "annular disc under rotating loads",
            Self::DiscMode => "a mode of the disc, if modes are listed instead of computed",
            Self::DiscLoad => {
                "mass, damper, spring and friction at a point; several as [[disc.load]]"
            }
            Self::Belt => "mass, spring and damper on a moving belt",
            Self::Initial | Self::SystemInitial => "initial state of a run [default: at rest]",
            Self::Drive => {
                "velocity of the surface over time: knots instead of belt_velocity, or an oscillation added to it"
            }
            Self::DriveOscillation
            | Self::LoadOscillation
            | Self::DiscDriveOscillation
            | Self::LoadEnvelopeOscillation => "a sine that is added to the constant value",
            Self::Load => {
                "normal load over time: knots instead of normal_load, or an oscillation added to it"
            }
            Self::Friction => "the friction law",
            Self::Constants => "named numbers of a formula",
            Self::System => "the linear structure",
            Self::Mode => "a mode of the structure",
            Self::Component => "a body given by its modes; several are joined by contacts",
            Self::Contact => "a friction contact",
            Self::Dither => "one dither force; several as [[dither]]",
            Self::DiscDrive => {
                "speed of the disc over time: knots instead of disc.load.speed, or an oscillation added to it"
            }
            Self::LoadEnvelope => "share of the normal load, and with it of friction, over time",
            Self::Envelope => "share of the amplitude over time",
            Self::Parameters => {
                "named numbers for formulas: numbers, or formulas of other parameters"
            }
            Self::Solver => "accuracy and length of the computations",
            Self::Response => {
                "measurements of a response in addition to the band of slow vibration"
            }
            Self::Design => "the least dither over a box of operating points",
            Self::DesignLimits => "limits of the dither that is designed",
            Self::DitherPlace => {
                "places that are tried in turn, each by the keys of a dither that say where it acts [default: its own]"
            }
            Self::Actuator => "the actuator that gives the dither",
            Self::Uncertainty => "distributions of numbers that are not known exactly",
            Self::Sweep => "one axis of a map; several in order",
        }
    }

    /// What a table over time gives.
    pub fn course(self) -> Option<CourseTable> {
        match self {
            Self::Drive => Some(DRIVE),
            Self::Load => Some(LOAD),
            Self::DiscDrive => Some(DISC_DRIVE),
            Self::LoadEnvelope => Some(LOAD_ENVELOPE),
            Self::Envelope => Some(ENVELOPE),
            _ => None,
        }
    }

    /// The table over time of which it is the oscillation.
    pub fn oscillates(self) -> Option<CourseTable> {
        match self {
            Self::DriveOscillation => Some(DRIVE),
            Self::LoadOscillation => Some(LOAD),
            Self::DiscDriveOscillation => Some(DISC_DRIVE),
            Self::LoadEnvelopeOscillation => Some(LOAD_ENVELOPE),
            _ => None,
        }
    }

    /// The studies that have the table.
    pub fn scope(self) -> KeyScope {
        match self {
            Self::Belt | Self::Initial | Self::Solver | Self::Response => KeyScope::BELT,
            Self::Disc
            | Self::DiscMode
            | Self::DiscLoad
            | Self::DiscDrive
            | Self::DiscDriveOscillation
            | Self::LoadEnvelope
            | Self::LoadEnvelopeOscillation => KeyScope::DISC,
            Self::System
            | Self::Mode
            | Self::Component
            | Self::SystemInitial
            | Self::Contact
            | Self::Parameters
            | Self::DitherPlace => KeyScope::SYSTEM,
            Self::Drive | Self::DriveOscillation | Self::Load | Self::LoadOscillation => {
                KeyScope::BELT_OR_SYSTEM
            }
            Self::Root
            | Self::Friction
            | Self::Constants
            | Self::Dither
            | Self::Envelope
            | Self::Design
            | Self::DesignLimits
            | Self::Actuator
            | Self::Uncertainty
            | Self::Sweep => KeyScope::EVERY,
        }
    }

    /// Whether entries of this list are also found by their names.
    pub(in crate::study) fn has_named_entries(self) -> bool {
        matches!(self, Self::Contact | Self::Component)
    }

    /// Whether the study chooses the names of its keys.
    pub(in crate::study) fn has_own_names(self) -> bool {
        matches!(self, Self::Constants | Self::Parameters)
    }

    /// The keys of a table that are no entries of the table of keys, because the study chooses them: name, kind of value and description.
    pub fn chosen_keys(self) -> Vec<(&'static str, &'static str, String)> {
        match self {
            Self::Parameters => {
                vec![("NAME", "number", "a number, or a formula of other parameters".to_owned())]
            }
            Self::Constants => vec![("NAME", "number", "a constant of the formula".to_owned())],
            Self::Uncertainty => {
                let kinds =
                    DISTRIBUTIONS.map(|(name, numbers)| format!("{{ {name} = {numbers} }}"));
                let number =
                    format!("the distribution of the number at a path: {}", kinds.join(" or "));
                vec![
                    ("\"PATH\"", "table", number),
                    ("covariance", "table", format!("{JOINTLY_NORMAL}: of (paths), mean, matrix")),
                    ("correlation", "table", format!("{CORRELATED}: of (paths), matrix")),
                ]
            }
            _ => Vec::new(),
        }
    }
}

/// The kind of study that a document describes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DocumentKind {
    /// A belt.
    Belt,
    /// A disc.
    Disc,
    /// A system.
    System,
}

impl DocumentKind {
    /// The kinds, in the order of [`quell_model::PARAMETERS`].
    pub const ALL: [Self; 3] = [Self::Belt, Self::Disc, Self::System];

    /// That of a document, by its tables.
    pub(in crate::study) fn of(document: &Table) -> Self {
        let has = |section: Section| document.has(section.path());
        match (has(Section::System), has(Section::Disc)) {
            (true, _) => Self::System,
            (false, true) => Self::Disc,
            (false, false) => Self::Belt,
        }
    }

    /// The scope of its studies alone.
    pub fn scope(self) -> KeyScope {
        self.section().scope()
    }

    /// Its table.
    pub fn section(self) -> Section {
        match self {
            Self::Belt => Section::Belt,
            Self::Disc => Section::Disc,
            Self::System => Section::System,
        }
    }
}

/// The studies that have a key: a bit for each kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KeyScope(u8);

impl KeyScope {
    /// Those of a belt.
    pub const BELT: Self = Self::of(DocumentKind::Belt);
    /// Those of a disc.
    pub const DISC: Self = Self::of(DocumentKind::Disc);
    /// Those of a system.
    pub const SYSTEM: Self = Self::of(DocumentKind::System);
    /// Those of a belt or a system.
    pub const BELT_OR_SYSTEM: Self = Self::BELT.or(Self::SYSTEM);
    /// Those of a belt or a disc.
    pub const BELT_OR_DISC: Self = Self::BELT.or(Self::DISC);
    /// All of them.
    pub const EVERY: Self = Self::BELT_OR_DISC.or(Self::SYSTEM);

    /// Those of a kind.
    pub const fn of(kind: DocumentKind) -> Self {
        Self(1 << kind as u8)
    }

    /// Those of either.
    #[must_use]
    pub const fn or(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Those of both.
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// Whether studies of a kind are among them.
    pub const fn includes(self, kind: DocumentKind) -> bool {
        self.and(Self::of(kind)).0 != 0
    }
}
