//! Every key a study file can have, made from the registry of parameters.
//!
//! One list serves the reader, `--set`, sweeps, suggestions and the JSON Schema.

use std::sync::LazyLock;

use quell_model::friction::expression;
use quell_model::parameter::{COEFFICIENT, Parameter, ScaleKey, SiTwin};
use quell_model::units::Quantity;

use super::suggest;

mod keys;
mod words;

pub use words::Choice;

/// Version of the study file that this program reads.
pub const SCHEMA_VERSION: u32 = 1;

/// What the key `schema` of a study is.
pub const SCHEMA_ABOUT: &str = "version of the study file; 1 where it is left out";

/// Tables of the design that are not built yet.
pub const NOT_BUILT: &[&str] =
    &["system", "contact", "input", "actuator", "design", "uncertainty", "sample", "profile"];

/// Most points an axis of a map may have.
pub const MOST_POINTS: u32 = 10_000_000;

/// A table of the study file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Section {
    /// Keys outside any table.
    Root,
    /// `[belt]`.
    Belt,
    /// `[belt.initial]`.
    Initial,
    /// `[friction]`.
    Friction,
    /// `[friction.constants]`, whose names a study chooses.
    Constants,
    /// `[disc]`.
    Disc,
    /// `[[disc.mode]]`.
    DiscMode,
    /// `[disc.load]` or `[[disc.load]]`.
    DiscLoad,
    /// `[dither]` or `[[dither]]`.
    Dither,
    /// `[solver]`.
    Solver,
    /// `[response]`.
    Response,
    /// `[[sweep]]`.
    Sweep,
}

impl Section {
    /// Every table, in the order of a study file.
    pub const ALL: &'static [Self] = &[
        Self::Root,
        Self::Belt,
        Self::Initial,
        Self::Friction,
        Self::Constants,
        Self::Disc,
        Self::DiscMode,
        Self::DiscLoad,
        Self::Dither,
        Self::Solver,
        Self::Response,
        Self::Sweep,
    ];

    /// Path of the table; empty for the root.
    pub fn path(self) -> &'static str {
        match self {
            Self::Root => "",
            Self::Belt => "belt",
            Self::Initial => "belt.initial",
            Self::Friction => "friction",
            Self::Constants => expression::CONSTANTS,
            Self::Disc => "disc",
            Self::DiscMode => "disc.mode",
            Self::DiscLoad => "disc.load",
            Self::Dither => "dither",
            Self::Solver => "solver",
            Self::Response => "response",
            Self::Sweep => "sweep",
        }
    }

    /// What the table holds.
    pub fn about(self) -> &'static str {
        match self {
            Self::Root => "a study: a belt with its friction law or a disc, and dither",
            Self::Disc => "annular disc under loads that rotate over it",
            Self::DiscMode => "a mode of the disc, where modes are listed instead of computed",
            Self::DiscLoad => {
                "mass, damper, spring and friction at a point; several as [[disc.load]]"
            }
            Self::Belt => "mass, spring and damper on a moving belt",
            Self::Initial => "where a run starts; at rest by default",
            Self::Friction => "the friction law",
            Self::Constants => "named numbers of a formula",
            Self::Dither => "one dither force; several as [[dither]]",
            Self::Solver => "accuracy and length of the computations",
            Self::Response => "what is measured of a response besides the band of slow vibration",
            Self::Sweep => "one axis of a map; several in order",
        }
    }
}

/// What a key takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Role {
    /// A parameter in the numbers of the equations.
    Number(Parameter),
    /// A parameter in SI.
    Twin(Parameter, SiTwin),
    /// A number that makes the scales of a study in SI.
    Scale(ScaleKey),
    /// A word out of a list.
    Choice(Choice),
    /// Free text.
    Text,
    /// The version of the file.
    Schema,
    /// Words out of a list, as an array.
    Choices(Choice),
    /// The reference frequency of a disc: "critical", or a frequency parameter k².
    Reference,
    /// A formula of the friction coefficient, measured coefficients, or the number of a named law.
    Coefficient,
    /// Friction as a force in SI, which gives this number of a named law.
    FrictionForce(Parameter, &'static str),
    /// Measured slip speeds, in SI or not.
    Speeds {
        /// In metres per second.
        si: bool,
    },
    /// The two ends of a band of frequencies, in hertz or in ω₀.
    Band {
        /// In hertz.
        hertz: bool,
    },
    /// The number of terms of a fit.
    Terms,
    /// A named number of a formula.
    Constant,
    /// A bare number of an axis, in the unit of the parameter it names.
    AxisNumber,
    /// The number of points of an axis.
    AxisPoints,
    /// The list of values of an axis.
    AxisValues,
}

/// One key of the study file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key {
    /// The table it stands in.
    pub section: Section,
    /// Its name inside the table.
    pub name: &'static str,
    /// What it takes.
    pub role: Role,
    /// What it is, in one line.
    pub about: &'static str,
}

impl Key {
    /// Its path without index.
    pub fn path(&self) -> String {
        join(self.section.path(), self.name)
    }

    /// The parameter it gives, in SI or not.
    pub fn parameter(&self) -> Option<Parameter> {
        match self.role {
            Role::Number(parameter) | Role::Twin(parameter, _) => Some(parameter),
            Role::Coefficient => Some(COEFFICIENT),
            _ => None,
        }
    }

    /// Whether it takes a number that can be varied.
    pub fn takes_number(&self) -> bool {
        let scale = matches!(self.role, Role::Scale(_) | Role::Constant | Role::FrictionForce(..));
        scale || self.parameter().is_some()
    }

    /// Unit of its value.
    pub fn unit(&self) -> &'static str {
        match self.role {
            Role::Number(parameter) => parameter.quantity.scaled_unit(),
            Role::Twin(_, twin) => twin.unit,
            Role::Scale(scale) => scale.unit,
            Role::FrictionForce(_, unit) => unit,
            Role::Speeds { si: true } => "m/s",
            Role::Speeds { si: false } => Quantity::Velocity.scaled_unit(),
            Role::Band { hertz: true } => "Hz",
            Role::Band { hertz: false } => Quantity::FrequencyRatio.scaled_unit(),
            _ => "1",
        }
    }

    /// Unit in words; frequencies of a disc are counted in ω_ref.
    pub fn unit_in_words(&self) -> &'static str {
        if self.is_of_a_disc() && self.unit() == "ω₀" { "ω_ref" } else { self.unit() }
    }

    /// The unit in which a number with a unit is read, such as `5.7kN` for a key in newtons; `None` for numbers of
    /// the equations and whatever else has no unit.
    pub fn measured_in(&self) -> Option<&'static str> {
        match self.role {
            Role::Number(parameter) => match parameter.quantity {
                Quantity::Ratio | Quantity::DampingRatio => Some("1"),
                Quantity::Angle => Some("rad"),
                quantity => quantity.own_unit(),
            },
            Role::Twin(_, twin) => Some(twin.unit.trim_end_matches(" (rms)")),
            Role::Scale(scale) => Some(scale.unit),
            Role::Speeds { si: true } => Some("m/s"),
            Role::Band { hertz: true } => Some("Hz"),
            Role::FrictionForce(_, unit) => Some(unit),
            Role::Constant => Some("1"),
            _ => None,
        }
    }

    fn is_of_a_disc(&self) -> bool {
        matches!(self.section, Section::Disc | Section::DiscMode | Section::DiscLoad)
    }
}

/// `table.key`, or `key` alone at the root.
pub fn join(table: &str, key: &str) -> String {
    if table.is_empty() { key.to_owned() } else { format!("{table}.{key}") }
}

/// Every key, table by table.
pub fn keys() -> &'static [Key] {
    static KEYS: LazyLock<Vec<Key>> = LazyLock::new(keys::all);
    &KEYS
}

/// The key of any named number of a formula.
static CONSTANT: Key = Key {
    section: Section::Constants,
    name: "NAME",
    role: Role::Constant,
    about: "a named number of the formula",
};

/// Keys of one table.
pub fn keys_of(section: Section) -> impl Iterator<Item = &'static Key> {
    keys().iter().filter(move |key| key.section == section)
}

/// The key of a name in a table.
pub fn key(section: Section, name: &str) -> Option<&'static Key> {
    keys_of(section).find(|key| key.name == name)
}

/// A key with the entry of the list it stands in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Address {
    /// The key.
    pub key: &'static Key,
    /// Which `[[dither]]` or `[[sweep]]`, counted from 0, where one was named.
    pub index: Option<usize>,
}

/// Finds what a path such as `dither[1].amplitude_n` names.
///
/// # Errors
/// The nearest path there is, if any is near.
pub fn resolve(path: &str) -> Result<Address, Option<String>> {
    let path = path.trim();
    let (table, name) = path.rsplit_once('.').unwrap_or(("", path));
    let (table, index) = match table.split_once('[') {
        Some((table, rest)) => match rest.strip_suffix(']').and_then(|text| text.parse().ok()) {
            Some(index) => (table, Some(index)),
            None => return Err(None),
        },
        None => (table, None),
    };
    let section = Section::ALL.iter().copied().find(|section| section.path() == table);
    if section == Some(Section::Constants) && index.is_none() && expression::is_name(name) {
        return Ok(Address { key: &CONSTANT, index: None });
    }
    let listed = matches!(
        section,
        Some(Section::Dither | Section::Sweep | Section::DiscMode | Section::DiscLoad)
    );
    let found = section.and_then(|section| key(section, name));
    match found {
        Some(key) if listed || index.is_none() => Ok(Address { key, index }),
        _ => Err(suggest::path(table, name, index)),
    }
}

/// The path that gives the same number in a study in SI, or in one without; a path that names none stays as it is.
pub fn in_system(path: &str, si: bool) -> String {
    let Ok(address) = resolve(path) else {
        return path.to_owned();
    };
    let key = match (address.key.role, si) {
        (Role::Number(parameter), true) if !parameter.is_pure() => {
            parameter.si.iter().find(|twin| !twin.rms).map(|twin| twin.key)
        }
        (Role::Twin(parameter, _), false) => Some(parameter.key()),
        _ => None,
    };
    match (key, path.rsplit_once('.')) {
        (Some(key), Some((table, _))) => join(table, key),
        _ => path.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_unique_and_resolve_to_themselves() {
        let mut paths: Vec<String> = keys().iter().map(Key::path).collect();
        for path in &paths {
            let address = resolve(path).expect(path);
            assert_eq!(&address.key.path(), path);
        }
        paths.sort();
        let count = paths.len();
        paths.dedup();
        assert_eq!(paths.len(), count);
    }

    #[test]
    fn every_parameter_stands_in_its_table() {
        for key in keys() {
            if let Role::Number(parameter) = key.role {
                assert_eq!(key.path(), parameter.path);
            }
        }
    }

    #[test]
    fn indices_belong_to_lists_alone() {
        assert_eq!(resolve("dither[1].amplitude_n").map(|found| found.index), Ok(Some(1)));
        assert!(resolve("belt[0].damping_ratio").is_err());
        assert!(resolve("dither[one].amplitude").is_err());
    }
}
