//! Whether the bifurcation at a threshold is supercritical, and to which side a fold opens, in JSON and in sentences.

use std::fmt::Display;

use quell_dynamics::orbit::{PointForm, ThresholdKind};
use quell_linear::steady::NoSteadySliding;
use quell_model::RefusedNumbers;
use quell_numerics::continuation::criticality::{Criticality, FirstLyapunov, NoFirstLyapunov};
use quell_numerics::continuation::fold::{FoldCoefficient, FoldOpening};
use serde_json::Value as Json;

use crate::fields::Fields;
use crate::reasons::reasons;

reasons! {
    /// Why the first Lyapunov coefficient of a threshold is unknown.
    pub enum NoLyapunovCoefficient {
        /// The coefficient has no value.
        NoValue(NoFirstLyapunov),
        /// There is no study with the numbers of the threshold.
        Refused(RefusedNumbers),
        /// There is no steady sliding.
        NoSliding(NoSteadySliding),
        ;
        /// The motion is averaged.
        OfAverage =>
            "not computed for averaged motion: `thresholds` gives that of the dithered response",
    }
}

reasons! {
    /// Why the criticality of a threshold is unknown.
    pub enum NoCriticality {
        /// The coefficient is unknown.
        NoCoefficient(NoLyapunovCoefficient),
        ;
        /// The sign of the coefficient is unknown.
        Degenerate =>
            "the coefficient is zero within its error: the bifurcation is degenerate, and neither supercritical nor subcritical could be \
             decided",
    }
}

reasons! {
    /// Why the side to which a threshold opens is unknown.
    pub enum NoFoldOpening {
        /// The coefficient of the fold is unknown.
        NoCoefficient(NoFirstLyapunov),
        ;
        /// The threshold is of another kind.
        NotFold => "two solutions exist on one side only of a fold",
        /// The parameter does not move the branch.
        Unmoved => "the parameter does not move the branch there",
        /// The sign of the coefficient is unknown.
        Degenerate => "the quadratic coefficient is zero within its error, as at a cusp",
    }
}

/// The first Lyapunov coefficient of a threshold, or why it is unknown.
pub type FoundLyapunov = Result<FirstLyapunov, NoLyapunovCoefficient>;

/// Why a coefficient that is not finite is null.
const BEYOND: &str = "the coefficient is beyond the range of floating-point numbers";

/// What the sign of a coefficient says.
///
/// # Errors
/// Why nothing could be decided.
pub fn decided(found: &FoundLyapunov) -> Result<Criticality, NoCriticality> {
    found.clone()?.criticality().ok_or(NoCriticality::Degenerate)
}

/// A clause about a threshold after a separator and before an end; empty where nothing is decided.
pub fn clause(found: &FoundLyapunov, separator: &str, end: &str) -> String {
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

/// The coefficient of a fold; `None` for other kinds.
type FoundFold = Option<Result<FoldCoefficient, NoFirstLyapunov>>;

/// The side to which a fold opens.
///
/// # Errors
/// Why it is not known.
pub fn opening(found: &FoundFold) -> Result<FoldOpening, NoFoldOpening> {
    let found = found.ok_or(NoFoldOpening::NotFold)?.map_err(|why| match why {
        NoFirstLyapunov::Singular => NoFoldOpening::Unmoved,
        why => NoFoldOpening::NoCoefficient(why),
    })?;
    found.opening().ok_or(NoFoldOpening::Degenerate)
}

/// A clause about a fold after a separator; empty where nothing is known or the threshold is of another kind.
pub fn opening_clause(found: &FoundFold, separator: &str, parameter: &str) -> String {
    opening(found).map_or_else(
        |_| String::new(),
        |side| format!("{separator}opens towards {} {parameter}", side.name()),
    )
}

/// Adds to which side a fold opens. `value` and `length` are the units of the parameter and of displacements.
pub(super) fn put_fold(fields: &mut Fields, [value, length]: [&str; 2], found: &FoundFold) {
    let side = opening(found);
    match &side {
        Ok(side) => fields.plain("opens_towards", side.name()),
        Err(why) => fields.unknown("opens_towards", why),
    };
    let unit = match (value, length) {
        (_, "1") => value.to_owned(),
        ("1", length) => format!("1/{length}²"),
        (value, length) => format!("{value}/{length}²"),
    };
    let names = ["quadratic_coefficient", "quadratic_coefficient_error"];
    match (found, side) {
        (Some(Ok(FoldCoefficient { value, error })), _)
            if value.is_finite() && error.is_finite() =>
        {
            fields.measured(names[0], &unit, *value).measured(names[1], &unit, *error);
        }
        (_, side) => {
            let why = side.err().map_or_else(|| BEYOND.to_owned(), |why| why.to_string());
            for name in names {
                fields.unknown(name, &why);
            }
        }
    }
}

/// Adds the forms of the points of a curve of one kind, in columns: a word, or `null` with its reason in the column of reasons.
pub(super) fn put_columns(fields: &mut Fields, kind: ThresholdKind, forms: &[PointForm]) {
    let lyapunov = |form: &PointForm| form.first_lyapunov.map_err(NoLyapunovCoefficient::from);
    let coefficients: Vec<_> = forms.iter().map(lyapunov).collect();
    put_criticalities(fields, &coefficients);
    if kind == ThresholdKind::Fold {
        let sides = forms.iter().map(|form| opening(&form.fold).map(FoldOpening::name));
        put_words(fields, "opens_towards", &sides.collect::<Vec<_>>());
    }
}

/// Adds the criticality of the points of a curve, likewise.
pub(super) fn put_criticalities(fields: &mut Fields, found: &[FoundLyapunov]) {
    let words = found.iter().map(|found| decided(found).map(Criticality::name));
    put_words(fields, "criticality", &words.collect::<Vec<_>>());
    let value = |found: &FoundLyapunov| match found {
        Ok(found) if found.value.is_finite() => Json::from(found.value),
        _ => Json::Null,
    };
    let values: Vec<Json> = found.iter().map(value).collect();
    let name = "first_lyapunov_coefficient";
    if values.iter().any(Json::is_null) {
        fields.why(name, "criticality_reason has the reason at each point");
    }
    fields.plain(name, values);
}

fn put_words(fields: &mut Fields, name: &str, found: &[Result<&'static str, impl Display>]) {
    let words: Vec<Json> =
        found.iter().map(|word| word.as_ref().map_or(Json::Null, |word| (*word).into())).collect();
    let reasons: Vec<Json> = found
        .iter()
        .map(|word| word.as_ref().err().map_or(Json::Null, |why| why.to_string().into()))
        .collect();
    let of_reasons = format!("{name}_reason");
    if words.iter().any(Json::is_null) {
        fields.why(name, format!("{of_reasons} has the reason at each point"));
    }
    if reasons.iter().any(Json::is_null) {
        fields.why(&of_reasons, format!("{name} is known there"));
    }
    fields.plain(name, words).plain(&of_reasons, reasons);
}

/// Adds the fields of a threshold. `length` is the unit of displacements.
pub(super) fn put(fields: &mut Fields, length: &str, found: &FoundLyapunov) {
    match decided(found) {
        Ok(criticality) => {
            fields
                .plain("criticality", criticality.name())
                .plain("criticality_reason", serde_json::Value::Null);
        }
        Err(why) => {
            fields.unknown("criticality", &why).plain("criticality_reason", why.to_string());
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
                fields.unknown(name, BEYOND);
            }
        }
        Err(why) => {
            for name in names {
                fields.unknown(name, why);
            }
        }
    }
}
