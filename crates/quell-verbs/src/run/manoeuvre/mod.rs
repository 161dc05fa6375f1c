//! What a run under a varying drive, load or dither does: when it vibrates, how soon the dither quenches it, and its spectrogram.

mod interval;
mod quench;
mod spectrogram;

pub use interval::{VibrationInterval, VibrationLevel, VibrationLimits};
pub use quench::{DitherSwitching, OnPhase, RunConditions};
pub use spectrogram::Spectrogram;

use quell_model::System;
use quell_model::units::Quantity;
use quell_numerics::interval::RealInterval;

use crate::fields::Fields;
use crate::words::plural;

/// Share of the largest vibration at which vibration begins, and that at which it has ended.
const BEGINS: f64 = 0.2;
const ENDS: f64 = 0.1;

/// A pause of fewer natural periods belongs to the vibration: stick–slip at low speed rests between its slips.
const PAUSE: f64 = 6.0;

/// Vibration below this share of the largest displacement is none.
const LEAST: f64 = 1e-3;

/// A dither with a period below this share of the natural period is averaged out.
const FAST: f64 = 0.4;

/// Intervals of vibration that a sentence names.
const MOST_INTERVALS: usize = 4;

/// Windows per natural period in which vibration is measured.
const WINDOWS_PER_PERIOD: usize = 4;

/// A displacement at equal steps.
#[derive(Clone, Copy, Debug)]
pub struct SampledMotion<'a> {
    /// Time of the first sample.
    pub start: f64,
    /// Time between two samples.
    pub step: f64,
    /// The displacement.
    pub displacement: &'a [f64],
}

/// When a run vibrates.
#[derive(Clone, Debug, PartialEq)]
pub struct Manoeuvre {
    /// The intervals of vibration, in order.
    pub vibration: Vec<VibrationInterval>,
    /// The levels above which vibration begins and below which it has ended, shares of the largest one; `None` without vibration.
    pub limits: Option<VibrationLimits>,
    /// What the dither does each time it is switched on.
    pub quenches: Vec<DitherSwitching>,
    /// Beginning and end of the run.
    pub whole: RealInterval,
}

impl Manoeuvre {
    /// Of a displacement of a system, whose drives, loads and dither vary.
    pub fn in_system(
        motion: SampledMotion<'_>,
        period: f64,
        fast: Option<f64>,
        system: &System,
    ) -> Self {
        let changes = |from: f64, to: f64| quench::changes_of(system, from, to);
        let (phases, rest) = (quench::phases_of(system), quench::rest_of(system));
        Self::of(motion, period, fast, &RunConditions { phases, rest, changes: &changes })
    }

    /// Of a displacement; `period` is the natural period, `fast` that of a dither, whose motion is no vibration.
    pub fn of(
        motion: SampledMotion<'_>,
        period: f64,
        fast: Option<f64>,
        conditions: &RunConditions<'_>,
    ) -> Self {
        let SampledMotion { start, step, displacement } = motion;
        let end = start + step * displacement.len().saturating_sub(1) as f64;
        let slow = without_fast(motion, period, fast);
        let motion = slow.as_ref().map_or(motion, SlowMotion::sampled);
        let SampledMotion { displacement, .. } = motion;
        let levels = levels(motion, period);
        let largest = levels.iter().fold(0.0, |most: f64, at| most.max(at.level));
        let reach = displacement.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let limits = (largest > LEAST * reach).then_some(VibrationLimits {
            begins_above: BEGINS * largest,
            ends_below: ENDS * largest,
        });
        let whole = RealInterval::new(start, end);
        let vibration =
            limits.map_or_else(Vec::new, |limits| intervals(&levels, limits, whole, period));
        let quenches = conditions.quenches(&vibration, &levels, (end, period));
        Self { vibration, limits, quenches, whole }
    }
}

/// The intervals in which the level rises above the first limit, until it falls below the second one for longer than a [`PAUSE`].
fn intervals(
    levels: &[VibrationLevel],
    limits: VibrationLimits,
    RealInterval { lower: start, upper: end }: RealInterval,
    period: f64,
) -> Vec<VibrationInterval> {
    let mut vibration: Vec<VibrationInterval> = Vec::new();
    let mut going = false;
    for VibrationLevel { time, level } in levels {
        if going {
            going = *level > limits.ends_below;
        } else if *level > limits.begins_above {
            going = true;
            let resumes = vibration.last().is_some_and(|last| time - last.to < PAUSE * period);
            let from = if vibration.is_empty() && *time <= start + period { start } else { *time };
            if !resumes {
                vibration.push(VibrationInterval { from, to: *time, level: *level });
            }
        }
        if let Some(last) = vibration.last_mut().filter(|_| going) {
            last.to = *time;
            last.level = last.level.max(*level);
        }
    }
    if let Some(last) = vibration.last_mut().filter(|_| going) {
        last.to = end;
    }
    vibration
}

/// A displacement without the motion under a fast dither.
struct SlowMotion {
    start: f64,
    step: f64,
    displacement: Vec<f64>,
}

impl SlowMotion {
    fn sampled(&self) -> SampledMotion<'_> {
        let Self { start, step, displacement } = self;
        SampledMotion { start: *start, step: *step, displacement }
    }
}

/// The displacement without the motion under a fast dither; `None` without one.
fn without_fast(motion: SampledMotion<'_>, period: f64, fast: Option<f64>) -> Option<SlowMotion> {
    fast.filter(|fast| *fast < FAST * period).map(|fast| averaged(motion, fast))
}

/// Half of the peak-to-peak slow displacement within one natural period, at the middle of each window.
pub(crate) fn vibration_levels(
    motion: SampledMotion<'_>,
    period: f64,
    fast: Option<f64>,
) -> Vec<VibrationLevel> {
    let slow = without_fast(motion, period, fast);
    levels(slow.as_ref().map_or(motion, SlowMotion::sampled), period)
}

/// The displacement averaged over a fast period about each sample that has half of one on both sides: over less a part of the fast
/// motion would remain.
fn averaged(motion: SampledMotion<'_>, period: f64) -> SlowMotion {
    let SampledMotion { start, step, displacement } = motion;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a count of samples"
    )]
    let half = ((0.5 * period / step).round() as usize).max(1);
    let mut sums = Vec::with_capacity(displacement.len() + 1);
    sums.push(0.0);
    let mut sum = 0.0;
    for value in displacement {
        sum += value;
        sums.push(sum);
    }
    let inner = half..displacement.len().saturating_sub(half);
    let mean = |at: usize| {
        // The samples at both ends of a whole period count half.
        let whole = sums[at + half] - sums[at - half]
            + 0.5 * (displacement[at + half] - displacement[at - half]);
        whole / (2 * half) as f64
    };
    SlowMotion {
        start: step.mul_add(half as f64, start),
        step,
        displacement: inner.map(mean).collect(),
    }
}

impl Manoeuvre {
    /// When the run vibrates, in one or two sentences; `in_words` writes a quantity with its unit, `what` vibrates.
    pub fn sentence(&self, what: &str, in_words: impl Fn(Quantity, f64) -> String) -> String {
        let moment = |time: f64| in_words(Quantity::Time, time);
        let RealInterval { lower: begins, upper: ends } = self.whole;
        let each = self.vibration.iter().take(MOST_INTERVALS).map(|interval| {
            let from = if interval.from <= begins {
                "the start".to_owned()
            } else {
                moment(interval.from)
            };
            let to = if interval.to >= ends { "the end".to_owned() } else { moment(interval.to) };
            let size = in_words(Quantity::Displacement, interval.level);
            format!("from {from} to {to} (amplitude up to {size})")
        });
        let listed = each.collect::<Vec<_>>().join(", ");
        let more = match self.vibration.len().saturating_sub(MOST_INTERVALS) {
            0 => String::new(),
            more => format!(" and in {more} more interval{}", plural(more as u64)),
        };
        let vibrates = if listed.is_empty() {
            format!("{what} does not vibrate.")
        } else {
            format!("{what} vibrates {listed}{more}.")
        };
        let known = self.quenches.iter().filter_map(|quench| Some((quench, quench.time.ok()?)));
        let known: Vec<(&DitherSwitching, f64)> = known.collect();
        let several = self.quenches.len() > 1;
        let each = known.iter().take(MOST_INTERVALS).map(|(quench, time)| {
            let at =
                if several { format!(" at {}", moment(quench.on.from)) } else { String::new() };
            let beside = if quench.alone { "" } else { ", while drive or load change too" };
            format!("{} after the dither is switched on{at}{beside}", moment(*time))
        });
        let each = each.collect::<Vec<_>>().join(", and ");
        let quench =
            if each.is_empty() { String::new() } else { format!(" The vibration ends {each}.") };
        format!("{vibrates}{quench}")
    }

    /// When the run vibrates, as fields; `empty` makes fields in the units of the study.
    pub(crate) fn fields(&self, empty: impl Fn() -> Fields) -> Fields {
        let mut fields = empty();
        let intervals = self.vibration.iter().map(|interval| {
            let mut inner = empty();
            inner
                .number("from", Quantity::Time, interval.from)
                .number("to", Quantity::Time, interval.to)
                .number("amplitude", Quantity::Displacement, interval.level);
            inner
        });
        fields.list("vibration", intervals.collect::<Vec<_>>());
        let limit = |of: fn(VibrationLimits) -> f64| {
            self.limits.map(of).ok_or_else(|| "nothing vibrates".to_owned())
        };
        fields
            .known("begins_above", Quantity::Displacement, limit(|limits| limits.begins_above))
            .known("ends_below", Quantity::Displacement, limit(|limits| limits.ends_below));
        let none = || "no dither is switched on during the run".to_owned();
        let first = self.quenches.first().ok_or_else(none);
        let of = |value: fn(&DitherSwitching) -> Result<f64, &'static str>| {
            first.clone().and_then(|quench| value(quench).map_err(str::to_owned))
        };
        fields
            .known("dither_onset", Quantity::Time, of(|quench| Ok(quench.on.from)))
            .known("time_to_quench", Quantity::Time, of(|quench| quench.time))
            .known("overshoot", Quantity::Ratio, of(|quench| quench.overshoot));
        let quenches = self.quenches.iter().map(|quench| {
            let mut inner = empty();
            inner
                .number("dither_onset", Quantity::Time, quench.on.from)
                .known("time_to_quench", Quantity::Time, quench.time.map_err(str::to_owned))
                .known("overshoot", Quantity::Ratio, quench.overshoot.map_err(str::to_owned))
                .plain("alone", quench.alone);
            inner
        });
        fields.list("quenches", quenches.collect::<Vec<_>>());
        fields
    }
}

/// Half of the peak-to-peak displacement within one natural period, without its drift, at the middle of each window.
fn levels(motion: SampledMotion<'_>, period: f64) -> Vec<VibrationLevel> {
    let SampledMotion { start, step, displacement } = motion;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a count of samples"
    )]
    let length = ((period / step).round() as usize).max(8);
    let hop = (length / WINDOWS_PER_PERIOD).max(1);
    let count = displacement.len();
    let firsts = (0..count.saturating_sub(length)).step_by(hop);
    firsts
        .map(|first| {
            let window = &displacement[first..=first + length];
            let drift = (window[length] - window[0]) / length as f64;
            let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
            for (place, x) in window.iter().enumerate() {
                let rest = x - drift * place as f64;
                least = least.min(rest);
                most = most.max(rest);
            }
            let time = step.mul_add(first as f64 + 0.5 * length as f64, start);
            VibrationLevel { time, level: 0.5 * (most - least) }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    const STEP: f64 = 0.02;

    fn motion(value: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..15_000).map(|sample| value(STEP * f64::from(sample))).collect()
    }

    fn on(from: f64) -> RunConditions<'static> {
        let on = OnPhase { from, to: f64::INFINITY };
        RunConditions { phases: vec![on], rest: f64::INFINITY, changes: &|_, _| false }
    }

    fn off() -> RunConditions<'static> {
        RunConditions { phases: Vec::new(), ..on(0.0) }
    }

    fn sampled(displacement: &[f64]) -> SampledMotion<'_> {
        SampledMotion { start: 0.0, step: STEP, displacement }
    }

    #[test]
    fn a_vibration_that_is_quenched_has_its_times() {
        // A drift that is no vibration, a vibration from 50 to 150, growing at first after the onset.
        let displacement = motion(|time| {
            let amplitude = if (50.0..150.0).contains(&time) {
                if time > 120.0 { 1.5 } else { 1.0 }
            } else {
                0.0
            };
            0.01 * time + amplitude * time.sin()
        });
        let found = Manoeuvre::of(sampled(&displacement), TAU, None, &on(110.0));
        assert_eq!(found.vibration.len(), 1);
        let only = found.vibration[0];
        assert!((only.from - 50.0).abs() < TAU && (only.to - 150.0).abs() < TAU, "{only:?}");
        assert!((only.level - 1.5).abs() < 0.05, "{only:?}");
        assert!((found.quenches[0].time.expect("quenched") - 40.0).abs() < TAU);
        assert!((found.quenches[0].overshoot.expect("known") - 0.5).abs() < 0.1);
        let quiet = motion(|time| 0.3 + 1e-7 * time.sin());
        let found = Manoeuvre::of(sampled(&quiet), TAU, None, &off());
        assert!(found.vibration.is_empty() && found.quenches.is_empty());
        let always = motion(f64::sin);
        let found = Manoeuvre::of(sampled(&always), TAU, None, &on(20.0));
        assert_eq!(RealInterval::new(found.vibration[0].from, found.vibration[0].to), found.whole);
        assert!(found.quenches[0].time.is_err());
    }

    /// A dither that moves the mass fast is no vibration.
    #[test]
    fn the_fast_motion_under_dither_does_not_count() {
        let displacement =
            motion(|time| if time < 100.0 { time.sin() } else { 0.3 * (10.0 * time).sin() });
        let found = |fast| Manoeuvre::of(sampled(&displacement), TAU, fast, &on(90.0));
        assert!(found(None).quenches[0].time.is_err());
        let quench = found(Some(TAU / 10.0)).quenches[0].time.expect("quenched");
        assert!((quench - 10.0).abs() < TAU, "{quench}");
    }

    /// The fast motion remains nowhere, also where the run ends within one of its periods.
    #[test]
    fn the_ends_of_a_run_are_no_vibration() {
        let displacement =
            motion(|time| if time < 100.0 { time.sin() } else { 3.0 * (10.0 * time).sin() });
        for beyond in 0..32 {
            let cut = &displacement[..displacement.len() - beyond];
            let found = Manoeuvre::of(sampled(cut), TAU, Some(TAU / 10.0), &off());
            assert_eq!(found.vibration.len(), 1, "{beyond}: {:?}", found.vibration);
        }
    }

    /// Slips of one natural period with rests of `rest` natural periods between them, ten times.
    fn with_rests(rest: f64) -> usize {
        let displacement = motion(|time| {
            let (whole, repeat) = (time / TAU, rest + 1.0);
            let slips = whole < 10.0 * repeat && whole.rem_euclid(repeat) < 1.0;
            if slips { time.sin() } else { 0.0 }
        });
        Manoeuvre::of(sampled(&displacement), TAU, None, &off()).vibration.len()
    }

    #[test]
    fn short_rests_belong_to_a_vibration() {
        assert_eq!(with_rests(3.0), 1);
        assert!(with_rests(9.0) > 4);
    }
}
