//! Averaged steady sliding of a system of any number of contacts under fast dither.
//!
//! The slow motion feels the mean friction ⟨μ_c(γ + a_c)(N_c + Ñ_c)⟩ of each contact, where the fast slip a_c and the fast load Ñ_c
//! are the linear response of the sliding system ([`crate::harmonic`]). They stay frozen when the mean is differentiated by γ
//! and N. The mean is linear in the load, T̄ = m₀N + m₁ with the effective coefficient m₀ = ⟨μ(γ + a)⟩ and the ratchet force
//! m₁ = ⟨μ(γ + a)Ñ⟩, so that steady sliding and its small motions are those of a system without dither and with other friction
//! ([`crate::steady::FrictionLine`]).
//!
//! Noise enters by the moments of its lines: the fast slip and load are Gaussian, with the variances and the covariance of the sums
//! over the lines.
//!
//! A sum of harmonics enters by its sines and cosines. Other waves that are not sines are divided into the motion far above every eigenfrequency, which has a closed form
//! ([`crate::harmonic::FreeSlip`]), and the harmonics of the remainder, which fall at least like n⁻⁴; those up to the 63rd are kept.

use num_complex::Complex64;
use quell_model::profile::Wave;
use quell_model::system::InputTarget;
use quell_model::waveform::NoiseLine;
use quell_model::{System, Waveform};
use quell_numerics::eigen::EigenError;

use super::fast_inputs::{DitheredContact, FastInputs, WaveResponse};
use super::no_average::NoAverage;
use crate::growth::Growth;
use crate::harmonic::{self, ContactResponse, FreeSlip};
use crate::linearised::{FrictionSlopes, Linearised};
use crate::spectrum::{self, MotionSpectrum};
use crate::steady::{NoSteadySliding, SteadySliding};

/// Least ratio of the frequency of a wave to that of an oscillation in closed form.
const ABOVE: f64 = 1.2;

/// Harmonics of the remainder of a wave up to this one are kept.
const MOST_HARMONICS: u32 = 63;

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
    /// [`NoAverage`] without steady sliding, at an undamped resonance, and for more than [`super::MOST_FREQUENCIES`].
    pub fn new(system: &'a System) -> Result<Self, NoAverage> {
        let sliding = Linearised::new(system)?;
        let mut waves = Vec::new();
        for (input, given) in system.inputs.iter().enumerate() {
            for wave in given.profile.waves().iter().cloned() {
                waves.push(wave_response(system, &sliding, (input, &given.target), wave)?);
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

    /// The system.
    pub fn system(&self) -> &System {
        self.system
    }

    /// Averaged sliding with the amplitudes of the system's inputs.
    ///
    /// # Errors
    /// [`NoAverage`] if the mean friction has no value or no steady sliding remains.
    pub fn average(&self) -> Result<AveragedSliding, NoAverage> {
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
    ) -> Result<AveragedSliding, NoAverage> {
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
    pub fn fast_state(&self) -> Result<Vec<f64>, NoAverage> {
        let average = self.average()?;
        let n = average.linear.coordinates();
        let mut state = vec![0.0; self.system.structure.state_size()];
        state[..n].copy_from_slice(average.linear.position());
        for response in &self.fast.waves {
            let Wave { amplitude, frequency, phase, .. } = response.wave;
            for (n_th, coefficient, _) in &response.harmonics {
                let harmonic = f64::from(*n_th);
                let target = &self.system.inputs[response.input].target;
                let moved =
                    harmonic::response(self.system, &self.sliding, target, harmonic * frequency);
                let Some(moved) = moved else { continue };
                let turned = Complex64::from_polar(amplitude, harmonic * phase) * coefficient;
                let input = -Complex64::I * turned;
                let rate = Complex64::new(0.0, harmonic * frequency);
                for (i, displacement) in moved.displacement.iter().enumerate() {
                    state[i] += (input * displacement).re;
                    if n + i < state.len() {
                        state[n + i] += (input * displacement * rate).re;
                    }
                }
            }
        }
        Ok(state)
    }
}

/// The response to one wave.
fn wave_response(
    system: &System,
    sliding: &Linearised,
    (input, target): (usize, &InputTarget),
    wave: Wave,
) -> Result<WaveResponse, NoAverage> {
    let at = |n: u32| {
        let frequency = f64::from(n) * wave.frequency;
        harmonic::response(system, sliding, target, frequency)
            .map(|response| response.contacts)
            .ok_or(NoAverage::Resonance { frequency })
    };
    if let Some(known) = wave.waveform.harmonics() {
        let harmonics: Result<Vec<_>, NoAverage> = known
            .iter()
            .map(|h| Ok((h.order, Complex64::new(h.sine, h.cosine), at(h.order)?)))
            .collect();
        return Ok(WaveResponse::of(input, wave, harmonics?));
    }
    if let Some(noise) = wave.waveform.noise() {
        let line = |line: &NoiseLine| {
            let frequency = line.ratio * wave.frequency;
            harmonic::response(system, sliding, target, frequency)
                .map(|response| response.contacts)
                .ok_or(NoAverage::Resonance { frequency })
        };
        let lines: Result<Vec<_>, NoAverage> = noise.lines().iter().map(line).collect();
        let lines = lines?;
        return Ok(WaveResponse { lines, ..WaveResponse::of(input, wave, Vec::new()) });
    }
    if !wave.waveform.is_symmetric() {
        return Err(NoAverage::Waveform { name: wave.waveform.name() });
    }
    if wave.waveform == Waveform::Sine {
        let harmonics = vec![(1, Complex64::ONE, at(1)?)];
        return Ok(WaveResponse::of(input, wave, harmonics));
    }
    // The closed form of an oscillation needs a frequency well above it.
    let slow = |free: FreeSlip| FreeSlip {
        natural: free.natural.filter(|natural| wave.frequency > ABOVE * natural),
        ..free
    };
    let free = harmonic::free_slip(system, sliding, target);
    let free = free.ok_or(NoSteadySliding::NoMass)?.into_iter().map(slow).collect();
    let mut harmonics: Vec<(u32, Complex64, Vec<ContactResponse>)> = Vec::new();
    for n in (1..=MOST_HARMONICS).step_by(2) {
        let coefficient = wave.waveform.sine_coefficient(n).unwrap_or(0.0);
        harmonics.push((n, coefficient.into(), at(n)?));
    }
    Ok(WaveResponse { free: Some(free), ..WaveResponse::of(input, wave, harmonics) })
}
