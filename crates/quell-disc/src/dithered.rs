//! Stability with dither: Floquet exponents (sections 5.4 and 5.5), f(τ) = f(1 + α cos Rτ) or f α cos Rτ.
//! Other waveforms take the place of the cosine. Each load may have
//! a phase of its own, cos(Rτ + φ_l), which the dissertation does not have: under one load it only shifts the time.

use quell_linear::floquet::{FollowerDither, NotFollowerDither};
use quell_linear::growth::Growth;
use quell_linear::linearised::Linearised;
use quell_model::Disc;
use quell_model::disc::Contributions;
use quell_numerics::eigen::EigenError;
use quell_numerics::floquet::Effort;

use crate::undithered;

/// Prepares a disc whose friction is dithered for any factor on the friction of its loads; `None` without dither.
///
/// # Errors
/// [`NotFollowerDither`] where the exponents do not describe this disc, or its parameters are so large that the matrix overflows.
pub fn prepared(disc: &Disc) -> Result<Option<FollowerDither>, NotFollowerDither> {
    prepared_with(disc, Contributions::ALL)
}

/// The same with some contributions switched off.
///
/// # Errors
/// As [`prepared`].
pub fn prepared_with(
    disc: &Disc,
    parts: Contributions,
) -> Result<Option<FollowerDither>, NotFollowerDither> {
    let Some(frequency) = disc.dither().frequency_ratio() else { return Ok(None) };
    let system = disc.system_of(parts);
    let linear = Linearised::new(&system).map_err(|_| EigenError::NotFinite)?;
    FollowerDither::new(&system, &linear, frequency).map(Some)
}

/// Largest growth rate of a disc, dithered or not.
///
/// # Errors
/// As [`prepared`].
pub fn growth(disc: &Disc, effort: Effort) -> Result<Growth, NotFollowerDither> {
    Ok(match prepared(disc)? {
        Some(dithered) => dithered.growth(1.0, effort)?,
        None => undithered::growth(disc)?,
    })
}
