//! The least dither that is quiet over a whole box of operating points, under limits.
//!
//! For every choice of the other design variables (a frequency, say) the least amplitude that is quiet in the whole box is sought
//! (`worst_point`), first by averaging and finite-R closed forms, which is cheap. Over the other variables the search is global: a grid,
//! then a pattern search from the best of its local minima, because resonances make the objective multimodal (`search`). The exact
//! thresholds are then computed only at the points of the box that decide, and followed where a limit binds (`exact`). The answer is
//! verified by exact periodic responses at points of the box (`verified`). What the structure is stays behind [`Plant`]. A structure whose
//! loud points form narrow tongues names the points that a grid would miss, and searches between points before an answer is accepted.

mod between_points;
mod branch;
mod confident;
mod covered;
mod covered_box;
mod disc;
mod exact;
mod exact_box;
mod no_design;
mod quiet;
mod response;
mod scaled;
mod schedule;
mod search;
mod sensitivity;
mod served_part;
mod system;
mod verified;
mod worst_point;

pub use branch::{AmplitudeBranch, QuietChange};
pub use confident::{LeastOfSample, LeastQuantile, SampledLeast, SampledQuiet};
pub use covered::{NoCoveredBox, covered};
pub use covered_box::{BeyondCovered, CoveredBox};
pub use disc::{DiscAtPoint, DiscPlant};
pub use exact::{Designed, FeasibleDesign, InfeasibleDesign, design};
pub use no_design::NoDesign;
pub use quiet::QuietAmplitudes;
pub use response::ResponseSize;
pub use scaled::ScaledPlant;
pub use schedule::ScheduledDither;
pub use search::{DesignBasin, DesignPoint};
pub use sensitivity::{
    LeastAmplitude, LeastAmplitudeSensitivity, NoLeastSensitivity, SystemOfNumbers,
};
pub use system::{SystemAtPoint, SystemPlant, amplitude_branch, averaged_quiet, first_averaged};
pub use verified::VerifiedPoint;
pub use worst_point::NoLeast;

use crate::NoAnswer;
use crate::actuator::{Actuator, ActuatorDemand, ActuatorLimit};
use crate::tasks::Tasks;
use quell_numerics::interval::RealInterval;

/// Share of the least amplitude by which the verified dither exceeds it, where the range of amplitudes does not end before.
pub const MARGIN: f64 = 1e-3;

/// Share of a limit up to which it is kept: the search along a limit ends within this of it.
pub const KEPT: f64 = 1.0 + 1e-6;

/// What is to be small.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DesignObjective {
    /// The amplitude of the dither.
    Amplitude,
    /// The peak-to-peak stroke of the linear response without friction.
    Stroke,
    /// The largest velocity of that response.
    Velocity,
    /// The mean power that the dither brings into that response.
    Power,
    /// The share of the mean friction that is lost, at the operating point where it is largest.
    FrictionLoss,
}

impl DesignObjective {
    /// Every objective.
    pub const ALL: [Self; 5] =
        [Self::Amplitude, Self::Stroke, Self::Velocity, Self::Power, Self::FrictionLoss];

    /// Name in a study.
    pub fn name(self) -> &'static str {
        match self {
            Self::Amplitude => "amplitude",
            Self::Stroke => "stroke",
            Self::Velocity => "velocity",
            Self::Power => "power",
            Self::FrictionLoss => "friction-loss",
        }
    }
}

/// A quantity with a limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LimitedQuantity {
    /// Amplitude of the dither, at most.
    Amplitude,
    /// Peak-to-peak stroke of the linear response without friction, at most.
    Stroke,
    /// Largest velocity of that response, at most.
    Velocity,
    /// Mean power of that response, at most.
    Power,
    /// Share of the mean friction that is lost at the worst operating point, at most; of several contacts the largest.
    FrictionLoss,
    /// Smallest normal load of a contact under normal dither, at least.
    MinimumNormalLoad,
    /// Root mean square of the response that is observed, about its mean, at the worst operating point, at most.
    ResponseRms,
    /// Half of the range of that response, at most.
    ResponsePeak,
    /// A limit of the actuator: its share that is used, at most 1.
    Actuator(ActuatorLimit),
    /// The upper end of the band of the vibration, over the frequency at which the dither repeats: a dither in the band vibrates slowly
    /// itself.
    Band,
}

impl LimitedQuantity {
    /// Every quantity of `[design.limits]`.
    pub const ALL: [Self; 8] = [
        Self::Amplitude,
        Self::Stroke,
        Self::Velocity,
        Self::Power,
        Self::FrictionLoss,
        Self::MinimumNormalLoad,
        Self::ResponseRms,
        Self::ResponsePeak,
    ];

    /// Name in a study.
    pub fn name(self) -> &'static str {
        match self {
            Self::Amplitude => "amplitude",
            Self::Stroke => "stroke",
            Self::Velocity => "velocity",
            Self::Power => "power",
            Self::FrictionLoss => "friction_loss",
            Self::MinimumNormalLoad => "minimum_normal_load",
            Self::ResponseRms => "response_rms",
            Self::ResponsePeak => "response_peak",
            Self::Actuator(limit) => limit.path(),
            Self::Band => "band",
        }
    }

    /// Whether it limits what only exact responses decide: their size, or the friction that is lost on them.
    pub(crate) fn is_of_exact_response(self) -> bool {
        self == Self::FrictionLoss || self.of_response().is_some()
    }

    /// The size of a response that it limits; `None` for other quantities.
    pub(crate) fn of_response(self) -> Option<fn(ResponseSize) -> f64> {
        match self {
            Self::ResponseRms => Some(|size| size.rms),
            Self::ResponsePeak => Some(|size| size.peak),
            _ => None,
        }
    }
}

/// The runs that must end quiet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DesignStart {
    /// Those near the base response: its multipliers decide.
    Local,
    /// A run from rest.
    Rest,
    /// A run from the limit cycle without dither.
    Squeal,
}

impl DesignStart {
    /// Every start.
    pub const ALL: [Self; 3] = [Self::Local, Self::Rest, Self::Squeal];

    /// Name in a study.
    pub fn name(self) -> &'static str {
        match self {
            Self::Local => "local",
            Self::Rest => "rest",
            Self::Squeal => "squeal",
        }
    }
}

/// A point of the box and the design variables other than the amplitude.
#[derive(Clone, Copy, Debug)]
pub struct OperatingPoint<'a> {
    /// Coordinates in the box of operating points.
    pub point: &'a [f64],
    /// Values of the other design variables.
    pub others: &'a [f64],
}

/// What a dither costs the linear structure without friction, in numbers of the equations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DitherPrice {
    /// Peak-to-peak displacement.
    pub stroke: f64,
    /// Largest velocity.
    pub velocity: f64,
    /// Mean power.
    pub power: f64,
}

/// An exact answer about one dither at one operating point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExactVerdict {
    /// Whether the run of the design's start is quiet.
    pub quiet: bool,
    /// Modulus of the deciding multiplier of the base response.
    pub multiplier: f64,
    /// Its growth rate, where small motions have exponents.
    pub growth_rate: Option<f64>,
}

/// A structure under a dither that is to be designed: it answers about one operating point.
pub trait Plant {
    /// The amplitudes in a range that are quiet by averaging at a finite frequency ratio.
    ///
    /// # Errors
    /// Why there is no answer.
    fn averaged(
        &self,
        at: OperatingPoint<'_>,
        range: RealInterval,
    ) -> Result<QuietAmplitudes, NoAnswer>;

    /// The least amplitude that is quiet by averaging at a finite frequency ratio.
    ///
    /// # Errors
    /// Why no amplitude is, or why there is no answer.
    fn least_averaged(&self, at: OperatingPoint<'_>) -> Result<f64, NoAnswer>;

    /// The amplitudes in a range that are quiet by exact thresholds.
    ///
    /// # Errors
    /// Why there is no answer.
    fn exact(
        &self,
        at: OperatingPoint<'_>,
        range: RealInterval,
    ) -> Result<QuietAmplitudes, NoAnswer>;

    /// The exact verdict about one amplitude.
    ///
    /// # Errors
    /// Why it is unknown.
    fn verdict(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<ExactVerdict, NoAnswer>;

    /// The response of the linear structure without friction.
    ///
    /// # Errors
    /// Why it is unknown.
    fn price(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<DitherPrice, NoAnswer>;

    /// The share of the mean friction that is lost by averaging.
    ///
    /// # Errors
    /// Why it is unknown.
    fn averaged_loss(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<f64, NoAnswer>;

    /// The share of the mean friction that is lost on the exact base response.
    ///
    /// # Errors
    /// Why it is unknown.
    fn exact_loss(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<f64, NoAnswer>;

    /// The size of the observed response on the exact base response.
    ///
    /// # Errors
    /// Why it is unknown.
    fn exact_response(
        &self,
        at: OperatingPoint<'_>,
        amplitude: f64,
    ) -> Result<ResponseSize, NoAnswer> {
        let _ = (at, amplitude);
        Err(NoAnswer::NothingObserved)
    }

    /// An estimate of the same without trajectories.
    ///
    /// # Errors
    /// Why it is unknown.
    fn averaged_response(
        &self,
        at: OperatingPoint<'_>,
        amplitude: f64,
    ) -> Result<ResponseSize, NoAnswer> {
        self.exact_response(at, amplitude)
    }

    /// The upper end of the band of slow vibration over the frequency at which the dither repeats: 1 or more where it is in the band, 0
    /// where no frequency of a dither is too slow.
    ///
    /// # Errors
    /// Why it is unknown.
    fn slowness(&self, at: OperatingPoint<'_>) -> Result<f64, NoAnswer>;

    /// The smallest normal load under the dither.
    ///
    /// # Errors
    /// Why it is unknown.
    fn minimum_normal_load(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<f64, NoAnswer>;

    /// What a dither of unit amplitude demands of an actuator.
    ///
    /// # Errors
    /// Why it is unknown.
    fn demand(
        &self,
        at: OperatingPoint<'_>,
        actuator: &Actuator,
    ) -> Result<ActuatorDemand, NoAnswer>;

    /// The largest fast slip velocity of every contact under a dither of unit amplitude.
    ///
    /// # Errors
    /// Why it is unknown.
    fn slip_amplitudes(&self, at: OperatingPoint<'_>) -> Result<Vec<f64>, NoAnswer>;

    /// Points of the box that a grid may miss and that may be loud at an amplitude up to the largest one.
    ///
    /// # Errors
    /// Why they are unknown.
    fn special_points(
        &self,
        ranges: &[RealInterval],
        others: &[f64],
        largest: f64,
    ) -> Result<Vec<Vec<f64>>, NoAnswer> {
        let _ = (ranges, others, largest);
        Ok(Vec::new())
    }

    /// Points of the box at which an amplitude is loud, by a search that follows the verdict between points.
    ///
    /// # Errors
    /// Why they are unknown.
    fn loud_points(
        &self,
        ranges: &[RealInterval],
        others: &[f64],
        amplitude: f64,
    ) -> Result<Vec<Vec<f64>>, NoAnswer> {
        let _ = (ranges, others, amplitude);
        Ok(Vec::new())
    }
}

/// A design question about one waveform, in numbers of the equations.
#[derive(Clone, Copy)]
pub struct DesignProblem<'a> {
    /// The structure.
    pub plant: &'a (dyn Plant + Sync),
    /// What is to be small.
    pub objective: DesignObjective,
    /// Smallest and largest amplitude.
    pub amplitude: RealInterval,
    /// Ranges of the other design variables.
    pub others: &'a [RealInterval],
    /// The box of operating points.
    pub over: &'a [RealInterval],
    /// Limits.
    pub limits: &'a [(LimitedQuantity, f64)],
    /// The actuator, whose limits are among them.
    pub actuator: Option<&'a Actuator>,
    /// The runs that must end quiet.
    pub start: DesignStart,
    /// Who runs what is independent of one another: choices of the design variables, and operating points.
    pub tasks: &'a dyn Tasks,
}

impl DesignProblem<'_> {
    /// The largest amplitude that the range and the limits on the amplitude allow.
    fn largest_amplitude(&self) -> f64 {
        let limits =
            self.limits.iter().filter(|(quantity, _)| *quantity == LimitedQuantity::Amplitude);
        limits.fold(self.amplitude.upper, |largest, (_, limit)| largest.min(*limit))
    }

    /// The amplitude at which a least one is verified: [`MARGIN`] above it, but not above the largest that is allowed.
    pub(super) fn verified_amplitude(&self, least: f64) -> f64 {
        (least * (1.0 + MARGIN)).min(self.largest_amplitude().max(least))
    }
}
