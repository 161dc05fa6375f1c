//! What a map computes at its points: a whole chunk in, its results out.
//!
//! This is the one place that calls the engines for a map. It takes a chunk at once, so that an
//! engine that works on many points side by side can take them all. A point's result depends
//! on its own study alone.

use quell_belt::averaging::{
    AveragingError, AveragingOptions, Criterion, CriticalAmplitude, criterion, critical_amplitudes,
};
use quell_belt::response::{Response, Undefined, respond};

use super::status::Status;
use crate::run::stability::SHARPER;
use crate::study::Study;

/// A computation that several quantities share.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Computation {
    /// The steady response with and without dither.
    Response,
    /// The criterion of averaged stability.
    Criterion,
    /// The same by the sharper averaging.
    CriterionSharper,
    /// Every critical amplitude of the first dither.
    CriticalAmplitudes,
}

/// The numbers of a steady response that a map can show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steady {
    /// E = M₁/M₀ (2.27).
    pub efficiency: Result<f64, Undefined>,
    /// M.
    pub amplitude: f64,
    /// M of the undithered run.
    pub undithered_amplitude: f64,
    /// Share of the record spent in stick.
    pub stick_fraction: f64,
    /// Whether both runs settled, as far as E needs them to.
    pub settled: bool,
    /// Mean friction force over k.
    pub mean_friction: f64,
    /// Mean power of tangential dither over kω₀.
    pub dither_power: Option<f64>,
    /// Peak-to-peak displacement at the dither frequencies.
    pub dither_stroke: Option<f64>,
    /// Smallest normal load.
    pub minimum_normal_load: f64,
}

impl From<&Response> for Steady {
    fn from(response: &Response) -> Self {
        Self {
            efficiency: response.efficiency,
            amplitude: response.amplitude,
            undithered_amplitude: response.undithered_amplitude,
            stick_fraction: response.stick_fraction,
            settled: response.settled
                && (response.undithered_settled || response.efficiency.is_err()),
            mean_friction: response.mean_friction,
            dither_power: response.dither_power,
            dither_stroke: response.dither_stroke,
            minimum_normal_load: response.minimum_normal_load,
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
}

/// Computes at every point of a chunk.
pub(super) fn evaluate(points: &[Study], wanted: &[Computation]) -> Vec<Results> {
    points.iter().map(|study| at(study, wanted)).collect()
}

fn at(study: &Study, wanted: &[Computation]) -> Results {
    let belt = study.belt();
    let mut results = Results::default();
    let told = |why: AveragingError| Status::from(&why);
    for computation in wanted {
        match computation {
            Computation::Response => results.steady = Some(steady(study)),
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

fn steady(study: &Study) -> Result<Steady, Status> {
    let start = study.initial().resolve(study.belt(), study.solver())?;
    match respond(study.belt(), start, study.solver()) {
        Ok(response) => Ok(Steady::from(&response)),
        Err(_) => Err(Status::Stalled),
    }
}
