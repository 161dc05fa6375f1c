//! Measured time series and spectra in CSV files.
//!
//! | column | |
//! |---|---|
//! | `time`, `time_s`, `time_ms`, `time_us` | ascending; without a suffix in the unit of the study |
//! | `displacement`, `displacement_m`, `…_mm`, `…_um` | or |
//! | `velocity`, `velocity_m_per_s`, `velocity_mm_per_s` | or |
//! | `acceleration`, `acceleration_m_per_s2`, `acceleration_g` | or any column that the request names with its quantity |
//! | `frequency_hz` or `frequency` | of a spectrum, in place of a time |
//! | `level_db` or `level`, or `amplitude`, or a quantity as above | of its lines: decibels re 1 unit, or amplitudes (half peak-to-peak) |
//!
//! Numbers with a suffix are converted to SI. Every invalid cell is reported with its line.

use std::path::{Path, PathBuf};

use quell_model::RecordedQuantity;
use quell_numerics::order::ascending;

use crate::complaint::{Complaint, Failure};
use crate::data_file::{self, DataFile, complaint, reported};
use crate::input::Inputs;
use crate::nearest;
use crate::wrong_file::WrongTable;

const WHAT: &str = "a CSV file of a measured record";

/// The most samples: a fit holds some tens of numbers for each.
pub const MOST_SAMPLES: usize = 500_000;

/// Least number of samples of a record: of the shortest one with a spectrum.
const LEAST_SAMPLES: usize = 8;

/// A step above this multiple of the median is a gap.
const GAP: f64 = 1.5;

/// Largest distance of a time from the grid of equal steps, in steps: times are printed with few digits.
const UNEVEN: f64 = 0.1;

/// An SI unit, and how many of them one number is.
type SiUnit = (&'static str, f64);

/// A name of a column and its unit; `None` without one.
type NamedUnit = (&'static str, Option<SiUnit>);

/// A column that a file has: its place, its name and its unit.
type FoundColumn = (usize, &'static str, Option<SiUnit>);

const TIMES: &[NamedUnit] = &[
    ("time_s", Some(("s", 1.0))),
    ("time_ms", Some(("s", 1e-3))),
    ("time_us", Some(("s", 1e-6))),
    ("time", None),
];

const FREQUENCIES: &[NamedUnit] = &[("frequency_hz", Some(("Hz", 1.0))), ("frequency", None)];

const LEVELS: &[&str] = &["level_db", "level"];

const AMPLITUDE: &str = "amplitude";

/// Standard acceleration of gravity, m/s².
const GRAVITY: f64 = 9.806_65;

/// Columns of a quantity.
const QUANTITIES: &[(RecordedQuantity, &[NamedUnit])] = &[
    (
        RecordedQuantity::Displacement,
        &[
            ("displacement_m", Some(("m", 1.0))),
            ("displacement_mm", Some(("m", 1e-3))),
            ("displacement_um", Some(("m", 1e-6))),
            ("displacement", None),
        ],
    ),
    (
        RecordedQuantity::Velocity,
        &[
            ("velocity_m_per_s", Some(("m/s", 1.0))),
            ("velocity_mm_per_s", Some(("m/s", 1e-3))),
            ("velocity", None),
        ],
    ),
    (
        RecordedQuantity::Acceleration,
        &[
            ("acceleration_m_per_s2", Some(("m/s²", 1.0))),
            ("acceleration_mm_per_s2", Some(("m/s²", 1e-3))),
            ("acceleration_g", Some(("m/s²", GRAVITY))),
            ("acceleration", None),
        ],
    ),
];

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
    pub window: Option<(f64, f64)>,
}

impl Default for RecordRequest {
    fn default() -> Self {
        Self { column: None, quantity: None, gain: 1.0, window: None }
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
    ) -> Result<Self, Failure> {
        let mut wrong = Vec::new();
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
                Some((number(from)?, number(to)?)).filter(|(from, to)| from < to)
            });
            request.window = ends;
            if ends.is_none() {
                let allowed = "two times A:B of the record with A < B, such as 0.2:1.5";
                wrong.push(Complaint::option("--window", text, allowed));
            }
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
        let text = data_file::text(path, WHAT).map_err(|why| complaint(path, why))?;
        let file = DataFile::new(&text, WHAT).map_err(|why| complaint(path, why))?;
        let has = |names: &[NamedUnit]| names.iter().any(|(name, _)| file.column(name).is_some());
        if has(FREQUENCIES) && !has(TIMES) {
            return read_spectrum(path, &file, request).map(Self::Spectrum);
        }
        read_record(path, &file, request).map(Self::Record)
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
    request: &RecordRequest,
) -> Result<TimeSeries, Failure> {
    let wrong = |why: String| complaint(path, why);
    let (time_at, time_name, time_factor) = first_of(file, TIMES).ok_or_else(|| {
        wrong(format!("{WHAT} with a column time, time_s or time_ms; it has {}", file.listed()))
    })?;
    let value = reading_column(path, file, request)?;
    if file.rows().len() > MOST_SAMPLES {
        let count = file.rows().len();
        let why =
            format!("it has {count} samples, and at most {MOST_SAMPLES} are read: leave some out");
        return Err(wrong(why).into());
    }
    let mut record = TimeSeries {
        path: path.to_owned(),
        times: Vec::new(),
        values: Vec::new(),
        lines: Vec::new(),
        quantity: value.quantity,
        columns: [time_name.to_owned(), value.name.clone()],
        time_unit: time_factor.map(|(unit, _)| unit),
        unit: value.unit.map(|(unit, _)| unit),
    };
    let (time_factor, factor) =
        (time_factor.map_or(1.0, |(_, factor)| factor), value.factor(request.gain));
    let mut found = Vec::new();
    let mut last: Option<f64> = None;
    for row in file.rows() {
        let time = row.number(time_at, time_name, "a finite number", f64::is_finite);
        let reading = row.number(value.at, &value.name, "a finite number", f64::is_finite);
        if let (Ok(time), Some(last)) = (&time, last)
            && *time <= last
        {
            found.push(WrongTable::Cell {
                line: row.line(),
                column: time_name.to_owned(),
                cell: time.to_string(),
                allowed: format!("above the time of the line before, {last}"),
            });
        }
        last = time.as_ref().ok().copied().or(last);
        match (time, reading) {
            (Ok(time), Ok(reading)) => {
                let time = time_factor * time;
                let inside = request.window.is_none_or(|(from, to)| (from..=to).contains(&time));
                if inside {
                    record.times.push(time);
                    record.values.push(factor * reading);
                    record.lines.push(row.line());
                }
            }
            (time, reading) => found.extend([time.err(), reading.err()].into_iter().flatten()),
        }
    }
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
    request: &RecordRequest,
) -> Result<MeasuredSpectrum, Failure> {
    let wrong = |why: String| complaint(path, why);
    let (at, name, unit) = first_of(file, FREQUENCIES).ok_or_else(|| {
        wrong(format!("a spectrum with a column frequency_hz; it has {}", file.listed()))
    })?;
    let level = LEVELS.iter().find_map(|name| Some((file.column(name)?, *name)));
    let plain = file.column(AMPLITUDE).map(|at| (at, AMPLITUDE));
    let named = level.or(plain).filter(|_| request.column.is_none());
    let value = match named {
        Some((at, name)) => ReadingColumn {
            at,
            name: name.to_owned(),
            quantity: request.quantity.unwrap_or(RecordedQuantity::Displacement),
            unit: None,
        },
        None => reading_column(path, file, request)?,
    };
    let in_decibels = LEVELS.contains(&value.name.as_str());
    let factor = value.factor(request.gain.abs());
    let (mut frequencies, mut amplitudes, mut found) = (Vec::new(), Vec::new(), Vec::new());
    for row in file.rows() {
        let above = frequencies.last().copied().unwrap_or(-1.0);
        let right = |value: f64| value.is_finite() && value >= 0.0 && value > above;
        let frequency =
            row.number(at, name, "a finite number ≥ 0 above that of the line before", right);
        let amplitude = row.number(value.at, &value.name, "a finite number", f64::is_finite);
        match (frequency, amplitude) {
            (Ok(frequency), Ok(reading)) => {
                let linear = if in_decibels { libm::pow(10.0, reading / 20.0) } else { reading };
                frequencies.push(frequency);
                amplitudes.push(factor * linear);
            }
            (frequency, amplitude) => {
                found.extend([frequency.err(), amplitude.err()].into_iter().flatten());
            }
        }
    }
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
        quantity: value.quantity,
        columns: [name.to_owned(), value.name],
        frequency_unit: unit.map(|(unit, _)| unit),
        unit: value.unit.map(|(unit, _)| unit),
    })
}

/// The column of readings.
struct ReadingColumn {
    at: usize,
    name: String,
    quantity: RecordedQuantity,
    unit: Option<SiUnit>,
}

impl ReadingColumn {
    fn factor(&self, gain: f64) -> f64 {
        gain * self.unit.map_or(1.0, |(_, factor)| factor)
    }
}

fn reading_column(
    path: &Path,
    file: &DataFile<'_>,
    request: &RecordRequest,
) -> Result<ReadingColumn, Failure> {
    let known = |name: &str| {
        QUANTITIES.iter().find_map(|(quantity, columns)| {
            let (_, unit) = columns.iter().find(|(column, _)| *column == name)?;
            Some((*quantity, *unit))
        })
    };
    if let Some(name) = &request.column {
        let Some(at) = file.column(name) else {
            let allowed = format!("a column of the file: {}", file.listed());
            let nearest = nearest::word(name, file.names().iter().copied());
            let complaint = Complaint::option("--column", name.as_str(), allowed);
            return Err(complaint.suggesting(nearest).into());
        };
        let (quantity, unit) = match (request.quantity, known(name)) {
            (Some(quantity), Some((own, unit))) if quantity == own => (quantity, unit),
            (Some(quantity), _) => (quantity, None),
            (None, Some(found)) => found,
            (None, None) => {
                let allowed = "given with --quantity displacement, velocity or acceleration: the name of the column does not say it";
                return Err(Complaint::option("--column", name.as_str(), allowed).into());
            }
        };
        return Ok(ReadingColumn { at, name: name.clone(), quantity, unit });
    }
    let wanted = |quantity: RecordedQuantity| request.quantity.is_none_or(|own| own == quantity);
    let found = QUANTITIES.iter().filter(|(quantity, _)| wanted(*quantity)).find_map(
        |(quantity, columns)| {
            let (at, name, unit) = first_of(file, columns)?;
            Some(ReadingColumn { at, name: name.to_owned(), quantity: *quantity, unit })
        },
    );
    found.ok_or_else(|| {
        let why = format!(
            "{WHAT} with a column displacement, velocity or acceleration (with _m, _m_per_s or _m_per_s2 in SI), or one named by \
             --column with --quantity; it has {}",
            file.listed()
        );
        complaint(path, why).into()
    })
}

/// The first of these columns that the file has.
fn first_of(file: &DataFile<'_>, names: &[NamedUnit]) -> Option<FoundColumn> {
    names.iter().find_map(|(name, unit)| Some((file.column(name)?, *name, *unit)))
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
        let invalid =
            rows("time,velocity", |k| format!("{k},{}", if k == 5 { "nan" } else { "1" }));
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
}
