//! Lines of a table: numbers in columns, gaps, wrong cells by line.

use crate::wrong_file::WrongTable;

/// Maximum number of characters of a cell that are shown.
const SHOWN: usize = 24;

/// Words for a reading that is missing.
const GAPS: [&str; 5] = ["nan", "na", "n/a", "null", "-nan"];

/// Whether a cell says that a reading is missing.
pub(crate) fn is_gap(cell: &str) -> bool {
    cell.is_empty() || GAPS.iter().any(|word| cell.eq_ignore_ascii_case(word))
}

/// The number of a cell.
fn number(cell: &str, decimal: char) -> Option<f64> {
    if decimal == ',' { cell.replace(',', ".").parse().ok() } else { cell.parse().ok() }
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

/// A line of numbers.
#[derive(Debug)]
pub struct Row<'t> {
    /// Number of the line, from 1; of a MATLAB file that of the element.
    line: usize,
    cells: Vec<&'t str>,
    /// Number of columns of the file.
    columns: usize,
    /// Decimal sign.
    decimal: char,
}

impl<'t> Row<'t> {
    /// A line with its cells.
    pub(crate) fn new(line: usize, cells: Vec<&'t str>, columns: usize, decimal: char) -> Self {
        Self { line, cells, columns, decimal }
    }

    /// The finite number in a column of a measured file, if it is `right`; `None` for a gap.
    ///
    /// # Errors
    /// As [`Self::number`]; a line that is too short.
    pub fn reading(
        &self,
        at: usize,
        name: &str,
        allowed: &str,
        right: impl Fn(f64) -> bool,
    ) -> Result<Option<f64>, WrongTable> {
        within(&self.cells, self.columns, self.line)?;
        match self.cells.get(at) {
            None => {
                let (line, cells, columns) = (self.line, self.cells.len(), self.columns);
                Err(WrongTable::TooFewCells { line, cells, columns })
            }
            Some(cell) if is_gap(cell) => Ok(None),
            Some(_) => {
                let right = |value: f64| value.is_finite() && right(value);
                self.number(at, name, allowed, right).map(Some)
            }
        }
    }

    /// The text in a column; empty if the line is too short.
    pub fn text(&self, at: usize) -> &str {
        self.cells.get(at).copied().unwrap_or_default()
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
        number(cell, self.decimal).filter(|&value| right(value)).ok_or_else(|| {
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
            .and_then(|cell| number(cell, self.decimal))
            .is_some_and(|number| number < 0.0)
    }
}
