//! A CSV file of the modes of a disc, as `quell modes --save` writes it.
//!
//! Comment lines begin with `#`; the first other line names the columns: `diameters`, `ratio` or `frequency_hz`,
//! `shape_at_load`, and optionally `damping` and `centrifugal`. Other columns are ignored. If both are given, `ratio` is used.

use quell_model::parameter::Parameter;
use quell_model::parameter::disc::{
    MODE_CENTRIFUGAL, MODE_DAMPING, MODE_DIAMETERS, MODE_FREQUENCY, MODE_RATIO, MODE_SHAPE_AT_LOAD,
};

use crate::data_file::{DataFile, Row};
use crate::files::WantedFile;
use crate::modes_file::WrongModes;
use crate::wrong_file::{WrongFile, WrongTable};

/// What the file must be.
const WHAT: &str = "a CSV file of modes";

/// The file.
pub const WANTED: WantedFile = WantedFile::of(WHAT);

/// One mode of a list, with its frequency as given.
#[derive(Clone, Copy, Debug)]
pub struct ModeLine {
    /// Nodal diameters, a whole number.
    pub diameters: f64,
    /// Frequency as a ratio to ω_ref.
    pub ratio: Option<f64>,
    /// Frequency, Hz.
    pub hertz: Option<f64>,
    /// Shape at the load.
    pub shape_at_load: f64,
    /// Damping ratio.
    pub damping: Option<f64>,
    /// Centrifugal coefficient.
    pub centrifugal: Option<f64>,
}

/// The lines of a text.
///
/// # Errors
/// What is wrong, with its line.
pub fn parse(text: &str) -> Result<Vec<ModeLine>, WrongFile<WrongModes>> {
    let file = DataFile::new(text, WHAT)?;
    let column = |parameter: Parameter| file.column(parameter.key());
    let needed = |parameter: Parameter| file.needed(parameter.key());
    let (diameters, shape) = (needed(MODE_DIAMETERS)?, needed(MODE_SHAPE_AT_LOAD)?);
    let (ratio, hertz) = (column(MODE_RATIO), column(MODE_FREQUENCY));
    if ratio.is_none() && hertz.is_none() {
        return Err(WrongModes::NoRatio.into());
    }
    let (damping, centrifugal) = (column(MODE_DAMPING), column(MODE_CENTRIFUGAL));
    let line = |row: &Row<'_>| {
        let value = |at: usize, parameter: Parameter| {
            let whole = parameter == MODE_DIAMETERS;
            let kind = if whole { " (whole)" } else { "" };
            row.number(at, parameter.key(), &format!("{}{kind}", parameter.bounds), |value| {
                parameter.bounds.contains(value) && !(whole && value.fract() != 0.0)
            })
        };
        let ratio = ratio.map(|at| value(at, MODE_RATIO)).transpose()?;
        let hertz = match ratio {
            Some(_) => None,
            None => hertz.map(|at| value(at, MODE_FREQUENCY)).transpose()?,
        };
        Ok(ModeLine {
            diameters: value(diameters, MODE_DIAMETERS)?,
            ratio,
            hertz,
            shape_at_load: value(shape, MODE_SHAPE_AT_LOAD)?,
            damping: damping.map(|at| value(at, MODE_DAMPING)).transpose()?,
            centrifugal: centrifugal.map(|at| value(at, MODE_CENTRIFUGAL)).transpose()?,
        })
    };
    let lines: Vec<ModeLine> = file.rows().iter().map(line).collect::<Result<_, WrongTable>>()?;
    if lines.is_empty() {
        return Err(WrongModes::Empty.into());
    }
    Ok(lines)
}
