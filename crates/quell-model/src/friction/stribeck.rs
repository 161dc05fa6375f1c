//! Stribeck law, eq. (2.7): falls to a minimum μ_m at v_m, then rises.
//!
//! μ = μ_s sgn(v_r) − (3/2)(μ_s − μ_m)(w − w³/3), w = v_r/v_m.
//!
//! Range: a cubic through the minimum, intended for the fall and the start of the rise. w − w³/3 = w(1 − w²/3) is zero
//! again at w = √3, where μ returns to μ_s; beyond that, μ grows as w³/3 without bound and soon exceeds any measured friction.
//! The law holds up to √3 v_m. With μ_m = μ_s it is constant and holds everywhere.

use quell_numerics::lane::{Lane, half_inner_square, partial_product};

use super::numeric::{checked, minimum_at_most_static, number_of, with_number};
use super::series::side_by_side;
use super::{
    BranchSeries, LawParameters, LawSeries, NumericLaw, RangeLimit, SlidingLaw, SlipRange,
};
use crate::InvalidValues;
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
    ) -> Result<Self, InvalidValues> {
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

impl LawParameters for Stribeck {
    const NAME: &'static str = "stribeck";
    const ABOUT: &'static str = "μ_s sgn(v_r) − (3/2)(μ_s − μ_m)(w − w³/3), w = v_r/v_m (2.7)";
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

impl SlidingLaw for Stribeck {
    type Recurrence = Self;

    #[inline(always)]
    fn recurrence(&self) -> &Self {
        self
    }

    fn range(&self) -> Option<SlipRange> {
        let falls = self.minimum_coefficient < self.static_coefficient;
        let upper = 3f64.sqrt() * self.reference_velocity;
        falls.then_some(SlipRange { lower: 0.0, upper, limit: RangeLimit::BackAtStaticLevel })
    }

    #[inline(always)]
    fn velocity_scale(&self) -> f64 {
        self.reference_velocity
    }

    #[inline(always)]
    fn static_coefficient(&self) -> f64 {
        self.static_coefficient
    }
}

impl LawSeries for Stribeck {
    type Constants<V: Lane> = StribeckConstants<V>;

    #[inline(always)]
    fn constants<V: Lane>(laws: &[Self]) -> StribeckConstants<V> {
        let fall = |law: &Self| 1.5 * (law.static_coefficient - law.minimum_coefficient);
        StribeckConstants {
            static_coefficient: side_by_side(laws, |law| law.static_coefficient),
            fall: side_by_side(laws, fall),
            cubic: side_by_side(laws, |law| fall(law) / 3.0),
        }
    }

    type Series<'c, V: Lane, const N: usize> = StribeckSeries<V, N>;

    #[inline(always)]
    fn series<V: Lane, const N: usize>(
        constants: &mut StribeckConstants<V>,
        sign: V,
        w0: V,
    ) -> StribeckSeries<V, N> {
        let StribeckConstants { static_coefficient, fall, cubic } = *constants;
        let linear = -fall;
        let square = w0 * w0;
        let first = (square * w0).mul_add(cubic, w0.mul_add(linear, sign * static_coefficient));
        StribeckSeries {
            first,
            slope: square.mul_add(fall, linear),
            twice_cubic: cubic + cubic,
            thrice_w0: fall * w0,
            inner: V::splat(0.0),
            factor: [V::splat(0.0); N],
        }
    }
}

impl NumericLaw for Stribeck {
    fn from_values(values: &[f64]) -> Result<Self, InvalidValues> {
        checked(Self::PARAMETERS, values, || minimum_at_most_static(values[0], values[1]))?;
        Ok(Self {
            static_coefficient: values[0],
            minimum_coefficient: values[1],
            reference_velocity: values[2],
        })
    }
}

/// μ = μ_s sgn(w) − f w + c w³ with f = (3/2)(μ_s − μ_m) and c = f/3, in each lane.
#[derive(Clone, Copy, Debug)]
pub struct StribeckConstants<V> {
    static_coefficient: V,
    fall: V,
    cubic: V,
}

/// Recurrence of [`Stribeck`], w³ by Cauchy products.
///
/// With Iⱼ = Σ wᵢwⱼ₋ᵢ over i = 1…j−1,
/// (w³)ₖ = 3w₀²wₖ + Σ (3w₀wⱼ + Iⱼ)wₖ₋ⱼ over j = 1…k−1.
#[derive(Clone, Copy, Debug)]
pub struct StribeckSeries<V, const N: usize> {
    first: V,
    slope: V,
    /// 2c of the cubic term c w³.
    twice_cubic: V,
    /// 3c w₀.
    thrice_w0: V,
    /// c Iₖ of the last k.
    inner: V,
    /// c (3w₀wⱼ + Iⱼ), complete below the last k.
    factor: [V; N],
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
            self.factor[k - 1] = self.thrice_w0.mul_add(w[k - 1], self.inner);
        }
        self.inner = half_inner_square(w, k) * self.twice_cubic;
        partial_product(&self.factor, w, k, 1, k - 1)
    }
}
