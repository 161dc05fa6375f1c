//! A structure whose dither is a multiple of the one that is judged: what a dither with a margin costs.

use super::{DitherPrice, ExactVerdict, OperatingPoint, Plant, QuietAmplitudes, ResponseSize};
use crate::NoAnswer;
use crate::actuator::{Actuator, ActuatorDemand};
use quell_numerics::interval::RealInterval;

/// A structure that is quiet where another one is, under a dither of `factor` times the amplitude that is judged: its price, its
/// loss of friction and its response are those of that larger dither.
#[derive(Clone, Copy)]
pub struct ScaledPlant<'a> {
    /// The structure.
    pub plant: &'a (dyn Plant + Sync),
    /// The amplitude of the dither over that which is judged.
    pub factor: f64,
}

impl Plant for ScaledPlant<'_> {
    fn averaged(
        &self,
        at: OperatingPoint<'_>,
        range: RealInterval,
    ) -> Result<QuietAmplitudes, NoAnswer> {
        self.plant.averaged(at, range)
    }

    fn least_averaged(&self, at: OperatingPoint<'_>) -> Result<f64, NoAnswer> {
        self.plant.least_averaged(at)
    }

    fn exact(
        &self,
        at: OperatingPoint<'_>,
        range: RealInterval,
    ) -> Result<QuietAmplitudes, NoAnswer> {
        self.plant.exact(at, range)
    }

    fn verdict(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<ExactVerdict, NoAnswer> {
        self.plant.verdict(at, self.factor * amplitude)
    }

    fn price(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<DitherPrice, NoAnswer> {
        self.plant.price(at, self.factor * amplitude)
    }

    fn averaged_loss(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<f64, NoAnswer> {
        self.plant.averaged_loss(at, self.factor * amplitude)
    }

    fn exact_loss(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<f64, NoAnswer> {
        self.plant.exact_loss(at, self.factor * amplitude)
    }

    fn exact_response(
        &self,
        at: OperatingPoint<'_>,
        amplitude: f64,
    ) -> Result<ResponseSize, NoAnswer> {
        self.plant.exact_response(at, self.factor * amplitude)
    }

    fn averaged_response(
        &self,
        at: OperatingPoint<'_>,
        amplitude: f64,
    ) -> Result<ResponseSize, NoAnswer> {
        self.plant.averaged_response(at, self.factor * amplitude)
    }

    fn slowness(&self, at: OperatingPoint<'_>) -> Result<f64, NoAnswer> {
        self.plant.slowness(at)
    }

    fn minimum_normal_load(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<f64, NoAnswer> {
        self.plant.minimum_normal_load(at, self.factor * amplitude)
    }

    fn demand(
        &self,
        at: OperatingPoint<'_>,
        actuator: &Actuator,
    ) -> Result<ActuatorDemand, NoAnswer> {
        Ok(self.plant.demand(at, actuator)?.at(self.factor))
    }

    fn slip_amplitudes(&self, at: OperatingPoint<'_>) -> Result<Vec<f64>, NoAnswer> {
        let unit = self.plant.slip_amplitudes(at)?;
        Ok(unit.into_iter().map(|slip| self.factor * slip).collect())
    }

    fn special_points(
        &self,
        ranges: &[RealInterval],
        others: &[f64],
        largest: f64,
    ) -> Result<Vec<Vec<f64>>, NoAnswer> {
        self.plant.special_points(ranges, others, largest)
    }

    fn loud_points(
        &self,
        ranges: &[RealInterval],
        others: &[f64],
        amplitude: f64,
    ) -> Result<Vec<Vec<f64>>, NoAnswer> {
        self.plant.loud_points(ranges, others, self.factor * amplitude)
    }
}
