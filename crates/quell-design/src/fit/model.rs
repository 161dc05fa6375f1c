//! A law as a function of its parameters: values and exact derivatives in steady sliding.
//!
//! μ(v) = Σ cᵢ φᵢ(v) with the coefficients cᵢ (levels and viscous part). The φᵢ are values of the law itself with unit coefficients,
//! or their differences, so that the law's formula is written nowhere else. The reference velocity v_m enters as v/v_m alone, except
//! in the viscous part, and the exponent δ of exp(−(v/v_m)^δ) as δ ln(v/v_m):
//!
//! ∂μ/∂v_m = −(v/v_m) μ₀′(v),   ∂μ/∂δ = v ln(v/v_m) μ₀′(v)/δ,
//!
//! with the slope μ₀′ of the law without its viscous part. These are exact.

use quell_model::friction::{Friction, LawKind, Otherwise};
use quell_model::parameter::{
    BRISTLE_DAMPING, BRISTLE_STIFFNESS, COEFFICIENT, EXPONENT, MINIMUM_COEFFICIENT, Parameter,
    REFERENCE_VELOCITY, STATIC_COEFFICIENT, VISCOUS,
};
use quell_model::{Invalid, InvalidValues};

/// Exponent of the exponential law where none is given: a Gaussian fall.
const GAUSSIAN: f64 = 2.0;

/// What is done with a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Estimate {
    /// It is estimated.
    Free,
    /// It has this value.
    Fixed(f64),
    /// It is not given, and steady sliding does not depend on it.
    Unused,
}

/// How steady sliding depends on a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Influence {
    /// Linearly: a level or the viscous part.
    Linear,
    /// As the velocity that scales slip.
    Velocity,
    /// As the exponent of the fall.
    Exponent,
    /// Not at all.
    Nothing,
}

/// A law with what is done with each of its parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct FitModel {
    kind: LawKind,
    estimates: Vec<Estimate>,
}

impl FitModel {
    /// The laws that can be fitted.
    pub const LAWS: &'static [LawKind] = LawKind::NUMERIC;

    /// A law with the parameters that are free by default; `None` for a law that carries data. Free are the levels and the
    /// reference velocity, and the viscous part of laws that fall to a level; the exponent is 2, and Coulomb friction has no viscous
    /// part.
    pub fn new(kind: LawKind) -> Option<Self> {
        if !Self::LAWS.contains(&kind) {
            return None;
        }
        let estimates = kind
            .parameters()
            .iter()
            .map(|parameter| match influence(kind, parameter.path) {
                Influence::Nothing => Estimate::Unused,
                Influence::Exponent => Estimate::Fixed(GAUSSIAN),
                Influence::Linear if parameter.path == VISCOUS.path && kind == LawKind::Coulomb => {
                    Estimate::Fixed(0.0)
                }
                Influence::Linear | Influence::Velocity => Estimate::Free,
            })
            .collect();
        Some(Self { kind, estimates })
    }

    /// The law.
    pub fn kind(&self) -> LawKind {
        self.kind
    }

    /// What is done with each parameter of the law.
    pub fn estimates(&self) -> &[Estimate] {
        &self.estimates
    }

    /// Whether the law has a parameter with this key.
    pub fn has(&self, key: &str) -> bool {
        self.place(key).is_some()
    }

    /// The same with a parameter estimated.
    ///
    /// # Errors
    /// A parameter that the law does not have, or that steady sliding does not depend on.
    pub fn freeing(mut self, key: &str) -> Result<Self, InvalidValues> {
        let place = self.known(key)?;
        let path = self.kind.parameters()[place].path;
        if influence(self.kind, path) == Influence::Nothing {
            let allowed = format!(
                "a parameter on which steady sliding depends: measured coefficients contain no information about {key} of the law {}",
                self.kind.name()
            );
            return Err(InvalidValues::from(Invalid::new(path, key, allowed)));
        }
        self.estimates[place] = Estimate::Free;
        Ok(self)
    }

    /// The same with a parameter fixed at a value.
    ///
    /// # Errors
    /// A parameter that the law does not have; a value out of its bounds.
    pub fn fixing(mut self, key: &str, value: f64) -> Result<Self, InvalidValues> {
        let place = self.known(key)?;
        self.kind.parameters()[place].check(value).map_err(InvalidValues::from)?;
        self.estimates[place] = Estimate::Fixed(value);
        let (upper, lower) = (self.level(true), self.level(false));
        if let Some((Estimate::Fixed(upper), Estimate::Fixed(lower))) = upper.zip(lower)
            && upper < lower
        {
            let allowed = format!(
                "such that the static coefficient {upper} is at least the sliding one, {lower}"
            );
            let path = self.kind.parameters()[place].path;
            return Err(InvalidValues::from(Invalid::new(path, value, allowed)));
        }
        Ok(self)
    }

    /// Places of the free parameters.
    pub(super) fn free(&self) -> impl Iterator<Item = usize> {
        let free = |place: &usize| self.estimates[*place] == Estimate::Free;
        (0..self.estimates.len()).filter(free)
    }

    /// How steady sliding depends on the parameter at a place.
    pub(super) fn influence(&self, place: usize) -> Influence {
        influence(self.kind, self.kind.parameters()[place].path)
    }

    /// Place of the upper and of the lower one of the two levels that a law orders, if it has both.
    pub(super) fn levels(&self) -> Option<(usize, usize)> {
        let lower = self.place(MINIMUM_COEFFICIENT.key()).or_else(|| self.place(COEFFICIENT.key()));
        self.place(STATIC_COEFFICIENT.key()).zip(lower)
    }

    fn level(&self, upper: bool) -> Option<Estimate> {
        self.levels().map(|(above, below)| self.estimates[if upper { above } else { below }])
    }

    /// Place of the parameter with a path.
    pub(super) fn place_of(&self, parameter: &Parameter) -> Option<usize> {
        self.kind.parameters().iter().position(|own| own.path == parameter.path)
    }

    fn place(&self, key: &str) -> Option<usize> {
        self.kind.parameters().iter().position(|parameter| parameter.key() == key)
    }

    fn known(&self, key: &str) -> Result<usize, InvalidValues> {
        self.place(key).ok_or_else(|| {
            let keys: Vec<&str> = self.kind.parameters().iter().map(Parameter::key).collect();
            let allowed =
                format!("a parameter of the law {}: {}", self.kind.name(), keys.join(", "));
            InvalidValues::from(Invalid::new("friction", key, allowed))
        })
    }

    /// Values that every search starts from: those that are fixed, and stand-ins for what steady sliding does not depend on.
    pub(super) fn start(&self) -> Vec<f64> {
        let parameters = self.kind.parameters().iter().zip(&self.estimates);
        parameters
            .map(|(parameter, estimate)| match estimate {
                Estimate::Fixed(value) => *value,
                Estimate::Free => 0.0,
                Estimate::Unused => self.stand_in(parameter.path),
            })
            .collect()
    }

    /// A valid value of a parameter that steady sliding does not depend on. Any value gives the same curve.
    fn stand_in(&self, path: &str) -> f64 {
        match self.kind.default_of(path) {
            Some(Otherwise::Number(value)) => value,
            Some(Otherwise::SameAs(_)) => 0.0,
            None => 1.0,
        }
    }

    /// The law with these values; `None` if they are out of bounds.
    pub(super) fn law(&self, values: &[f64]) -> Option<Friction> {
        let mut values = values.to_vec();
        // An absent static level of Coulomb friction equals the sliding coefficient.
        if let Some((upper, lower)) = self.levels()
            && self.estimates[upper] == Estimate::Unused
        {
            values[upper] = values[lower];
        }
        self.kind.build(&values).ok()
    }

    /// φ of each linear parameter at these speeds, for the reference velocity and the exponent in `values`.
    pub(super) fn bases(&self, values: &[f64], speeds: &[f64]) -> Option<Vec<(usize, Vec<f64>)>> {
        let parameters = 0..self.kind.parameters().len();
        let linear: Vec<usize> =
            parameters.filter(|place| self.influence(*place) == Influence::Linear).collect();
        let zeroed = |ones: &[usize]| {
            let mut values = values.to_vec();
            for place in &linear {
                values[*place] = 0.0;
            }
            for place in ones {
                values[*place] = 1.0;
            }
            let law = self.kind.build(&values).ok()?;
            Some(speeds.iter().map(|speed| law.coefficient(*speed)).collect::<Vec<f64>>())
        };
        let levels = self.levels();
        linear
            .iter()
            .map(|place| {
                let basis = match levels.filter(|(_, lower)| lower == place) {
                    None => zeroed(&[*place])?,
                    // A lower level needs an upper one that is as large.
                    Some((upper, lower)) => {
                        let both = zeroed(&[upper, lower])?;
                        if self.influence(upper) == Influence::Nothing {
                            both
                        } else {
                            let above = zeroed(&[upper])?;
                            both.iter().zip(above).map(|(both, above)| both - above).collect()
                        }
                    }
                };
                Some((*place, basis))
            })
            .collect()
    }

    /// ∂μ/∂p of every parameter at these speeds > 0; zeros for parameters without influence.
    pub(super) fn gradient(&self, values: &[f64], speeds: &[f64]) -> Vec<Vec<f64>> {
        let mut gradient = vec![vec![0.0; speeds.len()]; values.len()];
        for (place, basis) in self.bases(values, speeds).unwrap_or_default() {
            gradient[place] = basis;
        }
        let mut dry = values.to_vec();
        if let Some(viscous) = self.place_of(&VISCOUS) {
            dry[viscous] = 0.0;
        }
        let (Some(velocity), Some(law)) = (self.place_of(&REFERENCE_VELOCITY), self.law(&dry))
        else {
            return gradient;
        };
        let scale = values[velocity];
        let slopes: Vec<f64> = speeds.iter().map(|speed| law.slope(*speed)).collect();
        let scaled = speeds.iter().zip(&slopes);
        gradient[velocity] = scaled.clone().map(|(v, slope)| -v / scale * slope).collect();
        if let Some(exponent) = self.place_of(&EXPONENT) {
            let power = values[exponent];
            gradient[exponent] =
                scaled.map(|(v, slope)| v * libm::log(v / scale) * slope / power).collect();
        }
        gradient
    }
}

/// How steady sliding of a law depends on the parameter with a path.
fn influence(kind: LawKind, path: &str) -> Influence {
    if path == REFERENCE_VELOCITY.path {
        Influence::Velocity
    } else if path == EXPONENT.path {
        Influence::Exponent
    } else if path == BRISTLE_STIFFNESS.path
        || path == BRISTLE_DAMPING.path
        || (kind == LawKind::Coulomb && path == STATIC_COEFFICIENT.path)
    {
        Influence::Nothing
    } else {
        Influence::Linear
    }
}
