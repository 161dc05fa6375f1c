//! `thresholds`: values of a parameter at which the response changes: local ones by Floquet multipliers, and for runs
//! from given starts the values at which dither begins or ceases to quench.

use quell_belt::orbit::reached::{Reached, Switch, switches};
use quell_belt::orbit::threshold::{NoThresholds, Threshold, local_thresholds};
use quell_belt::simulation::Start;
use serde_json::{Value as Json, json};

use super::orbit::refused;
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::study::{InitialState, Study};

/// Values between which an orbit is followed.
const STEPS: u32 = 80;

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

    fn initial(self) -> InitialState {
        match self {
            Self::Rest => InitialState::Rest,
            Self::Sliding => InitialState::Sliding,
            Self::Squeal => InitialState::Squealing,
            Self::From(displacement, velocity) => InitialState::Explicit { displacement, velocity },
        }
    }
}

/// What is asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// Path of the parameter.
    pub parameter: String,
    /// First value.
    pub from: f64,
    /// Last value.
    pub to: f64,
    /// Protocols besides the local thresholds.
    pub protocols: Vec<Protocol>,
}

/// The thresholds of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Thresholds {
    /// What was asked.
    pub question: Question,
    /// By multipliers.
    pub local: Vec<Threshold>,
    /// By runs from a start.
    pub protocols: Vec<(Protocol, Vec<Switch>)>,
}

/// Thresholds of a study's belt.
///
/// # Errors
/// A complaint about the parameter or its range; [`Failure::Failed`] where an orbit is lost, with the place.
pub fn run(study: &Study, question: Question) -> Result<Thresholds, Failure> {
    let belt = study.belt();
    let path = question.parameter.as_str();
    if belt.get(path).is_none() {
        let allowed = "a number of the equations that this study has, such as dither.amplitude or belt.belt_velocity";
        let origin = Origin::Argument("--parameter");
        return Err(Complaint::new(Fault::Value, "--parameter", origin, path, allowed).into());
    }
    let told = |why: NoThresholds| match why {
        NoThresholds::Invalid { value } => {
            let allowed = format!("values that {path} can take");
            Complaint::option("--from", value, allowed).into()
        }
        NoThresholds::Start(why) => refused(why),
        NoThresholds::Lost { at, why } => Failure::Failed {
            key: "thresholds".to_owned(),
            why: format!("the response was lost beyond {path} = {at}: {why}"),
        },
    };
    let (from, to) = (question.from, question.to);
    let local = local_thresholds(belt, path, from, to, STEPS).map_err(told)?;
    let mut protocols = Vec::new();
    for &protocol in &question.protocols {
        let initial = protocol.initial();
        let start = |belt: &quell_model::Belt| -> Option<Start> {
            initial.resolve(belt, study.solver()).ok()
        };
        let found = switches(belt, path, (from, to), TRIED, CLOSENESS, start).map_err(told)?;
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

impl Thresholds {
    /// As JSON.
    pub fn json(&self) -> Json {
        let local: Vec<Json> = self
            .local
            .iter()
            .map(|it| {
                json!({ "value": it.value, "kind": it.kind.name(), "becomes": it.becomes.name() })
            })
            .collect();
        let mut object = json!({
            "ok": true,
            "parameter": self.question.parameter,
            "from": self.question.from,
            "to": self.question.to,
            "local": local,
        });
        for (protocol, switches) in &self.protocols {
            object[protocol.name()] = switches
                .iter()
                .map(|it| json!({ "value": it.value, "becomes": becomes(it.becomes) }))
                .collect();
        }
        object
    }
}
