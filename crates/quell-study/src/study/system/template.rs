//! A system as the template of a study.

use quell_input::complaint::Complaints;
use quell_input::document::Table;
use quell_model::parameter::{BELT_VELOCITY, NORMAL_LOAD, Parameter, indexed};
use quell_model::system::{Contact, Input};

use super::SystemSetup;
use crate::study::path;
use crate::study::steady::{each, replace, scale};
use crate::study::template::Template;

impl Template for SystemSetup {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn system(&self, _: &Table) -> Self {
        self.clone()
    }

    fn number(&self, document: &Table, path: &str) -> Option<f64> {
        let number = || path::number(document, &mut self.reader(), path);
        self.amplitude_at(document, path).or_else(number)
    }

    fn path_of(&self, contact: &str, parameter: Parameter) -> String {
        format!("contact.{contact}.{}", parameter.key())
    }

    fn varies_by(&self) -> Option<&'static str> {
        let system = &self.system;
        let drive = |contact: &Contact| {
            let drive = &contact.surface_velocity;
            !(drive.is_steady() && drive.waves().is_empty())
        };
        let load = |contact: &Contact| contact.varying_load.is_some();
        let any = |holds: &dyn Fn(&Contact) -> bool| system.contacts.iter().any(holds);
        let first = any(&drive).then_some("contact.drive");
        let second = any(&load).then_some("contact.load");
        let envelope = system.inputs.iter().any(|input| !input.profile.is_steady());
        first.or(second).or(envelope.then_some("dither.envelope"))
    }

    fn noise(&self) -> Option<String> {
        let inputs = &self.system.inputs;
        let is_noise =
            |input: &Input| input.profile.waves().iter().any(|wave| !wave.waveform.is_periodic());
        let place = inputs.iter().position(is_noise)?;
        Some(indexed("dither", place, inputs.len(), "waveform"))
    }

    fn freeze(&self, document: &mut Table, time: f64) -> Result<(), Complaints> {
        let system = &self.system;
        each(document, "contact", |index, table| {
            let Some(contact) = system.contacts.get(index) else { return Ok(()) };
            let steady = contact.steady_at(time);
            let velocity = steady.surface_velocity.mean();
            replace(table, "drive", BELT_VELOCITY, velocity);
            replace(table, "load", NORMAL_LOAD, steady.normal_load);
            Ok(())
        })?;
        each(document, "dither", |index, table| {
            let waves = system.inputs.get(index).map(|input| input.profile.waves());
            let share = waves.and_then(|waves| waves.first()).map_or(1.0, |wave| wave.share(time));
            scale(table, index, share)
        })
    }
}
