//! The page of a report.

use quell_model::digits::digits;
use serde_json::Value as Json;

use crate::cite::Sources;
use crate::html::{HtmlPage, escape, symbols, table};
use crate::plot;
use crate::study::Kind;
use crate::verbs::verbs;
use crate::words::capital;

use super::facts::{self, FactRow};
use super::parts::{ReportedAnswer, StudyReport};
use super::plan::is_dithered;

/// The style sheet, with rules for paper.
const STYLE: &str = include_str!("report.css");

/// Fields of an answer that are costs of a dither.
const COSTS: &[&str] = &[
    "mean_friction",
    "steady_sliding_friction",
    "friction_loss",
    "friction_power",
    "dither_power",
    "dither_stroke",
    "power",
    "stroke",
    "minimum_normal_load",
];
/// Fields that state a verdict, and its error: the first that an answer has.
const VERDICTS: &[&str] = &["/verdict", "/effect", "/local/0/kind"];
/// The same where no dither acts, which has no effect.
const UNDITHERED_VERDICTS: &[&str] = &["/verdict", "/ends_on"];
const ERRORS: &[&str] = &[
    "/growth_rate_error",
    "/multiplier_error",
    "/error",
    "/residual",
    "/local/0/error",
    "/thresholds/0/error",
    "/changes/0/relative_error",
];

/// Verbs whose pictures are shown at once, the most important first, and how many of them.
const PICTURED: &[&str] =
    &["thresholds", "response", "design", "probability", "stability", "resonances", "friction"];
const MOST_PICTURES: usize = 2;

/// The page.
pub(super) fn html(report: &StudyReport) -> String {
    let title = report.study.picture_title();
    let title = title.as_deref().unwrap_or("Report about a study");
    let mut page = HtmlPage::new(title, STYLE);
    page.put(&format!(
        "<header><p class=\"kicker\">Report of Quell {}</p><h1>{}</h1><p class=\"lead\">{}</p></header>",
        env!("CARGO_PKG_VERSION"),
        escape(title),
        escape(&report.question)
    ));
    let pictured = pictured(report);
    answer(&mut page, report);
    sketch(&mut page, report);
    verdicts(&mut page, report);
    cost(&mut page, report);
    pictures(&mut page, &pictured);
    unexamined(&mut page, report);
    // What is behind the answer is shown where it is asked for, and not on paper.
    assumptions(&mut page, report);
    values(&mut page, report);
    answers(&mut page, report, &pictured);
    sources(&mut page, report);
    numbers(&mut page, report);
    study(&mut page, report);
    page.finish()
}

/// The answer in one paragraph: the sentences of the verbs that answer the question.
fn answer(page: &mut HtmlPage, report: &StudyReport) {
    page.section("answer", "The answer");
    let wanted: &[&str] = match report.study.disc() {
        Err(_) if is_dithered(&report.study) => &["response", "thresholds"],
        Err(_) => &["stability", "response"],
        Ok(_) => &["stability"],
    };
    let of = |verbs: &[&str]| -> Vec<String> {
        let said = report.answers.iter().filter(|answer| verbs.contains(&answer.verb));
        said.filter_map(|answer| answer.outcome.sentence()).map(|text| symbols(&text)).collect()
    };
    let mut sentences = of(wanted);
    sentences.extend(of(&["design", "probability"]));
    if sentences.is_empty() {
        page.put("<p>No verb answered the question; what was not examined says why.</p>");
    } else {
        page.put(&format!("<p class=\"lead\">{}</p>", sentences.join(" ")));
    }
}

fn sketch(page: &mut HtmlPage, report: &StudyReport) {
    page.section("sketch", "The system");
    let label = escape(&report.sketch.title);
    page.put(&format!(
        "<figure aria-label=\"Sketch: {label}\">{}<figcaption>The mechanism of the study, not to scale.</figcaption></figure>",
        report.sketch.to_svg()
    ));
}

/// What the computations take for granted: the equations and their uses, from the sources, and what the check warns about.
fn assumptions(page: &mut HtmlPage, report: &StudyReport) {
    page.folded("assumptions", "Assumptions");
    let sources = cited(report);
    let starts = report.answers.iter().map(|answer| format!("{}: {}", answer.verb, answer.start));
    page.put("<p>The answers use these equations and methods:</p>");
    page.put(&list(sources.uses().into_iter().map(symbols)));
    page.put("<p>Where each computation starts:</p>");
    page.put(&list(starts.map(|text| symbols(&text))));
}

fn values(page: &mut HtmlPage, report: &StudyReport) {
    page.folded("values", "Values of the study");
    page.put(&fact_table(&facts::rows(&report.check.facts())));
}

/// One row for each answer: verdict, start, error.
fn verdicts(page: &mut HtmlPage, report: &StudyReport) {
    page.section("verdicts", "Verdicts");
    if report.answers.is_empty() {
        page.put("<p>No verb gave an answer.</p>");
        return;
    }
    let rows = report.answers.iter().filter_map(|answer| {
        let first = |pointers: &[&str], digits: &dyn Fn(f64) -> String| {
            pointers.iter().find_map(|pointer| match answer.facts.pointer(pointer) {
                Some(Json::String(text)) => Some(escape(text)),
                Some(Json::Number(number)) => number.as_f64().map(digits),
                _ => None,
            })
        };
        let shown = |text: Option<String>| text.unwrap_or_else(|| "–".to_owned());
        let wanted = if is_dithered(&report.study) { VERDICTS } else { UNDITHERED_VERDICTS };
        let verdict = first(wanted, &|value| digits(value, 6));
        let error = first(ERRORS, &|error| format!("{error:.0e}"));
        // An answer without a verdict has its place among the answers alone.
        (verdict.is_some() || error.is_some()).then(|| {
            vec![
                format!("<a href=\"#{}\">{}</a>", anchor(report, answer), escape(answer.heading)),
                shown(verdict),
                symbols(&answer.start),
                shown(error),
            ]
        })
    });
    let rows: Vec<Vec<String>> = rows.collect();
    page.put(&table("verdicts", &["question", "verdict", "protocol", "numerical error"], rows));
    page.put(&warnings(&report.check.warnings()));
}

fn cost(page: &mut HtmlPage, report: &StudyReport) {
    page.section("cost", "Cost of the dither");
    if !is_dithered(&report.study) {
        page.put("<p>No dither acts.</p>");
        return;
    }
    if matches!(report.study.kind(), Kind::Disc(_)) {
        page.put("<p>The answers about a disc are about small motions, which have no power and no stroke.</p>");
        return;
    }
    let response = report.answers.iter().find(|answer| answer.verb == "response");
    let rows = response.map(|answer| facts::named(&answer.facts, COSTS)).unwrap_or_default();
    if rows.is_empty() {
        page.put(
            "<p>No response was computed, so that friction, power and stroke are not known.</p>",
        );
    } else {
        let facts = response.map(|answer| &answer.facts);
        let rows: Vec<FactRow> = rows.iter().map(|row| cost_in_words(row, facts)).collect();
        page.put(&fact_table(&rows));
    }
}

/// A cost of a contact or a dither by its name, with four significant digits.
fn cost_in_words(row: &FactRow, facts: Option<&Json>) -> FactRow {
    let (place, quantity) = row.path.rsplit_once('.').unwrap_or(("", &row.path));
    let (list, rest) = place.split_once('[').unwrap_or((place, ""));
    let index = rest.trim_end_matches(']');
    let count = |list: &Json| list.as_array().map_or(0, Vec::len);
    let list_of = facts.and_then(|facts| facts.get(list));
    let name = facts.and_then(|facts| facts.pointer(&format!("/{list}/{index}/name"))?.as_str());
    let of = match (list, name) {
        ("contacts", Some(name)) => format!(" at contact {name}"),
        ("dithers", _) if list_of.map_or(0, count) > 1 => format!(" of dither[{index}]"),
        ("dithers", _) => " of the dither".to_owned(),
        _ => String::new(),
    };
    let value = row.value.parse::<f64>().map_or(row.value.clone(), |value| digits(value, 4));
    FactRow { path: format!("{}{of}", quantity.replace('_', " ")), value, unit: row.unit.clone() }
}

/// The answers whose pictures are shown at once, and the pictures.
fn pictured(report: &StudyReport) -> Vec<(&ReportedAnswer, String)> {
    let wanted = PICTURED
        .iter()
        .filter_map(|verb| report.answers.iter().find(|answer| answer.verb == *verb));
    let drawn = wanted.filter(|answer| matches!(answer.outcome.figure(), Some(Ok(_))));
    drawn.take(MOST_PICTURES).map(|answer| (answer, picture(answer))).collect()
}

fn pictures(page: &mut HtmlPage, pictured: &[(&ReportedAnswer, String)]) {
    if pictured.is_empty() {
        return;
    }
    page.section("pictures", "Pictures");
    for (answer, picture) in pictured {
        page.put(&format!("<h3>{}</h3>{picture}", escape(answer.heading)));
    }
}

/// The answers with their pictures.
fn answers(page: &mut HtmlPage, report: &StudyReport, pictured: &[(&ReportedAnswer, String)]) {
    page.folded("answers", "Every answer");
    for answer in &report.answers {
        let anchor = anchor(report, answer);
        page.entry(&anchor, "", answer.heading);
        page.put(&format!("<article id=\"{anchor}\"><h3>{}</h3>", escape(answer.heading)));
        page.put(&format!(
            "<p class=\"name\">quell {}, start: {}</p>",
            answer.verb,
            symbols(&answer.start)
        ));
        if let Some(chosen) = &answer.chosen {
            page.put(&format!("<p class=\"name\">{}</p>", marked(chosen)));
        }
        if let Some(sentence) = answer.outcome.sentence() {
            page.put(&format!("<p>{}</p>", symbols(&sentence)));
        }
        for note in answer.outcome.notes() {
            page.put(&format!("<p>{}</p>", symbols(&note)));
        }
        page.put(&warnings(&answer.outcome.warnings()));
        if pictured.iter().any(|(shown, _)| std::ptr::eq(*shown, answer)) {
            page.put("<p class=\"name\">Its picture is <a href=\"#pictures\">above</a>.</p>");
        } else {
            page.put(&picture(answer));
        }
        page.put(&format!("<pre><code>{}</code></pre>", escape(&answer.outcome.table())));
        page.put("</article>");
    }
}

/// The picture of an answer, if it has one.
fn picture(answer: &ReportedAnswer) -> String {
    match answer.outcome.figure() {
        None => String::new(),
        Some(Ok(figure)) => format!(
            "<figure aria-label=\"{}\">{}<figcaption>{}</figcaption></figure>",
            escape(answer.heading),
            figure.clone().caption("").to_svg(),
            plot::html(&figure.caption)
        ),
        Some(Err(why)) => {
            format!("<p class=\"calm\">The picture was not drawn: {}</p>", escape(&why.to_string()))
        }
    }
}

fn unexamined(page: &mut HtmlPage, report: &StudyReport) {
    page.section("not-examined", "What was not examined");
    let rows = report.unexamined.iter().map(|gap| vec![escape(&gap.subject), marked(&gap.fact)]);
    page.put(&table("gaps", &["subject", "what is known"], rows));
}

/// The sources of the verbs in the report.
fn cited(report: &StudyReport) -> Sources {
    let mut sources = verbs(&report.study).sources();
    let has = |name: &str| report.answers.iter().any(|answer| answer.verb == name);
    sources.citations.retain(|citation| has(citation.task.name()));
    sources
}

fn sources(page: &mut HtmlPage, report: &StudyReport) {
    page.folded("sources", "Versions and sources");
    page.put(&format!("<p>Computed by Quell {}.</p>", env!("CARGO_PKG_VERSION")));
    let sources = cited(report);
    let items = sources.unique().into_iter().map(|source| {
        format!("<code>{}</code> {}", escape(source.key), escape(&source.reference()))
    });
    page.put(&list(items));
    if !sources.corrections.is_empty() {
        page.put("<p>Corrections of the printed equations that were applied:</p>");
        let items = sources.corrections.iter().map(|correction| {
            format!("<b>{}</b> {}", symbols(correction.equations), symbols(correction.right))
        });
        page.put(&list(items));
    }
}

/// Every number of every answer.
fn numbers(page: &mut HtmlPage, report: &StudyReport) {
    page.folded("numbers", "All numbers");
    page.put("<p>As <code>--json</code> of each verb prints them.</p>");
    for answer in &report.answers {
        page.put(&format!("<h3>{}</h3>", escape(&capital(answer.verb))));
        page.put(&fact_table(&facts::rows(&answer.facts)));
    }
}

fn study(page: &mut HtmlPage, report: &StudyReport) {
    page.folded("study", "The study file");
    let changes = report.study.changes();
    if !changes.is_empty() {
        page.put("<p>Changed by <code>--set</code>:</p>");
        page.put(&list(changes.iter().map(|change| format!("<code>{}</code>", escape(change)))));
    }
    page.put(&format!("<pre><code>{}</code></pre>", escape(report.study.text())));
}

/// The anchor of an answer: its verb, numbered from the second on.
fn anchor(report: &StudyReport, answer: &ReportedAnswer) -> String {
    let same = report.answers.iter().filter(|other| other.verb == answer.verb);
    let place = same.take_while(|other| !std::ptr::eq(*other, answer)).count();
    match place {
        0 => format!("answer-{}", answer.verb),
        place => format!("answer-{}-{}", answer.verb, place + 1),
    }
}

fn fact_table(rows: &[FactRow]) -> String {
    let cells = rows.iter().map(|row| {
        let name = escape(&row.path).replace('_', "_<wbr>").replace('.', ".<wbr>");
        vec![name, escape(&row.value), escape(&row.unit)]
    });
    table("facts", &["quantity", "value", "unit"], cells)
}

fn warnings(texts: &[String]) -> String {
    if texts.is_empty() {
        return String::new();
    }
    let items = texts.iter().map(|text| marked(&capital(text)));
    format!("<div class=\"alarm\"><p>Warnings</p>{}</div>", list(items))
}

/// A sentence with symbols, and code between grave accents.
fn marked(text: &str) -> String {
    let parts = text.split('`').enumerate();
    let part = |(place, part): (usize, &str)| {
        if place % 2 == 1 { format!("<code>{}</code>", escape(part)) } else { symbols(part) }
    };
    parts.map(part).collect()
}

fn list(items: impl IntoIterator<Item = String>) -> String {
    let items: Vec<String> = items.into_iter().map(|item| format!("<li>{item}</li>")).collect();
    if items.is_empty() { String::new() } else { format!("<ul>{}</ul>", items.concat()) }
}
