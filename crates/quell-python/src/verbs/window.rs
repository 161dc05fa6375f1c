//! `window`: what a run does between two of its times, and the steady study of a moment.

use quell::kind::verbs;
use quell::run::system::start::duration as duration_of_motion;
use quell::{Complaint, Failure, Study, quantity};

use crate::answer::NativeAnswer;

/// Runs the verb between two times.
pub(crate) fn run(study: &Study, (start, end): (&str, &str)) -> Result<NativeAnswer, Failure> {
    let window = (moment(study, start, "--window")?, moment(study, end, "--window")?);
    Ok(NativeAnswer::new(verbs(study).response_within(window)?))
}

/// The steady study of a moment.
pub(crate) fn at_time(study: &Study, text: &str) -> Result<Study, Failure> {
    if study.varies_by().is_none() {
        let allowed = "left out: nothing varies in time in this study";
        return Err(Complaint::option("--at-time", text, allowed).into());
    }
    Ok(study.at_time(moment(study, text, "--at-time")?)?)
}

fn moment(study: &Study, text: &str, option: &'static str) -> Result<f64, Failure> {
    Ok(match (study.system(), study.disc()) {
        (Ok(system), _) => duration_of_motion(&system, text, option)?,
        (_, Ok(disc)) => quantity::time_of_disc(text, &disc, option)?,
        _ => quantity::duration(text, study.scales(), option)?,
    })
}
