//! The answer of `stability` as JSON.

use std::fmt::Display;

use quell_linear::averaging::{CriticalInput, DitheredContact};
use quell_linear::growth::Growth;
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::{DECIBELS, SlidingContact, SlidingStability, UnderDither, becomes, kind};
use crate::fields::Fields;
use crate::run::system::{put_motion, upper};
use crate::study::{SystemStudy, UnitSystem};

impl SlidingStability {
    /// As JSON.
    pub fn json(&self, study: &SystemStudy) -> Json {
        let units = study.units();
        let mut fields = Fields::in_units(units);
        let Growth { rate, error, frequency } = self.spectrum.growth;
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("verdict", self.verdict().name())
            .plain("protocol", self.protocol())
            .rate("growth_rate", rate)
            .rate("growth_rate_error", error)
            .number("frequency", Quantity::FrequencyRatio, frequency);
        if units != UnitSystem::None {
            fields.decibels("growth_rate_db_per_s", DECIBELS * rate);
        }
        let values = self.spectrum.motions.iter().map(|motion| motion.eigenvalue);
        let eigenvalues: Vec<Vec<f64>> = values.map(|value| vec![value.re, value.im]).collect();
        fields.plain("eigenvalues", eigenvalues);
        let motions = upper(&self.spectrum).map(|motion| put_motion(study.system(), units, motion));
        fields.list("motions", motions.collect::<Vec<_>>());
        let contacts = study.system().contacts.iter().zip(&self.contacts);
        let contacts = contacts.map(|(contact, found)| put_contact(&contact.name, units, found));
        fields.list("contacts", contacts.collect::<Vec<_>>());
        self.put_dither(&mut fields, units);
        if let Some(one) = &self.one_mass {
            one.put(study, &mut fields);
        }
        fields.plain("warnings", self.warnings.clone());
        fields.finish()
    }

    fn put_dither(&self, fields: &mut Fields, units: UnitSystem) {
        let Some(UnderDither { undithered, critical }) = &self.dither else {
            let why = "the study has no dither";
            fields.unknown("undithered", why).unknown("critical_amplitudes", why);
            return;
        };
        match undithered {
            Err(why) => {
                fields.unknown("undithered", why);
            }
            Ok(undithered) => {
                let Growth { rate, error, frequency } = undithered.growth;
                let mut inner = Fields::in_units(units);
                inner
                    .plain("verdict", undithered.growth.verdict().name())
                    .rate("growth_rate", rate)
                    .rate("growth_rate_error", error)
                    .number("frequency", Quantity::FrequencyRatio, frequency);
                fields.nested("undithered", inner);
            }
        }
        put_critical(fields, units, critical, |_, found| Ok(found.error));
    }
}

/// Adds critical amplitudes with the error of each, or why they are unknown.
pub(crate) fn put_critical(
    fields: &mut Fields,
    units: UnitSystem,
    critical: &Result<Vec<CriticalInput>, impl Display>,
    error: impl Fn(usize, &CriticalInput) -> Result<f64, &'static str>,
) {
    let critical = match critical {
        Ok(critical) => critical,
        Err(why) => {
            fields.unknown("critical_amplitudes", why);
            return;
        }
    };
    let items = critical.iter().enumerate().map(|(index, found)| {
        let mut inner = Fields::in_units(units);
        inner
            .number("amplitude", Quantity::Force, found.amplitude)
            .known("amplitude_error", Quantity::Force, error(index, found))
            .plain("kind", kind(found.crossing))
            .plain("becomes", becomes(found.becomes))
            .plain("contacts_stay_closed", found.contacts_stay_closed)
            .plain("within_law_ranges", found.within_laws);
        inner
    });
    fields.list("critical_amplitudes", items.collect::<Vec<_>>());
}

/// One contact.
pub(crate) fn put_contact(name: &str, units: UnitSystem, found: &SlidingContact) -> Fields {
    let mut fields = Fields::in_units(units);
    fields.plain("name", name).number("friction", Quantity::Force, found.friction).number(
        "normal",
        Quantity::Force,
        found.normal_load,
    );
    let dithered = found.dithered.ok_or("the study has no dither");
    let of = |pick: fn(&DitheredContact) -> f64| dithered.as_ref().map(pick);
    fields
        .known("slip_amplitude", Quantity::Velocity, of(|found| found.slip_amplitude))
        .known("load_amplitude", Quantity::Force, of(|found| found.load_amplitude))
        .known("effective_coefficient", Quantity::Ratio, of(|found| found.effective_coefficient))
        .known("ratchet_force", Quantity::Force, of(|found| found.ratchet_force))
        .known("slope_by_velocity", Quantity::LoadDamping, of(|found| found.slope_by_velocity));
    match &dithered {
        Ok(found) => fields.plain("slope_is_one_sided", found.one_sided),
        Err(why) => fields.unknown("slope_is_one_sided", why),
    };
    fields
}
