//! The figures and tables of the report, each with caption, claims, equations, corrections, study, data and run time.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use quell::picture::PicturePage;
use std::fmt::Write as _;

use super::super::WrittenEntry;
use super::super::claims::Claim;
use super::claims;
use crate::Cell;
use quell::html::{HtmlPage, escape, symbols, table};
use quell::plot;

/// Largest number of rows shown of a table without a figure.
const ROWS: usize = 20;

/// Titles of the chapters, by the first digit of their figures.
const CHAPTERS: [(char, &str); 4] = [
    ('2', "Chapter 2: sinusoidal tangential dither"),
    ('3', "Chapter 3: three waveforms"),
    ('4', "Chapter 4: normal dither"),
    ('5', "Chapter 5: the disc"),
];

/// Writes the figures and tables, chapter by chapter.
pub(super) fn write(page: &mut HtmlPage, written: &[WrittenEntry]) {
    let all = claims::all(written);
    for (digit, title) in CHAPTERS {
        let of: Vec<&WrittenEntry> = written
            .iter()
            .filter(|done| done.entry.name.trim_start_matches("table-").starts_with(digit))
            .collect();
        if of.is_empty() {
            continue;
        }
        page.section(&format!("chapter-{digit}"), title);
        for done in of {
            write_one(page, done, &claims::of(&done.entry, &all));
        }
    }
}

fn write_one(page: &mut HtmlPage, done: &WrittenEntry, claims: &[&Claim]) {
    let anchor = done.entry.stem();
    let number = done.entry.name.trim_start_matches("table-");
    let kind = if done.entry.name.starts_with("table") { "Table" } else { "Figure" };
    let short = if kind == "Table" { format!("T {number}") } else { number.to_owned() };
    page.entry(&anchor, &short, done.entry.about);
    let heading = if done.own {
        format!("Own numbers, like {} {number}", kind.to_lowercase())
    } else {
        format!("{kind} {number}: {}", escape(done.entry.about))
    };
    page.put(&format!("<article id=\"{anchor}\"><h3>{heading}</h3>"));
    page.put(&format!(
        "<figure>{}<figcaption>{}</figcaption></figure>",
        shown(done),
        plot::html(&done.product.caption)
    ));
    if !claims.is_empty() {
        let items = claims
            .iter()
            .map(|claim| {
                format!(
                    "<li>{} <a href=\"#claim-{}\">{}</a>{}</li>",
                    claims::chip(claim),
                    escape(&claim.name),
                    symbols(&claim.statement),
                    compared(claim)
                )
            })
            .collect::<Vec<String>>()
            .concat();
        page.put(&format!("<ul class=\"facts\">{items}</ul>"));
    }
    page.put(&details(done));
    page.put("</article>");
}

/// The printed and the measured value, where they exist.
fn compared(claim: &Claim) -> String {
    match (claim.printed.as_str(), claim.measured.as_str()) {
        ("", "") => String::new(),
        ("", measured) => format!(": {}", symbols(measured)),
        (printed, measured) => {
            format!(": printed {}, measured {}", symbols(printed), symbols(measured))
        }
    }
}

/// The figure, or the first rows of the data.
fn shown(done: &WrittenEntry) -> String {
    match &done.product.figure {
        Some(figure) => {
            // The caption is below the figure as text.
            let svg = PicturePage::default().laid_out(figure.clone()).to_svg();
            format!(
                "<img alt=\"{}\" src=\"data:image/svg+xml;base64,{}\">",
                escape(&done.product.plain_caption()),
                STANDARD.encode(svg)
            )
        }
        None => done.product.tables.first().map(rows).unwrap_or_default(),
    }
}

fn rows(data: &super::super::DataTable) -> String {
    let names: Vec<String> =
        data.columns.iter().map(|column| escape(&column.name.replace('_', " "))).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let cell = |cell: &Cell| match cell {
        Cell::Number(value) => format!("{value:.6}"),
        Cell::Text(text) => escape(text),
        Cell::Empty => "–".to_owned(),
    };
    table("data", &names, data.rows.iter().take(ROWS).map(|row| row.iter().map(cell).collect()))
}

/// Data files, equations, corrections, study, run time.
fn details(done: &WrittenEntry) -> String {
    let files: Vec<String> = done
        .files
        .iter()
        .filter_map(|file| file.file_name()?.to_str())
        .map(|name| format!("<a href=\"{0}\">{0}</a>", escape(name)))
        .collect();
    let sources = &done.product.sources;
    let list = |items: &[String]| -> String {
        let items =
            items.iter().map(|item| format!("<li>{item}</li>")).collect::<Vec<String>>().concat();
        format!("<ul>{items}</ul>")
    };
    let equations: Vec<String> = sources.uses().into_iter().map(symbols).collect();
    let corrections: Vec<String> = sources
        .corrections
        .iter()
        .map(|correction| {
            format!("<b>{}</b> {}", symbols(correction.equations), symbols(correction.right))
        })
        .collect();
    let mut html = format!(
        "<dl><dt>Files</dt><dd>{}</dd><dt>Run time</dt><dd>{:.2} s</dd></dl>",
        files.join(" · "),
        done.elapsed.as_secs_f64()
    );
    let mut fold = |title: String, inside: String| {
        let _ = write!(html, "<details><summary>{title}</summary>{inside}</details>");
    };
    if !equations.is_empty() {
        fold(format!("Equations used ({})", equations.len()), list(&equations));
    }
    if !corrections.is_empty() {
        fold(format!("Corrections applied ({})", corrections.len()), list(&corrections));
    }
    if !done.entry.source().text.is_empty() {
        fold(
            "BeltStudy".to_owned(),
            format!("<pre><code>{}</code></pre>", escape(done.entry.source().text)),
        );
    }
    html
}
