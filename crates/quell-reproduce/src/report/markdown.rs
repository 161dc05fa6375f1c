//! The report as a Markdown table: one line per figure or table, with its files, claims and run time.

use std::fmt::Write as _;

use super::super::{ReproductionOptions, WrittenEntry};
use super::claims;
use crate::claims::{statements, summary};

/// The table.
pub(crate) fn markdown(written: &[WrittenEntry], options: &ReproductionOptions) -> String {
    let all = claims::all(written);
    let mut text = format!("# {}\n\n", super::title(options));
    if options.resolution.most_points().is_some() {
        text += "Quick: maps have coarser grids than their study files specify.\n\n";
    }
    if !all.is_empty() {
        text += &summary(&statements(all.iter().copied()));
        text += "\n\n";
    }
    text += "| name | what | claims that hold | corrections applied | files | seconds |\n|---|---|---|---|---|---|\n";
    for done in written {
        let mut of = claims::of(&done.entry, &all);
        of.retain(|claim| claim.is_of_a_statement());
        let holding = of.iter().filter(|claim| claim.verdict.holds()).count();
        let counted =
            if of.is_empty() { String::new() } else { format!("{holding} of {}", of.len()) };
        let files: Vec<String> = done
            .files
            .iter()
            .filter_map(|file| file.file_name()?.to_str())
            .map(|name| format!("[{name}]({name})"))
            .collect();
        let _ = writeln!(
            text,
            "| {} | {} | {counted} | {} | {} | {:.2} |",
            done.entry.name,
            done.entry.about,
            done.product.sources.corrections.len(),
            files.join(", "),
            done.elapsed.as_secs_f64()
        );
    }
    text
}
