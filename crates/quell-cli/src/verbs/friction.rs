//! `quell friction`: the friction law and the effective friction under the dither.

use std::path::PathBuf;

use clap::Args;
use quell::outcome::friction_export::EXTENSIONS;
use quell::quantity;
use quell::verbs::verbs;
use quell::{Complaint, Failure, Fault, Origin, Study};
use serde_json::Value as Json;

use crate::answer::Answer;
use crate::arguments::{Gathered, Outputs, PlotArguments, StudyArguments, answer, inputs};

/// Computes the friction law and the effective friction under the dither
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Slip velocities, separated by commas; in a study in SI in m/s, or with a unit such as 20mm/s
    #[arg(long, value_name = "V,…", value_delimiter = ',', allow_hyphen_values = true)]
    at: Vec<String>,
    /// One mass: also measures the friction on steady responses, stick included, instead of averaging
    #[arg(long)]
    measured: bool,
    /// Gives the describing function of averaged friction at the velocity of the belt, or of every surface, for slow sinusoids up to
    /// this velocity amplitude, and the limit cycles that it predicts
    #[arg(long, value_name = "AMPLITUDE", conflicts_with_all = ["at", "measured"])]
    describing: Option<String>,
    #[command(flatten)]
    plot: PlotArguments,
    /// Saves the numbers as a table (.csv, .mat for MATLAB, .nc for NetCDF), or the averaged friction for Abaqus (.inp), as a
    /// script of MATLAB with parameters of Simscape (.m) or as a brake of Modelica (.mo), for slip speeds from 0 to the largest of --at
    #[arg(long, value_name = "FILE.csv|.mat|.nc|.inp|.m|.mo")]
    save: Option<PathBuf>,
}

impl Arguments {
    /// Rejects a file for another program where the friction is not only averaged.
    fn averages(&self) -> Result<(), Box<Complaint>> {
        let extension = self.save.as_deref().and_then(|path| path.extension()?.to_str());
        let Some(extension) = extension.map(str::to_ascii_lowercase) else { return Ok(()) };
        let other = [("--measured", self.measured), ("--describing", self.describing.is_some())];
        match other
            .into_iter()
            .find(|(_, given)| *given && EXTENSIONS.contains(&extension.as_str()))
        {
            Some((option, _)) => {
                let allowed = format!("left out: a file .{extension} has the averaged friction");
                let origin = Origin::Argument(option);
                Err(Box::new(Complaint::new(Fault::Conflict, option, origin, Json::Null, allowed)))
            }
            None => Ok(()),
        }
    }
}

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Gathered::default();
    let study = complaints.take(arguments.study.read());
    let inputs = inputs(study.as_ref());
    let at = velocities(&arguments.at, study.as_ref(), &mut complaints);
    let largest = arguments
        .describing
        .as_deref()
        .and_then(|text| complaints.take(quantity::velocity(text, study.as_ref(), "--describing")));
    complaints.take(arguments.averages());
    let save = arguments.save.as_deref();
    let outputs = complaints.take(Outputs::prepare(save, EXTENSIONS, &[], &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let (study, (outputs, plot)) = complaints.finish(study.zip(outputs.zip(plot)))?;

    let verbs = verbs(&study);
    let done = match largest {
        Some(largest) => verbs.describing(largest)?,
        None => verbs.friction((!at.is_empty()).then_some(&at[..]), arguments.measured)?,
    };
    answer(arguments.study.json, done.as_ref(), outputs, plot)
}

fn velocities(texts: &[String], study: Option<&Study>, complaints: &mut Gathered) -> Vec<f64> {
    texts
        .iter()
        .filter_map(|text| complaints.take(quantity::velocity(text, study, "--at")))
        .collect()
}
