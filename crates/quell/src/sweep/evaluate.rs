//! Computation of the points of a map, a whole chunk at a time.
//!
//! This is the only place that calls the engines for a map. Steady responses are computed for the
//! whole chunk in one batch; the result of a point still depends on its own study alone.

use quell_dynamics::motion::InputCost;
use quell_dynamics::orbit::OrbitVerdict;
use quell_dynamics::response::{
    Effect, ResponseCase, RunEnding, SettledRecord, Undefined, compare_many, effect,
};
use quell_dynamics::simulation::{Start, within};
use quell_dynamics::start::InitialState;
use quell_linear::averaging::{
    Averaging, AveragingError, Criterion, CriticalAmplitude, CriticalInput, criterion,
    critical_amplitudes,
};
use quell_linear::growth::Growth;
use quell_model::{Belt, Direction};

use super::quench::{QuenchNumbers, quench_numbers};
use super::status::Status;
use crate::complaint::Failure;
use crate::contact_state::differs_from_rigid;
use crate::effort::STEPS_OF_A_SEARCH;
use crate::range;
use crate::run::belt_system;
use crate::run::response::{self, ResponseRequest};
use crate::study::BeltStudy;

/// A computation that several quantities share.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Computation {
    /// The steady response with and without dither.
    Response,
    /// The steady response with the power and the stroke of the dither.
    ResponseWithCost,
    /// The steady response with the effect of the dither: where runs end with and without it.
    ResponseWithEffect,
    /// The criterion of stability by finite-R averaging.
    Criterion,
    /// The criterion in the limit of high frequency.
    LimitCriterion,
    /// Every critical amplitude of the first dither by finite-R averaging.
    CriticalAmplitudes,
    /// Those in the limit of high frequency.
    LimitCriticalAmplitudes,
    /// The exact quench amplitude of the first dither.
    Quench,
    /// The largest growth rate of a disc.
    DiscGrowth,
    /// The largest growth rate of a disc without dither.
    DiscGrowthUndithered,
    /// The largest growth rate of a system, by averaging under dither.
    SystemGrowth,
    /// The largest growth rate of a system without dither.
    SystemGrowthUndithered,
    /// Every critical amplitude of the first dither of a system.
    SystemCritical,
    /// The exact quench amplitude of the first dither of a system.
    SystemQuench,
    /// The base response of a dithered system and its multipliers.
    SystemOrbit,
    /// The motion on which the run of a system ends.
    SystemEnd,
    /// The steady response of a system with and without dither.
    SystemResponse,
}

impl Computation {
    /// Whether it applies to a belt or a system, whose friction laws may have a range.
    pub fn meets_friction(self) -> bool {
        !matches!(
            self,
            Self::DiscGrowth
                | Self::DiscGrowthUndithered
                | Self::SystemQuench
                | Self::SystemOrbit
                | Self::SystemEnd
        )
    }

    /// Whether it averages over the dither, or needs none, so that the dither may be noise.
    pub fn is_average(self) -> bool {
        matches!(
            self,
            Self::Criterion
                | Self::LimitCriterion
                | Self::CriticalAmplitudes
                | Self::LimitCriticalAmplitudes
                | Self::SystemGrowth
                | Self::SystemGrowthUndithered
                | Self::SystemCritical
        )
    }

    /// Whether it averages a friction law without the state of its contact.
    pub fn is_without_state(self) -> bool {
        self.is_average() && self != Self::SystemGrowthUndithered
    }

    /// Whether it integrates responses.
    pub fn is_response(self) -> bool {
        matches!(self, Self::Response | Self::ResponseWithCost | Self::ResponseWithEffect)
    }
}

/// The numbers of a steady response that a map can show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResponseNumbers {
    /// E = M₁/M₀ (2.27), dimensionless.
    pub residual_vibration: Result<f64, Undefined>,
    /// M, the largest spectral amplitude with 0 < ω ≤ 1.9: a length.
    pub amplitude: f64,
    /// M of the undithered run: a length.
    pub undithered_amplitude: f64,
    /// Whether both runs settled, as far as E requires.
    pub settled: bool,
    /// Largest slip speed of both records and of the first slow period.
    pub largest_slip: f64,
    /// What is measured over a period of the motion, if it is requested.
    pub means: Option<ResponseMeans>,
}

/// Means over a period of a steady response, and what the dither costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResponseMeans {
    /// Fraction of the time spent sticking; bristles never stick.
    pub stick_fraction: Result<f64, Status>,
    /// Mean friction force over k: a length.
    pub friction: f64,
    /// Mean power of tangential dither over kω₀, a length squared, and the peak-to-peak displacement of its point.
    pub dither: Result<(f64, f64), Status>,
    /// Smallest normal load over k: a length.
    pub least_load: f64,
}

/// What a map shows of one system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SystemPoint {
    /// Largest growth rate.
    pub growth: Growth,
    /// Largest fast slip velocity over the velocity of its surface, over all contacts.
    pub slip_ratio: f64,
    /// Whether the fast motion opens a contact.
    pub opens: bool,
    /// Whether slip leaves the range of a friction law.
    pub beyond_range: bool,
    /// Whether the average is that of a law without the state of its contact, which differs.
    pub without_state: bool,
}

impl SystemPoint {
    fn qualification(&self) -> Status {
        if self.opens {
            Status::Opens
        } else if self.beyond_range {
            Status::BeyondRange
        } else if self.without_state {
            Status::WithoutState
        } else {
            Status::Known
        }
    }
}

/// What a map shows of the base response of one system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SystemOrbitPoint {
    /// Modulus of the deciding multiplier.
    pub radius: f64,
    /// The verdict of the multipliers.
    pub verdict: OrbitVerdict,
}

/// What a map shows of the motion on which the run of one system ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SystemEndPoint {
    /// Its kind, in the order of the words of bifurcation diagrams.
    pub kind: u8,
    /// Peak-to-peak of the observed displacement.
    pub peak_to_peak: f64,
    /// Largest share of the time that a contact sticks; bristles never stick.
    pub stick_fraction: Result<f64, Status>,
}

/// What a map shows of the steady response of one system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SystemResponsePoint {
    /// Residual vibration E.
    pub residual_vibration: Result<f64, Undefined>,
    /// The effect of the dither.
    pub effect: Effect,
    /// Spectral amplitude of the slow vibration.
    pub amplitude: f64,
    /// The same without dither.
    pub undithered_amplitude: f64,
    /// Whether slip leaves the range of a friction law.
    pub beyond_range: bool,
}

/// Results at one point; `None` for computations that were not requested.
#[derive(Clone, Debug, Default)]
pub struct Results {
    /// The steady response.
    pub steady: Option<Result<ResponseNumbers, Status>>,
    /// The effect of the dither.
    pub effect: Option<Result<Effect, Status>>,
    /// The criterion of stability by finite-R averaging.
    pub criterion: Option<Result<Criterion, Status>>,
    /// The criterion in the limit of high frequency.
    pub limit_criterion: Option<Result<Criterion, Status>>,
    /// Every critical amplitude of the first dither by finite-R averaging, in order.
    pub critical_amplitudes: Option<Result<Vec<CriticalAmplitude>, Status>>,
    /// Those in the limit of high frequency.
    pub limit_critical_amplitudes: Option<Result<Vec<CriticalAmplitude>, Status>>,
    /// The exact quench amplitude of the first dither of a belt or a system.
    pub quench: Option<Result<QuenchNumbers, Status>>,
    /// The largest growth rate of a disc.
    pub disc: Option<Result<Growth, Status>>,
    /// The largest growth rate of a disc without dither.
    pub disc_undithered: Option<Result<Growth, Status>>,
    /// The largest growth rate of a system.
    pub system: Option<Result<SystemPoint, Status>>,
    /// The largest growth rate of a system without dither.
    pub system_undithered: Option<Result<SystemPoint, Status>>,
    /// Every critical amplitude of the first dither of a system, in order, and whether the state of a contact matters there.
    pub system_critical: Option<Result<Vec<(CriticalInput, bool)>, Status>>,
    /// The base response of a dithered system.
    pub system_orbit: Option<Result<SystemOrbitPoint, Status>>,
    /// The motion on which the run of a system ends.
    pub system_end: Option<Result<SystemEndPoint, Status>>,
    /// The steady response of a system.
    pub system_response: Option<Result<SystemResponsePoint, Status>>,
    /// The range of the friction law and the slip that averages reach, if the law has a range.
    pub reach: Option<Reach>,
    /// A belt whose contact has a state, which averages do not know.
    pub with_state: Option<Box<Belt>>,
}

/// The upper end of the range of a law, and the belt whose averages may leave it.
#[derive(Clone, Debug, PartialEq)]
pub struct Reach {
    /// End of the law's range.
    upper: f64,
    /// The belt.
    belt: Box<Belt>,
}

impl Reach {
    fn of(belt: &Belt) -> Option<Self> {
        let upper = belt.friction().range()?.upper;
        Some(Self { upper, belt: Box::new(belt.clone()) })
    }

    /// Whether averages leave the range.
    fn is_left(&self) -> bool {
        range::with_dither(&self.belt, self.belt.belt_velocity()) > self.upper
    }

    /// Whether averages leave the range with this amplitude of the first dither.
    fn is_left_at(&self, amplitude: f64) -> bool {
        range::at_amplitude(&self.belt, amplitude) > self.upper
    }

    /// The same with this α.
    fn is_left_at_ratio(&self, ratio: f64) -> bool {
        let first = self.belt.dithers().first();
        self.is_left_at(ratio * first.map_or(1.0, |dither| dither.frequency_ratio))
    }
}

impl Results {
    /// The status of a known `value`: whether slip leaves the range of a friction law, or a contact opens, in its computation.
    pub(super) fn qualification(&self, computation: Computation, value: f64) -> Status {
        let of = |point: Option<Result<SystemPoint, Status>>| {
            point.and_then(Result::ok).map_or(Status::Known, |point| point.qualification())
        };
        match computation {
            Computation::SystemGrowth => of(self.system),
            Computation::SystemGrowthUndithered => of(self.system_undithered),
            Computation::SystemResponse
                if self
                    .system_response
                    .is_some_and(|found| found.is_ok_and(|at| at.beyond_range)) =>
            {
                Status::BeyondRange
            }
            Computation::SystemCritical => {
                let found = self.system_critical.iter().flatten().flatten();
                let mut found = found.filter(|(critical, _)| critical.amplitude == value);
                found.next().map_or(Status::Known, |(critical, without_state)| {
                    let (opens, beyond) = (!critical.contacts_stay_closed, !critical.within_laws);
                    match (opens, beyond, without_state) {
                        (true, ..) => Status::Opens,
                        (_, true, _) => Status::BeyondRange,
                        (.., true) => Status::WithoutState,
                        _ => Status::Known,
                    }
                })
            }
            _ if self.leaves_range(computation, value) => Status::BeyondRange,
            _ if self.is_without_state(computation, value) => Status::WithoutState,
            _ => Status::Known,
        }
    }

    /// Whether `value` averages the law of a belt without the state of its contact, and differs from the average with it.
    fn is_without_state(&self, computation: Computation, value: f64) -> bool {
        let Some(belt) = &self.with_state else { return false };
        match computation {
            Computation::Criterion | Computation::LimitCriterion => differs_from_rigid(belt),
            // An amplitude ratio of the first dither.
            Computation::CriticalAmplitudes | Computation::LimitCriticalAmplitudes => {
                belt.dithers().first().is_some_and(|dither| {
                    let acting = belt.with_amplitude(0, value * dither.frequency_ratio);
                    differs_from_rigid(acting.as_ref().unwrap_or(belt))
                })
            }
            _ => false,
        }
    }

    /// Whether slip leaves the range of the friction law of a belt in the computation of `value`.
    fn leaves_range(&self, computation: Computation, value: f64) -> bool {
        let Some(reach) = &self.reach else { return false };
        match computation {
            Computation::Response
            | Computation::ResponseWithCost
            | Computation::ResponseWithEffect => {
                let met = |steady: ResponseNumbers| steady.largest_slip > reach.upper;
                self.steady.is_some_and(|steady| steady.is_ok_and(met))
            }
            Computation::Criterion | Computation::LimitCriterion => reach.is_left(),
            // An amplitude ratio of the first dither.
            Computation::CriticalAmplitudes | Computation::LimitCriticalAmplitudes => {
                reach.is_left_at_ratio(value)
            }
            Computation::Quench => {
                let least = self.quench.and_then(|found| found.ok()?.least.ok());
                least.is_some_and(|least| reach.is_left_at(least))
            }
            Computation::DiscGrowth
            | Computation::DiscGrowthUndithered
            | Computation::SystemGrowth
            | Computation::SystemGrowthUndithered
            | Computation::SystemCritical
            | Computation::SystemQuench
            | Computation::SystemOrbit
            | Computation::SystemEnd
            | Computation::SystemResponse => false,
        }
    }
}

/// Computes at every point of a chunk.
pub(super) fn evaluate(points: &[BeltStudy], wanted: &[Computation]) -> Vec<Results> {
    let mut results: Vec<Results> = points.iter().map(|study| averages(study, wanted)).collect();
    if wanted.iter().any(|computation| computation.is_response()) {
        let has_state = |study: &BeltStudy| study.belt().has_contact_state();
        let found =
            if wanted.contains(&Computation::ResponseWithCost) || points.iter().any(has_state) {
                points.iter().map(alone).collect()
            } else {
                responses(points, wanted.contains(&Computation::ResponseWithEffect))
            };
        for (result, outcome) in results.iter_mut().zip(found) {
            result.steady = Some(outcome.map(|(steady, _)| steady));
            result.effect = Some(outcome.and_then(|(_, effect)| effect.ok_or(Status::Missing)));
        }
    }
    results
}

/// A steady response, and the effect of the dither if requested.
type Responded = (ResponseNumbers, Option<Effect>);

/// The steady response of a belt as `response` measures it, in the numbers of the equations.
fn alone(study: &BeltStudy) -> Result<Responded, Status> {
    let squeals = study.initial() == InitialState::Squealing;
    let system = belt_system::dimensionless(study);
    let found = response::run(&system, ResponseRequest::default()).map_err(|why| match why {
        Failure::Wrong(_) if squeals => Status::NoSquealingStart,
        Failure::Wrong(_) => Status::InvalidStudy,
        Failure::Failed { .. } => Status::Stalled,
    })?;
    let response = &found.response;
    let numbers = ResponseNumbers {
        residual_vibration: response.residual_vibration,
        amplitude: response.dithered.lines.whole,
        undithered_amplitude: response.undithered.lines.whole,
        settled: found.settled()
            && (found.undithered_settled() || response.residual_vibration.is_err()),
        largest_slip: response.largest_slip(0),
        means: means(study.belt(), &response.dithered),
    };
    Ok((numbers, Some(response.effect)))
}

/// What is measured over a period of a belt's response.
fn means(belt: &Belt, record: &SettledRecord) -> Option<ResponseMeans> {
    let contact = record.contacts.first()?;
    let sticks = belt.friction().bristles().is_none();
    let inputs = record.inputs.iter().zip(belt.dithers());
    let tangential = inputs.filter(|(_, dither)| dither.direction == Direction::Tangential);
    let costs: Vec<&InputCost> = tangential.filter_map(|(cost, _)| cost.as_ref().ok()).collect();
    let power = costs.iter().map(|cost| cost.power).sum();
    Some(ResponseMeans {
        stick_fraction: if sticks { Ok(contact.stick_fraction) } else { Err(Status::NeverSticks) },
        friction: contact.friction,
        dither: costs.first().map(|cost| (power, cost.stroke)).ok_or(Status::OnlyNormalDither),
        least_load: contact.least_load,
    })
}

/// The steady responses, in one batch if the points share their solver settings.
fn responses(points: &[BeltStudy], with_effect: bool) -> Vec<Result<Responded, Status>> {
    let starts: Vec<Result<Start, Status>> = points
        .iter()
        .map(|study| Ok(within(STEPS_OF_A_SEARCH, || study.initial().resolve(study.belt()))?))
        .collect();
    let mut outcomes: Vec<Result<Responded, Status>> =
        starts.iter().map(|start| Err(start.err().unwrap_or(Status::Stalled))).collect();
    let mut rest: Vec<usize> = (0..points.len()).filter(|&at| starts[at].is_ok()).collect();
    while let Some(&first) = rest.first() {
        let solver = *points[first].solver();
        let (alike, others): (Vec<usize>, Vec<usize>) =
            rest.into_iter().partition(|&at| *points[at].solver() == solver);
        rest = others;
        let cases: Vec<ResponseCase> = alike
            .iter()
            .filter_map(|&at| {
                Some(ResponseCase { belt: points[at].belt().clone(), start: starts[at].ok()? })
            })
            .collect();
        let firsts: Vec<(&Belt, Start)> =
            cases.iter().map(|case| (&case.belt, case.start)).collect();
        let firsts = range::of_starts(&firsts, range::OF_START);
        let compared = compare_many(&cases, &solver).into_iter().zip(firsts);
        for (&at, (compared, first)) in alike.iter().zip(compared) {
            outcomes[at] = compared.map_err(|_| Status::Stalled).and_then(|compared| {
                let start = starts[at]?;
                let belt = points[at].belt();
                let residual_vibration = compared.residual_vibration();
                let (dithered, undithered) = (&compared.dithered, &compared.undithered);
                let steady = ResponseNumbers {
                    residual_vibration,
                    amplitude: dithered.lines.whole,
                    undithered_amplitude: undithered.lines.whole,
                    settled: compared.settled()
                        && (compared.undithered_settled() || residual_vibration.is_err()),
                    largest_slip: dithered.largest_slip.max(undithered.largest_slip).max(first),
                    means: None,
                };
                if !steady.settled {
                    // Its record begins on the motion on which the run ends, if that is found.
                    return alone(&points[at]);
                }
                let effect =
                    with_effect.then(|| effect(belt, &compared, RunEnding::of(belt, start)));
                Ok((steady, effect))
            });
        }
    }
    outcomes
}

/// The results of averaging at a point.
fn averages(study: &BeltStudy, wanted: &[Computation]) -> Results {
    let belt = study.belt();
    let with_state = belt.has_contact_state().then(|| Box::new(belt.clone()));
    let mut results = Results { reach: Reach::of(belt), with_state, ..Results::default() };
    let status = |why: AveragingError| Status::from(&why);
    let dithered = if belt.dithers().is_empty() { Err(Status::NoDither) } else { Ok(()) };
    for computation in wanted {
        match computation {
            Computation::Response
            | Computation::ResponseWithCost
            | Computation::ResponseWithEffect
            | Computation::DiscGrowth
            | Computation::DiscGrowthUndithered
            | Computation::SystemGrowth
            | Computation::SystemGrowthUndithered
            | Computation::SystemCritical
            | Computation::SystemQuench
            | Computation::SystemOrbit
            | Computation::SystemEnd
            | Computation::SystemResponse => {}
            Computation::Criterion => {
                let found = criterion(belt, Averaging::FiniteR);
                results.criterion = Some(found.map_err(status));
            }
            Computation::LimitCriterion => {
                results.limit_criterion =
                    Some(dithered.and_then(|()| criterion(belt, Averaging::Limit).map_err(status)));
            }
            Computation::CriticalAmplitudes => {
                results.critical_amplitudes =
                    Some(dithered.and_then(|()| {
                        critical_amplitudes(belt, Averaging::FiniteR).map_err(status)
                    }));
            }
            Computation::LimitCriticalAmplitudes => {
                results.limit_critical_amplitudes =
                    Some(dithered.and_then(|()| {
                        critical_amplitudes(belt, Averaging::Limit).map_err(status)
                    }));
            }
            Computation::Quench => results.quench = Some(quench_numbers(&belt.system(), 0)),
        }
    }
    results
}
