//! Event-exact trajectories of the belt by adaptive Taylor series.
//!
//! * Slip is a Taylor step of order [`ORDER`] on one analytic branch of the law
//!   (`slip`); its length keeps the last two retained terms below the tolerance.
//! * Stick is closed form; the release is the first root of |f_s| − μ_s N, under one sine without
//!   a series (`release`), under any other dither on one (`stick`).
//! * Every root of a step is isolated or proven absent
//!   ([`quell_numerics::polynomial::first_crossing`]); kinks and jumps of the dither are time
//!   events (`forcing`).
//! * Order of simultaneous events: first the kink or jump, then the stick test with the
//!   new value (stick while |f_s| − μ_s N ≤ 0), then release or reversal, then passive events.
//! * Lengths are counted in the law's velocity scale v_m: multiplying F, v₀, v_m, D and x(0)
//!   by a power of two leaves every event time equal in the last bit.
//! * μ_s > μ_k makes forward uniqueness fail at a tangential release; the rule "stick while
//!   |f_s| ≤ μ_s N" is our declared selection, and such releases are counted
//!   ([`FinalState::near_tangential_releases`]).
//!
//! * Steps are counted: a run that would not end in reasonable time is stopped with the reason (`pace`).
//!
//! Taylor step control: Jorba and Zou (2005). Order of events and stick rules: the errata
//! and traps of the project's documentation, chapter "The belt".

mod clock;
mod engine;
mod event;
mod extremes;
mod forcing;
mod lanes;
mod largest_slip;
mod observer;
mod pace;
mod release;
mod slip;
mod slip_step;
mod stick;
mod transitions;

use std::fmt;

use quell_model::Belt;
pub use quell_numerics::dispatch::InstructionSet;

pub use clock::Clock;
pub use event::{Event, EventKind};
pub use extremes::Extremes;
pub(crate) use lanes::slide;
pub use largest_slip::LargestSlip;
pub use observer::{EventRecorder, Observer, Sample, Sampler, Segment, VelocitySection};
pub use pace::{MOST_STEPS, within};

/// Order of the Taylor series. At tolerance 10⁻¹⁰ about three steps cover a period of free
/// slip; the kernel is unrolled for it.
pub const ORDER: usize = 16;

/// Default bound on the last retained terms, relative to F.
pub const DEFAULT_TOLERANCE: f64 = 1e-12;

/// State at the start of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// τ; decides the phase of the dither.
    pub time: f64,
    /// x.
    pub displacement: f64,
    /// x′.
    pub velocity: f64,
}

impl Start {
    /// x = 0, x′ = 0 at τ = 0.
    pub const REST: Self = Self { time: 0.0, displacement: 0.0, velocity: 0.0 };
}

/// State at the end of a run, and what happened on the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FinalState {
    /// τ.
    pub time: f64,
    /// x.
    pub displacement: f64,
    /// x′.
    pub velocity: f64,
    /// Whether the mass moves with the belt.
    pub sticking: bool,
    /// Sign of v_r; 0 in stick.
    pub slip_sign: i8,
    /// Number of events.
    pub events: u64,
    /// Number of segments integrated.
    pub steps: u64,
    /// Releases at which the threshold was hardly crossed (rate of |f_s| − μ_s N below 10⁻⁶
    /// of its scale): forward uniqueness is not guaranteed there, our rule decided.
    pub near_tangential_releases: u64,
}

impl FinalState {
    /// The start that continues this run.
    pub fn restart(&self) -> Start {
        Start { time: self.time, displacement: self.displacement, velocity: self.velocity }
    }
}

/// The engine could not go on: the numbers of the study are too extreme for it, or the run would not end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stalled {
    /// τ at which it stopped.
    pub time: f64,
    /// Why.
    pub why: &'static str,
}

impl Stalled {
    /// What is known of a run before it is run.
    pub(crate) const NEVER_STARTED: Self = Self { time: 0.0, why: "it was never started" };
}

impl fmt::Display for Stalled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the integration stopped at τ = {:?}: {}", self.time, self.why)
    }
}

impl std::error::Error for Stalled {}

/// One run: a belt from a state to a time, and who watches.
pub struct Run<'a> {
    /// The belt.
    pub belt: &'a Belt,
    /// Where it starts. A start with x′ = v₀ is decided by f_s alone and gives no event.
    pub start: Start,
    /// τ at which it ends.
    pub until: f64,
    /// Sees every segment and event.
    pub observer: &'a mut dyn Observer,
}

/// Integrates `belt` from `start` to τ = `until`, showing every segment and event to `observer`.
///
/// `tolerance` bounds the last two retained Taylor terms of a step relative to F
/// ([`DEFAULT_TOLERANCE`]). Nothing is allocated per step. The engine is compiled once per law
/// and instruction set, whatever watches: an observer costs one indirect call a segment.
///
/// # Errors
/// [`Stalled`] if a state leaves the finite numbers, if no step advances time, or if the run would take more than
/// [`MOST_STEPS`] or more than the question that it belongs to may take ([`within`]).
pub fn simulate(
    belt: &Belt,
    start: Start,
    until: f64,
    tolerance: f64,
    observer: &mut dyn Observer,
) -> Result<FinalState, Stalled> {
    let run = Run { belt, start, until, observer };
    let outcomes = simulate_many_with(InstructionSet::Fma, vec![run], tolerance);
    outcomes.into_iter().next().unwrap_or(Err(Stalled::NEVER_STARTED))
}

/// Integrates many runs side by side in the lanes of the machine's widest instruction set.
///
/// Each lane has its own time, step, phase and events; a lane that has finished takes the next
/// run. Every run has the same bits as in [`simulate`], beside whatever neighbours and on any
/// instruction set. Outcomes are in the order of the runs.
pub fn simulate_many(runs: Vec<Run<'_>>, tolerance: f64) -> Vec<Result<FinalState, Stalled>> {
    simulate_many_with(InstructionSet::widest(), runs, tolerance)
}

/// [`simulate_many`] with a given instruction set (or the widest there is, where it is missing).
pub fn simulate_many_with(
    set: InstructionSet,
    runs: Vec<Run<'_>>,
    tolerance: f64,
) -> Vec<Result<FinalState, Stalled>> {
    lanes::side_by_side(set, runs, tolerance)
}

#[cfg(test)]
mod tests {
    use quell_model::{Direction, Dither, LawKind, Waveform};

    use super::*;

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
            };
            let dithers = vec![
                dither(Direction::Tangential, Waveform::Sine),
                dither(Direction::Normal, Waveform::Triangle),
            ];
            let belt = Belt::new(0.005, 1.0, 0.05, friction, dithers).expect("valid belt");
            let mut fast = EventRecorder::default();
            let ahead = simulate(&belt, Start::REST, 300.0, DEFAULT_TOLERANCE, &mut fast);
            let mut slow = EventRecorder::default();
            let run = Run { belt: &belt, start: Start::REST, until: 300.0, observer: &mut slow };
            let behind = simulate_many_with(InstructionSet::Baseline, vec![run], DEFAULT_TOLERANCE);
            assert!(fast.events.len() > 100);
            assert_eq!(vec![ahead], behind, "{}", law.name());
            assert_eq!(fast.events, slow.events, "{}", law.name());
        }
    }
}
