//! `quell fit`: friction laws fitted to a file of measurements.

use std::path::PathBuf;

use clap::{Args, ValueHint};
use quell::Failure;
use quell::measurement::inputs;
use quell::run::fit::{self, FitRequest};

use crate::answer::Answer;
use crate::arguments::{Gathered, OutputArguments, PlotArguments, answer};

/// Fits friction laws to measured coefficients, with standard errors, and compares the laws
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// CSV file with slip_velocity (or slip_velocity_m_per_s) and coefficient, or friction_force and normal_load
    #[arg(value_name = "DATA.csv", value_hint = ValueHint::FilePath)]
    data: PathBuf,
    /// Law to fit, several times to compare laws: stribeck, decreasing, coulomb, stribeck-exponential, lugre or all [default: all]
    #[arg(long, value_name = "LAW")]
    law: Vec<String>,
    /// Parameters to estimate that are otherwise fixed, such as exponent
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    free: Vec<String>,
    /// Fixes a parameter, such as static_coefficient=0.4
    #[arg(long, value_name = "NAME=VALUE")]
    fix: Vec<String>,
    /// Prints one JSON object on standard output and nothing else
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    output: OutputArguments,
    #[command(flatten)]
    plot: PlotArguments,
}

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Gathered::default();
    let inputs = inputs(&arguments.data);
    let request = complaints.take(FitRequest::new(&arguments.law, &arguments.free, &arguments.fix));
    let outputs = complaints.take(arguments.output.prepare(&["points"], &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let (request, (outputs, plot)) = complaints.finish(request.zip(outputs.zip(plot)))?;
    let done = fit::run(&arguments.data, &request)?;
    answer(arguments.json, &done, outputs, plot)
}
