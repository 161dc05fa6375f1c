//! The exact motion of a study as a sensor would record it: what `compare` and `fit --record` set against measurements.
//!
//! Every kind of study gives its system, the observed row and the start; the motion is that of the engine for systems.

use quell_dynamics::motion::{Motion, MotionStart, ReadingSampler};
use quell_input::record::TimeSeries;
use quell_model::RecordedQuantity;
use quell_model::System;
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::failed;
use super::system::has_equations;
use super::system::periods::slowest_period;
use super::system::start::start_of;
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::study::SystemStudy;

/// A study as the structure that a record shows.
#[derive(Clone, Debug)]
pub struct ObservedMotion {
    /// The structure.
    pub system: System,
    /// The observed row over its displacements.
    pub row: Vec<f64>,
    /// Where its runs begin.
    pub start: MotionStart,
    /// Bound on the last terms of a step relative to the load, if the study has one.
    pub tolerance: Option<f64>,
    /// Units of the equations.
    pub scales: RecordScales,
    /// Period of the slowest oscillation; `None` if nothing oscillates.
    pub period: Option<f64>,
}

/// How many units of the equations a unit of a record is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecordScales {
    /// Of a second; `None` for a study without seconds.
    pub second: Option<f64>,
    /// Of a metre; `None` for a study without metres.
    pub metre: Option<f64>,
    /// Of a plain number that is a time.
    pub plain_time: f64,
}

impl ObservedMotion {
    /// The motion of a study.
    ///
    /// # Errors
    /// A measured frequency response; a start that does not exist.
    pub fn of(study: &SystemStudy, verb: &str) -> Result<Self, Failure> {
        has_equations(study, verb)?;
        let metre = study.units().si_per_unit(Quantity::Displacement).map(|metre| 1.0 / metre);
        let second = study.time_per_second();
        let plain = study.scaled_time().filter(|time| time.plain_in_seconds);
        let scales =
            RecordScales { second, metre, plain_time: plain.map_or(1.0, |time| time.per_second) };
        Ok(Self {
            system: study.system().clone(),
            row: study.observe(),
            start: start_of(study)?,
            tolerance: study.tolerance(),
            scales,
            period: slowest_period(study, "--settle").ok(),
        })
    }

    /// Readings at ascending times of the run, in units of the equations, and their rates of change.
    ///
    /// # Errors
    /// [`Failure::Failed`] where the engine stops.
    pub fn readings(
        &self,
        quantity: RecordedQuantity,
        times: &[f64],
    ) -> Result<(Vec<f64>, Vec<f64>), Failure> {
        let motion = Motion::new(&self.system).map_err(failed)?;
        let order = derivatives(quantity);
        let mut sampler = ReadingSampler::new(&self.row, order, times);
        let last = times.last().copied().unwrap_or(self.start.time);
        // Beyond the last sample, which may round to just after it.
        let until = last + motion.time_scale() + 1e-9 * last.abs();
        let tolerance = motion.run_tolerance(self.tolerance);
        motion.run(&self.start, until, tolerance, &mut sampler).map_err(failed)?;
        Ok((sampler.values, sampler.rates))
    }
}

/// Number of derivatives of the displacement that a quantity is.
fn derivatives(quantity: RecordedQuantity) -> usize {
    match quantity {
        RecordedQuantity::Displacement => 0,
        RecordedQuantity::Velocity => 1,
        RecordedQuantity::Acceleration => 2,
    }
}

/// Units of a record in those of the equations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecordUnits {
    /// Time of the equations in one of the record.
    pub time: f64,
    /// Reading of the record in one of the equations.
    pub reading: f64,
}

impl RecordScales {
    /// The units of a record with these units, for a study that may have none.
    ///
    /// # Errors
    /// A record in SI of a study without units.
    pub fn units(
        &self,
        quantity: RecordedQuantity,
        time_unit: Option<&str>,
        unit: Option<&str>,
        file: &str,
    ) -> Result<RecordUnits, Failure> {
        let lacks = |what: &str, remedy: &str| -> Failure {
            let allowed = format!("a column without a unit: the study has no {what}; {remedy}");
            Complaint::new(Fault::Mixed, "data file", Origin::Whole, Json::from(file), allowed)
                .into()
        };
        let time = if time_unit.is_some() {
            let remedy = "give the study in SI, such as belt.mass_kg and belt.natural_frequency_hz, or the column time in the \
                          unit of the equations";
            self.second.ok_or_else(|| lacks("seconds", remedy))?
        } else {
            self.plain_time
        };
        let (length, per_time) = if unit.is_some() {
            let remedy = "give the study in SI, or the column without its unit";
            let metre = self.metre.ok_or_else(|| lacks("metres", remedy))?;
            (metre, self.second.unwrap_or(1.0))
        } else {
            (1.0, self.plain_time)
        };
        let order = f64::from(u8::try_from(derivatives(quantity)).unwrap_or(0));
        Ok(RecordUnits { time, reading: libm::pow(per_time, order) / length })
    }

    /// The units of a record.
    ///
    /// # Errors
    /// As [`RecordScales::units`].
    pub fn of_record(&self, record: &TimeSeries) -> Result<RecordUnits, Failure> {
        let file = record.path().display().to_string();
        self.units(record.quantity, record.time_unit, record.unit, &file)
    }
}
