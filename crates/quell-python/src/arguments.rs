//! Arguments shared by several verbs: pairs of numbers, states, ends of a range.

use pyo3::FromPyObject;
use quell::run::protocol::{numbers_of, pair_of};
use quell::run::system::start::StateNumbers;
use quell::study::{Study, SystemStudy};
use quell::{Failure, RealInterval, quantity};

/// Two numbers in the system of the study, or with units.
pub(crate) type Pair = (String, String);

/// Names of a state with their values.
pub(crate) type NamedNumbers = Vec<(String, String)>;

/// A state: displacement and velocity, or names with their values.
#[derive(FromPyObject)]
pub(crate) enum GivenState {
    /// Displacement and velocity of one mass.
    Pair(Pair),
    /// Names and values.
    Named(NamedNumbers),
}

impl GivenState {
    /// The numbers of a state of a system.
    pub(crate) fn numbers(
        &self,
        system: &SystemStudy,
        option: &'static str,
    ) -> Result<StateNumbers, Failure> {
        Ok(match self {
            Self::Named(pairs) => numbers_of(system, option, pairs)?,
            Self::Pair((x, v)) => pair_of(system, option, (x, v))?,
        })
    }
}

/// The ends of a range of a parameter, in the unit of its key.
pub(crate) fn ends(
    study: &Study,
    parameter: &str,
    (from, to): &Pair,
) -> Result<RealInterval, Failure> {
    let from = quantity::value_of(Some(study), from, parameter, "--from")?;
    let to = quantity::value_of(Some(study), to, parameter, "--to")?;
    Ok(RealInterval::new(from, to))
}
