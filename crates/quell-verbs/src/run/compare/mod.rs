//! `compare`: a measured record or spectrum against the exact response of a study, before and after its dither.
//!
//! The study is sampled as the record was: after a settling time the same number of samples at the same step, without a filter. Both have
//! their spectra under the same window (Hann). Levels are 20 log₁₀ of amplitudes over one unit. The window separates lines four bins apart
//! at equal size; two bins is the half-width of its main lobe, reported as the resolution.

mod lines;
mod spectra;

use std::path::{Path, PathBuf};

use quell_input::dialect::FileDialect;
use quell_input::record::{MeasuredFile, MeasuredSpectrum, RecordRequest, TimeSeries};
use quell_model::RecordedQuantity;
use quell_numerics::spectrum::Spectrum;

pub use lines::{ComparedLine, decibels};
pub use spectra::ComparedSpectrum;

use super::recorded_motion::{ObservedMotion, RecordUnits};
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::study::Study;
use crate::words::digits;
use spectra::cycles;

/// Periods of the slowest oscillation before the computed record, if no time is given.
pub const SETTLE_PERIODS: f64 = 200.0;

/// Periods of the slowest line below which a record says little about it: its resolution is then a fifth of the frequency.
const LEAST_PERIODS: f64 = 10.0;

/// Half-width of the main lobe of the window, in bins.
const LOBE: f64 = 2.0;

/// Difference between the halves of the computed record, in decibels, above which it has not settled.
const UNSETTLED: f64 = 0.2;

/// Share of the frequency of the slowest dither at which the band of slow vibration ends.
const BELOW_DITHER: f64 = 0.75;

/// Samples of a computed record at most.
const MOST_SAMPLES: usize = 2_000_000;

/// What is compared.
#[derive(Clone, Debug, PartialEq)]
pub struct CompareRequest {
    /// The measured file; with `after` the one before the dither.
    pub measured: PathBuf,
    /// The file measured under dither.
    pub after: Option<PathBuf>,
    /// How the files are read.
    pub record: RecordRequest,
    /// Time before the computed record, in units of the equations.
    pub settle: Option<f64>,
}

/// A measured and a computed record.
#[derive(Clone, Debug)]
pub struct ComparedRecord {
    /// The file.
    pub file: PathBuf,
    /// Whether the study is computed with its dither.
    pub dithered: bool,
    /// What is compared.
    pub quantity: RecordedQuantity,
    /// Unit of readings; `None` without one.
    pub unit: Option<&'static str>,
    /// Unit of frequencies, `Hz`; `None` for cycles per plain unit of time.
    pub frequency_unit: Option<&'static str>,
    /// Columns of the file.
    pub columns: [String; 2],
    /// How the file was read.
    pub read: FileDialect,
    /// The measured spectrum.
    pub measured: ComparedSpectrum,
    /// The computed spectrum.
    pub computed: ComparedSpectrum,
    /// Its lines.
    pub lines: Vec<ComparedLine>,
    /// Half-width of the main lobe of the window.
    pub resolution: f64,
    /// Largest frequency that is compared.
    pub highest: f64,
    /// Length of the record.
    pub length: f64,
    /// Measured and computed root mean square of the vibration.
    pub rms: [f64; 2],
    /// The same below the dither; `None` without dither in the study.
    pub slow_rms: Option<[f64; 2]>,
    /// What cannot be compared.
    pub not_comparable: Vec<String>,
}

/// The answer of `compare`.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// The record, or the one before the dither.
    pub before: ComparedRecord,
    /// The record under dither, if there is a second file.
    pub after: Option<ComparedRecord>,
}

/// Compares files with a study.
///
/// # Errors
/// Complaints about files, units and the study; [`Failure::Failed`] where the engine stops.
pub fn run(study: &Study, request: &CompareRequest) -> Result<Comparison, Failure> {
    let motion = ObservedMotion::of(&study.system(), "compare")?;
    let is_dithered = motion.system.is_dithered();
    let Some(after) = &request.after else {
        let before = one(&motion, is_dithered, &request.measured, request)?;
        return Ok(Comparison { before, after: None });
    };
    if !is_dithered {
        let allowed = "given for a study with dither, whose effect the second file shows";
        let given = after.display().to_string();
        let origin = Origin::Argument("--after");
        return Err(Complaint::new(Fault::Conflict, "--after", origin, given, allowed).into());
    }
    let quiet = ObservedMotion { system: motion.system.undithered(), ..motion.clone() };
    let before = one(&quiet, false, &request.measured, request)?;
    let after = one(&motion, true, after, request)?;
    let mut found = Comparison { before, after: Some(after) };
    found.same_units()?;
    found.band_below_dither(&motion);
    Ok(found)
}

/// The samples of a computed record.
struct ComputedRecord {
    values: Vec<f64>,
    /// Step in units of the record.
    step: f64,
}

fn one(
    motion: &ObservedMotion,
    dithered: bool,
    path: &Path,
    request: &CompareRequest,
) -> Result<ComparedRecord, Failure> {
    let mut found = match MeasuredFile::read(path, &request.record)? {
        MeasuredFile::Record(record) => of_record(motion, dithered, &record, request)?,
        MeasuredFile::Spectrum(spectrum) => of_spectrum(motion, dithered, &spectrum, request)?,
    };
    found.look_at_dither(motion);
    Ok(found)
}

fn of_record(
    motion: &ObservedMotion,
    dithered: bool,
    record: &TimeSeries,
    request: &CompareRequest,
) -> Result<ComparedRecord, Failure> {
    let step = record.even_step()?;
    let units = motion.scales.of_record(record)?;
    let count = record.times.len();
    let begin = if motion.system.is_steady() { None } else { Some(record.times[0]) };
    let computed = computed(motion, record.quantity, &units, (step, count, begin), request)?;
    let refused = |why: quell_numerics::spectrum::SpectrumError| Failure::Failed {
        key: "compare".to_owned(),
        why: why.to_string().into(),
    };
    let of = |values: &[f64], step: f64| -> Result<ComparedSpectrum, Failure> {
        Ok(ComparedSpectrum::OfRecord { spectrum: Spectrum::of(values, step).map_err(refused)? })
    };
    let length = count as f64 * step;
    let mut found = ComparedRecord {
        file: record.path().to_owned(),
        dithered,
        quantity: record.quantity,
        unit: record.unit,
        frequency_unit: record.time_unit.map(|_| "Hz"),
        columns: record.columns.clone(),
        read: record.read.clone(),
        measured: of(&record.values, step)?,
        computed: of(&computed.values, computed.step)?,
        lines: Vec::new(),
        resolution: LOBE / length,
        highest: 0.5 / step,
        length,
        rms: [deviation(&record.values), deviation(&computed.values)],
        slow_rms: None,
        not_comparable: Vec::new(),
    };
    found.lines = lines::compared(&found.measured, &found.computed, found.resolution);
    found.look_at_halves(&computed.values);
    Ok(found)
}

/// A spectrum from a file: the computed record has its spacing as resolution and ends at its last line.
fn of_spectrum(
    motion: &ObservedMotion,
    dithered: bool,
    spectrum: &MeasuredSpectrum,
    request: &CompareRequest,
) -> Result<ComparedRecord, Failure> {
    let time_unit = spectrum.frequency_unit.map(|_| "s");
    let file = spectrum.path().display().to_string();
    let units = motion.scales.units(spectrum.quantity, time_unit, spectrum.unit, &file)?;
    let count = spectrum.frequencies.len();
    // Without a unit the frequencies are angular ones of the equations.
    let factor = if time_unit.is_some() { 1.0 } else { cycles(1.0) };
    let frequencies: Vec<f64> = spectrum.frequencies.iter().map(|f| factor * f).collect();
    let highest = frequencies[count - 1];
    let spacing = (highest - frequencies[0]) / (count - 1) as f64;
    let step = 0.5 / highest;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
    let samples = ((1.0 / (spacing * step)).ceil() as usize).clamp(64, MOST_SAMPLES);
    let computed = computed(motion, spectrum.quantity, &units, (step, samples, None), request)?;
    let own = Spectrum::of(&computed.values, computed.step).map_err(|why| Failure::Failed {
        key: "compare".to_owned(),
        why: why.to_string().into(),
    })?;
    let amplitudes = spectrum.amplitudes.clone();
    let measured = ComparedSpectrum::OnGrid { frequencies, amplitudes };
    let own = ComparedSpectrum::OfRecord { spectrum: own };
    let rms = [measured.by_peaks(0.0, highest), own.by_peaks(0.0, highest)];
    let mut found = ComparedRecord {
        file: spectrum.path().to_owned(),
        dithered,
        quantity: spectrum.quantity,
        unit: spectrum.unit,
        frequency_unit: spectrum.frequency_unit,
        columns: spectrum.columns.clone(),
        read: spectrum.read.clone(),
        lines: lines::compared(&measured, &own, LOBE * spacing),
        measured,
        computed: own,
        resolution: LOBE * spacing,
        highest,
        length: 1.0 / spacing,
        rms,
        slow_rms: None,
        not_comparable: vec![
            "the mean, and everything between the lines: the window of the file is unknown, so that levels are those of peaks".to_owned(),
        ],
    };
    found.look_at_halves(&computed.values);
    Ok(found)
}

/// The readings of the study: `step` in units of the record, `count` samples, and the time of the first one where the study varies.
fn computed(
    motion: &ObservedMotion,
    quantity: RecordedQuantity,
    units: &RecordUnits,
    (step, count, begin): (f64, usize, Option<f64>),
    request: &CompareRequest,
) -> Result<ComputedRecord, Failure> {
    let settle = match (begin, request.settle) {
        (Some(begin), None) => begin * units.time,
        (_, Some(settle)) => settle,
        (None, None) => {
            let period = motion.period.ok_or_else(|| {
                let allowed = "given: nothing oscillates in this study, so that there is no usual settling time";
                Failure::from(Complaint::option("--settle", serde_json::Value::Null, allowed))
            })?;
            SETTLE_PERIODS * period
        }
    };
    let first = motion.start.time + settle;
    let times: Vec<f64> =
        (0..count).map(|k| (k as f64).mul_add(step * units.time, first)).collect();
    let (values, _) = motion.readings(quantity, &times)?;
    let values = values.iter().map(|value| value * units.reading).collect();
    Ok(ComputedRecord { values, step })
}

/// Root mean square about the mean.
fn deviation(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    (values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / count).sqrt()
}

impl ComparedRecord {
    /// Name of a unit of frequency.
    pub fn hertz(&self) -> &'static str {
        self.frequency_unit.unwrap_or("cycles per unit of time")
    }

    /// Whether the computed record has settled.
    fn look_at_halves(&mut self, computed: &[f64]) {
        let (first, second) = computed.split_at(computed.len() / 2);
        let difference = decibels(deviation(second) / deviation(first));
        if difference.abs() > UNSETTLED {
            self.not_comparable.push(format!(
                "the level of the study to better than {} dB: the halves of its record differ by that, so that it has not settled or \
                 beats; --settle takes a longer time before it",
                quell_model::digits::digits(difference.abs(), 2)
            ));
        }
    }

    /// What sampling and length hide.
    fn look_at_dither(&mut self, motion: &ObservedMotion) {
        // One unit of time of the record in those of the equations, from the period of the equations.
        let per_time = match self.frequency_unit {
            Some(_) => motion.scales.second.unwrap_or(1.0),
            None => motion.scales.plain_time,
        };
        let hertz = self.hertz();
        for angular in motion.system.acting_frequencies() {
            let dither = cycles(angular) * per_time;
            if dither > self.highest {
                let rate = 2.0 * self.highest;
                let folded = dither - rate * (dither / rate).round();
                self.not_comparable.push(format!(
                    "the line of the dither at {} {hertz}: the record ends at {} {hertz}, half of its sampling rate. Without a filter \
                     before sampling it appears at {} {hertz}, in the study as well",
                    digits(dither),
                    digits(self.highest),
                    digits(folded.abs())
                ));
            }
        }
        let strongest = self.lines.iter().max_by(|a, b| a.size_of().total_cmp(&b.size_of()));
        if let Some(line) = strongest {
            let periods = line.frequency() * self.length;
            if periods < LEAST_PERIODS {
                self.not_comparable.push(format!(
                    "lines less than {} {hertz} apart: the record has {} periods of its strongest line, and at least {LEAST_PERIODS} \
                     are needed for levels to a tenth of a decibel",
                    digits(self.resolution),
                    quell_model::digits::digits(periods, 2)
                ));
            }
        }
        if self.unit.is_none() && motion.scales.metre.is_some() {
            self.not_comparable.push(format!(
                "absolute levels, unless the readings are the {} in the unit of the study: --gain calibrates them. Differences between lines and \
                 the reduction do not depend on it",
                self.quantity.name()
            ));
        }
    }

    fn band_below(&mut self, highest: f64) {
        if highest > self.resolution {
            let of =
                |spectrum: &ComparedSpectrum| spectrum.root_mean_square(self.resolution, highest);
            self.slow_rms = Some([of(&self.measured), of(&self.computed)]);
        }
    }
}

impl ComparedLine {
    /// The larger amplitude of the two.
    fn size_of(&self) -> f64 {
        let size =
            |peak: Option<quell_numerics::spectrum::Peak>| peak.map_or(0.0, |peak| peak.amplitude);
        size(self.measured).max(size(self.computed))
    }
}

/// A reduction in decibels, positive where the dither quiets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reduction {
    /// Measured.
    pub measured: f64,
    /// By the study.
    pub predicted: f64,
}

impl Comparison {
    /// Both records must be of one quantity in one unit.
    fn same_units(&self) -> Result<(), Failure> {
        let Some(after) = &self.after else { return Ok(()) };
        if (after.quantity, after.unit) == (self.before.quantity, self.before.unit) {
            return Ok(());
        }
        let allowed = format!(
            "a file of the same quantity in the same unit as the first one, {}",
            self.before.columns[1]
        );
        let given = after.columns[1].as_str();
        Err(Complaint::new(Fault::Mixed, "--after", Origin::Argument("--after"), given, allowed)
            .into())
    }

    /// Levels of slow vibration, below the slowest dither.
    fn band_below_dither(&mut self, motion: &ObservedMotion) {
        let per_time = match self.before.frequency_unit {
            Some(_) => motion.scales.second.unwrap_or(1.0),
            None => motion.scales.plain_time,
        };
        let slowest = motion.system.acting_frequencies().fold(f64::INFINITY, f64::min);
        let highest = BELOW_DITHER * cycles(slowest) * per_time;
        self.before.band_below(highest);
        if let Some(after) = &mut self.after {
            after.band_below(highest);
        }
    }

    /// The reduction of the whole vibration.
    pub fn reduction(&self) -> Option<Reduction> {
        let after = self.after.as_ref()?;
        Some(reduction(self.before.rms, after.rms))
    }

    /// The reduction of the vibration below the dither.
    pub fn slow_reduction(&self) -> Option<Reduction> {
        Some(reduction(self.before.slow_rms?, self.after.as_ref()?.slow_rms?))
    }
}

fn reduction(before: [f64; 2], after: [f64; 2]) -> Reduction {
    Reduction {
        measured: decibels(before[0] / after[0]),
        predicted: decibels(before[1] / after[1]),
    }
}
