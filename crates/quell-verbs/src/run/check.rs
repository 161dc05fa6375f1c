//! `check`: the numbers of a valid study of a belt or a system.

use quell_linear::averaging::DitheredSystem;
use quell_model::profile::{Profile, Wave};
use quell_model::system::{Contact, Input, InputTarget, Structure};
use quell_model::units::Quantity;
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

use super::actuator::beyond_actuator;
use super::law;
use super::system::velocity_in_words;
use crate::fields::Fields;
use crate::noise;
use crate::range::outside_of_laws;
use crate::removed_mean;
use crate::study::{GivenSize, SystemStart, SystemStudy};
use crate::words::counted;

/// That the study is valid, and what it has.
pub fn sentence(study: &SystemStudy) -> String {
    let system = study.system();
    let names = system.structure.names().len();
    let form = match &system.structure {
        Structure::Mechanical(_) => "coordinate",
        Structure::StateSpace(_) => "state",
    };
    let some = |count: usize, noun: &str| match count {
        0 => format!("no {noun}"),
        count => counted(count, noun),
    };
    format!(
        "The study is valid. It has {}, {} and {}.",
        counted(names, form),
        some(system.contacts.len(), "contact"),
        some(system.waves().count(), "dither")
    )
}

/// The study as JSON.
pub fn json(study: &SystemStudy) -> Json {
    let system = study.system();
    let mut fields = Fields::in_units(study.units());
    fields.plain("ok", true).plain("sentence", sentence(study));
    match study.title() {
        Some(title) => fields.plain("title", title),
        None => fields.unknown("title", "the study has no title"),
    };
    let form = match &system.structure {
        Structure::Mechanical(_) => "coordinates",
        Structure::StateSpace(_) => "states",
    };
    fields
        .plain("unit_system", study.units().name())
        .plain("form", form)
        .plain("coordinates", system.structure.names().to_vec());
    if let Some(ratios) = damping_ratios(study) {
        fields.numbers("damping_ratios", Quantity::Ratio, &ratios);
    }
    fields.list("contacts", system.contacts.iter().map(|contact| contact_fields(study, contact)));
    let dithers = system.inputs.iter().flat_map(|input| {
        let waves = input.profile.waves().iter();
        waves.map(move |wave| dither_fields(study, input, wave))
    });
    fields.list("dithers", dithers.collect::<Vec<_>>());
    let sizes = study.given_sizes().iter().map(|given| size_fields(study, given));
    fields.list("given_amplitudes", sizes.collect::<Vec<_>>());
    fields.plain("observe", study.observe()).plain("initial", initial(study.initial()));
    let axes = study.sweeps().iter().map(|sweep| {
        let mut inner = Fields::in_units(study.units());
        inner
            .plain("parameter", sweep.path.as_str())
            .plain("unit", sweep.target.unit)
            .plain("points", sweep.axis.len())
            .plain("from", sweep.axis.value(0))
            .plain("to", sweep.axis.value(usize::MAX));
        inner
    });
    fields.list("sweeps", axes.collect::<Vec<_>>()).plain("warnings", warnings(study));
    fields.finish()
}

/// c/(2√(km)) of each coordinate alone; `None` of equations of first order, and where a coordinate has no spring of its own.
pub fn damping_ratios(study: &SystemStudy) -> Option<Vec<f64>> {
    let mechanical = study.system().structure.mechanical()?;
    let mass = mechanical.mass().matrix();
    let ratio = |i: usize| {
        let (stiffness, damping) = (mechanical.stiffness()[(i, i)], mechanical.damping()[(i, i)]);
        (stiffness > 0.0).then(|| 0.5 * damping / (stiffness * mass[(i, i)]).sqrt())
    };
    (0..mechanical.size()).map(ratio).collect()
}

/// A number that may vary in time: its value, or its bounds.
fn put_over_time(fields: &mut Fields, name: &str, quantity: Quantity, profile: &Profile) {
    let RealInterval { lower: least, upper: largest } = profile.bounds();
    if least == largest {
        fields.number(name, quantity, least);
        return;
    }
    fields
        .known(name, quantity, Err("varies in time".to_owned()))
        .number(&format!("least_{name}"), quantity, least)
        .number(&format!("largest_{name}"), quantity, largest);
}

/// Load, surface velocity, law and stiffness of a contact.
fn contact_fields(study: &SystemStudy, contact: &Contact) -> Fields {
    let empty = || Fields::in_units(study.units());
    let mut fields = empty();
    fields
        .plain("name", contact.name.as_str())
        .plain("tangent", contact.tangent.is_some())
        .plain("normal", contact.normal.is_some());
    put_over_time(&mut fields, "normal_load", Quantity::Force, &contact.load());
    put_over_time(&mut fields, "belt_velocity", Quantity::Velocity, &contact.surface_velocity);
    let rigid = || "the contact is rigid".to_owned();
    fields
        .known(
            "tangential_stiffness",
            Quantity::Stiffness,
            contact.tangential_stiffness.ok_or_else(rigid),
        )
        .known("breakaway", Quantity::Displacement, contact.breakaway().ok_or_else(rigid))
        .nested("friction", law::fields(&contact.friction, contact.normal_load, &empty));
    fields
}

/// Target and numbers of a wave of an input.
fn dither_fields(study: &SystemStudy, input: &Input, wave: &Wave) -> Fields {
    let mut fields = Fields::in_units(study.units());
    let name =
        |contact: usize| study.system().contacts.get(contact).map(|known| known.name.clone());
    match &input.target {
        InputTarget::Force(row) => fields.plain("at", row.clone()),
        InputTarget::NormalLoad { contact, reaction } => {
            let direction = fields.plain("direction", "normal").plain("contact", name(*contact));
            direction.plain("reaction", *reaction)
        }
        InputTarget::Friction { contact } => fields
            .plain("direction", "friction")
            .plain("contact", name(*contact))
            .number("mean", Quantity::Ratio, input.profile.mean()),
    };
    let noise = wave.waveform.noise();
    let phase = match noise {
        Some(_) => Err("the lines of noise have random phases".to_owned()),
        None => Ok(wave.phase),
    };
    fields
        .plain("waveform", wave.waveform.name())
        .number("amplitude", Quantity::Force, wave.amplitude)
        .number("frequency", Quantity::FrequencyRatio, wave.frequency)
        .known("phase", Quantity::Angle, phase)
        .plain("has_envelope", wave.envelope.is_some());
    if let Some(noise) = noise {
        fields.plain("noise", noise::json(noise, wave.frequency));
    }
    fields
}

/// An amplitude that is given by another size than a peak force.
fn size_fields(study: &SystemStudy, given: &GivenSize) -> Fields {
    let force = study.units().unit(Quantity::Force).unwrap_or("1");
    let unit = if given.key.unit.is_empty() { force } else { given.key.unit };
    let mut fields = Fields::in_units(study.units());
    fields
        .plain("key", given.path.as_str())
        .measured("value", unit, given.value)
        .number("amplitude", Quantity::Force, given.amplitude)
        .plain("by_actuator", given.key.needs_actuator());
    fields
}

/// Warnings of the study, of slip beyond laws, of the actuator, of noise, and about the means of samples.
fn warnings(study: &SystemStudy) -> Vec<String> {
    let system = study.system();
    let mut warnings = study.warnings().to_vec();
    let has_range = system.contacts.iter().any(|contact| contact.friction.range().is_some());
    if has_range {
        let dithered = system.is_dithered().then(|| DitheredSystem::new(system)?.average());
        let average = dithered.and_then(Result::ok);
        let contacts = average.as_ref().map(|average| average.contacts.as_slice());
        let in_words = |speed| velocity_in_words(study, speed);
        warnings.extend(outside_of_laws(system, in_words, contacts));
    }
    warnings.extend(beyond_actuator(study));
    warnings.extend(noise::few_lines(system));
    warnings.extend(removed_mean::warnings(system.waves().map(|wave| &wave.waveform)));
    warnings
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
