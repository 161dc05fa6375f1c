//! The report of `reproduce`: one page with all results, and a Markdown table.
//!
//! The page written by [`html`] is self-contained: figures are embedded, and data files in the same directory are linked. It
//! begins with the claims that hold and those that do not, with the reasons, followed by all figures and tables, the claims, the
//! errata and the sources.

mod chapters;
mod claims;
mod errata;
mod markdown;
mod summary;

use super::{ReproductionOptions, WrittenEntry};
use quell::cite::Sources;
use quell::html::{HtmlPage, escape};

pub(super) use markdown::markdown;

/// The style sheet.
const STYLE: &str = include_str!("style.css");

/// The page.
pub(super) fn html(written: &[WrittenEntry], options: &ReproductionOptions) -> String {
    let title = title(options);
    let mut page = HtmlPage::new(title, STYLE);
    summary::write(&mut page, title, written, options);
    chapters::write(&mut page, written);
    claims::write(&mut page, written);
    errata::write(&mut page);
    sources(&mut page, written);
    page.finish()
}

/// Title of the report: one with other numbers reproduces nothing.
fn title(options: &ReproductionOptions) -> &'static str {
    if options.changes.is_empty() {
        "The dissertation, reproduced"
    } else {
        "Own numbers, by the figures of the dissertation"
    }
}

/// The literature on which the results are based.
fn sources(page: &mut HtmlPage, written: &[WrittenEntry]) {
    let mut all = Sources::default();
    for done in written {
        all.extend(&done.product.sources);
    }
    let unique = all.unique();
    if unique.is_empty() {
        return;
    }
    page.section("sources", "Sources");
    let items: Vec<String> = unique
        .iter()
        .map(|source| {
            format!("<li><code>{}</code> {}</li>", source.key, escape(&source.reference()))
        })
        .collect();
    page.put(&format!("<ul class=\"sources\">{}</ul>", items.concat()));
}
