//! Numbers over time: drives, loads and envelopes, of belts, discs and systems.
//!
//! A table has knots (`time` and values, or a file of both) or, for drives and loads, an oscillation about the constant value.

use std::fmt;

use quell_input::complaint::{Complaint, Fault};
use quell_input::data_file::{DataFile, Row};
use quell_input::document::{Node, Table, Value};
use quell_input::files::WantedFile;
use quell_input::wrong_file::{WrongFile, WrongTable};
use quell_model::parameter::course::{OSCILLATION_FREQUENCY, OSCILLATION_PHASE};
use quell_model::parameter::{Bounds, Parameter};
use quell_model::profile::{KnotShape, Knots, Profile, Wave};
use quell_model::units::Quantity;
use quell_model::{Invalid, Waveform};
use serde_json::Value as Json;

use super::reader::{Keyed, Reader, WantedNumber, suffixed};
use super::vocabulary::{Choice, CourseTable, KeyUnit, Section, join};

/// What the file must be.
const WHAT: &str = "a CSV file of times and values";

/// What is wrong with a file of times and values.
#[derive(Clone, Debug, PartialEq, Eq)]
enum WrongCourse {
    /// A column of times or of these values is missing.
    NoColumns {
        /// The column of values.
        value: &'static str,
    },
    /// The knots are wrong.
    Knots {
        /// The line of a wrong knot, from 1.
        line: Option<usize>,
        /// What is wrong, by the list of times or values.
        why: Invalid,
    },
}

impl fmt::Display for WrongCourse {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoColumns { value } => {
                write!(f, "a CSV file with columns time and {value}")
            }
            Self::Knots { line, why } => {
                if let Some(line) = line {
                    write!(f, "line {line}, ")?;
                }
                let list = why.key.split('[').next().unwrap_or_default();
                write!(f, "{list}: {} must be {}", why.value, why.allowed)
            }
        }
    }
}

impl std::error::Error for WrongCourse {}

/// What a table over time gives.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Course {
    /// Values at knots.
    Over(Knots),
    /// A sine added to the constant value.
    Oscillation(Wave),
}

/// A table over time, as it is read.
#[derive(Clone, Copy)]
pub(super) struct CoursePlace(pub(super) CourseTable);

/// A list of numbers with the key that it has in the file.
struct NumberList<'t> {
    node: &'t Node,
    key: String,
    /// The numbers of the equations.
    values: Vec<f64>,
    /// The numbers by the key.
    written: Vec<f64>,
}

impl NumberList<'_> {
    /// Reports what is wrong with the list, or with the number at the place that the key of `why` names.
    fn complain(&self, reader: &mut Reader, why: &Invalid) {
        let place = why.key.split(['[', ']']).nth(1).and_then(|place| place.parse::<usize>().ok());
        let entry = match (place, &self.node.value) {
            (Some(place), Value::List(list)) => list.get(place),
            _ => None,
        };
        let key = place.map_or_else(|| self.key.clone(), |place| format!("{}[{place}]", self.key));
        let given = entry.map_or(Json::Null, Node::given);
        let allowed = why.allowed.clone();
        reader.complain(Complaint::new(Fault::Value, key, self.node.origin, given, allowed));
    }
}

impl Course {
    /// The knots of a table that has no oscillation.
    pub(super) fn knots(course: Option<Self>) -> Option<Knots> {
        match course {
            Some(Self::Over(knots)) => Some(knots),
            _ => None,
        }
    }

    /// The profile, given the constant value to which an oscillation is added.
    pub(super) fn profile(self, constant: f64) -> Profile {
        match self {
            Self::Over(knots) => Profile::over(knots),
            Self::Oscillation(wave) => Profile::constant(constant).with(wave),
        }
    }
}

/// Whether a table over time takes the place of the constant value: it has no oscillation, which is added to it.
pub(super) fn replaces_constant(node: Option<&Node>) -> bool {
    node.is_some_and(|node| node.table().is_none_or(|table| !table.has("oscillation")))
}

/// Reports a constant value next to one over time.
pub(super) fn no_constant(
    reader: &mut Reader,
    table: &Table,
    prefix: &str,
    constant: Parameter,
    course: &str,
) {
    for name in constant.keys() {
        if let Some(node) = table.get(name) {
            let allowed = format!("left out: {} gives it over time", join(prefix, course));
            let key = join(prefix, name);
            let origin = node.origin;
            reader.complain(Complaint::new(Fault::Conflict, key, origin, node.given(), allowed));
        }
    }
}

impl CoursePlace {
    /// Reads the table if it is there; `Err` if it is wrong, which has been reported.
    pub(super) fn optional(
        &self,
        reader: &mut Reader,
        table: &Table,
        prefix: &str,
        name: &str,
    ) -> Result<Option<Course>, ()> {
        match table.get(name) {
            None => Ok(None),
            Some(node) => self.read(reader, node, &join(prefix, name)).map(Some).ok_or(()),
        }
    }

    /// Reads the table; `None` if it is wrong.
    fn read(&self, reader: &mut Reader, node: &Node, prefix: &str) -> Option<Course> {
        let table = node.table().or_else(|| {
            reader.wrong(prefix, node, format!("a table [{prefix}]; got {}", node.kind()));
            None
        })?;
        self.unknown_keys(reader, table, prefix)?;
        if let Some(inner) = table.get("oscillation").filter(|_| self.0.amplitude.is_some()) {
            return self.oscillation(reader, table, inner, prefix);
        }
        let shape = match table.get("shape") {
            None => KnotShape::default(),
            Some(node) => KnotShape::from_name(reader.choice(
                &join(prefix, "shape"),
                node,
                Choice::KnotShape,
            )?)?,
        };
        if let Some(named) = table.get("file") {
            return self.in_file(reader, table, named, prefix, shape);
        }
        let place = (node, prefix);
        let wanted = WantedNumber::finite(Some(Quantity::Time));
        let times = self.list(reader, table, place, "time", wanted);
        let CourseTable { value, quantity, bounds, .. } = self.0;
        let wanted = WantedNumber { bounds, ..WantedNumber::finite(Some(quantity)) };
        let values = self.list(reader, table, place, value, wanted);
        let (times, values) = (times?, values?);
        match self.knots(times.values.clone(), values.values.clone(), shape) {
            Ok(knots) => Some(Course::Over(knots)),
            Err(why) => {
                // What is wrong is said in the numbers of the file.
                let written = self.knots(times.written.clone(), values.written.clone(), shape);
                let why = written.err().unwrap_or(why);
                let list = if why.key.starts_with("time") { times } else { values };
                list.complain(reader, &why);
                None
            }
        }
    }

    /// The knots, which may not jump where a number cannot.
    fn knots(&self, times: Vec<f64>, values: Vec<f64>, shape: KnotShape) -> Result<Knots, Invalid> {
        let knots = Knots::new(times, values, shape)?;
        match knots.first_jump().filter(|_| !self.0.jumps) {
            None => Ok(knots),
            Some(place) => {
                let allowed = if self.0.quantity == Quantity::FrequencyRatio {
                    "later than the time before it: the speed of a disc cannot jump"
                } else {
                    "later than the time before it: a velocity cannot jump, no force could make a sticking mass follow"
                };
                Err(Invalid::new(format!("time[{place}]"), knots.times()[place], allowed))
            }
        }
    }

    fn unknown_keys(&self, reader: &mut Reader, table: &Table, prefix: &str) -> Option<()> {
        let section = Section::ALL.iter().find(|section| section.course() == Some(self.0))?;
        let before = reader.complaints_so_far();
        reader.unknown_keys(table, *section, prefix);
        (reader.complaints_so_far() == before).then_some(())
    }

    /// A list of numbers, by its key or by its key in SI.
    fn list<'t>(
        &self,
        reader: &mut Reader,
        table: &'t Table,
        (header, prefix): (&Node, &str),
        name: &str,
        wanted: WantedNumber,
    ) -> Option<NumberList<'t>> {
        let Keyed { node, key, unit } =
            self.keyed(reader, table, (header, prefix), name, wanted.quantity)?;
        let Value::List(list) = &node.value else {
            reader.wrong(&key, node, format!("a list of numbers; got {}", node.kind()));
            return None;
        };
        let wanted = WantedNumber { unit, ..wanted };
        let values: Vec<Option<f64>> = list
            .iter()
            .enumerate()
            .map(|(place, node)| reader.quantity(|| format!("{key}[{place}]"), node, wanted))
            .collect();
        let values: Vec<f64> = values.into_iter().collect::<Option<_>>()?;
        let of_one = wanted
            .quantity
            .and_then(|quantity| reader.units().written_per_one(quantity, wanted.unit));
        let written = values.iter().map(|value| value * of_one.unwrap_or(1.0)).collect();
        Some(NumberList { node, key, values, written })
    }

    /// The key of a number or of a list; reported where it is missing.
    fn keyed<'t>(
        &self,
        reader: &mut Reader,
        table: &'t Table,
        (header, prefix): (&Node, &str),
        name: &str,
        quantity: Option<Quantity>,
    ) -> Option<Keyed<'t>> {
        let found = reader.keyed(table, prefix, name, quantity).ok()?;
        if found.is_none() {
            let or = if self.0.amplitude.is_some() {
                "; or oscillation, a table of amplitude and frequency"
            } else {
                ""
            };
            let allowed = format!(
                "given: {prefix} has time and {}, lists of equal length, or file, a CSV file of these columns{or}",
                self.0.value
            );
            reader.missing(join(prefix, name), header.origin, allowed);
        }
        found
    }

    fn oscillation(
        &self,
        reader: &mut Reader,
        table: &Table,
        node: &Node,
        prefix: &str,
    ) -> Option<Course> {
        if let Some((name, other)) = table.iter().find(|(name, _)| *name != "oscillation") {
            let allowed = format!("left out: {prefix} has either knots or an oscillation");
            let key = join(prefix, name);
            let origin = other.origin;
            reader.complain(Complaint::new(Fault::Conflict, key, origin, Json::Null, allowed));
            return None;
        }
        let prefix = join(prefix, "oscillation");
        let inner = reader.table(&prefix, node)?;
        let mut sections = Section::ALL.iter();
        let section = sections.find(|section| section.oscillates() == Some(self.0))?;
        let before = reader.complaints_so_far();
        reader.unknown_keys(inner, *section, &prefix);
        if reader.complaints_so_far() != before {
            return None;
        }
        let amplitude = reader.number(inner, &prefix, node.origin, self.0.amplitude?);
        let frequency = reader.number(inner, &prefix, node.origin, OSCILLATION_FREQUENCY);
        let phase = reader.optional(inner, &prefix, OSCILLATION_PHASE).or(0.0);
        let wave = Wave {
            waveform: Waveform::Sine,
            amplitude: amplitude?,
            frequency: frequency?,
            phase: phase?,
            envelope: None,
        };
        Some(Course::Oscillation(wave))
    }

    fn in_file(
        &self,
        reader: &mut Reader,
        table: &Table,
        node: &Node,
        prefix: &str,
        shape: KnotShape,
    ) -> Option<Course> {
        let key = join(prefix, "file");
        for (name, other) in table.iter() {
            if !["file", "shape"].contains(&name) {
                let allowed = format!("left out: {key} gives times and values");
                let (key, origin) = (join(prefix, name), other.origin);
                reader.complain(Complaint::new(Fault::Conflict, key, origin, Json::Null, allowed));
                return None;
            }
        }
        let name = reader.text(&key, node)?;
        let knots = self.knots_of(reader, &key, &name, shape);
        Some(Course::Over(reader.in_file((&key, node), &name, knots)??))
    }

    /// The knots of a file; `None` if the scales of the study are wrong.
    fn knots_of(
        &self,
        reader: &mut Reader,
        key: &str,
        name: &str,
        shape: KnotShape,
    ) -> Result<Option<Knots>, WrongFile<WrongCourse>> {
        let text = reader.files().text(key, name, WantedFile::of(WHAT))?;
        let file = DataFile::new(&text, WHAT)?;
        let CourseTable { value, quantity, bounds, .. } = self.0;
        let may_be_si = reader.units().take_suffixes();
        let column = |name: &str, quantity| {
            let si = suffixed(name, quantity).filter(|_| may_be_si);
            let si = si
                .and_then(|(name, unit)| Some((file.column(&name)?, name, KeyUnit::Suffix(unit))));
            let plain = || Some((file.column(name)?, name.to_owned(), KeyUnit::Study));
            si.or_else(plain)
        };
        let time = column("time", Quantity::Time);
        let values = column(value, quantity);
        let (Some(time), Some(values)) = (time, values) else {
            return Err(WrongFile::Contents(WrongCourse::NoColumns { value }));
        };
        let units = reader.units();
        let read = |(at, name, unit): (usize, String, KeyUnit), quantity, bounds: Bounds| {
            let allowed = bounds.to_string();
            let rows = file.rows().iter();
            let given =
                rows.map(|row| row.number(at, &name, &allowed, |value| bounds.contains(value)));
            let given: Vec<f64> = given.collect::<Result<_, WrongTable>>()?;
            let values = given.iter().map(|value| units.in_equations(*value, quantity, unit));
            Ok::<_, WrongTable>((values.collect::<Option<Vec<f64>>>(), given))
        };
        let (times, written_times) = read(time, Quantity::Time, Bounds::FINITE)?;
        let (values, written_values) = read(values, quantity, bounds)?;
        let (Some(times), Some(values)) = (times, values) else { return Ok(None) };
        let knots = self.knots(times, values, shape).map_err(|why| {
            // What is wrong is said in the numbers of the file.
            let why = self.knots(written_times, written_values, shape).err().unwrap_or(why);
            let place = why.key.split(['[', ']']).nth(1).and_then(|at| at.parse::<usize>().ok());
            let row = place.and_then(|place| file.rows().get(place));
            let line = row.map(Row::line);
            WrongFile::Contents(WrongCourse::Knots { line, why })
        })?;
        Ok(Some(knots))
    }
}
