//! `resonances`: where waves of a disc meet, and which dither frequency keeps speeds clear.

use quell::dataset::Dataset;
use quell::picture;
use quell::plot::Figure;
use quell::run::disc::resonances::{Order, Question, Resonances, run as resonances};
use quell::{DiscStudy, Failure, Subject};
use serde_json::{Value as Json, json};
use std::ops::RangeInclusive;

use super::refused;
use crate::answer::{Answer, NativeAnswer};
use crate::study::disc;

struct Found {
    study: DiscStudy,
    done: Resonances,
}

impl Answer for Found {
    fn json(&self) -> Json {
        self.done.json()
    }

    fn datasets(&self) -> Vec<(&'static str, Dataset)> {
        vec![("resonances", self.done.dataset(&self.study))]
    }

    fn figure(&self) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::disc::resonances(&self.study, &self.done)))
    }

    fn warnings(&self) -> Vec<String> {
        self.study.warnings().to_vec()
    }
}

/// Answers.
pub(crate) fn run(
    subject: &Subject,
    speeds: (f64, f64),
    order: &str,
    clear: Option<(f64, f64)>,
    frequency: Option<(f64, f64)>,
) -> Result<NativeAnswer, Failure> {
    let study = disc(subject)?.clone();
    let mut wrong = Vec::new();
    let mut range = |argument, (from, to): (f64, f64)| -> RangeInclusive<f64> {
        if !(from.is_finite() && to.is_finite() && from <= to) {
            let allowed = "two numbers of which the first is not larger";
            wrong.push(refused(argument, json!([from, to]), allowed));
        }
        from..=to
    };
    let speeds = range("speeds", speeds);
    let clear = clear.map(|it| range("clear", it));
    let frequency = frequency.map(|it| range("frequency", it));
    let order = match order {
        "second" => Order::Second,
        "first" => Order::First,
        other => {
            wrong.push(refused("order", other, "\"first\" or \"second\""));
            Order::First
        }
    };
    if frequency.as_ref().is_some_and(|range| *range.start() <= 0.0) {
        wrong.push(refused("frequency", Json::Null, "frequencies above 0"));
    }
    if clear.is_some() != frequency.is_some() {
        wrong.push(refused("clear", Json::Null, "given together with frequency"));
    }
    if !wrong.is_empty() {
        let complaints = wrong.into_iter().filter_map(|failure| match failure {
            Failure::Wrong(complaints) => Some(complaints),
            Failure::Failed { .. } => None,
        });
        return Err(Failure::Wrong(complaints.flatten().collect()));
    }
    let question = Question { speeds, order, clear: clear.zip(frequency) };
    let done = resonances(&study, question)?;
    Ok(NativeAnswer::new(Found { study, done }))
}
