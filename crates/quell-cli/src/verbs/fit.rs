//! `quell fit`: friction laws fitted to points, a free decay, or a study fitted to a record.

use std::path::PathBuf;

use clap::{Args, ValueHint};
use quell::measurement::inputs;
use quell::run::decay::{self, DecayRequest};
use quell::run::fit::{self, FitRequest};
use quell::run::record_fit::{self, RecordFitRequest};
use quell::run::system::start::duration;
use quell::{Change, Complaint, Failure, Fault, Origin, Study};

use super::compare::RecordArguments;
use crate::answer::Answer;
use crate::arguments::{Gathered, OutputArguments, PlotArguments, answer};
use crate::interrupt;

/// Fits friction laws to measured coefficients, a free decay, or a study to a record, with standard errors
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// File with slip_velocity and coefficient, or friction_force and normal_load, units in the names (slip_velocity_mm_per_s) or in a line;
    /// without a load friction is a force. A folder of records at steady speed is a point for each. With --decay and --record a file with time
    /// and displacement, velocity or acceleration. CSV, LabVIEW (.lvm) or MATLAB (.mat)
    #[arg(value_name = "DATA", value_hint = ValueHint::FilePath)]
    data: PathBuf,
    /// Law to fit, several times to compare laws: stribeck, decreasing, coulomb, stribeck-exponential, lugre or all; of a decay viscous,
    /// coulomb, viscous-coulomb or all [default: all]
    #[arg(long, value_name = "LAW")]
    law: Vec<String>,
    /// Parameters to estimate that are otherwise fixed, such as exponent; with --record numbers of the study, such as
    /// belt.damping_ratio or belt.damping_ratio=0.01 with a start, and record.shift, record.offset and record.gain
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    free: Vec<String>,
    /// Fixes a parameter, such as static_coefficient=0.4
    #[arg(long, value_name = "NAME=VALUE")]
    fix: Vec<String>,
    /// Fits natural frequency, damping ratio and friction to a record of a free decay
    #[arg(long, conflicts_with = "record_of")]
    decay: bool,
    /// Fits numbers of a study to a record by its exact motion
    #[arg(long = "record", id = "record_of", requires = "study")]
    record_of: bool,
    /// Study of --record
    #[arg(long, value_name = "STUDY.toml", value_hint = ValueHint::FilePath, requires = "record_of")]
    study: Option<PathBuf>,
    /// Changes a value of the study of --record
    #[arg(long = "set", value_name = "PATH=VALUE", requires = "study")]
    set: Vec<String>,
    /// Time from the start of the run of the study to the record, in its units or with a unit such as 50ms [default: 0, with a free
    /// record.shift 30 periods]
    #[arg(long, value_name = "T", allow_hyphen_values = true, requires = "study", value_hint = ValueHint::Other)]
    settle: Option<String>,
    #[command(flatten)]
    record: RecordArguments,
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
    if arguments.decay {
        return of_decay(arguments);
    }
    if let Some(path) = &arguments.study {
        return of_record(arguments, path);
    }
    let mut complaints = Gathered::default();
    let inputs = inputs(&arguments.data);
    let request = complaints.take(FitRequest::new(
        &arguments.law,
        &arguments.free,
        &arguments.fix,
        &arguments.record.columns,
    ));
    let outputs = complaints.take(arguments.output.prepare(&["points"], &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let given = complaints.take(arguments.without_record());
    let ((request, ()), (outputs, plot)) =
        complaints.finish(request.zip(given).zip(outputs.zip(plot)))?;
    let done = fit::run(&arguments.data, &request)?;
    answer(arguments.json, &done, outputs, plot)
}

fn of_decay(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Gathered::default();
    let inputs = inputs(&arguments.data);
    let record = complaints.take(arguments.record.request());
    let request = record.and_then(|record| {
        complaints.take(DecayRequest::new(record, &arguments.law, &arguments.fix))
    });
    let all_free = complaints.take(match arguments.free.first() {
        None => Ok(()),
        Some(name) => {
            let allowed =
                "left out with --decay: every parameter is estimated that --fix does not fix";
            let origin = Origin::Argument("--free");
            Err(Failure::from(Complaint::new(
                Fault::Conflict,
                "--free",
                origin,
                name.as_str(),
                allowed,
            )))
        }
    });
    let outputs = complaints.take(arguments.output.prepare(&[], &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let ((request, ()), (outputs, plot)) =
        complaints.finish(request.zip(all_free).zip(outputs.zip(plot)))?;
    let done = decay::run(&arguments.data, &request)?;
    answer(arguments.json, &done, outputs, plot)
}

fn of_record(arguments: &Arguments, path: &std::path::Path) -> Result<Answer, Failure> {
    let mut complaints = Gathered::default();
    let changes: Vec<Change> = arguments
        .set
        .iter()
        .filter_map(|text| complaints.take(Change::parse(text, "--set")))
        .collect();
    let study = complaints.take(Study::read(path, &changes));
    let inputs = crate::arguments::inputs(study.as_ref()).with_files([arguments.data.as_path()]);
    let record = complaints.take(arguments.record.request());
    let settle = match (&study, &arguments.settle) {
        (Some(study), Some(text)) => {
            complaints.take(duration(&study.system(), text, "--settle").map(Some))
        }
        _ => Some(None),
    };
    let lawless = complaints.take(match arguments.law.first() {
        None => Ok(()),
        Some(law) => {
            let allowed = "left out with --record: the study has its law";
            let origin = Origin::Argument("--law");
            Err(Failure::from(Complaint::new(
                Fault::Conflict,
                "--law",
                origin,
                law.as_str(),
                allowed,
            )))
        }
    });
    let outputs = complaints.take(arguments.output.prepare(&[], &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let ((study, ()), ((record, settle), (outputs, plot))) =
        complaints.finish(study.zip(lawless).zip(record.zip(settle).zip(outputs.zip(plot))))?;
    let (free, fix) = (arguments.free.clone(), arguments.fix.clone());
    let request = RecordFitRequest { record, free, fix, settle };
    let done = record_fit::run(&study, &arguments.data, &request, interrupt::flag())?;
    answer(arguments.json, &done, outputs, plot)
}

impl Arguments {
    /// Rejects the options of records for points.
    fn without_record(&self) -> Result<(), Failure> {
        let given = self.record.given();
        if given.is_empty() {
            return Ok(());
        }
        let wrong = given.into_iter().map(|(option, text)| {
            let allowed = "given with --decay or --record, which read a record; --columns takes columns of points";
            Complaint::new(Fault::Conflict, option, Origin::Argument(option), text, allowed)
        });
        Err(wrong.collect::<Vec<_>>().into())
    }
}
