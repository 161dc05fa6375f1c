//! The errata in the report.

use quell::cite::{CORRECTIONS, Proof};
use quell::html::{HtmlPage, escape, symbols, table};

/// Writes the table.
pub(super) fn write(page: &mut HtmlPage) {
    page.section("errata", "Errata");
    page.put("<p>All errors found in the dissertation. Where an erratum affects a computation, a test compares the printed and \
              the correct form with an independent reference.</p>");
    let rows = CORRECTIONS.iter().map(|correction| {
        let proof = match correction.proof {
            Proof::Test { name, .. } => {
                format!("<code>{}</code>", escape(name).replace('_', "_<wbr>"))
            }
            Proof::Reading => "reading".to_owned(),
        };
        vec![
            symbols(correction.equations),
            symbols(correction.printed),
            symbols(correction.right),
            proof,
        ]
    });
    page.put(&table("errata", &["where", "printed", "correct", "shown by the test"], rows));
}
