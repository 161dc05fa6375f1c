//! Measured time series and spectra.
//!
//! | column | |
//! |---|---|
//! | `time` | ascending |
//! | `displacement`, `velocity` or `acceleration` | or any column that the request names with its quantity |
//! | `frequency` | of a spectrum, in place of a time |
//! | `level_db` or `level`, or `amplitude`, or a quantity as above | of its lines: decibels re 1 unit, or amplitudes (half peak-to-peak) |
//!
//! Units are those of [`crate::columns`], as suffix of the name (`time_ms`), at its end or in a line: such numbers are converted to SI. Lines with a gap are
//! left out. Every invalid cell is reported with its line.

use std::path::{Path, PathBuf};

use quell_model::RecordedQuantity;
use quell_numerics::interval::RealInterval;
use quell_numerics::order::ascending;

use crate::columns::{ColumnChoice, FoundColumn, WantedColumn};
use crate::complaint::{Complaint, Failure};
use crate::data_file::{self, DataFile, complaint, reported};
use crate::dialect::FileDialect;
use crate::input::Inputs;
use crate::nearest;
use crate::wrong_file::WrongTable;

const WHAT: &str = "a file of a measured record";

/// The most samples: a fit holds some tens of numbers for each.
pub const MOST_SAMPLES: usize = 500_000;

/// Least number of samples of a record: of the shortest one with a spectrum.
const LEAST_SAMPLES: usize = 8;

/// A step above this multiple of the median is a gap.
const GAP: f64 = 1.5;

/// Largest distance of a time from the grid of equal steps, in steps: times are printed with few digits.
const UNEVEN: f64 = 0.1;

/// Times.
pub(crate) const TIME: WantedColumn = WantedColumn { names: &["time"], units: &["s"] };
const FREQUENCY: WantedColumn = WantedColumn { names: &["frequency"], units: &["Hz"] };
const LEVEL: WantedColumn = WantedColumn { names: &["level_db", "level"], units: &[] };
const AMPLITUDE: WantedColumn = WantedColumn { names: &["amplitude"], units: &[] };

/// Readings.
const QUANTITIES: [(RecordedQuantity, WantedColumn); 3] = [
    (RecordedQuantity::Displacement, WantedColumn { names: &["displacement"], units: &["m"] }),
    (RecordedQuantity::Velocity, WantedColumn { names: &["velocity"], units: &["m/s"] }),
    (RecordedQuantity::Acceleration, WantedColumn { names: &["acceleration"], units: &["m/s²"] }),
];

/// The quantities of a record or a spectrum.
pub const COLUMNS: [WantedColumn; 7] =
    [TIME, QUANTITIES[0].1, QUANTITIES[1].1, QUANTITIES[2].1, FREQUENCY, LEVEL, AMPLITUDE];

/// How a file is read.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordRequest {
    /// The column, if not the first known one.
    pub column: Option<String>,
    /// What the column shows, if its name does not say it.
    pub quantity: Option<RecordedQuantity>,
    /// Factor of the readings: the calibration.
    pub gain: f64,
    /// The part of the record between two of its times.
    pub window: Option<RealInterval>,
    /// Columns by other names.
    pub columns: ColumnChoice,
}

impl Default for RecordRequest {
    fn default() -> Self {
        Self {
            column: None,
            quantity: None,
            gain: 1.0,
            window: None,
            columns: ColumnChoice::default(),
        }
    }
}

impl RecordRequest {
    /// From the texts of options.
    ///
    /// # Errors
    /// Every invalid option.
    pub fn new(
        column: Option<&str>,
        quantity: Option<&str>,
        gain: Option<&str>,
        window: Option<&str>,
        columns: &[String],
    ) -> Result<Self, Failure> {
        let mut wrong: Vec<Complaint> = Vec::new();
        let mut request = Self { column: column.map(str::to_owned), ..Self::default() };
        if let Some(name) = quantity {
            request.quantity =
                QUANTITIES.iter().map(|(known, _)| *known).find(|known| known.name() == name);
            if request.quantity.is_none() {
                let allowed = "displacement, velocity or acceleration";
                wrong.push(Complaint::option("--quantity", name, allowed));
            }
        }
        if let Some(text) = gain {
            let factor = text.parse::<f64>().ok();
            if let Some(gain) = factor.filter(|gain| gain.is_finite() && *gain != 0.0) {
                request.gain = gain;
            } else {
                let allowed = "a finite number other than 0, which multiplies the readings";
                wrong.push(Complaint::option("--gain", text, allowed));
            }
        }
        if let Some(text) = window {
            let ends = text.split_once(':').and_then(|(from, to)| {
                let number = |text: &str| text.trim().parse::<f64>().ok().filter(|n| n.is_finite());
                Some(RealInterval::new(number(from)?, number(to)?))
                    .filter(|window| window.lower < window.upper)
            });
            request.window = ends;
            if ends.is_none() {
                let allowed = "two times A:B of the record with A < B, such as 0.2:1.5";
                wrong.push(Complaint::option("--window", text, allowed));
            }
        }
        match ColumnChoice::new(columns, &COLUMNS) {
            Ok(columns) => request.columns = columns,
            Err(Failure::Wrong(complaints)) => wrong.extend(complaints),
            Err(why) => return Err(why),
        }
        if wrong.is_empty() { Ok(request) } else { Err(wrong.into()) }
    }
}

/// A measured time series.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeSeries {
    path: PathBuf,
    /// Times, ascending.
    pub times: Vec<f64>,
    /// Readings.
    pub values: Vec<f64>,
    /// Their lines in the file.
    pub lines: Vec<usize>,
    /// What the readings show.
    pub quantity: RecordedQuantity,
    /// Names of the two columns.
    pub columns: [String; 2],
    /// Unit of the times, `s`; `None` without one.
    pub time_unit: Option<&'static str>,
    /// SI unit of the readings; `None` without one.
    pub unit: Option<&'static str>,
    /// How the file was read.
    pub read: FileDialect,
}

/// A measured spectrum.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredSpectrum {
    path: PathBuf,
    /// Frequencies, ascending; in Hz, or angular ones in the unit of the study.
    pub frequencies: Vec<f64>,
    /// Amplitudes.
    pub amplitudes: Vec<f64>,
    /// What the amplitudes are of.
    pub quantity: RecordedQuantity,
    /// Names of the two columns.
    pub columns: [String; 2],
    /// Unit of the frequencies, `Hz`; `None` without one.
    pub frequency_unit: Option<&'static str>,
    /// SI unit of the amplitudes; `None` without one.
    pub unit: Option<&'static str>,
    /// How the file was read.
    pub read: FileDialect,
}

/// A measured time series or spectrum.
#[derive(Clone, Debug, PartialEq)]
pub enum MeasuredFile {
    /// Times and readings.
    Record(TimeSeries),
    /// Frequencies and amplitudes.
    Spectrum(MeasuredSpectrum),
}

impl MeasuredFile {
    /// Reads a file: a spectrum if it has a column of frequencies and none of times.
    ///
    /// # Errors
    /// Complaints about a file that cannot be read, missing columns, and every invalid cell.
    pub fn read(path: &Path, request: &RecordRequest) -> Result<Self, Failure> {
        let text = data_file::measured(path, WHAT).map_err(|why| complaint(path, why))?;
        let file = DataFile::measured(&text, WHAT).map_err(|why| complaint(path, why))?;
        let find = |wanted: WantedColumn| {
            let found = wanted.find(&file, &request.columns);
            found.map_err(|why| Failure::from(complaint(path, why)))
        };
        match (find(TIME)?, find(FREQUENCY)?) {
            (None, Some(frequency)) => {
                read_spectrum(path, &file, frequency, request).map(Self::Spectrum)
            }
            (Some(time), _) => read_record(path, &file, time, request).map(Self::Record),
            (None, None) => {
                let has = file.listed();
                let why = format!(
                    "{WHAT} with a column time or time_s, or one that --columns time=NAME names; it has {has}"
                );
                Err(complaint(path, why).into())
            }
        }
    }

    /// The file.
    pub fn path(&self) -> &Path {
        match self {
            Self::Record(record) => &record.path,
            Self::Spectrum(spectrum) => &spectrum.path,
        }
    }
}

impl MeasuredSpectrum {
    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

impl TimeSeries {
    /// Reads a file of a time series.
    ///
    /// # Errors
    /// As [`MeasuredFile::read`]; a spectrum.
    pub fn read(path: &Path, request: &RecordRequest) -> Result<Self, Failure> {
        match MeasuredFile::read(path, request)? {
            MeasuredFile::Record(record) => Ok(record),
            MeasuredFile::Spectrum(_) => {
                let why = "a time series with a column time or time_s; this file is a spectrum";
                Err(complaint(path, why).into())
            }
        }
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The file as an input that no output may overwrite.
    pub fn inputs(&self) -> Inputs {
        Inputs::of([self.path.as_path()])
    }

    /// Time from the first to the last sample.
    pub fn length(&self) -> f64 {
        self.times[self.times.len() - 1] - self.times[0]
    }

    /// Mean step between samples.
    pub fn step(&self) -> f64 {
        self.length() / (self.times.len() - 1) as f64
    }

    /// Lines after which a gap begins.
    pub fn gaps(&self) -> Vec<usize> {
        let mut steps: Vec<f64> = self.times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let each = steps.clone();
        ascending(&mut steps);
        let median = steps[steps.len() / 2];
        let long = each.iter().zip(&self.lines).filter(|(step, _)| **step > GAP * median);
        long.map(|(_, line)| *line).collect()
    }

    /// The equal step between samples, which a spectrum needs.
    ///
    /// # Errors
    /// A complaint with the first line that is off.
    pub fn even_step(&self) -> Result<f64, Failure> {
        let gaps = self.gaps();
        if let Some(line) = gaps.first() {
            let why = format!(
                "a record without gaps, for its spectrum: it has {} gap{} after line {line}; --window takes a part of the record",
                gaps.len(),
                if gaps.len() == 1 { "" } else { "s, the first" }
            );
            return Err(complaint(&self.path, why).into());
        }
        let step = self.step();
        let off = self.times.iter().enumerate().position(|(k, time)| {
            let even = (k as f64).mul_add(step, self.times[0]);
            (time - even).abs() > UNEVEN * step
        });
        match off {
            None => Ok(step),
            Some(place) => {
                let why = format!(
                    "a record with equal steps between samples, for its spectrum: line {} is off the grid of the step {step}",
                    self.lines[place]
                );
                Err(complaint(&self.path, why).into())
            }
        }
    }
}

fn read_record(
    path: &Path,
    file: &DataFile<'_>,
    time: FoundColumn,
    request: &RecordRequest,
) -> Result<TimeSeries, Failure> {
    let wrong = |why: String| complaint(path, why);
    let (quantity, value) = reading_column(path, file, request)?;
    if file.rows().len() > MOST_SAMPLES {
        let count = file.rows().len();
        let why =
            format!("it has {count} samples, and at most {MOST_SAMPLES} are read: leave some out");
        return Err(wrong(why).into());
    }
    let factor = request.gain * value.factor;
    let mut record = TimeSeries {
        path: path.to_owned(),
        times: Vec::new(),
        values: Vec::new(),
        lines: Vec::new(),
        quantity,
        columns: [time.name, value.name],
        time_unit: time.unit,
        unit: value.unit,
        read: file.dialect().clone(),
    };
    let mut found = Vec::new();
    let mut last: Option<f64> = None;
    for row in file.rows() {
        let own = row.reading(time.at, &record.columns[0], "a finite number", |_| true);
        let reading = row.reading(value.at, &record.columns[1], "a finite number", |_| true);
        if let (Ok(Some(time)), Some(last)) = (&own, last)
            && *time <= last
        {
            found.push(WrongTable::Cell {
                line: row.line(),
                column: record.columns[0].clone(),
                cell: time.to_string(),
                allowed: format!("above the time of the line before, {last}"),
            });
        }
        last = own.as_ref().ok().copied().flatten().or(last);
        match (own, reading) {
            (Ok(Some(own)), Ok(Some(reading))) => {
                let own = time.factor * own;
                let inside = request.window.is_none_or(|window| window.contains(own));
                if inside {
                    record.times.push(own);
                    record.values.push(factor * reading);
                    record.lines.push(row.line());
                }
            }
            (Ok(_), Ok(_)) => record.read.left_out_lines.push(row.line()),
            (own, reading) => found.extend([own.err(), reading.err()].into_iter().flatten()),
        }
    }
    // A line with too many cells is wrong once, not once a column.
    found.dedup();
    reported(path, &found)?;
    if record.times.len() < LEAST_SAMPLES {
        let part = if request.window.is_some() { " in the window" } else { "" };
        let count = record.times.len();
        let why = format!("at least {LEAST_SAMPLES} samples; it has {count}{part}");
        return Err(wrong(why).into());
    }
    Ok(record)
}

fn read_spectrum(
    path: &Path,
    file: &DataFile<'_>,
    frequency: FoundColumn,
    request: &RecordRequest,
) -> Result<MeasuredSpectrum, Failure> {
    let wrong = |why: String| complaint(path, why);
    let find = |wanted: WantedColumn| {
        let named = request.column.is_none();
        let found = if named { wanted.find(file, &request.columns) } else { Ok(None) };
        found.map_err(|why| Failure::from(wrong(why.to_string())))
    };
    let level = find(LEVEL)?;
    let in_decibels = level.is_some();
    let named = match level {
        None => find(AMPLITUDE)?,
        level => level,
    };
    let (quantity, value) = match named {
        Some(value) => (request.quantity.unwrap_or(RecordedQuantity::Displacement), value),
        None => reading_column(path, file, request)?,
    };
    let (at, name) = (frequency.at, frequency.name);
    let in_decibels = in_decibels || LEVEL.names_it(&file.columns()[value.at]);
    let factor = request.gain.abs() * value.factor;
    let mut read = file.dialect().clone();
    let (mut frequencies, mut amplitudes, mut found) = (Vec::new(), Vec::new(), Vec::new());
    for row in file.rows() {
        let above = frequencies.last().copied().unwrap_or(-1.0);
        let allowed = "a finite number ≥ 0 above that of the line before";
        let own = row.reading(at, &name, allowed, |value| {
            let value = frequency.factor * value;
            value >= 0.0 && value > above
        });
        let amplitude = row.reading(value.at, &value.name, "a finite number", |_| true);
        match (own, amplitude) {
            (Ok(Some(own)), Ok(Some(reading))) => {
                let linear = if in_decibels { libm::pow(10.0, reading / 20.0) } else { reading };
                frequencies.push(frequency.factor * own);
                amplitudes.push(factor * linear);
            }
            (Ok(_), Ok(_)) => read.left_out_lines.push(row.line()),
            (own, amplitude) => found.extend([own.err(), amplitude.err()].into_iter().flatten()),
        }
    }
    found.dedup();
    reported(path, &found)?;
    if frequencies.len() < LEAST_SAMPLES {
        let why =
            format!("at least {LEAST_SAMPLES} lines of a spectrum; it has {}", frequencies.len());
        return Err(wrong(why).into());
    }
    Ok(MeasuredSpectrum {
        path: path.to_owned(),
        frequencies,
        amplitudes,
        quantity,
        columns: [name, value.name],
        frequency_unit: frequency.unit,
        unit: value.unit,
        read,
    })
}

/// The column of readings, and what it shows.
fn reading_column(
    path: &Path,
    file: &DataFile<'_>,
    request: &RecordRequest,
) -> Result<(RecordedQuantity, FoundColumn), Failure> {
    let wrong = |why: String| Failure::from(complaint(path, why));
    if let Some(name) = &request.column {
        let Some(at) = file.column(name) else {
            let allowed = format!("a column of the file: {}", file.listed());
            let nearest = nearest::word(name, file.names());
            let complaint = Complaint::option("--column", name.as_str(), allowed);
            return Err(complaint.suggesting(nearest).into());
        };
        let named = QUANTITIES.iter().find(|(_, wanted)| wanted.names_it(&file.columns()[at]));
        let own = named.map(|(quantity, _)| *quantity);
        let Some(quantity) = request.quantity.or(own) else {
            let allowed = "given with --quantity displacement, velocity or acceleration: the name of the column does not say it";
            return Err(Complaint::option("--column", name.as_str(), allowed).into());
        };
        let wanted = QUANTITIES.iter().find(|(known, _)| *known == quantity);
        let (_, wanted) = wanted.ok_or_else(|| wrong(WHAT.to_owned()))?;
        let found = wanted.at(file, at).map_err(|why| wrong(why.to_string()))?;
        return Ok((quantity, found));
    }
    for (quantity, wanted) in &QUANTITIES {
        if request.quantity.is_some_and(|own| own != *quantity) {
            continue;
        }
        let found = wanted.find(file, &request.columns).map_err(|why| wrong(why.to_string()))?;
        if let Some(found) = found {
            return Ok((*quantity, found));
        }
    }
    Err(wrong(format!(
        "{WHAT} with a column displacement, velocity or acceleration, or one that --columns velocity=NAME names; it has {}",
        file.listed()
    )))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(name: &str, text: &str, request: &RecordRequest) -> Result<MeasuredFile, Failure> {
        let folder = std::env::temp_dir().join(format!("quell-record-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let path = folder.join(name);
        std::fs::write(&path, text).expect("written");
        MeasuredFile::read(&path, request)
    }

    fn rows(header: &str, row: impl Fn(u32) -> String) -> String {
        (0..10).fold(format!("{header}\n"), |text, k| text + &row(k) + "\n")
    }

    #[test]
    fn units_in_names_become_si_and_a_gain_multiplies() {
        let text = rows("time_ms,displacement_um", |k| format!("{k},{}", 2 * k));
        let request = RecordRequest { gain: -3.0, ..RecordRequest::default() };
        let Ok(MeasuredFile::Record(record)) = read("a.csv", &text, &request) else {
            panic!("a record");
        };
        assert_eq!((record.time_unit, record.unit), (Some("s"), Some("m")));
        assert!((record.times[3] - 3e-3).abs() < 1e-18);
        assert!((record.values[3] + 18e-6).abs() < 1e-18);
        assert!((record.even_step().expect("even") - 1e-3).abs() < 1e-15);
    }

    #[test]
    fn an_unknown_column_needs_its_quantity() {
        let text = rows("time,ch1", |k| format!("{k},{k}"));
        let named = RecordRequest { column: Some("ch1".to_owned()), ..RecordRequest::default() };
        let said = read("b.csv", &text, &named).expect_err("no quantity").to_string();
        assert!(said.contains("--quantity"), "{said}");
        let request = RecordRequest { quantity: Some(RecordedQuantity::Velocity), ..named };
        assert!(read("b.csv", &text, &request).is_ok());
        let other = RecordRequest { column: Some("ch2".to_owned()), ..request };
        assert!(read("b.csv", &text, &other).expect_err("no column").to_string().contains("ch1"));
    }

    #[test]
    fn times_backwards_gaps_and_invalid_cells_are_named_by_line() {
        let back = rows("time,velocity", |k| format!("{},1", if k == 4 { 2 } else { k }));
        let said =
            read("c.csv", &back, &RecordRequest::default()).expect_err("backwards").to_string();
        assert!(said.contains("line 6") && said.contains("above"), "{said}");
        let invalid = rows("time,velocity", |k| format!("{k},{}", if k == 5 { "x" } else { "1" }));
        let said = read("d.csv", &invalid, &RecordRequest::default())
            .expect_err("not a number")
            .to_string();
        assert!(said.contains("line 7, velocity"), "{said}");
        let gap = rows("time,velocity", |k| format!("{},1", if k > 6 { k + 3 } else { k }));
        let Ok(MeasuredFile::Record(record)) = read("e.csv", &gap, &RecordRequest::default())
        else {
            panic!("a record");
        };
        assert_eq!(record.gaps(), [8]);
        assert!(record.even_step().expect_err("a gap").to_string().contains("line 8"));
        let short = read("f.csv", "time,velocity\n0,1\n1,2\n", &RecordRequest::default());
        assert!(short.expect_err("short").to_string().contains("at least 8 samples; it has 2"));
    }

    #[test]
    fn a_file_with_frequencies_is_a_spectrum_in_decibels() {
        let text = rows("frequency_hz,level", |k| format!("{},{}", 10 * k, 20 * k));
        let Ok(MeasuredFile::Spectrum(spectrum)) = read("g.csv", &text, &RecordRequest::default())
        else {
            panic!("a spectrum");
        };
        assert_eq!(spectrum.frequency_unit, Some("Hz"));
        assert!((spectrum.amplitudes[2] / 100.0 - 1.0).abs() < 1e-14);
    }

    #[test]
    fn columns_have_other_names_and_gaps_are_left_out() {
        let text = rows("t,ch1", |k| {
            format!("{k},{}", if k == 3 { String::new() } else { k.to_string() })
        });
        let columns = ["time=t[ms]".to_owned(), "velocity=ch1[mm/s]".to_owned()];
        let request = RecordRequest::new(None, None, None, None, &columns).expect("valid");
        let Ok(MeasuredFile::Record(record)) = read("h.csv", &text, &request) else {
            panic!("a record")
        };
        assert_eq!((record.time_unit, record.unit), (Some("s"), Some("m/s")));
        assert_eq!((record.times.len(), &record.read.left_out_lines[..]), (9, &[5][..]));
        assert!((record.values[8] - 9e-3).abs() < 1e-17 && (record.times[8] - 9e-3).abs() < 1e-17);
        assert_eq!(record.gaps(), [4]);
        let other = ["slip_velocity=ch1".to_owned()];
        let said =
            RecordRequest::new(None, None, None, None, &other).expect_err("another quantity");
        assert!(said.to_string().contains("one of time, displacement"), "{said}");
        let said =
            read("i.csv", &text, &RecordRequest::default()).expect_err("no time").to_string();
        assert!(said.contains("--columns time=NAME names; it has \"t\", \"ch1\""), "{said}");
        // A unit of another quantity in a line.
        let units = text.replace("t,ch1\n", "time,velocity\nms,rpm\n");
        let said = read("j.csv", &units, &RecordRequest::default()).expect_err("rpm").to_string();
        assert!(
            said.contains("the column velocity is in rpm; velocity is read in units of m/s"),
            "{said}"
        );
    }
}
