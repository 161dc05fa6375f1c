//! A kind of system with its parameters: the paths of a study file, and the system they describe.

use crate::InvalidValues;
use crate::parameter::Parameter;
use crate::system::System;

/// A system described by named numbers, valid as a whole: a belt by ζ, F and v₀, a disc by modes and loads.
///
/// Sweeps, `--set` and continuation reach every number by its path; engines that are not written for one kind take the
/// [`System`].
///
/// ```
/// use quell_model::{Belt, LawKind, Parametrisation};
///
/// let law = LawKind::Stribeck.build(&[0.4, 0.2857, 0.2])?;
/// let belt = Belt::new(0.005, 1.0, 0.05, law, Vec::new())?;
/// let faster = belt.with("belt.belt_velocity", 0.1)?;
/// assert_eq!(faster.get("belt.belt_velocity"), Some(0.1));
/// assert_eq!(faster.system().contacts[0].surface_velocity.mean(), 0.1);
/// # Ok::<(), quell_model::InvalidValues>(())
/// ```
pub trait Parametrisation: Clone {
    /// The entry of the registry for a path; `None` if there is no such number here, or if the study defines it (a
    /// constant of a formula).
    fn parameter(&self, path: &str) -> Option<Parameter>;

    /// The value of a parameter by its path, such as `friction.static_coefficient` or `dither[1].amplitude`; `None` if
    /// there is no such number here.
    fn get(&self, path: &str) -> Option<f64>;

    /// The same system with one parameter changed.
    ///
    /// # Errors
    /// An unknown path, a value out of bounds, a violated relation.
    fn with(&self, path: &str, value: f64) -> Result<Self, InvalidValues>;

    /// The SI value of one unit of the parameter at `path`; `None` if the study does not give the scales.
    fn si_per_unit(&self, path: &str) -> Option<f64>;

    /// The structure, contacts and inputs that these numbers describe.
    fn system(&self) -> System;
}
