//! CSV files that a study names: columns by name, wrong cells by line.
//!
//! Comment lines begin with `#`; the first other line names the columns. Columns that are not requested are ignored.
//!
//! A study may come from an untrusted source and may name any file: error messages show nothing of a file unless the
//! required columns were found in it, and then only the invalid cell, truncated.

use std::fmt::Display;
use std::path::Path;

use serde_json::Value as Json;

use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::input::read_regular;
use crate::wrong_file::{UnreadFile, WrongTable};

/// The largest file that is read, in MiB.
pub const LARGEST: u64 = 16;

/// Maximum number of characters of a cell that are shown.
const SHOWN: usize = 24;

/// How files of other programs begin, and how one of them becomes text.
const FORMATS: &[(&[u8], &str)] = &[
    (b"PK\x03\x04", "this file is a workbook or an archive: save its sheet as CSV"),
    (
        b"\x93NUMPY",
        "this file is a NumPy array: np.savetxt(\"data.csv\", array, delimiter=\",\", header=\"…\", comments=\"\") writes it as CSV",
    ),
];

/// What may stand between columns elsewhere.
const SEPARATORS: &[(char, &str)] = &[(';', "semicolons"), ('\t', "tabs")];

/// Reads a file as text; `what` is what it must be, such as "a CSV file of samples".
///
/// # Errors
/// Why it cannot be read.
pub fn text(path: &Path, what: &'static str) -> Result<String, UnreadFile> {
    text_up_to(path, what, LARGEST)
}

/// As [`text`], up to a size in MiB.
///
/// # Errors
/// Why it cannot be read.
pub fn text_up_to(path: &Path, what: &'static str, most: u64) -> Result<String, UnreadFile> {
    let bytes = read_regular(path, most << 20).map_err(|error| UnreadFile::Unreadable {
        what,
        most,
        why: error.to_string(),
    })?;
    let known = FORMATS.iter().find(|(begin, _)| bytes.starts_with(begin));
    if let Some((_, how)) = known {
        return Err(UnreadFile::OtherProgram { what, how });
    }
    String::from_utf8(bytes).map_err(|_| UnreadFile::NotText { what })
}

/// The 64-bit FNV-1a checksum of bytes.
pub fn checksum(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |sum: u64, byte| {
        (sum ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// Checks that no two columns have one name: which of them is meant would be a guess, and that none has a control character. Empty
/// names may repeat.
///
/// # Errors
/// The places of columns that have. Names are not shown: the file may be any.
pub fn distinct(names: &[&str]) -> Result<(), WrongTable> {
    if let Some(place) = names.iter().position(|name| name.contains(char::is_control)) {
        return Err(WrongTable::ControlCharacters(place + 1));
    }
    let named = names.iter().enumerate().filter(|(_, name)| !name.is_empty());
    for (place, name) in named {
        if let Some(before) = names[..place].iter().position(|known| known == name) {
            return Err(WrongTable::SameName([before + 1, place + 1]));
        }
    }
    Ok(())
}

/// Checks that a line has no cells beyond the columns, as decimal commas add them. A comma at the end of a line adds none.
///
/// # Errors
/// The line, and the numbers of cells and columns.
pub fn within(cells: &[&str], columns: usize, line: usize) -> Result<(), WrongTable> {
    if cells.iter().skip(columns).all(|cell| cell.trim().is_empty()) {
        return Ok(());
    }
    Err(WrongTable::TooManyCells { line, cells: cells.len(), columns })
}

/// A CSV file whose columns are known.
#[derive(Debug)]
pub struct DataFile<'t> {
    names: Vec<&'t str>,
    rows: Vec<Row<'t>>,
}

/// A line of numbers.
#[derive(Debug)]
pub struct Row<'t> {
    /// Number of the line, from 1.
    line: usize,
    cells: Vec<&'t str>,
    /// Number of columns of the file.
    columns: usize,
}

/// The complaint about a data file that an argument names.
pub(crate) fn complaint(path: &Path, why: impl Display) -> Complaint {
    let given = Json::from(path.display().to_string());
    Complaint::new(Fault::Path, "data file", Origin::Whole, given, why.to_string())
}

/// The most invalid cells that are reported.
const REPORTED: usize = 20;

/// Fails with the first complaints about invalid cells.
pub(crate) fn reported<W: Display>(path: &Path, found: &[W]) -> Result<(), Failure> {
    if found.is_empty() {
        return Ok(());
    }
    let mut complaints: Vec<Complaint> =
        found.iter().take(REPORTED).map(|why| complaint(path, why)).collect();
    if let Some(further) = found.len().checked_sub(REPORTED).filter(|further| *further > 0) {
        complaints.push(complaint(path, format_args!("{further} further cells are invalid")));
    }
    Err(complaints.into())
}

impl<'t> DataFile<'t> {
    /// The columns in words, at most twelve.
    pub(crate) fn listed(&self) -> String {
        let names: Vec<String> =
            self.names.iter().take(12).map(|name| format!("{name:?}")).collect();
        names.join(", ")
    }

    /// Splits the text into column names and rows.
    ///
    /// # Errors
    /// If there is no header line, or if it has one name twice.
    pub fn new(text: &'t str, what: &'static str) -> Result<Self, WrongTable> {
        let mut lines = text
            .lines()
            .enumerate()
            .map(|(index, line)| (index + 1, line.trim().trim_start_matches('\u{feff}')))
            .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
        let (_, header) = lines.next().ok_or(WrongTable::NoHeader { what })?;
        let names: Vec<&str> =
            header.split(',').map(|name| name.trim().trim_matches('"')).collect();
        let other = SEPARATORS.iter().find(|(mark, _)| names.len() == 1 && header.contains(*mark));
        if let Some((_, separators)) = other {
            return Err(WrongTable::Separators { what, separators });
        }
        distinct(&names)?;
        let columns = names.len();
        let rows = lines
            .map(|(line, row)| Row {
                line,
                cells: row.split(',').map(str::trim).collect(),
                columns,
            })
            .collect();
        Ok(Self { names, rows })
    }

    /// Index of a column.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|known| *known == name)
    }

    /// Index of a column that must be there.
    ///
    /// # Errors
    /// It is not.
    pub fn needed(&self, name: &'static str) -> Result<usize, WrongTable> {
        self.column(name).ok_or(WrongTable::Lacks(name))
    }

    /// Index of the column of frequencies, `frequency` or `frequency_hz`, and whether it is in hertz.
    ///
    /// # Errors
    /// The file has neither column, or both.
    pub fn frequency(&self) -> Result<(usize, bool), WrongTable> {
        match (self.column("frequency"), self.column("frequency_hz")) {
            (Some(_), Some(_)) => Err(WrongTable::BothFrequencies),
            (Some(at), None) => Ok((at, false)),
            (None, Some(at)) => Ok((at, true)),
            (None, None) => Err(WrongTable::NoFrequency),
        }
    }

    /// Names of the columns.
    pub fn names(&self) -> &[&'t str] {
        &self.names
    }

    /// The lines of numbers.
    pub fn rows(&self) -> &[Row<'t>] {
        &self.rows
    }
}

impl Row<'_> {
    /// The text in a column; empty if the line is too short.
    pub fn text(&self, at: usize) -> &str {
        self.cells.get(at).copied().unwrap_or_default().trim_matches('"')
    }

    /// Number of the line, from 1.
    pub fn line(&self) -> usize {
        self.line
    }

    /// Where the row is in its file.
    pub fn place(&self) -> String {
        format!("line {}", self.line)
    }

    /// The number in a column, if it is `right`.
    ///
    /// # Errors
    /// Line, column, the cell, and what it must be.
    pub fn number(
        &self,
        at: usize,
        name: &str,
        allowed: &str,
        right: impl Fn(f64) -> bool,
    ) -> Result<f64, WrongTable> {
        within(&self.cells, self.columns, self.line)?;
        let cell = self.cells.get(at).copied().unwrap_or_default();
        cell.parse().ok().filter(|&value| right(value)).ok_or_else(|| {
            let short: String = cell.chars().take(SHOWN).collect();
            let rest = if short.len() < cell.len() { "…" } else { "" };
            WrongTable::Cell {
                line: self.line,
                column: name.to_owned(),
                cell: format!("{short:?}{rest}"),
                allowed: allowed.to_owned(),
            }
        })
    }

    /// Whether the number in a column is below 0.
    pub fn is_negative(&self, at: usize) -> bool {
        self.cells
            .get(at)
            .and_then(|cell| cell.parse::<f64>().ok())
            .is_some_and(|number| number < 0.0)
    }
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use super::*;
    use crate::wrong_file::WrongFile;

    #[test]
    fn files_of_other_programs_are_named() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("data");
        let why = |bytes: &[u8]| -> Result<(), WrongFile<Infallible>> {
            std::fs::write(&path, bytes).expect("written");
            let text = text(&path, "a CSV file of numbers")?;
            Ok(DataFile::new(&text, "a CSV file of numbers").map(|_| ())?)
        };
        for (bytes, wanted) in [
            (&b"velocity;coefficient\n0,1;0,4\n"[..], "this file has semicolons"),
            (b"velocity\tcoefficient\n0.1\t0.4\n", "this file has tabs"),
            (b"PK\x03\x04\x14\x00", "save its sheet as CSV"),
            (b"\x93NUMPY\x01\x00", "np.savetxt"),
            (b"\xff\xfe\x00", "is not text"),
        ] {
            let why = why(bytes).expect_err(wanted).to_string();
            assert!(why.starts_with("a CSV file of numbers") && why.contains(wanted), "{why}");
        }
        assert_eq!(why(b"velocity,coefficient\n0.1,0.4\n"), Ok(()));
        // One column is a file too.
        assert_eq!(why(b"velocity\n0.1\n"), Ok(()));
    }
}
