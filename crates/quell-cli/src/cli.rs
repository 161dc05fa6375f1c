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

use crate::verbs::{Verb, completions};
use crate::{answer, help, hint, interrupt, progress};

/// Finds the dither that silences friction-induced vibration, and quantifies its confidence
#[derive(Debug, Parser)]
#[command(name = "quell", version, propagate_version = true, arg_required_else_help = true)]
#[command(subcommand_value_name = "VERB")]
#[command(after_help = "`quell VERB --help` shows the options and examples of a verb.\n\
                        Exit status: 0 done, 2 invalid input, 1 failed, 130 interrupted.")]
pub(crate) struct Cli {
    #[command(subcommand)]
    verb: CliVerb,
}

#[derive(Debug, Subcommand)]
enum CliVerb {
    #[command(flatten)]
    Answering(Box<Verb>),
    Completions(completions::Arguments),
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
    let mut command = command();
    let parsed = command.try_get_matches_from_mut(&arguments);
    let named = |matches: ArgMatches| {
        let name = matches.subcommand_name().unwrap_or_default().to_owned();
        Cli::from_arg_matches(&matches).map(|cli| (name, cli))
    };
    let (name, cli) = match parsed.and_then(named) {
        Ok(named) => named,
        Err(error) => {
            let asked = arguments.get(1).and_then(|word| command.find_subcommand(word));
            let asked = asked.map(Command::get_name);
            return usage_error(&hint::explained(error, &arguments, &command), asked, json);
        }
    };
    let answer = match &cli.verb {
        CliVerb::Answering(verb) => progress::during(&name, || verb.run()),
        CliVerb::Completions(arguments) => completions::run(arguments, &mut command),
    };
    match answer {
        Ok(answer) => answer.show(),
        Err(failure) => {
            let status = answer::refuse(&failure, Some(&name), json);
            if interrupt::is_stopping() { ExitCode::from(interrupt::INTERRUPTED) } else { status }
        }
    }
}

/// Prints the requested help, or a usage error.
fn usage_error(error: &clap::Error, asked: Option<&str>, json: bool) -> ExitCode {
    let requested = matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion);
    if requested {
        return answer::print(&error.render().to_string());
    }
    if !json {
        answer::print_error(&error.render().to_string());
        return ExitCode::from(2);
    }
    answer::refuse(&Failure::from(complaint(error)), asked, json)
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
    let message = match hint::of(error) {
        Some(hint) => format!("{message}; {hint}"),
        None => message,
    };
    let value = context(ContextKind::InvalidValue).map_or(Json::Null, Json::from);
    let suggestion = context(ContextKind::SuggestedArg)
        .or_else(|| context(ContextKind::SuggestedSubcommand))
        .or_else(|| context(ContextKind::SuggestedValue));
    Complaint::new(Fault::Usage, key, Origin::Whole, value, message).suggesting(suggestion)
}
