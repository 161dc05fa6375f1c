//! `quell new`: a commented study to start from.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use quell::template::{CommentedStudy, TEMPLATES, list};
use quell::{Complaint, Failure, Fault, Origin};

use crate::answer::Answer;

/// Prints a commented study for a question, or lists the questions
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Name of the question [default: list all questions]
    #[arg(value_name = "QUESTION")]
    question: Option<String>,
    /// Saves the study to a new file instead of printing it
    #[arg(long, value_name = "FILE.toml")]
    save: Option<PathBuf>,
    /// Replaces the file if it exists
    #[arg(long, requires = "save")]
    overwrite: bool,
    /// Prints one JSON object on standard output and nothing else
    #[arg(long)]
    json: bool,
}

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let Some(name) = &arguments.question else {
        if let Some(path) = &arguments.save {
            let (key, allowed) =
                ("--save", "--save needs the name of a question; `quell new` lists them");
            let given = path.display().to_string();
            return Err(
                Complaint::new(Fault::Usage, key, Origin::Argument(key), given, allowed).into()
            );
        }
        return Ok(Answer::new(arguments.json, &list(), questions));
    };
    let template = CommentedStudy::find(name)?;
    let saved = arguments
        .save
        .as_deref()
        .map(|path| template.save(path, arguments.overwrite))
        .transpose()?;
    let text = || match &saved {
        None => template.text.to_owned(),
        Some(path) => {
            let path = path.display().to_string();
            let mut text = format!("Saved {path}. Next:\n");
            for command in template.commands() {
                let command = command.replace(&format!("{name}.toml"), &path);
                let _ = writeln!(text, "  {command}");
            }
            text
        }
    };
    Ok(Answer::new(arguments.json, &template.json(saved.as_deref()), text))
}

/// The list of questions.
fn questions() -> String {
    let width = TEMPLATES.iter().map(|template| template.name.len()).max().unwrap_or(0);
    let mut text = String::new();
    for template in TEMPLATES {
        let _ = writeln!(text, "  {:<width$}  {}", template.name, template.question());
    }
    text + "\n`quell new NAME` prints a commented study; --save FILE.toml saves it.\n"
}
