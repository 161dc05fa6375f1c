//! Stribeck law, eq. (2.7): falls to a minimum μ_m at v_m, then rises.
//!
//! μ = μ_s sgn(v_r) − (3/2)(μ_s − μ_m)(w − w³/3), w = v_r/v_m.

use quell_numerics::lane::{Lane, inner_square, partial_product};

use super::{BranchSeries, SlidingLaw, checked, minimum_at_most_static};
use crate::Invalid;
use crate::parameter::{MINIMUM_COEFFICIENT, Parameter, REFERENCE_VELOCITY, STATIC_COEFFICIENT};

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
        checked(Self::PARAMETERS, values, || minimum_at_most_static(values[0], values[1]))?;
        Ok(Self {
            static_coefficient: values[0],
            minimum_coefficient: values[1],
            reference_velocity: values[2],
        })
    }

    fn values(&self) -> Vec<f64> {
        vec![self.static_coefficient, self.minimum_coefficient, self.reference_velocity]
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
        let linear = V::splat(-fall);
        let cubic = V::splat(fall / 3.0);
        let mut square = [V::splat(0.0); N];
        square[0] = w0 * w0;
        let first = (square[0] * w0)
            .mul_add(cubic, w0.mul_add(linear, sign * V::splat(self.static_coefficient)));
        StribeckSeries {
            first,
            slope: square[0].mul_add(V::splat(fall), linear),
            cubic,
            twice_w0: w0 + w0,
            w0,
            inner: V::splat(0.0),
            square,
        }
    }
}

/// Recurrence of [`Stribeck`]: w² and w³ by Cauchy products.
///
/// With Iₖ = Σ wⱼwₖ₋ⱼ over j = 1…k−1 and (w²)ⱼ = 2w₀wⱼ + Iⱼ,
/// (w³)ₖ = 3w₀²wₖ + w₀Iₖ + Σ (w²)ⱼwₖ₋ⱼ over j = 1…k−1.
#[derive(Clone, Copy, Debug)]
pub struct StribeckSeries<V, const N: usize> {
    first: V,
    slope: V,
    cubic: V,
    w0: V,
    twice_w0: V,
    /// Iₖ of the last k.
    inner: V,
    /// Coefficients of w², complete below the last k.
    square: [V; N],
}

impl<V: Lane, const N: usize> BranchSeries<V> for StribeckSeries<V, N> {
    #[inline(always)]
    fn first(&self) -> V {
        self.first
    }

    #[inline(always)]
    fn slope(&self) -> V {
        self.slope
    }

    #[inline(always)]
    fn lower(&mut self, k: usize, w: &[V]) -> V {
        if k > 1 {
            self.square[k - 1] = self.twice_w0.mul_add(w[k - 1], self.inner);
        }
        self.inner = inner_square(w, k);
        // Ascending j: the newest coefficient of w² comes last, when it is ready.
        let cube = partial_product(&self.square, w, k, 1, k - 1);
        self.w0.mul_add(self.inner, cube) * self.cubic
    }
}
