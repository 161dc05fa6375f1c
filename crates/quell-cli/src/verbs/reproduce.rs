//! `quell reproduce`: figures and tables of the dissertation, with their data and the table of claims.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use quell::Failure;
use quell::reproduce::{ENTRIES, Written, find, run as reproduce};
use serde_json::{Value as Json, json};

use crate::answer::{Answer, tell};

/// Makes the figures and tables of the dissertation again, with their data
#[derive(Debug, Args)]
#[command(after_help = list())]
pub(crate) struct Arguments {
    /// Figures such as 2.3, or claims; everything where none is given
    #[arg(value_name = "NAME")]
    names: Vec<String>,
    /// Directory for pictures, data and tables; it is made if it is missing
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Prints one JSON object on standard output and nothing else
    #[arg(long)]
    json: bool,
}

/// Answers.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let entries = find(&arguments.names)?;
    let written = reproduce(&entries, &arguments.out, |done| {
        tell(&format!("{:>8}  {}\n", done.entry.name, done.entry.about));
    })?;
    let object = || {
        let entries: Vec<Json> = written.iter().map(Written::json).collect();
        json!({ "ok": true, "directory": arguments.out.display().to_string(), "entries": entries })
    };
    Ok(Answer::new(arguments.json, object, || text(arguments, &written)))
}

fn text(arguments: &Arguments, written: &[Written]) -> String {
    let files: usize = written.iter().map(|done| done.files.len()).sum();
    let mut text = format!("Wrote {files} files into {}.\n", arguments.out.display());
    for claim in written.iter().flat_map(|done| &done.claims) {
        let printed = if claim.printed.is_empty() { "" } else { " printed " };
        let _ = writeln!(
            text,
            "  {:<14} {}:{printed}{} measured {}: {}",
            claim.place, claim.statement, claim.printed, claim.measured, claim.verdict
        );
    }
    text
}

fn list() -> String {
    let lines: Vec<String> =
        ENTRIES.iter().map(|entry| format!("  {:<8} {}", entry.name, entry.about)).collect();
    format!("Names:\n{}", lines.join("\n"))
}
