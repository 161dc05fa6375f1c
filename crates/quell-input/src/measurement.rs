//! Measured friction in a CSV file: slip velocities with coefficients, or with friction forces and normal loads.
//!
//! | column | |
//! |---|---|
//! | `slip_velocity` or `slip_velocity_m_per_s` | of either sign |
//! | `friction_coefficient` or `coefficient` | or the two columns of forces |
//! | `friction_force` and `normal_load` (or `friction_force_n`, `normal_load_n`) | coefficient = force/load; the load is positive |
//! | `standard_deviation` | of the coefficient; optional |
//!
//! Other columns are ignored. Every invalid cell is reported with its line.

use std::fmt;
use std::path::{Path, PathBuf};

use crate::complaint::Failure;
use crate::data_file::{self, DataFile, Row, complaint, reported};
use crate::input::Inputs;
use crate::wrong_file::WrongTable;

/// What the file must be.
const WHAT: &str = "a CSV file of measured friction";

/// The most points: the search computes the curve at each of them some thousand times.
pub const MOST_POINTS: usize = 100_000;

/// What is wrong with a file of measured friction.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WrongFriction {
    /// No column has slip velocities; the columns in words.
    NoVelocity(String),
    /// No column has coefficients, and none forces and loads; the columns in words.
    NoFriction(String),
    /// Two columns have the same quantity.
    Both([&'static str; 2]),
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
}

impl fmt::Display for WrongFriction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoVelocity(has) => write!(
                f,
                "{WHAT} with a column slip_velocity or slip_velocity_m_per_s; it has {has}"
            ),
            Self::NoFriction(has) => write!(
                f,
                "{WHAT} with a column friction_coefficient or coefficient, or with friction_force and normal_load; it has {has}"
            ),
            Self::Both([first, second]) => {
                write!(f, "{WHAT} with one of the columns {first} and {second}, not both")
            }
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
        }
    }
}

impl std::error::Error for WrongFriction {}

/// One measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredPoint {
    /// Its line in the file, from 1.
    pub line: usize,
    /// Slip velocity, in m/s or in the unit of the file.
    pub slip_velocity: f64,
    /// Coefficient of friction with the sign that the file gives it.
    pub coefficient: f64,
    /// Standard deviation of the coefficient; 1 without such a column.
    pub standard_deviation: f64,
}

/// A file of measured friction.
#[derive(Clone, Debug, PartialEq)]
pub struct FrictionData {
    path: PathBuf,
    points: Vec<MeasuredPoint>,
    columns: Vec<&'static str>,
}

impl FrictionData {
    /// Reads a file.
    ///
    /// # Errors
    /// Complaints about a file that cannot be read, missing columns, and every invalid cell.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let text = data_file::text(path, WHAT).map_err(|why| complaint(path, why))?;
        let file = DataFile::new(&text, WHAT).map_err(|why| complaint(path, why))?;
        let wrong = |why: WrongFriction| complaint(path, why);
        let columns = Columns::find(&file).map_err(wrong)?;
        if file.rows().len() > MOST_POINTS {
            return Err(wrong(WrongFriction::TooManyPoints(file.rows().len())).into());
        }
        let mut points = Vec::new();
        let mut found = Vec::new();
        for row in file.rows() {
            match columns.point(row) {
                Ok(point) => points.push(point),
                Err(whys) => found.extend(whys),
            }
        }
        reported(path, &found)?;
        if points.is_empty() {
            return Err(wrong(WrongFriction::NoPoints).into());
        }
        Ok(Self { path: path.to_owned(), points, columns: columns.names() })
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The measurements in the order of the file.
    pub fn points(&self) -> &[MeasuredPoint] {
        &self.points
    }

    /// The columns that were read.
    pub fn columns(&self) -> &[&'static str] {
        &self.columns
    }

    /// Whether slip velocities are in m/s.
    pub fn is_si(&self) -> bool {
        self.columns.contains(&VELOCITIES[1])
    }

    /// Whether points have standard deviations.
    pub fn is_weighted(&self) -> bool {
        self.columns.contains(&DEVIATION)
    }

    /// The file as an input that no output may overwrite.
    pub fn inputs(&self) -> Inputs {
        inputs(&self.path)
    }
}

/// A file of measurements as an input that no output may overwrite, before it is read.
pub fn inputs(path: &Path) -> Inputs {
    Inputs::of([path])
}

/// Names of the column of slip velocities, dimensionless and in SI.
const VELOCITIES: [&str; 2] = ["slip_velocity", "slip_velocity_m_per_s"];
const COEFFICIENTS: [&str; 2] = ["friction_coefficient", "coefficient"];
const FORCES: [&str; 2] = ["friction_force", "friction_force_n"];
const LOADS: [&str; 2] = ["normal_load", "normal_load_n"];
const DEVIATION: &str = "standard_deviation";

/// A column by its place and name.
#[derive(Clone, Copy, Debug)]
struct NamedColumn {
    at: usize,
    name: &'static str,
}

/// The columns that a file has.
#[derive(Clone, Copy, Debug)]
struct Columns {
    velocity: NamedColumn,
    friction: FrictionColumns,
    deviation: Option<NamedColumn>,
}

/// How a file gives the coefficient.
#[derive(Clone, Copy, Debug)]
enum FrictionColumns {
    Coefficient(NamedColumn),
    Forces { force: NamedColumn, load: NamedColumn },
}

impl Columns {
    fn find(file: &DataFile<'_>) -> Result<Self, WrongFriction> {
        let velocity = one_of(file, &VELOCITIES)?;
        let velocity = velocity.ok_or_else(|| WrongFriction::NoVelocity(file.listed()))?;
        let force = one_of(file, &FORCES)?;
        let load = one_of(file, &LOADS)?;
        let friction = match (one_of(file, &COEFFICIENTS)?, force, load) {
            (Some(coefficient), ..) => FrictionColumns::Coefficient(coefficient),
            (None, Some(force), Some(load)) => FrictionColumns::Forces { force, load },
            _ => return Err(WrongFriction::NoFriction(file.listed())),
        };
        let deviation = one_of(file, &[DEVIATION])?;
        Ok(Self { velocity, friction, deviation })
    }

    fn names(&self) -> Vec<&'static str> {
        let friction = match self.friction {
            FrictionColumns::Coefficient(coefficient) => vec![coefficient.name],
            FrictionColumns::Forces { force, load } => vec![force.name, load.name],
        };
        let deviation = self.deviation.map(|column| column.name);
        std::iter::once(self.velocity.name).chain(friction).chain(deviation).collect()
    }

    /// The point of a row, or what is wrong with its cells.
    fn point(&self, row: &Row<'_>) -> Result<MeasuredPoint, Vec<WrongFriction>> {
        let mut wrong = Vec::new();
        let mut number = |column: NamedColumn, allowed: &str, right: fn(f64) -> bool| {
            let found = row
                .number(column.at, column.name, allowed, |value| value.is_finite() && right(value));
            found.map_err(|why| wrong.push(WrongFriction::Cell(why))).unwrap_or(f64::NAN)
        };
        let any = |_: f64| true;
        let positive = |value: f64| value > 0.0;
        let slip_velocity = number(self.velocity, "a finite number", any);
        let coefficient = match self.friction {
            FrictionColumns::Coefficient(column) => number(column, "a finite number", any),
            FrictionColumns::Forces { force, load } => {
                let force = number(force, "a finite number", any);
                force / number(load, "a finite number above 0: a contact only pushes", positive)
            }
        };
        let standard_deviation = match self.deviation {
            None => 1.0,
            Some(column) => number(column, "a finite number above 0", positive),
        };
        if !wrong.is_empty() {
            // A line with too many cells is wrong once, not once a column.
            wrong.dedup();
            return Err(wrong);
        }
        if !coefficient.is_finite() {
            return Err(vec![WrongFriction::Quotient { line: row.line() }]);
        }
        Ok(MeasuredPoint { line: row.line(), slip_velocity, coefficient, standard_deviation })
    }
}

/// The one column of these names that the file has.
fn one_of(
    file: &DataFile<'_>,
    names: &[&'static str],
) -> Result<Option<NamedColumn>, WrongFriction> {
    let found: Vec<NamedColumn> = names
        .iter()
        .filter_map(|&name| Some(NamedColumn { at: file.column(name)?, name }))
        .collect();
    match found[..] {
        [] => Ok(None),
        [only] => Ok(Some(only)),
        [first, second, ..] => Err(WrongFriction::Both([first.name, second.name])),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(name: &str, text: &str) -> Result<FrictionData, Failure> {
        let folder = std::env::temp_dir().join(format!("quell-measurement-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let path = folder.join(name);
        std::fs::write(&path, text).expect("written");
        FrictionData::read(&path)
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
        assert!(!one.is_si() && !one.is_weighted());
        assert_eq!(other.columns(), ["slip_velocity", "friction_force", "normal_load"]);
        let weighted =
            "slip_velocity_m_per_s,friction_coefficient,standard_deviation\n0.1,0.4,0.01\n";
        let weighted = read("c.csv", weighted).expect("valid");
        assert!(weighted.is_si() && weighted.is_weighted());
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
    }

    #[test]
    fn every_invalid_cell_is_reported_with_line_and_column() {
        let text = "slip_velocity,coefficient\nx,0.4\n0.1,nan\n0.2,0.3\n0.3\n";
        let said = read("d.csv", text).expect_err("three invalid cells").to_string();
        for words in
            ["line 2, slip_velocity: \"x\"", "line 3, coefficient: \"nan\"", "line 5, coefficient"]
        {
            assert!(said.contains(words), "{words}: {said}");
        }
        for (name, text, words) in [
            (
                "e.csv",
                "velocity,coefficient\n1,2\n",
                "a column slip_velocity or slip_velocity_m_per_s",
            ),
            ("f.csv", "slip_velocity,friction_force\n1,2\n", "friction_force and normal_load"),
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
}
