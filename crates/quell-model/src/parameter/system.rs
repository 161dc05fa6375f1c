//! Parameters of a study of a system: its modes, contacts and inputs.
//!
//! Numbers are in the units that the file chooses, so the unit of a quantity is not fixed here; [`Quantity::FrequencyRatio`]
//! is an angular frequency, with a twin in hertz. Matrices and rows are reached by paths such as `system.stiffness[0][1]`.

use super::{
    Bounds, DITHER_AMPLITUDE, DITHER_PHASE, Parameter, RECORD_PERIODS, SETTLE, SiTwin, TOLERANCE,
    si,
};
use crate::units::Quantity;

const fn number(
    path: &'static str,
    symbol: &'static str,
    about: &'static str,
    quantity: Quantity,
    bounds: Bounds,
    si: &'static [SiTwin],
) -> Parameter {
    Parameter { path, symbol, about, quantity, bounds, si }
}

/// Frequency of a mode.
pub const SYSTEM_MODE_FREQUENCY: Parameter = number(
    "system.mode.frequency",
    "ω_i",
    "angular frequency of the mode",
    Quantity::FrequencyRatio,
    Bounds::NOT_NEGATIVE,
    &[si("frequency_hz", "Hz")],
);

/// Damping ratio of a mode.
pub const SYSTEM_MODE_DAMPING: Parameter = number(
    "system.mode.damping_ratio",
    "ζ_i",
    "damping ratio of the mode",
    Quantity::Ratio,
    Bounds::NOT_NEGATIVE,
    &[],
);

/// Modal mass.
pub const SYSTEM_MODAL_MASS: Parameter = number(
    "system.mode.modal_mass",
    "m_i",
    "modal mass of a shape that is not mass-normalised",
    Quantity::LoadMass,
    Bounds::POSITIVE,
    &[si("modal_mass_kg", "kg")],
);

/// Normal load of a contact.
pub const CONTACT_NORMAL_LOAD: Parameter = number(
    "contact.normal_load",
    "N₀",
    "steady normal load",
    Quantity::Force,
    Bounds::POSITIVE,
    &[si("normal_load_n", "N")],
);

/// Normal stiffness of a contact.
pub const CONTACT_NORMAL_STIFFNESS: Parameter = number(
    "contact.normal_stiffness",
    "k_c",
    "normal stiffness of the contact",
    Quantity::LoadStiffness,
    Bounds::NOT_NEGATIVE,
    &[si("normal_stiffness_n_per_m", "N/m")],
);

/// Normal damping of a contact.
pub const CONTACT_NORMAL_DAMPING: Parameter = number(
    "contact.normal_damping",
    "d_c",
    "normal damping of the contact",
    Quantity::LoadDamping,
    Bounds::NOT_NEGATIVE,
    &[si("normal_damping_n_s_per_m", "N·s/m")],
);

/// Tangential stiffness of a contact.
pub const CONTACT_TANGENTIAL_STIFFNESS: Parameter = number(
    "contact.tangential_stiffness",
    "k_t",
    "tangential stiffness of the contact, which adheres elastically before it slips",
    Quantity::LoadStiffness,
    Bounds::POSITIVE,
    &[si("tangential_stiffness_n_per_m", "N/m")],
);

/// Velocity of the surface of a contact.
pub const CONTACT_BELT_VELOCITY: Parameter = number(
    "contact.belt_velocity",
    "v_c",
    "velocity of the moving surface along the tangent",
    Quantity::Velocity,
    Bounds::FINITE,
    &[si("belt_velocity_m_per_s", "m/s")],
);

/// Frequency of a dither.
pub const SYSTEM_DITHER_FREQUENCY: Parameter = number(
    "dither.frequency",
    "ω",
    "angular frequency of the dither",
    Quantity::FrequencyRatio,
    Bounds::POSITIVE,
    &[si("frequency_hz", "Hz"), si("frequency_ratio", "")],
);

/// Amplitude of a dither that is a factor on the friction of a contact.
pub const FRICTION_FACTOR: Parameter = number(
    DITHER_AMPLITUDE.path,
    "α",
    "amplitude of the factor on the friction of the contact",
    Quantity::Ratio,
    Bounds::NOT_NEGATIVE,
    &[],
);

/// Mean of a dither that is a factor on the friction of a contact.
pub const FRICTION_FACTOR_MEAN: Parameter = number(
    "dither.mean",
    "m",
    "mean of the factor on the friction of the contact",
    Quantity::Ratio,
    Bounds::FINITE,
    &[],
);

/// Every parameter of a study of a system, in the order of the study file; those of the friction laws are in their files.
pub const SYSTEM: &[Parameter] = &[
    SYSTEM_MODE_FREQUENCY,
    SYSTEM_MODE_DAMPING,
    SYSTEM_MODAL_MASS,
    CONTACT_NORMAL_LOAD,
    CONTACT_NORMAL_STIFFNESS,
    CONTACT_NORMAL_DAMPING,
    CONTACT_TANGENTIAL_STIFFNESS,
    CONTACT_BELT_VELOCITY,
    DITHER_AMPLITUDE,
    FRICTION_FACTOR_MEAN,
    SYSTEM_DITHER_FREQUENCY,
    DITHER_PHASE,
    TOLERANCE,
    SETTLE,
    RECORD_PERIODS,
];
