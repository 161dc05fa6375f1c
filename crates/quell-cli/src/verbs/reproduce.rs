//! `quell reproduce`: figures and tables of the dissertation, with their data, the table of claims and a report.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use quell::Failure;
use quell::picture::{PicturePage, PictureWidth};
use quell_reproduce::{ENTRIES, Reproduction, Resolution, find, run as reproduce};

use crate::answer::Answer;
use crate::progress::Entries;

/// Reproduces the figures, tables and claims of the dissertation, with data and a report
#[derive(Debug, Args)]
#[command(after_help = list())]
pub(crate) struct Arguments {
    /// Names of figures such as 2.3, or of claims [default: everything]
    #[arg(value_name = "NAME")]
    names: Vec<String>,
    /// Directory for the report, pictures, data and tables, created if it is missing
    #[arg(long, value_name = "DIR", default_value = "reproduction")]
    out: PathBuf,
    /// Uses coarser grids for the maps
    #[arg(long)]
    quick: bool,
    /// Width of the figures with its unit, such as 85mm for the column of a journal [default: suits their panels]
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    width: Option<String>,
    /// Draws the captions below the figures [default: only in the report]
    #[arg(long)]
    caption: bool,
    /// Prints one JSON object on standard output and nothing else
    #[arg(long)]
    json: bool,
}

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let entries = find(&arguments.names)?;
    let pace = if arguments.quick { Resolution::Quick } else { Resolution::Full };
    let width = arguments.width.as_deref().map(|text| PictureWidth::parse(text, "--width"));
    let page = PicturePage { width: width.transpose()?, caption: arguments.caption };
    let bar = Entries::new(entries.len());
    let done = reproduce(&entries, &arguments.out, pace, page, |step| bar.update(step));
    bar.end();
    let done = done?;
    let object = done.json(&arguments.out, pace);
    Ok(Answer::new(arguments.json, &object, || text(arguments, &done)))
}

fn text(arguments: &Arguments, done: &Reproduction) -> String {
    let files: usize = done.written.iter().map(|one| one.files.len()).sum();
    let mut text = format!("Wrote {} files into {}.\n", files + 2, arguments.out.display());
    for claim in done.written.iter().flat_map(|one| &one.product.claims) {
        let printed = if claim.printed.is_empty() { "" } else { " printed " };
        let _ = writeln!(
            text,
            "  {:<14} {}:{printed}{} measured {}: {}",
            claim.place, claim.statement, claim.printed, claim.measured, claim.verdict
        );
    }
    if let Some(summary) = done.summary() {
        let _ = writeln!(text, "{summary}");
    }
    let _ = writeln!(text, "Report: {}", done.report.display());
    text
}

fn list() -> String {
    let lines: Vec<String> =
        ENTRIES.iter().map(|entry| format!("  {:<8} {}", entry.name, entry.about)).collect();
    format!("Names:\n{}", lines.join("\n"))
}
