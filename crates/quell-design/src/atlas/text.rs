//! The atlas as text: `data/atlas-1.txt.gz`.
//!
//! The first line is the name of the format and its version. Each table is preceded by its axes (`axis NAME LOW HIGH NODES`), named
//! by `table LAW WAVEFORM SURFACE`, and followed by its values, one a line, the last axis fastest. After the tables come their errors:
//! `error LAW WAVEFORM SURFACE LOW HIGH POINTS MEDIAN P90 LARGEST`, where LOW and HIGH are a band of ζ_f/R.

use std::fmt::Write as _;

use quell_model::Waveform;
use quell_numerics::interval::RealInterval;

use super::grid::AtlasAxis;
use super::{Atlas, AtlasErrors, AtlasLaw, AtlasSurface, AtlasTable};

/// The first line.
const HEADING: &str = "quell-atlas 1";

/// What a line of an atlas must be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum AtlasExpected {
    /// The first line.
    Heading,
    /// One of the three kinds of line, or a value.
    KnownLine,
    /// A number of nodes.
    Nodes,
    /// A number of points.
    Points,
    /// A finite number.
    Number,
    /// A law.
    Law,
    /// A waveform.
    Waveform,
    /// A surface.
    Surface,
    /// A table after its axes.
    TableAfterAxes,
    /// A table before its values.
    TableBeforeValues,
    /// Every value of a table before this line.
    Values {
        /// The table: law, waveform and surface.
        table: String,
        /// Number of nodes of its axes.
        wanted: usize,
        /// Number of its values.
        found: usize,
    },
}

impl std::fmt::Display for AtlasExpected {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Heading => HEADING,
            Self::KnownLine => "axis, table or error",
            Self::Nodes => "a number of nodes above 0",
            Self::Points => "a number of points",
            Self::Number => "a finite number",
            Self::Law => "a law of the atlas",
            Self::Waveform => "a waveform of the atlas",
            Self::Surface => "a surface of the atlas",
            Self::TableAfterAxes => "a table after its axes",
            Self::TableBeforeValues => "a table before its values",
            Self::Values { table, wanted, found } => {
                return write!(f, "{wanted} values of {table} before this line, not {found}");
            }
        })
    }
}

/// Why a text is no atlas.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AtlasTextError {
    /// The line, from 1.
    pub line: usize,
    /// What is expected there.
    pub expected: AtlasExpected,
}

impl std::fmt::Display for AtlasTextError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "line {}: expected {}", self.line, self.expected)
    }
}

impl std::error::Error for AtlasTextError {}

impl Atlas {
    /// The text, with nine digits of each value.
    pub fn text(&self) -> String {
        let mut text = format!("{HEADING}\n");
        for table in &self.tables {
            for AtlasAxis { name, range, count } in table.surface.axes(table.law) {
                let _ = writeln!(text, "axis {name} {} {} {count}", range.lower, range.upper);
            }
            let AtlasTable { law, waveform, surface, values } = table;
            let (law, waveform, surface) = (law.name(), waveform.name(), surface.name());
            let _ = writeln!(text, "table {law} {waveform} {surface}");
            for value in values {
                let _ = writeln!(text, "{value:.8e}");
            }
        }
        for AtlasErrors { law, waveform, surface, band, points, quantiles } in &self.errors {
            let (law, waveform, surface) = (law.name(), waveform.name(), surface.name());
            let RealInterval { lower: low, upper: high } = band;
            let [median, high_quantile, largest] = quantiles;
            let _ = writeln!(
                text,
                "error {law} {waveform} {surface} {low} {high} {points} {median:.2e} {high_quantile:.2e} {largest:.2e}"
            );
        }
        text
    }

    /// The atlas of a text.
    ///
    /// # Errors
    /// The first line that is not as [`Atlas::text`] writes it.
    pub fn parse(text: &str) -> Result<Self, AtlasTextError> {
        let mut reader = AtlasReader { atlas: Self::default(), axes: Vec::new() };
        let mut last = 0;
        for (index, line) in text.lines().enumerate() {
            last = index + 1;
            let read = if index == 0 {
                if line == HEADING { Ok(()) } else { Err(AtlasExpected::Heading) }
            } else {
                reader.read(line)
            };
            read.map_err(|expected| AtlasTextError { line: last, expected })?;
        }
        reader.whole().map_err(|expected| AtlasTextError { line: last, expected })?;
        Ok(reader.atlas)
    }
}

/// An atlas while its text is read.
struct AtlasReader {
    atlas: Atlas,
    /// The axes that precede a table.
    axes: Vec<AtlasAxis>,
}

impl AtlasReader {
    fn read(&mut self, line: &str) -> Result<(), AtlasExpected> {
        if !line.starts_with(|first: char| first.is_ascii_lowercase()) {
            return self.value(line);
        }
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["axis", name, low, high, count] => {
                let count = count.parse().ok().filter(|count| *count > 0);
                let count = count.ok_or(AtlasExpected::Nodes)?;
                self.axes.push(AtlasAxis::new(
                    name,
                    RealInterval::new(number(low)?, number(high)?),
                    count,
                ));
                Ok(())
            }
            ["table", law, waveform, surface] => self.table(law, waveform, surface),
            ["error", law, waveform, surface, low, high, points, median, most, largest] => {
                self.whole()?;
                let (law, waveform, surface) = named(law, waveform, surface)?;
                self.atlas.errors.push(AtlasErrors {
                    law,
                    waveform,
                    surface,
                    band: RealInterval::new(number(low)?, number(high)?),
                    points: points.parse().map_err(|_| AtlasExpected::Points)?,
                    quantiles: [number(median)?, number(most)?, number(largest)?],
                });
                Ok(())
            }
            _ => Err(AtlasExpected::KnownLine),
        }
    }

    fn table(&mut self, law: &str, waveform: &str, surface: &str) -> Result<(), AtlasExpected> {
        self.whole()?;
        let (law, waveform, surface) = named(law, waveform, surface)?;
        if self.axes != surface.axes(law) {
            return Err(AtlasExpected::TableAfterAxes);
        }
        self.axes.clear();
        self.atlas.tables.push(AtlasTable { law, waveform, surface, values: Vec::new() });
        Ok(())
    }

    fn value(&mut self, line: &str) -> Result<(), AtlasExpected> {
        let table = self.atlas.tables.last_mut().ok_or(AtlasExpected::TableBeforeValues)?;
        table.values.push(number(line)?);
        Ok(())
    }

    /// Whether the last table has all its values.
    fn whole(&self) -> Result<(), AtlasExpected> {
        let Some(table) = self.atlas.tables.last() else { return Ok(()) };
        let axes = table.surface.axes(table.law);
        let wanted: usize = axes.iter().map(|axis| axis.count).product();
        if table.values.len() == wanted {
            return Ok(());
        }
        let AtlasTable { law, waveform, surface, values } = table;
        let table = format!("{} {} {}", law.name(), waveform.name(), surface.name());
        Err(AtlasExpected::Values { table, wanted, found: values.len() })
    }
}

fn number(text: &str) -> Result<f64, AtlasExpected> {
    let number = text.trim().parse::<f64>().ok().filter(|number| number.is_finite());
    number.ok_or(AtlasExpected::Number)
}

fn named(
    law: &str,
    waveform: &str,
    surface: &str,
) -> Result<(AtlasLaw, Waveform, AtlasSurface), AtlasExpected> {
    Ok((
        AtlasLaw::from_name(law).ok_or(AtlasExpected::Law)?,
        Waveform::from_name(waveform).ok_or(AtlasExpected::Waveform)?,
        AtlasSurface::from_name(surface).ok_or(AtlasExpected::Surface)?,
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_is_read_as_it_was_written() {
        let (law, waveform, surface) =
            (AtlasLaw::Decreasing, Waveform::Triangle, AtlasSurface::Grazing);
        let count = AtlasTable::nodes(law, surface).len();
        let values: Vec<f64> = (0..count).map(|index| 1.0 + index as f64 / 1024.0).collect();
        let table = AtlasTable { law, waveform: waveform.clone(), surface, values };
        let quantiles = [1e-8, 2e-7, 3e-6];
        let errors = AtlasErrors {
            law,
            waveform,
            surface,
            band: RealInterval::new(0.0, 0.02),
            points: 9,
            quantiles,
        };
        let atlas = Atlas { tables: vec![table], errors: vec![errors] };
        let text = atlas.text();
        let read = Atlas::parse(&text).expect("an atlas");
        assert_eq!(read.errors, atlas.errors);
        let pairs = read.tables[0].values.iter().zip(&atlas.tables[0].values);
        // Nine digits.
        assert!(pairs.map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max) < 5e-9);

        // A text that lost a value, its first line, or has something else in it is refused by its line.
        let line = |text: &str| Atlas::parse(text).expect_err("refused").line;
        let lines: Vec<&str> = text.lines().collect();
        let without = |index: usize| [&lines[..index], &lines[index + 1..]].concat().join("\n");
        assert_eq!(line(&without(0)), 1);
        assert_eq!(line(&without(20)), lines.len() - 1);
        assert_eq!(line(&text.replacen("1.00000000e0", "one", 1)), 7);
        assert_eq!(line(&text.replacen("1.00000000e0", "nan", 1)), 7);
    }
}
