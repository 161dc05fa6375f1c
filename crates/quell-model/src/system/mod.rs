//! A linear structure with friction contacts and inputs: what every kind of study describes.
//!
//! ```text
//! M q̈ + C q̇ + K q = p + Σ_j b_j u_j(t) + Σ_c [ t_c T_c + n_c (T_c s_cᵀq − (N_c − N₀_c)) ]
//! ```
//!
//! or ẋ = A x + p + Σ_j b_j u_j(t) + Σ_c g_c T_c with γ_c = v_c(t) − t_cᵀx, where the structure comes with controllers.
//!
//! A belt is the case n = 1, one contact with t = 1, M = K = 1, C = 2ζ; a disc is its modes in the frame of the loads with a
//! contact at every load ([`Belt::system`], [`Disc::system`]).
//!
//! [`Belt::system`]: crate::Belt::system
//! [`Disc::system`]: crate::Disc::system

mod contact;
mod in_units;
mod input;
mod layout;
mod mass;
mod structure;
mod surroundings;

pub use contact::Contact;
pub use input::{Input, InputTarget};
pub use layout::StateEntry;
pub use mass::MassMatrix;
pub use structure::{Mechanical, SpeedDependence, StateSpace, Structure};

use crate::profile::{Profile, Wave};

/// A structure, its contacts and its inputs.
#[derive(Clone, Debug, PartialEq)]
pub struct System {
    /// The linear structure.
    pub structure: Structure,
    /// The friction contacts.
    pub contacts: Vec<Contact>,
    /// What enters from outside.
    pub inputs: Vec<Input>,
}

impl System {
    /// The waves of all inputs in order, those of amplitude 0 included.
    pub fn waves(&self) -> impl Iterator<Item = &Wave> {
        self.inputs.iter().flat_map(|input| input.profile.waves())
    }

    /// Whether an input has a wave, of any amplitude. The frequencies of the waves give a system its period, also where a family of
    /// systems reaches the amplitude 0. Whether a dither acts is [`System::is_dithered`].
    pub fn has_waves(&self) -> bool {
        self.waves().next().is_some()
    }

    /// Whether a dither acts: a wave whose amplitude is not 0.
    pub fn is_dithered(&self) -> bool {
        self.acting_frequencies().next().is_some()
    }

    /// Whether some wave is noise, which has no period.
    pub fn has_noise(&self) -> bool {
        self.waves().any(|wave| !wave.waveform.is_periodic())
    }

    /// The same system in which the seeds of all noise are greater by a number; beyond the largest seed they continue from 0.
    #[must_use]
    pub fn reseeded(&self, by: u64) -> Self {
        let mut system = self.clone();
        for input in &mut system.inputs {
            input.profile = input.profile.reseeded(by);
        }
        system
    }

    /// Angular frequencies of the waves that act, in the order of the inputs.
    pub fn acting_frequencies(&self) -> impl Iterator<Item = f64> {
        self.waves().filter(|wave| wave.amplitude != 0.0).map(Wave::repetition)
    }

    /// Length of the state: that of the structure, and one number for each contact with a state of its own.
    pub fn state_size(&self) -> usize {
        let own = self.contacts.iter().filter(|contact| contact.has_state());
        self.structure.state_size() + own.count()
    }

    /// Whether a contact has a state of its own ([`Contact::has_state`]).
    pub fn has_contact_state(&self) -> bool {
        self.contacts.iter().any(Contact::has_state)
    }

    /// The same system without the waves of its inputs. A dither that multiplies friction takes its mean with it: without it friction is
    /// what the law gives, also where the mean of the factor is 0 because the direction of sliding alternates.
    #[must_use]
    pub fn undithered(&self) -> Self {
        let mut system = self.clone();
        let mut freed = vec![false; self.contacts.len()];
        for input in &mut system.inputs {
            let acts = input.profile.waves().iter().any(|wave| wave.amplitude != 0.0);
            input.profile = match input.target {
                InputTarget::Friction { contact } if acts => {
                    let is_first = !std::mem::replace(&mut freed[contact], true);
                    Profile::constant(f64::from(u8::from(is_first)))
                }
                _ => input.profile.without_waves(),
            };
        }
        system
    }

    /// Whether drives and loads are constant, and dithers periodic: nothing has knots or an envelope, no surface oscillates, and
    /// the matrices of the structure are constant.
    /// Averages, orbits, thresholds and steady sliding are those of a steady system.
    pub fn is_steady(&self) -> bool {
        let steady = |contact: &Contact| {
            let drive = &contact.surface_velocity;
            drive.is_steady() && drive.waves().is_empty() && contact.varying_load.is_none()
        };
        let turning = self.structure.mechanical().and_then(Mechanical::by_speed);
        turning.is_none()
            && self.contacts.iter().all(steady)
            && self.inputs.iter().all(|input| input.profile.is_steady())
    }

    /// The steady system with the drives, loads and amplitudes of a time.
    #[must_use]
    pub fn steady_at(&self, time: f64) -> Self {
        let mut system = self.clone();
        if let Some(mechanical) = self.structure.mechanical() {
            system.structure = mechanical.steady_at(time).into();
        }
        for contact in &mut system.contacts {
            *contact = contact.steady_at(time);
        }
        for input in &mut system.inputs {
            input.profile = input.profile.steady_at(time);
        }
        system
    }

    /// The same system with the amplitudes of all waves multiplied by a factor. With the factor 0 no dither acts, but the waves
    /// keep their frequencies ([`System::has_waves`]).
    ///
    /// ```
    /// use quell_model::profile::{Profile, Wave};
    /// use quell_model::system::InputTarget;
    /// use quell_model::{Belt, Coulomb, Friction, Input, Waveform};
    ///
    /// let law = Friction::Coulomb(Coulomb::constant(0.4));
    /// let mut system = Belt::new(0.05, 1.0, 0.5, law, Vec::new())?.system();
    /// let wave = Wave { waveform: Waveform::Sine, amplitude: 0.5, frequency: 10.0, phase: 0.0, envelope: None };
    /// let profile = Profile::constant(2.0).with(wave);
    /// system.inputs = vec![Input { target: InputTarget::Force(vec![1.0]), profile }];
    ///
    /// let half = system.with_amplitudes_scaled(0.5);
    /// assert_eq!(half.waves().next().map(|wave| wave.amplitude), Some(0.25));
    /// assert_eq!(half.inputs[0].profile.mean(), 2.0);
    /// assert!(half.is_dithered() && !half.undithered().has_waves());
    /// let still = system.with_amplitudes_scaled(0.0);
    /// assert!(!still.is_dithered() && still.has_waves());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn with_amplitudes_scaled(&self, factor: f64) -> Self {
        let mut system = self.clone();
        for input in &mut system.inputs {
            input.profile = input.profile.with_waves_scaled(factor);
        }
        system
    }

    /// The same system with another amplitude of one input; its waves keep their shares of the first, and are all as large where the first
    /// has no amplitude. Unchanged if it has no such input.
    ///
    /// ```
    /// use quell_model::profile::{Profile, Wave};
    /// use quell_model::system::{Input, InputTarget};
    /// use quell_model::{Belt, LawKind, Waveform};
    ///
    /// let law = LawKind::Stribeck.build(&[0.4, 0.25, 0.5])?;
    /// let mut system = Belt::new(0.05, 1.0, 0.5, law, Vec::new())?.system();
    /// let wave = Wave { waveform: Waveform::Sine, amplitude: 0.5, frequency: 10.0, phase: 0.0, envelope: None };
    /// let profile = Profile::constant(0.0).with(wave);
    /// system.inputs = vec![Input { target: InputTarget::Force(vec![1.0]), profile }];
    ///
    /// let louder = system.with_amplitude(0, 2.0);
    /// assert_eq!(louder.waves().next().map(|wave| wave.amplitude), Some(2.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn with_amplitude(&self, input: usize, amplitude: f64) -> Self {
        let mut system = self.clone();
        let Some(dither) = system.inputs.get_mut(input) else { return system };
        let waves = dither.profile.waves().to_vec();
        let first = waves.first().map_or(0.0, |wave| wave.amplitude);
        let scaled = |wave: &Wave| {
            let share = if first == 0.0 { 1.0 } else { wave.amplitude / first };
            Wave { amplitude: share * amplitude, ..wave.clone() }
        };
        let still = dither.profile.without_waves();
        dither.profile = waves.iter().map(scaled).fold(still, Profile::with);
        system
    }
}
