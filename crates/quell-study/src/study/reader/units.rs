//! The units in which a study gives its numbers, and those of its equations.

use std::f64::consts::TAU;

use quell_model::units::{DiscScales, Quantity, Scales, UnitSystem, measure};

use crate::study::vocabulary::KeyUnit;

/// What one number of the equations is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::study) enum EquationScale {
    /// The number of the file.
    OfTheFile,
    /// Numbers of a belt, over its mass and stiffness: in the units of the file, or in SI of a file without units; not known where
    /// they are not given or wrong.
    Belt(Option<Scales>),
    /// Numbers of a disc, over its plate and reference frequency; not known without material or frequencies in hertz.
    Disc(Option<DiscScales>),
}

/// The units of a study.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::study) struct StudyUnits {
    /// Those of bare numbers.
    pub(in crate::study) file: UnitSystem,
    /// Those of the equations.
    pub(in crate::study) scale: EquationScale,
    /// The natural frequency of a system of one coordinate in numbers of the file, to which a frequency ratio refers.
    pub(in crate::study) natural_frequency: Option<f64>,
}

impl StudyUnits {
    /// Whether the numbers of the equations are those of the file.
    pub(super) fn is_of_the_file(self) -> bool {
        self.scale == EquationScale::OfTheFile
    }

    /// Whether keys with the suffix of a unit and numbers with a unit can be read.
    pub(in crate::study) fn take_suffixes(self) -> bool {
        !self.file.is_none()
            || matches!(self.scale, EquationScale::Belt(Some(_)) | EquationScale::Disc(_))
    }

    /// What a number with a unit needs.
    pub(super) fn needed(self) -> &'static str {
        match self.scale {
            EquationScale::OfTheFile => "system.units = \"SI\" or \"mm-t-s\"",
            EquationScale::Belt(_) => {
                "belt.mass and belt.stiffness, which give the study its units"
            }
            EquationScale::Disc(_) => {
                "the size and material of the plate (disc.youngs_modulus_pa, density_kg_per_m3, thickness_m and outer_radius_m, with \
                 modes that are computed from it and radius_ratio of the load), or modes in hertz, with disc.plate_mass_kg for masses, \
                 dampers and springs, and disc.outer_radius_m and radius_ratio of the load for friction"
            }
        }
    }

    /// A number that a key gives in a unit, in the numbers of the equations; `None` without the scales for it.
    pub(in crate::study) fn in_equations(
        self,
        number: f64,
        quantity: Quantity,
        unit: KeyUnit,
    ) -> Option<f64> {
        let Some((si_unit, _)) = quantity.si_unit() else { return Some(number) };
        let unit = match unit {
            KeyUnit::Ratio if self.is_of_the_file() && quantity == Quantity::FrequencyRatio => {
                return Some(number * self.natural_frequency?);
            }
            KeyUnit::Ratio => return Some(number),
            KeyUnit::Suffix(unit) => Some(unit),
            KeyUnit::Study if self.file.is_none() => {
                return Some(number / bare_per_one(self.scale, quantity));
            }
            KeyUnit::Study => None,
        };
        // A key in rpm is not in the SI unit of its quantity.
        let si = |number: f64| match unit {
            Some(unit) if unit != si_unit => measure::convert(number, unit, si_unit),
            _ => Some(number),
        };
        let frequency = quantity == Quantity::FrequencyRatio;
        match (self.scale, unit) {
            (EquationScale::OfTheFile, None) => Some(number),
            // A product rounds once more than a quotient: hertz are multiplied by 2π exactly as written.
            (EquationScale::OfTheFile, Some(_)) if frequency => Some(si(number)? * TAU),
            (EquationScale::OfTheFile, Some(_)) => {
                Some(si(number)? * (1.0 / self.file.si_per_unit(quantity)?))
            }
            (EquationScale::Belt(scales), None) if frequency => {
                Some(number / scales?.angular_frequency())
            }
            (EquationScale::Belt(scales), None) => Some(number / scales?.per_unit(quantity)),
            (EquationScale::Belt(scales), Some(_)) => {
                let scales = scales?;
                let unit = if frequency { 1.0 } else { scales.units().si_per_unit(quantity)? };
                Some(si(number)? / unit / scales.per_unit(quantity))
            }
            (EquationScale::Disc(scales), None) if frequency => {
                Some(number / TAU / scales?.si_per_unit(quantity)?)
            }
            (EquationScale::Disc(scales), None) => {
                Some(number * self.file.si_per_unit(quantity)? / scales?.si_per_unit(quantity)?)
            }
            (EquationScale::Disc(scales), Some(_)) => {
                Some(si(number)? / scales?.si_per_unit(quantity)?)
            }
        }
    }

    /// A number that a key gives in a unit, in the unit of bare numbers; `None` without the scales for it.
    pub(in crate::study) fn in_file(
        self,
        number: f64,
        quantity: Quantity,
        unit: KeyUnit,
    ) -> Option<f64> {
        match (unit, quantity.si_unit()) {
            (KeyUnit::Suffix(unit), Some((si_unit, _))) if !self.file.is_none() => {
                let si = measure::convert(number, unit, si_unit)?;
                let frequency = quantity == Quantity::FrequencyRatio;
                Some(if frequency { si * TAU } else { si / self.file.si_per_unit(quantity)? })
            }
            (KeyUnit::Suffix(_), Some(_)) => self.in_equations(number, quantity, unit),
            _ => Some(number),
        }
    }

    /// What a key in a unit gives for one number of the equations; `None` without the scales for it.
    pub(in crate::study) fn written_per_one(
        self,
        quantity: Quantity,
        unit: KeyUnit,
    ) -> Option<f64> {
        self.in_equations(1.0, quantity, unit).map(f64::recip)
    }

    /// One watt or newton or another SI unit in the numbers of the equations; `None` without the scales for it.
    pub(in crate::study) fn of_si(self, quantity: Quantity) -> Option<f64> {
        let unit = quantity.si_unit().map_or(KeyUnit::Study, |(unit, _)| KeyUnit::Suffix(unit));
        self.in_equations(1.0, quantity, unit)
    }
}

/// What a bare number of a study without units is for one number of the equations: a damping coefficient c is 2ζ of unit mass and
/// stiffness.
fn bare_per_one(scale: EquationScale, quantity: Quantity) -> f64 {
    match (scale, quantity) {
        (EquationScale::Belt(_), Quantity::DampingRatio) => 2.0,
        _ => 1.0,
    }
}
