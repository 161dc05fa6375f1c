//! The two workloads on which Quell and its peers (`benches/peers/`) are timed.

use std::f64::consts::TAU;
use std::fs;
use std::thread;
use std::time::Instant;

use quell_dynamics::simulation::{
    InstructionSet, SimulationRun, Start, simulate, simulate_many_with,
};
use quell_model::{Belt, Direction, Dither, LawKind, Waveform};

/// Tolerance of the published speed figures.
pub(crate) const TOLERANCE: f64 = 1e-10;

/// Passes of a measurement, the fastest of which counts.
const PASSES: u32 = 12;

/// Belts to be simulated from their starts to a common end time.
pub(crate) struct Workload {
    pub(crate) name: &'static str,
    pub(crate) cases: Vec<(Belt, Start)>,
    /// End time τ, dimensionless.
    pub(crate) until: f64,
}

impl Workload {
    /// Stribeck law, v₀ = 0.05, tangential sine dither with D = 0.1, 0.3, 0.5, 0.8 and
    /// R = 5, 10, from rest: about 1.7 events per dither period.
    pub(crate) fn stick_slip() -> Self {
        let mut cases = Vec::new();
        for amplitude in [0.1, 0.3, 0.5, 0.8] {
            for ratio in [5.0, 10.0] {
                cases.push((belt(LawKind::Stribeck, 0.05, amplitude, ratio), Start::REST));
            }
        }
        Self { name: "stick-slip", cases, until: 200.0 }
    }

    /// Decreasing law, v₀ = 1, D = 2, R = 10, from x = 0.2: no event.
    pub(crate) fn event_free() -> Self {
        let start = Start { displacement: 0.2, ..Start::REST };
        let cases = vec![(belt(LawKind::Decreasing, 1.0, 2.0, 10.0), start)];
        Self { name: "event-free", cases, until: 2000.0 }
    }

    /// Each case `copies` times, with dither amplitudes that differ by thousandths, so that
    /// runs side by side have different steps and events, like the points of a map.
    pub(crate) fn multiplied(&self, copies: u32) -> Self {
        let mut cases = Vec::new();
        for copy in 0..copies {
            for (belt, start) in &self.cases {
                let amplitude = belt.dithers()[0].amplitude * (1.0 + 1e-3 * f64::from(copy));
                cases.push((belt.with_amplitude(0, amplitude).expect("valid"), *start));
            }
        }
        Self { name: self.name, cases, until: self.until }
    }

    /// The cases one after the other.
    pub(crate) fn pass_alone(&self) {
        for (belt, start) in &self.cases {
            simulate(belt, *start, self.until, TOLERANCE, &mut ()).expect("no stall");
        }
    }

    /// The cases side by side on an instruction set.
    pub(crate) fn pass_together(&self, set: InstructionSet) {
        let until = self.until;
        let mut observers = vec![(); self.cases.len()];
        let runs = (self.cases.iter().zip(&mut observers))
            .map(|((belt, start), observer)| SimulationRun { belt, start: *start, until, observer })
            .collect();
        let outcomes = simulate_many_with(set, runs, TOLERANCE);
        assert!(outcomes.iter().all(Result::is_ok), "no stall");
    }

    /// Fastest pass alone, in µs per dither period.
    pub(crate) fn time_alone(&self) -> f64 {
        self.fastest(|| self.pass_alone())
    }

    /// Fastest pass side by side, in µs per dither period.
    pub(crate) fn time_together(&self, set: InstructionSet) -> f64 {
        self.fastest(|| self.pass_together(set))
    }

    fn fastest(&self, pass: impl Fn()) -> f64 {
        let wall = Instant::now();
        let now = || processor_seconds().unwrap_or_else(|| wall.elapsed().as_secs_f64());
        let seconds = (0..PASSES)
            .map(|_| {
                let began = now();
                pass();
                now() - began
            })
            .fold(f64::INFINITY, f64::min);
        seconds * 1e6 / self.periods()
    }

    /// Total number of dither periods of all cases.
    pub(crate) fn periods(&self) -> f64 {
        self.cases.iter().map(|(belt, _)| belt.dithers()[0].frequency_ratio).sum::<f64>()
            * self.until
            / TAU
    }
}

/// Time that this thread spent on a processor, if the system reports it: other work does not count.
fn processor_seconds() -> Option<f64> {
    // The system updates its accounting when a thread yields.
    thread::yield_now();
    let statistics = fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = statistics.split_whitespace().next()?.parse().ok()?;
    Some(1e-9 * nanoseconds)
}

fn belt(law: LawKind, belt_velocity: f64, amplitude: f64, frequency_ratio: f64) -> Belt {
    let dither = Dither {
        direction: Direction::Tangential,
        waveform: Waveform::Sine,
        amplitude,
        frequency_ratio,
        phase: 0.0,
        envelope: None,
    };
    law.build(&[0.4, 0.2857, 0.2])
        .and_then(|friction| Belt::new(0.005, 1.0, belt_velocity, friction, vec![dither]))
        .expect("the workload is valid")
}
