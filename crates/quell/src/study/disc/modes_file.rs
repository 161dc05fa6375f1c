//! A CSV file of modes: what `quell modes --save` writes, or anyone else.
//!
//! Comment lines begin with `#`; the first other line names the columns: `diameters`, `ratio` or `frequency_hz`,
//! `shape_at_load`, and `damping` where modes have their own. Other columns are passed over. Where there are both, `ratio` counts.

use std::fs;
use std::path::Path;

use quell_model::parameter::Parameter;
use quell_model::parameter::disc::{
    MODE_DAMPING, MODE_DIAMETERS, MODE_FREQUENCY, MODE_RATIO, MODE_SHAPE_AT_LOAD,
};

use super::modes::Line;

/// The largest file of modes that is read.
const LARGEST: u64 = 16 << 20;

/// Reads the lines of a file.
///
/// # Errors
/// What is wrong, with its line.
pub(super) fn read(path: &Path) -> Result<Vec<Line>, String> {
    let unreadable =
        |error: std::io::Error| format!("a CSV file of modes; it cannot be read: {error}");
    let size = fs::metadata(path).map_err(unreadable)?;
    if !size.is_file() || size.len() > LARGEST {
        return Err("a CSV file of modes of at most 16 MiB".to_owned());
    }
    parse(&fs::read_to_string(path).map_err(unreadable)?)
}

fn parse(text: &str) -> Result<Vec<Line>, String> {
    let mut rows = text
        .lines()
        .enumerate()
        .map(|(index, line)| (index + 1, line.trim().trim_start_matches('\u{feff}')))
        .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
    let (_, header) = rows.next().ok_or("a CSV file of modes with a line of column names")?;
    let names: Vec<&str> = header.split(',').map(|name| name.trim().trim_matches('"')).collect();
    let column = |parameter: Parameter| names.iter().position(|name| *name == parameter.key());
    let needed = |parameter: Parameter| {
        column(parameter).ok_or_else(|| format!("a CSV file with a column {}", parameter.key()))
    };
    let (diameters, shape) = (needed(MODE_DIAMETERS)?, needed(MODE_SHAPE_AT_LOAD)?);
    let (ratio, hertz) = (column(MODE_RATIO), column(MODE_FREQUENCY));
    if ratio.is_none() && hertz.is_none() {
        return Err("a CSV file with a column ratio or frequency_hz".to_owned());
    }
    let damping = column(MODE_DAMPING);
    let mut lines = Vec::new();
    for (number, row) in rows {
        let cells: Vec<&str> = row.split(',').map(str::trim).collect();
        let value = |at: usize, parameter: Parameter| -> Result<f64, String> {
            let cell = cells.get(at).copied().unwrap_or_default();
            let whole = parameter == MODE_DIAMETERS;
            let right =
                |value: &f64| parameter.bounds.contains(*value) && !(whole && value.fract() != 0.0);
            cell.parse::<f64>().ok().filter(right).ok_or_else(|| {
                let kind = if whole { " (whole)" } else { "" };
                format!(
                    "line {number}, {}: {cell:?} must be {}{kind}",
                    parameter.key(),
                    parameter.bounds
                )
            })
        };
        let ratio = ratio.map(|at| value(at, MODE_RATIO)).transpose()?;
        let hertz = match ratio {
            Some(_) => None,
            None => hertz.map(|at| value(at, MODE_FREQUENCY)).transpose()?,
        };
        lines.push(Line {
            diameters: value(diameters, MODE_DIAMETERS)?,
            ratio,
            hertz,
            shape_at_load: value(shape, MODE_SHAPE_AT_LOAD)?,
            damping: damping.map(|at| value(at, MODE_DAMPING)).transpose()?,
        });
    }
    if lines.is_empty() {
        return Err("a CSV file with at least one mode".to_owned());
    }
    Ok(lines)
}
