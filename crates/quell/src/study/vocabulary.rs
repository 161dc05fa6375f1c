//! Every key a study file can have, made from the registry of parameters.
//!
//! One list serves the reader, `--set`, sweeps, suggestions and the JSON Schema.

use std::sync::LazyLock;

use quell_model::parameter::{self, Parameter, ScaleKey, SiTwin};
use quell_model::{Direction, LawKind, Waveform};

use super::suggest;

/// Version of the study file that this program reads.
pub const SCHEMA_VERSION: u32 = 1;

/// Tables of the design that are not built yet.
pub const NOT_BUILT: &[&str] = &[
    "disc",
    "system",
    "contact",
    "input",
    "actuator",
    "design",
    "uncertainty",
    "sample",
    "profile",
];

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
            Self::Dither => "dither",
            Self::Solver => "solver",
            Self::Sweep => "sweep",
        }
    }

    /// What the table holds.
    pub fn about(self) -> &'static str {
        match self {
            Self::Root => "a study: one belt, its friction law, its dither",
            Self::Belt => "mass, spring and damper on a moving belt",
            Self::Initial => "where a run starts; at rest by default",
            Self::Friction => "the friction law",
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
}

impl Choice {
    /// The words.
    pub fn names(self) -> Vec<&'static str> {
        match self {
            Self::State => vec!["rest", "sliding", "squealing"],
            Self::Law => LawKind::ALL.iter().map(|law| law.name()).collect(),
            Self::Direction => Direction::ALL
                .iter()
                .map(|direction| direction.name())
                .collect(),
            Self::Waveform => Waveform::ALL
                .iter()
                .map(|waveform| waveform.name())
                .collect(),
            Self::Spacing => vec!["linear", "log"],
        }
    }

    /// What each word means, in the same order; empty where the words say it.
    pub fn abouts(self) -> Vec<&'static str> {
        match self {
            Self::State => vec![
                "displacement and velocity zero",
                "steady sliding without dither",
                "on the limit cycle of the belt without dither",
            ],
            Self::Law => LawKind::ALL.iter().map(|law| law.about()).collect(),
            Self::Direction => vec!["along the belt, on the mass", "on the normal load"],
            Self::Waveform => Vec::new(),
            Self::Spacing => vec!["equal steps", "equal ratios"],
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
            _ => "1",
        }
    }
}

/// `table.key`, or `key` alone at the root.
pub(crate) fn join(table: &str, key: &str) -> String {
    if table.is_empty() {
        key.to_owned()
    } else {
        format!("{table}.{key}")
    }
}

/// Every key, table by table.
pub fn keys() -> &'static [Key] {
    static KEYS: LazyLock<Vec<Key>> = LazyLock::new(build);
    &KEYS
}

fn build() -> Vec<Key> {
    let plain = |section, name, role, about| Key {
        section,
        name,
        role,
        about,
    };
    let mut keys = vec![
        plain(
            Section::Root,
            "schema",
            Role::Schema,
            "version of the study file",
        ),
        plain(
            Section::Root,
            "title",
            Role::Text,
            "what the study is about",
        ),
    ];
    keys.extend(
        parameter::SCALES
            .iter()
            .map(|scale| plain(Section::Belt, scale.key(), Role::Scale(*scale), scale.about)),
    );
    keys.push(plain(
        Section::Initial,
        "state",
        Role::Choice(Choice::State),
        "a named state",
    ));
    keys.push(plain(
        Section::Friction,
        "law",
        Role::Choice(Choice::Law),
        "the friction law",
    ));
    keys.push(plain(
        Section::Dither,
        "direction",
        Role::Choice(Choice::Direction),
        "where the force acts",
    ));
    keys.push(plain(
        Section::Dither,
        "waveform",
        Role::Choice(Choice::Waveform),
        "shape of the force in time",
    ));
    let mut parameters = parameter::BELT.to_vec();
    for law in LawKind::ALL {
        for parameter in law.parameters() {
            if !parameters.iter().any(|known| known.path == parameter.path) {
                parameters.push(*parameter);
            }
        }
    }
    for parameter in parameters {
        let table = parameter
            .path
            .strip_suffix(parameter.key())
            .unwrap_or_default();
        let section = Section::ALL
            .iter()
            .copied()
            .find(|section| section.path() == table.trim_end_matches('.'))
            .unwrap_or(Section::Root);
        keys.push(plain(
            section,
            parameter.key(),
            Role::Number(parameter),
            parameter.about,
        ));
        for &twin in parameter.si {
            keys.push(plain(
                section,
                twin.key,
                Role::Twin(parameter, twin),
                parameter.about,
            ));
        }
    }
    let sweep = |name, role, about| plain(Section::Sweep, name, role, about);
    keys.extend([
        sweep("parameter", Role::Text, "path of the number that is varied"),
        sweep("from", Role::AxisNumber, "first value"),
        sweep("to", Role::AxisNumber, "last value"),
        sweep(
            "points",
            Role::AxisPoints,
            "number of values, both ends included",
        ),
        sweep(
            "values",
            Role::AxisValues,
            "the values themselves, instead of from, to and points",
        ),
        sweep(
            "spacing",
            Role::Choice(Choice::Spacing),
            "how the values lie between the ends",
        ),
    ]);
    keys.sort_by_key(|key| {
        Section::ALL
            .iter()
            .position(|section| *section == key.section)
    });
    keys
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
    let section = Section::ALL
        .iter()
        .copied()
        .find(|section| section.path() == table);
    let listed = matches!(section, Some(Section::Dither | Section::Sweep));
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
        assert_eq!(
            resolve("dither[1].amplitude_n").map(|found| found.index),
            Ok(Some(1))
        );
        assert!(resolve("belt[0].damping_ratio").is_err());
        assert!(resolve("dither[one].amplitude").is_err());
    }
}
