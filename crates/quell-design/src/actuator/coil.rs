//! A coil in a magnet, or a motor: a force in proportion to a current.
//!
//! I = F_a/K_f and U = R I + L dI/dt + K_f ẋ. The windings bear a root mean square, the amplifier a peak of the current and of the
//! voltage. A controller that changes the force f_s times per unit of time can follow harmonics up to half of it.

use quell_linear::driven_point::{DrivenPoint, PointOutput};

use super::demand::{ActuatorDemand, ActuatorLimit, LimitUse, SignalSize, UnknownDemand, share};

/// A jump of a current is larger than this share of its range.
const JUMP: f64 = 1e-9;

/// A voice coil or a motor.
#[derive(Clone, Debug, PartialEq)]
pub struct CoilActuator {
    /// Force per ampere, K_f.
    pub force_per_ampere: f64,
    /// Stiffness of its guide; 0 without one.
    pub stiffness: f64,
    /// Mass that moves with the driven point.
    pub mass: f64,
    /// Travel.
    pub free_stroke: Option<f64>,
    /// Largest root mean square of the current, in amperes.
    pub rms_current: Option<f64>,
    /// Largest current, in amperes.
    pub maximum_current: Option<f64>,
    /// Largest voltage of the amplifier, in volts.
    pub maximum_voltage: Option<f64>,
    /// Resistance of the windings, in ohms.
    pub resistance: Option<f64>,
    /// Inductance, in volts per ampere and unit of time of the equations.
    pub inductance: Option<f64>,
    /// Watts in a unit of power of the equations.
    pub watts: f64,
    /// Angular frequency of the samples of the controller.
    pub sample_rate: Option<f64>,
}

impl CoilActuator {
    /// Its limits.
    pub(super) fn limits(&self) -> Vec<ActuatorLimit> {
        let limits = [
            self.rms_current.map(|_| ActuatorLimit::RmsCurrent),
            self.maximum_current.map(|_| ActuatorLimit::MaximumCurrent),
            self.maximum_voltage.map(|_| ActuatorLimit::MaximumVoltage),
            self.free_stroke.map(|_| ActuatorLimit::FreeStroke),
            self.sample_rate.map(|_| ActuatorLimit::SampleRate),
        ];
        limits.into_iter().flatten().collect()
    }

    /// What it must give for a dither of unit amplitude.
    pub(super) fn demand(&self, point: &DrivenPoint<'_>) -> ActuatorDemand {
        let own = PointOutput {
            force: 1.0,
            displacement: self.stiffness,
            velocity: 0.0,
            acceleration: self.mass,
        };
        let outputs = point.outputs(&[own, PointOutput::DISPLACEMENT, PointOutput::VELOCITY]);
        let force = SignalSize::of(&outputs[0], 1.0);
        let current = Ok(force.times(self.force_per_ampere.recip()));
        let inductance = self.inductance.unwrap_or(0.0);
        let voltage = match self.resistance {
            None => Err(UnknownDemand::NotGiven("resistance")),
            Some(_)
                if inductance > 0.0 && outputs[0].largest_jump() > JUMP * force.peak_to_peak =>
            {
                Err(UnknownDemand::CurrentJumps)
            }
            Some(resistance) => {
                let slope = inductance * point.frequency() / self.force_per_ampere;
                let windings = outputs[0].combined(
                    resistance / self.force_per_ampere,
                    slope,
                    &outputs[0].derivative(),
                );
                let motion = self.force_per_ampere * self.watts;
                Ok(SignalSize::of(&windings.combined(1.0, motion, &outputs[2]), 1.0))
            }
        };
        let displacement = SignalSize::of(&outputs[1], 1.0);
        let samples_per_period = self.sample_rate.map(|rate| rate / point.frequency());
        let sampled = samples_per_period.map(|samples| LimitUse {
            limit: ActuatorLimit::SampleRate,
            used: Ok(2.0 * f64::from(point.waveform().highest_order()) / samples),
        });
        let peak = |size: SignalSize| size.peak;
        let limits = [
            share(ActuatorLimit::RmsCurrent, self.rms_current, &current, |size| {
                size.root_mean_square
            }),
            share(ActuatorLimit::MaximumCurrent, self.maximum_current, &current, peak),
            share(ActuatorLimit::MaximumVoltage, self.maximum_voltage, &voltage, peak),
            share(ActuatorLimit::FreeStroke, self.free_stroke, &Ok(displacement), |size| {
                size.peak_to_peak
            }),
            sampled,
        ];
        ActuatorDemand {
            force,
            displacement,
            change_of_structure: point.change_by(self.stiffness, self.mass),
            in_series: point.is_in_series(),
            voltage,
            current,
            samples_per_period,
            limits: limits.into_iter().flatten().collect(),
        }
    }
}
