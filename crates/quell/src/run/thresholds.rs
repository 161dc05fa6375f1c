//! `thresholds`: values of a parameter at which the response changes: local ones by Floquet multipliers, and for runs
//! from given starts the values at which dither begins or ceases to quench.

use quell_belt::orbit::NoOrbit;
pub use quell_belt::orbit::family::Signature;
use quell_belt::orbit::reached::{Reached, Switch, ramped, switches};
pub use quell_belt::orbit::threshold::{Change, Ending, Kind, Local, Threshold};
use quell_belt::orbit::threshold::{NoThresholds, local};
use quell_belt::simulation::Start;
use quell_belt::start::NoSquealingStart;
use serde_json::{Value as Json, json};

use super::orbit::refused;
use super::varied::{ascending, unable};
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::quantity::bearable;
use crate::study::mirror::given_number;
use crate::study::vocabulary::{join, resolve};
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
    /// Path of the parameter.
    pub parameter: String,
    /// First value, a number of the equations.
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
    /// What was asked.
    pub question: Question,
    /// By multipliers, with the branch of responses on which they lie.
    pub local: Local,
    /// By runs from a start.
    pub protocols: Vec<(Protocol, Vec<Switch>)>,
}

/// Refuses a parameter that the study does not have.
pub(super) fn known(study: &Study, option: &'static str, path: &str) -> Result<(), Failure> {
    if study.belt().get(path).is_some() {
        return Ok(());
    }
    let allowed = "a number of the equations that this study has, such as dither.amplitude or belt.belt_velocity";
    // A key in SI, or a slip of the pen: its number of the equations.
    let near = match resolve(path) {
        Ok(address) => address.key.parameter().map(|parameter| {
            let table = path.rsplit_once('.').map_or("", |(table, _)| table);
            join(table, parameter.key())
        }),
        Err(nearest) => nearest,
    };
    let near = near.filter(|near| study.belt().get(near).is_some());
    Err(Complaint::option(option, path, allowed).suggesting(near).into())
}

/// Why there are no thresholds, as it is told.
pub(super) fn told(why: NoThresholds, path: &str, option: &'static str) -> Failure {
    match why {
        NoThresholds::Invalid { value } => {
            Complaint::option(option, value, format!("values that {path} can take")).into()
        }
        NoThresholds::Start(why) => refused(why),
        NoThresholds::Lost { at, why } => Failure::Failed {
            key: "thresholds".to_owned(),
            why: format!("the response was lost beyond {path} = {at}: {why}"),
        },
    }
}

/// Refuses a question that has no answer.
fn refuse(study: &Study, question: &Question) -> Result<(), Failure> {
    let &Question { from, to, ramp, .. } = question;
    known(study, "--parameter", &question.parameter)?;
    let ends = [("--from", from), ("--to", to)];
    let mut wrong: Vec<Complaint> =
        ends.into_iter().flat_map(|end| unable(study.belt(), &question.parameter, end)).collect();
    wrong.extend(ascending(from, to).err().map(|complaint| *complaint));
    wrong.extend(bearable(ramp, given_number(ramp), "--ramp").err().map(|complaint| *complaint));
    if ramp > 0.0 && question.protocols.is_empty() {
        let allowed = "given together with --from-rest, --from-sliding, --from-squeal or --start: it is the dither of their runs";
        let origin = Origin::Argument("--ramp");
        wrong.push(Complaint::new(Fault::Conflict, "--ramp", origin, ramp, allowed));
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong.into()) }
}

/// Thresholds of a study's belt.
///
/// # Errors
/// A complaint about the parameter or its range; [`Failure::Failed`] where there is no response to begin with.
pub fn run(study: &Study, question: Question) -> Result<Thresholds, Failure> {
    let belt = study.belt();
    let path = question.parameter.as_str();
    refuse(study, &question)?;
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
    }
}

/// The verdict on one side of a threshold; "none" where this response does not exist there.
pub fn side(verdict: Option<quell_belt::orbit::Verdict>) -> &'static str {
    verdict.map_or("none", quell_belt::orbit::Verdict::name)
}

impl Thresholds {
    /// Whether and how far the response was followed, in one sentence.
    pub fn sentence(&self) -> String {
        let path = &self.question.parameter;
        let (from, to) = (self.question.from, self.question.to);
        match self.local.ending {
            Ending::Covered => {
                format!(
                    "The response that sliding becomes was followed from {path} = {from} to {to}."
                )
            }
            Ending::TurnedBack { at } => format!(
                "The response that sliding becomes turns back at {path} = {at}: there is none of it beyond, \
                 and what a run ends on there is another one."
            ),
            Ending::Touch { at } => format!(
                "The response that sliding becomes ends at {path} = {at}, where it touches v_r = 0: there is none beyond."
            ),
            Ending::Lost { at } => {
                format!("The response that sliding becomes was lost beyond {path} = {at}.")
            }
        }
    }

    /// As JSON.
    pub fn json(&self) -> Json {
        let local: Vec<Json> = self
            .local
            .thresholds
            .iter()
            .map(|it| {
                json!({
                    "value": it.value,
                    "error": it.error,
                    "kind": it.kind.name(),
                    "was": side(it.was),
                    "becomes": side(it.becomes),
                    "displacement": it.state.displacement,
                    "velocity": it.state.velocity,
                })
            })
            .collect();
        let words = |signature: Option<&Signature>| {
            signature.map_or_else(|| "none".to_owned(), Signature::words)
        };
        let changes: Vec<Json> = self
            .local
            .changes
            .iter()
            .map(|it| {
                json!({
                    "value": it.value,
                    "below": words(it.below.as_ref()),
                    "above": words(it.above.as_ref()),
                })
            })
            .collect();
        let mut object = json!({
            "ok": true,
            "sentence": self.sentence(),
            "parameter": self.question.parameter,
            "from": self.question.from,
            "to": self.question.to,
            "covered": self.local.ending == Ending::Covered,
            "local": local,
            "signature_changes": changes,
        });
        if self.question.ramp > 0.0 {
            object["ramp"] = self.question.ramp.into();
        }
        for (protocol, switches) in &self.protocols {
            object[protocol.name()] = switches
                .iter()
                .map(|it| {
                    json!({ "value": it.value, "error": it.error, "becomes": becomes(it.becomes) })
                })
                .collect();
        }
        object
    }
}
