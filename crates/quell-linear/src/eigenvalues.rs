//! Eigenvalues of small motions about steady sliding, without dither.
//!
//! Growth rates carry a bound on what rounding can have done (condition × backward error, at least `FLOOR`): whole lines of
//! a map can be marginal (a disc at ξ = 0), where a bare sign would be noise.

use num_complex::Complex64;
use quell_numerics::eigen::{Decomposition, EigenError};

use crate::growth::Growth;
use crate::linearised::Linearised;

/// Least error bound: assembling the matrix rounds its entries too.
const FLOOR: f64 = 1e-14;

/// Largest growth rate under the friction of each contact as given: a row of a map shares the linearisation.
///
/// # Errors
/// [`EigenError`] where parameters are so large that the matrix overflows.
pub fn growth(linear: &Linearised, friction: &[f64]) -> Result<Growth, EigenError> {
    let decomposition = Decomposition::new(&linear.state_matrix(friction))?;
    // A structure has at least one coordinate, so there is an eigenvalue.
    let rightmost = decomposition.rightmost().ok_or(EigenError::NotConverged)?;
    Ok(Growth {
        rate: rightmost.value.re,
        error: rightmost.error + FLOOR,
        frequency: rightmost.value.im,
    })
}

/// Every motion that grows by more than its error, the fastest first.
///
/// # Errors
/// As [`growth`].
pub fn growing(linear: &Linearised, friction: &[f64]) -> Result<Vec<Growth>, EigenError> {
    let decomposition = Decomposition::new(&linear.state_matrix(friction))?;
    let found = decomposition.in_right_half_plane().into_iter().map(|found| Growth {
        rate: found.value.re,
        error: found.error + FLOOR,
        frequency: found.value.im,
    });
    Ok(found.filter(|growth| growth.rate > growth.error).collect())
}

/// All eigenvalues, sorted by frequency and then by growth rate: one column of a Campbell diagram.
///
/// # Errors
/// As [`growth`].
pub fn all(linear: &Linearised, friction: &[f64]) -> Result<Vec<Complex64>, EigenError> {
    let mut values = quell_numerics::eigen::eigenvalues(&linear.state_matrix(friction))?;
    values.sort_by(|a, b| a.im.total_cmp(&b.im).then(a.re.total_cmp(&b.re)));
    Ok(values)
}
