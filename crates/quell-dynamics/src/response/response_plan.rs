//! How a response is measured.

use std::f64::consts::TAU;

use super::solver::Solver;

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
