//! Parameters of a disc study: the disc, its modes, the loads that rotate over it.
//!
//! Mass-ratio form: M_p = ρhπ(a² − b²), m* = m/M_p, c* = c/(M_pω_ref), k* = k/(M_pω_ref²),
//! f* = F_θ/(r₀M_pω_ref²); frequencies and speeds in ω_ref, time in 1/ω_ref.

mod load;

pub use load::{
    CALIPER_DAMPING, CALIPER_MASS, CALIPER_STIFFNESS, LOAD_ANGLE, LOAD_DAMPING, LOAD_DITHER_PHASE,
    LOAD_FRICTION, LOAD_MASS, LOAD_NORMAL, LOAD_SLIP_RATIO, LOAD_STATIC, LOAD_STIFFNESS,
    PAD_DAMPING, PAD_STIFFNESS,
};

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

/// Mass of the plate whose modes are listed.
pub const PLATE_MASS: Parameter = disc(
    "disc.plate_mass_kg",
    "M_p",
    "mass of the plate between clamp and edge, whose modes are listed",
    Quantity::PlateMass,
    Bounds::POSITIVE,
);

/// Modal damping of the disc.
pub const MODAL_DAMPING: Parameter = disc(
    "disc.modal_damping",
    "ξ",
    "damping ratio of every mode; the damping rotates with the disc",
    Quantity::Ratio,
    Bounds::NOT_NEGATIVE,
);

/// Centrifugal stiffening of the modes.
pub const CENTRIFUGAL: Parameter = disc(
    "disc.centrifugal",
    "κ",
    "centrifugal stiffening of every mode, β² + κΩ², of a disc that rotates itself",
    Quantity::Ratio,
    Bounds { lower: 0.0, lower_included: true, upper: 1e6 },
);

/// Centrifugal stiffening of a listed mode.
pub const MODE_CENTRIFUGAL: Parameter = disc(
    "disc.mode.centrifugal",
    "κ",
    "centrifugal stiffening of the mode, β² + κΩ², of a disc that rotates itself",
    Quantity::Ratio,
    Bounds { lower: 0.0, lower_included: true, upper: 1e6 },
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

/// Half the thickness of the disc over the radius of a load.
pub const LOAD_HALF_THICKNESS: Parameter = disc(
    "disc.load.half_thickness",
    "η",
    "half the thickness of the disc over the radius of the load, by which a slope moves the surface along the slip; by default \
     from disc.thickness_m where it is known, else 0",
    Quantity::Ratio,
    Bounds { lower: 0.0, lower_included: true, upper: 1.0 },
);

/// Angular extent of a load.
pub const LOAD_EXTENT: Parameter = disc(
    "disc.load.extent_deg",
    "θ_e",
    "angle over which the load is distributed, symmetric to its own angle, degrees; a point if absent",
    Quantity::Degrees,
    Bounds { lower: 0.0, lower_included: true, upper: 360.0 },
);

/// Radial extent of a load.
pub const LOAD_RADIAL_EXTENT: Parameter = disc(
    "disc.load.radial_extent",
    "r_e/a",
    "radial width over which the load is distributed, symmetric to its radius, over the outer radius; requires computed modes",
    Quantity::Ratio,
    Bounds { lower: 0.0, lower_included: false, upper: 1.0 },
);

/// Quadrature points over the angle of a load.
pub const LOAD_POINTS: Parameter = disc(
    "disc.load.points",
    "n_θ",
    "quadrature points over the angle of a distributed load; by default enough for its modes",
    Quantity::Count,
    Bounds { lower: 1.0, lower_included: true, upper: 200.0 },
);

/// Quadrature points over the radius of a load.
pub const LOAD_RADIAL_POINTS: Parameter = disc(
    "disc.load.radial_points",
    "n_r",
    "quadrature points over the radius of a distributed load; by default enough for its modes",
    Quantity::Count,
    Bounds { lower: 1.0, lower_included: true, upper: 50.0 },
);

/// Mass of the pad.
pub const PAD_MASS: Parameter = in_si(
    disc(
        "disc.load.pad_mass",
        "m_p*",
        "mass of the pad; without one the spring and the damper of the load are grounded over the mass of the plate",
        Quantity::LoadMass,
        Bounds::POSITIVE,
    ),
    &[si("pad_mass_kg", "kg")],
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
    CENTRIFUGAL,
    RADIAL_MODES,
    NODAL_DIAMETERS,
    YOUNGS_MODULUS,
    DENSITY,
    THICKNESS,
    OUTER_RADIUS,
    PLATE_MASS,
    MODE_DIAMETERS,
    MODE_RATIO,
    MODE_FREQUENCY,
    MODE_SHAPE_AT_LOAD,
    MODE_DAMPING,
    MODE_CENTRIFUGAL,
    LOAD_RADIUS,
    LOAD_ANGLE,
    LOAD_MASS,
    LOAD_DAMPING,
    LOAD_STIFFNESS,
    LOAD_FRICTION,
    LOAD_DITHER_PHASE,
    LOAD_NORMAL,
    LOAD_HALF_THICKNESS,
    LOAD_STATIC,
    LOAD_SLIP_RATIO,
    LOAD_EXTENT,
    LOAD_RADIAL_EXTENT,
    LOAD_POINTS,
    LOAD_RADIAL_POINTS,
    PAD_MASS,
    PAD_DAMPING,
    PAD_STIFFNESS,
    CALIPER_MASS,
    CALIPER_DAMPING,
    CALIPER_STIFFNESS,
    DISC_SPEED,
    DISC_DITHER_AMPLITUDE,
    super::DITHER_FREQUENCY_RATIO,
];
