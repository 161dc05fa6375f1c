//! A measured coefficient of friction.

/// One measured coefficient of friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitPoint {
    /// Slip velocity v, not 0; its sign is the direction of slip.
    pub slip_velocity: f64,
    /// Coefficient, positive where friction opposes slip.
    pub coefficient: f64,
    /// Standard deviation σ > 0 of the coefficient; 1 if none is given.
    pub standard_deviation: f64,
}

impl FitPoint {
    /// Slip speed |v|.
    pub fn speed(&self) -> f64 {
        self.slip_velocity.abs()
    }
}
