//! The motion on which a run of a system ends, in words and as JSON: `attractor`, `bifurcation`, `basins`, `response` and `probability`
//! report it.

use quell_dynamics::attractor::{MotionKind, SystemAttractor};
use quell_dynamics::orbit::{
    BASE_STEPS, NoOrbit, NoSlidingVerdict, base_response, sliding_verdict,
};
use quell_model::System;
use quell_model::units::Quantity;
use serde_json::json;

use super::in_units;
use crate::fields::Fields;
use crate::reasons::reasons;
use crate::study::{SystemStudy, UnitSystem};
use crate::words::{digits, plural};

reasons! {
    /// Why the local stability of a study is unknown.
    pub enum NoLocalVerdict {
        /// The base response is unknown.
        NoBaseResponse(NoOrbit),
        /// The verdict on steady sliding is unknown.
        NoSlidingVerdict(NoSlidingVerdict),
        ;
    }
}

/// Verdict on the base response of a dithered system, or on steady sliding without dither.
///
/// # Errors
/// Why it is unknown.
pub fn local_verdict(system: &System) -> Result<&'static str, NoLocalVerdict> {
    if system.is_dithered() {
        return Ok(base_response(system, BASE_STEPS)?.verdict().name());
    }
    Ok(sliding_verdict(system)?.name())
}

/// Why the observed velocity is unknown.
const WITHOUT_VELOCITY: &str = "the states of first-order equations contain no velocity";

/// Adds a state, and the observed displacement and velocity in it.
pub(in crate::run) fn put_state(fields: &mut Fields, study: &SystemStudy, state: &[f64]) {
    let observe = study.observe();
    let displacement = observe.iter().zip(state).map(|(w, x)| w * x).sum();
    let is_mechanical = study.system().structure.mechanical().is_some();
    let velocity = is_mechanical.then(|| rate_of(&observe, state));
    fields
        .plain("state", state.to_vec())
        .number("displacement", Quantity::Displacement, displacement)
        .known("velocity", Quantity::Velocity, velocity.ok_or(WITHOUT_VELOCITY));
}

/// Rate of an observed displacement in a state of masses.
pub(in crate::run) fn rate_of(row: &[f64], state: &[f64]) -> f64 {
    row.iter().zip(&state[row.len()..]).map(|(weight, velocity)| weight * velocity).sum()
}

/// Observed velocity at whole periods; `None` of first-order equations.
pub fn section_rates(attractor: &SystemAttractor, study: &SystemStudy) -> Option<Vec<f64>> {
    study.system().structure.mechanical()?;
    let observe = study.observe();
    let states = attractor.states.iter().take(attractor.section.len());
    Some(states.map(|state| rate_of(&observe, state)).collect())
}

/// The kind of a motion in words.
pub fn in_words(attractor: &SystemAttractor, units: UnitSystem) -> String {
    let slow = attractor.slow.map_or_else(String::new, |slow| match units {
        UnitSystem::None => format!(", slow angular frequency {}", digits(slow)),
        _ => format!(", slow frequency {} Hz", digits(slow / std::f64::consts::TAU)),
    });
    match attractor.kind {
        MotionKind::Periodic { periods: 1, .. } if attractor.base == Some(true) => {
            "base response (period 1)".to_owned()
        }
        MotionKind::Periodic { periods: 1, .. } => "period 1, in step with the dither".to_owned(),
        MotionKind::Periodic { periods, .. } => {
            let Some(ratio) = attractor.rotation.and_then(|rotation| rotation.ratio) else {
                return format!("locked: repeats after {periods} periods");
            };
            let (turns, counted) = (ratio.turns, ratio.periods);
            let repeats = if counted == periods {
                String::new()
            } else {
                format!(", repeating after {periods}")
            };
            format!(
                "locked: {turns} slow cycle{} in {counted} period{}{repeats}{slow}",
                plural(turns),
                plural(counted)
            )
        }
        MotionKind::QuasiPeriodic { .. } => format!("quasi-periodic{slow}"),
        MotionKind::NotPeriodic { tried } => {
            format!("a motion that does not repeat itself, followed over {tried} periods")
        }
        MotionKind::Cycle { period, .. } => {
            format!("limit cycle of period {}", in_units(units, Quantity::Time, period))
        }
        MotionKind::Rest if attractor.slides() => "steady sliding".to_owned(),
        MotionKind::Rest if attractor.stick.iter().all(|share| *share == 1.0) => {
            "rest, with every contact in stick".to_owned()
        }
        MotionKind::Rest => "rest, with some contacts in stick".to_owned(),
    }
}

/// Adds the fields of a motion to an object.
pub(in crate::run) fn put_attractor(
    fields: &mut Fields,
    attractor: &SystemAttractor,
    study: &SystemStudy,
) {
    fields.plain("words", in_words(attractor, study.units())).plain("kind", attractor.kind_name());
    put_quietness(fields, "", attractor);
    put_turns(fields, attractor);
    match attractor.kind {
        MotionKind::Periodic { periods, radius } => {
            fields.plain("periods", periods).plain("multiplier", radius);
        }
        MotionKind::Cycle { period, radius } => {
            fields.unknown("periods", "a limit cycle has a period of its own");
            fields.number("period", Quantity::Time, period).plain("multiplier", radius);
        }
        MotionKind::QuasiPeriodic { .. } | MotionKind::NotPeriodic { .. } | MotionKind::Rest => {
            let why = in_words(attractor, study.units());
            fields.unknown("periods", why.clone()).unknown("multiplier", why);
        }
    }
    let contacts = study.system().contacts.iter().zip(&attractor.stick).map(|(contact, share)| {
        let mut inner = Fields::in_units(study.units());
        inner.plain("name", contact.name.clone()).number("stick_fraction", Quantity::Ratio, *share);
        inner
    });
    put_state(fields, study, &attractor.state);
    fields
        .number("lowest", Quantity::Displacement, attractor.extremes.lower)
        .number("highest", Quantity::Displacement, attractor.extremes.upper)
        .number("peak_to_peak", Quantity::Displacement, attractor.size())
        .numbers("section_displacement", Quantity::Displacement, &attractor.section);
    match section_rates(attractor, study) {
        Some(rates) => fields.numbers("section_velocity", Quantity::Velocity, &rates),
        None => fields.unknown("section_velocity", WITHOUT_VELOCITY),
    };
    fields.list("contacts", contacts);
}

/// Adds whether a motion is quiet, and the base response, under names with a prefix.
pub(in crate::run) fn put_quietness(
    fields: &mut Fields,
    prefix: &str,
    attractor: &SystemAttractor,
) {
    fields.plain(&format!("{prefix}quiet"), attractor.quiet);
    let name = format!("{prefix}base_response");
    match attractor.base {
        Some(base) => fields.plain(&name, base),
        None if attractor.kind_code() == 0 => {
            fields.unknown(&name, "the base response was not found")
        }
        None => fields.plain(&name, false),
    };
}

/// The slow revolutions, or why they are not known.
fn put_turns(fields: &mut Fields, attractor: &SystemAttractor) {
    let why = match attractor.kind {
        MotionKind::Periodic { periods: 1, .. } => {
            "a motion in step with the dither has no slow rotation"
        }
        MotionKind::Cycle { .. } | MotionKind::Rest => "rotation is counted in periods of a dither",
        _ => "slow revolutions are counted for a single mass with a rigid contact alone",
    };
    let Some(rotation) = attractor.rotation else {
        for name in ["rotation_number", "rotation_error", "frequency", "locking"] {
            fields.unknown(name, why);
        }
        return;
    };
    fields.number("rotation_number", Quantity::Ratio, rotation.turns_per_period).number(
        "rotation_error",
        Quantity::Ratio,
        rotation.error,
    );
    if let Some(slow) = attractor.slow {
        fields.number("frequency", Quantity::FrequencyRatio, slow);
    }
    match rotation.ratio {
        Some(ratio) => {
            fields.plain("locking", json!({ "turns": ratio.turns, "periods": ratio.periods }));
        }
        None => {
            fields.unknown("locking", "the response is not locked");
        }
    }
}

/// Words of the column `local_verdict`.
pub(in crate::run) const VERDICTS: [(u8, &str); 4] =
    [(0, "stable"), (1, "unstable"), (2, "undecided"), (3, "unknown")];

/// The code of a verdict in datasets.
pub(in crate::run) fn verdict_code(local: &Result<&'static str, NoLocalVerdict>) -> u8 {
    let word = local.as_ref().map_or("unknown", |word| *word);
    VERDICTS.iter().find(|(_, known)| *known == word).map_or(3, |(code, _)| *code)
}
