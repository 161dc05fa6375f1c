//! `friction`: the friction law of every contact and its mean under the dither, over the slip velocity.

mod curve;
pub mod export;
mod means;
mod unknown;
mod warnings;

use quell_linear::averaging::Effective;
use quell_model::System;
use quell_model::units::Quantity;
use serde_json::Value as Json;

pub use self::curve::{ContactFriction, FrictionCurve, FrictionPoint};
pub use self::unknown::{
    LimitMean, MeasuredFriction, NoCoefficient, NoMeanOfContact, NoMeasuredFriction, NotFinite,
    NotFreeMass,
};

use super::system::has_equations;
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::dataset::Dataset;
use crate::fields::Fields;
use crate::noise::few_lines;
use crate::run::law;
use crate::study::SystemStudy;

/// Friction of every contact of a study.
#[derive(Clone, Debug)]
pub struct ContactCurves {
    /// The contacts, in the order of the study.
    pub contacts: Vec<ContactFriction>,
    /// Warnings about the answer.
    pub warnings: Vec<String>,
}

/// The laws and their averages at slip velocities `at`, or on a grid for each contact; `measured` adds friction measured on steady
/// responses (4.30), (4.31).
///
/// # Errors
/// A measured frequency response, which has no equations; measured friction of other systems than one mass.
pub fn run(
    study: &SystemStudy,
    at: Option<&[f64]>,
    measured: bool,
) -> Result<ContactCurves, Failure> {
    has_equations(study, "friction")?;
    let system = study.system();
    let mass = if measured { Some(one_mass(system)?) } else { None };
    let (mut contacts, mut warnings) = (Vec::new(), study.warnings().to_vec());
    warnings.extend(few_lines(system));
    warnings.extend(warnings::slow_dither(study));
    for (contact, means) in system.contacts.iter().zip(means::contacts(system)) {
        let velocity = contact.surface_velocity.mean();
        let first = at.and_then(|at| at.first()).copied().unwrap_or(velocity);
        let at = at.map_or_else(|| means.grid(), <[f64]>::to_vec);
        let curve = FrictionCurve {
            points: means.points(&at),
            limit: means.limits(&at),
            measured: mass.as_ref().map(|mass| means::measured(mass.belt(), &at)),
        };
        let found = ContactFriction {
            name: contact.name.clone(),
            velocity,
            normal_load: means.normal_load(),
            law: contact.friction.clone(),
            fast_velocity: means.fast_velocity(),
            at: means.point(first),
            curve,
        };
        warnings.extend(warnings::of_contact(study, contact, &means, &found));
        contacts.push(found);
    }
    Ok(ContactCurves { contacts, warnings })
}

/// The mass whose steady responses measure friction.
fn one_mass(system: &System) -> Result<quell_model::OneMass, Failure> {
    system.one_mass().filter(|mass| mass.direction() > 0.0).ok_or_else(|| {
        let allowed = "left out for other studies than one mass with a rigid contact on a surface of constant velocity, not below 0: \
                       `response` gives the mean friction of every contact in the steady response";
        let origin = Origin::Argument("--measured");
        Complaint::new(Fault::Conflict, "--measured", origin, Json::Null, allowed).into()
    })
}

impl ContactCurves {
    /// The friction of the first contact at the slip velocity that was asked for, or at the velocity of its surface.
    pub fn sentence(&self, study: &SystemStudy) -> String {
        let first = self.contacts.first();
        first.map_or_else(
            || "The study has no contact.".to_owned(),
            |contact| contact.sentence(study),
        )
    }

    /// That of every further contact.
    pub fn notes(&self, study: &SystemStudy) -> Vec<String> {
        self.contacts.iter().skip(1).map(|contact| contact.sentence(study)).collect()
    }

    /// As JSON.
    pub fn json(&self, study: &SystemStudy) -> Json {
        let empty = || Fields::in_units(study.units());
        let mut fields = empty();
        fields.plain("ok", true).plain("sentence", self.sentence(study));
        let contacts = self.contacts.iter().map(|contact| {
            let mut inner = empty();
            inner
                .plain("name", contact.name.as_str())
                .number("surface_velocity", Quantity::Velocity, contact.velocity)
                .known("fast_velocity", Quantity::Velocity, contact.fast_velocity.clone())
                .nested("law", law::fields(&contact.law, contact.normal_load, &empty));
            contact.curve.put(&mut inner);
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
        // A column that some contact has; the rows of others are empty.
        let some = |of: &dyn Fn(&FrictionCurve) -> Option<Vec<f64>>| -> Option<Vec<f64>> {
            let has = self.contacts.iter().any(|contact| of(&contact.curve).is_some());
            let filled = |curve: &FrictionCurve| {
                of(curve).unwrap_or_else(|| vec![f64::NAN; curve.points.len()])
            };
            has.then(|| rows(&filled))
        };
        let limit = |value: fn(&Effective) -> f64| some(&|curve| curve.limit_column(value));
        let mut dataset = Dataset::of(&study.into(), "friction")
            .by_contact(counts)
            .array("slip_velocity", Quantity::Velocity, rows(&FrictionCurve::slip_velocities))
            .array("coefficient", Quantity::Ratio, rows(&FrictionCurve::coefficients))
            .array(
                "effective_coefficient",
                Quantity::Ratio,
                rows(&FrictionCurve::effective_coefficients),
            )
            .per_velocity("effective_slope", rows(&FrictionCurve::effective_slopes));
        if let Some(slopes) = limit(|found| found.slope) {
            dataset = dataset.per_velocity("limit_effective_slope", slopes);
        }
        for (name, values) in [
            ("limit_effective_coefficient", limit(|found| found.coefficient)),
            ("measured_coefficient", some(&FrictionCurve::measured_coefficients)),
            ("measured_stick_fraction", some(&FrictionCurve::measured_stick_fractions)),
            ("measured_stable", some(&FrictionCurve::measured_stability)),
        ] {
            if let Some(values) = values {
                dataset = dataset.array(name, Quantity::Ratio, values);
            }
        }
        dataset
    }
}
