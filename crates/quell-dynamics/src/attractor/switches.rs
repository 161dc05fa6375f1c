//! Thresholds of an initial-condition protocol: the values of a parameter at which runs from a given state begin or stop
//! settling on the base response.
//!
//! These thresholds depend on the start, unlike the local ones of the multipliers: attractors coexist, so that quenching from a
//! given start and stability of the response are different questions. Where a run settles is decided by
//! [`settle()`](super::settle()), as everywhere.
//!
//! A ramp increases all amplitudes in equal steps, one per common period; the phase of the dither is continuous across steps.

use quell_model::Belt;

use super::base_response::BaseResponse;
use super::measure::is_quiescent;
use super::settings::AttractorSettings;
use super::settle::{Patience, SettleOutcome, Settled, settle};
use crate::orbit::family::{BeltAt, FamilyParameters, Forced};
use crate::orbit::threshold::NoThresholds;
use crate::orbit::{NoOrbit, OrbitVerdict, common_period};
use crate::simulation::{DEFAULT_TOLERANCE, Stalled, Start, simulate};

/// The relative closeness to which the changes of runs are bisected, in thresholds and designs alike.
pub const SWITCH_CLOSENESS: f64 = 1e-5;

/// Half the width of an interval, relative to its value, up to which it is reported as a single value: ten times
/// [`SWITCH_CLOSENESS`]. Wider intervals are those at which bisection stopped, and are reported with
/// their error. With a larger bound such an interval would be reported as a value; with a smaller one
/// an ordinary threshold would be reported as an interval.
const NARROW: f64 = 1e-4;

/// For a run that cannot settle on the base response, because that is unstable. A run that still moves after 2000 slow periods
/// (at R = 10) counts as vibrating: a response without slow motion that attracts more slowly than that is missed, in a narrow
/// interval around a threshold.
const OFF_AN_UNSTABLE_BASE: Patience = Patience { periods: 20_000, ..Patience::SWEEP };

/// Where a run settles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Reached {
    /// On the base response.
    Base,
    /// On another response without slow motion of its own: of the dither's period, or of so few periods that all its spectral
    /// lines are above the band of slow vibration.
    Forced,
    /// On a response that vibrates slowly.
    Elsewhere,
    /// It had not settled when its periods were used up.
    Unsettled,
    /// The start, or the base response for the comparison, was not found.
    Unknown,
}

impl Reached {
    /// Whether it is quiescent, without slow motion of its own, so that the self-excited vibration has ended; `None` if unknown.
    pub fn is_quiet(self) -> Option<bool> {
        match self {
            Self::Base | Self::Forced => Some(true),
            Self::Elsewhere => Some(false),
            Self::Unsettled | Self::Unknown => None,
        }
    }

    /// Whether both give the same answer for a start: whether its run is quiescent in the end.
    fn agrees(self, other: Self) -> bool {
        self == other || (self.is_quiet() == Some(true) && other.is_quiet() == Some(true))
    }

    fn of(settings: &AttractorSettings<'_>, settled: &Settled) -> Result<Self, Stalled> {
        Ok(match settled.outcome {
            SettleOutcome::Base => Self::Base,
            SettleOutcome::Elsewhere if is_quiescent(settings, settled)? => Self::Forced,
            SettleOutcome::Elsewhere => Self::Elsewhere,
            SettleOutcome::Unsettled(_) => Self::Unsettled,
        })
    }
}

/// Where the run of a belt from `start` settles. `start.time` is a whole number of common periods of the dithers.
///
/// # Errors
/// [`NoOrbit`]: no common period, or the engine stopped; also if the run has not settled and the base response, to which it may
/// be converging, could not be followed to the dither's amplitude.
pub fn reached(belt: &Belt, start: Start) -> Result<Reached, NoOrbit> {
    Ok(reached_at(belt, start)?.0)
}

/// [`reached`] with a state of the response at τ = 0 modulo the period: of the base response its own, otherwise the last one of the run.
pub(crate) fn reached_at(belt: &Belt, start: Start) -> Result<(Reached, Start), NoOrbit> {
    let settings = AttractorSettings::new(belt)?;
    let is_unstable =
        settings.base.as_ref().is_ok_and(|base| base.verdict == OrbitVerdict::Unstable);
    let patience = if is_unstable { OFF_AN_UNSTABLE_BASE } else { Patience::SWEEP };
    let settled = settle(&settings, start, patience).map_err(NoOrbit::Stalled)?;
    match (Reached::of(&settings, &settled).map_err(NoOrbit::Stalled)?, &settings.base) {
        (Reached::Unsettled, Err(why)) if !why.is_absence() => Err(*why),
        (Reached::Unsettled, _) if is_unstable => Ok((Reached::Elsewhere, settled.state)),
        (Reached::Base, Ok(base)) => {
            let BaseResponse { displacement, velocity, .. } = *base;
            Ok((Reached::Base, Start { time: 0.0, displacement, velocity }))
        }
        (reached, _) => Ok((reached, settled.state)),
    }
}

/// The state of a run after its dither has grown from zero over a time `over`, in equal steps, one per common period (at
/// least one). `over` = 0 means no ramp.
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
        let factor = (number + 0.5) / count;
        let family = Forced { belt, parameters: FamilyParameters::CommonFactor, periods: 1 };
        let step = family.belt_at(&[factor])?;
        number += 1.0;
        let until = number.mul_add(period, start.time);
        state = simulate(&step, state, until, DEFAULT_TOLERANCE, &mut ())
            .map_err(NoOrbit::Stalled)?
            .restart();
    }
    Ok(state)
}

/// A value of the parameter at which the result of a protocol changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Switch {
    /// The parameter.
    pub value: f64,
    /// Half the width of the interval in which the result changes.
    pub error: f64,
    /// Where runs settle for slightly larger values.
    pub becomes: Reached,
}

impl Switch {
    /// Whether the interval is narrow: bisection was not stopped by a value with an unknown result.
    pub fn is_close(&self) -> bool {
        self.error <= NARROW * self.value.abs()
    }
}

/// Where the runs of a protocol settle over a range of values.
#[derive(Clone, Debug, PartialEq)]
pub struct Switches {
    /// The result at the first value.
    pub first: Reached,
    /// The values at which it changes, in order.
    pub changes: Vec<Switch>,
    /// The values with [`Reached::Unknown`], and the reason.
    pub unknown: Vec<(f64, NoOrbit)>,
}

/// Values between `from` and `to` at which runs from `start` (a state for each belt) begin or stop
/// settling on the base response. A belt without a start has nothing to quench and counts as settling on it. `steps` values are
/// tried, and each change is bisected to the relative `closeness`; if a third result is found between two, both changes next to
/// it are bisected. A pair of changes between two neighbouring values is missed.
///
/// # Errors
/// [`NoThresholds::Invalid`] if a value is not allowed.
pub fn switches(
    at: BeltAt<'_>,
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
        let belt = at(&[value]).ok_or(NoThresholds::Invalid { value })?;
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

/// The changes of the result between two values, in order. If a third result is found between them, both sides of it are
/// searched, unless it is unknown or unsettled: the change is then somewhere between the two values.
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
            reached if reached.agrees(last) => low = middle,
            reached if reached.agrees(next) => high = middle,
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

    /// The results over a parameter, each with the value from which it applies.
    fn changes(answers: &[(f64, Reached)], closeness: f64) -> Vec<Switch> {
        let mut tried = |value: f64| {
            let found = answers.iter().rev().find(|(from, _)| *from <= value).expect("from 0 on");
            Ok(found.1)
        };
        let ends = [(0.0, answers[0].1), (1.0, answers[answers.len() - 1].1)];
        let mut found = Vec::new();
        bisected(&mut tried, ends, closeness, &mut found).expect("valid");
        found
    }

    /// A third result between two is searched on both sides.
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
        // If the middle is unknown the change is somewhere between, and the error covers the interval.
        let found = changes(&[(0.0, Base), (0.4, Unknown), (0.6, Elsewhere)], 1e-6);
        assert_eq!((found.len(), found[0].error), (1, 0.5));
        assert!(!found[0].is_close());
    }
}
