//! The steady study of one moment of a study whose drive, load or dither varies in time, and what makes a study vary or not repeat.

use quell_input::complaint::{Complaint, Complaints, Fault, Origin};
use quell_input::document::{Node, Table, Value};
use quell_model::parameter::Parameter;
use quell_model::units::measure;
use quell_model::waveform::NOISE;
use serde_json::Value as Json;

use super::kind::Study;

impl Study {
    /// The table that makes the study vary in time, such as `belt.drive`; `None` for a steady study.
    pub fn varies_by(&self) -> Option<&'static str> {
        self.kind().template().varies_by()
    }

    /// The key of the first dither of noise, which has no period, such as `dither.waveform`; `None` where every dither is periodic.
    pub fn noise(&self) -> Option<String> {
        self.kind().template().noise()
    }

    /// The steady study with the velocities, loads and amplitudes of a time of its system.
    ///
    /// # Errors
    /// All complaints about the study of that moment: a belt that stands still or moves backwards is none.
    pub fn at_time(&self, time: f64) -> Result<Self, Complaints> {
        let mut document = self.source.document.clone();
        let mut changes = self.source.changes.clone();
        self.source.declared.template().freeze(&mut document, time)?;
        changes.push(format!("at_time={time:?}"));
        self.check_again(document, changes)
    }
}

/// Replaces a table over time by the constant value of its moment.
pub(super) fn replace(table: &mut Table, course: &str, parameter: Parameter, value: f64) {
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
pub(super) fn scale(table: &mut Table, index: usize, share: f64) -> Result<(), Complaints> {
    scale_by(table, &format!("dither[{index}]"), share, |name| name.starts_with("amplitude"))
}

/// Replaces an envelope by its share of the numbers of some keys.
pub(super) fn scale_by(
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
pub(super) fn each(
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
