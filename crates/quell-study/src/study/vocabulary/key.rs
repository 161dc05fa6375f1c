//! A key of the study file: its table, its name and the values it takes.

use quell_model::parameter::{COEFFICIENT, NATURAL_FREQUENCY, Parameter, STIFFNESS, SiTwin};
use quell_model::units::{Quantity, UnitSystem};

use super::course::CourseKey;
use super::key_unit::KeyUnit;
use super::section::{DocumentKind, KeyScope, Section};
use super::size::{SizeKey, SizedSignal};
use super::wave::WaveKey;
use super::words::Choice;

/// What the key `schema` of a study is.
pub const SCHEMA_ABOUT: &str = "version of the study file [default: 1]";

/// The kind of value that a key takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Role {
    /// A parameter by its own key.
    Number(Parameter),
    /// A parameter by another key.
    Twin(Parameter, SiTwin),
    /// Another size of a signal than its peak, which gives this parameter.
    Size(Parameter, SizeKey),
    /// A word from a list.
    Choice(Choice),
    /// Free text.
    Text,
    /// `true` or `false`.
    Flag,
    /// The version of the file.
    Schema,
    /// Words from a list, as an array.
    Choices(Choice),
    /// The reference frequency of a disc: "critical", or a frequency parameter k².
    Reference,
    /// A formula of the friction coefficient, measured coefficients, or the number of a named law.
    Coefficient,
    /// Friction as a force in SI, which determines this parameter of a named law.
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
    /// A part of the description of a waveform.
    Wave(WaveKey),
    /// A part of a drive, a load or an envelope.
    Course(CourseKey),
    /// A named number of a formula.
    Constant,
    /// A bare number of an axis, in the unit of the parameter it names.
    AxisNumber,
    /// The number of points of an axis.
    AxisPoints,
    /// The list of values of an axis.
    AxisValues,
    /// The paths of the numbers that a design varies.
    Paths,
    /// The ranges of the numbers over which a design holds, by their paths.
    Ranges,
    /// A diagonal, rows or a file of numbers of a quantity.
    Matrix(RowUnit),
    /// A number for each coordinate, as a table of names or an array.
    Row(RowUnit),
    /// Names of coordinates or states.
    Names,
    /// A table.
    Table(Section),
    /// A table or a list of tables.
    Tables(Section),
    /// A list of tables that is set as a whole.
    List(Section),
}

/// What the numbers of a matrix or of a row measure, and by which key they are given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RowUnit {
    /// Their quantity; `None` for numbers without a unit.
    pub quantity: Option<Quantity>,
    /// Whether the key has the unit as a suffix, such as `mass_kg`.
    pub si: bool,
}

impl RowUnit {
    /// The unit in the suffix of the key.
    pub fn suffix(self) -> Option<&'static str> {
        self.quantity.filter(|_| self.si)?.si_unit().map(|(unit, _)| unit)
    }
}

/// One key of the study file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key {
    /// Its table.
    pub section: Section,
    /// Its name inside the table.
    pub name: &'static str,
    /// Its kind of value.
    pub role: Role,
    /// Description, in one line.
    pub about: &'static str,
    /// The studies that have it.
    pub scope: KeyScope,
}

impl Key {
    /// A key of every study that has its table.
    pub(super) fn new(
        section: Section,
        name: &'static str,
        role: Role,
        about: &'static str,
    ) -> Self {
        Self { section, name, role, about, scope: section.scope() }
    }

    /// The keys of a number of the registry.
    pub(super) fn of_number(section: Section, parameter: Parameter) -> impl Iterator<Item = Self> {
        let Parameter { about, .. } = parameter;
        let others = parameter.si.iter().map(move |&twin| {
            let about = twin.own.map_or(about, |(_, own)| own);
            Self::new(section, twin.key, Role::Twin(parameter, twin), about)
        });
        let own = Self::new(section, parameter.key(), Role::Number(parameter), about);
        [own].into_iter().chain(others)
    }

    /// Its path without index.
    pub fn path(&self) -> String {
        join(self.section.path(), self.name)
    }

    /// The parameter it gives, by whichever key.
    pub fn parameter(&self) -> Option<Parameter> {
        match self.role {
            Role::Number(parameter) | Role::Twin(parameter, _) | Role::Size(parameter, _) => {
                Some(parameter)
            }
            Role::Coefficient => Some(COEFFICIENT),
            _ => None,
        }
    }

    /// Symbol of its number in the equations.
    pub fn symbol(&self) -> Option<&'static str> {
        match self.role {
            Role::Twin(_, SiTwin { own: Some((symbol, _)), .. })
            | Role::Size(_, SizeKey { symbol, .. }) => Some(symbol),
            _ => self.parameter().map(|parameter| parameter.symbol),
        }
    }

    /// The quantity that its numbers measure.
    pub fn quantity(&self) -> Option<Quantity> {
        match self.role {
            Role::Size(_, size) => size.quantity(),
            Role::Matrix(unit) | Role::Row(unit) => unit.quantity,
            Role::Band { .. } => Some(Quantity::FrequencyRatio),
            Role::Speeds { .. } => Some(Quantity::Velocity),
            _ => self.parameter().map(|parameter| parameter.quantity),
        }
    }

    /// Whether it takes a number that can be varied.
    pub fn takes_number(&self) -> bool {
        let named = matches!(self.role, Role::Constant | Role::FrictionForce(..));
        named || self.parameter().is_some()
    }

    /// The unit in which it gives its numbers.
    pub(in crate::study) fn key_unit(&self) -> KeyUnit {
        let suffix = match self.role {
            Role::Number(parameter) | Role::Twin(parameter, _) => {
                return KeyUnit::of(parameter, self.name);
            }
            Role::Size(_, SizeKey { signal: SizedSignal::Newtons, .. }) => Some("N"),
            Role::FrictionForce(_, unit) => Some(unit),
            Role::Matrix(unit) | Role::Row(unit) => unit.suffix(),
            Role::Speeds { si: true } => Some("m/s"),
            Role::Band { hertz: true } => Some("Hz"),
            _ => None,
        };
        suffix.map_or(KeyUnit::Study, KeyUnit::Suffix)
    }

    /// Unit of its value in a study of a belt or a disc with these units.
    pub fn unit(&self, units: UnitSystem) -> &'static str {
        match (self.role, self.key_unit()) {
            (_, KeyUnit::Suffix(unit)) => unit,
            (Role::Size(_, size), _) if !size.unit.is_empty() => size.unit,
            (_, KeyUnit::Ratio) => self.quantity().map_or("1", Quantity::scaled_unit),
            (_, KeyUnit::Study) => self.quantity().map_or("1", |quantity| {
                units.unit(quantity).unwrap_or_else(|| quantity.scaled_unit())
            }),
        }
    }

    /// Unit of its value in words in the study of a kind: frequencies of a disc are in ω_ref, and the equations of a system have no
    /// scales.
    pub fn unit_in_words(&self, kind: DocumentKind, units: UnitSystem) -> &'static str {
        let of_study = |quantity: Quantity| units.unit(quantity).or(quantity.own_unit());
        match (kind, self.key_unit(), self.unit(units)) {
            (DocumentKind::Disc, _, "ω₀") => "ω_ref",
            (DocumentKind::Belt | DocumentKind::Disc, _, unit) | (_, KeyUnit::Suffix(unit), _) => {
                unit
            }
            (DocumentKind::System, KeyUnit::Ratio, _) => "1",
            (DocumentKind::System, KeyUnit::Study, _) => {
                self.quantity().and_then(of_study).unwrap_or("1")
            }
        }
    }

    /// The first kind of study that has it.
    pub fn first_kind(&self) -> DocumentKind {
        let mut kinds = DocumentKind::ALL.into_iter();
        kinds.find(|kind| self.scope.includes(*kind)).unwrap_or(DocumentKind::System)
    }

    /// The unit to which a number with a unit is converted, such as `5.7kN` for a key in newtons; `None` for dimensionless
    /// numbers and other values without a unit.
    pub fn measured_in(&self, units: UnitSystem) -> Option<&'static str> {
        match (self.role, self.key_unit()) {
            (_, KeyUnit::Suffix(unit)) => Some(unit),
            (Role::Constant, _) | (_, KeyUnit::Ratio) => Some("1"),
            (Role::Size(_, size), _) if !size.unit.is_empty() => Some(size.unit),
            (Role::Speeds { .. } | Role::Band { .. }, _) => None,
            (_, KeyUnit::Study) => match self.quantity()? {
                Quantity::Ratio | Quantity::DampingRatio => Some("1"),
                Quantity::Angle => Some("rad"),
                quantity => quantity.own_unit().or_else(|| units.unit(quantity)),
            },
        }
    }

    /// Whether setting it replaces another key of its table: another key of the same parameter, a named state for numbers, the
    /// values of an axis for its ends, and vice versa.
    pub(in crate::study) fn replaces(&self, sibling: &Self) -> bool {
        if self.name == sibling.name {
            return false;
        }
        if let (Some(one), Some(other)) = (self.parameter(), sibling.parameter()) {
            // Stiffness and natural frequency are alternatives to each other.
            let alternatives = [STIFFNESS.path, NATURAL_FREQUENCY.path];
            return one.path == other.path
                || [one, other].iter().all(|number| alternatives.contains(&number.path));
        }
        match (self.section, self.role, sibling.role) {
            (Section::Initial | Section::SystemInitial, role, other) => {
                role.is_word() || other.is_word()
            }
            (Section::Friction, Role::Speeds { .. }, Role::Speeds { .. })
            | (_, Role::Band { .. }, Role::Band { .. }) => true,
            (Section::Friction, Role::FrictionForce(one, _), Role::FrictionForce(other, _)) => {
                one.path == other.path
            }
            (Section::Sweep, role, other) => {
                (role == Role::AxisValues) != (other == Role::AxisValues)
                    && self.name != "parameter"
                    && sibling.name != "parameter"
            }
            _ => false,
        }
    }
}

impl Role {
    /// Whether it takes a word from a list.
    fn is_word(self) -> bool {
        matches!(self, Self::Choice(_))
    }

    /// The table, or tables of a list, inside.
    pub fn inner(self) -> Option<Section> {
        match self {
            Self::Table(inner) | Self::Tables(inner) | Self::List(inner) => Some(inner),
            _ => None,
        }
    }
}

/// `table.key`, or `key` alone at the root.
pub fn join(table: &str, key: &str) -> String {
    if table.is_empty() { key.to_owned() } else { [table, ".", key].concat() }
}
