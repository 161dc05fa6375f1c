//! The rightmost eigenvalue of a matrix and how far rounding can have moved it.
//!
//! Every eigenvalue whose real part comes near the largest is given its condition κ; its error is at most κ·e with e the
//! backward error, or the root of e‖A‖ where it is nearly double. The worst case of e is nε‖A‖ ([`Decomposition::backward_error`]), which
//! rounding never reaches: errors add as a random walk. Here e = [`ROUNDING`]·ε‖A‖.

use num_complex::Complex64;

use super::Decomposition;

/// e over ε‖A‖ (Frobenius). Largest ratio seen against `faer` over random matrices up to 97 rows: 1.2.
pub(crate) const ROUNDING: f64 = 4.0;

/// Real parts this much below the largest, over ‖A‖, are looked at too: a nearly double eigenvalue is uncertain by
/// the root of a rounding error.
const MARGIN: f64 = 1e-7;

/// The rightmost eigenvalue.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rightmost {
    /// The eigenvalue, Im ≥ 0.
    pub value: Complex64,
    /// Bound on the error of the largest real part.
    pub error: f64,
}

impl Decomposition {
    /// Every eigenvalue with a positive real part, one of each conjugate pair, the largest real part first, each with the
    /// bound on the error of its own real part.
    pub fn in_right_half_plane(&self) -> Vec<Rightmost> {
        let rounding = ROUNDING * f64::EPSILON * self.norm;
        let nearly_double = (rounding * self.norm).sqrt();
        let mut found: Vec<Rightmost> = (0..self.n)
            .filter(|&i| self.values[i].im >= 0.0 && self.values[i].re > 0.0)
            .map(|i| {
                let error = (rounding * self.pair(i).condition).min(nearly_double);
                Rightmost { value: self.values[i], error: error.max(f64::MIN_POSITIVE) }
            })
            .collect();
        found.sort_by(|a, b| {
            b.value.re.total_cmp(&a.value.re).then(a.value.im.total_cmp(&b.value.im))
        });
        found
    }

    /// The eigenvalue of largest real part; `None` for a matrix without rows.
    pub fn rightmost(&self) -> Option<Rightmost> {
        let upper = |z: &Complex64| z.im >= 0.0;
        let leader = self
            .values
            .iter()
            .copied()
            .filter(upper)
            .max_by(|a, b| a.re.total_cmp(&b.re).then(a.im.total_cmp(&b.im)))?;
        let rounding = ROUNDING * f64::EPSILON * self.norm;
        let nearly_double = (rounding * self.norm).sqrt();
        let highest = (0..self.n)
            .filter(|&i| {
                upper(&self.values[i]) && self.values[i].re >= leader.re - MARGIN * self.norm
            })
            .map(|i| self.values[i].re + (rounding * self.pair(i).condition).min(nearly_double))
            .fold(leader.re, f64::max);
        Some(Rightmost { value: leader, error: (highest - leader.re).max(f64::MIN_POSITIVE) })
    }
}
