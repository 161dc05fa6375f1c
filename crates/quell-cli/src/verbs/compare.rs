//! `quell compare`: a measured record or spectrum against the response of a study.

use std::path::PathBuf;

use clap::{Args, ValueHint};
use quell::Failure;
use quell::outcome::ComparedStudy;
use quell::record::RecordRequest;
use quell::run::compare::{self, CompareRequest};
use quell::run::system::start::duration;

use crate::answer::Answer;
use crate::arguments::{Gathered, OutputArguments, PlotArguments, StudyArguments, answer, inputs};

/// Compares a measured record or spectrum with the response of a study, before and after its dither
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// File with time (time_s) and displacement, velocity or acceleration, or with frequency_hz and level: CSV, LabVIEW (.lvm) or
    /// MATLAB (.mat)
    #[arg(value_name = "MEASURED", value_hint = ValueHint::FilePath)]
    measured: PathBuf,
    /// File measured under dither; the first one is then without dither
    #[arg(long, value_name = "MEASURED", value_hint = ValueHint::FilePath)]
    after: Option<PathBuf>,
    #[command(flatten)]
    record: RecordArguments,
    /// Time before the computed record, in the units of the study or with a unit such as 50ms [default: 200 periods]
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_hint = ValueHint::Other)]
    settle: Option<String>,
    #[command(flatten)]
    output: OutputArguments,
    #[command(flatten)]
    plot: PlotArguments,
}

/// How a measured file is read.
#[derive(Debug, Args)]
pub(crate) struct RecordArguments {
    /// Columns by other names, such as slip_velocity=V,friction_force=F, by their unit where no name is, with a unit that the file does not
    /// give, slip_velocity=V[mm/s], and with a factor, friction_force=%*9.84mNm
    #[arg(long, value_name = "QUANTITY=COLUMN,…", value_delimiter = ',')]
    pub(crate) columns: Vec<String>,
    /// Column of the record [default: the first of displacement, velocity and acceleration]
    #[arg(long, value_name = "NAME")]
    column: Option<String>,
    /// What the column shows, if its name does not say it: displacement, velocity or acceleration
    #[arg(long, value_name = "QUANTITY")]
    quantity: Option<String>,
    /// Factor of the readings, such as the calibration of a sensor [default: 1]
    #[arg(long, value_name = "FACTOR", allow_hyphen_values = true)]
    gain: Option<String>,
    /// Takes the part of the record between two of its times, such as 0.2:1.5
    #[arg(long, value_name = "A:B", allow_hyphen_values = true, value_hint = ValueHint::Other)]
    window: Option<String>,
}

impl RecordArguments {
    /// The checked request.
    pub(crate) fn request(&self) -> Result<RecordRequest, Failure> {
        RecordRequest::new(
            self.column.as_deref(),
            self.quantity.as_deref(),
            self.gain.as_deref(),
            self.window.as_deref(),
            &self.columns,
        )
    }

    /// The options that were given.
    pub(crate) fn given(&self) -> Vec<(&'static str, &str)> {
        let options = [
            ("--column", &self.column),
            ("--quantity", &self.quantity),
            ("--gain", &self.gain),
            ("--window", &self.window),
        ];
        options.into_iter().filter_map(|(name, text)| Some((name, text.as_deref()?))).collect()
    }
}

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Gathered::default();
    let study = complaints.take(arguments.study.read());
    let files = std::iter::once(&arguments.measured).chain(&arguments.after);
    let inputs = inputs(study.as_ref()).with_files(files.map(PathBuf::as_path));
    let record = complaints.take(arguments.record.request());
    let outputs = complaints.take(arguments.output.prepare(arguments.parts(), &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let settle = match (&study, &arguments.settle) {
        (Some(study), Some(text)) => {
            complaints.take(duration(&study.system(), text, "--settle").map(Some))
        }
        _ => Some(None),
    };
    let ((study, (record, settle)), (outputs, plot)) =
        complaints.finish(study.zip(record.zip(settle)).zip(outputs.zip(plot)))?;
    let request = CompareRequest {
        measured: arguments.measured.clone(),
        after: arguments.after.clone(),
        record,
        settle,
    };
    let done = compare::run(&study, &request)?;
    answer(arguments.study.json, &ComparedStudy { study, done }, outputs, plot)
}

impl Arguments {
    /// Further files of numbers.
    fn parts(&self) -> &'static [&'static str] {
        if self.after.is_some() { &["after"] } else { &[] }
    }
}
