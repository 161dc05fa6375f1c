//! Laws defined by numbers alone, and the relations that the numbers must satisfy.

use super::law::{LawParameters, SlidingLaw};
use crate::parameter::Parameter;
use crate::{Invalid, InvalidValues};

/// A law defined by numbers alone.
pub trait NumericLaw: SlidingLaw {
    /// From values in the order of `PARAMETERS`.
    ///
    /// # Errors
    /// Every value out of its bounds, and every relation that does not hold.
    fn from_values(values: &[f64]) -> Result<Self, InvalidValues>;
}

/// `get` of a law defined by numbers.
pub(super) fn number_of<L: NumericLaw>(law: &L, path: &str) -> Option<f64> {
    let index = L::PARAMETERS.iter().position(|parameter| parameter.path == path)?;
    law.values().get(index).copied()
}

/// `with` of a law defined by numbers.
pub(super) fn with_number<L: NumericLaw>(
    law: &L,
    path: &str,
    value: f64,
) -> Result<L, InvalidValues> {
    let index = L::PARAMETERS.iter().position(|parameter| parameter.path == path);
    let index = index.ok_or_else(|| not_a_number_of::<L>(path, value))?;
    let mut values = law.values();
    values[index] = value;
    L::from_values(&values)
}

/// The error for a path that a law does not have.
pub(super) fn not_a_number_of<L: LawParameters>(path: &str, value: f64) -> InvalidValues {
    InvalidValues::from(Invalid::new(
        path,
        value,
        format!("a parameter of the law \"{}\"", L::NAME),
    ))
}

/// Checks values against their parameters and against `relation`, which returns an error only if
/// the values it relates are themselves valid.
pub(super) fn checked(
    parameters: &[Parameter],
    values: &[f64],
    relation: impl FnOnce() -> Option<Invalid>,
) -> Result<(), InvalidValues> {
    if values.len() != parameters.len() {
        let allowed = format!("as many values as the law has parameters ({})", parameters.len());
        return Err(InvalidValues::from(Invalid::new("friction", values.len(), allowed)));
    }
    let complaints: Vec<_> = parameters
        .iter()
        .zip(values)
        .filter_map(|(parameter, &value)| parameter.check(value).err())
        .chain(relation())
        .collect();
    if complaints.is_empty() { Ok(()) } else { Err(InvalidValues::of(complaints)) }
}

/// μ_s ≥ μ_d, required by the laws with a sliding coefficient.
pub(super) fn static_at_least_sliding(
    coefficient: f64,
    static_coefficient: f64,
) -> Option<Invalid> {
    use crate::parameter::{COEFFICIENT, STATIC_COEFFICIENT};
    let judged = COEFFICIENT.bounds.contains(coefficient)
        && STATIC_COEFFICIENT.bounds.contains(static_coefficient);
    (judged && static_coefficient < coefficient).then(|| {
        let allowed = format!("at least friction.coefficient = {coefficient}");
        Invalid::new(STATIC_COEFFICIENT.path, static_coefficient, allowed)
    })
}

/// μ_m ≤ μ_s, required by the laws of the dissertation.
pub(super) fn minimum_at_most_static(
    static_coefficient: f64,
    minimum_coefficient: f64,
) -> Option<Invalid> {
    use crate::parameter::{MINIMUM_COEFFICIENT, STATIC_COEFFICIENT};
    let judged = STATIC_COEFFICIENT.bounds.contains(static_coefficient)
        && MINIMUM_COEFFICIENT.bounds.contains(minimum_coefficient);
    (judged && minimum_coefficient > static_coefficient).then(|| {
        Invalid::new(
            MINIMUM_COEFFICIENT.path,
            minimum_coefficient,
            format!("at most friction.static_coefficient = {static_coefficient}"),
        )
    })
}
