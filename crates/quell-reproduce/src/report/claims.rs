//! The claims in the report: all of them in one table, and those about each figure next to it.

use super::super::claims::{Claim, ClaimVerdict};
use super::super::{CatalogueEntry, WrittenEntry};
use quell::html::{HtmlPage, escape, symbols, table};

/// All claims among the written entries.
pub(super) fn all(written: &[WrittenEntry]) -> Vec<&Claim> {
    written.iter().flat_map(|done| &done.product.claims).collect()
}

/// Writes the table of all claims.
pub(super) fn write(page: &mut HtmlPage, written: &[WrittenEntry]) {
    let claims = all(written);
    if claims.is_empty() {
        return;
    }
    page.section("claims", "All claims");
    page.put(
        "<p>Verdicts follow from printed and measured numbers. A printed number is <em>reproduced</em> if the measured one \
         rounds to it, and <em>reproduced within</em> a deviation if that is at most its tolerance. A formula is compared with \
         a quadrature of its definition.</p>",
    );
    let rows = claims.iter().map(|claim| {
        let tolerance = claim.tolerance.map(tolerance).unwrap_or_default();
        vec![
            format!(
                "<span id=\"claim-{0}\" class=\"name\">{0}</span>{1}",
                escape(&claim.name),
                escape(&claim.place)
            ),
            symbols(&claim.statement),
            symbols(&claim.printed),
            symbols(&claim.measured),
            tolerance,
            chip(claim),
            symbols(&claim.note),
        ]
    });
    let names = ["claim", "statement", "printed", "measured", "tolerance", "verdict", "note"];
    page.put(&table("claims", &names, rows));
}

/// A tolerance as a percentage, or as a power of ten if small.
fn tolerance(share: f64) -> String {
    if share < 1e-4 {
        symbols(&format!("10^{{−{:.0}}}", -libm::log10(share)))
    } else {
        format!("{:.0} %", 100.0 * share)
    }
}

/// The verdict as a coloured label.
pub(super) fn chip(claim: &Claim) -> String {
    let class = match claim.verdict {
        ClaimVerdict::Reproduced => "holds",
        ClaimVerdict::Within { .. } => "within",
        ClaimVerdict::FormulaWrong { .. } => "wrong",
        ClaimVerdict::NotReproduced { .. } => "fails",
        ClaimVerdict::Finding => "finding",
    };
    format!("<span class=\"chip {class}\">{}</span>", claim.verdict)
}

/// The claims about a figure or table.
pub(super) fn of<'a>(entry: &CatalogueEntry, claims: &[&'a Claim]) -> Vec<&'a Claim> {
    claims.iter().filter(|claim| about(&claim.place, entry.name)).copied().collect()
}

/// Whether a text such as "Figures 2.7, 2.10" or "figures 5.9–5.12" refers to the figure `name`. Numbers in parentheses are
/// equations.
fn about(place: &str, name: &str) -> bool {
    let (kind, number) = match name.strip_prefix("table-") {
        Some(number) => ("able", number),
        None => ("igure", name),
    };
    let mut kind_now = "";
    for word in place.split([' ', ',', ';']).filter(|word| !word.is_empty()) {
        kind_now = ["able", "igure", "quation"]
            .into_iter()
            .find(|known| word.contains(known))
            .unwrap_or(kind_now);
        let bare = word.split('(').next().unwrap_or_default();
        let named = match bare.split_once('–') {
            Some((from, to)) => within(from, number, to),
            None => bare == number,
        };
        if kind_now == kind && named {
            return true;
        }
    }
    false
}

/// Whether a number such as 5.10 is in a range such as 5.9 to 5.12.
fn within(from: &str, number: &str, to: &str) -> bool {
    let parts = |text: &str| -> Option<(u32, u32)> {
        let (chapter, figure) = text.split_once('.')?;
        Some((chapter.parse().ok()?, figure.parse().ok()?))
    };
    match (parts(from), parts(number), parts(to)) {
        (Some(from), Some(number), Some(to)) => (from..=to).contains(&number),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::about;

    #[test]
    fn places_name_their_figures() {
        assert!(about("Figures 2.7, 2.10", "2.10"));
        assert!(!about("Figures 2.7, 2.10", "2.1"));
        assert!(about("Figure 2.3(a), (b)", "2.3"));
        assert!(!about("(3.38a), (B.10a)", "3.38"));
        assert!(about("Table 5.1", "table-5.1"));
        assert!(!about("Table 5.1", "5.1"));
        assert!(about("Text of figure 5.13", "5.13"));
        assert!(about("Text of figures 5.9–5.12", "5.11"));
        assert!(!about("Text of figures 5.9–5.12", "5.13"));
    }
}
