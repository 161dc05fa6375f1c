//! Tables of numbers in files: columns by name, wrong cells by line.
//!
//! How a table is written (`dialect`) is found in its text. In a file that a study names the first line that is no comment has the names; a measured
//! file may begin with the header of a recorder and give units. Columns that are not requested are ignored.
//!
//! A study may come from an untrusted source and may name any file: error messages show nothing of a file unless the
//! required columns were found in it, and then only the invalid cell, truncated.

use std::fmt::Display;
use std::path::Path;

use serde_json::Value as Json;

use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::dialect::{self, Column, FileDialect, FoundTable, Header};
use crate::input::read_regular;
use crate::matlab_file;
pub use crate::row::{Row, distinct, within};
use crate::wrong_file::{UnreadFile, WrongTable};

/// The largest file that is read, in MiB.
pub const LARGEST: u64 = 16;

/// How files of other programs begin, and how one of them becomes text.
const FORMATS: &[(&[u8], &str)] = &[
    (
        b"\x93NUMPY",
        "this file is a NumPy array: np.savetxt(\"data.csv\", np.column_stack([np.load(f\"{name}.npy\").ravel() for name in names]), \
         delimiter=\",\", header=\",\".join(names), comments=\"\") with names = [\"time\", \"velocity\", …] writes one column of CSV for each file",
    ),
    (b"\xd0\xcf\x11\xe0", WORKBOOK),
    (
        b"MATLAB 7.3 MAT-file",
        "this file is a MATLAB file of version 7.3 (HDF5): save(\"data.mat\", \"-v7\") in MATLAB writes one that is read",
    ),
    (
        b"\x89HDF\r\n",
        "this file is an HDF5 file: pandas.read_hdf(\"data.h5\").to_csv(\"data.csv\", index=False) writes a table of it as CSV",
    ),
    (
        b"PAR1",
        "this file is a Parquet file: pandas.read_parquet(\"data.parquet\").to_csv(\"data.csv\", index=False) writes it as CSV",
    ),
    (
        b"TDSm",
        "this file is a TDMS file of LabVIEW: nptdms.TdmsFile(\"data.tdms\").as_dataframe().to_csv(\"data.csv\", index=False) writes it as CSV",
    ),
    (b"\x1f\x8b", "this file is compressed by gzip: unpack it first"),
];

/// How a workbook becomes text.
const WORKBOOK: &str = "this file is a workbook of Excel: pandas.read_excel(\"data.xlsx\", sheet_name=0).to_csv(\"data.csv\", index=False) writes its first sheet as CSV, and sheet_name=\"NAME\" another one";

/// How an archive of NumPy arrays becomes text.
const ARRAYS: &str = "this file is an archive of NumPy arrays: pandas.DataFrame(dict(np.load(\"data.npz\"))).to_csv(\"data.csv\", index=False) writes arrays of \
                      one length as CSV";

/// What a file of another program is, and how it becomes text.
fn other_program(bytes: &[u8]) -> Option<&'static str> {
    if bytes.starts_with(b"PK\x03\x04") {
        // The name of the first entry of the archive.
        let name = bytes.get(30..).unwrap_or_default();
        let length = bytes.get(26..28).map_or(0, |length| usize::from(length[0]));
        let name = &name[..length.min(name.len())];
        return Some(match name {
            name if name.ends_with(b".npy") => ARRAYS,
            name if name.starts_with(b"xl/")
                || name.starts_with(b"[Content_Types]")
                || name.starts_with(b"_rels/") =>
            {
                WORKBOOK
            }
            _ => "this file is an archive: unpack it first; a sheet of a workbook is saved as CSV",
        });
    }
    FORMATS.iter().find(|(begin, _)| bytes.starts_with(begin)).map(|(_, how)| *how)
}

/// The text of bytes: UTF-8 or UTF-16 with their mark, or Latin-1; `None` if it has control characters.
fn decoded(bytes: Vec<u8>) -> Option<String> {
    let wide = |bytes: &[u8], unit: fn([u8; 2]) -> u16| -> Option<String> {
        let pairs = bytes.chunks_exact(2);
        let whole = pairs.remainder().is_empty();
        let units: Vec<u16> = pairs.map(|pair| unit([pair[0], pair[1]])).collect();
        String::from_utf16(&units).ok().filter(|_| whole)
    };
    let text = match &bytes[..] {
        [0xff, 0xfe, rest @ ..] => wide(rest, u16::from_le_bytes)?,
        [0xfe, 0xff, rest @ ..] => wide(rest, u16::from_be_bytes)?,
        _ => String::from_utf8(bytes).unwrap_or_else(|wrong| {
            wrong.into_bytes().iter().map(|byte| char::from(*byte)).collect()
        }),
    };
    let text = text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text);
    let allowed =
        |c: char| !c.is_ascii_control() || matches!(c, '\t' | '\n' | '\r' | '\u{c}' | '\u{1b}');
    text.chars().all(allowed).then_some(text)
}

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
    as_text(bytes(path, what, most)?, what)
}

fn bytes(path: &Path, what: &'static str, most: u64) -> Result<Vec<u8>, UnreadFile> {
    read_regular(path, most << 20).map_err(|error| UnreadFile::Unreadable {
        what,
        most,
        why: error.to_string(),
    })
}

fn as_text(bytes: Vec<u8>, what: &'static str) -> Result<String, UnreadFile> {
    if let Some(how) = other_program(&bytes) {
        return Err(UnreadFile::OtherProgram { what, how });
    }
    decoded(bytes).ok_or(UnreadFile::NotText { what })
}

/// Reads a measured file: text, or the variables of a MATLAB file as a table.
///
/// # Errors
/// Why it cannot be read.
pub fn measured(path: &Path, what: &'static str) -> Result<MeasuredText, UnreadFile> {
    let bytes = bytes(path, what, LARGEST)?;
    if matlab_file::is_one(&bytes) {
        let variables =
            matlab_file::table(&bytes).map_err(|why| UnreadFile::Matlab { what, why })?;
        return Ok(MeasuredText { text: variables.text, others: Some(variables.others) });
    }
    Ok(MeasuredText { text: as_text(bytes, what)?, others: None })
}

/// The text of a measured file.
#[derive(Debug)]
pub struct MeasuredText {
    text: String,
    /// Variables of a MATLAB file that are no columns; `None` for a text.
    others: Option<Vec<String>>,
}

/// The 64-bit FNV-1a checksum of bytes.
pub fn checksum(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |sum: u64, byte| {
        (sum ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// A table whose columns are known.
#[derive(Debug)]
pub struct DataFile<'t> {
    columns: Vec<Column<'t>>,
    rows: Vec<Row<'t>>,
    dialect: FileDialect,
    /// Variables of a MATLAB file that are no columns.
    others: &'t [String],
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
    /// The columns in words, at most twelve, and the number of rows.
    pub(crate) fn listed(&self) -> String {
        let name = |column: &Column<'_>| match &column.unit {
            Some(unit) if column.base == column.name => format!("{:?} in {unit}", column.name),
            _ => format!("{:?}", column.name),
        };
        let mut listed: Vec<String> = self.columns.iter().take(12).map(name).collect();
        if self.columns.len() > 12 {
            listed.push(format!("{} more", self.columns.len() - 12));
        }
        let others = match self.others {
            [] => String::new(),
            others => format!(", and {} without a column", others.join(", ")),
        };
        let rows = self.rows.len();
        let ending = if rows == 1 { "" } else { "s" };
        format!("{} with {rows} row{ending}{others}", listed.join(", "))
    }

    /// Splits the text of a file that a study names. The first line that is no comment names the columns.
    ///
    /// # Errors
    /// If there is no such line, if it has one name twice, and if the decimal sign changes.
    pub fn new(text: &'t str, what: &'static str) -> Result<Self, WrongTable> {
        let found = dialect::find(text, what, Header::Names)?;
        dialect::distinct(&found.columns)?;
        Ok(Self::of(found, &[]))
    }

    /// Splits the text of a measured file, which may begin with the header of a recorder and give units.
    ///
    /// # Errors
    /// If no line names the columns, and if the decimal sign changes.
    pub fn measured(file: &'t MeasuredText, what: &'static str) -> Result<Self, WrongTable> {
        let found = match &file.others {
            None => dialect::find(&file.text, what, Header::Recorder)?,
            Some(_) => dialect::of_variables(&file.text, what)?,
        };
        let named = found.columns.iter().position(|column| column.name.contains(char::is_control));
        if let Some(place) = named {
            return Err(WrongTable::ControlCharacters(place + 1));
        }
        Ok(Self::of(found, file.others.as_deref().unwrap_or_default()))
    }

    fn of(found: FoundTable<'t>, others: &'t [String]) -> Self {
        let FoundTable { columns, rows, dialect } = found;
        Self { columns, rows, dialect, others }
    }

    /// How the file is written.
    pub fn dialect(&self) -> &FileDialect {
        &self.dialect
    }

    /// The columns.
    pub fn columns(&self) -> &[Column<'t>] {
        &self.columns
    }

    /// Index of a column.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|known| known.name == name)
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
    pub fn names(&self) -> Vec<&'t str> {
        self.columns.iter().map(|column| column.name).collect()
    }

    /// The lines of numbers.
    pub fn rows(&self) -> &[Row<'t>] {
        &self.rows
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
            (&b"PK\x03\x04\x14\x00"[..], "an archive: unpack it"),
            (b"PK\x03\x04\x14\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x13\0\0\0[Content_Types].xml", "pandas.read_excel"),
            (b"PK\x03\x04\x14\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x05\0\0\0F.npyx", "np.load(\"data.npz\")"),
            (b"\x93NUMPY\x01\x00", "np.savetxt"),
            (b"\xd0\xcf\x11\xe0\xa1", "pandas.read_excel"),
            (b"MATLAB 7.3 MAT-file", "-v7"),
            (b"\xff\xfe\x00", "is not text"),
            (b"v,mu\n0.1,\x000.4\n", "is not text"),
        ] {
            let why = why(bytes).expect_err(wanted).to_string();
            assert!(why.starts_with("a CSV file of numbers") && why.contains(wanted), "{why}");
        }
        assert_eq!(why(b"velocity,coefficient\n0.1,0.4\n"), Ok(()));
        // The mark of UTF-8, Latin-1 and UTF-16.
        assert_eq!(why(b"\xef\xbb\xbfvelocity;coefficient\r\n0,1;0,4\r\n"), Ok(()));
        std::fs::write(&path, b"t (\xb5s),a (m/s\xb2)\n1,2\n").expect("written");
        assert_eq!(text(&path, "a table").expect("Latin-1"), "t (µs),a (m/s²)\n1,2\n");
        std::fs::write(&path, b"\xff\xfev\0\n\x001\0\n\0").expect("written");
        assert_eq!(text(&path, "a table").expect("UTF-16"), "v\n1\n");
        // A file that is too large is not read.
        std::fs::File::create(&path)
            .and_then(|file| file.set_len((LARGEST << 20) + 1))
            .expect("a hole");
        let large = text(&path, "a table").expect_err("large").to_string();
        assert!(large.contains("larger than 16 MiB"), "{large}");
        // One column is a file too.
        assert_eq!(why(b"velocity\n0.1\n"), Ok(()));
    }
}
