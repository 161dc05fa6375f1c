//! The slow vibration of a system that a weak dither leaves, by harmonic balance with the averaged law of its contact.
//!
//! A slow vibration whose slip velocity at the contact has the amplitude a feels friction with the slope N·N₁(a), the equivalent gain
//! of the averaged law ([`DescribingFunction`]). The structure answers as in small motions: its growth rate is that of the eigenvalue
//! λ(a) of the linear equations with this slope, and a limit cycle is where Re λ(a) = 0, at the frequency Im λ. This is the balance
//! 1 + N·N₁(a) Y(iω) = 0 with the mobility Y of the structure at the contact, with every mode, written for the state matrix. It is
//! stable where the growth rate falls with a.
//!
//! The balance is for one contact whose load is constant and one growing mode: the amplitudes at several contacts differ, a load that
//! moves multiplies the gain, and several growing modes modulate each other. [`NoSlowVibration`] says which of these it is.

use num_complex::Complex64;
use quell_model::System;
use quell_model::system::Contact;
use quell_numerics::eigen::EigenError;

use super::describing::{DescribedCycle, DescribingFunction};
use super::error::AveragingError;
use super::sliding::AveragedSliding;
use crate::linearised::FrictionSlopes;
use crate::spectrum::{MotionSpectrum, SmallMotion, spectrum};

/// Growth rates below this share of the frequency are rounding where another motion is checked at a cycle.
const NEUTRAL: f64 = 1e-9;

/// Why harmonic balance predicts no slow vibration.
#[derive(Clone, Debug, PartialEq)]
pub enum NoSlowVibration {
    /// No contact moves along its tangent, or several do.
    Contacts {
        /// Their number.
        count: usize,
    },
    /// The load of the contact follows the motion.
    MovingLoad {
        /// Name of the contact.
        contact: String,
    },
    /// The contact has a state of its own.
    OwnState {
        /// Name of the contact.
        contact: String,
    },
    /// Several motions grow.
    Modes {
        /// Their number.
        count: usize,
    },
    /// A mean has no value.
    Mean(AveragingError),
    /// The state matrix overflows.
    Eigenvalues(EigenError),
}

impl std::fmt::Display for NoSlowVibration {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Contacts { count: 0 } => {
                f.write_str("no contact moves along its tangent, so that friction damps no motion")
            }
            Self::Contacts { count } => write!(
                f,
                "harmonic balance is for one contact, and {count} contacts move along their tangents, each with an amplitude of its own"
            ),
            Self::MovingLoad { contact } => write!(
                f,
                "harmonic balance is for a constant load, and the load of contact {contact} follows the motion, so that its friction is \
                 no function of the slip velocity alone"
            ),
            Self::OwnState { contact } => write!(
                f,
                "harmonic balance is for friction that follows the slip velocity at once, and contact {contact} has a state of its own"
            ),
            Self::Modes { count } => {
                write!(f, "harmonic balance is for one growing motion, and {count} grow together")
            }
            Self::Mean(why) => why.fmt(f),
            Self::Eigenvalues(why) => why.fmt(f),
        }
    }
}

impl std::error::Error for NoSlowVibration {}

impl From<AveragingError> for NoSlowVibration {
    fn from(why: AveragingError) -> Self {
        Self::Mean(why)
    }
}

impl From<EigenError> for NoSlowVibration {
    fn from(why: EigenError) -> Self {
        Self::Eigenvalues(why)
    }
}

/// A limit cycle of slow motions.
#[derive(Clone, Debug, PartialEq)]
pub struct DescribedVibration {
    /// Amplitude of the slip velocity at the contact, and its stability.
    pub cycle: DescribedCycle,
    /// Angular frequency.
    pub frequency: f64,
    /// Amplitude over the coordinates, or over the states of first-order equations.
    pub shape: Vec<Complex64>,
}

impl DescribedVibration {
    /// Amplitude of a row over the coordinates.
    pub fn amplitude(&self, row: &[f64]) -> f64 {
        let along: Complex64 = row.iter().zip(&self.shape).map(|(r, q)| q * *r).sum();
        quell_numerics::polar::modulus(along)
    }
}

/// The slow motions of a system with the equivalent gain of one contact.
#[derive(Clone, Debug)]
pub struct SlowVibration<'a> {
    average: &'a AveragedSliding,
    contact: usize,
    function: &'a DescribingFunction,
}

impl<'a> SlowVibration<'a> {
    /// The one contact of a system for which harmonic balance holds.
    ///
    /// # Errors
    /// [`NoSlowVibration`] about the contacts.
    pub fn contact_of(system: &System) -> Result<usize, NoSlowVibration> {
        let moves = |contact: &Contact| contact.tangent.iter().flatten().any(|entry| *entry != 0.0);
        let mut moving = system.contacts.iter().enumerate().filter(|(_, contact)| moves(contact));
        let (Some((index, contact)), None) = (moving.next(), moving.next()) else {
            let count = system.contacts.iter().filter(|contact| moves(contact)).count();
            return Err(NoSlowVibration::Contacts { count });
        };
        let name = || contact.name.clone();
        if contact.has_state() {
            return Err(NoSlowVibration::OwnState { contact: name() });
        }
        let sprung = contact.normal_stiffness != 0.0 || contact.normal_damping != 0.0;
        if contact.slope.is_some() || (contact.normal.is_some() && sprung) {
            return Err(NoSlowVibration::MovingLoad { contact: name() });
        }
        Ok(index)
    }

    /// The slow motions about averaged sliding, with the describing function of the contact.
    pub fn new(
        average: &'a AveragedSliding,
        contact: usize,
        function: &'a DescribingFunction,
    ) -> Self {
        Self { average, contact, function }
    }

    /// Every slow motion with an equivalent gain.
    fn spectrum(&self, gain: f64) -> Result<MotionSpectrum, EigenError> {
        let steady = &self.average.linear.contacts()[self.contact].steady;
        let mut friction: Vec<FrictionSlopes> = self.average.friction.clone();
        friction[self.contact].by_velocity = steady.factor * steady.normal_load * gain;
        spectrum(&self.average.linear, &friction)
    }

    /// Largest growth rate of slow oscillations with an equivalent gain; of a structure that does not oscillate, of every motion.
    ///
    /// # Errors
    /// [`EigenError`] where the matrix overflows.
    pub fn growth_rate(&self, gain: f64) -> Result<f64, EigenError> {
        let found = self.spectrum(gain)?;
        Ok(oscillating(&found).next().map_or(found.growth.rate, |motion| motion.eigenvalue.re))
    }

    /// Every limit cycle up to an amplitude of the slip velocity, ascending.
    ///
    /// # Errors
    /// [`NoSlowVibration`] where several motions grow, at small amplitudes or at a cycle, and where a mean has no value.
    pub fn cycles(&self, largest: f64) -> Result<Vec<DescribedVibration>, NoSlowVibration> {
        let first = match self.function.small()? {
            Some(gain) => gain,
            // At a corner the slope jumps: the gain just above it.
            None => self.function.at(1e-3 * largest)?.gain,
        };
        let count = growing(&self.spectrum(first)?).count();
        if count > 1 {
            return Err(NoSlowVibration::Modes { count });
        }
        let balance = |gain: f64| -> Result<f64, NoSlowVibration> { Ok(-self.growth_rate(gain)?) };
        let cycles = self.function.cycles(largest, balance)?;
        cycles.into_iter().map(|cycle| self.vibration(cycle)).collect()
    }

    /// The motion at a cycle.
    fn vibration(&self, cycle: DescribedCycle) -> Result<DescribedVibration, NoSlowVibration> {
        let found = self.spectrum(self.function.at(cycle.amplitude)?.gain)?;
        let Some(motion) = oscillating(&found).next() else {
            return Err(NoSlowVibration::Modes { count: 0 });
        };
        let others = growing(&found).filter(|other| *other != motion).count();
        if others > 0 {
            return Err(NoSlowVibration::Modes { count: others + 1 });
        }
        let linear = &self.average.linear;
        let tangent = linear.contacts()[self.contact].tangent().unwrap_or_default();
        let along: Complex64 = tangent.iter().zip(&motion.shape).map(|(t, q)| q * *t).sum();
        // First-order equations have the slip velocity itself among their states.
        let slip = if linear.matrices().is_some() { along * motion.eigenvalue } else { along };
        let size = quell_numerics::polar::modulus(slip);
        let shape = motion.shape.iter().map(|q| q * (cycle.amplitude / size)).collect();
        Ok(DescribedVibration { cycle, frequency: motion.frequency(), shape })
    }
}

/// The oscillations without conjugates, the fastest growing first.
fn oscillating(spectrum: &MotionSpectrum) -> impl Iterator<Item = &SmallMotion> {
    spectrum.motions.iter().filter(|motion| motion.eigenvalue.im > 0.0)
}

/// The motions that grow, without conjugates.
fn growing(spectrum: &MotionSpectrum) -> impl Iterator<Item = &SmallMotion> {
    let grows = |motion: &&SmallMotion| {
        let size = quell_numerics::polar::modulus(motion.eigenvalue);
        motion.eigenvalue.im >= 0.0 && motion.eigenvalue.re > motion.error.max(NEUTRAL * size)
    };
    spectrum.motions.iter().filter(grows)
}
