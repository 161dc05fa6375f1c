//! An actuator by its measured frequency response: the force that it gives per volt or ampere, or at most, at each frequency.
//!
//! The response is that of the actuator on its structure, own mass and spring included. It holds for a sine; between two frequencies
//! magnitudes follow straight lines, and outside the measured range nothing is known.

use quell_linear::driven_point::{DrivenPoint, PointOutput};
use quell_model::Waveform;

use super::demand::{ActuatorDemand, ActuatorLimit, LimitUse, SignalSize, UnknownDemand, share};

/// A measured actuator.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredActuator {
    /// Angular frequencies, ascending.
    pub frequencies: Vec<f64>,
    /// Force per volt at each.
    pub force_per_volt: Option<Vec<f64>>,
    /// Force per ampere at each.
    pub force_per_ampere: Option<Vec<f64>>,
    /// Largest amplitude of the force at each.
    pub maximum_force: Option<Vec<f64>>,
    /// Largest voltage, a peak, in volts.
    pub maximum_voltage: Option<f64>,
    /// Largest current, a peak, in amperes.
    pub maximum_current: Option<f64>,
    /// Largest root mean square of the current, in amperes.
    pub rms_current: Option<f64>,
}

impl MeasuredActuator {
    /// Its limits.
    pub(super) fn limits(&self) -> Vec<ActuatorLimit> {
        let limits = [
            self.maximum_force.as_ref().map(|_| ActuatorLimit::MaximumForce),
            self.maximum_voltage.map(|_| ActuatorLimit::MaximumVoltage),
            self.maximum_current.map(|_| ActuatorLimit::MaximumCurrent),
            self.rms_current.map(|_| ActuatorLimit::RmsCurrent),
        ];
        limits.into_iter().flatten().collect()
    }

    /// What it must give for a dither of unit amplitude.
    pub(super) fn demand(&self, point: &DrivenPoint<'_>) -> ActuatorDemand {
        let outputs = point.outputs(&[PointOutput::FORCE, PointOutput::DISPLACEMENT]);
        let force = SignalSize::of(&outputs[0], 1.0);
        let known = self.place(point);
        let per = |series: &Option<Vec<f64>>, name: &'static str| {
            let series = series.as_ref().ok_or(UnknownDemand::NoColumn(name))?;
            let (place, share) = known.clone()?;
            let next = (place + 1).min(series.len() - 1);
            Ok(force.times((series[place] + share * (series[next] - series[place])).recip()))
        };
        let voltage = per(&self.force_per_volt, "force_per_volt");
        let current = per(&self.force_per_ampere, "force_per_ampere");
        let peak = |size: SignalSize| size.peak;
        let at_most = self.maximum_force.is_some().then(|| LimitUse {
            limit: ActuatorLimit::MaximumForce,
            used: per(&self.maximum_force, "maximum_force").map(peak),
        });
        let limits = [
            at_most,
            share(ActuatorLimit::MaximumVoltage, self.maximum_voltage, &voltage, peak),
            share(ActuatorLimit::MaximumCurrent, self.maximum_current, &current, peak),
            share(ActuatorLimit::RmsCurrent, self.rms_current, &current, |size| {
                size.root_mean_square
            }),
        ];
        ActuatorDemand {
            force,
            displacement: SignalSize::of(&outputs[1], 1.0),
            // It was measured on the structure.
            change_of_structure: 0.0,
            in_series: point.is_in_series(),
            voltage,
            current,
            samples_per_period: None,
            limits: limits.into_iter().flatten().collect(),
        }
    }

    /// The interval of a frequency and the share of it that lies below.
    fn place(&self, point: &DrivenPoint<'_>) -> Result<(usize, f64), UnknownDemand> {
        if *point.waveform() != Waveform::Sine {
            return Err(UnknownDemand::NotSine);
        }
        let frequency = point.frequency();
        let within = |(first, last): (&f64, &f64)| *first <= frequency && frequency <= *last;
        if !self.frequencies.first().zip(self.frequencies.last()).is_some_and(within) {
            return Err(UnknownDemand::OutsideMeasured);
        }
        let place = self.frequencies.partition_point(|known| *known <= frequency) - 1;
        let Some(next) = self.frequencies.get(place + 1) else { return Ok((place, 0.0)) };
        let start = self.frequencies[place];
        Ok((place, (frequency - start) / (next - start)))
    }
}
