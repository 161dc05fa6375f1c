//! Fixed points of maps that depend on parameters: computed by shooting, continued by pseudo-arclength, with the
//! thresholds at which their stability changes, and curves of such thresholds in two parameters.
//!
//! A system implements [`PeriodMap`]: the state after one period, its derivative, and the signature of the events during the
//! period. The number of masses and contacts, and the integration of their impacts, sticks and slips, are up to the system:
//! the derivative includes saltation matrices, and periods with different events have different signatures.
//!
//! * [`shooting`]: Newton's method for a fixed point, which reports where and why it stopped;
//! * [`branch`]: a branch of fixed points in one parameter, around folds and through borders of signatures;
//! * [`threshold`]: the test functions of a fold, a flip, a Neimark–Sacker bifurcation and a grazing bifurcation;
//! * [`criticality`]: whether a bifurcation is supercritical or subcritical;
//! * [`fold`]: on which side of a fold two fixed points exist;
//! * [`curve`]: the curve of a threshold in two parameters;
//! * [`sensitivity`]: derivatives of a threshold with respect to other parameters.
//!
//! Lengths along a branch are measured in scaled coordinates: the state in units of [`PeriodMap::scale`], each parameter in
//! units of the width of its window.
//!
//! References: H. B. Keller, *Lectures on Numerical Methods in Bifurcation Problems* (1987), for the bordered
//! systems; Yu. A. Kuznetsov, *Elements of Applied Bifurcation Theory* (3rd ed. 2004), ch. 4, 5 and 10, for the test
//! functions; M. di Bernardo et al., *Piecewise-smooth Dynamical Systems* (2008), for borders of signatures.

mod arc;
pub mod branch;
pub mod criticality;
pub mod curve;
pub mod fold;
pub mod sensitivity;
pub mod shooting;
pub mod threshold;

use std::fmt::Debug;

use num_complex::Complex64;

use crate::polar::modulus;

use crate::eigen::eigenvalues;

use crate::matrix::Matrix;
use crate::order::descending_by;

/// A map of the state over one period, which depends on parameters.
pub trait PeriodMap {
    /// The sequence of events during a period. Where the signature is constant, the image depends smoothly on state and
    /// parameters.
    type Signature: Clone + PartialEq + Debug;
    /// The reason why an image does not exist.
    type Error: Clone + Debug;

    /// Number of entries of a state.
    fn dimension(&self) -> usize;

    /// Typical size of the entries of a state, used for tolerances; above zero.
    fn scale(&self) -> f64;

    /// The image of a state.
    ///
    /// `held` is a signature whose smooth piece is to be extended beyond its border if the map supports that;
    /// otherwise the map returns the actual image with its own signature.
    ///
    /// # Errors
    /// Where there is no image: invalid parameters, or an integration that stopped.
    fn image(
        &self,
        state: &[f64],
        parameters: &[f64],
        held: Option<&Self::Signature>,
    ) -> Result<Image<Self::Signature>, Self::Error>;

    /// The state of [`PeriodMap::image`] alone, for differences with respect to parameters: a map whose derivative costs more than its
    /// state computes it without.
    ///
    /// # Errors
    /// As [`PeriodMap::image`].
    fn image_state(
        &self,
        state: &[f64],
        parameters: &[f64],
        held: Option<&Self::Signature>,
    ) -> Result<Vec<f64>, Self::Error> {
        self.image(state, parameters, held).map(|image| image.state)
    }

    /// Signatures with fewer events whose pieces [`PeriodMap::image`] extends beyond their borders: those that a motion with this
    /// signature may have beyond a grazing. None by default.
    fn smoother(&self, _signature: &Self::Signature, _parameters: &[f64]) -> Vec<Self::Signature> {
        Vec::new()
    }
}

/// The image of a state after a period.
#[derive(Clone, Debug)]
pub struct Image<S> {
    /// The state after the period.
    pub state: Vec<f64>,
    /// Its derivative with respect to the initial state, including saltation at events.
    pub derivative: Matrix,
    /// Distance from the border of the signature: positive inside, zero at grazing, negative on an
    /// extension beyond it; infinite where the map does not define it.
    pub distance: f64,
    /// The events during the period.
    pub signature: S,
}

/// Eigenvalues of a real matrix, the largest modulus first; `None` if they cannot be computed.
pub fn multipliers(derivative: &Matrix) -> Option<Vec<Complex64>> {
    let mut found = match derivative.rows() {
        1 => vec![Complex64::new(derivative[(0, 0)], 0.0)],
        2 => {
            let entry = |i, j| derivative[(i, j)];
            of_two(entry(0, 0), entry(0, 1), entry(1, 0), entry(1, 1)).to_vec()
        }
        _ => eigenvalues(derivative).ok()?,
    };
    if found.iter().any(|z| !z.re.is_finite() || !z.im.is_finite()) {
        return None;
    }
    descending_by(&mut found, |a| modulus(*a));
    Some(found)
}

/// Eigenvalues of ((a, b), (c, d)), the larger modulus first; for a complex pair, the one in the upper half plane first.
fn of_two(a: f64, b: f64, c: f64, d: f64) -> [Complex64; 2] {
    let half = 0.5 * (a + d);
    let determinant = a * d - b * c;
    let discriminant = 0.25 * (a - d) * (a - d) + b * c;
    if discriminant < 0.0 {
        let im = libm::sqrt(-discriminant);
        return [Complex64::new(half, im), Complex64::new(half, -im)];
    }
    let large = half + libm::copysign(libm::sqrt(discriminant), half);
    // The smaller one follows from the product, without cancellation.
    let small = if large == 0.0 { 0.0 } else { determinant / large };
    [Complex64::new(large, 0.0), Complex64::new(small, 0.0)]
}

/// Largest modulus of multipliers sorted by modulus; 0 for an empty list.
pub fn spectral_radius(multipliers: &[Complex64]) -> f64 {
    multipliers.first().map_or(0.0, |&z| modulus(z))
}

/// Number of multipliers outside the unit circle.
pub fn unstable(multipliers: &[Complex64]) -> usize {
    multipliers.iter().filter(|&&z| modulus(z) > 1.0).count()
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
                let off = general.iter().map(|z| (z - value).norm()).fold(f64::INFINITY, f64::min);
                assert!(off < 1e-14, "{matrix:?}: {off}");
            }
        }
    }
}
