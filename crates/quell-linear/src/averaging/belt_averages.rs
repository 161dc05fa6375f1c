//! The averaged law of a belt at one slow slip velocity and any amplitude: in the limit of high frequency by its dithers alone, at finite
//! R by the fast motion of its system.

use quell_model::profile::Profile;
use quell_model::{Belt, Dither, System};

use super::averaged_law::AveragedLaw;
use super::dithers::Averaging;
use super::error::AveragingError;
use super::fast_inputs::FastInputs;
use super::fast_motion::FastMotion;
use super::sliding::DitheredSystem;

/// A belt at a slow slip velocity, whose averages are asked for at many amplitudes.
#[derive(Clone, Debug)]
pub(super) struct BeltAverages<'a> {
    belt: &'a Belt,
    velocity: f64,
    fast: BeltFast,
}

#[derive(Clone, Debug)]
enum BeltFast {
    /// The dithers themselves, in the limit of high frequency.
    Limit { to_second_order: bool },
    /// The response of the belt's system to each of them.
    FiniteR(Box<(System, FastInputs)>),
}

impl<'a> BeltAverages<'a> {
    /// Prepares the averages at slow slip velocity `velocity`.
    ///
    /// # Errors
    /// [`AveragingError`] where the fast motion has no value.
    pub(super) fn new(
        belt: &'a Belt,
        velocity: f64,
        averaging: Averaging,
    ) -> Result<Self, AveragingError> {
        let fast = match averaging {
            Averaging::Limit => BeltFast::Limit { to_second_order: false },
            Averaging::LimitToSecondOrder => BeltFast::Limit { to_second_order: true },
            Averaging::FiniteR => {
                let acting = belt.dithers().iter().filter(|dither| dither.amplitude > 0.0);
                let lowest = acting.map(Dither::lowest_ratio).fold(f64::INFINITY, f64::min);
                if lowest <= 1.0 {
                    return Err(AveragingError::NotFast { frequency_ratio: lowest });
                }
                let mut system = belt.system();
                for contact in &mut system.contacts {
                    contact.surface_velocity = Profile::constant(velocity);
                    // An average is that of the rigid law.
                    contact.tangential_stiffness = None;
                }
                let fast = DitheredSystem::with_fast_motion(&system)?.into_fast();
                BeltFast::FiniteR(Box::new((system, fast)))
            }
        };
        Ok(Self { belt, velocity, fast })
    }

    /// The averaged law, with another amplitude D of the first dither if one is given, whether or not the contact would stay closed.
    ///
    /// # Errors
    /// [`AveragingError`] where the fast motion has no value.
    pub(super) fn law(&self, first: Option<f64>) -> Result<AveragedLaw, AveragingError> {
        let (belt, load) = (self.belt, self.belt.normal_load());
        match &self.fast {
            BeltFast::FiniteR(fast) => {
                let (system, fast) = &**fast;
                Ok(fast.law(system, (0, load), first.map(|amplitude| (0, amplitude)))?)
            }
            BeltFast::Limit { to_second_order } => {
                let mut dithers: Vec<Dither> = belt.dithers().to_vec();
                if let (Some(dither), Some(amplitude)) = (dithers.first_mut(), first) {
                    dither.amplitude = amplitude;
                }
                let motion = FastMotion::in_the_limit(
                    (belt.friction(), load),
                    &dithers,
                    self.velocity,
                    *to_second_order,
                )?;
                Ok(AveragedLaw::new(belt.friction(), [motion.clone(), motion], 0.0))
            }
        }
    }
}

impl AveragedLaw {
    /// The law of a belt under its dithers, with their fast motion at a slow slip velocity: that of its system at finite R.
    ///
    /// # Errors
    /// [`AveragingError`] where the fast motion has no value.
    pub fn of_one_mass(belt: &Belt, v: f64, averaging: Averaging) -> Result<Self, AveragingError> {
        BeltAverages::new(belt, v, averaging)?.law(None)
    }
}

impl FastMotion {
    /// Fast motion of a belt's dithers at slow slip velocity `v`.
    ///
    /// # Errors
    /// [`AveragingError`] where the structure has no response, or where dither acts in both directions and the friction level that
    /// drives the normal dither cannot be computed.
    pub fn of(belt: &Belt, v: f64, averaging: Averaging) -> Result<Self, AveragingError> {
        Ok(AveragedLaw::of_one_mass(belt, v, averaging)?.motion().clone())
    }
}
