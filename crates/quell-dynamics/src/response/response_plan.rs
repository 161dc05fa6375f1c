//! How a response is measured.

use std::f64::consts::TAU;

use quell_model::OneMass;

use super::solver::Solver;
use crate::simulation::DEFAULT_TOLERANCE;

/// Relative rounding of a length that is a whole number of slow periods.
const ROUNDING: f64 = 1e-12;

/// How a response is measured.
#[derive(Clone, Debug, PartialEq)]
pub struct ResponsePlan {
    /// The row that is observed.
    pub row: Vec<f64>,
    /// Time discarded before the record.
    pub settle: f64,
    /// Length of the record.
    pub length: f64,
    /// Bound on the last terms of a step, as of [`crate::motion::Motion::run_tolerance`]; `None` for that of the engine.
    pub tolerance: Option<f64>,
}

impl From<&Solver> for ResponsePlan {
    /// The plan of a belt's response in the numbers of its equations.
    fn from(solver: &Solver) -> Self {
        let Solver { tolerance, settle, record_periods } = *solver;
        let length = TAU * f64::from(record_periods);
        Self { row: vec![1.0], settle, length, tolerance: Some(tolerance) }
    }
}

impl ResponsePlan {
    /// The plan in the numbers of one mass, if the record is a whole number of its slow periods.
    pub(super) fn solver_of(&self, mass: &OneMass) -> Option<Solver> {
        let periods = mass.rate() * self.length / TAU;
        let whole = periods.round();
        let is_whole = (periods - whole).abs() <= ROUNDING * periods;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a small count"
        )]
        let record_periods = (is_whole && (1.0..1e6).contains(&whole)).then_some(whole as u32)?;
        Some(Solver {
            tolerance: self.tolerance.unwrap_or(DEFAULT_TOLERANCE),
            settle: mass.rate() * self.settle,
            record_periods,
        })
    }
}
