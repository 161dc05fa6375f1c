//! Columns of measured files: by their usual names, by those that a user gives, and with their units.
//!
//! A column has a usual name (`slip_velocity`), a usual name with a unit as suffix (`slip_velocity_mm_per_s`), or is chosen:
//! `slip_velocity=V`. A choice names a column by its name or, where that is unique, by its unit, and may give a unit that the file does not,
//! `slip_velocity=V[mm/s]`, and a factor, `friction_force=%*9.84mNm`.
//!
//! Units are converted to those of the quantity. None is guessed: a column without a unit is in the units of the study.

use std::f64::consts::TAU;
use std::fmt;

use quell_model::units::measure;

use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::data_file::DataFile;
use crate::dialect::Column;
use crate::nearest;
use crate::wrong_file::WrongTable;

/// The option.
const OPTION: &str = "--columns";

/// Standard acceleration of gravity, m/s² (CGPM 1901).
const GRAVITY: f64 = 9.806_65;

/// A quantity that a column may have.
#[derive(Clone, Copy, Debug)]
pub struct WantedColumn {
    /// Its usual names.
    pub names: &'static [&'static str],
    /// The units to which its numbers are converted, by dimension.
    pub units: &'static [&'static str],
}

/// Columns that a user names.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ColumnChoice {
    /// Names of quantities with the texts of their columns.
    chosen: Vec<(String, String)>,
}

impl ColumnChoice {
    /// From texts `QUANTITY=COLUMN`.
    ///
    /// # Errors
    /// Every text that is another one; a quantity that is not one of `known`, or is given twice.
    pub fn new(texts: &[String], known: &[WantedColumn]) -> Result<Self, Failure> {
        let mut wrong = Vec::new();
        let mut choice = Self::default();
        let names = || known.iter().flat_map(|wanted| wanted.names.iter().copied());
        for text in texts {
            let pair = text.split_once('=').map(|(name, column)| (name.trim(), column.trim()));
            let Some((name, column)) = pair.filter(|(_, column)| !column.is_empty()) else {
                let allowed = "QUANTITY=COLUMN, such as slip_velocity=V, slip_velocity=V[mm/s] or friction_force=%*9.84mNm";
                wrong.push(Complaint::option(OPTION, text.as_str(), allowed));
                continue;
            };
            if !names().any(|known| known == name) {
                let allowed =
                    format!("given with one of {}", names().collect::<Vec<_>>().join(", "));
                let complaint = Complaint::option(OPTION, text.as_str(), allowed);
                wrong.push(complaint.suggesting(nearest::word(name, names())));
                continue;
            }
            if choice.chosen.iter().any(|(before, _)| before == name) {
                let origin = Origin::Argument(OPTION);
                let allowed = format!("{name} is given twice");
                wrong.push(Complaint::new(Fault::Conflict, OPTION, origin, text.as_str(), allowed));
                continue;
            }
            choice.chosen.push((name.to_owned(), column.to_owned()));
        }
        if wrong.is_empty() { Ok(choice) } else { Err(wrong.into()) }
    }

    /// This choice with one more column.
    #[must_use]
    pub fn with(mut self, quantity: &str, column: &str) -> Self {
        self.chosen.push((quantity.to_owned(), column.to_owned()));
        self
    }

    /// The column that is chosen for a quantity.
    fn of(&self, wanted: &WantedColumn) -> Option<(&str, &str)> {
        let of = |name: &str| wanted.names.contains(&name);
        let found = self.chosen.iter().find(|(name, _)| of(name))?;
        Some((&found.0, &found.1))
    }
}

/// A column of a file with the conversion of its numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundColumn {
    /// Place in the file.
    pub at: usize,
    /// Name in the file.
    pub name: String,
    /// Unit of the converted numbers; `None` if it is that of the file, which does not give it.
    pub unit: Option<&'static str>,
    /// Factor of its numbers.
    pub factor: f64,
}

/// Why a column is unknown.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WrongColumn {
    /// Two columns have the quantity.
    Both([String; 2]),
    /// No column has the name that was given.
    NoSuchColumn {
        /// The quantity.
        quantity: String,
        /// The text that was given.
        text: String,
        /// The columns of the file in words.
        has: String,
    },
    /// Several columns have the name or the unit that was given.
    Several {
        /// The text that was given.
        text: String,
        /// Their places, from 1.
        places: Vec<usize>,
        /// The columns of the file in words.
        has: String,
    },
    /// A unit is not one of the quantity.
    Unit {
        /// Name of the column.
        column: String,
        /// The unit.
        unit: String,
        /// The quantity.
        quantity: &'static str,
        /// Units of the quantity.
        units: &'static [&'static str],
    },
    /// A unit is given for a column that has another one.
    TwoUnits {
        /// Name of the column.
        column: String,
        /// The unit of the file and that of the choice.
        units: [String; 2],
    },
    /// Per cent of a force that is not stated.
    PerCent {
        /// Name of the column.
        column: String,
        /// The quantity.
        quantity: &'static str,
    },
    /// A factor is not one.
    Factor {
        /// The text that was given.
        text: String,
    },
}

impl fmt::Display for WrongColumn {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Both([first, second]) => {
                write!(
                    f,
                    "one of the columns {first} and {second}, not both; {OPTION} takes one of them"
                )
            }
            Self::NoSuchColumn { quantity, text, has } => {
                write!(f, "{OPTION} {quantity}={text}: a column of the file, which has {has}")
            }
            Self::Several { text, places, has } => {
                let places: Vec<String> = places.iter().map(ToString::to_string).collect();
                write!(
                    f,
                    "columns {} are all called {text:?}, and their units do not distinguish them: it has {has}",
                    places.join(" and ")
                )
            }
            Self::Unit { column, unit, quantity, units } => {
                let known =
                    if measure::is_unit(unit) { "" } else { ", which is no unit that is known" };
                write!(
                    f,
                    "the column {column} is in {unit}{known}; {quantity} is read in units of {}",
                    units.join(" or ")
                )
            }
            Self::TwoUnits { column, units: [own, given] } => {
                write!(f, "the column {column} is in {own} by the file and in {given} by {OPTION}")
            }
            Self::PerCent { column, quantity } => write!(
                f,
                "the column {column} is in per cent: {OPTION} {quantity}={column}*9.84mNm says of what, with the rated torque or force"
            ),
            Self::Factor { text } => {
                write!(
                    f,
                    "{OPTION} {text}: a factor other than 0 after *, such as *9.84mNm or *1e-3"
                )
            }
        }
    }
}

impl std::error::Error for WrongColumn {}

/// A unit of a quantity: the one to which it is converted, and the factor.
fn converted(unit: &str, units: &'static [&'static str]) -> Option<(&'static str, f64)> {
    units.iter().find_map(|own| {
        let factor = match *own {
            "m/s²" if unit == "g" => Some(GRAVITY),
            // A speed of rotation counts turns.
            "rad/s" => measure::convert(1.0, unit, own)
                .or_else(|| measure::convert(1.0, unit, "Hz").map(|hertz| TAU * hertz)),
            own => measure::convert(1.0, unit, own),
        };
        Some((*own, factor?))
    })
}

/// The unit that a suffix of a name says: `m_per_s`, `N`, `n`, `percent`.
fn of_suffix(suffix: &str, units: &'static [&'static str]) -> Option<(&'static str, f64)> {
    let plain = suffix.replace("_per_", "/").replace('_', " ");
    // Names have small letters where units have capitals.
    let capital = |text: &str, from: &str, to: &str| {
        text.split('/')
            .map(|part| {
                part.strip_suffix(from).map_or(part.to_owned(), |rest| format!("{rest}{to}"))
            })
            .collect::<Vec<_>>()
            .join("/")
    };
    let percent = if matches!(suffix, "percent" | "pct") { "%" } else { &plain };
    [
        percent.to_owned(),
        capital(&plain, "n", "N"),
        capital(&plain, "nm", "Nm"),
        capital(&plain, "hz", "Hz"),
    ]
    .iter()
    .find_map(|unit| converted(unit, units))
}

impl WantedColumn {
    /// The column of this quantity; `None` if the file has none.
    ///
    /// # Errors
    /// A choice that is no column, two columns, a unit of another quantity.
    pub fn find(
        &self,
        file: &DataFile<'_>,
        choice: &ColumnChoice,
    ) -> Result<Option<FoundColumn>, WrongFind> {
        if let Some((quantity, text)) = choice.of(self) {
            return self.chosen(file, quantity, text).map(Some);
        }
        let found: Vec<usize> =
            (0..file.columns().len()).filter(|at| self.names_it(&file.columns()[*at])).collect();
        match found[..] {
            [] => Ok(None),
            [at] => self.at(file, at).map(Some),
            [first, second, ..] => {
                let name = |at: usize| file.columns()[at].name.to_owned();
                if name(first) == name(second) {
                    return Err(WrongTable::SameName([first + 1, second + 1]).into());
                }
                Err(WrongColumn::Both([name(first), name(second)]).into())
            }
        }
    }

    /// Whether the name of a column says that it has this quantity.
    pub fn names_it(&self, column: &Column<'_>) -> bool {
        self.names.iter().any(|name| {
            column.base.eq_ignore_ascii_case(name) || self.suffix(column, name).is_some()
        })
    }

    fn suffix(&self, column: &Column<'_>, name: &str) -> Option<(&'static str, f64)> {
        let begin =
            column.base.get(..name.len()).filter(|begin| begin.eq_ignore_ascii_case(name))?;
        of_suffix(column.base[begin.len()..].strip_prefix('_')?, self.units)
    }

    /// A column by its place.
    ///
    /// # Errors
    /// A unit of another quantity.
    pub fn at(&self, file: &DataFile<'_>, at: usize) -> Result<FoundColumn, WrongFind> {
        self.scaled(file, at, None, None)
    }

    /// The column that a text names.
    fn chosen(
        &self,
        file: &DataFile<'_>,
        quantity: &str,
        text: &str,
    ) -> Result<FoundColumn, WrongFind> {
        if let Some(at) = named(file, text)? {
            return self.at(file, at);
        }
        let (column, factor) = match text.rsplit_once('*') {
            Some((column, factor)) => (column.trim(), Some(factor)),
            None => (text, None),
        };
        let factor = factor
            .map(|factor| {
                let split = measure::split(factor);
                let known = |(number, unit): &(f64, &str)| {
                    *number != 0.0 && (unit.is_empty() || measure::is_unit(unit))
                };
                let wrong = || WrongColumn::Factor { text: format!("{quantity}={text}") };
                split.filter(known).ok_or_else(wrong)
            })
            .transpose()?;
        if let Some(at) = named(file, column)? {
            return self.scaled(file, at, None, factor);
        }
        let bracketed = column.strip_suffix(']').and_then(|column| column.rsplit_once('['));
        if let Some((column, unit)) = bracketed
            && let Some(at) = named(file, column.trim())?
        {
            return self.scaled(file, at, Some(unit.trim()), factor);
        }
        let (quantity, text) = (quantity.to_owned(), column.to_owned());
        Err(WrongColumn::NoSuchColumn { quantity, text, has: file.listed() }.into())
    }

    /// A column with the unit and the factor that a choice gives.
    fn scaled(
        &self,
        file: &DataFile<'_>,
        at: usize,
        given: Option<&str>,
        factor: Option<(f64, &str)>,
    ) -> Result<FoundColumn, WrongFind> {
        let column = &file.columns()[at];
        let name = column.name.to_owned();
        let shown = if name.is_empty() { format!("{}", at + 1) } else { name.clone() };
        let own = match (&column.unit, given) {
            (Some(own), Some(given)) if own != given => {
                let units = [own.clone(), given.to_owned()];
                return Err(WrongColumn::TwoUnits { column: shown, units }.into());
            }
            (own, given) => own.as_deref().or(given),
        };
        let (number, of_factor) = factor.unwrap_or((1.0, ""));
        let found = |unit: Option<&'static str>, size: f64| {
            Ok(FoundColumn { at, name: name.clone(), unit, factor: number * size })
        };
        let suffix = self.names.iter().find_map(|name| self.suffix(column, name));
        if let (None, "", Some((unit, size))) = (own, of_factor, suffix) {
            return found(Some(unit), size);
        }
        let product: Vec<&str> =
            own.into_iter().chain(Some(of_factor)).filter(|unit| !unit.is_empty()).collect();
        let product = product.join("·");
        if product.is_empty() {
            return found(None, 1.0);
        }
        if let Some((unit, size)) = converted(&product, self.units) {
            return found(Some(unit), size);
        }
        let quantity = self.names[0];
        match (measure::convert(1.0, &product, "1"), factor) {
            // A share of a number without a unit is one without a unit.
            (Some(size), Some((_, ""))) => found(None, size),
            (Some(_), None) if product == "%" => Err(WrongColumn::PerCent {
                column: if name.is_empty() { product } else { shown },
                quantity,
            }
            .into()),
            _ => {
                Err(WrongColumn::Unit { column: shown, unit: product, quantity, units: self.units }
                    .into())
            }
        }
    }
}

/// The column with this name, else the only one with this unit; columns without names by their numbers.
fn named(file: &DataFile<'_>, text: &str) -> Result<Option<usize>, WrongFind> {
    let columns = file.columns();
    let tests: [&dyn Fn(&Column<'_>) -> bool; 4] = [
        &|column| column.name == text,
        &|column| column.base == text,
        &|column| column.base.eq_ignore_ascii_case(text) || column.name.eq_ignore_ascii_case(text),
        &|column| column.unit.as_deref() == Some(text),
    ];
    for test in tests {
        let found: Vec<usize> = (0..columns.len()).filter(|at| test(&columns[*at])).collect();
        match found[..] {
            [] => {}
            [at] => return Ok(Some(at)),
            _ => {
                let places = found.iter().map(|at| at + 1).collect();
                let text = text.to_owned();
                return Err(WrongColumn::Several { text, places, has: file.listed() }.into());
            }
        }
    }
    Ok(None)
}

/// Why a column of a file is unknown: its choice, or the table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WrongFind {
    /// The choice or the unit.
    Column(WrongColumn),
    /// The table.
    Table(WrongTable),
}

impl From<WrongColumn> for WrongFind {
    fn from(why: WrongColumn) -> Self {
        Self::Column(why)
    }
}

impl From<WrongTable> for WrongFind {
    fn from(why: WrongTable) -> Self {
        Self::Table(why)
    }
}

impl fmt::Display for WrongFind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Column(why) => why.fmt(f),
            Self::Table(why) => why.fmt(f),
        }
    }
}

impl std::error::Error for WrongFind {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data_file;

    const SPEED: WantedColumn =
        WantedColumn { names: &["slip_velocity"], units: &["m/s", "rad/s"] };
    const FORCE: WantedColumn = WantedColumn { names: &["friction_force"], units: &["N", "Nm"] };
    const SHARE: WantedColumn = WantedColumn { names: &["coefficient"], units: &["1"] };
    const MOTION: WantedColumn = WantedColumn { names: &["acceleration"], units: &["m/s²"] };

    /// The unit and the factor of a column, or what is wrong.
    fn found(
        wanted: WantedColumn,
        header: &str,
        choice: &str,
    ) -> Result<Option<(Option<&'static str>, f64)>, String> {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("data.csv");
        std::fs::write(&path, format!("{header}\n1;2;3\n2;3;4\n")).expect("written");
        let text = data_file::measured(&path, "a table").expect("text");
        let file = DataFile::measured(&text, "a table").expect("a table");
        let texts: Vec<String> = choice.split_terminator(',').map(str::to_owned).collect();
        let choice = ColumnChoice::new(&texts, &[SPEED, FORCE, SHARE, MOTION])
            .map_err(|why| why.to_string())?;
        let found = wanted.find(&file, &choice).map_err(|why| why.to_string())?;
        Ok(found.map(|column| (column.unit, column.factor)))
    }

    #[test]
    fn units_stand_in_names_in_a_line_and_in_a_choice() {
        let per_minute = TAU / 60.0;
        for (wanted, header, choice, unit, factor) in [
            (SPEED, "slip_velocity;b;c", "", None, 1.0),
            (SPEED, "slip_velocity_m_per_s;b;c", "", Some("m/s"), 1.0),
            (SPEED, "slip_velocity_mm_per_s;b;c", "", Some("m/s"), 1e-3),
            (SPEED, "Slip_Velocity [mm/s];b;c", "", Some("m/s"), 1e-3),
            (SPEED, "slip_velocity / rpm;b;c", "", Some("rad/s"), per_minute),
            (SPEED, "slip_velocity;b;c\ncm/s;1;1", "", Some("m/s"), 1e-2),
            (SPEED, "a;b;c", "slip_velocity=b[mm/s]", Some("m/s"), 1e-3),
            (SPEED, "a;b;c\nrpm;%;1", "slip_velocity=rpm", Some("rad/s"), per_minute),
            (SPEED, "a;a;c\nms;rpm;%", "slip_velocity=rpm", Some("rad/s"), per_minute),
            (SPEED, "a;b;c", "slip_velocity=c*-2", None, -2.0),
            (FORCE, "friction_force_N;b;c", "", Some("N"), 1.0),
            (FORCE, "friction_force_kn;b;c", "", Some("N"), 1e3),
            (FORCE, "friction_force_nm;b;c", "", Some("Nm"), 1.0),
            (FORCE, "friction_force_mNm;b;c", "", Some("Nm"), 1e-3),
            (FORCE, "a;b;c\ns;%;1", "friction_force=%*9.84mNm", Some("Nm"), 9.84e-5),
            (FORCE, "a;b;c\ns;%;1", "friction_force=b*9.84e-3", None, 9.84e-5),
            (FORCE, "a;U (V);c", "friction_force=U*12 N/V", Some("N"), 12.0),
            (FORCE, "a;F*2;c", "friction_force=F*2", None, 1.0),
            (SHARE, "coefficient (%);b;c", "", Some("1"), 1e-2),
            (SHARE, "coefficient_percent;b;c", "", Some("1"), 1e-2),
            (SHARE, "coefficient (-);b;c", "", Some("1"), 1.0),
            (MOTION, "acceleration_g;b;c", "", Some("m/s²"), GRAVITY),
            (MOTION, "acceleration;b;c\ng;1;s", "", Some("m/s²"), GRAVITY),
            (MOTION, "acceleration_mm_per_s2;b;c", "", Some("m/s²"), 1e-3),
        ] {
            let own = found(wanted, header, choice).expect(header).expect(header);
            assert_eq!(own.0, unit, "{header} {choice}");
            assert!((own.1 / factor - 1.0).abs() < 1e-15, "{header} {choice}: {}", own.1);
        }
        assert_eq!(found(SPEED, "velocity;b;c", ""), Ok(None));
    }

    #[test]
    fn what_is_no_column_of_the_quantity_is_refused_with_what_was_met() {
        for (wanted, header, choice, words) in [
            (
                SPEED,
                "slip_velocity [N];b;c",
                "",
                "slip_velocity [N] is in N; slip_velocity is read in units of m/s or rad/s",
            ),
            (
                SPEED,
                "a;b;c",
                "slip_velocity=V",
                "a column of the file, which has \"a\", \"b\", \"c\" with 2 rows",
            ),
            (SPEED, "a;b;c", "slip_velocity=b[furlong]", "furlong, which is no unit that is known"),
            (
                SPEED,
                "a;b [m/s];c",
                "slip_velocity=b[mm/s]",
                "in m/s by the file and in mm/s by --columns",
            ),
            (
                SPEED,
                "a;b;c\nrpm;rpm;1",
                "slip_velocity=rpm",
                "columns 1 and 2 are all called \"rpm\"",
            ),
            (SPEED, "a;a;c", "slip_velocity=a", "columns 1 and 2 are all called \"a\""),
            (SPEED, "slip_velocity;slip_velocity;c", "", "columns 1 and 2 have the same"),
            (SPEED, "slip_velocity;slip_velocity_m_per_s;c", "", "not both"),
            (SPEED, "a;b;c", "slip_velocity=b*0", "a factor other than 0"),
            (SPEED, "a;b;c", "slip_velocity=b*fast", "a factor other than 0"),
            (SPEED, "a;b;c", "slip_velocity", "QUANTITY=COLUMN"),
            (SPEED, "a;b;c", "slip_velocty=a", "did you mean slip_velocity?"),
            (SPEED, "a;b;c", "slip_velocity=a,slip_velocity=b", "given twice"),
            (
                FORCE,
                "a;b;c\ns;%;1",
                "friction_force=%",
                "the column b is in per cent: --columns friction_force=b*9.84mNm",
            ),
            (
                FORCE,
                "a;b;c\ns;%;1",
                "friction_force=a*3",
                "is in s; friction_force is read in units of N or Nm",
            ),
        ] {
            let said = found(wanted, header, choice).expect_err(header);
            assert!(said.contains(words), "{header} {choice}: {said}");
        }
    }
}
