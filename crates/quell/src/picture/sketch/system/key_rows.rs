//! Rows of the key of a system, of which equal ones are written once.

use crate::plot::{Sketch, SketchKey};

/// The fewest equal rows that become one.
const FEWEST: usize = 3;

/// A row: a heading, an index of its symbols, items, and sums over coordinates that may differ between rows that are equal.
#[derive(Clone, Debug)]
pub(super) struct KeyRow {
    pub(super) head: String,
    pub(super) index: String,
    pub(super) items: Vec<String>,
    /// A word and the sum that it is about.
    pub(super) rows: Vec<(&'static str, String)>,
}

impl KeyRow {
    /// The items with the letter i for the index.
    fn general(&self) -> Vec<String> {
        let index = match self.index.chars().count() {
            0 => return self.items.clone(),
            1 => format!("_{}$", self.index),
            _ => format!("_{{{}}}$", self.index),
        };
        self.items.iter().map(|item| item.replace(&index, "_i$")).collect()
    }

    fn is_like(&self, other: &Self) -> bool {
        let words = |row: &Self| row.rows.iter().map(|(word, _)| *word).collect::<Vec<_>>();
        self.general() == other.general() && words(self) == words(other)
    }

    fn written(&self, prefix: &str) -> SketchKey {
        let sums = self.rows.iter().map(|(word, sum)| format!("{word}: {sum}"));
        SketchKey::new(format!("{prefix}{}", self.head), self.items.iter().cloned().chain(sums))
    }
}

/// Adds rows to the key; consecutive ones that are equal but for their indices become one.
pub(super) fn add_rows(mut sheet: Sketch, rows: &[KeyRow], prefix: &str) -> Sketch {
    for equal in rows.chunk_by(KeyRow::is_like) {
        let (Some(first), Some(last)) = (equal.first(), equal.last()) else { continue };
        if equal.len() < FEWEST {
            for row in equal {
                sheet = sheet.with_key(row.written(prefix));
            }
            continue;
        }
        let sums = first.rows.iter().zip(&last.rows);
        let sums = sums.map(|((word, one), (_, other))| format!("{word}: {one} to {other}"));
        let head = format!("{prefix}{} to {} ({})", first.head, last.head, equal.len());
        let items = first.general().into_iter().chain(sums);
        sheet = sheet.with_key(SketchKey::new(head, items.collect::<Vec<_>>()));
    }
    sheet
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(number: usize, mass: f64) -> KeyRow {
        KeyRow {
            head: format!("b{number}"),
            index: number.to_string(),
            items: vec![format!("$m_{number}$ = {mass}")],
            rows: vec![("slip", format!("b{number}"))],
        }
    }

    #[test]
    fn three_equal_rows_become_one() {
        let heads = |masses: &[f64]| {
            let rows = masses.iter().enumerate().map(|(place, mass)| row(place + 1, *mass));
            let sheet = add_rows(Sketch::new(85.0), &rows.collect::<Vec<_>>(), "");
            sheet.key.into_iter().map(|row| (row.head, row.items.join(", "))).collect::<Vec<_>>()
        };
        let text = |head: &str, items: &str| (head.to_owned(), items.to_owned());
        assert_eq!(
            heads(&[1.0, 1.0, 1.0, 2.0]),
            [text("b1 to b3 (3)", "$m_i$ = 1, slip: b1 to b3"), text("b4", "$m_4$ = 2, slip: b4")]
        );
        assert_eq!(heads(&[1.0, 1.0]).len(), 2);
    }
}
