//! `quell basins`: which starts converge to which response.

use clap::Args;
use quell::run::basins::{BasinsRequest, PlaneAxis, StartLayout, default_plane, read_plane};
use quell::run::varied::Range;
use quell::study::SystemStudy;
use quell::running::Running;
use quell::verbs::{system_of, verbs};
use quell::{Complaint, Failure, Fault, Origin, Study, quantity};
use quell_model::units::Quantity;

use super::map::threads;
use super::numbers::{ascending, count, number};
use crate::answer::Answer;
use crate::arguments::{Gathered, OutputArguments, PlotArguments, StudyArguments, answer, inputs};
use crate::interrupt;
use crate::progress::Bar;

/// Finds the responses that starts in a window converge to, and the share of each
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Range of the first displacement, such as -1:1 or with units -1mm:1mm [default: around steady sliding]
    #[arg(long, value_name = "FROM:TO", allow_hyphen_values = true)]
    displacement: Option<String>,
    /// Range of its velocity [default: around 0]
    #[arg(long, value_name = "FROM:TO", allow_hyphen_values = true)]
    velocity: Option<String>,
    /// The two numbers of the state that are varied, such as x,velocity.x or x=-1:1,velocity.x=-2:2 with their windows;
    /// the others are those of the study's start [default: the first displacement and its velocity]
    #[arg(long, value_name = "NAME,NAME", conflicts_with_all = ["displacement", "velocity"], allow_hyphen_values = true)]
    plane: Option<String>,
    /// Numbers of values of the first and the second number of the grid, edges included [default: 41x31; of several masses 21x15]
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
    /// Smallest value of the parameter of --over
    #[arg(long, value_name = "A", requires = "over", allow_hyphen_values = true)]
    from: Option<String>,
    /// Largest value of the parameter of --over
    #[arg(long, value_name = "B", requires = "over", allow_hyphen_values = true)]
    to: Option<String>,
    /// Number of values of the parameter of --over
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

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Gathered::default();
    let study = complaints.take(arguments.study.read());
    let inputs = inputs(study.as_ref());
    let system = study.as_ref().map(|study| system_of(study, "basins"));
    let axes = match complaints.take(system.transpose()) {
        Some(Some(system)) => arguments.axes(&system, &mut complaints),
        _ => None,
    };
    let layout = complaints.take(layout(arguments));
    let over = over(arguments, study.as_ref(), &mut complaints);
    let threads = complaints.take(threads(arguments.threads.as_deref()));
    let outputs = complaints.take(arguments.output.prepare(&[], &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let request = axes.zip(layout).zip(over);
    let ((study, ((axes, layout), over)), (threads, (outputs, plot))) =
        complaints.finish(study.zip(request).zip(threads.zip(outputs.zip(plot))))?;
    let request = BasinsRequest { axes: Some(axes), layout, over: over.0 };
    let bar = Bar::new();
    let running = Running { threads, stop: interrupt::flag(), progress: &bar };
    let done = verbs(&study).basins(&request, running)?;
    answer(arguments.study.json, done.as_ref(), outputs, plot)
}

impl Arguments {
    /// The plane of starts.
    fn axes(&self, system: &SystemStudy, complaints: &mut Gathered) -> Option<[PlaneAxis; 2]> {
        if let Some(text) = &self.plane {
            return complaints.take(read_plane(system, text));
        }
        let mut window = |option, text: &Option<String>, quantity| {
            let read =
                |text: &str| quantity::number(text, Some(quantity), system.units(), option);
            let found = text.as_deref().map(|text| ascending(option, text, read));
            complaints.take(found.transpose())
        };
        let across = window("--displacement", &self.displacement, Quantity::Displacement);
        let up = window("--velocity", &self.velocity, Quantity::Velocity);
        complaints.take(default_plane(system, [across?, up?]))
    }
}

/// The parameter of --over and its values, if it is given.
struct Over(Option<Range>);

/// The parameter of --over; `None` after a complaint.
fn over(arguments: &Arguments, study: Option<&Study>, complaints: &mut Gathered) -> Option<Over> {
    let Some(parameter) = &arguments.over else { return Some(Over(None)) };
    let end = |option, text: &Option<String>| {
        number(option, text.as_deref().unwrap_or_default(), parameter, study)
    };
    let from = complaints.take(end("--from", &arguments.from));
    let to = complaints.take(end("--to", &arguments.to));
    let points = complaints.take(count("--points", &arguments.points));
    let ((from, to), points) = from.zip(to).zip(points)?;
    Some(Over(Some(Range { parameter: parameter.clone(), from, to, points })))
}

fn layout(arguments: &Arguments) -> Result<Option<StartLayout>, Box<Complaint>> {
    if let Some(text) = &arguments.sample {
        let count = count("--sample", text)?;
        return Ok(Some(StartLayout::Sample { count, seed: arguments.seed }));
    }
    let Some(text) = &arguments.grid else { return Ok(None) };
    let sides = text.split_once(['x', 'X', '×']).and_then(|(columns, rows)| {
        Some((columns.trim().parse().ok()?, rows.trim().parse().ok()?))
    });
    let grid = sides.map(|(columns, rows)| Some(StartLayout::Grid { columns, rows }));
    grid.ok_or_else(|| {
        let allowed = "NxM, the numbers of displacements and of velocities, such as 41x31";
        let origin = Origin::Argument("--grid");
        Box::new(Complaint::new(Fault::Value, "--grid", origin, text.as_str(), allowed))
    })
}
