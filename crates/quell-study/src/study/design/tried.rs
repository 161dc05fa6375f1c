//! What a design tries in turn: waveforms, bursts of every chosen number of periods, and places of the dither.

use quell_input::complaint::{Complaint, Fault, Origin};
use quell_input::document::{Node, Table, Value};
use quell_model::Waveform;
use quell_model::waveform::Burst;
use serde_json::Value as Json;

use crate::study::reader::Reader;
use crate::study::vocabulary::Choice;

/// Dithers that a design tries at most, each of which is a search of its own.
const MOST_TRIED: usize = 100;

/// A number of a burst that a design chooses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BurstNumber {
    /// Periods of the carrier in a burst.
    On,
    /// Periods of the carrier in a pause.
    Off,
}

impl BurstNumber {
    /// The number of a burst.
    pub fn of(self, burst: &Burst) -> u32 {
        match self {
            Self::On => burst.on(),
            Self::Off => burst.off(),
        }
    }
}

/// A place of the dither that a design tries: the keys of a dither that say where it acts.
#[derive(Clone, Debug, PartialEq)]
pub struct DitherPlace {
    /// Where it acts, in words.
    pub name: String,
    pub(in crate::study) keys: Table,
}

/// A number of a burst that is chosen, with its path and its smallest and largest value.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ChosenPeriods {
    pub(super) path: String,
    pub(super) number: BurstNumber,
    range: (u32, u32),
    origin: Origin,
}

impl ChosenPeriods {
    /// The values.
    fn values(&self) -> impl Iterator<Item = u32> {
        self.range.0..=self.range.1
    }
}

/// The number of a burst that a path names, and the path of its dither.
pub(super) fn of_burst(path: &str) -> Option<(&str, BurstNumber)> {
    let (table, key) = path.trim().rsplit_once('.')?;
    let number = match key {
        "on" => BurstNumber::On,
        "off" => BurstNumber::Off,
        _ => return None,
    };
    (table == "dither" || table.starts_with("dither[")).then_some((table, number))
}

/// Whether two paths of dithers name the same one: an only dither needs no index.
fn is_same_dither(one: &str, other: &str) -> bool {
    let whole =
        |path: &str| if path == "dither" { "dither[0]".to_owned() } else { path.to_owned() };
    whole(one) == whole(other)
}

/// Reads the range of a number of a burst.
pub(super) fn periods(
    reader: &mut Reader,
    (path, path_node): (&str, &Node),
    number: BurstNumber,
    keys: [&str; 2],
    nodes: [&Node; 2],
) -> Option<ChosenPeriods> {
    let least = u32::from(number == BurstNumber::On);
    let most = u32::try_from(MOST_TRIED).unwrap_or(u32::MAX);
    let mut end = |place: usize| {
        let node: &Node = nodes[place];
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a whole number within these bounds"
        )]
        if let Value::Number(value) = node.value
            && value.fract() == 0.0
            && (f64::from(least)..=f64::from(most)).contains(&value)
        {
            return Some(value as u32);
        }
        let allowed = format!("a whole number of periods of the carrier, from {least} to {most}");
        reader.wrong(keys[place], node, allowed);
        None
    };
    let (from, to) = (end(0), end(1));
    let range = (from?, to?);
    if range.0 > range.1 {
        reader.wrong(keys[1], nodes[1], format!("at least the smallest value, {}", range.0));
        return None;
    }
    Some(ChosenPeriods { path: path.to_owned(), number, range, origin: path_node.origin })
}

/// Rejects numbers of bursts that the design cannot choose: those of another dither, and one number twice.
pub(super) fn check_periods(
    reader: &mut Reader,
    chosen: &[ChosenPeriods],
    amplitude: Option<&str>,
) -> Option<()> {
    let mut right = Some(());
    let mut complain = |periods: &ChosenPeriods, allowed: String| {
        let path = periods.path.as_str();
        let complaint =
            Complaint::new(Fault::Conflict, "design.vary", periods.origin, path, allowed);
        reader.complain(complaint);
        right = None;
    };
    let dither = amplitude.and_then(|path| path.rsplit_once('.')).map(|(table, _)| table);
    for (place, periods) in chosen.iter().enumerate() {
        let own = of_burst(&periods.path).map(|(table, _)| table);
        if let (Some(dither), Some(own)) = (dither, own)
            && !is_same_dither(dither, own)
        {
            complain(periods, format!("on or off of {dither}, whose amplitude is chosen"));
        } else if chosen[..place].iter().any(|known| known.number == periods.number) {
            complain(periods, "each number of a burst once".to_owned());
        }
    }
    right
}

/// The waveforms that are tried in turn: named ones, and that of the dither.
pub(super) fn waveforms(
    reader: &mut Reader,
    table: &Table,
    own: Option<&Waveform>,
) -> Option<Vec<Waveform>> {
    let Some(node) = table.get("waveforms") else {
        return Some(own.into_iter().cloned().collect());
    };
    let Value::List(list) = &node.value else {
        reader.wrong(
            "design.waveforms",
            node,
            format!("an array of waveforms; got {}", node.kind()),
        );
        return None;
    };
    let mut found: Vec<Option<Waveform>> = Vec::new();
    for (place, node) in list.iter().enumerate() {
        let key = format!("design.waveforms[{place}]");
        let Some(name) = reader.choice(&key, node, Choice::Waveform) else {
            found.push(None);
            continue;
        };
        let plain = Waveform::NAMED.iter().find(|known| known.name() == name);
        let known = plain.or_else(|| own.filter(|own| own.name() == name));
        if known.is_none() {
            reader.wrong(
                &key,
                node,
                "\"sine\", \"triangle\", \"square\", or the waveform of the study's dither",
            );
        }
        found.push(known.cloned());
    }
    if found.is_empty() {
        reader.wrong("design.waveforms", node, "an array of at least one waveform");
        return None;
    }
    found.into_iter().collect()
}

/// The waveforms, with bursts of every chosen number of periods in place of a burst, for a number of places.
pub(super) fn with_periods(
    reader: &mut Reader,
    waveforms: Vec<Waveform>,
    chosen: &[ChosenPeriods],
    (places, header): (usize, Origin),
) -> Option<Vec<Waveform>> {
    let is_burst = |waveform: &Waveform| matches!(waveform, Waveform::Burst(_));
    if let Some(first) = chosen.first()
        && !waveforms.iter().any(is_burst)
    {
        let allowed = "omitted: only bursts have it; let dither.waveform be \"burst\" and a waveform that is tried";
        let path = first.path.as_str();
        let key = "design.vary";
        reader.complain(Complaint::new(Fault::Conflict, key, first.origin, path, allowed));
        return None;
    }
    let count = |number| {
        let values = chosen.iter().find(|known| known.number == number);
        values.map_or(1, |known| known.values().count())
    };
    let of_burst = count(BurstNumber::On) * count(BurstNumber::Off);
    let bursts = waveforms.iter().filter(|waveform| is_burst(waveform)).count();
    let tried = (bursts * of_burst + waveforms.len() - bursts) * places.max(1);
    if tried > MOST_TRIED {
        let allowed = format!(
            "at most {MOST_TRIED} dithers to try, waveforms times places: choose fewer numbers of periods"
        );
        let origin = chosen.first().map_or(header, |first| first.origin);
        reader.complain(Complaint::new(Fault::Value, "design", origin, tried, allowed));
        return None;
    }
    let mut found = Vec::new();
    for waveform in waveforms {
        match &waveform {
            Waveform::Burst(burst) if !chosen.is_empty() => {
                found.extend(of_every_number(reader, burst, chosen)?);
            }
            _ => found.push(waveform),
        }
    }
    Some(found)
}

/// Bursts with every chosen number of periods.
fn of_every_number(
    reader: &mut Reader,
    burst: &Burst,
    chosen: &[ChosenPeriods],
) -> Option<Vec<Waveform>> {
    let values = |number: BurstNumber| -> Vec<u32> {
        let known = chosen.iter().find(|known| known.number == number);
        known.map_or_else(|| vec![number.of(burst)], |known| known.values().collect())
    };
    let mut found = Vec::new();
    for on in values(BurstNumber::On) {
        for off in values(BurstNumber::Off) {
            match Burst::new(burst.carrier().clone(), on, off) {
                Ok(burst) => {
                    // Without a pause every burst is its carrier.
                    let waveform = burst.into_waveform();
                    if !found.contains(&waveform) {
                        found.push(waveform);
                    }
                }
                Err(why) => {
                    let origin = chosen.first().map_or(Origin::Whole, |first| first.origin);
                    let key = format!("dither.{}", why.key);
                    let complaint =
                        Complaint::new(Fault::Value, key, origin, Json::Null, why.allowed);
                    reader.complain(complaint);
                    return None;
                }
            }
        }
    }
    Some(found)
}
