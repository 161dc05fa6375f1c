//! SI units, mapped once at the edge.
//!
//! Lengths stay lengths: a study in SI has F = N₀/k, D = A/k, v₀ = V₀/ω₀ in metres, only
//! time is counted in 1/ω₀. ω₀ = √(k/m), ζ = c/(2mω₀), R = 2πf/ω₀, τ = ω₀t.

use crate::Invalid;

/// What kind of quantity a number is.
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
}

impl Quantity {
    /// Unit in a study without SI, in words of the equations.
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
        }
    }

    /// SI unit and the suffix that field and key names carry for it.
    pub fn si_unit(self) -> Option<(&'static str, &'static str)> {
        Some(match self {
            Self::Ratio | Self::Count | Self::Angle => return None,
            Self::DampingRatio => ("N·s/m", "n_s_per_m"),
            Self::Force => ("N", "n"),
            Self::Velocity => ("m/s", "m_per_s"),
            Self::Displacement => ("m", "m"),
            Self::FrequencyRatio => ("Hz", "hz"),
            Self::Time => ("s", "s"),
            Self::Power => ("W", "w"),
            Self::PerVelocity => ("s/m", "s_per_m"),
        })
    }
}

/// Mass and stiffness of an SI study: the scales that turn SI into the equations' numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scales {
    mass_kg: f64,
    stiffness_n_per_m: f64,
}

impl Scales {
    /// From mass in kilograms and stiffness in newtons per metre.
    ///
    /// # Errors
    /// A complaint for each value that is not finite and positive.
    pub fn new(mass_kg: f64, stiffness_n_per_m: f64) -> Result<Self, Vec<Invalid>> {
        let complaints: Vec<_> =
            [("belt.mass_kg", mass_kg), ("belt.stiffness_n_per_m", stiffness_n_per_m)]
                .into_iter()
                .filter(|(_, value)| !(value.is_finite() && *value > 0.0))
                .map(|(key, value)| Invalid::new(key, value, "a finite number > 0"))
                .collect();
        if complaints.is_empty() {
            Ok(Self { mass_kg, stiffness_n_per_m })
        } else {
            Err(complaints)
        }
    }

    /// Natural frequency ω₀ = √(k/m), rad/s.
    pub fn angular_frequency(&self) -> f64 {
        (self.stiffness_n_per_m / self.mass_kg).sqrt()
    }

    /// Mass m, kg.
    pub fn mass_kg(&self) -> f64 {
        self.mass_kg
    }

    /// SI value of one unit of a quantity of the equations.
    pub fn si_per_unit(&self, quantity: Quantity) -> f64 {
        let omega = self.angular_frequency();
        match quantity {
            Quantity::Ratio | Quantity::Count | Quantity::Angle | Quantity::Displacement => 1.0,
            Quantity::DampingRatio => 2.0 * self.mass_kg * omega,
            Quantity::Force => self.stiffness_n_per_m,
            Quantity::Velocity => omega,
            Quantity::FrequencyRatio => omega / std::f64::consts::TAU,
            Quantity::Time | Quantity::PerVelocity => 1.0 / omega,
            Quantity::Power => self.stiffness_n_per_m * omega,
        }
    }

    /// From SI to the equations' number.
    pub fn from_si(&self, quantity: Quantity, value: f64) -> f64 {
        value / self.si_per_unit(quantity)
    }

    /// From the equations' number to SI.
    pub fn to_si(&self, quantity: Quantity, value: f64) -> f64 {
        value * self.si_per_unit(quantity)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pad_in_si_maps_to_its_ratios() {
        // 2 kg on 200 N/m: ω₀ = 10 rad/s.
        let scales = Scales::new(2.0, 200.0).expect("valid");
        assert_eq!(scales.angular_frequency(), 10.0);
        assert_eq!(scales.from_si(Quantity::DampingRatio, 4.0), 0.1);
        assert_eq!(scales.from_si(Quantity::Force, 50.0), 0.25);
        assert_eq!(scales.from_si(Quantity::Velocity, 5.0), 0.5);
        let ratio = scales.from_si(Quantity::FrequencyRatio, 100.0 / std::f64::consts::TAU);
        assert!((ratio - 10.0).abs() < 1e-14);
        assert_eq!(scales.to_si(Quantity::Time, 30.0), 3.0);
    }

    #[test]
    fn both_scales_are_complained_about_at_once() {
        let complaints = Scales::new(-1.0, f64::NAN).expect_err("both are wrong");
        assert_eq!(complaints.len(), 2);
    }
}
