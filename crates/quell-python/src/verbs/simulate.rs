//! `simulate`: one trajectory with its events.

use quell::kind::{moving_system, verbs};
use quell::run::simulate::Options;
use quell::run::system::simulate::MotionRequest;
use quell::run::system::start;
use quell::sound::SoundOptions;
use quell::study::SystemStudy;
use quell::{Complaint, Failure, Fault, Origin, Study, quantity};

use crate::answer::NativeAnswer;

/// The options of a sound as they are given: transposition and gain.
pub(crate) type SoundTexts = (Option<String>, Option<String>);

/// Runs the verb. `until` and `start` are texts: a time, and names of a state with their values.
pub(crate) fn run(
    study: &Study,
    until: Option<&str>,
    kept: (bool, bool),
    start: &[(String, String)],
    sound: Option<&SoundTexts>,
) -> Result<NativeAnswer, Failure> {
    if let Some(system) = moving_system(study) {
        let sound = sound.map(|sound| options(study, sound)).transpose()?;
        let request = of_system(&system, until, kept, start, sound)?;
        return Ok(NativeAnswer::new(verbs(study).simulate_from(&request)?));
    }
    let refused = |option: &'static str, fault, allowed: &str| {
        let origin = Origin::Argument(option);
        Failure::from(Complaint::new(fault, option, origin, serde_json::Value::Null, allowed))
    };
    if !start.is_empty() {
        let allowed = "left out: the start of a belt is its initial state";
        return Err(refused("--start", Fault::Conflict, allowed));
    }
    let until = until
        .ok_or_else(|| refused("--until", Fault::Missing, "a time: only systems have a default"))?;
    let until = quantity::duration(until, study.scales(), "--until")?;
    let sound = sound.map(|sound| options(study, sound)).transpose()?;
    let options = Options { events: kept.0, samples: kept.1, undithered: false, sound };
    Ok(NativeAnswer::new(verbs(study).simulate(until, options)?))
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
    study: &SystemStudy,
    until: Option<&str>,
    (events, samples): (bool, bool),
    given: &[(String, String)],
    sound: Option<SoundOptions>,
) -> Result<MotionRequest, Failure> {
    let read = |text| start::duration(study, text, "--until");
    let until = until.map(read).transpose()?;
    let pairs = given.iter().map(|(name, value)| Ok((name.as_str(), value.as_str())));
    Ok(MotionRequest { until, start: start::named(study, pairs)?, events, samples, sound })
}
