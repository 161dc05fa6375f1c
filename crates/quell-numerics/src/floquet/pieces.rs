//! Exponents where the matrix is constant on each of a few pieces of the period: x′ = A_k x for a time t_k.
//!
//! The map of one period is the product of the exponentials e^{A_k t_k}, so that no step and no extrapolation is needed. The
//! remaining error is rounding: that of the eigenvalues of the map, and ε‖A_k‖ for the phase of each exponential, both times
//! the condition number of the multiplier.

use crate::eigen::{Decomposition, EigenError};
use crate::matrix::Matrix;
use crate::order::descending_by;
use crate::polar::modulus;

use super::steps::exponential_of_matrix;
use super::{Exponent, FLOOR, conditions};

/// Rounding of the exponentials relative to ε‖A‖.
const ROUNDING: f64 = 4.0;

/// A part of the period on which the matrix is constant.
#[derive(Clone, Debug, PartialEq)]
pub struct ConstantPiece {
    /// Its duration.
    pub duration: f64,
    /// The matrix A.
    pub matrix: Matrix,
}

/// The exponents of a period that consists of these pieces, one of each conjugate pair, the fastest first. `steps` is the number of
/// pieces.
///
/// # Errors
/// [`EigenError`] if the map is not finite or its eigenvalues do not converge.
pub fn of_pieces(pieces: &[ConstantPiece]) -> Result<Vec<Exponent>, EigenError> {
    let period: f64 = pieces.iter().map(|piece| piece.duration).sum();
    let mut map: Option<Matrix> = None;
    let mut norm = 0.0;
    for piece in pieces {
        if !piece.matrix.is_finite() {
            return Err(EigenError::NotFinite);
        }
        norm = f64::max(norm, piece.matrix.frobenius_norm());
        let flow = exponential_of_matrix(&piece.matrix, piece.duration);
        map = Some(map.map_or_else(|| flow.clone(), |before| flow.times(&before)));
    }
    let map = map.unwrap_or_else(|| Matrix::identity(0));
    exponents_of(&map, period, ROUNDING * f64::EPSILON * norm, pieces.len())
}

/// The exponents of a map of one period, one of each conjugate pair, the fastest first. `phase` is the rounding of the phase of the
/// map, per unit of time.
pub(super) fn exponents_of(
    map: &Matrix,
    period: f64,
    phase: f64,
    steps: usize,
) -> Result<Vec<Exponent>, EigenError> {
    let decomposition = Decomposition::of_balanced(map)?;
    let values = decomposition.values();
    let mut found: Vec<Exponent> = values
        .iter()
        .zip(conditions(&decomposition, 0.0))
        .filter(|(value, _)| value.im >= 0.0)
        .map(|(&value, condition)| {
            let eigenvalue = decomposition.backward_error() / (modulus(value) * period);
            Exponent {
                growth_rate: libm::log(modulus(value)) / period,
                error: condition * (eigenvalue + phase) + FLOOR,
                frequency: libm::atan2(value.im.abs(), value.re) / period,
                steps,
            }
        })
        .collect();
    descending_by(&mut found, |a| a.growth_rate);
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The Meissner equation x″ + (a ± b)x = 0: cosh(ρT) = cos θ₁ cos θ₂ − (w₁/w₂ + w₂/w₁) sin θ₁ sin θ₂/2.
    #[test]
    fn the_meissner_equation_has_its_closed_form() {
        for (a, b, half) in [(1.0f64, 0.3, 3.0), (1.0, 0.3, 2.2), (0.5, 0.2, 4.4)] {
            let oscillator = |square: f64| ConstantPiece {
                duration: half,
                matrix: Matrix::from_fn(2, 2, |i, j| match (i, j) {
                    (0, 1) => 1.0,
                    (1, 0) => -square,
                    _ => 0.0,
                }),
            };
            let found = of_pieces(&[oscillator(a + b), oscillator(a - b)]).expect("finite");
            let (w1, w2) = ((a + b).sqrt(), (a - b).sqrt());
            let trace = (w1 * half).cos() * (w2 * half).cos()
                - 0.5 * (w1 / w2 + w2 / w1) * (w1 * half).sin() * (w2 * half).sin();
            let rate = if trace.abs() > 1.0 { trace.abs().acosh() / (2.0 * half) } else { 0.0 };
            assert!((found[0].growth_rate - rate).abs() < 1e-13, "{found:?} {rate}");
            assert!((found[0].growth_rate - rate).abs() < found[0].error);
        }
    }
}
