//! A family of state matrices over a parameter, and its eigenvalues at one value.

use num_complex::Complex64;
use quell_numerics::eigen::{Decomposition, EigenError};
use quell_numerics::matrix::Matrix;

use crate::growth::Growth;
use crate::spectrum::growth_of;

/// A family of state matrices, one for each value of a parameter.
pub trait Family {
    /// Why there is no matrix at a value.
    type Error: Clone;

    /// The state matrix at a value of the parameter.
    ///
    /// # Errors
    /// Why no matrix exists, such as the lack of steady sliding.
    fn matrix(&self, value: f64) -> Result<Matrix, Self::Error>;

    /// The error of a matrix whose eigenvalues cannot be computed.
    fn overflows(why: EigenError) -> Self::Error;

    /// The values in the window at which no matrix exists although it does next to them, such as those at which the velocity of a
    /// surface changes its sign, ascending, and why. A value at which this is not known may be passed over. None by default.
    fn gaps(&self) -> Vec<(f64, Self::Error)> {
        Vec::new()
    }
}

/// Eigenvalues at one value of the parameter, in the order of the branches.
#[derive(Clone, Debug, PartialEq)]
pub struct TrackedPoint {
    /// Value of the parameter.
    pub value: f64,
    /// Eigenvalues; entry b belongs to branch b of the piece.
    pub eigenvalues: Vec<Complex64>,
    /// Largest growth rate with its bound.
    pub growth: Growth,
}

/// Eigenvalues at a value, in any order.
pub(super) fn at<F: Family>(family: &F, value: f64) -> Result<TrackedPoint, F::Error> {
    let decomposition = Decomposition::new(&family.matrix(value)?).map_err(F::overflows)?;
    let growth = growth_of(&decomposition).map_err(F::overflows)?;
    Ok(TrackedPoint { value, eigenvalues: decomposition.values().to_vec(), growth })
}
