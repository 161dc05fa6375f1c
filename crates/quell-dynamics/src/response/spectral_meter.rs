//! The largest low line of a record, measured while integrating. Samples of x at equal steps are summed as they arrive; none is stored.

use std::f64::consts::TAU;

use quell_model::Belt;
use quell_numerics::spectrum::low_band::{LargestLines, LowBand};

use super::solver::Solver;
use crate::band::{BAND_END, LEAST_BAND_END};
use crate::simulation::Segment;

/// Samples per period of the fastest dither, at least: its seventh harmonic stays below
/// the Nyquist frequency.
pub(super) const SAMPLES_PER_DITHER_PERIOD: f64 = 16.0;

/// Samples per slow period, at least: only harmonics from the 126th on fold back into the band.
pub(super) const SAMPLES_PER_SLOW_PERIOD: f64 = 128.0;

/// Lines of the unpadded record, or of its halves, between the line of a dither and the end of the band: the window spreads a
/// tone over two on each side.
pub(super) const WINDOW_REACH: f64 = 4.0;

/// Cells per slow period in which the low band is sampled: the band ends below a quarter of
/// their Nyquist frequency, 4.
pub(super) const CELLS_PER_SLOW_PERIOD: usize = 8;

/// Number of samples whose displacements are evaluated at once.
const ABREAST: usize = 4;

/// The samples of a record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sampling {
    /// Time of the first sample.
    pub(super) from: f64,
    /// Step between them.
    pub(super) step: f64,
    /// Number per slow period; a multiple of 32 keeps the factors of a transform small.
    pub(super) per_slow_period: usize,
    /// Total number.
    pub(super) count: usize,
}

/// Number of samples of the displacement of a belt per 2π, a whole number.
pub(super) fn samples_per_slow_period(belt: &Belt) -> f64 {
    let fastest = belt
        .dithers()
        .iter()
        .filter(|dither| dither.amplitude > 0.0)
        .fold(0.0_f64, |rate, dither| rate.max(dither.resolved_ratio()));
    let wanted = SAMPLES_PER_SLOW_PERIOD.max(SAMPLES_PER_DITHER_PERIOD * fastest);
    (wanted / 32.0).ceil() * 32.0
}

impl Sampling {
    /// The samples of a record of `belt` that starts at `from`.
    pub(super) fn of(belt: &Belt, from: f64, solver: &Solver) -> Self {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a count of samples"
        )]
        let per_slow_period = samples_per_slow_period(belt) as usize;
        Self {
            from,
            step: TAU / per_slow_period as f64,
            per_slow_period,
            count: per_slow_period * solver.record_periods as usize,
        }
    }

    /// End of the record.
    pub(super) fn end(&self) -> f64 {
        self.from + self.count as f64 * self.step
    }
}

/// Measures the spectral lines of a record.
#[derive(Clone, Debug)]
pub(super) struct SpectralMeter {
    sampling: Sampling,
    band: LowBand,
    /// Upper end of the band that is searched for lines.
    band_end: f64,
}

impl SpectralMeter {
    /// For a record of `belt`.
    pub(super) fn new(belt: &Belt, sampling: Sampling) -> Self {
        let decimation = sampling.per_slow_period / CELLS_PER_SLOW_PERIOD;
        Self {
            sampling,
            band: LowBand::new(sampling.count, sampling.step, decimation),
            band_end: band_end_of_mass(
                belt,
                WINDOW_REACH * sampling.per_slow_period as f64 / sampling.count as f64,
            ),
        }
    }

    /// M of the record and of its halves.
    pub(super) fn largest_lines(&self) -> LargestLines {
        self.band.largest_lines(self.band_end)
    }

    /// Adds the missing samples at the end: the last sample may round to just after it.
    pub(super) fn finish(&mut self, displacement: f64) {
        while self.band.missing() > 0 {
            self.band.push(displacement);
        }
    }

    /// Adds the samples of one segment. To be called on the machine's best instruction set.
    #[inline(always)]
    pub(super) fn add_segment(&mut self, segment: &Segment<'_>) {
        let Sampling { from, step, count, .. } = self.sampling;
        loop {
            let next = count - self.band.missing();
            let mut since = [0.0; ABREAST];
            let mut inside = 0;
            for (offset, since) in since.iter_mut().enumerate() {
                // A sample at the very start of a run may round to just before it.
                *since =
                    segment.clock().until(((next + offset) as f64).mul_add(step, from)).max(0.0);
                if next + offset < count && *since <= segment.duration() {
                    inside = offset + 1;
                }
            }
            for &displacement in &segment.displacements_at(&since)[..inside] {
                self.band.push(displacement);
            }
            if inside < ABREAST {
                return;
            }
        }
    }
}

/// The upper end of the band of slow vibration, in ω₀, reduced where the window would spread the line of a dither just above it into the
/// band: by `reach`, two lines of the unpadded half of a record. A record too short to separate both keeps the whole band, including
/// that line.
pub(super) fn band_end_of_mass(belt: &Belt, reach: f64) -> f64 {
    let above = belt
        .dithers()
        .iter()
        .filter(|dither| dither.amplitude > 0.0 && dither.repetition_ratio() > BAND_END);
    let ends = above.map(|dither| dither.repetition_ratio() - reach);
    ends.filter(|end| *end >= LEAST_BAND_END).fold(BAND_END, f64::min)
}
