//! `quell orbit`: the periodic response and its Floquet multipliers.

use clap::Args;
use quell::run::orbit::{Wanted, json, run as orbit, sentence};
use quell::{Complaint, Failure, picture};
use quell_model::units::Quantity;

use crate::answer::Answer;
use crate::arguments::{Complaints, PlotArguments, StudyArguments};
use crate::table::Table;

/// Computes the periodic response to dither and whether it is stable, exactly
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Looks near this state x,x′ at τ = 0; by default for what sliding becomes under dither
    #[arg(long, value_name = "X,V", allow_hyphen_values = true)]
    near: Option<String>,
    /// Common periods of the dithers in one period of the response
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1000))]
    periods: u32,
    #[command(flatten)]
    plot: PlotArguments,
}

/// Answers.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Complaints::default();
    let study = complaints.take(arguments.study.read());
    let near = complaints.take(arguments.near.as_deref().map(|it| state("--near", it)).transpose());
    let plot = complaints.take(arguments.plot.prepare());
    let (study, (near, plot)) = complaints.finish(study.zip(near.zip(plot)))?;
    let found = orbit(&study, Wanted { near, periods: arguments.periods })?;
    let mut object = json(&study, &found);
    plot.write(|| picture::orbit(&study, &found), &mut object)?;
    let text = || {
        let mut table = Table::new(study.scales());
        table.word("verdict", found.verdict().name());
        for (re, im) in found.multipliers {
            let multiplier =
                format!("{re:.9} {} {:.9} i", if im < 0.0 { '−' } else { '+' }, im.abs());
            table.word("multiplier", &multiplier);
        }
        table.number("modulus of the larger", Quantity::Ratio, found.radius());
        table.number("displacement x at τ = 0", Quantity::Displacement, found.start.displacement);
        table.number("velocity x′ at τ = 0", Quantity::Velocity, found.start.velocity);
        table.number("period", Quantity::Time, found.period);
        if let Some((least, _)) = found.least_slip {
            table.number("least slip velocity |v_r|", Quantity::Velocity, least);
        }
        table.number("stick fraction", Quantity::Ratio, found.stick_fraction);
        table.number("residual", Quantity::Displacement, found.residual);
        format!("{}\n{}", sentence(&study, &found), table.text())
    };
    Ok(Answer::new(arguments.study.json, || object, text))
}

/// Two numbers x,v.
pub(super) fn state(option: &'static str, text: &str) -> Result<(f64, f64), Failure> {
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|it| it.is_finite());
    text.split_once(',').and_then(|(x, v)| Some((number(x)?, number(v)?))).ok_or_else(|| {
        let allowed = "two finite numbers x,v: displacement and velocity, such as 0.3,0";
        Complaint::option(option, text, allowed).into()
    })
}
