//! Samples of a waveform in a file of their own.
//!
//! The file has one number per line, or is a CSV file whose header line names the column `value` (a single column may have any name).
//! Comment lines begin with `#`. The samples are at equal distances, so that no line may be left out.

use std::fmt;

use crate::data_file;
use crate::files::{Files, WantedFile};
use crate::wrong_file::WrongFile;

/// What the file must be.
const WHAT: &str = "a file of samples, one number per line, or a CSV file with a column value";

/// The column of samples.
const COLUMN: &str = "value";

/// Columns of times, which are checked for equal steps.
const TIMES: [&str; 2] = ["time", "time_s"];

/// Difference of a step in time from the mean step, as a share of it, from which samples are not at equal distances. Times of two
/// digits for each step stay within it; a gap of one sample is a difference of 100 %. Smaller jitter is not noticed.
const UNEQUAL: f64 = 0.1;

/// What is wrong with the samples of a waveform.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WrongWave {
    /// The file is empty.
    Empty,
    /// No column has samples.
    NoValue,
    /// A line, from 1, is empty.
    Gap {
        /// The line.
        line: usize,
    },
    /// A line, from 1, lacks a finite number.
    NotFinite {
        /// The line.
        line: usize,
        /// What the number is.
        kind: &'static str,
    },
    /// The time of a line, from 1, is not above that of the line before.
    NotAscending {
        /// The line.
        line: usize,
    },
    /// The step in time to a line, from 1, is not the mean step.
    UnequalStep {
        /// The line.
        line: usize,
    },
}

impl fmt::Display for WrongWave {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => write!(f, "{WHAT}; this file is empty"),
            Self::NoValue => f.write_str(WHAT),
            Self::Gap { line } => {
                write!(f, "line {line} is empty: samples are at equal distances, without gaps")
            }
            Self::NotFinite { line, kind } => {
                write!(f, "line {line} must have a finite number as {kind}")
            }
            Self::NotAscending { line } => write!(f, "line {line}: times must ascend"),
            Self::UnequalStep { line } => write!(
                f,
                "line {line}: its step in time differs from the mean step by more than {} %; samples are at equal distances",
                100.0 * UNEQUAL
            ),
        }
    }
}

impl std::error::Error for WrongWave {}

impl From<WrongWave> for WrongFile<WrongWave> {
    fn from(why: WrongWave) -> Self {
        Self::Contents(why)
    }
}

/// The samples of a file.
struct FileSamples(Vec<f64>);

/// The samples of the file that `key` names.
///
/// # Errors
/// Why it cannot be read, or the line that is wrong.
pub fn values(files: &mut Files, key: &str, name: &str) -> Result<Vec<f64>, WrongFile<WrongWave>> {
    let samples =
        files.parsed(key, name, WantedFile::of(WHAT), |text| parse(text).map(FileSamples))?;
    Ok(samples.0.clone())
}

/// The samples of a text. Messages show nothing of it: a study may name any file.
fn parse(text: &str) -> Result<Vec<f64>, WrongFile<WrongWave>> {
    let lines = text.trim_end().lines().enumerate();
    let mut lines = lines
        .map(|(index, line)| (index + 1, line.trim().trim_start_matches('\u{feff}')))
        .filter(|(_, line)| !line.starts_with('#'))
        .skip_while(|(_, line)| line.is_empty())
        .peekable();
    let (_, first) = lines.peek().copied().ok_or(WrongWave::Empty)?;
    let number = |cell: &str| cell.trim().trim_matches('"').parse::<f64>();
    let (column, time, columns) = if number(first).is_ok() {
        (0, None, 1)
    } else {
        let names: Vec<&str> = first.split(',').map(|name| name.trim().trim_matches('"')).collect();
        data_file::distinct(&names)?;
        let column = match names.iter().position(|name| *name == COLUMN) {
            None if names.len() == 1 => 0,
            found => found.ok_or(WrongWave::NoValue)?,
        };
        lines.next();
        (column, names.iter().position(|name| TIMES.contains(name)), names.len())
    };
    let mut times = Vec::new();
    let mut values = Vec::new();
    for (line, row) in lines {
        if row.is_empty() {
            return Err(WrongWave::Gap { line }.into());
        }
        let cells: Vec<&str> = row.split(',').collect();
        data_file::within(&cells, columns, line)?;
        let finite = |place: usize| {
            let found = cells.get(place).and_then(|cell| number(cell).ok());
            found.filter(|value| value.is_finite())
        };
        values.push(finite(column).ok_or(WrongWave::NotFinite { line, kind: "sample" })?);
        if let Some(place) = time {
            let found = finite(place).ok_or(WrongWave::NotFinite { line, kind: "time" })?;
            times.push((line, found));
        }
    }
    equal_steps(&times)?;
    Ok(values)
}

/// Checks that the times of the samples have equal steps: their values are not used, the dither has its own frequency.
///
/// # Errors
/// The line with another step.
fn equal_steps(times: &[(usize, f64)]) -> Result<(), WrongWave> {
    let [(_, first), .., (_, last)] = times else { return Ok(()) };
    let mean = (last - first) / (times.len() - 1) as f64;
    let rounding = f64::EPSILON * first.abs().max(last.abs());
    // Times are often written with few digits, so that a step may be off by a part of itself.
    let wrong = times.windows(2).find(|pair| {
        let step = pair[1].1 - pair[0].1;
        step.is_nan() || step <= 0.0 || (step - mean).abs() > UNEQUAL * mean + 4.0 * rounding
    });
    let Some(pair) = wrong else { return Ok(()) };
    if pair[1].1 <= pair[0].1 {
        return Err(WrongWave::NotAscending { line: pair[1].0 });
    }
    Err(WrongWave::UnequalStep { line: pair[1].0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_columns() {
        assert_eq!(parse("# g\n1\n -0.5\n2e-1\n\n"), Ok(vec![1.0, -0.5, 0.2]));
        assert_eq!(parse("time,value\n0,1\n1,\"2\"\n"), Ok(vec![1.0, 2.0]));
        assert_eq!(parse("time,value\n0,1\n0.33,2\n0.67,0\n1,1\n"), Ok(vec![1.0, 2.0, 0.0, 1.0]));
        assert_eq!(parse("force\n1\n2\n"), Ok(vec![1.0, 2.0]));
    }

    #[test]
    fn wrong_lines_are_named() {
        for (text, words) in [
            ("", "empty"),
            ("# only\n", "empty"),
            ("1\n\n2\n", "line 2 is empty"),
            ("1\n2\nx\n", "line 3"),
            ("1\nnan\n", "line 2"),
            ("time,value\n0,1\n1\n", "line 3"),
            ("time,force\n0,1\n", "a column value"),
            ("1,2\n3,4\n", "a column value"),
            ("1\n0,5\n", "line 2: 2 cells for 1 columns"),
            ("value\n1\n0,5\n", "line 3: 2 cells for 1 columns"),
            ("value,value\n1,2\n", "columns 1 and 2"),
            ("time,value\n0,1\n1,2\n3,1\n", "line 3: its step"),
            ("time_s,value\n0,1\n-1,2\n-2,1\n", "times must ascend"),
            ("time,value\n0,1\nx,2\n", "line 3 must have a finite number as time"),
        ] {
            let said = parse(text).expect_err(text).to_string();
            assert!(said.contains(words), "{text:?}: {said}");
        }
    }
}
