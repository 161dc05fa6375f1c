//! `check`: the numbers of a valid study.
use quell_model::parameter::{BELT_VELOCITY, DAMPING_RATIO, NORMAL_LOAD};
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::law;
use crate::contact_state::passivity;
use crate::fields::Fields;
use crate::noise;
use crate::range;
use crate::removed_mean;
use crate::run::actuator::beyond_actuator;
use crate::study::{BeltStudy, GivenSize, plausible};

/// The answer for a valid study.
#[derive(Clone, Debug)]
pub struct Check<'a> {
    /// The study.
    pub study: &'a BeltStudy,
}

impl Check<'_> {
    /// As JSON.
    pub fn json(&self) -> Json {
        let study = self.study;
        let scales = study.scales();
        let belt = study.belt();
        let mut fields = Fields::new(scales);
        fields.plain("ok", true);
        match study.title() {
            Some(title) => fields.plain("title", title),
            None => fields.unknown("title", "the study has no title"),
        };
        fields.plain("unit_system", study.units().name());
        let mut inner = Fields::new(scales);
        for (parameter, value, over_time) in [
            (DAMPING_RATIO, belt.damping_ratio(), None),
            (NORMAL_LOAD, belt.normal_load(), belt.load()),
            (BELT_VELOCITY, belt.belt_velocity(), belt.drive()),
        ] {
            let Some(profile) = over_time else {
                inner.number(parameter.key(), parameter.quantity, value);
                continue;
            };
            let (least, largest) = profile.bounds();
            inner
                .known(parameter.key(), parameter.quantity, Err("varies in time".to_owned()))
                .number(&format!("least_{}", parameter.key()), parameter.quantity, least)
                .number(&format!("largest_{}", parameter.key()), parameter.quantity, largest);
        }
        let none = "a rigid contact: belt.tangential_stiffness is not given";
        let stiffness = belt.tangential_stiffness();
        inner
            .known("tangential_stiffness", Quantity::Stiffness, stiffness.ok_or(none.to_owned()))
            .known(
                "breakaway",
                Quantity::Displacement,
                stiffness.map(|own| belt.breakaway(own)).ok_or(none.to_owned()),
            );
        fields.nested("belt", inner);
        let inner = law::fields(study);
        fields.nested("friction", inner);
        let dithers = belt.dithers().iter().map(|dither| {
            let mut inner = Fields::new(scales);
            inner
                .plain("direction", dither.direction.name())
                .plain("waveform", dither.waveform.name())
                .number("amplitude", Quantity::Force, dither.amplitude)
                .number("frequency_ratio", Quantity::FrequencyRatio, dither.frequency_ratio)
                .known(
                    "phase",
                    Quantity::Angle,
                    match dither.waveform.noise() {
                        Some(_) => Err("the lines of noise have random phases".to_owned()),
                        None => Ok(dither.phase),
                    },
                )
                .number("amplitude_ratio", Quantity::Velocity, dither.amplitude_ratio())
                .plain("has_envelope", dither.envelope.is_some());
            if scales.is_some() {
                inner.number("frequency", Quantity::FrequencyRatio, dither.frequency_ratio);
            }
            if let Some(noise) = dither.waveform.noise() {
                inner.plain("noise", noise::json(noise, dither.frequency_ratio));
            }
            inner
        });
        fields.list("dithers", dithers.collect::<Vec<_>>());
        let sizes = study.given_sizes().iter().map(|given| given_size(given, Fields::new(scales)));
        fields.list("given_amplitudes", sizes.collect::<Vec<_>>());
        let axes = study.sweeps().iter().map(|sweep| {
            let mut inner = Fields::new(None);
            inner
                .plain("parameter", sweep.path.as_str())
                .plain("unit", sweep.target.unit)
                .plain("points", sweep.axis.len())
                .plain("from", sweep.axis.value(0))
                .plain("to", sweep.axis.value(usize::MAX));
            inner
        });
        fields.list("sweeps", axes.collect::<Vec<_>>());
        let warnings = range::averaged(study).into_iter().chain(passivity(study));
        let in_units = belt.system_in_units().and_then(Result::ok);
        let magnitudes = in_units.map(|system| plausible::warnings(&system, study.units(), false));
        let warnings = warnings.chain(magnitudes.into_iter().flatten());
        let warnings = warnings.chain(beyond_actuator(&belt.system(), study.actuator(), 0));
        let waveforms = belt.dithers().iter().map(|dither| &dither.waveform);
        let warnings = warnings.chain(noise::few_lines(study.belt()));
        let warnings = warnings.chain(removed_mean::warnings(waveforms));
        fields.plain("warnings", warnings.collect::<Vec<String>>());
        fields.finish()
    }
}

/// An amplitude that is given by another size than a peak force.
pub(crate) fn given_size(given: &GivenSize, mut fields: Fields) -> Fields {
    fields
        .plain("key", given.path.as_str())
        .measured("value", unit_of_size(given), given.value)
        .number("amplitude", Quantity::Force, given.amplitude)
        .plain("by_actuator", given.key.needs_actuator());
    fields
}

/// The unit of the number that a size gives.
pub(crate) fn unit_of_size(given: &GivenSize) -> &'static str {
    if given.key.unit.is_empty() { Quantity::Force.scaled_unit() } else { given.key.unit }
}
