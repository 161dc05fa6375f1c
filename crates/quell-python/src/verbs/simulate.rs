//! `simulate`: one trajectory with its events.

use quell::run::simulate::{MotionRequest, MotionStart};
use quell::run::system::start;
use quell::sound::SoundOptions;
use quell::study::{SystemStudy, UnitSystem};
use quell::verbs::verbs;
use quell::{Complaint, Failure, Study};

use crate::answer::NativeAnswer;
use crate::arguments::{NamedNumbers, Pair};

/// The options of a sound as they are given: transposition and gain.
pub(crate) type SoundTexts = (Option<String>, Option<String>);

/// Where a run begins.
#[derive(pyo3::FromPyObject)]
pub(crate) enum Begin {
    /// A time and a state in the units of the study, such as those at the end of another run.
    Exact((f64, Vec<f64>)),
    /// Displacement and velocity of one coordinate, as texts, and the time, if it is not 0.
    State((Pair, Option<String>)),
    /// Names of the state with their values.
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
    let request = request_of(&study.system(), asked)?;
    Ok(NativeAnswer::new(verbs(study).simulate(&request)?))
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

fn options(units: UnitSystem, (transpose, gain): &SoundTexts) -> Result<SoundOptions, Failure> {
    let mut options = SoundOptions::default();
    if let Some(text) = transpose {
        options.transposition = SoundOptions::transposition(text)?;
    }
    if let Some(text) = gain {
        options.gain = Some(SoundOptions::gain(text, units)?);
    }
    Ok(options)
}

fn request_of(system: &SystemStudy, asked: &GivenRun) -> Result<MotionRequest, Failure> {
    let read = |text: &str, option| start::duration(system, text, option);
    // The last of the times is the usual end: a complaint is about the times.
    let times = in_time(asked.times.as_ref(), read)?;
    let mut request = MotionRequest {
        until: asked.until.as_deref().map(|text| read(text, "--until")).transpose()?,
        times,
        events: asked.kept.0,
        samples: asked.kept.1,
        sound: asked.sound.as_ref().map(|sound| options(system.units(), sound)).transpose()?,
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
        Some(Begin::State((pair, time))) => {
            let numbers = start::pair(system, (&pair.0, &pair.1))?;
            let time = time.as_deref().map(|text| read(text, "--start")).transpose()?;
            match time {
                None => request.start = numbers,
                Some(time) => {
                    let begin = start::start_with(system, &numbers)?;
                    request.from = Some(MotionStart { time, ..begin });
                }
            }
        }
    }
    Ok(request)
}
