//! The registry of parameters: one table of path, symbol, unit and bounds.
//!
//! Constructors, the reader of study files, `--set`, sweeps and the published JSON Schema
//! all use it.

pub mod actuator;
pub mod course;
pub mod design;
pub mod disc;
pub mod system;

use std::fmt;

use crate::Invalid;
use crate::units::Quantity;

/// Path of the key of entry `index` of a list of `count` tables, as a study file names it: without index if there is only one.
pub fn indexed(table: &str, index: usize, count: usize, key: &str) -> String {
    if count > 1 { format!("{table}[{index}].{key}") } else { format!("{table}.{key}") }
}

/// Index and key of such a path; `None` if it is not a path of the table.
pub fn split_index<'a>(path: &'a str, table: &str) -> Option<(usize, &'a str)> {
    let rest = path.strip_prefix(table)?;
    match rest.strip_prefix('[') {
        Some(rest) => {
            let (index, key) = rest.split_once("].")?;
            Some((index.parse().ok()?, key))
        }
        None => Some((0, rest.strip_prefix('.')?)),
    }
}

/// A named number of a study.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Path in a study file without index, such as `dither.amplitude`.
    pub path: &'static str,
    /// Symbol in the equations, such as `D`.
    pub symbol: &'static str,
    /// Description, in one line.
    pub about: &'static str,
    /// Kind of quantity, which determines units and conversion.
    pub quantity: Quantity,
    /// Allowed values.
    pub bounds: Bounds,
    /// Other keys that give it: with the unit as a suffix, or in the units of the study where its own is a ratio.
    pub si: &'static [SiTwin],
}

impl Parameter {
    /// Last part of the path, the key inside its table.
    pub fn key(&self) -> &'static str {
        // Numbers are looked up by it for every value of a run: a search from the end is quicker than a split.
        let dot = self.path.bytes().rposition(|byte| byte == b'.');
        dot.map_or(self.path, |dot| &self.path[dot + 1..])
    }

    /// First part of the path, the table.
    pub fn table(&self) -> &'static str {
        self.path.split('.').next().unwrap_or(self.path)
    }

    /// Whether its key gives a ratio of quantities of one dimension, which has no unit in any study.
    pub fn is_pure(&self) -> bool {
        self.quantity == Quantity::DampingRatio || self.key().ends_with("ratio")
    }

    /// All keys that give it: its own, and those of [`Parameter::si`].
    pub fn keys(&self) -> impl Iterator<Item = &'static str> + use<> {
        [self.key()].into_iter().chain(self.si.iter().map(|other| other.key))
    }

    /// Checks a value against the bounds.
    ///
    /// # Errors
    /// [`Invalid`] naming this parameter, the value and the allowed range.
    pub fn check(&self, value: f64) -> Result<(), Invalid> {
        if self.bounds.contains(value) {
            Ok(())
        } else {
            Err(Invalid::new(self.path, value, self.bounds.to_string()))
        }
    }
}

/// Another key that gives a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SiTwin {
    /// Key in the same table, such as `amplitude_n`.
    pub key: &'static str,
    /// Its unit, such as `N`; empty for the unit of the study.
    pub unit: &'static str,
    /// Symbol and description in SI where they differ from those of the parameter: A, a force, instead of D = A/k.
    pub own: Option<(&'static str, &'static str)>,
}

impl SiTwin {
    /// The same key with a symbol and a description of its own.
    const fn named(self, symbol: &'static str, about: &'static str) -> Self {
        Self { own: Some((symbol, about)), ..self }
    }
}

/// An interval of finite numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Lowest value.
    pub lower: f64,
    /// Whether the lowest value itself is allowed.
    pub lower_included: bool,
    /// Highest value, included.
    pub upper: f64,
}

impl Bounds {
    /// Any finite number.
    pub const FINITE: Self = Self::at_least(f64::NEG_INFINITY);
    /// Finite and ≥ 0.
    pub const NOT_NEGATIVE: Self = Self::at_least(0.0);
    /// Finite and > 0.
    pub const POSITIVE: Self = Self { lower: 0.0, lower_included: false, upper: f64::INFINITY };

    /// Finite and at least `lower`.
    pub const fn at_least(lower: f64) -> Self {
        Self { lower, lower_included: true, upper: f64::INFINITY }
    }

    /// Whether a value is within the bounds. NaN and infinities never are.
    pub fn contains(&self, value: f64) -> bool {
        value.is_finite()
            && (value > self.lower || (self.lower_included && value == self.lower))
            && value <= self.upper
    }

    /// Whether some value of the sign of a number is within the bounds: what can be said of a number in an unknown unit.
    pub fn has_sign_of(&self, number: f64) -> bool {
        match number {
            number if number > 0.0 => self.upper > 0.0,
            number if number < 0.0 => self.lower < 0.0,
            number => self.contains(number),
        }
    }
}

impl fmt::Display for Bounds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // The shortest form of the number, without runs of zeros.
        let short = |value: f64| {
            let text = format!("{value:?}");
            text.strip_suffix(".0").map_or_else(|| text.clone(), str::to_owned)
        };
        match (self.lower.is_finite(), self.upper.is_finite()) {
            (false, false) => write!(f, "a finite number"),
            (true, false) => {
                let sign = if self.lower_included { "≥" } else { ">" };
                write!(f, "a finite number {sign} {}", short(self.lower))
            }
            (false, true) => write!(f, "a finite number ≤ {}", short(self.upper)),
            (true, true) => {
                let open = if self.lower_included { '[' } else { '(' };
                write!(f, "a number in {open}{}, {}]", short(self.lower), short(self.upper))
            }
        }
    }
}

const fn si(key: &'static str, unit: &'static str) -> SiTwin {
    SiTwin { key, unit, own: None }
}

/// Damping ratio.
pub const DAMPING_RATIO: Parameter = Parameter {
    path: "belt.damping_ratio",
    symbol: "ζ",
    about: "damping ratio c/(2mω₀)",
    quantity: Quantity::DampingRatio,
    bounds: Bounds::NOT_NEGATIVE,
    si: &[
        si("damping", "").named("c", "damping coefficient"),
        si("damping_n_s_per_m", "N·s/m").named("c", "damping coefficient"),
    ],
};

/// Normal load.
pub const NORMAL_LOAD: Parameter = Parameter {
    path: "belt.normal_load",
    symbol: "F",
    about: "steady normal load N₀/k",
    quantity: Quantity::Force,
    bounds: Bounds::POSITIVE,
    si: &[
        si("normal_load_n", "N").named("N₀", "steady normal load"),
        si("normal_force_n", "N").named("N₀", "steady normal load"),
    ],
};

/// Belt velocity.
pub const BELT_VELOCITY: Parameter = Parameter {
    path: "belt.belt_velocity",
    symbol: "v₀",
    about: "belt velocity V₀/ω₀",
    quantity: Quantity::Velocity,
    bounds: Bounds::NOT_NEGATIVE,
    si: &[si("belt_velocity_m_per_s", "m/s").named("V₀", "belt velocity")],
};

/// Tangential stiffness of the contact.
pub const TANGENTIAL_STIFFNESS: Parameter = Parameter {
    path: "belt.tangential_stiffness",
    symbol: "k_t",
    about: "tangential stiffness of the contact over k: it adheres elastically before it slips",
    quantity: Quantity::Stiffness,
    bounds: Bounds::POSITIVE,
    si: &[si("tangential_stiffness_n_per_m", "N/m")
        .named("k_t", "tangential stiffness of the contact")],
};

/// Normal stiffness of the contact.
pub const NORMAL_STIFFNESS: Parameter = Parameter {
    path: "belt.normal_stiffness",
    symbol: "k_n",
    about: "normal stiffness of the contact over k, through which an actuator gives normal dither",
    quantity: Quantity::Stiffness,
    bounds: Bounds::POSITIVE,
    si: &[si("normal_stiffness_n_per_m", "N/m").named(
        "k_n",
        "normal stiffness of the contact, through which an actuator gives normal dither",
    )],
};

/// Initial displacement.
pub const INITIAL_DISPLACEMENT: Parameter = Parameter {
    path: "belt.initial.displacement",
    symbol: "x(0)",
    about: "initial displacement",
    quantity: Quantity::Displacement,
    bounds: Bounds::FINITE,
    si: &[si("displacement_m", "m")],
};

/// Initial velocity.
pub const INITIAL_VELOCITY: Parameter = Parameter {
    path: "belt.initial.velocity",
    symbol: "x′(0)",
    about: "initial velocity",
    quantity: Quantity::Velocity,
    bounds: Bounds::FINITE,
    si: &[si("velocity_m_per_s", "m/s")],
};

/// Static friction coefficient.
pub const STATIC_COEFFICIENT: Parameter = Parameter {
    path: "friction.static_coefficient",
    symbol: "μ_s",
    about: "static friction coefficient",
    quantity: Quantity::Ratio,
    bounds: Bounds::NOT_NEGATIVE,
    si: &[],
};

/// Minimum (dynamic) friction coefficient.
pub const MINIMUM_COEFFICIENT: Parameter = Parameter {
    path: "friction.minimum_coefficient",
    symbol: "μ_m",
    about: "minimum (dynamic) friction coefficient, at most the static one",
    quantity: Quantity::Ratio,
    bounds: Bounds::NOT_NEGATIVE,
    si: &[],
};

/// Reference velocity of the friction law.
pub const REFERENCE_VELOCITY: Parameter = Parameter {
    path: "friction.reference_velocity",
    symbol: "v_m",
    about: "slip velocity that scales the law: of the minimum (Stribeck), of the decay (decreasing)",
    quantity: Quantity::Velocity,
    bounds: Bounds::POSITIVE,
    si: &[si("reference_velocity_m_per_s", "m/s")],
};

/// Sliding coefficient of a named law: constant, or at high slip speed.
pub const COEFFICIENT: Parameter = Parameter {
    path: "friction.coefficient",
    symbol: "μ_d",
    about: "sliding coefficient: at any slip (coulomb), at high slip without the viscous part (stribeck-exponential)",
    quantity: Quantity::Ratio,
    bounds: Bounds::NOT_NEGATIVE,
    si: &[],
};

/// Viscous part of the coefficient.
pub const VISCOUS: Parameter = Parameter {
    path: "friction.viscous",
    symbol: "σ_v",
    about: "rise of the coefficient with slip speed: friction is N(… + viscous·v_r)",
    quantity: Quantity::PerVelocity,
    bounds: Bounds::NOT_NEGATIVE,
    si: &[si("viscous_s_per_m", "s/m")],
};

/// Stiffness of the bristles of the LuGre law.
pub const BRISTLE_STIFFNESS: Parameter = Parameter {
    path: "friction.bristle_stiffness",
    symbol: "σ₀",
    about: "stiffness of the bristles: friction is N(σ₀z + …), z their mean deflection",
    quantity: Quantity::PerLength,
    bounds: Bounds::POSITIVE,
    si: &[si("bristle_stiffness_per_m", "1/m")],
};

/// Damping of the bristles of the LuGre law.
pub const BRISTLE_DAMPING: Parameter = Parameter {
    path: "friction.bristle_damping",
    symbol: "σ₁",
    about: "damping of the bristles: friction is N(… + σ₁ż + …)",
    quantity: Quantity::PerVelocity,
    bounds: Bounds::NOT_NEGATIVE,
    si: &[si("bristle_damping_s_per_m", "s/m")],
};

/// Exponent of the Stribeck fall.
pub const EXPONENT: Parameter = Parameter {
    path: "friction.exponent",
    symbol: "δ",
    about: "exponent of the fall, e^−(v/v_s)^δ; simulation needs 1, 2, 3 or 4",
    quantity: Quantity::Ratio,
    // Beyond this the fall is practically a step at v_s, with a slope that grows with δ.
    bounds: Bounds { lower: 0.0, lower_included: false, upper: 100.0 },
    si: &[],
};

/// Largest slip speed for which a formula is intended.
pub const MAXIMUM_VELOCITY: Parameter = Parameter {
    path: "friction.maximum_velocity",
    symbol: "v_max",
    about: "slip speed up to which the formula is used and proven finite, smooth and not negative",
    quantity: Quantity::Velocity,
    bounds: Bounds::POSITIVE,
    si: &[si("maximum_velocity_m_per_s", "m/s")],
};

/// Dither amplitude.
pub const DITHER_AMPLITUDE: Parameter = Parameter {
    path: "dither.amplitude",
    symbol: "D",
    about: "peak dither force over stiffness",
    quantity: Quantity::Force,
    bounds: Bounds::NOT_NEGATIVE,
    si: &[si("amplitude_n", "N").named("A", "peak dither force")],
};

/// Dither frequency over the natural frequency.
pub const DITHER_FREQUENCY_RATIO: Parameter = Parameter {
    path: "dither.frequency_ratio",
    symbol: "R",
    about: "dither frequency over natural frequency",
    quantity: Quantity::FrequencyRatio,
    // Time of a run and memory of its record grow with R: beyond this a slow period alone takes minutes, and the response
    // differs from the limit of high frequency by less than 10⁻¹⁰.
    bounds: Bounds { lower: 0.0, lower_included: false, upper: 1e5 },
    si: &[
        si("frequency", "").named("ω", "angular frequency of the dither"),
        si("frequency_hz", "Hz").named("f", "dither frequency"),
    ],
};

/// Dither phase.
pub const DITHER_PHASE: Parameter = Parameter {
    path: "dither.phase",
    symbol: "φ",
    about: "dither phase at τ = 0",
    quantity: Quantity::Angle,
    bounds: Bounds { lower: -1e6, lower_included: true, upper: 1e6 },
    si: &[],
};

/// Tolerance of the Taylor steps.
pub const TOLERANCE: Parameter = Parameter {
    path: "solver.tolerance",
    symbol: "ε",
    about: "bound on the last retained Taylor terms of a step, relative to F",
    quantity: Quantity::Ratio,
    bounds: Bounds { lower: 1e-15, lower_included: true, upper: 1e-3 },
    si: &[],
};

/// Settling time before a response is measured.
pub const SETTLE: Parameter = Parameter {
    path: "solver.settle",
    symbol: "τ_s",
    about: "time discarded before a response is measured",
    quantity: Quantity::Time,
    bounds: Bounds { lower: 0.0, lower_included: true, upper: 1e9 },
    si: &[si("settle_s", "s").named("t_s", "time discarded before a response is measured")],
};

/// Length of the record.
pub const RECORD_PERIODS: Parameter = Parameter {
    path: "solver.record_periods",
    symbol: "n",
    about: "slow periods 2π in the record",
    quantity: Quantity::Count,
    bounds: Bounds { lower: 2.0, lower_included: true, upper: 100_000.0 },
    si: &[],
};

/// Mass m of a study with units.
pub const MASS: Parameter = Parameter {
    path: "belt.mass",
    symbol: "m",
    about: "mass on the belt; with it the study has units",
    quantity: Quantity::LoadMass,
    bounds: Bounds::POSITIVE,
    si: &[si("mass_kg", "kg")],
};

/// Stiffness k of a study with units.
pub const STIFFNESS: Parameter = Parameter {
    path: "belt.stiffness",
    symbol: "k",
    about: "stiffness of the spring that holds the mass; with it the study has units",
    quantity: Quantity::LoadStiffness,
    bounds: Bounds::POSITIVE,
    si: &[si("stiffness_n_per_m", "N/m")],
};

/// Natural frequency ω₀/2π of a study with units, instead of its stiffness.
pub const NATURAL_FREQUENCY: Parameter = Parameter {
    path: "belt.natural_frequency",
    symbol: "ω₀",
    about: "natural frequency, instead of the stiffness; with it the study has units",
    quantity: Quantity::FrequencyRatio,
    bounds: Bounds::POSITIVE,
    si: &[si("natural_frequency_hz", "Hz").named(
        "f₀",
        "natural frequency ω₀/2π, instead of the stiffness; with it the study has units",
    )],
};

/// The numbers that define the scales of a study with units: the mass, and either stiffness or natural frequency.
pub const SCALES: &[Parameter] = &[MASS, STIFFNESS, NATURAL_FREQUENCY];

/// Every parameter of a belt study, in the order of the study file. The friction law's own
/// parameters are those of its file ([`crate::friction::LawKind::parameters`]).
pub const BELT: &[Parameter] = &[
    DAMPING_RATIO,
    NORMAL_LOAD,
    BELT_VELOCITY,
    TANGENTIAL_STIFFNESS,
    NORMAL_STIFFNESS,
    INITIAL_DISPLACEMENT,
    INITIAL_VELOCITY,
    DITHER_AMPLITUDE,
    DITHER_FREQUENCY_RATIO,
    DITHER_PHASE,
    TOLERANCE,
    SETTLE,
    RECORD_PERIODS,
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_reject_nan_and_infinity() {
        for bounds in [Bounds::FINITE, Bounds::NOT_NEGATIVE, Bounds::POSITIVE] {
            assert!(!bounds.contains(f64::NAN) && !bounds.contains(f64::INFINITY));
        }
        assert!(Bounds::NOT_NEGATIVE.contains(0.0) && !Bounds::POSITIVE.contains(0.0));
        assert_eq!(Bounds::POSITIVE.to_string(), "a finite number > 0");
    }

    #[test]
    fn paths_and_si_keys_are_unique() {
        let mut keys: Vec<String> = BELT
            .iter()
            .flat_map(|p| {
                let table = p.path.strip_suffix(p.key()).unwrap_or_default();
                let twins = p.si.iter().map(move |twin| format!("{table}{}", twin.key));
                twins.chain([p.path.to_owned()])
            })
            .collect();
        keys.sort();
        let count = keys.len();
        keys.dedup();
        assert_eq!(keys.len(), count);
    }
}
