//! The times of samples that a caller gives.

use serde_json::Value as Json;

use crate::complaint::{Complaint, Failure};

/// Whether a run from `start` to `until` moves forwards and has every time of a sample, in ascending order.
///
/// # Errors
/// A complaint about the end, or about the first time that is out of range or out of order.
pub(crate) fn are_within(start: f64, until: f64, times: Option<&[f64]>) -> Result<(), Failure> {
    if until < start {
        let allowed = format!("a time at or after that of the start, {start}");
        return Err(Complaint::option("--until", until, &allowed).into());
    }
    let times = times.unwrap_or_default();
    let wrong = |time: &f64| !(start <= *time && *time <= until);
    if let Some(time) = times.iter().find(|time| wrong(time)) {
        let allowed = format!("within the run, from {start} to {until}");
        return Err(Complaint::option("t_eval", shown(*time), &allowed).into());
    }
    if let Some(pair) = times.windows(2).find(|pair| pair[1] < pair[0]) {
        let allowed = "in ascending order";
        return Err(Complaint::option("t_eval", shown(pair[1]), allowed).into());
    }
    Ok(())
}

/// A number as it is shown; JSON has no NaN.
fn shown(time: f64) -> Json {
    if time.is_finite() { time.into() } else { time.to_string().into() }
}
