//! `receptance`: displacement over force between rows of a system, over frequency.

use quell::run::system::receptance::{ContactsAre, ReceptanceRequest};
use quell::verbs::verbs;
use quell::{Failure, RealInterval, Study, quantity};

use crate::answer::NativeAnswer;
use crate::arguments::Pair;

/// Runs the verb.
pub(crate) fn run(
    study: &Study,
    [outputs, inputs]: [Vec<String>; 2],
    contacts: &str,
    (frequency, points, at): &(Option<Pair>, Option<usize>, Vec<String>),
) -> Result<NativeAnswer, Failure> {
    let read = |text: &str| quantity::dither_frequency(text, Some(study), "--frequency");
    let frequency = match frequency {
        Some((from, to)) => Some(RealInterval::new(read(from)?, read(to)?)),
        None => None,
    };
    let listed = at.iter().map(|text| quantity::dither_frequency(text, Some(study), "--at"));
    let at: Vec<f64> = listed.collect::<Result<_, _>>()?;
    let contacts = ContactsAre::from_name(contacts)?;
    let request = ReceptanceRequest { outputs, inputs, contacts, frequency, points: *points, at };
    Ok(NativeAnswer::new(verbs(study).receptance(&request)?))
}
