//! The steady response of any system: a settled record of one row, compared with the undithered run from the same start.
//!
//! Where a run ends on a stable periodic motion, means over time are those of one period exactly ([`SystemEnding`]). The record of one mass
//! is that of its run after the settling time, as in maps ([`super::compare_many`]); where it has not settled it begins on that motion
//! instead. With several masses it always does. Where no such motion is found, the record of the run itself is judged.
//!
//! The dissertation specifies no record, and E depends on it: the time until the run has settled is discarded, the mean removed, a periodic
//! Hann window applied, and zeros appended to four times the length. M is the largest spectral amplitude in the band of slow vibration, and
//! E = M₁/M₀ (2.27). Keeping the mean would make E > 1; keeping the start-up under a rectangular window would limit E to about 0.3 from
//! below.
//!
//! The band of one mass ends at 1.9 ω₀, as in the dissertation. With several masses it ends below the lowest dither frequency; if that is
//! not above 1.9 times the frequency of the vibration, the band ends there ([`RecordGrid::band_end`]). The vibration is the strongest line
//! without dither; where none remains, the least damped motion of the sliding structure. The effect is decided by [`Vibrations`]. The tones of dithers above the band are subtracted first: near its end the window would spread them
//! into it. What a dither in the band moves is vibration.
//!
//! An undithered run on no known motion keeps vibrating if its record does not decay, or shows a vibration while steady sliding is
//! unstable.

use quell_linear::steady::SteadySliding;
use quell_model::System;

use super::effect::{Effect, Uncertain, Vibrations};
use super::measure::{ResponseCase, Undefined, keeps_vibrating_without};
use super::record_grid::RecordGrid;
use super::record_lines::RecordLines;
use super::refused::ResponseRefused;
use super::response_plan::ResponsePlan;
use super::settled_record::SettledRecord;
use super::system_ending::{SystemEnding, cannot_settle};
use crate::motion::{Motion, MotionStart};
use crate::simulation::Start;

/// Peaks below this fraction of the largest are not listed.
pub const PEAK_FLOOR: f64 = 1e-3;

/// The steady response of a system.
#[derive(Clone, Debug)]
pub struct SteadyResponse {
    /// With dither.
    pub dithered: SettledRecord,
    /// Without dither, from the same start.
    pub undithered: SettledRecord,
    /// M with and without dither.
    pub vibrations: Vibrations,
    /// Upper end of the band of slow vibration, an angular frequency.
    pub band_end: f64,
    /// The effect of the dither.
    pub effect: Effect,
    /// E = M₁/M₀, the residual vibration, or why it is undefined.
    pub residual_vibration: Result<f64, Undefined>,
    /// Friction of every contact in steady sliding without dither, if that exists.
    pub steady_friction: Option<Vec<f64>>,
}

/// The settled record without dither, with which responses are compared: those under noise of any seed share it.
#[derive(Clone, Debug)]
pub struct UnditheredResponse<'a> {
    start: &'a MotionStart,
    plan: &'a ResponsePlan,
    /// The system without its dither.
    still: System,
    grid: RecordGrid,
    record: SettledRecord,
    band_end: f64,
}

/// Integrates a system from a start with and without its dither, and measures both.
///
/// # Errors
/// [`ResponseRefused`].
pub fn respond(
    system: &System,
    start: &MotionStart,
    plan: &ResponsePlan,
) -> Result<SteadyResponse, ResponseRefused> {
    UnditheredResponse::new(system, start, plan)?.with_dither(system)
}

/// The effect of a dither: `vibrates` without it, or why not; the end of the run with it, with the upper end of the band; and what the
/// records show.
pub(super) fn effect_of(
    has_dither: bool,
    vibrates: Result<(), Undefined>,
    (ending, band_end): (&SystemEnding, f64),
    vibrations: &Vibrations,
) -> Effect {
    match vibrates {
        _ if !has_dither => Effect::Unknown(Uncertain::NoDither),
        Err(why) if why.is_unknown() => Effect::Unknown(Uncertain::Undithered(why)),
        _ if *ending == SystemEnding::Drift => Effect::Unknown(Uncertain::Drifts),
        Ok(()) if ending.is_faster_than(band_end) => Effect::Quenches,
        Err(_) if ending.is_faster_than(band_end) => Effect::Quiet,
        _ => vibrations.effect(),
    }
}

impl SteadyResponse {
    /// Whether a dither acts.
    pub fn has_dither(&self) -> bool {
        self.effect != Effect::Unknown(Uncertain::NoDither)
    }

    /// Whether both runs settled, as far as E requires.
    pub fn is_settled(&self) -> bool {
        self.dithered_is_settled()
            && (self.undithered_is_settled() || self.residual_vibration.is_err())
    }

    /// Whether the run with dither ends on an orbit, or M of the halves of its record agree.
    pub fn dithered_is_settled(&self) -> bool {
        if !self.has_dither() {
            return self.undithered_is_settled();
        }
        let Vibrations { dithered, undithered, .. } = self.vibrations;
        dithered.is_settled(undithered.whole()) && self.dithered.ending != SystemEnding::Drift
    }

    /// The same without dither.
    pub fn undithered_is_settled(&self) -> bool {
        self.vibrations.undithered.is_steady() && self.undithered.ending != SystemEnding::Drift
            || self.residual_vibration.is_err_and(Undefined::is_quiet)
    }

    /// Largest slip speed of a contact in both runs, 0 where its law has no range.
    pub fn largest_slip(&self, contact: usize) -> f64 {
        self.dithered.largest_slip[contact].max(self.undithered.largest_slip[contact])
    }
}

impl<'a> UnditheredResponse<'a> {
    /// Integrates a system from a start without its dither; the record and its band fit the dither.
    ///
    /// # Errors
    /// [`ResponseRefused`].
    pub fn new(
        system: &System,
        start: &'a MotionStart,
        plan: &'a ResponsePlan,
    ) -> Result<Self, ResponseRefused> {
        let still = system.undithered();
        let motion = Motion::new(system).map_err(ResponseRefused::Immobile)?;
        let without = Motion::new(&still).map_err(ResponseRefused::Immobile)?;
        let grid = RecordGrid::of(&motion, plan)?;
        let stopped = ResponseRefused::Stopped;
        let mut record = SettledRecord::of(&without, start, plan, grid).map_err(stopped)?;
        let band_end = grid.band_end(system, plan, record.strongest_line())?;
        record.measure_lines(&without, plan, (grid, band_end), None).map_err(stopped)?;
        Ok(Self { start, plan, still, grid, record, band_end })
    }

    /// Its record.
    pub fn record(&self) -> &SettledRecord {
        &self.record
    }

    /// Upper end of the band of slow vibration, an angular frequency.
    pub fn band_end(&self) -> f64 {
        self.band_end
    }

    /// Integrates the system with its dither, and compares.
    ///
    /// # Errors
    /// [`ResponseRefused`].
    pub fn with_dither(&self, system: &System) -> Result<SteadyResponse, ResponseRefused> {
        let (undithered, band_end) = (self.record.clone(), self.band_end);
        let has_dither = system.is_dithered();
        let dithered = if has_dither {
            let motion = Motion::new(system).map_err(ResponseRefused::Immobile)?;
            let stopped = ResponseRefused::Stopped;
            let mut dithered =
                SettledRecord::of(&motion, self.start, self.plan, self.grid).map_err(stopped)?;
            let reference = Some(undithered.lines.whole);
            dithered
                .measure_lines(&motion, self.plan, (self.grid, band_end), reference)
                .map_err(stopped)?;
            dithered
        } else {
            undithered.clone()
        };
        let scale = dithered.scale.max(undithered.scale);
        let [with, without] =
            [&dithered, &undithered].map(|record| RecordLines { lines: record.lines, scale });
        let vibrates = match self.vibrates(without) {
            Ok(()) if without.is_negligible() => Err(Undefined::UnditheredStill),
            vibrates => vibrates,
        };
        let vibrations = Vibrations {
            dithered: with,
            undithered: without,
            quiet_without: vibrates.is_err_and(Undefined::is_quiet),
            quiet_with: dithered.ending.motion().map(|found| found.quiet),
        };
        let effect = effect_of(has_dither, vibrates, (&dithered.ending, band_end), &vibrations);
        let steady = SteadySliding::new(&self.still).ok();
        Ok(SteadyResponse {
            residual_vibration: vibrates.map(|()| with.whole() / without.whole()),
            band_end,
            steady_friction: steady
                .map(|steady| steady.contacts.iter().map(|contact| contact.friction).collect()),
            dithered,
            undithered,
            vibrations,
            effect,
        })
    }

    /// Whether the run keeps vibrating: by the motion on which it ends; where that has no period of one mass by its cycle map, otherwise by
    /// its lines, compared with the largest motion of both runs.
    fn vibrates(&self, lines: RecordLines) -> Result<(), Undefined> {
        let ending = &self.record.ending;
        if ending.period().is_some() {
            return Ok(());
        }
        if let Some(mass) = self.still.one_mass() {
            let (displacement, velocity) = mass.of_state(&self.start.state);
            let start = Start { time: self.start.time, displacement, velocity };
            let case = ResponseCase { belt: mass.belt().clone(), start };
            return keeps_vibrating_without(&case).unwrap_or(Err(Undefined::UnditheredUnknown));
        }
        if *ending == SystemEnding::UnstableSliding {
            Err(Undefined::UnditheredUnstable)
        } else if *ending == SystemEnding::Drift {
            Err(Undefined::UnditheredDrifts)
        } else if ending.is_rest() || lines.is_negligible() || lines.whole() == 0.0 {
            Err(Undefined::UnditheredSettles)
        } else if lines.is_steady() || cannot_settle(&self.still) {
            Ok(())
        } else {
            Err(Undefined::UnditheredUnknown)
        }
    }
}
