//! Decreasing law, eq. (2.8): falls from μ_s towards μ_m and never rises.
//!
//! μ = [μ_m + (μ_s − μ_m) e^{−|v_r|/v_m}] sgn(v_r).

use quell_numerics::elementary;
use quell_numerics::lane::{Lane, partial_product};

use super::numeric::{checked, minimum_at_most_static, number_of, with_number};
use super::series::{length_of_change, longest_change, side_by_side};
use super::{BranchSeries, LawParameters, LawSeries, NumericLaw, SlidingLaw};
use crate::InvalidValues;
use crate::parameter::{MINIMUM_COEFFICIENT, Parameter, REFERENCE_VELOCITY, STATIC_COEFFICIENT};

/// Decreasing law, eq. (2.8).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decreasing {
    static_coefficient: f64,
    minimum_coefficient: f64,
    reference_velocity: f64,
}

impl Decreasing {
    /// From μ_s ≥ μ_m ≥ 0 and v_m > 0.
    ///
    /// # Errors
    /// Every value out of its bounds; μ_m > μ_s.
    pub fn new(
        static_coefficient: f64,
        minimum_coefficient: f64,
        reference_velocity: f64,
    ) -> Result<Self, InvalidValues> {
        Self::from_values(&[static_coefficient, minimum_coefficient, reference_velocity])
    }

    /// Dynamic coefficient μ_m, the limit at high slip velocity.
    pub fn minimum_coefficient(&self) -> f64 {
        self.minimum_coefficient
    }

    /// Slip velocity v_m over which the excess μ_s − μ_m falls by e.
    pub fn reference_velocity(&self) -> f64 {
        self.reference_velocity
    }
}

impl LawParameters for Decreasing {
    const NAME: &'static str = "decreasing";
    const ABOUT: &'static str = "[μ_m + (μ_s − μ_m) e^{−|v_r|/v_m}] sgn(v_r) (2.8)";
    const PARAMETERS: &'static [Parameter] =
        &[STATIC_COEFFICIENT, MINIMUM_COEFFICIENT, REFERENCE_VELOCITY];

    fn values(&self) -> Vec<f64> {
        vec![self.static_coefficient, self.minimum_coefficient, self.reference_velocity]
    }

    fn get(&self, path: &str) -> Option<f64> {
        number_of(self, path)
    }

    fn with(&self, path: &str, value: f64) -> Result<Self, InvalidValues> {
        with_number(self, path, value)
    }
}

impl SlidingLaw for Decreasing {
    type Recurrence = Self;

    #[inline(always)]
    fn recurrence(&self) -> &Self {
        self
    }

    #[inline(always)]
    fn velocity_scale(&self) -> f64 {
        self.reference_velocity
    }

    #[inline(always)]
    fn static_coefficient(&self) -> f64 {
        self.static_coefficient
    }

    #[inline(always)]
    fn starts_at_static_level(&self) -> bool {
        true
    }
}

impl LawSeries for Decreasing {
    type Constants<V: Lane> = DecreasingConstants<V>;

    #[inline(always)]
    fn constants<V: Lane>(laws: &[Self]) -> DecreasingConstants<V> {
        DecreasingConstants {
            minimum: side_by_side(laws, |law| law.minimum_coefficient),
            excess: side_by_side(laws, |law| law.static_coefficient - law.minimum_coefficient),
        }
    }

    type Series<'c, V: Lane, const N: usize> = DecreasingSeries<V, N>;

    #[inline(always)]
    fn series<V: Lane, const N: usize>(
        constants: &mut DecreasingConstants<V>,
        sign: V,
        w0: V,
    ) -> DecreasingSeries<V, N> {
        let mut decay = [V::splat(0.0); N];
        decay[0] = constants.excess * elementary::exp(-(sign * w0));
        DecreasingSeries {
            sign,
            minimum: constants.minimum,
            decay,
            rate: [V::splat(0.0); N],
            partial: V::splat(0.0),
        }
    }
}

impl NumericLaw for Decreasing {
    fn from_values(values: &[f64]) -> Result<Self, InvalidValues> {
        checked(Self::PARAMETERS, values, || minimum_at_most_static(values[0], values[1]))?;
        Ok(Self {
            static_coefficient: values[0],
            minimum_coefficient: values[1],
            reference_velocity: values[2],
        })
    }
}

/// μ_m and μ_s − μ_m in each lane.
#[derive(Clone, Copy, Debug)]
pub struct DecreasingConstants<V> {
    minimum: V,
    excess: V,
}

/// Recurrence of [`Decreasing`]: the excess e = (μ_s − μ_m) e^{−s w} obeys e′ = −s w′e, so that
/// k eₖ = −s Σ j wⱼeₖ₋ⱼ over j = 1…k.
#[derive(Clone, Copy, Debug)]
pub struct DecreasingSeries<V, const N: usize> {
    sign: V,
    minimum: V,
    /// Coefficients of the excess e, complete below the last k.
    decay: [V; N],
    /// `rate[j]` = −s j wⱼ.
    rate: [V; N],
    /// eₖ without its term in wₖ, for the last k.
    partial: V,
}

impl<V: Lane, const N: usize> BranchSeries<V> for DecreasingSeries<V, N> {
    #[inline(always)]
    fn first(&self) -> V {
        self.sign * (self.minimum + self.decay[0])
    }

    #[inline(always)]
    fn slope(&self) -> V {
        -self.decay[0]
    }

    #[inline(always)]
    fn lower(&mut self, k: usize, w: &[V]) -> V {
        if k > 1 {
            let newest = self.sign * w[k - 1];
            self.rate[k - 1] = -(newest * V::splat((k - 1) as f64));
            self.decay[k - 1] = (-newest).mul_add(self.decay[0], self.partial);
        }
        let sum = partial_product(&self.rate, &self.decay, k, 1, k - 1);
        self.partial = sum * V::splat(1.0 / k as f64);
        self.sign * self.partial
    }

    #[inline(always)]
    fn trusted(&self, w: &[V], length: V) -> V {
        length_of_change(w, V::splat(1.0), length, longest_change(w.len() - 1))
    }
}
