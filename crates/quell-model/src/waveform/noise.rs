//! Noise in a band: equal lines at irregular frequencies with random phases.
//!
//! g(θ) = n^{−1/2} Σ sin(ρᵢθ + φᵢ), where the phase θ is that of the middle of the band, ρᵢ is the frequency of line i over that of
//! the middle, and √⟨g²⟩ = 1/√2, as for a sine. The band is divided into n equal cells, and each has one line at a random position:
//! the spectrum is flat on the scale of a cell, and the record does not repeat in any run, because no two differences of
//! frequencies are equal.
//!
//! The random numbers are those of SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", OOPSLA
//! 2014), whose state starts at the seed. For each line in ascending order two numbers are drawn: its position in its cell, and its
//! phase over 2π; each is the upper 53 bits over 2⁵³. The numbers involve integer arithmetic, one sum, products and quotients only,
//! so that a seed has the same lines on every platform. The algorithm is part of the study format and never changes.
//!
//! A sum of many independent lines is nearly Gaussian: its excess kurtosis is −3/(2n).

use std::f64::consts::TAU;

use quell_numerics::random::SplitMix;

use super::WaveformError;

/// Most lines: every line is a wave of its own in each step of a run, and more lines are no closer to a Gaussian process within
/// what a run resolves.
pub const MOST_LINES: u32 = 1000;

/// Largest seed: every whole number up to it is a number of a study file.
pub const LARGEST_SEED: u64 = (1 << 53) - 1;

/// Below this number of lines averages over a Gaussian distribution differ from those over the lines by more than 1 % of the
/// static level: the difference is up to 0.07/n of a jump of friction.
pub const FEWEST_GAUSSIAN_LINES: usize = 8;

/// Standard deviations within which the fast velocity of noise is counted: a Gaussian process is beyond them for 6·10⁻⁵ of the
/// time.
const REACH: f64 = 4.0;

/// One line of a noise: sin(ρθ + φ).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseLine {
    /// Frequency over that of the middle of the band, ρ.
    pub ratio: f64,
    /// Phase φ, radians.
    pub phase: f64,
}

/// Noise in a band of frequencies.
#[derive(Clone, Debug, PartialEq)]
pub struct Noise {
    /// Ends of the band over its middle.
    ends: [f64; 2],
    seed: u64,
    lines: Vec<NoiseLine>,
}

impl Noise {
    /// Noise of `lines` lines between two frequencies, in any unit; only their ratio matters, the dither has the
    /// [middle](Noise::middle) as its frequency.
    ///
    /// # Errors
    /// A band that is not 0 < low < high, no line or more than [`MOST_LINES`], a seed beyond [`LARGEST_SEED`].
    pub fn new(band: [f64; 2], lines: u32, seed: u64) -> Result<Self, WaveformError> {
        let wrong = |key, allowed: String| Err(WaveformError { key, allowed });
        let [low, high] = band;
        if !(low > 0.0 && low < high && high.is_finite()) {
            return wrong("band", "two frequencies [low, high] with 0 < low < high".to_owned());
        }
        if !(1..=MOST_LINES).contains(&lines) {
            return wrong(
                "lines",
                format!(
                    "a whole number from 1 to {MOST_LINES}: every line is a sine of its own in each step of a run"
                ),
            );
        }
        if seed > LARGEST_SEED {
            return wrong("seed", format!("a whole number from 0 to {LARGEST_SEED}"));
        }
        let middle = Self::middle(band);
        let ends = [low / middle, high / middle];
        let mut random = SplitMix::new(seed);
        let cell = (ends[1] - ends[0]) / f64::from(lines);
        let lines = (0..lines).map(|place| {
            let position = f64::from(place) + random.share();
            NoiseLine { ratio: ends[0] + cell * position, phase: TAU * random.share() }
        });
        Ok(Self { ends, seed, lines: lines.collect() })
    }

    /// The middle of a band, the frequency of a dither of noise.
    pub fn middle([low, high]: [f64; 2]) -> f64 {
        low + 0.5 * (high - low)
    }

    /// The same noise with another seed.
    ///
    /// # Errors
    /// A seed beyond [`LARGEST_SEED`].
    pub fn reseeded(&self, seed: u64) -> Result<Self, WaveformError> {
        let lines = u32::try_from(self.lines.len()).unwrap_or(u32::MAX);
        Self::new(self.ends, lines, seed)
    }

    /// The ends of the band of a dither whose frequency is `middle`.
    pub fn band(&self, middle: f64) -> [f64; 2] {
        self.ends.map(|end| end * middle)
    }

    /// The seed.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// The lines in ascending order of frequency.
    pub fn lines(&self) -> &[NoiseLine] {
        &self.lines
    }

    /// Amplitude of each line for an amplitude of 1: n^{−1/2}.
    pub fn line_amplitude(&self) -> f64 {
        1.0 / (self.lines.len() as f64).sqrt()
    }

    /// Whether there are enough lines for averages over a Gaussian distribution ([`FEWEST_GAUSSIAN_LINES`]).
    pub fn is_gaussian(&self) -> bool {
        self.lines.len() >= FEWEST_GAUSSIAN_LINES
    }

    /// ½ Σ (aᵢ wᵢ)²: the mean square of the lines, each with a factor that depends on its frequency over the middle.
    pub fn mean_square(&self, factor: impl Fn(f64) -> f64) -> f64 {
        let squares = self.lines.iter().map(|line| factor(line.ratio) * factor(line.ratio));
        0.5 * squares.sum::<f64>() / self.lines.len() as f64
    }

    fn sum(&self, phase: f64, term: impl Fn(&NoiseLine, f64, f64) -> f64) -> f64 {
        let each = self.lines.iter().map(|line| {
            let angle = line.ratio.mul_add(phase, line.phase);
            term(line, libm::sin(angle), libm::cos(angle))
        });
        self.line_amplitude() * each.sum::<f64>()
    }

    pub(super) fn value(&self, phase: f64) -> f64 {
        self.sum(phase, |_, sine, _| sine)
    }

    pub(super) fn slope(&self, phase: f64) -> f64 {
        self.sum(phase, |line, _, cosine| line.ratio * cosine)
    }

    pub(super) fn integral(&self, phase: f64) -> f64 {
        self.sum(phase, |line, _, cosine| -cosine / line.ratio)
    }

    /// Bound of |g|: √n, where all lines are in phase.
    pub(super) fn bound(&self) -> f64 {
        (self.lines.len() as f64).sqrt()
    }

    /// Largest |G| that counts: four standard deviations, or the sum of all lines where that is less.
    pub(super) fn reach_of_integral(&self) -> f64 {
        let sum: f64 = self.lines.iter().map(|line| 1.0 / line.ratio).sum();
        (self.line_amplitude() * sum).min(REACH * self.mean_square_integral().sqrt())
    }

    pub(super) fn mean_square_integral(&self) -> f64 {
        self.mean_square(|ratio| 1.0 / ratio)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cell_has_a_line() {
        let noise = Noise::new([8.0, 12.0], 64, 1).expect("valid");
        for (place, line) in noise.lines().iter().enumerate() {
            let position = (10.0 * line.ratio - 8.0) / 4.0 * 64.0;
            assert!((place as f64..place as f64 + 1.0).contains(&position), "{place} {position}");
            assert!((0.0..TAU).contains(&line.phase));
        }
        let band = noise.band(10.0);
        assert!((band[0] - 8.0).abs() < 1e-14 && (band[1] - 12.0).abs() < 1e-14);
    }

    #[test]
    fn a_seed_decides_the_record() {
        let of = |seed| Noise::new([8.0, 12.0], 16, seed).expect("valid");
        assert_eq!(of(3), of(3));
        assert_eq!(of(3).reseeded(4).map(|noise| noise.seed()), Ok(4));
        assert_ne!(of(3).lines(), of(4).lines());
        // The bits of the first line of seed 1 are part of the format.
        let first = of(1).lines()[0];
        let (a, b) = {
            let mut random = SplitMix::new(1);
            (random.share(), random.share())
        };
        assert_eq!(first.ratio.to_bits(), (0.8 + (1.2 - 0.8) / 16.0 * a).to_bits());
        assert_eq!(first.phase.to_bits(), (TAU * b).to_bits());
    }

    /// The mean square over a long record is 1/2, and the integral is that of the value.
    #[test]
    fn amplitude_is_the_rms_times_the_root_of_two() {
        let noise = Noise::new([8.0, 12.0], 32, 5).expect("valid");
        let (steps, length) = (400_000, 40_000.0);
        let square = |k: i32| noise.value(length * f64::from(k) / f64::from(steps)).powi(2);
        let mean = (0..steps).map(square).sum::<f64>() / f64::from(steps);
        assert!((mean - 0.5).abs() < 2e-3, "{mean}");
        // Central differences: h²/6 of the third derivative, and the rounding of the phase, ε·234/h.
        for at in [0.3, 17.0, 234.5] {
            let difference = (noise.integral(at + 1e-4) - noise.integral(at - 1e-4)) / 2e-4;
            assert!((difference - noise.value(at)).abs() < 1e-7);
            let difference = (noise.value(at + 1e-4) - noise.value(at - 1e-4)) / 2e-4;
            assert!((difference - noise.slope(at)).abs() < 1e-7);
        }
    }

    #[test]
    fn errors_name_their_key() {
        let key = |band, lines, seed| Noise::new(band, lines, seed).expect_err("wrong").key;
        assert_eq!(key([12.0, 8.0], 64, 1), "band");
        assert_eq!(key([8.0, 8.0], 64, 1), "band");
        assert_eq!(key([0.0, 8.0], 64, 1), "band");
        assert_eq!(key([-8.0, 8.0], 64, 1), "band");
        assert_eq!(key([8.0, f64::NAN], 64, 1), "band");
        assert_eq!(key([8.0, 12.0], 0, 1), "lines");
        assert_eq!(key([8.0, 12.0], 1001, 1), "lines");
        assert_eq!(key([8.0, 12.0], 64, 1 << 53), "seed");
    }
}
