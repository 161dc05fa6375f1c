//! The unit of every bare number of a study.

use std::f64::consts::TAU;

use super::Quantity;

/// The units in which a study gives its bare numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum UnitSystem {
    /// Numbers without units.
    #[default]
    None,
    /// Metre, kilogram, second, newton.
    Si,
    /// Millimetre, tonne, second, newton: the units of many finite-element models.
    MmTonneSecond,
}

impl UnitSystem {
    /// Every choice.
    pub const ALL: &'static [Self] = &[Self::None, Self::Si, Self::MmTonneSecond];

    /// Name in a study file.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Si => "SI",
            Self::MmTonneSecond => "mm-t-s",
        }
    }

    /// Whether numbers have no units.
    pub fn is_none(self) -> bool {
        self == Self::None
    }

    /// The choice of a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|units| units.name() == name)
    }

    /// Unit of a bare number; `None` where it has none. [`Quantity::FrequencyRatio`] is an angular frequency.
    pub fn unit(self, quantity: Quantity) -> Option<&'static str> {
        let (si, mm) = match quantity {
            Quantity::Angle => return Some("rad"),
            Quantity::Displacement => ("m", "mm"),
            Quantity::Velocity => ("m/s", "mm/s"),
            Quantity::Force | Quantity::LoadFriction => ("N", "N"),
            Quantity::Mass | Quantity::LoadMass => ("kg", "Mg"),
            Quantity::Stiffness | Quantity::LoadStiffness => ("N/m", "N/mm"),
            Quantity::LoadDamping | Quantity::DampingRatio => ("N·s/m", "N·s/mm"),
            Quantity::FrequencyRatio => ("rad/s", "rad/s"),
            Quantity::Time => ("s", "s"),
            Quantity::Power => ("W", "mW"),
            Quantity::PerVelocity => ("s/m", "s/mm"),
            Quantity::PerLength => ("1/m", "1/mm"),
            Quantity::ForcePerCurrent => ("N/A", "N/A"),
            Quantity::Capacitance => ("F", "F"),
            Quantity::Inductance => ("H", "H"),
            Quantity::Voltage | Quantity::Current | Quantity::Resistance => {
                return quantity.own_unit();
            }
            _ => return None,
        };
        match self {
            Self::None => None,
            Self::Si => Some(si),
            Self::MmTonneSecond => Some(mm),
        }
    }

    /// SI value of one bare unit; angular frequencies become hertz. `None` if the study has no units and the quantity has.
    pub fn si_per_unit(self, quantity: Quantity) -> Option<f64> {
        if quantity.si_unit().is_none() {
            return Some(1.0);
        }
        let frequency = quantity == Quantity::FrequencyRatio;
        match self {
            Self::None => None,
            _ if frequency => Some(1.0 / TAU),
            Self::Si => Some(1.0),
            Self::MmTonneSecond => Some(match quantity {
                Quantity::Displacement | Quantity::Velocity | Quantity::Power => 1e-3,
                Quantity::Mass
                | Quantity::LoadMass
                | Quantity::Stiffness
                | Quantity::LoadStiffness
                | Quantity::LoadDamping
                | Quantity::DampingRatio
                | Quantity::PerVelocity
                | Quantity::PerLength => 1e3,
                _ => 1.0,
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::measure;

    #[test]
    fn factors_agree_with_the_units() {
        for quantity in [
            Quantity::Displacement,
            Quantity::Velocity,
            Quantity::Force,
            Quantity::LoadMass,
            Quantity::LoadStiffness,
            Quantity::LoadDamping,
            Quantity::Time,
            Quantity::Power,
            Quantity::PerVelocity,
            Quantity::PerLength,
            Quantity::Mass,
            Quantity::Stiffness,
            Quantity::ForcePerCurrent,
            Quantity::Capacitance,
            Quantity::Inductance,
        ] {
            for units in [UnitSystem::Si, UnitSystem::MmTonneSecond] {
                let unit = units.unit(quantity).expect("a unit");
                let (si, _) = quantity.si_unit().expect("a unit");
                let size = measure::convert(1.0, unit, si).expect("same dimension");
                let factor = units.si_per_unit(quantity).expect("known");
                assert!((factor / size - 1.0).abs() < 1e-15, "{quantity:?} {units:?}");
            }
            assert_eq!(UnitSystem::None.si_per_unit(quantity), None);
        }
        for units in UnitSystem::ALL {
            assert_eq!(UnitSystem::from_name(units.name()), Some(*units));
        }
    }
}
