//! Citations: which computation uses which source, and what for.

use super::references::Source;

/// A computation, named after its verb.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Task {
    /// Effective friction.
    Friction,
    /// Stability of steady sliding, by eigenvalues or by averaging.
    Stability,
    /// Thresholds of the stability of a system.
    Thresholds,
    /// A trajectory with its events.
    Simulate,
    /// The steady response.
    Response,
    /// Sweeps of a parameter up and down.
    Bifurcation,
    /// Which starts converge to which response.
    Basins,
    /// Modes of a disc or of a system.
    Modes,
    /// Resonances of a disc, or of the dither of a system.
    Resonances,
}

impl Task {
    /// Every task, in the order in which its sources are listed.
    pub const ALL: &'static [Self] = &[
        Self::Modes,
        Self::Friction,
        Self::Stability,
        Self::Thresholds,
        Self::Simulate,
        Self::Response,
        Self::Bifurcation,
        Self::Basins,
        Self::Resonances,
    ];

    /// Name of the verb.
    pub fn name(self) -> &'static str {
        match self {
            Self::Friction => "friction",
            Self::Stability => "stability",
            Self::Thresholds => "thresholds",
            Self::Simulate => "simulate",
            Self::Response => "response",
            Self::Bifurcation => "bifurcation",
            Self::Basins => "basins",
            Self::Modes => "modes",
            Self::Resonances => "resonances",
        }
    }
}

/// A source with its use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Citation {
    /// The source.
    pub source: Source,
    /// The computation that uses it.
    pub task: Task,
    /// The equations used, or the purpose.
    pub used: &'static str,
}
