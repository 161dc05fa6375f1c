//! Friction laws.
//!
//! A law is one file that implements [`SlidingLaw`], and one name in the list `laws!(…)` of
//! this one. Its formula is written once, as a recurrence for Taylor coefficients
//! ([`BranchSeries`]): the engine, its SIMD lanes, values, slopes and plots all use it.
//! μ is odd; at v_r = 0 it is set-valued in [−μ_s, μ_s] (the static level is apart from
//! the sliding branch).
//!
//! Most laws are a few numbers ([`NumericLaw`]). A law may also carry data that its runs share:
//! a formula ([`Expression`]) or the approximant of measured samples ([`Samples`]).

use quell_numerics::lane::{Lane, MOST_LANES};

use crate::Invalid;
use crate::parameter::Parameter;

mod coulomb;
mod decreasing;
pub mod expression;
mod range;
pub mod samples;
mod stribeck;
mod stribeck_exponential;

pub use coulomb::{Coulomb, CoulombConstants, CoulombSeries};
pub use decreasing::{Decreasing, DecreasingConstants, DecreasingSeries};
pub use expression::Expression;
pub use range::{RangeLimit, SlipRange, Surroundings};
pub use samples::Samples;
pub use stribeck::{Stribeck, StribeckConstants, StribeckSeries};
pub use stribeck_exponential::{
    StribeckExponential, StribeckExponentialConstants, StribeckExponentialSeries,
};

/// The value of a parameter that a study leaves out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Otherwise {
    /// This number.
    Number(f64),
    /// That of the law's parameter with this path.
    SameAs(&'static str),
}

/// A friction law in steady sliding, analytic on each side of v_r = 0.
pub trait SlidingLaw: Clone + Send + Sync + 'static {
    /// Name in a study file.
    const NAME: &'static str;
    /// One line for people: the formula and its source.
    const ABOUT: &'static str;
    /// The law's parameters in the registry, in the order of [`SlidingLaw::values`].
    const PARAMETERS: &'static [Parameter];

    /// Numbers that a study may say about the law and that are no number of its formula.
    const OPTIONS: &'static [Parameter] = &[];

    /// The value of a parameter that a study may leave out; `None` where it has to be given.
    fn default_of(path: &str) -> Option<Otherwise> {
        let _ = path;
        None
    }

    /// Values in the order of `PARAMETERS`.
    fn values(&self) -> Vec<f64>;

    /// The number of a path such as `friction.static_coefficient`, if the law has it.
    fn get(&self, path: &str) -> Option<f64>;

    /// The law with one number changed.
    ///
    /// # Errors
    /// A path that the law does not have; what [`SlidingLaw::get`] gives, out of its bounds or
    /// against a relation.
    fn with(&self, path: &str, value: f64) -> Result<Self, Vec<Invalid>>;

    /// The law in the belt that it is put into: whatever it has to prove about the slip it meets there is proven, and
    /// where it has no velocity of its own it counts slip in one of the belt's.
    ///
    /// # Errors
    /// What cannot be proven of a law of one's own, and at which slip.
    fn placed(&self, surroundings: &Surroundings) -> Result<Self, Vec<Invalid>> {
        let _ = surroundings;
        Ok(self.clone())
    }

    /// Slip speeds for which the law holds; `None` where it holds for all.
    fn range(&self) -> Option<SlipRange> {
        None
    }

    /// Why the law cannot be simulated, where it cannot: averages hold for every law.
    fn unsimulated(&self) -> Option<&'static str> {
        None
    }

    /// Velocity by which the law is naturally scaled (v_m); slip is counted in it, w = v_r/v_m.
    fn velocity_scale(&self) -> f64;

    /// Whether the law changes over a velocity of its own, so that [`SlidingLaw::velocity_scale`] says something of it.
    fn has_velocity(&self) -> bool {
        true
    }

    /// Static level μ_s.
    fn static_coefficient(&self) -> f64;

    /// What the recurrence needs to know of the law in each lane.
    /// A law with data keeps the memory of its recurrence here too: nothing is allocated per step.
    type Constants<V: Lane>: Send + Sync;

    /// Constants of laws side by side, one law per lane: [`Lane::LANES`] of them, all alike.
    fn constants<V: Lane>(laws: &[Self]) -> Self::Constants<V>;

    /// Whether two laws differ in numbers alone, so that they can run side by side.
    fn is_alike(&self, other: &Self) -> bool {
        let _ = other;
        true
    }

    /// Taylor recurrence of the sliding branch.
    type Series<'c, V: Lane, const N: usize>: BranchSeries<V>;

    /// Starts the recurrence on the branch of `sign` (±1) at scaled slip `w0`.
    fn series<V: Lane, const N: usize>(
        constants: &mut Self::Constants<V>,
        sign: V,
        w0: V,
    ) -> Self::Series<'_, V, N>;

    /// The concrete law in `friction`, if it is of this kind.
    fn of(friction: &Friction) -> Option<Self>;

    /// Whether the sliding branch starts from the static level, μ(0⁺) = μ_s. A release then
    /// leaves v_r = 0 with zero slope.
    #[inline(always)]
    fn starts_at_static_level(&self) -> bool {
        self.coefficient(0.0) == self.static_coefficient()
    }

    /// Sliding coefficient at slip speed |v_r|, ≥ 0.
    #[inline(always)]
    fn coefficient(&self, speed: f64) -> f64 {
        self.alone(speed).0
    }

    /// Slope dμ/d|v_r| of the sliding branch at slip speed |v_r|, per unit velocity.
    #[inline(always)]
    fn slope(&self, speed: f64) -> f64 {
        self.alone(speed).1 / self.velocity_scale()
    }

    /// Coefficient and slope dμ/dw at one slip speed |v_r|, without any term of a series.
    #[inline(always)]
    fn alone(&self, speed: f64) -> (f64, f64) {
        let mut constants = Self::constants::<f64>(std::slice::from_ref(self));
        let branch = Self::series::<f64, 1>(&mut constants, 1.0, speed / self.velocity_scale());
        (branch.first(), branch.slope())
    }
}

/// A law that is nothing but its numbers.
pub trait NumericLaw: SlidingLaw {
    /// From values in the order of `PARAMETERS`.
    ///
    /// # Errors
    /// Every value out of its bounds, and every relation that does not hold.
    fn from_values(values: &[f64]) -> Result<Self, Vec<Invalid>>;
}

/// [`SlidingLaw::get`] of a law of numbers.
fn number_of<L: NumericLaw>(law: &L, path: &str) -> Option<f64> {
    let index = L::PARAMETERS.iter().position(|parameter| parameter.path == path)?;
    law.values().get(index).copied()
}

/// [`SlidingLaw::with`] of a law of numbers.
fn with_number<L: NumericLaw>(law: &L, path: &str, value: f64) -> Result<L, Vec<Invalid>> {
    let index = L::PARAMETERS.iter().position(|parameter| parameter.path == path);
    let index = index.ok_or_else(|| not_a_number_of::<L>(path, value))?;
    let mut values = law.values();
    values[index] = value;
    L::from_values(&values)
}

/// Complaint about a path that a law does not have.
fn not_a_number_of<L: SlidingLaw>(path: &str, value: f64) -> Vec<Invalid> {
    vec![Invalid::new(path, value, format!("a number of the law \"{}\"", L::NAME))]
}

/// Taylor coefficients μ₀, μ₁, … of the coefficient along a slip w(t) = Σ wₖtᵏ.
///
/// μₖ = μ′(w₀)·wₖ + (a part of w₀…wₖ₋₁ alone): the two parts apart let the engine prepare the
/// second while wₖ is still being computed, which halves the time of a scalar step.
pub trait BranchSeries<V: Lane> {
    /// μ₀, with the sign of the branch.
    fn first(&self) -> V;

    /// μ′(w₀) = dμ/dw on the branch, per unit of w.
    fn slope(&self) -> V;

    /// μₖ − μ′(w₀)wₖ, for k = 1, 2, … in ascending order, given w₀…wₖ₋₁.
    fn lower(&mut self, k: usize, w: &[V]) -> V;

    /// The part of a step of `length` along w, of order `w.len() − 1`, over which the last retained
    /// terms bound the remainder. An exponential that grows from almost nothing shows no last term
    /// however far the step goes: its law must say how far it may.
    #[inline(always)]
    fn trusted(&self, w: &[V], length: V) -> V {
        let _ = w;
        length
    }
}

/// Half the order of a step: with c the change of an exponent over it, the terms of eᶜ fall from
/// the c-th on, and from k = 2c on each is less than half of the one before.
#[inline(always)]
fn longest_change(order: usize) -> f64 {
    0.5 * order as f64
}

/// The part of `length` over which `times` Σ aₖtᵏ without its first term changes by no more than `most`:
/// every term shrinks at least as the step does.
#[inline(always)]
fn length_of_change<V: Lane>(series: &[V], times: V, length: V, most: f64) -> V {
    let mut largest = V::splat(0.0);
    for k in (1..series.len()).rev() {
        largest = largest.mul_add(length, series[k].abs());
    }
    let share = (largest * length * times).map(|it| if it > most { most / it } else { 1.0 });
    length * share
}

/// Work that wants the concrete law, for code that is compiled per law.
pub trait LawVisitor {
    /// Result of the work.
    type Output;
    /// Does the work with a concrete law.
    fn visit<L: SlidingLaw>(self, law: &L) -> Self::Output;
}

macro_rules! laws {
    (numbers: $($numeric:ident),+; data: $($carrying:ident),+ $(,)?) => {
        laws!(@ $($numeric),+, $($carrying),+);

        impl LawKind {
            /// Laws that are nothing but their numbers.
            pub const NUMERIC: &'static [Self] = &[$(Self::$numeric),+];

            /// A law of numbers from values in the order of its parameters.
            ///
            /// # Errors
            /// Every value out of its bounds, and every relation that does not hold; a law that
            /// is more than its numbers.
            pub fn build(self, values: &[f64]) -> Result<Friction, Vec<Invalid>> {
                match self {
                    $(Self::$numeric => $numeric::from_values(values).map(Friction::$numeric),)+
                    $(Self::$carrying => {
                        let allowed = "made of its data; no law of numbers alone";
                        Err(vec![Invalid::new("friction.law", $carrying::NAME, allowed)])
                    })+
                }
            }
        }
    };
    (@ $($kind:ident),+) => {
        /// The friction laws there are.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum LawKind {
            $(#[doc = concat!("[`", stringify!($kind), "`].")] $kind,)+
        }

        /// A friction law with valid parameters; cheap to clone.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Friction {
            $(#[doc = concat!("[`", stringify!($kind), "`].")] $kind($kind),)+
        }

        impl LawKind {
            /// Every law.
            pub const ALL: &'static [Self] = &[$(Self::$kind),+];

            /// Name in a study file.
            pub fn name(self) -> &'static str {
                match self { $(Self::$kind => <$kind as SlidingLaw>::NAME),+ }
            }

            /// One line for people.
            pub fn about(self) -> &'static str {
                match self { $(Self::$kind => <$kind as SlidingLaw>::ABOUT),+ }
            }

            /// Numbers that a study may say about the law and that are no number of its formula.
            pub fn options(self) -> &'static [Parameter] {
                match self { $(Self::$kind => <$kind as SlidingLaw>::OPTIONS),+ }
            }

            /// The value of a parameter that a study may leave out; `None` where it has to be given.
            pub fn default_of(self, path: &str) -> Option<Otherwise> {
                match self { $(Self::$kind => <$kind as SlidingLaw>::default_of(path)),+ }
            }

            /// Parameters of the law, in the order of [`Friction::values`].
            pub fn parameters(self) -> &'static [Parameter] {
                match self { $(Self::$kind => <$kind as SlidingLaw>::PARAMETERS),+ }
            }
        }

        impl Friction {
            /// Which law it is.
            pub fn kind(&self) -> LawKind {
                match self { $(Self::$kind(_) => LawKind::$kind),+ }
            }

            /// Values in the order of the law's parameters.
            pub fn values(&self) -> Vec<f64> {
                match self { $(Self::$kind(law) => law.values()),+ }
            }

            /// The number of a path such as `friction.static_coefficient`, if the law has it.
            pub fn get(&self, path: &str) -> Option<f64> {
                match self { $(Self::$kind(law) => law.get(path)),+ }
            }

            /// The law with one number changed.
            ///
            /// # Errors
            /// A path that the law does not have; a value out of its bounds or against a relation.
            pub fn with(&self, path: &str, value: f64) -> Result<Self, Vec<Invalid>> {
                match self { $(Self::$kind(law) => law.with(path, value).map(Self::$kind)),+ }
            }

            /// Whether runs with this law and with the other can go side by side: both are of one
            /// kind and differ in numbers alone.
            pub fn is_alike(&self, other: &Self) -> bool {
                match (self, other) {
                    $((Self::$kind(law), Self::$kind(other)) => law.is_alike(other),)+
                    _ => false,
                }
            }

            /// Whether the sliding branch starts from the static level, μ(0⁺) = μ_s.
            pub fn starts_at_static_level(&self) -> bool {
                match self { $(Self::$kind(law) => law.starts_at_static_level()),+ }
            }

            /// Hands the concrete law to `visitor`.
            #[inline]
            pub fn visit<T: LawVisitor>(&self, visitor: T) -> T::Output {
                match self { $(Self::$kind(law) => visitor.visit(law)),+ }
            }

            /// The law in the belt that it is put into ([`SlidingLaw::placed`]).
            ///
            /// # Errors
            /// What cannot be proven of a law of one's own, and at which slip.
            pub fn placed(&self, surroundings: &Surroundings) -> Result<Self, Vec<Invalid>> {
                match self { $(Self::$kind(law) => law.placed(surroundings).map(Self::$kind)),+ }
            }

            /// Slip speeds for which the law holds; `None` where it holds for all.
            pub fn range(&self) -> Option<SlipRange> {
                match self { $(Self::$kind(law) => law.range()),+ }
            }

            /// Why the law cannot be simulated, where it cannot.
            pub fn unsimulated(&self) -> Option<&'static str> {
                match self { $(Self::$kind(law) => law.unsimulated()),+ }
            }

            /// Whether the law changes over a velocity of its own.
            pub fn has_velocity(&self) -> bool {
                match self { $(Self::$kind(law) => law.has_velocity()),+ }
            }

            /// Velocity scale v_m of the law.
            pub fn velocity_scale(&self) -> f64 {
                match self { $(Self::$kind(law) => law.velocity_scale()),+ }
            }

            /// Static level μ_s.
            pub fn static_coefficient(&self) -> f64 {
                match self { $(Self::$kind(law) => law.static_coefficient()),+ }
            }

            /// Sliding coefficient at slip speed |v_r| ≥ 0.
            pub fn coefficient(&self, speed: f64) -> f64 {
                match self { $(Self::$kind(law) => law.coefficient(speed)),+ }
            }

            /// Slope of the sliding branch at slip speed |v_r| ≥ 0, per unit velocity.
            pub fn slope(&self, speed: f64) -> f64 {
                match self { $(Self::$kind(law) => law.slope(speed)),+ }
            }
        }
    };
}

laws!(numbers: Stribeck, Decreasing, Coulomb, StribeckExponential; data: Expression, Samples);

impl LawKind {
    /// The law of a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|kind| kind.name() == name)
    }
}

/// One number of each of [`Lane::LANES`] laws, side by side.
#[inline(always)]
fn side_by_side<V: Lane, L>(laws: &[L], number: impl Fn(&L) -> f64) -> V {
    let mut lanes = [0.0; MOST_LANES];
    for (lane, law) in lanes.iter_mut().zip(laws) {
        *lane = number(law);
    }
    V::load(&lanes)
}

/// Values checked against their parameters and against `relation`, which speaks only where
/// the values it relates are themselves valid.
fn checked(
    parameters: &[Parameter],
    values: &[f64],
    relation: impl FnOnce() -> Option<Invalid>,
) -> Result<(), Vec<Invalid>> {
    if values.len() != parameters.len() {
        let allowed = format!("as many values as the law has parameters, {}", parameters.len());
        return Err(vec![Invalid::new("friction", values.len(), allowed)]);
    }
    let complaints: Vec<_> = parameters
        .iter()
        .zip(values)
        .filter_map(|(parameter, &value)| parameter.check(value).err())
        .chain(relation())
        .collect();
    if complaints.is_empty() { Ok(()) } else { Err(complaints) }
}

/// μ_s ≥ μ_d, which the laws with a sliding coefficient need.
fn static_at_least_sliding(coefficient: f64, static_coefficient: f64) -> Option<Invalid> {
    use crate::parameter::{COEFFICIENT, STATIC_COEFFICIENT};
    let judged = COEFFICIENT.bounds.contains(coefficient)
        && STATIC_COEFFICIENT.bounds.contains(static_coefficient);
    (judged && static_coefficient < coefficient).then(|| {
        let allowed = format!("at least friction.coefficient = {coefficient}");
        Invalid::new(STATIC_COEFFICIENT.path, static_coefficient, allowed)
    })
}

/// μ_m ≤ μ_s, which the laws of the dissertation need.
fn minimum_at_most_static(static_coefficient: f64, minimum_coefficient: f64) -> Option<Invalid> {
    use crate::parameter::{MINIMUM_COEFFICIENT, STATIC_COEFFICIENT};
    let judged = STATIC_COEFFICIENT.bounds.contains(static_coefficient)
        && MINIMUM_COEFFICIENT.bounds.contains(minimum_coefficient);
    (judged && minimum_coefficient > static_coefficient).then(|| {
        Invalid::new(
            MINIMUM_COEFFICIENT.path,
            minimum_coefficient,
            format!("at most friction.static_coefficient = {static_coefficient}"),
        )
    })
}
