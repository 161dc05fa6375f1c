//! SI units, converted once at the boundary.
//!
//! Lengths stay lengths: a study in SI has F = N₀/k, D = A/k, v₀ = V₀/ω₀ in metres; only
//! time is measured in 1/ω₀. ω₀ = √(k/m), ζ = c/(2mω₀), R = 2πf/ω₀, τ = ω₀t.

use crate::{Invalid, InvalidValues};

pub mod measure;
mod unit_system;
mod values;

pub use unit_system::UnitSystem;
pub use values::UnitValues;

/// The kind of a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// A pure number.
    Ratio,
    /// A whole number.
    Count,
    /// An angle in radians.
    Angle,
    /// ζ; in SI a damping constant in N·s/m.
    DampingRatio,
    /// A force over k; in SI newtons.
    Force,
    /// A velocity over ω₀; in SI m/s.
    Velocity,
    /// A displacement; in SI metres.
    Displacement,
    /// A frequency over ω₀; in SI hertz.
    FrequencyRatio,
    /// ω₀t; in SI seconds.
    Time,
    /// Power over kω₀; in SI watts.
    Power,
    /// Per velocity/ω₀; in SI per m/s.
    PerVelocity,
    /// Per length; in SI per metre.
    PerLength,
    /// A stiffness over k; in SI N/m.
    Stiffness,
    /// Mass over the plate's; in SI kilograms.
    LoadMass,
    /// Damper over M_pω_ref; in SI N·s/m.
    LoadDamping,
    /// Spring over M_pω_ref²; in SI N/m.
    LoadStiffness,
    /// Friction force over r₀M_pω_ref²; in SI newtons.
    LoadFriction,
    /// A modulus of elasticity, always in pascals.
    Modulus,
    /// A density, always in kilograms per cubic metre.
    Density,
    /// A length of the plate, always in metres.
    Length,
    /// The mass of the plate, always in kilograms.
    PlateMass,
    /// A frequency, always in hertz.
    Frequency,
    /// An angle, always in degrees.
    Degrees,
    /// A mass over m; in SI kilograms.
    Mass,
    /// A force over k per ampere; in SI N/A.
    ForcePerCurrent,
    /// A capacitance times ω₀, ampere per volt; in SI farads.
    Capacitance,
    /// An inductance times ω₀, volt per ampere; in SI henries.
    Inductance,
    /// A voltage, always in volts.
    Voltage,
    /// A current, always in amperes.
    Current,
    /// A resistance, always in ohms.
    Resistance,
}

impl Quantity {
    /// Unit in a dimensionless study, in the symbols of the equations.
    pub fn scaled_unit(self) -> &'static str {
        match self {
            Self::Ratio | Self::Count => "1",
            Self::Angle => "rad",
            Self::DampingRatio => "1 (c/(2mω₀))",
            Self::Force => "length (force/k)",
            Self::Velocity => "length (velocity/ω₀)",
            Self::Displacement => "length",
            Self::FrequencyRatio => "ω₀",
            Self::Time => "1/ω₀",
            Self::Power => "length² (power/(kω₀))",
            Self::PerVelocity => "1/length (per velocity/ω₀)",
            Self::PerLength => "1/length",
            Self::Stiffness => "1 (stiffness/k)",
            Self::LoadMass => "1 (m/M_p)",
            Self::LoadDamping => "1 (c/(M_pω_ref))",
            Self::LoadStiffness => "1 (k/(M_pω_ref²))",
            Self::LoadFriction => "1 (F_θ/(r₀M_pω_ref²))",
            Self::Modulus => "Pa",
            Self::Density => "kg/m³",
            Self::Length => "m",
            Self::PlateMass => "kg",
            Self::Frequency => "Hz",
            Self::Degrees => "degrees",
            Self::Mass => "1 (mass/m)",
            Self::ForcePerCurrent => "length/A (force per current/k)",
            Self::Capacitance => "A/V (capacitance ω₀)",
            Self::Inductance => "V/A (inductance ω₀)",
            Self::Voltage => "V",
            Self::Current => "A",
            Self::Resistance => "Ω",
        }
    }

    /// The unit of a quantity that has a unit in every study; the key ends in it.
    pub fn own_unit(self) -> Option<&'static str> {
        Some(match self {
            Self::Modulus => "Pa",
            Self::Density => "kg/m³",
            Self::Length => "m",
            Self::PlateMass => "kg",
            Self::Frequency => "Hz",
            Self::Degrees => "deg",
            Self::Voltage => "V",
            Self::Current => "A",
            Self::Resistance => "Ω",
            _ => return None,
        })
    }

    /// SI unit and the suffix for it in field and key names.
    pub fn si_unit(self) -> Option<(&'static str, &'static str)> {
        Some(match self {
            Self::Ratio
            | Self::Count
            | Self::Angle
            | Self::Modulus
            | Self::Density
            | Self::Length
            | Self::PlateMass
            | Self::Frequency
            | Self::Degrees
            | Self::Voltage
            | Self::Current
            | Self::Resistance => return None,
            Self::ForcePerCurrent => ("N/A", "n_per_a"),
            Self::Capacitance => ("F", "f"),
            Self::Inductance => ("H", "h"),
            Self::DampingRatio | Self::LoadDamping => ("N·s/m", "n_s_per_m"),
            Self::Force | Self::LoadFriction => ("N", "n"),
            Self::Velocity => ("m/s", "m_per_s"),
            Self::Displacement => ("m", "m"),
            Self::FrequencyRatio => ("Hz", "hz"),
            Self::Time => ("s", "s"),
            Self::Power => ("W", "w"),
            Self::PerVelocity => ("s/m", "s_per_m"),
            Self::PerLength => ("1/m", "per_m"),
            Self::Mass | Self::LoadMass => ("kg", "kg"),
            Self::Stiffness | Self::LoadStiffness => ("N/m", "n_per_m"),
        })
    }
}

/// Mass and stiffness of a study with units: the scales that convert its numbers to those of the equations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scales {
    units: UnitSystem,
    mass: f64,
    stiffness: f64,
    /// ω₀, rad/s.
    angular_frequency: f64,
}

impl Scales {
    /// From mass in kilograms and stiffness in newtons per metre.
    ///
    /// # Errors
    /// An error for each value that is not finite and positive.
    pub fn new(mass_kg: f64, stiffness_n_per_m: f64) -> Result<Self, InvalidValues> {
        Self::in_units_of(UnitSystem::Si, mass_kg, stiffness_n_per_m)
    }

    /// From mass and stiffness in these units; [`UnitSystem::None`] stands for SI.
    ///
    /// # Errors
    /// An error for each value that is not finite and positive.
    pub fn in_units_of(
        units: UnitSystem,
        mass: f64,
        stiffness: f64,
    ) -> Result<Self, InvalidValues> {
        let complaints: Vec<_> = [("belt.mass", mass), ("belt.stiffness", stiffness)]
            .into_iter()
            .filter(|(_, value)| !(value.is_finite() && *value > 0.0))
            .map(|(key, value)| Invalid::new(key, value, "a finite number > 0"))
            .collect();
        if !complaints.is_empty() {
            return Err(InvalidValues::of(complaints));
        }
        let units = if units.is_none() { UnitSystem::Si } else { units };
        let angular_frequency = (stiffness / mass).sqrt();
        Ok(Self { units, mass, stiffness, angular_frequency })
    }

    /// From mass in these units and natural frequency ω₀ in radians per second: k = mω₀².
    ///
    /// # Errors
    /// An error for each value that is not finite and positive.
    pub fn of_angular_frequency(
        units: UnitSystem,
        mass: f64,
        angular_frequency: f64,
    ) -> Result<Self, InvalidValues> {
        let stiffness = mass * angular_frequency * angular_frequency;
        if !(angular_frequency.is_finite() && angular_frequency > 0.0) {
            let allowed = "a finite number > 0";
            let invalid = Invalid::new("belt.natural_frequency", angular_frequency, allowed);
            return Err(InvalidValues::from(invalid));
        }
        let scales = Self::in_units_of(units, mass, stiffness)?;
        Ok(Self { angular_frequency, ..scales })
    }

    /// Natural frequency ω₀ = √(k/m), rad/s.
    pub fn angular_frequency(&self) -> f64 {
        self.angular_frequency
    }

    /// Stiffness k, in the units of the study.
    pub fn stiffness(&self) -> f64 {
        self.stiffness
    }

    /// Mass m, in the units of the study.
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// The units of the study; not [`UnitSystem::None`].
    pub fn units(&self) -> UnitSystem {
        self.units
    }

    /// Unit of a quantity in the study, hertz of a frequency; `None` for a quantity without a unit, and for one whose unit every study
    /// has.
    pub fn unit(&self, quantity: Quantity) -> Option<&'static str> {
        let (hertz, _) = quantity.si_unit()?;
        match quantity {
            Quantity::FrequencyRatio => Some(hertz),
            quantity => self.units.unit(quantity),
        }
    }

    /// What one number of the equations is in the units of the study, with the unit; `None` as of [`Scales::unit`].
    pub fn one(&self, quantity: Quantity) -> Option<(f64, &'static str)> {
        Some((self.per_unit(quantity), self.unit(quantity)?))
    }

    /// What one number of the equations is in the units of the study, with the unit, as a bare number gives it: a frequency is angular.
    pub fn own(&self, quantity: Quantity) -> Option<(f64, &'static str)> {
        let unit = self.units.unit(quantity).filter(|_| quantity.si_unit().is_some())?;
        Some(match quantity {
            Quantity::FrequencyRatio => (self.angular_frequency, unit),
            quantity => (self.per_unit(quantity), unit),
        })
    }

    /// What one number of the equations is in the units of the study, hertz of a frequency.
    pub fn per_unit(&self, quantity: Quantity) -> f64 {
        let omega = self.angular_frequency();
        match quantity {
            Quantity::Ratio
            | Quantity::Count
            | Quantity::Angle
            | Quantity::Displacement
            | Quantity::PerLength
            | Quantity::Modulus
            | Quantity::Density
            | Quantity::Length
            | Quantity::PlateMass
            | Quantity::Frequency
            | Quantity::Degrees
            | Quantity::Voltage
            | Quantity::Current
            | Quantity::Resistance => 1.0,
            Quantity::DampingRatio => 2.0 * self.mass * omega,
            // Stiffness and friction of a load: a force over a length of 1 m.
            Quantity::Force
            | Quantity::Stiffness
            | Quantity::LoadStiffness
            | Quantity::LoadFriction
            | Quantity::ForcePerCurrent => self.stiffness,
            Quantity::Velocity => omega,
            Quantity::FrequencyRatio => omega / std::f64::consts::TAU,
            Quantity::Time
            | Quantity::PerVelocity
            | Quantity::Capacitance
            | Quantity::Inductance => 1.0 / omega,
            Quantity::Power => self.stiffness * omega,
            Quantity::Mass | Quantity::LoadMass => self.mass,
            Quantity::LoadDamping => self.mass * omega,
        }
    }

    /// Converts from the units of the study to the number of the equations.
    pub fn from_units(&self, quantity: Quantity, value: f64) -> f64 {
        value / self.per_unit(quantity)
    }

    /// Converts from the number of the equations to the units of the study.
    pub fn to_units(&self, quantity: Quantity, value: f64) -> f64 {
        value * self.per_unit(quantity)
    }
}

/// The scales that convert the numbers of a disc to SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiscScales {
    /// ω_ref/2π, Hz.
    pub reference_hz: f64,
    /// Mass M_p of the plate, kg, if material and size are known.
    pub plate_mass_kg: Option<f64>,
    /// Radius r₀ of the load, m, if known.
    pub load_radius_m: Option<f64>,
}

impl DiscScales {
    /// ω_ref, rad/s.
    pub fn angular_frequency(&self) -> f64 {
        std::f64::consts::TAU * self.reference_hz
    }

    /// SI value of one dimensionless unit of a quantity; `None` if the required scales are unknown.
    pub fn si_per_unit(&self, quantity: Quantity) -> Option<f64> {
        let omega = self.angular_frequency();
        let mass = self.plate_mass_kg;
        match quantity {
            Quantity::FrequencyRatio => Some(self.reference_hz),
            Quantity::Time => Some(1.0 / omega),
            Quantity::LoadMass => mass,
            Quantity::LoadDamping => mass.map(|mass| mass * omega),
            Quantity::LoadStiffness => mass.map(|mass| mass * omega * omega),
            Quantity::Velocity => self.load_radius_m.map(|radius| radius * omega),
            Quantity::PerVelocity => self.load_radius_m.map(|radius| 1.0 / (radius * omega)),
            Quantity::LoadFriction => {
                mass.zip(self.load_radius_m).map(|(mass, radius)| radius * mass * omega * omega)
            }
            Quantity::Ratio
            | Quantity::Count
            | Quantity::Angle
            | Quantity::Displacement
            | Quantity::PerLength
            | Quantity::Modulus
            | Quantity::Density
            | Quantity::Length
            | Quantity::PlateMass
            | Quantity::Frequency
            | Quantity::Degrees
            | Quantity::Voltage
            | Quantity::Current
            | Quantity::Resistance => Some(1.0),
            Quantity::DampingRatio
            | Quantity::Force
            | Quantity::Stiffness
            | Quantity::Power
            | Quantity::Mass
            | Quantity::ForcePerCurrent
            | Quantity::Capacitance
            | Quantity::Inductance => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_load_in_si_maps_to_the_numbers_of_the_disc() {
        let scales = DiscScales {
            reference_hz: 5.0 / std::f64::consts::PI,
            plate_mass_kg: Some(2.0),
            load_radius_m: Some(0.1),
        };
        for (quantity, unit) in [
            (Quantity::LoadMass, 2.0),
            (Quantity::LoadDamping, 20.0),
            (Quantity::LoadStiffness, 200.0),
            (Quantity::LoadFriction, 20.0),
            (Quantity::Time, 0.1),
        ] {
            let found = scales.si_per_unit(quantity).expect("known");
            assert!((found / unit - 1.0).abs() < 1e-14, "{quantity:?}");
        }
        let bare = DiscScales { plate_mass_kg: None, ..scales };
        assert_eq!(bare.si_per_unit(Quantity::LoadMass), None);
        assert!(bare.si_per_unit(Quantity::FrequencyRatio).is_some());
    }

    #[test]
    fn a_pad_in_si_maps_to_its_ratios() {
        // 2 kg on 200 N/m: ω₀ = 10 rad/s.
        let scales = Scales::new(2.0, 200.0).expect("valid");
        assert_eq!(scales.angular_frequency(), 10.0);
        assert_eq!(scales.from_units(Quantity::DampingRatio, 4.0), 0.1);
        assert_eq!(scales.from_units(Quantity::Force, 50.0), 0.25);
        assert_eq!(scales.from_units(Quantity::Velocity, 5.0), 0.5);
        let ratio = scales.from_units(Quantity::FrequencyRatio, 100.0 / std::f64::consts::TAU);
        assert!((ratio - 10.0).abs() < 1e-14);
        assert_eq!(scales.to_units(Quantity::Time, 30.0), 3.0);
    }

    #[test]
    fn a_natural_frequency_replaces_a_stiffness() {
        let angular = 10.0 * std::f64::consts::PI;
        let scales = Scales::of_angular_frequency(UnitSystem::Si, 2.0, angular).expect("valid");
        assert_eq!(scales.angular_frequency(), 10.0 * std::f64::consts::PI);
        assert_eq!(scales.per_unit(Quantity::FrequencyRatio), 5.0);
        let stiffness = 200.0 * std::f64::consts::PI * std::f64::consts::PI;
        assert!((scales.stiffness() / stiffness - 1.0).abs() < 1e-15);
        assert!(Scales::of_angular_frequency(UnitSystem::Si, 2.0, 0.0).is_err());
        assert!(Scales::of_angular_frequency(UnitSystem::Si, -2.0, 5.0).is_err());
    }

    #[test]
    fn both_scales_are_complained_about_at_once() {
        let complaints = Scales::new(-1.0, f64::NAN).expect_err("both are wrong");
        assert_eq!(complaints.len(), 2);
    }
}
