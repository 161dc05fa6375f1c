//! The disc linearised: the equations of motion are those of any structure with contacts
//! ([`Disc::system_of`](quell_model::Disc::system_of) says which).

use quell_linear::linearised::Linearised;
use quell_model::Disc;
use quell_model::disc::Contributions;
use quell_numerics::eigen::EigenError;

/// Small motions of a disc, some contributions switched off. Steady sliding is the flat disc, y = 0.
///
/// # Errors
/// [`EigenError::NotFinite`] where parameters are so large that the mass matrix cannot be inverted.
pub fn linearised(disc: &Disc, parts: Contributions) -> Result<Linearised, EigenError> {
    Linearised::new(&disc.system_of(parts)).map_err(|_| EigenError::NotFinite)
}
