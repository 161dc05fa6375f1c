//! The spectrogram of a run.

use quell_numerics::spectrum::Spectrum;

use super::SampledMotion;

/// Natural periods in a window of the spectrogram.
const PERIODS_PER_WINDOW: f64 = 6.0;

/// Largest numbers of columns and rows of a spectrogram.
const MOST_COLUMNS: usize = 240;
const MOST_ROWS: usize = 160;

/// Spectral amplitude over time and angular frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrogram {
    /// Middles of the windows.
    pub times: Vec<f64>,
    /// Angular frequencies.
    pub frequencies: Vec<f64>,
    /// Amplitudes, row by row: those of the lowest frequency first.
    pub amplitudes: Vec<f64>,
}

impl Spectrogram {
    /// Of a displacement up to an angular frequency; `None` if the run is shorter than a window.
    pub fn of(motion: SampledMotion<'_>, period: f64, highest: f64) -> Option<Self> {
        let SampledMotion { start, step, displacement } = motion;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a count of samples"
        )]
        let length = (PERIODS_PER_WINDOW * period / step).round() as usize;
        if length < 16 || displacement.len() < 2 * length {
            return None;
        }
        let free = displacement.len() - length;
        let hop = (length / 8).max(free / MOST_COLUMNS).max(1);
        let (mut times, mut columns) = (Vec::new(), Vec::new());
        let mut frequencies = Vec::new();
        // Lines of the spectrum in one row; all windows have the same lines.
        let mut each = 1;
        for first in (0..=free).step_by(hop) {
            let spectrum = Spectrum::of(&displacement[first..first + length], step).ok()?;
            if frequencies.is_empty() {
                let shown =
                    spectrum.frequencies().take_while(|frequency| *frequency <= highest).count();
                each = shown.div_ceil(MOST_ROWS).max(1);
                frequencies = (0..shown / each)
                    .map(|row| spectrum.frequency(row * each + each / 2))
                    .collect();
            }
            let rows = spectrum.amplitudes().chunks(each).take(frequencies.len());
            columns.push(
                rows.map(|row| row.iter().fold(0.0, |most: f64, a| most.max(*a)))
                    .collect::<Vec<f64>>(),
            );
            times.push(step.mul_add(first as f64 + 0.5 * length as f64, start));
        }
        let amplitudes = (0..frequencies.len())
            .flat_map(|row| columns.iter().map(move |column| column[row]))
            .collect();
        (times.len() > 1 && frequencies.len() > 1).then_some(Self {
            times,
            frequencies,
            amplitudes,
        })
    }

    /// The largest amplitude.
    pub fn largest(&self) -> f64 {
        self.amplitudes.iter().fold(0.0, |most: f64, a| most.max(*a))
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    const STEP: f64 = 0.02;

    #[test]
    fn a_chirp_moves_through_the_spectrogram() {
        let chirp = |time: f64| (time + 0.005 * time * time).sin();
        let displacement: Vec<f64> =
            (0..15_000).map(|sample| chirp(STEP * f64::from(sample))).collect();
        let found = Spectrogram::of(
            SampledMotion { start: 0.0, step: STEP, displacement: &displacement },
            TAU,
            6.0,
        )
        .expect("a spectrogram");
        let columns = found.times.len();
        for (column, time) in found.times.iter().enumerate() {
            let at = |row: usize| found.amplitudes[row * columns + column];
            let peak = (0..found.frequencies.len())
                .max_by(|a, b| at(*a).total_cmp(&at(*b)))
                .expect("rows");
            let exact = 1.0 + 0.01 * time;
            assert!(
                (found.frequencies[peak] - exact).abs() < 0.12,
                "{time}: {}",
                found.frequencies[peak]
            );
            assert!(at(peak) > 0.7 && at(peak) < 1.05);
        }
    }
}
