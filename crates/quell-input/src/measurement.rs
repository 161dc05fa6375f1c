//! Measured friction: slip velocities with coefficients, with friction forces and normal loads, or with friction forces or torques alone.
//!
//! | column | |
//! |---|---|
//! | `slip_velocity` | of either sign, in m/s or of a joint in rad/s |
//! | `friction_coefficient` or `coefficient` | or forces |
//! | `friction_force` and `normal_load` | coefficient = force/load; the load is positive. Without a load friction is a force or a torque |
//! | `standard_deviation` | of the coefficient or the force; optional |
//!
//! Units are those of [`crate::columns`]. Other columns are ignored, and lines with a gap are left out. Every invalid cell is reported with its line.
//! A folder of records at steady speed is one point for each: the means of its readings.

use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

use crate::columns::{ColumnChoice, FoundColumn, WantedColumn, WrongFind};
use crate::complaint::{Complaint, Failure};
use crate::data_file::{self, DataFile, Row, complaint, reported};
use crate::dialect::FileDialect;
use crate::input::Inputs;
use crate::record::TIME;
use crate::wrong_file::WrongTable;

/// What the file must be.
const WHAT: &str = "a file of measured friction";

/// The most points: the search computes the curve at each of them some thousand times.
pub const MOST_POINTS: usize = 100_000;

/// The most files of a folder: with more, a folder of something else is the likelier reason.
const MOST_FILES: usize = 1000;

/// The speed of a record is steady if its standard deviation is at most this share of its mean. Chosen here: control of speed and the rounding
/// of an encoder stay well below it, and stick-slip well above. It changes no number: a record beyond it is a point with a warning if it
/// slips in one direction, and is left out by name if it slips in both.
const STEADY: f64 = 0.25;

const VELOCITY: WantedColumn = WantedColumn { names: &["slip_velocity"], units: &["m/s", "rad/s"] };
const COEFFICIENT: WantedColumn =
    WantedColumn { names: &["friction_coefficient", "coefficient"], units: &["1"] };
const FORCE: WantedColumn = WantedColumn { names: &["friction_force"], units: &["N", "Nm"] };
const LOAD: WantedColumn = WantedColumn { names: &["normal_load"], units: &["N", "Nm"] };
const DEVIATION: WantedColumn =
    WantedColumn { names: &["standard_deviation"], units: &["1", "N", "Nm"] };

/// The quantities of a file of measured friction.
pub const COLUMNS: [WantedColumn; 6] = [VELOCITY, COEFFICIENT, FORCE, LOAD, DEVIATION, TIME];

/// What is wrong with a file of measured friction.
#[derive(Clone, Debug, PartialEq)]
pub enum WrongFriction {
    /// No column has slip velocities; the columns in words.
    NoVelocity(String),
    /// Friction is recorded over time, without slip velocities.
    OverTime(FrictionRecord),
    /// No column has friction; the columns in words.
    NoFriction(String),
    /// A column.
    Column(WrongFind),
    /// Force and load have different units.
    OtherUnits([String; 2]),
    /// The standard deviation has not the unit of friction.
    OtherDeviation(String),
    /// A cell.
    Cell(WrongTable),
    /// The quotient of force and load of a line, from 1, is not finite.
    Quotient {
        /// The line.
        line: usize,
    },
    /// There are more points than can be fitted.
    TooManyPoints(usize),
    /// There are no points.
    NoPoints,
    /// A folder cannot be read, in words of the system.
    UnreadFolder(String),
    /// A folder has more files than are read.
    TooManyFiles(usize),
    /// A folder has no record at steady speed.
    NoSteadyRecord(usize),
    /// The files of a folder give different units.
    MixedFiles {
        /// The first file.
        first: String,
        /// The other one.
        other: String,
    },
}

/// What a record of friction over time holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionRecord {
    /// Number of samples.
    pub samples: usize,
    /// Mean step between them.
    pub step: f64,
    /// Unit of the times.
    pub time_unit: Option<&'static str>,
    /// Mean, standard deviation, least and largest reading.
    pub readings: [f64; 4],
    /// Unit of the readings.
    pub unit: Option<&'static str>,
}

impl fmt::Display for WrongFriction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoVelocity(has) => write!(
                f,
                "{WHAT} with a column slip_velocity, or one that --columns slip_velocity=NAME names; of a record of friction over time \
                 --columns time=NAME,friction_force=NAME gives the levels; it has {has}"
            ),
            Self::OverTime(record) => record.fmt(f),
            Self::NoFriction(has) => write!(
                f,
                "{WHAT} with a column coefficient or friction_force, or one that --columns friction_force=NAME names; it has {has}"
            ),
            Self::Column(why) => why.fmt(f),
            Self::OtherUnits([force, load]) => write!(
                f,
                "{WHAT} with force and load in units of one kind; it has friction_force in {force} and normal_load in {load}"
            ),
            Self::OtherDeviation(unit) => write!(
                f,
                "{WHAT} with the standard deviation in the unit of friction; it has standard_deviation in {unit}"
            ),
            Self::Cell(why) => why.fmt(f),
            Self::Quotient { line } => write!(
                f,
                "line {line}: the quotient of force and load is beyond the range of floating-point numbers"
            ),
            Self::TooManyPoints(count) => write!(
                f,
                "it has {count} points, and at most {MOST_POINTS} are fitted: average neighbouring points first"
            ),
            Self::NoPoints => write!(f, "{WHAT}; it has no points"),
            Self::UnreadFolder(why) => {
                write!(f, "a folder of measured friction; it cannot be read: {why}")
            }
            Self::TooManyFiles(count) => {
                write!(
                    f,
                    "a folder of at most {MOST_FILES} files of measured friction; it has {count}"
                )
            }
            Self::NoSteadyRecord(count) => write!(
                f,
                "a folder of records at steady speed, each in one direction; it has {count} files, none of which is one"
            ),
            Self::MixedFiles { first, other } => {
                write!(
                    f,
                    "a folder of files with the same units; those of {other} differ from those of {first}"
                )
            }
        }
    }
}

impl fmt::Display for FrictionRecord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { samples, step, readings: [mean, deviation, least, largest], .. } = self;
        let unit = |unit: Option<&'static str>| match unit {
            None | Some("1") => String::new(),
            Some(unit) => format!(" {unit}"),
        };
        write!(
            f,
            "{WHAT} with slip velocities; it is a record of friction over time: {samples} samples at a mean step of {step}{}, mean {mean:.9}, \
             standard deviation {deviation:.9}, from {least:.9} to {largest:.9}{}. A law is fitted to friction over the slip velocity; levels and \
             periods of stick-slip are not read from such a record yet",
            unit(self.time_unit),
            unit(self.unit)
        )
    }
}

impl std::error::Error for WrongFriction {}

impl From<WrongFind> for WrongFriction {
    fn from(why: WrongFind) -> Self {
        Self::Column(why)
    }
}

/// One measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredPoint {
    /// Its line in the file, from 1; of a folder the number of its file.
    pub line: usize,
    /// Slip velocity, in m/s, rad/s or the unit of the file.
    pub slip_velocity: f64,
    /// Coefficient of friction, or friction force or torque, with the sign that the file gives it.
    pub coefficient: f64,
    /// Standard deviation of the coefficient or force; 1 without such a column.
    pub standard_deviation: f64,
}

/// What the friction of a file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrictionScale {
    /// A coefficient.
    Coefficient,
    /// A force or torque, with its unit if the file gives one: no normal load was measured.
    Force(Option<&'static str>),
}

/// A record at steady speed, of which the means are one point.
#[derive(Clone, Debug, PartialEq)]
pub struct SteadyFile {
    /// The file.
    pub path: PathBuf,
    /// Number of readings.
    pub readings: usize,
    /// Mean slip velocity.
    pub slip_velocity: f64,
    /// Mean friction.
    pub friction: f64,
    /// Whether its speed is steady; else it sticks and slips in one direction.
    pub is_steady: bool,
}

/// A file of a folder that is no point.
#[derive(Clone, Debug, PartialEq)]
pub struct LeftOutFile {
    /// The file.
    pub path: PathBuf,
    /// Why.
    pub why: NoPoint,
}

/// Why a record is no point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoPoint {
    /// It has no readings.
    Empty,
    /// Its speed is not steady, and it slips in both directions.
    BothDirections {
        /// Mean slip velocity.
        mean: f64,
        /// Its standard deviation.
        deviation: f64,
        /// Unit of both, if the file gives one.
        unit: Option<&'static str>,
    },
}

impl fmt::Display for NoPoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => f.write_str("it has no readings"),
            Self::BothDirections { mean, deviation, unit } => {
                let unit = unit.map_or(String::new(), |unit| format!(" {unit}"));
                write!(
                    f,
                    "it slips in both directions: mean {mean:.4}{unit}, standard deviation {deviation:.4}{unit}"
                )
            }
        }
    }
}

impl std::error::Error for NoPoint {}

/// The files of a folder.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SteadyFiles {
    /// The points in the order of their names.
    pub taken: Vec<SteadyFile>,
    /// Those that are not at steady speed.
    pub left_out: Vec<LeftOutFile>,
}

/// A file or a folder of measured friction.
#[derive(Clone, Debug, PartialEq)]
pub struct FrictionData {
    path: PathBuf,
    points: Vec<MeasuredPoint>,
    columns: Vec<String>,
    velocity_unit: Option<&'static str>,
    scale: FrictionScale,
    is_weighted: bool,
    has_times: bool,
    read: FileDialect,
    folder: Option<SteadyFiles>,
}

impl FrictionData {
    /// Reads a file, or each file of a folder as one point.
    ///
    /// # Errors
    /// Complaints about a file that cannot be read, missing columns, units of another quantity, and every invalid cell.
    pub fn read(path: &Path, choice: &ColumnChoice) -> Result<Self, Failure> {
        let data = if path.is_dir() {
            Self::of_folder(path, choice)?
        } else {
            Self::of_file(path, choice)?
        };
        let wrong = |why: WrongFriction| Failure::from(complaint(path, why));
        match data.points.len() {
            0 => Err(wrong(WrongFriction::NoPoints)),
            count if count > MOST_POINTS => Err(wrong(WrongFriction::TooManyPoints(count))),
            _ => Ok(data),
        }
    }

    fn of_file(path: &Path, choice: &ColumnChoice) -> Result<Self, Failure> {
        let text = data_file::measured(path, WHAT).map_err(|why| complaint(path, why))?;
        let file = DataFile::measured(&text, WHAT).map_err(|why| complaint(path, why))?;
        let columns = Columns::find(&file, choice).map_err(|why| complaint(path, why))?;
        let (mut points, mut found) = (Vec::new(), Vec::new());
        let mut read = file.dialect().clone();
        for row in file.rows() {
            match columns.point(row) {
                Ok(Some(point)) => points.push(point),
                Ok(None) => read.left_out_lines.push(row.line()),
                Err(whys) => found.extend(whys),
            }
        }
        reported(path, &found)?;
        Ok(Self {
            path: path.to_owned(),
            points,
            columns: columns.names(),
            velocity_unit: columns.velocity.unit,
            scale: columns.scale(),
            is_weighted: columns.deviation.is_some(),
            has_times: file.columns().iter().any(|column| TIME.names_it(column)),
            read,
            folder: None,
        })
    }

    /// Each record at steady speed is the point of its means.
    fn of_folder(path: &Path, choice: &ColumnChoice) -> Result<Self, Failure> {
        let wrong = |why: WrongFriction| Failure::from(complaint(path, why));
        let files = files_of(path).map_err(wrong)?;
        if files.len() > MOST_FILES {
            return Err(wrong(WrongFriction::TooManyFiles(files.len())));
        }
        let mut whole: Option<Self> = None;
        let (mut folder, mut complaints): (_, Vec<Complaint>) =
            (SteadyFiles::default(), Vec::new());
        for (index, file) in files.iter().enumerate() {
            let data = match Self::of_file(file, choice) {
                Ok(data) => data,
                Err(Failure::Wrong(wrong)) => {
                    complaints.extend(wrong);
                    continue;
                }
                Err(why) => return Err(why),
            };
            match data.mean(index + 1) {
                Ok((point, is_steady)) => {
                    folder.taken.push(SteadyFile {
                        path: file.clone(),
                        readings: data.points.len(),
                        slip_velocity: point.slip_velocity,
                        friction: point.coefficient,
                        is_steady,
                    });
                    let whole =
                        whole.get_or_insert_with(|| Self { points: Vec::new(), ..data.clone() });
                    if (whole.velocity_unit, whole.scale) != (data.velocity_unit, data.scale) {
                        let name = |path: &Path| path.display().to_string();
                        let (first, other) = (name(&whole.path), name(file));
                        return Err(wrong(WrongFriction::MixedFiles { first, other }));
                    }
                    whole.points.push(point);
                }
                Err(why) => folder.left_out.push(LeftOutFile { path: file.clone(), why }),
            }
        }
        if !complaints.is_empty() {
            return Err(complaints.into());
        }
        let whole = whole.ok_or_else(|| wrong(WrongFriction::NoSteadyRecord(files.len())))?;
        Ok(Self { path: path.to_owned(), is_weighted: false, folder: Some(folder), ..whole })
    }

    /// The means of a record and whether its speed is steady, or why it is no point.
    fn mean(&self, place: usize) -> Result<(MeasuredPoint, bool), NoPoint> {
        let count = self.points.len() as f64;
        if self.points.is_empty() {
            return Err(NoPoint::Empty);
        }
        let mean = |of: fn(&MeasuredPoint) -> f64| self.points.iter().map(of).sum::<f64>() / count;
        let slip_velocity = mean(|point| point.slip_velocity);
        let squares = self.points.iter().map(|point| (point.slip_velocity - slip_velocity).powi(2));
        let deviation = (squares.sum::<f64>() / count).sqrt();
        let is_steady = deviation <= STEADY * slip_velocity.abs();
        let slips = |sign: f64| self.points.iter().any(|point| sign * point.slip_velocity > 0.0);
        if !is_steady && slips(1.0) && slips(-1.0) {
            let (mean, unit) = (slip_velocity, self.velocity_unit);
            return Err(NoPoint::BothDirections { mean, deviation, unit });
        }
        let coefficient = mean(|point| point.coefficient);
        let point =
            MeasuredPoint { line: place, slip_velocity, coefficient, standard_deviation: 1.0 };
        Ok((point, is_steady))
    }

    /// The file or folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The measurements in the order of the file.
    pub fn points(&self) -> &[MeasuredPoint] {
        &self.points
    }

    /// The columns that were read, by their names in the file.
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// Unit of slip velocities, `m/s` or `rad/s`; `None` without one.
    pub fn velocity_unit(&self) -> Option<&'static str> {
        self.velocity_unit
    }

    /// What the friction is.
    pub fn scale(&self) -> FrictionScale {
        self.scale
    }

    /// Whether points have standard deviations.
    pub fn is_weighted(&self) -> bool {
        self.is_weighted
    }

    /// Whether the file is a record over time.
    pub fn has_times(&self) -> bool {
        self.has_times
    }

    /// How the file was read; of a folder its first one.
    pub fn dialect(&self) -> &FileDialect {
        &self.read
    }

    /// The files of a folder.
    pub fn folder(&self) -> Option<&SteadyFiles> {
        self.folder.as_ref()
    }

    /// The file as an input that no output may overwrite.
    pub fn inputs(&self) -> Inputs {
        inputs(&self.path)
    }
}

/// A file of measurements, or the files of a folder, as inputs that no output may overwrite, before they are read.
pub fn inputs(path: &Path) -> Inputs {
    let files =
        if path.is_dir() { files_of(path).unwrap_or_default() } else { vec![path.to_owned()] };
    Inputs::of(files.iter().map(PathBuf::as_path))
}

/// The files of a folder by name, without those that are hidden.
fn files_of(folder: &Path) -> Result<Vec<PathBuf>, WrongFriction> {
    let unread = |why: std::io::Error| WrongFriction::UnreadFolder(why.to_string());
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).map_err(unread)? {
        let entry = entry.map_err(unread)?;
        let is_hidden = entry.file_name().to_string_lossy().starts_with('.');
        if !is_hidden && entry.path().is_file() {
            files.push(entry.path());
        }
    }
    files.sort();
    Ok(files)
}

/// The columns that a file has.
#[derive(Clone, Debug)]
struct Columns {
    velocity: FoundColumn,
    friction: FrictionColumns,
    deviation: Option<FoundColumn>,
}

/// How a file gives friction.
#[derive(Clone, Debug)]
enum FrictionColumns {
    Coefficient(FoundColumn),
    Force(FoundColumn),
    Quotient { force: FoundColumn, load: FoundColumn },
}

impl FrictionColumns {
    fn find(file: &DataFile<'_>, choice: &ColumnChoice) -> Result<Option<Self>, WrongFriction> {
        let of = |wanted: WantedColumn| wanted.find(file, choice);
        if let Some(coefficient) = of(COEFFICIENT)? {
            return Ok(Some(Self::Coefficient(coefficient)));
        }
        let Some(force) = of(FORCE)? else { return Ok(None) };
        let Some(load) = of(LOAD)? else { return Ok(Some(Self::Force(force))) };
        if force.unit != load.unit {
            let shown = |column: &FoundColumn| column.unit.unwrap_or("no unit").to_owned();
            return Err(WrongFriction::OtherUnits([shown(&force), shown(&load)]));
        }
        Ok(Some(Self::Quotient { force, load }))
    }

    /// The column whose numbers have the sign of friction.
    fn signed(&self) -> &FoundColumn {
        match self {
            Self::Coefficient(column)
            | Self::Force(column)
            | Self::Quotient { force: column, .. } => column,
        }
    }
}

impl Columns {
    fn find(file: &DataFile<'_>, choice: &ColumnChoice) -> Result<Self, WrongFriction> {
        let velocity = VELOCITY.find(file, choice)?;
        let friction = FrictionColumns::find(file, choice)?;
        let Some(velocity) = velocity else {
            let over_time = match (&friction, TIME.find(file, choice)?) {
                (Some(friction), Some(time)) => over_time(file, &time, friction.signed()),
                _ => None,
            };
            return Err(over_time.unwrap_or_else(|| WrongFriction::NoVelocity(file.listed())));
        };
        let friction = friction.ok_or_else(|| WrongFriction::NoFriction(file.listed()))?;
        let found = Self { velocity, friction, deviation: DEVIATION.find(file, choice)? };
        let unit = match found.scale() {
            FrictionScale::Coefficient => Some("1"),
            FrictionScale::Force(unit) => unit,
        };
        let own = found.deviation.as_ref().and_then(|column| column.unit);
        match own.filter(|own| Some(*own) != unit) {
            Some(own) => Err(WrongFriction::OtherDeviation(own.to_owned())),
            None => Ok(found),
        }
    }

    fn scale(&self) -> FrictionScale {
        match &self.friction {
            FrictionColumns::Force(force) => FrictionScale::Force(force.unit),
            FrictionColumns::Coefficient(_) | FrictionColumns::Quotient { .. } => {
                FrictionScale::Coefficient
            }
        }
    }

    fn names(&self) -> Vec<String> {
        let load = match &self.friction {
            FrictionColumns::Quotient { load, .. } => Some(load),
            _ => None,
        };
        let columns =
            [&self.velocity, self.friction.signed()].into_iter().chain(load).chain(&self.deviation);
        columns.map(|column| column.name.clone()).collect()
    }

    /// The point of a row, `None` for one with a gap, or what is wrong with its cells.
    fn point(&self, row: &Row<'_>) -> Result<Option<MeasuredPoint>, Vec<WrongFriction>> {
        let mut wrong = Vec::new();
        let mut number = |column: &FoundColumn, allowed: &str, right: fn(f64) -> bool| match row
            .reading(column.at, &column.name, allowed, right)
        {
            Ok(reading) => reading.map(|reading| column.factor * reading),
            Err(why) => {
                wrong.push(WrongFriction::Cell(why));
                None
            }
        };
        let any = |_: f64| true;
        let positive = |value: f64| value > 0.0;
        let slip_velocity = number(&self.velocity, "a finite number", any);
        let coefficient = match &self.friction {
            FrictionColumns::Coefficient(column) | FrictionColumns::Force(column) => {
                number(column, "a finite number", any)
            }
            FrictionColumns::Quotient { force, load } => {
                let force = number(force, "a finite number", any);
                let load = number(load, "a finite number above 0: a contact only pushes", positive);
                force.zip(load).map(|(force, load)| force / load)
            }
        };
        let standard_deviation = match &self.deviation {
            None => Some(1.0),
            Some(column) => number(column, "a finite number above 0", positive).map(f64::abs),
        };
        if !wrong.is_empty() {
            // A line with too many cells is wrong once, not once a column.
            wrong.dedup();
            return Err(wrong);
        }
        let (Some(slip_velocity), Some(coefficient), Some(standard_deviation)) =
            (slip_velocity, coefficient, standard_deviation)
        else {
            return Ok(None);
        };
        if !coefficient.is_finite() {
            return Err(vec![WrongFriction::Quotient { line: row.line() }]);
        }
        Ok(Some(MeasuredPoint { line: row.line(), slip_velocity, coefficient, standard_deviation }))
    }
}

/// What a record of friction over time holds; `None` without two readings.
fn over_time(
    file: &DataFile<'_>,
    time: &FoundColumn,
    friction: &FoundColumn,
) -> Option<WrongFriction> {
    let of = |row: &Row<'_>, column: &FoundColumn| {
        let reading = row.reading(column.at, &column.name, "a finite number", |_| true);
        reading.ok().flatten().map(|reading| column.factor * reading)
    };
    let samples: Vec<(f64, f64)> =
        file.rows().iter().filter_map(|row| of(row, time).zip(of(row, friction))).collect();
    let ([first, ..], [.., last]) = (&samples[..], &samples[..]) else { return None };
    let count = samples.len() as f64;
    let values = || samples.iter().map(|(_, value)| *value);
    let mean = values().sum::<f64>() / count;
    let deviation = (values().map(|value| (value - mean).powi(2)).sum::<f64>() / count).sqrt();
    let (least, largest) =
        (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
    Some(WrongFriction::OverTime(FrictionRecord {
        samples: samples.len(),
        step: (last.0 - first.0) / (count - 1.0).max(1.0),
        time_unit: time.unit,
        readings: [mean, deviation, least, largest],
        unit: friction.unit,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(name: &str, text: &str) -> Result<FrictionData, Failure> {
        let folder = std::env::temp_dir().join(format!("quell-measurement-{}", std::process::id()));
        fs::create_dir_all(&folder).expect("a folder");
        let path = folder.join(name);
        fs::write(&path, text).expect("written");
        FrictionData::read(&path, &ColumnChoice::default())
    }

    #[test]
    fn coefficients_and_forces_give_the_same_points() {
        let one =
            read("a.csv", "# rig\nslip_velocity,coefficient\n0.1,0.4\n-0.2,0.25\n").expect("valid");
        let other = read(
            "b.csv",
            "note,normal_load,slip_velocity,friction_force\nx,10,0.1,4\ny,20,-0.2,5\n",
        )
        .expect("valid");
        let numbers = |data: &FrictionData| -> Vec<(f64, f64, f64)> {
            let points = data.points().iter();
            points.map(|own| (own.slip_velocity, own.coefficient, own.standard_deviation)).collect()
        };
        assert_eq!(numbers(&one), numbers(&other));
        assert_eq!((one.points()[0].line, one.points()[1].line), (3, 4));
        assert!(one.velocity_unit().is_none() && !one.is_weighted());
        assert_eq!(other.columns(), ["slip_velocity", "friction_force", "normal_load"]);
        let weighted =
            "slip_velocity_m_per_s,friction_coefficient,standard_deviation\n0.1,0.4,0.01\n";
        let weighted = read("c.csv", weighted).expect("valid");
        assert!(weighted.velocity_unit() == Some("m/s") && weighted.is_weighted());
        assert_eq!(weighted.points()[0].standard_deviation, 0.01);
    }

    /// Decimal commas are cells of their own, and two columns of one name are two measurements.
    #[test]
    fn cells_beyond_the_columns_and_columns_of_one_name_are_refused() {
        let commas = read("commas", "slip_velocity,coefficient\n1,1,0,40\n2,1,0,38\n");
        let said = commas.expect_err("decimal commas").to_string();
        assert!(said.contains("line 2: 4 cells for 2 columns"), "{said}");
        let twice = read("twice", "slip_velocity,coefficient,coefficient\n1,0.4,0.3\n");
        let said = twice.expect_err("two columns").to_string();
        assert!(said.contains("columns 2 and 3 have the same"), "{said}");
        // A comma at the end of a line adds nothing.
        assert!(read("end", "slip_velocity,coefficient\n1,0.4,\n2,0.3,\n").is_ok());
        let saved = "Trigger:;1,,\nslip_velocity;coefficient,,\n1;0.4,,\n2;0.3,,\n";
        assert_eq!(read("saved", saved).map(|data| data.points().len()), Ok(2));
        let noted = saved.replace("0.4,,", "40,,was 0.4");
        let said = read("noted", &noted).expect_err("a note").to_string();
        assert!(said.contains("line 3, coefficient: \"40,,was 0.4\""), "{said}");
    }

    #[test]
    fn every_invalid_cell_is_reported_with_line_and_column() {
        let text = "slip_velocity,coefficient\nx,0.4\n0.1,inf\n0.2,0.3\n0.3\n";
        let said = read("d.csv", text).expect_err("three invalid cells").to_string();
        for words in [
            "line 2, slip_velocity: \"x\"",
            "line 3, coefficient: \"inf\"",
            "line 5: 1 cell for 2 columns",
        ] {
            assert!(said.contains(words), "{words}: {said}");
        }
        for (name, text, words) in [
            ("e.csv", "velocity,coefficient\n1,2\n", "a column slip_velocity, or one"),
            ("f.csv", "slip_velocity,normal_load\n1,2\n", "coefficient or friction_force"),
            ("g.csv", "slip_velocity,coefficient,friction_coefficient\n1,2,2\n", "not both"),
            ("h.csv", "slip_velocity,friction_force,normal_load\n1,2,-3\n", "above 0"),
            ("i.csv", "slip_velocity,coefficient,standard_deviation\n1,2,0\n", "above 0"),
            ("j.csv", "slip_velocity,coefficient\n", "no points"),
            ("k.csv", "", "a header line"),
        ] {
            let said = read(name, text).expect_err(text).to_string();
            assert!(said.contains(words), "{text:?}: {said}");
        }
    }

    fn with(name: &str, text: &str, columns: &[&str]) -> Result<FrictionData, Failure> {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join(name);
        fs::write(&path, text).expect("written");
        let columns: Vec<String> = columns.iter().map(|text| (*text).to_owned()).collect();
        FrictionData::read(&path, &ColumnChoice::new(&columns, &COLUMNS)?)
    }

    /// A recorder of a drive: speeds in rpm and torques in per cent of the rated torque.
    #[test]
    fn without_a_load_friction_is_a_force_or_a_torque() {
        let text = "Sampling period:;51.200\n;Velocity;Torque\nms;rpm;%\n0;-60;-32.0\n51.2;60;\n102.4;120;40\n";
        let columns = ["slip_velocity=rpm", "friction_force=%*9.84mNm"];
        let data = with("drive.csv", text, &columns).expect("valid");
        assert_eq!(data.velocity_unit(), Some("rad/s"));
        assert_eq!(data.scale(), FrictionScale::Force(Some("Nm")));
        assert_eq!(
            (data.dialect().header_lines, &data.dialect().left_out_lines[..]),
            (1, &[5][..])
        );
        let [first, last] = data.points() else { panic!("two points") };
        assert!((first.slip_velocity + std::f64::consts::TAU).abs() < 1e-14);
        assert!((first.coefficient + 0.32 * 9.84e-3).abs() < 1e-17);
        assert_eq!((first.line, last.line), (4, 6));
        assert_eq!(data.columns(), ["Velocity", "Torque"]);
        let force = with("plain.csv", "slip_velocity,friction_force\n1,2\n", &[]).expect("valid");
        assert_eq!(force.scale(), FrictionScale::Force(None));
        // One of two units is missing.
        let mixed = with("mixed.csv", "slip_velocity,friction_force_n,normal_load\n1,2,3\n", &[]);
        assert!(
            mixed
                .expect_err("mixed")
                .to_string()
                .contains("friction_force in N and normal_load in no unit")
        );
        let both =
            with("both.csv", "slip_velocity,friction_force [kN],normal_load [N]\n1,2,4\n", &[]);
        assert_eq!(both.expect("valid").points()[0].coefficient, 500.0);
        let share =
            with("share.csv", "slip_velocity,coefficient,standard_deviation [N]\n1,2,4\n", &[]);
        assert!(share.expect_err("a force").to_string().contains("standard_deviation in N"));
    }

    #[test]
    fn a_folder_of_records_is_a_point_for_each() {
        let folder = tempfile::tempdir().expect("a folder");
        let columns = "slip_velocity [mm/s],coefficient\n";
        for (name, rows) in [
            ("b.csv", "100,0.4\n102,0.3\n98,0.2\n"),
            ("a.csv", "-50,-0.5\n-50,-0.3\n"),
            ("c.csv", "0,0.5\n30,0.3\n0,0.4\n"),
            ("start-stop.csv", "-200,-0.5\n0,0\n210,0.5\n"),
            (".hidden", "x"),
        ] {
            fs::write(folder.path().join(name), format!("{columns}{rows}")).expect("written");
        }
        let data = FrictionData::read(folder.path(), &ColumnChoice::default()).expect("valid");
        let points: Vec<(f64, f64)> =
            data.points().iter().map(|point| (point.slip_velocity, point.coefficient)).collect();
        for (own, wanted) in points.iter().zip([(-0.05, -0.4), (0.1, 0.3), (0.01, 0.4)]) {
            assert!(
                (own.0 - wanted.0).abs() < 1e-15 && (own.1 - wanted.1).abs() < 1e-15,
                "{points:?}"
            );
        }
        let files = data.folder().expect("a folder");
        assert_eq!((points.len(), files.taken.len(), files.left_out.len()), (3, 3, 1));
        assert_eq!(
            files.taken.iter().map(|file| file.is_steady).collect::<Vec<_>>(),
            [true, true, false]
        );
        assert!(
            files.left_out[0].why.to_string().starts_with("it slips in both directions"),
            "{files:?}"
        );
        assert!(data.inputs().at(&folder.path().join("b.csv")).is_some());
        fs::write(folder.path().join("z.csv"), "slip_velocity,coefficient\n1,2\n")
            .expect("written");
        let mixed = FrictionData::read(folder.path(), &ColumnChoice::default());
        assert!(mixed.expect_err("mixed").to_string().contains("z.csv differ from those of"));
        fs::write(folder.path().join("z.csv"), "").expect("written");
        let empty = FrictionData::read(folder.path(), &ColumnChoice::default());
        assert!(
            empty
                .expect_err("empty")
                .to_string()
                .contains("z.csv: a file of measured friction with a header")
        );
    }

    #[test]
    fn a_record_over_time_says_what_it_holds() {
        let text = "t;Fnorm\n0;0.25\n0.5;0.35\n1;0.45\n";
        let said =
            with("paper.csv", text, &["time=t[s]", "coefficient=Fnorm"]).expect_err("no slip");
        let said = said.to_string();
        for words in [
            "3 samples at a mean step of 0.5 s",
            "mean 0.350000000",
            "deviation 0.081649658",
            "from 0.250000000 to 0.450000000",
        ] {
            assert!(said.contains(words), "{said}");
        }
        let said = with("plain.csv", text, &[]).expect_err("no slip").to_string();
        assert!(said.contains("it has \"t\", \"Fnorm\" with 3 rows"), "{said}");
    }
}
