//! The answer of `simulate`: sentence, warnings and JSON.

use quell_dynamics::motion::{ContactPhase, RecordedEvent};
use quell_model::System;
use quell_model::units::Quantity;
use serde_json::{Map, Value as Json};

use super::history::KINDS;
use super::{DEFAULT_PERIODS, Simulation};
use crate::fields::Fields;
use crate::run::actuator::beyond_actuator;
use crate::run::system::in_units_of;
use crate::run::system::of_runs::{of_engine, put_means};
use crate::run::system::start::{observed_state, start_in_words};
use crate::study::{SystemStudy, UnitSystem};
use crate::words::{capital, listed, plural};

/// Contacts that a sentence describes one by one.
const MOST_DESCRIBED: usize = 4;

/// Word for what a contact does, as its verb.
fn does(phase: ContactPhase) -> &'static str {
    match phase {
        ContactPhase::Slip(_) => "slips",
        ContactPhase::Stick => "sticks",
        ContactPhase::Open => "is open",
    }
}

impl Simulation {
    /// Total number of events of each kind.
    fn totals(&self) -> [u64; KINDS.len()] {
        let mut totals = [0; KINDS.len()];
        for counts in &self.history.counts {
            totals.iter_mut().zip(counts).for_each(|(total, count)| *total += count);
        }
        totals
    }

    /// What the contacts do at the end.
    fn contacts_in_words(&self, system: &System) -> String {
        let ends = &self.end.contacts;
        if ends.len() <= MOST_DESCRIBED {
            let each = system.contacts.iter().zip(ends);
            let each = each.map(|(contact, end)| format!("{} {}", contact.name, does(end.phase)));
            return format!("contact {}", each.collect::<Vec<_>>().join(", contact "));
        }
        let count =
            |holds: fn(ContactPhase) -> bool| ends.iter().filter(|end| holds(end.phase)).count();
        format!(
            "{} contacts slip, {} stick and {} are open",
            count(|phase| matches!(phase, ContactPhase::Slip(_))),
            count(|phase| phase == ContactPhase::Stick),
            count(|phase| phase == ContactPhase::Open)
        )
    }

    /// The start as text, such as "from rest".
    pub fn start_in_words(&self, study: &SystemStudy) -> String {
        match &self.request.from {
            Some(from) => {
                let time = in_units_of(study, Quantity::Time, from.time);
                format!("from the given state at t = {time}")
            }
            None => start_in_words(study, &self.request.start),
        }
    }

    /// The outcome in one or two sentences.
    pub fn sentence(&self, study: &SystemStudy) -> String {
        let time = in_units_of(study, Quantity::Time, self.end.time);
        let totals = self.totals();
        let each = KINDS.iter().zip(totals).filter(|(_, count)| *count > 0);
        let each: Vec<String> =
            each.map(|(kind, count)| format!("{count} {}{}", kind.name(), plural(count))).collect();
        let events = match totals.iter().sum::<u64>() {
            0 => "without any contact event".to_owned(),
            _ => format!("after {}", listed(&each)),
        };
        let start = capital(&self.start_in_words(study));
        let contacts = match self.end.contacts.len() {
            0 => format!("{start}: the run ends at t = {time}"),
            _ => format!(
                "{start}: at t = {time} {}, {events}",
                self.contacts_in_words(study.system())
            ),
        };
        let vibrates =
            self.manoeuvre_sentence(study).map_or(String::new(), |said| format!(" {said}"));
        format!("{contacts}.{vibrates}")
    }

    /// How long the run lasts where that was not requested, and the sound.
    pub fn notes(&self, study: &SystemStudy) -> Vec<String> {
        let chosen = self.request.until.is_none().then(|| {
            format!(
                "The run lasts {DEFAULT_PERIODS} periods of the slowest oscillation; --until sets another time."
            )
        });
        chosen.into_iter().chain(self.sound_sentence(study)).collect()
    }

    /// When the observed row vibrates, in one or two sentences, where a drive, a load or a dither varies in time.
    pub fn manoeuvre_sentence(&self, study: &SystemStudy) -> Option<String> {
        let found = self.manoeuvre.as_ref()?;
        let words = |quantity, value| in_units_of(study, quantity, value);
        Some(found.sentence("The observed motion", words))
    }

    /// The sound in one sentence, if it was requested.
    pub fn sound_sentence(&self, study: &SystemStudy) -> Option<String> {
        let sound = self.sound.as_ref()?;
        let in_real_time = study.time_per_second().is_some() && sound.transposition == 1.0;
        Some(sound.sentence(in_real_time, |quantity, value| in_units_of(study, quantity, value)))
    }

    /// Warnings about the result.
    pub fn warnings(&self, study: &SystemStudy) -> Vec<String> {
        let mut warnings = study.warnings().to_vec();
        warnings.extend(self.beyond.iter().cloned());
        warnings.extend(of_engine(study.system(), &self.end));
        warnings.extend(beyond_actuator(study));
        if self.coarse {
            let count = self.samples.as_ref().map_or(0, |samples| samples.times.len());
            warnings.push(format!(
                "only {count} samples are kept, too few to resolve the fastest motion"
            ));
        }
        if let Some(sound) = &self.sound {
            let words = |quantity, value| in_units_of(study, quantity, value);
            warnings.extend(sound.warnings(words));
        }
        if let Some(Err(why)) = &self.undithered {
            warnings.push(format!("the motion without dither is not shown: {why}"));
        }
        if self.history.lost > 0 {
            let kept = self.history.events.len();
            warnings.push(format!("only the first {kept} events are kept; all are counted"));
        }
        warnings
    }

    /// As JSON.
    pub fn json(&self, study: &SystemStudy) -> Json {
        let (system, units) = (study.system(), study.units());
        let mut fields = Fields::in_units(units);
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("state_names", system.state_names());
        fields.nested("start", moment(study, self.start.time, &self.start.state));
        fields.nested("final", self.put_end(study));
        // The units are those of start and end.
        let events = self.history.events.iter().map(|event| event_of(study, event));
        fields.plain("events", events.collect::<Vec<Json>>());
        fields.list("contacts", self.put_contacts(system, units));
        if let Some(found) = &self.manoeuvre {
            fields.nested("manoeuvre", found.fields(|| Fields::in_units(units)));
        }
        if let Some(sound) = &self.sound {
            let mut inner = Fields::in_units(units);
            sound.state(&mut inner);
            fields.nested("sound", inner);
        }
        fields
            .plain("event_count", self.end.events)
            .nested("event_counts", put_counts(units, &self.totals()))
            .plain("steps", self.end.steps)
            .plain("near_tangential_releases", self.end.near_tangential_releases)
            .plain("tolerance", self.tolerance)
            .plain("warnings", self.warnings(study));
        fields.finish()
    }

    fn put_end(&self, study: &SystemStudy) -> Fields {
        let (system, units) = (study.system(), study.units());
        let mut fields = moment(study, self.end.time, &self.end.state);
        let contacts = system.contacts.iter().zip(&self.end.contacts).map(|(contact, end)| {
            let mut inner = Fields::in_units(units);
            inner
                .plain("name", contact.name.clone())
                .number("slip_velocity", Quantity::Velocity, end.slip_velocity)
                .plain("sticking", end.phase == ContactPhase::Stick)
                .plain("open", end.phase == ContactPhase::Open)
                .plain("slip_sign", end.phase.slip_sign())
                .number("friction", Quantity::Force, end.friction)
                .number("normal", Quantity::Force, end.normal_load);
            if let Some(bristle) = end.bristle {
                inner.number("bristle", Quantity::Displacement, bristle);
            }
            inner
        });
        fields.list("contacts", contacts.collect::<Vec<_>>());
        if let [only] = self.end.contacts.as_slice() {
            fields.number("friction", Quantity::Force, only.friction);
        }
        if let Some(bristle) = self.end.contacts.iter().find_map(|end| end.bristle) {
            fields.number("bristle", Quantity::Displacement, bristle);
        }
        fields
    }

    /// Counts and means of every contact over the run.
    fn put_contacts(&self, system: &System, units: UnitSystem) -> Vec<Fields> {
        let contacts = system.contacts.iter().enumerate().map(|(index, contact)| {
            let mut inner = Fields::in_units(units);
            inner
                .plain("name", contact.name.clone())
                .nested("event_counts", put_counts(units, &self.history.counts[index]));
            let means = self.means.as_ref().map(|means| means[index]);
            put_means(&mut inner, means.ok_or("the run has no duration"));
            inner
        });
        contacts.collect()
    }
}

/// A moment of the motion: its time, the observed displacement and velocity, and every number of the state.
fn moment(study: &SystemStudy, time: f64, state: &[f64]) -> Fields {
    let mut fields = Fields::in_units(study.units());
    let (displacement, velocity) = observed_state(study, state);
    let no_rate =
        || "the rate of a state of first-order equations is no part of the state".to_owned();
    fields
        .number("time", Quantity::Time, time)
        .number("displacement", Quantity::Displacement, displacement)
        .known("velocity", Quantity::Velocity, velocity.ok_or_else(no_rate))
        .plain("state", state.to_vec());
    fields
}

/// An event with its moment; one by one without a list of units, because a run may have millions.
fn event_of(study: &SystemStudy, event: &RecordedEvent) -> Json {
    let (displacement, velocity) = observed_state(study, &event.state);
    let mut object = Map::new();
    let mut put = |name: &str, value: Json| object.insert(name.to_owned(), value);
    put("time", event.time.into());
    put("contact", event.contact.into());
    put("kind", event.kind.name().into());
    put("slip_sign", event.slip_sign.into());
    put("displacement", displacement.into());
    if let Some(velocity) = velocity {
        put("velocity", velocity.into());
    }
    put("state", event.state.clone().into());
    Json::Object(object)
}

/// Counts kind by kind.
fn put_counts(units: UnitSystem, counts: &[u64; KINDS.len()]) -> Fields {
    let mut fields = Fields::in_units(units);
    for (kind, count) in KINDS.iter().zip(counts) {
        fields.plain(kind.name(), *count);
    }
    fields
}
