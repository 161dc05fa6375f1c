//! Averaging: the effect of fast dither on a friction law and on the stability of steady sliding.
//!
//! The slow motion satisfies Z″ + 2ζZ′ + Z = μ̄(v₀ − Z′)F with the effective friction μ̄ (2.21, 3.19, 4.27). Steady sliding is
//! unstable iff 2ζ + Fμ̄′(v₀) < 0 (2.26).
//!
//! ```
//! use quell_linear::averaging::{Averaging, CrossingKind, critical_amplitudes};
//! use quell_model::{Belt, Direction, Dither, LawKind, Waveform};
//!
//! let law = LawKind::Decreasing.build(&[0.4, 0.2857, 0.2])?;
//! let dither = Dither {
//!     direction: Direction::Tangential,
//!     waveform: Waveform::Sine,
//!     amplitude: 5.0,
//!     frequency_ratio: 10.0,
//!     phase: 0.0,
//!     envelope: None,
//! };
//! let belt = Belt::new(0.005, 1.0, 1.0, law, vec![dither])?;
//! // Dither destabilises between a root of the criterion and its jump, where the fast velocity reaches the belt velocity.
//! let critical = critical_amplitudes(&belt, Averaging::FiniteR).expect("one dither");
//! assert!((critical[0].amplitude - 4.322392).abs() < 1e-6); // exact: 4.322393
//! assert!((critical[1].amplitude - 9.9).abs() < 1e-12 && critical[1].crossing == CrossingKind::Jump);
//! # Ok::<(), quell_model::InvalidValues>(())
//! ```
//!
//! | file | content |
//! |---|---|
//! | `wave` | shape of the fast velocity of one dither: G, or the oscillator's own response |
//! | `periodic_motion`, `fast_motion` | fast slip and load of one period, and of groups of incommensurate frequencies |
//! | `dithers` | the fast motion of a belt's dithers in the limit of high frequency, grouped by frequency |
//! | `belt_averages` | the averaged law of a belt at one slow slip velocity and any amplitude |
//! | `effective`, `error` | μ̄ and its frozen slope with their error bounds, or why they have no value |
//! | `stribeck`, `decreasing` | closed forms for one law |
//! | `single_wave`, `periodic`, `independent` | any law under one shape, a periodic sum, several frequencies |
//! | `pieces` | any law under one wave by samples, piece by piece |
//! | `gaussian` | any law under noise, whose fast velocity is Gaussian |
//! | `mean_friction` | the method for each fast motion |
//! | `averaged_law` | the mean of one contact over its slow slip velocity |
//! | `describing` | averaged friction under a slow sinusoid: equivalent gain and limit cycles |
//! | `slow_vibration` | the slow vibration of a system by harmonic balance with that gain |
//! | `criterion` | 2ζ + Fμ̄′(v₀) and its verdict |
//! | `critical_amplitudes`, `edges`, `everywhere_stable`, `everywhere_stable_noise` | points at which the verdict changes: along α, along v₀, and α^L |
//! | `wave_response` | the response of a sliding structure to one wave |
//! | `contact_motion`, `fast_inputs` | the fast motion at one contact, and at all contacts for any amplitudes |
//! | `sliding`, `sliding_critical` | averaged sliding of systems of any number of contacts, and its critical amplitudes |
//! | `sign_changes` | every change of sign of a function on a grid |

mod averaged_law;
mod belt_averages;
mod contact_motion;
mod criterion;
mod critical_amplitudes;
mod decreasing;
mod describing;
mod dithers;
mod edges;
mod effective;
mod error;
mod everywhere_stable;
mod everywhere_stable_noise;
mod fast_inputs;
mod fast_motion;
mod gaussian;
mod independent;
mod mean_friction;
mod periodic;
mod periodic_motion;
mod pieces;
mod sign_changes;
mod single_wave;
mod sliding;
mod sliding_critical;
mod slow_vibration;
mod stribeck;
mod wave;
mod wave_response;

pub use averaged_law::AveragedLaw;
pub use criterion::{AveragedVerdict, Criterion, UndecidedBecause, criterion};
pub use critical_amplitudes::{Becomes, CriticalAmplitude, critical_amplitudes};
pub use describing::{DescribedCycle, DescribingFunction, EquivalentGain};
pub(crate) use dithers::commensurate_groups;
pub use dithers::{Averaging, MAX_HARMONIC};
pub use edges::{
    CriticalVelocity, NoBand, UnstableBand, closed_band, undithered_critical_velocity,
    unstable_bands,
};
pub use effective::{Effective, SlopeSide};
pub use error::AveragingError;
pub use everywhere_stable::{EverywhereStable, NeverStable, everywhere_stable_amplitude};
pub use everywhere_stable_noise::everywhere_stable_under_noise;
pub use fast_inputs::{DitheredContact, FastInputs};
pub use fast_motion::FastMotion;
pub use gaussian::effective_under_noise_by_quadrature;
pub use independent::MAX_GROUPS;
pub use mean_friction::effective;
pub use periodic_motion::{LoadTerm, LoadWave, PeriodicMotion, SlipTerm};
pub use sign_changes::CrossingKind;
pub(crate) use sign_changes::{SignChange, sign_changes};
pub use single_wave::effective_by_quadrature;
pub use sliding::{AveragedSliding, DitheredSystem};
pub use sliding_critical::CriticalInput;
pub use slow_vibration::{DescribedVibration, NoSlowVibration, SlowVibration};
pub use wave::FastWave;
