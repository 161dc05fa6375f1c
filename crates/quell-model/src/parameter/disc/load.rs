//! Parameters of the loads of a disc: strengths, area, pad and caliper, friction.

use super::{disc, in_si};
use crate::parameter::{Bounds, Parameter, si};
use crate::units::Quantity;

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

/// Normal load under a friction law.
pub const LOAD_NORMAL: Parameter = in_si(
    disc(
        "disc.load.normal_load",
        "N*",
        "normal load under a friction law, which then determines the follower force instead of friction",
        Quantity::LoadFriction,
        Bounds::POSITIVE,
    ),
    &[si("normal_load_n", "N")],
);

/// Static load on the disc.
pub const LOAD_STATIC: Parameter = in_si(
    disc(
        "disc.load.static_load",
        "P*",
        "static load that deflects the disc, most of all near a critical speed",
        Quantity::LoadFriction,
        Bounds::FINITE,
    ),
    &[si("static_load_n", "N")],
);

/// Slip ratio of tangential dither at a load.
pub const LOAD_SLIP_RATIO: Parameter = disc(
    "disc.load.slip_ratio",
    "Λ",
    "peak velocity of tangential dither over the speed of sliding: determines the dither force that is needed",
    Quantity::Ratio,
    Bounds::POSITIVE,
);

/// Damping of the pad.
pub const PAD_DAMPING: Parameter = in_si(
    disc(
        "disc.load.pad_damping",
        "c_p*",
        "damper between the pad and its caliper, or the ground",
        Quantity::LoadDamping,
        Bounds::NOT_NEGATIVE,
    ),
    &[si("pad_damping_n_s_per_m", "N·s/m")],
);

/// Stiffness of the pad.
pub const PAD_STIFFNESS: Parameter = in_si(
    disc(
        "disc.load.pad_stiffness",
        "k_p*",
        "spring between the pad and its caliper, or the ground",
        Quantity::LoadStiffness,
        Bounds::POSITIVE,
    ),
    &[si("pad_stiffness_n_per_m", "N/m")],
);

/// Mass of the caliper.
pub const CALIPER_MASS: Parameter = in_si(
    disc(
        "disc.load.caliper_mass",
        "m_c*",
        "mass of the caliper that carries the pad over the mass of the plate",
        Quantity::LoadMass,
        Bounds::POSITIVE,
    ),
    &[si("caliper_mass_kg", "kg")],
);

/// Damping of the caliper.
pub const CALIPER_DAMPING: Parameter = in_si(
    disc(
        "disc.load.caliper_damping",
        "c_c*",
        "damper between the caliper and the ground",
        Quantity::LoadDamping,
        Bounds::NOT_NEGATIVE,
    ),
    &[si("caliper_damping_n_s_per_m", "N·s/m")],
);

/// Stiffness of the caliper.
pub const CALIPER_STIFFNESS: Parameter = in_si(
    disc(
        "disc.load.caliper_stiffness",
        "k_c*",
        "spring between the caliper and the ground",
        Quantity::LoadStiffness,
        Bounds::POSITIVE,
    ),
    &[si("caliper_stiffness_n_per_m", "N/m")],
);

/// Phase of the dither of a load's friction.
pub const LOAD_DITHER_PHASE: Parameter = disc(
    "disc.load.dither_phase_deg",
    "φ",
    "phase of the dither of the load's friction, cos(Rτ + φ), degrees",
    Quantity::Degrees,
    Bounds { lower: -1e6, lower_included: true, upper: 1e6 },
);
