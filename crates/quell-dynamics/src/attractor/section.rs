//! The stroboscopic section: the moments at which states are compared.

use std::f64::consts::TAU;

use quell_model::Belt;

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
}
