//! The errata in the report.

use super::html::{Page, escape, symbols, table};
use quell::cite::{CORRECTIONS, Proof};

/// Writes the table.
pub(super) fn write(page: &mut Page) {
    page.section("errata", "Errata");
    page.put("<p>Every place where the print was found wrong. What enters a computation has a test that holds the printed form and \
              the right one against something independent.</p>");
    let rows = CORRECTIONS.iter().map(|it| {
        let proof = match it.proof {
            Proof::Test { name, .. } => {
                format!("<code>{}</code>", escape(name).replace('_', "_<wbr>"))
            }
            Proof::Reading => "reading".to_owned(),
        };
        vec![symbols(it.equations), symbols(it.printed), symbols(it.right), proof]
    });
    page.put(&table("errata", &["where", "printed", "right", "shown by the test"], rows));
}
