//! `quell sketch`: the mechanism that a study describes, as a drawing.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use quell::output::Output;
use quell::Failure;
use quell::picture::{EXTENSIONS, sketch};

use crate::answer::Answer;
use crate::arguments::{Gathered, StudyArguments, inputs};

/// Draws the mechanism that a study describes, with the values of its parts
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// File for the drawing
    #[arg(long, value_name = "FILE.svg|.pdf|.png")]
    out: PathBuf,
    /// Width of the drawing with its unit, such as 85mm for the column of a journal [default: 120mm]
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    width: Option<String>,
}

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Gathered::default();
    let study = complaints.take(arguments.study.read());
    let inputs = inputs(study.as_ref());
    let output = complaints.take(Output::prepare(&arguments.out, "--out", EXTENSIONS, &inputs));
    let width = complaints.take(arguments.width.as_deref().map(sketch::width).transpose());
    let (study, (output, width)) = complaints.finish(study.zip(output.zip(width)))?;

    let drawn = sketch::sketch(&study, width)?;
    let mut object = sketch::json(&drawn);
    let written = sketch::write(&drawn, output)?;
    object["saved"] = vec![written.as_str()].into();
    Ok(Answer::new(arguments.study.json, &object, || {
        let mut text = String::new();
        let (width, height) = (drawn.width_mm, drawn.height_mm());
        let _ = writeln!(text, "Saved {written}: {width} mm × {height:.0} mm.");
        text
    }))
}
