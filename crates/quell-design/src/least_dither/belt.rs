//! A belt under dither as a structure whose dither is designed.

use std::sync::Arc;

use quell_dynamics::motion::orbit::{RunOutcome, VariedRun};
use quell_dynamics::orbit::threshold::{NoThresholds, local};
use quell_dynamics::orbit::{OrbitVerdict, from_sliding};
use quell_dynamics::response::BAND_END;
use quell_dynamics::start::{InitialState, NoSquealingStart};
use quell_linear::averaging::{
    AveragedVerdict, Averaging, AveragingError, Becomes, criterion, critical_amplitudes_up_to,
};
use quell_linear::driven_point::DrivenPoint;
use quell_linear::linear_cost::linear_cost;
use quell_model::{Belt, Direction, Dither, System};

use super::branch::AmplitudeBranch;
use super::quiet::AveragedChange;
use super::response::{ResponseSize, linear_response, loss_on, response_on};
use super::system::{STEPS_OF_A_RUN, quiet_changes};
use super::{DesignStart, DitherPrice, ExactVerdict, OperatingPoint, Plant, QuietAmplitudes};
use crate::actuator::{Actuator, ActuatorDemand};

/// Steps of the continuation over a range of amplitudes.
const STEPS: u32 = 8;

/// Steps by which the dither grows from zero to a verified base response.
const GROWTH_STEPS: u32 = 8;

/// Values tried between the ends of a range for runs from a start.
const TRIED: u32 = 24;

/// The row that is observed: the displacement of the mass.
const DISPLACEMENT: [f64; 1] = [1.0];

/// The belt at an operating point, its first dither without amplitude; or why it is none.
pub type BeltAtPoint<'a> = dyn Fn(OperatingPoint<'_>) -> Result<Belt, String> + Send + Sync + 'a;

/// A belt whose first dither is designed.
#[derive(Clone)]
pub struct BeltPlant<'a> {
    /// The belt at a point.
    pub at: Arc<BeltAtPoint<'a>>,
    /// The runs that must end quiet.
    pub start: DesignStart,
}

impl BeltPlant<'_> {
    fn at(&self, at: OperatingPoint<'_>) -> Result<Belt, String> {
        (self.at)(at)
    }

    fn dithered(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<Belt, String> {
        self.at(at)?.with_amplitude(0, amplitude).map_err(|why| why.to_string())
    }

    /// The belt as a system at a point with an amplitude.
    ///
    /// # Errors
    /// Why it is no valid belt.
    pub fn system(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<System, String> {
        self.dithered(at, amplitude).map(|belt| belt.system())
    }

    /// An answer about the point on which the dither acts.
    fn about_point<T>(
        &self,
        at: OperatingPoint<'_>,
        answer: impl Fn(&DrivenPoint<'_>) -> T,
    ) -> Result<T, String> {
        let belt = self.at(at)?;
        let first = belt.dithers().first().ok_or("the study has no dither")?;
        if first.direction == Direction::Normal {
            let why = "a normal dither on a prescribed load has no stroke, which the demand on an actuator needs";
            return Err(why.to_owned());
        }
        let point =
            DrivenPoint::of_belt(&first.waveform, first.frequency_ratio, belt.damping_ratio())
                .map_err(|why| why.to_string())?;
        Ok(answer(&point))
    }

    /// An answer about the runs from the start over the amplitude; `None` where nothing squeals without dither, so that every run is quiet.
    fn about_runs<T>(
        &self,
        belt: &Belt,
        answer: impl FnOnce(&VariedRun<'_>) -> Result<T, String>,
    ) -> Result<Option<T>, String> {
        let state = match self.start {
            DesignStart::Local => InitialState::Sliding,
            DesignStart::Rest => InitialState::Rest,
            DesignStart::Squeal => InitialState::Squealing,
        };
        let state = match state.resolve(belt) {
            Ok(start) => vec![start.displacement, start.velocity],
            Err(NoSquealingStart::SettlesToSliding | NoSquealingStart::BeltAtRest) => {
                return Ok(None);
            }
            Err(NoSquealingStart::Stalled(why)) => return Err(why.to_string()),
        };
        let at = |values: &[f64]| {
            let dithered = belt.with_amplitude(0, values[0]).map_err(|why| why.to_string())?;
            Ok(dithered.system())
        };
        let start = |_: f64, _: &System| Ok(state.clone());
        let run = VariedRun { start: &start, ramp: 0.0, at: &at, most_steps: STEPS_OF_A_RUN };
        answer(&run).map(Some)
    }

    fn by_runs(&self, belt: &Belt, range: (f64, f64)) -> Result<QuietAmplitudes, String> {
        let found = self.about_runs(belt, |run| quiet_changes(run, range, TRIED))?;
        let (first, changes) = found.unwrap_or((true, Vec::new()));
        Ok(QuietAmplitudes::of_changes(range, first, changes))
    }

    fn by_multipliers(belt: &Belt, (from, to): (f64, f64)) -> Result<QuietAmplitudes, String> {
        let found = amplitude_branch_of_belt(belt, (from, to), STEPS);
        Ok(found.map_err(|why| why.to_string())?.quiet())
    }
}

/// The base response of a belt over the amplitude of its first dither, followed in at least `steps` steps: the judge of `thresholds`.
///
/// # Errors
/// [`NoThresholds`] if there is no base response at the least amplitude.
pub fn amplitude_branch_of_belt(
    belt: &Belt,
    (from, to): (f64, f64),
    steps: u32,
) -> Result<AmplitudeBranch, NoThresholds> {
    let at = |values: &[f64]| belt.with_amplitude(0, values[0]).ok();
    let found = local(&at, from, to, steps)?;
    Ok(AmplitudeBranch::of_belt((from, to), &found))
}

/// The amplitudes of the first dither of a belt that are quiet by finite-R averaging, in a range.
///
/// # Errors
/// [`AveragingError`].
pub fn averaged_quiet_of_belt(
    belt: &Belt,
    range: (f64, f64),
) -> Result<QuietAmplitudes, AveragingError> {
    let (quiet_without, changes) = averaged_changes(belt, range.1)?;
    Ok(QuietAmplitudes::by_averaging(range, quiet_without, &changes))
}

/// Whether a belt is quiet without its first dither by finite-R averaging, and the changes up to an amplitude.
fn averaged_changes(
    belt: &Belt,
    largest: f64,
) -> Result<(bool, Vec<AveragedChange>), AveragingError> {
    let options = Averaging::FiniteR;
    // A belt without dither has no amplitude to set.
    let without = belt.with_amplitude(0, 0.0);
    let without = criterion(without.as_ref().unwrap_or(belt), options)?;
    let changes = critical_amplitudes_up_to(belt, options, largest)?;
    let changes = changes.iter().map(|critical| AveragedChange {
        amplitude: critical.amplitude,
        becomes_quiet: critical.becomes == Becomes::Stable,
        fails: (!critical.contact_stays_closed).then_some("the contact opens"),
    });
    Ok((without.verdict == AveragedVerdict::Stable, changes.collect()))
}

impl Plant for BeltPlant<'_> {
    fn averaged(
        &self,
        at: OperatingPoint<'_>,
        range: (f64, f64),
    ) -> Result<QuietAmplitudes, String> {
        averaged_quiet_of_belt(&self.at(at)?, range).map_err(|why| why.to_string())
    }

    fn least_averaged(&self, at: OperatingPoint<'_>) -> Result<f64, String> {
        let found = averaged_changes(&self.at(at)?, f64::INFINITY);
        let (quiet_without, changes) = found.map_err(|why| why.to_string())?;
        QuietAmplitudes::least_by_averaging(quiet_without, &changes)
    }

    fn exact(&self, at: OperatingPoint<'_>, range: (f64, f64)) -> Result<QuietAmplitudes, String> {
        let belt = self.at(at)?;
        match self.start {
            DesignStart::Local => Self::by_multipliers(&belt, range),
            DesignStart::Rest | DesignStart::Squeal => self.by_runs(&belt, range),
        }
    }

    fn verdict(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<ExactVerdict, String> {
        let belt = self.dithered(at, amplitude)?;
        let orbit = from_sliding(&belt, GROWTH_STEPS).map_err(|why| why.to_string())?;
        let stable = orbit.verdict() == OrbitVerdict::Stable;
        let quiet = match self.start {
            DesignStart::Local => stable,
            DesignStart::Rest | DesignStart::Squeal => {
                let outcome = |run: &VariedRun<'_>| match run.outcome(amplitude) {
                    RunOutcome::Unknown(why) => Err(why),
                    known => Ok(known.is_quiet() == Some(true)),
                };
                stable && self.about_runs(&self.at(at)?, outcome)?.unwrap_or(true)
            }
        };
        Ok(ExactVerdict { quiet, multiplier: orbit.radius(), growth_rate: None })
    }

    fn price(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<DitherPrice, String> {
        let belt = self.at(at)?;
        let first = belt.dithers().first().ok_or("the study has no dither")?;
        let acting = Dither { amplitude, ..first.clone() };
        let cost = linear_cost(&acting, belt.damping_ratio()).map_err(|why| why.to_string())?;
        Ok(DitherPrice { stroke: cost.stroke, velocity: cost.velocity, power: cost.power })
    }

    fn averaged_loss(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<f64, String> {
        let belt = self.dithered(at, amplitude)?;
        let dithered = criterion(&belt, Averaging::FiniteR).map_err(|why| why.to_string())?;
        let without = belt.friction().coefficient(belt.belt_velocity());
        Ok(1.0 - dithered.effective.coefficient / without)
    }

    fn exact_loss(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<f64, String> {
        let belt = self.dithered(at, amplitude)?;
        let orbit = from_sliding(&belt, GROWTH_STEPS).map_err(|why| why.to_string())?;
        let state = [orbit.start.displacement, orbit.start.velocity];
        loss_on(&belt.system(), (&state, orbit.period))
    }

    fn exact_response(
        &self,
        at: OperatingPoint<'_>,
        amplitude: f64,
    ) -> Result<ResponseSize, String> {
        let belt = self.dithered(at, amplitude)?;
        let orbit = from_sliding(&belt, GROWTH_STEPS).map_err(|why| why.to_string())?;
        let state = [orbit.start.displacement, orbit.start.velocity];
        response_on(&belt.system(), (&state, orbit.period), &DISPLACEMENT)
    }

    fn averaged_response(
        &self,
        at: OperatingPoint<'_>,
        amplitude: f64,
    ) -> Result<ResponseSize, String> {
        linear_response(&self.system(at, amplitude)?, 0, &DISPLACEMENT)
    }

    fn slowness(&self, at: OperatingPoint<'_>) -> Result<f64, String> {
        let belt = self.at(at)?;
        let slowest =
            belt.dithers().iter().map(Dither::repetition_ratio).fold(f64::INFINITY, f64::min);
        Ok(BAND_END / slowest)
    }

    fn minimum_normal_load(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<f64, String> {
        let belt = self.dithered(at, amplitude)?;
        Ok(belt.normal_load() - belt.total_amplitude(Direction::Normal))
    }

    fn demand(
        &self,
        at: OperatingPoint<'_>,
        actuator: &Actuator,
    ) -> Result<ActuatorDemand, String> {
        self.about_point(at, |point| actuator.demand(point))
    }

    #[expect(
        clippy::redundant_closure_for_method_calls,
        reason = "the method itself is of a point of one lifetime"
    )]
    fn slip_amplitudes(&self, at: OperatingPoint<'_>) -> Result<Vec<f64>, String> {
        self.about_point(at, |point| point.slip_amplitudes())
    }
}
