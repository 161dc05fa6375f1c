//! Averaging: what a fast dither makes of a friction law.
//!
//! The slow motion obeys Z″ + 2ζZ′ + Z = μ̄(v₀ − Z′)F with the effective friction μ̄ (2.21, 3.19, 4.27); steady sliding is
//! unstable iff 2ζ + Fμ̄′(v₀) < 0 (2.26).

mod criterion;
mod critical_amplitudes;
mod decreasing;
mod edges;
mod effective;
mod everywhere_stable;
mod fast_motion;
mod independent;
mod periodic;
mod sign_changes;
mod single_wave;
mod stribeck;
mod wave;

pub use criterion::{Criterion, UndecidedBecause, Verdict, criterion};
pub use critical_amplitudes::{Becomes, CriticalAmplitude, critical_amplitudes};
pub use edges::{Band, CriticalVelocity, closed_band, undithered_critical_velocity, unstable_bands};
pub use effective::{AveragingError, Effective, Side, effective, effective_by_quadrature};
pub use everywhere_stable::{EverywhereStable, NeverStable, everywhere_stable_amplitude};
pub use fast_motion::{
    AveragingOptions, FastMotion, LoadTerm, MAX_HARMONIC, NormalOrder, PeriodicMotion, Response,
    SlipTerm,
};
pub use independent::MAX_GROUPS;
pub use sign_changes::Crossing;
pub use wave::FastWave;
