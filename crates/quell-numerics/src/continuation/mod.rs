//! Fixed points of maps that depend on parameters: found by shooting, followed by pseudo-arclength, with the
//! thresholds at which their stability changes, and curves of such thresholds in two parameters.
//!
//! A system enters by [`PeriodMap`]: where a state comes to after a period, the derivative of that, and what happens on the
//! way. How many masses and contacts it has, and how their impacts, sticks and slips are integrated, is its own affair:
//! a saltation matrix is part of the derivative, and two periods with other events have other signatures.
//!
//! * [`shooting`]: Newton's method for a fixed point, which says where it stopped and why;
//! * [`branch`]: a branch of fixed points in one parameter, around folds and through borders of signatures;
//! * [`threshold`]: what is zero at a fold, a flip, a Neimark–Sacker bifurcation, a touch;
//! * [`curve`]: the curve of a threshold in two parameters.
//!
//! Lengths along a branch are counted in scaled coordinates: the state in [`PeriodMap::scale`], each parameter in the width of
//! its window.
//!
//! References: H. B. Keller, *Lectures on Numerical Methods in Bifurcation Problems* (1987), for the bordered
//! systems; Yu. A. Kuznetsov, *Elements of Applied Bifurcation Theory* (3rd ed. 2004), ch. 4, 5 and 10, for the test
//! functions; M. di Bernardo et al., *Piecewise-smooth Dynamical Systems* (2008), for borders of signatures.

mod arc;
pub mod branch;
pub mod curve;
pub mod shooting;
pub mod threshold;

use std::fmt::Debug;

use num_complex::Complex64;

use crate::eigen::eigenvalues;
pub use crate::eigen::modulus;
use crate::matrix::Matrix;

/// A map of a state over one period, which depends on parameters.
pub trait PeriodMap {
    /// What happens along a period. States of one signature have images that depend smoothly on state and parameters.
    type Signature: Clone + PartialEq + Debug;
    /// Why there is no image.
    type Error: Clone + Debug;

    /// Length of a state.
    fn dimension(&self) -> usize;

    /// Size of the entries of a state by which closeness is judged, above zero.
    fn scale(&self) -> f64;

    /// The image of a state.
    ///
    /// `held` is a signature whose smooth piece is to be continued beyond its border where the family can do that;
    /// one that cannot gives the image as it is, with its own signature.
    ///
    /// # Errors
    /// Where there is no image: parameters without meaning, or an integration that stopped.
    fn image(
        &self,
        state: &[f64],
        parameters: &[f64],
        held: Option<&Self::Signature>,
    ) -> Result<Image<Self::Signature>, Self::Error>;
}

/// Where a state comes to after a period.
#[derive(Clone, Debug)]
pub struct Image<S> {
    /// The state after the period.
    pub state: Vec<f64>,
    /// Its derivative by the state before, saltation at events included.
    pub derivative: Matrix,
    /// Distance from the border of the signature: positive inside, zero at a touch, negative on a
    /// continuation beyond it; infinite where the family knows none.
    pub distance: f64,
    /// What happened.
    pub signature: S,
}

/// Eigenvalues of a real matrix, the largest modulus first; `None` where they cannot be computed.
pub fn multipliers(derivative: &Matrix) -> Option<Vec<Complex64>> {
    let mut found = match derivative.rows() {
        1 => vec![Complex64::new(derivative[(0, 0)], 0.0)],
        2 => {
            let entry = |i, j| derivative[(i, j)];
            of_two(entry(0, 0), entry(0, 1), entry(1, 0), entry(1, 1)).to_vec()
        }
        _ => eigenvalues(derivative).ok()?,
    };
    if found.iter().any(|it| !it.re.is_finite() || !it.im.is_finite()) {
        return None;
    }
    found.sort_by(|a, b| modulus(*b).total_cmp(&modulus(*a)));
    Some(found)
}

/// Eigenvalues of ((a, b), (c, d)), the larger modulus first; of a complex pair the upper one.
fn of_two(a: f64, b: f64, c: f64, d: f64) -> [Complex64; 2] {
    let half = 0.5 * (a + d);
    let determinant = a * d - b * c;
    let discriminant = 0.25 * (a - d) * (a - d) + b * c;
    if discriminant < 0.0 {
        let im = libm::sqrt(-discriminant);
        return [Complex64::new(half, im), Complex64::new(half, -im)];
    }
    let large = half + libm::copysign(libm::sqrt(discriminant), half);
    // The smaller one by the product, which does not cancel.
    let small = if large == 0.0 { 0.0 } else { determinant / large };
    [Complex64::new(large, 0.0), Complex64::new(small, 0.0)]
}

/// Largest modulus of multipliers in their order; 0 of none.
pub fn spectral_radius(multipliers: &[Complex64]) -> f64 {
    multipliers.first().map_or(0.0, |&it| modulus(it))
}

/// Number of multipliers outside the unit circle.
pub fn unstable(multipliers: &[Complex64]) -> usize {
    multipliers.iter().filter(|&&it| modulus(it) > 1.0).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_by_two_agrees_with_the_general_algorithm() {
        for (a, b, c, d) in [
            (0.3, -1.2, 0.8, 0.5),
            (2.0, 0.5, 0.25, -0.7),
            (1.0, 3.0, 0.0, 0.0),
            (0.0, 1.0, 1.0, 0.0),
        ] {
            let matrix = Matrix::from_fn(2, 2, |i, j| [[a, b], [c, d]][i][j]);
            let own = multipliers(&matrix).expect("finite");
            let general = eigenvalues(&matrix).expect("finite");
            for value in own {
                let off =
                    general.iter().map(|it| (it - value).norm()).fold(f64::INFINITY, f64::min);
                assert!(off < 1e-14, "{matrix:?}: {off}");
            }
        }
    }
}
