//! The errata of the dissertation as a page: every correction with the printed form, the correct form, and the test that proves
//! it.

use std::fmt::Write as _;

use super::citation::Task;
use super::correction::{Bears, Correction, Proof};
use super::corrections::CORRECTIONS;
use super::references::MICHAUX_2005;

/// Equations that were compared with quadrature and are correct as printed, with the ends of ranges written out.
pub const CORRECT_AS_PRINTED: &[&str] = &[
    "3.20b", "3.27", "3.29", "3.30", "3.31", "3.37", "3.38b", "3.39", "3.41", "3.42", "3.43",
    "3.44", "3.49", "3.50", "3.51", "3.52", "3.53b", "3.54", "3.55", "3.56", "3.57", "3.58",
    "3.59", "3.60", "3.61", "3.62", "4.21", "4.22", "4.23", "A.3", "A.4", "B.6", "B.10b", "C.3",
    "C.4", "C.5", "C.6", "C.7", "4.33", "4.34", "4.37", "4.39", "4.40", "4.41", "4.42",
];

const OPENING: &str = "\
Every error found in the printed text, in the order of the text, with the correct form. A formula or number that enters a \
computation has a test that computes both the printed and the correct form and compares them with something independent: \
quadrature of the definition, exact eigenvalues, or an exact orbit. Errors without a number (a bracket, a word) are listed, but \
not tested.

The text used is an optical reading of the print: a lost sign in an exponent may be an error of the reading and not of the \
author.

`quell cite` prints the entries of this list that concern a study, and the report of `quell reproduce` contains the list.

Symbols: γ = πα/(4v_m), w = |v_r|/v_m, κ = 4v_mζ/(3FΔμ), Δμ = μ_s − μ_m.
";

/// The page as Markdown; links to tests are relative to `root`, such as `../../..`.
pub fn markdown(root: &str) -> String {
    let correct: Vec<String> =
        CORRECT_AS_PRINTED.iter().map(|equation| format!("({equation})")).collect();
    let mut page = format!(
        "# Errata\n\n{}.\n\n{OPENING}\nCompared with quadrature and correct as printed, {} equations: {}; those of chapter 4 in \
         their own terms, with α_T replaced by μ(v₀)α_N, and (3.44) and (4.34) with the brace that their reading lost.\n",
        MICHAUX_2005.reference(),
        correct.len(),
        correct.join(", ")
    );
    let belt = |correction: &&Correction| !is_about_disc(correction);
    for (title, corrections) in [
        ("Chapters 2 to 4: the belt", CORRECTIONS.iter().filter(belt).collect::<Vec<_>>()),
        ("Chapter 5: the disc", CORRECTIONS.iter().filter(|entry| is_about_disc(entry)).collect()),
    ] {
        let _ = write!(
            page,
            "\n## {title}\n\n| where | printed | correct | concerns | shown by |\n|---|---|---|---|---|\n"
        );
        for correction in corrections {
            let cells = [
                correction.equations.to_owned(),
                correction.printed.to_owned(),
                correction.right.to_owned(),
                verbs(correction.tasks),
                proof(correction.proof, root),
            ];
            let _ =
                writeln!(page, "| {} |", cells.map(|cell| cell.replace('|', "\\|")).join(" | "));
        }
    }
    page
}

/// Whether a correction belongs to chapter 5.
fn is_about_disc(correction: &Correction) -> bool {
    matches!(correction.bears, Bears::Disc(_))
}

fn verbs(tasks: &[Task]) -> String {
    let names: Vec<String> = tasks.iter().map(|task| format!("`{}`", task.name())).collect();
    names.join(", ")
}

fn proof(proof: Proof, root: &str) -> String {
    match proof {
        Proof::Test { file, name } => format!("[{name}]({root}/{file})"),
        Proof::Reading => "reading".to_owned(),
    }
}
