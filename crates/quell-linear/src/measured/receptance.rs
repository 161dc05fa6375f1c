//! A measured receptance: displacement over force between points, over frequency.

use num_complex::Complex64;

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

    /// outᵀ H in at a frequency inside the band, between measured frequencies on a straight line; pairs that were not measured
    /// count as zero.
    pub(super) fn between(&self, out: &[f64], into: &[f64], frequency: f64) -> Complex64 {
        let last = self.frequencies.len() - 1;
        let after = self.frequencies.partition_point(|known| *known < frequency).clamp(1, last);
        let (low, high) = (self.frequencies[after - 1], self.frequencies[after]);
        let share = ((frequency - low) / (high - low)).clamp(0.0, 1.0);
        let mut sum = Complex64::ZERO;
        for (o, &left) in out.iter().enumerate().filter(|(_, left)| **left != 0.0) {
            for (i, &right) in into.iter().enumerate().filter(|(_, right)| **right != 0.0) {
                let Some(values) = &self.series[o * self.points + i] else { continue };
                let value = values[after - 1] * (1.0 - share) + values[after] * share;
                sum += value * (left * right);
            }
        }
        sum
    }
}
