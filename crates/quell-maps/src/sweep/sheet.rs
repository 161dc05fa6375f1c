//! The arrays of a map: their contents and values.
//!
//! Every variable gives an array of values in the units of the study and an array of statuses. If a number is unknown, its status gives the reason, and the value is a NaN that carries
//! the code of the status, or the word for "unknown". The fill values (the plain NaN, 255) mean
//! "missing" and nothing else.

use super::map_quantity::{MapQuantity, Variable, VariableKind};
use super::points::ChunkPoints;
use crate::disc_units::DiscUnits;
use crate::fields::rate_unit;
use crate::status::Status;
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
        let units = UnitNames::of(study);
        let mut sheet = Self { entries: Vec::new(), fields: Vec::new() };
        for variable in quantities.iter().flat_map(|quantity| quantity.variables) {
            let name = variable.name;
            let content = match variable.kind {
                VariableKind::Number(_) | VariableKind::Rate => Content::Numbers,
                VariableKind::Word { words, unknown } => {
                    let words = words.iter().chain([&unknown]).zip(0..);
                    let words = words.map(|(word, code)| (code, *word));
                    Content::Codes(words.chain([(MISSING, Status::Missing.name())]).collect())
                }
            };
            let state = Some(format!("{name}_status"));
            let unit = units.of_variable(variable);
            let value = sheet.add(name.to_owned(), variable.about, unit, content, state);
            let states = variable.all_statuses();
            let states = states.iter().map(|status| (status.code(), status.name())).collect();
            let about = format!("status of {name}: known, or why it is unknown");
            let content = Content::Codes(states);
            let name = format!("{name}_status");
            let status = sheet.add(name, &about, String::new(), content, None);
            sheet.entries.push(VariableArrays { variable: *variable, value, status });
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

    /// The arrays of some points.
    pub(super) fn fill(&self, points: &ChunkPoints<'_>) -> Vec<Data> {
        let mut arrays = self.missing(0);
        for entry in &self.entries {
            for value in (entry.variable.read)(points) {
                let (number, code, status) = match value {
                    Ok((value, status)) => (value, whole(value), status),
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
        VariableKind::Number(_) | VariableKind::Rate => MISSING,
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

/// The units of a study's numbers, as every verb names them.
struct UnitNames {
    units: UnitSystem,
    disc: Option<DiscUnits>,
    /// Whether it is a disc, whose rates without units are those over ω_ref.
    is_disc: bool,
}

impl UnitNames {
    fn of(study: &Study) -> Self {
        let disc = study.disc().ok();
        let is_disc = disc.is_some();
        Self { units: study.units(), disc: disc.and_then(|study| DiscUnits::of(&study)), is_disc }
    }

    fn of_variable(&self, variable: &Variable) -> String {
        let unit = match variable.kind {
            VariableKind::Number(quantity) => self.units.unit(quantity).unwrap_or("1"),
            VariableKind::Rate if self.is_disc => {
                let own = self.disc.and_then(|disc| disc.one(variable.name, "ω_ref"));
                own.map_or("ω_ref", |(_, unit)| unit)
            }
            VariableKind::Rate => rate_unit(self.units),
            VariableKind::Word { .. } => "",
        };
        unit.to_owned()
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
