//! Friction of one contact over the slip velocity, and its columns.

use std::fmt::Display;

use quell_dynamics::orbit::OrbitVerdict;
use quell_dynamics::response::SteadyFriction;
use quell_linear::averaging::{AveragingError, Effective, SlopeSide};
use quell_model::Friction;
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::unknown::{LimitMean, MeasuredFriction, NoCoefficient, NoMeanOfContact, NotFreeMass};
use crate::fields::Fields;
use crate::run::system::velocity_in_words;
use crate::study::SystemStudy;
use crate::words::digits;

/// Friction of one contact over its slip velocity.
#[derive(Clone, Debug)]
pub struct ContactFriction {
    /// Name of the contact.
    pub name: String,
    /// Velocity of its surface.
    pub velocity: f64,
    /// Its mean normal load.
    pub normal_load: f64,
    /// Its law.
    pub law: Friction,
    /// Largest fast slip velocity in the study, or why it is unknown.
    pub fast_velocity: Result<f64, AveragingError>,
    /// Friction at the first slip velocity that was asked for, or at the velocity of the surface.
    pub at: FrictionPoint,
    /// Friction over the slip velocity.
    pub curve: FrictionCurve,
}

impl ContactFriction {
    /// The friction that was asked for, in one sentence.
    pub(super) fn sentence(&self, study: &SystemStudy) -> String {
        let slip = velocity_in_words(study, self.at.slip_velocity);
        let of = if study.system().contacts.len() > 1 {
            format!(" of contact {}", self.name)
        } else {
            String::new()
        };
        let dithered = study.system().is_dithered();
        let mean = match &self.at.effective {
            _ if !dithered => String::new(),
            Ok(found) => {
                format!("; averaged over the dither it is {}", digits(found.coefficient))
            }
            Err(_) => "; its average over the dither is unknown".to_owned(),
        };
        match &self.at.coefficient {
            Ok(value) => {
                let value = digits(*value);
                format!(
                    "The friction coefficient{of} at the slip velocity {slip} is {value}{mean}."
                )
            }
            Err(NoCoefficient::AtRest { static_coefficient }) => {
                let level = digits(*static_coefficient);
                format!("The friction coefficient{of} at rest is at most {level}{mean}.")
            }
            Err(why @ NoCoefficient::NotFinite(_)) => {
                format!(
                    "The friction coefficient{of} at the slip velocity {slip} is unknown: {why}."
                )
            }
        }
    }
}

/// Friction at one slip velocity.
#[derive(Clone, Debug)]
pub struct FrictionPoint {
    /// Slip velocity v_r.
    pub slip_velocity: f64,
    /// μ with the sign of v_r, dimensionless; or why it has no single value.
    pub coefficient: Result<f64, NoCoefficient>,
    /// μ̄, dimensionless, and its slope per unit of v_r, by finite-R averaging; of a contact with a state its mean over the periodic state;
    /// or why they are undefined.
    pub effective: Result<Effective, NoMeanOfContact>,
}

/// Friction of a contact over its slip velocity.
#[derive(Clone, Debug)]
pub struct FrictionCurve {
    /// Points in the requested order.
    pub points: Vec<FrictionPoint>,
    /// μ̄ and its slope in the limit of high dither frequency, R → ∞, where the masses are free, or why the contact has no such limit; `None`
    /// without dither, and of a contact with a state of its own.
    pub limit: Option<Result<Vec<LimitMean>, NotFreeMass>>,
    /// ⟨f/N⟩ of the steady response at each point, or why it has no value; `None` if it was not requested.
    pub measured: Option<Vec<MeasuredFriction>>,
}

impl FrictionCurve {
    /// μ̄ at each point; NaN where it is undefined.
    pub fn effective_coefficients(&self) -> Vec<f64> {
        self.averages(|found| found.coefficient)
    }

    /// μ at each point; NaN where it has no single value.
    pub fn coefficients(&self) -> Vec<f64> {
        self.column(|point| *point.coefficient.as_ref().unwrap_or(&f64::NAN))
    }

    /// The slip velocities.
    pub fn slip_velocities(&self) -> Vec<f64> {
        self.column(|point| point.slip_velocity)
    }

    /// μ̄′ at each point; NaN where it is undefined.
    pub fn effective_slopes(&self) -> Vec<f64> {
        self.averages(|found| found.slope)
    }

    /// ⟨f/N⟩ of the steady response at each point, NaN where it has no value; `None` if it was not requested.
    pub fn measured_coefficients(&self) -> Option<Vec<f64>> {
        self.measured_column(|found| found.coefficient)
    }

    /// Fraction of the period that the steady response sticks, in the same way.
    pub fn measured_stick_fractions(&self) -> Option<Vec<f64>> {
        self.measured_column(|found| found.stick_fraction)
    }

    /// 1 where the steady response is stable, 0 where it is unstable, NaN where it has no value or its stability is not decided.
    pub fn measured_stability(&self) -> Option<Vec<f64>> {
        self.measured_column(|found| match found.verdict {
            OrbitVerdict::Stable => 1.0,
            OrbitVerdict::Unstable => 0.0,
            OrbitVerdict::Undecided => f64::NAN,
        })
    }

    /// The largest slip speed of the points.
    pub(crate) fn fastest(&self) -> f64 {
        self.points.iter().map(|point| point.slip_velocity.abs()).fold(0.0, f64::max)
    }

    /// μ̄ or its slope in the limit R → ∞, NaN where it is undefined; `None` where the limit is not given.
    pub(super) fn limit_column(&self, value: fn(&Effective) -> f64) -> Option<Vec<f64>> {
        let limit = self.limit.as_ref()?.as_ref().ok()?;
        Some(limit.iter().map(|found| found.as_ref().map_or(f64::NAN, value)).collect())
    }

    fn measured_column(&self, value: fn(&SteadyFriction) -> f64) -> Option<Vec<f64>> {
        let measured = self.measured.as_ref()?;
        Some(measured.iter().map(|found| found.as_ref().map_or(f64::NAN, value)).collect())
    }

    fn column(&self, value: impl Fn(&FrictionPoint) -> f64) -> Vec<f64> {
        self.points.iter().map(value).collect()
    }

    fn averages(&self, value: fn(&Effective) -> f64) -> Vec<f64> {
        self.column(|point| point.effective.as_ref().map_or(f64::NAN, value))
    }

    /// The columns, and why values are missing.
    pub(super) fn put(&self, fields: &mut Fields) {
        fields
            .numbers("slip_velocity", Quantity::Velocity, &self.slip_velocities())
            .numbers("coefficient", Quantity::Ratio, &self.coefficients())
            .numbers("effective_coefficient", Quantity::Ratio, &self.effective_coefficients())
            .numbers(
                "effective_coefficient_error",
                Quantity::Ratio,
                &self.averages(|found| found.coefficient_error),
            )
            .per_velocity("effective_slope", &self.effective_slopes())
            .per_velocity("effective_slope_error", &self.averages(|found| found.slope_error));
        let one_sided = self.points.iter().map(|point| {
            point.effective.as_ref().is_ok_and(|found| found.side == SlopeSide::Outer)
        });
        fields.plain("effective_slope_one_sided", one_sided.collect::<Vec<bool>>());
        missing(fields, &["coefficient"], self.points.iter().map(|point| &point.coefficient));
        let averages = [
            "effective_coefficient",
            "effective_coefficient_error",
            "effective_slope",
            "effective_slope_error",
        ];
        missing(fields, &averages, self.points.iter().map(|point| &point.effective));
        self.put_limit(fields);
        self.put_measured(fields);
    }

    /// The columns of the limit R → ∞, if they are given.
    fn put_limit(&self, fields: &mut Fields) {
        let names = ["limit_effective_coefficient", "limit_effective_slope"];
        match &self.limit {
            None => {}
            Some(Err(why)) => {
                for name in names {
                    fields.unknown(name, why);
                }
            }
            Some(Ok(limit)) => {
                let column =
                    |value: fn(&Effective) -> f64| self.limit_column(value).unwrap_or_default();
                fields
                    .numbers(names[0], Quantity::Ratio, &column(|found| found.coefficient))
                    .per_velocity(names[1], &column(|found| found.slope));
                missing(fields, &names, limit.iter());
            }
        }
    }

    /// The columns of the measured friction, if it was requested.
    fn put_measured(&self, fields: &mut Fields) {
        let (Some(measured), Some(coefficients), Some(stuck)) =
            (&self.measured, self.measured_coefficients(), self.measured_stick_fractions())
        else {
            return;
        };
        let words = |value: fn(&SteadyFriction) -> Json| -> Vec<Json> {
            measured.iter().map(|found| found.as_ref().map_or(Json::Null, value)).collect()
        };
        fields
            .numbers("measured_coefficient", Quantity::Ratio, &coefficients)
            .numbers("measured_stick_fraction", Quantity::Ratio, &stuck)
            .plain("measured_verdict", words(|found| found.verdict.name().into()))
            .plain("measured_base", words(|found| found.base.into()));
        let names = [
            "measured_coefficient",
            "measured_stick_fraction",
            "measured_verdict",
            "measured_base",
        ];
        missing(fields, &names, measured.iter());
    }
}

/// Why columns have nulls: the reason of each entry, and that entries have reasons.
fn missing<'a, V: 'a, E: Display + 'a>(
    fields: &mut Fields,
    names: &[&str],
    values: impl Iterator<Item = &'a Result<V, E>>,
) {
    let mut any = false;
    for (index, why) in
        values.enumerate().filter_map(|(at, found)| Some((at, found.as_ref().err()?)))
    {
        any = true;
        for name in names {
            fields.why(&format!("{name}[{index}]"), why);
        }
    }
    for name in names.iter().filter(|_| any) {
        fields.why(name, "the reason of each entry is given with its index");
    }
}
