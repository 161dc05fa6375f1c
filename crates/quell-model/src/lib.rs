//! The models of Quell: the systems that a study describes, as valid values.
//!
//! * [`system`]: a linear structure with friction contacts and inputs, common to all kinds of study; [`profile`]: quantities
//!   that vary in time;
//! * [`belt`], [`disc`]: the two kinds of system with their parameters, each of which gives its system;
//! * [`friction`], [`waveform`], [`dither`]: laws, waves, and the dither of a belt;
//! * [`parameter`], [`units`]: the registry of all numbers with symbols, bounds and units; [`digits`]: numbers in sentences.
//!
//! A value that exists is valid: constructors return all invalid values together, as
//! [`InvalidValues`]. Symbols and equation numbers are those of Michaux (2005), *Suppression of
//! Friction-Induced Oscillations through Use of High-Frequency Dither Signals*.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod belt;
pub mod digits;
pub mod disc;
pub mod dither;
pub mod friction;
mod invalid;
pub mod parameter;
pub mod profile;
mod recorded;
mod refused;
pub mod system;
pub mod units;
pub mod waveform;

pub use belt::{Belt, OneMass};
pub use disc::Disc;
pub use dither::{Direction, Dither};
pub use friction::{
    Coulomb, Expression, Friction, LawKind, LawParameters, LawSeries, Samples, SlidingLaw,
    StribeckExponential,
};
pub use invalid::{Invalid, InvalidValues};
pub use profile::Profile;
pub use recorded::RecordedQuantity;
pub use refused::RefusedNumbers;
pub use system::{Contact, Input, Structure, System};
pub use waveform::Waveform;

/// The parameters of every kind of system, kind by kind: study files, `--set` and the schema are made of them.
pub const PARAMETERS: &[&[parameter::Parameter]] =
    &[parameter::BELT, parameter::disc::DISC, parameter::system::SYSTEM];
