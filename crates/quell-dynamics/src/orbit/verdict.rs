//! The verdict of the Floquet multipliers.

/// Smallest presumed error of a multiplier's modulus: that of the collocation of `variation`, 10⁻¹⁰ compared with finite
/// differences, with a margin.
const UNDECIDED: f64 = 1e-9;

/// Whether small perturbations of a periodic response decay.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum OrbitVerdict {
    /// Every multiplier is inside the unit circle.
    Stable,
    /// One multiplier is outside.
    Unstable,
    /// The largest multiplier is on the unit circle, within the error.
    Undecided,
}

impl OrbitVerdict {
    /// The verdict on an orbit whose largest multiplier has this modulus with this error (at least 10⁻⁹ is presumed).
    pub fn of(radius: f64, error: f64) -> Self {
        let error = error.max(UNDECIDED);
        match radius {
            radius if radius > 1.0 + error => Self::Unstable,
            radius if radius < 1.0 - error => Self::Stable,
            _ => Self::Undecided,
        }
    }

    /// The word in outputs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stable => "stable",
            Self::Unstable => "unstable",
            Self::Undecided => "undecided",
        }
    }
}
