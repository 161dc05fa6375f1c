//! `simulate`: one trajectory with its events.

use quell::dataset::Dataset;
use quell::picture;
use quell::plot::Figure;
use quell::run::simulate::{MOST_SAMPLES, Options, Simulation, run as simulate};
use quell::{Failure, Study, Subject, quantity};
use serde_json::Value as Json;

use crate::answer::{Answer, NativeAnswer};

struct Trajectory {
    study: Study,
    until: f64,
    done: Simulation,
}

impl Answer for Trajectory {
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

    fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        if self.done.coarse {
            warnings.push(format!(
                "only {MOST_SAMPLES} samples are kept; they are coarser than the dither deserves"
            ));
        }
        let releases = self.done.end.near_tangential_releases;
        if releases > 0 {
            warnings.push(format!(
                "{releases} releases hardly crossed the threshold: forward uniqueness is not guaranteed \
                 there"
            ));
        }
        warnings
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
    let time = quantity::duration(until, study.scales(), "until")?;
    let done = simulate(&study, time, Options { events, samples, undithered: false })?;
    Ok(NativeAnswer::new(Trajectory { study, until: time, done }))
}
