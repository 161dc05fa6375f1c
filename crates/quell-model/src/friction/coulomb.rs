//! Coulomb friction with a separate static level and a viscous part.
//!
//! μ = μ_d sgn(v_r) + σ_v v_r, μ_s ≥ μ_d at rest.
//!
//! Its average under a fast velocity α cos θ is μ_d (2/π) asin(v/α) + σ_v v for |v| < α: the static level does not
//! enter. The law has no characteristic velocity; slip is scaled by the normal load of the belt.

use quell_numerics::lane::Lane;

use super::numeric::{checked, not_a_number_of, number_of, static_at_least_sliding};
use super::series::side_by_side;
use super::{
    BranchSeries, LawParameters, LawSeries, NumericLaw, Otherwise, SlidingLaw, Surroundings,
};
use crate::InvalidValues;
use crate::parameter::{COEFFICIENT, Parameter, STATIC_COEFFICIENT, VISCOUS};

/// Coulomb friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coulomb {
    coefficient: f64,
    given_static: Option<f64>,
    viscous: f64,
    /// Velocity that scales slip.
    scale: f64,
}

impl Coulomb {
    /// From μ_d ≥ 0, μ_s ≥ μ_d (μ_d if not given) and σ_v ≥ 0.
    ///
    /// # Errors
    /// Every value out of its bounds; μ_s < μ_d.
    pub fn new(
        coefficient: f64,
        static_coefficient: Option<f64>,
        viscous: f64,
    ) -> Result<Self, InvalidValues> {
        let level = static_coefficient.unwrap_or(coefficient);
        let law = Self::from_values(&[coefficient, level, viscous])?;
        Ok(Self { given_static: static_coefficient, ..law })
    }

    /// A constant coefficient μ ≥ 0, without a separate static level.
    pub fn constant(coefficient: f64) -> Self {
        Self { coefficient, given_static: None, viscous: 0.0, scale: 1.0 }
    }

    /// The same law without a separate static level, which then equals the coefficient.
    #[must_use]
    pub fn without_static_level(self) -> Self {
        Self { given_static: None, ..self }
    }

    /// The same law with slip scaled by another velocity.
    #[must_use]
    pub fn counted_in(self, scale: f64) -> Self {
        Self { scale, ..self }
    }
}

impl LawParameters for Coulomb {
    const NAME: &'static str = "coulomb";
    const ABOUT: &'static str = "μ_d sgn(v_r) + σ_v v_r, with a static level μ_s ≥ μ_d";
    const PARAMETERS: &'static [Parameter] = &[COEFFICIENT, STATIC_COEFFICIENT, VISCOUS];

    fn default_of(path: &str) -> Option<Otherwise> {
        if path == STATIC_COEFFICIENT.path {
            return Some(Otherwise::SameAs(COEFFICIENT.path));
        }
        (path == VISCOUS.path).then_some(Otherwise::Number(0.0))
    }

    fn values(&self) -> Vec<f64> {
        vec![self.coefficient, self.static_coefficient(), self.viscous]
    }

    fn get(&self, path: &str) -> Option<f64> {
        number_of(self, path)
    }

    fn with(&self, path: &str, value: f64) -> Result<Self, InvalidValues> {
        let Self { mut coefficient, mut given_static, mut viscous, .. } = *self;
        match path {
            path if path == COEFFICIENT.path => coefficient = value,
            path if path == STATIC_COEFFICIENT.path => given_static = Some(value),
            path if path == VISCOUS.path => viscous = value,
            _ => return Err(not_a_number_of::<Self>(path, value)),
        }
        Ok(Self::new(coefficient, given_static, viscous)?.counted_in(self.scale))
    }
}

impl SlidingLaw for Coulomb {
    type Recurrence = Self;

    #[inline(always)]
    fn recurrence(&self) -> &Self {
        self
    }

    fn placed(&self, surroundings: &Surroundings) -> Result<Self, InvalidValues> {
        Ok(self.counted_in(surroundings.normal_load))
    }

    #[inline(always)]
    fn velocity_scale(&self) -> f64 {
        self.scale
    }

    fn has_velocity(&self) -> bool {
        false
    }

    #[inline(always)]
    fn static_coefficient(&self) -> f64 {
        self.given_static.unwrap_or(self.coefficient)
    }
}

impl LawSeries for Coulomb {
    type Constants<V: Lane> = CoulombConstants<V>;

    #[inline(always)]
    fn constants<V: Lane>(laws: &[Self]) -> CoulombConstants<V> {
        CoulombConstants {
            coefficient: side_by_side(laws, |law| law.coefficient),
            viscous: side_by_side(laws, |law| law.viscous * law.scale),
        }
    }

    type Series<'c, V: Lane, const N: usize> = CoulombSeries<V>;

    #[inline(always)]
    fn series<V: Lane, const N: usize>(
        constants: &mut CoulombConstants<V>,
        sign: V,
        w0: V,
    ) -> CoulombSeries<V> {
        let CoulombConstants { coefficient, viscous } = *constants;
        CoulombSeries { first: w0.mul_add(viscous, sign * coefficient), slope: viscous }
    }
}

impl NumericLaw for Coulomb {
    fn from_values(values: &[f64]) -> Result<Self, InvalidValues> {
        checked(Self::PARAMETERS, values, || static_at_least_sliding(values[0], values[1]))?;
        Ok(Self {
            coefficient: values[0],
            given_static: Some(values[1]),
            viscous: values[2],
            scale: 1.0,
        })
    }
}

/// μ_d, and σ_v times the velocity in which slip is counted, in each lane.
#[derive(Clone, Copy, Debug)]
pub struct CoulombConstants<V> {
    coefficient: V,
    viscous: V,
}

/// Recurrence of [`Coulomb`]: nothing but its slope.
#[derive(Clone, Copy, Debug)]
pub struct CoulombSeries<V> {
    first: V,
    slope: V,
}

impl<V: Lane> BranchSeries<V> for CoulombSeries<V> {
    #[inline(always)]
    fn first(&self) -> V {
        self.first
    }

    #[inline(always)]
    fn slope(&self) -> V {
        self.slope
    }

    #[inline(always)]
    fn lower(&mut self, _: usize, _: &[V]) -> V {
        V::splat(0.0)
    }
}
