//! Where a run from a start ends, in the words of its quietness.
//!
//! This depends on the start, unlike the multipliers: attractors coexist, so that quenching from a given start and stability of the
//! response are different questions. Where a run settles is decided by [`settle()`](super::settle()), as everywhere.

use quell_model::Belt;

use super::base_response::BaseResponse;
use super::measure::is_quiescent;
use super::settings::AttractorSettings;
use super::settle::{Patience, SettleOutcome, Settled, settle};
use crate::orbit::{NoOrbit, OrbitVerdict};
use crate::simulation::{Stalled, Start};

/// For a run that cannot settle on the base response, because that is unstable. A run that still moves after 2000 slow periods
/// (at R = 10) counts as vibrating: a response without slow motion that attracts more slowly than that is missed, in a narrow
/// interval around a threshold.
const OFF_AN_UNSTABLE_BASE: Patience = Patience { periods: 20_000, ..Patience::SWEEP };

/// Where a run settles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Reached {
    /// On the base response.
    Base,
    /// On another response without slow motion of its own: of the dither's period, or of so few periods that all its spectral
    /// lines are above the band of slow vibration.
    Forced,
    /// On a response that vibrates slowly.
    Elsewhere,
    /// It had not settled when its periods were used up.
    Unsettled,
    /// The start, or the base response for the comparison, was not found.
    Unknown,
}

impl Reached {
    /// Whether it is quiescent, without slow motion of its own, so that the self-excited vibration has ended; `None` if unknown.
    pub fn is_quiet(self) -> Option<bool> {
        match self {
            Self::Base | Self::Forced => Some(true),
            Self::Elsewhere => Some(false),
            Self::Unsettled | Self::Unknown => None,
        }
    }

    fn of(settings: &AttractorSettings<'_>, settled: &Settled) -> Result<Self, Stalled> {
        Ok(match settled.outcome {
            SettleOutcome::Base => Self::Base,
            SettleOutcome::Elsewhere if is_quiescent(settings, settled)? => Self::Forced,
            SettleOutcome::Elsewhere => Self::Elsewhere,
            SettleOutcome::Unsettled(_) => Self::Unsettled,
        })
    }
}

/// Where the run of a belt from `start` settles. `start.time` is a whole number of common periods of the dithers.
///
/// # Errors
/// [`NoOrbit`]: no common period, or the engine stopped; also if the run has not settled and the base response, to which it may
/// be converging, could not be followed to the dither's amplitude.
pub fn reached(belt: &Belt, start: Start) -> Result<Reached, NoOrbit> {
    Ok(reached_at(belt, start)?.0)
}

/// [`reached`] with a state of the response at τ = 0 modulo the period: of the base response its own, otherwise the last one of the run.
pub(crate) fn reached_at(belt: &Belt, start: Start) -> Result<(Reached, Start), NoOrbit> {
    let settings = AttractorSettings::new(belt)?;
    let is_unstable =
        settings.base.as_ref().is_ok_and(|base| base.verdict == OrbitVerdict::Unstable);
    let patience = if is_unstable { OFF_AN_UNSTABLE_BASE } else { Patience::SWEEP };
    let settled = settle(&settings, start, patience).map_err(NoOrbit::Stalled)?;
    match (Reached::of(&settings, &settled).map_err(NoOrbit::Stalled)?, &settings.base) {
        (Reached::Unsettled, Err(why)) if !why.is_absence() => Err(*why),
        (Reached::Unsettled, _) if is_unstable => Ok((Reached::Elsewhere, settled.state)),
        (Reached::Base, Ok(base)) => {
            let BaseResponse { displacement, velocity, .. } = *base;
            Ok((Reached::Base, Start { time: 0.0, displacement, velocity }))
        }
        (reached, _) => Ok((reached, settled.state)),
    }
}
