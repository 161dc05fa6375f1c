//! Where a run from a given state ends: on the response that sliding becomes under dither, or elsewhere.
//!
//! An answer for a protocol, beside the local one of the multipliers: attractors coexist, and from which start on the
//! dither quenches is another question than whether its response is stable.
//!
//! Scheme: states once a period, compared with the orbit. Settled is what comes nearer than `NEAR`; away is
//! what has not come nearer over a whole block. A run that still comes nearer goes on, for near a threshold a
//! decay takes long and a small remnant says nothing. Limit: a run that dwells beside the
//! boundary of the basin for two blocks counts as away; that is an exponentially narrow range of parameters.

use quell_model::Belt;

use super::threshold::NoThresholds;
use super::{NoOrbit, Orbit, from_sliding};
use crate::simulation::{DEFAULT_TOLERANCE, Sample, Sampler, Stalled, Start, simulate};

/// Distance from the orbit, relative to F, that counts as being there.
const NEAR: f64 = 1e-6;

/// Length of a block, τ.
const BLOCK: f64 = 400.0;

/// Most blocks of a run.
const MOST_BLOCKS: u32 = 200;

/// Share by which the distance must fall over a block to count as coming nearer.
const NEARER: f64 = 1e-3;

/// Where a run ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Reached {
    /// On the response that sliding becomes under dither: quenched.
    Sliding,
    /// On another response.
    Elsewhere,
    /// It still came nearer when its time was over.
    Unsettled,
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
        let end = simulate(belt, state, until, DEFAULT_TOLERANCE, &mut sampler)?;
        let distance = |sample: &Sample| {
            let x = (sample.displacement - orbit.start.displacement).abs();
            x.max((sample.velocity - orbit.start.velocity).abs()) / scale
        };
        let last = sampler.samples.last().map_or(f64::INFINITY, distance);
        let most = sampler.samples.iter().map(distance).fold(0.0, f64::max);
        if last < NEAR {
            return Ok(Reached::Sliding);
        }
        if most > (1.0 - NEARER) * before {
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

/// A value of the parameter at which the answer of a protocol changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Switch {
    /// The parameter.
    pub value: f64,
    /// Where runs end for slightly larger values.
    pub becomes: Reached,
}

/// Values of `path` between `from` and `to` at which runs from `start` (a state for each belt) begin or cease to
/// end on the response of sliding: `steps` values are tried, and each change is bisected to `closeness`
/// relative. A pair of changes between two neighbouring values is missed.
///
/// # Errors
/// [`NoThresholds`] where an orbit is not found or a value not allowed.
pub fn switches(
    belt: &Belt,
    path: &str,
    (from, to): (f64, f64),
    steps: u32,
    closeness: f64,
    start: impl Fn(&Belt) -> Option<Start>,
) -> Result<Vec<Switch>, NoThresholds> {
    let ends = |value: f64| -> Result<Reached, NoThresholds> {
        let belt = belt.with(path, value).map_err(|_| NoThresholds::Invalid { value })?;
        let Some(start) = start(&belt) else { return Ok(Reached::Sliding) };
        let lost = |why| NoThresholds::Lost { at: value, why };
        let orbit = match from_sliding(&belt, 8) {
            Ok(orbit) => orbit,
            Err(NoOrbit::NotConverged { .. }) => return Ok(Reached::Elsewhere),
            Err(why) => return Err(lost(why)),
        };
        reached(&belt, &orbit, start).map_err(|why| lost(NoOrbit::Stalled(why)))
    };
    let value = |k: u32| from + (to - from) * f64::from(k) / f64::from(steps.max(1));
    let mut found = Vec::new();
    let mut last = ends(from)?;
    for k in 1..=steps.max(1) {
        let next = ends(value(k))?;
        if next != last {
            let (mut low, mut high) = (value(k - 1), value(k));
            while (high - low).abs() > closeness * high.abs().max(low.abs()) {
                let middle = 0.5 * (low + high);
                if ends(middle)? == last { low = middle } else { high = middle }
            }
            found.push(Switch { value: 0.5 * (low + high), becomes: next });
        }
        last = next;
    }
    Ok(found)
}
