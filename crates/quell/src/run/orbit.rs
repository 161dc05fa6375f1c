//! `orbit`: the periodic response that sliding becomes under dither, or one near a given state, with its Floquet
//! multipliers.

use quell_belt::orbit::{NoOrbit, Orbit, Verdict, from_sliding, near};
use quell_belt::simulation::{EventKind, Start};
use quell_model::units::Quantity;
use serde_json::{Value as Json, json};

use super::{failed, in_words};
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::fields::Fields;
use crate::study::Study;

/// Steps of the dither's amplitude from nothing to its value.
const STEPS: u32 = 8;

/// Which periodic response is looked for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wanted {
    /// Near this state (x, x′) at τ = 0; by default the one that sliding becomes.
    pub near: Option<(f64, f64)>,
    /// Common periods of the dithers in a period of the response.
    pub periods: u32,
}

/// The periodic response of a study.
///
/// # Errors
/// A complaint where there is no period; [`Failure::Failed`] where shooting does not converge, with the place.
pub fn run(study: &Study, wanted: Wanted) -> Result<Orbit, Failure> {
    let belt = study.belt();
    let found = match wanted.near {
        Some((displacement, velocity)) => {
            near(belt, Start { time: 0.0, displacement, velocity }, wanted.periods.max(1))
        }
        None if wanted.periods > 1 => {
            from_sliding(belt, STEPS).and_then(|orbit| near(belt, orbit.start, wanted.periods))
        }
        None => from_sliding(belt, STEPS),
    };
    found.map_err(refused)
}

/// Why there is no orbit, as it is told.
pub(super) fn refused(why: NoOrbit) -> Failure {
    let key = match why {
        NoOrbit::NoDither => "dither",
        NoOrbit::Incommensurate => "dither.frequency_ratio",
        NoOrbit::NotConverged { .. } => {
            return Failure::Failed { key: "orbit".to_owned(), why: why.to_string() };
        }
        NoOrbit::Stalled(stalled) => return failed(stalled),
    };
    Complaint::new(Fault::Value, key, Origin::Whole, Json::Null, why.to_string()).into()
}

/// The orbit in one sentence.
pub fn sentence(study: &Study, orbit: &Orbit) -> String {
    let verdict = match orbit.verdict() {
        Verdict::Stable => "stable: small changes of it die out",
        Verdict::Unstable => "unstable: small changes of it grow",
        Verdict::Undecided => {
            "at its threshold: its largest multiplier has modulus 1 within the error"
        }
    };
    let contact = match (orbit.count(EventKind::Stick), orbit.count(EventKind::Reversal)) {
        (0, 0) if orbit.is_pure_slip() => "slides without touching v_r = 0".to_owned(),
        (0, 0) => "sticks throughout".to_owned(),
        (sticks, reversals) => format!("sticks {sticks} and reverses {reversals} times a period"),
    };
    let period = in_words(study, Quantity::Time, orbit.period);
    format!("The response of period {period} {contact}; it is {verdict}.")
}

/// The orbit as JSON.
pub fn json(study: &Study, orbit: &Orbit) -> Json {
    let mut fields = Fields::new(study.scales());
    fields
        .plain("ok", true)
        .plain("sentence", sentence(study, orbit))
        .plain("protocol", "local: Floquet multipliers of the periodic response")
        .number("displacement", Quantity::Displacement, orbit.start.displacement)
        .number("velocity", Quantity::Velocity, orbit.start.velocity)
        .number("period", Quantity::Time, orbit.period)
        .plain("multipliers", orbit.multipliers.map(|(re, im)| vec![re, im]).to_vec())
        .plain("monodromy", orbit.monodromy.map(|row| row.to_vec()).to_vec())
        .plain("verdict", orbit.verdict().name())
        .plain("stick_episodes", orbit.count(EventKind::Stick))
        .plain("reversals", orbit.count(EventKind::Reversal))
        .number("stick_fraction", Quantity::Ratio, orbit.stick_fraction)
        .number("residual", Quantity::Displacement, orbit.residual);
    let signature: Vec<Json> = orbit
        .events
        .iter()
        .map(|(kind, sign)| json!({ "kind": kind.name(), "slip_sign": sign }))
        .collect();
    fields.plain("signature", signature);
    let stuck = || "the response sticks throughout".to_owned();
    let least = orbit.least_slip.map(|(value, _)| value).ok_or_else(stuck);
    fields.known("least_slip_velocity", Quantity::Velocity, least);
    fields.finish()
}
