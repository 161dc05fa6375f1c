//! The largest slip speed of a run.

use quell_model::Belt;
use quell_numerics::dispatch::{Work, with_fused_multiply_add};

use super::observer::{Observer, Segment};
use super::{DEFAULT_TOLERANCE, SimulationRun, Start, simulate_many};

/// Moments of a step at which slip is evaluated: a step is at most a few radians of the fastest oscillation, so that the
/// largest slip is underestimated by less than a hundredth of the oscillation.
const MOMENTS: usize = 8;

/// Records the largest |v_r| of a run if the friction law has a range of validity that slip could leave.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LargestSlip {
    /// The largest |v_r| so far, a length per τ; 0 if the law has no range.
    pub speed: f64,
    /// Whether the law has a range.
    has_range: bool,
}

impl LargestSlip {
    /// For runs of a belt.
    pub fn of(belt: &Belt) -> Self {
        Self { speed: 0.0, has_range: belt.friction().range().is_some() }
    }
}

impl Observer for LargestSlip {
    fn watches(&self) -> bool {
        self.has_range
    }

    fn segment(&mut self, segment: &Segment<'_>) {
        if self.has_range && segment.slip_sign() != 0 {
            self.speed = self.speed.max(with_fused_multiply_add(Largest(segment)));
        }
    }
}

/// The largest |v_r| at equal steps of a segment, both ends included.
struct Largest<'a, 'b>(&'a Segment<'b>);

impl Work for Largest<'_, '_> {
    type Output = f64;

    #[inline(always)]
    fn run(self) -> f64 {
        let mut since = [0.0; MOMENTS];
        for (index, since) in since.iter_mut().enumerate() {
            *since = self.0.duration() * (index as f64 / (MOMENTS - 1) as f64);
        }
        self.0.slips_at(&since).into_iter().fold(0.0, |most, slip| slip.abs().max(most))
    }
}

/// Largest slip speed of each run up to `length` after its start, computed in one batch; 0 if the law has no range.
pub fn largest_slips(cases: &[(&Belt, Start)], length: f64) -> Vec<f64> {
    let mut slips: Vec<LargestSlip> = cases.iter().map(|(belt, _)| LargestSlip::of(belt)).collect();
    let watched = cases.iter().zip(&mut slips).filter(|(_, slip)| slip.watches());
    let runs = watched.map(|(&(belt, start), slip)| {
        let observer: &mut dyn Observer = slip;
        SimulationRun { belt, start, until: start.time + length, observer }
    });
    simulate_many(runs.collect(), DEFAULT_TOLERANCE);
    slips.into_iter().map(|slip| slip.speed).collect()
}
