//! The response of a sliding structure to one wave of an input: by harmonics, by pieces of polynomials, in closed form, or by lines.

use std::sync::Arc;

use num_complex::Complex64;
use quell_model::profile::Wave;
use quell_model::system::{InputTarget, Mechanical};
use quell_model::waveform::NoiseLine;
use quell_model::{System, Waveform};
use quell_numerics::matrix::Matrix;
use quell_numerics::periodic_polynomial::PeriodicPolynomial;

use super::error::AveragingError;
use super::wave::FastWave;
use crate::harmonic::{self, ContactResponse, DrivenEquations, own_load};
use crate::linearised::Linearised;
use crate::periodic_response::ResponseToWave;
use crate::steady::NoSteadySliding;

/// The response of the structure to one wave of an input, for unit amplitude.
#[derive(Clone, Debug)]
pub(super) struct WaveResponse {
    pub(super) input: usize,
    pub(super) wave: Wave,
    pub(super) shape: WaveShape,
}

/// How the response to a wave is known.
#[derive(Clone, Debug)]
pub(super) enum WaveShape {
    /// By harmonics: n, its coefficient b_n + ic_n where the wave has b_n sin nθ + c_n cos nθ, and the response at nω.
    Harmonics(Vec<(u32, Complex64, Vec<ContactResponse>)>),
    /// By polynomials: fast slip and fast load of every contact over the phase of the wave.
    Polynomials(Vec<[Arc<PeriodicPolynomial>; 2]>),
    /// By a closed form: the motion of one coordinate without its damper, with what it is at every contact.
    Closed { wave: FastWave, contacts: Vec<ClosedResponse> },
    /// Of noise: the response at each line.
    Lines(Vec<Vec<ContactResponse>>),
}

/// What a closed form is at a contact for unit amplitude of the wave.
#[derive(Clone, Copy, Debug)]
pub(super) struct ClosedResponse {
    /// Factor of the fast slip s.
    pub(super) slip: f64,
    /// Factor of the waveform in the fast load.
    pub(super) load: f64,
}

impl WaveResponse {
    /// Frequency at which the wave repeats itself; `None` of noise.
    pub(super) fn repetition(&self) -> Option<f64> {
        let repeats = !matches!(self.shape, WaveShape::Lines(_));
        repeats.then(|| self.wave.frequency / f64::from(self.wave.waveform.cycles()))
    }
}

/// A structure of one coordinate without its damper, for the fast motion under dither that repeats itself above its resonance: at a
/// stability boundary the damper cancels with the slope of friction, which the fast motion leaves out. Other structures keep their dampers,
/// which bound their resonances.
pub(super) fn without_damper(system: &System) -> Option<System> {
    let mechanical = system.structure.mechanical().filter(|one| one.by_speed().is_none())?;
    if mechanical.size() != 1 {
        return None;
    }
    let resonance = (mechanical.stiffness()[(0, 0)] / mechanical.mass().matrix()[(0, 0)]).sqrt();
    let slowest = system.waves().map(Wave::lowest).fold(f64::INFINITY, f64::min);
    let undamped = Mechanical::new(
        mechanical.coordinates().to_vec(),
        mechanical.mass().clone(),
        Matrix::zeros(1, 1),
        mechanical.stiffness().clone(),
    );
    let structure = undamped.under(mechanical.force().to_vec()).into();
    (slowest > resonance).then(|| System { structure, ..system.clone() })
}

/// The equations of the sliding structure under an input.
pub(super) fn driven(
    system: &System,
    sliding: &Linearised,
    target: &InputTarget,
) -> Result<DrivenEquations, NoSteadySliding> {
    DrivenEquations::new(system, sliding, target).ok_or(NoSteadySliding::NoMass)
}

/// The response of one coordinate without its damper to a triangle or a square in closed form; `None` of other waveforms, which have
/// harmonics or pieces, and where a load follows the motion.
fn closed_form(
    system: &System,
    sliding: &Linearised,
    target: &InputTarget,
    wave: &Wave,
) -> Option<WaveShape> {
    let waveform = wave.waveform.clone();
    let follows = system.contacts.iter().any(|contact| contact.normal.is_some());
    if !waveform.is_symmetric() || waveform == Waveform::Sine || follows {
        return None;
    }
    let mechanical = system.structure.mechanical()?;
    let mass = mechanical.mass().matrix()[(0, 0)];
    let rate = (mechanical.stiffness()[(0, 0)] / mass).sqrt();
    let force = harmonic::force_on(system, sliding, target, 0);
    // The velocity under a force F g is F/(Mω) times the shape, and friction is μ(v − s).
    let velocity = force / (mass * wave.frequency);
    let contacts = system.contacts.iter().enumerate().map(|(index, contact)| ClosedResponse {
        slip: velocity * contact.tangent.as_ref().map_or(0.0, |tangent| tangent[0]),
        load: own_load(target, index),
    });
    let contacts = contacts.collect();
    let frequency_ratio = wave.frequency / rate;
    Some(WaveShape::Closed { wave: FastWave::Oscillator { waveform, frequency_ratio }, contacts })
}

impl WaveShape {
    /// The response of one coordinate without its damper ([`without_damper`]).
    pub(super) fn undamped(
        system: &System,
        sliding: &Linearised,
        target: &InputTarget,
        wave: &Wave,
    ) -> Result<Self, AveragingError> {
        match closed_form(system, sliding, target, wave) {
            Some(closed) => Ok(closed),
            None => Self::of(system, sliding, target, wave),
        }
    }

    /// The response of a structure.
    pub(super) fn of(
        system: &System,
        sliding: &Linearised,
        target: &InputTarget,
        wave: &Wave,
    ) -> Result<Self, AveragingError> {
        let at = |n: u32| {
            let frequency = f64::from(n) * wave.frequency;
            harmonic::response(system, sliding, target, frequency)
                .map(|response| response.contacts)
                .ok_or(AveragingError::Resonance { frequency })
        };
        if let Some(known) = wave.waveform.harmonics() {
            let harmonics: Result<Vec<_>, AveragingError> = known
                .iter()
                .map(|h| Ok((h.order, Complex64::new(h.sine, h.cosine), at(h.order)?)))
                .collect();
            return Ok(Self::Harmonics(harmonics?));
        }
        if wave.waveform == Waveform::Sine {
            return Ok(Self::Harmonics(vec![(1, Complex64::ONE, at(1)?)]));
        }
        if let Some(noise) = wave.waveform.noise() {
            let line = |line: &NoiseLine| {
                let frequency = line.ratio * wave.frequency;
                harmonic::response(system, sliding, target, frequency)
                    .map(|response| response.contacts)
                    .ok_or(AveragingError::Resonance { frequency })
            };
            let lines: Result<Vec<_>, AveragingError> = noise.lines().iter().map(line).collect();
            return Ok(Self::Lines(lines?));
        }
        let equations = driven(system, sliding, target)?;
        let response = ResponseToWave::new(
            &equations.matrix,
            &equations.source,
            &wave.waveform,
            wave.frequency,
        )?;
        let contacts = sliding.contacts().iter().enumerate();
        let rows: Vec<(Vec<f64>, f64)> = contacts
            .flat_map(|(index, contact)| {
                let direct = own_load(target, index);
                [(equations.slip_row(contact), 0.0), (equations.load_row(contact), direct)]
            })
            .collect();
        let rows: Vec<(&[f64], f64)> =
            rows.iter().map(|(row, direct)| (row.as_slice(), *direct)).collect();
        let outputs = response.outputs(&rows);
        let of = |pair: &[PeriodicPolynomial]| [pair[0].clone().into(), pair[1].clone().into()];
        Ok(Self::Polynomials(outputs.chunks_exact(2).map(of).collect()))
    }
}
