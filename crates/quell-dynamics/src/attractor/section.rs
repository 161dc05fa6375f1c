//! When a response is looked at, and what is known of a belt before any run.

use std::f64::consts::TAU;

use quell_model::Belt;

use super::quiet::Quiet;
use crate::band::BAND_END;
use crate::orbit::{NoOrbit, common_period};

/// Looks at an undithered belt in one slow period 2π: often enough that a turn is not mistaken for none.
const LOOKS_WITHOUT_DITHER: f64 = 10.0;

/// The moments τ = nT at which states are compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strobe {
    /// T: the common period of the dithers; 2π/10 without dither.
    pub period: f64,
    /// Whether T is a period of the dither.
    pub dithered: bool,
}

impl Strobe {
    /// The strobe of a belt.
    ///
    /// # Errors
    /// [`NoOrbit::Incommensurate`].
    pub fn of(belt: &Belt) -> Result<Self, NoOrbit> {
        match common_period(belt) {
            Ok(period) => Ok(Self { period, dithered: true }),
            Err(NoOrbit::NoDither) => {
                Ok(Self { period: TAU / LOOKS_WITHOUT_DITHER, dithered: false })
            }
            Err(why) => Err(why),
        }
    }

    /// Most periods of a response of which every line, a multiple of 2π/(qT), lies above the band of slow vibration; 1 where
    /// the dither's own period is that of a line in the band, for what is in step with it has no motion of its own.
    pub(super) fn periods_above_the_band(&self) -> u32 {
        let most = TAU / (self.period * BAND_END);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
        let most = (most.ceil() - 1.0) as u32;
        most.max(1)
    }

    /// Whether a response of the dither's own period may vibrate in the band of slow vibration: its lines are multiples of 2π/T.
    pub fn reaches_the_band(&self) -> bool {
        self.dithered && TAU / self.period <= BAND_END
    }
}

/// A belt, its strobe, and the response that sliding becomes under its dither, where that was found.
#[derive(Clone, Debug)]
pub struct Scene<'a> {
    /// The belt.
    pub belt: &'a Belt,
    /// When states are compared.
    pub strobe: Strobe,
    /// The response that sliding becomes, or why there is none.
    pub quiet: Result<Quiet, NoOrbit>,
}

impl<'a> Scene<'a> {
    /// The scene of a belt.
    ///
    /// # Errors
    /// [`NoOrbit::Incommensurate`].
    pub fn new(belt: &'a Belt) -> Result<Self, NoOrbit> {
        let strobe = Strobe::of(belt)?;
        Ok(Self { belt, strobe, quiet: Quiet::of(belt, strobe) })
    }

    /// Whether a dither acts whose own responses may vibrate in the band of slow vibration.
    pub fn reaches_the_band(&self) -> bool {
        !self.is_autonomous() && self.strobe.reaches_the_band()
    }

    /// Whether no dither acts.
    pub fn is_autonomous(&self) -> bool {
        self.belt.dithers().iter().all(|dither| dither.amplitude == 0.0)
    }
}
