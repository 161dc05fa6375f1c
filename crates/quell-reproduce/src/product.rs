//! The product of an entry: a figure, its caption, and data tables.

use std::fmt::Write as _;

use super::claim::Claim;
use quell::cite::{self, Sources, Task};
use quell::plot::Figure;
use quell::study::{BeltStudy, DiscStudy};

/// A figure or table, ready to be written to files.
#[derive(Clone, Debug, Default)]
pub struct Product {
    /// The figure; a table has none.
    pub figure: Option<Figure>,
    /// Caption with parameters and departures from the dissertation; symbols are between dollar signs.
    pub caption: String,
    /// The data behind the figure.
    pub tables: Vec<DataTable>,
    /// The claims; empty except in the table of claims.
    pub claims: Vec<Claim>,
    /// Study text and changes, for the header of the data.
    pub provenance: Vec<String>,
    /// The equations used, and the corrections to the dissertation.
    pub sources: Sources,
}

impl Product {
    /// A figure of a belt; the caption is also drawn below the figure.
    pub fn new(figure: Figure, caption: impl Into<String>, study: &BeltStudy) -> Self {
        Self {
            sources: cite::sources_of(&study.into()),
            ..Self::with_provenance(caption, study.text(), study.changes())
        }
        .drawn(figure)
    }

    /// A figure of a disc.
    pub(super) fn about(figure: Figure, caption: impl Into<String>, study: &DiscStudy) -> Self {
        Self::disc_table(caption, study).drawn(figure)
    }

    /// A table of a disc without a figure.
    pub(super) fn disc_table(caption: impl Into<String>, study: &DiscStudy) -> Self {
        Self {
            sources: cite::sources_of(&study.into()),
            ..Self::with_provenance(caption, study.text(), study.changes())
        }
    }

    fn drawn(self, figure: Figure) -> Self {
        Self { figure: Some(figure.caption(self.caption.clone())), ..self }
    }

    /// Restricts the sources to those of these computations, instead of all computations that the study allows.
    #[must_use]
    pub fn by(mut self, tasks: &[Task]) -> Self {
        self.sources = self.sources.of_tasks(tasks);
        self
    }

    /// Adds the sources of further studies.
    #[must_use]
    pub fn also<'a>(mut self, studies: impl IntoIterator<Item = &'a BeltStudy>) -> Self {
        for study in studies {
            self.sources.extend(&cite::sources_of(&study.into()));
        }
        self
    }

    /// A product with caption, study text and changes.
    fn with_provenance(caption: impl Into<String>, text: &str, changes: &[String]) -> Self {
        // Keep a symbol, its equals sign and its number on one line.
        let caption = caption.into().replace(" = ", "\u{a0}=\u{a0}");
        let mut provenance: Vec<String> =
            changes.iter().map(|change| format!("changed: {change}")).collect();
        provenance.push("study:".to_owned());
        provenance.extend(text.lines().map(|line| format!("  {line}")));
        Self { caption, provenance, ..Self::default() }
    }

    /// Adds a data table.
    #[must_use]
    pub fn table(mut self, table: DataTable) -> Self {
        self.tables.push(table);
        self
    }

    /// The caption without typesetting marks.
    pub fn plain_caption(&self) -> String {
        self.caption
            .replace("\\bar{μ}", "μ̄")
            .replace(['$', '{', '}', '\\'], "")
            .replace('\u{a0}', " ")
    }

    /// A table as CSV: comment lines (`#`) with caption, units and study, then column names and rows.
    pub fn csv(&self, table: &DataTable) -> String {
        let mut text = String::new();
        let mut lines = vec![format!("quell {} reproduce", env!("CARGO_PKG_VERSION"))];
        lines.extend((!self.caption.is_empty()).then(|| self.plain_caption()));
        let units: Vec<String> = table
            .columns
            .iter()
            .map(|column| format!("{} [{}]", column.name, column.unit))
            .collect();
        lines.push(format!("units: {}", units.join(", ")));
        lines.extend(self.provenance.iter().cloned());
        for line in &lines {
            let _ = writeln!(text, "# {}", line.trim_end());
        }
        let names: Vec<&str> = table.columns.iter().map(|column| column.name.as_str()).collect();
        text += &names.join(",");
        text.push('\n');
        for row in &table.rows {
            let cells: Vec<String> = row.iter().map(Cell::csv).collect();
            text += &cells.join(",");
            text.push('\n');
        }
        text
    }
}

/// Name and unit of a column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DataColumn {
    /// Name.
    pub name: String,
    /// Unit; `1` for a dimensionless number.
    pub unit: &'static str,
}

/// One value of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// A number.
    Number(f64),
    /// A word or sentence.
    Text(String),
    /// No value.
    Empty,
}

impl Cell {
    fn csv(&self) -> String {
        match self {
            // The shortest digits that parse as the same number.
            Self::Number(value) if value.is_finite() => format!("{value:?}"),
            Self::Text(text) if text.contains([',', '"', '\n']) => {
                format!("\"{}\"", text.replace('"', "\"\""))
            }
            Self::Text(text) => text.clone(),
            Self::Number(_) | Self::Empty => String::new(),
        }
    }
}

impl From<f64> for Cell {
    fn from(value: f64) -> Self {
        Self::Number(value)
    }
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<Option<f64>> for Cell {
    fn from(value: Option<f64>) -> Self {
        value.map_or(Self::Empty, Self::Number)
    }
}

/// Rows of cells under named columns.
#[derive(Clone, Debug, PartialEq)]
pub struct DataTable {
    /// Suffix of the file name after the name of the figure; empty for the main table.
    pub part: &'static str,
    /// The columns.
    pub columns: Vec<DataColumn>,
    /// The rows, each with one cell per column.
    pub rows: Vec<Vec<Cell>>,
}

impl DataTable {
    /// An empty table with these (name, unit) columns.
    pub fn new(part: &'static str, columns: &[(&str, &'static str)]) -> Self {
        let columns = columns
            .iter()
            .map(|&(name, unit)| DataColumn { name: name.to_owned(), unit })
            .collect();
        Self { part, columns, rows: Vec::new() }
    }

    /// Adds a row.
    pub fn row(&mut self, cells: impl IntoIterator<Item = Cell>) {
        self.rows.push(cells.into_iter().collect());
    }

    /// A table of whole columns of equal length.
    pub fn of_columns(part: &'static str, columns: Vec<(String, &'static str, Vec<f64>)>) -> Self {
        let length = columns.iter().map(|(_, _, values)| values.len()).max().unwrap_or(0);
        let rows = (0..length)
            .map(|row| {
                columns.iter().map(|(_, _, values)| values.get(row).copied().into()).collect()
            })
            .collect();
        let columns =
            columns.into_iter().map(|(name, unit, _)| DataColumn { name, unit }).collect();
        Self { part, columns, rows }
    }
}
