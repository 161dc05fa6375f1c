//! The steady response of any system: a settled record of one row, compared with the undithered run from the same start.
//!
//! Where a run ends on a stable periodic motion, the record begins on it, and means over time are those of one period exactly
//! ([`SystemEnding`]). Where no such motion is found, the record of the run itself is judged, after the settling time.
//!
//! The dissertation specifies no record, and E depends on it: the time until the run has settled is discarded, the mean removed, a periodic
//! Hann window applied, and zeros appended to four times the length. M is the largest spectral amplitude in the band of slow vibration, and
//! E = M₁/M₀ (2.27). Keeping the mean would make E > 1; keeping the start-up under a rectangular window would limit E to about 0.3 from
//! below.
//!
//! The band of one mass ends at 1.9 ω₀, as in the dissertation. With several masses it ends below the lowest dither frequency; if that is
//! not above 1.9 times the frequency of the vibration, the band ends there ([`RecordGrid::band_end`]). The vibration is the strongest line
//! without dither; where none remains, the least damped motion of the sliding structure. The effect is decided by [`Vibrations`]. The tones of dithers above the band are subtracted first: near its end the window would spread them
//! into it. What a dither in the band moves is vibration.
//!
//! An undithered run on no known motion keeps vibrating if its record does not decay, or shows a vibration while steady sliding is
//! unstable.

use std::f64::consts::TAU;
use std::fmt;

use quell_linear::steady::SteadySliding;
use quell_model::profile::Wave;
use quell_model::{Contact, System};
use quell_numerics::spectrum::Spectrum;
use quell_numerics::spectrum::low_band::LargestLines;

use super::effect::{Effect, Uncertain, Vibrations};
use super::measure::Undefined;
use super::record_lines::RecordLines;
use super::record_tones::{lines_of, spectrum_of};
use super::solver::Solver;
use super::system_ending::{SystemEnding, cannot_settle};
use crate::band::{BAND_END, LEAST_BAND_END, vibration_frequency};
use crate::motion::{
    ContactMeans, ContactMeter, Immobile, InputCost, InputMeter, Motion, MotionEnd, MotionObserver,
    MotionSegment, MotionStart, MotionStopped, NoPower, ReadingSampler, RowMeter,
};

/// Samples per period of the fastest dither, at least: its seventh harmonic stays below the Nyquist frequency.
const SAMPLES_PER_DITHER_PERIOD: f64 = 16.0;

/// Samples per period of the fastest motion of the structure, at least.
const SAMPLES_PER_PERIOD: f64 = 8.0;

/// Samples per period of the vibration, at least: its harmonics fold back into the band beyond the 126th alone.
const SAMPLES_PER_SLOW_PERIOD: f64 = 128.0;

/// Largest number of samples of a record.
const MOST_SAMPLES: f64 = 4_194_304.0;

/// Least number of samples of a record.
const LEAST_SAMPLES: f64 = 256.0;

/// Lines of the unpadded record, or of its halves, between the line of a dither and the end of the band: the window spreads a
/// tone over two on each side.
const WINDOW_REACH: f64 = 4.0;

/// Peaks below this fraction of the largest are not listed.
pub const PEAK_FLOOR: f64 = 1e-3;

/// How a response is measured.
#[derive(Clone, Debug, PartialEq)]
pub struct ResponsePlan {
    /// The row that is observed.
    pub row: Vec<f64>,
    /// Time discarded before the record.
    pub settle: f64,
    /// Length of the record.
    pub length: f64,
    /// Bound on the last terms of a step, as of [`Motion::run_tolerance`]; `None` for that of the engine.
    pub tolerance: Option<f64>,
}

impl From<&Solver> for ResponsePlan {
    /// The plan of a belt's response in the numbers of its equations.
    fn from(solver: &Solver) -> Self {
        let Solver { tolerance, settle, record_periods } = *solver;
        let length = TAU * f64::from(record_periods);
        Self { row: vec![1.0], settle, length, tolerance: Some(tolerance) }
    }
}

/// Why a response could not be measured.
#[derive(Clone, Debug, PartialEq)]
pub enum ResponseRefused {
    /// The motion cannot be computed.
    Immobile(Immobile),
    /// A run ended early.
    Stopped(MotionStopped),
    /// The record would have too many samples.
    TooLong {
        /// The longest record of this system.
        most: f64,
    },
    /// The record is too short for a line of it to lie in the band of slow vibration.
    TooShort {
        /// The shortest record.
        least: f64,
    },
}

impl fmt::Display for ResponseRefused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Immobile(why) => why.fmt(f),
            Self::Stopped(why) => why.fmt(f),
            Self::TooLong { most } => {
                write!(f, "a record of this system is at most {most:.6e} long")
            }
            Self::TooShort { least } => {
                write!(f, "a record of this system is at least {least:.6e} long")
            }
        }
    }
}

impl std::error::Error for ResponseRefused {}

/// The settled record of one run.
#[derive(Clone, Debug)]
pub struct SettledRecord {
    /// Where the run ends.
    pub ending: SystemEnding,
    /// Range, mean and deviation of the row: over one period of the orbit, or over the record.
    pub observed: RowMeter,
    /// Time of the first sample after the start.
    pub from: f64,
    /// Step between the samples.
    pub step: f64,
    /// The row at equal steps.
    pub samples: Vec<f64>,
    /// Its rate of change there.
    pub rates: Vec<f64>,
    /// Spectrum of the samples.
    pub spectrum: Spectrum,
    /// M in the band of slow vibration.
    pub lines: LargestLines,
    /// The contacts over one period of the orbit, or over the record.
    pub contacts: Vec<ContactMeans>,
    /// The inputs over one period of the orbit, or over the record.
    pub inputs: Vec<Result<InputCost, NoPower>>,
    /// Largest slip speed of every contact from the start to the end of the record, transient included; 0 where the law has no range that
    /// slip may leave.
    pub largest_slip: Vec<f64>,
    /// Largest magnitude of the row from the start to the end of the record.
    pub largest: f64,
    /// The end of the record.
    pub end: MotionEnd,
}

/// The steady response of a system.
#[derive(Clone, Debug)]
pub struct SteadyResponse {
    /// With dither.
    pub dithered: SettledRecord,
    /// Without dither, from the same start.
    pub undithered: SettledRecord,
    /// M with and without dither.
    pub vibrations: Vibrations,
    /// Upper end of the band of slow vibration, an angular frequency.
    pub band_end: f64,
    /// The effect of the dither.
    pub effect: Effect,
    /// E = M₁/M₀, the residual vibration, or why it is undefined.
    pub residual_vibration: Result<f64, Undefined>,
    /// Friction of every contact in steady sliding without dither, if that exists.
    pub steady_friction: Option<Vec<f64>>,
}

/// The sampling of both records.
#[derive(Clone, Copy, Debug)]
struct RecordGrid {
    step: f64,
    count: usize,
}

/// The settled record without dither, with which responses are compared: those under noise of any seed share it.
#[derive(Clone, Debug)]
pub struct UnditheredResponse<'a> {
    start: &'a MotionStart,
    plan: &'a ResponsePlan,
    /// The system without its dither.
    still: System,
    grid: RecordGrid,
    record: SettledRecord,
    band_end: f64,
}

/// Integrates a system from a start with and without its dither, and measures both.
///
/// # Errors
/// [`ResponseRefused`].
pub fn respond(
    system: &System,
    start: &MotionStart,
    plan: &ResponsePlan,
) -> Result<SteadyResponse, ResponseRefused> {
    UnditheredResponse::new(system, start, plan)?.with_dither(system)
}

impl SteadyResponse {
    /// Largest slip speed of a contact in both runs, 0 where its law has no range.
    pub fn largest_slip(&self, contact: usize) -> f64 {
        self.dithered.largest_slip[contact].max(self.undithered.largest_slip[contact])
    }
}

impl<'a> UnditheredResponse<'a> {
    /// Integrates a system from a start without its dither; the record and its band fit the dither.
    ///
    /// # Errors
    /// [`ResponseRefused`].
    pub fn new(
        system: &System,
        start: &'a MotionStart,
        plan: &'a ResponsePlan,
    ) -> Result<Self, ResponseRefused> {
        let still = system.undithered();
        let motion = Motion::new(system).map_err(ResponseRefused::Immobile)?;
        let without = Motion::new(&still).map_err(ResponseRefused::Immobile)?;
        let grid = RecordGrid::of(&motion, plan)?;
        let mut record = record(&without, start, plan, grid).map_err(ResponseRefused::Stopped)?;
        let band_end = grid.band_end(system, plan, &record)?;
        record.measure_lines(&without, band_end);
        Ok(Self { start, plan, still, grid, record, band_end })
    }

    /// Its record.
    pub fn record(&self) -> &SettledRecord {
        &self.record
    }

    /// Upper end of the band of slow vibration, an angular frequency.
    pub fn band_end(&self) -> f64 {
        self.band_end
    }

    /// Integrates the system with its dither, and compares.
    ///
    /// # Errors
    /// [`ResponseRefused`].
    pub fn with_dither(&self, system: &System) -> Result<SteadyResponse, ResponseRefused> {
        let (undithered, band_end) = (self.record.clone(), self.band_end);
        let has_dither = system.is_dithered();
        let dithered = if has_dither {
            let motion = Motion::new(system).map_err(ResponseRefused::Immobile)?;
            let mut dithered = record(&motion, self.start, self.plan, self.grid)
                .map_err(ResponseRefused::Stopped)?;
            dithered.measure_lines(&motion, band_end);
            dithered
        } else {
            undithered.clone()
        };
        let scale = dithered.largest.max(undithered.largest);
        let [with, without] =
            [&dithered, &undithered].map(|record| RecordLines { lines: record.lines, scale });
        let vibrates = self.vibrates(without);
        let vibrations = Vibrations {
            dithered: with,
            undithered: without,
            quiet_without: vibrates == Err(Undefined::UnditheredSettles),
            quiet_with: with.decays(),
        };
        let effect = match vibrates {
            _ if !has_dither => Effect::Unknown(Uncertain::NoDither),
            Err(why) if why.is_unknown() => Effect::Unknown(Uncertain::Undithered(why)),
            _ if dithered.ending == SystemEnding::Drift => Effect::Unknown(Uncertain::Drifts),
            Ok(()) if dithered.ending.is_faster_than(band_end) => Effect::Quenches,
            Err(_) if dithered.ending.is_faster_than(band_end) => Effect::Quiet,
            _ => vibrations.effect(),
        };
        let steady = SteadySliding::new(&self.still).ok();
        Ok(SteadyResponse {
            residual_vibration: vibrates.map(|()| with.whole() / without.whole()),
            band_end,
            steady_friction: steady
                .map(|steady| steady.contacts.iter().map(|contact| contact.friction).collect()),
            dithered,
            undithered,
            vibrations,
            effect,
        })
    }

    /// Whether the run keeps vibrating; its lines are compared with the largest motion of both runs.
    fn vibrates(&self, lines: RecordLines) -> Result<(), Undefined> {
        let ending = &self.record.ending;
        if ending.period().is_some() {
            Ok(())
        } else if *ending == SystemEnding::UnstableSliding {
            Err(Undefined::UnditheredUnstable)
        } else if *ending == SystemEnding::Drift {
            Err(Undefined::UnditheredDrifts)
        } else if ending.is_rest() || lines.is_negligible() || lines.whole() == 0.0 {
            Err(Undefined::UnditheredSettles)
        } else if lines.is_steady() || cannot_settle(&self.still) {
            Ok(())
        } else {
            Err(Undefined::UnditheredUnknown)
        }
    }
}

impl RecordGrid {
    /// For a system with its dither.
    fn of(motion: &Motion<'_>, plan: &ResponsePlan) -> Result<Self, ResponseRefused> {
        let system = motion.system();
        let slow = vibration_frequency(system).map_or(f64::INFINITY, |rate| TAU / rate);
        let own = TAU * motion.time_scale() / SAMPLES_PER_PERIOD;
        let own = own.min(slow / SAMPLES_PER_SLOW_PERIOD);
        let fastest = system.waves().map(Wave::highest).fold(0.0, f64::max);
        let longest = own.min(TAU / (SAMPLES_PER_DITHER_PERIOD * fastest));
        let wanted = (plan.length / longest).max(LEAST_SAMPLES);
        if wanted > MOST_SAMPLES {
            return Err(ResponseRefused::TooLong { most: longest * MOST_SAMPLES });
        }
        // A small number times a power of two keeps the factors of a transform small.
        let unit = libm::exp2(libm::log2(wanted / LEAST_SAMPLES).floor() + 1.0);
        let count = (wanted / unit).ceil() * unit;
        let step = plan.length / count;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
        let count = count as usize;
        Ok(Self { step, count })
    }

    /// Upper end of the band of slow vibration: below the lowest dither frequency, or 1.9 times the frequency of the vibration where
    /// a dither is not faster than that, reduced to end below faster dithers.
    fn band_end(
        &self,
        system: &System,
        plan: &ResponsePlan,
        undithered: &SettledRecord,
    ) -> Result<f64, ResponseRefused> {
        let line = TAU / plan.length;
        let reach = WINDOW_REACH * line;
        let lowest = || {
            let acting = system.waves().filter(|wave| wave.amplitude != 0.0);
            acting.map(Wave::lowest)
        };
        // Above the Nyquist frequency there are no lines.
        let nyquist = 0.5 * TAU / self.step;
        if let Some(mass) = system.one_averaged_mass() {
            let [end, least] = [BAND_END, LEAST_BAND_END].map(|end| end * mass.rate());
            let above = lowest().filter(|f| *f > end).map(|f| f - reach).filter(|f| *f >= least);
            let end = above.fold(end, f64::min);
            return if line < end {
                Ok(end)
            } else {
                Err(ResponseRefused::TooShort { least: TAU / end })
            };
        }
        let slowest = lowest().fold(f64::INFINITY, f64::min);
        let below_dither = (slowest - reach).min(nyquist);
        let vibration = undithered.strongest_line().or_else(|| vibration_frequency(system));
        let end_of_band = vibration.map(|frequency| BAND_END * frequency);
        let end = match end_of_band.filter(|end| slowest <= *end) {
            None => below_dither,
            Some(end) => {
                let above = lowest().filter(|f| *f > end);
                above.map(|f| f - reach).fold(end.min(nyquist), f64::min)
            }
        };
        if end <= 2.0 * line {
            let least = (WINDOW_REACH + 2.0) * TAU / slowest;
            return Err(ResponseRefused::TooShort { least });
        }
        Ok(end)
    }
}

impl SettledRecord {
    /// Frequency of the largest line, if there is a vibration.
    fn strongest_line(&self) -> Option<f64> {
        if self.ending.is_rest() {
            return None;
        }
        let lines = self.spectrum.frequencies().zip(self.spectrum.amplitudes()).skip(1);
        let largest = lines.max_by(|a, b| a.1.total_cmp(b.1));
        largest.filter(|(_, amplitude)| **amplitude > 0.0).map(|(frequency, _)| frequency)
    }

    /// Measures M in the band of slow vibration.
    fn measure_lines(&mut self, motion: &Motion<'_>, band_end: f64) {
        self.lines = lines_of(&self.samples, motion.system(), self.step, band_end);
        if self.ending.period().is_some() {
            // The halves of a periodic motion differ by where the window cuts it.
            self.lines.halves = [self.lines.whole; 2];
        }
    }
}

/// Settles a run and measures its record, without its lines, whose band depends on the undithered record.
fn record(
    motion: &Motion<'_>,
    start: &MotionStart,
    plan: &ResponsePlan,
    grid: RecordGrid,
) -> Result<SettledRecord, MotionStopped> {
    let tolerance = motion.run_tolerance(plan.tolerance);
    let system = motion.system();
    let has_range = |contact: &Contact| contact.friction.range().is_some();
    let watched = if system.contacts.iter().any(has_range) { system.contacts.len() } else { 0 };
    let mut slip = ContactMeter::new(watched);
    let mut transient = RowMeter::new(&plan.row, start.time, grid.step, 0);
    let settled = start.time + plan.settle;
    let end = motion.run(start, settled, tolerance, &mut (&mut slip, &mut transient))?;
    let ending = SystemEnding::of(system, &plan.row, start, &end);
    let from = ending.record_from(motion, tolerance, &end)?;
    let times: Vec<f64> =
        (0..grid.count).map(|number| f64::mul_add(number as f64, grid.step, from.time)).collect();
    let mut sampler = ReadingSampler::new(&plan.row, 0, &times);
    let mut meters = RunMeters::new(motion, &plan.row);
    let mut observer = ((&mut slip, &mut meters), &mut sampler);
    let end = motion.run(&from, from.time + plan.length, tolerance, &mut observer)?;
    let ReadingSampler { values: samples, rates, .. } = sampler;
    let largest = transient.largest().max(meters.row.largest());
    if let Some(period) = ending.period() {
        meters = RunMeters::new(motion, &plan.row);
        motion.run(&from, from.time + period, tolerance, &mut meters)?;
    }
    let spectrum = spectrum_of(&samples, grid.step);
    let ending = ending.with_record(&samples);
    Ok(SettledRecord {
        ending,
        contacts: meters.contacts.means().unwrap_or_default(),
        inputs: meters.inputs.costs().unwrap_or_default(),
        largest,
        from: settled,
        step: grid.step,
        observed: meters.row,
        samples,
        rates,
        spectrum,
        lines: LargestLines { whole: 0.0, halves: [0.0; 2] },
        largest_slip: (0..system.contacts.len())
            .map(|contact| if contact < watched { slip.largest_slip(contact) } else { 0.0 })
            .collect(),
        end,
    })
}

/// What is measured over a period or a record.
struct RunMeters<'s> {
    contacts: ContactMeter,
    inputs: InputMeter<'s>,
    row: RowMeter,
}

impl<'s> RunMeters<'s> {
    fn new(motion: &Motion<'s>, row: &[f64]) -> Self {
        let system = motion.system();
        Self {
            contacts: ContactMeter::new(system.contacts.len()),
            inputs: InputMeter::new(system),
            row: RowMeter::new(row, 0.0, 0.0, 0),
        }
    }
}

impl MotionObserver for RunMeters<'_> {
    fn segment(&mut self, segment: &MotionSegment<'_>) {
        self.contacts.segment(segment);
        self.inputs.segment(segment);
        self.row.segment(segment);
    }
}
