//! The moments of a study that options name: a time in the units of its study, and the steady study of that time.

use super::system::start::duration;
use crate::complaint::{Complaint, Failure};
use crate::quantity;
use crate::study::Study;

/// Reads a time of a study of any kind into the numbers of its equations.
///
/// # Errors
/// A complaint about `option`.
pub fn moment(study: &Study, text: &str, option: &'static str) -> Result<f64, Failure> {
    Ok(match (study.system(), study.disc()) {
        (Ok(system), _) => duration(&system, text, option)?,
        (_, Ok(disc)) => quantity::time_of_disc(text, &disc, option)?,
        _ => quantity::duration(text, study.scales(), option)?,
    })
}

/// The steady study of the moment that `--at-time` names.
///
/// # Errors
/// A complaint where nothing varies in time, about the time, or about the study of that moment.
pub fn at_time(study: &Study, text: &str) -> Result<Study, Failure> {
    const OPTION: &str = "--at-time";
    if study.varies_by().is_none() {
        let allowed = "left out: nothing varies in time in this study";
        return Err(Complaint::option(OPTION, text, allowed).into());
    }
    Ok(study.at_time(moment(study, text, OPTION)?)?)
}
