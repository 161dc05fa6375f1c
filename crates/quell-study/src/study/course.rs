//! Numbers over time: drives, loads and envelopes, of belts, discs and systems.
//!
//! A table has knots (`time` and values, or a file of both) or, for drives and loads, an oscillation about the constant value.

use quell_model::parameter::Bounds;
use quell_model::profile::{KnotShape, Knots, Profile, Wave};
use quell_model::units::Quantity;
use quell_model::{Invalid, Waveform};
use serde_json::Value as Json;

use super::data_file::DataFile;
use super::document::{Node, Table, Value};
use super::files::WantedFile;
use super::reader::Reader;
use super::system::CourseNumbers;
use super::vocabulary::{Choice, CourseKey, CourseTable, join};
use crate::complaint::{Complaint, Fault};

/// What the file must be.
const WHAT: &str = "a CSV file of times and values";

/// How the numbers of a table are read.
#[derive(Clone, Copy)]
pub(super) enum CourseUnits<'a> {
    /// Those of a belt: dimensionless, or by keys in SI.
    Belt,
    /// Those of a system: in the units of the file, or by keys in SI.
    System(CourseNumbers<'a>),
    /// Those of a disc: each key dimensionless or in SI.
    Disc,
}

/// What a table over time gives.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Course {
    /// Values at knots.
    Over(Knots),
    /// A sine added to the constant value.
    Oscillation(Wave),
}

/// Where a table over time is, and how it is read.
#[derive(Clone, Copy)]
pub(super) struct CoursePlace<'a> {
    pub(super) what: CourseTable,
    pub(super) units: CourseUnits<'a>,
}

/// A list of numbers with the key that it has in the file.
struct NumberList<'t> {
    node: &'t Node,
    key: String,
    values: Vec<f64>,
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
    names: &[&str],
    course: &str,
) {
    for name in names {
        if let Some(node) = table.get(name) {
            let allowed = format!("left out: {} gives it over time", join(prefix, course));
            let key = join(prefix, name);
            let origin = node.origin;
            reader.complain(Complaint::new(Fault::Conflict, key, origin, node.given(), allowed));
        }
    }
}

impl CoursePlace<'_> {
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
        if let Some(inner) = table.get("oscillation").filter(|_| self.what.oscillates) {
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
        let times = self.list(reader, table, node, prefix, "time", Quantity::Time, Bounds::FINITE);
        let CourseTable { value, quantity, bounds, .. } = self.what;
        let values = self.list(reader, table, node, prefix, value, quantity, bounds);
        let (times, values) = (times?, values?);
        match self.knots(times.values.clone(), values.values.clone(), shape) {
            Ok(knots) => Some(Course::Over(knots)),
            Err(why) => {
                let list = if why.key.starts_with("time") { times } else { values };
                list.complain(reader, &why);
                None
            }
        }
    }

    /// The knots, which may not jump where a number cannot.
    fn knots(&self, times: Vec<f64>, values: Vec<f64>, shape: KnotShape) -> Result<Knots, Invalid> {
        let knots = Knots::new(times, values, shape)?;
        match knots.first_jump().filter(|_| !self.what.jumps) {
            None => Ok(knots),
            Some(place) => {
                let allowed = match self.units {
                    CourseUnits::Disc => {
                        "later than the time before it: the speed of a disc cannot jump"
                    }
                    _ => {
                        "later than the time before it: a velocity cannot jump, no force could make a sticking mass follow"
                    }
                };
                Err(Invalid::new(format!("time[{place}]"), knots.times()[place], allowed))
            }
        }
    }

    fn unknown_keys(&self, reader: &mut Reader, table: &Table, prefix: &str) -> Option<()> {
        let keys = self.what.keys();
        let mut fits = true;
        for (name, node) in table.iter() {
            if keys.iter().any(|(known, _)| *known == name) {
                continue;
            }
            let si = match self.units {
                CourseUnits::Belt => Some(reader.is_si()),
                CourseUnits::System(_) | CourseUnits::Disc => None,
            };
            let fit = |key: &CourseKey| key.si().zip(si).is_none_or(|(own, si)| own == si);
            let there: Vec<&str> =
                keys.iter().filter(|(_, key)| fit(key)).map(|(name, _)| *name).collect();
            let key = join(prefix, name);
            let complaint =
                Complaint::new(Fault::Unknown, key, node.origin, node.given(), there.join(", "));
            reader.complain(complaint);
            fits = false;
        }
        fits.then_some(())
    }

    /// A list of numbers, by its key or by its key in SI.
    #[expect(clippy::too_many_arguments, reason = "a place, and what is read there")]
    fn list<'t>(
        &self,
        reader: &mut Reader,
        table: &'t Table,
        header: &Node,
        prefix: &str,
        name: &str,
        quantity: Quantity,
        bounds: Bounds,
    ) -> Option<NumberList<'t>> {
        let si_name = in_si(name, quantity);
        let (node, name, twin) = self.keyed(reader, table, header, prefix, name, si_name)?;
        let key = join(prefix, name);
        let Value::List(list) = &node.value else {
            reader.wrong(&key, node, format!("a list of numbers; got {}", node.kind()));
            return None;
        };
        let values: Vec<Option<f64>> = list
            .iter()
            .enumerate()
            .map(|(place, node)| {
                let key = format!("{key}[{place}]");
                self.number(reader, &key, node, quantity, bounds, twin)
            })
            .collect();
        Some(NumberList { node, key, values: values.into_iter().collect::<Option<_>>()? })
    }

    /// The key of a number or of a list that is given, and whether it is that in SI.
    fn keyed<'t, 'n>(
        &self,
        reader: &mut Reader,
        table: &'t Table,
        header: &Node,
        prefix: &str,
        name: &'n str,
        si_name: Option<&'n str>,
    ) -> Option<(&'t Node, &'n str, bool)> {
        let plain = table.get(name);
        let twin = si_name.and_then(|name| Some((table.get(name)?, name)));
        let wants_si = match self.units {
            CourseUnits::Belt if si_name.is_some() => Some(reader.is_si()),
            CourseUnits::System(numbers) if !numbers.has_units() => Some(false),
            _ => None,
        };
        let right = si_name.filter(|_| wants_si == Some(true)).unwrap_or(name);
        let mixed = |node: &Node, given: &str| {
            let allowed =
                format!("does not match the units of this study: use {}", join(prefix, right));
            let key = join(prefix, given);
            Complaint::new(Fault::Mixed, key, node.origin, Json::Null, allowed)
                .suggesting(Some(join(prefix, right)))
        };
        match (plain, twin) {
            (Some(_), Some((node, si_name))) => {
                let allowed = format!("give either {} or this key, not both", join(prefix, name));
                let key = join(prefix, si_name);
                let origin = node.origin;
                reader.complain(Complaint::new(Fault::Conflict, key, origin, Json::Null, allowed));
                None
            }
            (Some(node), None) if wants_si == Some(true) => {
                reader.complain(mixed(node, name));
                None
            }
            (None, Some((node, si_name))) if wants_si == Some(false) => {
                reader.complain(mixed(node, si_name));
                None
            }
            (Some(node), None) => Some((node, name, false)),
            (None, Some((node, si_name))) => Some((node, si_name, true)),
            (None, None) => {
                let key = join(prefix, right);
                let allowed = format!("given: {prefix} has {}", self.needs(wants_si));
                let origin = header.origin;
                reader.complain(Complaint::new(Fault::Missing, key, origin, Json::Null, allowed));
                None
            }
        }
    }

    /// What a table needs, in words.
    fn needs(&self, wants_si: Option<bool>) -> String {
        let si = wants_si == Some(true);
        let value = self.what.value_in_si().filter(|_| si).unwrap_or(self.what.value);
        let time = if si { "time_s" } else { "time" };
        let or = if self.what.oscillates {
            "; or oscillation, a table of amplitude and frequency"
        } else {
            ""
        };
        format!(
            "{time} and {value}, lists of equal length, or file, a CSV file of these columns{or}"
        )
    }

    fn number(
        &self,
        reader: &mut Reader,
        key: &str,
        node: &Node,
        quantity: Quantity,
        bounds: Bounds,
        twin: bool,
    ) -> Option<f64> {
        match self.units {
            CourseUnits::Belt => {
                let unit = if twin { quantity.si_unit().map_or("", |(unit, _)| unit) } else { "" };
                let given = reader.within(key, node, bounds, unit, false)?;
                Some(given / self.per_unit(reader, quantity, twin)?)
            }
            CourseUnits::System(numbers) => {
                numbers.number(reader, key, node, quantity, bounds, twin)
            }
            CourseUnits::Disc => {
                let unit = if twin { quantity.si_unit().map_or("", |(unit, _)| unit) } else { "" };
                let given = reader.within(key, node, bounds, unit, false)?;
                let per_unit = self.per_unit(reader, quantity, twin);
                if per_unit.is_none() {
                    let allowed = "left out: values in seconds and hertz require disc.youngs_modulus_pa, density_kg_per_m3, \
                                   thickness_m and outer_radius_m, or modes in hertz";
                    let (origin, given) = (node.origin, node.given());
                    let conflict = Complaint::new(Fault::Conflict, key, origin, given, allowed);
                    reader.complain(conflict);
                }
                Some(given / per_unit?)
            }
        }
    }

    /// The number of a key or file over that of the equations; `None` if the scales are wrong, which has been reported.
    fn per_unit(&self, reader: &Reader, quantity: Quantity, twin: bool) -> Option<f64> {
        match self.units {
            _ if !twin => Some(1.0),
            CourseUnits::Belt => reader.known_scales().map(|scales| scales.si_per_unit(quantity)),
            CourseUnits::System(numbers) => Some(1.0 / numbers.factor(quantity, twin)),
            CourseUnits::Disc => reader.si_per_unit(quantity),
        }
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
        let Some(inner) = node.table() else {
            let allowed = format!("a table of amplitude, frequency and phase; got {}", node.kind());
            reader.wrong(&prefix, node, allowed);
            return None;
        };
        let is_ratio = matches!(self.units, CourseUnits::Belt | CourseUnits::Disc);
        let frequency = if is_ratio { "frequency_ratio" } else { "frequency" };
        let amplitude_in_si = match self.what.quantity {
            Quantity::Velocity => Some("amplitude_m_per_s"),
            Quantity::Force => Some("amplitude_n"),
            Quantity::FrequencyRatio => Some("amplitude_hz"),
            _ => None,
        };
        let mut known = vec!["amplitude"];
        known.extend(amplitude_in_si);
        known.extend([frequency, "frequency_hz", "phase"]);
        for (name, other) in inner.iter() {
            if !known.contains(&name) {
                let key = join(&prefix, name);
                let (origin, given) = (other.origin, other.given());
                reader.complain(Complaint::new(
                    Fault::Unknown,
                    key,
                    origin,
                    given,
                    known.join(", "),
                ));
                return None;
            }
        }
        let mut one = |name: &str, si_name: Option<&str>, quantity: Quantity, bounds: Bounds| {
            let (found, name, twin) = self.keyed(reader, inner, node, &prefix, name, si_name)?;
            self.number(reader, &join(&prefix, name), found, quantity, bounds, twin)
        };
        let amplitude = one("amplitude", amplitude_in_si, self.what.quantity, Bounds::NOT_NEGATIVE);
        let hertz = Some("frequency_hz");
        let frequency = one(frequency, hertz, Quantity::FrequencyRatio, Bounds::POSITIVE);
        let phase = match inner.get("phase") {
            None => Some(0.0),
            Some(_) => one("phase", None, Quantity::Angle, Bounds::FINITE),
        };
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
        match self.knots_of(reader, &key, &name, shape) {
            Ok(knots) => Some(Course::Over(knots?)),
            Err(why) => {
                reader.complain(Complaint::new(Fault::Path, key, node.origin, name, why));
                None
            }
        }
    }

    /// The knots of a file; `None` if the scales of the study are wrong.
    fn knots_of(
        &self,
        reader: &mut Reader,
        key: &str,
        name: &str,
        shape: KnotShape,
    ) -> Result<Option<Knots>, String> {
        let text = reader.files().text(key, name, WantedFile::of(WHAT))?;
        let file = DataFile::new(&text, WHAT)?;
        let CourseTable { value, quantity, bounds, .. } = self.what;
        let column = |name: &'static str, si_name: Option<&'static str>, si_only: bool| {
            let plain = file.column(name).filter(|_| !(si_only && si_name.is_some()));
            let twin = si_name.and_then(|name| Some((file.column(name)?, name, true)));
            plain.map(|at| (at, name, false)).or(twin)
        };
        let (si_only, may_be_si) = match self.units {
            CourseUnits::Belt => (reader.is_si(), reader.is_si()),
            CourseUnits::System(numbers) => (false, numbers.has_units()),
            CourseUnits::Disc => (false, reader.si_per_unit(Quantity::Time).is_some()),
        };
        let si = |name: &'static str, quantity| in_si(name, quantity).filter(|_| may_be_si);
        let time = column("time", si("time", Quantity::Time), si_only);
        let values = column(value, si(value, quantity), si_only);
        let (Some(time), Some(values)) = (time, values) else {
            let name = |name: &'static str, quantity| {
                si(name, quantity).filter(|_| si_only).unwrap_or(name)
            };
            let (time, value) = (name("time", Quantity::Time), name(value, quantity));
            return Err(format!("a CSV file with columns {time} and {value}"));
        };
        let read = |(at, name, twin): (usize, &str, bool), quantity, bounds: Bounds| {
            let allowed = bounds.to_string();
            let rows = file.rows().iter();
            let given =
                rows.map(|row| row.number(at, name, &allowed, |value| bounds.contains(value)));
            let given: Vec<f64> = given.collect::<Result<_, String>>()?;
            let per_unit = self.per_unit(reader, quantity, twin);
            Ok::<_, String>(
                per_unit
                    .map(|unit| given.into_iter().map(|value| value / unit).collect::<Vec<f64>>()),
            )
        };
        let times: Option<Vec<f64>> = read(time, Quantity::Time, Bounds::FINITE)?;
        let values: Option<Vec<f64>> = read(values, quantity, bounds)?;
        let (Some(times), Some(values)) = (times, values) else { return Ok(None) };
        let knots = self.knots(times, values, shape).map_err(|why| {
            let place = why.key.split(['[', ']']).nth(1).and_then(|at| at.parse::<usize>().ok());
            let row = place.and_then(|place| file.rows().get(place));
            let at = row.map_or_else(String::new, |row| format!("{}, ", row.place()));
            let list = why.key.split('[').next().unwrap_or_default();
            format!("{at}{list}: {} must be {}", why.value, why.allowed)
        })?;
        Ok(Some(knots))
    }
}

/// The key of a number in SI.
fn in_si(name: &str, quantity: Quantity) -> Option<&'static str> {
    match (name, quantity) {
        ("time", _) => Some("time_s"),
        ("velocity", _) => Some("velocity_m_per_s"),
        ("load", _) => Some("load_n"),
        ("speed", _) => Some("speed_hz"),
        _ => None,
    }
}
