//! Dither waveforms g over the phase θ, of zero mean.
//!
//! A waveform is analytic between its breaks (kinks and jumps); the engine makes each break a time event. G is the zero-mean
//! integral of g. For the sine, the triangle and the square it is even (the dissertation's text after (3.25) calls it odd, but
//! τ₂ = 2π − τ₁ there requires it to be even), g is antiperiodic and G_max = −G_min. Other waveforms need not have any symmetry,
//! so that averages extend over the whole period, and the sign of the dither matters.
//!
//! | file | content |
//! |---|---|
//! | `sine`, `triangle`, `square` | the waveforms of the dissertation, as constants |
//! | `fourier` | a sum of harmonics |
//! | `samples` | one period by samples, joined by straight lines or held |
//! | `burst` | whole periods of a carrier, and a pause |
//! | `noise` | equal lines at irregular frequencies of a band; the one waveform without a period |
//! | `coefficients` | Fourier coefficients of all of them, in closed form |
//! | `shape`, `table` | breaks, pieces and averages: of constants, and computed from pieces |

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use quell_numerics::interval::RealInterval;

mod burst;
mod coefficients;
mod fourier;
mod noise;
mod samples;
mod shape;
mod sine;
mod square;
mod table;
mod triangle;

pub use burst::Burst;
pub use fourier::{FourierWave, Harmonic};
pub use noise::{FEWEST_GAUSSIAN_LINES, LARGEST_SEED, MOST_LINES, Noise, NoiseLine};
pub use samples::{Hold, SampledWave};
pub use shape::Piece;

use shape::Shape;
use table::WaveTable;

/// A dither waveform. It is cheap to clone.
///
/// ```
/// use quell_model::Waveform;
/// use quell_model::waveform::{Burst, FourierWave, Harmonic, Hold, SampledWave};
///
/// // A square wave by two samples that are held.
/// let held = Waveform::Samples(SampledWave::new(vec![1.0, -1.0], Hold::Zero)?.into());
/// assert_eq!(held.integral(1.0), Waveform::Square.integral(1.0));
/// // Eight periods of a sine, and a pause of 24.
/// let burst = Burst::new(Waveform::Sine, 8, 24)?;
/// assert_eq!(burst.cycles(), 32);
/// # Ok::<(), quell_model::waveform::WaveformError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Waveform {
    /// g = sin θ, eq. (2.1).
    Sine,
    /// Triangle, eq. (3.5).
    Triangle,
    /// Square, eq. (3.6).
    Square,
    /// A sum of harmonics.
    Fourier(Arc<FourierWave>),
    /// One period by samples.
    Samples(Arc<SampledWave>),
    /// Periods of a carrier and a pause.
    Burst(Arc<Burst>),
    /// Lines in a band of frequencies. The phase is that of the middle of the band.
    Noise(Arc<Noise>),
}

/// One sine of a waveform: a sin(mθ + φ).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WaveSine {
    /// Frequency m as a multiple of the waveform's.
    pub multiple: f64,
    /// Amplitude a.
    pub amplitude: f64,
    /// Phase φ, radians.
    pub phase: f64,
}

/// Why numbers make no waveform.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WaveformError {
    /// The key of a study file that is wrong: `harmonics`, `values`, `on`, `off`, `carrier`, `band`, `lines` or `seed`.
    pub key: &'static str,
    /// What is allowed.
    pub allowed: String,
}

impl std::fmt::Display for WaveformError {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "{} must be {}", self.key, self.allowed)
    }
}

impl std::error::Error for WaveformError {}

/// Names in a study file of the waveforms that take further keys.
pub const FOURIER: &str = "fourier";
/// See [`FOURIER`].
pub const SAMPLES: &str = "samples";
/// See [`FOURIER`].
pub const BURST: &str = "burst";
/// See [`FOURIER`].
pub const NOISE: &str = "noise";

impl Waveform {
    /// The waveforms without numbers of their own.
    pub const NAMED: &'static [Self] = &[Self::Sine, Self::Triangle, Self::Square];

    /// The names of all waveforms in a study file.
    pub const NAMES: &'static [&'static str] =
        &["sine", "triangle", "square", FOURIER, SAMPLES, BURST, NOISE];

    /// The constants of a waveform without numbers of its own.
    fn shape(&self) -> Option<&'static Shape> {
        match self {
            Self::Sine => Some(&sine::SHAPE),
            Self::Triangle => Some(&triangle::SHAPE),
            Self::Square => Some(&square::SHAPE),
            Self::Fourier(_) | Self::Samples(_) | Self::Burst(_) | Self::Noise(_) => None,
        }
    }

    /// The table of a waveform by pieces.
    fn table(&self) -> Option<&WaveTable> {
        match self {
            Self::Samples(samples) => Some(samples.table()),
            Self::Burst(burst) => Some(burst.table()),
            _ => None,
        }
    }

    /// Name in a study file.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Fourier(_) => FOURIER,
            Self::Samples(_) => SAMPLES,
            Self::Burst(_) => BURST,
            Self::Noise(_) => NOISE,
            _ => self.shape().map_or("", |shape| shape.name),
        }
    }

    /// The waveform of a name that takes no further keys.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::NAMED.iter().find(|waveform| waveform.name() == name).cloned()
    }

    /// Number of cycles 2π of the phase in one period: more than one for bursts.
    pub fn cycles(&self) -> u32 {
        match self {
            Self::Burst(burst) => burst.cycles(),
            _ => 1,
        }
    }

    /// The period, radians of the phase. Noise has none ([`Waveform::is_periodic`]): the value is the cycle of the middle of its band.
    pub fn period(&self) -> f64 {
        TAU * f64::from(self.cycles())
    }

    /// Whether it repeats: every waveform but noise.
    pub fn is_periodic(&self) -> bool {
        self.noise().is_none()
    }

    /// The lines of a noise.
    pub fn noise(&self) -> Option<&Noise> {
        match self {
            Self::Noise(noise) => Some(noise),
            _ => None,
        }
    }

    /// The same waveform in which the seed of noise is greater by a number; beyond the largest seed it continues from 0.
    #[must_use]
    pub fn reseeded(&self, by: u64) -> Self {
        let reseeded = self.noise().and_then(|noise| {
            let seed = noise.seed().wrapping_add(by) % (LARGEST_SEED + 1);
            noise.reseeded(seed).ok()
        });
        reseeded.map_or_else(|| self.clone(), |noise| Self::Noise(noise.into()))
    }

    /// Whether G is even and antiperiodic, as for the waveforms of the dissertation: it is known from a quarter of its period.
    pub fn is_symmetric(&self) -> bool {
        self.shape().is_some()
    }

    /// g(θ). At a jump the value after it.
    pub fn value(&self, phase: f64) -> f64 {
        match self {
            Self::Fourier(series) => return series.value(phase),
            Self::Noise(noise) => return noise.value(phase),
            _ => {}
        }
        let phase = self.wrapped(phase);
        match self.piece_at(phase) {
            (_, Piece::Harmonic) => libm::sin(phase),
            (start, Piece::Affine { value, slope }) => value + slope * self.wrapped(phase - start),
        }
    }

    /// g′(θ), per radian. At a kink the slope after it; a jump has none.
    pub fn slope(&self, phase: f64) -> f64 {
        match self {
            Self::Fourier(series) => return series.slope(phase),
            Self::Noise(noise) => return noise.slope(phase),
            _ => {}
        }
        let phase = self.wrapped(phase);
        match self.piece_at(phase) {
            (_, Piece::Harmonic) => libm::cos(phase),
            (_, Piece::Affine { slope, .. }) => slope,
        }
    }

    /// G(θ), the zero-mean integral of g.
    pub fn integral(&self, phase: f64) -> f64 {
        match (self, self.shape(), self.table()) {
            (Self::Fourier(series), ..) => series.integral(phase),
            (Self::Noise(noise), ..) => noise.integral(phase),
            (_, Some(shape), _) => (shape.integral)(self.wrapped(phase)),
            (_, _, Some(table)) => table.integral(self.wrapped(phase)),
            _ => 0.0,
        }
    }

    /// Least and largest value of G: ∓1, ∓π/4, ∓π/2 for the waveforms of the dissertation; of noise four standard deviations.
    pub fn integral_range(&self) -> RealInterval {
        match self {
            Self::Fourier(series) => series.integral_range(),
            Self::Noise(noise) => {
                RealInterval::new(-noise.reach_of_integral(), noise.reach_of_integral())
            }
            _ => match (self.shape(), self.table()) {
                (Some(shape), _) => RealInterval::new(-shape.peak_integral, shape.peak_integral),
                (_, Some(table)) => table.integral_range(),
                _ => RealInterval::point(0.0),
            },
        }
    }

    /// max |G|: 1, π/4, π/2.
    pub fn peak_integral(&self) -> f64 {
        let range = self.integral_range();
        range.upper.max(-range.lower)
    }

    /// ⟨G²⟩: 1/2, π²/30, π²/12.
    pub fn mean_square_integral(&self) -> f64 {
        match self {
            Self::Fourier(series) => series.mean_square_integral(),
            Self::Noise(noise) => noise.mean_square_integral(),
            _ => match (self.shape(), self.table()) {
                (Some(shape), _) => shape.mean_square_integral,
                (_, Some(table)) => table.mean_square_integral(),
                _ => 0.0,
            },
        }
    }

    /// √⟨g²⟩: 1/√2, 1/√3, 1.
    pub fn root_mean_square(&self) -> f64 {
        match self {
            Self::Fourier(series) => series.root_mean_square(),
            Self::Noise(_) => std::f64::consts::FRAC_1_SQRT_2,
            _ => match (self.shape(), self.table()) {
                (Some(shape), _) => shape.root_mean_square,
                (_, Some(table)) => table.root_mean_square(),
                _ => 0.0,
            },
        }
    }

    /// Least and largest value of g: ∓1 for the waveforms of the dissertation; of noise bounds, where all lines are in phase.
    pub fn range(&self) -> RealInterval {
        match self {
            Self::Fourier(series) => series.range(),
            Self::Noise(noise) => RealInterval::new(-noise.bound(), noise.bound()),
            _ => self.table().map_or(RealInterval::new(-1.0, 1.0), WaveTable::range),
        }
    }

    /// max |g|.
    pub fn peak(&self) -> f64 {
        let range = self.range();
        range.upper.max(-range.lower)
    }

    /// Fourier coefficient b_n of sin nθ of a waveform of the dissertation, which is odd and antiperiodic, so that all others
    /// vanish; `None` for other waveforms.
    pub fn sine_coefficient(&self, harmonic: u32) -> Option<f64> {
        let odd = !harmonic.is_multiple_of(2);
        let n = f64::from(harmonic);
        let value = match self {
            Self::Sine => f64::from(u8::from(harmonic == 1)),
            Self::Square => 4.0 / (PI * n),
            Self::Triangle => {
                let sign = if harmonic % 4 == 1 { 1.0 } else { -1.0 };
                8.0 * sign / (PI * n * PI * n)
            }
            _ => return None,
        };
        Some(if odd { value } else { 0.0 })
    }

    /// Whether the waveform is constant between its jumps: a square wave, held samples, bursts of squares.
    pub fn is_piecewise_constant(&self) -> bool {
        let pieces = self.pieces();
        let constant = |piece: &Piece| matches!(piece, Piece::Affine { slope: 0.0, .. });
        !pieces.is_empty() && pieces.iter().all(constant)
    }

    /// The analytic piece at a phase, that after it at a break; `None` for a sum of harmonics, which is analytic everywhere.
    pub fn piece_after(&self, phase: f64) -> Option<Piece> {
        let has_pieces = !self.pieces().is_empty();
        has_pieces.then(|| self.piece_at(self.wrapped(phase)).1)
    }

    /// Phases of kinks and jumps within a period, ascending from 0.
    pub fn breaks(&self) -> &[f64] {
        match self {
            Self::Sine | Self::Fourier(_) | Self::Noise(_) => &[],
            Self::Triangle => triangle::SHAPE.breaks,
            Self::Square => square::SHAPE.breaks,
            Self::Samples(samples) => samples.table().breaks(),
            Self::Burst(burst) => burst.table().breaks(),
        }
    }

    /// The pieces: `pieces()[i]` follows `breaks()[i]`; a single piece if there are no breaks, and none for a sum of sines.
    pub fn pieces(&self) -> &[Piece] {
        match self {
            Self::Sine => sine::SHAPE.pieces,
            Self::Triangle => triangle::SHAPE.pieces,
            Self::Square => square::SHAPE.pieces,
            Self::Fourier(_) | Self::Noise(_) => &[],
            Self::Samples(samples) => samples.table().pieces(),
            Self::Burst(burst) => burst.table().pieces(),
        }
    }

    /// The highest order of a sum of harmonics; 1 for other waveforms.
    pub fn highest_order(&self) -> u32 {
        self.harmonics().and_then(<[Harmonic]>::last).map_or(1, |harmonic| harmonic.order)
    }

    /// The highest frequency in it, as a multiple of its own.
    pub fn highest_multiple(&self) -> f64 {
        let last = self.noise().and_then(|noise| noise.lines().last());
        last.map_or_else(|| f64::from(self.highest_order()), |line| line.ratio)
    }

    /// The lowest frequency of noise, that of its first line, as a multiple of that of the middle of its band; 1 of others.
    pub fn lowest_multiple(&self) -> f64 {
        self.noise().and_then(|noise| noise.lines().first()).map_or(1.0, |line| line.ratio)
    }

    /// The sines of which it is the sum, where it is given by them.
    pub fn sines(&self) -> Option<Vec<WaveSine>> {
        let of_harmonic = |harmonic: &Harmonic| WaveSine {
            multiple: f64::from(harmonic.order),
            amplitude: harmonic.amplitude(),
            phase: harmonic.phase(),
        };
        match self {
            Self::Fourier(series) => Some(series.harmonics().iter().map(of_harmonic).collect()),
            Self::Noise(noise) => {
                let amplitude = noise.line_amplitude();
                let sine = |line: &NoiseLine| {
                    let NoiseLine { ratio, phase } = *line;
                    WaveSine { multiple: ratio, amplitude, phase }
                };
                Some(noise.lines().iter().map(sine).collect())
            }
            _ => None,
        }
    }

    /// Whether it is given as a sum of sines ([`Waveform::sines`]).
    pub fn is_sum_of_sines(&self) -> bool {
        matches!(self, Self::Fourier(_) | Self::Noise(_))
    }

    /// −g, where it is a waveform: bursts and noise have none.
    pub fn negated(&self) -> Option<Self> {
        match self {
            Self::Fourier(series) => Some(Self::Fourier(series.negated().into())),
            Self::Samples(samples) => Some(Self::Samples(samples.negated().into())),
            Self::Sine | Self::Triangle | Self::Square | Self::Burst(_) | Self::Noise(_) => None,
        }
    }

    /// The harmonics of a sum.
    pub fn harmonics(&self) -> Option<&[Harmonic]> {
        match self {
            Self::Fourier(series) => Some(series.harmonics()),
            _ => None,
        }
    }

    /// The piece at a phase within the period, with the phase of the break that opens it; of a waveform that has pieces.
    pub fn piece_at(&self, phase: f64) -> (f64, Piece) {
        let (breaks, pieces) = (self.breaks(), self.pieces());
        let after = breaks.partition_point(|&start| start <= phase);
        let index = (after + pieces.len() - 1) % pieces.len();
        (breaks.get(index).copied().unwrap_or(0.0), pieces[index])
    }

    /// θ modulo the period.
    fn wrapped(&self, phase: f64) -> f64 {
        let period = self.period();
        let rest = phase.rem_euclid(period);
        if rest == period { 0.0 } else { rest }
    }
}
