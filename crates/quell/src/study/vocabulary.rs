//! Every key a study file can have, made from the registry of parameters.
//!
//! One list serves the reader, `--set`, sweeps, suggestions and the JSON Schema.

use std::sync::LazyLock;

use quell_disc::system::Contribution;
use quell_model::friction::expression;
use quell_model::parameter::{self, Parameter, ScaleKey, SiTwin};
use quell_model::units::Quantity;
use quell_model::{Direction, LawKind, Waveform};

use super::suggest;

/// Version of the study file that this program reads.
pub const SCHEMA_VERSION: u32 = 1;

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
            Self::Sweep => "one axis of a map; several in order",
        }
    }
}

/// A list of words.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Choice {
    /// Initial states.
    State,
    /// Friction laws.
    Law,
    /// Directions of dither.
    Direction,
    /// Waveforms of dither.
    Waveform,
    /// Spacings of an axis.
    Spacing,
    /// Parts of the disc's equations.
    Contribution,
}

impl Choice {
    /// The words.
    pub fn names(self) -> Vec<&'static str> {
        match self {
            Self::State => vec!["rest", "sliding", "squealing"],
            Self::Law => LawKind::ALL.iter().map(|law| law.name()).collect(),
            Self::Direction => Direction::ALL.iter().map(|direction| direction.name()).collect(),
            Self::Waveform => Waveform::ALL.iter().map(|waveform| waveform.name()).collect(),
            Self::Spacing => vec!["linear", "log"],
            Self::Contribution => Contribution::ALL.iter().map(|part| part.name()).collect(),
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
    /// A formula of the friction coefficient, or measured coefficients.
    Coefficient,
    /// Measured slip speeds, in SI or not.
    Speeds {
        /// In metres per second.
        si: bool,
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
            _ => None,
        }
    }

    /// Unit of its value.
    pub fn unit(&self) -> &'static str {
        match self.role {
            Role::Number(parameter) => parameter.quantity.scaled_unit(),
            Role::Twin(_, twin) => twin.unit,
            Role::Scale(scale) => scale.unit,
            Role::Speeds { si: true } => "m/s",
            Role::Speeds { si: false } => Quantity::Velocity.scaled_unit(),
            _ => "1",
        }
    }

    /// Unit in words, also of the disc's keys, which carry it in their names.
    pub fn unit_in_words(&self) -> &'static str {
        let units = [
            ("_kg_per_m3", "kg/m³"),
            ("_pa", "Pa"),
            ("_hz", "Hz"),
            ("_deg", "degrees"),
            ("_m", "m"),
        ];
        let disc = matches!(self.section, Section::Disc | Section::DiscMode | Section::DiscLoad);
        let found = units.iter().find(|(suffix, _)| disc && self.name.ends_with(suffix));
        match found {
            Some((_, unit)) => unit,
            None if disc && self.unit() == "ω₀" => "ω_ref",
            None => self.unit(),
        }
    }
}

/// `table.key`, or `key` alone at the root.
pub(crate) fn join(table: &str, key: &str) -> String {
    if table.is_empty() { key.to_owned() } else { format!("{table}.{key}") }
}

/// Every key, table by table.
pub fn keys() -> &'static [Key] {
    static KEYS: LazyLock<Vec<Key>> = LazyLock::new(build);
    &KEYS
}

fn build() -> Vec<Key> {
    let mut keys = words();
    keys.extend(numbers());
    keys.extend(own_law());
    keys.extend(disc());
    keys.extend(axis());
    keys.sort_by_key(|key| Section::ALL.iter().position(|section| *section == key.section));
    keys
}

/// Keys that take words.
fn words() -> Vec<Key> {
    use Section::{Dither, Friction, Initial, Root};
    let word =
        |section, name, choice, about| Key { section, name, role: Role::Choice(choice), about };
    let root = |name, role, about| Key { section: Root, name, role, about };
    vec![
        root("schema", Role::Schema, "version of the study file"),
        root("title", Role::Text, "what the study is about"),
        word(Initial, "state", Choice::State, "a named state"),
        word(Friction, "law", Choice::Law, "the friction law"),
        word(Dither, "direction", Choice::Direction, "where the force acts"),
        word(Dither, "waveform", Choice::Waveform, "shape of the force in time"),
    ]
}

/// Keys that take a number of the registry, in the numbers of the equations or in SI.
fn numbers() -> Vec<Key> {
    let scales = parameter::SCALES.iter().map(|scale| Key {
        section: Section::Belt,
        name: scale.key(),
        role: Role::Scale(*scale),
        about: scale.about,
    });
    let mut keys: Vec<Key> = scales.collect();
    let mut parameters = parameter::BELT.to_vec();
    // The disc's dither has the keys of the belt's.
    let own = |parameter: &&Parameter| parameter.table() == "disc";
    parameters.extend(parameter::disc::DISC.iter().filter(own));
    for parameter in LawKind::ALL.iter().flat_map(|law| law.parameters()) {
        if !parameters.iter().any(|known| known.path == parameter.path) {
            parameters.push(*parameter);
        }
    }
    for parameter in parameters {
        let table = parameter.path.strip_suffix(parameter.key()).unwrap_or_default();
        let at = |section: &&Section| section.path() == table.trim_end_matches('.');
        let section = Section::ALL.iter().find(at).copied().unwrap_or(Section::Root);
        let about = parameter.about;
        keys.push(Key { section, name: parameter.key(), role: Role::Number(parameter), about });
        keys.extend(parameter.si.iter().map(|&twin| Key {
            section,
            name: twin.key,
            role: Role::Twin(parameter, twin),
            about,
        }));
    }
    keys
}

/// Keys of a friction law of one's own.
fn own_law() -> Vec<Key> {
    let key = |name, role, about| Key { section: Section::Friction, name, role, about };
    vec![
        key(
            "coefficient",
            Role::Coefficient,
            "formula of the coefficient in the slip velocity v, or measured coefficients",
        ),
        key(
            "file",
            Role::Text,
            "CSV file of measured slip speeds and coefficients, beside the study",
        ),
        key("slip_velocity", Role::Speeds { si: false }, "measured slip speeds"),
        key("slip_velocity_m_per_s", Role::Speeds { si: true }, "measured slip speeds"),
        key(
            "terms",
            Role::Terms,
            "number of exponentials of the fit, the best where it is not given",
        ),
    ]
}

/// The key of any named number of a formula.
static CONSTANT: Key = Key {
    section: Section::Constants,
    name: "NAME",
    role: Role::Constant,
    about: "a named number of the formula",
};

/// Keys of a disc that take no number of the registry.
fn disc() -> Vec<Key> {
    let key = |name, role, about| Key { section: Section::Disc, name, role, about };
    vec![
        key(
            "reference_frequency",
            Role::Reference,
            "what frequencies and speeds are measured in: \"critical\", the lowest critical speed of these modes, \
             or a frequency parameter k²",
        ),
        key(
            "modes_file",
            Role::Text,
            "CSV file of modes, beside the study, instead of computed ones",
        ),
        key(
            "without",
            Role::Choices(Choice::Contribution),
            "parts of the equations that are left out",
        ),
    ]
}

/// Keys of an axis.
fn axis() -> Vec<Key> {
    let key = |name, role, about| Key { section: Section::Sweep, name, role, about };
    vec![
        key("parameter", Role::Text, "path of the number that is varied"),
        key("from", Role::AxisNumber, "first value"),
        key("to", Role::AxisNumber, "last value"),
        key("points", Role::AxisPoints, "number of values, both ends included"),
        key("values", Role::AxisValues, "the values themselves, instead of from, to and points"),
        key("spacing", Role::Choice(Choice::Spacing), "how the values lie between the ends"),
    ]
}

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
