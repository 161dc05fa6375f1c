//! Tangential dither at the slip ratio of each load: the follower force it leaves, and the force it needs.

use quell_disc::tangential::TangentialDither;
use quell_model::disc::DiscDither;
use quell_model::units::Quantity;
use serde_json::{Value as Json, json};

use crate::disc_units::DiscUnits;
use crate::study::DiscStudy;

/// One object for each load with a slip ratio; null where no load slides with one, `None` without tangential dither.
pub(super) fn json(study: &DiscStudy) -> Option<Json> {
    let disc = study.disc();
    let DiscDither::Tangential { frequency_ratio, .. } = disc.dither() else { return None };
    let speed = disc.speed();
    let shaken: Vec<Json> = disc
        .loads()
        .iter()
        .enumerate()
        .filter(|_| speed != 0.0)
        .filter_map(|(index, load)| {
            let slip_ratio = load.slip_ratio?;
            let dither = TangentialDither { slip_ratio, speed, frequency_ratio };
            let mass = load.mass + load.pad.map_or(0.0, |pad| pad.mass);
            let force = dither.force(mass, load.friction);
            // Each load has scales of its own.
            let newtons = DiscUnits::of(study)
                .and_then(|_| study.scales(index)?.si_per_unit(Quantity::LoadFriction));
            let (unit, own) =
                newtons.map_or(("1 (F/(r₀M_pω_ref²))", 1.0), |force| ("N", force));
            Some(json!({
                "load": index,
                "slip_ratio": slip_ratio,
                "angle_deg": dither.angle().to_degrees(),
                "mean": dither.mean(),
                "fundamental": dither.harmonic(1),
                "force": own * force,
                "units": { "angle_deg": "°", "mean": "1", "fundamental": "1", "force": unit },
            }))
        })
        .collect();
    Some(if shaken.is_empty() { Json::Null } else { shaken.into() })
}
