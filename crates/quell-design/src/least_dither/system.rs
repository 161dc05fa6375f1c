//! Any linear structure with friction contacts as one whose dither is designed.

use quell_dynamics::attractor::{RunOutcome, SWITCH_CLOSENESS, VariedRun, values_tried};
use quell_dynamics::orbit::{
    NoOrbit, Orbit, OrbitVerdict, base_response, branch_thresholds, sliding_verdict,
    squealing_state,
};
use quell_dynamics::response::{BAND_END, vibration_frequency};
use quell_linear::averaging::{AveragingError, Becomes, DitheredSystem};
use quell_linear::driven_point::DrivenPoint;
use quell_linear::growth::Verdict;
use quell_linear::input_cost::input_cost;
use quell_linear::linearised::Linearised;
use quell_model::profile::Wave;
use quell_model::{RefusedNumbers, System};
use quell_numerics::interval::RealInterval;

use super::branch::AmplitudeBranch;
use super::quiet::AveragedChange;
use super::response::{ResponseSize, largest_loss, linear_response, loss_on, response_on};
use super::{
    DesignStart, DitherPrice, ExactVerdict, MARGIN, OperatingPoint, Plant, QuietAmplitudes,
};
use crate::actuator::{Actuator, ActuatorDemand};
use crate::{AveragingEnds, NoAnswer};

/// Steps of the continuation over a range of amplitudes.
const STEPS: u32 = 8;

/// The end to which the base response is followed, over that of the range: what is quiet from just below the end is seen beyond it.
/// The continuation needs some 10⁻⁶ beyond a grazing; with less room a threshold next to the end counts as never quiet. More costs a step.
const BEYOND: f64 = 1.0 + 1e-4;

/// Share of the range between two amplitudes at which runs from a start are tried.
const TRIED_WITHIN: f64 = 1.0 / 16.0;

/// Least steps in which an interval is divided for them.
const LEAST_TRIED: u32 = 2;

/// Most integration steps of one run from a start and of what decides where it ends.
pub(super) const STEPS_OF_A_RUN: u64 = 20_000_000;

/// Steps by which the dither grows from zero to a verified base response.
const GROWTH_STEPS: u32 = 8;

/// A system at an operating point with an amplitude of the dither that is designed, or why it is no valid system.
pub type SystemAtPoint<'a> =
    dyn Fn(OperatingPoint<'_>, f64) -> Result<System, RefusedNumbers> + Sync + 'a;

/// A system one of whose dithers is designed, judged by small motions, averaged sliding and then the multipliers of the base response, or
/// by runs from a start, which must end in step with the dither.
#[derive(Clone, Copy)]
pub struct SystemPlant<'a> {
    /// The system at an operating point with an amplitude.
    pub at: &'a SystemAtPoint<'a>,
    /// The input whose dither is designed, counted from 0.
    pub input: usize,
    /// The row over the coordinates, or states, that is observed.
    pub observe: &'a [f64],
    /// The runs that must end quiet.
    pub start: DesignStart,
}

impl SystemPlant<'_> {
    fn wave(&self, system: &System) -> Result<Wave, NoAnswer> {
        let input = system.inputs.get(self.input);
        let wave = input.and_then(|input| input.profile.waves().first());
        wave.cloned().ok_or(NoAnswer::DoesNotAct)
    }

    /// The system at an operating point over the amplitude, read once where the largest amplitude is valid: then all are.
    fn over_amplitude<'s>(
        &'s self,
        at: OperatingPoint<'s>,
        largest: f64,
    ) -> Box<dyn Fn(f64) -> Result<System, RefusedNumbers> + Sync + 's> {
        match (self.at)(at, largest) {
            Ok(system) if largest > 0.0 => {
                Box::new(move |amplitude| Ok(system.with_amplitude(self.input, amplitude)))
            }
            _ => Box::new(move |amplitude| (self.at)(at, amplitude)),
        }
    }

    /// An answer about the point on which the dither acts.
    fn about_point<T>(
        &self,
        at: OperatingPoint<'_>,
        answer: impl Fn(&DrivenPoint<'_>) -> T,
    ) -> Result<T, NoAnswer> {
        let system = (self.at)(at, 1.0)?;
        let sliding = Linearised::new(&system)?;
        let wave = self.wave(&system)?;
        let target = &system.inputs[self.input].target;
        let point =
            DrivenPoint::of_input(&system, &sliding, target, &wave.waveform, wave.frequency)?;
        Ok(answer(&point))
    }

    /// An answer about the runs from the start; `None` where nothing squeals without dither, so that every run is quiet.
    fn about_runs<T>(
        &self,
        at: OperatingPoint<'_>,
        largest: f64,
        answer: impl FnOnce(&VariedRun<'_>) -> Result<T, NoAnswer>,
    ) -> Result<Option<T>, NoAnswer> {
        let over_amplitude = self.over_amplitude(at, largest);
        let system = |values: &[f64]| over_amplitude(values[0]);
        let without = system(&[0.0])?.undithered();
        let state = match self.start {
            DesignStart::Squeal => match squealing_state(&without) {
                Ok(state) => state,
                // Where steady sliding is stable no limit cycle is needed for a design.
                Err(_) if sliding_verdict(&without)? == Verdict::Stable => return Ok(None),
                Err(why) => return Err(NoAnswer::NoSqueal(why)),
            },
            DesignStart::Local | DesignStart::Rest => vec![0.0; without.state_size()],
        };
        let start = |_: f64, _: &System| Ok(state.clone());
        let run = VariedRun { start: &start, ramp: 0.0, at: &system, most_steps: STEPS_OF_A_RUN };
        answer(&run).map(Some)
    }

    /// The amplitudes in a range whose base response is stable and whose run from the start ends in step with the dither, by the judges
    /// of `thresholds`. No run is quiet for good where the base response is unstable.
    fn by_runs(
        &self,
        at: OperatingPoint<'_>,
        range: RealInterval,
    ) -> Result<QuietAmplitudes, NoAnswer> {
        let stable = self.by_multipliers(at, range)?;
        let found = self.about_runs(at, range.upper, |run| {
            let within = TRIED_WITHIN * range.width();
            let each = stable.intervals().iter().map(|interval| in_step(run, *interval, within));
            Ok(each.collect::<Result<Vec<_>, NoAnswer>>()?.concat())
        })?;
        Ok(found.map_or(stable, QuietAmplitudes::of_intervals))
    }

    /// The amplitudes in a range whose base response is stable: the judge of `thresholds`.
    fn by_multipliers(
        &self,
        at: OperatingPoint<'_>,
        range: RealInterval,
    ) -> Result<QuietAmplitudes, NoAnswer> {
        let system = self.over_amplitude(at, range.upper);
        let beyond = RealInterval::new(range.lower, range.upper * BEYOND);
        let found = amplitude_branch(&system, beyond, STEPS)?;
        Ok(found.quiet_within(range))
    }

    /// The base response under an amplitude.
    fn base(system: &System) -> Result<Orbit, NoOrbit> {
        base_response(system, GROWTH_STEPS)
    }
}

/// The amplitudes within an interval of stable base responses whose run ends in step with the dither, tried at steps of at most
/// `within`. At the ends of the interval itself no run settles: the margin of a verified dither away from them it must.
fn in_step(
    run: &VariedRun<'_>,
    RealInterval { lower: low, upper: high }: RealInterval,
    within: f64,
) -> Result<Vec<RealInterval>, NoAnswer> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a count of at most sixteen steps"
    )]
    let steps = (((high - low) / within).ceil() as u32).max(LEAST_TRIED);
    let begin = (low * (1.0 + MARGIN)).max(low + MARGIN * within).min(0.5 * (low + high));
    let end = high - MARGIN * (high - begin) / f64::from(steps);
    let (first, changes) = quiet_changes(run, RealInterval::new(begin, end), steps)?;
    Ok(QuietAmplitudes::of_changes(RealInterval::new(low, high), first, changes)
        .intervals()
        .to_vec())
}

/// Whether the run at the first of some equally spaced amplitudes ends quiet, and the changes: the end that has been seen to be quiet, and
/// whether it becomes so. A run that does not settle is not known to be quiet.
///
/// # Errors
/// Why the outcome of a run is unknown, where none is known to be quiet.
pub(super) fn quiet_changes(
    run: &VariedRun<'_>,
    range: RealInterval,
    steps: u32,
) -> Result<(bool, Vec<(f64, bool)>), NoAnswer> {
    let outcomes: Vec<(f64, RunOutcome)> =
        values_tried(range, steps).map(|value| (value, run.outcome(value))).collect();
    let quiet = |outcome: &RunOutcome| outcome.is_quiet() == Some(true);
    if !outcomes.iter().any(|(_, outcome)| quiet(outcome))
        && let Some((amplitude, RunOutcome::Unknown(why))) =
            outcomes.iter().find(|(_, outcome)| outcome.is_quiet().is_none())
    {
        return Err(NoAnswer::NoOutcomeAt { amplitude: *amplitude, why: why.clone() });
    }
    let changes = outcomes.windows(2).filter(|pair| quiet(&pair[0].1) != quiet(&pair[1].1));
    let changes = changes.map(|pair| {
        let becomes = quiet(&pair[1].1);
        let (mut loud, mut still) =
            if becomes { (pair[0].0, pair[1].0) } else { (pair[1].0, pair[0].0) };
        while (still - loud).abs() > SWITCH_CLOSENESS * still {
            let middle = 0.5 * (loud + still);
            *(if quiet(&run.outcome(middle)) { &mut still } else { &mut loud }) = middle;
        }
        (still, becomes)
    });
    let first = outcomes.first().is_some_and(|(_, outcome)| quiet(outcome));
    Ok((first, changes.collect()))
}

/// The base response of a system over the amplitude of one of its dithers, followed in at least `steps` steps: the judge of
/// `thresholds`.
///
/// # Errors
/// [`NoOrbit`] if there is no base response at the least amplitude.
pub fn amplitude_branch(
    at: &dyn Fn(f64) -> Result<System, RefusedNumbers>,
    range: RealInterval,
    steps: u32,
) -> Result<AmplitudeBranch, NoOrbit> {
    let found =
        branch_thresholds(&|values: &[f64]| at(values[0]), range.lower, range.upper, steps, None)?;
    Ok(AmplitudeBranch::new(range, &found))
}

/// The amplitudes of a dither of a system that are quiet by averaging, in a range.
///
/// # Errors
/// [`AveragingError`].
pub fn averaged_quiet(
    system: &System,
    input: usize,
    range: RealInterval,
) -> Result<QuietAmplitudes, AveragingError> {
    let (quiet_without, changes) = averaged_changes(system, input)?;
    Ok(QuietAmplitudes::by_averaging(range, quiet_without, &changes))
}

/// The first range of amplitudes of a dither that are quiet by averaging: from 0 where sliding is stable without it, and up to the next
/// change, or without bound.
///
/// # Errors
/// Why no amplitude is quiet.
pub fn first_averaged(system: &System, input: usize) -> Result<RealInterval, NoAnswer> {
    let (quiet_without, changes) = averaged_changes(system, input)?;
    QuietAmplitudes::first_by_averaging(quiet_without, &changes)
}

/// Whether a system is quiet without one of its dithers by averaging, and the changes over the amplitude of that dither.
fn averaged_changes(
    system: &System,
    input: usize,
) -> Result<(bool, Vec<AveragedChange>), AveragingError> {
    let prepared = DitheredSystem::new(system)?;
    let without = prepared.average_with(Some((input, 0.0)))?;
    let without = without.growth().map_err(AveragingError::Eigenvalues)?.verdict();
    let changes = prepared.critical_amplitudes(input)?;
    let changes = changes.iter().map(|critical| AveragedChange {
        amplitude: critical.amplitude,
        becomes_quiet: critical.becomes == Becomes::Stable,
        fails: match (critical.contacts_stay_closed, critical.within_laws) {
            (true, true) => None,
            (true, false) => Some(AveragingEnds::BeyondLaw),
            (false, _) => Some(AveragingEnds::Opens),
        },
    });
    Ok((without == Verdict::Stable, changes.collect()))
}

impl Plant for SystemPlant<'_> {
    fn averaged(
        &self,
        at: OperatingPoint<'_>,
        range: RealInterval,
    ) -> Result<QuietAmplitudes, NoAnswer> {
        let system = (self.at)(at, range.upper)?;
        Ok(averaged_quiet(&system, self.input, range)?)
    }

    fn least_averaged(&self, at: OperatingPoint<'_>) -> Result<f64, NoAnswer> {
        let system = (self.at)(at, 1.0)?;
        Ok(first_averaged(&system, self.input)?.lower)
    }

    fn exact(
        &self,
        at: OperatingPoint<'_>,
        range: RealInterval,
    ) -> Result<QuietAmplitudes, NoAnswer> {
        if self.start != DesignStart::Local {
            return self.by_runs(at, range);
        }
        self.by_multipliers(at, range)
    }

    fn verdict(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<ExactVerdict, NoAnswer> {
        let orbit = Self::base(&(self.at)(at, amplitude)?)?;
        let stable = orbit.verdict() == OrbitVerdict::Stable;
        let quiet = match self.start {
            DesignStart::Local => stable,
            DesignStart::Rest | DesignStart::Squeal => {
                let outcome = |run: &VariedRun<'_>| match run.outcome(amplitude) {
                    RunOutcome::Unknown(why) => Err(NoAnswer::NoOutcome(why)),
                    known => Ok(known.is_quiet() == Some(true)),
                };
                stable && self.about_runs(at, amplitude, outcome)?.unwrap_or(true)
            }
        };
        Ok(ExactVerdict { quiet, multiplier: orbit.radius(), growth_rate: None })
    }

    fn price(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<DitherPrice, NoAnswer> {
        let system = (self.at)(at, amplitude)?;
        let sliding = Linearised::new(&system)?;
        let wave = self.wave(&system)?;
        let target = &system.inputs[self.input].target;
        let cost = input_cost(&system, &sliding, target, &wave)?;
        Ok(DitherPrice { stroke: cost.stroke, velocity: cost.velocity, power: cost.power })
    }

    fn averaged_loss(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<f64, NoAnswer> {
        let system = (self.at)(at, amplitude)?;
        let prepared = DitheredSystem::new(&system)?;
        let average = prepared.average()?;
        let means = average.contacts.iter().map(|contact| contact.friction);
        largest_loss(prepared.sliding(), means)
    }

    fn exact_loss(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<f64, NoAnswer> {
        let system = (self.at)(at, amplitude)?;
        let orbit = Self::base(&system)?;
        loss_on(&system, (&orbit.state, orbit.period))
    }

    fn exact_response(
        &self,
        at: OperatingPoint<'_>,
        amplitude: f64,
    ) -> Result<ResponseSize, NoAnswer> {
        let system = (self.at)(at, amplitude)?;
        let orbit = Self::base(&system)?;
        response_on(&system, (&orbit.state, orbit.period), self.observe)
    }

    fn averaged_response(
        &self,
        at: OperatingPoint<'_>,
        amplitude: f64,
    ) -> Result<ResponseSize, NoAnswer> {
        linear_response(&(self.at)(at, amplitude)?, self.input, self.observe)
    }

    fn slowness(&self, at: OperatingPoint<'_>) -> Result<f64, NoAnswer> {
        let system = (self.at)(at, 1.0)?;
        let slowest = system.waves().map(Wave::repetition).fold(f64::INFINITY, f64::min);
        Ok(vibration_frequency(&system).map_or(0.0, |vibration| BAND_END * vibration / slowest))
    }

    fn minimum_normal_load(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<f64, NoAnswer> {
        let system = (self.at)(at, amplitude)?;
        let prepared = DitheredSystem::new(&system)?;
        let average = prepared.average()?;
        let least = average.contacts.iter().map(|found| found.normal_load - found.load_amplitude);
        least.min_by(f64::total_cmp).ok_or(NoAnswer::NoContact)
    }

    fn demand(
        &self,
        at: OperatingPoint<'_>,
        actuator: &Actuator,
    ) -> Result<ActuatorDemand, NoAnswer> {
        Ok(self.about_point(at, |point| actuator.demand(point))??)
    }

    #[expect(
        clippy::redundant_closure_for_method_calls,
        reason = "the method itself is of a point of one lifetime"
    )]
    fn slip_amplitudes(&self, at: OperatingPoint<'_>) -> Result<Vec<f64>, NoAnswer> {
        self.about_point(at, |point| point.slip_amplitudes())
    }
}
