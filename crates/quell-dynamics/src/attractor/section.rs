//! The stroboscopic section: the moments at which states are compared.

use std::f64::consts::TAU;

use quell_model::Belt;

use crate::band::BAND_END;
use crate::orbit::{NoOrbit, common_period};

/// Samples of an undithered belt per slow period 2π: a revolution is followed in steps of a tenth, so that none is missed. With
/// two or fewer its direction would be undetermined; more only take longer.
const SAMPLES_WITHOUT_DITHER: f64 = 10.0;

/// The stroboscopic section: states at the moments τ = nT.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StroboscopicSection {
    /// T: the common period of the dithers; 2π/10 without dither.
    pub period: f64,
    /// Whether T is a period of the dither.
    pub dithered: bool,
}

impl StroboscopicSection {
    /// The section of a belt.
    ///
    /// # Errors
    /// [`NoOrbit::Incommensurate`].
    pub fn of(belt: &Belt) -> Result<Self, NoOrbit> {
        match common_period(belt) {
            Ok(period) => Ok(Self { period, dithered: true }),
            Err(NoOrbit::NoDither) => {
                Ok(Self { period: TAU / SAMPLES_WITHOUT_DITHER, dithered: false })
            }
            Err(why) => Err(why),
        }
    }

    /// Largest number q of periods of a response whose spectral lines, multiples of 2π/(qT), are all above the band of slow
    /// vibration; 1 if the dither's own period has a line in the band, because a response in step with the dither has no slow
    /// motion of its own.
    pub(super) fn periods_above_the_band(&self) -> u32 {
        let most = TAU / (self.period * BAND_END);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
        let most = (most.ceil() - 1.0) as u32;
        most.max(1)
    }

    /// Whether a response of the dither's own period may vibrate in the band of slow vibration: its spectral lines are multiples
    /// of 2π/T.
    pub fn reaches_the_band(&self) -> bool {
        self.dithered && TAU / self.period <= BAND_END
    }
}
