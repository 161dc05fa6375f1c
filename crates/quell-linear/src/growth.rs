//! What an analysis says about stability: a growth rate, its error bound, and the verdict they allow.

/// Whether the disc squeals.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// Every motion decays: the growth rate is below zero by more than its error.
    Stable,
    /// Some motion grows: the growth rate is above zero by more than its error.
    Unstable,
    /// The growth rate is zero within its error. So it is on whole lines of the map at ξ = 0, where one combination of two
    /// waves is out of the load's reach.
    Undecided,
}

impl Verdict {
    /// Word in outputs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stable => "stable",
            Self::Unstable => "unstable",
            Self::Undecided => "undecided",
        }
    }
}

/// Largest growth rate with its error bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Growth {
    /// Growth rate: the largest Re ρ, per unit of τ = ω_ref t.
    pub rate: f64,
    /// Bound on its error.
    pub error: f64,
    /// Frequency |Im ρ| in ω_ref; under dither between 0 and R/2, for exponents are known up to multiples of iR.
    pub frequency: f64,
}

impl Growth {
    /// The verdict that rate and error allow.
    pub fn verdict(&self) -> Verdict {
        if self.rate > self.error {
            Verdict::Unstable
        } else if self.rate < -self.error {
            Verdict::Stable
        } else {
            Verdict::Undecided
        }
    }
}
