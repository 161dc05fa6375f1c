//! Statements of the dissertation, each with the claims that measure it.
//!
//! A statement is one assertion of the text, a formula, or a table. It may need several measurements: two amplitudes, several
//! frequency ratios, or a number measured exactly and once more in the way in which the author probably read it. Counts are counts
//! of statements; a statement holds if all of its claims do.

use super::super::claim::{Claim, ClaimVerdict, Expected};
use quell::cite::errata::CORRECT_AS_PRINTED;

/// A statement with the verdict that follows from its claims.
#[derive(Clone, Debug, PartialEq)]
pub struct StatementVerdict<'a> {
    /// Name of the statement: that of its first claim.
    pub name: &'a str,
    /// The claims that measure it, in the order of the table.
    pub claims: Vec<&'a Claim>,
    /// The least favourable verdict among them.
    pub verdict: ClaimVerdict,
}

/// Statements with more than one claim: their names. Every other claim is a statement of its own.
pub const SEVERAL: &[&[&str]] = &[
    &["2.3-undithered-fundamental", "2.3-undithered-record"],
    &["2.3-dithered-fundamental", "2.3-dithered-record"],
    &["3.7-fundamental", "3.7-record"],
    &["4.3-cancelled", "4.3-record"],
    &["2.6-linear-up-to", "2.6-linear"],
    &["2.7-v1-unstable-ratio", "2.7-v1-unstable", "2.10-local-lower"],
    &[
        "2.7-v1-stable-ratio",
        "2.7-v1-stable",
        "2.7-v1-stable-difference-ratio",
        "2.7-v1-stable-difference-amplitude",
        "2.10-local-upper",
    ],
    &["2.7-v1.5-unstable", "2.7-v1.5-stable", "2.11-local-lower", "2.11-local-upper"],
    &["3.3-peak-sine", "3.3-peak-triangle", "3.3-peak-square"],
    &["3.38a", "3.38a-corner"],
    &["3.44", "3.44-damped"],
    &["3.61-triangle-unstable-ratio", "3.61-triangle-unstable", "3.12-local-lower"],
    &["3.61-triangle-stable-ratio", "3.61-triangle-stable", "3.12-local-upper"],
    &["3.62-square-unstable", "3.62-square-stable", "3.13-local-lower", "3.13-local-upper"],
    &["3.7-partial", "3.8-partial", "3.9-partial"],
    &["3.7-suppressed", "3.8-suppressed", "3.9-suppressed"],
    &["2.8-isocline-5", "2.8-isocline-10", "2.8-isocline-20"],
    &["3.10-isocline-5", "3.10-isocline-10", "3.10-isocline-20"],
    &["4.5-slope-change", "4.6-slope-change"],
    &["4.5-smaller-amplitude", "4.6-smaller-amplitude"],
    &["4.5-falling-region", "4.6-falling-region"],
    &["4.5-convexity", "4.6-convexity"],
    &["2.3-forced-amplitude", "2.8-falls-with-ratio"],
    &["4.41-unstable-ratio", "4.41-unstable"],
    &["4.41-stable-ratio", "4.41-stable"],
    &["2.10-columns", "2.10-from-rest-lower", "2.10-from-rest-upper"],
    &["2.11-columns", "2.11-from-rest-lower", "2.11-from-rest-upper"],
    &["3.12-columns", "3.12-from-rest-lower", "3.12-from-rest-upper"],
    &["3.13-columns", "3.13-from-rest-lower", "3.13-from-rest-upper"],
    &["4.11-square-columns", "4.11-square-pattern"],
    &["5.1-speed-1", "5.1-speed-2", "5.1-speed-3", "5.1-speed-4", "5.1-speed-5"],
    &[
        "5.2-speed-1",
        "5.2-speed-2",
        "5.2-speed-3",
        "5.2-speed-4",
        "5.2-speed-5",
        "5.2-speed-6",
        "5.2-speed-7",
        "5.2-speed-8",
    ],
    &["5.9-all-unstable-0.1", "5.9-all-unstable-0.2", "5.9-all-unstable-0.3"],
    &["5.3a-mostly-stable", "5.3b-mostly-stable"],
    &["5.7-peak-0.7", "5.7-peak-0.88"],
    &["5.9-fourth-0.1", "5.9-fourth-0.3"],
    &["5.14-vanish-0.0001", "5.14-vanish-0.001"],
    &["5.12-revived-1", "5.12-revived-4"],
    &["5.12-left-0.0", "5.12-left-1e-5"],
    &["5.13-begins-3", "5.13-begins-4", "5.13-interchanged-4", "5.13-interchanged-3"],
];

/// Name of the statement that a claim measures.
pub fn statement_of(claim: &str) -> &str {
    let several = SEVERAL.iter().find(|claims| claims.contains(&claim));
    several.and_then(|claims| claims.first().copied()).unwrap_or(claim)
}

/// The statements that these claims measure, in the order of their first claims; findings measure none.
pub fn statements<'a>(claims: impl IntoIterator<Item = &'a Claim>) -> Vec<StatementVerdict<'a>> {
    let mut found: Vec<StatementVerdict<'a>> = Vec::new();
    for claim in claims.into_iter().filter(|claim| claim.is_of_a_statement()) {
        let name = statement_of(&claim.name);
        match found.iter_mut().find(|statement| statement.name == name) {
            Some(statement) => {
                statement.claims.push(claim);
                if rank(claim.verdict) > rank(statement.verdict) {
                    statement.verdict = claim.verdict;
                }
            }
            None => {
                found.push(StatementVerdict { name, claims: vec![claim], verdict: claim.verdict });
            }
        }
    }
    found
}

/// Order from the most to the least favourable verdict, deviations of one kind by size.
fn rank(verdict: ClaimVerdict) -> (u8, f64) {
    let kind = match verdict {
        ClaimVerdict::Reproduced | ClaimVerdict::Finding => 0,
        ClaimVerdict::Within { .. } => 1,
        ClaimVerdict::NotReproduced { .. } => 2,
        ClaimVerdict::FormulaWrong { .. } => 3,
    };
    (kind, verdict.deviation().unwrap_or_default())
}

/// Number of statements with a verdict of this kind, named as by [`ClaimVerdict::name`].
pub fn count(statements: &[StatementVerdict<'_>], kind: &str) -> usize {
    statements.iter().filter(|statement| statement.verdict.name() == kind).count()
}

/// The counts in one sentence.
pub fn summary(statements: &[StatementVerdict<'_>]) -> String {
    let claims: usize = statements.iter().map(|statement| statement.claims.len()).sum();
    let wrong = count(statements, "printed formula wrong");
    format!(
        "{} statements of the dissertation, measured by {claims} claims: {} reproduced, {} reproduced within a stated deviation, \
         {} not reproduced, {wrong} printed formulas wrong; these are {wrong} of {} that were compared with their definitions, from {} \
         slips.",
        statements.len(),
        count(statements, "reproduced"),
        count(statements, "reproduced within"),
        count(statements, "not reproduced"),
        wrong + CORRECT_AS_PRINTED.len(),
        slips(statements).len(),
    )
}

/// The slips behind the wrong formulas.
pub fn slips(statements: &[StatementVerdict<'_>]) -> Vec<&'static str> {
    let mut found = Vec::new();
    for claim in statements.iter().flat_map(|statement| &statement.claims) {
        if let Some(Expected::FormulaWrong(slip)) = claim.expected
            && !found.contains(&slip)
        {
            found.push(slip);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::super::LEDGER;
    use super::*;

    #[test]
    fn every_claim_measures_one_statement() {
        let mut seen = Vec::new();
        for name in SEVERAL.iter().flat_map(|claims| claims.iter()) {
            assert!(LEDGER.iter().any(|(known, _)| known == name), "{name} is not in the ledger");
            assert!(!seen.contains(name), "{name} measures two statements");
            seen.push(name);
        }
        assert!(SEVERAL.iter().all(|claims| claims.len() > 1), "one claim needs no line");
    }

    #[test]
    fn a_statement_holds_if_all_of_its_claims_do() {
        let mut sheet = super::super::sheet::ClaimSheet::default();
        sheet.number("2.6-linear-up-to", "", "", "0.16", &[0.161]);
        sheet.number("2.7-undithered", "", "", "0.8", &[0.8]);
        sheet.statement(["2.6-linear", "", ""], "", &[], false);
        let found = statements(&sheet.claims);
        assert_eq!(
            found.iter().map(|one| one.name).collect::<Vec<_>>(),
            ["2.6-linear-up-to", "2.7-undithered"]
        );
        assert_eq!(found[0].claims.len(), 2);
        assert_eq!(found[0].verdict.name(), "not reproduced");
        assert_eq!((count(&found, "reproduced"), count(&found, "not reproduced")), (1, 1));
    }
}
