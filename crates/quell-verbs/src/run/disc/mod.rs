//! Runs of a disc study: one file per verb.

pub mod campbell;
pub mod check;
pub mod critical;
pub mod design;
pub mod kick;
pub mod modes;
pub mod motion;
pub mod resonances;
pub mod stability;
mod tangential;
mod watch;

use crate::complaint::Failure;

/// The failure of a computation that overflowed.
fn overflowed(key: &str, why: impl std::fmt::Display) -> Failure {
    Failure::Failed { key: key.to_owned(), why: why.to_string().into() }
}
