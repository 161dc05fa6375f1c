//! The datasets of a motion: its samples and its events.

use quell_dynamics::motion::{ContactPhase, MotionSampler};
use quell_model::units::Quantity;

use super::Simulation;
use super::history::{KINDS, code};
use crate::dataset::{Array, Dataset};
use crate::run::system::start::observed_states;
use crate::study::SystemStudy;

/// What a contact does, as words with their codes.
const PHASES: [(u8, &str); 3] = [(0, "slip"), (1, "stick"), (2, "open")];

fn phase_code(phase: ContactPhase) -> u8 {
    match phase {
        ContactPhase::Slip(_) => 0,
        ContactPhase::Stick => 1,
        ContactPhase::Open => 2,
    }
}

/// Every `count`-th value from `first` on.
fn column(values: &[f64], first: usize, count: usize) -> Vec<f64> {
    values.iter().skip(first).step_by(count.max(1)).copied().collect()
}

fn unit_of(study: &SystemStudy, quantity: Option<Quantity>) -> &'static str {
    quantity.and_then(|quantity| study.units().unit(quantity)).unwrap_or("1")
}

/// Names of the columns of a state; the first columns have the other names.
fn columns(study: &SystemStudy) -> Vec<String> {
    let taken = |name: String| match name.as_str() {
        "time" | "displacement" | "velocity" => format!("displacement.{name}"),
        _ => name,
    };
    study.system().state_names().into_iter().map(taken).collect()
}

/// Adds columns of the observed displacement and its velocity, and one for every number of the states.
fn with_states(mut dataset: Dataset, study: &SystemStudy, states: &[f64]) -> Dataset {
    let size = columns(study).len();
    let (displacements, rates) = observed_states(study, states);
    let unit = |quantity| unit_of(study, Some(quantity));
    dataset = dataset.with(Array::new("displacement", unit(Quantity::Displacement), displacements));
    if let Some(rates) = rates {
        dataset = dataset.with(Array::new("velocity", unit(Quantity::Velocity), rates));
    }
    for (place, name) in columns(study).into_iter().enumerate() {
        let unit = unit_of(study, study.system().state_quantity(place));
        dataset = dataset.with(Array::new(name, unit, column(states, place, size)));
    }
    dataset
}

impl Simulation {
    /// The sampled motion: every number of the state, and slip velocity, friction, load and phase of every contact.
    pub fn dataset(&self, study: &SystemStudy, samples: &MotionSampler) -> Dataset {
        let axis = Array::new("time", unit_of(study, Some(Quantity::Time)), samples.times.clone());
        let dataset = Dataset::of(&study.into(), "simulate")
            .fact(format!("start: {}", self.start_in_words(study)))
            .with_axis(axis);
        let mut dataset = with_states(dataset, study, &samples.states);
        let contacts = &study.system().contacts;
        let force = unit_of(study, Some(Quantity::Force));
        let velocity = unit_of(study, Some(Quantity::Velocity));
        for (index, contact) in contacts.iter().enumerate() {
            let name = |what: &str| format!("{}.{what}", contact.name);
            let of = |values: &[f64]| column(values, index, contacts.len());
            let phases = samples.phases.iter().skip(index).step_by(contacts.len());
            let phases: Vec<u8> = phases.map(|phase| phase_code(*phase)).collect();
            dataset = dataset
                .with(Array::new(name("slip_velocity"), velocity, of(&samples.slip_velocities)))
                .with(Array::new(name("friction"), force, of(&samples.friction)))
                .with(Array::new(name("normal"), force, of(&samples.normal_loads)))
                .with(Array::of_words(name("phase"), PHASES.to_vec(), &phases));
        }
        dataset
    }

    /// The events, one row each.
    pub fn events_dataset(&self, study: &SystemStudy) -> Dataset {
        let events = &self.history.events;
        let rows = (1..=events.len()).map(|row| row as f64).collect();
        let codes: Vec<u8> = events.iter().map(|event| code(event.kind)).collect();
        let words = KINDS.iter().map(|kind| (code(*kind), kind.name())).collect();
        let times = events.iter().map(|event| event.time).collect();
        let contacts = events.iter().map(|event| event.contact as f64).collect();
        let signs = events.iter().map(|event| f64::from(event.slip_sign)).collect();
        let states: Vec<f64> = events.iter().flat_map(|event| event.state.clone()).collect();
        let dataset = Dataset::of(&study.into(), "simulate: events")
            .fact(format!("start: {}", self.start_in_words(study)))
            .axis("event", Quantity::Count, rows)
            .with(Array::new("time", unit_of(study, Some(Quantity::Time)), times))
            .with(Array::new("contact", "1", contacts))
            .with(Array::of_words("kind", words, &codes))
            .with(Array::new("slip_sign", "1", signs));
        with_states(dataset, study, &states)
    }
}
