//! Any linear structure with friction contacts as one whose dither is designed.

use quell_dynamics::motion::orbit::{MotionOrbit, NoMotionOrbit, base_motion, motion_thresholds};
use quell_dynamics::orbit::OrbitVerdict;
use quell_linear::averaging::{Becomes, DitheredSystem, NoAverage};
use quell_linear::driven_point::DrivenPoint;
use quell_linear::growth::Verdict;
use quell_linear::input_cost::input_cost;
use quell_linear::linearised::Linearised;
use quell_model::System;
use quell_model::profile::Wave;

use super::branch::AmplitudeBranch;
use super::quiet::AveragedChange;
use super::response::{ResponseSize, largest_loss, linear_response, loss_on, response_on};
use super::{DitherPrice, ExactVerdict, OperatingPoint, Plant, QuietAmplitudes};
use crate::actuator::{Actuator, ActuatorDemand};

/// Steps of the continuation over a range of amplitudes.
const STEPS: u32 = 8;

/// Steps by which the dither grows from zero to a verified base response.
const GROWTH_STEPS: u32 = 8;

/// A system at an operating point with an amplitude of the dither that is designed, or why it is no valid system.
pub type SystemAtPoint<'a> = dyn Fn(OperatingPoint<'_>, f64) -> Result<System, String> + Sync + 'a;

/// A system one of whose dithers is designed, judged by small motions: averaged sliding, then the multipliers of the base response.
#[derive(Clone, Copy)]
pub struct SystemPlant<'a> {
    /// The system at an operating point with an amplitude.
    pub at: &'a SystemAtPoint<'a>,
    /// The input whose dither is designed, counted from 0.
    pub input: usize,
    /// The row over the coordinates, or states, that is observed.
    pub observe: &'a [f64],
}

fn in_words(why: impl std::fmt::Display) -> String {
    why.to_string()
}

impl SystemPlant<'_> {
    fn wave(&self, system: &System) -> Result<Wave, String> {
        let input = system.inputs.get(self.input);
        let wave = input.and_then(|input| input.profile.waves().first());
        wave.cloned().ok_or_else(|| "the dither that is designed does not act".to_owned())
    }

    /// An answer about the point on which the dither acts.
    fn about_point<T>(
        &self,
        at: OperatingPoint<'_>,
        answer: impl Fn(&DrivenPoint<'_>) -> T,
    ) -> Result<T, String> {
        let system = (self.at)(at, 1.0)?;
        let sliding = Linearised::new(&system).map_err(in_words)?;
        let wave = self.wave(&system)?;
        let target = &system.inputs[self.input].target;
        let point =
            DrivenPoint::of_input(&system, &sliding, target, &wave.waveform, wave.frequency)
                .map_err(in_words)?;
        Ok(answer(&point))
    }

    /// The base response under an amplitude.
    fn base(system: &System) -> Result<MotionOrbit, String> {
        base_motion(system, GROWTH_STEPS).map_err(in_words)
    }
}

/// The base response of a system over the amplitude of one of its dithers, followed in at least `steps` steps: the judge of
/// `thresholds`.
///
/// # Errors
/// [`NoMotionOrbit`] if there is no base response at the least amplitude.
pub fn amplitude_branch_of_system(
    at: &dyn Fn(f64) -> Result<System, String>,
    range: (f64, f64),
    steps: u32,
) -> Result<AmplitudeBranch, NoMotionOrbit> {
    let found = motion_thresholds(&|values: &[f64]| at(values[0]), range, steps, None)?;
    Ok(AmplitudeBranch::of_motion(range, &found))
}

/// The amplitudes of a dither of a system that are quiet by averaging, in a range.
///
/// # Errors
/// [`NoAverage`].
pub fn averaged_quiet_of_system(
    system: &System,
    input: usize,
    range: (f64, f64),
) -> Result<QuietAmplitudes, NoAverage> {
    let prepared = DitheredSystem::new(system)?;
    let without = prepared.average_with(Some((input, 0.0)))?;
    let without = without.growth().map_err(NoAverage::Eigenvalues)?.verdict();
    let changes: Vec<_> = prepared
        .critical_amplitudes(input)?
        .iter()
        .map(|critical| AveragedChange {
            amplitude: critical.amplitude,
            becomes_quiet: critical.becomes == Becomes::Stable,
            holds: critical.contacts_stay_closed && critical.within_laws,
        })
        .collect();
    Ok(QuietAmplitudes::by_averaging(range, without == Verdict::Stable, &changes))
}

impl Plant for SystemPlant<'_> {
    fn averaged(
        &self,
        at: OperatingPoint<'_>,
        range: (f64, f64),
    ) -> Result<QuietAmplitudes, String> {
        let system = (self.at)(at, range.1)?;
        averaged_quiet_of_system(&system, self.input, range).map_err(in_words)
    }

    fn least_averaged(&self, at: OperatingPoint<'_>) -> Result<Option<f64>, String> {
        let system = (self.at)(at, 1.0)?;
        let every = averaged_quiet_of_system(&system, self.input, (0.0, f64::INFINITY));
        Ok(every.map_err(in_words)?.least_from(0.0))
    }

    fn exact(&self, at: OperatingPoint<'_>, range: (f64, f64)) -> Result<QuietAmplitudes, String> {
        let found = amplitude_branch_of_system(&|value| (self.at)(at, value), range, STEPS);
        Ok(found.map_err(in_words)?.quiet())
    }

    fn verdict(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<ExactVerdict, String> {
        let orbit = Self::base(&(self.at)(at, amplitude)?)?;
        Ok(ExactVerdict {
            quiet: orbit.verdict() == OrbitVerdict::Stable,
            multiplier: orbit.radius(),
            growth_rate: None,
        })
    }

    fn price(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<DitherPrice, String> {
        let system = (self.at)(at, amplitude)?;
        let sliding = Linearised::new(&system).map_err(in_words)?;
        let wave = self.wave(&system)?;
        let target = &system.inputs[self.input].target;
        let cost = input_cost(&system, &sliding, target, &wave).map_err(in_words)?;
        Ok(DitherPrice { stroke: cost.stroke, velocity: cost.velocity, power: cost.power })
    }

    fn averaged_loss(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<f64, String> {
        let system = (self.at)(at, amplitude)?;
        let prepared = DitheredSystem::new(&system).map_err(in_words)?;
        let average = prepared.average().map_err(in_words)?;
        let means = average.contacts.iter().map(|contact| contact.friction);
        largest_loss(prepared.sliding(), means)
    }

    fn exact_loss(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<f64, String> {
        let system = (self.at)(at, amplitude)?;
        let orbit = Self::base(&system)?;
        loss_on(&system, (&orbit.state, orbit.period))
    }

    fn exact_response(
        &self,
        at: OperatingPoint<'_>,
        amplitude: f64,
    ) -> Result<ResponseSize, String> {
        let system = (self.at)(at, amplitude)?;
        let orbit = Self::base(&system)?;
        response_on(&system, (&orbit.state, orbit.period), self.observe)
    }

    fn averaged_response(
        &self,
        at: OperatingPoint<'_>,
        amplitude: f64,
    ) -> Result<ResponseSize, String> {
        linear_response(&(self.at)(at, amplitude)?, self.input, self.observe)
    }

    fn minimum_normal_load(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<f64, String> {
        let system = (self.at)(at, amplitude)?;
        let prepared = DitheredSystem::new(&system).map_err(in_words)?;
        let average = prepared.average().map_err(in_words)?;
        let least = average.contacts.iter().map(|found| found.normal_load - found.load_amplitude);
        least.min_by(f64::total_cmp).ok_or_else(|| "the system has no contact".to_owned())
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
