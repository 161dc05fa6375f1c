//! Fourier coefficients of a waveform, in closed form from its pieces.
//!
//! With k = n/c, n the harmonic of the period 2πc, integration by parts gives for each piece from θ_a to θ_b
//!
//! ```text
//! ∫ g e^{−ikθ} dθ = [−g e^{−ikθ}/(ik) − g′ e^{−ikθ}/(ik)²]        g a straight line
//!                 = (e^{−ikθ_a} − e^{−ikθ_b})/(1 − k²)             g = sin θ over whole cycles; −i(θ_b − θ_a)/2 for k = 1
//! ```
//!
//! The cycles of a burst differ by a factor e^{−2πik} each, whose sum is a geometric series.

use std::f64::consts::{PI, TAU};

use super::shape::Piece;
use super::{Burst, Waveform};

impl Waveform {
    /// Fourier coefficients [a, b] of the harmonic n ≥ 1 of the period: g = Σ a_n cos(nθ/c) + b_n sin(nθ/c), c the cycles of a
    /// period. Noise has no period, and zero coefficients. Only those of bursts are counted from a frequency below that of the waveform.
    ///
    /// ```
    /// use quell_model::Waveform;
    /// use quell_model::waveform::{Hold, SampledWave};
    ///
    /// let held = Waveform::Samples(SampledWave::new(vec![1.0, -1.0], Hold::Zero)?.into());
    /// let [cosine, sine] = held.fourier_coefficient(3);
    /// assert!(cosine.abs() < 1e-15);
    /// assert!((sine - 4.0 / (3.0 * std::f64::consts::PI)).abs() < 1e-15);
    /// # Ok::<(), quell_model::waveform::WaveformError>(())
    /// ```
    pub fn fourier_coefficient(&self, harmonic: u32) -> [f64; 2] {
        let whole = match self {
            Self::Sine | Self::Triangle | Self::Square => {
                return [0.0, self.sine_coefficient(harmonic).unwrap_or(0.0)];
            }
            Self::Fourier(series) => {
                let known = series.harmonics().iter().find(|known| known.order == harmonic);
                return known.map_or([0.0; 2], |known| [known.cosine, known.sine]);
            }
            // Its lines are at no harmonics.
            Self::Noise(_) => return [0.0; 2],
            Self::Samples(_) => transform(self.breaks(), self.pieces(), TAU, f64::from(harmonic)),
            Self::Burst(burst) => of_burst(burst, self.breaks(), self.pieces(), harmonic),
        };
        let [real, imaginary] = whole;
        let period = self.period();
        [2.0 * real / period, -2.0 * imaginary / period]
    }
}

/// ∫ g e^{−ikθ} dθ of a burst over its period, its real and its imaginary part.
fn of_burst(burst: &Burst, breaks: &[f64], pieces: &[Piece], harmonic: u32) -> [f64; 2] {
    let (cycles, on) = (u64::from(burst.cycles()), u64::from(burst.on()));
    let k = f64::from(harmonic) / cycles as f64;
    let in_first = breaks.partition_point(|start| *start < TAU);
    let [real, imaginary] = transform(&breaks[..in_first], &pieces[..in_first], TAU, k);
    // Σ_j e^{−2πikj} over the cycles of a burst, its angles reduced as whole numbers.
    let harmonic = u64::from(harmonic);
    if harmonic.is_multiple_of(cycles) {
        return [on as f64 * real, on as f64 * imaginary];
    }
    let angle = |count: u64| PI * ((harmonic * count) % (2 * cycles)) as f64 / cycles as f64;
    let size = libm::sin(angle(on)) / libm::sin(angle(1));
    let (sine, cosine) = libm::sincos(angle(on - 1));
    let (along, across) = (size * cosine, -size * sine);
    [along * real - across * imaginary, along * imaginary + across * real]
}

/// ∫ g e^{−ikθ} dθ, its real and its imaginary part, over pieces that begin at `breaks`, the last of which ends at `end`.
fn transform(breaks: &[f64], pieces: &[Piece], end: f64, k: f64) -> [f64; 2] {
    let ends = breaks.iter().skip(1).copied().chain([end]);
    let (mut real, mut imaginary) = (0.0, 0.0);
    for ((start, piece), end) in breaks.iter().zip(pieces).zip(ends) {
        let (first_sine, first_cosine) = libm::sincos(k * start);
        let (last_sine, last_cosine) = libm::sincos(k * end);
        // e^{−ikθ} = cos kθ − i sin kθ.
        let (along, across) = (first_cosine - last_cosine, last_sine - first_sine);
        match *piece {
            Piece::Harmonic if k == 1.0 => imaginary -= 0.5 * (end - start),
            Piece::Harmonic => {
                real += along / (1.0 - k * k);
                imaginary += across / (1.0 - k * k);
            }
            Piece::Affine { value, slope } => {
                let last = slope.mul_add(end - start, value);
                // (g_a e_a − g_b e_b)/(ik): divided by i, the parts are exchanged.
                let jump_along = value * first_cosine - last * last_cosine;
                let jump_across = last * last_sine - value * first_sine;
                real += jump_across / k - slope * along / (k * k);
                imaginary -= jump_along / k + slope * across / (k * k);
            }
        }
    }
    [real, imaginary]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::waveform::{FourierWave, Harmonic, Hold, SampledWave};

    /// Every kind of piece, with and without pauses.
    fn waves() -> Vec<Waveform> {
        let sampled = |hold| {
            let values = vec![0.3, 1.0, -0.4, 0.9, -2.0];
            Waveform::Samples(SampledWave::new(values, hold).expect("valid").into())
        };
        let burst = |carrier, on, off| Burst::new(carrier, on, off).expect("valid").into_waveform();
        let harmonics = vec![
            Harmonic { order: 1, sine: 1.0, cosine: 0.0 },
            Harmonic { order: 3, sine: 0.2, cosine: -0.1 },
        ];
        let series = FourierWave::new(harmonics).expect("valid");
        let mut all = Waveform::NAMED.to_vec();
        all.extend([sampled(Hold::Linear), sampled(Hold::Zero), Waveform::Fourier(series.into())]);
        for carrier in Waveform::NAMED {
            all.extend([(1, 1), (3, 2), (2, 6)].map(|(on, off)| burst(carrier.clone(), on, off)));
        }
        all
    }

    /// The midpoint rule between breaks, which it does not pass, against the closed forms.
    #[test]
    fn coefficients_are_the_integrals() {
        for wave in waves() {
            let period = wave.period();
            let mut cuts: Vec<f64> = wave.breaks().to_vec();
            cuts.extend([0.0, period]);
            cuts.sort_by(f64::total_cmp);
            for harmonic in [1u32, 2, 3, 4, 5, 7, 8, 13] {
                let k = f64::from(harmonic) / f64::from(wave.cycles());
                let mut found = [0.0; 2];
                for part in cuts.windows(2) {
                    const STEPS: u32 = 4000;
                    let step = (part[1] - part[0]) / f64::from(STEPS);
                    for i in 0..STEPS {
                        let at = part[0] + step * (f64::from(i) + 0.5);
                        let value = 2.0 * step * wave.value(at) / period;
                        found[0] += value * (k * at).cos();
                        found[1] += value * (k * at).sin();
                    }
                }
                let exact = wave.fourier_coefficient(harmonic);
                for (found, exact) in found.into_iter().zip(exact) {
                    assert!((found - exact).abs() < 3e-6, "{wave:?} {harmonic}: {found} {exact}");
                }
            }
        }
    }

    /// Parseval: ⟨g²⟩ is half the sum of all squares. The tails fall as 1/n² at jumps, else as 1/n⁴.
    #[test]
    fn squares_sum_to_the_mean_square() {
        for wave in waves() {
            let count = 400 * wave.cycles();
            let sum: f64 = (1..=count)
                .map(|n| wave.fourier_coefficient(n).map(|part| part * part).iter().sum::<f64>())
                .sum();
            let square = wave.root_mean_square().powi(2);
            let gap = square - 0.5 * sum;
            assert!(gap > -1e-13 && gap < 0.01 * square, "{wave:?}: {gap}");
        }
    }

    #[test]
    fn a_waveform_is_the_sum_of_its_harmonics() {
        for wave in waves().into_iter().filter(|wave| wave.peak() < 1.5 && wave.cycles() > 1) {
            let sum = |phase: f64| {
                let cycles = f64::from(wave.cycles());
                let term = |n: u32| {
                    let [cosine, sine] = wave.fourier_coefficient(n);
                    let at = f64::from(n) * phase / cycles;
                    cosine * at.cos() + sine * at.sin()
                };
                (1..=4000).map(term).sum::<f64>()
            };
            for phase in [0.7, 2.0, 4.0, TAU + 1.0] {
                let gap = (sum(phase) - wave.value(phase)).abs();
                assert!(gap < 5e-3, "{wave:?} {phase}: {gap}");
            }
        }
    }
}
