//! A measured receptance: displacement over force between points, over frequency.

use num_complex::Complex64;
use quell_numerics::polar::modulus;

/// Measured frequencies that an interpolation takes: a rational function through six values has room for a lightly damped resonance
/// among them, and for the smooth rest of the structure.
const STENCIL: usize = 6;

/// Displacement at one point over force at another, for every pair that was measured, over a band that begins at 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Receptance {
    frequencies: Vec<f64>,
    points: usize,
    /// Series of (output, input) at `output * points + input`; `None` if not measured.
    series: Vec<Option<Vec<Complex64>>>,
}

impl Receptance {
    /// From ascending angular frequencies, the first of them 0, and the number of points; series are added one by one.
    ///
    /// # Panics
    /// Without at least two frequencies.
    pub fn new(frequencies: Vec<f64>, points: usize) -> Self {
        assert!(frequencies.len() > 1, "a static value and at least one frequency");
        Self { frequencies, points, series: vec![None; points * points] }
    }

    /// The same with the response at `output` to a force at `input`.
    ///
    /// # Panics
    /// If there are not as many values as frequencies.
    #[must_use]
    pub fn with(mut self, output: usize, input: usize, values: Vec<Complex64>) -> Self {
        assert_eq!(values.len(), self.frequencies.len(), "one value for each frequency");
        self.series[output * self.points + input] = Some(values);
        self
    }

    /// Angular frequencies.
    pub fn frequencies(&self) -> &[f64] {
        &self.frequencies
    }

    /// The same with every second frequency, and the last one: what is computed from it differs by more than the error of
    /// interpolation between all of them.
    #[must_use]
    pub fn every_second(&self) -> Self {
        let last = self.frequencies.len() - 1;
        let kept: Vec<usize> = (0..=last).filter(|k| k % 2 == 0 || *k == last).collect();
        let thinned = |values: &Vec<Complex64>| kept.iter().map(|k| values[*k]).collect();
        Self {
            frequencies: kept.iter().map(|k| self.frequencies[*k]).collect(),
            points: self.points,
            series: self.series.iter().map(|series| series.as_ref().map(thinned)).collect(),
        }
    }

    /// outᵀ H in at a frequency inside the band, between measured frequencies by a rational function; pairs that were not measured
    /// count as zero.
    pub(super) fn between(&self, out: &[f64], into: &[f64], frequency: f64) -> Complex64 {
        let last = self.frequencies.len() - 1;
        let after = self.frequencies.partition_point(|known| *known < frequency).clamp(1, last);
        let mut sum = Complex64::ZERO;
        for (o, &left) in out.iter().enumerate().filter(|(_, left)| **left != 0.0) {
            for (i, &right) in into.iter().enumerate().filter(|(_, right)| **right != 0.0) {
                let Some(values) = &self.series[o * self.points + i] else { continue };
                sum += interpolated(&self.frequencies, values, after, frequency) * (left * right);
            }
        }
        sum
    }
}

/// The value at a frequency between `after − 1` and `after`, by the rational function through the nearest [`STENCIL`] values. Where that
/// through fewer of them is as far from it as the straight line is, as noise makes it, the straight line.
fn interpolated(frequencies: &[f64], values: &[Complex64], after: usize, at: f64) -> Complex64 {
    let (low, high) = (frequencies[after - 1], frequencies[after]);
    if at >= high {
        return values[after];
    }
    if at <= low {
        return values[after - 1];
    }
    let share = (at - low) / (high - low);
    let line = values[after - 1] * (1.0 - share) + values[after] * share;
    let through = |count: usize| {
        let first = after.saturating_sub(count / 2).min(frequencies.len().saturating_sub(count));
        let end = (first + count).min(frequencies.len());
        rational(&frequencies[first..end], &values[first..end], at)
    };
    match (through(STENCIL), through(STENCIL - 2)) {
        (Some(value), Some(fewer)) if modulus(value - fewer) < modulus(value - line) => value,
        _ => line,
    }
}

/// The diagonal rational function through some values (J. Stoer and R. Bulirsch, *Introduction to Numerical Analysis*, section 2.2.3);
/// `None` where it has a pole at `at`.
fn rational(frequencies: &[f64], values: &[Complex64], at: f64) -> Option<Complex64> {
    let count = frequencies.len();
    let mut from_left = values.to_vec();
    let mut from_right = values.to_vec();
    let mut sum = values[0];
    for order in 1..count {
        for i in 0..count - order {
            let difference = from_left[i + 1] - from_right[i];
            if difference == Complex64::ZERO {
                (from_left[i], from_right[i]) = (Complex64::ZERO, Complex64::ZERO);
                continue;
            }
            let scaled = from_right[i] * ((at - frequencies[i]) / (at - frequencies[i + order]));
            let denominator = scaled - from_left[i + 1];
            if denominator == Complex64::ZERO {
                return None;
            }
            let factor = difference / denominator;
            from_right[i] = from_left[i + 1] * factor;
            from_left[i] = scaled * factor;
        }
        sum += from_left[0];
    }
    sum.is_finite().then_some(sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A resonance between two of seven coarse frequencies on a smooth background: exact where a straight line is off by half.
    #[test]
    fn a_resonance_between_two_frequencies() {
        let exact = |frequency: f64| {
            let pole = Complex64::new(2.0_f64.powi(2) - frequency * frequency, 0.08 * frequency);
            pole.inv() + 0.3
        };
        let frequencies: Vec<f64> = (0..30).map(|k| 0.13 * f64::from(k)).collect();
        let values: Vec<Complex64> = frequencies.iter().map(|at| exact(*at)).collect();
        let receptance = Receptance::new(frequencies.clone(), 1).with(0, 0, values.clone());
        for at in [0.07, 0.9, 1.9, 1.99, 2.05, 3.0, 3.7] {
            let error = (receptance.between(&[1.0], &[1.0], at) - exact(at)).norm();
            assert!(error < 1e-9 * exact(at).norm(), "{at}: {error:e}");
        }
        assert_eq!(receptance.between(&[1.0], &[1.0], frequencies[7]), values[7]);
        let coarse = receptance.every_second();
        assert_eq!(coarse.frequencies()[1], frequencies[2]);
        assert_eq!(coarse.frequencies().last(), frequencies.last());
    }

    #[test]
    fn constant_and_noisy_values() {
        let frequencies: Vec<f64> = (0..9).map(f64::from).collect();
        let flat = vec![Complex64::new(0.5, 0.0); 9];
        assert_eq!(interpolated(&frequencies, &flat, 4, 3.3), flat[0]);
        let noisy: Vec<Complex64> =
            [1.0, 1.02, 0.99, 1.01, 0.98, 1.0, 1.03, 0.97, 1.0].map(Complex64::from).to_vec();
        let value = interpolated(&frequencies, &noisy, 4, 3.5).re;
        assert!((0.9..1.1).contains(&value), "{value}");
    }
}
