//! Nouns of Quell: friction laws, waveforms, dither, valid parameters, units.
//!
//! A value that exists is valid: constructors return every complaint at once as
//! [`Invalid`]. Symbols and equation numbers are those of Michaux (2005), *Suppression of
//! Friction-Induced Oscillations through Use of High-Frequency Dither Signals*.

pub mod belt;
pub mod disc;
pub mod dither;
pub mod friction;
mod invalid;
pub mod parameter;
pub mod units;
pub mod waveform;

pub use belt::Belt;
pub use disc::Disc;
pub use dither::{Direction, Dither};
pub use friction::{
    Coulomb, Expression, Friction, LawKind, Samples, SlidingLaw, StribeckExponential,
};
pub use invalid::Invalid;
pub use waveform::Waveform;
