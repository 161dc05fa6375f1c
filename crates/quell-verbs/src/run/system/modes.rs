//! `modes` of a system: frequencies, damping and shapes with the springs of the contacts and without friction.

use std::f64::consts::TAU;

use quell_linear::linearised::{FrictionSlopes, Linearised};
use quell_linear::rigid::rigid_once;
use quell_linear::spectrum::{SmallMotion, spectrum};
use quell_model::System;
use quell_model::units::Quantity;
use quell_numerics::order::ascending_by;
use serde_json::Value as Json;

use super::{failed, has_equations};
use crate::complaint::Failure;
use crate::dataset::{Array, Dataset};
use crate::fields::Fields;
use crate::study::{SystemStudy, UnitSystem};
use crate::words::{counted, digits};

/// Natural motions of a system without friction, the lowest first.
#[derive(Clone, Debug, PartialEq)]
pub struct SystemModes {
    /// The motions, without conjugates; rigid ones once, with λ = 0.
    pub modes: Vec<SmallMotion>,
}

/// The modes of a study.
///
/// # Errors
/// [`Failure::Failed`] if a matrix overflows or the mass is singular.
pub fn run(study: &SystemStudy) -> Result<SystemModes, Failure> {
    has_equations(study, "modes")?;
    of(study.system())
}

/// The modes of a system.
///
/// # Errors
/// [`Failure::Failed`] if a matrix overflows or the mass is singular.
pub(crate) fn of(system: &System) -> Result<SystemModes, Failure> {
    let linear = Linearised::frictionless(system).map_err(|why| failed("modes", why))?;
    let none = FrictionSlopes { force: 0.0, by_velocity: 0.0, by_load: 0.0, bristles: None };
    let found = spectrum(&linear, &vec![none; system.contacts.len()]);
    let found = found.map_err(|why| failed("modes", why))?;
    let motions = rigid_once(&linear, found.motions).into_iter();
    let mut modes: Vec<SmallMotion> =
        motions.filter(|motion| motion.eigenvalue.im >= 0.0).collect();
    ascending_by(&mut modes, natural);
    Ok(SystemModes { modes })
}

/// |λ|.
pub fn natural(motion: &SmallMotion) -> f64 {
    quell_numerics::polar::modulus(motion.eigenvalue)
}

impl SystemModes {
    /// The lowest and the highest natural frequency.
    pub fn sentence(&self, study: &SystemStudy) -> String {
        let (noun, factor, unit) = match study.units() {
            UnitSystem::None => ("natural angular frequency", 1.0, ""),
            _ => ("natural frequency", 1.0 / TAU, " Hz"),
        };
        let words = |motion: &SmallMotion| digits(factor * natural(motion)) + unit;
        let mut oscillating =
            self.modes.iter().filter(|motion| motion.eigenvalue.im > motion.error);
        let Some(lowest) = oscillating.next() else {
            return "No motion of this structure oscillates.".to_owned();
        };
        let damping = digits(lowest.damping_ratio());
        let of_lowest = format!("{}, with the damping ratio {damping}", words(lowest));
        match oscillating.next_back().map(words) {
            None => format!("The {noun} is {of_lowest}."),
            Some(highest) => format!("The lowest {noun} is {of_lowest}; the highest is {highest}."),
        }
    }

    /// How many motions oscillate, and how many do not.
    pub fn notes(&self) -> Vec<String> {
        let count =
            |of: fn(&SmallMotion) -> bool| self.modes.iter().filter(|mode| of(mode)).count();
        let oscillating = count(|mode| mode.eigenvalue.im > mode.error);
        let others = self.modes.len() - oscillating;
        let many = (oscillating > 1).then(|| format!("{oscillating} motions oscillate."));
        let rest = (others > 0).then(|| {
            format!(
                "{} neither oscillate{} nor have a natural frequency.",
                counted(others, "motion"),
                if others == 1 { "s" } else { "" }
            )
        });
        many.into_iter().chain(rest).collect()
    }

    /// As JSON.
    pub fn json(&self, study: &SystemStudy) -> Json {
        let mut fields = Fields::in_units(study.units());
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("coordinates", study.system().structure.names());
        let modes = self.modes.iter().map(|motion| {
            let mut inner = Fields::in_units(study.units());
            let shape: Vec<f64> = motion.shape.iter().map(|z| z.re).collect();
            let imaginary: Vec<f64> = motion.shape.iter().map(|z| z.im).collect();
            inner
                .number("frequency", Quantity::FrequencyRatio, natural(motion))
                .number("damping_ratio", Quantity::Ratio, motion.damping_ratio())
                .plain("shape", shape)
                .plain("shape_imaginary", imaginary);
            inner
        });
        fields.list("modes", modes.collect::<Vec<_>>());
        fields.plain("warnings", study.warnings());
        fields.finish()
    }

    /// As a dataset, one row per mode.
    pub fn dataset(&self, study: &SystemStudy) -> Dataset {
        let column =
            |of: &dyn Fn(&SmallMotion) -> f64| self.modes.iter().map(of).collect::<Vec<f64>>();
        let number = (1..=self.modes.len()).map(|index| index as f64).collect();
        let unit = study.units().unit(Quantity::FrequencyRatio).unwrap_or("1");
        let mut dataset = Dataset::of(&study.into(), "modes")
            .axis("mode", Quantity::Count, number)
            .with(Array::new("frequency", unit, column(&natural)))
            .with(Array::new("damping_ratio", "1", column(&SmallMotion::damping_ratio)));
        for (index, name) in study.system().structure.names().iter().enumerate() {
            let values = column(&|motion| motion.shape[index].re);
            dataset = dataset.with(Array::new(format!("shape_{name}"), "1", values));
        }
        dataset
    }
}
