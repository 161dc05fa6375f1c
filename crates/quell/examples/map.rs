//! What does the dither do over a whole plane of belt velocities and amplitudes?
//!
//! `cargo run --release --package quell --example map`

use std::sync::atomic::AtomicBool;

use quell::map;
use quell::outcome::Outcome;
use quell::running::Running;
use quell::sweep::{MapQuantity, Plan};
use quell::{Failure, Study};

/// A Stribeck belt with two axes.
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
[[sweep]]
parameter = "belt.belt_velocity"
from = 0.02
to = 0.2
points = 10
[[sweep]]
parameter = "dither.amplitude"
from = 0.1
to = 2.0
points = 20
"#;

/// Answers the question.
///
/// # Errors
/// An invalid study.
pub(crate) fn main() -> Result<(), Failure> {
    let study = Study::parse(STUDY, &[])?;
    let plan = Plan::new(&study, &[MapQuantity::named("verdict", "quantity")?])?;
    assert_eq!(plan.grid().shape(), [10, 20]);
    let running = Running { threads: None, stop: &AtomicBool::new(false), progress: &() };
    let done = map::run(plan, None, running)?;
    println!("{}", done.text());
    Ok(())
}
