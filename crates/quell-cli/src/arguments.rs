//! Arguments shared by several verbs, and the collection of their complaints.

use std::path::{Path, PathBuf};

use clap::Args;
use quell::document::Node;
use quell::input::Inputs;
use quell::outcome::{Outcome, named};
use quell::output::Output;
use quell::picture::{self, EXTENSIONS, PicturePage, PictureWidth};
use quell::plot::Figure;
use quell::run::moment::at_time;
use quell::table_file::TableFormat;
use quell::verbs::verbs;
use quell::{Change, Complaint, Failure, Fault, Origin, Study};
use serde_json::Value as Json;

use crate::answer::Answer;

/// The study and its changes.
#[derive(Debug, Args)]
pub(crate) struct StudyArguments {
    /// Study file (TOML); - reads standard input
    #[arg(value_name = "STUDY")]
    study: PathBuf,
    /// Changes a value of the study, such as dither[1].amplitude=0.3; `quell schema` lists the keys
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Replaces the tolerance of [solver], in a study of a belt
    #[arg(long, value_name = "ε", allow_hyphen_values = true)]
    tolerance: Option<String>,
    /// Takes drives, loads and amplitudes that vary in time at this moment
    #[arg(long, value_name = "TIME", allow_hyphen_values = true)]
    at_time: Option<String>,
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
        let study = complaints.finish(study)?;
        match &self.at_time {
            Some(text) => at_time(&study, text),
            None => Ok(study),
        }
    }
}

/// The files that a study was read from; none if it could not be read, in which case nothing is computed anyway.
pub(crate) fn inputs(study: Option<&Study>) -> Inputs {
    study.map_or(Inputs::NONE, Study::inputs)
}

/// The option for the picture.
#[derive(Debug, Args)]
pub(crate) struct PlotArguments {
    /// Draws the answer into a picture file
    #[arg(long, value_name = "FILE.svg|.pdf|.png")]
    plot: Option<PathBuf>,
    /// Width of the picture with its unit, such as 85mm for the column of a journal [default: chosen to suit the panels]
    #[arg(long, value_name = "LENGTH", requires = "plot", allow_hyphen_values = true)]
    width: Option<String>,
    /// Draws the caption below the picture [default: only in the answer]
    #[arg(long, requires = "plot")]
    caption: bool,
    /// Omits the title above the picture
    #[arg(long, requires = "plot")]
    no_title: bool,
}

impl PlotArguments {
    /// Whether a picture is requested.
    pub(crate) fn asked(&self) -> bool {
        self.plot.is_some()
    }

    /// Checks that the picture can be written and does not replace one of the inputs.
    pub(crate) fn prepare(&self, inputs: &Inputs) -> Result<Plot, Failure> {
        let width = self.width.as_deref().map(|text| PictureWidth::parse(text, "--width"));
        let page = PicturePage {
            width: width.transpose()?,
            caption: self.caption,
            without_title: self.no_title,
        };
        let prepare = |path| Output::prepare(path, "--plot", EXTENSIONS, inputs);
        let output = self.plot.as_deref().map(prepare);
        Ok(Plot { output: output.transpose()?, page })
    }
}

/// The output of a picture, if one is requested.
#[derive(Debug)]
pub(crate) struct Plot {
    output: Option<Output>,
    page: PicturePage,
}

impl Plot {
    /// Whether a picture is requested.
    pub(crate) fn wanted(&self) -> bool {
        self.output.is_some()
    }

    /// Rejects a picture of an answer that has none, before anything is computed or written.
    pub(crate) fn drawn_by(self, study: Option<&Study>, verb: &str) -> Result<Self, Failure> {
        if self.wanted() && study.is_some_and(|study| !verbs(study).draws(verb)) {
            return Err(no_picture());
        }
        Ok(self)
    }

    /// No picture.
    pub(crate) fn none() -> Self {
        Self { output: None, page: PicturePage::default() }
    }

    /// Draws the picture of an outcome and adds its path to the object.
    pub(crate) fn write(self, outcome: &dyn Outcome, object: &mut Json) -> Result<(), Failure> {
        self.drawn(outcome)?.write(object)
    }

    /// The picture of an outcome, not written yet.
    fn drawn(self, outcome: &dyn Outcome) -> Result<Drawn, Failure> {
        let Some(output) = self.output else { return Ok(Drawn(None)) };
        let figure = outcome.figure().unwrap_or_else(|| Err(no_picture()));
        Ok(Drawn(Some((self.page.laid_out(figure?), output))))
    }
}

/// A picture with its output, if one is requested.
struct Drawn(Option<(Figure, Output)>);

impl Drawn {
    /// Writes the picture and adds its path and its caption to the object.
    fn write(self, object: &mut Json) -> Result<(), Failure> {
        if let Some((figure, output)) = self.0 {
            object["plotted"] = picture::write(&figure, output)?.into();
            object["caption"] = figure.plain_caption().into();
        }
        Ok(())
    }
}

/// The complaint about `--plot` where there is no picture.
fn no_picture() -> Failure {
    let (origin, allowed) = (Origin::Argument("--plot"), "this answer has no picture");
    Complaint::new(Fault::Conflict, "--plot", origin, Json::Null, allowed).into()
}

/// The option for the table of numbers.
#[derive(Debug, Args)]
pub(crate) struct OutputArguments {
    /// Saves the computed numbers as a table: FILE.csv, FILE.mat (MATLAB) or FILE.nc (NetCDF)
    #[arg(long, value_name = "FILE")]
    save: Option<PathBuf>,
}

/// Extension of a sound.
pub(crate) const WAV: &str = "wav";

/// Output files that have been checked to be writable.
#[derive(Debug)]
pub(crate) struct Outputs {
    save: Vec<Output>,
}

impl OutputArguments {
    /// Whether the numbers are to be saved.
    pub(crate) fn saves(&self) -> bool {
        self.save.is_some()
    }

    /// Checks that every output can be written and does not replace one of the inputs; `parts` name further files in the folder
    /// of the first.
    pub(crate) fn prepare(&self, parts: &[&str], inputs: &Inputs) -> Result<Outputs, Failure> {
        Outputs::prepare(self.save.as_deref(), &[], parts, inputs)
    }
}

impl Outputs {
    /// [`OutputArguments::prepare`] for a path with the extension of a table, or one of these extensions.
    pub(crate) fn prepare(
        path: Option<&Path>,
        further: &[&str],
        parts: &[&str],
        inputs: &Inputs,
    ) -> Result<Self, Failure> {
        let mut save = Vec::new();
        if let Some(path) = path {
            let extensions = [TableFormat::EXTENSIONS, further].concat();
            let first = Output::prepare(path, "--save", &extensions, inputs)?;
            let format = TableFormat::of_extension(&first.extension());
            if format == Some(TableFormat::Csv) {
                for part in parts {
                    save.push(first.sibling(part, "--save", inputs)?);
                }
            }
            save.insert(0, first);
        }
        Ok(Self { save })
    }

    /// No output.
    pub(crate) fn none() -> Self {
        Self { save: Vec::new() }
    }

    /// Writes the sound of an outcome, its file for another program, or its datasets, and adds the paths to the object.
    fn write(self, outcome: &dyn Outcome, object: &mut Json) -> Result<(), Failure> {
        let Some(first) = self.save.first() else { return Ok(()) };
        let extension = first.extension();
        let single = if extension == WAV { outcome.sound() } else { outcome.exported(&extension) };
        let contents = match single {
            Some(bytes) => vec![bytes?],
            None => match TableFormat::of_extension(&extension) {
                Some(format) => format.files(&outcome.datasets(), "--save")?,
                None => Vec::new(),
            },
        };
        if contents.is_empty() {
            let allowed = match TableFormat::of_extension(&extension) {
                None if extension != WAV => format!(
                    "--save: this answer has no form in a file .{extension}, which has the averaged friction of a belt"
                ),
                _ => {
                    "--save: this answer has no table: `orbit` has one of the motion that it finds, `attractor` one with --lyapunov"
                        .to_owned()
                }
            };
            let origin = Origin::Argument("--save");
            return Err(Complaint::new(Fault::Usage, "--save", origin, Json::Null, allowed).into());
        }
        let mut saved = Vec::new();
        for (output, content) in self.save.into_iter().zip(contents) {
            saved.push(output.write(&content)?.display().to_string());
        }
        object["saved"] = saved.into();
        Ok(())
    }
}

/// Writes the datasets and the picture of an outcome and returns its answer.
pub(crate) fn answer(
    json: bool,
    outcome: &dyn Outcome,
    outputs: Outputs,
    plot: Plot,
) -> Result<Answer, Failure> {
    let mut object = named(outcome, outcome.json());
    let drawn = plot.drawn(outcome)?;
    outputs.write(outcome, &mut object)?;
    drawn.write(&mut object)?;
    Ok(Answer::new(json, &object, || with_caption(outcome.text(), &object)))
}

/// The text of an answer, followed by the caption of its picture if there is one.
pub(crate) fn with_caption(text: String, object: &Json) -> String {
    match object["caption"].as_str() {
        Some(caption) if !caption.is_empty() => {
            let picture = object["plotted"].as_str().unwrap_or_default();
            format!("{text}Caption of {picture}: {caption}\n")
        }
        _ => text,
    }
}

/// Complaints collected from several arguments, to be reported together.
#[derive(Debug, Default)]
pub(crate) struct Gathered {
    wrong: Vec<Complaint>,
    failed: Option<Failure>,
}

impl Gathered {
    /// The value of a result, or `None` after recording its failure.
    pub(crate) fn take<T>(&mut self, result: Result<T, impl Into<Failure>>) -> Option<T> {
        match result.map_err(Into::into) {
            Ok(value) => return Some(value),
            Err(Failure::Wrong(complaints)) => self.wrong.extend(complaints),
            Err(failure @ Failure::Failed { .. }) => self.failed = Some(failure),
        }
        None
    }

    /// The value if no failure was recorded.
    pub(crate) fn finish<T>(self, value: Option<T>) -> Result<T, Failure> {
        match (value, self.failed) {
            (Some(value), None) if self.wrong.is_empty() => Ok(value),
            (_, Some(failure)) if self.wrong.is_empty() => Err(failure),
            _ => Err(self.wrong.into()),
        }
    }
}
