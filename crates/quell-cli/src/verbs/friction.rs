//! `quell friction`: the law and what the dither makes of it.

use std::fmt::Write as _;

use clap::Args;
use quell::picture;
use quell::run::friction::{FrictionCurve, grid, run as friction};
use quell::run::law;
use quell::{Complaint, Failure, Study, quantity};
use quell_model::units::Quantity;

use super::numbers::scales;
use crate::answer::Answer;
use crate::arguments::{Complaints, OutputArguments, PlotArguments, StudyArguments, inputs};
use crate::table::figure;

/// Computes the friction law and the effective friction under the dither
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Slip velocities: numbers; m/s, or with a unit such as 20mm/s, in a study in SI
    #[arg(long, value_name = "V,…", value_delimiter = ',', allow_hyphen_values = true)]
    at: Vec<String>,
    #[command(flatten)]
    plot: PlotArguments,
    #[command(flatten)]
    output: OutputArguments,
}

/// Answers.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Complaints::default();
    let study = complaints.take(arguments.study.read());
    let inputs = inputs(study.as_ref(), Study::inputs);
    let at = velocities(&arguments.at, study.as_ref(), &mut complaints);
    let outputs = complaints.take(arguments.output.prepare(&[], &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let (study, (outputs, plot)) = complaints.finish(study.zip(outputs.zip(plot)))?;

    let at = if at.is_empty() { grid(study.belt()) } else { at };
    let curve = friction(&study, &at);
    let mut object = curve.json(&study);
    outputs.write(&[curve.dataset(&study)], &mut object)?;
    plot.write(|| picture::friction(&study, &curve), &mut object)?;
    Ok(Answer::new(arguments.study.json, &object, || text(&study, &curve)))
}

fn velocities(texts: &[String], study: Option<&Study>, complaints: &mut Complaints) -> Vec<f64> {
    let scales = scales(study);
    texts
        .iter()
        .filter_map(|text| {
            let read: Result<f64, Box<Complaint>> =
                quantity::parse(text, Quantity::Velocity, scales, "--at");
            complaints.take(read)
        })
        .collect()
}

fn text(study: &Study, curve: &FrictionCurve) -> String {
    // In the units of the study: m/s, and slopes per m/s, in SI.
    let (unit, per_unit) = match study.scales() {
        Some(scales) => ("m/s".to_owned(), scales.si_per_unit(Quantity::Velocity)),
        None => (quantity::unit_of(Quantity::Velocity, false), 1.0),
    };
    let mut text = String::new();
    for (label, words) in law::words(study) {
        let _ = writeln!(text, "{}: {words}", label.trim());
    }
    let _ = write!(
        text,
        "Friction over the slip velocity v_r, in {unit}: the law μ, the effective μ̄ under the dither, \
         its slope\n  {:>14}  {:>14}  {:>14}  {:>14}\n",
        "v_r", "μ", "μ̄", "μ̄′"
    );
    // A grid is for a file or a program; people see every tenth point of it.
    let stride = if curve.points.len() > 100 { 10 } else { 1 };
    for point in curve.points.iter().step_by(stride) {
        let law =
            point.coefficient.as_ref().map_or_else(|_| "any".to_owned(), |value| figure(*value));
        let (mean, slope) = match &point.effective {
            Ok(found) => (figure(found.coefficient), figure(found.slope / per_unit)),
            Err(_) => ("any".to_owned(), "none".to_owned()),
        };
        let v = figure(point.slip_velocity * per_unit);
        let _ = writeln!(text, "  {v:>14}  {law:>14}  {mean:>14}  {slope:>14}");
    }
    text
}
