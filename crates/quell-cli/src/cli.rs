//! The verbs, and the dispatch of a command line to them.
//!
//! Exit status: 0 done, 2 invalid input (usage errors too), 1 failed, 130 interrupted. With `--json`, standard output contains
//! exactly one object, also in case of an error.

use std::ffi::OsString;
use std::process::ExitCode;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{ArgMatches, Command, CommandFactory, FromArgMatches, Parser, Subcommand};
use quell::{Complaint, Failure, Fault, Origin};
use serde_json::Value as Json;

use crate::answer::Answer;
use crate::verbs::{
    actuator, attractor, basins, bifurcation, check, cite, compare, completions, design, fit,
    friction, map, modes, new, orbit, probability, report, reproduce, resonances, response, schema,
    simulate, sketch, stability, thresholds, waveforms,
};
use crate::{answer, help, interrupt, progress};

/// Finds the dither that silences friction-induced vibration, and quantifies its confidence
#[derive(Debug, Parser)]
#[command(name = "quell", version, propagate_version = true, arg_required_else_help = true)]
#[command(subcommand_value_name = "VERB")]
#[command(after_help = "`quell VERB --help` shows the options and examples of a verb.\n\
                        Exit status: 0 done, 2 invalid input, 1 failed, 130 interrupted.")]
pub(crate) struct Cli {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Debug, Subcommand)]
enum Verb {
    New(new::Arguments),
    Completions(completions::Arguments),
    Check(check::Arguments),
    Schema(schema::Arguments),
    Sketch(sketch::Arguments),
    Report(report::Arguments),
    Cite(cite::Arguments),
    Fit(fit::Arguments),
    Compare(compare::Arguments),
    Friction(friction::Arguments),
    Stability(stability::Arguments),
    Simulate(simulate::Arguments),
    Response(response::Arguments),
    Orbit(orbit::Arguments),
    Attractor(attractor::Arguments),
    Thresholds(thresholds::Arguments),
    Waveforms(waveforms::Arguments),
    Design(design::Arguments),
    Actuator(actuator::Arguments),
    Probability(probability::Arguments),
    Bifurcation(bifurcation::Arguments),
    Basins(basins::Arguments),
    Map(map::Arguments),
    Modes(modes::Arguments),
    Resonances(resonances::Arguments),
    Reproduce(reproduce::Arguments),
}

/// The command line with its help.
pub(crate) fn command() -> Command {
    help::with_help(Cli::command())
}

/// Runs the command line `arguments`, program name first.
pub(crate) fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    let json = arguments
        .iter()
        .take_while(|argument| *argument != "--")
        .any(|argument| argument == "--json");
    let parsed = command().try_get_matches_from(&arguments);
    let named = |matches: ArgMatches| {
        let name = matches.subcommand_name().unwrap_or_default().to_owned();
        Cli::from_arg_matches(&matches).map(|cli| (name, cli))
    };
    let (name, cli) = match parsed.and_then(named) {
        Ok(named) => named,
        Err(error) => return usage_error(&error, json),
    };
    match progress::during(&name, || cli.verb.run()) {
        Ok(answer) => answer.show(),
        Err(failure) => {
            let status = answer::refuse(&failure, json);
            if interrupt::is_stopping() { ExitCode::from(interrupt::INTERRUPTED) } else { status }
        }
    }
}

impl Verb {
    /// The answer of the verb.
    fn run(&self) -> Result<Answer, Failure> {
        match self {
            Self::New(arguments) => new::run(arguments),
            Self::Completions(arguments) => completions::run(arguments, &mut command()),
            Self::Check(arguments) => check::run(arguments),
            Self::Schema(arguments) => schema::run(arguments),
            Self::Sketch(arguments) => sketch::run(arguments),
            Self::Report(arguments) => report::run(arguments),
            Self::Cite(arguments) => cite::run(arguments),
            Self::Fit(arguments) => fit::run(arguments),
            Self::Compare(arguments) => compare::run(arguments),
            Self::Friction(arguments) => friction::run(arguments),
            Self::Stability(arguments) => stability::run(arguments),
            Self::Simulate(arguments) => simulate::run(arguments),
            Self::Response(arguments) => response::run(arguments),
            Self::Orbit(arguments) => orbit::run(arguments),
            Self::Attractor(arguments) => attractor::run(arguments),
            Self::Thresholds(arguments) => thresholds::run(arguments),
            Self::Waveforms(arguments) => waveforms::run(arguments),
            Self::Design(arguments) => design::run(arguments),
            Self::Actuator(arguments) => actuator::run(arguments),
            Self::Probability(arguments) => probability::run(arguments),
            Self::Bifurcation(arguments) => bifurcation::run(arguments),
            Self::Basins(arguments) => basins::run(arguments),
            Self::Map(arguments) => map::run(arguments),
            Self::Modes(arguments) => modes::run(arguments),
            Self::Resonances(arguments) => resonances::run(arguments),
            Self::Reproduce(arguments) => reproduce::run(arguments),
        }
    }
}

/// Prints the requested help, or a usage error.
fn usage_error(error: &clap::Error, json: bool) -> ExitCode {
    let requested = matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion);
    if requested {
        return answer::print(&error.render().to_string());
    }
    if !json {
        answer::print_error(&error.render().to_string());
        return ExitCode::from(2);
    }
    answer::refuse(&Failure::from(complaint(error)), json)
}

/// A usage error as a complaint.
fn complaint(error: &clap::Error) -> Complaint {
    let context = |kind| match error.get(kind) {
        Some(ContextValue::String(text)) => Some(text.clone()),
        Some(ContextValue::Strings(texts)) => texts.first().cloned(),
        _ => None,
    };
    let argument =
        context(ContextKind::InvalidArg).or_else(|| context(ContextKind::InvalidSubcommand));
    // "--until <T>" and "<STUDY>" are named without their placeholders.
    let key = argument
        .as_deref()
        .and_then(|name| name.split([' ', '=']).next())
        .unwrap_or("command line");
    let text = error.render().to_string();
    let first = text.lines().next().unwrap_or_default().trim_start_matches("error: ").to_owned();
    // The names of missing arguments follow, one per line.
    let message = if first.ends_with(':') {
        let names = text.lines().skip(1).take_while(|line| !line.trim().is_empty());
        let names: Vec<&str> = names.map(str::trim).collect();
        format!("{first} {}", names.join(", "))
    } else {
        first
    };
    let value = context(ContextKind::InvalidValue).map_or(Json::Null, Json::from);
    let suggestion = context(ContextKind::SuggestedArg)
        .or_else(|| context(ContextKind::SuggestedSubcommand))
        .or_else(|| context(ContextKind::SuggestedValue));
    Complaint::new(Fault::Usage, key, Origin::Whole, value, message).suggesting(suggestion)
}
