//! The definition of a waveform: its breaks, its analytic pieces, and the averages of its integral.

/// One analytic piece of a waveform.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Piece {
    /// sin θ.
    Harmonic,
    /// `value + slope·(θ − θ₀)` after the break θ₀ at which the piece starts.
    Affine {
        /// Value just after the break.
        value: f64,
        /// Slope per radian.
        slope: f64,
    },
}

/// The properties of a waveform. All phases are in [0, 2π).
pub(crate) struct Shape {
    pub(crate) name: &'static str,
    /// Phases of kinks and jumps, ascending; empty for an analytic waveform.
    pub(crate) breaks: &'static [f64],
    /// Pieces after each break; one piece if there are no breaks.
    pub(crate) pieces: &'static [Piece],
    /// G at a phase in [0, 2π).
    pub(crate) integral: fn(f64) -> f64,
    /// max |G|.
    pub(crate) peak_integral: f64,
    /// ⟨G²⟩.
    pub(crate) mean_square_integral: f64,
    /// √⟨g²⟩.
    pub(crate) root_mean_square: f64,
}
