//! The verbs of a report with their requests.

use std::sync::atomic::AtomicBool;

use quell_model::System;
use quell_model::parameter::indexed;
use quell_model::system::{Input, InputTarget};

use crate::run::disc::resonances::ResonancesRequest;
use crate::run::orbit::Wanted;
use crate::run::probability::ProbabilityRequest;
use crate::run::response::ResponseRequest;
use crate::run::system::start::{StateNumbers, start_in_words};
use crate::run::thresholds::ThresholdsRequest;
use crate::run::varied::key_of;
use crate::study::{Study, SystemStudy};
use crate::sweep::Running;
use crate::verbs::{Reply, Verbs};
use crate::words::digits;

/// The window of thresholds, in amplitudes of the study.
const WINDOW: (f64, f64) = (0.1, 2.0);

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
        steps.extend(of_system(study, &study.system()));
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
fn of_system(declared: &Study, study: &SystemStudy) -> Vec<ReportStep> {
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
    for (place, input) in inputs.iter().enumerate() {
        let path = indexed("dither", place, inputs.len(), "amplitude");
        let amplitude = amplitude_of(input);
        let room = room_for(study.system(), input);
        steps.extend(thresholds(&key_of(declared, &path), amplitude, room));
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

/// The largest amplitude at which an input leaves the contact closed on whose prescribed load it acts.
fn room_for(system: &System, input: &Input) -> f64 {
    let InputTarget::NormalLoad { contact, .. } = input.target else { return f64::INFINITY };
    let same = |other: &&Input| matches!(other.target, InputTarget::NormalLoad { contact: its, .. } if its == contact);
    let all: f64 = system.inputs.iter().filter(same).map(amplitude_of).sum();
    let loaded = &system.contacts[contact];
    if loaded.normal.is_some() {
        f64::INFINITY
    } else {
        loaded.normal_load - all + amplitude_of(input)
    }
}

/// Thresholds of an amplitude between a tenth and twice its value, or up to the largest that the contact allows; none of an
/// amplitude that is 0.
fn thresholds(path: &str, amplitude: f64, room: f64) -> Option<ReportStep> {
    // Numbers with few digits; rounding must not lead beyond the largest amplitude.
    let rounded = |value: f64| digits(value).parse::<f64>().unwrap_or(value);
    let (from, to) = (rounded(WINDOW.0 * amplitude), rounded(WINDOW.1 * amplitude).min(room));
    if !(amplitude > 0.0 && from < to) {
        return None;
    }
    let parameter = path.to_owned();
    let request =
        ThresholdsRequest { parameter, window: (from, to), ..ThresholdsRequest::default() };
    let heading = "Amplitudes that change the outcome";
    let ask = move |verbs: &Verbs| verbs.thresholds(&request);
    let mut step = ReportStep::new("thresholds", heading, BRANCH, ask);
    step.chosen = Some(format!("`{path}` from {} to {}", digits(from), digits(to)));
    Some(step)
}
