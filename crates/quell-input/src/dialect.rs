//! How the text of a table is written: separators, decimal sign, comments, header lines, names and units.
//!
//! | in the text | how it is read |
//! |---|---|
//! | separators | `;`, tab, `,` or runs of spaces: the one by which most lines are numbers |
//! | decimal sign | a point or a comma, the same in every number of the file |
//! | comments | lines that begin with `#` or `%` |
//! | names | the last line before the numbers that has no number, or the first line of a file whose header may not be skipped |
//! | units | a line of units between names and numbers, or at the end of a name: `F [N]`, `Speed (rpm)`, `F / N` |
//! | header of a recorder | what is before the names |
//!
//! A LabVIEW measurement file says its separator, its decimal sign and its units in its own header.

use quell_model::units::measure;

use crate::row::{self, Row, is_gap};
use crate::wrong_file::WrongTable;

/// Separators in the order of preference, where two would do equally well.
const SEPARATORS: [char; 4] = [';', '\t', ',', ' '];

/// What begins a comment.
const COMMENTS: [char; 2] = ['#', '%'];

/// The first line of a LabVIEW measurement file.
const LABVIEW: &str = "LabVIEW Measurement";

/// The last line of each header of a LabVIEW measurement file.
const END_OF_HEADER: &str = "***End_of_Header***";

/// How a file was read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileDialect {
    /// The format: `text`, `LabVIEW` or `MATLAB`.
    pub format: &'static str,
    /// What stands between columns; a space for runs of spaces; `None` for a file that is not text.
    pub separator: Option<char>,
    /// The decimal sign; `None` for a file that is not text.
    pub decimal: Option<char>,
    /// The unit of each column; empty if the file gives none.
    pub units: Vec<Option<String>>,
    /// Number of comment lines.
    pub comment_lines: usize,
    /// Number of lines before the names of the columns.
    pub header_lines: usize,
    /// Lines with a gap, which were left out.
    pub left_out_lines: Vec<usize>,
}

/// A column of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column<'t> {
    /// Its name as the file has it.
    pub name: &'t str,
    /// Its name without a unit.
    pub base: &'t str,
    /// Its unit.
    pub unit: Option<String>,
}

impl<'t> Column<'t> {
    /// A column by its name alone.
    pub fn plain(name: &'t str) -> Self {
        Self { name, base: name, unit: None }
    }

    /// Splits a name with a unit at its end: `F [N]`, `Speed (rpm)`, `F / N`.
    fn of(name: &'t str) -> Self {
        let bracketed = |open: char, close: char| {
            let (base, unit) = name.strip_suffix(close)?.rsplit_once(open)?;
            Some((base.trim(), unit.trim()))
        };
        let split =
            bracketed('[', ']').or_else(|| bracketed('(', ')')).or_else(|| name.split_once(" / "));
        match split.filter(|(base, unit)| !base.is_empty() && is_unit(unit)) {
            Some((base, unit)) => Self { name, base, unit: Some(bare_unit(unit).to_owned()) },
            None => Self::plain(name),
        }
    }
}

/// A unit without brackets; a dash is that of a pure number.
fn bare_unit(text: &str) -> &str {
    let inner = text.strip_prefix('[').and_then(|text| text.strip_suffix(']'));
    let inner = inner.or_else(|| text.strip_prefix('(').and_then(|text| text.strip_suffix(')')));
    match inner.unwrap_or(text).trim() {
        "-" => "1",
        unit => unit,
    }
}

fn is_unit(text: &str) -> bool {
    measure::is_unit(bare_unit(text))
}

/// The way in which a cell is a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum NumberShape {
    Whole,
    /// It has a decimal sign.
    With(char),
    /// It has a point and a comma.
    Both,
}

/// How a cell is a number; `None` if it is none.
fn shape(cell: &str) -> Option<NumberShape> {
    let unsigned = cell.strip_prefix(['+', '-']).unwrap_or(cell);
    let (mantissa, exponent) = unsigned.split_once(['e', 'E']).unwrap_or((unsigned, "0"));
    let exponent = exponent.strip_prefix(['+', '-']).unwrap_or(exponent);
    let digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
    let mantissa_is_one = mantissa.bytes().any(|byte| byte.is_ascii_digit())
        && mantissa.bytes().all(|byte| byte.is_ascii_digit() || matches!(byte, b'.' | b','));
    if !mantissa_is_one || exponent.is_empty() || !digits(exponent) {
        return None;
    }
    let count = |sign: char| mantissa.matches(sign).count();
    match (count('.'), count(',')) {
        (0, 0) => Some(NumberShape::Whole),
        (1, 0) => Some(NumberShape::With('.')),
        (0, 1) => Some(NumberShape::With(',')),
        (0, _) | (_, 0) => None,
        _ => Some(NumberShape::Both),
    }
}

/// The cells of a line. In quotes a separator is part of a cell. Commas that a spreadsheet adds at the end of a line with another separator are
/// left out.
pub fn cells(line: &str, separator: char) -> Vec<&str> {
    if separator == ' ' {
        return line.split_whitespace().map(unquoted).collect();
    }
    let line = if separator == ',' { line } else { line.trim_end_matches(',') };
    let mut quoted = false;
    let split = line.split(|c: char| {
        quoted ^= c == '"';
        c == separator && !quoted
    });
    split.map(unquoted).collect()
}

fn unquoted(cell: &str) -> &str {
    cell.trim().trim_matches('"').trim()
}

/// A line with its number, from 1.
type Numbered<'t> = (usize, &'t str);

/// What the cells of a line are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct CellCounts {
    cells: usize,
    numbers: usize,
    gaps: usize,
}

impl CellCounts {
    fn of(cells: &[&str]) -> Self {
        let numbers = cells.iter().filter(|cell| shape(cell).is_some()).count();
        let gaps = cells.iter().filter(|cell| is_gap(cell)).count();
        Self { cells: cells.len(), numbers, gaps }
    }

    /// Whether every cell is a number or a gap.
    fn is_row(self) -> bool {
        self.numbers > 0 && self.numbers + self.gaps == self.cells
    }
}

/// The separator by which most lines are numbers throughout, or, if none has such lines, in part.
fn separator_of(lines: &[Numbered<'_>]) -> char {
    let counts = |separator: char| {
        let of_line = move |(_, line): &Numbered<'_>| CellCounts::of(&cells(line, separator));
        lines.iter().map(of_line).filter(move |own| own.cells > 1 || separator == ',')
    };
    let most = |score: &dyn Fn(char) -> usize| {
        let best =
            SEPARATORS.iter().map(|separator| score(*separator)).max().filter(|best| *best > 0)?;
        SEPARATORS.iter().copied().find(|separator| score(*separator) == best)
    };
    let whole = |separator| counts(separator).filter(|own| own.is_row()).count();
    let part = |separator| counts(separator).filter(|own| own.cells > 1 && own.numbers > 0).count();
    let written =
        |separator: &char| lines.first().is_some_and(|(_, line)| line.contains(*separator));
    let first = || SEPARATORS[..3].iter().copied().find(written);
    most(&whole).or_else(|| most(&part)).or_else(first).unwrap_or(',')
}

/// Where names, units and numbers are.
struct TablePlaces<'t> {
    names: Vec<&'t str>,
    units: Vec<&'t str>,
    /// Place of the first line of numbers.
    rows: usize,
    header_lines: usize,
}

/// Whether a line has units and nothing else, and a name above each.
fn has_units(line: &[&str], above: &[&str]) -> bool {
    let given = || line.iter().filter(|cell| !cell.is_empty());
    given().all(|cell| is_unit(cell))
        && given().any(|cell| shape(cell).is_none())
        && line.len() == above.len()
        && CellCounts::of(above).numbers == 0
        && line.iter().zip(above).filter(|(unit, _)| !unit.is_empty()).count() > 0
}

/// Finds names and units above the first line of numbers.
fn places<'t>(
    lines: &[Numbered<'t>],
    comments: &[Numbered<'t>],
    separator: char,
) -> TablePlaces<'t> {
    let cells_at = |place: usize| cells(lines[place].1, separator);
    let first = (0..lines.len()).find(|place| {
        let own = cells_at(*place);
        let above = place.checked_sub(1).map(cells_at).unwrap_or_default();
        CellCounts::of(&own).is_row() && !has_units(&own, &above)
    });
    // Without a line of numbers the first line has the names.
    let Some(first) = first else {
        let names = if lines.is_empty() { Vec::new() } else { cells_at(0) };
        return TablePlaces { names, units: Vec::new(), rows: lines.len().min(1), header_lines: 0 };
    };
    let columns = cells_at(first).len();
    // Lines of the same length with some numbers are rows with wrong cells.
    let mut begin = first;
    while begin > 0 {
        let counts = CellCounts::of(&cells_at(begin - 1));
        let above = begin.checked_sub(2).map(cells_at).unwrap_or_default();
        let is_wrong_row = counts.numbers > 0
            && counts.cells == columns
            && !has_units(&cells_at(begin - 1), &above);
        if !is_wrong_row {
            break;
        }
        begin -= 1;
    }
    let Some(last) = begin.checked_sub(1) else {
        return nameless(lines, comments, (begin, columns), separator);
    };
    let own = cells_at(last);
    if last > 0 && has_units(&own, &cells_at(last - 1)) {
        let names = cells_at(last - 1);
        return TablePlaces { names, units: own, rows: begin, header_lines: last - 1 };
    }
    if CellCounts::of(&own).numbers > 0 {
        return nameless(lines, comments, (begin, columns), separator);
    }
    TablePlaces { names: own, units: Vec::new(), rows: begin, header_lines: last }
}

/// Columns without a line of names: the comment above the numbers names them, if it has a word for each.
fn nameless<'t>(
    lines: &[Numbered<'t>],
    comments: &[Numbered<'t>],
    (begin, columns): (usize, usize),
    separator: char,
) -> TablePlaces<'t> {
    let number = lines[begin].0;
    let above = comments.iter().rev().find(|(line, _)| *line < number);
    let named = above.map(|(_, text)| cells(text.trim_start_matches(COMMENTS).trim(), separator));
    let fits = |names: &Vec<&str>| names.len() == columns && CellCounts::of(names).numbers == 0;
    let names = named.filter(fits).unwrap_or_default();
    TablePlaces { names, units: Vec::new(), rows: begin, header_lines: begin }
}

/// A table as it was found in a text.
#[derive(Debug)]
pub(crate) struct FoundTable<'t> {
    pub(crate) columns: Vec<Column<'t>>,
    pub(crate) rows: Vec<Row<'t>>,
    pub(crate) dialect: FileDialect,
}

/// Whether lines before the names may be skipped and units are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Header {
    /// The first line has the names.
    Names,
    /// A recorder wrote the file.
    Recorder,
}

/// Finds the table of a text.
///
/// # Errors
/// No line names the columns; the decimal sign changes.
pub(crate) fn find<'t>(
    text: &'t str,
    what: &'static str,
    header: Header,
) -> Result<FoundTable<'t>, WrongTable> {
    if header == Header::Recorder && text.trim_start().starts_with(LABVIEW) {
        return labview(text, what);
    }
    let numbered =
        text.split('\n').enumerate().map(|(index, line)| (index + 1, line.trim_end_matches('\r')));
    let (comments, lines): (Vec<Numbered<'t>>, Vec<Numbered<'t>>) = numbered
        .filter(|(_, line)| !line.trim().is_empty())
        .partition(|(_, line)| line.trim_start().starts_with(COMMENTS) && !is_percent_units(line));
    let separator = separator_of(&lines);
    let found = match header {
        Header::Recorder => places(&lines, &comments, separator),
        Header::Names => {
            let names = lines.first().map(|(_, line)| cells(line, separator)).unwrap_or_default();
            TablePlaces { names, units: Vec::new(), rows: lines.len().min(1), header_lines: 0 }
        }
    };
    if lines.is_empty() {
        return Err(WrongTable::NoHeader { what });
    }
    let mut columns: Vec<Column<'t>> = match header {
        Header::Names => found.names.iter().map(|name| Column::plain(name)).collect(),
        Header::Recorder => found.names.iter().map(|name| Column::of(name)).collect(),
    };
    if columns.is_empty() {
        return Err(WrongTable::NoNames { what, line: lines[found.rows].0 });
    }
    for (column, unit) in columns.iter_mut().zip(&found.units) {
        if !unit.is_empty() {
            column.unit = Some(bare_unit(unit).to_owned());
        }
    }
    let (rows, decimal) = rows_of(&lines[found.rows..], separator, columns.len())?;
    let dialect = FileDialect {
        format: "text",
        separator: Some(separator),
        decimal: Some(decimal),
        units: units_of(&columns),
        comment_lines: comments.len(),
        header_lines: found.header_lines,
        left_out_lines: Vec::new(),
    };
    Ok(FoundTable { columns, rows, dialect })
}

/// Whether a line that begins with a per cent sign has units: `%;rpm`.
fn is_percent_units(line: &str) -> bool {
    let rest = line.trim_start().strip_prefix('%');
    rest.is_some_and(|rest| {
        SEPARATORS[..3].iter().any(|separator| {
            rest.starts_with(*separator)
                && cells(rest, *separator)[1..].iter().all(|cell| is_unit(cell))
        })
    })
}

fn units_of(columns: &[Column<'_>]) -> Vec<Option<String>> {
    if columns.iter().all(|column| column.unit.is_none()) {
        return Vec::new();
    }
    columns.iter().map(|column| column.unit.clone()).collect()
}

/// The lines of numbers with the decimal sign of the file.
fn rows_of<'t>(
    lines: &[Numbered<'t>],
    separator: char,
    columns: usize,
) -> Result<(Vec<Row<'t>>, char), WrongTable> {
    let mut sign: Option<(char, usize)> = None;
    let split: Vec<(usize, Vec<&str>)> =
        lines.iter().map(|(line, text)| (*line, cells(text, separator))).collect();
    for (line, cells) in &split {
        for cell in cells {
            match (shape(cell), sign) {
                (Some(NumberShape::Both), _) => return Err(WrongTable::TwoSigns { line: *line }),
                (Some(NumberShape::With(own)), Some((known, first))) if own != known => {
                    return Err(WrongTable::OtherSign { line: *line, first });
                }
                (Some(NumberShape::With(own)), None) => sign = Some((own, *line)),
                _ => {}
            }
        }
    }
    let decimal = sign.map_or('.', |(sign, _)| sign);
    let row = |(line, cells)| Row::new(line, cells, columns, decimal);
    Ok((split.into_iter().map(row).collect(), decimal))
}

/// A LabVIEW measurement file of one segment.
fn labview<'t>(text: &'t str, what: &'static str) -> Result<FoundTable<'t>, WrongTable> {
    let lines: Vec<Numbered<'t>> = text
        .split('\n')
        .enumerate()
        .map(|(index, line)| (index + 1, line.trim_end_matches('\r')))
        .filter(|(_, line)| !line.trim().is_empty())
        .collect();
    let ends: Vec<usize> =
        (0..lines.len()).filter(|place| lines[*place].1.starts_with(END_OF_HEADER)).collect();
    if let Some(third) = ends.get(2) {
        return Err(WrongTable::SecondSegment { line: lines[*third].0 });
    }
    let last = *ends.last().ok_or(WrongTable::NoHeader { what })?;
    let Some((_, names)) = lines.get(last + 1) else { return Err(WrongTable::NoHeader { what }) };
    let key = |name: &str| {
        let mut of = lines[..last].iter().map(|(_, line)| *line);
        of.find_map(|line| line.strip_prefix(name)?.strip_prefix(['\t', ',']))
    };
    let separator =
        if key("Separator").is_some_and(|own| own.starts_with("Comma")) { ',' } else { '\t' };
    if key("X_Columns").is_some_and(|own| !own.starts_with("One")) {
        let line = lines.iter().find(|(_, line)| line.starts_with("X_Columns"));
        return Err(WrongTable::NoTimes { line: line.map_or(1, |(line, _)| *line) });
    }
    let mut columns: Vec<Column<'t>> =
        cells(names, separator).into_iter().map(Column::plain).collect();
    let units = key("Y_Unit_Label").map(|units| cells(units, separator)).unwrap_or_default();
    for (column, unit) in columns.iter_mut().skip(1).zip(units) {
        if !unit.is_empty() {
            column.unit = Some(unit.to_owned());
        }
    }
    // LabVIEW writes times in seconds.
    if key("X_Dimension").is_some_and(|own| own.starts_with("Time"))
        && let Some(first) = columns.first_mut()
    {
        first.base = "time";
        first.unit = Some("s".to_owned());
    }
    let (rows, decimal) = rows_of(&lines[last + 2..], separator, columns.len())?;
    let dialect = FileDialect {
        format: "LabVIEW",
        separator: Some(separator),
        decimal: Some(decimal),
        units: units_of(&columns),
        comment_lines: 0,
        header_lines: lines[last + 1].0 - 1,
        left_out_lines: Vec::new(),
    };
    Ok(FoundTable { columns, rows, dialect })
}

/// A table that was made from the variables of a MATLAB file: names in the first line, a row for each element.
pub(crate) fn of_variables<'t>(
    text: &'t str,
    what: &'static str,
) -> Result<FoundTable<'t>, WrongTable> {
    let mut lines = text.lines();
    let names = lines.next().ok_or(WrongTable::NoHeader { what })?;
    let columns: Vec<Column<'t>> = names.split(',').map(Column::plain).collect();
    let rows = lines
        .enumerate()
        .map(|(index, line)| Row::new(index + 1, line.split(',').collect(), columns.len(), '.'));
    let dialect = FileDialect {
        format: "MATLAB",
        separator: None,
        decimal: None,
        units: Vec::new(),
        comment_lines: 0,
        header_lines: 0,
        left_out_lines: Vec::new(),
    };
    Ok(FoundTable { rows: rows.collect(), columns, dialect })
}

/// Checks names as [`row::distinct`] does.
pub(crate) fn distinct(columns: &[Column<'_>]) -> Result<(), WrongTable> {
    let names: Vec<&str> = columns.iter().map(|column| column.name).collect();
    row::distinct(&names)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Names, units, numbers of the rows and the dialect.
    type Read = (Vec<String>, Vec<(usize, Vec<Option<f64>>)>, FileDialect);

    fn read(text: &str) -> Result<Read, String> {
        let found = find(text, "a table", Header::Recorder).map_err(|why| why.to_string())?;
        let names = found.columns.iter().map(|column| column.base.to_owned()).collect();
        let count = found.columns.len();
        let row = |row: &Row<'_>| -> Result<(usize, Vec<Option<f64>>), WrongTable> {
            let numbers = (0..count).map(|at| row.reading(at, "column", "a number", |_| true));
            Ok((row.line(), numbers.collect::<Result<_, _>>()?))
        };
        let rows: Result<Vec<_>, _> = found.rows.iter().map(row).collect();
        Ok((names, rows.map_err(|why| why.to_string())?, found.dialect))
    }

    /// Every way to write one table.
    #[test]
    fn one_table_is_read_however_it_is_written() {
        for (text, separator, decimal) in [
            ("v,mu\n0.5,0.25\n-1.5,3e-1\n", ',', '.'),
            ("v;mu\n0,5;0,25\n-1,5;3e-1\n", ';', ','),
            ("v;mu\n0.5;0.25\n-1.5;0.3\n", ';', '.'),
            ("v\tmu\r\n0.5\t0.25\r\n-1.5\t0.3\r\n", '\t', '.'),
            ("v\tmu\n0,5\t0,25\n-1,5\t0,3\n", '\t', ','),
            ("  v     mu\n 0.5   0.25\n-1.5   3.0E-01\n", ' ', '.'),
            ("v mu\n0,5 0,25\n-1,5 0,3\n", ' ', ','),
            ("v, mu\n0.5, 0.25\n-1.5, 0.3", ',', '.'),
            ("\"v\",\"mu\"\n\"0,5\",\"0,25\"\n\"-1,5\",\"0,3\"\n", ',', ','),
        ] {
            let (names, rows, dialect) = read(text).expect(text);
            assert_eq!(names, ["v", "mu"], "{text:?}");
            let numbers: Vec<_> = rows.iter().map(|(_, numbers)| numbers.clone()).collect();
            assert_eq!(numbers, [[Some(0.5), Some(0.25)], [Some(-1.5), Some(0.3)]], "{text:?}");
            assert_eq!(
                (dialect.separator, dialect.decimal),
                (Some(separator), Some(decimal)),
                "{text:?}"
            );
            assert_eq!(
                (rows[0].0, dialect.header_lines, dialect.units.len()),
                (2, 0, 0),
                "{text:?}"
            );
        }
    }

    #[test]
    fn headers_comments_units_and_gaps_are_found() {
        let recorder = "Date:;2020-07-08\r\nMax. samples:;500\r\nScale:;0;True;1.000\r\nTrigger:;\"a;b\"\r\n\
                        ;Velocity actual value averaged;Torque actual value averaged\r\nms;rpm;%\r\n\
                        0.000;-10;-32.0\r\n51.200;;-32.6\r\n";
        let (names, rows, dialect) = read(recorder).expect("a recorder");
        assert_eq!(names, ["", "Velocity actual value averaged", "Torque actual value averaged"]);
        assert_eq!(rows[0], (7, vec![Some(0.0), Some(-10.0), Some(-32.0)]));
        assert_eq!(rows[1], (8, vec![Some(51.2), None, Some(-32.6)]));
        assert_eq!(dialect.header_lines, 4);
        assert_eq!(
            dialect.units,
            [Some("ms".to_owned()), Some("rpm".to_owned()), Some("%".to_owned())]
        );

        let (names, rows, dialect) =
            read("# rig\n% 2026\nslip_velocity,coefficient\nmm/s,1\n10,nan\n20,NA\n# end\n")
                .expect("units");
        assert_eq!((dialect.comment_lines, dialect.header_lines), (3, 0));
        assert_eq!(dialect.units, [Some("mm/s".to_owned()), Some("1".to_owned())]);
        assert_eq!((names.len(), rows[1].clone()), (2, (6, vec![Some(20.0), None])));

        // Names that are units too, and units at the end of names.
        let (names, _, dialect) = read("V;F;N\n0,1;2;20\n").expect("names");
        assert_eq!(
            (names, dialect.units.len()),
            (vec!["V".to_owned(), "F".to_owned(), "N".to_owned()], 0)
        );
        let (names, _, dialect) =
            read("Speed (rpm),F [N],v / mm/s,mu (filtered)\n1,2,3,4\n").expect("units");
        assert_eq!(names, ["Speed", "F", "v", "mu (filtered)"]);
        let units: Vec<Option<&str>> = dialect.units.iter().map(Option::as_deref).collect();
        assert_eq!(units, [Some("rpm"), Some("N"), Some("mm/s"), None]);
        // A comment of names above the numbers, as np.savetxt writes them, and per cent as first unit.
        assert_eq!(read("# time velocity\n0 1\n1 2\n").expect("names").0, ["time", "velocity"]);
        let (_, rows, dialect) = read("share;speed\n%;rpm\n10;20\n").expect("per cent");
        assert_eq!((dialect.units.len(), dialect.comment_lines, rows.len()), (2, 0, 1));
        // A wrong cell in the first line of numbers makes it no header, and a column of words none either.
        let wrong = read("v,mu\nx,0.4\n0.1,0.5\n").expect_err("a wrong cell");
        assert!(wrong.contains("line 2, column: \"x\""), "{wrong}");
        assert_eq!(
            find("note,v\na,1\nb,2\n", "a table", Header::Recorder).expect("words").rows.len(),
            2
        );
    }

    #[test]
    fn labview_says_its_own_units_and_time() {
        let labview = "LabVIEW Measurement\t\r\nSeparator\tTab\r\nDecimal_Separator\t.\r\nX_Columns\tOne\r\n\
                       ***End_of_Header***\t\r\n\t\r\nChannels\t2\t\t\r\nY_Unit_Label\tVolts\tg\t\r\n\
                       X_Dimension\tTime\tTime\t\r\nDelta_X\t1.0E-5\t1.0E-5\t\r\n***End_of_Header***\t\t\t\r\n\
                       X_Value\t  Voltage\tAcceleration\r\n0.000\t-0.5\t0.25\r\n0.002\t0.5\t-0.25\r\n";
        let (names, rows, dialect) = read(labview).expect("a file");
        assert_eq!(names, ["time", "Voltage", "Acceleration"]);
        assert_eq!(rows[1], (14, vec![Some(0.002), Some(0.5), Some(-0.25)]));
        let units: Vec<Option<&str>> = dialect.units.iter().map(Option::as_deref).collect();
        assert_eq!(units, [Some("s"), Some("Volts"), Some("g")]);
        assert_eq!((dialect.format, dialect.header_lines), ("LabVIEW", 11));
        let none = labview.replace("X_Columns\tOne", "X_Columns\tNo");
        assert!(read(&none).expect_err("no times").contains("line 4"), "no times");
        let second = format!("{labview}***End_of_Header***\r\n");
        assert!(
            read(&second).expect_err("two segments").contains("line 15: a second segment"),
            "two segments"
        );
        assert!(read("LabVIEW Measurement\nSeparator\tTab\n").is_err());
    }

    #[test]
    fn what_may_mean_two_things_is_refused_by_line() {
        for (text, words) in [
            ("v,mu\n0,01,0,39\n0,02,0,38\n", "line 2: 4 cells for 2 columns"),
            ("v;mu\n0,01;0,39\n0.2;0.31\n", "line 3: another decimal sign than in line 2"),
            (
                "v;mu\n1.234;0,31\n2.345;0,30\n",
                "line 2: a number with a decimal point and one with a decimal comma",
            ),
            ("v;mu\n1.234,5;0,31\n", "line 2: a number has a comma and a point"),
            ("v;mu\n0,01;0,39\n0,02\n", "line 3: 1 cell for 2 columns"),
            ("0.1,0.2\n0.3,0.4\n", "numbers from line 1 on and no names"),
            ("", "a header line"),
            ("# only comments\n", "a header line"),
        ] {
            let said = read(text).expect_err(text);
            assert!(said.contains(words), "{text:?}: {said}");
        }
        // A file that a study names begins with its names.
        let found = find("v;mu\n0,5;0,25\n", "a table", Header::Names).expect("a table");
        assert_eq!(found.rows[0].number(1, "mu", "", |_| true), Ok(0.25));
        assert!(
            find("rig;1\nv;mu\n1;2\n", "a table", Header::Names).expect("a table").columns[0].name
                == "rig"
        );
    }
}
