//! Measurements for figures 2.10, 2.11, 3.12, 3.13, 4.11: at each amplitude, the attractor of the run from rest and the stability
//! of the base response, and the amplitudes at which either of them changes.

use quell_dynamics::attractor::{
    Attractor, AttractorSettings, Patience, RunSwitches, VariedRun, measure, settle,
};
use quell_dynamics::orbit::{OrbitVerdict, branch_thresholds};
use quell_model::{RefusedNumbers, System};
use quell_numerics::interval::RealInterval;

use super::axis::values;
use super::failure::failed;
use super::start::start;
use quell::complaint::Failure;
use quell::study::BeltStudy;

/// Steps in which the base response is followed over the amplitudes.
const STEPS: u32 = 40;

/// One column of a figure: one amplitude.
#[derive(Debug)]
pub(super) struct AmplitudeColumn {
    /// D.
    pub(super) amplitude: f64,
    /// Its study.
    pub(super) study: BeltStudy,
    /// Stability of the base response.
    pub(super) local: OrbitVerdict,
    /// Whether the run from the study's initial state converges to a quiescent attractor.
    pub(super) quiet: bool,
    /// The attractor to which the run converges, if it does.
    pub(super) attractor: Option<Attractor>,
    /// Period of the stroboscopic section.
    pub(super) period: f64,
}

impl AmplitudeColumn {
    fn new(name: &str, study: &BeltStudy, amplitude: f64) -> Result<Self, Failure> {
        let study = study.with("dither.amplitude", amplitude)?;
        let belt = study.belt().clone();
        let settings = AttractorSettings::new(&belt).map_err(|why| failed(name, &why))?;
        let base = settings.base.as_ref().map_err(|why| failed(name, why))?;
        let local = base.verdict;
        let settled = settle(&settings, start(&study)?, Patience::SWEEP);
        let settled = settled.map_err(|why| failed(name, &why))?;
        let attractor = measure(&settings, &settled).map_err(|why| failed(name, &why))?;
        let quiet = attractor.as_ref().is_some_and(|attractor| attractor.quiet);
        Ok(Self { amplitude, study, local, quiet, attractor, period: settings.section.period })
    }

    /// Slow frequency (ω₀), if the section of the response rotates.
    pub(super) fn frequency(&self) -> Option<f64> {
        self.attractor.as_ref()?.frequency(self.period)
    }
}

/// An amplitude at which a property changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AmplitudeThreshold {
    /// The amplitude.
    pub(super) amplitude: f64,
    /// Whether the property holds above the amplitude.
    pub(super) holds_above: bool,
}

/// The columns of a figure with one waveform, and the thresholds between them.
#[derive(Debug)]
pub(super) struct AmplitudeColumns {
    pub(super) study: BeltStudy,
    pub(super) cases: Vec<AmplitudeColumn>,
    /// Amplitudes at which the base response gains or loses stability.
    pub(super) local: Vec<AmplitudeThreshold>,
    /// Amplitudes at which the run from rest starts or stops converging to a quiescent attractor.
    pub(super) from_rest: Vec<AmplitudeThreshold>,
}

impl AmplitudeColumns {
    /// Measures every column of a study.
    pub(super) fn of(name: &str, study: BeltStudy) -> Result<Self, Failure> {
        let cases: Vec<AmplitudeColumn> = values(&study, "dither.amplitude")
            .into_iter()
            .map(|amplitude| AmplitudeColumn::new(name, &study, amplitude))
            .collect::<Result<_, Failure>>()?;
        let at = |values: &[f64]| {
            let study =
                study.with("dither.amplitude", values[0]).map_err(RefusedNumbers::by_study)?;
            Ok(study.belt().system())
        };
        let ends = cases.first().zip(cases.last());
        let window = ends.map_or(RealInterval::new(0.0, 0.0), |(first, last)| {
            RealInterval::new(first.amplitude, last.amplitude)
        });
        let found = branch_thresholds(&at, window.lower, window.upper, STEPS, None)
            .map_err(|why| failed(name, &why))?;
        let local = found.thresholds.iter().filter_map(|threshold| {
            let [was, is] = [threshold.was, threshold.becomes]
                .map(|verdict| verdict == Some(OrbitVerdict::Stable));
            (was != is)
                .then_some(AmplitudeThreshold { amplitude: threshold.value, holds_above: is })
        });
        let local = local.collect();
        let start = start(&study)?;
        let state = move |_: f64, _: &System| Ok(vec![start.displacement, start.velocity]);
        let run = VariedRun { start: &state, ramp: 0.0, at: &at, most_steps: u64::MAX };
        let outcomes: Vec<_> =
            cases.iter().map(|case| (case.amplitude, run.outcome(case.amplitude))).collect();
        let switches = RunSwitches::of(&outcomes, |pairs| {
            pairs.iter().map(|[low, high]| run.change(*low, *high)).collect()
        });
        let from_rest = switches.changes.iter().map(|change| AmplitudeThreshold {
            amplitude: change.value,
            holds_above: change.becomes.is_quiet() == Some(true),
        });
        let from_rest = from_rest.collect();
        Ok(Self { study, cases, local, from_rest })
    }
}
