//! `quell convert`: a belt or a disc as the system that it describes, and few contacts in place of a surface of many.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use quell::output::Output;
use quell::run::fewer_contacts::{Conversion, ERROR};
use quell::study::UnitSystem;
use quell::{Complaint, Failure, Fault, Origin, quantity};
use serde_json::json;

use super::numbers::count;

use crate::answer::Answer;
use crate::arguments::{Gathered, StudyArguments, inputs};

/// Writes the study of a belt or a disc as that of a system, or a system with few contacts in place of a surface of many
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Kind of the study that is written
    #[arg(long, value_enum, default_value_t = OtherKind::System)]
    to: OtherKind,
    /// Replaces the contacts of each law and surface by at most N of them, with larger loads and stiffnesses
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    contacts: Option<String>,
    /// Relative error that the sums over a surface may have, for fewer than N contacts [default: 1e-6]
    #[arg(long, value_name = "ε", requires = "contacts", allow_hyphen_values = true)]
    error: Option<String>,
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
    let most = arguments.contacts.as_deref().map(|text| count("--contacts", text));
    let most = complaints.take(most.transpose());
    let plain = |text: &str| quantity::number(text, None, UnitSystem::None, "--error");
    let error = complaints.take(arguments.error.as_deref().map(plain).transpose());
    let ((study, output), (most, error)) =
        complaints.finish(study.zip(output).zip(most.zip(error)))?;
    let fewer = most.map(|most| (most, error.unwrap_or(ERROR)));
    let done = Conversion::of(&study, fewer)?;
    if let Some(path) = save.filter(|_| done.names_files()) {
        same_folder(path, study.files().folder())?;
    }
    let text = done.study().text();
    let saved = output.map(|output| output.write(text.as_bytes())).transpose()?;
    let saved = saved.map(|path| path.display().to_string());
    let mut warnings = done.warnings();
    if done.names_files() && saved.is_none() {
        let folder = study.files().folder().display().to_string();
        let folder = if folder.is_empty() { ".".to_owned() } else { folder };
        warnings.push(format!("it names files, relative to the folder of the study: {folder}"));
    }
    let mut object = json!({
        "ok": true,
        "answer": "convert",
        "kind": "system",
        "text": text,
        "left_out": done.left_out(),
        "saved": saved.as_slice(),
        "warnings": warnings,
    });
    if let Some(fewer) = done.fewer() {
        object["sentence"] = fewer.sentence().into();
        object["contacts_before"] = fewer.contacts[0].into();
        object["contacts"] = fewer.contacts[1].into();
        object["contacts_error"] = fewer.error.into();
    }
    let sentence = done.fewer().map(|fewer| fewer.sentence() + "\n").unwrap_or_default();
    Ok(Answer::new(arguments.study.json, &object, || match saved {
        Some(path) => format!("{sentence}Saved {path}.\n"),
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
