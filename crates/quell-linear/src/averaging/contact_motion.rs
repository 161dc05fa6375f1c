//! The fast motion at one contact under waves of given amplitudes, and the mean friction that follows from it.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::f64::consts::FRAC_PI_2;

use num_complex::Complex64;
use quell_model::system::{Contact, InputTarget};
use quell_model::{System, Waveform};
use quell_numerics::polar::{argument, from_polar};

use super::averaged_law::curvature;
use super::dithers::commensurate_groups;
use super::effective::SlopeSide;
use super::error::AveragingError;
use super::fast_motion::{FastMotion, REACH};
use super::mean_friction::{effective, of_fluctuating_load};
use super::periodic_motion::{LoadTerm, LoadWave, PeriodicMotion, SlipTerm};
use super::wave::FastWave;
use super::wave_response::{ClosedResponse, WaveResponse, WaveShape};
use crate::harmonic::ContactResponse;
use crate::steady::FrictionLine;

/// Harmonics below this share of the largest are left out.
const SMALLEST_HARMONIC: f64 = 1e-14;

/// A wave with the amplitude at which it acts.
#[derive(Clone, Copy, Debug)]
pub(super) struct ActingWave<'a> {
    response: &'a WaveResponse,
    amplitude: f64,
    /// The contact whose load it is, if that contact bears it by friction alone: it has no normal row.
    borne_by: Option<usize>,
    /// Mean friction that drives the response over that of steady sliding.
    share: f64,
}

impl<'a> ActingWave<'a> {
    pub(super) fn new(system: &System, response: &'a WaveResponse, amplitude: f64) -> Self {
        let borne_by = match system.inputs[response.input].target {
            InputTarget::NormalLoad { contact, .. } => {
                Some(contact).filter(|index| system.contacts[*index].normal.is_none())
            }
            _ => None,
        };
        Self { response, amplitude, borne_by, share: 1.0 }
    }

    /// Amplitudes of the slip and of the load at a contact, whose own load is what it is.
    fn amplitudes(&self, contact: usize) -> [f64; 2] {
        let driven = self.amplitude * self.share;
        [driven, if self.borne_by == Some(contact) { self.amplitude } else { driven }]
    }
}

/// How friction under the dithers that no contact bears drives the motion due to the fast load of a contact.
#[derive(Clone, Copy, Debug)]
struct DrivingFriction {
    /// Mean friction over that of steady sliding.
    share: f64,
    /// −μ̄′/(2μ̄).
    distortion: f64,
}

impl DrivingFriction {
    fn new(
        contact: &Contact,
        (index, imposed): (usize, &[ActingWave<'_>]),
    ) -> Result<Self, AveragingError> {
        let Ok(sliding) = FrictionLine::of(contact) else {
            return Ok(Self { share: 1.0, distortion: 0.0 });
        };
        let motion = ContactMotion::new(index, imposed, contact.normal_load, 0.0);
        let (mut level, mut slope) = (sliding.coefficient, sliding.slope);
        if motion.moves() {
            let mean = effective(&contact.friction, &motion.slip, contact.surface_velocity.mean())?;
            (level, slope) = (mean.coefficient, mean.slope);
        }
        let distortion = if level == 0.0 { 0.0 } else { -0.5 * slope / level };
        Ok(Self { share: level / sliding.coefficient, distortion })
    }
}

/// Parts of the fast motion of one contact in one group of commensurate frequencies.
#[derive(Debug, Default)]
struct GroupParts {
    /// Terms by polynomials: slip, and slip due to the contact's own load.
    slip_terms: [Vec<SlipTerm>; 2],
    load_terms: Vec<LoadTerm>,
    /// Complex amplitudes of a, of a due to the contact's own load, and of Ñ by harmonic.
    harmonics: BTreeMap<u32, [Complex64; 3]>,
}

impl GroupParts {
    fn add(&mut self, wave: &ActingWave<'_>, contact: usize, multiple: u32) {
        let response = wave.response;
        let [slip_amplitude, load_amplitude] = wave.amplitudes(contact);
        let own = usize::from(wave.borne_by == Some(contact));
        let phase = response.wave.phase;
        match &response.shape {
            WaveShape::Polynomials(contacts) => {
                let [slip, load] = &contacts[contact];
                let harmonic = multiple * response.wave.waveform.cycles();
                // Friction is μ(v − s), and the slip is v + a.
                let (wave, amplitude) = (FastWave::Response(slip.clone()), -slip_amplitude);
                self.slip_terms[own].push(SlipTerm { wave, amplitude, harmonic, phase });
                let (wave, amplitude) = (LoadWave::Response(load.clone()), load_amplitude);
                if wave.peak() > 0.0 {
                    self.load_terms.push(LoadTerm { wave, amplitude, harmonic, phase });
                }
            }
            WaveShape::Closed { wave, contacts } => {
                let ClosedResponse { slip, load } = contacts[contact];
                let waveform = &response.wave.waveform;
                let harmonic = multiple * waveform.cycles();
                let amplitude = slip_amplitude * slip;
                self.slip_terms[own].push(SlipTerm {
                    wave: wave.clone(),
                    amplitude,
                    harmonic,
                    phase,
                });
                if load != 0.0 {
                    let (wave, amplitude) =
                        (LoadWave::Waveform(waveform.clone()), load_amplitude * load);
                    self.load_terms.push(LoadTerm { wave, amplitude, harmonic, phase });
                }
            }
            // Noise has no period.
            WaveShape::Lines(_) => {}
            WaveShape::Harmonics(harmonics) => {
                for (n, coefficient, contacts) in harmonics {
                    let ContactResponse { slip, load } = contacts[contact];
                    // A(b sin nθ + c cos nθ) is the real part of −iA(b + ic) e^{inθ}.
                    let turned = from_polar(1.0, f64::from(*n) * phase) * coefficient;
                    let input = -Complex64::I * turned;
                    let sum = self.harmonics.entry(n * multiple).or_default();
                    sum[own] += input * slip_amplitude * slip;
                    sum[2] += input * load_amplitude * load;
                }
            }
        }
    }

    fn motion(self, normal_load: f64, distortion: f64) -> PeriodicMotion {
        let Self { slip_terms: [mut tangential, mut normal], load_terms: mut load, harmonics } =
            self;
        let size = quell_numerics::polar::modulus;
        let largest = |part: usize| harmonics.values().fold(0.0, |m: f64, z| m.max(size(z[part])));
        let least = [0, 1, 2].map(|part| SMALLEST_HARMONIC * largest(part));
        for (&harmonic, [slip, own, fast_load]) in &harmonics {
            for (slip, least, terms) in
                [(slip, least[0], &mut tangential), (own, least[1], &mut normal)]
            {
                let amplitude = size(*slip);
                if amplitude > least {
                    // s = −|a| cos(θ + arg a), and the integral of a sine is −cos.
                    let wave = FastWave::Integral(Waveform::Sine);
                    terms.push(SlipTerm { wave, amplitude, harmonic, phase: argument(*slip) });
                }
            }
            let amplitude = size(*fast_load);
            if amplitude > least[2] {
                let phase = argument(*fast_load) + FRAC_PI_2;
                let wave = LoadWave::Waveform(Waveform::Sine);
                load.push(LoadTerm { wave, amplitude, harmonic, phase });
            }
        }
        for term in &mut load {
            term.amplitude /= normal_load;
        }
        let distortion = if normal.is_empty() { 0.0 } else { distortion };
        PeriodicMotion { tangential, normal, distortion, load, load_is_slope: false }
    }
}

/// Fast motion at one contact.
#[derive(Debug)]
pub(super) struct ContactMotion {
    /// Slip with the load that goes with it; `None` under a steady load.
    loaded: Option<FastMotion>,
    /// Slip alone.
    pub(super) slip: FastMotion,
    /// Sum of the amplitudes of the load of periodic dithers.
    periodic_load: f64,
    pub(super) load_amplitude: f64,
    /// Covariance ⟨aÑ⟩ of slip and load under noise.
    pub(super) covariance: f64,
    normal_load: f64,
}

impl ContactMotion {
    /// The motion at a contact under waves of its system, its load over a given one. Friction under the waves that no contact bears
    /// drives the motion due to the others.
    ///
    /// # Errors
    /// [`AveragingError`] where that friction has no value.
    pub(super) fn of_waves<'a>(
        system: &System,
        acting: impl Iterator<Item = ActingWave<'a>>,
        (contact, normal_load): (usize, f64),
    ) -> Result<Self, AveragingError> {
        let (borne, mut acting): (Vec<ActingWave>, Vec<ActingWave>) =
            acting.filter(|wave| wave.amplitude != 0.0).partition(|wave| wave.borne_by.is_some());
        let mut drives: BTreeMap<usize, DrivingFriction> = BTreeMap::new();
        for by in borne.iter().filter_map(|wave| wave.borne_by) {
            if let Entry::Vacant(vacant) = drives.entry(by) {
                vacant.insert(DrivingFriction::new(&system.contacts[by], (by, &acting))?);
            }
        }
        acting.extend(borne.into_iter().map(|wave| match wave.borne_by {
            Some(by) => ActingWave { share: drives[&by].share, ..wave },
            None => wave,
        }));
        let distortion = drives.get(&contact).map_or(0.0, |drive| drive.distortion);
        Ok(Self::new(contact, &acting, normal_load, distortion))
    }

    fn new(contact: usize, acting: &[ActingWave<'_>], normal_load: f64, distortion: f64) -> Self {
        let mut noise = NoiseMoments::default();
        for wave in acting {
            noise.add(wave, contact);
        }
        let (periodic, frequencies): (Vec<&ActingWave<'_>>, Vec<f64>) =
            acting.iter().filter_map(|wave| Some((wave, wave.response.repetition()?))).unzip();
        let groups = commensurate_groups(&frequencies).into_iter().map(|members| {
            let mut parts = GroupParts::default();
            for (index, multiple) in members {
                parts.add(periodic[index], contact, multiple);
            }
            parts.motion(normal_load, distortion)
        });
        Self::of(groups.collect(), noise, normal_load)
    }

    fn of(groups: Vec<PeriodicMotion>, noise: NoiseMoments, normal_load: f64) -> Self {
        let loads = groups.iter().flat_map(|group| &group.load);
        let peaks = loads.map(|term| term.amplitude.abs() * term.wave.peak());
        let periodic_load = normal_load * peaks.sum::<f64>();
        let load_amplitude = periodic_load + REACH * noise.load.sqrt();
        let whole = FastMotion::new(groups).with_noise(noise.slip.sqrt());
        let (slip, loaded) =
            if whole.has_load() { (whole.without_load(), Some(whole)) } else { (whole, None) };
        let covariance = noise.covariance;
        Self { loaded, slip, periodic_load, load_amplitude, covariance, normal_load }
    }

    /// The motion under inputs of that many times the amplitude.
    pub(super) fn times(&self, factor: f64) -> Self {
        let size = factor.abs();
        Self {
            loaded: self.loaded.as_ref().map(|motion| motion.times(factor)),
            slip: self.slip.times(factor),
            periodic_load: size * self.periodic_load,
            load_amplitude: size * self.load_amplitude,
            covariance: factor * factor * self.covariance,
            normal_load: self.normal_load,
        }
    }

    /// Slip with the load that goes with it, and slip alone.
    pub(super) fn into_motions(self) -> [FastMotion; 2] {
        [self.loaded.unwrap_or_else(|| self.slip.clone()), self.slip]
    }

    /// Whether the contact has fast slip.
    fn moves(&self) -> bool {
        !self.slip.groups().is_empty() || self.slip.noise() > 0.0
    }

    pub(super) fn slip_amplitude(&self) -> Result<f64, AveragingError> {
        let [low, high] = self.slip.slip_range()?;
        Ok(high.max(-low))
    }

    /// Mean friction as a function of the load.
    pub(super) fn line(&self, contact: &Contact) -> Result<FrictionLine, AveragingError> {
        if !self.moves() {
            return Ok(FrictionLine::of(contact)?);
        }
        let velocity = self.slip.at_corner(contact.surface_velocity.mean())?;
        let mean = effective(&contact.friction, &self.slip, velocity)?;
        let mut line = FrictionLine {
            coefficient: mean.coefficient,
            slope: mean.slope,
            one_sided: mean.side == SlopeSide::Outer,
            ..FrictionLine::NONE
        };
        if let Some(loaded) = self.loaded.as_ref().filter(|_| self.periodic_load > 0.0) {
            let (level, slope) = of_fluctuating_load(&contact.friction, (loaded, &mean), velocity)?;
            line.constant = self.normal_load * level;
            line.slope_constant = self.normal_load * slope;
        }
        if self.covariance != 0.0 {
            // Of two Gaussian variables ⟨μ(γ + a)Ñ⟩ = ⟨aÑ⟩⟨μ′(γ + a)⟩ (Stein's identity).
            line.constant += self.covariance * mean.slope;
            line.slope_constant +=
                self.covariance * curvature(&contact.friction, &self.slip, velocity)?;
        }
        Ok(line)
    }
}

/// Second moments of the Gaussian slip a and load Ñ of a contact under noise.
#[derive(Clone, Copy, Debug, Default)]
struct NoiseMoments {
    /// ⟨a²⟩.
    slip: f64,
    /// ⟨Ñ²⟩.
    load: f64,
    /// ⟨aÑ⟩.
    covariance: f64,
}

impl NoiseMoments {
    /// Adds the lines of a noise; nothing of another wave.
    fn add(&mut self, wave: &ActingWave<'_>, contact: usize) {
        let (WaveShape::Lines(lines), Some(noise)) =
            (&wave.response.shape, wave.response.wave.waveform.noise())
        else {
            return;
        };
        let [slip_amplitude, load_amplitude] =
            wave.amplitudes(contact).map(|amplitude| noise.line_amplitude() * amplitude);
        for line in lines {
            let ContactResponse { slip, load } = line[contact];
            let (slip, load) = (slip * slip_amplitude, load * load_amplitude);
            self.slip += 0.5 * slip.norm_sqr();
            self.load += 0.5 * load.norm_sqr();
            self.covariance += 0.5 * (slip * load.conj()).re;
        }
    }
}
