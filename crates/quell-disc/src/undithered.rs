//! Stability without dither: eigenvalues of the state matrix, in the frame of the loads (section 5.3).
//!
//! Growth rates carry a bound on what rounding can have done (condition × backward error, at least `FLOOR`); at
//! ξ = 0 whole lines of the map are marginal, where a bare sign would be noise.

use num_complex::Complex64;
use quell_numerics::eigen::{Decomposition, EigenError};

use crate::equations::System;
use quell_linear::growth::Growth;
use quell_model::Disc;
use quell_model::disc::Contributions;

/// Least error bound: assembling the matrix rounds its entries too.
const FLOOR: f64 = 1e-14;

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
    let system = undithered(disc, parts);
    growth_of(&system, system.mean_friction())
}

/// Largest growth rate of an assembled system with the friction of each load as given: a row of a map shares
/// the assembly.
///
/// # Errors
/// As [`growth`].
pub fn growth_of(system: &System, friction: &[f64]) -> Result<Growth, EigenError> {
    let decomposition = Decomposition::new(&system.state_matrix(friction))?;
    // A disc has at least one mode, so there is an eigenvalue.
    let rightmost = decomposition.rightmost().ok_or(EigenError::NotConverged)?;
    Ok(Growth {
        rate: rightmost.value.re,
        error: rightmost.error + FLOOR,
        frequency: rightmost.value.im,
    })
}

/// Every motion that grows by more than its error, the disc's dither left out and some contributions switched off, the fastest
/// first.
///
/// # Errors
/// As [`growth`].
pub fn growing_with(disc: &Disc, parts: Contributions) -> Result<Vec<Growth>, EigenError> {
    let system = undithered(disc, parts);
    let decomposition = Decomposition::new(&system.state_matrix(system.mean_friction()))?;
    let found = decomposition.in_right_half_plane().into_iter().map(|found| Growth {
        rate: found.value.re,
        error: found.error + FLOOR,
        frequency: found.value.im,
    });
    Ok(found.filter(|growth| growth.rate > growth.error).collect())
}

/// All eigenvalues of a disc, its dither left out, sorted by frequency and then by growth rate: one
/// column of a Campbell diagram.
///
/// # Errors
/// As [`growth`].
pub fn eigenvalues(disc: &Disc) -> Result<Vec<Complex64>, EigenError> {
    let system = undithered(disc, Contributions::ALL);
    let matrix = system.state_matrix(system.mean_friction());
    let mut values = quell_numerics::eigen::eigenvalues(&matrix)?;
    values.sort_by(|a, b| a.im.total_cmp(&b.im).then(a.re.total_cmp(&b.re)));
    Ok(values)
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

/// The system with f(τ) = f.
fn undithered(disc: &Disc, parts: Contributions) -> System {
    System::assemble(&disc.undithered(), parts)
}
