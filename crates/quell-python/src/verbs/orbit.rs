//! `orbit`: the periodic response and its Floquet multipliers.

use quell::input::Inputs;
use quell::picture;
use quell::plot::Figure;
use quell::run::orbit::{Response, Wanted, run as orbit};
use quell::{Failure, Study, Subject};
use serde_json::Value as Json;

use super::thresholds::protocols;
use crate::answer::{Answer, NativeAnswer};

struct Found {
    study: Study,
    done: Response,
}

impl Answer for Found {
    fn inputs(&self) -> Inputs {
        self.study.inputs()
    }

    fn json(&self) -> Json {
        self.done.json(&self.study)
    }

    fn figure(&self) -> Option<Result<Figure, Failure>> {
        Some(picture::periodic_response(&self.study, &self.done))
    }
}

/// Answers; `after`: names of a start, or a start of its own, whose run is followed.
pub(crate) fn run(
    subject: &Subject,
    near: Option<(f64, f64)>,
    periods: u32,
    after: &[String],
    start: Option<(f64, f64)>,
) -> Result<NativeAnswer, Failure> {
    let study = subject.the_belt()?.clone();
    let wanted = match (protocols(after, start).into_iter().next(), near) {
        (Some(protocol), _) => Wanted::After(protocol),
        (None, Some(state)) => Wanted::Near { state, periods },
        (None, None) => Wanted::OfSliding { periods },
    };
    let done = orbit(&study, wanted)?;
    Ok(NativeAnswer::new(Found { study, done }))
}
