//! How much dither quenches a belt: by averaging, exactly, and what a run from rest says.
//!
//! `cargo run --release --package quell-dynamics --example quench`; the book shows this file and its answer.

use std::error::Error;
use std::fmt::Write as _;

use quell_dynamics::orbit::branch_thresholds;
use quell_dynamics::response::{ResponsePlan, Solver, respond};
use quell_dynamics::simulation::Start;
use quell_linear::averaging::{Averaging, critical_amplitudes};
use quell_model::{Belt, Direction, Dither, LawKind, Waveform};

/// The answer as text.
///
/// # Errors
/// Values out of range, a run that stops, a threshold that cannot be followed.
pub(crate) fn answer() -> Result<String, Box<dyn Error>> {
    // μ_s, μ_m, v_m; then ζ, F, v₀: a belt that exists is valid.
    let law = LawKind::Stribeck.build(&[0.4, 0.2857, 0.2]).map_err(|wrong| format!("{wrong:?}"))?;
    let dither = Dither {
        direction: Direction::Tangential,
        waveform: Waveform::Sine,
        amplitude: 0.4,
        frequency_ratio: 10.0,
        phase: 0.0,
        envelope: None,
    };
    let belt =
        Belt::new(0.005, 1.0, 0.05, law, vec![dither]).map_err(|wrong| format!("{wrong:?}"))?;

    let mut text = String::new();
    for change in critical_amplitudes(&belt, Averaging::Limit)? {
        writeln!(text, "averaging: {:?} from D = {:.4}", change.becomes, change.amplitude)?;
    }
    let at = |values: &[f64]| Ok(belt.with_amplitude(0, values[0])?.system());
    let found = branch_thresholds(&at, 0.4, 0.6, 64, None)?;
    for threshold in found.thresholds {
        writeln!(text, "exactly: {} at D = {:.7}", threshold.kind.name(), threshold.value)?;
    }
    for amplitude in [0.3, 0.4, 0.52] {
        let belt = belt.with_amplitude(0, amplitude).map_err(|error| format!("{error:?}"))?;
        let plan = ResponsePlan::from(&Solver::default());
        let response = respond(&belt.system(), &Start::REST.into(), &plan)?;
        let left = response.residual_vibration?;
        writeln!(text, "from rest, D = {amplitude}: {:.1} % of the squeal is left", 100.0 * left)?;
    }
    Ok(text)
}

#[allow(dead_code, reason = "the test of the book calls `answer`")]
fn main() -> Result<(), Box<dyn Error>> {
    print!("{}", answer()?);
    Ok(())
}
