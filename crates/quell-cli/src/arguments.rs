//! Arguments that several verbs share, and complaints gathered from all of them.

use std::path::PathBuf;

use clap::Args;
use quell::dataset::Dataset;
use quell::input::Inputs;
use quell::output::Output;
use quell::picture::{self, EXTENSIONS};
use quell::plot::Figure;
use quell::study::mirror::Node;
use quell::{Change, Complaint, DiscStudy, Failure, Study, Subject};
use serde_json::Value as Json;

/// The study and its changes.
#[derive(Debug, Args)]
pub(crate) struct StudyArguments {
    /// Study file (TOML); - is standard input
    #[arg(value_name = "STUDY")]
    study: PathBuf,
    /// Changes a value of the study, such as dither[1].amplitude=0.3
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Replaces the tolerance in [solver]
    #[arg(long, value_name = "ε", allow_hyphen_values = true)]
    tolerance: Option<String>,
    /// Prints one JSON object on standard output and nothing else
    #[arg(long)]
    pub(crate) json: bool,
}

impl StudyArguments {
    /// Reads and checks the study of a belt.
    pub(crate) fn read(&self) -> Result<Study, Failure> {
        Ok(self.read_any()?.the_belt()?.clone())
    }

    /// Reads and checks the study of a disc.
    pub(crate) fn read_disc(&self) -> Result<DiscStudy, Failure> {
        Ok(self.read_any()?.the_disc()?.clone())
    }

    /// Reads and checks the study, of whatever it is about.
    pub(crate) fn read_any(&self) -> Result<Subject, Failure> {
        let mut complaints = Complaints::default();
        let mut changes: Vec<Change> = self
            .set
            .iter()
            .filter_map(|text| complaints.take(Change::parse(text, "--set")))
            .collect();
        changes.extend(self.tolerance.iter().map(|text| Change {
            path: "solver.tolerance".to_owned(),
            node: Node::from_argument(text, "--tolerance"),
        }));
        let study = complaints.take(Subject::read(&self.study, &changes));
        complaints.finish(study)
    }
}

/// The files that a study was read from: none where it could not be read, which ends the work anyway.
pub(crate) fn inputs<S>(study: Option<&S>, of: impl Fn(&S) -> Inputs) -> Inputs {
    study.map_or(Inputs::NONE, of)
}

/// Where the picture goes.
#[derive(Debug, Args)]
pub(crate) struct PlotArguments {
    /// Draws a picture
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

    /// Draws what can fail to be drawn, and adds its path to the object.
    pub(crate) fn try_write(
        self,
        figure: impl FnOnce() -> Result<Figure, Failure>,
        object: &mut Json,
    ) -> Result<(), Failure> {
        if let Some(output) = self.output {
            object["plotted"] = picture::write(&figure()?, output)?.into();
        }
        Ok(())
    }

    /// Draws it and adds its path to the object.
    pub(crate) fn write(
        self,
        figure: impl FnOnce() -> Figure,
        object: &mut Json,
    ) -> Result<(), Failure> {
        self.try_write(|| Ok(figure()), object)
    }
}

/// Where the numbers go besides standard output.
#[derive(Debug, Args)]
pub(crate) struct OutputArguments {
    /// Saves the numbers
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
                save.push(first.beside(part, "--save", inputs)?);
            }
            save.insert(0, first);
        }
        Ok(Outputs { save })
    }
}

impl Outputs {
    /// Writes the datasets, one a file, and adds their paths to the object.
    pub(crate) fn write(self, datasets: &[Dataset], object: &mut Json) -> Result<(), Failure> {
        let mut saved = Vec::new();
        for (output, dataset) in self.save.into_iter().zip(datasets) {
            saved.push(output.write(dataset.csv().as_bytes())?.display().to_string());
        }
        if !saved.is_empty() {
            object["saved"] = saved.into();
        }
        Ok(())
    }
}

/// Complaints from several places, told at once.
#[derive(Debug, Default)]
pub(crate) struct Complaints {
    wrong: Vec<Complaint>,
    failed: Option<Failure>,
}

impl Complaints {
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
            _ => Err(Failure::Wrong(self.wrong)),
        }
    }
}
