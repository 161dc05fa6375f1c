//! The moments of a study that options name: a time in the units of its study, and the steady study of that time.

use super::system::start::duration;
use crate::complaint::{Complaint, Failure};
use crate::study::Study;

/// Reads a time of a study into the units of its system.
///
/// # Errors
/// A complaint about `option`.
pub fn moment(study: &Study, text: &str, option: &'static str) -> Result<f64, Failure> {
    Ok(duration(&study.system(), text, option)?)
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
