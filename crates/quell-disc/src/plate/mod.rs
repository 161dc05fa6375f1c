//! Natural frequencies and mode shapes of an annular brake disc: a thin plate clamped at r = b and free at r = a.
//!
//! Exact solution in Bessel functions, eqs (5.1)–(5.7). Errors in the dissertation: (5.2) should be the operator
//! (∂ᵣᵣ + ∂ᵣ/r + ∂_θθ/r²)², without w inside it and not a square of terms in w; (5.5) should have ∂²/∂θ², not ∂/∂θ².
//!
//! Every mode is computed in two steps. A Ritz discretisation (`ritz`) gives all wave numbers in order, each from above, so that
//! no mode is missed or duplicated. The sign change of the exact characteristic determinant (`characteristic`) just below each
//! Ritz value then gives the accurate value. A Ritz value without a sign change is an error; it is never returned as a guess.
//!
//! Accuracy: relative error of the frequency parameters k² 10⁻¹³ against 40-digit arithmetic, error of the shapes 10⁻¹¹ of φ(a);
//! see the tests.

mod characteristic;
mod dimension;
mod mode_set;
mod ritz;
mod shape;

#[cfg(test)]
mod tests;

pub use dimension::{PlateMaterial, PlateMaterialError};
pub use mode_set::{ModeSet, ModeSetError, Reference};
pub use shape::RadialShape;

use quell_model::parameter::disc as parameter;
use quell_numerics::roots::{Closeness, find_root};

use characteristic::eliminate;
use ritz::{ACCURACY, TrialSpace};

/// Bounds of the ratio of radii b/a. Below them the plate is a full disc with a pinhole; above them it is a ring to which plate
/// theory does not apply.
pub const INNER_RADIUS_RATIO: [f64; 2] =
    [parameter::INNER_RADIUS_RATIO.bounds.lower, parameter::INNER_RADIUS_RATIO.bounds.upper];

/// Largest number of nodal diameters. Beyond it, Y and K at a small inner radius approach the limits of `f64`.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
pub const MOST_DIAMETERS: u32 = parameter::NODAL_DIAMETERS.bounds.upper as u32;

/// Largest number of radial modes per number of nodal diameters.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
pub const MOST_RADIAL: usize = parameter::RADIAL_MODES.bounds.upper as usize;

/// A thin annular plate, clamped at its inner and free at its outer edge, in units of its outer radius.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plate {
    inner_radius_ratio: f64,
    poisson_ratio: f64,
}

/// One mode of a plate.
#[derive(Debug, Clone, PartialEq)]
pub struct PlateMode {
    /// Radial number, from 1; 1 = no interior nodal circle.
    pub radial: usize,
    /// Nodal diameters j.
    pub diameters: u32,
    /// Frequency parameter k² = ω a² √(ρh/D).
    pub frequency_parameter: f64,
    /// Shape φ(r) along the radius, normalised.
    pub shape: RadialShape,
}

/// Why modes could not be computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PlateError {
    /// b/a is outside [`INNER_RADIUS_RATIO`].
    InnerRadiusRatio {
        /// The value given.
        value: f64,
    },
    /// ν is outside 0 ≤ ν < 0.5.
    PoissonRatio {
        /// The value given.
        value: f64,
    },
    /// More nodal diameters than [`MOST_DIAMETERS`].
    TooManyDiameters {
        /// The number requested.
        diameters: u32,
    },
    /// No radial mode, or more than [`MOST_RADIAL`].
    RadialModes {
        /// The number requested.
        radial: usize,
    },
    /// No root of the characteristic equation was found near the Ritz value of this mode, or its matrices or functions
    /// are out of the range of `f64`.
    NotFound {
        /// Nodal diameters of the mode.
        diameters: u32,
        /// Its radial number, from 1.
        radial: usize,
    },
}

impl core::fmt::Display for PlateError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::InnerRadiusRatio { value } => write!(
                f,
                "the ratio of radii b/a is {value}, but must be from {} to {}",
                INNER_RADIUS_RATIO[0], INNER_RADIUS_RATIO[1]
            ),
            Self::PoissonRatio { value } => {
                write!(f, "Poisson's ratio is {value}, but must be at least 0 and below 0.5")
            }
            Self::TooManyDiameters { diameters } => {
                write!(
                    f,
                    "{diameters} nodal diameters were requested, but at most {MOST_DIAMETERS} are supported"
                )
            }
            Self::RadialModes { radial } => {
                write!(
                    f,
                    "{radial} radial modes were requested, but 1 to {MOST_RADIAL} are supported"
                )
            }
            Self::NotFound { diameters, radial } => write!(
                f,
                "radial mode {radial} with {diameters} nodal diameters could not be confirmed by the characteristic equation"
            ),
        }
    }
}

impl core::error::Error for PlateError {}

impl Plate {
    /// A plate with the ratio of radii b/a and Poisson's ratio ν.
    ///
    /// # Errors
    /// [`PlateError::InnerRadiusRatio`] or [`PlateError::PoissonRatio`] where a value is out of range or not a number.
    pub fn new(inner_radius_ratio: f64, poisson_ratio: f64) -> Result<Self, PlateError> {
        let [least, most] = INNER_RADIUS_RATIO;
        if !(least..=most).contains(&inner_radius_ratio) {
            return Err(PlateError::InnerRadiusRatio { value: inner_radius_ratio });
        }
        if !(0.0..0.5).contains(&poisson_ratio) {
            return Err(PlateError::PoissonRatio { value: poisson_ratio });
        }
        Ok(Self { inner_radius_ratio, poisson_ratio })
    }

    /// Ratio of radii b/a.
    #[must_use]
    pub fn inner_radius_ratio(&self) -> f64 {
        self.inner_radius_ratio
    }

    /// Poisson's ratio ν.
    #[must_use]
    pub fn poisson_ratio(&self) -> f64 {
        self.poisson_ratio
    }

    /// The lowest `radial` modes for every number of nodal diameters 0, 1, … `diameters`, ordered by diameters, then radial
    /// number.
    ///
    /// # Errors
    /// [`PlateError`] where more modes are requested than supported, or one could not be confirmed.
    pub fn modes(&self, radial: usize, diameters: u32) -> Result<Vec<PlateMode>, PlateError> {
        if diameters > MOST_DIAMETERS {
            return Err(PlateError::TooManyDiameters { diameters });
        }
        if !(1..=MOST_RADIAL).contains(&radial) {
            return Err(PlateError::RadialModes { radial });
        }
        // One more than requested, so that the last root has a neighbour above it too.
        let wanted = radial + 1;
        let space = TrialSpace::new(self.inner_radius_ratio, self.poisson_ratio, wanted, diameters);
        let mut modes = Vec::with_capacity(radial * (diameters as usize + 1));
        for n in 0..=diameters {
            let failure = PlateError::NotFound { diameters: n, radial: 1 };
            let ritz = space.wave_numbers(n, wanted).ok_or(failure)?;
            for number in 1..=radial {
                let mode = self.refine(n, number, &ritz);
                modes.push(mode.ok_or(PlateError::NotFound { diameters: n, radial: number })?);
            }
        }
        Ok(modes)
    }

    /// The exact mode just below the Ritz value of the given radial number.
    fn refine(&self, diameters: u32, radial: usize, ritz: &[f64]) -> Option<PlateMode> {
        let (inner, poisson) = (self.inner_radius_ratio, self.poisson_ratio);
        let guess = ritz[radial - 1];
        let below = if radial == 1 { 0.0 } else { ritz[radial - 2] };
        let above = ritz[radial];
        // Limited to the midpoints between neighbours: brackets of different modes cannot overlap.
        let (floor, ceiling) = (0.5 * (below + guess), 0.5 * (guess + above));
        let determinant =
            |k: f64| eliminate(diameters, inner, poisson, k).map_or(f64::NAN, |e| e.determinant);
        // Ritz values are above the roots, but with rounding the computed root may be slightly above its Ritz value.
        let mut reach = 1e-9;
        while reach <= ACCURACY {
            let from = (guess * (1.0 - reach)).max(floor);
            let to = (guess * (1.0 + 0.1 * reach)).min(ceiling);
            if let Ok(root) = find_root(determinant, from, to, Closeness::default()) {
                let k = root.location;
                let coefficients = eliminate(diameters, inner, poisson, k)?.coefficients;
                let shape = RadialShape::new(diameters, k, inner, coefficients)?;
                return Some(PlateMode { radial, diameters, frequency_parameter: k * k, shape });
            }
            reach *= 10.0;
        }
        None
    }
}
