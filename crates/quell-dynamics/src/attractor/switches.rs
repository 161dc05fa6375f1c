//! Thresholds of an initial-condition protocol: the values of a parameter at which runs from a given start begin or cease to
//! end on the base response.
//!
//! An answer for a start, next to the local one of the multipliers: attractors coexist, and from which start on the
//! dither quenches is another question than whether its response is stable. Where a run ends is decided by
//! [`settle()`](super::settle()), as everywhere.
//!
//! A ramp grows all amplitudes in equal steps, one a common period: the dither's phase goes on through them.

use quell_model::Belt;

use super::measure::ends_quietly;
use super::settle::{Outcome, Patience, Settled, settle};
use super::strobe::Scene;
use crate::orbit::family::{Forced, Setting};
use crate::orbit::threshold::NoThresholds;
use crate::orbit::{NoOrbit, Verdict, common_period};
use crate::simulation::{DEFAULT_TOLERANCE, Stalled, Start, simulate};

/// Half the width of an interval, relative to its value, up to which it is reported as a value: ten times what thresholds ask of
/// bisection (10⁻⁵). Wider intervals are those at which it stopped, and are reported with their error.
const NARROW: f64 = 1e-4;

/// For a run that cannot end on the base response, because that is unstable. What still moves after 2000 slow periods (at R = 10)
/// counts as vibrating: a response without slow motion that attracts more slowly than that is missed, which is so in a narrow
/// interval about a threshold.
const OFF_AN_UNSTABLE_BASE: Patience = Patience { periods: 20_000, ..Patience::SWEEP };

/// Where a run ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Reached {
    /// On the base response.
    Base,
    /// On another response without a slow motion of its own: of the dither's period, or of so few that all its lines lie above
    /// the band of slow vibration.
    Forced,
    /// On a response that vibrates slowly.
    Elsewhere,
    /// It had not settled when its time was over.
    Unsettled,
    /// The start, or the response with which it would be compared, was not found.
    Unknown,
}

impl Reached {
    /// Whether no slow motion of its own is left, and the self-excited vibration is over; `None` where that is not known.
    pub fn is_quiet(self) -> Option<bool> {
        match self {
            Self::Base | Self::Forced => Some(true),
            Self::Elsewhere => Some(false),
            Self::Unsettled | Self::Unknown => None,
        }
    }

    /// Whether both answer alike what a start is asked for: whether its run ends quietly.
    fn agrees(self, other: Self) -> bool {
        self == other || (self.is_quiet() == Some(true) && other.is_quiet() == Some(true))
    }

    fn of(scene: &Scene<'_>, settled: &Settled) -> Result<Self, Stalled> {
        Ok(match settled.outcome {
            Outcome::Quiet => Self::Base,
            Outcome::Elsewhere if ends_quietly(scene, settled)? => Self::Forced,
            Outcome::Elsewhere => Self::Elsewhere,
            Outcome::Unsettled(_) => Self::Unsettled,
        })
    }
}

/// Where the run of a belt from `start` ends. `start.time` is a whole number of common periods of the dithers.
///
/// # Errors
/// [`NoOrbit`]: no common period, or the engine stopped; and where the run has not settled and the base response, which it may be
/// nearing, could not be followed to the dither's amplitude.
pub fn reached(belt: &Belt, start: Start) -> Result<Reached, NoOrbit> {
    let scene = Scene::new(belt)?;
    let is_unstable = scene.quiet.as_ref().is_ok_and(|quiet| quiet.verdict == Verdict::Unstable);
    let patience = if is_unstable { OFF_AN_UNSTABLE_BASE } else { Patience::SWEEP };
    let settled = settle(&scene, start, patience).map_err(NoOrbit::Stalled)?;
    match (Reached::of(&scene, &settled).map_err(NoOrbit::Stalled)?, &scene.quiet) {
        (Reached::Unsettled, Err(why)) if !why.is_absence() => Err(*why),
        (Reached::Unsettled, _) if is_unstable => Ok(Reached::Elsewhere),
        (reached, _) => Ok(reached),
    }
}

/// Where a run is after its dither has grown from nothing over a time `over`, in equal steps, one a common period (at
/// least one). `over` = 0 is no ramp.
///
/// # Errors
/// [`NoOrbit`]: no common period, or the engine stopped.
pub fn ramped(belt: &Belt, start: Start, over: f64) -> Result<Start, NoOrbit> {
    if over <= 0.0 {
        return Ok(start);
    }
    let period = common_period(belt)?;
    let count = (over / period).ceil().max(1.0);
    let mut state = start;
    let mut number = 0.0;
    while number < count {
        let share = (number + 0.5) / count;
        let step = Forced { belt, setting: Setting::Share, periods: 1 }.belt_at(&[share])?;
        number += 1.0;
        let until = number.mul_add(period, start.time);
        state = simulate(&step, state, until, DEFAULT_TOLERANCE, &mut ())
            .map_err(NoOrbit::Stalled)?
            .restart();
    }
    Ok(state)
}

/// A value of the parameter at which the answer of a protocol changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Switch {
    /// The parameter.
    pub value: f64,
    /// Half the width of the interval in which the answer changes.
    pub error: f64,
    /// Where runs end for slightly larger values.
    pub becomes: Reached,
}

impl Switch {
    /// Whether the interval is narrow: bisection was not stopped by a value at which nothing is known.
    pub fn is_close(&self) -> bool {
        self.error <= NARROW * self.value.abs()
    }
}

/// Where the runs of a protocol end over a range of values.
#[derive(Clone, Debug, PartialEq)]
pub struct Switches {
    /// At the first value.
    pub first: Reached,
    /// Where that changes, in the order of the values.
    pub changes: Vec<Switch>,
    /// Values that were tried with [`Reached::Unknown`], and why.
    pub unknown: Vec<(f64, NoOrbit)>,
}

/// Values of `path` between `from` and `to` at which runs from `start` (a state for each belt) begin or cease to
/// end on the response of sliding (and where there is no start, because nothing is there to be quenched): `steps` values are
/// tried, and each change is bisected to `closeness` relative; where a third answer lies between two, no further than to it.
/// A pair of changes between two neighbouring values is missed.
///
/// # Errors
/// [`NoThresholds::Invalid`] where a value is not allowed.
pub fn switches(
    belt: &Belt,
    path: &str,
    (from, to): (f64, f64),
    steps: u32,
    closeness: f64,
    start: impl Fn(&Belt) -> Result<Option<Start>, NoOrbit>,
) -> Result<Switches, NoThresholds> {
    let found = |belt: &Belt| -> Result<Reached, NoOrbit> {
        start(belt)?.map_or(Ok(Reached::Base), |start| reached(belt, start))
    };
    let mut unknown = Vec::new();
    let mut tried = |value: f64| {
        let belt = belt.with(path, value).map_err(|_| NoThresholds::Invalid { value })?;
        Ok(found(&belt).unwrap_or_else(|why| {
            unknown.push((value, why));
            Reached::Unknown
        }))
    };
    let value = |k: u32| from + (to - from) * f64::from(k) / f64::from(steps.max(1));
    let mut changes = Vec::new();
    let first = tried(from)?;
    let mut last = first;
    for k in 1..=steps.max(1) {
        let next = tried(value(k))?;
        let ends = [(value(k - 1), last), (value(k), next)];
        bisected(&mut tried, ends, closeness, &mut changes)?;
        last = next;
    }
    Ok(Switches { first, changes, unknown })
}

/// The changes of the answer between two values at which it is known, in their order. Where a third answer lies between them
/// both ways to it are searched, unless it is that nothing is known there: the change then lies somewhere between.
fn bisected(
    tried: &mut impl FnMut(f64) -> Result<Reached, NoThresholds>,
    [(mut low, last), (mut high, next)]: [(f64, Reached); 2],
    closeness: f64,
    out: &mut Vec<Switch>,
) -> Result<(), NoThresholds> {
    if last.agrees(next) {
        return Ok(());
    }
    while (high - low).abs() > closeness * high.abs().max(low.abs()) {
        let middle = 0.5 * (low + high);
        match tried(middle)? {
            it if it.agrees(last) => low = middle,
            it if it.agrees(next) => high = middle,
            Reached::Unsettled | Reached::Unknown => break,
            third => {
                bisected(tried, [(low, last), (middle, third)], closeness, out)?;
                return bisected(tried, [(middle, third), (high, next)], closeness, out);
            }
        }
    }
    let (value, error) = (0.5 * (low + high), 0.5 * (high - low).abs());
    out.push(Switch { value, error, becomes: next });
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Answers of a parameter by the places where they begin.
    fn changes(answers: &[(f64, Reached)], closeness: f64) -> Vec<Switch> {
        let mut tried = |value: f64| {
            let found = answers.iter().rev().find(|it| it.0 <= value).expect("from 0 on");
            Ok(found.1)
        };
        let ends = [(0.0, answers[0].1), (1.0, answers[answers.len() - 1].1)];
        let mut found = Vec::new();
        bisected(&mut tried, ends, closeness, &mut found).expect("valid");
        found
    }

    /// A third answer between two is searched for on both sides.
    #[test]
    fn every_change_between_two_values_is_found() {
        use Reached::{Base, Elsewhere, Unknown};
        for (answers, expected) in [
            (vec![(0.0, Base), (0.3, Elsewhere)], vec![(0.3, Elsewhere)]),
            (
                vec![(0.0, Base), (0.4, Elsewhere), (0.6, Unknown)],
                vec![(0.4, Elsewhere), (0.6, Unknown)],
            ),
            (vec![(0.0, Base)], vec![]),
        ] {
            let found = changes(&answers, 1e-6);
            assert_eq!(found.len(), expected.len(), "{found:?}");
            for (change, (value, becomes)) in found.iter().zip(&expected) {
                assert!((change.value - value).abs() <= change.error && change.is_close());
                assert_eq!(change.becomes, *becomes);
            }
        }
        // Where the middle is unknown the change lies somewhere between, and the error says so.
        let found = changes(&[(0.0, Base), (0.4, Unknown), (0.6, Elsewhere)], 1e-6);
        assert_eq!((found.len(), found[0].error), (1, 0.5));
        assert!(!found[0].is_close());
    }
}
