//! `quell orbit`: the periodic response and its Floquet multipliers.

use std::fmt::Write as _;

use clap::Args;
use quell::run::orbit::{Orbit, Response, Wanted, extremes, run as orbit};
use quell::run::thresholds::Protocol;
use quell::{Failure, Study, picture};
use quell_model::units::Quantity;

use super::numbers::state;
use crate::answer::Answer;
use crate::arguments::{Complaints, OutputArguments, PlotArguments, StudyArguments, inputs};
use crate::table::Table;

/// Options that ask for the response on which a run ends, which has its own state and number of periods.
const STARTS: [&str; 4] = ["from_rest", "from_sliding", "from_squeal", "start"];

/// Computes the periodic response and its stability by Floquet multipliers
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Searches near this state x,v at τ = 0; in a study in SI metres and m/s, or with units such as 1um,50mm/s [default: the
    /// base response, continued from steady sliding; without dither the limit cycle; at v₀ = 0 the response that a run
    /// from rest reaches]
    #[arg(long, value_name = "X,V", conflicts_with_all = STARTS, allow_hyphen_values = true)]
    near: Option<String>,
    /// Common periods of the dithers in one period of the response
    #[arg(long, value_name = "N", conflicts_with_all = STARTS, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1000))]
    periods: u32,
    /// Finds the response that a run from rest reaches, of any number of periods
    #[arg(long, group = "run")]
    from_rest: bool,
    /// Finds the response that a run from steady sliding without dither reaches
    #[arg(long, group = "run")]
    from_sliding: bool,
    /// Finds the response that a run from the undithered limit cycle reaches
    #[arg(long, group = "run")]
    from_squeal: bool,
    /// Finds the response that a run from this state reaches
    #[arg(long, group = "run", value_name = "X,V", allow_hyphen_values = true)]
    start: Option<String>,
    #[command(flatten)]
    output: OutputArguments,
    #[command(flatten)]
    plot: PlotArguments,
}

impl Arguments {
    /// The start of the run whose response is asked for.
    fn after(&self, start: Option<(f64, f64)>) -> Option<Protocol> {
        let flags = [
            (self.from_rest, Protocol::Rest),
            (self.from_sliding, Protocol::Sliding),
            (self.from_squeal, Protocol::Squeal),
        ];
        let flag = flags.into_iter().find_map(|(asked, protocol)| asked.then_some(protocol));
        flag.or(start.map(|(x, v)| Protocol::From(x, v)))
    }
}

/// Answers.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Complaints::default();
    let study = complaints.take(arguments.study.read());
    let inputs = inputs(study.as_ref(), Study::inputs);
    let near = arguments.near.as_deref().map(|it| state("--near", it, study.as_ref()));
    let near = complaints.take(near.transpose());
    let start = arguments.start.as_deref().map(|it| state("--start", it, study.as_ref()));
    let start = complaints.take(start.transpose());
    let outputs = complaints.take(arguments.output.prepare(&[], &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let (study, ((near, start), (outputs, plot))) =
        complaints.finish(study.zip(near.zip(start).zip(outputs.zip(plot))))?;
    let periods = arguments.periods;
    let wanted = match (arguments.after(start), near) {
        (Some(protocol), _) => Wanted::After(protocol),
        (None, Some(state)) => Wanted::Near { state, periods },
        (None, None) => Wanted::OfSliding { periods },
    };
    let found = orbit(&study, wanted)?;
    let mut object = found.json(&study);
    if arguments.output.saves() {
        outputs.write(&[found.dataset(&study)?], &mut object)?;
    }
    plot.try_write(|| picture::periodic_response(&study, &found), &mut object)?;
    Ok(Answer::new(arguments.study.json, &object, || text(&study, &found)))
}

fn text(study: &Study, found: &Response) -> String {
    let mut text = found.sentence(study) + "\n";
    if let Some(orbit) = &found.orbit {
        text += &table(study, orbit);
    }
    let others = found.cycles.iter().filter(|it| Some(*it) != found.orbit.as_ref());
    for other in others {
        let _ = write!(
            text,
            "\nAlso found: {}\n{}",
            quell::run::orbit::sentence(study, other),
            table(study, other)
        );
    }
    text
}

fn table(study: &Study, found: &Orbit) -> String {
    let mut table = Table::new(study.scales());
    table.word("verdict", found.verdict().name());
    for (re, im) in found.multipliers {
        let multiplier = format!("{re:.9} {} {:.9} i", if im < 0.0 { '−' } else { '+' }, im.abs());
        table.word("multiplier", &multiplier);
    }
    let modulus =
        if found.is_free { "modulus of the one that decides" } else { "modulus of the larger" };
    table.number(modulus, Quantity::Ratio, found.radius());
    table.number("displacement x at τ = 0", Quantity::Displacement, found.start.displacement);
    table.number("velocity x′ at τ = 0", Quantity::Velocity, found.start.velocity);
    table.number("period", Quantity::Time, found.period);
    if let Some((least, _)) = found.least_slip {
        table.number("least slip velocity |v_r|", Quantity::Velocity, least);
    }
    table.number("stick fraction", Quantity::Ratio, found.stick_fraction);
    let reach = extremes(study, found);
    table.number("lowest displacement", Quantity::Displacement, reach.displacement.0);
    table.number("highest displacement", Quantity::Displacement, reach.displacement.1);
    table.number("lowest velocity", Quantity::Velocity, reach.velocity.0);
    table.number("highest velocity", Quantity::Velocity, reach.velocity.1);
    table.number("residual", Quantity::Displacement, found.residual);
    table.number("error of the state", Quantity::Displacement, found.state_error);
    table.number("error of the multiplier", Quantity::Ratio, found.multiplier_error);
    table.text()
}
