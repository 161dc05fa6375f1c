//! The stroboscopic section: the moments at which states are compared.

use std::f64::consts::TAU;

use quell_linear::pure_slip::period;
use quell_model::System;

use crate::orbit::{NoImage, NoOrbit};

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
    /// The section of a system.
    ///
    /// # Errors
    /// [`NoOrbit::NoImage`] of dithers without a common period.
    pub fn of(system: &System) -> Result<Self, NoOrbit> {
        if !system.has_waves() {
            return Ok(Self { period: TAU / SAMPLES_WITHOUT_DITHER, dithered: false });
        }
        let period = period(system).ok_or(NoOrbit::NoImage(NoImage::NoPeriod))?;
        Ok(Self { period, dithered: true })
    }
}
