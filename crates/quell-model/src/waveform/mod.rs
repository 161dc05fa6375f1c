//! Dither waveforms g: zero mean, unit amplitude, 2π-periodic, odd.
//!
//! A waveform is one file with a `Shape` and one line in the list below. It is analytic between its
//! breaks (kinks and jumps); the engine makes each break a time event. G is
//! the zero-mean integral of g (even; the dissertation's text after (3.25) calls it odd,
//! but τ₂ = 2π − τ₁ there requires it to be even).

use std::f64::consts::{PI, TAU};

mod shape;
mod sine;
mod square;
mod triangle;

pub use shape::Piece;
use shape::Shape;

/// A dither waveform.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Waveform {
    /// g = sin θ, eq. (2.1).
    Sine,
    /// Triangle, eq. (3.5).
    Triangle,
    /// Square, eq. (3.6).
    Square,
}

impl Waveform {
    /// Every waveform.
    pub const ALL: &'static [Self] = &[Self::Sine, Self::Triangle, Self::Square];

    fn shape(self) -> &'static Shape {
        match self {
            Self::Sine => &sine::SHAPE,
            Self::Triangle => &triangle::SHAPE,
            Self::Square => &square::SHAPE,
        }
    }

    /// Name in a study file.
    pub fn name(self) -> &'static str {
        self.shape().name
    }

    /// The waveform of a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|waveform| waveform.name() == name)
    }

    /// g(θ). At a jump the value after it.
    pub fn value(self, phase: f64) -> f64 {
        let phase = wrapped(phase);
        match self.piece_at(phase) {
            (_, Piece::Harmonic) => libm::sin(phase),
            (start, Piece::Affine { value, slope }) => value + slope * wrapped(phase - start),
        }
    }

    /// g′(θ), per radian. At a kink the slope after it; a jump has none.
    pub fn slope(self, phase: f64) -> f64 {
        let phase = wrapped(phase);
        match self.piece_at(phase) {
            (_, Piece::Harmonic) => libm::cos(phase),
            (_, Piece::Affine { slope, .. }) => slope,
        }
    }

    /// G(θ), the zero-mean integral of g.
    pub fn integral(self, phase: f64) -> f64 {
        (self.shape().integral)(wrapped(phase))
    }

    /// G_max: 1, π/4, π/2.
    pub fn peak_integral(self) -> f64 {
        self.shape().peak_integral
    }

    /// ⟨G²⟩: 1/2, π²/30, π²/12.
    pub fn mean_square_integral(self) -> f64 {
        self.shape().mean_square_integral
    }

    /// √⟨g²⟩: 1/√2, 1/√3, 1.
    pub fn root_mean_square(self) -> f64 {
        self.shape().root_mean_square
    }

    /// Fourier coefficient b_n of sin nθ; g is odd and antiperiodic, so that all others vanish.
    pub fn sine_coefficient(self, harmonic: u32) -> f64 {
        if harmonic.is_multiple_of(2) {
            return 0.0;
        }
        let n = f64::from(harmonic);
        match self {
            Self::Sine => f64::from(u8::from(harmonic == 1)),
            Self::Square => 4.0 / (PI * n),
            Self::Triangle => {
                let sign = if harmonic % 4 == 1 { 1.0 } else { -1.0 };
                8.0 * sign / (PI * n * PI * n)
            }
        }
    }

    /// Phases of kinks and jumps in [0, 2π), ascending.
    pub fn breaks(self) -> &'static [f64] {
        self.shape().breaks
    }

    /// The pieces: `pieces()[i]` follows `breaks()[i]`; a single piece if there are no breaks.
    pub fn pieces(self) -> &'static [Piece] {
        self.shape().pieces
    }

    /// The piece at a phase in [0, 2π), with the phase of the break that opens it.
    fn piece_at(self, phase: f64) -> (f64, Piece) {
        let Shape { breaks, pieces, .. } = self.shape();
        let after = breaks.partition_point(|&start| start <= phase);
        let index = (after + pieces.len() - 1) % pieces.len();
        (breaks.get(index).copied().unwrap_or(0.0), pieces[index])
    }
}

/// θ modulo 2π, in [0, 2π).
fn wrapped(phase: f64) -> f64 {
    let rest = phase.rem_euclid(TAU);
    if rest == TAU { 0.0 } else { rest }
}
