//! A disc as the template of a study.

use std::f64::consts::TAU;

use quell_input::complaint::{Complaints, Origin};
use quell_input::document::{Node, Table, Value};
use quell_model::parameter::Parameter;
use quell_model::parameter::disc::{DISC_DITHER_AMPLITUDE, DISC_SPEED, LOAD_FRICTION, LOAD_NORMAL};
use quell_model::units::{DiscScales, UnitSystem};

use super::{DiscSetup, is_si};
use crate::study::path;
use crate::study::steady::{each, scale_by};
use crate::study::study_kind::StudyKind;
use crate::study::system::{ScaledTime, SystemSetup};
use crate::study::template::Template;
use crate::study::vocabulary::UNITS;

impl Template for DiscSetup {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn system(&self, document: &Table) -> SystemSetup {
        let source = &self.plate.source;
        let time = source
            .reference_hz(self.plate.material.as_ref())
            .map(|hertz| ScaledTime { per_second: TAU * hertz, plain_in_seconds: is_si(document) });
        let setup = SystemSetup::of(self.equations(), UnitSystem::None, self.observed_row());
        SystemSetup { warnings: self.plate.warnings.clone(), time, ..setup }
    }

    fn number(&self, document: &Table, path: &str) -> Option<f64> {
        path::number(document, &mut Self::reader(document), path)
    }

    fn path_of(&self, _: &str, parameter: Parameter) -> String {
        parameter.path.to_owned()
    }

    fn varies_by(&self) -> Option<&'static str> {
        let disc = &self.disc;
        let drive = disc.drive().map(|_| "disc.drive");
        let load = disc.loads().iter().any(|load| load.share.is_some());
        let envelope = disc.envelope().map(|_| "dither.envelope");
        drive.or(load.then_some("disc.load.envelope")).or(envelope)
    }

    fn noise(&self) -> Option<String> {
        None
    }

    fn freeze(&self, document: &mut Table, time: f64) -> Result<(), Complaints> {
        let disc = &self.disc;
        if let Some(Value::Table(table)) = document.get_mut("disc").map(|node| &mut node.value) {
            if disc.drive().is_some() {
                table.remove("drive");
                let speed = disc.speed_at(time);
                let has_units = table.has(UNITS);
                each(table, "load", |index, table| {
                    set_speed(table, speed, disc.scales(index), has_units);
                    Ok(())
                })?;
            }
            each(table, "load", |index, table| {
                let share = disc.loads().get(index).and_then(|load| load.share.as_ref());
                let share = share.map_or(1.0, |share| share.value(time));
                let several = disc.loads().len() > 1;
                let path =
                    if several { format!("disc.load[{index}]") } else { "disc.load".to_owned() };
                let is_friction = |name: &str| {
                    [LOAD_FRICTION, LOAD_NORMAL].iter().any(|parameter| {
                        parameter.key() == name || parameter.si.iter().any(|twin| twin.key == name)
                    })
                };
                scale_by(table, &path, share, is_friction)
            })?;
        }
        each(document, "dither", |_, table| {
            let share = disc.envelope().map_or(1.0, |envelope| envelope.value(time));
            if table.has("envelope") && !table.has(DISC_DITHER_AMPLITUDE.key()) {
                // The amplitude that is not given is 1.
                let value = Value::Number(1.0);
                let origin = Origin::Argument("--at-time");
                table.set(DISC_DITHER_AMPLITUDE.key(), Node { value, origin });
            }
            scale_by(table, "dither", share, |name| name == DISC_DITHER_AMPLITUDE.key())
        })
    }
}

/// Sets the speed of a load, in hertz where it was given in SI.
fn set_speed(table: &mut Table, speed: f64, scales: Option<DiscScales>, has_units: bool) {
    let hertz = scales.and_then(|scales| scales.si_per_unit(DISC_SPEED.quantity));
    let twins = || DISC_SPEED.si.iter().map(|twin| twin.key);
    let si = hertz.filter(|_| has_units || twins().any(|key| table.has(key)));
    let (key, value) = match si {
        Some(hertz) => ("speed_hz", hertz * speed),
        None => (DISC_SPEED.key(), speed),
    };
    for key in twins().chain([DISC_SPEED.key()]) {
        table.remove(key);
    }
    table.set(key, Node { value: Value::Number(value), origin: Origin::Argument("--at-time") });
}
