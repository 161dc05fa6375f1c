//! Critical speeds of a disc, and its deflection under static loads.

use quell_disc::static_load::{CriticalSpeed, critical_speeds, deflections};
use quell_numerics::eigen::EigenError;
use serde_json::{Map, Value as Json, json};

use crate::disc_units::DiscUnits;
use crate::study::DiscStudy;

/// Deflections at the loads.
#[derive(Clone, Debug, PartialEq)]
pub struct StaticDeflection {
    /// At the speed of the study, over the radius of each load; `None` where the disc has no unique equilibrium.
    pub deflections: Option<Vec<f64>>,
    /// The same at rest; `None` also under a friction law, which requires sliding.
    pub at_rest: Option<Vec<f64>>,
}

/// Critical speeds, and deflections where the study has static loads.
#[derive(Clone, Debug, PartialEq)]
pub struct Critical {
    /// The critical speeds, ascending.
    pub speeds: Vec<CriticalSpeed>,
    /// Deflections under the static loads; `None` without any.
    pub deflection: Option<StaticDeflection>,
}

/// Critical speeds and deflections of a study.
///
/// # Errors
/// [`EigenError`] if a matrix overflows.
pub(super) fn run(study: &DiscStudy) -> Result<Critical, EigenError> {
    let (disc, parts) = (study.disc(), study.parts());
    let speeds = critical_speeds(disc);
    if disc.loads().iter().all(|load| load.static_load == 0.0) {
        return Ok(Critical { speeds, deflection: None });
    }
    let at_rest = match disc.at_speed(0.0) {
        Ok(still) => deflections(&still, parts)?,
        Err(_) => None,
    };
    let deflections = deflections(disc, parts)?;
    Ok(Critical { speeds, deflection: Some(StaticDeflection { deflections, at_rest }) })
}

impl Critical {
    /// A warning for each critical speed near which a static load acts.
    pub fn warnings(&self, study: &DiscStudy) -> Vec<String> {
        let near = self.speeds.iter().filter(|critical| critical.is_near());
        let near = near.filter(|_| self.deflection.is_some());
        near.map(|critical| {
            let diameters = study.disc().modes()[critical.mode].diameters;
            format!(
                "the speed {} ω_ref is near {} ω_ref, the critical speed of a mode with {diameters} nodal diameters: the static \
                 load meets a wave at rest and deflects the disc strongly",
                study.disc().speed(),
                critical.speed
            )
        })
        .collect()
    }

    /// Adds critical speeds and deflections to an answer, and the reasons of nulls.
    pub(super) fn put(&self, study: &DiscStudy, object: &mut Json, why: &mut Map<String, Json>) {
        let one = |critical: &CriticalSpeed| {
            json!({
                "mode": critical.mode,
                "diameters": study.disc().modes()[critical.mode].diameters,
                "speed": critical.speed,
                "near": critical.is_near(),
            })
        };
        object["critical_speeds"] = self.speeds.iter().map(one).collect();
        let Some(found) = &self.deflection else { return };
        // Each load has a radius of its own.
        let units = DiscUnits::of(study);
        let radius = |load| units?.length(study.scales(load)?.load_radius_m?);
        let radii: Option<Vec<_>> = (0..study.disc().loads().len()).map(radius).collect();
        let radii = radii.unwrap_or_else(|| vec![(1.0, "r₀"); study.disc().loads().len()]);
        for (name, over_radii) in
            [("deflection", &found.deflections), ("deflection_at_rest", &found.at_rest)]
        {
            let deflections = over_radii.as_ref().map(|list| {
                list.iter().zip(&radii).map(|(w, (radius, _))| w * radius).collect::<Vec<f64>>()
            });
            object[name] = json!(deflections);
            object["units"][name] = radii.first().map_or("r₀", |(_, unit)| unit).into();
        }
        let singular = "the disc has no unique equilibrium under the static load";
        if found.deflections.is_none() {
            why.insert("deflection".to_owned(), singular.into());
        }
        if found.at_rest.is_none() {
            let law = study.disc().law().is_some();
            let reason = if law { "a friction law requires sliding" } else { singular };
            why.insert("deflection_at_rest".to_owned(), reason.into());
        }
    }
}
