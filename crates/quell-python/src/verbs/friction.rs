//! `friction`: the law and what the dither makes of it.

use quell::dataset::Dataset;
use quell::input::Inputs;
use quell::picture;
use quell::plot::Figure;
use quell::run::friction::{FrictionCurve, grid, run as friction};
use quell::{Failure, Study, Subject, quantity};
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::refused;
use crate::answer::{Answer, NativeAnswer};

struct Curve {
    study: Study,
    done: FrictionCurve,
}

impl Answer for Curve {
    fn inputs(&self) -> Inputs {
        self.study.inputs()
    }

    fn json(&self) -> Json {
        self.done.json(&self.study)
    }

    fn datasets(&self) -> Vec<(&'static str, Dataset)> {
        vec![("friction", self.done.dataset(&self.study))]
    }

    fn figure(&self) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::friction(&self.study, &self.done)))
    }
}

/// Answers.
pub(crate) fn run(
    subject: &Subject,
    at: Option<Vec<f64>>,
    texts: &[String],
) -> Result<NativeAnswer, Failure> {
    let study = subject.the_belt()?.clone();
    let scales = study.scales();
    if let Some(wrong) = at.iter().flatten().find(|v| !v.is_finite()) {
        return Err(refused("at", wrong.to_string(), "finite slip velocities"));
    }
    let scaled = |v: f64| scales.map_or(v, |scales| scales.from_si(Quantity::Velocity, v));
    let read = |text: &String| quantity::parse(text, Quantity::Velocity, scales, "--at");
    let at = match (at, texts) {
        (Some(at), _) => at.into_iter().map(scaled).collect(),
        (None, []) => grid(study.belt()),
        (None, texts) => texts.iter().map(read).collect::<Result<Vec<f64>, _>>()?,
    };
    let done = friction(&study, &at);
    Ok(NativeAnswer::new(Curve { study, done }))
}
