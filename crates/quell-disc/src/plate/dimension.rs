//! Conversion of frequency parameters to hertz and revolutions per minute.
//!
//! D = E h³/(12(1 − ν²)),  ω = (k²/a²) √(D/(ρh)) for a Kirchhoff plate. Apart from h < a, neither the ratio h/a nor the ratio of
//! the wavelength to h is checked.

use super::Plate;

/// Material and dimensions of a plate, which relate its dimensionless quantities to SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlateMaterial {
    youngs_modulus: f64,
    density: f64,
    thickness: f64,
    outer_radius: f64,
}

/// An invalid material property or dimension.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlateMaterialError {
    /// Name of the quantity.
    pub quantity: &'static str,
    /// The value given.
    pub value: f64,
}

impl core::fmt::Display for PlateMaterialError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "the {} is {}, but must be a positive number", self.quantity, self.value)?;
        if self.quantity == "thickness" { f.write_str(" below the outer radius") } else { Ok(()) }
    }
}

impl core::error::Error for PlateMaterialError {}

impl PlateMaterial {
    /// Young's modulus E (Pa), density ρ (kg/m³), thickness h (m), outer radius a (m).
    ///
    /// # Errors
    /// [`PlateMaterialError`] where a value is not a positive number, or h ≥ a.
    pub fn new(
        youngs_modulus: f64,
        density: f64,
        thickness: f64,
        outer_radius: f64,
    ) -> Result<Self, PlateMaterialError> {
        let values = [
            ("Young's modulus", youngs_modulus),
            ("density", density),
            ("outer radius", outer_radius),
            ("thickness", thickness),
        ];
        for (quantity, value) in values {
            let valid = value > 0.0
                && value.is_finite()
                && (quantity != "thickness" || value < outer_radius);
            if !valid {
                return Err(PlateMaterialError { quantity, value });
            }
        }
        Ok(Self { youngs_modulus, density, thickness, outer_radius })
    }

    /// Thickness h, m.
    #[must_use]
    pub fn thickness(&self) -> f64 {
        self.thickness
    }

    /// Outer radius a, m.
    #[must_use]
    pub fn outer_radius(&self) -> f64 {
        self.outer_radius
    }

    /// Angular frequency (rad/s) that corresponds to the frequency parameter k² = 1 on the given plate.
    #[must_use]
    pub fn angular_frequency_unit(&self, plate: &Plate) -> f64 {
        let nu = plate.poisson_ratio();
        let rigidity =
            self.youngs_modulus * libm::pow(self.thickness, 3.0) / (12.0 * (1.0 - nu * nu));
        libm::sqrt(rigidity / (self.density * self.thickness))
            / (self.outer_radius * self.outer_radius)
    }

    /// Frequency in hertz of the frequency parameter k².
    #[must_use]
    pub fn hertz(&self, plate: &Plate, frequency_parameter: f64) -> f64 {
        frequency_parameter * self.angular_frequency_unit(plate) / core::f64::consts::TAU
    }

    /// Critical speed ω/q in revolutions per minute of a mode of `diameters` nodal diameters; `None` for 0.
    #[must_use]
    pub fn critical_speed_rpm(
        &self,
        plate: &Plate,
        frequency_parameter: f64,
        diameters: u32,
    ) -> Option<f64> {
        (diameters > 0)
            .then(|| 60.0 * self.hertz(plate, frequency_parameter) / f64::from(diameters))
    }

    /// Mass of the plate M_p = ρhπ(a² − b²) in kg: the unit of m* (and, with ω_ref, of c*, k*, f*).
    #[must_use]
    pub fn plate_mass(&self, plate: &Plate) -> f64 {
        let ratio = plate.inner_radius_ratio();
        let area = core::f64::consts::PI
            * self.outer_radius
            * self.outer_radius
            * (1.0 - ratio)
            * (1.0 + ratio);
        self.density * self.thickness * area
    }
}
