//! `quell map`: quantities over the axes of a study.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use quell::input::Inputs;
use quell::needs::Needs;
use quell::outcome::{Outcome, named};
use quell::output::Output;
use quell::picture;
use quell::map::run as map;
use quell::store::Store;
use quell::running::{MOST_THREADS, Running};
use quell::sweep::{Grid, MapQuantity, Plan, QUANTITIES};
use quell::table_file::TableFormat;
use quell::{Complaint, Failure, Fault, Origin};

use crate::answer::Answer;
use crate::arguments::{Gathered, PlotArguments, StudyArguments, inputs};
use crate::interrupt;
use crate::progress::Bar;
use crate::verbs::shard;

/// Computes quantities over the axes ([[sweep]]) of a study in parallel
#[derive(Debug, Args)]
#[command(after_help = quantities())]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Quantities to compute, separated by commas or as repeated options
    #[arg(long = "quantity", value_name = "NAME", required = true, value_delimiter = ',')]
    quantities: Vec<String>,
    /// Saves the map as a Zarr store, written during the computation, or as a table at the end
    #[arg(long, value_name = "FILE.zarr|.csv|.mat|.nc")]
    save: Option<PathBuf>,
    /// Continues the store of --save if it exists
    #[arg(long)]
    resume: bool,
    /// Computes part K of N equal parts of the map into the store of --save; other processes, on any machines, compute the
    /// other parts
    #[arg(long, value_name = "K/N", allow_hyphen_values = true, conflicts_with = "resume")]
    shard: Option<String>,
    /// Number of threads [default: all cores]
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    threads: Option<String>,
    #[command(flatten)]
    plot: PlotArguments,
}

/// The list of quantities in the help.
fn quantities() -> String {
    let mut text = String::new();
    for needs in [Needs::SLIDING, Needs::CONTACTS, Needs::ONE_MASS, Needs::MOTIONS] {
        let _ = writeln!(text, "Quantities of {}:", needs.about());
        let all = QUANTITIES.iter().copied().flatten();
        for quantity in all.filter(|quantity| quantity.needs == needs) {
            let _ = writeln!(text, "  {:<20}  {}", quantity.name, quantity.about);
        }
    }
    text + "\nExit status: 0 done, 2 invalid input, 1 failed, 130 interrupted."
}

/// Where the map is saved.
enum Keep {
    Nowhere,
    Table(Output),
    Zarr(PathBuf),
}

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Gathered::default();
    let study = complaints.take(arguments.study.read());
    let inputs = inputs(study.as_ref());
    let names = arguments.quantities.iter().map(|name| name.trim());
    let asked: Vec<&'static MapQuantity> =
        names.filter_map(|name| complaints.take(MapQuantity::named(name, "--quantity"))).collect();
    let threads = complaints.take(threads(arguments.threads.as_deref()));
    let keep = complaints.take(keep(arguments, &inputs));
    let shard = arguments.shard.as_deref().map(|text| shard::read(text, arguments.plot.asked()));
    let shard = complaints.take(shard.transpose());
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let plan = study.and_then(|study| complaints.take(Plan::new(&study, &asked)));
    if let (Some(plan), Some(plot)) = (&plan, &plot)
        && plot.wanted()
    {
        complaints.take(drawable(plan.grid()));
    }
    let (((plan, keep), shard), (threads, plot)) =
        complaints.finish(plan.zip(keep).zip(shard).zip(threads.zip(plot)))?;

    if let (Some(shard), Keep::Zarr(path)) = (shard, &keep) {
        return shard::run(shard, path, plan, threads, arguments.study.json);
    }
    let store = match &keep {
        Keep::Zarr(path) => Some(Store::open(path, &plan, arguments.resume)?),
        Keep::Table(_) | Keep::Nowhere => None,
    };
    let bar = Bar::new();
    if let Keep::Zarr(path) = &keep {
        bar.keeps(path, "the same command with --resume continues");
    }
    let running = Running { threads, stop: interrupt::flag(), progress: &bar };
    let done = map(plan, store.as_ref(), running)?;
    let mut object = named(&done, done.json());
    match keep {
        Keep::Table(output) => {
            let format = TableFormat::of_extension(&output.extension());
            let files = format.unwrap_or(TableFormat::Csv).files(&done.datasets(), "--save")?;
            let written = output.write(&files.concat())?;
            object["saved"] = vec![written.display().to_string()].into();
        }
        Keep::Zarr(path) => object["saved"] = vec![path.display().to_string()].into(),
        Keep::Nowhere => {}
    }
    plot.write(&done, &mut object)?;
    Ok(Answer::new(arguments.study.json, &object, || done.text()))
}

pub(super) fn threads(text: Option<&str>) -> Result<Option<usize>, Box<Complaint>> {
    let Some(text) = text else {
        return Ok(None);
    };
    match text.parse() {
        Ok(threads) if (1..=MOST_THREADS).contains(&threads) => Ok(Some(threads)),
        _ => {
            let allowed = format!("a whole number from 1 to {MOST_THREADS}");
            Err(Box::new(Complaint::option("--threads", text, allowed)))
        }
    }
}

fn keep(arguments: &Arguments, inputs: &Inputs) -> Result<Keep, Box<Complaint>> {
    let zarr = |path: &PathBuf| path.extension().is_some_and(|extension| extension == "zarr");
    match &arguments.save {
        Some(path) if zarr(path) => Ok(Keep::Zarr(path.clone())),
        _ if arguments.resume || arguments.shard.is_some() => {
            let (option, allowed) = if arguments.resume {
                ("--resume", "--resume continues a store: name it by --save FILE.zarr")
            } else {
                ("--shard", "--shard writes into a store: name it by --save FILE.zarr")
            };
            Err(Box::new(Complaint::new(Fault::Usage, option, Origin::Whole, option, allowed)))
        }
        Some(path) => {
            let extensions = [TableFormat::EXTENSIONS, &["zarr"]].concat();
            Output::prepare(path, "--save", &extensions, inputs).map(Keep::Table)
        }
        None => Ok(Keep::Nowhere),
    }
}

/// Rejects a picture with too many panels: one for each point of the axes before the last two.
fn drawable(grid: &Grid) -> Result<(), Box<Complaint>> {
    let shape = grid.shape();
    let panels: usize = shape[..shape.len().saturating_sub(2)].iter().product();
    if panels <= picture::MOST_PANELS {
        return Ok(());
    }
    let allowed = format!(
        "--plot draws one panel for each point of the axes before the last two, at most {}; this study has {panels}: \
         save the map and plot it from the saved file",
        picture::MOST_PANELS
    );
    let origin = Origin::Argument("--plot");
    Err(Box::new(Complaint::new(Fault::Value, "--plot", origin, panels, allowed)))
}
