//! `quell cite`: what a study's computations rest on.

use std::fmt::Write as _;

use clap::Args;
use quell::Failure;
use quell::cite::sources_of;

use crate::answer::Answer;
use crate::arguments::StudyArguments;

/// Lists the equations and papers that a study's computations use, and corrections of the print
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Prints BibTeX entries instead
    #[arg(long)]
    bibtex: bool,
}

/// Answers.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let study = arguments.study.read_any()?;
    let found = sources_of(&study);
    let text = || {
        if arguments.bibtex {
            return found.bibtex();
        }
        let mut text = String::new();
        for source in found.unique() {
            let _ = writeln!(text, "[{}] {}", source.key, source.reference);
            let mut uses: Vec<(&str, Vec<&str>)> = Vec::new();
            for citation in found.citations.iter().filter(|citation| citation.source == source) {
                match uses.iter_mut().find(|(used, _)| *used == citation.used) {
                    Some((_, verbs)) => verbs.push(citation.task.name()),
                    None => uses.push((citation.used, vec![citation.task.name()])),
                }
            }
            for (used, verbs) in uses {
                let _ = writeln!(text, "    {used} ({})", verbs.join(", "));
            }
        }
        if !found.corrections.is_empty() {
            text.push_str("\nWhere the print was corrected:\n");
        }
        for correction in &found.corrections {
            let _ = writeln!(text, "    {}: {}", correction.equations, correction.right);
        }
        text
    };
    Ok(Answer::new(arguments.study.json, &found.json(), text))
}
