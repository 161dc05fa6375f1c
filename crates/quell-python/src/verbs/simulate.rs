//! `simulate`: one trajectory with its events.

use quell::kind::verbs;
use quell::run::simulate::Options;
use quell::sound::SoundOptions;
use quell::{Failure, Study, quantity};

use crate::answer::NativeAnswer;

/// The options of a sound as they are given: transposition and gain.
pub(crate) type SoundTexts = (Option<String>, Option<String>);

/// Runs the verb.
pub(crate) fn run(
    study: &Study,
    until: &str,
    (events, samples): (bool, bool),
    sound: Option<&SoundTexts>,
) -> Result<NativeAnswer, Failure> {
    let verbs = verbs(study);
    let until = quantity::duration(until, study.scales(), "--until")?;
    let sound = sound.map(|sound| options(study, sound)).transpose()?;
    let options = Options { events, samples, undithered: false, sound };
    Ok(NativeAnswer::new(verbs.simulate(until, options)?))
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
