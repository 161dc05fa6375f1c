//! Runs of a disc study: one file per verb.

pub mod campbell;
pub mod check;
pub mod modes;
pub mod resonances;
pub mod stability;

use crate::complaint::Failure;

/// A computation that the arithmetic could not carry through.
fn overflowed(key: &str, why: impl std::fmt::Display) -> Failure {
    Failure::Failed { key: key.to_owned(), why: why.to_string() }
}
