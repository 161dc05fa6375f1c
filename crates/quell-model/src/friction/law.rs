//! The traits of a friction law: its numbers in a study, its values in steady sliding, its Taylor series.
//!
//! There is one trait for each use: [`LawParameters`] to read and print a law, [`SlidingLaw`] for its physics, [`LawSeries`]
//! for the engines. The formula is written once, in the series; values and slopes are its first terms.

use std::any::Any;

use quell_numerics::lane::Lane;

use super::series::BranchSeries;
use super::{Bristles, SlipRange, Surroundings};
use crate::InvalidValues;
use crate::parameter::Parameter;

/// The default value of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Otherwise {
    /// This number.
    Number(f64),
    /// The value of the parameter with this path.
    SameAs(&'static str),
}

/// The numbers of a law, as a study file gives them.
pub trait LawParameters: Sized {
    /// Name in a study file.
    const NAME: &'static str;
    /// Description in one line: the formula and its source.
    const ABOUT: &'static str;
    /// The law's parameters in the registry, in the order of [`LawParameters::values`].
    const PARAMETERS: &'static [Parameter];

    /// Whether the law has a state of its own ([`SlidingLaw::bristles`]), so that the engine for belts does not simulate it.
    const HAS_STATE: bool = false;

    /// Numbers that a study may give for the law and that are not in its formula.
    const OPTIONS: &'static [Parameter] = &[];

    /// The default value of a parameter; `None` if the parameter is required.
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
    /// A path that the law does not have; a value that is out of bounds or violates a relation.
    fn with(&self, path: &str, value: f64) -> Result<Self, InvalidValues>;
}

/// A friction law in steady sliding, analytic on each side of v_r = 0.
pub trait SlidingLaw: LawParameters + Clone + Send + Sync + 'static {
    /// The law with the recurrence of its Taylor series: itself, or the law of which it is a case with other numbers. Engines
    /// are compiled for laws with a recurrence of their own.
    type Recurrence: LawSeries;

    /// The law as one with a recurrence of its own.
    fn recurrence(&self) -> &Self::Recurrence;

    /// The law for use at a given contact: its properties are proven over the slip range of the contact, and a law without a
    /// characteristic velocity takes one from the contact to scale slip.
    ///
    /// # Errors
    /// What could not be proven of a user-defined law, and at which slip.
    fn placed(&self, surroundings: &Surroundings) -> Result<Self, InvalidValues> {
        let _ = surroundings;
        Ok(self.clone())
    }

    /// Slip speeds for which the law holds; `None` if it holds for all.
    fn range(&self) -> Option<SlipRange> {
        None
    }

    /// Why the law cannot be simulated; `None` if it can. Averages are valid for every law.
    fn unsimulated(&self) -> Option<&'static str> {
        None
    }

    /// The bristles whose deflection is a state of the law; `None` of a law of the slip velocity alone.
    fn bristles(&self) -> Option<Bristles> {
        None
    }

    /// Characteristic velocity of the law (v_m), which scales slip: w = v_r/v_m.
    fn velocity_scale(&self) -> f64;

    /// Whether the law has a characteristic velocity, so that [`SlidingLaw::velocity_scale`] is a property of the law.
    fn has_velocity(&self) -> bool {
        true
    }

    /// Static level μ_s.
    fn static_coefficient(&self) -> f64;

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

    /// Coefficient and slope dμ/dw at one slip speed |v_r|, without further terms of the series.
    #[inline(always)]
    fn alone(&self, speed: f64) -> (f64, f64) {
        let law = std::slice::from_ref(self.recurrence());
        let mut constants = Self::Recurrence::constants::<f64>(law);
        let scaled = speed / self.velocity_scale();
        let branch = Self::Recurrence::series::<f64, 1>(&mut constants, 1.0, scaled);
        (branch.first(), branch.slope())
    }
}

/// The Taylor series of a law along a slip, for one run or for several in SIMD lanes.
pub trait LawSeries: SlidingLaw<Recurrence = Self> {
    /// The constants of the recurrence in each lane.
    /// A law with data also stores the memory of its recurrence here, so that no step allocates.
    type Constants<V: Lane>: Send + Sync;

    /// Constants of [`Lane::LANES`] laws, one per lane, all alike.
    fn constants<V: Lane>(laws: &[Self]) -> Self::Constants<V>;

    /// Whether two laws differ only in numbers, so that they can share lanes.
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

    /// The law in `friction`, if its recurrence is of this kind.
    fn of(friction: &impl AnyLaw) -> Option<Self> {
        friction.recurring().downcast_ref::<Self>().cloned()
    }
}

/// A law of any kind, such as [`Friction`](super::Friction).
pub trait AnyLaw {
    /// The concrete law with the recurrence.
    fn recurring(&self) -> &dyn Any;
}

/// An operation on the constants of a law's recurrence in each lane, for code that is compiled per recurrence.
pub trait ConstantsVisitor<V: Lane> {
    /// Result of the operation.
    type Output;
    /// Applies the operation to the constants of laws with the recurrence of `L`.
    fn visit<L: LawSeries>(self, constants: &mut L::Constants<V>) -> Self::Output;
}

/// An operation on the concrete law, for code that is compiled per recurrence.
pub trait LawVisitor {
    /// Result of the operation.
    type Output;
    /// Applies the operation to a concrete law.
    fn visit<L: LawSeries>(self, law: &L) -> Self::Output;
}
