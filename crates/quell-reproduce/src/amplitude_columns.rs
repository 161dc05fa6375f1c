//! Measurements for figures 2.10, 2.11, 3.12, 3.13, 4.11: at each amplitude, the attractor of the run from rest and the stability
//! of the base response, and the amplitudes at which either of them changes.

use quell_dynamics::attractor::{
    Attractor, AttractorSettings, Patience, SettleOutcome, Settled, measure, settle,
};
use quell_dynamics::orbit::OrbitVerdict;

use super::axis::values;
use super::failure::failed;
use quell::complaint::Failure;
use quell::run;
use quell::study::BeltStudy;

/// Largest number of periods of a run. With fewer, a run that is still settling counts as
/// vibrating and has no settled section; with more, a run at a threshold only takes longer.
const MOST_PERIODS: u64 = 40_000;

/// Relative tolerance of a threshold.
const CLOSENESS: f64 = 1e-5;

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
        let local = local(name, &settings)?;
        let settled = run_from_start(name, &study, &settings)?;
        let attractor = measure(&settings, &settled).map_err(|why| failed(name, &why))?;
        let quiet = attractor.as_ref().is_some_and(|attractor| attractor.quiet);
        Ok(Self { amplitude, study, local, quiet, attractor, period: settings.section.period })
    }

    /// Slow frequency (ω₀), if the section of the response rotates.
    pub(super) fn frequency(&self) -> Option<f64> {
        self.attractor.as_ref()?.frequency(self.period)
    }
}

/// Stability of the base response.
fn local(name: &str, settings: &AttractorSettings<'_>) -> Result<OrbitVerdict, Failure> {
    settings.base.as_ref().map(|base| base.verdict).map_err(|why| failed(name, why))
}

/// SettleOutcome of the run from the study's initial state.
fn run_from_start(
    name: &str,
    study: &BeltStudy,
    settings: &AttractorSettings<'_>,
) -> Result<Settled, Failure> {
    let start = run::start(study)?;
    let patience = Patience { periods: MOST_PERIODS, ..Patience::SWEEP };
    settle(settings, start, patience).map_err(|why| failed(name, &why))
}

/// An amplitude between neighbouring columns at which a property changes.
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
        let of = |holds: fn(&AmplitudeColumn) -> bool| {
            cases.iter().map(|case| (case.amplitude, holds(case))).collect::<Vec<_>>()
        };
        let stable = of(|case| case.local == OrbitVerdict::Stable);
        let local = thresholds(&study, &stable, |_, settings| {
            Ok(local(name, settings)? == OrbitVerdict::Stable)
        })?;
        let quiet = of(|case| case.quiet);
        let from_rest = thresholds(&study, &quiet, |study, settings| {
            Ok(run_from_start(name, study, settings)?.outcome == SettleOutcome::Base)
        })?;
        Ok(Self { study, cases, local, from_rest })
    }
}

/// Bisects each change between neighbouring columns; two changes between the same columns are missed.
fn thresholds(
    study: &BeltStudy,
    known: &[(f64, bool)],
    holds: impl Fn(&BeltStudy, &AttractorSettings<'_>) -> Result<bool, Failure>,
) -> Result<Vec<AmplitudeThreshold>, Failure> {
    let mut found = Vec::new();
    for pair in known.windows(2) {
        let [(mut low, before), (mut high, after)] = [pair[0], pair[1]];
        if before == after {
            continue;
        }
        while high - low > CLOSENESS * high {
            let middle = 0.5 * (low + high);
            let study = study.with("dither.amplitude", middle)?;
            let belt = study.belt().clone();
            let settings =
                AttractorSettings::new(&belt).map_err(|why| failed("reproduce", &why))?;
            if holds(&study, &settings)? == before { low = middle } else { high = middle }
        }
        found.push(AmplitudeThreshold { amplitude: 0.5 * (low + high), holds_above: after });
    }
    Ok(found)
}
