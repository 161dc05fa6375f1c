//! `resonances`: where waves of a disc meet, and which dither frequency keeps speeds clear.

use quell::dataset::Dataset;
use quell::input::Inputs;
use quell::picture;
use quell::plot::Figure;
use quell::run::disc::resonances::{Order, Question, Resonances, run as resonances};
use quell::{DiscStudy, Failure, Subject, quantity};
use serde_json::Value as Json;

use super::refused;
use crate::answer::{Answer, NativeAnswer};
use crate::study::Pair;

struct Found {
    study: DiscStudy,
    done: Resonances,
}

impl Answer for Found {
    fn inputs(&self) -> Inputs {
        self.study.inputs()
    }

    fn json(&self) -> Json {
        self.done.json(&self.study)
    }

    fn datasets(&self) -> Vec<(&'static str, Dataset)> {
        vec![("resonances", self.done.dataset(&self.study))]
    }

    fn figure(&self) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::disc::resonances(&self.study, &self.done)))
    }
}

/// Answers.
pub(crate) fn run(
    subject: &Subject,
    order: &str,
    [speeds, clear, frequency]: [Option<Pair>; 3],
) -> Result<NativeAnswer, Failure> {
    let study = subject.the_disc()?.clone();
    let order = match order {
        "first" => Order::First,
        "second" => Order::Second,
        other => return Err(refused("order", other, "\"first\" or \"second\"")),
    };
    let range = |pair: &Option<Pair>, option| -> Result<Option<(f64, f64)>, Failure> {
        let Some((from, to)) = pair else { return Ok(None) };
        let read = |text: &str| quantity::frequency(text, Some(&study), option);
        Ok(Some((read(from)?, read(to)?)))
    };
    // Without a range, those of the command line.
    let speeds = range(&speeds, "--speeds")?.unwrap_or((0.0, 1.0));
    let (clear, frequency) = (range(&clear, "--clear")?, range(&frequency, "--frequency")?);
    let question = Question::new(speeds, order, clear, frequency)?;
    let done = resonances(&study, question)?;
    Ok(NativeAnswer::new(Found { study, done }))
}
