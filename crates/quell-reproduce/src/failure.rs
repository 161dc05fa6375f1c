//! The failure of a measurement.

use std::fmt::Display;

use quell::complaint::Failure;

/// A piece of work that gave no value.
pub(super) fn failed(name: &str, why: &impl Display) -> Failure {
    Failure::Failed { key: format!("reproduce {name}"), why: why.to_string() }
}
