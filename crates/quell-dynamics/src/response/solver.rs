//! The options of a steady response.

use crate::simulation::DEFAULT_TOLERANCE;

/// Options of a response; `[solver]` of a study.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solver {
    /// Bound on the last retained Taylor terms of a step, relative to F.
    pub tolerance: f64,
    /// Time τ discarded before the record.
    pub settle: f64,
    /// Slow periods 2π in the record.
    pub record_periods: u32,
}

impl Default for Solver {
    fn default() -> Self {
        Self { tolerance: DEFAULT_TOLERANCE, settle: 1200.0, record_periods: 60 }
    }
}
