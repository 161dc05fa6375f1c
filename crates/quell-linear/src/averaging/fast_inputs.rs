//! The fast motion of contacts under the dithers of a system, from the response of the structure to each of them.
//!
//! The response may be computed from matrices ([`super::DitheredSystem`]) or measured ([`crate::measured`]); what follows from it
//! is the same: fast slip and load of every contact, their mean friction, and the amplitudes at which a contact reverses.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use num_complex::Complex64;
use quell_model::profile::Wave;
use quell_model::system::{Contact, InputTarget};
use quell_model::{System, Waveform};
use quell_numerics::order::ascending;
use quell_numerics::periodic_polynomial::PeriodicPolynomial;

use super::averaged_law::{AveragedLaw, curvature};
use super::dithers::commensurate_groups;
use super::effective::SlopeSide;
use super::error::AveragingError;
use super::fast_motion::{FastMotion, REACH};
use super::independent::MAX_GROUPS;
use super::mean_friction::{effective, of_fluctuating_load};
use super::periodic_motion::{LoadTerm, LoadWave, PeriodicMotion, SlipTerm};
use super::sign_changes::sign_changes;
use super::wave::FastWave;
use crate::harmonic::ContactResponse;
use crate::steady::{FrictionLine, SteadyContact};

/// Harmonics below this share of the largest are left out.
const SMALLEST_HARMONIC: f64 = 1e-14;

/// Amplitudes are searched from the smallest corner divided by this …
const BELOW: f64 = 1e3;
/// … up to the largest corner times this. Far beyond a corner mean friction falls like the inverse of the amplitude.
const BEYOND: f64 = 30.0;
/// Ratio of neighbouring amplitudes of the search.
const STEP: f64 = 1.05;
/// Amplitudes on each side of a corner, each at half the distance of the last.
const AROUND: i32 = 14;

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
    /// Whether that slope is the one of slightly faster slip: the fast slip just reaches the slow one.
    pub one_sided: bool,
}

impl DitheredContact {
    /// Whether the fast load opens the contact, which averaging does not describe.
    pub fn opens(&self) -> bool {
        self.load_amplitude > self.normal_load
    }

    /// The largest slip velocity, slow and fast.
    pub fn largest_slip(&self, contact: &Contact) -> f64 {
        contact.surface_velocity.mean().abs() + self.slip_amplitude
    }

    /// Whether the slip velocity exceeds the range of the friction law of its contact.
    pub fn leaves_law(&self, contact: &Contact) -> bool {
        contact.friction.range().is_some_and(|range| self.largest_slip(contact) > range.upper)
    }
}

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
    fn repetition(&self) -> Option<f64> {
        let repeats = !matches!(self.shape, WaveShape::Lines(_));
        repeats.then(|| self.wave.frequency / f64::from(self.wave.waveform.cycles()))
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

/// The fast motion of contacts, prepared for any amplitudes of the inputs.
#[derive(Clone, Debug)]
pub struct FastInputs {
    pub(super) waves: Vec<WaveResponse>,
}

impl FastInputs {
    /// From the response of every contact to each wave of the inputs, for û = 1, all of them sines.
    ///
    /// # Errors
    /// The first error of `response`; [`AveragingError::TooManyGroups`].
    pub fn new<E: From<AveragingError>>(
        system: &System,
        mut response: impl FnMut(&InputTarget, &Wave) -> Result<Vec<ContactResponse>, E>,
    ) -> Result<Self, E> {
        let mut waves = Vec::new();
        for (input, given) in system.inputs.iter().enumerate() {
            for wave in given.profile.waves().iter().cloned() {
                let contacts = response(&given.target, &wave)?;
                let shape = WaveShape::Harmonics(vec![(1, Complex64::ONE, contacts)]);
                waves.push(WaveResponse { input, wave, shape });
            }
        }
        Ok(Self::of(waves)?)
    }

    pub(super) fn of(waves: Vec<WaveResponse>) -> Result<Self, AveragingError> {
        let frequencies: Vec<f64> = waves.iter().filter_map(WaveResponse::repetition).collect();
        let count = commensurate_groups(&frequencies).len();
        if count > MAX_GROUPS {
            return Err(AveragingError::TooManyGroups { groups: count, largest: MAX_GROUPS });
        }
        Ok(Self { waves })
    }

    /// Mean friction of every contact as a function of its load; `changed` gives another amplitude of one input.
    ///
    /// # Errors
    /// [`AveragingError`] if a mean has no value.
    pub fn lines(
        &self,
        system: &System,
        changed: Option<(usize, f64)>,
    ) -> Result<Vec<FrictionLine>, AveragingError> {
        let contacts = system.contacts.iter().enumerate();
        contacts
            .map(|(index, contact)| self.motion(system, index, changed)?.line(contact))
            .collect()
    }

    /// What the dither does to every contact, in a steady sliding that was found with [`FastInputs::lines`].
    ///
    /// # Errors
    /// [`AveragingError`].
    pub fn contacts(
        &self,
        system: &System,
        steady: &[SteadyContact],
        changed: Option<(usize, f64)>,
    ) -> Result<Vec<DitheredContact>, AveragingError> {
        let contacts = steady.iter().enumerate();
        contacts
            .map(|(index, contact)| {
                let motion = self.motion(system, index, changed)?;
                let SteadyContact { line, normal_load, friction, factor, .. } = *contact;
                Ok(DitheredContact {
                    slip_amplitude: motion.slip_amplitude()?,
                    load_amplitude: motion.load_amplitude,
                    friction: factor * friction,
                    normal_load,
                    effective_coefficient: line.coefficient,
                    ratchet_force: line.constant,
                    slope_by_velocity: factor * line.slope_under(normal_load),
                    one_sided: line.one_sided,
                })
            })
            .collect()
    }

    /// The averaged friction law of a contact under a mean normal load; `changed` gives another amplitude of one input.
    ///
    /// # Errors
    /// [`AveragingError`] where the friction that drives a fast load's motion has no value.
    pub fn law(
        &self,
        system: &System,
        (contact, normal_load): (usize, f64),
        changed: Option<(usize, f64)>,
    ) -> Result<AveragedLaw, AveragingError> {
        let ContactMotion { whole, slip, covariance, .. } =
            self.motion_under(system, (contact, normal_load), changed)?;
        let covariance = covariance / normal_load;
        Ok(AveragedLaw::new(&system.contacts[contact].friction, [whole, slip], covariance))
    }

    /// How far the fast slip exceeds the velocity of the surface, against it; negative while the contact slips in one direction.
    fn reversal_excess(
        &self,
        system: &System,
        contact: usize,
        changed: (usize, f64),
    ) -> Result<f64, AveragingError> {
        let velocity = system.contacts[contact].surface_velocity.mean();
        let [low, high] = self.motion(system, contact, Some(changed))?.slip.slip_range()?;
        Ok(if velocity > 0.0 { high - velocity } else { velocity - low })
    }

    /// Amplitudes of an input at which the fast slip of a contact reaches the velocity of its surface, ascending.
    ///
    /// # Errors
    /// [`AveragingError`].
    pub fn corners(&self, system: &System, input: usize) -> Result<Vec<f64>, AveragingError> {
        let mut corners: Vec<f64> = Vec::new();
        for contact in 0..system.contacts.len() {
            let excess = |amplitude: f64| self.reversal_excess(system, contact, (input, amplitude));
            let (at_none, at_one) = (excess(0.0)?, excess(1.0)?);
            if at_one == at_none {
                continue;
            }
            // The slip of a single dither is proportional to its amplitude.
            let proportional = -at_none / (at_one - at_none);
            if system.inputs.len() == 1 {
                corners.push(proportional);
                continue;
            }
            let scale = proportional.abs().max(f64::MIN_POSITIVE);
            let points: Vec<f64> =
                (0..240).map(|k| scale * libm::exp(-9.0 + 0.06 * f64::from(k))).collect();
            let changes = sign_changes(excess, &points, &[])?;
            corners.extend(changes.into_iter().map(|change| change.location));
        }
        corners.retain(|corner| corner.is_finite() && *corner > 0.0);
        ascending(&mut corners);
        corners.dedup_by(|a, b| (*a - *b).abs() <= 1e-14 * b.abs());
        Ok(corners)
    }

    /// Amplitudes at which a verdict is evaluated in a search: in equal ratios, and closer to the corners; none without corners.
    pub fn amplitudes(corners: &[f64]) -> Vec<f64> {
        let (Some(&least), Some(&largest)) = (corners.first(), corners.last()) else {
            return Vec::new();
        };
        // Below the smallest normal number no ratio makes an amplitude larger.
        let (mut amplitude, end) = ((least / BELOW).max(f64::MIN_POSITIVE), largest * BEYOND);
        let mut points = vec![0.0];
        while amplitude < end {
            points.push(amplitude);
            amplitude *= STEP;
        }
        points.push(end);
        for corner in corners {
            let distances = (1..=AROUND).map(|k| 2f64.powi(-k));
            points.extend(distances.flat_map(|d| [corner * (1.0 - d), corner * (1.0 + d)]));
        }
        ascending(&mut points);
        points.dedup();
        points
    }

    /// Fast motion at a contact, its load over the steady one without friction.
    fn motion(
        &self,
        system: &System,
        contact: usize,
        changed: Option<(usize, f64)>,
    ) -> Result<ContactMotion, AveragingError> {
        self.motion_under(system, (contact, system.contacts[contact].normal_load), changed)
    }

    /// Fast motion at a contact, its load over a given one.
    fn motion_under(
        &self,
        system: &System,
        (contact, normal_load): (usize, f64),
        changed: Option<(usize, f64)>,
    ) -> Result<ContactMotion, AveragingError> {
        let amplitude = |response: &WaveResponse| match changed {
            Some((input, amplitude)) if input == response.input => {
                let first = system.inputs[input].profile.waves()[0].amplitude;
                let share = if first == 0.0 { 1.0 } else { response.wave.amplitude / first };
                amplitude * share
            }
            _ => response.wave.amplitude,
        };
        let (borne, imposed): (Vec<ActingWave>, Vec<ActingWave>) = self
            .waves
            .iter()
            .map(|response| ActingWave::new(system, response, amplitude(response)))
            .filter(|wave| wave.amplitude != 0.0)
            .partition(|wave| wave.borne_by.is_some());
        let mut drives: BTreeMap<usize, DrivingFriction> = BTreeMap::new();
        for by in borne.iter().filter_map(|wave| wave.borne_by) {
            if let Entry::Vacant(vacant) = drives.entry(by) {
                vacant.insert(DrivingFriction::new(&system.contacts[by], (by, &imposed))?);
            }
        }
        let driven = borne.into_iter().map(|wave| match wave.borne_by {
            Some(by) => ActingWave { share: drives[&by].share, ..wave },
            None => wave,
        });
        let acting: Vec<ActingWave> = imposed.iter().copied().chain(driven).collect();
        let distortion = drives.get(&contact).map_or(0.0, |drive| drive.distortion);
        Ok(ContactMotion::new(contact, &acting, normal_load, distortion))
    }
}

/// A wave with the amplitude at which it acts.
#[derive(Clone, Copy, Debug)]
struct ActingWave<'a> {
    response: &'a WaveResponse,
    amplitude: f64,
    /// The contact whose load it is, if that contact bears it by friction alone: it has no normal row.
    borne_by: Option<usize>,
    /// Mean friction that drives the response over that of steady sliding.
    share: f64,
}

impl<'a> ActingWave<'a> {
    fn new(system: &System, response: &'a WaveResponse, amplitude: f64) -> Self {
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
                    let turned = Complex64::from_polar(1.0, f64::from(*n) * phase) * coefficient;
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
        let size = quell_numerics::eigen::modulus;
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
                    terms.push(SlipTerm { wave, amplitude, harmonic, phase: slip.arg() });
                }
            }
            let amplitude = size(*fast_load);
            if amplitude > least[2] {
                let phase = fast_load.arg() + FRAC_PI_2;
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
struct ContactMotion {
    /// Slip with the load that goes with it, and slip alone.
    whole: FastMotion,
    slip: FastMotion,
    /// Sum of the amplitudes of the load of periodic dithers.
    periodic_load: f64,
    load_amplitude: f64,
    /// Covariance ⟨aÑ⟩ of slip and load under noise.
    covariance: f64,
    normal_load: f64,
}

impl ContactMotion {
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
        let bare = groups
            .iter()
            .map(|group| PeriodicMotion { load: Vec::new(), ..group.clone() })
            .collect();
        let [whole, slip] =
            [groups, bare].map(|groups| FastMotion::new(groups).with_noise(noise.slip.sqrt()));
        let covariance = noise.covariance;
        Self { whole, slip, periodic_load, load_amplitude, covariance, normal_load }
    }

    /// Whether the contact has fast slip.
    fn moves(&self) -> bool {
        !self.slip.groups().is_empty() || self.slip.noise() > 0.0
    }

    fn slip_amplitude(&self) -> Result<f64, AveragingError> {
        let [low, high] = self.slip.slip_range()?;
        Ok(high.max(-low))
    }

    /// Mean friction as a function of the load.
    fn line(&self, contact: &Contact) -> Result<FrictionLine, AveragingError> {
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
        if self.periodic_load > 0.0 {
            let (level, slope) =
                of_fluctuating_load(&contact.friction, (&self.whole, &mean), velocity)?;
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
