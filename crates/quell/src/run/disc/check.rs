//! `check` of a disc study: the study in numbers, once everything about it is right.

use quell_disc::Dither;
use quell_model::Direction;
use quell_model::parameter::disc::{
    DISC_SPEED, LOAD_DAMPING, LOAD_FRICTION, LOAD_MASS, LOAD_STIFFNESS,
};
use serde_json::{Value as Json, json};

use crate::study::DiscStudy;
use crate::study::disc::ModeSource;

/// The study as JSON.
pub fn json(study: &DiscStudy) -> Json {
    let disc = study.disc();
    let loads: Vec<Json> = disc
        .loads()
        .iter()
        .zip(study.radii())
        .map(|(load, radius)| {
            json!({
                "radius_ratio": radius,
                "angle_deg": load.angle.to_degrees(),
                LOAD_MASS.key(): load.mass,
                LOAD_DAMPING.key(): load.damping,
                LOAD_STIFFNESS.key(): load.stiffness,
                LOAD_FRICTION.key(): load.friction,
            })
        })
        .collect();
    let sweeps: Vec<Json> = study
        .sweeps()
        .iter()
        .map(|sweep| {
            json!({
                "parameter": sweep.path,
                "unit": sweep.address.key.unit_in_words(),
                "points": sweep.axis.len(),
                "from": sweep.axis.value(0),
                "to": sweep.axis.value(usize::MAX),
            })
        })
        .collect();
    let mut object = json!({
        "ok": true,
        "title": study.title(),
        "system": "dimensionless",
        "disc": {
            "modes": disc.modes().len(),
            "modes_from": source(study),
            "without": study.without(),
            DISC_SPEED.key(): disc.speed(),
            "loads": loads,
        },
        "dither": dither(disc.dither()),
        "sweeps": sweeps,
        "warnings": study.warnings(),
    });
    if study.title().is_none() {
        object["why"] = json!({ "title": "the study gives none" });
    }
    object
}

/// Where the modes come from, in words.
pub fn source(study: &DiscStudy) -> String {
    match study.source() {
        ModeSource::Plate(_) => "plate".to_owned(),
        ModeSource::List(_) => "study".to_owned(),
        ModeSource::File { path, .. } => path.display().to_string(),
    }
}

fn dither(dither: Dither) -> Json {
    match dither {
        Dither::None => Json::Null,
        Dither::Normal { amplitude, frequency_ratio } => json!({
            "direction": Direction::Normal.name(),
            "amplitude": amplitude,
            "frequency_ratio": frequency_ratio,
        }),
        Dither::Tangential { amplitude, frequency_ratio } => json!({
            "direction": Direction::Tangential.name(),
            "amplitude": amplitude,
            "frequency_ratio": frequency_ratio,
        }),
    }
}
