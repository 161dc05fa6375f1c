//! The entry points: one run, or many side by side.

use quell_model::Belt;
use quell_numerics::dispatch::InstructionSet;

use super::lanes::side_by_side;
use super::observer::Observer;
use super::run::{RunTerms, SimulationRun};
use super::state::{FinalState, Stalled, Start};

/// Default bound on the last retained terms, relative to F.
pub const DEFAULT_TOLERANCE: f64 = 1e-12;

/// Integrates `belt` from `start` to τ = `until` and passes every segment and event to `observer`.
///
/// `tolerance` bounds the last two retained Taylor terms of a step relative to F
/// ([`DEFAULT_TOLERANCE`]). Nothing is allocated per step. The engine is compiled once per law
/// and instruction set, not per observer: an observer costs one indirect call per segment.
///
/// # Errors
/// [`Stalled`] if a state leaves the finite numbers, if no step advances time, or if the run would take more than
/// [`MOST_STEPS`](super::MOST_STEPS) or more than the request that it belongs to may take ([`within`](super::within)).
pub fn simulate(
    belt: &Belt,
    start: Start,
    until: f64,
    tolerance: f64,
    observer: &mut dyn Observer,
) -> Result<FinalState, Stalled> {
    let run = SimulationRun { belt, start, until, observer };
    alone(run, RunTerms { tolerance, branch: None })
}

/// One run by itself.
fn alone(run: SimulationRun<'_>, terms: RunTerms) -> Result<FinalState, Stalled> {
    let outcomes = side_by_side(InstructionSet::Fma, vec![run], terms);
    outcomes.into_iter().next().unwrap_or(Err(Stalled::NEVER_STARTED))
}

/// Integrates many runs side by side in the lanes of the machine's widest instruction set.
///
/// Each lane has its own time, step, phase and events; a lane that has finished takes the next
/// run. Every run has the same bits as in [`simulate`], for any other runs in the lanes and on any
/// instruction set. The results are in the order of the runs.
pub fn simulate_many(
    runs: Vec<SimulationRun<'_>>,
    tolerance: f64,
) -> Vec<Result<FinalState, Stalled>> {
    simulate_many_with(InstructionSet::widest(), runs, tolerance)
}

/// [`simulate_many`] with a given instruction set, or the widest available one if the machine lacks it.
pub fn simulate_many_with(
    set: InstructionSet,
    runs: Vec<SimulationRun<'_>>,
    tolerance: f64,
) -> Vec<Result<FinalState, Stalled>> {
    side_by_side(set, runs, RunTerms { tolerance, branch: None })
}

/// Integrates slip on the branch of `sign` from `start` to τ = `until`, regardless of the sign of v_r, and passes every segment to
/// `observer`.
///
/// This is not a motion of the belt but the smooth continuation of one: through v_r = 0 slip goes on analytically on one branch of the law,
/// as slip of the other sign. In this sense an orbit in pure slip that depends on a parameter exists on both sides of the grazing of
/// v_r = 0, so that the grazing is a simple root of its least slip velocity. In slip of the branch's own sign it is the actual motion.
///
/// # Errors
/// [`Stalled`] if a state leaves the finite numbers or no step advances time.
pub(crate) fn continue_slip(
    belt: &Belt,
    sign: f64,
    start: Start,
    until: f64,
    tolerance: f64,
    observer: &mut dyn Observer,
) -> Result<FinalState, Stalled> {
    let run = SimulationRun { belt, start, until, observer };
    alone(run, RunTerms { tolerance, branch: Some(sign) })
}

#[cfg(test)]
mod tests {
    use quell_model::{Direction, Dither, LawKind, Waveform};

    use super::*;
    use crate::simulation::EventRecorder;

    #[test]
    fn machines_without_fused_multiply_add_give_the_same_bits() {
        for values in [
            (LawKind::Stribeck, &[0.4, 0.2857, 0.2][..]),
            (LawKind::Decreasing, &[0.4, 0.2857, 0.2]),
            (LawKind::Coulomb, &[0.2857, 0.4, 0.05]),
            (LawKind::StribeckExponential, &[0.2857, 0.4, 0.2, 2.0, 0.05]),
        ] {
            let (law, values) = values;
            let friction = law.build(values).expect("valid law");
            let dither = |direction, waveform| Dither {
                direction,
                waveform,
                amplitude: 0.3,
                frequency_ratio: 7.3,
                phase: 0.4,
                envelope: None,
            };
            let dithers = vec![
                dither(Direction::Tangential, Waveform::Sine),
                dither(Direction::Normal, Waveform::Triangle),
            ];
            let belt = Belt::new(0.005, 1.0, 0.05, friction, dithers).expect("valid belt");
            let mut fast = EventRecorder::default();
            let ahead = simulate(&belt, Start::REST, 300.0, DEFAULT_TOLERANCE, &mut fast);
            let mut slow = EventRecorder::default();
            let run = SimulationRun {
                belt: &belt,
                start: Start::REST,
                until: 300.0,
                observer: &mut slow,
            };
            let behind = simulate_many_with(InstructionSet::Baseline, vec![run], DEFAULT_TOLERANCE);
            assert!(fast.events.len() > 100);
            assert_eq!(vec![ahead], behind, "{}", law.name());
            assert_eq!(fast.events, slow.events, "{}", law.name());
        }
    }
}
