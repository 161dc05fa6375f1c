//! Is a dither frequency that first-order theory calls clear really clear? The exact exponents over the range of speeds.
//!
//! Theory of first order leaves out what friction does twice: undithered tongues that are revived, meetings of twice the
//! dither's frequency, and waves that are no more damped under strong friction. So frequencies of the clear intervals are
//! tried by their Floquet exponents, on a grid of speeds with a point in every tongue of second order. Of those without
//! growth the middle of the widest stretch is looked at closely: a finer grid, several points a tongue, and the
//! largest growth refined. If it grows there after all, the next one is.
//! Limits: a stretch of growth between neighbouring speeds that second order does not know is missed.

use core::ops::RangeInclusive;

use quell_model::parameter::DITHER_FREQUENCY_RATIO;
use quell_numerics::floquet::Effort;
use quell_numerics::roots::{Closeness, minimise};

use super::clear::Clearance;
use super::tongue::{Coupling, Tongue};
use super::waves::{Order, Waves};
use crate::dithered;
use quell_linear::growth::{Growth, Verdict};
use quell_model::Disc;

/// Frequencies that are tried, over all clear intervals together: each takes some thirty exponents of 0.1 (three modes) to 2 ms
/// (ten modes), so that an answer takes 0.1 to 3 s.
const FREQUENCIES: f64 = 32.0;

/// Equal steps of speed: when many frequencies are tried, and when one is looked at closely. They are for growth that no tongue
/// of second order tells of; with fewer, a narrower stretch of it is missed, with more an answer takes as much longer.
const STEPS: (u32, u32) = (16, 240);

/// Points in a tongue when one frequency is looked at closely: growth is a hump over a tongue, and minimising needs a bracket.
const IN_A_TONGUE: u32 = 5;

/// Most frequencies that are looked at closely, some hundreds of exponents each; if all of these grow, the least growth is told.
const CLOSELY: usize = 8;

/// A dither frequency with the largest growth rate of the exact equations over a range of speeds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Verified {
    /// Dither frequency R.
    pub frequency_ratio: f64,
    /// The largest growth rate that was met.
    pub growth: Growth,
    /// The speed there.
    pub speed: f64,
}

impl Verified {
    /// Whether nothing grows.
    #[must_use]
    pub fn is_clear(&self) -> bool {
        self.growth.verdict() != Verdict::Unstable
    }
}

/// The frequency of the clear intervals that keeps the range of speeds clear by the exact equations, away from those that do
/// not; where none does, the one under which least grows. `None` where there is no interval, and where exponents cannot be
/// computed.
#[must_use]
pub fn verified_frequency(
    disc: &Disc,
    clearance: &Clearance,
    speeds: RangeInclusive<f64>,
) -> Option<Verified> {
    let waves = Waves::new(disc).ok()?.with_order(Order::Second);
    let exact = Exact { disc, waves, speeds };
    let mut tried = exact.coarsely(&clearance.clear);
    for _ in 0..CLOSELY {
        let Some(middle) = middle_of_widest(&tried) else { break };
        let found = exact.closely(tried[middle].2.frequency_ratio)?;
        if found.is_clear() {
            return Some(found);
        }
        tried[middle].2 = found;
    }
    let least = tried.iter().min_by(|a, b| a.2.growth.rate.total_cmp(&b.2.growth.rate))?;
    exact.closely(least.2.frequency_ratio)
}

/// A frequency that was tried: the number of its interval, the width it stands for, what was found.
type Tried = (usize, f64, Verified);

/// The middle of the widest stretch of neighbours without growth.
fn middle_of_widest(tried: &[Tried]) -> Option<usize> {
    let mut widest: Option<(f64, usize)> = None;
    let mut first = 0;
    while first < tried.len() {
        let same = |it: &&Tried| it.0 == tried[first].0 && it.2.is_clear();
        let count = tried[first..].iter().take_while(same).count();
        let width = tried[first].1 * count as f64;
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
    fn growth(&self, ratio: f64, speed: f64) -> Option<Growth> {
        let disc = self.disc.with(DITHER_FREQUENCY_RATIO.path, ratio).ok()?.at_speed(speed).ok()?;
        dithered::growth(&disc, Effort::default()).ok()
    }

    /// Frequencies spread over the clear intervals.
    fn coarsely(&self, clear: &[[f64; 2]]) -> Vec<Tried> {
        let total: f64 = clear.iter().map(|[from, to]| to - from).sum();
        let mut tried = Vec::new();
        for (interval, [from, to]) in clear.iter().enumerate() {
            // An interval may be one frequency.
            let share = if total > 0.0 { (to - from) / total } else { 0.0 };
            let share = (FREQUENCIES * share).ceil().clamp(1.0, FREQUENCIES);
            let width = (to - from) / share;
            let mut number = 0.5;
            while number < share {
                let ratio = width.mul_add(number, *from);
                tried.extend(self.worst(ratio, STEPS.0, 1).map(|found| (interval, width, found.0)));
                number += 1.0;
            }
        }
        tried
    }

    /// The largest growth at one frequency, refined.
    fn closely(&self, ratio: f64) -> Option<Verified> {
        let (mut worst, between) = self.worst(ratio, STEPS.1, IN_A_TONGUE)?;
        let growth = |speed: f64| self.growth(ratio, speed);
        let closeness = Closeness { absolute: 0.0, relative: 1e-6 };
        let rate = |speed: f64| growth(speed).map_or(f64::INFINITY, |found| -found.rate);
        if let Ok(peak) = minimise(rate, between[0], between[1], closeness)
            && -peak.value > worst.growth.rate
        {
            let found = growth(peak.location)?;
            worst = Verified { growth: found, speed: peak.location, ..worst };
        }
        Some(worst)
    }

    /// The largest growth at one frequency over the grid, and the neighbours of its speed.
    fn worst(&self, ratio: f64, steps: u32, in_a_tongue: u32) -> Option<(Verified, [f64; 2])> {
        let speeds = self.grid(ratio, steps, in_a_tongue)?;
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

    /// Speeds at equal steps, and in every tongue of second order.
    fn grid(&self, ratio: f64, steps: u32, in_a_tongue: u32) -> Option<Vec<f64>> {
        let (from, to) = (*self.speeds.start(), *self.speeds.end());
        let equal = |k: u32| (to - from).mul_add(f64::from(k) / f64::from(steps), from);
        let mut grid: Vec<f64> = (0..=steps).map(equal).collect();
        let waves = self.waves.with_dither_frequency(ratio).ok()?;
        for meeting in (0..=2).flat_map(|h| waves.meetings(h, &self.speeds)) {
            if waves.coupling(&meeting) != Coupling::Destabilising {
                continue;
            }
            grid.push(meeting.speed);
            if let Tongue::Between { lower, upper, peak_speed, .. } = waves.tongue(&meeting) {
                grid.push(peak_speed);
                let share = |k: u32| f64::from(k) / f64::from(in_a_tongue);
                grid.extend((1..in_a_tongue).map(|k| (upper - lower).mul_add(share(k), lower)));
            }
        }
        grid.retain(|speed| (from..=to).contains(speed));
        grid.sort_unstable_by(f64::total_cmp);
        grid.dedup();
        Some(grid)
    }
}
