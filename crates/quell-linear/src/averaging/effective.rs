//! Effective friction at one slip velocity: its value, its frozen slope, and their error bounds.

/// Whether the slope is the same on both sides of the slip velocity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SlopeSide {
    /// An ordinary slope.
    Both,
    /// |v| equals the largest fast velocity. The slope jumps there (to +∞ inside for a sine and a triangle, by a finite step for
    /// a square); the value given is the one for increasing |v|.
    Outer,
}

/// Effective friction at one slip velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effective {
    /// μ̄ (dimensionless).
    pub coefficient: f64,
    /// Bound on the numerical error of `coefficient`.
    pub coefficient_error: f64,
    /// dμ̄/dv_r with the fast motion frozen, per unit velocity.
    pub slope: f64,
    /// Bound on the numerical error of `slope`.
    pub slope_error: f64,
    /// Whether `slope` is one-sided.
    pub side: SlopeSide,
}

impl Effective {
    /// Sum of the parts of a closed form. The errors bound the rounding of each part (`slope_size`: magnitude of the terms of
    /// which a slope part is the sum).
    pub(super) fn closed(
        coefficient: [f64; 2],
        slope: [f64; 2],
        slope_size: f64,
        side: SlopeSide,
    ) -> Self {
        let rounding = 16.0 * f64::EPSILON;
        Self {
            coefficient: coefficient[0] + coefficient[1],
            coefficient_error: rounding * (coefficient[0].abs() + coefficient[1].abs()),
            slope: slope[0] + slope[1],
            slope_error: rounding * (slope[0].abs() + slope[1].abs() + slope_size),
            side,
        }
    }

    /// The value at −v: μ̄ is odd in v, its slope even.
    pub(super) fn mirrored(self) -> Self {
        Self { coefficient: -self.coefficient, ..self }
    }
}
