//! What a command line that cannot be parsed probably meant, in one sentence.

use std::ffi::OsString;
use std::path::Path;

use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Command, Error};
use quell::Study;
use quell::study::vocabulary::{Key, keys};

/// Words in place of a verb, and what to type.
const OTHER_WORDS: &[(&[&str], &str)] = &[
    (
        &["run", "sim", "solve", "integrate"],
        "`quell simulate STUDY` computes one run, `quell report STUDY` answers every question about a study",
    ),
    (&["version"], "`quell --version`"),
    (
        &["plot", "draw", "show", "view"],
        "`quell sketch STUDY` draws a study, and `--plot FILE.svg` of a verb its answer",
    ),
    (&["validate", "lint", "info", "read"], "`quell check STUDY`"),
    (&["init", "create", "example", "examples"], "`quell new` writes a study"),
    (
        &["optimise", "optimize", "dither"],
        "`quell design STUDY` finds the least dither, `quell thresholds STUDY` where it begins to quench",
    ),
    (&["threshold", "quench"], "`quell thresholds STUDY`"),
    (
        &["sweep", "scan", "grid"],
        "`quell map STUDY` computes the points of [[sweep]], `quell bifurcation STUDY` follows one number",
    ),
    (
        &["eigenvalues", "eigen", "frequencies"],
        "`quell stability STUDY` gives eigenvalues of small motions, `quell modes STUDY` natural frequencies",
    ),
    (&["keys", "parameters"], "`quell schema` lists the keys of a study"),
];

/// An option of ours by its name in the parser, and what it does.
type OurOption = (&'static str, &'static str);

/// Options that other programs have, and which of ours do it.
const OTHER_OPTIONS: &[(&[&str], &[OurOption])] = &[
    (
        &["-o", "--output", "--out", "--export", "--csv", "-f", "--file"],
        &[("save", "`--save FILE` writes the numbers"), ("plot", "`--plot FILE.svg` the picture")],
    ),
    (&["-p", "--figure", "--png", "--svg"], &[("plot", "`--plot FILE.svg` draws the answer")]),
    (&["-j", "--format"], &[("json", "`--json` prints one JSON object")]),
    (&["-s", "--param", "-D"], &[("set", "`--set PATH=VALUE` changes a number of the study")]),
    (
        &["-t", "--time", "--duration", "--t-end"],
        &[("until", "`--until TIME` sets the end of the run")],
    ),
    (
        &["--from", "--to", "--range", "--between"],
        &[
            ("speeds", "`--speeds FROM:TO` sets the range of speeds"),
            ("frequency", "`--frequency FROM:TO` that of dither frequencies"),
            ("window", "`--window FROM:TO` sets the ends of the interval"),
        ],
    ),
];

/// Most paths that a hint lists.
const MOST_PATHS: usize = 3;

/// The error with a hint in place of the suggestions of the parser, where there is a better one.
pub(crate) fn explained(mut error: Error, arguments: &[OsString], command: &Command) -> Error {
    // That a word could be passed as a value helps nobody: no verb takes such values.
    if error.kind() == ErrorKind::UnknownArgument {
        error.remove(ContextKind::Suggested);
    }
    if let Some(hint) = hint(&error, arguments, command) {
        for kind in [ContextKind::SuggestedSubcommand, ContextKind::SuggestedArg] {
            error.remove(kind);
        }
        let hints = vec![StyledStr::from(hint)];
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(hints));
    }
    error
}

/// The hint of an error that has one.
pub(crate) fn of(error: &Error) -> Option<String> {
    match error.get(ContextKind::Suggested) {
        Some(ContextValue::StyledStrs(hints)) => hints.first().map(ToString::to_string),
        _ => None,
    }
}

fn hint(error: &Error, arguments: &[OsString], command: &Command) -> Option<String> {
    let text = |kind| match error.get(kind) {
        Some(ContextValue::String(text)) => Some(text.as_str()),
        Some(ContextValue::Strings(texts)) => texts.first().map(String::as_str),
        _ => None,
    };
    let words: Vec<&str> = arguments.iter().filter_map(|word| word.to_str()).collect();
    match error.kind() {
        ErrorKind::InvalidSubcommand => for_verb(text(ContextKind::InvalidSubcommand)?),
        ErrorKind::UnknownArgument => {
            let argument = text(ContextKind::InvalidArg)?;
            let verb = words.get(1).and_then(|name| command.find_subcommand(name));
            for_value(argument, &words)
                .or_else(|| for_option(argument, verb?))
                .or_else(|| for_number(argument, &words, verb?))
                .or_else(|| of_other_verbs(argument, verb?, command))
        }
        ErrorKind::MissingRequiredArgument if text(ContextKind::InvalidArg) == Some("<STUDY>") => {
            Some("`quell new` writes a study to begin with".to_owned())
        }
        _ => None,
    }
}

/// A word where a verb is expected.
fn for_verb(word: &str) -> Option<String> {
    let path = Path::new(word);
    if path.extension().is_some_and(|extension| extension == "toml") || path.is_file() {
        return Some(format!(
            "the verb comes before the study: `quell report {word}` answers every question about it, `quell check {word}` shows its numbers"
        ));
    }
    let lower = word.to_lowercase();
    let known = OTHER_WORDS.iter().find(|(words, _)| words.contains(&lower.as_str()));
    known.map(|(_, hint)| (*hint).to_owned())
}

/// A value that stands alone, after a path of `--set`.
fn for_value(value: &str, words: &[&str]) -> Option<String> {
    let place = words.iter().position(|word| *word == value)?;
    let before = words.get(place.checked_sub(2)?..place)?;
    (before[0] == "--set" && !before[1].contains('='))
        .then(|| format!("`--set {}={value}`, in one word", before[1]))
}

/// An option of other programs.
fn for_option(option: &str, verb: &Command) -> Option<String> {
    let name = option.split('=').next().unwrap_or(option);
    let (_, ours) = OTHER_OPTIONS.iter().find(|(names, _)| names.contains(&name))?;
    let has = |id: &str| verb.get_arguments().any(|argument| argument.get_id() == id);
    let hints: Vec<&str> = ours.iter().filter(|(id, _)| has(id)).map(|(_, hint)| *hint).collect();
    (!hints.is_empty()).then(|| hints.join(", "))
}

/// An option that other verbs have.
fn of_other_verbs(option: &str, verb: &Command, command: &Command) -> Option<String> {
    let name = option.split('=').next()?.strip_prefix("--")?;
    let has = |verb: &&Command| verb.get_arguments().any(|own| own.get_long() == Some(name));
    let verbs = command.get_subcommands().filter(has).map(|verb| format!("`{}`", verb.get_name()));
    let verbs: Vec<String> = verbs.collect();
    let of = verb.get_name();
    (!verbs.is_empty()).then(|| {
        format!(
            "--{name} is an option of {}; `quell {of} --help` shows those of `{of}`",
            verbs.join(", ")
        )
    })
}

/// A number of the study as an option.
fn for_number(option: &str, words: &[&str], verb: &Command) -> Option<String> {
    verb.get_arguments().find(|argument| argument.get_id() == "set")?;
    let name = option.strip_prefix("--")?.replace('-', "_");
    let place = words.iter().position(|word| word.split('=').next() == Some(option))?;
    let joined = words[place].split_once('=').map(|(_, value)| value);
    let next = words.get(place + 1).filter(|next| !next.starts_with("--"));
    let value = joined.or(next.copied()).unwrap_or("VALUE");
    let named = keys().iter().filter(|key| key.name == name && key.takes_number());
    let mut paths: Vec<String> = named.map(Key::path).collect();
    if let Some(study) = words.iter().skip(2).find_map(|word| study_at(word)) {
        paths.retain(|path| study.number(path).is_some());
    }
    paths.sort_by_key(|path| path.matches('.').count());
    paths.dedup();
    paths.truncate(MOST_PATHS);
    let set: Vec<String> = paths.iter().map(|path| format!("`--set {path}={value}`")).collect();
    (!set.is_empty()).then(|| format!("a number of the study is changed by {}", set.join(" or ")))
}

/// The study in a file.
fn study_at(word: &str) -> Option<Study> {
    let path = Path::new(word);
    let is_study = path.extension().is_some_and(|extension| extension == "toml");
    if is_study { Study::read(path, &[]).ok() } else { None }
}
