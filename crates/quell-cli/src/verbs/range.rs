//! Numbers and ranges that several verbs take: `--from`, `--to`, `--points`, `FROM:TO`.

use quell::{Complaint, quantity};
use quell_model::units::{Quantity, Scales};

/// A finite number, if the text is one.
pub(crate) fn finite(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|it: &f64| it.is_finite())
}

/// A finite number in the numbers of the equations, or of the SI key that is varied.
pub(crate) fn number(option: &'static str, text: &str) -> Result<f64, Box<Complaint>> {
    finite(text).ok_or_else(|| {
        Box::new(Complaint::option(option, text, "a finite number in the unit of the parameter"))
    })
}

/// A whole number.
pub(crate) fn count(option: &'static str, text: &str) -> Result<usize, Box<Complaint>> {
    text.trim()
        .parse()
        .map_err(|_| Box::new(Complaint::option(option, text, "a whole number, such as 101")))
}

/// `FROM:TO`, two quantities of which the first is smaller.
pub(crate) fn range(
    option: &'static str,
    text: &str,
    quantity: Quantity,
    scales: Option<Scales>,
) -> Result<(f64, f64), Box<Complaint>> {
    let allowed = || {
        let allowed = "FROM:TO, two quantities, the first below the second, such as -1:1.5";
        Box::new(Complaint::option(option, text, allowed))
    };
    let (from, to) = text.split_once(':').ok_or_else(allowed)?;
    let from = quantity::parse(from, quantity, scales, option)?;
    let to = quantity::parse(to, quantity, scales, option)?;
    if from < to { Ok((from, to)) } else { Err(allowed()) }
}
