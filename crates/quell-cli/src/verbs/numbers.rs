//! Numbers and ranges in the options of several verbs: `--from`, `--to`, `--points`, `FROM:TO`, `X,V`, times.

use clap::{Args, ValueHint};
use quell::{Complaint, RealInterval, Study, quantity};

use crate::arguments::Gathered;

/// A parameter and the ends of its range, in the unit of its key.
#[derive(Debug, Args)]
pub(crate) struct VariedArguments {
    /// Path of the parameter, such as dither.amplitude
    #[arg(long, value_name = "PATH", value_hint = ValueHint::Other)]
    pub(super) parameter: String,
    /// Smallest value, in the unit of the key or with a unit, such as 5kN
    #[arg(long, value_name = "A", allow_hyphen_values = true, value_hint = ValueHint::Other)]
    pub(super) from: String,
    /// Largest value, in the unit of the key or with a unit, such as 5kN
    #[arg(long, value_name = "B", allow_hyphen_values = true, value_hint = ValueHint::Other)]
    pub(super) to: String,
}

impl VariedArguments {
    /// Both ends, in the unit of the key.
    pub(super) fn ends(
        &self,
        study: Option<&Study>,
        complaints: &mut Gathered,
    ) -> Option<RealInterval> {
        let from = complaints.take(number("--from", &self.from, &self.parameter, study));
        let to = complaints.take(number("--to", &self.to, &self.parameter, study));
        Some(RealInterval::new(from?, to?))
    }
}

/// A finite number in the unit of the varied key, or with a unit of its own.
pub(crate) fn number(
    option: &'static str,
    text: &str,
    parameter: &str,
    study: Option<&Study>,
) -> Result<f64, Box<Complaint>> {
    quantity::value_of(study, text, parameter, option)
}

/// A whole number.
pub(crate) fn count(option: &'static str, text: &str) -> Result<usize, Box<Complaint>> {
    text.trim()
        .parse()
        .map_err(|_| Box::new(Complaint::option(option, text, "a whole number, such as 101")))
}

/// `FROM:TO`, two quantities parsed by `read`, the first below the second.
pub(crate) fn ascending(
    option: &'static str,
    text: &str,
    read: impl Fn(&str) -> Result<f64, Box<Complaint>>,
) -> Result<RealInterval, Box<Complaint>> {
    let range = pair(option, text, read)?;
    if range.lower < range.upper {
        return Ok(range);
    }
    let allowed = "FROM:TO, two quantities, the first below the second, such as -1:1.5";
    Err(Box::new(Complaint::option(option, text, allowed)))
}

/// `FROM:TO`, two values of the parameter with a path.
pub(crate) fn window(
    option: &'static str,
    text: &str,
    parameter: &str,
    study: Option<&Study>,
) -> Result<RealInterval, Box<Complaint>> {
    pair(option, text, |text| quantity::value_of(study, text, parameter, option))
}

/// `FROM:TO`, each end parsed by `read`.
pub(crate) fn pair(
    option: &'static str,
    text: &str,
    read: impl Fn(&str) -> Result<f64, Box<Complaint>>,
) -> Result<RealInterval, Box<Complaint>> {
    let Some((from, to)) = text.split_once(':') else {
        let allowed = "two finite numbers FROM:TO, such as 0.2:0.9";
        return Err(Box::new(Complaint::option(option, text, allowed)));
    };
    Ok(RealInterval::new(read(from)?, read(to)?))
}
