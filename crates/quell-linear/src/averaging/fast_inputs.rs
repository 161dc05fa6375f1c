//! The fast motion of contacts under the dithers of a system, from the response of the structure to each of them.
//!
//! The response may be computed from matrices ([`super::DitheredSystem`]) or measured ([`crate::measured`]); what follows from it
//! is the same: fast slip and load of every contact, their mean friction, and the amplitudes at which a contact reverses.

use num_complex::Complex64;
use quell_model::System;
use quell_model::profile::Wave;
use quell_model::system::{Contact, InputTarget};
use quell_numerics::order::ascending;

use super::averaged_law::AveragedLaw;
use super::contact_motion::{ActingWave, ContactMotion};
use super::dithers::commensurate_groups;
use super::error::AveragingError;
use super::independent::MAX_GROUPS;
use super::sign_changes::sign_changes;
use super::wave_response::{WaveResponse, WaveShape};
use crate::harmonic::ContactResponse;
use crate::steady::{FrictionLine, SteadyContact};

/// Amplitudes are searched from the smallest corner divided by this …
const BELOW: f64 = 1e3;
/// … up to the largest corner times this. Far beyond a corner mean friction falls like the inverse of the amplitude.
const BEYOND: f64 = 30.0;
/// Ratio of neighbouring amplitudes of the search …
const STEP: f64 = 1.05;
/// … and below the smallest corner divided by [`SMALL`], where mean friction changes like the square of the amplitude.
/// Both are choices of effort: two changes between neighbours are missed.
const SMALL_STEP: f64 = 1.3;
/// See [`SMALL_STEP`].
const SMALL: f64 = 20.0;
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

    /// Mean friction of a contact over the amplitude of one input. The fast motion is that of a unit amplitude times the amplitude where
    /// no other input acts.
    ///
    /// # Errors
    /// [`AveragingError`] if the fast motion has no value; so the function, if a mean has none.
    pub(super) fn line_over<'a>(
        &'a self,
        system: &'a System,
        (contact, input): (usize, usize),
    ) -> Result<impl Fn(f64) -> Result<FrictionLine, AveragingError> + 'a, AveragingError> {
        let at = move |amplitude: f64| self.motion(system, contact, Some((input, amplitude)));
        let alone =
            |response: &WaveResponse| response.input == input || response.wave.amplitude == 0.0;
        let unit = if self.waves.iter().all(alone) { Some(at(1.0)?) } else { None };
        Ok(move |amplitude: f64| {
            let motion = match &unit {
                Some(unit) => unit.times(amplitude),
                None => at(amplitude)?,
            };
            motion.line(&system.contacts[contact])
        })
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
        let motion = self.motion_under(system, (contact, normal_load), changed)?;
        let covariance = motion.covariance / normal_load;
        let law = &system.contacts[contact].friction;
        Ok(AveragedLaw::new(law, motion.into_motions(), covariance))
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
            amplitude *= if amplitude < least / SMALL { SMALL_STEP } else { STEP };
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
        let acting = self
            .waves
            .iter()
            .map(|response| ActingWave::new(system, response, amplitude(response)));
        ContactMotion::of_waves(system, acting, (contact, normal_load))
    }
}
