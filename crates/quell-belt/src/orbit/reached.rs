//! Where a run from a given state ends: on the response that sliding becomes under dither, or elsewhere.
//!
//! An answer for a protocol, beside the local one of the multipliers: attractors coexist, and from which start on the
//! dither quenches is another question than whether its response is stable.
//!
//! Scheme: states once a period, compared with the orbit. Settled is what comes nearer than `NEAR`; away is
//! what has not come nearer over a whole block, while it is on something that attracts. A run that still comes nearer
//! goes on, for near a threshold a decay takes long and a small remnant says nothing: the rate decides. A run that dwells in
//! slip where areas grow, ∫(2ζ + μ′N)dτ < 0 over a block, is not on an attractor however steady it looks: it is
//! beside the unstable curve between two basins, and goes on too, until it leaves or is told as unsettled.
//!
//! A ramp grows all amplitudes in equal steps, one a common period: the dither's phase goes on through them.

use std::sync::LazyLock;

use quell_model::Belt;
use quell_model::friction::{LawVisitor, SlidingLaw};
use quell_numerics::gauss_legendre::GaussLegendre;

use super::family::{Forced, Setting};
use super::threshold::NoThresholds;
use super::{NoOrbit, Orbit, Verdict, common_period, near, quiet};
use crate::simulation::{
    DEFAULT_TOLERANCE, Event, Observer, Sample, Sampler, Segment, Stalled, Start, simulate,
};

/// Distance from the orbit, relative to F, that counts as being there.
const NEAR: f64 = 1e-6;

/// Length of a block, τ.
const BLOCK: f64 = 400.0;

/// Most blocks of a run.
const MOST_BLOCKS: u32 = 200;

/// Share by which the distance must fall over a block to count as coming nearer.
const NEARER: f64 = 1e-3;

/// Time for which a run settles before its period is looked for, τ, and how often that is done.
const SETTLE: (f64, u32) = (2000.0, 6);

/// Half the width of an interval, relative to its place, up to which it is told as a value: ten times what thresholds ask of
/// bisection (10⁻⁵). Wider intervals are those at which it stopped, and are told with their error.
const NARROW: f64 = 1e-4;

/// Closeness of two states of a run, relative to F, that may be the same of a periodic orbit.
const AGAIN: f64 = 1e-5;

/// Where a run ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Reached {
    /// On the response that sliding becomes under dither: quenched.
    Sliding,
    /// On another response.
    Elsewhere,
    /// It still came nearer when its time was over.
    Unsettled,
    /// The start, or the response with which it would be compared, was not found.
    Unknown,
}

/// Where the run of a belt from `start` ends. The dither runs on from its phase at `start.time`.
///
/// # Errors
/// [`Stalled`].
pub fn reached(belt: &Belt, orbit: &Orbit, start: Start) -> Result<Reached, Stalled> {
    let scale = belt.normal_load();
    let mut state = start;
    // Moments at which the dither has the phase that it has at the orbit's start.
    let periods_before = (start.time / orbit.period).ceil();
    let mut first = periods_before * orbit.period;
    let count = (BLOCK / orbit.period).ceil().max(8.0);
    let mut before = f64::INFINITY;
    let mut lasting = 0;
    for _ in 0..MOST_BLOCKS {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
        let mut sampler = Sampler::new(first, orbit.period, count as usize);
        let until = first + (count - 1.0) * orbit.period;
        let mut watch = (&mut sampler, Areas::new(belt));
        let end = simulate(belt, state, until, DEFAULT_TOLERANCE, &mut watch)?;
        let dwells = watch.1.grow();
        let distance = |sample: &Sample| {
            let x = (sample.displacement - orbit.start.displacement).abs();
            x.max((sample.velocity - orbit.start.velocity).abs()) / scale
        };
        let last = sampler.samples.last().map_or(f64::INFINITY, distance);
        let most = sampler.samples.iter().map(distance).fold(0.0, f64::max);
        // Nothing ends on an unstable orbit: what is this near to one is another, small one around it, or leaves it.
        if last < NEAR && orbit.verdict() != Verdict::Unstable {
            return Ok(Reached::Sliding);
        }
        if most > (1.0 - NEARER) * before && !dwells {
            lasting += 1;
            if lasting == 2 {
                return Ok(Reached::Elsewhere);
            }
        } else {
            lasting = 0;
        }
        before = most;
        state = end.restart();
        first = until + orbit.period;
    }
    Ok(Reached::Unsettled)
}

/// Whether areas of the phase plane grow along a run: in slip alone, ∫(2ζ + μ′N)dτ < 0.
struct Areas<'a> {
    belt: &'a Belt,
    damping: f64,
    touched: bool,
}

/// Two nodes on [0, 1]: the sign of an integral over many steps is all that is asked.
static RULE: LazyLock<[[f64; 2]; 2]> = LazyLock::new(|| GaussLegendre::new(2).on_unit_interval());

impl<'a> Areas<'a> {
    fn new(belt: &'a Belt) -> Self {
        Self { belt, damping: 0.0, touched: false }
    }

    fn grow(&self) -> bool {
        !self.touched && self.damping < 0.0
    }
}

impl Observer for Areas<'_> {
    fn segment(&mut self, segment: &Segment<'_>) {
        if segment.slip_sign() == 0 {
            self.touched = true;
        } else if !self.touched {
            let rate = Rate { belt: self.belt, segment };
            self.damping += self.belt.friction().visit(rate);
        }
    }

    fn event(&mut self, _: &Event) {
        self.touched = true;
    }
}

/// ∫(2ζ + μ′N)dτ over a segment.
struct Rate<'a, 's, 'c> {
    belt: &'a Belt,
    segment: &'s Segment<'c>,
}

impl LawVisitor for Rate<'_, '_, '_> {
    type Output = f64;

    fn visit<L: SlidingLaw>(self, law: &L) -> f64 {
        let Self { belt, segment } = self;
        let h = segment.duration();
        let at = |node: f64| {
            let since = node * h;
            let load = belt.normal_load_at(segment.clock().time() + since);
            belt.damping_rate(law.slope(segment.slip_velocity(since).abs()), load)
        };
        let [nodes, weights] = &*RULE;
        h * nodes.iter().zip(weights).map(|(node, weight)| weight * at(*node)).sum::<f64>()
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

/// The periodic orbit on which a run from a state at τ = 0 ends, of up to `most` common periods.
///
/// # Errors
/// [`NoOrbit`]; [`NoOrbit::NoPeriod`] where the run does not come back to itself, slow as it may be or not periodic.
pub fn orbit_reached(belt: &Belt, start: Start, most: u32) -> Result<Orbit, NoOrbit> {
    let period = common_period(belt)?;
    let mut state = start;
    for _ in 0..SETTLE.1 {
        let count = (SETTLE.0 / period).ceil();
        let first = ((state.time / period).round() + count) * period;
        let mut sampler = Sampler::new(first, period, most as usize + 1);
        let until = f64::from(most).mul_add(period, first);
        let end = simulate(belt, state, until, DEFAULT_TOLERANCE, &mut sampler)
            .map_err(NoOrbit::Stalled)?;
        if let Some(last) = sampler.samples.last() {
            let again = |n: u32| {
                let before = sampler.samples.len().checked_sub(1 + n as usize)?;
                let sample = sampler.samples.get(before)?;
                let off = (sample.displacement - last.displacement).abs();
                let off = off.max((sample.velocity - last.velocity).abs());
                (off < AGAIN * belt.normal_load()).then_some(n)
            };
            if let Some(periods) = (1..=most).find_map(again) {
                let guess =
                    Start { time: 0.0, displacement: last.displacement, velocity: last.velocity };
                let orbit = near(belt, guess, periods)?;
                return Ok(shortest(belt, orbit, periods));
            }
        }
        state = end.restart();
    }
    Err(NoOrbit::NoPeriod { most })
}

/// The orbit with its own period, where it is a part of the one that was found: a slow spiral comes near to itself after
/// many periods before it does after one.
fn shortest(belt: &Belt, orbit: Orbit, periods: u32) -> Orbit {
    let same = |part: &Orbit| {
        let off = (part.start.displacement - orbit.start.displacement).abs();
        let off = off.max((part.start.velocity - orbit.start.velocity).abs());
        off < AGAIN * belt.normal_load()
    };
    (1..periods)
        .filter(|part| periods.is_multiple_of(*part))
        .find_map(|part| near(belt, orbit.start, part).ok().filter(same))
        .unwrap_or(orbit)
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
        let Some(start) = start(belt)? else { return Ok(Reached::Sliding) };
        let orbit = match quiet(belt, 8) {
            Ok(orbit) => orbit,
            // Where sliding becomes no response there is nothing to be quenched to.
            Err(NoOrbit::Ends { .. } | NoOrbit::Degenerate { .. } | NoOrbit::Another { .. }) => {
                return Ok(Reached::Elsewhere);
            }
            Err(why) => return Err(why),
        };
        reached(belt, &orbit, start).map_err(NoOrbit::Stalled)
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
    if last == next {
        return Ok(());
    }
    while (high - low).abs() > closeness * high.abs().max(low.abs()) {
        let middle = 0.5 * (low + high);
        match tried(middle)? {
            it if it == last => low = middle,
            it if it == next => high = middle,
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
        use Reached::{Elsewhere, Sliding, Unknown};
        for (answers, expected) in [
            (vec![(0.0, Sliding), (0.3, Elsewhere)], vec![(0.3, Elsewhere)]),
            (
                vec![(0.0, Sliding), (0.4, Elsewhere), (0.6, Unknown)],
                vec![(0.4, Elsewhere), (0.6, Unknown)],
            ),
            (vec![(0.0, Sliding)], vec![]),
        ] {
            let found = changes(&answers, 1e-6);
            assert_eq!(found.len(), expected.len(), "{found:?}");
            for (change, (value, becomes)) in found.iter().zip(&expected) {
                assert!((change.value - value).abs() <= change.error && change.is_close());
                assert_eq!(change.becomes, *becomes);
            }
        }
        // Where the middle is unknown the change lies somewhere between, and the error says so.
        let found = changes(&[(0.0, Sliding), (0.4, Unknown), (0.6, Elsewhere)], 1e-6);
        assert_eq!((found.len(), found[0].error), (1, 0.5));
        assert!(!found[0].is_close());
    }
}
