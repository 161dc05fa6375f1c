//! Where a run of a system begins: the one place that decides it, for every verb.

use quell_dynamics::motion::MotionStart;
use quell_dynamics::orbit::{base_state, sliding_state, squealing_state};
use quell_model::System;
use quell_model::system::Mechanical;
use quell_model::units::measure;

use crate::complaint::{Complaint, Complaints, Failure, Fault, Origin};
use crate::dataset::{Array, Dataset};
use crate::nearest;
use crate::quantity;
use crate::study::{SystemStart, SystemStudy, UnitSystem};
use crate::words::{digits, unit_after};

/// Numbers of a state by their places in it.
pub type StateNumbers = Vec<(usize, f64)>;

/// Numbers of a state that a sentence lists.
const MOST_LISTED: usize = 8;

/// The observed displacement of a state and its velocity; no velocity for first-order equations.
pub(crate) fn observed_state(study: &SystemStudy, state: &[f64]) -> (f64, Option<f64>) {
    let row = study.observed_row();
    let over = |state: &[f64]| row.iter().zip(state).map(|(weight, x)| weight * x).sum();
    let velocities = study.system().structure.mechanical().map(Mechanical::size);
    (over(state), velocities.map(|from| over(&state[from..])))
}

/// The same of states one after the other.
pub fn observed_states(study: &SystemStudy, states: &[f64]) -> (Vec<f64>, Option<Vec<f64>>) {
    let states = states.chunks(study.system().state_size());
    let (displacements, rates): (Vec<f64>, Vec<Option<f64>>) =
        states.map(|state| observed_state(study, state)).unzip();
    let has_rates = study.system().structure.mechanical().is_some();
    (displacements, has_rates.then(|| rates.into_iter().flatten().collect()))
}

/// A dataset with one column for each number of a state, over states in its order.
pub(in crate::run) fn state_columns(
    dataset: Dataset,
    study: &SystemStudy,
    states: &[&[f64]],
) -> Dataset {
    let names = study.system().state_names().into_iter().enumerate();
    names.fold(dataset, |dataset, (place, name)| {
        let quantity = study.system().state_quantity(place);
        let unit = quantity.and_then(|quantity| study.units().unit(quantity)).unwrap_or("1");
        let values = states.iter().map(|state| state[place]).collect();
        dataset.with(Array::new(format!("state.{name}"), unit, values))
    })
}

/// The start of a study's runs.
///
/// # Errors
/// A complaint about a start that does not exist or is not available.
pub fn start_of(study: &SystemStudy) -> Result<MotionStart, Failure> {
    let system = study.system();
    let size = system.state_size();
    let refused = |name: &str, allowed: String| -> Failure {
        // The system of a belt has the document of the belt.
        let is_belt = study.document().get("belt").is_some();
        let key = if is_belt { "belt.initial.state" } else { "system.initial.state" };
        Complaint::new(Fault::Value, key, Origin::Whole, name, allowed).into()
    };
    // Steady sliding and squeal at the beginning are those of the drives, loads and amplitudes there.
    let first = if system.is_steady() { system.clone() } else { system.steady_at(0.0) };
    let mut state = match study.initial() {
        SystemStart::Rest => vec![0.0; size],
        SystemStart::Values(state) | SystemStart::Described { state, .. } => state.clone(),
        SystemStart::Sliding => sliding_state(&first)
            .map_err(|why| refused("sliding", format!("another state: {why}")))?,
        SystemStart::Squealing => {
            squealing_state(&first).map_err(|why| refused("squealing", why.to_string()))?
        }
        SystemStart::Base => {
            base_state(&first).map_err(|why| refused("base", format!("another state: {why}")))?
        }
    };
    // The contacts' own numbers begin at zero.
    state.resize(size, 0.0);
    Ok(MotionStart { time: 0.0, state })
}

/// [`start_of`] with some numbers replaced.
///
/// # Errors
/// As [`start_of`].
pub fn start_with(study: &SystemStudy, numbers: &StateNumbers) -> Result<MotionStart, Failure> {
    let mut start = start_of(study)?;
    for (place, value) in numbers {
        start.state[*place] = *value;
    }
    Ok(start)
}

/// Reads `name=value,…`, such as `x=0.1,velocity.x=-2`; of one coordinate also its displacement and velocity alone, such as `0.1,-2`.
///
/// # Errors
/// A complaint about every part.
pub fn read_state(study: &SystemStudy, text: &str) -> Result<StateNumbers, Complaints> {
    if let Some((x, v)) = text.split_once(',').filter(|_| !text.contains('=')) {
        return pair(study, (x.trim(), v.trim()));
    }
    let parts = text.split(',').map(|part| {
        if let Some((name, value)) = part.split_once('=') {
            return Ok((name.trim(), value.trim()));
        }
        let allowed = "name=value pairs with commas between them, such as x=0.1,velocity.x=-2";
        Err(Box::new(Complaint::option("--start", part.trim(), allowed)))
    });
    named(study, parts)
}

/// The complaint about a state given by two numbers.
fn unnamed(option: &'static str, given: &str) -> Complaint {
    let allowed = "name=value pairs such as x=0.1,velocity.x=-2: a system has many coordinates";
    Complaint::option(option, given, allowed)
}

/// Reads displacement and velocity of a system of one coordinate.
///
/// # Errors
/// A complaint about a number, or about several coordinates.
pub fn pair(study: &SystemStudy, (x, v): (&str, &str)) -> Result<StateNumbers, Complaints> {
    let system = study.system();
    if system.structure.mechanical().is_none_or(|mechanical| mechanical.size() != 1) {
        return Err(unnamed("--start", &format!("{x},{v}")).into());
    }
    let names = system.state_names();
    named(study, names.iter().map(String::as_str).zip([x, v]).map(Ok))
}

/// Reads pairs of a name and a value.
///
/// # Errors
/// A complaint about every pair.
pub fn named<'a>(
    study: &SystemStudy,
    pairs: impl Iterator<Item = Result<(&'a str, &'a str), Box<Complaint>>>,
) -> Result<StateNumbers, Complaints> {
    let system = study.system();
    let names = system.state_names();
    let mut numbers = StateNumbers::new();
    let mut wrong: Vec<Complaint> = Vec::new();
    for pair in pairs {
        let number = pair.and_then(|(name, text)| {
            let place = place_of(&names, name)?;
            if numbers.iter().any(|(known, _)| *known == place) {
                let allowed = format!("one value for {name}");
                return Err(Box::new(Complaint::option("--start", text, allowed)));
            }
            let quantity = system.state_quantity(place);
            Ok((place, quantity::number(text, quantity, study.units(), "--start")?))
        });
        match number {
            Ok(number) => numbers.push(number),
            Err(complaint) => wrong.push(*complaint),
        }
    }
    if wrong.is_empty() { Ok(numbers) } else { Err(wrong.into()) }
}

/// Reads how long a run lasts, in the units of the study: a plain number, or a time with its unit where the study has seconds.
///
/// # Errors
/// A complaint about `option`.
pub fn duration(
    study: &SystemStudy,
    text: &str,
    option: &'static str,
) -> Result<f64, Box<Complaint>> {
    match study.scaled_time() {
        Some(time) if time.plain_in_seconds || measure::has_unit(text) => {
            let seconds = quantity::duration(text, UnitSystem::Si, option)?;
            Ok(time.per_second * seconds)
        }
        _ => quantity::duration(text, study.units(), option),
    }
}

/// The place of a name in a state.
fn place_of(names: &[String], name: &str) -> Result<usize, Box<Complaint>> {
    names.iter().position(|known| known == name).ok_or_else(|| {
        let listed = names.iter().take(MOST_LISTED).cloned().collect::<Vec<_>>().join(", ");
        let more = if names.len() > MOST_LISTED { ", …" } else { "" };
        let allowed = format!("one of the names of the state, {listed}{more}");
        let nearest = nearest::word(name, names.iter().map(String::as_str));
        Box::new(Complaint::option("--start", name, allowed).suggesting(nearest))
    })
}

/// The start in words, such as "from rest".
pub fn start_in_words(study: &SystemStudy, numbers: &StateNumbers) -> String {
    if !numbers.is_empty() && *study.initial() == SystemStart::Rest {
        return format!("from {}", listed(study, numbers));
    }
    let from = match study.initial() {
        SystemStart::Rest => "from rest",
        SystemStart::Sliding => "from steady sliding",
        SystemStart::Squealing => "from the undithered limit cycle",
        SystemStart::Base => "from the base response",
        SystemStart::Values(_) => "from the initial state of the study",
        SystemStart::Described { words, .. } => &format!("from {words}"),
    };
    if numbers.is_empty() {
        return from.to_owned();
    }
    format!("{from} with {}", listed(study, numbers))
}

/// Numbers of a state with their names and units.
fn listed(study: &SystemStudy, numbers: &StateNumbers) -> String {
    let names = study.system().state_names();
    let given = numbers.iter().map(|(place, value)| {
        let quantity = study.system().state_quantity(*place);
        let unit = unit_after(quantity.and_then(|quantity| study.units().unit(quantity)));
        format!("{} = {}{unit}", names[*place], digits(*value))
    });
    given.collect::<Vec<_>>().join(", ")
}

/// A state in words, at most a few of its numbers.
pub fn state_in_words(system: &System, state: &[f64]) -> String {
    let names = system.state_names();
    let listed = names.iter().zip(state).take(MOST_LISTED);
    let listed = listed.map(|(name, value)| format!("{name} = {}", digits(*value)));
    let more = if state.len() > MOST_LISTED { ", …" } else { "" };
    format!("{}{more}", listed.collect::<Vec<_>>().join(", "))
}
