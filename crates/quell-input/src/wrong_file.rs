//! What is wrong with a file of data that a study or a command names.
//!
//! The words are those after "must be" in a complaint: what the file must be, and what it is instead.

use std::fmt;

use crate::matlab_file::WrongMatlab;

/// Why the text of a file is unknown.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum UnreadFile {
    /// It cannot be read, in the words of the operating system.
    Unreadable {
        /// What it must be.
        what: &'static str,
        /// The largest size in MiB.
        most: u64,
        /// Why.
        why: String,
    },
    /// It was written by another program.
    OtherProgram {
        /// What it must be.
        what: &'static str,
        /// What it is, and how it becomes text.
        how: &'static str,
    },
    /// It is not text.
    NotText {
        /// What it must be.
        what: &'static str,
    },
    /// It is a MATLAB file that cannot be read.
    Matlab {
        /// What it must be.
        what: &'static str,
        /// Why.
        why: WrongMatlab,
    },
}

/// What is wrong with the columns or a cell of a CSV file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WrongTable {
    /// No line names the columns.
    NoHeader {
        /// What the file must be.
        what: &'static str,
    },
    /// Nothing names the columns of the numbers.
    NoNames {
        /// What the file must be.
        what: &'static str,
        /// The first line of numbers, from 1.
        line: usize,
    },
    /// A number has a decimal point and a comma.
    TwoSigns {
        /// The line, from 1.
        line: usize,
    },
    /// The decimal sign is another one than before.
    OtherSign {
        /// The line, from 1.
        line: usize,
        /// The first line with the other sign.
        first: usize,
    },
    /// A LabVIEW measurement file has a second segment.
    SecondSegment {
        /// The line, from 1.
        line: usize,
    },
    /// A LabVIEW measurement file has no times, or several.
    NoTimes {
        /// The line, from 1.
        line: usize,
    },
    /// The name of a column, counted from 1, has control characters.
    ControlCharacters(usize),
    /// Two columns, counted from 1, have one name.
    SameName([usize; 2]),
    /// A column is missing.
    Lacks(&'static str),
    /// No column has frequencies.
    NoFrequency,
    /// Two columns have frequencies.
    BothFrequencies,
    /// A line has cells beyond the columns.
    TooManyCells {
        /// The line, from 1.
        line: usize,
        /// Number of its cells.
        cells: usize,
        /// Number of columns.
        columns: usize,
    },
    /// A line ends before its last column.
    TooFewCells {
        /// The line, from 1.
        line: usize,
        /// Number of its cells.
        cells: usize,
        /// Number of columns.
        columns: usize,
    },
    /// A cell has no number, or one that is not allowed.
    Cell {
        /// The line, from 1.
        line: usize,
        /// Name of the column.
        column: String,
        /// The cell in quotes, shortened.
        cell: String,
        /// The allowed numbers.
        allowed: String,
    },
}

/// What is wrong with a file of a format, in which `C` may be wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WrongFile<C> {
    /// Its text is unknown.
    Unread(UnreadFile),
    /// Its table.
    Table(WrongTable),
    /// Its contents.
    Contents(C),
}

impl<C> From<UnreadFile> for WrongFile<C> {
    fn from(why: UnreadFile) -> Self {
        Self::Unread(why)
    }
}

impl<C> From<WrongTable> for WrongFile<C> {
    fn from(why: WrongTable) -> Self {
        Self::Table(why)
    }
}

impl fmt::Display for UnreadFile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unreadable { what, most, why } => {
                write!(f, "{what} of at most {most} MiB; it cannot be read: {why}")
            }
            Self::OtherProgram { what, how } => write!(f, "{what}; {how}"),
            Self::NotText { what } => write!(f, "{what}; this file is not text"),
            Self::Matlab { what, why } => write!(f, "{what}; this MATLAB file {why}"),
        }
    }
}

impl fmt::Display for WrongTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoHeader { what } => write!(f, "{what} with a header line of column names"),
            Self::NoNames { what, line } => write!(
                f,
                "{what} with a line of column names; it has numbers from line {line} on and no names before them"
            ),
            Self::TwoSigns { line } => write!(
                f,
                "line {line}: a number has a comma and a point, one of which separates thousands: write it without thousands"
            ),
            Self::OtherSign { line, first } if line == first => write!(
                f,
                "line {line}: a number with a decimal point and one with a decimal comma; one of the two may separate thousands"
            ),
            Self::OtherSign { line, first } => write!(
                f,
                "line {line}: another decimal sign than in line {first}; one of the two may separate thousands"
            ),
            Self::SecondSegment { line } => write!(
                f,
                "line {line}: a second segment of a LabVIEW measurement file begins: keep one segment in a file"
            ),
            Self::NoTimes { line } => write!(
                f,
                "line {line}: a LabVIEW measurement file with one column of times (X_Columns One) is read"
            ),
            Self::ControlCharacters(column) => write!(
                f,
                "a CSV file with columns whose names have no control characters; that of column {column} has"
            ),
            Self::SameName([first, second]) => write!(
                f,
                "a CSV file with columns of different names; columns {first} and {second} have the same"
            ),
            Self::Lacks(column) => write!(f, "a CSV file with a column {column}"),
            Self::NoFrequency => f.write_str("a CSV file with a column frequency or frequency_hz"),
            Self::BothFrequencies => f.write_str(
                "a CSV file with either the column frequency, angular, or frequency_hz; this one has both",
            ),
            Self::TooManyCells { line, cells, columns } => write!(
                f,
                "line {line}: {cells} cells for {columns} columns; between commas numbers have a decimal point, not a comma"
            ),
            Self::TooFewCells { line, cells, columns } => write!(
                f,
                "line {line}: {cells} cell{} for {columns} columns",
                if *cells == 1 { "" } else { "s" }
            ),
            Self::Cell { line, column, cell, allowed } => {
                write!(f, "line {line}, {column}: {cell} must be {allowed}")
            }
        }
    }
}

impl<C: fmt::Display> fmt::Display for WrongFile<C> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unread(why) => why.fmt(f),
            Self::Table(why) => why.fmt(f),
            Self::Contents(why) => why.fmt(f),
        }
    }
}

impl std::error::Error for UnreadFile {}

impl std::error::Error for WrongTable {}

impl<C: fmt::Debug + fmt::Display> std::error::Error for WrongFile<C> {}
