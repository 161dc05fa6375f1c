//! A set of modes and its reference frequency; eq. (5.17).
//!
//! ω_ref = ω_cr = min ω_pq/q over the modes of the set with q > 0 nodal diameters. This is the lowest critical speed: Ω = 1
//! is the speed at which a forward wave is first stationary relative to the load. It depends on the set: at b/a = 0.5 it is
//! smaller by a factor of 1.188 with q ≤ 5 than with q ≤ 2, and speeds, damping, stiffness and friction are scaled by it. To
//! compare truncations, use a fixed reference frequency instead.

use super::{Plate, PlateError, PlateMode};
use quell_model::disc::Mode;

/// The reference frequency of a mode set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reference {
    /// ω_cr = min ω_pq/q of the mode set, as in the dissertation.
    Critical,
    /// A fixed frequency parameter k²_ref = ω_ref a² √(ρh/D).
    FrequencyParameter(f64),
}

/// Modes of a plate with their reference frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct ModeSet {
    modes: Vec<PlateMode>,
    reference: f64,
    critical: Option<usize>,
}

/// Why a mode set could not be formed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ModeSetError {
    /// The modes could not be computed.
    Plate(PlateError),
    /// No mode of the set has a nodal diameter, so there is no critical speed: a reference must be given.
    NoCriticalSpeed,
    /// The given reference frequency is not a positive number.
    Reference {
        /// The value given.
        value: f64,
    },
}

impl core::fmt::Display for ModeSetError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Plate(error) => error.fmt(f),
            Self::NoCriticalSpeed => {
                f.write_str("no mode has a nodal diameter, so there is no critical speed: specify a reference frequency")
            }
            Self::Reference { value } => {
                write!(f, "the reference frequency parameter is {value}, but must be a positive number")
            }
        }
    }
}

impl core::error::Error for ModeSetError {}

impl From<PlateError> for ModeSetError {
    fn from(error: PlateError) -> Self {
        Self::Plate(error)
    }
}

impl ModeSet {
    /// The lowest `radial_modes` modes of 0 … `nodal_diameters` nodal diameters of a plate (N_r, N_θ of the dissertation).
    ///
    /// # Errors
    /// [`ModeSetError`] where the modes or the reference frequency could not be determined.
    pub fn new(
        plate: &Plate,
        radial_modes: usize,
        nodal_diameters: u32,
        reference: Reference,
    ) -> Result<Self, ModeSetError> {
        let modes = plate.modes(radial_modes, nodal_diameters)?;
        let speed = |mode: &PlateMode| mode.frequency_parameter / f64::from(mode.diameters);
        let with_diameters = modes.iter().enumerate().filter(|(_, mode)| mode.diameters > 0);
        let critical =
            with_diameters.min_by(|a, b| speed(a.1).total_cmp(&speed(b.1))).map(|(index, _)| index);
        let reference = match reference {
            Reference::FrequencyParameter(value) if value > 0.0 && value.is_finite() => value,
            Reference::FrequencyParameter(value) => return Err(ModeSetError::Reference { value }),
            Reference::Critical => speed(&modes[critical.ok_or(ModeSetError::NoCriticalSpeed)?]),
        };
        Ok(Self { modes, reference, critical })
    }

    /// The modes, ordered by nodal diameters, then radial number.
    #[must_use]
    pub fn modes(&self) -> &[PlateMode] {
        &self.modes
    }

    /// Frequency parameter k²_ref of the reference frequency.
    #[must_use]
    pub fn reference(&self) -> f64 {
        self.reference
    }

    /// The mode with the lowest critical speed ω_pq/q of the set; `None` where no mode has a nodal diameter.
    #[must_use]
    pub fn critical_mode(&self) -> Option<&PlateMode> {
        self.critical.map(|index| &self.modes[index])
    }

    /// Natural frequency β = ω_pq/ω_ref of a mode.
    #[must_use]
    pub fn ratio(&self, mode: &PlateMode) -> f64 {
        mode.frequency_parameter / self.reference
    }

    /// The modes for a load at the radius r₀ (in units of the outer radius), all with the damping ratio ξ; `None`
    /// where r₀ is not on the plate.
    #[must_use]
    pub fn at_radius(&self, radius: f64, damping: f64) -> Option<Vec<Mode>> {
        self.modes
            .iter()
            .map(|mode| {
                Some(Mode {
                    diameters: mode.diameters as usize,
                    ratio: self.ratio(mode),
                    shape_at_load: mode.shape.value(radius)?,
                    damping,
                })
            })
            .collect()
    }
}
