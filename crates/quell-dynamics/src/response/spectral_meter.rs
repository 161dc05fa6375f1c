//! The spectral measurements of a record while integrating: its largest low line, and its lines at the
//! frequencies of the dither. Samples of x at equal steps are summed as they arrive; none is stored.

use std::f64::consts::TAU;

use quell_model::Belt;
use quell_numerics::elementary::sin_cos_of_phase;
use quell_numerics::spectrum::low_band::{LargestLines, LowBand};

use super::dither_lines::{self, LineGroup};
use super::solver::Solver;
use crate::band::BAND_END;
use crate::simulation::Segment;

/// Samples per period of the fastest dither, at least: its seventh harmonic stays below
/// the Nyquist frequency.
const SAMPLES_PER_DITHER_PERIOD: f64 = 16.0;

/// Samples per slow period, at least.
const SAMPLES_PER_SLOW_PERIOD: f64 = 128.0;

/// Cells per slow period in which the low band is sampled: the band ends below a quarter of
/// their Nyquist frequency, 4.
const CELLS_PER_SLOW_PERIOD: usize = 8;

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
pub fn samples_per_slow_period(belt: &Belt) -> f64 {
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
    /// The tones of the dithers, in the order of their groups; none where they are not measured.
    tones: Vec<Tone>,
    groups: Result<Vec<LineGroup>, &'static str>,
}

/// Sums of a record under the Hann window at one frequency.
#[derive(Clone, Copy, Debug, Default)]
struct Tone {
    frequency: f64,
    weight: f64,
    /// Σ w x, Σ w x cos, Σ w x sin.
    sample: [f64; 3],
    /// Σ w cos, Σ w sin.
    window: [f64; 2],
}

impl SpectralMeter {
    /// For a record of `belt`; with the lines of the dither only if `with_tones`.
    pub(super) fn new(belt: &Belt, sampling: Sampling, with_tones: bool) -> Self {
        let record_periods =
            u32::try_from(sampling.count / sampling.per_slow_period).unwrap_or(u32::MAX);
        let groups =
            if with_tones { dither_lines::groups(belt, record_periods) } else { Ok(Vec::new()) };
        let frequencies = groups.iter().flatten().flat_map(|group| group.frequencies.clone());
        let tone = |frequency| Tone { frequency, ..Tone::default() };
        let decimation = sampling.per_slow_period / CELLS_PER_SLOW_PERIOD;
        Self {
            sampling,
            band: LowBand::new(sampling.count, sampling.step, decimation),
            band_end: band_end(belt, sampling),
            tones: frequencies.map(tone).collect(),
            groups,
        }
    }

    /// M of the record and of its halves.
    pub(super) fn largest_lines(&self) -> LargestLines {
        self.band.largest_lines(self.band_end)
    }

    /// Peak-to-peak displacement in the lines of the tangential dithers, of those with different periods the sum; `None` where these
    /// lines are unknown.
    pub(super) fn stroke(&self) -> Option<f64> {
        let mut tones = self.tones.iter();
        let groups = self.groups.as_ref().ok()?;
        let strokes = groups.iter().map(|group| {
            let lines: Vec<_> =
                tones.by_ref().take(group.frequencies.len()).map(Tone::line).collect();
            dither_lines::peak_to_peak(group.repetition, &lines)
        });
        Some(strokes.sum())
    }

    /// Adds the missing samples at the end: the last sample may round to just after it.
    pub(super) fn finish(&mut self, displacement: f64) {
        while self.band.missing() > 0 {
            self.add_sample(displacement);
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
                self.add_sample(displacement);
            }
            if inside < ABREAST {
                return;
            }
        }
    }

    #[inline(always)]
    fn add_sample(&mut self, displacement: f64) {
        let number = (self.sampling.count - self.band.missing()) as f64;
        self.band.push(displacement);
        for tone in &mut self.tones {
            tone.add_sample(displacement, number, &self.sampling);
        }
    }
}

/// Least upper end of the band, in ω₀: self-excited vibration is at about the natural frequency, 1. If the band ended lower, a
/// vibration outside it would be reported as quenched.
const LEAST_BAND_END: f64 = 1.5;

/// The upper end of the band of slow vibration, reduced where the window would spread the line of a dither just above it into the
/// band: by two lines of the unpadded half of a record. A record too short to separate both keeps the whole band, including
/// that line.
fn band_end(belt: &Belt, sampling: Sampling) -> f64 {
    let reach = 4.0 * sampling.per_slow_period as f64 / sampling.count as f64;
    let above = belt
        .dithers()
        .iter()
        .filter(|dither| dither.amplitude > 0.0 && dither.repetition_ratio() > BAND_END);
    let ends = above.map(|dither| dither.repetition_ratio() - reach);
    ends.filter(|end| *end >= LEAST_BAND_END).fold(BAND_END, f64::min)
}

impl Tone {
    #[inline(always)]
    fn add_sample(&mut self, displacement: f64, number: f64, sampling: &Sampling) {
        let (sine, _) = sin_cos_of_phase(0.5 * TAU / sampling.count as f64, number, 0.0, 0.0);
        let weight = sine * sine;
        let (sine, cosine) = sin_cos_of_phase(self.frequency * sampling.step, number, 0.0, 0.0);
        let value = weight * displacement;
        self.weight += weight;
        self.sample[0] += value;
        self.sample[1] = value.mul_add(cosine, self.sample[1]);
        self.sample[2] = value.mul_add(sine, self.sample[2]);
        self.window[0] = weight.mul_add(cosine, self.window[0]);
        self.window[1] = weight.mul_add(sine, self.window[1]);
    }

    /// Its frequency and its two spectral amplitudes, of cosine and sine, the weighted mean removed.
    fn line(&self) -> [f64; 3] {
        let mean = self.sample[0] / self.weight;
        let cosine = self.sample[1] - mean * self.window[0];
        let sine = self.sample[2] - mean * self.window[1];
        [self.frequency, 2.0 * cosine / self.weight, 2.0 * sine / self.weight]
    }
}
