//! A piezo stack between the ground and the driven point.
//!
//! Its voltage U makes the force F_b U/U_max, against which stand its own spring k_a = F_b/Δu and mass. The ceramic must not be pulled,
//! so that the voltage goes from 0 to U_max: a dither may have half of it on both sides of a bias. The current is C dU/dt.

use quell_linear::driven_point::{DrivenPoint, PointOutput};

use super::demand::{ActuatorDemand, ActuatorLimit, SignalSize, UnknownDemand, share};

/// A jump of a voltage is larger than this share of its range.
const JUMP: f64 = 1e-9;

/// A piezo stack.
#[derive(Clone, Debug, PartialEq)]
pub struct PiezoStack {
    /// Force at the largest voltage without motion, F_b.
    pub blocked_force: f64,
    /// Stiffness k_a; 0 where the structure contains it.
    pub stiffness: f64,
    /// Mass that moves with the driven point.
    pub mass: f64,
    /// Capacitance, in amperes per volt and unit of time of the equations.
    pub capacitance: Option<f64>,
    /// Largest voltage U_max, in volts.
    pub maximum_voltage: Option<f64>,
    /// Largest current, in amperes.
    pub maximum_current: Option<f64>,
}

impl PiezoStack {
    /// Its limits: without a voltage the force itself is one.
    pub(super) fn limits(&self) -> Vec<ActuatorLimit> {
        let force = match self.maximum_voltage {
            Some(_) => ActuatorLimit::MaximumVoltage,
            None => ActuatorLimit::BlockedForce,
        };
        let current = self.maximum_current.map(|_| ActuatorLimit::MaximumCurrent);
        [force].into_iter().chain(current).collect()
    }

    /// What it must give for a dither of unit amplitude.
    pub(super) fn demand(&self, point: &DrivenPoint<'_>) -> ActuatorDemand {
        let own = PointOutput {
            force: 1.0,
            displacement: self.stiffness,
            velocity: 0.0,
            acceleration: self.mass,
        };
        let outputs = point.outputs(&[own, PointOutput::DISPLACEMENT]);
        let force = SignalSize::of(&outputs[0], 1.0);
        let volts = self.maximum_voltage.map(|most| most / self.blocked_force);
        let voltage =
            volts.map(|volts| force.times(volts)).ok_or(UnknownDemand::NotGiven("maximum_voltage"));
        let current = match (volts, self.capacitance) {
            (Some(_), Some(_)) if outputs[0].largest_jump() > JUMP * force.peak_to_peak => {
                Err(UnknownDemand::VoltageJumps)
            }
            (Some(volts), Some(capacitance)) => {
                let rate = capacitance * volts * point.frequency();
                Ok(SignalSize::of(&outputs[0].derivative(), rate))
            }
            _ => Err(UnknownDemand::NoCurrent),
        };
        let range = |size: SignalSize| size.peak_to_peak;
        let by_force = self.maximum_voltage.is_none().then_some(self.blocked_force);
        let limits = [
            share(ActuatorLimit::BlockedForce, by_force, &Ok(force), range),
            share(ActuatorLimit::MaximumVoltage, self.maximum_voltage, &voltage, range),
            share(ActuatorLimit::MaximumCurrent, self.maximum_current, &current, |size| size.peak),
        ];
        ActuatorDemand {
            force,
            displacement: SignalSize::of(&outputs[1], 1.0),
            change_of_structure: point.change_by(self.stiffness, self.mass),
            in_series: point.is_in_series(),
            voltage,
            current,
            samples_per_period: None,
            limits: limits.into_iter().flatten().collect(),
        }
    }
}
