//! `friction` of a system: the friction law of every contact and its mean under the dither, over the slip velocity.
//!
//! The mean at a slip velocity v is that of steady sliding with the surface of this contact at v and those of the others unchanged,
//! with the fast motion that the structure makes of the dither there. The fast motion depends on v only where friction takes part in
//! it: at contacts with normals or slopes, and under dither of a load or of friction. Otherwise it is computed once.

use quell_linear::averaging::{AveragedLaw, DitheredContact, DitheredSystem};
use quell_model::System;
use quell_model::profile::Profile;
use quell_model::system::{Contact, Input, InputTarget};
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::{has_equations, velocity_in_words};
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::fields::Fields;
use crate::noise::few_lines_of_system;
use crate::parallel::Parallel;
use crate::range;
use crate::run::friction::{FrictionCurve, FrictionPoint, coefficient_at, grid_of};
use crate::study::SystemStudy;

/// Friction of one contact over its slip velocity.
#[derive(Clone, Debug)]
pub struct ContactFriction {
    /// Name of the contact.
    pub name: String,
    /// Velocity of its surface.
    pub velocity: f64,
    /// Largest fast slip velocity in the study, or why it is unknown.
    pub fast_velocity: Result<f64, String>,
    /// Friction over the slip velocity.
    pub curve: FrictionCurve,
}

/// Friction of every contact of a system.
#[derive(Clone, Debug)]
pub struct SystemFriction {
    /// The contacts, in the order of the study.
    pub contacts: Vec<ContactFriction>,
    /// Warnings about the answer.
    pub warnings: Vec<String>,
}

/// The laws and their averages at slip velocities `at`, or on a grid for each contact.
///
/// # Errors
/// A measured frequency response, which has no equations.
pub fn run(study: &SystemStudy, at: Option<&[f64]>) -> Result<SystemFriction, Failure> {
    has_equations(study, "friction")?;
    let system = study.system();
    let given = averaged(system);
    let of = |(index, contact): (usize, &Contact)| {
        let law = given.as_ref().map_err(Clone::clone).map(|laws| &laws[index]);
        let fast_velocity =
            law.clone().and_then(|law| law.fast_velocity().map_err(|why| why.to_string()));
        let velocity = contact.surface_velocity.mean();
        let own = || grid_of(&contact.friction, velocity, *fast_velocity.as_ref().unwrap_or(&0.0));
        let at = at.map_or_else(own, <[f64]>::to_vec);
        let points = at.in_parallel(|&v| FrictionPoint {
            slip_velocity: v,
            coefficient: coefficient_at(&contact.friction, v),
            effective: mean_at(system, index, law.clone(), v),
        });
        let curve = FrictionCurve { points: points.collect(), limit: None, measured: None };
        ContactFriction { name: contact.name.clone(), velocity, fast_velocity, curve }
    };
    let contacts: Vec<ContactFriction> = system.contacts.iter().enumerate().map(of).collect();
    let mut warnings = study.warnings().to_vec();
    warnings.extend(few_lines_of_system(system));
    warnings.extend(contacts.iter().zip(&system.contacts).filter_map(|(found, contact)| {
        let speeds = found.curve.points.iter().map(|point| point.slip_velocity.abs());
        let fast = *found.fast_velocity.as_ref().unwrap_or(&0.0);
        let largest = speeds.fold(found.velocity.abs(), f64::max) + fast;
        range::at_contact(contact, largest, |speed| velocity_in_words(study, speed))
    }));
    Ok(SystemFriction { contacts, warnings })
}

/// The averaged law of every contact in the study's own sliding.
fn averaged(system: &System) -> Result<Vec<AveragedLaw>, String> {
    let prepared = DitheredSystem::new(system).map_err(|why| why.to_string())?;
    let average = prepared.average().map_err(|why| why.to_string())?;
    let contacts = average.contacts.iter().enumerate();
    let law = |(index, contact): (usize, &DitheredContact)| {
        prepared.fast().law(system, (index, contact.normal_load), None)
    };
    contacts.map(law).collect::<Result<_, _>>().map_err(|why| why.to_string())
}

/// Whether the fast motion depends on friction, and so on slip velocities.
fn depends_on_friction(system: &System) -> bool {
    let couples = |contact: &Contact| contact.normal.is_some() || contact.slope.is_some();
    let modulates = |input: &Input| !matches!(input.target, InputTarget::Force(_));
    system.contacts.iter().any(couples) || system.inputs.iter().any(modulates)
}

/// The mean at a slip velocity; `own` is the averaged law in the study's own sliding.
fn mean_at(
    system: &System,
    contact: usize,
    own: Result<&AveragedLaw, String>,
    v: f64,
) -> Result<quell_linear::averaging::Effective, String> {
    if system.contacts[contact].has_state() {
        return Err(
            "the mean of a contact with a state of its own is that of its periodic state; `response` gives its mean friction"
                .to_owned(),
        );
    }
    if !depends_on_friction(system) {
        return own?.at(v).map_err(|why| why.to_string());
    }
    let mut there = system.clone();
    there.contacts[contact].surface_velocity = Profile::constant(v);
    let laws = averaged(&there)?;
    laws[contact].at(v).map_err(|why| why.to_string())
}

impl ContactFriction {
    /// Why arrays have nulls; the reason of each entry is given with it.
    fn put_reasons(&self, fields: &mut Fields) {
        const WHY: &str = "the reason of each entry is given with its index";
        let points = || self.curve.points.iter();
        if points().any(|point| point.coefficient.is_err()) {
            fields.why("coefficient", WHY);
        }
        if points().any(|point| point.effective.is_err()) {
            for name in ["effective_coefficient", "effective_slope"] {
                fields.why(name, WHY).why(&format!("{name}_error"), WHY);
            }
        }
    }
}

impl SystemFriction {
    /// As JSON.
    pub fn json(&self, study: &SystemStudy) -> Json {
        let empty = || Fields::of_system(study.units());
        let mut fields = empty();
        fields.plain("ok", true);
        let contacts = self.contacts.iter().map(|contact| {
            let mut inner = empty();
            inner
                .plain("name", contact.name.as_str())
                .number("surface_velocity", Quantity::Velocity, contact.velocity)
                .known("fast_velocity", Quantity::Velocity, contact.fast_velocity.clone());
            contact.curve.put(&mut inner);
            contact.put_reasons(&mut inner);
            inner
        });
        fields.list("contacts", contacts.collect::<Vec<_>>());
        fields.plain("warnings", self.warnings.clone());
        fields.finish()
    }

    /// As a dataset, one row for each contact and slip velocity.
    pub fn dataset(&self, study: &SystemStudy) -> Dataset {
        let counts =
            self.contacts.iter().map(|contact| (contact.name.as_str(), contact.curve.points.len()));
        let rows = |of: &dyn Fn(&FrictionCurve) -> Vec<f64>| -> Vec<f64> {
            self.contacts.iter().flat_map(|contact| of(&contact.curve)).collect()
        };
        Dataset::of(&study.into(), "friction")
            .by_contact(counts)
            .array("slip_velocity", Quantity::Velocity, rows(&FrictionCurve::slip_velocities))
            .array("coefficient", Quantity::Ratio, rows(&FrictionCurve::coefficients))
            .array(
                "effective_coefficient",
                Quantity::Ratio,
                rows(&FrictionCurve::effective_coefficients),
            )
            .per_velocity("effective_slope", rows(&FrictionCurve::effective_slopes))
    }
}
