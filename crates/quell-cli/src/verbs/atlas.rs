//! `quell atlas`: exact thresholds of belts from the tables in dimensionless groups.

use std::path::{Path, PathBuf};

use clap::{Args, ValueHint};
use quell::input::Inputs;
use quell::run::atlas::{recomputed, tables};
use quell::sweep::Running;
use quell::verbs::verbs;
use quell::{Change, Failure, Study};

use super::map::threads;
use crate::answer::Answer;
use crate::arguments::{Gathered, Outputs, PlotArguments, answer, inputs};
use crate::interrupt;
use crate::progress::Bar;

/// Extension of the file of the tables.
const TEXT: &str = "txt";

/// Looks up the exact thresholds of a belt in the tables of the atlas, or shows the tables
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Study file (TOML); - reads standard input [default: the tables themselves]
    #[arg(value_name = "STUDY", value_hint = ValueHint::FilePath)]
    study: Option<PathBuf>,
    /// Changes a value of the study, such as dither[1].amplitude=0.3
    #[arg(long = "set", value_name = "PATH=VALUE", requires = "study")]
    set: Vec<String>,
    /// Also computes the thresholds of the study exactly, and reports the difference
    #[arg(long, requires = "study")]
    exact: bool,
    /// Computes the tables again, and reports the largest difference; takes minutes
    #[arg(long, conflicts_with = "study")]
    compute: bool,
    /// Number of threads of --compute [default: all cores]
    #[arg(long, value_name = "N", requires = "compute", allow_hyphen_values = true)]
    threads: Option<String>,
    /// Prints one JSON object on standard output and nothing else
    #[arg(long)]
    json: bool,
    /// Saves the thresholds over the belt's speed, or without a study those at round numbers: FILE.csv, FILE.mat (MATLAB) or FILE.nc
    /// (NetCDF); without a study also the tables themselves: FILE.txt
    #[arg(long, value_name = "FILE")]
    save: Option<PathBuf>,
    #[command(flatten)]
    plot: PlotArguments,
}

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    match &arguments.study {
        Some(path) => of_study(arguments, path),
        None => of_tables(arguments),
    }
}

fn of_study(arguments: &Arguments, path: &Path) -> Result<Answer, Failure> {
    let mut complaints = Gathered::default();
    let changes: Vec<Change> = arguments
        .set
        .iter()
        .filter_map(|text| complaints.take(Change::parse(text, "--set")))
        .collect();
    let study = complaints.take(Study::read(path, &changes));
    let inputs = inputs(study.as_ref());
    let outputs = complaints.take(Outputs::prepare(arguments.save.as_deref(), &[], &[], &inputs));
    let plot = arguments.plot.prepare(&inputs);
    let plot = complaints.take(plot.and_then(|plot| plot.drawn_by(study.as_ref(), "atlas")));
    let (study, (outputs, plot)) = complaints.finish(study.zip(outputs.zip(plot)))?;
    let done = verbs(&study).atlas(arguments.exact)?;
    answer(arguments.json, done.as_ref(), outputs, plot)
}

fn of_tables(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Gathered::default();
    let threads = complaints.take(threads(arguments.threads.as_deref()));
    let save = arguments.save.as_deref();
    let outputs = complaints.take(Outputs::prepare(save, &[TEXT], &[], &Inputs::NONE));
    let plot = complaints.take(arguments.plot.prepare(&Inputs::NONE));
    let (threads, (outputs, plot)) = complaints.finish(threads.zip(outputs.zip(plot)))?;
    let done = if arguments.compute {
        let bar = Bar::new();
        recomputed(Running { threads, stop: interrupt::flag(), progress: &bar })?
    } else {
        tables()
    };
    answer(arguments.json, &done, outputs, plot)
}
