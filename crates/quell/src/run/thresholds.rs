//! `thresholds`: values of a parameter at which the response changes: local ones by Floquet multipliers, and for runs
//! from given starts the values at which dither begins or ceases to quench.

use quell_belt::orbit::NoOrbit;
pub use quell_belt::orbit::family::Signature;
use quell_belt::orbit::reached::{Reached, Switches, ramped, switches};
pub use quell_belt::orbit::threshold::{Change, Ending, Kind, Local, Threshold};
use quell_belt::orbit::threshold::{NoThresholds, local};
use quell_belt::simulation::{Start, within};
use quell_belt::start::NoSquealingStart;
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::orbit::refused;
use super::varied::{Named, ascending};
use super::{STEPS_OF_MANY_SEARCHES, in_words};
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::fields::Fields;
use crate::quantity::bearable;
use crate::study::mirror::given_number;
use crate::study::vocabulary::join;
use crate::study::{InitialState, Study};

/// Least number of values between which an orbit is followed.
const STEPS: u32 = 40;

/// Values that are tried of a protocol.
const TRIED: u32 = 40;

/// Relative closeness of a protocol's threshold.
const CLOSENESS: f64 = 1e-5;

/// From where runs start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Protocol {
    /// x = 0, x′ = 0.
    Rest,
    /// Steady sliding without dither.
    Sliding,
    /// The undithered limit cycle.
    Squeal,
    /// This state (x, x′).
    From(f64, f64),
}

impl Protocol {
    /// Name of its field in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rest => "from_rest",
            Self::Sliding => "from_sliding",
            Self::Squeal => "from_squeal",
            Self::From(..) => "from_start",
        }
    }

    pub(super) fn initial(self) -> InitialState {
        match self {
            Self::Rest => InitialState::Rest,
            Self::Sliding => InitialState::Sliding,
            Self::Squeal => InitialState::Squealing,
            Self::From(displacement, velocity) => InitialState::Explicit { displacement, velocity },
        }
    }
}

/// What is asked.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Question {
    /// Path of the parameter; its key in SI in a study in SI too.
    pub parameter: String,
    /// First value, in the unit of that key.
    pub from: f64,
    /// Last value, above the first.
    pub to: f64,
    /// Protocols besides the local thresholds.
    pub protocols: Vec<Protocol>,
    /// Time τ over which the dither of a protocol grows from nothing, in steps of its period; 0 switches it on.
    pub ramp: f64,
}

/// The thresholds of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Thresholds {
    /// What was asked, in numbers of the equations.
    pub question: Question,
    /// By multipliers, with the branch of responses on which they lie.
    pub local: Local,
    /// By runs from a start.
    pub protocols: Vec<(Protocol, Switches)>,
}

/// The key of a number of the equations, in SI where the study is.
pub fn path_in_words(study: &Study, path: &str) -> String {
    let twin = study
        .belt()
        .parameter(path)
        .filter(|_| study.scales().is_some())
        .and_then(|parameter| parameter.si.iter().find(|twin| !twin.rms));
    match (twin, path.rsplit_once('.')) {
        (Some(twin), Some((table, _))) => join(table, twin.key),
        _ => path.to_owned(),
    }
}

/// A value of a number of the equations, in SI where the study is.
pub fn value_in_words(study: &Study, path: &str, value: f64) -> String {
    if study.scales().is_none() {
        return value.to_string();
    }
    in_words(study, quantity_of(study, path), value)
}

/// What a number of the equations measures.
pub fn quantity_of(study: &Study, path: &str) -> Quantity {
    study.belt().parameter(path).map_or(Quantity::Ratio, |parameter| parameter.quantity)
}

/// Why there are no thresholds, as it is told.
pub(super) fn told(why: NoThresholds, path: &str, option: &'static str) -> Failure {
    match why {
        NoThresholds::Invalid { value } => {
            Complaint::option(option, value, format!("values that {path} can take")).into()
        }
        NoThresholds::Start(why) => refused(why),
        NoThresholds::Lost { at } => Failure::Failed {
            key: "thresholds".to_owned(),
            why: format!("the response was lost beyond {path} = {at}"),
        },
    }
}

/// The question in numbers of the equations.
///
/// # Errors
/// Every complaint about it at once.
fn understood(study: &Study, question: Question) -> Result<Question, Failure> {
    let Question { from, to, ramp, .. } = question;
    let named = Named::new(study, "--parameter", &question.parameter)?;
    let ends = [("--from", from), ("--to", to)];
    let mut wrong: Vec<Complaint> =
        ends.into_iter().flat_map(|end| named.unable(study.belt(), end)).collect();
    wrong.extend(ascending(from, to).err().map(|complaint| *complaint));
    wrong.extend(bearable(ramp, given_number(ramp), "--ramp").err().map(|complaint| *complaint));
    if ramp > 0.0 && question.protocols.is_empty() {
        let allowed = "given together with --from-rest, --from-sliding, --from-squeal or --start: it is the dither of their runs";
        let origin = Origin::Argument("--ramp");
        wrong.push(Complaint::new(Fault::Conflict, "--ramp", origin, ramp, allowed));
    }
    if !wrong.is_empty() {
        return Err(wrong.into());
    }
    let (from, to) = (named.of(from), named.of(to));
    Ok(Question { parameter: named.path, from, to, ..question })
}

/// Thresholds of a study's belt.
///
/// # Errors
/// A complaint about the parameter or its range; [`Failure::Failed`] where there is no response to begin with.
pub fn run(study: &Study, question: Question) -> Result<Thresholds, Failure> {
    within(STEPS_OF_MANY_SEARCHES, || found(study, question))
}

fn found(study: &Study, question: Question) -> Result<Thresholds, Failure> {
    let belt = study.belt();
    let question = understood(study, question)?;
    let path = question.parameter.as_str();
    let (from, to) = (question.from, question.to);
    let local = local(belt, path, from, to, STEPS).map_err(|why| told(why, path, "--from"))?;
    let mut protocols = Vec::new();
    for &protocol in &question.protocols {
        let initial = protocol.initial();
        let start = |belt: &quell_model::Belt| -> Result<Option<Start>, NoOrbit> {
            let start = match initial.resolve(belt, study.solver()) {
                Ok(start) => start,
                Err(NoSquealingStart::SettlesToSliding | NoSquealingStart::BeltAtRest) => {
                    return Ok(None);
                }
                Err(NoSquealingStart::Stalled(why)) => return Err(NoOrbit::Stalled(why)),
            };
            // Without dither there is nothing to grow.
            match ramped(belt, start, question.ramp) {
                Err(NoOrbit::NoDither) => Ok(Some(start)),
                ramped => ramped.map(Some),
            }
        };
        let found = switches(belt, path, (from, to), TRIED, CLOSENESS, start)
            .map_err(|why| told(why, path, "--from"))?;
        protocols.push((protocol, found));
    }
    Ok(Thresholds { question, local, protocols })
}

/// What runs do beyond a switch.
pub fn becomes(reached: Reached) -> &'static str {
    match reached {
        Reached::Sliding => "quenched",
        Reached::Elsewhere => "not quenched",
        Reached::Unsettled => "unsettled",
        Reached::Unknown => "unknown",
    }
}

/// The verdict on one side of a threshold; "none" where this response does not exist there.
pub fn side(verdict: Option<quell_belt::orbit::Verdict>) -> &'static str {
    verdict.map_or("none", quell_belt::orbit::Verdict::name)
}

impl Thresholds {
    /// Whether and how far the response was followed, in one sentence.
    pub fn sentence(&self, study: &Study) -> String {
        let given = &self.question.parameter;
        let path = path_in_words(study, given);
        let told = |value: f64| value_in_words(study, given, value);
        let (from, to) = (told(self.question.from), told(self.question.to));
        match self.local.ending {
            Ending::Covered => {
                format!(
                    "The response that sliding becomes was followed from {path} = {from} to {to}."
                )
            }
            Ending::TurnedBack { at } => format!(
                "The response that sliding becomes turns back at {path} = {}: there is none of it beyond, \
                 and what a run ends on there is another one.",
                told(at)
            ),
            Ending::Touch { at } => format!(
                "The response that sliding becomes ends at {path} = {}, where it touches v_r = 0: there is none beyond.",
                told(at)
            ),
            Ending::LostTurning { furthest, at } => format!(
                "The response that sliding becomes turns back at {path} = {} and was lost at {}: whether it goes further is not known.",
                told(furthest),
                told(at)
            ),
            Ending::Lost { at } => {
                format!("The response that sliding becomes was lost beyond {path} = {}.", told(at))
            }
        }
    }

    /// As JSON.
    pub fn json(&self, study: &Study) -> Json {
        let question = &self.question;
        let quantity = quantity_of(study, &question.parameter);
        let object = || Fields::new(study.scales());
        let local = self.local.thresholds.iter().map(|it| {
            let mut inner = object();
            inner
                .number("value", quantity, it.value)
                .number("error", quantity, it.error)
                .plain("kind", it.kind.name())
                .plain("was", side(it.was))
                .plain("becomes", side(it.becomes))
                .number("displacement", Quantity::Displacement, it.state.displacement)
                .number("velocity", Quantity::Velocity, it.state.velocity);
            inner
        });
        let words = |signature: Option<&Signature>| {
            signature.map_or_else(|| "none".to_owned(), Signature::words)
        };
        let changes = self.local.changes.iter().map(|it| {
            let mut inner = object();
            inner
                .number("value", quantity, it.value)
                .plain("below", words(it.below.as_ref()))
                .plain("above", words(it.above.as_ref()));
            inner
        });
        let mut fields = object();
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("parameter", question.parameter.as_str())
            .number("from", quantity, question.from)
            .number("to", quantity, question.to)
            .plain("covered", self.local.ending == Ending::Covered)
            .list("local", local)
            .list("signature_changes", changes);
        if question.ramp > 0.0 {
            fields.number("ramp", Quantity::Time, question.ramp);
        }
        let mut first = object();
        for (protocol, switches) in &self.protocols {
            first.plain(protocol.name(), becomes(switches.first));
            let switches = switches.changes.iter().map(|it| {
                let mut inner = object();
                inner
                    .number("value", quantity, it.value)
                    .number("error", quantity, it.error)
                    .plain("becomes", becomes(it.becomes));
                inner
            });
            fields.list(protocol.name(), switches);
        }
        if !self.protocols.is_empty() {
            fields.nested("at_from", first);
        }
        fields.plain("warnings", self.warnings(study));
        fields.finish()
    }

    /// Values at which it is not known where runs end, in words.
    pub fn warnings(&self, study: &Study) -> Vec<String> {
        let given = &self.question.parameter;
        let path = path_in_words(study, given);
        let told = |(protocol, switches): &(Protocol, Switches)| {
            let (value, why) = switches.unknown.first()?;
            let value = value_in_words(study, given, *value);
            let runs = protocol.name().replace('_', " ");
            let count = switches.unknown.len();
            let others = if count > 1 {
                format!("; so at {} more values", count - 1)
            } else {
                String::new()
            };
            Some(format!(
                "where the run {runs} ends at {path} = {value} is not known: {why}{others}"
            ))
        };
        self.protocols.iter().filter_map(told).collect()
    }
}
