//! The units of a disc's answers.
//!
//! A disc is computed in the numbers of its equations: ω_ref, r₀ and M_p. A study that has units, or gives a load, its speed or the dither
//! in SI, is answered in its units: every number of an answer whose unit is one of those is converted here, with the name of its unit.

use quell_model::units::{DiscScales, Quantity, UnitSystem};
use serde_json::Value as Json;

use crate::dataset::Dataset;
use crate::study::DiscStudy;

/// The unit of friction on a disc, in the numbers of its equations.
pub const FORCE: &str = "r₀M_pω_ref²";

/// The unit of its power.
pub(crate) const POWER: &str = "r₀²M_pω_ref³";

/// The unit of a friction f*.
pub(crate) const FRICTION: &str = "1 (f*)";

/// Scales and units of a study that is answered in units.
#[derive(Clone, Copy, Debug)]
pub struct DiscUnits {
    scales: DiscScales,
    units: UnitSystem,
}

impl DiscUnits {
    /// Those of a study; `None` where it is answered in the numbers of the equations.
    pub fn of(study: &DiscStudy) -> Option<Self> {
        let reference_hz = study.reference_hz().filter(|_| study.is_si())?;
        let plain = DiscScales { reference_hz, plate_mass_kg: None, load_radius_m: None };
        let units = match study.file_units() {
            UnitSystem::None => UnitSystem::Si,
            units => units,
        };
        // Forces and lengths are relative to the radius of each load: one factor for all where it is one radius.
        let mut radii = study.radii().iter();
        let first = radii.next();
        let same = radii.all(|radius| Some(radius) == first);
        Some(Self { scales: study.scales(0).filter(|_| same).unwrap_or(plain), units })
    }

    /// What one unit of the equations is in the units of the study, and that unit; `None` for other units and where the study does not
    /// determine it. A number of the name `name` in ω_ref is a growth rate or an angular frequency.
    pub fn one(&self, name: &str, unit: &str) -> Option<(f64, &'static str)> {
        let omega = self.scales.angular_frequency();
        let force = || self.scales.si_per_unit(Quantity::LoadFriction);
        let velocity = || self.scales.si_per_unit(Quantity::Velocity);
        let (quantity, si) = match unit {
            "ω_ref" if name.contains("growth") => return Some((omega, "1/s")),
            "ω_ref" => return Some((omega, "rad/s")),
            "1/ω_ref" => return Some((1.0 / omega, "s")),
            "r₀" => return self.length(self.scales.load_radius_m?),
            "r₀ω_ref" => (Quantity::Velocity, velocity()?),
            FORCE | FRICTION | "f*" => (Quantity::Force, force()?),
            POWER => (Quantity::Power, force()? * velocity()?),
            _ => return None,
        };
        Some((si / self.units.si_per_unit(quantity)?, self.units.unit(quantity)?))
    }

    /// The unit system of the answers.
    pub(crate) fn system(&self) -> UnitSystem {
        self.units
    }

    /// What one of the equations is at a load of these scales, and its unit.
    pub(crate) fn one_at(
        &self,
        scales: &DiscScales,
        quantity: Quantity,
    ) -> Option<(f64, &'static str)> {
        let unit = self.units.unit(quantity)?;
        Some((scales.si_per_unit(quantity)? / self.units.si_per_unit(quantity)?, unit))
    }

    /// A length in metres in the units of the study, and that unit.
    pub(crate) fn length(&self, metres: f64) -> Option<(f64, &'static str)> {
        let quantity = Quantity::Displacement;
        Some((metres / self.units.si_per_unit(quantity)?, self.units.unit(quantity)?))
    }

    /// Converts the numbers whose units an object of an answer names, and those of its parts.
    fn convert(&self, object: &mut Json, known: &[(String, f64)]) {
        let Some(fields) = object.as_object_mut() else {
            let parts = object.as_array_mut().into_iter().flatten();
            return parts.for_each(|part| self.convert(part, known));
        };
        let mut known = known.to_vec();
        for (name, unit) in
            fields.get_mut("units").and_then(Json::as_object_mut).into_iter().flatten()
        {
            // The units of an object stand for those around it.
            known.retain(|(other, _)| other != name);
            if let Some((factor, own)) = unit.as_str().and_then(|unit| self.one(name, unit)) {
                known.push((name.clone(), factor));
                *unit = own.into();
            }
        }
        for (name, value) in fields
            .iter_mut()
            .filter(|(name, _)| !["units", "why", "shares"].contains(&name.as_str()))
        {
            match known.iter().find(|(other, _)| other == name) {
                Some((_, factor)) if !has_objects(value) => scale(value, *factor),
                _ => self.convert(value, &known),
            }
        }
    }
}

/// A number of the name `name` in ω_ref in the units of a study, and that unit ([`DiscUnits::one`]).
pub(crate) fn from_reference(study: &DiscStudy, name: &str, value: f64) -> (f64, &'static str) {
    let own = (1.0, "ω_ref");
    let (one, unit) = DiscUnits::of(study).and_then(|units| units.one(name, own.1)).unwrap_or(own);
    (one * value, unit)
}

/// Whether a value is an object or has some.
fn has_objects(value: &Json) -> bool {
    match value {
        Json::Array(list) => list.iter().any(has_objects),
        value => value.is_object(),
    }
}

/// Multiplies a number, or the numbers of a list.
fn scale(value: &mut Json, factor: f64) {
    match value {
        Json::Array(list) => list.iter_mut().for_each(|value| scale(value, factor)),
        value => {
            if let Some(number) = value.as_f64() {
                *value = (factor * number).into();
            }
        }
    }
}

/// An answer about a disc in the units of its study.
pub fn in_units_of_study(study: &DiscStudy, mut answer: Json) -> Json {
    if let Some(units) = DiscUnits::of(study) {
        units.convert(&mut answer, &[]);
    }
    answer
}

/// A dataset about a disc in the units of its study.
pub fn dataset_in_units(study: &DiscStudy, dataset: Dataset) -> Dataset {
    match DiscUnits::of(study) {
        Some(units) => dataset.rescaled(|name, unit| units.one(name, unit)),
        None => dataset,
    }
}
