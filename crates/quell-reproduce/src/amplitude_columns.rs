//! The columns of figures 2.10, 2.11, 3.12, 3.13, 4.11: the end of the run from rest and the stability of the base response at each
//! amplitude, and the amplitudes between which either of them changes.

use quell_dynamics::attractor::{Attractor, Outcome, Patience, Scene, Settled, measure, settle};
use quell_dynamics::orbit::Verdict;

use super::axis::values;
use super::failure::failed;
use quell::complaint::Failure;
use quell::run;
use quell::study::Study;

/// Most periods of a run. With fewer a run that is still settling counts as
/// vibrating and shows no settled section; with more, one at a threshold only takes longer to say so.
const MOST_PERIODS: u64 = 40_000;

/// Closeness of a threshold, relative.
const CLOSENESS: f64 = 1e-5;

/// One column of a figure.
#[derive(Debug)]
pub(super) struct AmplitudeColumn {
    /// D.
    pub(super) amplitude: f64,
    /// Its study.
    pub(super) study: Study,
    /// Whether the response of sliding is stable.
    pub(super) local: Verdict,
    /// Whether the run from the start of the study ends on it.
    pub(super) quiet: bool,
    /// What it ends on.
    pub(super) attractor: Option<Attractor>,
    /// Period of the section.
    pub(super) period: f64,
}

impl AmplitudeColumn {
    fn new(name: &str, study: &Study, amplitude: f64) -> Result<Self, Failure> {
        let study = study.with("dither.amplitude", amplitude)?;
        let belt = study.belt().clone();
        let scene = Scene::new(&belt).map_err(|why| failed(name, &why))?;
        let local = local(name, &scene)?;
        let settled = ends(name, &study, &scene)?;
        let attractor = measure(&scene, &settled).map_err(|why| failed(name, &why))?;
        let quiet = attractor.as_ref().is_some_and(|it| it.quiet);
        Ok(Self { amplitude, study, local, quiet, attractor, period: scene.strobe.period })
    }

    /// Slow frequency (ω₀), where the response turns.
    pub(super) fn frequency(&self) -> Option<f64> {
        self.attractor.as_ref()?.frequency(self.period)
    }
}

/// Whether the response of sliding is stable.
fn local(name: &str, scene: &Scene<'_>) -> Result<Verdict, Failure> {
    scene.quiet.as_ref().map(|quiet| quiet.verdict).map_err(|why| failed(name, why))
}

/// Where the run from the start of the study ends.
fn ends(name: &str, study: &Study, scene: &Scene<'_>) -> Result<Settled, Failure> {
    let start = run::start(study)?;
    let patience = Patience { periods: MOST_PERIODS, ..Patience::SWEEP };
    settle(scene, start, patience).map_err(|why| failed(name, &why))
}

/// Amplitudes between neighbouring columns at which something changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AmplitudeThreshold {
    /// The amplitude.
    pub(super) amplitude: f64,
    /// Whether it holds above.
    pub(super) holds_above: bool,
}

/// The columns of a figure with one waveform, and what changes between them.
#[derive(Debug)]
pub(super) struct AmplitudeColumns {
    pub(super) study: Study,
    pub(super) cases: Vec<AmplitudeColumn>,
    /// Where the response of sliding gains or loses stability.
    pub(super) local: Vec<AmplitudeThreshold>,
    /// Where the run from rest begins or ceases to end on it.
    pub(super) from_rest: Vec<AmplitudeThreshold>,
}

impl AmplitudeColumns {
    /// Measures every column of a study.
    pub(super) fn of(name: &str, study: Study) -> Result<Self, Failure> {
        let cases: Vec<AmplitudeColumn> = values(&study, "dither.amplitude")
            .into_iter()
            .map(|amplitude| AmplitudeColumn::new(name, &study, amplitude))
            .collect::<Result<_, Failure>>()?;
        let of = |holds: fn(&AmplitudeColumn) -> bool| {
            cases.iter().map(|case| (case.amplitude, holds(case))).collect::<Vec<_>>()
        };
        let stable = of(|case| case.local == Verdict::Stable);
        let local =
            changes(&study, &stable, |_, scene| Ok(local(name, scene)? == Verdict::Stable))?;
        let quiet = of(|case| case.quiet);
        let from_rest = changes(&study, &quiet, |study, scene| {
            Ok(ends(name, study, scene)?.outcome == Outcome::Quiet)
        })?;
        Ok(Self { study, cases, local, from_rest })
    }
}

/// Bisects each change between neighbours; a pair of changes between two columns is missed.
fn changes(
    study: &Study,
    known: &[(f64, bool)],
    holds: impl Fn(&Study, &Scene<'_>) -> Result<bool, Failure>,
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
            let scene = Scene::new(&belt).map_err(|why| failed("reproduce", &why))?;
            if holds(&study, &scene)? == before { low = middle } else { high = middle }
        }
        found.push(AmplitudeThreshold { amplitude: 0.5 * (low + high), holds_above: after });
    }
    Ok(found)
}
