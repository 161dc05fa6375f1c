//! Does this brake disc squeal, at which frequency, and at which speeds can it?
//!
//! `cargo run --release --package quell --example disc`

use quell::outcome::{Answered, Outcome};
use quell::run::disc::resonances::{self, ResonancesRequest};
use quell::run::disc::stability;
use quell::{Failure, Study};

/// A steel disc under one pad; modes are computed from the plate.
const STUDY: &str = r"
[disc]
inner_radius_ratio = 0.5
poisson_ratio = 0.3
radial_modes = 1
nodal_diameters = 2
[disc.load]
radius_ratio = 0.75
stiffness = 0.1
friction = 0.05
speed = 0.4
";

/// Answers the question.
///
/// # Errors
/// An invalid study; numbers that overflow.
pub(crate) fn main() -> Result<(), Failure> {
    let study = Study::parse(STUDY, &[])?.disc()?;
    let found = stability::run(&study)?;
    assert!(found.growth.rate > 0.0);
    println!("{}", Answered::new(&study, found).text());
    let resonances = resonances::run(&study, ResonancesRequest::default())?;
    println!("{}", Answered::new(&study, resonances).text());
    Ok(())
}
