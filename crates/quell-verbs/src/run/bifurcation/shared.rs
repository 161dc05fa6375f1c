//! Of sweeps: directions, jumps, and ranges in which the two directions differ.

use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

use crate::fields::Fields;
use crate::run::varied::Range;

/// Options of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepRequest {
    /// The parameter and its values.
    pub range: Range,
    /// Whether it is swept up.
    pub up: bool,
    /// Whether it is swept down.
    pub down: bool,
}

/// Direction of a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SweepDirection {
    /// To larger values.
    Up,
    /// To smaller values.
    Down,
}

impl SweepDirection {
    /// Word in outputs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Up => "up",
            Self::Down => "down",
        }
    }
}

/// The requested directions in the order of the sweeps; both by default.
pub(super) fn directions(request: &SweepRequest) -> Vec<SweepDirection> {
    let (up, down) =
        if request.up || request.down { (request.up, request.down) } else { (true, true) };
    let asked = [(up, SweepDirection::Up), (down, SweepDirection::Down)];
    asked.into_iter().filter(|(on, _)| *on).map(|(_, direction)| direction).collect()
}

/// The places of neighbouring points of known quiescence that differ in it.
pub(super) fn changes(quiet: impl Iterator<Item = Option<bool>>) -> Vec<(usize, usize)> {
    let known: Vec<(usize, bool)> =
        quiet.enumerate().filter_map(|(place, quiet)| Some((place, quiet?))).collect();
    let pairs = known.windows(2).filter(|pair| pair[0].1 != pair[1].1);
    pairs.map(|pair| (pair[0].0, pair[1].0)).collect()
}

/// First and last value of each range of neighbouring values at which both directions differ.
pub(super) fn ranges(apart: impl Iterator<Item = (f64, bool)>) -> Vec<RealInterval> {
    let mut ranges: Vec<RealInterval> = Vec::new();
    let mut open = false;
    for (value, apart) in apart {
        match (apart, ranges.last_mut()) {
            (true, Some(last)) if open => last.upper = value,
            (true, _) => ranges.push(RealInterval::new(value, value)),
            (false, _) => {}
        }
        open = apart;
    }
    ranges
}

/// The sentence on hysteresis; `known` says at each value whether both directions have a known motion. `noun` is the plural of
/// what a sweep is on.
pub(super) fn hysteresis_sentence(
    ranges: &[RealInterval],
    known: &[bool],
    noun: &str,
    value: impl Fn(f64) -> String,
) -> String {
    if !ranges.is_empty() {
        let parts = ranges.iter().map(|RealInterval { lower: from, upper: to }| {
            if from == to {
                format!("at {}", value(*from))
            } else {
                format!("from {} to {}", value(*from), value(*to))
            }
        });
        let parts = parts.collect::<Vec<_>>().join(" and ");
        return format!("The two directions differ {parts}, where {noun} coexist.");
    }
    if known.iter().all(|known| *known) {
        return format!(
            "Both directions show {noun} of the same size: these sweeps show no hysteresis."
        );
    }
    if known.contains(&true) {
        return format!("Both directions show {noun} of the same size wherever both have settled.");
    }
    "The two directions have not both settled at any value.".to_owned()
}

/// The jumps of all branches and the ranges of hysteresis as fields.
pub(super) fn put_comparison(
    fields: &mut Fields,
    jumps: Vec<Fields>,
    ranges: Option<&[RealInterval]>,
) {
    fields.list("jumps", jumps);
    match ranges {
        Some(ranges) => {
            let pairs = ranges.iter().map(|range| vec![range.lower, range.upper].into());
            fields.plain("hysteresis", pairs.collect::<Vec<Json>>());
        }
        None => {
            fields.unknown("hysteresis", "hysteresis requires sweeps in both directions");
        }
    }
}

/// One jump; `object` is an empty object with the units of the study.
pub(super) fn jump(
    mut object: Fields,
    direction: SweepDirection,
    (before, after): (f64, f64),
    to_quiet: bool,
) -> Fields {
    object
        .plain("direction", direction.name())
        .plain("before", before)
        .plain("after", after)
        .plain("becomes", if to_quiet { "quiet" } else { "not quiet" });
    object
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn jumps_pass_over_unknown_points() {
        let quiet =
            [Some(true), None, Some(true), None, Some(false), Some(false), None, Some(true)];
        assert_eq!(changes(quiet.into_iter()), [(2, 4), (5, 7)]);
    }

    #[test]
    fn neighbouring_values_form_ranges() {
        let apart = [false, true, true, false, true].into_iter().enumerate();
        let found = ranges(apart.map(|(place, apart)| (place as f64, apart)));
        assert_eq!(found, [RealInterval::new(1.0, 2.0), RealInterval::new(4.0, 4.0)]);
    }
}
