//! Limits of a design.

use super::{Bounds, Parameter, si};
use crate::units::Quantity;

const fn limit(
    path: &'static str,
    symbol: &'static str,
    about: &'static str,
    quantity: Quantity,
    si: &'static [super::SiTwin],
) -> Parameter {
    Parameter { path, symbol, about, quantity, bounds: Bounds::POSITIVE, si }
}

/// Largest amplitude of the dither.
pub const LIMIT_AMPLITUDE: Parameter = limit(
    "design.limits.amplitude",
    "D",
    "largest amplitude of the dither",
    Quantity::Force,
    &[si("amplitude_n", "N")],
);

/// Largest peak-to-peak stroke of the linear response without friction.
pub const LIMIT_STROKE: Parameter = limit(
    "design.limits.stroke",
    "Δx",
    "largest peak-to-peak stroke of the response without friction",
    Quantity::Displacement,
    &[si("stroke_m", "m")],
);

/// Largest velocity of that response.
pub const LIMIT_VELOCITY: Parameter = limit(
    "design.limits.velocity",
    "x′",
    "largest velocity of the response without friction",
    Quantity::Velocity,
    &[si("velocity_m_per_s", "m/s")],
);

/// Largest mean power of that response.
pub const LIMIT_POWER: Parameter = limit(
    "design.limits.power",
    "P",
    "largest mean power of the response without friction",
    Quantity::Power,
    &[si("power_w", "W")],
);

/// Largest share of the mean friction that may be lost.
pub const LIMIT_FRICTION_LOSS: Parameter = limit(
    "design.limits.friction_loss",
    "1 − ⟨T⟩/T₀",
    "largest share of the mean friction that may be lost at any operating point",
    Quantity::Ratio,
    &[],
);

/// Smallest normal load that must remain.
pub const LIMIT_NORMAL_LOAD: Parameter = limit(
    "design.limits.minimum_normal_load",
    "N",
    "smallest normal load that must remain under normal dither",
    Quantity::Force,
    &[si("minimum_normal_load_n", "N")],
);

/// Largest root mean square of the observed response.
pub const LIMIT_RESPONSE_RMS: Parameter = limit(
    "design.limits.response_rms",
    "x_rms",
    "largest root mean square of the observed response about its mean, on exact responses",
    Quantity::Displacement,
    &[si("response_rms_m", "m")],
);

/// Largest peak of the observed response.
pub const LIMIT_RESPONSE_PEAK: Parameter = limit(
    "design.limits.response_peak",
    "x_peak",
    "largest half of the range of the observed response, on exact responses",
    Quantity::Displacement,
    &[si("response_peak_m", "m")],
);

/// Every limit, in the order of a study file.
pub const LIMITS: &[Parameter] = &[
    LIMIT_AMPLITUDE,
    LIMIT_STROKE,
    LIMIT_VELOCITY,
    LIMIT_POWER,
    LIMIT_FRICTION_LOSS,
    LIMIT_NORMAL_LOAD,
    LIMIT_RESPONSE_RMS,
    LIMIT_RESPONSE_PEAK,
];

/// Share of the random samples in which the dither is to be quiet.
pub const CONFIDENCE: Parameter = Parameter {
    path: "design.confidence",
    symbol: "P",
    about: "share of the samples of [uncertainty] in which the dither is to be quiet",
    quantity: Quantity::Ratio,
    bounds: Bounds { lower: 0.0, lower_included: false, upper: 0.9999 },
    si: &[],
};

/// Number of these samples.
pub const SAMPLES: Parameter = Parameter {
    path: "design.samples",
    symbol: "n",
    about: "number of samples of [uncertainty] [default: 20 beyond the confidence, at least 400]",
    quantity: Quantity::Count,
    bounds: Bounds { lower: 20.0, lower_included: true, upper: 1e6 },
    si: &[],
};

/// Seed of these samples.
pub const SEED: Parameter = Parameter {
    path: "design.seed",
    symbol: "s",
    about: "seed of the samples of [uncertainty] [default: 1]",
    quantity: Quantity::Count,
    bounds: Bounds { lower: 0.0, lower_included: true, upper: 9_007_199_254_740_992.0 },
    si: &[],
};

/// The numbers of a design under uncertainty.
pub const CONFIDENT: &[Parameter] = &[CONFIDENCE, SAMPLES, SEED];
