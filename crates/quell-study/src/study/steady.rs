//! The steady study of one moment of a study whose drive, load or dither varies in time, and what makes a study vary or not repeat.

use quell_model::parameter::disc::{DISC_DITHER_AMPLITUDE, DISC_SPEED, LOAD_FRICTION, LOAD_NORMAL};
use quell_model::parameter::{BELT_VELOCITY, NORMAL_LOAD, Parameter, indexed};
use quell_model::system::{Contact, Input};
use quell_model::units::{DiscScales, measure};
use quell_model::waveform::NOISE;
use quell_model::{Belt, Disc};
use serde_json::Value as Json;

use super::document::{Node, Table, Value};
use super::kind::{Kind, Study};
use super::vocabulary::UNITS;
use crate::complaint::{Complaint, Complaints, Fault, Origin};

impl Study {
    /// The table that makes the study vary in time, such as `belt.drive`; `None` for a steady study.
    pub fn varies_by(&self) -> Option<&'static str> {
        match self.kind() {
            Kind::Belt(setup) => {
                let belt = setup.belt();
                let envelope = belt.dithers().iter().any(|dither| dither.envelope.is_some());
                let drive = belt.drive().map(|_| "belt.drive");
                let load = belt.load().map(|_| "belt.load");
                drive.or(load).or(envelope.then_some("dither.envelope"))
            }
            Kind::Disc(setup) => {
                let disc = setup.disc();
                let drive = disc.drive().map(|_| "disc.drive");
                let load = disc.loads().iter().any(|load| load.share.is_some());
                let envelope = disc.envelope().map(|_| "dither.envelope");
                drive.or(load.then_some("disc.load.envelope")).or(envelope)
            }
            Kind::System(setup) => {
                let system = setup.system();
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
        }
    }

    /// The key of the first dither of noise, which has no period, such as `dither.waveform`; `None` where every dither is periodic.
    pub fn noise(&self) -> Option<String> {
        let (place, count) = match self.kind() {
            Kind::Belt(setup) => {
                let dithers = setup.belt().dithers();
                (dithers.iter().position(|dither| !dither.waveform.is_periodic()), dithers.len())
            }
            Kind::Disc(_) => (None, 0),
            Kind::System(setup) => {
                let inputs = &setup.system().inputs;
                let is_noise = |input: &Input| {
                    input.profile.waves().iter().any(|wave| !wave.waveform.is_periodic())
                };
                (inputs.iter().position(is_noise), inputs.len())
            }
        };
        Some(indexed("dither", place?, count, "waveform"))
    }

    /// The steady study with the velocities, loads and amplitudes of a time.
    ///
    /// # Errors
    /// All complaints about the study of that moment: a belt that stands still or moves backwards is none.
    pub fn at_time(&self, time: f64) -> Result<Self, Complaints> {
        let mut document = self.source.document.clone();
        let mut changes = self.source.changes.clone();
        match &self.source.declared {
            Kind::Belt(setup) => belt_at(&mut document, setup.belt(), time)?,
            Kind::Disc(setup) => disc_at(&mut document, setup.disc(), time)?,
            Kind::System(setup) => {
                let system = setup.system();
                each(&mut document, "contact", |index, table| {
                    let Some(contact) = system.contacts.get(index) else { return Ok(()) };
                    let steady = contact.steady_at(time);
                    let velocity = steady.surface_velocity.mean();
                    replace(table, "drive", BELT_VELOCITY, velocity);
                    replace(table, "load", NORMAL_LOAD, steady.normal_load);
                    Ok(())
                })?;
                each(&mut document, "dither", |index, table| {
                    let waves = system.inputs.get(index).map(|input| input.profile.waves());
                    let share =
                        waves.and_then(|waves| waves.first()).map_or(1.0, |wave| wave.share(time));
                    scale(table, index, share)
                })?;
            }
        }
        changes.push(format!("at_time={time:?}"));
        self.check_again(document, changes)
    }
}

fn belt_at(document: &mut Table, belt: &Belt, time: f64) -> Result<(), Complaints> {
    let scales = belt.scales();
    if let Some(Value::Table(table)) = document.get_mut("belt").map(|node| &mut node.value) {
        let mut set = |name: &str, parameter: Parameter, value: f64| {
            let own = scales.map_or(value, |scales| scales.to_units(parameter.quantity, value));
            replace(table, name, parameter, own);
        };
        set("drive", BELT_VELOCITY, belt.belt_velocity_at(time));
        let load = belt.load().map_or(belt.normal_load(), |load| load.value(time));
        set("load", NORMAL_LOAD, load);
    }
    each(document, "dither", |index, table| {
        let share = belt.dithers().get(index).map_or(1.0, |dither| dither.wave().share(time));
        scale(table, index, share)
    })
}

/// Gives every load the speed of a moment, and multiplies its friction or normal load and the amplitude of the dither by their shares.
fn disc_at(document: &mut Table, disc: &Disc, time: f64) -> Result<(), Complaints> {
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
            let path = if several { format!("disc.load[{index}]") } else { "disc.load".to_owned() };
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

/// Replaces a table over time by the constant value of its moment.
fn replace(table: &mut Table, course: &str, parameter: Parameter, value: f64) {
    if !table.has(course) {
        return;
    }
    table.remove(course);
    for key in parameter.keys() {
        table.remove(key);
    }
    table.set(
        parameter.key(),
        Node { value: Value::Number(value), origin: Origin::Argument("--at-time") },
    );
}

/// Replaces an envelope by its share of the amplitude.
fn scale(table: &mut Table, index: usize, share: f64) -> Result<(), Complaints> {
    scale_by(table, &format!("dither[{index}]"), share, |name| name.starts_with("amplitude"))
}

/// Replaces an envelope by its share of the numbers of some keys.
fn scale_by(
    table: &mut Table,
    path: &str,
    share: f64,
    scales: impl Fn(&str) -> bool,
) -> Result<(), Complaints> {
    if !table.has("envelope") {
        return Ok(());
    }
    table.remove("envelope");
    for (name, node) in table.iter_mut().filter(|(name, _)| scales(name)) {
        node.value = match &node.value {
            Value::Number(amplitude) => Value::Number(share * amplitude),
            Value::Text(text) => match measure::scaled(text, share) {
                Some(scaled) => Value::Text(scaled),
                None => Value::Text(format!("({text}) * {share:?}")),
            },
            _ => {
                let allowed =
                    "a number or a formula, so that its share at --at-time is one as well";
                let key = format!("{path}.{name}");
                let (origin, given) = (node.origin, node.given());
                return Err(vec![Complaint::new(Fault::Value, key, origin, given, allowed)].into());
            }
        };
    }
    Ok(())
}

/// Changes each table of a list, or the only one.
fn each(
    document: &mut Table,
    name: &str,
    mut change: impl FnMut(usize, &mut Table) -> Result<(), Complaints>,
) -> Result<(), Complaints> {
    match document.get_mut(name).map(|node| &mut node.value) {
        Some(Value::Table(table)) => change(0, table),
        Some(Value::List(list)) => {
            for (index, node) in list.iter_mut().enumerate() {
                if let Value::Table(table) = &mut node.value {
                    change(index, table)?;
                }
            }
            Ok(())
        }
        _ => Ok(()),
    }
}

/// The complaint about a question that only periodic dither answers; `key` is that of the noise.
pub fn not_periodic(verb: &str, key: impl Into<String>) -> Complaint {
    let allowed = format!(
        "a periodic waveform for {verb}, which is about a response that repeats, and under noise none does: simulate computes runs, \
         response the share of seeds that quench, response --window the record of one run, and friction, stability and \
         maps of averaged quantities the mean over the distribution of the noise"
    );
    Complaint::new(Fault::Conflict, key, Origin::Whole, NOISE, allowed)
}

/// The complaint about a question that only a steady study answers.
pub fn varies_in_time(verb: &str, table: &'static str) -> Complaint {
    let window = if verb == "response" { "--window for a part of the run, " } else { "" };
    let allowed = format!(
        "left out for {verb}, which is about a steady drive, load and dither: give {window}--at-time for the values of one moment, or \
         use simulate"
    );
    Complaint::new(Fault::Conflict, table, Origin::Whole, Json::Null, allowed)
}
