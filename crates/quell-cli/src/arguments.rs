//! Arguments that several verbs share, and complaints gathered from all of them.

use std::path::PathBuf;

use clap::Args;
use quell::input::Inputs;
use quell::outcome::Outcome;
use quell::output::Output;
use quell::picture::{self, EXTENSIONS};
use quell::study::document::Node;
use quell::{Change, Complaint, Failure, Study};
use serde_json::Value as Json;

use crate::answer::Answer;

/// The study and its changes.
#[derive(Debug, Args)]
pub(crate) struct StudyArguments {
    /// Study file (TOML); - is standard input
    #[arg(value_name = "STUDY")]
    study: PathBuf,
    /// Changes a value of the study, such as dither[1].amplitude=0.3
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Replaces the tolerance of [solver]
    #[arg(long, value_name = "ε", allow_hyphen_values = true)]
    tolerance: Option<String>,
    /// Prints one JSON object on standard output and nothing else
    #[arg(long)]
    pub(crate) json: bool,
}

impl StudyArguments {
    /// Reads and checks the study, of any kind.
    pub(crate) fn read(&self) -> Result<Study, Failure> {
        let mut complaints = Gathered::default();
        let mut changes: Vec<Change> = self
            .set
            .iter()
            .filter_map(|text| complaints.take(Change::parse(text, "--set")))
            .collect();
        changes.extend(self.tolerance.iter().map(|text| Change {
            path: "solver.tolerance".to_owned(),
            node: Node::from_argument(text, "--tolerance"),
        }));
        let study = complaints.take(Study::read(&self.study, &changes));
        complaints.finish(study)
    }
}

/// The files that a study was read from: none where it could not be read, which ends the work anyway.
pub(crate) fn inputs(study: Option<&Study>) -> Inputs {
    study.map_or(Inputs::NONE, Study::inputs)
}

/// Where the picture goes.
#[derive(Debug, Args)]
pub(crate) struct PlotArguments {
    /// Draws the answer into a picture file
    #[arg(long, value_name = "FILE.svg|.png")]
    plot: Option<PathBuf>,
}

impl PlotArguments {
    /// Whether a picture is asked for.
    pub(crate) fn asked(&self) -> bool {
        self.plot.is_some()
    }

    /// Tries whether the picture can be written, and is not one of the inputs.
    pub(crate) fn prepare(&self, inputs: &Inputs) -> Result<Plot, Failure> {
        let prepare = |path| Output::prepare(path, "--plot", EXTENSIONS, inputs);
        let output = self.plot.as_deref().map(prepare);
        Ok(Plot { output: output.transpose()? })
    }
}

/// A picture to be drawn, or none.
#[derive(Debug)]
pub(crate) struct Plot {
    output: Option<Output>,
}

impl Plot {
    /// Whether there is one to be drawn.
    pub(crate) fn wanted(&self) -> bool {
        self.output.is_some()
    }

    /// No picture.
    pub(crate) fn none() -> Self {
        Self { output: None }
    }

    /// Draws the picture of an outcome and adds its path to the object.
    pub(crate) fn write(self, outcome: &dyn Outcome, object: &mut Json) -> Result<(), Failure> {
        let Some(output) = self.output else { return Ok(()) };
        let figure = outcome.figure().unwrap_or_else(|| {
            let allowed = "this answer has no picture";
            Err(Complaint::option("--plot", Json::Null, allowed).into())
        });
        object["plotted"] = picture::write(&figure?, output)?.into();
        Ok(())
    }
}

/// Where the numbers go besides standard output.
#[derive(Debug, Args)]
pub(crate) struct OutputArguments {
    /// Saves the computed numbers as a table
    #[arg(long, value_name = "FILE.csv")]
    save: Option<PathBuf>,
}

/// Outputs that were proven to be writable.
#[derive(Debug)]
pub(crate) struct Outputs {
    save: Vec<Output>,
}

impl OutputArguments {
    /// Whether numbers are to be saved.
    pub(crate) fn saves(&self) -> bool {
        self.save.is_some()
    }

    /// Tries every output, none of which is one of the inputs; `parts` name further files beside the first.
    pub(crate) fn prepare(&self, parts: &[&str], inputs: &Inputs) -> Result<Outputs, Failure> {
        let mut save = Vec::new();
        if let Some(path) = &self.save {
            let first = Output::prepare(path, "--save", &["csv"], inputs)?;
            for part in parts {
                save.push(first.sibling(part, "--save", inputs)?);
            }
            save.insert(0, first);
        }
        Ok(Outputs { save })
    }
}

impl Outputs {
    /// No output.
    pub(crate) fn none() -> Self {
        Self { save: Vec::new() }
    }

    /// Writes the datasets of an outcome, one a file, and adds their paths to the object.
    fn write(self, outcome: &dyn Outcome, object: &mut Json) -> Result<(), Failure> {
        if self.save.is_empty() {
            return Ok(());
        }
        let mut saved = Vec::new();
        for (output, (_, dataset)) in self.save.into_iter().zip(outcome.datasets()) {
            saved.push(output.write(dataset.csv().as_bytes())?.display().to_string());
        }
        object["saved"] = saved.into();
        Ok(())
    }
}

/// The answer with its files: datasets saved, picture drawn.
pub(crate) fn answer(
    json: bool,
    outcome: &dyn Outcome,
    outputs: Outputs,
    plot: Plot,
) -> Result<Answer, Failure> {
    let mut object = outcome.json();
    outputs.write(outcome, &mut object)?;
    plot.write(outcome, &mut object)?;
    Ok(Answer::new(json, &object, || outcome.text()))
}

/// Complaints gathered from several places, reported together.
#[derive(Debug, Default)]
pub(crate) struct Gathered {
    wrong: Vec<Complaint>,
    failed: Option<Failure>,
}

impl Gathered {
    /// The value, or nothing and one more thing to complain about.
    pub(crate) fn take<T>(&mut self, result: Result<T, impl Into<Failure>>) -> Option<T> {
        match result.map_err(Into::into) {
            Ok(value) => return Some(value),
            Err(Failure::Wrong(complaints)) => self.wrong.extend(complaints),
            Err(failure @ Failure::Failed { .. }) => self.failed = Some(failure),
        }
        None
    }

    /// The value where there is nothing to complain about.
    pub(crate) fn finish<T>(self, value: Option<T>) -> Result<T, Failure> {
        match (value, self.failed) {
            (Some(value), None) if self.wrong.is_empty() => Ok(value),
            (_, Some(failure)) if self.wrong.is_empty() => Err(failure),
            _ => Err(self.wrong.into()),
        }
    }
}
