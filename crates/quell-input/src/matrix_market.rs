//! The text format Matrix Market: square real matrices, dense (`array`) or sparse (`coordinate`).
//!
//! The first line is `%%MatrixMarket matrix FORMAT FIELD SYMMETRY`; comments begin with `%`; a line has the numbers of rows and
//! columns, and of a sparse matrix that of its entries. Entries count from 1. A dense matrix has its columns one after the
//! other. Of a symmetric matrix only one triangle is written, of a skew-symmetric one without the diagonal; dense ones have the
//! lower triangle. An entry that occurs twice, which the format leaves open, is rejected.
//!
//! Source: R. F. Boisvert, R. Pozo and K. A. Remington, The Matrix Market exchange formats: initial design, NISTIR 5935, 1996
//! (`boisvert1996`).

use std::fmt;
use std::str::SplitWhitespace;

use quell_numerics::matrix::Matrix;

/// The first word of a file.
const BANNER: &str = "%%matrixmarket";

/// What the first line must be.
const HEADER: &str = "a Matrix Market file, whose first line is \"%%MatrixMarket matrix coordinate real general\" or has array, \
                      integer, symmetric or skew-symmetric in these places";

/// What is wrong with a Matrix Market file. Lines, rows and columns count from 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WrongMatrix {
    /// The first line is another, or has another word.
    Header(Option<String>),
    /// The numbers are of another kind.
    Field(String),
    /// No line has the sizes.
    NoSizes,
    /// The sizes are not whole numbers.
    Sizes {
        /// The line.
        line: usize,
        /// Whether the matrix is dense.
        is_dense: bool,
    },
    /// The matrix has another size.
    OtherSize {
        /// The wanted number of rows and columns.
        n: usize,
        /// The line.
        line: usize,
        /// Number of rows.
        rows: usize,
        /// Number of columns.
        columns: usize,
    },
    /// It has more entries than places.
    TooManyEntries {
        /// The largest number.
        most: usize,
        /// The line.
        line: usize,
        /// The number of entries.
        entries: usize,
    },
    /// It has fewer entries than it says.
    TooFewEntries {
        /// The number of entries.
        entries: usize,
        /// The number of lines with them.
        count: usize,
    },
    /// A dense matrix ends before this entry.
    EndsBefore {
        /// The row.
        row: usize,
        /// The column.
        column: usize,
    },
    /// The row or column of an entry is not in the matrix.
    Index {
        /// The line.
        line: usize,
        /// Row or column.
        what: &'static str,
        /// The largest one.
        n: usize,
    },
    /// An entry of a skew-symmetric matrix is on its diagonal.
    OnDiagonal {
        /// The line.
        line: usize,
    },
    /// An entry is repeated.
    Repeated {
        /// The line.
        line: usize,
        /// The row.
        row: usize,
        /// The column.
        column: usize,
    },
    /// An entry is not a finite number.
    NotFinite {
        /// The line.
        line: usize,
    },
    /// Something follows the number of an entry.
    AfterNumber {
        /// The line.
        line: usize,
    },
    /// Something follows the entries.
    AfterEntries {
        /// The line.
        line: usize,
    },
}

impl fmt::Display for WrongMatrix {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Header(None) => f.write_str(HEADER),
            Self::Header(Some(word)) => write!(f, "{HEADER}; it says {word:?}"),
            Self::Field(field) => {
                write!(f, "a matrix of real or integer numbers; line 1 says {field:?}")
            }
            Self::NoSizes => f.write_str("a Matrix Market file with a line of sizes"),
            Self::Sizes { line, is_dense } => {
                let entries = if *is_dense { "" } else { ", and of entries" };
                write!(f, "line {line}: the numbers of rows and columns{entries}")
            }
            Self::OtherSize { n, line, rows, columns } => write!(
                f,
                "a matrix of {n} rows and {n} columns, one for each name; line {line} says {rows} and {columns}"
            ),
            Self::TooManyEntries { most, line, entries } => {
                write!(f, "at most {most} entries; line {line} says {entries}")
            }
            Self::TooFewEntries { entries, count } => {
                write!(f, "{entries} entries; the file has {count}")
            }
            Self::EndsBefore { row, column } => {
                write!(f, "a file that does not end before entry ({row}, {column})")
            }
            Self::Index { line, what, n } => {
                write!(f, "line {line}: the {what} of an entry, a whole number from 1 to {n}")
            }
            Self::OnDiagonal { line } => write!(
                f,
                "line {line}: an entry off the diagonal: a skew-symmetric matrix has zeros on it"
            ),
            Self::Repeated { line, row, column } => {
                write!(f, "line {line}: each entry once; ({row}, {column}) is repeated")
            }
            Self::NotFinite { line } => write!(f, "line {line}: a finite number"),
            Self::AfterNumber { line } => write!(f, "line {line}: nothing after the number"),
            Self::AfterEntries { line } => {
                write!(f, "a file that ends after its entries; line {line} follows")
            }
        }
    }
}

impl std::error::Error for WrongMatrix {}

/// Which entries a file has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum MarketSymmetry {
    General,
    Symmetric,
    Skew,
}

/// MarketLines with their numbers, without comments and empty lines.
struct MarketLines<'t> {
    lines: std::iter::Enumerate<std::str::Lines<'t>>,
}

impl<'t> MarketLines<'t> {
    fn next(&mut self) -> Option<(usize, SplitWhitespace<'t>)> {
        self.lines.by_ref().find_map(|(index, line)| {
            let line = line.trim();
            (!line.is_empty() && !line.starts_with('%'))
                .then(|| (index + 1, line.split_whitespace()))
        })
    }
}

/// Reads a matrix of `n` rows and columns.
///
/// # Errors
/// What the file must be, with the line that is wrong.
pub fn parse(text: &str, n: usize) -> Result<Matrix, WrongMatrix> {
    let text = text.trim_start_matches('\u{feff}');
    let (is_dense, symmetry) = header(text.lines().next().unwrap_or_default())?;
    let mut lines = MarketLines { lines: text.lines().enumerate() };
    let (line, mut words) = lines.next().ok_or(WrongMatrix::NoSizes)?;
    let mut size = || {
        let found = words.next().and_then(|word| word.parse::<usize>().ok());
        found.ok_or(WrongMatrix::Sizes { line, is_dense })
    };
    let (rows, columns) = (size()?, size()?);
    if (rows, columns) != (n, n) {
        return Err(WrongMatrix::OtherSize { n, line, rows, columns });
    }
    if is_dense {
        return dense(&mut lines, n, symmetry);
    }
    let entries = size()?;
    if entries > n * n {
        return Err(WrongMatrix::TooManyEntries { most: n * n, line, entries });
    }
    coordinates(&mut lines, n, symmetry, entries)
}

/// Whether a file is dense, and its symmetry.
fn header(line: &str) -> Result<(bool, MarketSymmetry), WrongMatrix> {
    let words: Vec<String> = line.split_whitespace().map(str::to_lowercase).collect();
    let [banner, object, format, field, symmetry] = words.as_slice() else {
        return Err(WrongMatrix::Header(None));
    };
    if banner != BANNER || object != "matrix" {
        return Err(WrongMatrix::Header(None));
    }
    let is_dense = match format.as_str() {
        "array" => true,
        "coordinate" => false,
        _ => return Err(WrongMatrix::Header(Some(format.clone()))),
    };
    if !["real", "integer", "double"].contains(&field.as_str()) {
        return Err(WrongMatrix::Field(field.clone()));
    }
    let symmetry = match symmetry.as_str() {
        "general" => MarketSymmetry::General,
        "symmetric" => MarketSymmetry::Symmetric,
        "skew-symmetric" => MarketSymmetry::Skew,
        _ => return Err(WrongMatrix::Header(Some(symmetry.clone()))),
    };
    Ok((is_dense, symmetry))
}

/// The columns of a dense matrix one after the other.
fn dense(
    lines: &mut MarketLines<'_>,
    n: usize,
    symmetry: MarketSymmetry,
) -> Result<Matrix, WrongMatrix> {
    let mut matrix = Matrix::zeros(n, n);
    for j in 0..n {
        let first = match symmetry {
            MarketSymmetry::General => 0,
            MarketSymmetry::Symmetric => j,
            MarketSymmetry::Skew => j + 1,
        };
        for i in first..n {
            let (line, mut words) =
                lines.next().ok_or(WrongMatrix::EndsBefore { row: i + 1, column: j + 1 })?;
            let value = number(words.next(), line)?;
            ended(words, line)?;
            set(&mut matrix, (i, j), value, symmetry);
        }
    }
    rest(lines)?;
    Ok(matrix)
}

/// The entries of a sparse matrix.
fn coordinates(
    lines: &mut MarketLines<'_>,
    n: usize,
    symmetry: MarketSymmetry,
    entries: usize,
) -> Result<Matrix, WrongMatrix> {
    let mut matrix = Matrix::zeros(n, n);
    let mut given = vec![false; n * n];
    for count in 0..entries {
        let (line, mut words) =
            lines.next().ok_or(WrongMatrix::TooFewEntries { entries, count })?;
        let mut index = |what: &'static str| {
            let found = words.next().and_then(|word| word.parse::<usize>().ok());
            found
                .filter(|found| (1..=n).contains(found))
                .map(|found| found - 1)
                .ok_or(WrongMatrix::Index { line, what, n })
        };
        let (i, j) = (index("row")?, index("column")?);
        let value = number(words.next(), line)?;
        ended(words, line)?;
        if symmetry == MarketSymmetry::Skew && i == j {
            return Err(WrongMatrix::OnDiagonal { line });
        }
        let mirrored = symmetry != MarketSymmetry::General;
        if given[i * n + j] || mirrored && given[j * n + i] {
            let (row, column) = (i + 1, j + 1);
            return Err(WrongMatrix::Repeated { line, row, column });
        }
        given[i * n + j] = true;
        set(&mut matrix, (i, j), value, symmetry);
    }
    rest(lines)?;
    Ok(matrix)
}

/// Sets an entry and, by symmetry, its mirror image.
fn set(matrix: &mut Matrix, (i, j): (usize, usize), value: f64, symmetry: MarketSymmetry) {
    match symmetry {
        MarketSymmetry::General => {}
        MarketSymmetry::Symmetric => matrix[(j, i)] = value,
        MarketSymmetry::Skew => matrix[(j, i)] = -value,
    }
    matrix[(i, j)] = value;
}

fn number(word: Option<&str>, line: usize) -> Result<f64, WrongMatrix> {
    let value = word.and_then(|word| word.parse::<f64>().ok()).filter(|value| value.is_finite());
    value.ok_or(WrongMatrix::NotFinite { line })
}

fn ended(mut words: SplitWhitespace<'_>, line: usize) -> Result<(), WrongMatrix> {
    match words.next() {
        None => Ok(()),
        Some(_) => Err(WrongMatrix::AfterNumber { line }),
    }
}

fn rest(lines: &mut MarketLines<'_>) -> Result<(), WrongMatrix> {
    match lines.next() {
        None => Ok(()),
        Some((line, _)) => Err(WrongMatrix::AfterEntries { line }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(text: &str, n: usize) -> Vec<f64> {
        parse(text, n).expect(text).as_slice().to_vec()
    }

    #[test]
    fn every_form_gives_its_matrix() {
        let general = [1.0, 2.0, 3.0, 4.0];
        for text in [
            "%%MatrixMarket matrix coordinate real general\n% by hand\n\n2 2 4\n1 1 1\n2 1 3.0\n1 2 2\n2 2 4e0\n",
            "%%matrixmarket MATRIX array integer general\n2 2\n1\n3\n2\n4",
        ] {
            assert_eq!(rows(text, 2), general);
        }
        let symmetric = [2.0, -1.0, 0.0, -1.0, 2.0, 5.0, 0.0, 5.0, 3.0];
        for text in [
            "%%MatrixMarket matrix coordinate real symmetric\n3 3 5\n1 1 2\n2 1 -1\n2 2 2\n3 2 5\n3 3 3\n",
            // The upper triangle says the same.
            "%%MatrixMarket matrix coordinate real symmetric\n3 3 5\n1 1 2\n1 2 -1\n2 2 2\n2 3 5\n3 3 3\n",
            "%%MatrixMarket matrix array real symmetric\n3 3\n2\n-1\n0\n2\n5\n3\n",
        ] {
            assert_eq!(rows(text, 3), symmetric);
        }
        for text in [
            "%%MatrixMarket matrix coordinate real skew-symmetric\n2 2 1\n2 1 7\n",
            "%%MatrixMarket matrix array real skew-symmetric\n2 2\n7\n",
        ] {
            assert_eq!(rows(text, 2), [0.0, -7.0, 7.0, 0.0]);
        }
        assert_eq!(rows("%%MatrixMarket matrix coordinate real general\n2 2 0\n", 2), [0.0; 4]);
    }

    #[test]
    fn wrong_files_are_reported_with_their_line() {
        let head = "%%MatrixMarket matrix coordinate real general\n";
        let symmetric = "%%MatrixMarket matrix coordinate real symmetric\n";
        let skew = "%%MatrixMarket matrix coordinate real skew-symmetric\n";
        let array = "%%MatrixMarket matrix array real general\n";
        for (text, part) in [
            (String::new(), "first line"),
            ("1,1, 1,1, 2.0\n".to_owned(), "first line"),
            (head.replace("matrix c", "vector c"), "first line"),
            (head.replace("coordinate", "sparse"), "\"sparse\""),
            (head.replace("real", "complex"), "\"complex\""),
            (head.replace("real", "pattern"), "\"pattern\""),
            (head.replace("general", "hermitian"), "\"hermitian\""),
            (head.to_owned(), "line of sizes"),
            (format!("{head}2 x 1\n"), "line 2: the numbers of rows and columns, and of entries"),
            (format!("{head}3 2 1\n1 1 1\n"), "line 2 says 3 and 2"),
            (format!("{head}2 2 5\n"), "at most 4 entries"),
            (format!("{head}2 2 18446744073709551615\n"), "at most 4 entries"),
            (format!("{head}2 2 2\n1 1 1\n"), "2 entries; the file has 1"),
            (format!("{head}2 2 1\n1 1 1\n% more\n2 2 1\n"), "line 5 follows"),
            (format!("{head}2 2 1\n3 1 1\n"), "line 3: the row"),
            (format!("{head}2 2 1\n1 0 1\n"), "line 3: the column"),
            (format!("{head}2 2 1\n1 1 nan\n"), "line 3: a finite number"),
            (format!("{head}2 2 1\n1 1\n"), "line 3: a finite number"),
            (format!("{head}2 2 1\n1 1 1 0\n"), "line 3: nothing after"),
            (format!("{head}2 2 2\n1 1 1\n1 1 1\n"), "line 4: each entry once; (1, 1)"),
            (format!("{symmetric}2 2 2\n2 1 1\n1 2 1\n"), "line 4: each entry once; (1, 2)"),
            (format!("{skew}2 2 1\n1 1 0\n"), "line 3: an entry off the diagonal"),
            (format!("{array}2 2\n1\n2\n3\n"), "before entry (2, 2)"),
            (format!("{array}2 2\n1\n2 3\n3\n4\n"), "line 4: nothing after"),
            (format!("{array}2 2\n1\n2\n3\n4\n5\n"), "line 7 follows"),
        ] {
            let wrong = parse(&text, 2).expect_err(&text).to_string();
            assert!(wrong.contains(part), "{text}: {wrong}");
        }
    }
}
