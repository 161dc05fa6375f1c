//! Samples of a waveform in a file of their own.
//!
//! The file has one number per line, or is a CSV file whose header line names the column `value` (a single column may have any name).
//! Comment lines begin with `#`. The samples are at equal distances, so that no line may be left out.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::study::data_file;

/// What the file must be.
const WHAT: &str = "a file of samples, one number per line, or a CSV file with a column value";

/// The column of samples.
const COLUMN: &str = "value";

/// A file of samples that has been read.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct WaveFile {
    path: PathBuf,
    values: Arc<[f64]>,
}

impl WaveFile {
    /// The file.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// What identifies its samples: their number and a checksum.
    pub(super) fn settings(&self, index: usize) -> (String, String) {
        let sum = data_file::checksum(&self.values);
        (format!("dither.file[{index}]"), format!("{} samples, {sum:016x}", self.values.len()))
    }
}

/// The files of samples of a study: those that are known from before a change are not read again.
#[derive(Debug)]
pub(super) struct WaveFiles<'a> {
    folder: &'a Path,
    known: &'a [WaveFile],
    found: Vec<WaveFile>,
}

impl<'a> WaveFiles<'a> {
    /// The folder in which the files are.
    pub(super) fn folder(&self) -> &'a Path {
        self.folder
    }

    /// Files in a folder.
    pub(super) fn new(folder: &'a Path, known: &'a [WaveFile]) -> Self {
        Self { folder, known, found: Vec::new() }
    }

    /// The files that the study names.
    pub(super) fn into_found(self) -> Vec<WaveFile> {
        self.found
    }

    /// The samples of a file.
    ///
    /// # Errors
    /// Why it cannot be read, or the line that is wrong.
    pub(super) fn values(&mut self, name: &str) -> Result<Vec<f64>, String> {
        let path = self.folder.join(name);
        let known = self.known.iter().chain(&self.found).find(|known| known.path == path);
        let file = if let Some(known) = known {
            known.clone()
        } else {
            let values = parse(&data_file::text(&path, WHAT)?)?.into();
            WaveFile { path, values }
        };
        let values = file.values.to_vec();
        self.found.push(file);
        Ok(values)
    }
}

/// The samples of a text. Messages show nothing of it: a study may name any file.
fn parse(text: &str) -> Result<Vec<f64>, String> {
    let lines = text.trim_end().lines().enumerate();
    let mut lines = lines
        .map(|(index, line)| (index + 1, line.trim().trim_start_matches('\u{feff}')))
        .filter(|(_, line)| !line.starts_with('#'))
        .skip_while(|(_, line)| line.is_empty())
        .peekable();
    let (_, first) = lines.peek().copied().ok_or_else(|| format!("{WHAT}; this file is empty"))?;
    let number = |cell: &str| cell.trim().trim_matches('"').parse::<f64>();
    let column = if number(first).is_ok() {
        0
    } else {
        let names: Vec<&str> = first.split(',').map(|name| name.trim().trim_matches('"')).collect();
        let column = match names.iter().position(|name| *name == COLUMN) {
            None if names.len() == 1 => 0,
            found => found.ok_or(WHAT)?,
        };
        lines.next();
        column
    };
    lines
        .map(|(line, row)| {
            if row.is_empty() {
                return Err(format!(
                    "line {line} is empty: samples are at equal distances, without gaps"
                ));
            }
            let cell = row.split(',').nth(column).unwrap_or_default();
            match number(cell) {
                Ok(value) if value.is_finite() => Ok(value),
                _ => Err(format!("line {line} must have a finite number as sample")),
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_columns() {
        assert_eq!(parse("# g\n1\n -0.5\n2e-1\n\n"), Ok(vec![1.0, -0.5, 0.2]));
        assert_eq!(parse("time,value\n0,1\n1,\"2\"\n"), Ok(vec![1.0, 2.0]));
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
        ] {
            let said = parse(text).expect_err(text);
            assert!(said.contains(words), "{text:?}: {said}");
        }
    }
}
