//! The arrays of a map: their contents and values.
//!
//! Every variable gives an array of values, in a study in SI a second one in SI, and an array of
//! statuses. If a number is unknown, its status gives the reason, and the value is a NaN that carries
//! the code of the status, or the word for "unknown". The fill values (the plain NaN, 255) mean
//! "missing" and nothing else.

use quell_model::units::Quantity;

use super::evaluate::Computation;
use super::mapped::{PointResults, PointScales};
use super::quantity::{MapQuantity, Variable, VariableKind};
use super::status::Status;
use crate::outcome::disc_units::DiscUnits;
use crate::study::{Study, UnitSystem};

/// Bits of the NaN for an unknown number, to which the code of its status is added.
const UNKNOWN: u64 = 0x7ff8_0000_0000_0000;

/// Code of a word or status that is not computed yet.
pub const MISSING: u8 = Status::Missing.code();

/// One array of a map.
#[derive(Clone, Debug)]
pub struct MapArray {
    /// Its name.
    pub name: String,
    /// Description in one line.
    pub about: String,
    /// Unit; empty for words and statuses.
    pub unit: String,
    /// Its contents.
    pub content: Content,
    /// The array with the statuses of its values; `None` for an array of statuses.
    pub status: Option<String>,
}

/// Contents of an array.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Content {
    /// Numbers.
    Numbers,
    /// Codes, each with its meaning.
    Codes(Vec<(u8, &'static str)>),
}

/// Values of one array.
#[derive(Clone, Debug, PartialEq)]
pub enum Data {
    /// Numbers.
    Numbers(Vec<f64>),
    /// Codes of words or statuses.
    Codes(Vec<u8>),
}

impl Data {
    /// `points` values that are all missing.
    pub fn missing(content: &Content, points: usize) -> Self {
        match content {
            Content::Numbers => Self::Numbers(vec![f64::NAN; points]),
            Content::Codes(_) => Self::Codes(vec![MISSING; points]),
        }
    }

    /// Copies value `from` of another array of the same kind to value `to`.
    pub fn take(&mut self, to: usize, other: &Self, from: usize) {
        match (self, other) {
            (Self::Numbers(values), Self::Numbers(others)) => values[to] = others[from],
            (Self::Codes(values), Self::Codes(others)) => values[to] = others[from],
            _ => {}
        }
    }

    /// Whether value `at` has the bits of value `other_at` of another array of the same kind.
    pub fn same_bits(&self, at: usize, other: &Self, other_at: usize) -> bool {
        match (self, other) {
            (Self::Numbers(values), Self::Numbers(others)) => {
                values[at].to_bits() == others[other_at].to_bits()
            }
            (Self::Codes(values), Self::Codes(others)) => values[at] == others[other_at],
            _ => false,
        }
    }

    fn push(&mut self, number: f64, code: u8) {
        match self {
            Self::Numbers(values) => values.push(number),
            Self::Codes(values) => values.push(code),
        }
    }
}

/// A variable with the indices of its arrays.
#[derive(Clone, Copy, Debug)]
pub struct VariableArrays {
    /// The variable.
    pub variable: Variable,
    /// The computation that it needs.
    pub computation: Computation,
    /// Its values.
    pub value: usize,
    /// Its statuses.
    pub status: usize,
}

/// The arrays of a map.
#[derive(Clone, Debug)]
pub struct Sheet {
    entries: Vec<VariableArrays>,
    fields: Vec<MapArray>,
}

impl Sheet {
    /// The arrays of `quantities` for a study.
    pub fn new(study: &Study, quantities: &[&MapQuantity]) -> Self {
        let scaled = study.scales().is_some();
        let units = match study.system() {
            Ok(study) => study.units(),
            Err(_) => study.file_units(),
        };
        let disc_units = study.disc().ok().and_then(|study| DiscUnits::of(&study));
        let mut sheet = Self { entries: Vec::new(), fields: Vec::new() };
        let variables = quantities.iter().flat_map(|quantity| {
            quantity.variables.iter().map(|variable| (variable, quantity.computation))
        });
        for (variable, computation) in variables {
            let name = variable.name;
            let content = match variable.kind {
                VariableKind::Number(_)
                | VariableKind::Rate
                | VariableKind::DiscRate
                | VariableKind::SystemRate
                | VariableKind::SystemNumber(_) => Content::Numbers,
                VariableKind::Word { words, unknown } => {
                    let words = words.iter().chain([&unknown]).zip(0..);
                    let words = words.map(|(word, code)| (code, *word));
                    Content::Codes(words.chain([(MISSING, Status::Missing.name())]).collect())
                }
            };
            let state = Some(format!("{name}_status"));
            let unit = match &disc_units {
                Some(disc) if variable.kind == VariableKind::DiscRate => disc
                    .one(name, &unit(variable.kind, units, scaled))
                    .map_or_else(String::new, |(_, unit)| unit.to_owned()),
                _ => unit(variable.kind, units, scaled),
            };
            let value = sheet.add(name.to_owned(), variable.about, unit, content, state.clone());
            let states = variable.all_statuses(computation);
            let states = states.iter().map(|status| (status.code(), status.name())).collect();
            let about = format!("status of {name}: known, or why it is unknown");
            let content = Content::Codes(states);
            let name = format!("{name}_status");
            let status = sheet.add(name, &about, String::new(), content, None);
            sheet.entries.push(VariableArrays { variable: *variable, computation, value, status });
        }
        sheet
    }

    fn add(
        &mut self,
        name: String,
        about: &str,
        unit: String,
        content: Content,
        status: Option<String>,
    ) -> usize {
        self.fields.push(MapArray { name, about: about.to_owned(), unit, content, status });
        self.fields.len() - 1
    }

    /// The variables in order.
    pub fn entries(&self) -> &[VariableArrays] {
        &self.entries
    }

    /// The arrays in order.
    pub fn fields(&self) -> &[MapArray] {
        &self.fields
    }

    /// Arrays of `points` values that are all missing.
    pub fn missing(&self, points: usize) -> Vec<Data> {
        self.fields.iter().map(|field| Data::missing(&field.content, points)).collect()
    }

    /// The arrays of some points; `None` where the axis values do not form a valid study.
    pub(super) fn fill(&self, points: &[Option<PointResults>]) -> Vec<Data> {
        let mut arrays = self.missing(0);
        for point in points {
            for entry in &self.entries {
                let (value, scales) = match point {
                    Some((scales, results)) => {
                        let value = entry.variable.read(results);
                        let known = |value: f64| results.qualification(entry.computation, value);
                        (value.map(|value| (value, known(value))), *scales)
                    }
                    None => (Err(Status::InvalidStudy), PointScales::Own),
                };
                let factor = factor(entry.variable.kind, scales);
                let (number, code, status) = match value {
                    Ok((value, status)) => (value * factor, whole(value), status),
                    Err(status) => (unknown(status), unknown_word(entry.variable.kind), status),
                };
                arrays[entry.value].push(number, code);
                arrays[entry.status].push(0.0, status.code());
            }
        }
        arrays
    }
}

/// The NaN for an unknown number.
fn unknown(status: Status) -> f64 {
    f64::from_bits(UNKNOWN | u64::from(status.code()))
}

/// The code of an unknown word.
fn unknown_word(kind: VariableKind) -> u8 {
    match kind {
        VariableKind::Word { words, .. } => u8::try_from(words.len()).unwrap_or(MISSING),
        VariableKind::Number(_)
        | VariableKind::Rate
        | VariableKind::DiscRate
        | VariableKind::SystemRate
        | VariableKind::SystemNumber(_) => MISSING,
    }
}

/// The code of a word, given as a number.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "there are few words; the code of a number that is not a word is not used"
)]
fn whole(value: f64) -> u8 {
    value as u8
}

/// Unit of a variable in the units of the study; `scaled` says whether it has the scales of a belt.
fn unit(kind: VariableKind, units: UnitSystem, scaled: bool) -> String {
    match kind {
        VariableKind::Number(quantity) => {
            let own = units.unit(quantity).filter(|_| scaled && quantity.si_unit().is_some());
            own.unwrap_or_else(|| quantity.scaled_unit()).to_owned()
        }
        VariableKind::Rate if scaled => "1/s".to_owned(),
        VariableKind::Rate => "ω₀".to_owned(),
        VariableKind::DiscRate => "ω_ref".to_owned(),
        VariableKind::SystemRate if units == UnitSystem::None => "1/time".to_owned(),
        // Both systems of units have the second.
        VariableKind::SystemRate => "1/s".to_owned(),
        VariableKind::SystemNumber(quantity) => {
            let name = if quantity == Quantity::Force { "force" } else { "length" };
            units.unit(quantity).unwrap_or(name).to_owned()
        }
        VariableKind::Word { .. } => String::new(),
    }
}

/// What one number of the equations is in the units of the study.
fn factor(kind: VariableKind, scales: PointScales) -> f64 {
    match (kind, scales) {
        (VariableKind::Number(quantity), PointScales::Belt(scales)) => {
            scales.own(quantity).map_or(1.0, |(one, _)| one)
        }
        (VariableKind::Rate, PointScales::Belt(scales)) => scales.angular_frequency(),
        (VariableKind::DiscRate, PointScales::Disc(angular)) => angular,
        _ => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknown_and_missing_numbers_differ() {
        for status in Status::ALL.iter().filter(|status| !status.has_number()) {
            let number = unknown(*status);
            assert!(number.is_nan() && number.to_bits() != f64::NAN.to_bits());
        }
        assert_eq!(f64::NAN.to_bits(), UNKNOWN);
    }
}
