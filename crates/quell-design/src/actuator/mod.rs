//! Actuators: what force each can give at a driven point, and which of its limits binds.
//!
//! The force of a dither acts on the structure of the study, which does not contain the actuator: where its point moves by x, the
//! actuator also moves its own mass and bends its own spring. It must therefore make
//!
//! ```text
//! F_a = F + k_a x + m_a ẍ
//! ```
//!
//! with the exact periodic motion x of the driven point ([`quell_linear::driven_point`]), for any periodic waveform. Where the dither
//! modulates the load of a contact, the actuator is in series with the contact: x is its elongation, F all by which the load varies, and
//! its mass is at the contact, carried by the structure. A piezo stack
//! makes F_a = F_b U/U_max, a coil F_a = K_f I. All is proportional to the amplitude, so that each limit gives the largest amplitude
//! that keeps it; the least of them is the reach of the actuator.

mod coil;
mod coverage;
mod demand;
mod measured;
mod piezo;

use quell_linear::driven_point::DrivenPoint;

pub use coil::CoilActuator;
pub use coverage::{
    ActuatorAtFrequency, ActuatorCoverage, AtFrequency, BindingBand, DitherResonance,
    SufficientBand, coverage,
};
pub use demand::{
    ActuatorDemand, ActuatorLimit, ActuatorReach, LimitUse, SignalSize, UnknownDemand,
};
pub use measured::MeasuredActuator;
pub use piezo::PiezoStack;

/// The kinds of actuator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ActuatorKind {
    /// A stack of piezoceramic discs.
    Piezo,
    /// A coil in a magnet.
    VoiceCoil,
    /// A motor, by the force that its torque gives at the driven point.
    Motor,
    /// A measured frequency response of any actuator.
    FrequencyResponse,
}

impl ActuatorKind {
    /// Every kind.
    pub const ALL: [Self; 4] = [Self::Piezo, Self::VoiceCoil, Self::Motor, Self::FrequencyResponse];

    /// Name in a study.
    pub fn name(self) -> &'static str {
        match self {
            Self::Piezo => "piezo",
            Self::VoiceCoil => "voice-coil",
            Self::Motor => "motor",
            Self::FrequencyResponse => "frf",
        }
    }

    /// What it is called in a sentence.
    pub fn in_words(self) -> &'static str {
        match self {
            Self::Piezo => "piezo stack",
            Self::VoiceCoil => "voice coil",
            Self::Motor => "motor",
            Self::FrequencyResponse => "measured actuator",
        }
    }
}

/// An actuator, its mechanical numbers in those of the equations, its electrical ones in volts and amperes.
#[derive(Clone, Debug, PartialEq)]
pub enum Actuator {
    /// A piezo stack.
    Piezo(PiezoStack),
    /// A voice coil.
    VoiceCoil(CoilActuator),
    /// A motor.
    Motor(CoilActuator),
    /// A measured frequency response.
    Measured(MeasuredActuator),
}

impl Actuator {
    /// Its kind.
    pub fn kind(&self) -> ActuatorKind {
        match self {
            Self::Piezo(_) => ActuatorKind::Piezo,
            Self::VoiceCoil(_) => ActuatorKind::VoiceCoil,
            Self::Motor(_) => ActuatorKind::Motor,
            Self::Measured(_) => ActuatorKind::FrequencyResponse,
        }
    }

    /// The limits that it has, in the order of [`ActuatorDemand::limits`].
    pub fn limits(&self) -> Vec<ActuatorLimit> {
        match self {
            Self::Piezo(stack) => stack.limits(),
            Self::VoiceCoil(coil) | Self::Motor(coil) => coil.limits(),
            Self::Measured(measured) => measured.limits(),
        }
    }

    /// The frequencies at which it was measured.
    pub fn measured_frequencies(&self) -> &[f64] {
        match self {
            Self::Measured(measured) => &measured.frequencies,
            Self::Piezo(_) | Self::VoiceCoil(_) | Self::Motor(_) => &[],
        }
    }

    /// Its spring and its mass.
    fn passive(&self) -> (f64, f64) {
        match self {
            Self::Piezo(PiezoStack { stiffness, mass, .. })
            | Self::VoiceCoil(CoilActuator { stiffness, mass, .. })
            | Self::Motor(CoilActuator { stiffness, mass, .. }) => (*stiffness, *mass),
            Self::Measured(_) => (0.0, 0.0),
        }
    }

    /// What it must give for a dither of unit amplitude at a driven point.
    ///
    /// # Errors
    /// In series with a contact a piezo stack without stiffness, and a mass whose velocity would have to jump.
    pub fn demand(&self, point: &DrivenPoint<'_>) -> Result<ActuatorDemand, UnknownDemand> {
        let (stiffness, mass) = self.passive();
        if point.is_in_series() {
            if stiffness == 0.0 && matches!(self, Self::Piezo(_)) {
                return Err(UnknownDemand::NoOwnSpring);
            }
            if mass > 0.0 && point.velocity_jumps() {
                return Err(UnknownDemand::VelocityJumps);
            }
        }
        Ok(match self {
            Self::Piezo(stack) => stack.demand(point),
            Self::VoiceCoil(coil) | Self::Motor(coil) => coil.demand(point),
            Self::Measured(measured) => measured.demand(point),
        })
    }
}

#[cfg(test)]
mod tests {
    use quell_model::Waveform;

    use super::*;

    fn stack() -> PiezoStack {
        PiezoStack {
            blocked_force: 3.0,
            stiffness: 0.5,
            mass: 0.02,
            capacitance: Some(0.01),
            maximum_voltage: Some(100.0),
            maximum_current: Some(2.0),
        }
    }

    fn point(waveform: &Waveform, frequency: f64) -> DrivenPoint<'_> {
        DrivenPoint::of_one_mass(waveform, frequency, 0.02).expect("a motion")
    }

    fn close(value: f64, exact: f64) {
        assert!((value / exact - 1.0).abs() < 1e-12, "{value} should be {exact}");
    }

    /// A sine has x̂ = 1/(1 − ω² + 2iζω), so that every size is in closed form.
    #[test]
    fn a_piezo_stack_under_a_sine() {
        for frequency in [0.3, 0.99, 4.0, 30.0] {
            let demand =
                Actuator::Piezo(stack()).demand(&point(&Waveform::Sine, frequency)).expect("known");
            let square: f64 = frequency * frequency;
            let (re, im) = (1.0 - square, 2.0 * 0.02 * frequency);
            // F_a = (K + k_a − m_a ω²)/K of the force.
            let own = 0.5 - 0.02 * square;
            let force = libm::hypot(re + own, im) / libm::hypot(re, im);
            close(demand.force.peak, force);
            close(demand.force.root_mean_square, force / 2f64.sqrt());
            let voltage = force * 100.0 / 3.0;
            close(demand.voltage.as_ref().expect("known").peak_to_peak, 2.0 * voltage);
            let current = 0.01 * frequency * voltage;
            close(demand.current.as_ref().expect("known").peak, current);
            let named: Vec<_> = demand.limits.iter().map(|used| used.limit).collect();
            assert_eq!(named, Actuator::Piezo(stack()).limits());
            let reach = demand.reach().expect("known");
            close(reach.amplitude, (50.0 / voltage).min(2.0 / current));
            let by_current = current / 2.0 > voltage / 50.0;
            let limit = if by_current {
                ActuatorLimit::MaximumCurrent
            } else {
                ActuatorLimit::MaximumVoltage
            };
            assert_eq!(reach.limit, limit);
            // At its reach the limit is used wholly.
            close(demand.at(reach.amplitude).tightest().expect("known").1, 1.0);
        }
    }

    /// Against a rigid structure the force is the blocked one, against none the stroke the free one.
    #[test]
    fn the_ends_of_the_line_of_load() {
        let quasistatic = |stiffness: f64| PiezoStack {
            stiffness,
            mass: 0.0,
            capacitance: None,
            maximum_current: None,
            ..stack()
        };
        // The structure has stiffness 1 at a frequency near 0.
        let soft = quasistatic(1e-9).demand(&point(&Waveform::Sine, 1e-3));
        let reach = soft.reach().expect("known");
        assert!((reach.amplitude / 1.5 - 1.0).abs() < 1e-5, "{reach:?}");
        let stiff = quasistatic(1e6).demand(&point(&Waveform::Sine, 1e-3));
        let reach = stiff.reach().expect("known");
        let stroke = stiff.at(reach.amplitude).displacement.peak_to_peak;
        assert!((stroke / (3.0 / 1e6) - 1.0).abs() < 1e-5, "{stroke}");
    }

    #[test]
    fn a_square_wave_needs_an_unlimited_current() {
        let waveform = Waveform::Square;
        let demand = stack().demand(&point(&waveform, 4.0));
        assert!(demand.current.is_err() && demand.reach().is_err());
        let free = PiezoStack { maximum_current: None, ..stack() };
        let demand = free.demand(&point(&waveform, 4.0));
        assert!(demand.current.is_err());
        assert_eq!(demand.reach().expect("known").limit, ActuatorLimit::MaximumVoltage);
    }

    #[test]
    fn a_coil_under_a_sine() {
        let coil = CoilActuator {
            force_per_ampere: 0.25,
            stiffness: 0.0,
            mass: 0.1,
            free_stroke: Some(0.5),
            rms_current: Some(2.0),
            maximum_current: Some(5.0),
            maximum_voltage: Some(48.0),
            resistance: Some(3.0),
            inductance: Some(0.4),
            watts: 2.0,
            sample_rate: Some(40.0),
        };
        let frequency = 5.0;
        let demand = Actuator::VoiceCoil(coil.clone())
            .demand(&point(&Waveform::Sine, frequency))
            .expect("known");
        let square = frequency * frequency;
        let structure = [1.0 - square, 2.0 * 0.02 * frequency];
        let divided = |[a, b]: [f64; 2], [c, d]: [f64; 2]| {
            let size = c * c + d * d;
            [(a * c + b * d) / size, (b * c - a * d) / size]
        };
        let x = divided([1.0, 0.0], structure);
        let current = [(1.0 - 0.1 * square * x[0]) / 0.25, -0.1 * square * x[1] / 0.25];
        let peak = libm::hypot(current[0], current[1]);
        close(demand.current.as_ref().expect("known").peak, peak);
        // U = (R + iωL) I + K_f iω x, in volts.
        let voltage = [
            3.0 * current[0] - 0.4 * frequency * current[1] - 0.25 * 2.0 * frequency * x[1],
            3.0 * current[1] + 0.4 * frequency * current[0] + 0.25 * 2.0 * frequency * x[0],
        ];
        close(demand.voltage.as_ref().expect("known").peak, libm::hypot(voltage[0], voltage[1]));
        close(demand.samples_per_period.expect("sampled"), 8.0);
        let names: Vec<&str> = demand.limits.iter().map(|used| used.limit.name()).collect();
        assert_eq!(
            names,
            ["rms_current", "maximum_current", "maximum_voltage", "free_stroke", "sample_rate"]
        );
        let limits = Actuator::Motor(coil.clone()).limits();
        assert_eq!(names, limits.iter().map(|limit| limit.name()).collect::<Vec<_>>());
        let slow = CoilActuator { sample_rate: Some(9.0), ..coil };
        let demand = slow.demand(&point(&Waveform::Sine, frequency));
        let reach = demand.reach().expect("known");
        assert_eq!((reach.amplitude, reach.limit), (0.0, ActuatorLimit::SampleRate));
    }

    #[test]
    fn a_measured_response_holds_within_its_range() {
        let measured = MeasuredActuator {
            frequencies: vec![2.0, 4.0, 8.0],
            force_per_volt: Some(vec![0.1, 0.3, 0.2]),
            force_per_ampere: None,
            maximum_force: Some(vec![5.0, 5.0, 1.0]),
            maximum_voltage: Some(10.0),
            maximum_current: None,
            rms_current: None,
        };
        let demand = |frequency| measured.demand(&point(&Waveform::Sine, frequency));
        let limits: Vec<_> = demand(3.0).limits.iter().map(|used| used.limit).collect();
        assert_eq!(limits, measured.limits());
        let reach = demand(3.0).reach().expect("known");
        close(reach.amplitude, 2.0);
        assert_eq!(reach.limit, ActuatorLimit::MaximumVoltage);
        let reach = demand(8.0).reach().expect("known");
        assert_eq!((reach.amplitude, reach.limit), (1.0, ActuatorLimit::MaximumForce));
        assert!(demand(1.9).reach().is_err() && demand(8.1).reach().is_err());
        assert!(measured.demand(&point(&Waveform::Square, 3.0)).reach().is_err());
    }
}
