//! CSV files of modes: a line for each mode, a column for each point of its shape.
//!
//! Columns `frequency` (angular) or `frequency_hz`, `damping_ratio` and optionally `modal_mass`; every other column is a
//! point, and its numbers are the displacements of the point in the modes.

use std::f64::consts::TAU;
use std::fmt;

use quell_model::parameter::Bounds;
use quell_model::parameter::system::{SYSTEM_MODAL_MASS, SYSTEM_MODE_DAMPING};

use crate::data_file::DataFile;
use crate::files::WantedFile;
use crate::wrong_file::{WrongFile, WrongTable};

/// What the file must be.
const WHAT: &str = "a CSV file of modes";

/// The file.
pub const WANTED: WantedFile = WantedFile::of(WHAT);

/// What is wrong with a list of modes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WrongModes {
    /// There are more modes than allowed.
    TooMany {
        /// The largest number.
        most: usize,
        /// Their number.
        count: usize,
    },
    /// There are no modes.
    Empty,
    /// No column has displacements of a point.
    NoPoint,
    /// A column has no name.
    UnnamedColumn,
    /// No column has the frequencies of a disc.
    NoRatio,
}

impl fmt::Display for WrongModes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooMany { most, count } => {
                write!(f, "a CSV file of at most {most} modes; this one has {count}")
            }
            Self::Empty => f.write_str("a CSV file with at least one mode"),
            Self::NoPoint => f.write_str("a CSV file with a column for each point of the shapes"),
            Self::UnnamedColumn => f.write_str("a CSV file with a name for every column"),
            Self::NoRatio => f.write_str("a CSV file with a column ratio or frequency_hz"),
        }
    }
}

impl std::error::Error for WrongModes {}

impl From<WrongModes> for WrongFile<WrongModes> {
    fn from(why: WrongModes) -> Self {
        Self::Contents(why)
    }
}

/// A mode.
#[derive(Clone, Debug, PartialEq)]
pub struct SystemMode {
    /// Angular frequency.
    pub frequency: f64,
    /// Damping ratio.
    pub damping_ratio: f64,
    /// Modal mass, if the file has it.
    pub modal_mass: Option<f64>,
    /// Displacement of each point of the list.
    pub shape: Vec<f64>,
}

/// The modes of a structure or of one of its components.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ModeList {
    /// Whether the file gives frequencies in hertz.
    pub in_hertz: bool,
    /// Names of the points.
    pub points: Vec<String>,
    /// The modes, in the order of the file.
    pub modes: Vec<SystemMode>,
}

/// The modes of a text, at most `most`.
///
/// # Errors
/// What is wrong, with its line.
pub fn parse(text: &str, most: usize) -> Result<ModeList, WrongFile<WrongModes>> {
    let file = DataFile::new(text, WHAT)?;
    let count = file.rows().len();
    if count > most {
        return Err(WrongModes::TooMany { most, count }.into());
    }
    let (frequency, in_hertz) = file.frequency()?;
    let damping = file.needed(SYSTEM_MODE_DAMPING.key())?;
    let mass = file.column(SYSTEM_MODAL_MASS.key());
    let known = [Some(frequency), Some(damping), mass];
    let points: Vec<(usize, &str)> = file
        .names()
        .iter()
        .enumerate()
        .filter(|(at, _)| !known.contains(&Some(*at)))
        .map(|(at, name)| (at, *name))
        .collect();
    if points.is_empty() {
        return Err(WrongModes::NoPoint.into());
    }
    if points.iter().any(|(_, name)| name.is_empty()) {
        return Err(WrongModes::UnnamedColumn.into());
    }
    let modes: Vec<SystemMode> = file
        .rows()
        .iter()
        .map(|row| {
            let number = |at: usize, name: &str, bounds: Bounds| {
                row.number(at, name, &bounds.to_string(), |value| bounds.contains(value))
            };
            let name = if in_hertz { "frequency_hz" } else { "frequency" };
            let written = number(frequency, name, Bounds::NOT_NEGATIVE)?;
            let shape = points.iter().map(|(at, name)| number(*at, name, Bounds::FINITE));
            Ok(SystemMode {
                frequency: if in_hertz { TAU * written } else { written },
                damping_ratio: number(damping, "damping_ratio", Bounds::NOT_NEGATIVE)?,
                modal_mass: mass
                    .map(|at| number(at, "modal_mass", Bounds::POSITIVE))
                    .transpose()?,
                shape: shape.collect::<Result<_, WrongTable>>()?,
            })
        })
        .collect::<Result<_, WrongTable>>()?;
    if modes.is_empty() {
        return Err(WrongModes::Empty.into());
    }
    let points = points.into_iter().map(|(_, name)| name.to_owned()).collect();
    Ok(ModeList { in_hertz, points, modes })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_beyond_the_known_ones_are_points() {
        let text = "# a rotor\nfrequency_hz, damping_ratio, pad_x, pad_y\n10, 0.01, 0.5, 1\n20, 0.02, -1, 0\n";
        let list = parse(text, 10).expect("modes");
        assert_eq!(list.points, ["pad_x", "pad_y"]);
        assert_eq!(list.modes[1].frequency, TAU * 20.0);
        assert_eq!(list.modes[0].shape, [0.5, 1.0]);
        for (text, part) in [
            ("frequency,frequency_hz,damping_ratio,x\n1,1,0,1\n", "has both"),
            ("damping_ratio,x\n0,1\n", "frequency or frequency_hz"),
            ("frequency,x\n1,1\n", "damping_ratio"),
            ("frequency,damping_ratio\n1,0\n", "each point"),
            ("frequency,damping_ratio,x\n1,0,nan\n", "line 2, x"),
            ("frequency,damping_ratio,x\n-1,0,1\n", "line 2, frequency"),
            ("frequency,damping_ratio,x\n", "at least one mode"),
            ("frequency,damping_ratio,x,x\n1,0,1,1\n", "different names"),
        ] {
            let wrong = parse(text, 10).expect_err(text).to_string();
            assert!(wrong.contains(part), "{text}: {wrong}");
        }
        let many = "frequency,damping_ratio,x\n".to_owned() + &"1,0,1\n".repeat(100_000);
        assert!(parse(&many, 2000).expect_err("too many").to_string().contains("100000"));
    }
}
