//! Numbers of an actuator, as its data sheet prints them.

use super::{Bounds, Parameter, SiTwin, si};
use crate::units::Quantity;

const fn of(
    path: &'static str,
    symbol: &'static str,
    about: &'static str,
    quantity: Quantity,
    si: &'static [SiTwin],
) -> Parameter {
    Parameter { path, symbol, about, quantity, bounds: Bounds::POSITIVE, si }
}

/// Force of a piezo stack that cannot move, at its largest voltage.
pub const BLOCKED_FORCE: Parameter = of(
    "actuator.blocked_force",
    "F_b",
    "force of a piezo stack that cannot move, at its largest voltage",
    Quantity::Force,
    &[si("blocked_force_n", "N")],
);

/// Elongation of a piezo stack that nothing resists, or travel of a coil.
pub const FREE_STROKE: Parameter = of(
    "actuator.free_stroke",
    "Δu",
    "elongation of a piezo stack that nothing resists, at its largest voltage, or travel of a coil",
    Quantity::Displacement,
    &[si("free_stroke_m", "m")],
);

/// Stiffness of a piezo stack, or of the guide of a coil.
pub const ACTUATOR_STIFFNESS: Parameter = of(
    "actuator.stiffness",
    "k_a",
    "stiffness of a piezo stack, or of the guide of a coil",
    Quantity::Stiffness,
    &[si("stiffness_n_per_m", "N/m")],
);

/// Mass that moves with the driven point.
pub const ACTUATOR_MASS: Parameter = of(
    "actuator.mass",
    "m_a",
    "mass of the actuator that moves with the driven point",
    Quantity::Mass,
    &[si("mass_kg", "kg")],
);

/// Capacitance of a piezo stack.
pub const CAPACITANCE: Parameter = of(
    "actuator.capacitance",
    "C",
    "capacitance of a piezo stack",
    Quantity::Capacitance,
    &[si("capacitance_f", "F")],
);

/// Largest voltage.
pub const MAXIMUM_VOLTAGE: Parameter = of(
    "actuator.maximum_voltage",
    "U",
    "largest voltage: the whole range from 0 of a piezo stack, the peak of other amplifiers",
    Quantity::Voltage,
    &[],
);

/// Largest current.
pub const MAXIMUM_CURRENT: Parameter = of(
    "actuator.maximum_current",
    "I",
    "largest current of the amplifier, a peak",
    Quantity::Current,
    &[],
);

/// Current that the windings bear for long.
pub const RMS_CURRENT: Parameter = of(
    "actuator.rms_current",
    "I_rms",
    "largest root mean square of the current",
    Quantity::Current,
    &[],
);

/// Force of a coil or motor per ampere.
pub const FORCE_PER_AMPERE: Parameter = of(
    "actuator.force_per_ampere",
    "K_f",
    "force of a coil or motor per ampere",
    Quantity::ForcePerCurrent,
    &[si("force_per_ampere_n", "N/A"), si("force_per_ampere_n_per_a", "N/A")],
);

/// Resistance of the windings.
pub const RESISTANCE: Parameter =
    of("actuator.resistance", "R_w", "resistance of the windings", Quantity::Resistance, &[]);

/// Inductance of the windings.
pub const INDUCTANCE: Parameter = of(
    "actuator.inductance",
    "L",
    "inductance of the windings",
    Quantity::Inductance,
    &[si("inductance_h", "H")],
);

/// Samples of the controller per time.
pub const SAMPLE_RATE: Parameter = of(
    "actuator.sample_rate",
    "f_s",
    "frequency at which the controller changes the force",
    Quantity::FrequencyRatio,
    &[si("sample_rate_hz", "Hz")],
);

/// Every number, in the order of a study file.
pub const ACTUATOR: &[Parameter] = &[
    BLOCKED_FORCE,
    FREE_STROKE,
    ACTUATOR_STIFFNESS,
    ACTUATOR_MASS,
    CAPACITANCE,
    MAXIMUM_VOLTAGE,
    MAXIMUM_CURRENT,
    RMS_CURRENT,
    FORCE_PER_AMPERE,
    RESISTANCE,
    INDUCTANCE,
    SAMPLE_RATE,
];
