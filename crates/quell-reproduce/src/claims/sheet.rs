//! The sheet on which the measurements of claims are recorded, and the rules of their verdicts.

use super::super::claim::{Claim, ClaimVerdict};
use super::super::shared::SharedMeasurements;
use super::ledger;

/// The claims recorded so far by one measurement.
#[derive(Debug, Default)]
pub(super) struct ClaimSheet {
    /// Measurements shared with the figures.
    pub(super) shared: SharedMeasurements,
    /// The recorded claims.
    pub(super) claims: Vec<Claim>,
}

/// Largest relative deviation at which a number still counts as reproduced.
pub(super) const USUAL_LIMIT: f64 = 0.05;
/// Relative difference below which a printed formula counts as correct.
const FORMULA_AGREES: f64 = 1e-9;

impl ClaimSheet {
    /// Compares a printed number, such as `0.666`, with measured ones; all of them must agree.
    pub(super) fn number(
        &mut self,
        name: &str,
        place: &str,
        statement: &str,
        printed: &str,
        measured: &[f64],
    ) -> &mut Claim {
        self.number_within(USUAL_LIMIT, [name, place, statement], printed, measured)
    }

    /// The same with another limit, for a number that is printed as approximate; `words` are name, place, statement.
    pub(super) fn number_within(
        &mut self,
        limit: f64,
        words: [&str; 3],
        printed: &str,
        measured: &[f64],
    ) -> &mut Claim {
        let (value, half_digit) = read(printed);
        let error = measured.iter().map(|m| (m - value).abs()).fold(0.0, f64::max);
        let deviation = error / value.abs();
        let verdict = if measured.is_empty() {
            ClaimVerdict::NotReproduced { deviation: None }
        } else if error <= half_digit * (1.0 + 1e-9) {
            ClaimVerdict::Reproduced
        } else if deviation <= limit {
            ClaimVerdict::Within { deviation }
        } else {
            ClaimVerdict::NotReproduced { deviation: Some(deviation) }
        };
        let claim = self.push(words, printed.to_owned(), list(measured), measured, verdict);
        claim.tolerance = Some(limit);
        claim
    }

    /// Compares a printed number with measured ones whose further digits are dropped instead of rounded, as the dissertation does
    /// with many numbers. A number that agrees in neither way is judged as by [`ClaimSheet::number`]. `words` are name, place,
    /// statement.
    pub(super) fn truncated(
        &mut self,
        [name, place, statement]: [&str; 3],
        printed: &str,
        measured: &[f64],
    ) -> &mut Claim {
        let (value, half_digit) = read(printed);
        let agrees = !measured.is_empty()
            && measured.iter().all(|&m| {
                let below = m - value;
                // A number that ends in zeros may round to just below itself.
                below > -1e-9 * half_digit && below < 2.0 * half_digit
            });
        let claim = self.number(name, place, statement, printed, measured);
        if agrees {
            claim.verdict = ClaimVerdict::Reproduced;
        }
        claim
    }

    /// A statement that holds or not, with the numbers that decide it.
    pub(super) fn statement(
        &mut self,
        words: [&str; 3],
        measured: impl Into<String>,
        values: &[f64],
        holds: bool,
    ) -> &mut Claim {
        let verdict = if holds {
            ClaimVerdict::Reproduced
        } else {
            ClaimVerdict::NotReproduced { deviation: None }
        };
        self.push(words, String::new(), measured.into(), values, verdict)
    }

    /// A finding that the dissertation does not state, with the numbers that decide whether it holds.
    pub(super) fn finding(
        &mut self,
        words: [&str; 3],
        measured: impl Into<String>,
        values: &[f64],
        holds: bool,
    ) -> &mut Claim {
        let verdict = if holds {
            ClaimVerdict::Finding
        } else {
            ClaimVerdict::NotReproduced { deviation: None }
        };
        self.push(words, String::new(), measured.into(), values, verdict)
    }

    /// Compares a printed formula at one point with the value of its definition.
    pub(super) fn formula(&mut self, words: [&str; 3], printed: f64, right: f64) -> &mut Claim {
        let deviation = (printed - right).abs() / right.abs();
        let verdict = if deviation <= FORMULA_AGREES {
            ClaimVerdict::Reproduced
        } else {
            ClaimVerdict::FormulaWrong { deviation }
        };
        let claim = self.push(words, digits(printed, 8), digits(right, 8), &[right], verdict);
        claim.tolerance = Some(FORMULA_AGREES);
        claim
    }

    fn push(
        &mut self,
        [name, place, statement]: [&str; 3],
        printed: String,
        measured: String,
        values: &[f64],
        verdict: ClaimVerdict,
    ) -> &mut Claim {
        self.claims.push(Claim {
            name: name.to_owned(),
            place: place.to_owned(),
            statement: statement.to_owned(),
            printed,
            measured,
            values: values.to_vec(),
            verdict,
            tolerance: None,
            expected: ledger::expected(name),
            note: String::new(),
        });
        let last = self.claims.len() - 1;
        &mut self.claims[last]
    }
}

/// The value of a printed number and half a unit of its last digit.
fn read(printed: &str) -> (f64, f64) {
    let value = printed.parse().unwrap_or(f64::INFINITY);
    let decimals = printed.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    (value, 0.5 * 10f64.powi(-i32::try_from(decimals).unwrap_or(0)))
}

/// Numbers with four significant digits, separated by commas.
pub(super) fn list(values: &[f64]) -> String {
    let values: Vec<String> = values.iter().map(|value| digits(*value, 4)).collect();
    values.join(", ")
}

/// Ratios with three decimals, separated by commas.
pub(super) fn shares(values: &[f64]) -> String {
    let values: Vec<String> = values.iter().map(|value| format!("{value:.3}")).collect();
    values.join(", ")
}

/// A number with `count` significant digits.
pub(super) fn digits(value: f64, count: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let scientific = format!("{value:.*e}", count - 1);
    // The exponent after rounding, so that 9.9999 counts as 10.
    let exponent =
        scientific.split_once('e').and_then(|(_, exponent)| exponent.parse::<i64>().ok());
    match exponent {
        Some(exponent @ -4..) => {
            let before = usize::try_from(exponent + 1).unwrap_or(0);
            let leading_zeros = usize::try_from(-exponent - 1).unwrap_or(0);
            format!("{value:.*}", (count + leading_zeros).saturating_sub(before))
        }
        _ => scientific,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verdicts_follow_from_the_numbers() {
        let mut sheet = ClaimSheet::default();
        let rounds = sheet.number("a", "", "", "0.67", &[0.6651]).verdict;
        assert_eq!(rounds, ClaimVerdict::Reproduced);
        let within = sheet.number("b", "", "", "0.666", &[0.6544]).verdict;
        assert_eq!(within.to_string(), "reproduced within 1.8 %");
        let cut = sheet.truncated(["b", "", ""], "0.666", &[2.0 / 3.0]).verdict;
        assert_eq!(cut, ClaimVerdict::Reproduced);
        let below = sheet.truncated(["b", "", ""], "0.666", &[0.665_9]).verdict;
        assert_eq!(below, ClaimVerdict::Reproduced, "it rounds");
        let next = sheet.truncated(["b", "", ""], "0.666", &[2.0 / 3.0, 0.667_1]).verdict;
        assert_eq!(next.name(), "reproduced within");
        let off = sheet.number("c", "", "", "1.0", &[1.0, 1.2]).verdict;
        assert_eq!(off.name(), "not reproduced");
        let nothing = sheet.number("d", "", "", "1.0", &[]).verdict;
        assert_eq!(nothing, ClaimVerdict::NotReproduced { deviation: None });
        let wrong = sheet.formula(["e", "", ""], 2.0, 1.0).verdict;
        assert_eq!(wrong, ClaimVerdict::FormulaWrong { deviation: 1.0 });
        assert_eq!(sheet.formula(["f", "", ""], 1.0, 1.0).verdict, ClaimVerdict::Reproduced);
    }

    #[test]
    fn digits_are_significant() {
        assert_eq!(digits(0.654_435_1, 4), "0.6544");
        assert_eq!(digits(12.73, 2), "13");
        assert_eq!(digits(9.999_999, 4), "10.00");
        assert_eq!(digits(0.0062, 2), "0.0062");
        assert_eq!(digits(2e-7, 2), "2.0e-7");
    }
}
