//! Verification of clear dither frequencies by exact Floquet exponents over the range of speeds.
//!
//! First-order theory neglects the terms quadratic in friction: revived undithered tongues, meetings at sums of the harmonics of
//! the dither (of a sine at twice its frequency), waves that lose their damping under strong friction, and tongues of three waves
//! and more. Frequencies of the clear intervals are therefore tested by their Floquet exponents, on a grid of speeds with a point in
//! every second-order tongue, and by all exponents along the speeds ([`growing_speeds`]). Among those without growth, the middle
//! of the widest interval is examined closely: with a finer grid, several points per tongue, and a refinement of the largest
//! growth rate. If the closer examination finds growth, the next widest interval follows.
//!
//! Limitation: that of [`growing_speeds`]; between two tested frequencies nothing is known beyond first order.

use core::ops::RangeInclusive;

use quell_numerics::floquet::Effort;
use quell_numerics::order::ascending;
use quell_numerics::roots::{Closeness, minimise};

use super::clear::Clearance;
use super::tongue::{Coupling, Tongue};
use super::waves::{Order, Waves};
use crate::dithered;
use crate::growing::growing_speeds;
use quell_linear::growth::{Growth, Verdict};
use quell_model::Disc;

/// Number of frequencies tested, over all clear intervals together. Each takes about thirty exponents of 0.1 (three modes) to 2
/// ms (ten modes), so that a result takes 0.1 to 3 s.
const FREQUENCIES: f64 = 32.0;

/// Equal steps of speed when many frequencies are tested, and when one is examined closely. They detect growth that no
/// second-order tongue predicts. Fewer steps would miss wider intervals of growth; the run time is proportional to their number.
const STEPS: (u32, u32) = (16, 240);

/// Intervals into which a tongue is divided when one frequency is examined closely: the growth rate has one maximum over a
/// tongue, and the minimiser needs a bracket.
const PER_TONGUE: u32 = 5;

/// Most frequencies that are examined closely, with some hundreds of exponents each. If there is growth at all of these, the
/// smallest growth is reported.
const CLOSELY: usize = 8;

/// A dither frequency with the largest growth rate of the exact equations over a range of speeds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Verified {
    /// Dither frequency R.
    pub frequency_ratio: f64,
    /// The largest growth rate found.
    pub growth: Growth,
    /// The speed at which it occurs.
    pub speed: f64,
}

impl Verified {
    /// Whether no motion grows.
    #[must_use]
    pub fn is_clear(&self) -> bool {
        self.growth.verdict() != Verdict::Unstable
    }
}

/// What the exact equations say of the frequencies that are clear at first order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Verification {
    /// The frequency in the clear intervals that keeps the range of speeds clear by the exact equations, far from those that do
    /// not; where no tested frequency does, the one with the smallest growth rate. `None` where there is no interval, and where
    /// exponents cannot be computed.
    pub best: Option<Verified>,
    /// Every frequency that was tested, in the order of the intervals.
    pub tested: Vec<TestedFrequency>,
}

/// A frequency that was tested.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TestedFrequency {
    /// Index of its clear interval.
    pub interval: usize,
    /// Width of the frequencies that it represents.
    pub width: f64,
    /// Largest growth found.
    pub result: Verified,
}

/// Tests frequencies of the clear intervals by the exact equations.
#[must_use]
pub fn verified_frequency(
    disc: &Disc,
    clearance: &Clearance,
    speeds: RangeInclusive<f64>,
) -> Verification {
    let Ok(waves) = Waves::new(disc) else { return Verification::default() };
    let exact = Exact { disc, waves: waves.with_order(Order::Second), speeds };
    let mut tested = exact.coarsely(&clearance.clear);
    let best = exact.best(&mut tested);
    Verification { best, tested }
}

/// The middle of the widest run of neighbours without growth.
fn middle_of_widest(tested: &[TestedFrequency]) -> Option<usize> {
    let mut widest: Option<(f64, usize)> = None;
    let mut first = 0;
    while first < tested.len() {
        let same = |other: &&TestedFrequency| {
            other.interval == tested[first].interval && other.result.is_clear()
        };
        let count = tested[first..].iter().take_while(same).count();
        let width = tested[first].width * count as f64;
        if count > 0 && widest.is_none_or(|(known, _)| width > known) {
            widest = Some((width, first + count / 2));
        }
        first += count.max(1);
    }
    widest.map(|(_, middle)| middle)
}

/// Growth rates of a disc over a range of speeds.
struct Exact<'a> {
    disc: &'a Disc,
    waves: Waves,
    speeds: RangeInclusive<f64>,
}

impl Exact<'_> {
    /// The middle of the widest run of clear frequencies that a close examination confirms, or the frequency of least growth.
    fn best(&self, tested: &mut [TestedFrequency]) -> Option<Verified> {
        for _ in 0..CLOSELY {
            let Some(middle) = middle_of_widest(tested) else { break };
            let found = self.closely(tested[middle].result.frequency_ratio)?;
            tested[middle].result = found;
            if found.is_clear() {
                return Some(found);
            }
        }
        let least =
            tested.iter().min_by(|a, b| a.result.growth.rate.total_cmp(&b.result.growth.rate))?;
        self.closely(least.result.frequency_ratio)
    }

    /// The result with the largest growth that all exponents along the speeds have, if that is larger.
    fn with_growing(&self, found: Verified, steps: u32) -> Option<Verified> {
        let ratio = found.frequency_ratio;
        let disc = self.disc.with_frequency_ratio(ratio).ok()?;
        let growing = growing_speeds(&disc, &self.speeds, steps).ok()?;
        let peak = growing.iter().max_by(|a, b| a.peak_growth.total_cmp(&b.peak_growth));
        match peak.filter(|peak| peak.peak_growth > found.growth.rate) {
            Some(peak) => {
                let growth = self.growth(ratio, peak.peak_speed)?;
                Some(Verified { growth, speed: peak.peak_speed, ..found })
            }
            None => Some(found),
        }
    }

    fn growth(&self, ratio: f64, speed: f64) -> Option<Growth> {
        let disc = self.disc.with_frequency_ratio(ratio).ok()?.at_speed(speed).ok()?;
        dithered::growth(&disc, Effort::default()).ok()
    }

    /// Frequencies spread over the clear intervals.
    fn coarsely(&self, clear: &[[f64; 2]]) -> Vec<TestedFrequency> {
        let total: f64 = clear.iter().map(|[from, to]| to - from).sum();
        let mut tested = Vec::new();
        for (interval, [from, to]) in clear.iter().enumerate() {
            // An interval may be a single frequency.
            let share = if total > 0.0 { (to - from) / total } else { 0.0 };
            let share = (FREQUENCIES * share).ceil().clamp(1.0, FREQUENCIES);
            let width = (to - from) / share;
            let mut number = 0.5;
            while number < share {
                let ratio = width.mul_add(number, *from);
                let worst = self.worst(ratio, STEPS.0, 1).map(|(worst, _)| worst);
                let worst = worst.and_then(|worst| self.with_growing(worst, STEPS.0));
                tested.extend(worst.map(|result| TestedFrequency { interval, width, result }));
                number += 1.0;
            }
        }
        tested
    }

    /// The largest growth at one frequency, refined.
    fn closely(&self, ratio: f64) -> Option<Verified> {
        let (mut worst, between) = self.worst(ratio, STEPS.1, PER_TONGUE)?;
        let growth = |speed: f64| self.growth(ratio, speed);
        let closeness = Closeness { absolute: 0.0, relative: 1e-6 };
        let rate = |speed: f64| growth(speed).map_or(f64::INFINITY, |found| -found.rate);
        if let Ok(peak) = minimise(rate, between[0], between[1], closeness)
            && -peak.value > worst.growth.rate
        {
            let found = growth(peak.location)?;
            worst = Verified { growth: found, speed: peak.location, ..worst };
        }
        self.with_growing(worst, STEPS.1)
    }

    /// The largest growth at one frequency over the grid, and the neighbours of its speed.
    fn worst(&self, ratio: f64, steps: u32, per_tongue: u32) -> Option<(Verified, [f64; 2])> {
        let speeds = self.grid(ratio, steps, per_tongue)?;
        let mut worst: Option<(usize, Growth)> = None;
        for (index, speed) in speeds.iter().enumerate() {
            let growth = self.growth(ratio, *speed)?;
            if worst.is_none_or(|(_, known)| growth.rate > known.rate) {
                worst = Some((index, growth));
            }
        }
        let (index, growth) = worst?;
        let between = [speeds[index.saturating_sub(1)], speeds[(index + 1).min(speeds.len() - 1)]];
        Some((Verified { frequency_ratio: ratio, growth, speed: speeds[index] }, between))
    }

    /// Speeds at equal steps, and in every second-order tongue.
    fn grid(&self, ratio: f64, steps: u32, per_tongue: u32) -> Option<Vec<f64>> {
        let (from, to) = (*self.speeds.start(), *self.speeds.end());
        let equal = |k: u32| (to - from).mul_add(f64::from(k) / f64::from(steps), from);
        let mut grid: Vec<f64> = (0..=steps).map(equal).collect();
        let waves = self.waves.with_dither_frequency(ratio).ok()?;
        let repetition = waves.dither_frequency()?;
        let driven = waves.driven(&self.speeds, repetition).into_iter();
        for meeting in
            std::iter::once(0).chain(driven).flat_map(|h| waves.meetings(h, &self.speeds))
        {
            if waves.coupling(&meeting) != Coupling::Destabilising {
                continue;
            }
            grid.push(meeting.speed);
            if let Tongue::Between { lower, upper, peak_speed, .. } = waves.tongue(&meeting) {
                grid.push(peak_speed);
                let share = |k: u32| f64::from(k) / f64::from(per_tongue);
                grid.extend((1..per_tongue).map(|k| (upper - lower).mul_add(share(k), lower)));
            }
        }
        grid.retain(|speed| (from..=to).contains(speed));
        ascending(&mut grid);
        grid.dedup();
        Some(grid)
    }
}
