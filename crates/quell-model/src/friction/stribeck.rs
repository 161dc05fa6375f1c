//! Stribeck law, eq. (2.7): falls to a minimum μ_m at v_m, then rises.
//!
//! μ = μ_s sgn(v_r) − (3/2)(μ_s − μ_m)(w − w³/3), w = v_r/v_m.

use quell_numerics::lane::{Lane, product_coefficient, square_coefficient};

use super::{BranchSeries, SlidingLaw, checked, minimum_at_most_static};
use crate::Invalid;
use crate::parameter::{
    MINIMUM_COEFFICIENT, Parameter, REFERENCE_VELOCITY, STATIC_COEFFICIENT,
};

/// Stribeck law, eq. (2.7).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stribeck {
    static_coefficient: f64,
    minimum_coefficient: f64,
    reference_velocity: f64,
}

impl Stribeck {
    /// From μ_s ≥ μ_m ≥ 0 and v_m > 0.
    ///
    /// # Errors
    /// Every value out of its bounds; μ_m > μ_s.
    pub fn new(
        static_coefficient: f64,
        minimum_coefficient: f64,
        reference_velocity: f64,
    ) -> Result<Self, Vec<Invalid>> {
        Self::from_values(&[static_coefficient, minimum_coefficient, reference_velocity])
    }

    /// Minimum coefficient μ_m, reached at v_m.
    pub fn minimum_coefficient(&self) -> f64 {
        self.minimum_coefficient
    }

    /// Slip velocity v_m of the minimum.
    pub fn reference_velocity(&self) -> f64 {
        self.reference_velocity
    }
}

impl SlidingLaw for Stribeck {
    const NAME: &'static str = "stribeck";
    const ABOUT: &'static str = "μ_s sgn(v_r) − (3/2)(μ_s − μ_m)(w − w³/3), w = v_r/v_m (2.7)";
    const PARAMETERS: &'static [Parameter] =
        &[STATIC_COEFFICIENT, MINIMUM_COEFFICIENT, REFERENCE_VELOCITY];

    fn from_values(values: &[f64]) -> Result<Self, Vec<Invalid>> {
        checked(Self::PARAMETERS, values, || {
            minimum_at_most_static(values[0], values[1])
        })?;
        Ok(Self {
            static_coefficient: values[0],
            minimum_coefficient: values[1],
            reference_velocity: values[2],
        })
    }

    fn values(&self) -> Vec<f64> {
        vec![
            self.static_coefficient,
            self.minimum_coefficient,
            self.reference_velocity,
        ]
    }

    #[inline(always)]
    fn velocity_scale(&self) -> f64 {
        self.reference_velocity
    }

    #[inline(always)]
    fn static_coefficient(&self) -> f64 {
        self.static_coefficient
    }

    type Series<V: Lane, const N: usize> = StribeckSeries<V, N>;

    #[inline(always)]
    fn series<V: Lane, const N: usize>(&self, sign: V, w0: V) -> StribeckSeries<V, N> {
        let fall = 1.5 * (self.static_coefficient - self.minimum_coefficient);
        let mut square = [V::splat(0.0); N];
        square[0] = w0 * w0;
        let linear = V::splat(-fall);
        let cubic = V::splat(fall / 3.0);
        let first = (square[0] * w0).mul_add(
            cubic,
            w0.mul_add(linear, sign * V::splat(self.static_coefficient)),
        );
        StribeckSeries {
            first,
            linear,
            cubic,
            square,
        }
    }
}

/// Recurrence of [`Stribeck`]: w² and w³ by Cauchy products.
#[derive(Clone, Copy, Debug)]
pub struct StribeckSeries<V, const N: usize> {
    first: V,
    linear: V,
    cubic: V,
    square: [V; N],
}

impl<V: Lane, const N: usize> BranchSeries<V> for StribeckSeries<V, N> {
    #[inline(always)]
    fn first(&self) -> V {
        self.first
    }

    #[inline(always)]
    fn next(&mut self, k: usize, w: &[V]) -> V {
        self.square[k] = square_coefficient(w, k);
        let cube = product_coefficient(&self.square, w, k);
        cube.mul_add(self.cubic, w[k] * self.linear)
    }
}
