//! Stribeck friction as an exponential fall with a viscous part (Bo and Pavelescu 1982; Armstrong-Hélouvry et al. 1994).
//!
//! μ = [μ_d + (μ_s − μ_d) e^{−(|v_r|/v_s)^δ}] sgn(v_r) + σ_v v_r.
//!
//! Limits: if δ is not an integer, the law is not analytic at v_r = 0, where every slip begins: averages are valid, but
//! simulation rejects it. Integer exponents up to [`LARGEST_SIMULATED`] have a recurrence that is valid through v_r = 0.

use quell_numerics::elementary;
use quell_numerics::lane::{Lane, half_inner_square, partial_product};

use super::numeric::{checked, number_of, static_at_least_sliding, with_number};
use super::series::{length_of_change, longest_change, side_by_side};
use super::{BranchSeries, LawParameters, LawSeries, NumericLaw, Otherwise, SlidingLaw};
use crate::InvalidValues;
use crate::parameter::{
    COEFFICIENT, EXPONENT, Parameter, REFERENCE_VELOCITY, STATIC_COEFFICIENT, VISCOUS,
};

/// Largest integer exponent with a recurrence through v_r = 0.
const LARGEST_SIMULATED: f64 = 4.0;

/// p = (v/v_s)^δ from which the excess e^{−p} is negligible, below 10⁻²¹ of the friction. Without this bound a slip of 100 v_s
/// with δ = 4 takes 10⁷ steps in which nothing changes; closer to rounding, e⁻³⁷, an error of the excess would be visible.
const VANISHED: f64 = 50.0;

/// How often a step is cut by the fourth root of its excess: a step 10⁶ times too long is 12 times too long after six cuts.
const CUTS: u32 = 6;

/// Default exponent: a Gaussian fall.
const USUAL_EXPONENT: f64 = 2.0;

/// Exponential Stribeck friction with a viscous part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StribeckExponential {
    coefficient: f64,
    static_coefficient: f64,
    reference_velocity: f64,
    exponent: f64,
    viscous: f64,
}

impl StribeckExponential {
    /// From μ_d ≥ 0, μ_s ≥ μ_d, v_s > 0, δ > 0 and σ_v ≥ 0.
    ///
    /// # Errors
    /// Every value out of its bounds; μ_s < μ_d.
    pub fn new(
        coefficient: f64,
        static_coefficient: f64,
        reference_velocity: f64,
        exponent: f64,
        viscous: f64,
    ) -> Result<Self, InvalidValues> {
        Self::from_values(&[coefficient, static_coefficient, reference_velocity, exponent, viscous])
    }

    /// The exponent δ.
    pub fn exponent(&self) -> f64 {
        self.exponent
    }
}

impl LawParameters for StribeckExponential {
    const NAME: &'static str = "stribeck-exponential";
    const ABOUT: &'static str = "[μ_d + (μ_s − μ_d) e^{−(|v_r|/v_s)^δ}] sgn(v_r) + σ_v v_r";
    const PARAMETERS: &'static [Parameter] =
        &[COEFFICIENT, STATIC_COEFFICIENT, REFERENCE_VELOCITY, EXPONENT, VISCOUS];

    fn default_of(path: &str) -> Option<Otherwise> {
        if path == EXPONENT.path {
            return Some(Otherwise::Number(USUAL_EXPONENT));
        }
        (path == VISCOUS.path).then_some(Otherwise::Number(0.0))
    }

    fn values(&self) -> Vec<f64> {
        vec![
            self.coefficient,
            self.static_coefficient,
            self.reference_velocity,
            self.exponent,
            self.viscous,
        ]
    }

    fn get(&self, path: &str) -> Option<f64> {
        number_of(self, path)
    }

    fn with(&self, path: &str, value: f64) -> Result<Self, InvalidValues> {
        with_number(self, path, value)
    }
}

impl SlidingLaw for StribeckExponential {
    type Recurrence = Self;

    #[inline(always)]
    fn recurrence(&self) -> &Self {
        self
    }

    fn unsimulated(&self) -> Option<&'static str> {
        let whole = self.exponent.fract() == 0.0 && self.exponent <= LARGEST_SIMULATED;
        (!whole).then_some(
            "simulation of a stribeck-exponential law requires friction.exponent = 1, 2, 3 or 4: other exponents are not \
             analytic at v_r = 0, where every slip begins; averages (friction, stability) are valid for any exponent",
        )
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

impl LawSeries for StribeckExponential {
    type Constants<V: Lane> = StribeckExponentialConstants<V>;

    #[inline(always)]
    fn constants<V: Lane>(laws: &[Self]) -> StribeckExponentialConstants<V> {
        StribeckExponentialConstants {
            coefficient: side_by_side(laws, |law| law.coefficient),
            excess: side_by_side(laws, |law| law.static_coefficient - law.coefficient),
            viscous: side_by_side(laws, |law| law.viscous * law.reference_velocity),
            // Laws in lanes are alike: they have the same exponent.
            exponent: laws[0].exponent,
        }
    }

    fn is_alike(&self, other: &Self) -> bool {
        self.exponent == other.exponent
    }

    type Series<'c, V: Lane, const N: usize> = StribeckExponentialSeries<V, N>;

    #[inline(always)]
    fn series<V: Lane, const N: usize>(
        constants: &mut StribeckExponentialConstants<V>,
        sign: V,
        w0: V,
    ) -> StribeckExponentialSeries<V, N> {
        let StribeckExponentialConstants { coefficient, excess, viscous, exponent } = *constants;
        let zero = V::splat(0.0);
        let speed = sign * w0;
        let square = speed * speed;
        let whole = Whole::of(exponent);
        let (first, rate) = match whole {
            Some(Whole::One) => (speed, V::splat(1.0)),
            Some(Whole::Two) => (square, speed + speed),
            Some(Whole::Three) => (square * speed, V::splat(3.0) * square),
            Some(Whole::Four) => (square * square, V::splat(4.0) * square * speed),
            None => (
                speed.map(|speed| libm::pow(speed, exponent)),
                speed.map(|speed| exponent * libm::pow(speed, exponent - 1.0)),
            ),
        };
        let mut powers = Powers {
            whole,
            exponent,
            speed,
            rate,
            lower: zero,
            inner: zero,
            square: [zero; N],
            power: [zero; N],
        };
        powers.square[0] = square;
        powers.power[0] = first;
        let mut decay = [zero; N];
        decay[0] = excess * elementary::exp(-first);
        StribeckExponentialSeries {
            sign,
            coefficient,
            viscous,
            w0,
            powers,
            decay,
            rate: [zero; N],
            partial: zero,
        }
    }
}

impl NumericLaw for StribeckExponential {
    fn from_values(values: &[f64]) -> Result<Self, InvalidValues> {
        checked(Self::PARAMETERS, values, || static_at_least_sliding(values[0], values[1]))?;
        Ok(Self {
            coefficient: values[0],
            static_coefficient: values[1],
            reference_velocity: values[2],
            exponent: values[3],
            viscous: values[4],
        })
    }
}

/// μ_d, μ_s − μ_d and σ_v v_s in each lane, and δ.
#[derive(Clone, Copy, Debug)]
pub struct StribeckExponentialConstants<V> {
    coefficient: V,
    excess: V,
    viscous: V,
    exponent: f64,
}

/// Integer exponents with a recurrence through v_r = 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Whole {
    One,
    Two,
    Three,
    Four,
}

impl Whole {
    fn of(exponent: f64) -> Option<Self> {
        [(1.0, Self::One), (2.0, Self::Two), (3.0, Self::Three), (LARGEST_SIMULATED, Self::Four)]
            .into_iter()
            .find(|(whole, _)| *whole == exponent)
            .map(|(_, whole)| whole)
    }
}

/// Recurrence of p = u^δ along the scaled slip speed u, by Cauchy products of u and q = u²; away from v_r = 0 from
/// u p′ = δ u′ p for any δ.
#[derive(Clone, Copy, Debug)]
struct Powers<V, const N: usize> {
    whole: Option<Whole>,
    exponent: f64,
    /// u₀.
    speed: V,
    /// δ u₀^{δ−1}.
    rate: V,
    /// pₖ without its term in uₖ, for the last k.
    lower: V,
    /// qₖ without its term in uₖ, for the last k.
    inner: V,
    /// q, complete below the last k.
    square: [V; N],
    /// p, complete below the last k.
    power: [V; N],
}

impl<V: Lane, const N: usize> Powers<V, N> {
    /// Completes order k from uₖ.
    #[inline(always)]
    fn complete(&mut self, k: usize, newest: V) {
        self.square[k] = (self.speed + self.speed).mul_add(newest, self.inner);
        self.power[k] = self.rate.mul_add(newest, self.lower);
    }

    /// pₖ without its term in uₖ, from the orders below; `w` is the slip, u = s w.
    #[inline(always)]
    fn lower(&mut self, k: usize, sign: V, w: &[V]) -> V {
        // Squares do not depend on the sign.
        let half = half_inner_square(w, k);
        self.inner = half + half;
        self.lower = match self.whole {
            Some(Whole::One) => V::splat(0.0),
            Some(Whole::Two) => self.inner,
            Some(Whole::Three) => {
                let mixed = partial_product(&self.square, w, k, 1, k - 1);
                self.speed.mul_add(self.inner, sign * mixed)
            }
            Some(Whole::Four) => {
                let half = half_inner_square(&self.square, k);
                (self.square[0] + self.square[0]).mul_add(self.inner, half + half)
            }
            None => {
                let mut sum = V::splat(0.0);
                for (j, &slip) in w.iter().enumerate().take(k).skip(1) {
                    let weight = self.exponent * j as f64 - (k - j) as f64;
                    sum = (V::splat(weight) * slip).mul_add(self.power[k - j], sum);
                }
                let inverse = self.speed.map(|speed| 1.0 / (k as f64 * speed));
                sign * sum * inverse
            }
        };
        self.lower
    }
}

/// Recurrence of [`StribeckExponential`]: the excess e = (μ_s − μ_d) e^{−p}, p = u^δ, obeys e′ = −p′e, so that
/// k eₖ = −Σ j pⱼeₖ₋ⱼ over j = 1…k.
#[derive(Clone, Copy, Debug)]
pub struct StribeckExponentialSeries<V, const N: usize> {
    sign: V,
    coefficient: V,
    viscous: V,
    w0: V,
    powers: Powers<V, N>,
    /// Coefficients of the excess e, complete below the last k.
    decay: [V; N],
    /// `rate[j]` = −j pⱼ.
    rate: [V; N],
    /// eₖ without its term in wₖ, for the last k.
    partial: V,
}

impl<V: Lane, const N: usize> BranchSeries<V> for StribeckExponentialSeries<V, N> {
    #[inline(always)]
    fn first(&self) -> V {
        self.viscous.mul_add(self.w0, self.sign * (self.coefficient + self.decay[0]))
    }

    #[inline(always)]
    fn slope(&self) -> V {
        self.viscous - self.powers.rate * self.decay[0]
    }

    #[inline(always)]
    fn lower(&mut self, k: usize, w: &[V]) -> V {
        if k > 1 {
            let newest = self.sign * w[k - 1];
            self.powers.complete(k - 1, newest);
            self.rate[k - 1] = -(self.powers.power[k - 1] * V::splat((k - 1) as f64));
            self.decay[k - 1] = (-(self.powers.rate * newest)).mul_add(self.decay[0], self.partial);
        }
        let power = self.powers.lower(k, self.sign, w);
        let sum = partial_product(&self.rate, &self.decay, k, 1, k - 1);
        self.partial = sum.mul_add(V::splat(1.0 / k as f64), -(power * self.decay[0]));
        self.sign * self.partial
    }

    #[inline(always)]
    fn trusted(&self, w: &[V], length: V) -> V {
        // The step length keeps the last orders below the tolerance.
        let known = &self.powers.power[..N.saturating_sub(2)];
        let most = longest_change(w.len() - 1);
        // At large slip the excess vanishes, and p may change as long as it stays there.
        let room = (self.powers.power[0] - V::splat(VANISHED)).max(V::splat(most));
        let times = room.map(|room| most / room);
        // The bound is linear in the step, but p is of order δ: a long step is first cut by the fourth root, so that it is not
        // cut too far.
        let mut length = length;
        for _ in 0..CUTS {
            let cut = length_of_change(known, times, length, most);
            length = length.zip(cut, |length, cut| length * libm::sqrt(libm::sqrt(cut / length)));
        }
        length_of_change(known, times, length, most)
    }
}
