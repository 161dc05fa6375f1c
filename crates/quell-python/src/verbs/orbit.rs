//! `orbit`: the periodic response and its Floquet multipliers.

use quell::dataset::Dataset;
use quell::input::Inputs;
use quell::picture;
use quell::plot::Figure;
use quell::run::orbit::{Response, Wanted, run as orbit};
use quell::{Failure, Study, Subject};
use serde_json::Value as Json;

use super::thresholds::protocols;
use crate::answer::{Answer, NativeAnswer};
use crate::study::{Pair, state};

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

    fn datasets(&self) -> Vec<(&'static str, Dataset)> {
        self.done.dataset(&self.study).map(|dataset| ("orbit", dataset)).into_iter().collect()
    }

    fn figure(&self) -> Option<Result<Figure, Failure>> {
        Some(picture::periodic_response(&self.study, &self.done))
    }
}

/// Answers; `after`: names of a start, or a start of its own, whose run is followed.
pub(crate) fn run(
    subject: &Subject,
    near: Option<&Pair>,
    periods: u32,
    after: &[String],
    start: Option<&Pair>,
) -> Result<NativeAnswer, Failure> {
    let study = subject.the_belt()?.clone();
    let scales = study.scales();
    let near = near.map(|pair| state(pair, scales, "--near")).transpose()?;
    let start = start.map(|pair| state(pair, scales, "--start")).transpose()?;
    let wanted = match (protocols(after, start).into_iter().next(), near) {
        (Some(protocol), _) => Wanted::After(protocol),
        (None, Some(state)) => Wanted::Near { state, periods },
        (None, None) => Wanted::OfSliding { periods },
    };
    let done = orbit(&study, wanted)?;
    Ok(NativeAnswer::new(Found { study, done }))
}
