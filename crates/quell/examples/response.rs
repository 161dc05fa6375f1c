//! Does this dither quench the vibration, and at what cost?
//!
//! `cargo run --release --package quell --example response`

use quell::run::response::ResponseRequest;
use quell::verbs::verbs;
use quell::{Failure, Study};

/// A Stribeck belt under a fast tangential force.
const STUDY: &str = r#"
[belt]
damping_ratio = 0.005
normal_load = 1.0
belt_velocity = 0.05
[friction]
law = "stribeck"
static_coefficient = 0.4
minimum_coefficient = 0.2857
reference_velocity = 0.2
[dither]
direction = "tangential"
waveform = "sine"
amplitude = 0.52
frequency_ratio = 10.0
"#;

/// Answers the question.
///
/// # Errors
/// An invalid study; a run that cannot be computed.
pub(crate) fn main() -> Result<(), Failure> {
    let study = Study::parse(STUDY, &[])?;
    let steady = verbs(&study).response(&ResponseRequest::default())?;
    assert_eq!(steady.json()["effect"], "quenches");
    println!("{}", steady.text());
    Ok(())
}
