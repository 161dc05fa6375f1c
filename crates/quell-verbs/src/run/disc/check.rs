//! `check` of a disc study: the numbers of a valid study.

use quell_model::disc::{Carrier, DiscDither, Load};
use quell_model::parameter::disc::{
    CALIPER_DAMPING, CALIPER_MASS, CALIPER_STIFFNESS, DISC_SPEED, LOAD_DAMPING, LOAD_DITHER_PHASE,
    LOAD_EXTENT, LOAD_FRICTION, LOAD_HALF_THICKNESS, LOAD_MASS, LOAD_NORMAL, LOAD_POINTS,
    LOAD_RADIAL_POINTS, LOAD_STATIC, LOAD_STIFFNESS, PAD_DAMPING, PAD_MASS, PAD_STIFFNESS,
};
use quell_model::parameter::{DITHER_FREQUENCY_RATIO, Parameter};
use quell_model::profile::Profile;
use quell_model::units::{DiscScales, Quantity, UnitSystem};
use quell_model::{Direction, Disc, Waveform};
use quell_numerics::interval::RealInterval;
use serde_json::{Value as Json, json};

use crate::disc_units::DiscUnits;
use crate::removed_mean;
use crate::run::actuator::beyond_actuators_at_loads;
use crate::study::DiscStudy;
use crate::study::disc::ModeSource;
use crate::words::counted;

/// The units of the answers, with the scales of a load; `None` where numbers are those of the equations.
type LoadUnits = Option<(DiscUnits, DiscScales)>;

/// That the study is valid, and what it has.
pub fn sentence(study: &DiscStudy) -> String {
    let disc = study.disc();
    let dither = match disc.dither() {
        DiscDither::None => "no dither",
        DiscDither::Normal { .. } => "normal dither",
        DiscDither::Tangential { .. } => "tangential dither",
    };
    let (modes, loads) = (disc.modes().len(), disc.loads().len());
    format!(
        "The study is valid. It has {}, {} and {dither}.",
        counted(modes, "mode"),
        counted(loads, "load")
    )
}

/// The study as JSON.
pub fn json(study: &DiscStudy) -> Json {
    let disc = study.disc();
    let units = DiscUnits::of(study);
    let loads: Vec<Json> = disc
        .loads()
        .iter()
        .zip(study.radii())
        .enumerate()
        .map(|(index, (load, radius))| {
            let mut object = json!({
                "radius_ratio": radius,
                "angle_deg": load.angle.to_degrees(),
                LOAD_DITHER_PHASE.key(): load.dither_phase.to_degrees(),
                "units": { "angle_deg": "deg", LOAD_DITHER_PHASE.key(): "deg" },
            });
            let scales = units.zip(study.scales(index));
            for (parameter, value) in [
                (LOAD_MASS, load.mass),
                (LOAD_DAMPING, load.damping),
                (LOAD_STIFFNESS, load.stiffness),
                (LOAD_FRICTION, load.friction),
            ] {
                put(&mut object, parameter, value, scales);
            }
            if load.static_load != 0.0 {
                put(&mut object, LOAD_STATIC, load.static_load, scales);
            }
            if let Some(normal_load) = load.normal_load {
                put(&mut object, LOAD_NORMAL, normal_load, scales);
                put(&mut object, LOAD_HALF_THICKNESS, load.half_thickness, scales);
            }
            put_area(&mut object, load);
            if let Some(RealInterval { lower: least, upper: largest }) =
                load.share.as_ref().map(Profile::bounds)
            {
                object["least_share"] = least.into();
                object["largest_share"] = largest.into();
            }
            let of_pad = [PAD_MASS, PAD_DAMPING, PAD_STIFFNESS];
            let of_caliper = [CALIPER_MASS, CALIPER_DAMPING, CALIPER_STIFFNESS];
            for (body, names) in [(load.pad, of_pad), (load.caliper, of_caliper)] {
                let Some(Carrier { mass, damping, stiffness }) = body else { continue };
                for (parameter, value) in names.into_iter().zip([mass, damping, stiffness]) {
                    put(&mut object, parameter, value, scales);
                }
            }
            object
        })
        .collect();
    let sweeps: Vec<Json> = study
        .sweeps()
        .iter()
        .map(|sweep| {
            json!({
                "parameter": sweep.path,
                "unit": sweep.target.unit,
                "points": sweep.axis.len(),
                "from": sweep.axis.value(0),
                "to": sweep.axis.value(usize::MAX),
            })
        })
        .collect();
    let mut warnings = study.warnings().to_vec();
    warnings.extend(removed_mean::warnings(std::iter::once(disc.waveform())));
    warnings.extend(beyond_actuators_at_loads(study));
    let mut object = json!({
        "ok": true,
        "sentence": sentence(study),
        "title": study.title(),
        "unit_system": units.map_or(UnitSystem::None, |units| units.system()).name(),
        "disc": {
            "modes": disc.modes().len(),
            "modes_from": source(study),
            "without": study.without(),
            "loads": loads,
        },
        "dither": dither(disc),
        "sweeps": sweeps,
        "warnings": warnings,
    });
    if let Some(law) = disc.law() {
        let kind = law.kind();
        object["friction"] = json!({ "law": kind.name() });
        for (parameter, value) in kind.parameters().iter().zip(law.values()) {
            put(&mut object["friction"], *parameter, value, units.zip(study.scales(0)));
        }
    }
    let scales = units.zip(study.scales(0));
    put_speed(&mut object, disc, scales);
    if let Some(ratio) = disc.dither().frequency_ratio().filter(|_| units.is_some()) {
        let frequency = Parameter { path: "dither.frequency", ..DITHER_FREQUENCY_RATIO };
        put(&mut object["dither"], frequency, ratio, scales);
    }
    if study.title().is_none() {
        object["why"]["title"] = "the study has no title".into();
    }
    object
}

/// Adds the speed; where it varies in time, its least and its largest value.
fn put_speed(object: &mut Json, disc: &Disc, scales: LoadUnits) {
    let Some(RealInterval { lower: least, upper: largest }) = disc.drive().map(Profile::bounds)
    else {
        put(&mut object["disc"], DISC_SPEED, disc.speed(), scales);
        return;
    };
    object["disc"][DISC_SPEED.key()] = Json::Null;
    object["why"]["disc.speed"] = "varies in time".into();
    let mut ends = json!({});
    for (name, value) in [("least", least), ("largest", largest)] {
        let mut one = json!({});
        put(&mut one, DISC_SPEED, value, scales);
        let key = format!("{name}_{}", DISC_SPEED.key());
        ends["units"][&key] = one["units"][DISC_SPEED.key()].take();
        ends[key] = one[DISC_SPEED.key()].take();
    }
    if let (Some(whole), Json::Object(mut ends)) = (object["disc"].as_object_mut(), ends) {
        whole.append(&mut ends);
    }
}

/// Adds the area of a distributed load: its extent and its numbers of quadrature points.
fn put_area(object: &mut Json, load: &Load) {
    let Some(patch) = &load.patch else { return };
    object[LOAD_EXTENT.key()] = patch.extent.to_degrees().into();
    object[LOAD_POINTS.key()] = patch.points.into();
    if !patch.radii.is_empty() {
        object[LOAD_RADIAL_POINTS.key()] = patch.radii.len().into();
    }
}

/// Adds a number of the equations in the units of the study, with its unit.
fn put(object: &mut Json, parameter: Parameter, value: f64, scales: LoadUnits) {
    let quantity = parameter.quantity;
    let one = scales.and_then(|(units, scales)| units.one_at(&scales, quantity));
    let (one, unit) = one.unwrap_or((1.0, parameter_unit(quantity)));
    object[parameter.key()] = (one * value).into();
    object["units"][parameter.key()] = unit.into();
}

/// The unit of a number of the equations of a disc.
fn parameter_unit(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::FrequencyRatio => "ω_ref",
        quantity => quantity.scaled_unit(),
    }
}

/// The source of the modes, as text.
pub fn source(study: &DiscStudy) -> String {
    match study.source() {
        ModeSource::Plate(_) => "plate".to_owned(),
        ModeSource::List(_) => "study".to_owned(),
        ModeSource::File { name, .. } => name.clone(),
    }
}

fn dither(disc: &Disc) -> Json {
    let mut object = match disc.dither() {
        DiscDither::None => Json::Null,
        DiscDither::Normal { amplitude, frequency_ratio } => json!({
            "direction": Direction::Normal.name(),
            "amplitude": amplitude,
            "frequency_ratio": frequency_ratio,
        }),
        DiscDither::Tangential { amplitude, frequency_ratio } => json!({
            "direction": Direction::Tangential.name(),
            "amplitude": amplitude,
            "frequency_ratio": frequency_ratio,
        }),
    };
    if *disc.waveform() != Waveform::Sine {
        object["waveform"] = disc.waveform().name().into();
    }
    if disc.envelope().is_some() {
        object["has_envelope"] = true.into();
    }
    object
}
