//! `simulate`: one trajectory with its events.

use quell::kind::{moving_system, verbs};
use quell::run::simulate::{Options, Start};
use quell::run::system::simulate::{MotionRequest, MotionStart};
use quell::run::system::start;
use quell::sound::SoundOptions;
use quell::study::SystemStudy;
use quell::{Complaint, Failure, Fault, Origin, Study, quantity};
use quell_model::units::Quantity;

use crate::answer::NativeAnswer;
use crate::arguments::{NamedNumbers, Pair, state};

/// The options of a sound as they are given: transposition and gain.
pub(crate) type SoundTexts = (Option<String>, Option<String>);

/// Where a run begins.
#[derive(pyo3::FromPyObject)]
pub(crate) enum Begin {
    /// A time and a state in the units of the study, such as those at the end of another run.
    Exact((f64, Vec<f64>)),
    /// Displacement and velocity of a belt, as texts, and the time, if it is not 0.
    State((Pair, Option<String>)),
    /// Names of the state of a system with their values.
    Named(NamedNumbers),
}

/// Times of samples.
#[derive(pyo3::FromPyObject)]
pub(crate) enum GivenTimes {
    /// In the unit of `until`.
    Numbers(Vec<f64>),
    /// Texts with units.
    Texts(Vec<String>),
}

/// What is asked of a run.
pub(crate) struct GivenRun {
    /// Time at its end.
    pub(crate) until: Option<String>,
    /// Whether events and samples are kept.
    pub(crate) kept: (bool, bool),
    /// Where it begins, if not at the start of the study.
    pub(crate) begin: Option<Begin>,
    /// Times of the samples.
    pub(crate) times: Option<GivenTimes>,
    /// The options of its sound.
    pub(crate) sound: Option<SoundTexts>,
}

/// Runs the verb.
pub(crate) fn run(study: &Study, asked: &GivenRun) -> Result<NativeAnswer, Failure> {
    if let Some(system) = moving_system(study) {
        let request = of_system(study, &system, asked)?;
        return Ok(NativeAnswer::new(verbs(study).simulate_from(&request)?));
    }
    let until = asked.until.as_deref().ok_or_else(|| {
        let allowed = "a time: only systems have a default";
        refused("--until", Fault::Missing, allowed)
    })?;
    let read = |text: &str, option| quantity::duration(text, study.scales(), option);
    let options = Options {
        start: asked.begin.as_ref().map(|begin| of_belt(study, begin)).transpose()?,
        times: in_time(asked.times.as_ref(), read)?,
        events: asked.kept.0,
        samples: asked.kept.1,
        undithered: false,
        sound: asked.sound.as_ref().map(|sound| options(study, sound)).transpose()?,
    };
    Ok(NativeAnswer::new(verbs(study).simulate(read(until, "--until")?, options)?))
}

fn refused(option: &'static str, fault: Fault, allowed: &str) -> Failure {
    let origin = Origin::Argument(option);
    Complaint::new(fault, option, origin, serde_json::Value::Null, allowed).into()
}

/// Times of samples as numbers of the equations; `read` reads one of them for an option.
fn in_time(
    times: Option<&GivenTimes>,
    read: impl Fn(&str, &'static str) -> Result<f64, Box<Complaint>>,
) -> Result<Option<Vec<f64>>, Failure> {
    Ok(match times {
        None => None,
        Some(GivenTimes::Numbers(times)) => {
            let unit = read("1", "t_eval")?;
            Some(times.iter().map(|time| unit * time).collect())
        }
        Some(GivenTimes::Texts(texts)) => {
            let times: Result<Vec<f64>, _> =
                texts.iter().map(|text| read(text, "t_eval")).collect();
            Some(times?)
        }
    })
}

fn of_belt(study: &Study, begin: &Begin) -> Result<Start, Failure> {
    match begin {
        Begin::Exact((time, numbers)) => match numbers.as_slice() {
            [displacement, velocity] => {
                let number = |quantity, value| {
                    study.scales().map_or(value, |scales| scales.from_units(quantity, value))
                };
                Ok(Start {
                    time: number(Quantity::Time, *time),
                    displacement: *displacement,
                    velocity: number(Quantity::Velocity, *velocity),
                })
            }
            _ => Err(refused("--start", Fault::Value, "two numbers (x, x′)")),
        },
        Begin::State((pair, time)) => {
            let (displacement, velocity) = state(pair, study.scales(), "--start")?;
            let time = time
                .as_deref()
                .map_or(Ok(0.0), |text| quantity::duration(text, study.scales(), "--start"))?;
            Ok(Start { time, displacement, velocity })
        }
        Begin::Named(_) => {
            Err(refused("--start", Fault::Value, "displacement and velocity: (x, x′)"))
        }
    }
}

fn options(study: &Study, (transpose, gain): &SoundTexts) -> Result<SoundOptions, Failure> {
    let mut options = SoundOptions::default();
    if let Some(text) = transpose {
        options.transposition = SoundOptions::transposition(text)?;
    }
    if let Some(text) = gain {
        options.gain = Some(SoundOptions::gain(text, study.scales())?);
    }
    Ok(options)
}

fn of_system(
    study: &Study,
    system: &SystemStudy,
    asked: &GivenRun,
) -> Result<MotionRequest, Failure> {
    let read = |text: &str, option| start::duration(system, text, option);
    let mut request = MotionRequest {
        until: asked.until.as_deref().map(|text| read(text, "--until")).transpose()?,
        times: in_time(asked.times.as_ref(), read)?,
        events: asked.kept.0,
        samples: asked.kept.1,
        sound: asked.sound.as_ref().map(|sound| options(study, sound)).transpose()?,
        ..MotionRequest::default()
    };
    match &asked.begin {
        None => {}
        Some(Begin::Exact((time, state))) => {
            request.from = Some(MotionStart { time: *time, state: state.clone() });
        }
        Some(Begin::Named(given)) => {
            let pairs = given.iter().map(|(name, value)| Ok((name.as_str(), value.as_str())));
            request.start = start::named(system, pairs)?;
        }
        Some(Begin::State(_)) => {
            let allowed = "names of the state with their values";
            return Err(refused("--start", Fault::Value, allowed));
        }
    }
    Ok(request)
}
