//! The settings in which runs of a belt are judged: the belt, its stroboscopic section, and its base response.

use quell_model::{Belt, System};

use super::base_response::BaseResponse;
use super::section::StroboscopicSection;
use crate::band::is_quiet;
use crate::orbit::NoOrbit;

/// A belt, its stroboscopic section, and the base response under its dither, where it was found.
#[derive(Clone, Debug)]
pub struct AttractorSettings {
    /// The belt.
    pub belt: Belt,
    /// The belt as a system, whose state is (x, x′).
    pub(super) system: System,
    /// When states are compared.
    pub section: StroboscopicSection,
    /// The base response, or why it does not exist.
    pub base: Result<BaseResponse, NoOrbit>,
}

impl AttractorSettings {
    /// The settings of a belt.
    ///
    /// # Errors
    /// [`NoOrbit::NoImage`] of dithers without a common period.
    pub fn new(belt: &Belt) -> Result<Self, NoOrbit> {
        let system = belt.system();
        let section = StroboscopicSection::of(&system)?;
        let base = BaseResponse::of(&system, belt, section);
        Ok(Self { belt: belt.clone(), system, section, base })
    }

    /// Whether a response that repeats after a number of periods is quiet, without slow motion of its own.
    pub(super) fn is_quiet(&self, periods: u32) -> bool {
        is_quiet(&self.system, periods, f64::from(periods) * self.section.period)
    }

    /// Whether no dither acts.
    pub fn is_autonomous(&self) -> bool {
        self.belt.dithers().iter().all(|dither| dither.amplitude == 0.0)
    }
}
