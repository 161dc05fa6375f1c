//! Averaged steady sliding of a system of any number of contacts under fast dither.
//!
//! The slow motion feels the mean friction ⟨μ_c(γ + a_c)(N_c + Ñ_c)⟩ of each contact, where the fast slip a_c and the fast load Ñ_c
//! are the linear response of the sliding system ([`crate::harmonic`]). They stay frozen when the mean is differentiated by γ
//! and N. The mean is linear in the load, T̄ = m₀N + m₁ with the effective coefficient m₀ = ⟨μ(γ + a)⟩ and the ratchet force
//! m₁ = ⟨μ(γ + a)Ñ⟩, so that steady sliding and its small motions are those of a system without dither and with other friction
//! ([`crate::steady::FrictionLine`]).
//!
//! Sines and sums of harmonics enter by their harmonics, every other periodic waveform by its periodic response, piece by piece
//! ([`crate::periodic_response`]). Both are exact. Noise enters by the moments of its lines: the fast slip and load are Gaussian, with
//! the variances and the covariance of the sums over the lines.
//!
//! The load that a contact without a normal row bears by itself moves it through friction. That motion is driven by the mean friction
//! under the other dithers, and carried to second order, as of the mass above its resonance (4.23): s = S − (μ′/2μ)(S² − ⟨S²⟩).

use num_complex::Complex64;
use quell_model::System;
use quell_model::profile::Wave;
use quell_model::system::{Contact, Input, InputTarget};
use quell_numerics::eigen::EigenError;
use quell_numerics::polar::{from_polar, modulus};

use super::error::AveragingError;
use super::fast_inputs::{DitheredContact, FastInputs};
use super::wave_response::{WaveResponse, WaveShape, driven, without_damper};
use crate::growth::Growth;
use crate::harmonic::{self, ContactResponse};
use crate::linearised::{FrictionSlopes, Linearised};
use crate::periodic_response::ResponseToWave;
use crate::spectrum::{self, MotionSpectrum};
use crate::steady::{FrictionLine, NoSteadySliding, SteadySliding};

/// Averaged steady sliding with its linear equations.
#[derive(Clone, Debug)]
pub struct AveragedSliding {
    /// The linear equations of small slow motions.
    pub linear: Linearised,
    /// Mean friction of each contact and its slopes.
    pub friction: Vec<FrictionSlopes>,
    /// The contacts.
    pub contacts: Vec<DitheredContact>,
}

impl AveragedSliding {
    /// Every small slow motion.
    ///
    /// # Errors
    /// [`EigenError`] where the matrix overflows.
    pub fn spectrum(&self) -> Result<MotionSpectrum, EigenError> {
        spectrum::spectrum(&self.linear, &self.friction)
    }

    /// Largest growth rate of small slow motions.
    ///
    /// # Errors
    /// As [`AveragedSliding::spectrum`].
    pub fn growth(&self) -> Result<Growth, EigenError> {
        spectrum::growth(&self.linear, &self.friction)
    }
}

/// A system with the response of its structure to every dither, prepared for any amplitudes.
#[derive(Clone, Debug)]
pub struct DitheredSystem<'a> {
    system: &'a System,
    sliding: Linearised,
    fast: FastInputs,
}

impl<'a> DitheredSystem<'a> {
    /// Prepares a system.
    ///
    /// # Errors
    /// [`AveragingError`] without steady sliding, at an undamped resonance, for more than [`super::MAX_GROUPS`], and for a factor on
    /// friction.
    pub fn new(system: &'a System) -> Result<Self, AveragingError> {
        let is_factor = |input: &Input| {
            matches!(input.target, InputTarget::Friction { .. })
                && !input.profile.waves().is_empty()
        };
        if system.inputs.iter().any(is_factor) {
            return Err(AveragingError::FrictionFactor);
        }
        Self::with_fast_motion(system)
    }

    /// As [`Self::new`] for the fast motion alone, which a factor on friction excites too.
    pub(crate) fn with_fast_motion(system: &'a System) -> Result<Self, AveragingError> {
        let sliding = sliding_under_dither(system)?;
        let undamped = without_damper(system);
        let about = undamped.as_ref().map(sliding_under_dither).transpose()?;
        let moved = undamped.as_ref().zip(about.as_ref());
        let mut waves = Vec::new();
        for (input, given) in system.inputs.iter().enumerate() {
            for wave in given.profile.waves().iter().cloned() {
                let shape = match moved {
                    Some((mass, about)) => WaveShape::undamped(mass, about, &given.target, &wave)?,
                    None => WaveShape::of(system, &sliding, &given.target, &wave)?,
                };
                waves.push(WaveResponse { input, wave, shape });
            }
        }
        Ok(Self { system, sliding, fast: FastInputs::of(waves)? })
    }

    /// The sliding system without dither.
    pub fn sliding(&self) -> &Linearised {
        &self.sliding
    }

    /// What the dithers do to the contacts.
    pub fn fast(&self) -> &FastInputs {
        &self.fast
    }

    /// The same without the system.
    pub(super) fn into_fast(self) -> FastInputs {
        self.fast
    }

    /// The system.
    pub fn system(&self) -> &System {
        self.system
    }

    /// Averaged sliding with the amplitudes of the system's inputs.
    ///
    /// # Errors
    /// [`AveragingError`] if the mean friction has no value or no steady sliding remains.
    pub fn average(&self) -> Result<AveragedSliding, AveragingError> {
        self.average_with(None)
    }

    /// Averaged sliding with another amplitude of one input: (its index, the amplitude of its first wave); further waves of the
    /// input change in proportion.
    ///
    /// # Errors
    /// As [`DitheredSystem::average`].
    pub fn average_with(
        &self,
        changed: Option<(usize, f64)>,
    ) -> Result<AveragedSliding, AveragingError> {
        let lines = self.fast.lines(self.system, changed)?;
        let steady = SteadySliding::with(self.system, &lines)?;
        let contacts = self.fast.contacts(self.system, &steady.contacts, changed)?;
        let linear = Linearised::about(self.system, steady)?;
        let friction = linear.friction();
        Ok(AveragedSliding { linear, friction, contacts })
    }

    /// The state at t = 0 of averaged sliding with its fast motion: a first guess of the periodic orbit.
    ///
    /// # Errors
    /// As [`DitheredSystem::average`].
    pub fn fast_state(&self) -> Result<Vec<f64>, AveragingError> {
        let average = self.average()?;
        let n = average.linear.coordinates();
        let mut state = vec![0.0; self.system.structure.state_size()];
        state[..n].copy_from_slice(average.linear.position());
        for response in &self.fast.waves {
            let target = &self.system.inputs[response.input].target;
            let moved = match &response.shape {
                WaveShape::Harmonics(harmonics) => {
                    self.state_by_harmonics(target, &response.wave, harmonics)
                }
                // No periodic orbit exists, for which this would be a first guess.
                WaveShape::Lines(_) => continue,
                WaveShape::Polynomials(_) | WaveShape::Closed { .. } => {
                    let Wave { waveform, amplitude, frequency, phase, .. } = &response.wave;
                    let equations = driven(self.system, &self.sliding, target)?;
                    let moved = ResponseToWave::new(
                        &equations.matrix,
                        &equations.source,
                        waveform,
                        *frequency,
                    )?;
                    moved.state(*phase).into_iter().map(|x| amplitude * x).collect()
                }
            };
            for (entry, own) in state.iter_mut().zip(&moved) {
                *entry += own;
            }
        }
        Ok(state)
    }

    /// What the harmonics of a wave add to the state at t = 0.
    fn state_by_harmonics(
        &self,
        target: &InputTarget,
        wave: &Wave,
        harmonics: &[(u32, Complex64, Vec<ContactResponse>)],
    ) -> Vec<f64> {
        let n = self.sliding.coordinates();
        let mut state = vec![0.0; self.system.structure.state_size()];
        for (n_th, coefficient, _) in harmonics {
            let harmonic = f64::from(*n_th);
            let frequency = harmonic * wave.frequency;
            let moved = harmonic::response(self.system, &self.sliding, target, frequency);
            let Some(moved) = moved else { continue };
            let turned = from_polar(wave.amplitude, harmonic * wave.phase) * coefficient;
            let input = -Complex64::I * turned;
            let rate = Complex64::new(0.0, frequency);
            for (i, displacement) in moved.displacement.iter().enumerate() {
                state[i] += (input * displacement).re;
                if n + i < state.len() {
                    state[n + i] += (input * displacement * rate).re;
                }
            }
        }
        state
    }
}

/// Steady sliding without dither; of surfaces at rest what it is under dither.
fn sliding_under_dither(system: &System) -> Result<Linearised, AveragingError> {
    match Linearised::new(system) {
        Err(why @ NoSteadySliding::AtRest { .. }) => dithered_at_rest(system, why),
        sliding => Ok(sliding?),
    }
}

/// A system with surfaces at rest, where the mean of friction vanishes if dither moves the contact; only of dither that is faster than
/// every motion.
fn dithered_at_rest(system: &System, why: NoSteadySliding) -> Result<Linearised, AveragingError> {
    let line = |contact: &Contact| FrictionLine::of(contact).unwrap_or(FrictionLine::NONE);
    let lines: Vec<FrictionLine> = system.contacts.iter().map(line).collect();
    let sliding = Linearised::about(system, SteadySliding::with(system, &lines)?)?;
    let motions = spectrum::spectrum(&sliding, &sliding.friction())?.motions;
    let fastest = motions.iter().map(|motion| modulus(motion.eigenvalue)).fold(0.0, f64::max);
    let slowest = system.acting_frequencies().fold(f64::INFINITY, f64::min);
    if slowest > fastest { Ok(sliding) } else { Err(why.into()) }
}
