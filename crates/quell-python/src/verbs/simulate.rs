//! `simulate`: one trajectory with its events.

use quell::dataset::Dataset;
use quell::input::Inputs;
use quell::picture;
use quell::plot::Figure;
use quell::run::simulate::{Options, Simulation, run as simulate};
use quell::{Failure, Study, Subject, quantity};
use serde_json::Value as Json;

use crate::answer::{Answer, NativeAnswer};

struct Trajectory {
    study: Study,
    until: f64,
    done: Simulation,
}

impl Answer for Trajectory {
    fn inputs(&self) -> Inputs {
        self.study.inputs()
    }

    fn json(&self) -> Json {
        self.done.json(&self.study)
    }

    fn datasets(&self) -> Vec<(&'static str, Dataset)> {
        match self.done.samples {
            Some(_) => vec![("trajectory", self.done.dataset(&self.study))],
            None => Vec::new(),
        }
    }

    fn figure(&self) -> Option<Result<Figure, Failure>> {
        // The picture shows the run without dither beside this one.
        let options = Options { events: false, samples: true, undithered: true };
        let both = simulate(&self.study, self.until, options);
        Some(both.map(|both| picture::simulate(&self.study, &both)))
    }
}

/// Answers.
pub(crate) fn run(
    subject: &Subject,
    until: &str,
    events: bool,
    samples: bool,
) -> Result<NativeAnswer, Failure> {
    let study = subject.the_belt()?.clone();
    let time = quantity::duration(until, study.scales(), "--until")?;
    let done = simulate(&study, time, Options { events, samples, undithered: false })?;
    Ok(NativeAnswer::new(Trajectory { study, until: time, done }))
}
