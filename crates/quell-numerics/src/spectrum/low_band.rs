//! Largest spectral line at low frequencies, without storing the samples.
//!
//! Computes the low-frequency part of [`super::Spectrum`] for a record and for its two halves, with memory for a
//! few numbers per slow period instead of the record, and with the same bits on every machine.
//!
//! Scheme: samples are distributed over coarse cells by the p-fold running mean of m samples (p = [`FOLDS`]), whose response
//! [sin(mθ/2)/(m sin(θ/2))]^p at θ = ωh is divided out afterwards. Lines at ω alias with
//! |2πk/(mh) ± ω|, whose components are suppressed by the same factor: for ω up to a quarter of the coarse
//! Nyquist frequency, to 3·10⁻⁹ of their amplitude. The sum over the cells
//! at one line is a polynomial in its phasor (Horner's rule, several lines in SIMD lanes). The rectangular transforms
//! of the halves are combined to that of the whole record; the Hann window is applied to the lines,
//! ½X_j − ¼(X_{j−q} + X_{j+q}) with q lines per unpadded bin; the weighted mean is removed last.
//!
//! Reference: E. B. Hogenauer, *IEEE Trans. ASSP* 29 (1981) 155–162 (cascaded running means).

use core::f64::consts::PI;

use super::ZERO_PADDING;
use crate::dispatch::{InstructionSet, LaneWork, with_lanes};
use crate::elementary::sin_cos_of_phase;
use crate::lane::{Lane, MOST_LANES};

/// Number of running means.
pub const FOLDS: usize = 16;

/// Accumulates the samples of one record with an even number of samples.
#[derive(Clone, Debug)]
pub struct LowBand {
    samples: usize,
    decimation: usize,
    step: f64,
    /// Weights of a sample in the [`FOLDS`] cells to which it contributes, for each position in its cell.
    weights: Vec<[f64; FOLDS]>,
    taken: usize,
    /// Cells of the two halves of the record.
    halves: [Vec<f64>; 2],
}

/// Largest lines of a record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LargestLines {
    /// Spectral amplitude of the largest line of the whole record.
    pub whole: f64,
    /// The same of its first and second half.
    pub halves: [f64; 2],
}

impl LowBand {
    /// An accumulator for `samples` samples at equal time steps `step`, in cells of `decimation` samples. Half the record
    /// should be an integer number of cells; otherwise the number is rounded up.
    pub fn new(samples: usize, step: f64, decimation: usize) -> Self {
        let decimation = decimation.max(1);
        let cells = (samples / 2).div_ceil(decimation) + FOLDS;
        Self {
            samples: samples / 2 * 2,
            decimation,
            step,
            weights: weights(decimation),
            taken: 0,
            halves: [vec![0.0; cells], vec![0.0; cells]],
        }
    }

    /// Number of samples still to come.
    pub fn missing(&self) -> usize {
        self.samples - self.taken
    }

    /// Adds the next sample; samples after the last one are ignored.
    #[inline(always)]
    pub fn push(&mut self, sample: f64) {
        if self.taken == self.samples {
            return;
        }
        let half = self.samples / 2;
        let (cells, position) = if self.taken < half {
            (&mut self.halves[0], self.taken)
        } else {
            (&mut self.halves[1], self.taken - half)
        };
        let weights = &self.weights[position % self.decimation];
        let first = position / self.decimation;
        for (cell, weight) in cells[first..first + FOLDS].iter_mut().zip(weights) {
            *cell = weight.mul_add(sample, *cell);
        }
        self.taken += 1;
    }

    /// Largest lines at 0 < ω ≤ `high`, where `high` must not exceed a quarter of the Nyquist frequency of the cells.
    pub fn largest_lines(&self, high: f64) -> LargestLines {
        let spacing = 2.0 * PI / ((ZERO_PADDING * self.samples) as f64 * self.step);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
        let lines = (high / spacing * (1.0 + 1e-12)).floor() as usize;
        // A half has bins twice as wide: its window reaches two unpadded bins of the whole.
        let reach = 2 * ZERO_PADDING;
        let count = lines + reach + 1;
        let first = self.transform(&self.halves[0], spacing, count);
        let second = self.transform(&self.halves[1], spacing, count);
        let half = self.samples / 2;
        let rectangle = self.rectangle(half, spacing, count);
        let largest =
            |x: &Transform, flat: &Transform, samples: usize, bin: usize, every: usize| {
                let mean = x.windowed(0, bin).0 / flat.windowed(0, bin).0;
                (1..=lines)
                    .filter(|line| line.is_multiple_of(every))
                    .map(|line| {
                        let (x, flat) = (x.windowed(line, bin), flat.windowed(line, bin));
                        libm::hypot(x.0 - mean * flat.0, x.1 - mean * flat.1)
                    })
                    .fold(0.0, f64::max)
                    * 4.0
                    / samples as f64
            };
        let delay = half as f64 * self.step * spacing;
        let whole = first.plus_delayed(&second, delay);
        let flat = rectangle.plus_delayed(&rectangle, delay);
        LargestLines {
            whole: largest(&whole, &flat, self.samples, ZERO_PADDING, 1),
            halves: [&first, &second].map(|x| largest(x, &rectangle, half, reach, 2)),
        }
    }

    /// Rectangular transform Σ xₙe^{−iωnh} at `count` lines.
    fn transform(&self, cells: &[f64], spacing: f64, count: usize) -> Transform {
        let mut sums = with_lanes(
            InstructionSet::widest(),
            PhasorSums { cells, spacing, count, cell: self.cell() },
        );
        for line in 0..count {
            let theta = line as f64 * spacing * self.step;
            let response = response(theta, self.decimation) / self.decimation as f64;
            // The centre of the kernel of a cell, in samples after the cell.
            let (folds, m) = (FOLDS as f64, self.decimation as f64);
            let shift = 0.5 * folds * (m - 1.0) - m + folds;
            let (sine, cosine) = sin_cos_of_phase(theta, shift, 0.0, 0.0);
            let (re, im) = (sums.re[line], sums.im[line]);
            sums.re[line] = (re * cosine - im * sine) / response;
            sums.im[line] = (re * sine + im * cosine) / response;
        }
        sums
    }

    /// Duration of a cell.
    fn cell(&self) -> f64 {
        self.decimation as f64 * self.step
    }

    /// Transform of a constant record of `samples` ones.
    fn rectangle(&self, samples: usize, spacing: f64, count: usize) -> Transform {
        let (re, im) = (0..count)
            .map(|line| {
                let half = 0.5 * line as f64 * spacing * self.step;
                if line == 0 {
                    return (samples as f64, 0.0);
                }
                let size = libm::sin(half * samples as f64) / libm::sin(half);
                let phase = half * (samples as f64 - 1.0);
                (size * libm::cos(phase), -size * libm::sin(phase))
            })
            .unzip();
        Transform { re, im }
    }
}

/// Weights of the p-fold running mean of m samples: [position in the cell][cell].
fn weights(decimation: usize) -> Vec<[f64; FOLDS]> {
    let m = decimation;
    let mut kernel = vec![1.0];
    for _ in 0..FOLDS {
        kernel = running_mean(&kernel, m);
    }
    // A sample at position r of cell c lies m·(p − 1 − i) + r samples after the start of the kernel of
    // cell c + i.
    let at = |position: usize, i: usize| kernel.get(m * (FOLDS - 1 - i) + position).copied();
    (0..m).map(|r| core::array::from_fn(|i| at(r, i).unwrap_or(0.0))).collect()
}

/// Running means of m neighbours, with zero padding on both sides.
///
/// A window overlaps two blocks of m numbers: its sum is the sum from its start to the end of the first block plus the sum from
/// the start of the second block. All terms have one sign, so there is no cancellation as in differences of cumulative sums.
fn running_mean(values: &[f64], m: usize) -> Vec<f64> {
    let windows = values.len() + m - 1;
    let mut to_end = vec![0.0; windows + m - 1];
    to_end[m - 1..windows].copy_from_slice(values);
    let mut from_start = to_end.clone();
    for k in 1..from_start.len() {
        if !k.is_multiple_of(m) {
            from_start[k] += from_start[k - 1];
        }
    }
    for k in (1..to_end.len()).rev() {
        if !k.is_multiple_of(m) {
            to_end[k - 1] += to_end[k];
        }
    }
    let sum = |k: usize| {
        let first = if k.is_multiple_of(m) { 0.0 } else { to_end[k] };
        first + from_start[k + m - 1]
    };
    (0..windows).map(|k| sum(k) / m as f64).collect()
}

/// [sin(mθ/2)/(m sin(θ/2))]^p.
fn response(theta: f64, decimation: usize) -> f64 {
    if theta == 0.0 {
        return 1.0;
    }
    let m = decimation as f64;
    let mean = libm::sin(0.5 * m * theta) / (m * libm::sin(0.5 * theta));
    let mut power = mean;
    for _ in 0..FOLDS.ilog2() {
        power *= power;
    }
    power
}

const _: () = assert!(FOLDS.is_power_of_two(), "the response is squared repeatedly");

/// Complex numbers at equal steps of frequency from 0.
#[derive(Clone, Debug)]
struct Transform {
    re: Vec<f64>,
    im: Vec<f64>,
}

impl Transform {
    /// ½X_j − ¼(X_{j−q} + X_{j+q}); X at negative frequencies is the conjugate.
    fn windowed(&self, line: usize, bin: usize) -> (f64, f64) {
        let (after, before) = (line + bin, line.abs_diff(bin));
        let sign = if line >= bin { 1.0 } else { -1.0 };
        let re = 0.5 * self.re[line] - 0.25 * (self.re[after] + self.re[before]);
        let im = 0.5 * self.im[line] - 0.25 * (self.im[after] + sign * self.im[before]);
        (re, im)
    }

    /// The sum of this transform and of `other` delayed in time; `delay` is the delay multiplied by the spacing.
    fn plus_delayed(&self, other: &Self, delay: f64) -> Self {
        let (re, im) = (0..self.re.len())
            .map(|line| {
                let (sine, cosine) = sin_cos_of_phase(delay, line as f64, 0.0, 0.0);
                let (re, im) = (other.re[line], other.im[line]);
                (self.re[line] + re * cosine + im * sine, self.im[line] + im * cosine - re * sine)
            })
            .unzip();
        Self { re, im }
    }
}

/// Σ y_c e^{−iωcH} at several lines ω in SIMD lanes.
struct PhasorSums<'a> {
    cells: &'a [f64],
    spacing: f64,
    count: usize,
    cell: f64,
}

impl LaneWork for PhasorSums<'_> {
    type Output = Transform;

    #[inline(always)]
    fn run<V: Lane>(self) -> Transform {
        let padded = self.count.next_multiple_of(MOST_LANES);
        let mut sums = Transform { re: vec![0.0; padded], im: vec![0.0; padded] };
        for first in (0..padded).step_by(V::LANES) {
            let mut numbers = [0.0; MOST_LANES];
            for (lane, number) in numbers.iter_mut().enumerate() {
                *number = (first + lane) as f64;
            }
            let line = V::load(&numbers);
            let turn = V::splat(self.spacing * self.cell);
            let (sine, cosine) = sin_cos_of_phase(turn, line, V::splat(0.0), V::splat(0.0));
            let (mut re, mut im) = (V::splat(0.0), V::splat(0.0));
            for &cell in self.cells.iter().rev() {
                // z e^{−iωH} + y.
                let real = re.mul_add(cosine, im.mul_add(sine, V::splat(cell)));
                im = im.mul_add(cosine, -(re * sine));
                re = real;
            }
            re.store(&mut sums.re[first..]);
            im.store(&mut sums.im[first..]);
        }
        sums.re.truncate(self.count);
        sums.im.truncate(self.count);
        sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::Spectrum;

    /// Twelve slow periods 2π of 160 samples: a mean, slow tones, a drift and tones of high frequency,
    /// some of them where coarse cells would alias them into the band.
    fn record() -> (Vec<f64>, f64) {
        let step = 2.0 * PI / 160.0;
        let samples = (0..12 * 160)
            .map(|n| {
                let t = f64::from(n) * step;
                0.31 + 0.12 * (0.654 * t + 0.3).cos()
                    + 0.02 * (1.41 * t).sin()
                    + 1e-3 * t
                    + 0.05 * (10.0 * t).cos()
                    + 0.03 * (7.1 * t).sin()
                    + 0.01 * (8.9 * t).sin()
                    + 0.02 * (30.0 * t).cos()
            })
            .collect();
        (samples, step)
    }

    #[test]
    fn largest_lines_agree_with_the_spectrum_of_the_record() {
        let (samples, step) = record();
        let mut band = LowBand::new(samples.len(), step, 20);
        for &sample in &samples {
            band.push(sample);
        }
        let lines = band.largest_lines(1.9);
        let of = |samples: &[f64]| {
            let spectrum = Spectrum::of(samples, step).expect("a record");
            spectrum.largest_line(0.0, 1.9).expect("a line").amplitude
        };
        let (first, second) = samples.split_at(samples.len() / 2);
        assert!((lines.whole - of(&samples)).abs() < 1e-9, "{lines:?}, {}", of(&samples));
        assert!((lines.halves[0] - of(first)).abs() < 1e-9, "{lines:?}, {}", of(first));
        assert!((lines.halves[1] - of(second)).abs() < 1e-9, "{lines:?}, {}", of(second));
        assert!(lines.whole > 0.1);
    }

    #[test]
    fn running_means_agree_with_direct_sums() {
        let values: Vec<f64> = (0..37).map(|k| f64::from(k * k % 11)).collect();
        for m in [1, 2, 5, 36, 37, 50] {
            let found = running_mean(&values, m);
            assert_eq!(found.len(), values.len() + m - 1);
            for (k, mean) in found.iter().enumerate() {
                // Sums of integers are exact in any order.
                let window = (k + 1).saturating_sub(m)..=k.min(values.len() - 1);
                assert_eq!(*mean, values[window].iter().sum::<f64>() / m as f64, "{m} {k}");
            }
        }
    }

    #[test]
    fn a_constant_has_no_line() {
        let mut band = LowBand::new(640, 0.1, 8);
        while band.missing() > 0 {
            band.push(3.0);
        }
        let lines = band.largest_lines(0.5);
        assert!(lines.whole < 1e-13 && lines.halves.iter().all(|&half| half < 1e-13), "{lines:?}");
    }
}
