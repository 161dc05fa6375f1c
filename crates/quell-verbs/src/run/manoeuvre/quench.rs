//! How soon a dither quenches a vibration, each time it is switched on.

use quell_model::System;
use quell_model::profile::{Knots, Profile};

use super::interval::{VibrationInterval, VibrationLevel};

/// Share of the range of an envelope below which the dither is off.
const OFF: f64 = 1e-3;

/// Relative change of a drive or a load that counts.
const CHANGE: f64 = 0.01;

/// Moments at which a drive or a load is compared.
const MOMENTS: u32 = 16;

/// A time in which the dither is on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OnPhase {
    /// When its amplitude begins to rise from its least share.
    pub from: f64,
    /// When it begins to return there; infinite if it does not.
    pub to: f64,
}

/// What changes around a run.
pub struct RunConditions<'a> {
    /// When the first dither that is switched on is on.
    pub phases: Vec<OnPhase>,
    /// The time from which every surface is at rest; infinite if one moves.
    pub rest: f64,
    /// Whether a drive or a load changes between two times.
    pub changes: &'a dyn Fn(f64, f64) -> bool,
}

/// A quantity, or why it is unknown.
type Known = Result<f64, &'static str>;

/// What the dither does when it is switched on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DitherSwitching {
    /// When it is on.
    pub on: OnPhase,
    /// Time from there until the vibration has ended for as long as the dither is on; or why it is unknown.
    pub time: Known,
    /// Largest vibration after the onset over the vibration at the onset, minus 1; why it is unknown.
    pub overshoot: Known,
    /// Whether drive and load are constant until the vibration ends, so that the dither alone ends it.
    pub alone: bool,
}

impl RunConditions<'_> {
    /// What the dither does in each of its phases, of the vibration up to the end of a run; times of intervals are known to about a
    /// `period`.
    pub(super) fn quenches(
        &self,
        vibration: &[VibrationInterval],
        levels: &[VibrationLevel],
        (end, period): (f64, f64),
    ) -> Vec<DitherSwitching> {
        let phases = self.phases.iter().filter(|on| on.from < end);
        phases.map(|on| self.quench(*on, vibration, levels, (end, period))).collect()
    }

    fn quench(
        &self,
        on: OnPhase,
        vibration: &[VibrationInterval],
        levels: &[VibrationLevel],
        (end, period): (f64, f64),
    ) -> DitherSwitching {
        let at_onset =
            vibration.iter().any(|interval| interval.from <= on.from && on.from <= interval.to);
        if !at_onset {
            let why = "nothing vibrates when the dither is switched on";
            return DitherSwitching { on, time: Err(why), overshoot: Err(why), alone: true };
        }
        let off = on.to.min(end);
        // One that begins as the dither is switched off begins after it.
        let within = vibration.iter().filter(|interval| interval.from < off - period);
        let last = within.map(|interval| interval.to).fold(on.from, f64::max);
        let alone = !(self.changes)(on.from, last.min(off));
        let time = if last >= end {
            Err("it still vibrates at the end of the run")
        } else if last >= off {
            Err("it still vibrates when the dither is switched off")
        } else if last >= self.rest - period {
            Err(
                "the surface comes to rest before the vibration ends, which ends it without dither too",
            )
        } else {
            Ok(last - on.from)
        };
        let level_at = levels.iter().take_while(|at| at.time <= on.from).last();
        let after = levels.iter().filter(|at| on.from < at.time && at.time < off);
        let most = after.fold(0.0, |most: f64, at| most.max(at.level));
        let overshoot = level_at.map_or(Err("the dither is on from the start"), |at| {
            Ok((most / at.level - 1.0).max(0.0))
        });
        DitherSwitching { on, time, overshoot, alone }
    }
}

/// When an envelope rises from its least share, and when it begins to return there.
fn phases(envelope: &Knots) -> Vec<OnPhase> {
    let (times, values) = (envelope.times(), envelope.values());
    let sizes: Vec<f64> = values.iter().map(|value| value.abs()).collect();
    let least = sizes.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = sizes.iter().copied().fold(0.0, f64::max);
    let is_off = |place: usize| sizes[place] - least <= OFF * (largest - least);
    let mut found: Vec<OnPhase> = Vec::new();
    for place in 1..sizes.len() {
        match (is_off(place - 1), is_off(place)) {
            (true, false) => {
                found.push(OnPhase { from: times[place - 1], to: f64::INFINITY });
            }
            (false, true) => {
                if let Some(open) = found.last_mut() {
                    open.to = times[place - 1];
                }
            }
            _ => {}
        }
    }
    found
}

/// When the dither of a system that is switched on first is on.
pub(crate) fn phases_of(system: &System) -> Vec<OnPhase> {
    let acting = system.waves().filter(|wave| wave.amplitude != 0.0);
    let phases = acting.filter_map(|wave| wave.envelope.as_ref()).map(phases);
    let begun = phases.filter(|phases| !phases.is_empty());
    begun.min_by(|a, b| a[0].from.total_cmp(&b[0].from)).unwrap_or_default()
}

/// The time from which every surface of a system is at rest.
pub(crate) fn rest_of(system: &System) -> f64 {
    let of = |profile: &Profile| {
        let at_rest = || if profile.mean() == 0.0 { f64::NEG_INFINITY } else { f64::INFINITY };
        match profile.knots() {
            _ if !profile.waves().is_empty() => f64::INFINITY,
            None => at_rest(),
            Some(knots) => {
                let values = knots.values();
                let moving = values.iter().rposition(|value| *value != 0.0);
                moving.map_or(f64::NEG_INFINITY, |place| {
                    knots.times().get(place + 1).copied().unwrap_or(f64::INFINITY)
                })
            }
        }
    };
    let rests = system.contacts.iter().map(|contact| of(&contact.surface_velocity));
    rests.reduce(f64::max).unwrap_or(f64::INFINITY)
}

/// Whether a drive or a load of a system changes between two times.
pub(crate) fn changes_of(system: &System, from: f64, to: f64) -> bool {
    let changes = |profile: &Profile| {
        let moments = (0..=MOMENTS).map(|k| from + (to - from) * f64::from(k) / f64::from(MOMENTS));
        let values: Vec<f64> = moments.map(|time| profile.value(time)).collect();
        let largest = values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        values.iter().any(|value| (value - values[0]).abs() > CHANGE * largest)
    };
    system.contacts.iter().any(|contact| {
        changes(&contact.surface_velocity) || contact.varying_load.as_ref().is_some_and(changes)
    })
}

#[cfg(test)]
mod tests {
    use quell_model::profile::KnotShape;

    use super::*;

    fn knots(times: &[f64], values: &[f64]) -> Knots {
        Knots::new(times.to_vec(), values.to_vec(), KnotShape::Linear).expect("valid")
    }

    fn on(from: f64, to: f64) -> OnPhase {
        OnPhase { from, to }
    }

    #[test]
    fn a_dither_is_on_from_where_its_share_rises_to_where_it_falls() {
        let infinite = f64::INFINITY;
        assert_eq!(phases(&knots(&[0.0, 5.0, 9.0], &[0.0, 0.0, 1.0])), [on(5.0, infinite)]);
        assert_eq!(phases(&knots(&[3.0, 3.0], &[0.0, 1.0])), [on(3.0, infinite)]);
        assert!(phases(&knots(&[0.0, 5.0], &[1.0, 0.0])).is_empty());
        let twice = knots(&[1.0, 1.0, 2.0, 3.0, 5.0, 5.0], &[0.0, 1.0, 1.0, 0.0, 0.0, 0.5]);
        assert_eq!(phases(&twice), [on(1.0, 2.0), on(5.0, infinite)]);
    }

    fn vibration(ends: &[(f64, f64)]) -> Vec<VibrationInterval> {
        ends.iter()
            .map(|(from, to)| VibrationInterval { from: *from, to: *to, level: 1.0 })
            .collect()
    }

    #[test]
    fn each_phase_has_its_own_time() {
        let found = vibration(&[(0.0, 1.2), (2.5, 5.4), (8.0, 9.0)]);
        let phases = vec![on(1.0, 2.0), on(5.0, 7.0), on(8.5, f64::INFINITY)];
        let steady = RunConditions { phases, rest: f64::INFINITY, changes: &|from, _| from > 8.0 };
        let times: Vec<Known> = steady
            .quenches(&found, &[VibrationLevel { time: 0.0, level: 1.0 }], (10.0, 0.1))
            .iter()
            .map(|quench| quench.time)
            .collect();
        for (time, wanted) in times.iter().zip([0.2, 0.4, 0.5]) {
            assert!((time.expect("known") - wanted).abs() < 1e-12, "{times:?}");
        }
        let alone: Vec<bool> =
            steady.quenches(&found, &[], (10.0, 0.1)).iter().map(|quench| quench.alone).collect();
        assert_eq!(alone, [true, true, false]);
        // A vibration that lasts until the dither is off, and one that ends on a surface at rest.
        let long = RunConditions {
            phases: vec![on(1.0, 1.1)],
            ..RunConditions { phases: Vec::new(), rest: f64::INFINITY, changes: &|_, _| false }
        };
        assert_eq!(
            long.quenches(&found, &[], (10.0, 0.0))[0].time,
            Err("it still vibrates when the dither is switched off")
        );
        let stops = RunConditions {
            phases: vec![on(8.5, f64::INFINITY)],
            rest: 8.8,
            changes: &|_, _| true,
        };
        assert!(stops.quenches(&found, &[], (10.0, 0.1))[0].time.is_err());
    }
}
