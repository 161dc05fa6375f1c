//! Parameters of a disc study: the disc, its modes, the loads that rotate over it.
//!
//! Mass-ratio form: M_p = ρhπ(a² − b²), m* = m/M_p, c* = c/(M_pω_ref), k* = k/(M_pω_ref²),
//! f* = F_θ/(r₀M_pω_ref²); frequencies and speeds in ω_ref, time in 1/ω_ref.

use super::{Bounds, Parameter, SiTwin, si};
use crate::units::Quantity;

const fn disc(
    path: &'static str,
    symbol: &'static str,
    about: &'static str,
    quantity: Quantity,
    bounds: Bounds,
) -> Parameter {
    Parameter { path, symbol, about, quantity, bounds, si: &[] }
}

/// A parameter of a disc with keys that give it in SI.
const fn in_si(parameter: Parameter, si: &'static [SiTwin]) -> Parameter {
    Parameter { si, ..parameter }
}

/// Ratio of the radii of the plate.
pub const INNER_RADIUS_RATIO: Parameter = disc(
    "disc.inner_radius_ratio",
    "b/a",
    "radius of the clamp over the outer radius",
    Quantity::Ratio,
    Bounds { lower: 0.01, lower_included: true, upper: 0.95 },
);

/// Poisson's ratio of the plate.
pub const POISSON_RATIO: Parameter = disc(
    "disc.poisson_ratio",
    "ν",
    "Poisson's ratio of the plate, below 0.5",
    Quantity::Ratio,
    Bounds { lower: 0.0, lower_included: true, upper: 0.4999 },
);

/// Radial modes per number of nodal diameters.
pub const RADIAL_MODES: Parameter = disc(
    "disc.radial_modes",
    "N_r",
    "modes for each number of nodal diameters",
    Quantity::Count,
    Bounds { lower: 1.0, lower_included: true, upper: 40.0 },
);

/// Largest number of nodal diameters.
pub const NODAL_DIAMETERS: Parameter = disc(
    "disc.nodal_diameters",
    "N_θ",
    "largest number of nodal diameters; 0 to this",
    Quantity::Count,
    Bounds { lower: 0.0, lower_included: true, upper: 40.0 },
);

/// Young's modulus of the plate.
pub const YOUNGS_MODULUS: Parameter =
    disc("disc.youngs_modulus_pa", "E", "Young's modulus", Quantity::Modulus, Bounds::POSITIVE);

/// Density of the plate.
pub const DENSITY: Parameter =
    disc("disc.density_kg_per_m3", "ρ", "density", Quantity::Density, Bounds::POSITIVE);

/// Thickness of the plate.
pub const THICKNESS: Parameter = disc(
    "disc.thickness_m",
    "h",
    "thickness, below the outer radius",
    Quantity::Length,
    Bounds::POSITIVE,
);

/// Outer radius of the plate.
pub const OUTER_RADIUS: Parameter =
    disc("disc.outer_radius_m", "a", "outer radius", Quantity::Length, Bounds::POSITIVE);

/// Modal damping of the disc.
pub const MODAL_DAMPING: Parameter = disc(
    "disc.modal_damping",
    "ξ",
    "damping ratio of every mode; the damping rotates with the disc",
    Quantity::Ratio,
    Bounds::NOT_NEGATIVE,
);

/// Speed of the loads over the disc.
pub const DISC_SPEED: Parameter = in_si(
    disc(
        "disc.load.speed",
        "Ω",
        "speed of the loads over the disc",
        Quantity::FrequencyRatio,
        Bounds { lower: -1e3, lower_included: true, upper: 1e3 },
    ),
    &[si("speed_hz", "Hz"), si("speed_rpm", "rpm")],
);

/// Nodal diameters of a listed mode.
pub const MODE_DIAMETERS: Parameter = disc(
    "disc.mode.diameters",
    "q",
    "nodal diameters of the mode, a whole number",
    Quantity::Count,
    Bounds { lower: 0.0, lower_included: true, upper: 1000.0 },
);

/// Frequency of a listed mode.
pub const MODE_RATIO: Parameter = disc(
    "disc.mode.ratio",
    "β",
    "frequency of the mode over ω_ref",
    Quantity::FrequencyRatio,
    Bounds { lower: 0.0, lower_included: false, upper: 1e6 },
);

/// Frequency of a mode in hertz.
pub const MODE_FREQUENCY: Parameter = disc(
    "disc.mode.frequency_hz",
    "f",
    "frequency of the mode, instead of its ratio; for all modes or none",
    Quantity::Frequency,
    Bounds::POSITIVE,
);

/// Shape of a mode at the load.
pub const MODE_SHAPE_AT_LOAD: Parameter = disc(
    "disc.mode.shape_at_load",
    "φ(r₀)",
    "radial shape at the load; φ cos qθ has unit mean square over the plate",
    Quantity::Ratio,
    Bounds { lower: -1e6, lower_included: true, upper: 1e6 },
);

/// Damping of a listed mode.
pub const MODE_DAMPING: Parameter = disc(
    "disc.mode.damping",
    "ξ",
    "damping ratio of the mode",
    Quantity::Ratio,
    Bounds::NOT_NEGATIVE,
);

/// Radius of a load.
pub const LOAD_RADIUS: Parameter = disc(
    "disc.load.radius_ratio",
    "r₀/a",
    "radius of the load over the outer radius; required if modes are computed",
    Quantity::Ratio,
    Bounds { lower: 0.01, lower_included: true, upper: 1.0 },
);

/// Angle of a load.
pub const LOAD_ANGLE: Parameter = disc(
    "disc.load.angle_deg",
    "θ",
    "angle of the load in the frame that rotates with the loads, degrees",
    Quantity::Degrees,
    Bounds { lower: -1e6, lower_included: true, upper: 1e6 },
);

/// Mass of a load.
pub const LOAD_MASS: Parameter = in_si(
    disc(
        "disc.load.mass",
        "m*",
        "mass of the load over the mass of the plate",
        Quantity::LoadMass,
        Bounds::NOT_NEGATIVE,
    ),
    &[si("mass_kg", "kg")],
);

/// Damper of a load.
pub const LOAD_DAMPING: Parameter = in_si(
    disc(
        "disc.load.damping",
        "c*",
        "damper of the load",
        Quantity::LoadDamping,
        Bounds::NOT_NEGATIVE,
    ),
    &[si("damping_n_s_per_m", "N·s/m")],
);

/// Spring of a load.
pub const LOAD_STIFFNESS: Parameter = in_si(
    disc(
        "disc.load.stiffness",
        "k*",
        "spring of the load",
        Quantity::LoadStiffness,
        Bounds::NOT_NEGATIVE,
    ),
    &[si("stiffness_n_per_m", "N/m")],
);

/// Friction of a load; positive drags the disc along with the load.
pub const LOAD_FRICTION: Parameter = in_si(
    disc(
        "disc.load.friction",
        "f*",
        "follower force of friction",
        Quantity::LoadFriction,
        Bounds::FINITE,
    ),
    &[si("friction_n", "N")],
);

/// Phase of the dither of a load's friction.
pub const LOAD_DITHER_PHASE: Parameter = disc(
    "disc.load.dither_phase_deg",
    "φ",
    "phase of the dither of the load's friction, cos(Rτ + φ), degrees",
    Quantity::Degrees,
    Bounds { lower: -1e6, lower_included: true, upper: 1e6 },
);

/// Dither of the friction force.
pub const DISC_DITHER_AMPLITUDE: Parameter = disc(
    "dither.amplitude",
    "α",
    "dither amplitude over the friction force; at most 1 for normal dither",
    Quantity::Ratio,
    Bounds::NOT_NEGATIVE,
);

/// Every parameter of a disc study, in the order of the file.
pub const DISC: &[Parameter] = &[
    INNER_RADIUS_RATIO,
    POISSON_RATIO,
    MODAL_DAMPING,
    RADIAL_MODES,
    NODAL_DIAMETERS,
    YOUNGS_MODULUS,
    DENSITY,
    THICKNESS,
    OUTER_RADIUS,
    MODE_DIAMETERS,
    MODE_RATIO,
    MODE_FREQUENCY,
    MODE_SHAPE_AT_LOAD,
    MODE_DAMPING,
    LOAD_RADIUS,
    LOAD_ANGLE,
    LOAD_MASS,
    LOAD_DAMPING,
    LOAD_STIFFNESS,
    LOAD_FRICTION,
    LOAD_DITHER_PHASE,
    DISC_SPEED,
    DISC_DITHER_AMPLITUDE,
    super::DITHER_FREQUENCY_RATIO,
];
