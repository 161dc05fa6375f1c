//! Numbers and ranges that several verbs take: `--from`, `--to`, `--points`, `FROM:TO`, `X,V`, times.

use clap::Args;
use quell::{Complaint, Study, quantity};
use quell_model::units::{Quantity, Scales};

use crate::arguments::Complaints;

/// A parameter and the ends of its range.
#[derive(Debug, Args)]
pub(crate) struct VariedArguments {
    /// Path of the parameter, such as dither.amplitude
    #[arg(long, value_name = "PATH")]
    pub(super) parameter: String,
    /// Smallest value
    #[arg(long, value_name = "A", allow_hyphen_values = true)]
    from: String,
    /// Largest value
    #[arg(long, value_name = "B", allow_hyphen_values = true)]
    to: String,
}

impl VariedArguments {
    /// Both ends.
    pub(super) fn ends(&self, complaints: &mut Complaints) -> Option<(f64, f64)> {
        let from = complaints.take(number("--from", &self.from));
        let to = complaints.take(number("--to", &self.to));
        from.zip(to)
    }
}

/// Scales in which quantities of a study are read. Of one that could not be read it is not known whether it is in SI: units
/// are no fault there.
pub(super) fn scales(study: Option<&Study>) -> Option<Scales> {
    study.map_or_else(|| Scales::new(1.0, 1.0).ok(), Study::scales)
}

/// How long: τ, or a time with its unit in a study in SI.
pub(super) fn duration(
    option: &'static str,
    text: &str,
    study: Option<&Study>,
) -> Result<f64, Box<Complaint>> {
    quantity::duration(text, scales(study), option)
}

/// A finite number, if the text is one.
fn finite(text: &str) -> Option<f64> {
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

/// `FROM:TO`, two finite numbers.
pub(crate) fn window(option: &'static str, text: &str) -> Result<(f64, f64), Box<Complaint>> {
    pair(text, ':').ok_or_else(|| {
        Box::new(Complaint::option(option, text, "two finite numbers FROM:TO, such as 0.2:0.9"))
    })
}

/// `X,V`, a state.
pub(crate) fn state(option: &'static str, text: &str) -> Result<(f64, f64), Box<Complaint>> {
    pair(text, ',').ok_or_else(|| {
        let allowed = "two finite numbers x,v: displacement and velocity, such as 0.3,0";
        Box::new(Complaint::option(option, text, allowed))
    })
}

fn pair(text: &str, between: char) -> Option<(f64, f64)> {
    let (first, second) = text.split_once(between)?;
    Some((finite(first)?, finite(second)?))
}
