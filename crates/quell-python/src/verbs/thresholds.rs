//! `thresholds`: exact values of a parameter at which the response changes, and curves of them in two.

use quell::dataset::Dataset;
use quell::input::Inputs;
use quell::picture;
use quell::plot::Figure;
use quell::run::curves::{Curves, Question as Plane, run as curves};
use quell::run::thresholds::{Protocol, Question, Thresholds, run as thresholds};
use quell::{Failure, Study, Subject, quantity};
use serde_json::Value as Json;

use crate::answer::{Answer, NativeAnswer};
use crate::study::{Pair, ends, state};

struct OnALine {
    study: Study,
    done: Thresholds,
}

impl Answer for OnALine {
    fn inputs(&self) -> Inputs {
        self.study.inputs()
    }

    fn json(&self) -> Json {
        self.done.json(&self.study)
    }

    fn figure(&self) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::thresholds(&self.study, &self.done)))
    }
}

struct InAPlane {
    study: Study,
    done: Curves,
}

impl Answer for InAPlane {
    fn inputs(&self) -> Inputs {
        self.study.inputs()
    }

    fn json(&self) -> Json {
        self.done.json(&self.study)
    }

    fn datasets(&self) -> Vec<(&'static str, Dataset)> {
        vec![("curves", self.done.dataset(&self.study))]
    }

    fn figure(&self) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::curves(&self.study, &self.done)))
    }
}

/// Protocols by the names of their fields, and one from a state.
pub(crate) fn protocols(names: &[String], start: Option<(f64, f64)>) -> Vec<Protocol> {
    let known = [Protocol::Rest, Protocol::Sliding, Protocol::Squeal];
    let asked = known.into_iter().filter(|it| names.iter().any(|name| name == it.name()));
    asked.chain(start.map(|(x, v)| Protocol::From(x, v))).collect()
}

/// Answers; `range`: the values of the parameter that are searched.
pub(crate) fn run(
    subject: &Subject,
    parameter: String,
    range: &Pair,
    (names, start): (&[String], Option<&Pair>),
    ramp: &str,
) -> Result<NativeAnswer, Failure> {
    let study = subject.the_belt()?.clone();
    let scales = study.scales();
    let (from, to) = ends(&parameter, range)?;
    let start = start.map(|pair| state(pair, scales, "--start")).transpose()?;
    let ramp = quantity::duration(ramp, scales, "--ramp")?;
    let protocols = protocols(names, start);
    let done = thresholds(&study, Question { parameter, from, to, protocols, ramp })?;
    Ok(NativeAnswer::new(OnALine { study, done }))
}

/// Answers; `between`: the window of the second parameter.
pub(crate) fn run_along(
    subject: &Subject,
    parameter: String,
    range: &Pair,
    along: String,
    between: &Pair,
) -> Result<NativeAnswer, Failure> {
    let study = subject.the_belt()?.clone();
    let window = ends(&parameter, range)?;
    let value = |text: &str| quantity::value_of_key(text, &along, "--between");
    let between = (value(&between.0)?, value(&between.1)?);
    let done = curves(&study, &Plane { parameter, window, along, between })?;
    Ok(NativeAnswer::new(InAPlane { study, done }))
}
