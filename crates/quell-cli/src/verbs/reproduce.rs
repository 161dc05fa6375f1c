//! `quell reproduce`: figures and tables of the dissertation, with their data, the table of claims and a report.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use quell::picture::{PicturePage, PictureWidth};
use quell::{Change, Failure};
use quell_reproduce::{
    ENTRIES, Reproduction, ReproductionOptions, Resolution, find, run as reproduce,
};

use crate::answer::Answer;
use crate::interrupt;
use crate::progress::Entries;

/// Reproduces the figures, tables and claims of the dissertation, with data and a report
#[derive(Debug, Args)]
#[command(after_help = list())]
#[expect(clippy::struct_excessive_bools, reason = "one for each flag of the verb")]
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
    /// Replaces a value of a figure by your own, such as friction.reference_velocity=0.3; a list replaces a family of curves or panels,
    /// such as dither.amplitude=[0,1,2], belt.damping_ratio=[0.07,0.01] or dither.waveform=[sine,square]
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Draws the captions below the figures [default: only in the report]
    #[arg(long)]
    caption: bool,
    /// Omits the titles above the figures
    #[arg(long)]
    no_title: bool,
    /// Prints one JSON object on standard output and nothing else
    #[arg(long)]
    json: bool,
}

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let entries = find(&arguments.names)?;
    let resolution = if arguments.quick { Resolution::QUICK } else { Resolution::Full };
    let width = arguments.width.as_deref().map(|text| PictureWidth::parse(text, "--width"));
    let page = PicturePage {
        width: width.transpose()?,
        caption: arguments.caption,
        without_title: arguments.no_title,
    };
    let changes = arguments.set.iter().map(|text| Change::parse(text, "--set"));
    let changes = changes.collect::<Result<Vec<Change>, _>>()?;
    let options = ReproductionOptions { resolution, page, changes };
    let bar = Entries::new(entries.len());
    let out = arguments.out.display().to_string();
    interrupt::keeping(move || format!("the files written until then are in {out}"));
    let done = reproduce(&entries, &arguments.out, &options, |step| bar.update(step));
    bar.end();
    let done = done?;
    let object = done.json(&arguments.out, &options);
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
