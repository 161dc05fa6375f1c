//! The first section of the report: how many statements hold, which claims do not, and why.

use std::time::Duration;

use super::super::claims::{Claim, ClaimVerdict, StatementVerdict, count, slips, statements};
use super::super::{ReproductionOptions, Resolution, WrittenEntry};
use super::claims::{all, chip};
use quell::cite::MICHAUX_2005;
use quell::cite::errata::CORRECT_AS_PRINTED;
use quell::html::{HtmlPage, escape, symbols, table};

/// Kinds of verdict in the order of the summary, with their meaning.
const KINDS: [(&str, &str, &str); 4] = [
    ("reproduced", "holds", "every claim about it rounds to the printed number or holds"),
    (
        "reproduced within",
        "within",
        "the largest deviation is no more than the tolerance of the claim",
    ),
    (
        "printed formula wrong",
        "wrong",
        "the printed formula differs from its own definition; the correct formula is among the errata",
    ),
    (
        "not reproduced",
        "fails",
        "a claim about it deviates by more than its tolerance, or does not hold",
    ),
];

/// Writes the section.
pub(super) fn write(
    page: &mut HtmlPage,
    title: &str,
    written: &[WrittenEntry],
    options: &ReproductionOptions,
) {
    let claims: Vec<&Claim> = all(written);
    let resolution = options.resolution;
    let lead = if options.changes.is_empty() {
        "Does dither, a fast added vibration, silence friction-induced vibration, as this dissertation claims? Every figure and table \
         was recomputed from its study file, and every number and formula that can be measured was measured."
            .to_owned()
    } else {
        let changes: Vec<String> =
            options.changes.iter().map(|change| escape(&change.to_string())).collect();
        format!(
            "Figures computed like those of this dissertation with other numbers: {}. None of them is a figure of the dissertation.",
            changes.join(", ")
        )
    };
    page.put(&format!(
        "<header><p class=\"kicker\">Quell {} · reproduce{}</p><h1>{}</h1><p \
         class=\"source\">{}</p><p class=\"lead\">{lead} {}</p></header>",
        env!("CARGO_PKG_VERSION"),
        if resolution.most_points().is_some() { " --quick" } else { "" },
        title,
        escape(&MICHAUX_2005.reference()),
        extent(written, resolution),
    ));
    if claims.is_empty() {
        return;
    }
    page.section("summary", "What holds, what does not, and why");
    overview(page, &claims);
    changed(page, &claims);
    exceptions(page, &claims);
}

/// Number of figures and tables, and run time.
fn extent(written: &[WrittenEntry], resolution: Resolution) -> String {
    let figures = written.iter().filter(|done| done.product.figure.is_some()).count();
    let work: Duration = written.iter().map(|done| done.elapsed).sum();
    let quick = match resolution {
        Resolution::Full => "",
        Resolution::AtMost(_) => {
            " <strong>This is the quick report: maps have coarser grids than their study files specify; claims are measured in \
             full.</strong>"
        }
    };
    format!(
        "{figures} figures and {} data tables, {:.0} s of run time.{quick}",
        written.iter().map(|done| done.product.tables.len()).sum::<usize>(),
        work.as_secs_f64()
    )
}

fn overview(page: &mut HtmlPage, claims: &[&Claim]) {
    let statements = statements(claims.iter().copied());
    let total = statements.len();
    let share = |count: usize| 100.0 * count as f64 / total as f64;
    let counts = KINDS.map(|(name, ..)| count(&statements, name));
    let bar = KINDS
        .iter()
        .zip(counts)
        .map(|((name, class, _), count)| {
            format!(
                "<span class=\"{class}\" style=\"width:{:.3}%\" title=\"{count} {name}\"></span>",
                share(count)
            )
        })
        .collect::<Vec<String>>()
        .concat();
    let cards = KINDS
        .iter()
        .zip(counts)
        .map(|((name, class, about), count)| {
            format!("<li class=\"{class}\"><b>{count}</b> <em>{name}</em><span>{about}</span></li>")
        })
        .collect::<Vec<String>>()
        .concat();
    page.put(&format!(
        "<p>Of <strong>{total}</strong> statements, measured by {} claims:</p><div class=\"bar\">{bar}</div><ul \
         class=\"cards\">{cards}</ul><p>{}</p>",
        claims.iter().filter(|claim| claim.is_of_a_statement()).count(),
        escape(&formulas(&statements)),
    ));
}

/// How many printed formulas were compared, and the slips behind those that are wrong.
fn formulas(found: &[StatementVerdict<'_>]) -> String {
    let wrong = count(found, "printed formula wrong");
    let slips = slips(found);
    format!(
        "{} printed formulas were compared with their definitions; {wrong} are wrong, from {} slips: {}.",
        wrong + CORRECT_AS_PRINTED.len(),
        slips.len(),
        slips.join("; ")
    )
}

/// Lists verdicts that are not the expected ones, first and prominently.
fn changed(page: &mut HtmlPage, claims: &[&Claim]) {
    let changed: Vec<&&Claim> = claims.iter().filter(|claim| !claim.as_expected()).collect();
    if changed.is_empty() {
        page.put("<p class=\"calm\">Every verdict is the expected one.</p>");
        return;
    }
    let items = changed
        .iter()
        .map(|claim| {
            let expected =
                claim.expected.map_or("no verdict on record", |expected| expected.name());
            format!(
                "<li><a href=\"#claim-{0}\">{0}</a>: {1}, expected: {expected}</li>",
                escape(&claim.name),
                claim.verdict
            )
        })
        .collect::<Vec<String>>()
        .concat();
    page.put(&format!("<div class=\"alarm\"><strong>Verdicts that are not the expected ones</strong><ul>{items}</ul></div>"));
}

/// Lists the claims that do not hold, with the reasons.
fn exceptions(page: &mut HtmlPage, claims: &[&Claim]) {
    let rows = |listed: fn(&ClaimVerdict) -> bool| {
        claims.iter().filter(move |claim| listed(&claim.verdict)).map(|claim| {
            let reason = match claim.why() {
                "" => symbols(&claim.note),
                why => symbols(why),
            };
            vec![
                format!("<a href=\"#claim-{}\">{}</a>", escape(&claim.name), escape(&claim.place)),
                symbols(&claim.statement),
                symbols(&claim.printed),
                symbols(&claim.measured),
                format!("{}{}", chip(claim), reason),
            ]
        })
    };
    let names = ["where", "claim", "printed", "measured", "why"];
    page.put("<h3>Claims that do not hold</h3>");
    page.put(&table(
        "claims",
        &names,
        rows(|verdict| matches!(verdict, ClaimVerdict::NotReproduced { .. })),
    ));
    page.put("<h3>Findings that the dissertation does not state</h3>");
    page.put(&table("claims", &names, rows(|verdict| *verdict == ClaimVerdict::Finding)));
    page.put("<h3>Printed formulas that are wrong</h3>");
    page.put(&table(
        "claims",
        &names,
        rows(|verdict| matches!(verdict, ClaimVerdict::FormulaWrong { .. })),
    ));
}
