//! Friction laws.
//!
//! A law is one file that implements [`LawParameters`], [`SlidingLaw`] and [`LawSeries`], and its name in the lists of
//! `laws!(…)` of `kinds.rs`. A law whose series is that of another implements no [`LawSeries`] of its own, and engines are
//! compiled for the other alone ([`SlidingLaw::Recurrence`]). Its formula is written once, as a recurrence for Taylor coefficients
//! ([`BranchSeries`]): the engine, its SIMD lanes, values, slopes and plots all use it.
//! μ is odd; at v_r = 0 it is set-valued in [−μ_s, μ_s] (the static level is separate from
//! the sliding branch).
//!
//! Most laws are defined by a few numbers ([`NumericLaw`]). A law may also carry data that its runs share:
//! a formula ([`Expression`]) or the approximant of measured samples ([`Samples`]).

mod bristles;
mod coulomb;
mod decreasing;
mod derivatives;
pub mod expression;
mod kinds;
mod law;
mod lugre;
mod numeric;
mod range;
pub mod samples;
mod series;
mod stribeck;
mod stribeck_exponential;

pub use bristles::Bristles;
pub use coulomb::{Coulomb, CoulombConstants, CoulombSeries};
pub use decreasing::{Decreasing, DecreasingConstants, DecreasingSeries};
pub use expression::Expression;
pub use kinds::{Friction, FrictionConstants, FrictionSeries, LawKind};
pub use law::{
    AnyLaw, ConstantsVisitor, LawParameters, LawSeries, LawVisitor, Otherwise, SlidingLaw,
};
pub use lugre::Lugre;
pub use numeric::NumericLaw;
pub use range::{RangeLimit, SlipRange, Surroundings};
pub use samples::Samples;
pub use series::BranchSeries;
pub use stribeck::{Stribeck, StribeckConstants, StribeckSeries};
pub use stribeck_exponential::{
    StribeckExponential, StribeckExponentialConstants, StribeckExponentialSeries,
};
