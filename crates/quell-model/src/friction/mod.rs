//! Friction laws.
//!
//! A law is one file that implements [`SlidingLaw`], and one line in the list at the end of
//! this one. Its formula is written once, as a recurrence for Taylor coefficients
//! ([`BranchSeries`]): the engine, its SIMD lanes, values, slopes and plots all use it.
//! μ is odd; at v_r = 0 it is set-valued in [−μ_s, μ_s] (the static level is apart from
//! the sliding branch).

use quell_numerics::lane::{Lane, MOST_LANES};

use crate::Invalid;
use crate::parameter::Parameter;

mod decreasing;
mod stribeck;

pub use decreasing::{Decreasing, DecreasingConstants, DecreasingSeries};
pub use stribeck::{Stribeck, StribeckConstants, StribeckSeries};

/// A friction law in steady sliding, analytic on each side of v_r = 0.
pub trait SlidingLaw: Copy + Send + Sync + 'static {
    /// Name in a study file.
    const NAME: &'static str;
    /// One line for people: the formula and its source.
    const ABOUT: &'static str;
    /// The law's parameters, in the order of [`SlidingLaw::values`].
    const PARAMETERS: &'static [Parameter];

    /// From values in the order of `PARAMETERS`.
    ///
    /// # Errors
    /// Every value out of its bounds, and every relation that does not hold.
    fn from_values(values: &[f64]) -> Result<Self, Vec<Invalid>>;

    /// Values in the order of `PARAMETERS`.
    fn values(&self) -> Vec<f64>;

    /// Velocity by which the law is naturally scaled (v_m); slip is counted in it, w = v_r/v_m.
    fn velocity_scale(&self) -> f64;

    /// Static level μ_s.
    fn static_coefficient(&self) -> f64;

    /// Change of scaled slip w over a Taylor step of order `order` up to which the last
    /// retained terms bound the remainder. An exponential that grows from almost nothing
    /// shows no last term however far the step goes: its law must say how far it may.
    #[inline(always)]
    fn longest_change(order: usize) -> f64 {
        let _ = order;
        f64::INFINITY
    }

    /// What the recurrence needs to know of the law in each lane.
    type Constants<V: Lane>: Copy + Send + Sync;

    /// Constants of laws side by side, one law per lane: [`Lane::LANES`] of them.
    fn constants<V: Lane>(laws: &[Self]) -> Self::Constants<V>;

    /// Taylor recurrence of the sliding branch.
    type Series<V: Lane, const N: usize>: BranchSeries<V>;

    /// Starts the recurrence on the branch of `sign` (±1) at scaled slip `w0`.
    fn series<V: Lane, const N: usize>(
        constants: &Self::Constants<V>,
        sign: V,
        w0: V,
    ) -> Self::Series<V, N>;

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
        self.alone(speed).first()
    }

    /// Slope dμ/d|v_r| of the sliding branch at slip speed |v_r|, per unit velocity.
    #[inline(always)]
    fn slope(&self, speed: f64) -> f64 {
        self.alone(speed).slope() / self.velocity_scale()
    }

    /// The branch at one slip speed |v_r|, without any term of a series.
    #[inline(always)]
    fn alone(&self, speed: f64) -> Self::Series<f64, 1> {
        let constants = Self::constants::<f64>(std::slice::from_ref(self));
        Self::series(&constants, 1.0, speed / self.velocity_scale())
    }
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
}

/// Work that wants the concrete law, for code that is compiled per law.
pub trait LawVisitor {
    /// Result of the work.
    type Output;
    /// Does the work with a concrete law.
    fn visit<L: SlidingLaw>(self, law: &L) -> Self::Output;
}

macro_rules! laws {
    ($($kind:ident),+ $(,)?) => {
        /// The friction laws there are.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum LawKind {
            $(#[doc = concat!("[`", stringify!($kind), "`].")] $kind,)+
        }

        /// A friction law with valid parameters.
        #[derive(Clone, Copy, Debug, PartialEq)]
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

            /// Parameters of the law, in the order of [`Friction::values`].
            pub fn parameters(self) -> &'static [Parameter] {
                match self { $(Self::$kind => <$kind as SlidingLaw>::PARAMETERS),+ }
            }

            /// The law from values in the order of its parameters.
            ///
            /// # Errors
            /// Every value out of its bounds, and every relation that does not hold.
            pub fn build(self, values: &[f64]) -> Result<Friction, Vec<Invalid>> {
                match self {
                    $(Self::$kind => $kind::from_values(values).map(Friction::$kind)),+
                }
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

            /// Hands the concrete law to `visitor`.
            #[inline]
            pub fn visit<T: LawVisitor>(&self, visitor: T) -> T::Output {
                match self { $(Self::$kind(law) => visitor.visit(law)),+ }
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

laws!(Stribeck, Decreasing);

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

/// μ_m ≤ μ_s, which both built-in laws need.
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
