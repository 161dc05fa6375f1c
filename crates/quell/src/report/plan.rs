//! The verbs of a report with their requests.

use std::sync::atomic::AtomicBool;

use quell_model::parameter::indexed;
use quell_model::system::Input;
use quell_numerics::interval::RealInterval;

use crate::run::disc::resonances::ResonancesRequest;
use crate::run::orbit::Wanted;
use crate::run::probability::ProbabilityRequest;
use crate::run::response::ResponseRequest;
use crate::run::system::start::{StateNumbers, start_in_words};
use crate::run::thresholds::{ThresholdsRequest, window_of};
use crate::run::varied::key_of;
use crate::running::Running;
use crate::study::{Study, SystemStudy};
use crate::verbs::{Reply, Verbs};
use crate::words::digits;

/// A verb of the report.
pub(super) struct ReportStep {
    pub(super) verb: &'static str,
    pub(super) heading: &'static str,
    pub(super) start: String,
    pub(super) chosen: Option<String>,
    /// Asks the verb.
    pub(super) ask: Box<dyn Fn(&Verbs) -> Reply>,
}

impl ReportStep {
    fn new(
        verb: &'static str,
        heading: &'static str,
        start: &str,
        ask: impl Fn(&Verbs) -> Reply + 'static,
    ) -> Self {
        Self { verb, heading, start: start.to_owned(), chosen: None, ask: Box::new(ask) }
    }
}

const SMALL: &str = "small motions about steady sliding";
const NO_START: &str = "none: no motion is computed";
const BRANCH: &str = "the base response, continued from steady sliding";

/// The verbs that a study has, in the order of the report.
pub(super) fn planned(study: &Study) -> Vec<ReportStep> {
    let stability = "Stability of steady sliding";
    let mut steps = vec![
        ReportStep::new("stability", stability, SMALL, Verbs::stability),
        ReportStep::new("modes", "Natural frequencies", NO_START, Verbs::modes),
    ];
    if let Ok(disc) = study.disc() {
        let heading = "Speeds at which waves meet";
        steps.push(ReportStep::new("resonances", heading, SMALL, |verbs| {
            verbs.resonances(ResonancesRequest::default())
        }));
        // The exponents of small motions decide about a disc.
        steps.extend(disc.design().filter(|_| is_dithered(study)).map(|_| design(SMALL)));
    } else {
        steps.extend(about_motions(study, &study.system()));
    }
    if study.uncertainty().is_some() {
        steps.push(ReportStep::new(
            "probability",
            "How probable the vibration is",
            SMALL,
            probability,
        ));
    }
    if study.disc().is_err() {
        let ask = |verbs: &Verbs| verbs.friction(None, false);
        steps.push(ReportStep::new("friction", "Friction law", NO_START, ask));
    }
    steps
}

/// Whether a dither acts.
pub(super) fn is_dithered(study: &Study) -> bool {
    match study.disc() {
        Ok(disc) => disc.disc().dither().frequency_ratio().is_some(),
        Err(_) => study.system().system().is_dithered(),
    }
}

/// The verbs of a belt or a system about its motions and its dither.
fn about_motions(declared: &Study, study: &SystemStudy) -> Vec<ReportStep> {
    let start = &start_in_words(study, &StateNumbers::new());
    let mut steps = vec![
        ReportStep::new("response", "Steady response", start, |verbs| {
            verbs.response(&ResponseRequest::default())
        }),
        ReportStep::new("orbit", "Periodic response", BRANCH, |verbs| {
            verbs.orbit(&Wanted::default())
        }),
    ];
    let inputs = &study.system().inputs;
    for (place, input) in inputs.iter().enumerate().filter(|(_, input)| amplitude_of(input) > 0.0) {
        let path = indexed("dither", place, inputs.len(), "amplitude");
        steps.push(thresholds(study, &key_of(declared, &path), input));
    }
    if !inputs.is_empty() {
        steps.extend(study.design().map(|_| design(BRANCH)));
        let ask = |verbs: &Verbs| verbs.actuator(None);
        let actuator = ReportStep::new("actuator", "What the actuator can give", SMALL, ask);
        steps.extend(study.actuator().map(|_| actuator));
    }
    steps
}

fn design(start: &str) -> ReportStep {
    let heading = "The least dither over the operating points";
    ReportStep::new("design", heading, start, Verbs::design)
}

fn probability(verbs: &Verbs) -> Reply {
    let (stop, request) = (AtomicBool::new(false), ProbabilityRequest::default());
    verbs.probability(request, Running { threads: None, stop: &stop, progress: &() })
}

/// The amplitude of an input: that of its largest wave.
pub(super) fn amplitude_of(input: &Input) -> f64 {
    input.profile.waves().iter().map(|wave| wave.amplitude).fold(0.0, f64::max)
}

/// Thresholds of an amplitude from no dither up to the limit of the verb, of one without such a limit up to twice its value.
fn thresholds(study: &SystemStudy, path: &str, input: &Input) -> ReportStep {
    let window = window_of(study, path, (None, None), None);
    let window = window.unwrap_or_else(|_| RealInterval::new(0.0, 2.0 * amplitude_of(input)));
    let (parameter, RealInterval { lower: from, upper: to }) = (path.to_owned(), window);
    let request = ThresholdsRequest { parameter, window, ..ThresholdsRequest::default() };
    let heading = "Amplitudes that change the outcome";
    let ask = move |verbs: &Verbs| verbs.thresholds(&request);
    let mut step = ReportStep::new("thresholds", heading, BRANCH, ask);
    step.chosen = Some(format!("`{path}` from {} to {}", digits(from), digits(to)));
    step
}
