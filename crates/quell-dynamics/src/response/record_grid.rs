//! The samples of a record, and the band in which its slow vibration is sought.

use std::f64::consts::TAU;

use quell_model::profile::Wave;
use quell_model::{OneMass, System};

use super::refused::ResponseRefused;
use super::response_plan::ResponsePlan;
use super::spectral_meter::{
    CELLS_PER_SLOW_PERIOD, SAMPLES_PER_DITHER_PERIOD, SAMPLES_PER_SLOW_PERIOD, WINDOW_REACH,
    band_end_of_mass, samples_per_slow_period,
};
use crate::band::{BAND_END, vibration_frequency};
use crate::motion::Motion;

/// Samples per period of the fastest motion of the structure, at least.
const SAMPLES_PER_PERIOD: f64 = 8.0;

/// Largest number of samples of a record: with that of the undithered run and both padded spectra about a gigabyte. With more, a fast dither
/// could exhaust the memory; with fewer, records would have to be shorter.
const MOST_SAMPLES: f64 = 4_194_304.0;

/// Least number of samples of a record: its halves then have lines to compare. A slow structure in a short record takes more samples than it
/// needs, which cost nothing.
const LEAST_SAMPLES: f64 = 256.0;

/// The samples of both records.
#[derive(Clone, Copy, Debug)]
pub(super) struct RecordGrid {
    /// Step between them.
    pub(super) step: f64,
    /// Their number.
    pub(super) count: usize,
    /// Of one mass: the samples of a cell, whose means show the low band.
    pub(super) cell: Option<usize>,
}

impl RecordGrid {
    /// For a system with its dither.
    pub(super) fn of(motion: &Motion<'_>, plan: &ResponsePlan) -> Result<Self, ResponseRefused> {
        let system = motion.system();
        if let Some(mass) = system.one_mass() {
            return Self::of_mass(&mass, plan);
        }
        let slow = vibration_frequency(system).map_or(f64::INFINITY, |rate| TAU / rate);
        let own = TAU * motion.time_scale() / SAMPLES_PER_PERIOD;
        let own = own.min(slow / SAMPLES_PER_SLOW_PERIOD);
        let fastest = system.waves().map(Wave::highest).fold(0.0, f64::max);
        let longest = own.min(TAU / (SAMPLES_PER_DITHER_PERIOD * fastest));
        if plan.length < longest {
            return Err(ResponseRefused::TooShort { least: LEAST_SAMPLES * longest });
        }
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
        Ok(Self { step, count, cell: None })
    }

    /// The samples of a map of belts: a whole number of cells of a slow period.
    pub(super) fn of_mass(mass: &OneMass, plan: &ResponsePlan) -> Result<Self, ResponseRefused> {
        let (per_period, rate) = (samples_per_slow_period(mass.belt()), mass.rate());
        let step = TAU / (rate * per_period);
        if plan.length < step {
            return Err(ResponseRefused::TooShort { least: TAU / (rate * BAND_END) });
        }
        let cell = per_period / CELLS_PER_SLOW_PERIOD as f64;
        // The length may err by rounding.
        let cells = (plan.length / (step * cell) * (1.0 - 1e-12)).ceil().max(1.0);
        let count = cells * cell;
        if count > MOST_SAMPLES {
            return Err(ResponseRefused::TooLong { most: step * MOST_SAMPLES });
        }
        let step = plan.length / count;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "counts")]
        let (count, cell) = (count as usize, Some(cell as usize));
        Ok(Self { step, count, cell })
    }

    /// Upper end of the band of slow vibration of one mass as in maps. With several masses below the lowest dither frequency, or 1.9 times the frequency of the vibration where
    /// a dither is not faster than that, reduced to end below faster dithers; the vibration is the `strongest` line without dither.
    pub(super) fn band_end(
        &self,
        system: &System,
        plan: &ResponsePlan,
        strongest: Option<f64>,
    ) -> Result<f64, ResponseRefused> {
        let line = TAU / plan.length;
        let reach = WINDOW_REACH * line;
        let lowest = || {
            let acting = system.waves().filter(|wave| wave.amplitude != 0.0);
            acting.map(Wave::lowest)
        };
        // Above the Nyquist frequency there are no lines.
        let nyquist = 0.5 * TAU / self.step;
        if let Some(mass) = system.one_mass().or_else(|| system.one_averaged_mass()) {
            let end = mass.rate() * band_end_of_mass(mass.belt(), reach / mass.rate());
            return if line < end {
                Ok(end)
            } else {
                Err(ResponseRefused::TooShort { least: TAU / end })
            };
        }
        let slowest = lowest().fold(f64::INFINITY, f64::min);
        let below_dither = (slowest - reach).min(nyquist);
        let vibration = strongest.or_else(|| vibration_frequency(system));
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
