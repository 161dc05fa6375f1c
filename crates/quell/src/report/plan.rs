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
use crate::study::{DiscStudy, Study, SystemStudy};
use crate::sweep::Running;
use crate::verbs::{Reply, Verbs};
use crate::words::digits;

/// The window of thresholds, in amplitudes of the study.
const WINDOW: (f64, f64) = (0.1, 2.0);

/// What a verb is asked.
pub(super) enum ReportedVerb {
    Modes,
    Stability,
    Response,
    Orbit,
    Friction,
    Resonances,
    Thresholds(ThresholdsRequest),
    Design,
    Actuator,
    Probability,
}

/// A verb of the report.
pub(super) struct ReportStep {
    pub(super) verb: &'static str,
    pub(super) heading: &'static str,
    pub(super) start: String,
    pub(super) chosen: Option<String>,
    pub(super) request: ReportedVerb,
}

impl ReportStep {
    fn new(verb: &'static str, heading: &'static str, start: &str, request: ReportedVerb) -> Self {
        Self { verb, heading, start: start.to_owned(), chosen: None, request }
    }
}

const SMALL: &str = "small motions about steady sliding";
const NO_START: &str = "none: no motion is computed";
const BRANCH: &str = "the base response, continued from steady sliding";

/// The verbs that a study of this kind has, in the order of the report.
pub(super) fn planned(study: &Study) -> Vec<ReportStep> {
    match study.disc() {
        Ok(disc) => of_disc(&disc),
        Err(_) => of_system(study, &study.system()),
    }
}

/// Whether a dither acts.
pub(super) fn is_dithered(study: &Study) -> bool {
    match study.disc() {
        Ok(disc) => disc.disc().dither().frequency_ratio().is_some(),
        Err(_) => study.system().system().is_dithered(),
    }
}

fn of_disc(study: &DiscStudy) -> Vec<ReportStep> {
    let mut steps = vec![
        ReportStep::new("stability", "Stability of steady sliding", SMALL, ReportedVerb::Stability),
        ReportStep::new("modes", "Natural frequencies", NO_START, ReportedVerb::Modes),
        ReportStep::new(
            "resonances",
            "Speeds at which waves meet",
            SMALL,
            ReportedVerb::Resonances,
        ),
    ];
    let dithered = study.disc().dither().frequency_ratio().is_some();
    // The exponents of small motions decide about a disc.
    let asked = questions(Questions {
        design: dithered && study.design().is_some(),
        actuator: false,
        probability: study.uncertainty().is_some(),
    });
    steps.extend(asked.map(|step| ReportStep { start: SMALL.to_owned(), ..step }));
    steps
}

fn of_system(declared: &Study, study: &SystemStudy) -> Vec<ReportStep> {
    let start = &start_in_words(study, &StateNumbers::new());
    let mut steps = vec![
        ReportStep::new("stability", "Stability of steady sliding", SMALL, ReportedVerb::Stability),
        ReportStep::new("modes", "Natural frequencies", NO_START, ReportedVerb::Modes),
        ReportStep::new("response", "Steady response", start, ReportedVerb::Response),
        ReportStep::new("orbit", "Periodic response", BRANCH, ReportedVerb::Orbit),
    ];
    let inputs = &study.system().inputs;
    for (place, input) in inputs.iter().enumerate() {
        let path = indexed("dither", place, inputs.len(), "amplitude");
        let amplitude = amplitude_of(input);
        let room = room_for(study.system(), input);
        steps.extend(thresholds(&key_of(declared, &path), amplitude, room));
    }
    steps.extend(questions(Questions {
        design: !inputs.is_empty() && study.design().is_some(),
        actuator: !inputs.is_empty() && study.actuator().is_some(),
        probability: study.uncertainty().is_some(),
    }));
    steps.push(ReportStep::new("friction", "Friction law", NO_START, ReportedVerb::Friction));
    steps
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

/// The tables of a study that ask a question.
#[derive(Clone, Copy)]
struct Questions {
    design: bool,
    actuator: bool,
    probability: bool,
}

/// The verbs that answer them.
fn questions(asked: Questions) -> impl Iterator<Item = ReportStep> {
    let design = ReportStep::new(
        "design",
        "The least dither over the operating points",
        BRANCH,
        ReportedVerb::Design,
    );
    let actuator =
        ReportStep::new("actuator", "What the actuator can give", SMALL, ReportedVerb::Actuator);
    let probability = ReportStep::new(
        "probability",
        "How probable the vibration is",
        SMALL,
        ReportedVerb::Probability,
    );
    let all =
        [(asked.design, design), (asked.actuator, actuator), (asked.probability, probability)];
    all.into_iter().filter_map(|(wanted, step)| wanted.then_some(step))
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
    let mut step =
        ReportStep::new("thresholds", heading, BRANCH, ReportedVerb::Thresholds(request));
    step.chosen = Some(format!("`{path}` from {} to {}", digits(from), digits(to)));
    Some(step)
}

/// The answer of a verb.
pub(super) fn ask(verbs: &Verbs, asked: ReportedVerb) -> Reply {
    match asked {
        ReportedVerb::Modes => verbs.modes(),
        ReportedVerb::Stability => verbs.stability(),
        ReportedVerb::Response => verbs.response(&ResponseRequest::default()),
        ReportedVerb::Orbit => verbs.orbit(&Wanted::default()),
        ReportedVerb::Friction => verbs.friction(None, false),
        ReportedVerb::Resonances => verbs.resonances(ResonancesRequest::default()),
        ReportedVerb::Thresholds(request) => verbs.thresholds(&request),
        ReportedVerb::Design => verbs.design(),
        ReportedVerb::Actuator => verbs.actuator(None),
        ReportedVerb::Probability => {
            let (stop, request) = (AtomicBool::new(false), ProbabilityRequest::default());
            verbs.probability(request, Running { threads: None, stop: &stop, progress: &() })
        }
    }
}
