//! Event-exact trajectories of the belt by adaptive Taylor series.
//!
//! * Slip is a Taylor step of order [`ORDER`] on one analytic branch of the law
//!   (`slip`); its length keeps the last two retained terms below the tolerance.
//! * Stick is closed form; the release is the first root of |f_s| − μ_s N (`stick`).
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
//! Taylor step control: Jorba and Zou (2005). Order of events and stick rules: the errata
//! and traps of the project's documentation, chapter "The belt".

mod clock;
mod engine;
mod event;
mod forcing;
mod observer;
mod slip;
mod stick;
mod transitions;

use std::fmt;

use quell_model::Belt;
use quell_model::friction::{LawVisitor, SlidingLaw};
use quell_numerics::dispatch::{Work, with_fused_multiply_add};

pub use clock::Clock;
pub use event::{Event, EventKind};
pub use observer::{EventRecorder, Observer, Sample, Sampler, Segment, VelocitySection};

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

/// The engine could not go on; a defect worth reporting with the study.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stalled {
    /// τ at which it stopped.
    pub time: f64,
    /// Why.
    pub why: &'static str,
}

impl fmt::Display for Stalled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the integration stopped at τ = {}: {}", self.time, self.why)
    }
}

impl std::error::Error for Stalled {}

/// Integrates `belt` from `start` to τ = `until`, showing every segment and event to `observer`.
///
/// `tolerance` bounds the last two retained Taylor terms of a step relative to F
/// ([`DEFAULT_TOLERANCE`]). Nothing is allocated per step. The engine is compiled once per law and
/// instruction set, whatever watches: an observer costs one indirect call a segment. A start with x′ = v₀ is decided by
/// f_s alone and gives no event.
///
/// # Errors
/// [`Stalled`] if a state leaves the finite numbers or no step advances time.
pub fn simulate(
    belt: &Belt,
    start: Start,
    until: f64,
    tolerance: f64,
    observer: &mut dyn Observer,
) -> Result<FinalState, Stalled> {
    belt.friction().visit(Run { belt, start, until, tolerance, observer })
}

/// One run, before the law is known.
struct Run<'a> {
    belt: &'a Belt,
    start: Start,
    until: f64,
    tolerance: f64,
    observer: &'a mut dyn Observer,
}

/// One run with its law.
struct RunOf<'a, L> {
    run: Run<'a>,
    law: L,
}

impl LawVisitor for Run<'_> {
    type Output = Result<FinalState, Stalled>;

    fn visit<L: SlidingLaw>(self, law: &L) -> Self::Output {
        with_fused_multiply_add(RunOf { run: self, law: *law })
    }
}

impl<L: SlidingLaw> Work for RunOf<'_, L> {
    type Output = Result<FinalState, Stalled>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        let Run { belt, start, until, tolerance, observer } = self.run;
        engine::Engine::new(belt, self.law, start, until, tolerance, observer).run()
    }
}

#[cfg(test)]
mod tests {
    use quell_model::{Direction, Dither, LawKind, Waveform};

    use super::*;

    /// A run in the baseline copy of the engine.
    struct Baseline<'a>(Run<'a>);

    impl LawVisitor for Baseline<'_> {
        type Output = Result<FinalState, Stalled>;

        fn visit<L: SlidingLaw>(self, law: &L) -> Self::Output {
            RunOf { run: self.0, law: *law }.run()
        }
    }

    #[test]
    fn machines_without_fused_multiply_add_give_the_same_bits() {
        for &law in LawKind::ALL {
            let friction = law.build(&[0.4, 0.2857, 0.2]).expect("valid law");
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
            let behind = belt.friction().visit(Baseline(Run {
                belt: &belt,
                start: Start::REST,
                until: 300.0,
                tolerance: DEFAULT_TOLERANCE,
                observer: &mut slow,
            }));
            assert!(fast.events.len() > 100);
            assert_eq!(ahead, behind, "{}", law.name());
            assert_eq!(fast.events, slow.events, "{}", law.name());
        }
    }
}
