//! The errata of the dissertation as a page: every correction with what is printed, what is right, and the test that
//! shows it.

use std::fmt::Write as _;

use super::citation::Task;
use super::correction::{Bears, Correction, Proof};
use super::corrections::CORRECTIONS;
use super::references::MICHAUX_2005;

const OPENING: &str = "\
Every place where the print was found wrong, in its order, with what is right. A formula or number that enters a computation \
has a test that computes the printed form and the right one and holds both against something independent: quadrature of the \
definition, exact eigenvalues, an exact orbit. What carries no number (a bracket, a word) is told and not tested.

The text used is an optical reading of the print: a lost sign in an exponent may be the reading's fault and not the author's. \
Held to quadrature and right as printed: (3.20b), (3.27), (3.29)–(3.31), (3.37), (3.38b), (3.39), (3.41)–(3.43), (3.49)–(3.52), \
(3.53b), (3.54)–(3.62), (4.21)–(4.23), (A.3), (A.4), (B.6), (B.10b), (C.3)–(C.7); and (4.33), (4.37), (4.39)–(4.42) as what they \
are, α_T replaced by μ(v₀)α_N.

The same list is behind `quell cite`, which tells what of it bears on a study, and behind the report of `quell reproduce`.

Symbols: γ = πα/(4v_m), w = |v_r|/v_m, κ = 4v_mζ/(3FΔμ), Δμ = μ_s − μ_m.
";

/// The page as Markdown; links to tests go to `root`, such as `../../..`.
pub fn markdown(root: &str) -> String {
    let mut page = format!("# Errata\n\n{}.\n\n{OPENING}", MICHAUX_2005.reference);
    let belt = |correction: &&Correction| !of_disc(correction);
    for (title, corrections) in [
        ("Chapters 2 to 4: the belt", CORRECTIONS.iter().filter(belt).collect::<Vec<_>>()),
        ("Chapter 5: the disc", CORRECTIONS.iter().filter(|it| of_disc(it)).collect()),
    ] {
        let _ = write!(
            page,
            "\n## {title}\n\n| where | printed | right | concerns | shown by |\n|---|---|---|---|---|\n"
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

/// Is it of chapter 5?
fn of_disc(correction: &Correction) -> bool {
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
