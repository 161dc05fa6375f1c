//! Whether the bifurcation at a threshold is supercritical, in JSON and in sentences.

use quell_numerics::continuation::criticality::{Criticality, FirstLyapunov};

use crate::fields::Fields;

/// Why the sign of a coefficient is not known.
const DEGENERATE: &str = "the coefficient is zero within its error: the bifurcation is degenerate, and neither supercritical nor \
                          subcritical could be decided";

/// What the sign of a coefficient says.
///
/// # Errors
/// Why nothing could be decided.
pub fn decided(found: &Result<FirstLyapunov, String>) -> Result<Criticality, String> {
    found.clone()?.criticality().ok_or_else(|| DEGENERATE.to_owned())
}

/// A clause about a threshold after a separator and before an end; empty where nothing is decided.
pub fn clause(found: &Result<FirstLyapunov, String>, separator: &str, end: &str) -> String {
    decided(found)
        .map_or_else(|_| String::new(), |found| format!("{separator}{}{end}", words(found)))
}

/// What it means for the motion beyond the threshold.
pub fn words(criticality: Criticality) -> &'static str {
    match criticality {
        Criticality::Supercritical => "supercritical: the vibration grows from zero",
        Criticality::Subcritical => "subcritical: the motion jumps",
    }
}

/// Adds the fields of a threshold. `length` is the unit of displacements.
pub(super) fn put(fields: &mut Fields, length: &str, found: &Result<FirstLyapunov, String>) {
    match decided(found) {
        Ok(criticality) => {
            fields
                .plain("criticality", criticality.name())
                .plain("criticality_reason", serde_json::Value::Null);
        }
        Err(why) => {
            fields.unknown("criticality", why.clone()).plain("criticality_reason", why);
        }
    }
    let unit = if length == "1" { length.to_owned() } else { format!("1/{length}²") };
    let names = ["first_lyapunov_coefficient", "first_lyapunov_coefficient_error"];
    match found {
        Ok(FirstLyapunov { value, error }) if value.is_finite() && error.is_finite() => {
            fields.measured(names[0], &unit, *value).measured(names[1], &unit, *error);
        }
        Ok(_) => {
            for name in names {
                fields
                    .unknown(name, "the coefficient is beyond the range of floating-point numbers");
            }
        }
        Err(why) => {
            for name in names {
                fields.unknown(name, why.clone());
            }
        }
    }
}
