//! `response`: the steady response, the effect of the dither on it, and the cost of the dither.

use quell::kind::verbs;
use quell::run::system::response::ResponseRequest;
use quell::{Complaint, Failure, Fault, Origin, Study, quantity};

use crate::answer::NativeAnswer;

/// Runs the verb for runs under noise with different seeds; `times` as in [`run`].
pub(crate) fn of_seeds(
    study: &Study,
    seeds: Option<usize>,
    times: (Option<&str>, Option<&str>),
) -> Result<NativeAnswer, Failure> {
    let times = request(study, times)?.unwrap_or_default();
    Ok(NativeAnswer::new(verbs(study).response_of_seeds(seeds, times)?))
}

/// Runs the verb; `times`: the settling time and the length of the record of a system.
pub(crate) fn run(
    study: &Study,
    times: (Option<&str>, Option<&str>),
) -> Result<NativeAnswer, Failure> {
    match request(study, times)? {
        Some(times) => Ok(NativeAnswer::new(verbs(study).response_after(times)?)),
        None => Ok(NativeAnswer::new(verbs(study).response()?)),
    }
}

/// The settling time and the length of the record of a system; `None` of other kinds, whose solver has them.
fn request(
    study: &Study,
    times: (Option<&str>, Option<&str>),
) -> Result<Option<ResponseRequest>, Failure> {
    let Ok(system) = study.system() else {
        for (option, text) in [("--settle", times.0), ("--record", times.1)] {
            if let Some(text) = text {
                let allowed = "left out: the solver of the study has settle and record_periods";
                let origin = Origin::Argument(option);
                return Err(Complaint::new(Fault::Conflict, option, origin, text, allowed).into());
            }
        }
        return Ok(None);
    };
    let read = |option, text: Option<&str>| {
        let read = |text| quantity::duration_of_system(text, system.units(), option);
        text.map(read).transpose()
    };
    let [settle, record] = [read("--settle", times.0)?, read("--record", times.1)?];
    Ok(Some(ResponseRequest { settle, record }))
}
