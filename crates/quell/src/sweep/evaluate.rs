//! What a map computes at its points: a whole chunk in, its results out.
//!
//! This is the one place that calls the engines for a map. Steady responses are computed for the
//! whole chunk side by side; a point's result depends on its own study alone all the same.

use quell_belt::averaging::{
    AveragingError, AveragingOptions, Criterion, CriticalAmplitude, criterion, critical_amplitudes,
};
use quell_belt::response::{Case, Compared, Undefined, Wanted, compare_many};
use quell_belt::simulation::{Start, within};
use quell_disc::Growth;

use super::status::Status;
use crate::run::STEPS_OF_A_SEARCH;
use crate::run::stability::SHARPER;
use crate::study::Study;

/// A computation that several quantities share.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Computation {
    /// The steady response with and without dither.
    Response,
    /// The same with the power and the stroke of the dither.
    ResponseWithCost,
    /// The criterion of averaged stability.
    Criterion,
    /// The same by the sharper averaging.
    CriterionSharper,
    /// Every critical amplitude of the first dither.
    CriticalAmplitudes,
    /// The largest growth rate of a disc.
    DiscGrowth,
    /// The same without dither.
    DiscGrowthUndithered,
}

impl Computation {
    /// Whether it integrates responses.
    pub fn is_response(self) -> bool {
        matches!(self, Self::Response | Self::ResponseWithCost)
    }
}

/// The numbers of a steady response that a map can show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steady {
    /// E = M₁/M₀ (2.27), dimensionless.
    pub efficiency: Result<f64, Undefined>,
    /// M, the largest spectral amplitude with 0 < ω ≤ 1.9: a length.
    pub amplitude: f64,
    /// M of the undithered run: a length.
    pub undithered_amplitude: f64,
    /// Share of the record spent in stick.
    pub stick_fraction: f64,
    /// Whether both runs settled, as far as E needs them to.
    pub settled: bool,
    /// Mean friction force over k: a length.
    pub mean_friction: f64,
    /// Mean power of tangential dither over kω₀: a length squared.
    pub dither_power: Option<f64>,
    /// Peak-to-peak displacement at the dither frequencies: a length.
    pub dither_stroke: Option<f64>,
    /// Smallest normal load over k: a length.
    pub minimum_normal_load: f64,
}

impl From<&Compared> for Steady {
    fn from(compared: &Compared) -> Self {
        let dithered = &compared.dithered;
        let efficiency = compared.efficiency();
        Self {
            efficiency,
            amplitude: dithered.lines.whole,
            undithered_amplitude: compared.undithered.lines.whole,
            stick_fraction: dithered.stick_fraction,
            settled: compared.settled() && (compared.undithered_settled() || efficiency.is_err()),
            mean_friction: dithered.mean_friction,
            dither_power: dithered.dither_power,
            dither_stroke: dithered.dither_stroke,
            minimum_normal_load: dithered.minimum_normal_load,
        }
    }
}

/// What was computed at one point; `None` what was not asked for.
#[derive(Clone, Debug, Default)]
pub struct Results {
    /// The steady response.
    pub steady: Option<Result<Steady, Status>>,
    /// The criterion of averaged stability.
    pub criterion: Option<Result<Criterion, Status>>,
    /// The same by the sharper averaging.
    pub criterion_sharper: Option<Result<Criterion, Status>>,
    /// Every critical amplitude of the first dither, in order.
    pub critical_amplitudes: Option<Result<Vec<CriticalAmplitude>, Status>>,
    /// The largest growth rate of a disc.
    pub disc: Option<Result<Growth, Status>>,
    /// The same without dither.
    pub disc_undithered: Option<Result<Growth, Status>>,
}

/// Computes at every point of a chunk.
pub(super) fn evaluate(points: &[Study], wanted: &[Computation]) -> Vec<Results> {
    let mut results: Vec<Results> = points.iter().map(|study| averages(study, wanted)).collect();
    let dither_cost = wanted.contains(&Computation::ResponseWithCost);
    if dither_cost || wanted.contains(&Computation::Response) {
        for (result, steady) in results.iter_mut().zip(responses(points, Wanted { dither_cost })) {
            result.steady = Some(steady);
        }
    }
    results
}

/// The steady responses, side by side where the points share their solver.
fn responses(points: &[Study], wanted: Wanted) -> Vec<Result<Steady, Status>> {
    let starts: Vec<Result<Start, Status>> = points
        .iter()
        .map(|study| {
            let start = || study.initial().resolve(study.belt(), study.solver());
            Ok(within(STEPS_OF_A_SEARCH, start)?)
        })
        .collect();
    let mut outcomes: Vec<Result<Steady, Status>> =
        starts.iter().map(|start| Err(start.err().unwrap_or(Status::Stalled))).collect();
    let mut rest: Vec<usize> = (0..points.len()).filter(|&at| starts[at].is_ok()).collect();
    while let Some(&first) = rest.first() {
        let solver = *points[first].solver();
        let (alike, others): (Vec<usize>, Vec<usize>) =
            rest.into_iter().partition(|&at| *points[at].solver() == solver);
        rest = others;
        let cases: Vec<Case> = alike
            .iter()
            .filter_map(|&at| {
                Some(Case { belt: points[at].belt().clone(), start: starts[at].ok()? })
            })
            .collect();
        for (&at, compared) in alike.iter().zip(compare_many(&cases, &solver, wanted)) {
            outcomes[at] = compared.map(|it| Steady::from(&it)).map_err(|_| Status::Stalled);
        }
    }
    outcomes
}

/// What averaging says at a point.
fn averages(study: &Study, wanted: &[Computation]) -> Results {
    let belt = study.belt();
    let mut results = Results::default();
    let told = |why: AveragingError| Status::from(&why);
    for computation in wanted {
        match computation {
            Computation::Response
            | Computation::ResponseWithCost
            | Computation::DiscGrowth
            | Computation::DiscGrowthUndithered => {}
            Computation::Criterion => {
                let found = criterion(belt, AveragingOptions::default());
                results.criterion = Some(found.map_err(told));
            }
            Computation::CriterionSharper => {
                let slow = belt.dithers().iter().any(|dither| dither.frequency_ratio <= 1.0);
                results.criterion_sharper = Some(match belt.dithers() {
                    [] => Err(Status::NoDither),
                    _ if slow => Err(Status::NotFast),
                    _ => criterion(belt, SHARPER).map_err(told),
                });
            }
            Computation::CriticalAmplitudes => {
                results.critical_amplitudes = Some(match belt.dithers() {
                    [] => Err(Status::NoDither),
                    _ => critical_amplitudes(belt, AveragingOptions::default()).map_err(told),
                });
            }
        }
    }
    results
}
