//! `quell orbit`: the periodic response and its Floquet multipliers.

use std::fmt::Write as _;

use clap::Args;
use quell::run::orbit::{Orbit, Response, Wanted, run as orbit};
use quell::run::thresholds::Protocol;
use quell::{Failure, Study, picture};
use quell_model::units::Quantity;

use super::numbers::state;
use crate::answer::Answer;
use crate::arguments::{Complaints, PlotArguments, StudyArguments, inputs};
use crate::table::Table;

/// Options that ask for the response on which a run ends, which has its own state and number of periods.
const STARTS: [&str; 4] = ["from_rest", "from_sliding", "from_squeal", "start"];

/// Computes the periodic response to dither and whether it is stable, exactly
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Looks near this state x,v at τ = 0; by default for what sliding becomes under dither, without dither for the limit cycle
    #[arg(long, value_name = "X,V", conflicts_with_all = STARTS, allow_hyphen_values = true)]
    near: Option<String>,
    /// Common periods of the dithers in one period of the response
    #[arg(long, value_name = "N", conflicts_with_all = STARTS, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1000))]
    periods: u32,
    /// Looks for the response on which a run from rest ends, of whatever number of periods
    #[arg(long, group = "run")]
    from_rest: bool,
    /// The same from steady sliding without dither
    #[arg(long, group = "run")]
    from_sliding: bool,
    /// The same from the undithered limit cycle
    #[arg(long, group = "run")]
    from_squeal: bool,
    /// The same from this state
    #[arg(long, group = "run", value_name = "X,V", allow_hyphen_values = true)]
    start: Option<String>,
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
    let near = complaints.take(arguments.near.as_deref().map(|it| state("--near", it)).transpose());
    let start =
        complaints.take(arguments.start.as_deref().map(|it| state("--start", it)).transpose());
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let (study, ((near, start), plot)) = complaints.finish(study.zip(near.zip(start).zip(plot)))?;
    let periods = arguments.periods;
    let wanted = match (arguments.after(start), near) {
        (Some(protocol), _) => Wanted::After(protocol),
        (None, Some(state)) => Wanted::Near { state, periods },
        (None, None) => Wanted::OfSliding { periods },
    };
    let found = orbit(&study, wanted)?;
    let mut object = found.json(&study);
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
            "\nBeside it: {}\n{}",
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
    table.number("residual", Quantity::Displacement, found.residual);
    table.text()
}
