//! `quell basins`: which starts end on which response.

use std::fmt::Write as _;

use clap::Args;
use quell::run::attractor::words;
use quell::run::basins::{Basins, Layout, Portrait, Question, quiescence, run as basins};
use quell::run::varied::Range;
use quell::sweep::Running;
use quell::{Complaint, Failure, Fault, Origin, Study, picture};
use quell_model::units::Quantity;

use super::map::threads;
use super::numbers::{count, number, range, scales};
use crate::answer::Answer;
use crate::arguments::{Complaints, OutputArguments, PlotArguments, StudyArguments, inputs};
use crate::interrupt;
use crate::progress::Bar;
use crate::table::{figure, figure_of};

/// Finds the responses that starts in a window end on, and the share of each
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Displacements x of the window, SI in a study in SI [default: around steady sliding]
    #[arg(long, value_name = "FROM:TO", allow_hyphen_values = true)]
    displacement: Option<String>,
    /// Velocities x′ of the window, SI in a study in SI [default: around 0]
    #[arg(long, value_name = "FROM:TO", allow_hyphen_values = true)]
    velocity: Option<String>,
    /// Numbers of displacements and velocities of a grid, from edge to edge [default: 41x31]
    #[arg(long, value_name = "NxM", conflicts_with = "sample")]
    grid: Option<String>,
    /// Number of random states instead of a grid
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    sample: Option<String>,
    /// Seed of the random states
    #[arg(long, value_name = "SEED", requires = "sample", default_value_t = 1)]
    seed: u64,
    /// Follows the shares over this parameter, such as dither.amplitude; needs --from and --to
    #[arg(long, value_name = "PATH", requires = "from", requires = "to")]
    over: Option<String>,
    /// Its smallest value
    #[arg(long, value_name = "A", requires = "over", allow_hyphen_values = true)]
    from: Option<String>,
    /// Its largest value
    #[arg(long, value_name = "B", requires = "over", allow_hyphen_values = true)]
    to: Option<String>,
    /// Number of its values
    #[arg(
        long,
        value_name = "N",
        requires = "over",
        default_value = "41",
        allow_hyphen_values = true
    )]
    points: String,
    /// Number of threads [default: all cores]
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    threads: Option<String>,
    #[command(flatten)]
    output: OutputArguments,
    #[command(flatten)]
    plot: PlotArguments,
}

/// Answers.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Complaints::default();
    let study = complaints.take(arguments.study.read());
    let inputs = inputs(study.as_ref(), Study::inputs);
    let question = question(arguments, study.as_ref(), &mut complaints);
    let threads = complaints.take(threads(arguments.threads.as_deref()));
    let output = complaints.take(arguments.output.prepare(&[], &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let ((study, question), (threads, (output, plot))) =
        complaints.finish(study.zip(question).zip(threads.zip(output.zip(plot))))?;
    let bar = Bar::new();
    let running = Running { threads, stop: interrupt::flag(), progress: &bar };
    let done = basins(&study, &question, running)?;
    let mut object = done.json(&study);
    output.write(&[done.dataset(&study)], &mut object)?;
    plot.try_write(|| picture::basins(&study, &done), &mut object)?;
    Ok(Answer::new(arguments.study.json, &object, || text(&study, &done)))
}

fn question(
    arguments: &Arguments,
    study: Option<&Study>,
    complaints: &mut Complaints,
) -> Option<Question> {
    let scales = scales(study);
    let mut window = |option, text: &Option<String>, quantity| {
        let found = text.as_deref().map(|text| range(option, text, quantity, scales));
        complaints.take(found.transpose())
    };
    let displacement = window("--displacement", &arguments.displacement, Quantity::Displacement);
    let velocity = window("--velocity", &arguments.velocity, Quantity::Velocity);
    let layout = complaints.take(layout(arguments));
    let over = match &arguments.over {
        None => Some(None),
        Some(parameter) => {
            let end = |option, text: &Option<String>| {
                number(option, text.as_deref().unwrap_or_default(), parameter)
            };
            let from = complaints.take(end("--from", &arguments.from));
            let to = complaints.take(end("--to", &arguments.to));
            let points = complaints.take(count("--points", &arguments.points));
            let parameter = parameter.clone();
            from.zip(to)
                .zip(points)
                .map(|((from, to), points)| Some(Range { parameter, from, to, points }))
        }
    };
    Some(Question {
        displacement: displacement?,
        velocity: velocity?,
        layout: layout?,
        over: over?,
    })
}

fn layout(arguments: &Arguments) -> Result<Layout, Box<Complaint>> {
    if let Some(text) = &arguments.sample {
        return Ok(Layout::Sample { count: count("--sample", text)?, seed: arguments.seed });
    }
    let Some(text) = &arguments.grid else { return Ok(Layout::default()) };
    let sides = text.split_once(['x', 'X', '×']).and_then(|(columns, rows)| {
        Some((columns.trim().parse().ok()?, rows.trim().parse().ok()?))
    });
    sides.map(|(columns, rows)| Layout::Grid { columns, rows }).ok_or_else(|| {
        let allowed = "NxM, a number of displacements and one of velocities, such as 41x31";
        let origin = Origin::Argument("--grid");
        Box::new(Complaint::new(Fault::Value, "--grid", origin, text.as_str(), allowed))
    })
}

fn text(study: &Study, done: &Basins) -> String {
    let mut text = String::new();
    if let Some(title) = study.title() {
        let _ = writeln!(text, "{title}");
    }
    let _ = writeln!(text, "{}", done.sentence(study));
    let _ = writeln!(text, "  {}", done.starts_in_words(study));
    match (&done.varied, done.portraits.as_slice()) {
        (None, [portrait]) => text += &attractors(study, portrait),
        (varied, portraits) => {
            let path = varied.as_ref().map_or("", |varied| varied.path.as_str());
            let [_, fall] = quiescence(done.in_band());
            let _ = writeln!(text, "\n  {path:<18}  base response   share of starts that {fall}");
            for portrait in portraits {
                let value = portrait.value.map_or_else(String::new, figure);
                let local = portrait.local.as_ref().map_or("unknown", |verdict| verdict.name());
                let share = portrait.quiet.map_or_else(
                    || "unknown".to_owned(),
                    |share| {
                        format!(
                            "{} ({} to {})",
                            figure(share.fraction),
                            figure(share.low),
                            figure(share.high)
                        )
                    },
                );
                let _ = writeln!(text, "  {value:<18}  {local:<14}  {share}");
            }
        }
    }
    let _ = writeln!(text, "  bounds: {}", done.meaning());
    text
}

fn attractors(study: &Study, portrait: &Portrait) -> String {
    let mut text = String::new();
    for (basin, share) in portrait.gathered.basins.iter().zip(&portrait.shares) {
        let attractor = &basin.attractor;
        let quiet = portrait.quiet_word(attractor);
        let quiet = quiet.map_or_else(String::new, |word| format!("{word}, "));
        let _ = writeln!(
            text,
            "  {:>6.2} % ({:.2} to {:.2})  {quiet}{}, peak-to-peak {}, stick fraction {}",
            100.0 * share.fraction,
            100.0 * share.low,
            100.0 * share.high,
            words(portrait.scales, attractor, portrait.period),
            figure_of(study, Quantity::Displacement, attractor.size()),
            figure(attractor.stick_fraction),
        );
    }
    text
}
