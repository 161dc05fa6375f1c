//! `quell convert`: a belt or a disc as the system that it describes.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use quell::output::Output;
use quell::{Complaint, Failure, Fault, Origin};
use serde_json::json;

use crate::answer::Answer;
use crate::arguments::{Gathered, StudyArguments, inputs};

/// Writes the study of a belt or a disc as that of a system, with the numbers of its equations
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Kind of the study that is written
    #[arg(long, value_enum, default_value_t = OtherKind::System)]
    to: OtherKind,
    /// Saves the study to a file instead of printing it
    #[arg(long, value_name = "FILE.toml")]
    save: Option<PathBuf>,
}

/// A kind that other studies can be written as.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum OtherKind {
    /// Coordinates, contacts and dithers
    System,
}

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let OtherKind::System = arguments.to;
    let mut complaints = Gathered::default();
    let study = complaints.take(arguments.study.read());
    let inputs = inputs(study.as_ref());
    let save = arguments.save.as_deref();
    let output = complaints
        .take(save.map(|path| Output::prepare(path, "--save", &["toml"], &inputs)).transpose());
    let (study, output) = complaints.finish(study.zip(output))?;
    let converted = study.as_system()?;
    if let Some(path) = save.filter(|_| converted.names_files) {
        same_folder(path, study.files().folder())?;
    }
    let text = converted.study.text();
    let saved = output.map(|output| output.write(text.as_bytes())).transpose()?;
    let saved = saved.map(|path| path.display().to_string());
    let mut warnings = converted.warnings();
    if converted.names_files && saved.is_none() {
        let folder = study.files().folder().display().to_string();
        let folder = if folder.is_empty() { ".".to_owned() } else { folder };
        warnings.push(format!("it names files, relative to the folder of the study: {folder}"));
    }
    let object = json!({
        "ok": true,
        "answer": "convert",
        "kind": "system",
        "text": text,
        "left_out": converted.left_out,
        "saved": saved.as_slice(),
        "warnings": warnings,
    });
    Ok(Answer::new(arguments.study.json, &object, || match saved {
        Some(path) => format!("Saved {path}.\n"),
        None => text.to_owned(),
    }))
}

/// Refuses another folder for a study that names files relative to its own.
fn same_folder(path: &Path, folder: &Path) -> Result<(), Failure> {
    let absolute = |folder: &Path| {
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        folder.canonicalize().ok()
    };
    if absolute(path.parent().unwrap_or(Path::new(""))) == absolute(folder) {
        return Ok(());
    }
    let given = path.display().to_string();
    let allowed = format!("in the folder of the study, {}: it names files relative to it", folder.display());
    Err(Complaint::new(Fault::Path, "--save", Origin::Argument("--save"), given, allowed).into())
}
