//! Averaged steady sliding of a system of any number of contacts under fast dither.
//!
//! The slow motion feels the mean friction ⟨μ_c(γ + a_c)(N_c + Ñ_c)⟩ of each contact, where the fast slip a_c and the fast load Ñ_c
//! are the linear response of the sliding system ([`crate::harmonic`]). They stay frozen when the mean is differentiated by γ
//! and N. The mean is linear in the load, T̄ = m₀N + m₁ with the effective coefficient m₀ = ⟨μ(γ + a)⟩ and the ratchet force
//! m₁ = ⟨μ(γ + a)Ñ⟩, so that steady sliding and its small motions are those of a system without dither and with other friction
//! ([`FrictionLine`]).
//!
//! Waves that are not sines are divided into the motion of free masses, whose slip is an integral of the wave, and the harmonics
//! of the remainder, which fall quickly.

use std::collections::BTreeMap;

use num_complex::Complex64;
use quell_model::profile::Wave;
use quell_model::system::InputTarget;
use quell_model::{System, Waveform};
use quell_numerics::eigen::EigenError;

use super::dithers::commensurate_groups;
use super::error::AveragingError;
use super::fast_motion::FastMotion;
use super::mean_friction::effective;
use super::periodic_motion::{LoadTerm, PeriodicMotion, SlipTerm};
use super::wave::FastWave;
use crate::growth::Growth;
use crate::harmonic::{self, ContactResponse};
use crate::linearised::{FrictionSlopes, Linearised};
use crate::spectrum::{self, Spectrum};
use crate::steady::{FrictionLine, NoSteadySliding, SteadySliding};

/// Most incommensurate frequencies whose mean is taken: over a torus of two phases.
pub const MOST_FREQUENCIES: usize = 2;

/// Harmonics of the remainder of a wave up to this one are kept.
const MOST_HARMONICS: u32 = 63;

/// Harmonics below this share of the largest are left out.
const SMALLEST_HARMONIC: f64 = 1e-14;

/// Why dithered sliding has no average.
#[derive(Clone, Debug, PartialEq)]
pub enum NoAverage {
    /// There is no steady sliding, with or without dither.
    NoSteadySliding(NoSteadySliding),
    /// A dither excites an undamped resonance.
    Resonance {
        /// Angular frequency.
        frequency: f64,
    },
    /// More incommensurate frequencies than [`MOST_FREQUENCIES`].
    TooManyFrequencies {
        /// Their number.
        count: usize,
    },
    /// The mean friction has no value.
    Mean(AveragingError),
    /// The state matrix overflows.
    Eigenvalues(EigenError),
}

impl std::fmt::Display for NoAverage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NoSteadySliding(why) => write!(f, "no steady sliding: {why}"),
            Self::Resonance { frequency } => {
                write!(
                    f,
                    "the dither of angular frequency {frequency} excites an undamped resonance"
                )
            }
            Self::TooManyFrequencies { count } => write!(
                f,
                "the dithers have {count} mutually incommensurate frequencies, but averaging of a system supports at most \
                 {MOST_FREQUENCIES}"
            ),
            Self::Mean(why) => why.fmt(f),
            Self::Eigenvalues(why) => why.fmt(f),
        }
    }
}

impl std::error::Error for NoAverage {}

impl From<NoSteadySliding> for NoAverage {
    fn from(why: NoSteadySliding) -> Self {
        Self::NoSteadySliding(why)
    }
}

impl From<AveragingError> for NoAverage {
    fn from(why: AveragingError) -> Self {
        Self::Mean(why)
    }
}

impl From<EigenError> for NoAverage {
    fn from(why: EigenError) -> Self {
        Self::Eigenvalues(why)
    }
}

/// A contact under fast dither.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DitheredContact {
    /// Largest fast slip velocity, |â| of a single sine.
    pub slip_amplitude: f64,
    /// Largest fast part of the normal load, |N̂| of a single sine; the sum of the amplitudes of several.
    pub load_amplitude: f64,
    /// Mean friction T̄.
    pub friction: f64,
    /// Mean normal load.
    pub normal_load: f64,
    /// Effective coefficient m₀.
    pub effective_coefficient: f64,
    /// Ratchet force m₁.
    pub ratchet_force: f64,
    /// ∂T̄/∂γ.
    pub slope_by_velocity: f64,
}

impl DitheredContact {
    /// Whether the fast load opens the contact, which averaging does not describe.
    pub fn opens(&self) -> bool {
        self.load_amplitude > self.normal_load
    }
}

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
    pub fn spectrum(&self) -> Result<Spectrum, EigenError> {
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

/// The response of the structure to one wave of an input, for unit amplitude.
#[derive(Clone, Debug)]
struct WaveResponse {
    input: usize,
    wave: Wave,
    /// Slip of free masses, −iωâ; `None` for a sine.
    free: Option<Vec<f64>>,
    /// Harmonic n of the wave, its coefficient b_n of sin nθ, and the response at nω.
    harmonics: Vec<(u32, f64, Vec<ContactResponse>)>,
}

/// A system with the response of its structure to every dither, prepared for any amplitudes.
#[derive(Clone, Debug)]
pub struct DitheredSystem<'a> {
    system: &'a System,
    sliding: Linearised,
    waves: Vec<WaveResponse>,
}

impl<'a> DitheredSystem<'a> {
    /// Prepares a system.
    ///
    /// # Errors
    /// [`NoAverage`] without steady sliding, at an undamped resonance, and for more than [`MOST_FREQUENCIES`].
    pub fn new(system: &'a System) -> Result<Self, NoAverage> {
        let sliding = Linearised::new(system)?;
        let mut waves = Vec::new();
        for (input, given) in system.inputs.iter().enumerate() {
            for &wave in given.profile.waves() {
                waves.push(wave_response(system, &sliding, (input, &given.target), wave)?);
            }
        }
        let frequencies: Vec<f64> = waves.iter().map(|response| response.wave.frequency).collect();
        let count = commensurate_groups(&frequencies).len();
        if count > MOST_FREQUENCIES {
            return Err(NoAverage::TooManyFrequencies { count });
        }
        Ok(Self { system, sliding, waves })
    }

    /// The sliding system without dither.
    pub fn sliding(&self) -> &Linearised {
        &self.sliding
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
        let contacts = self.system.contacts.iter().enumerate();
        let motions: Vec<ContactMotion> =
            contacts.map(|(index, _)| self.motion(index, changed)).collect();
        let mut lines = Vec::with_capacity(motions.len());
        for (contact, motion) in self.system.contacts.iter().zip(&motions) {
            lines.push(motion.line(contact)?);
        }
        let steady = SteadySliding::with(self.system, &lines)?;
        let linear = Linearised::about(self.system, steady)?;
        let friction = linear.friction();
        let found = linear.contacts().iter().zip(&friction).zip(&motions);
        let contacts = found
            .map(|((contact, friction), motion)| {
                Ok(DitheredContact {
                    slip_amplitude: motion.slip_amplitude()?,
                    load_amplitude: motion.load_amplitude,
                    friction: friction.force,
                    normal_load: contact.steady.normal_load,
                    effective_coefficient: contact.steady.line.coefficient,
                    ratchet_force: contact.steady.line.constant,
                    slope_by_velocity: friction.by_velocity,
                })
            })
            .collect::<Result<_, NoAverage>>()?;
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
        for response in &self.waves {
            let Wave { amplitude, frequency, phase, .. } = response.wave;
            for (n_th, coefficient, _) in &response.harmonics {
                let harmonic = f64::from(*n_th);
                let target = &self.system.inputs[response.input].target;
                let moved =
                    harmonic::response(self.system, &self.sliding, target, harmonic * frequency);
                let Some(moved) = moved else { continue };
                let turned = Complex64::from_polar(amplitude * coefficient, harmonic * phase);
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

    /// How far the fast slip exceeds the velocity of the surface, against it; negative while the contact slips in one direction.
    ///
    /// # Errors
    /// [`NoAverage::Mean`].
    pub fn reversal_excess(
        &self,
        contact: usize,
        changed: Option<(usize, f64)>,
    ) -> Result<f64, NoAverage> {
        let velocity = self.system.contacts[contact].surface_velocity.mean();
        let [low, high] = self.motion(contact, changed).slip.slip_range()?;
        Ok(if velocity > 0.0 { high - velocity } else { velocity - low })
    }

    /// Fast motion at a contact.
    fn motion(&self, contact: usize, changed: Option<(usize, f64)>) -> ContactMotion {
        let amplitude = |response: &WaveResponse| match changed {
            Some((input, amplitude)) if input == response.input => {
                let first = self.system.inputs[input].profile.waves()[0].amplitude;
                let share = if first == 0.0 { 1.0 } else { response.wave.amplitude / first };
                amplitude * share
            }
            _ => response.wave.amplitude,
        };
        let normal_load = self.system.contacts[contact].normal_load;
        let frequencies: Vec<f64> =
            self.waves.iter().map(|response| response.wave.frequency).collect();
        let groups = commensurate_groups(&frequencies).into_iter().map(|members| {
            let mut parts = GroupParts::default();
            for (index, multiple) in members {
                let response = &self.waves[index];
                let target = &self.system.inputs[response.input].target;
                let direct =
                    matches!(target, InputTarget::NormalLoad { contact: at, .. } if *at == contact);
                parts.add(response, (contact, direct), (amplitude(response), multiple));
            }
            parts.motion(normal_load)
        });
        ContactMotion::new(groups.collect(), normal_load)
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
    if wave.waveform == Waveform::Sine {
        return Ok(WaveResponse { input, wave, free: None, harmonics: vec![(1, 1.0, at(1)?)] });
    }
    let free = harmonic::slip_of_free_masses(system, sliding, target);
    let free = free.ok_or(NoSteadySliding::NoMass)?;
    let mut harmonics: Vec<(u32, f64, Vec<ContactResponse>)> = Vec::new();
    for n in (1..=MOST_HARMONICS).step_by(2) {
        let coefficient = wave.waveform.sine_coefficient(n);
        harmonics.push((n, coefficient, at(n)?));
    }
    Ok(WaveResponse { input, wave, free: Some(free), harmonics })
}

/// Parts of the fast motion of one contact in one group of commensurate frequencies.
#[derive(Debug, Default)]
struct GroupParts {
    /// Terms that are integrals of a wave, and loads that are the wave itself.
    slip_terms: Vec<SlipTerm>,
    load_terms: Vec<LoadTerm>,
    /// Complex amplitudes of a and Ñ by harmonic.
    harmonics: BTreeMap<u32, [Complex64; 2]>,
}

impl GroupParts {
    fn add(
        &mut self,
        response: &WaveResponse,
        (contact, direct): (usize, bool),
        (amplitude, multiple): (f64, u32),
    ) {
        let Wave { waveform, frequency, phase, .. } = response.wave;
        let free = response.free.as_ref().map(|free| free[contact]);
        if let Some(free) = free {
            // s = −a, and a = c A ∫g dt.
            let wave = FastWave::Integral(waveform);
            let slip = -free * amplitude / frequency;
            self.slip_terms.push(SlipTerm { wave, amplitude: slip, harmonic: multiple, phase });
            if direct {
                self.load_terms.push(LoadTerm { waveform, amplitude, harmonic: multiple, phase });
            }
        }
        for (n, coefficient, contacts) in &response.harmonics {
            let ContactResponse { mut slip, mut load } = contacts[contact];
            if let Some(free) = free {
                slip -= free / Complex64::new(0.0, f64::from(*n) * frequency);
                load -= f64::from(u8::from(direct));
            }
            // A b sin(nθ) is the real part of −iA b e^{inθ}.
            let turned = Complex64::from_polar(amplitude * coefficient, f64::from(*n) * phase);
            let input = -Complex64::I * turned;
            let sum = self.harmonics.entry(n * multiple).or_default();
            sum[0] += input * slip;
            sum[1] += input * load;
        }
    }

    fn motion(self, normal_load: f64) -> PeriodicMotion {
        let Self { slip_terms: mut tangential, load_terms: mut load, harmonics } = self;
        let size = quell_numerics::eigen::modulus;
        let largest = |part: usize| harmonics.values().fold(0.0, |m: f64, z| m.max(size(z[part])));
        let least = [0, 1].map(|part| SMALLEST_HARMONIC * largest(part));
        for (&harmonic, [slip, fast_load]) in &harmonics {
            let amplitude = size(*slip);
            if amplitude > least[0] {
                // s = −|a| cos(θ + arg a), and the integral of a sine is −cos.
                let wave = FastWave::Integral(Waveform::Sine);
                tangential.push(SlipTerm { wave, amplitude, harmonic, phase: slip.arg() });
            }
            let amplitude = size(*fast_load);
            if amplitude > least[1] {
                let phase = fast_load.arg() + std::f64::consts::FRAC_PI_2;
                load.push(LoadTerm { waveform: Waveform::Sine, amplitude, harmonic, phase });
            }
        }
        for term in &mut load {
            term.amplitude /= normal_load;
        }
        PeriodicMotion { tangential, load, ..PeriodicMotion::default() }
    }
}

/// Fast motion at one contact.
#[derive(Debug)]
struct ContactMotion {
    /// Slip with the load that goes with it, and slip alone.
    whole: FastMotion,
    slip: FastMotion,
    load_amplitude: f64,
    normal_load: f64,
}

impl ContactMotion {
    fn new(groups: Vec<PeriodicMotion>, normal_load: f64) -> Self {
        let loads = groups.iter().flat_map(|group| &group.load);
        let load_amplitude = normal_load * loads.map(|term| term.amplitude.abs()).sum::<f64>();
        let bare = groups
            .iter()
            .map(|group| PeriodicMotion { load: Vec::new(), ..group.clone() })
            .collect();
        let (whole, slip) = (FastMotion::new(groups), FastMotion::new(bare));
        Self { whole, slip, load_amplitude, normal_load }
    }

    fn slip_amplitude(&self) -> Result<f64, AveragingError> {
        let [low, high] = self.slip.slip_range()?;
        Ok(high.max(-low))
    }

    /// Mean friction as a function of the load.
    fn line(&self, contact: &quell_model::system::Contact) -> Result<FrictionLine, NoAverage> {
        let undithered = FrictionLine::of(contact)?;
        if self.slip.groups().is_empty() {
            return Ok(undithered);
        }
        let velocity = contact.surface_velocity.mean();
        let mean = effective(&contact.friction, &self.slip, velocity)?;
        let mut line = FrictionLine {
            coefficient: mean.coefficient,
            constant: 0.0,
            slope: mean.slope,
            slope_constant: 0.0,
        };
        if self.load_amplitude > 0.0 {
            let loaded = effective(&contact.friction, &self.whole, velocity)?;
            line.constant = self.normal_load * (loaded.coefficient - mean.coefficient);
            line.slope_constant = self.normal_load * (loaded.slope - mean.slope);
        }
        Ok(line)
    }
}
