//! `[design]`: the least dither over a box of operating points.

mod tried;

use quell_design::least_dither::{DesignObjective, DesignStart, LimitedQuantity};
use quell_input::complaint::{Complaint, Fault};
use quell_input::document::{Node, Table, Value};
use quell_model::Waveform;
use quell_model::parameter::Bounds;
use quell_model::parameter::design::{CONFIDENCE, CONFIDENT, LIMITS, SAMPLES, SEED};
use serde_json::Value as Json;

use super::path::{self, LostPath};
use super::reader::{Found, Reader};
use super::system::PLACES;
use super::vocabulary::{Choice, DocumentKind, Section, join};
use tried::ChosenPeriods;

pub use tried::{BurstNumber, DitherPlace};

/// A number of the study with a range, in the unit of its key.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignRange {
    /// Path of the number, as it was written.
    pub path: String,
    /// Smallest value.
    pub from: f64,
    /// Largest value, not below the smallest.
    pub to: f64,
}

/// What `[design]` asks for.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// What is to be small.
    pub minimise: DesignObjective,
    /// The numbers to choose.
    pub vary: Vec<DesignRange>,
    /// The waveforms that are tried in turn, bursts of every chosen number of periods among them.
    pub waveforms: Vec<Waveform>,
    /// The numbers of bursts that are chosen, with their paths.
    pub periods: Vec<(String, BurstNumber)>,
    /// The places of the dither that are tried in turn; empty for the study's own.
    pub places: Vec<DitherPlace>,
    /// The runs that must end quiet.
    pub start: DesignStart,
    /// The box of operating points; empty for the study's own.
    pub over: Vec<DesignRange>,
    /// Limits in numbers of the equations.
    pub limits: Vec<(LimitedQuantity, f64)>,
    /// The share of random samples in which the dither is to be quiet, if it is asked for.
    pub confidence: Option<Confidence>,
}

/// A share of random samples of `[uncertainty]` in which a dither is to be quiet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Confidence {
    /// The share, above 0 and below 1.
    pub share: f64,
    /// Number of samples.
    pub samples: usize,
    /// Their seed.
    pub seed: u64,
}

/// Samples that lie beyond the share of a confidence by default, and the fewest and most samples by default.
const BEYOND: f64 = 20.0;
const DEFAULT_SAMPLES: (f64, f64) = (400.0, 100_000.0);

/// Seed by default, as that of `quell probability`.
const DEFAULT_SEED: f64 = 1.0;

/// The study whose dither is designed.
#[derive(Clone, Copy)]
pub(super) struct DesignContext<'a> {
    /// The waveform of the study's dither.
    pub(super) waveform: Option<&'a Waveform>,
    /// The document of the study.
    pub(super) document: &'a Table,
    /// The places of the dither that are tried.
    pub(super) places: &'a [DitherPlace],
}

impl DesignContext<'_> {
    /// The unit of the number that a path names, empty for a ratio.
    ///
    /// # Errors
    /// What is wrong with the path.
    fn unit_of(self, path: &str) -> Result<&'static str, LostPath> {
        let address = path::resolve(self.document, path)?;
        Ok(address.measured_in.filter(|unit| *unit != "1").unwrap_or_default())
    }
}

/// Reads `[design]`: `Some(None)` without it, `None` if it is invalid.
#[expect(clippy::option_option, reason = "invalid, absent, given")]
pub(super) fn read(
    reader: &mut Reader,
    root: &Table,
    context: DesignContext<'_>,
) -> Option<Option<Design>> {
    let Some(node) = root.get("design") else { return Some(None) };
    let table = reader.table("design", node)?;
    let before = reader.complaints_so_far();
    reader.unknown_keys(table, Section::Design, "design");
    if let Some(node) = table.get(PLACES).filter(|_| DocumentKind::of(root) != DocumentKind::System)
    {
        let allowed = "omitted: only in a system is there a choice of places; dither.direction says where the dither of a belt acts";
        let (key, null) = (join("design", PLACES), Json::Null);
        reader.complain(Complaint::new(Fault::Conflict, key, node.origin, null, allowed));
    }
    let minimise =
        reader.needed_choice(table, "design", node.origin, "minimise", Choice::Objective);
    let start = match table.get("start") {
        Some(node) => reader.choice("design.start", node, Choice::DesignStart),
        None => Some(DesignStart::Local.name()),
    };
    let vary = varied(reader, table, node, context);
    let over = operating_points(reader, table, context);
    let own = context.waveform;
    let waveforms = tried::waveforms(reader, table, own);
    let (vary, periods) = vary.unzip();
    let waveforms = match (waveforms, &periods) {
        (Some(waveforms), Some(periods)) => {
            let around = (context.places.len(), node.origin);
            tried::with_periods(reader, waveforms, periods, around)
        }
        _ => None,
    };
    let limits = limits(reader, table);
    let confidence = confidence(reader, table);
    if let (Some(vary), Some(over)) = (&vary, &over)
        && let Some(both) =
            over.iter().find(|range| vary.iter().any(|known| known.path == range.path))
    {
        let allowed =
            format!("{} is chosen by design.vary and cannot be an operating point too", both.path);
        let complaint =
            Complaint::new(Fault::Conflict, "design.over", node.origin, Json::Null, allowed);
        reader.complain(complaint);
    }
    let minimise = DesignObjective::ALL.into_iter().find(|known| Some(known.name()) == minimise)?;
    let start = DesignStart::ALL.into_iter().find(|known| Some(known.name()) == start)?;
    let design = Design {
        minimise,
        vary: vary?,
        waveforms: waveforms?,
        periods: periods?.into_iter().map(|known| (known.path, known.number)).collect(),
        places: context.places.to_vec(),
        start,
        over: over?,
        limits: limits?,
        confidence: confidence?,
    };
    (reader.complaints_so_far() == before).then_some(Some(design))
}

/// `vary`, `from` and `to`, lists of one length: numbers, and numbers of periods of bursts.
fn varied(
    reader: &mut Reader,
    table: &Table,
    header: &Node,
    context: DesignContext<'_>,
) -> Option<(Vec<DesignRange>, Vec<ChosenPeriods>)> {
    let mut list = |name: &str, what: &str| -> Option<Vec<Node>> {
        let key = join("design", name);
        let Some(node) = table.get(name) else {
            let allowed = format!("an array of {what}, one for each number to choose");
            reader.complain(Complaint::new(
                Fault::Missing,
                key,
                header.origin,
                Json::Null,
                allowed,
            ));
            return None;
        };
        match &node.value {
            Value::List(list) if !list.is_empty() => Some(list.clone()),
            _ => {
                reader.wrong(
                    &key,
                    node,
                    format!("an array of at least one of {what}; got {}", node.kind()),
                );
                None
            }
        }
    };
    let (paths, from, to) =
        (list("vary", "paths")?, list("from", "numbers")?, list("to", "numbers")?);
    if from.len() != paths.len() || to.len() != paths.len() {
        let allowed = format!("as many numbers in from and to as paths in vary, {}", paths.len());
        let complaint =
            Complaint::new(Fault::Conflict, "design.vary", header.origin, Json::Null, allowed);
        reader.complain(complaint);
        return None;
    }
    let mut ranges: Vec<Option<DesignRange>> = Vec::new();
    let mut periods: Vec<Option<ChosenPeriods>> = Vec::new();
    for (place, ((path, from), to)) in paths.iter().zip(&from).zip(&to).enumerate() {
        let key = format!("design.vary[{place}]");
        let keys = [format!("design.from[{place}]"), format!("design.to[{place}]")];
        let (keys, ends) = ([keys[0].as_str(), keys[1].as_str()], [from, to]);
        let Some(text) = reader.text(&key, path) else {
            ranges.push(None);
            continue;
        };
        if let Some((_, number)) = tried::of_burst(&text) {
            periods.push(tried::periods(reader, (&text, path), number, keys, ends));
            continue;
        }
        let named = named(reader, &key, path, &text, context);
        ranges.push(range(reader, named, keys, ends));
    }
    let ranges: Vec<DesignRange> = ranges.into_iter().collect::<Option<_>>()?;
    let periods: Vec<ChosenPeriods> = periods.into_iter().collect::<Option<_>>()?;
    let is_amplitude = |range: &&DesignRange| {
        range.path.rsplit_once('.').is_some_and(|(_, key)| key.starts_with("amplitude"))
    };
    let amplitude = ranges.iter().find(is_amplitude).map(|range| range.path.as_str());
    tried::check_periods(reader, &periods, amplitude)?;
    Some((ranges, periods))
}

/// `over`: ranges by path.
fn operating_points(
    reader: &mut Reader,
    table: &Table,
    context: DesignContext<'_>,
) -> Option<Vec<DesignRange>> {
    let Some(node) = table.get("over") else { return Some(Vec::new()) };
    let over = reader.table("design.over", node)?.clone();
    if over.iter().next().is_none() {
        reader.wrong(
            "design.over",
            node,
            "a table with at least one range, such as \"belt.belt_velocity\" = [0.05, 0.2]",
        );
        return None;
    }
    let mut ranges: Vec<Option<DesignRange>> = Vec::new();
    for (path, node) in over.iter() {
        let key = format!("design.over.\"{path}\"");
        let named = named(reader, &key, node, path, context);
        let Value::List(list) = &node.value else {
            reader.wrong(
                &key,
                node,
                format!("an array of the smallest and the largest value; got {}", node.kind()),
            );
            ranges.push(None);
            continue;
        };
        let [low, high] = list.as_slice() else {
            reader.wrong(
                &key,
                node,
                format!("the smallest and the largest value; got {} values", list.len()),
            );
            ranges.push(None);
            continue;
        };
        let keys = [format!("{key}[0]"), format!("{key}[1]")];
        ranges.push(range(reader, named, [&keys[0], &keys[1]], [low, high]));
    }
    ranges.into_iter().collect()
}

/// A path that names a number of the study, with the unit of the number.
fn named(
    reader: &mut Reader,
    key: &str,
    node: &Node,
    path: &str,
    context: DesignContext<'_>,
) -> Option<(String, &'static str)> {
    if path.starts_with("actuator.") {
        let allowed = "a path outside [actuator]: the actuator is not chosen, it limits the dither";
        reader.complain(Complaint::new(Fault::Value, key, node.origin, path, allowed));
        return None;
    }
    let lost = match context.unit_of(path) {
        Ok(unit) => return Some((path.to_owned(), unit)),
        Err(lost) => lost,
    };
    let allowed = "the path of a number in the study, such as \"dither.amplitude\"";
    let given = (node.origin, Json::from(path));
    reader.complain(lost.complaint(key, given, (Fault::Value, allowed)));
    None
}

/// A number with its range.
fn range(
    reader: &mut Reader,
    named: Option<(String, &'static str)>,
    keys: [&str; 2],
    nodes: [&Node; 2],
) -> Option<DesignRange> {
    let unit = named.as_ref().map_or("", |(_, unit)| unit);
    let mut end =
        |place: usize| reader.within(keys[place], nodes[place], Bounds::FINITE, unit, false);
    let (from, to) = (end(0), end(1));
    let (from, to) = (from?, to?);
    if from > to {
        reader.wrong(keys[1], nodes[1], format!("at least the smallest value, {from}"));
        return None;
    }
    Some(DesignRange { path: named?.0, from, to })
}

/// `confidence`, with `samples` and `seed`, which belong to it: `Some(None)` without it, `None` if it is invalid.
#[expect(clippy::option_option, reason = "invalid, absent, given")]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "whole numbers within the bounds of the registry"
)]
fn confidence(reader: &mut Reader, table: &Table) -> Option<Option<Confidence>> {
    let given = CONFIDENT.iter().find_map(|parameter| table.get(parameter.key()));
    let mut number = |parameter| reader.optional(table, "design", parameter);
    let (share, samples, seed) = (number(CONFIDENCE), number(SAMPLES), number(SEED));
    let Found::Value(share) = share else {
        let alone = matches!(share, Found::Absent);
        if let Some(node) = given.filter(|_| alone) {
            let allowed =
                "a number above 0 and below 1, such as 0.99, of which samples and seed are options";
            let (key, null) = (CONFIDENCE.path, Json::Null);
            reader.complain(Complaint::new(Fault::Missing, key, node.origin, null, allowed));
            return None;
        }
        return alone.then_some(None);
    };
    let default = (BEYOND / (1.0 - share)).ceil().clamp(DEFAULT_SAMPLES.0, DEFAULT_SAMPLES.1);
    Some(Some(Confidence {
        share,
        samples: samples.or(default)? as usize,
        seed: seed.or(DEFAULT_SEED)? as u64,
    }))
}

/// `[design.limits]`.
fn limits(reader: &mut Reader, table: &Table) -> Option<Vec<(LimitedQuantity, f64)>> {
    let Some(node) = table.get("limits") else { return Some(Vec::new()) };
    let prefix = Section::DesignLimits.path();
    let limits = reader.table(prefix, node)?;
    reader.unknown_keys(limits, Section::DesignLimits, prefix);
    let mut found = Vec::new();
    for (quantity, parameter) in LimitedQuantity::ALL.into_iter().zip(LIMITS) {
        match reader.optional(limits, prefix, *parameter) {
            Found::Absent => {}
            Found::Wrong => return None,
            Found::Value(value) => found.push((quantity, value)),
        }
    }
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_have_the_names_of_their_quantities() {
        for (quantity, parameter) in LimitedQuantity::ALL.into_iter().zip(LIMITS) {
            assert_eq!(quantity.name(), parameter.key());
        }
        assert_eq!(LimitedQuantity::ALL.len(), LIMITS.len());
    }
}
