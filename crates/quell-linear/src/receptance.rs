//! Receptance: displacement along a row over a harmonic force along another, of the linear equations of small motions.
//!
//! ```text
//! H(ω) = R (iω − A)⁻¹ (0, M⁻¹ b),    ẏ = A y
//! ```
//!
//! A is the state matrix of a structure with its contacts in a given state, as in [`crate::linearised`]. It is reduced to Hessenberg form
//! once, so that a frequency costs O(n²) (A. J. Laub 1981). Of first-order equations ẋ = A x a force enters as b.

use num_complex::Complex64;
use quell_numerics::eigen::{Decomposition, EigenError};
use quell_numerics::matrix::Matrix;

use crate::linearised::{FrictionSlopes, Linearised};

/// The equations between forces along some rows and displacements along others.
#[derive(Clone, Debug)]
pub struct ReceptanceEquations {
    decomposition: Decomposition,
    outputs: Vec<Vec<f64>>,
    columns: Vec<Vec<f64>>,
}

impl ReceptanceEquations {
    /// Of linear equations under a friction of each contact, between rows over the coordinates; `None` where the mass is singular.
    ///
    /// # Errors
    /// [`EigenError`] where the matrix overflows.
    pub fn new(
        linear: &Linearised,
        friction: &[FrictionSlopes],
        outputs: Vec<Vec<f64>>,
        inputs: &[Vec<f64>],
    ) -> Result<Option<Self>, EigenError> {
        let n = linear.coordinates();
        let matrix = linear.state_matrix_with(friction);
        let forces = Matrix::from_fn(n, inputs.len(), |i, k| inputs[k][i]);
        let (first, moved) = match linear.matrices() {
            Some(matrices) => (n, matrices.mass.solve(&forces)),
            None => (0, Some(forces)),
        };
        let Some(moved) = moved else { return Ok(None) };
        let column = |k: usize| {
            let mut column = vec![0.0; matrix.rows()];
            (0..n).for_each(|i| column[first + i] = moved[(i, k)]);
            column
        };
        let columns = (0..inputs.len()).map(column).collect();
        Ok(Some(Self { decomposition: Decomposition::new(&matrix)?, outputs, columns }))
    }

    /// The eigenvalues of the equations: at their frequencies the receptances have peaks.
    pub fn poles(&self) -> &[Complex64] {
        self.decomposition.values()
    }

    /// Poles that are closer to the imaginary axis than this may lie on it.
    pub fn rounding(&self) -> f64 {
        self.decomposition.backward_error()
    }

    /// The receptances at an angular frequency, one row of inputs for each output; `None` at an undamped resonance, and at rest where a
    /// motion is rigid.
    pub fn at(&self, frequency: f64) -> Option<Vec<Vec<Complex64>>> {
        let shift = Complex64::new(0.0, frequency);
        let solved = self.decomposition.solve_shifted(shift, &self.columns)?;
        // (A − iω)y = −b.
        let along = |row: &[f64], y: &[Complex64]| {
            row.iter().zip(y).fold(Complex64::ZERO, |sum, (r, y)| sum - y * *r)
        };
        let of = |row: &Vec<f64>| solved.iter().map(|y| along(row, y)).collect();
        Some(self.outputs.iter().map(of).collect())
    }
}

#[cfg(test)]
mod tests {
    use quell_model::{Belt, LawKind};

    use super::*;

    /// One mass on a belt: H = 1/(1 − ω² + iω(2ζ + Fμ′)).
    #[test]
    fn one_mass_has_its_closed_form() {
        let law = LawKind::Stribeck.build(&[0.4, 0.2857, 0.2]).expect("valid");
        let belt = Belt::new(0.3, 1.3, 0.05, law, Vec::new()).expect("valid");
        let linear = Linearised::new(&belt.system()).expect("slides");
        let row = vec![vec![1.0]];
        let found = ReceptanceEquations::new(&linear, &linear.friction(), row.clone(), &row);
        let found = found.expect("finite").expect("a mass");
        let rate = belt.damping_rate(belt.friction().slope(0.05), belt.normal_load());
        for frequency in [0.0, 0.3, 1.0, 2.5, 40.0] {
            let exact = Complex64::new(1.0 - frequency * frequency, frequency * rate).inv();
            let value = found.at(frequency).expect("damped")[0][0];
            assert!((value - exact).norm() < 1e-14 * exact.norm(), "{frequency}: {value} {exact}");
        }
    }

    #[test]
    fn an_undamped_resonance_is_unbounded() {
        let law = LawKind::Coulomb.build(&[0.3, 0.3, 0.0]).expect("valid");
        let belt = Belt::new(0.0, 1.0, 0.05, law, Vec::new()).expect("valid");
        let linear = Linearised::new(&belt.system()).expect("slides");
        let row = vec![vec![1.0]];
        let found = ReceptanceEquations::new(&linear, &linear.friction(), row.clone(), &row);
        let found = found.expect("finite").expect("a mass");
        assert_eq!(found.at(1.0), None);
        assert!(found.at(1.0 + 1e-9).is_some());
    }
}
