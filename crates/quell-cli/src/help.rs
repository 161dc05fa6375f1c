//! The help: verbs in groups, with examples of each.

use std::fmt::Write as _;

use clap::Command;

use crate::verbs::{GROUPS, VerbGroup};

/// What is no question about a study.
const SHELL: VerbGroup = ("Shell", &[("completions", &["quell completions bash"])]);

/// Every group of the help, in order.
fn groups() -> impl Iterator<Item = &'static VerbGroup> {
    GROUPS.iter().chain([&SHELL])
}

/// Adds the groups of verbs and the examples to the help of the command line.
pub(crate) fn with_help(mut command: Command) -> Command {
    let mut listing = String::new();
    let verbs = || groups().flat_map(|(_, verbs)| *verbs);
    let width = verbs().map(|(verb, _)| verb.len()).max().unwrap_or(0);
    for (heading, verbs) in groups() {
        let _ = writeln!(listing, "{heading}:");
        for (verb, _) in *verbs {
            let about = command.find_subcommand(verb).and_then(Command::get_about);
            let about = about.map(ToString::to_string).unwrap_or_default();
            let _ = writeln!(listing, "  {verb:<width$}  {about}");
        }
        listing.push('\n');
    }
    for (verb, examples) in verbs() {
        command = command.mut_subcommand(verb, |command| {
            let mut text = String::from("Examples:\n");
            for example in *examples {
                let _ = writeln!(text, "  {example}");
            }
            if let Some(rest) = command.get_after_help() {
                let _ = write!(text, "\n{rest}");
            }
            command.after_help(text)
        });
    }
    command.help_template(format!(
        "{{about-with-newline}}\n{{usage-heading}} {{usage}}\n\n{listing}Options:\n{{options}}{{after-help}}"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::command;

    #[test]
    fn every_verb_is_in_one_group_with_examples_that_parse() {
        let command = command();
        let mut grouped: Vec<&str> =
            groups().flat_map(|(_, verbs)| verbs.iter().map(|(verb, _)| *verb)).collect();
        let mut existing: Vec<&str> = command.get_subcommands().map(Command::get_name).collect();
        grouped.sort_unstable();
        existing.sort_unstable();
        assert_eq!(grouped, existing);
        for (verb, examples) in groups().flat_map(|(_, verbs)| *verbs) {
            // One for each kind of study at most.
            assert!((1..=3).contains(&examples.len()), "{verb}");
            for example in *examples {
                let words: Vec<&str> = example.split_whitespace().collect();
                assert_eq!(words[..2], ["quell", verb]);
                command.clone().try_get_matches_from(words).unwrap_or_else(|why| panic!("{why}"));
            }
        }
    }
}
