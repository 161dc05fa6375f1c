//! Attractors in outcomes: their names in JSON and in sentences, for `bifurcation` and `basins`.

use quell_dynamics::attractor::{Attractor, AttractorKind, AttractorSettings};
use quell_dynamics::orbit::{NoOrbit, OrbitVerdict};
use quell_model::Belt;
use quell_model::units::{Quantity, Scales};
use serde_json::{Value as Json, json};

use super::failed;
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::fields::Fields;
use crate::study::BeltStudy;
use crate::words::{digits, in_scales, plural};

/// The belt with its stroboscopic section and its base response.
pub(super) fn settings(belt: &Belt) -> Result<AttractorSettings<'_>, Failure> {
    AttractorSettings::new(belt).map_err(refused)
}

/// The failure that reports why no orbit was found.
pub(super) fn refused(why: NoOrbit) -> Failure {
    let key = match why {
        NoOrbit::NoDither => "dither",
        NoOrbit::Incommensurate => {
            return Failure::Failed { key: "dither".to_owned(), why: why.to_string() };
        }
        NoOrbit::NotConverged { .. }
        | NoOrbit::Degenerate { .. }
        | NoOrbit::Another { .. }
        | NoOrbit::Ends { .. }
        | NoOrbit::LostOnTheWay { .. }
        | NoOrbit::NoPeriod { .. }
        | NoOrbit::AtRest
        | NoOrbit::Unsettled(_)
        | NoOrbit::NoLimit
        | NoOrbit::NoMirror
        | NoOrbit::Invalid { .. } => {
            return Failure::Failed { key: "orbit".to_owned(), why: why.to_string() };
        }
        NoOrbit::Stalled(stalled) => return failed(stalled),
    };
    Complaint::new(Fault::Value, key, Origin::Whole, Json::Null, why.to_string()).into()
}

/// The attractor as text: its kind and its slow frequency.
pub fn words(scales: Option<Scales>, attractor: &Attractor, period: f64) -> String {
    let frequency = attractor.frequency(period).map_or_else(String::new, |frequency| {
        let unit = if scales.is_some() { "" } else { " ω₀" };
        format!(", slow frequency {}{unit}", in_scales(scales, Quantity::FrequencyRatio, frequency))
    });
    let ratio = attractor.rotation.and_then(|rotation| rotation.ratio);
    match (attractor.kind, ratio) {
        (AttractorKind::Periodic { periods: 1, .. }, _) if attractor.size() == 0.0 => {
            "steady sliding".to_owned()
        }
        (AttractorKind::Periodic { periods: 1, .. }, _) if attractor.base => {
            "base response (period 1)".to_owned()
        }
        (AttractorKind::Periodic { periods: 1, .. }, _) => "another period-1 response".to_owned(),
        (AttractorKind::Periodic { periods, .. }, Some(ratio)) => {
            let closed = if periods == ratio.periods {
                String::new()
            } else {
                format!(", repeating after {periods}")
            };
            format!(
                "locked: {} slow cycle{} in {} period{}{closed}{frequency}",
                ratio.turns,
                plural(ratio.turns),
                ratio.periods,
                plural(ratio.periods)
            )
        }
        (kind, _) => format!("{}{frequency}", kind.words()),
    }
}

/// Adds the fields of an attractor to an object.
pub(super) fn put(fields: &mut Fields, attractor: &Attractor, period: f64) {
    let not_turning = || "a period-1 response has no slow rotation".to_owned();
    let rotation = attractor.rotation;
    let (kind, periods, radius) = match attractor.kind {
        AttractorKind::Periodic { periods: 1, radius } => {
            ("period-1", Ok(f64::from(1)), Ok(radius))
        }
        AttractorKind::Periodic { periods, radius } => {
            ("locked", Ok(f64::from(periods)), Ok(radius))
        }
        AttractorKind::Cycle => {
            let why = || {
                "an undithered limit cycle has its own period, not a multiple of the section's"
                    .to_owned()
            };
            ("limit-cycle", Err(why()), Err(why()))
        }
        AttractorKind::QuasiPeriodic => {
            let why = || "a quasi-periodic response has no period".to_owned();
            ("quasi-periodic", Err(why()), Err(why()))
        }
        AttractorKind::Rest => {
            let why = || "a mass at rest has no period".to_owned();
            ("rest", Err(why()), Err(why()))
        }
        AttractorKind::Unclassified => {
            let why = || "no period up to 200 and no steady rotation number was found".to_owned();
            ("unclassified", Err(why()), Err(why()))
        }
    };
    fields
        .plain("kind", kind)
        .plain("quiet", attractor.quiet)
        .plain("base_response", attractor.base)
        .known("periods", Quantity::Count, periods)
        .known("multiplier", Quantity::Ratio, radius)
        .number("displacement", Quantity::Displacement, attractor.state.displacement)
        .number("velocity", Quantity::Velocity, attractor.state.velocity)
        .number("lowest", Quantity::Displacement, attractor.lowest)
        .number("highest", Quantity::Displacement, attractor.highest)
        .number("peak_to_peak", Quantity::Displacement, attractor.size())
        .number("stick_fraction", Quantity::Ratio, attractor.stick_fraction)
        .known(
            "rotation_number",
            Quantity::Ratio,
            rotation.map(|rotation| rotation.turns_per_period).ok_or_else(not_turning),
        )
        .known(
            "rotation_error",
            Quantity::Ratio,
            rotation.map(|rotation| rotation.error).ok_or_else(not_turning),
        )
        .known(
            "frequency",
            Quantity::FrequencyRatio,
            attractor.frequency(period).ok_or_else(not_turning),
        );
    match rotation.and_then(|rotation| rotation.ratio) {
        Some(ratio) => {
            fields.plain("locking", json!({ "turns": ratio.turns, "periods": ratio.periods }));
        }
        None => {
            fields.unknown("locking", "the response is not locked");
        }
    }
}

/// The section of an attractor as two arrays.
pub(super) fn put_section(fields: &mut Fields, attractor: &Attractor) {
    let (x, v): (Vec<f64>, Vec<f64>) = attractor.section.iter().copied().unzip();
    fields.numbers("section_displacement", Quantity::Displacement, &x).numbers(
        "section_velocity",
        Quantity::Velocity,
        &v,
    );
}

/// Why the base response is unknown, as text.
pub(in crate::run) fn unknown(why: &NoOrbit) -> String {
    match why {
        NoOrbit::Ends { share } => {
            format!(
                "the base response ends at {} % of the dither's amplitude",
                digits(100.0 * share)
            )
        }
        NoOrbit::LostOnTheWay { share } => format!(
            "the base response could not be followed beyond {} % of the dither's amplitude",
            digits(100.0 * share)
        ),
        why => format!("the base response was not found: {why}"),
    }
}

/// A number of the study as text.
pub(super) fn number(study: &BeltStudy, unit: &str, value: f64) -> String {
    let text = digits(value);
    if study.scales().is_some() && !unit.starts_with('1') { format!("{text} {unit}") } else { text }
}

/// Words of the column `local_verdict`.
pub(super) const VERDICTS: [(u8, &str); 4] =
    [(0, "stable"), (1, "unstable"), (2, "undecided"), (3, "unknown")];

/// Code of the column `local_verdict`.
pub(super) fn verdict_code(local: &Result<OrbitVerdict, String>) -> u8 {
    match local {
        Ok(OrbitVerdict::Stable) => 0,
        Ok(OrbitVerdict::Unstable) => 1,
        Ok(OrbitVerdict::Undecided) => 2,
        Err(_) => 3,
    }
}
