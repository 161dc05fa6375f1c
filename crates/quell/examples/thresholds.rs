//! From which amplitude on does the dither quench, exactly, and from rest?
//!
//! `cargo run --release --package quell --example thresholds`

use quell::outcome::{Answered, Outcome};
use quell::run::protocol::Protocol;
use quell::run::thresholds::{self, ThresholdsRequest};
use quell::verbs::system_of;
use quell::{Failure, Study};
use quell_numerics::interval::RealInterval;

/// A Stribeck belt; the amplitude of its dither is varied.
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
amplitude = 0.5
frequency_ratio = 10.0
"#;

/// Answers the question.
///
/// # Errors
/// An invalid study; a response that cannot be followed.
pub(crate) fn main() -> Result<(), Failure> {
    // A belt is a system of one mass.
    let study = system_of(&Study::parse(STUDY, &[])?, "thresholds")?;
    let request = ThresholdsRequest {
        parameter: "dither.amplitude".to_owned(),
        window: RealInterval::new(0.4, 0.6),
        protocols: vec![Protocol::Rest],
        ..ThresholdsRequest::default()
    };
    let found = thresholds::run(&study, &request)?;
    let first = found.local.as_ref().ok().and_then(|local| local.thresholds.first());
    assert!(first.is_some_and(|first| (first.value - 0.4965619).abs() < 1e-7));
    println!("{}", Answered::new(&study, found).text());
    Ok(())
}
