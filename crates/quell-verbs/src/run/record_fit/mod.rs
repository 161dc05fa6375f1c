//! `fit --record`: numbers of a study from a measured record, by the exact motion.
//!
//! The sum of squares is minimised over the first periods from several starts (`starts`), and from the best of them over a part that grows to the
//! whole record, so that the phase is never lost. `model` says how readings and derivatives are computed.

mod model;
mod request;
mod starts;

use std::path::Path;
use std::sync::atomic::AtomicBool;

use quell_design::estimates::{Estimates, Freedom};
use quell_input::record::{RecordRequest, TimeSeries};
use quell_numerics::damped_least_squares::{DampedMinimum, DampedSearch, FittedFunction, fitted};
use quell_numerics::order::ascending_by;

pub use request::{FreeNumber, FreeStart, MEASUREMENT};

use super::decay::{pattern, record_warnings};
use super::named_estimates::{NamedEstimates, ReportedParameter};
use super::recorded_motion::ObservedMotion;
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::study::{Change, Kind, Study};
use crate::words::{more_digits, quantity_at};
use model::RecordModel;
use request::free_numbers;

/// Periods of the record in the first part, and the factor by which it grows.
const FIRST_PART: (f64, f64) = (3.0, 2.0);

/// Starts that go on after the first part.
const KEPT: usize = 3;

/// Most steps over the first part, and over a later one.
const STEPS: (usize, usize) = (30, 60);

/// Periods before the record if the shift is free and no settling time is given: a limit cycle is reached to 10⁻⁴ at a growth rate of 5 % a
/// period.
const SETTLE_PERIODS: f64 = 30.0;

/// Periods of the record within which its highest displacement is sought: one is complete in any phase, also where the study is slower.
const MARKER_PERIODS: f64 = 2.5;

/// Samples at least in the first part, for each free number.
const PER_NUMBER: usize = 4;

/// Relative difference of two values that are one minimum, in standard errors.
const ONE_MINIMUM: f64 = 0.5;

/// Options of `fit --record`.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordFitRequest {
    /// How the file is read.
    pub record: RecordRequest,
    /// `PATH`, `PATH=START`, and the names of [`MEASUREMENT`].
    pub free: Vec<String>,
    /// `PATH=VALUE`: other numbers of the study.
    pub fix: Vec<String>,
    /// Time before the record in units of the equations.
    pub settle: Option<f64>,
}

/// Another minimum of the sum of squares.
#[derive(Clone, Debug, PartialEq)]
pub struct OtherMinimum {
    /// Values of the free numbers.
    pub values: Vec<f64>,
    /// Sum of squares.
    pub rss: f64,
}

/// A study fitted to a record.
#[derive(Clone, Debug)]
pub struct RecordFit {
    /// The study, with fixed numbers but before the fit.
    pub study: Study,
    /// The study with the estimates.
    pub fitted_study: Study,
    /// The record.
    pub record: TimeSeries,
    /// The free numbers.
    pub free: Vec<FreeNumber>,
    /// The estimates with their names.
    pub named: NamedEstimates,
    /// The fitted readings.
    pub values: Vec<f64>,
    /// Whether the search has converged.
    pub converged: bool,
    /// Whether the shift counts from the highest displacement.
    pub from_highest: bool,
    /// Settling time in units of the equations.
    pub settle: f64,
    /// Number of starts of the search.
    pub tried: usize,
    /// Other minima.
    pub others: Vec<OtherMinimum>,
}

/// Fits free numbers of a study to a file.
///
/// # Errors
/// Complaints about the file and the numbers; [`Failure::Failed`] where the study has no motion, or the search is stopped.
pub fn run(
    study: &Study,
    path: &Path,
    request: &RecordFitRequest,
    stop: &AtomicBool,
) -> Result<RecordFit, Failure> {
    let study = with_fixed(study, &request.fix)?;
    let record = TimeSeries::read(path, &request.record)?;
    let starts = free_numbers(&study, &request.free)?;
    let free: Vec<FreeNumber> = starts.iter().map(|one| one.number.clone()).collect();
    if record.times.len() <= 2 * free.len() {
        let allowed =
            format!("at least {} samples for {} free numbers", 2 * free.len() + 1, free.len());
        let given = record.path().display().to_string();
        return Err(Complaint::new(Fault::Path, "data file", Origin::Whole, given, allowed).into());
    }
    let motion = ObservedMotion::of(&study.system(), "fit --record")?;
    motion.scales.of_record(&record)?;
    let period = starts::period(&record);
    let has_shift = free.contains(&FreeNumber::Shift);
    let settle = settling(&motion, request.settle, has_shift)?;
    let is_paced = motion.system.is_dithered() || !motion.system.is_steady();
    let marker = match (has_shift && !is_paced, period) {
        (false, _) => None,
        (true, Some(period)) => Some(MARKER_PERIODS * period),
        (true, None) => {
            let allowed = "fixed: the record does not vibrate";
            return Err(Complaint::option("--free", MEASUREMENT[0], allowed).into());
        }
    };
    let base: Vec<f64> = starts.iter().map(|one| one.start.unwrap_or(0.0)).collect();
    let mut model = RecordModel::new(&study, &free, &record, (settle, marker), &base, stop);
    let (minima, tried) = search(&mut model, &starts, period)?;
    finish(&study, &record, &free, &model, (minima, tried), (settle, marker.is_some()))
}

/// The study with the numbers of `--fix`.
fn with_fixed(study: &Study, fix: &[String]) -> Result<Study, Failure> {
    let mut study = study.clone();
    for text in fix {
        let change = Change::parse(text, "--fix").map_err(|wrong| Failure::from(*wrong))?;
        let number = text.split_once('=').and_then(|(_, value)| value.trim().parse::<f64>().ok());
        let Some(number) = number.filter(|number| number.is_finite()) else {
            let allowed = "PATH=VALUE with a finite number, such as belt.damping_ratio=0.01";
            return Err(Complaint::option("--fix", text.as_str(), allowed).into());
        };
        study = study.with(&change.path, number)?;
    }
    Ok(study)
}

/// Time before the record.
fn settling(motion: &ObservedMotion, given: Option<f64>, has_shift: bool) -> Result<f64, Failure> {
    match (given, has_shift && motion.system.is_steady()) {
        (Some(settle), _) => Ok(settle),
        (None, false) => Ok(0.0),
        (None, true) => motion.period.map(|period| SETTLE_PERIODS * period).ok_or_else(|| {
            let allowed =
                "given: nothing oscillates in this study, so that there is no usual settling time";
            Complaint::option("--settle", serde_json::Value::Null, allowed).into()
        }),
    }
}

/// The minima over the whole record, the least first, and the number of starts.
fn search(
    model: &mut RecordModel<'_>,
    starts: &[FreeStart],
    period: Option<f64>,
) -> Result<(Vec<DampedMinimum>, usize), Failure> {
    let record = model.record;
    let whole = record.times.len();
    let within = |length: f64| record.times.partition_point(|t| t - record.times[0] <= length);
    let least = (PER_NUMBER * starts.len()).max(8).min(whole);
    let mut part = FIRST_PART.0 * period.unwrap_or(record.length());
    model.count = within(part).clamp(least, whole);
    let mean = record.values.iter().sum::<f64>() / whole as f64;
    let tried = starts::starts(model, starts, period, (mean, model.size));
    let count = tried.len();
    let mut search = bounds(model.study, starts);
    search.steps = STEPS.0;
    let mut minima: Vec<DampedMinimum> = Vec::new();
    for start in tried {
        let data = &record.values[..model.count];
        minima.extend(fitted(model, data, &start, &search));
    }
    search.steps = STEPS.1;
    keep_least(&mut minima);
    while model.count < whole {
        part *= FIRST_PART.1;
        model.count = within(part).max(model.count + 1).min(whole);
        let data = &record.values[..model.count];
        minima = minima
            .into_iter()
            .filter_map(|found| fitted(model, data, &found.at, &search))
            .collect();
        keep_least(&mut minima);
    }
    if model.is_stopped() {
        return Err(super::stopped("fit"));
    }
    if minima.is_empty() {
        let why = model.why.take().unwrap_or_else(|| "the study has no readings".to_owned());
        let why = format!("no start of the search has a motion: {why}");
        return Err(Failure::Failed { key: "fit --record".to_owned(), why: why.into() });
    }
    Ok((minima, count))
}

/// Sorts the minima, drops those that another one equals, and keeps a few.
fn keep_least(minima: &mut Vec<DampedMinimum>) {
    ascending_by(minima, |a| a.rss);
    let mut kept: Vec<DampedMinimum> = Vec::new();
    for found in minima.drain(..) {
        let is_known = kept.iter().any(|other| {
            let away: f64 =
                found.values.iter().zip(&other.values).map(|(a, b)| (a - b) * (a - b)).sum();
            away.sqrt()
                <= ONE_MINIMUM * (other.rss / other.values.len() as f64).sqrt()
                    + 1e-9 * size(&other.values)
        });
        if !is_known && kept.len() < KEPT {
            kept.push(found);
        }
    }
    *minima = kept;
}

fn size(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}

/// Bounds of the numbers: 0 for those that are positive and for which no negative value is valid.
fn bounds(study: &Study, starts: &[FreeStart]) -> DampedSearch {
    let lower = starts.iter().map(|one| match (&one.number, one.start) {
        (FreeNumber::OfStudy(path), Some(start)) if start > 0.0 => {
            let is_valid = |value: f64| study.at([(path.as_str(), value)]).is_ok();
            match (is_valid(-1e-9 * start), is_valid(0.0)) {
                (true, _) => -f64::MAX,
                (false, true) => 0.0,
                // A number that must be positive stays so.
                (false, false) => 1e-6 * start,
            }
        }
        _ => -f64::MAX,
    });
    DampedSearch { lower: lower.collect(), upper: vec![f64::MAX; starts.len()], steps: 0 }
}

fn finish(
    study: &Study,
    record: &TimeSeries,
    free: &[FreeNumber],
    model: &RecordModel<'_>,
    (mut minima, tried): (Vec<DampedMinimum>, usize),
    (settle, from_highest): (f64, bool),
) -> Result<RecordFit, Failure> {
    let best = minima.remove(0);
    let estimates = Estimates::of(&best, &record.values, &vec![Freedom::Free; free.len()]);
    let parameters = free.iter().map(|number| ReportedParameter {
        name: number.name().to_owned(),
        unit: unit(study, record, number),
        factor: 1.0,
    });
    let named = NamedEstimates { parameters: parameters.collect(), estimates };
    let others =
        minima.into_iter().map(|found| OtherMinimum { values: found.at, rss: found.rss }).collect();
    Ok(RecordFit {
        study: study.clone(),
        fitted_study: model.study_at(&best.at)?,
        record: record.clone(),
        free: free.to_vec(),
        named,
        values: best.values,
        converged: best.converged,
        from_highest,
        settle,
        tried,
        others,
    })
}

/// Unit of a free number.
fn unit(study: &Study, record: &TimeSeries, number: &FreeNumber) -> String {
    match number {
        FreeNumber::OfStudy(path) => {
            study.address(path).map_or("1", |address| address.unit).to_owned()
        }
        FreeNumber::Shift => record.time_unit.unwrap_or("time").to_owned(),
        FreeNumber::Offset => record.unit.unwrap_or("reading").to_owned(),
        FreeNumber::Gain => "1".to_owned(),
    }
}

impl RecordFit {
    /// Residuals.
    pub fn residuals(&self) -> Vec<f64> {
        self.record.values.iter().zip(&self.values).map(|(y, f)| y - f).collect()
    }

    /// Numbers of the study as tables to paste, and their covariance.
    pub fn fragments(&self) -> (String, String) {
        let mut tables: Vec<(String, String)> = Vec::new();
        for (place, number) in self.free.iter().enumerate() {
            let FreeNumber::OfStudy(path) = number else { continue };
            let value = self.named.value(place);
            let (table, key) = path.rsplit_once('.').unwrap_or(("", path));
            // A table of a list has a place or a name of its own.
            let is_plain = !matches!(self.study.kind(), Kind::System(_))
                && !table.contains('[')
                && table != "dither";
            let line = format!("{key} = {value:?}\n");
            let (heading, line) = if is_plain {
                (format!("[{table}]\n"), line)
            } else {
                (
                    "# further numbers, as --set takes them\n".to_owned(),
                    format!("# {path}={value:?}\n"),
                )
            };
            match tables.iter_mut().find(|(known, _)| *known == heading) {
                Some((_, lines)) => *lines += &line,
                None => tables.push((heading, line)),
            }
        }
        let text = tables.into_iter().map(|(heading, lines)| heading + &lines).collect();
        let uncertainty =
            self.named.uncertainty(|name| (!MEASUREMENT.contains(&name)).then(|| name.to_owned()));
        (text, uncertainty)
    }

    /// Warnings about the record and the estimates.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = record_warnings(&self.record);
        if !self.converged {
            warnings.push("the search has not converged: try other starts with --free PATH=START, or free fewer numbers".to_owned());
        }
        let of_measurement = |warning: &String| {
            warning.ends_with("exceeds it")
                && MEASUREMENT.iter().any(|name| warning.starts_with(name))
        };
        // An offset or a shift that is nearly 0 is no defect.
        warnings.extend(self.named.warnings().into_iter().filter(|text| !of_measurement(text)));
        for other in &self.others {
            let count = self.record.times.len() as f64;
            let away = count * libm::log(other.rss / self.named.estimates.rss);
            let values: Vec<String> = self
                .free
                .iter()
                .zip(&other.values)
                .map(|(number, value)| {
                    format!("{} {}", quantity_at(number.name()), more_digits(*value))
                })
                .collect();
            if away < NEAR_MINIMUM {
                warnings.push(format!(
                    "another minimum fits nearly as well (its AIC is larger by {}): {}",
                    quell_model::digits::digits(away, 2),
                    values.join(", ")
                ));
            }
        }
        warnings.extend(pattern(&self.residuals()));
        warnings
    }
}

/// Difference of AIC within which another minimum is reported: its Akaike weight is above 0.7 %.
const NEAR_MINIMUM: f64 = 10.0;
