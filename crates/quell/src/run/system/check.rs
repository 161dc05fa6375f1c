//! `check` of a study of a system: the numbers of a valid study.

use quell_model::Profile;
use quell_model::system::{InputTarget, Structure};
use quell_model::units::Quantity;
use serde_json::{Value as Json, json};

use super::actuator::designed;
use crate::noise;
use crate::removed_mean;
use crate::run::actuator::beyond_actuator;
use crate::study::{SystemStart, SystemStudy};

/// The study as JSON.
pub fn json(study: &SystemStudy) -> Json {
    let system = study.system();
    let names = system.structure.names();
    let form = match &system.structure {
        Structure::Mechanical(_) => "coordinates",
        Structure::StateSpace(_) => "states",
    };
    let contacts: Vec<&str> = system.contacts.iter().map(|contact| contact.name.as_str()).collect();
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
    json!({
        "ok": true,
        "title": study.title(),
        "kind": "system",
        "form": form,
        "unit_system": study.units().name(),
        "coordinates": names,
        "contacts": contacts,
        "contact_laws": laws(study),
        "dithers": dithers(study),
        "given_amplitudes": sizes(study),
        "observe": study.observe(),
        "initial": initial(study.initial()),
        "sweeps": sweeps,
        "warnings": warnings(study),
    })
}

/// Load, surface velocity and law of each contact.
fn laws(study: &SystemStudy) -> Vec<Json> {
    let units = study.units();
    let contacts = study.system().contacts.iter();
    contacts
        .map(|contact| {
            json!({
                "name": contact.name,
                "normal_load": constant(&contact.load()),
                "normal_load_unit": units.unit(Quantity::Force),
                "belt_velocity": constant(&contact.surface_velocity),
                "varies_in_time": constant(&contact.load()).is_none() || constant(&contact.surface_velocity).is_none(),
                "belt_velocity_unit": units.unit(Quantity::Velocity),
                "normal": contact.normal.is_some(),
                "tangent": contact.tangent.is_some(),
                "law": contact.friction.kind().name(),
            })
        })
        .collect()
}

/// The value of a constant profile; `None` for one that varies.
fn constant(profile: &Profile) -> Option<f64> {
    (profile.knots().is_none() && profile.waves().is_empty()).then(|| profile.mean())
}

/// Target and wave of each input.
fn dithers(study: &SystemStudy) -> Vec<Json> {
    let system = study.system();
    let mut dithers = Vec::new();
    for input in &system.inputs {
        let name = |contact: usize| system.contacts.get(contact).map(|contact| &contact.name);
        let target = match &input.target {
            InputTarget::Force(row) => json!({ "at": row }),
            InputTarget::NormalLoad { contact, reaction } => {
                json!({ "contact": name(*contact), "reaction": reaction })
            }
            InputTarget::Friction { contact } => {
                json!({ "contact": name(*contact), "friction": true, "mean": input.profile.mean() })
            }
        };
        for wave in input.profile.waves() {
            let mut object = target.clone();
            object["waveform"] = wave.waveform.name().into();
            object["amplitude"] = wave.amplitude.into();
            object["frequency"] = wave.frequency.into();
            object["phase"] = wave.phase.into();
            if let Some(noise) = wave.waveform.noise() {
                object["phase"] = Json::Null;
                object["noise"] = noise::json(noise, wave.frequency);
            }
            dithers.push(object);
        }
    }
    dithers
}

/// Warnings of the study, about friction that is not passive, and about the means of samples.
fn warnings(study: &SystemStudy) -> Vec<String> {
    let mut warnings = study.warnings().to_vec();
    warnings.extend(beyond_actuator(study.system(), study.actuator(), designed(study)));
    let waves = study.system().inputs.iter().flat_map(|input| input.profile.waves());
    warnings.extend(removed_mean::warnings(waves.map(|wave| &wave.waveform)));
    warnings
}

/// Amplitudes that are given by another size than a peak force.
fn sizes(study: &SystemStudy) -> Vec<Json> {
    let units = study.units();
    let given = study.given_sizes().iter();
    given
        .map(|given| {
            let unit = if given.key.unit.is_empty() {
                units.unit(Quantity::Force)
            } else {
                Some(given.key.unit)
            };
            json!({
                "key": given.path,
                "value": given.value,
                "unit": unit,
                "amplitude": given.amplitude,
                "amplitude_unit": units.unit(Quantity::Force),
                "by_actuator": given.key.needs_actuator(),
            })
        })
        .collect()
}

fn initial(start: &SystemStart) -> Json {
    match start {
        SystemStart::Rest => "rest".into(),
        SystemStart::Sliding => "sliding".into(),
        SystemStart::Squealing => "squealing".into(),
        SystemStart::Base => "base".into(),
        SystemStart::Values(state) | SystemStart::Described { state, .. } => state.clone().into(),
    }
}
