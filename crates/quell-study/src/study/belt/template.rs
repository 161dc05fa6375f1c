//! A belt as the template of a study.

use quell_input::complaint::{Complaint, Complaints, Fault, Origin};
use quell_input::document::{Table, Value};
use quell_model::parameter::{BELT_VELOCITY, NORMAL_LOAD, Parameter, indexed};
use quell_model::units::Quantity;

use super::BeltSetup;
use crate::study::path;
use crate::study::steady::{each, replace, scale};
use crate::study::system::SystemSetup;
use crate::study::template::Template;

impl Template for BeltSetup {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn system(&self, _: &Table) -> SystemSetup {
        self.system.clone()
    }

    fn number(&self, document: &Table, path: &str) -> Option<f64> {
        super::number::number(&self.belt, document, path)
    }

    fn path_of(&self, _: &str, parameter: Parameter) -> String {
        match self.belt.scales() {
            Some(_) => path::with_unit(parameter.path),
            None => parameter.path.to_owned(),
        }
    }

    fn varies_by(&self) -> Option<&'static str> {
        let belt = &self.belt;
        let envelope = belt.dithers().iter().any(|dither| dither.envelope.is_some());
        let drive = belt.drive().map(|_| "belt.drive");
        let load = belt.load().map(|_| "belt.load");
        drive.or(load).or(envelope.then_some("dither.envelope"))
    }

    fn noise(&self) -> Option<String> {
        let dithers = self.belt.dithers();
        let place = dithers.iter().position(|dither| !dither.waveform.is_periodic())?;
        Some(indexed("dither", place, dithers.len(), "waveform"))
    }

    fn freeze(&self, document: &mut Table, time: f64) -> Result<(), Complaints> {
        let belt = &self.belt;
        let scales = belt.scales();
        // The moment is one of the system.
        let time = scales.map_or(time, |scales| scales.angular_frequency() * time);
        let velocity = belt.belt_velocity_at(time);
        if velocity < 0.0 {
            let own =
                scales.map_or(velocity, |scales| scales.to_units(Quantity::Velocity, velocity));
            let allowed = "a drive that does not move backwards at --at-time: the same study as [system] takes either direction";
            let origin = Origin::Argument("--at-time");
            return Err(Complaint::new(Fault::Value, "belt.drive", origin, own, allowed).into());
        }
        if let Some(Value::Table(table)) = document.get_mut("belt").map(|node| &mut node.value) {
            let mut set = |name: &str, parameter: Parameter, value: f64| {
                let own = scales.map_or(value, |scales| scales.to_units(parameter.quantity, value));
                replace(table, name, parameter, own);
            };
            set("drive", BELT_VELOCITY, velocity);
            let load = belt.load().map_or(belt.normal_load(), |load| load.value(time));
            set("load", NORMAL_LOAD, load);
        }
        each(document, "dither", |index, table| {
            let share = belt.dithers().get(index).map_or(1.0, |dither| dither.wave().share(time));
            scale(table, index, share)
        })
    }
}
