//! The friction laws as one type, and what holds for each of them.

use std::any::Any;

use quell_numerics::lane::Lane;

use super::law::AnyLaw;
use super::{
    BranchSeries, Bristles, ConstantsVisitor, Coulomb, Decreasing, Expression, LawParameters,
    LawSeries, LawVisitor, Lugre, NumericLaw, Otherwise, Samples, SlidingLaw, SlipRange, Stribeck,
    StribeckExponential, Surroundings,
};
use crate::parameter::Parameter;
use crate::units::UnitValues;
use crate::{Invalid, InvalidValues};

macro_rules! laws {
    (numbers: $($numeric:ident),+; data: $($carrying:ident),+; recurrences: $($own:ident),+ $(,)?) => {
        laws!(@ $($numeric),+, $($carrying),+);
        recurrences!($($own),+);

        impl LawKind {
            /// Laws defined by numbers alone.
            pub const NUMERIC: &'static [Self] = &[$(Self::$numeric),+];

            /// Builds a law from values in the order of its parameters.
            ///
            /// # Errors
            /// Every value out of its bounds, and every relation that does not hold; a law that
            /// is not defined by numbers alone.
            pub fn build(self, values: &[f64]) -> Result<Friction, InvalidValues> {
                match self {
                    $(Self::$numeric => $numeric::from_values(values).map(Friction::$numeric),)+
                    $(Self::$carrying => {
                        let allowed = "a law defined by numbers alone; this one is built from data";
                        Err(InvalidValues::from(Invalid::new("friction.law", $carrying::NAME, allowed)))
                    })+
                }
            }
        }
    };
    (@ $($kind:ident),+) => {
        /// The kinds of friction law.
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
                match self { $(Self::$kind => <$kind as LawParameters>::NAME),+ }
            }

            /// Whether the law has a state of its own ([`Friction::bristles`]).
            pub fn has_state(self) -> bool {
                match self { $(Self::$kind => <$kind as LawParameters>::HAS_STATE),+ }
            }

            /// Description in one line.
            pub fn about(self) -> &'static str {
                match self { $(Self::$kind => <$kind as LawParameters>::ABOUT),+ }
            }

            /// Numbers that a study may give for the law and that are not in its formula.
            pub fn options(self) -> &'static [Parameter] {
                match self { $(Self::$kind => <$kind as LawParameters>::OPTIONS),+ }
            }

            /// The default value of a parameter; `None` if the parameter is required.
            pub fn default_of(self, path: &str) -> Option<Otherwise> {
                match self { $(Self::$kind => <$kind as LawParameters>::default_of(path)),+ }
            }

            /// Parameters of the law, in the order of [`Friction::values`].
            pub fn parameters(self) -> &'static [Parameter] {
                match self { $(Self::$kind => <$kind as LawParameters>::PARAMETERS),+ }
            }
        }

        impl FrictionConstants {
            /// The constants of a law.
            pub fn of(law: &Friction) -> Self {
                match law {
                    $(Friction::$kind(law) => Recurring::in_lanes(std::slice::from_ref(law.recurrence())),)+
                }
            }
        }

        impl<V: Lane> FrictionConstants<V> {
            /// The constants of [`Lane::LANES`] laws, one per lane; `None` if they are not all alike ([`Friction::is_alike`]) or
            /// of another number.
            pub fn side_by_side(laws: &[Friction]) -> Option<Self> {
                let first = laws.first()?;
                if laws.len() != V::LANES || !laws.iter().all(|law| law.is_alike(first)) {
                    return None;
                }
                Some(match first {
                    $(Friction::$kind(_) => {
                        type Law = <$kind as SlidingLaw>::Recurrence;
                        Recurring::in_lanes(&laws.iter().map(Law::of).collect::<Option<Vec<_>>>()?)
                    })+
                })
            }
        }

        impl AnyLaw for Friction {
            fn recurring(&self) -> &dyn Any {
                match self { $(Self::$kind(law) => law.recurrence()),+ }
            }
        }

        impl Friction {
            /// The kind of the law.
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
            pub fn with(&self, path: &str, value: f64) -> Result<Self, InvalidValues> {
                match self { $(Self::$kind(law) => law.with(path, value).map(Self::$kind)),+ }
            }

            /// Whether runs with this law and with the other can share SIMD lanes: both are of one
            /// kind and differ only in numbers.
            pub fn is_alike(&self, other: &Self) -> bool {
                match (self, other) {
                    $((Self::$kind(law), Self::$kind(other)) => law.recurrence().is_alike(other.recurrence()),)+
                    _ => false,
                }
            }

            /// Whether the sliding branch starts from the static level, μ(0⁺) = μ_s.
            pub fn starts_at_static_level(&self) -> bool {
                match self { $(Self::$kind(law) => law.starts_at_static_level()),+ }
            }

            /// Passes the law with the recurrence to `visitor`.
            #[inline]
            pub fn visit<T: LawVisitor>(&self, visitor: T) -> T::Output {
                match self { $(Self::$kind(law) => visitor.visit(law.recurrence())),+ }
            }

            /// The law for use in a given belt ([`SlidingLaw::placed`]).
            ///
            /// # Errors
            /// What could not be proven of a user-defined law, and at which slip.
            pub fn placed(&self, surroundings: &Surroundings) -> Result<Self, InvalidValues> {
                match self { $(Self::$kind(law) => law.placed(surroundings).map(Self::$kind)),+ }
            }

            /// Slip speeds for which the law holds; `None` if it holds for all.
            pub fn range(&self) -> Option<SlipRange> {
                match self { $(Self::$kind(law) => law.range()),+ }
            }

            /// Why the law cannot be simulated; `None` if it can.
            pub fn unsimulated(&self) -> Option<&'static str> {
                match self { $(Self::$kind(law) => law.unsimulated()),+ }
            }

            /// The bristles whose deflection is a state of the law; `None` of a law of the slip velocity alone.
            pub fn bristles(&self) -> Option<Bristles> {
                match self { $(Self::$kind(law) => law.bristles()),+ }
            }

            /// Whether the law has a characteristic velocity.
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

/// The laws with a recurrence of their own, as one type.
macro_rules! recurrences {
    ($($kind:ident),+) => {
        /// The constants of a law's recurrence in each lane, for engines whose contacts have different laws.
        pub enum FrictionConstants<V: Lane = f64> {
            $(#[doc = concat!("[`", stringify!($kind), "`].")] $kind(<$kind as LawSeries>::Constants<V>),)+
        }

        /// The Taylor recurrence of a law in each lane.
        pub enum FrictionSeries<'c, V: Lane, const N: usize> {
            $(#[doc = concat!("[`", stringify!($kind), "`].")] $kind(<$kind as LawSeries>::Series<'c, V, N>),)+
        }

        $(impl Recurring for $kind {
            fn in_lanes<V: Lane>(laws: &[Self]) -> FrictionConstants<V> {
                FrictionConstants::$kind(Self::constants::<V>(laws))
            }
        })+

        impl<V: Lane> FrictionConstants<V> {
            /// Starts the recurrence on the branch of `sign` (±1) at scaled slip `w0`.
            #[inline(always)]
            pub fn series<const N: usize>(&mut self, sign: V, w0: V) -> FrictionSeries<'_, V, N> {
                match self {
                    $(Self::$kind(constants) => FrictionSeries::$kind(
                        <$kind as LawSeries>::series::<V, N>(constants, sign, w0),
                    ),)+
                }
            }
        }

        impl<V: Lane> FrictionConstants<V> {
            /// Passes the constants to `visitor`, which is compiled for each recurrence.
            #[inline(always)]
            pub fn visit<T: ConstantsVisitor<V>>(&mut self, visitor: T) -> T::Output {
                match self { $(Self::$kind(constants) => visitor.visit::<$kind>(constants)),+ }
            }
        }

        impl<V: Lane> FrictionConstants<V> {
            /// The coefficient along a scaled slip w(t) on the branch of `sign` (±1), order by order.
            #[inline(always)]
            pub fn along<const N: usize>(&mut self, sign: V, w: &[V; N]) -> [V; N] {
                match self {
                    $(Self::$kind(constants) => {
                        composed(<$kind as LawSeries>::series::<V, N>(constants, sign, w[0]), w)
                    })+
                }
            }
        }

        impl<V: Lane, const N: usize> BranchSeries<V> for FrictionSeries<'_, V, N> {
            #[inline(always)]
            fn first(&self) -> V {
                match self { $(Self::$kind(series) => series.first()),+ }
            }

            #[inline(always)]
            fn slope(&self) -> V {
                match self { $(Self::$kind(series) => series.slope()),+ }
            }

            #[inline(always)]
            fn lower(&mut self, k: usize, w: &[V]) -> V {
                match self { $(Self::$kind(series) => series.lower(k, w)),+ }
            }

            #[inline(always)]
            fn trusted(&self, w: &[V], length: V) -> V {
                match self { $(Self::$kind(series) => series.trusted(w, length)),+ }
            }
        }
    };
}

/// The coefficient along w(t), all of whose terms are known.
#[inline(always)]
fn composed<V: Lane, const N: usize>(mut branch: impl BranchSeries<V>, w: &[V; N]) -> [V; N] {
    let slope = branch.slope();
    let mut series = [branch.first(); N];
    const { assert!(N <= 17, "unrolled up to order 16") };
    quell_numerics::for_each_order_below_16!(J, {
        const K: usize = J + 1;
        if K < N {
            series[K] = slope.mul_add(w[K], branch.lower(K, w));
        }
    });
    series
}

/// A law with a recurrence of its own, as a variant of [`FrictionConstants`].
trait Recurring: LawSeries {
    /// The constants of [`Lane::LANES`] laws.
    fn in_lanes<V: Lane>(laws: &[Self]) -> FrictionConstants<V>;
}

laws!(
    numbers: Stribeck, Decreasing, Coulomb, StribeckExponential, Lugre;
    data: Expression, Samples;
    recurrences: Stribeck, Decreasing, Coulomb, StribeckExponential, Expression,
);

impl Friction {
    /// The law with slip in another unit of velocity.
    ///
    /// # Errors
    /// Numbers that are out of their bounds there.
    pub fn in_units(&self, unit: &UnitValues) -> Result<Self, InvalidValues> {
        let velocity = unit.velocity;
        match self {
            Self::Expression(law) => {
                Ok(Self::Expression(law.in_unit(velocity * law.velocity_unit())))
            }
            Self::Samples(law) => {
                Ok(Self::Samples(law.in_unit(velocity * law.curve().velocity_unit())))
            }
            law => {
                let (kind, values) = (law.kind(), law.values());
                let numbers = kind.parameters().iter().zip(values);
                let scaled =
                    |(parameter, value): (&Parameter, f64)| value * unit.of_law(parameter.quantity);
                kind.build(&numbers.map(scaled).collect::<Vec<f64>>())
            }
        }
    }
}

impl LawKind {
    /// The law with a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|kind| kind.name() == name)
    }
}
