//! Waves of a mode in the frame of the load.

/// Direction of travel of a wave in the frame of the disc.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum WaveDirection {
    /// With the load: frequency β − qΩ in the load's frame.
    Forward,
    /// Against the load: frequency β + qΩ.
    Backward,
    /// No nodal diameters: the wave does not travel; frequency β.
    Axisymmetric,
}

/// One wave of a mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct TravellingWave {
    /// Index of the mode in the list of modes.
    pub mode: usize,
    /// Radial number of the mode among those with the same number of nodal diameters, in order of frequency, from 1.
    pub radial: usize,
    /// Nodal diameters.
    pub diameters: usize,
    /// WaveDirection.
    pub direction: WaveDirection,
}

impl core::fmt::Display for TravellingWave {
    /// "forward (1,2)": direction, radial number, nodal diameters.
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let direction = match self.direction {
            WaveDirection::Forward => "forward",
            WaveDirection::Backward => "backward",
            WaveDirection::Axisymmetric => "axisymmetric",
        };
        write!(f, "{direction} ({},{})", self.radial, self.diameters)
    }
}

impl TravellingWave {
    /// Signed number of diameters: −q forward, q backward; frequency β + sΩ in the load's frame.
    #[must_use]
    pub fn signed_diameters(&self) -> f64 {
        match self.direction {
            WaveDirection::Forward => -(self.diameters as f64),
            WaveDirection::Backward => self.diameters as f64,
            WaveDirection::Axisymmetric => 0.0,
        }
    }
}

/// A wave or its conjugate in the complex form: frequency w = lΩ + σβ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SignedWave {
    pub(super) mode: usize,
    /// l; σl < 0 for a forward wave.
    pub(super) l: f64,
    /// σ = ±1.
    pub(super) sigma: f64,
}

impl SignedWave {
    pub(super) fn new(wave: &TravellingWave, conjugate: bool) -> Self {
        let sigma = if conjugate { -1.0 } else { 1.0 };
        Self { mode: wave.mode, l: sigma * wave.signed_diameters(), sigma }
    }
}
