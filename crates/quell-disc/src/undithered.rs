//! Stability without dither: eigenvalues of the state matrix, in the frame of the loads (section 5.3).

use num_complex::Complex64;
use quell_linear::eigenvalues as linear;
use quell_linear::growth::Growth;
use quell_linear::linearised::Linearised;
use quell_model::Disc;
use quell_model::disc::Contributions;
use quell_numerics::eigen::EigenError;

use crate::equations::linearised;

/// Largest growth rate of a disc, its dither left out.
///
/// # Errors
/// [`EigenError`] where parameters are so large that the matrix overflows.
pub fn growth(disc: &Disc) -> Result<Growth, EigenError> {
    growth_with(disc, Contributions::ALL)
}

/// Largest growth rate with some contributions switched off.
///
/// # Errors
/// As [`growth`].
pub fn growth_with(disc: &Disc, parts: Contributions) -> Result<Growth, EigenError> {
    let equations = undithered(disc, parts)?;
    linear::growth(&equations, &equations.mean_friction())
}

/// Every motion that grows by more than its error, the disc's dither left out and some contributions switched off, the
/// fastest first.
///
/// # Errors
/// As [`growth`].
pub fn growing_with(disc: &Disc, parts: Contributions) -> Result<Vec<Growth>, EigenError> {
    let equations = undithered(disc, parts)?;
    linear::growing(&equations, &equations.mean_friction())
}

/// All eigenvalues of a disc, its dither left out, sorted by frequency and then by growth rate: one
/// column of a Campbell diagram.
///
/// # Errors
/// As [`growth`].
pub fn eigenvalues(disc: &Disc) -> Result<Vec<Complex64>, EigenError> {
    let equations = undithered(disc, Contributions::ALL)?;
    linear::all(&equations, &equations.mean_friction())
}

/// Campbell diagram: the eigenvalues (as [`eigenvalues`]) at each speed.
///
/// # Errors
/// As [`growth`]; a speed out of bounds gives [`EigenError::NotFinite`].
pub fn campbell(disc: &Disc, speeds: &[f64]) -> Result<Vec<Vec<Complex64>>, EigenError> {
    speeds
        .iter()
        .map(|&speed| {
            let disc = disc.at_speed(speed).map_err(|_| EigenError::NotFinite)?;
            eigenvalues(&disc)
        })
        .collect()
}

/// The equations with f(τ) = f.
fn undithered(disc: &Disc, parts: Contributions) -> Result<Linearised, EigenError> {
    linearised(&disc.undithered(), parts)
}
