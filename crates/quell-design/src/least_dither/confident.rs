//! The least amplitude that is quiet in a share of random samples: a quantile of their exact least amplitudes.
//!
//! Averaging orders the samples cheaply. The exact least amplitude is computed of those samples alone that may decide: first of those
//! about the quantile, then of every further one whose averaged amplitude, times any ratio of the exact to the averaged one that was
//! seen, could lie within the interval of the quantile. Half of the range of the ratios is added on both sides. Where that range is
//! narrow, averaging with its upper end decides about the others, so that the quantile may be too large by that range, never too small.

use std::collections::BTreeMap;

use quell_numerics::interval::RealInterval;
use quell_numerics::order::{ascending, ascending_by};

use super::exact_box::{ExactBox, Near, QuietSet, WINDOW};
use super::quiet::QuietAmplitudes;
use super::search::{Judged, grid};
use super::worst_point::{BoxSearch, LeastOfBox, NoLeast, least_of_box};
use super::{DesignPoint, DesignProblem};
use crate::NoAnswer;
use crate::probability::binomial_interval;

/// First step over the box by averaging, and the last one, as shares of its ranges.
const STEPS: (f64, f64) = (0.0625, 1e-6);

/// Last step of exact thresholds over the box: where a tip decides, a threshold is too low by about this share of the range, which is far
/// less than the interval of a quantile. A design itself steps to 10⁻⁷.
const CLOSENESS: f64 = 1e-4;

/// Samples all over the order of averaging whose exact amplitude is computed first: they show the ratios elsewhere. With fewer, a ratio
/// that occurs rarely is overlooked; the range of the ratios is doubled for that reason.
const SPREAD: usize = 16;

/// Relative range of the ratios of exact to averaged amplitudes that is narrow: the accuracy to which a design is asked for (0.5 %). A
/// smaller value computes more samples exactly; a larger one makes the amplitude larger than it must be.
const NARROW: f64 = 5e-3;

/// Samples on each side of the interval of the quantile whose exact amplitude is computed first, as a share of all. It decides only how
/// many rounds follow.
const FIRST: f64 = 0.005;

/// The quiet amplitudes of one sample over the operating points, with the other design variables of a design.
pub struct SampledQuiet<'a> {
    /// By averaging.
    pub averaged: Box<QuietSet<'a>>,
    /// By exact thresholds.
    pub exact: Box<QuietSet<'a>>,
}

/// The least amplitude of a sample by averaging.
#[derive(Clone, Debug, PartialEq)]
pub struct LeastOfSample(LeastOfBox);

impl LeastOfSample {
    /// The amplitude.
    pub fn amplitude(&self) -> f64 {
        self.0.amplitude
    }
}

impl DesignProblem<'_> {
    /// The least amplitude by averaging of a sample, near a design.
    ///
    /// # Errors
    /// [`NoLeast`].
    pub fn averaged_least_of(
        &self,
        sample: &SampledQuiet<'_>,
        design: &DesignPoint,
    ) -> Result<LeastOfSample, NoLeast> {
        let quiet = |point: &[f64]| (sample.averaged)(point, self.amplitude);
        let (step, closeness) = STEPS;
        let Self { over: ranges, amplitude: RealInterval { lower: from, .. }, tasks, .. } = *self;
        let search = BoxSearch { ranges, from, step, closeness, tasks };
        least_of_box(search, self.points_near(design), &quiet).map(LeastOfSample)
    }

    /// The exact least amplitude of a sample.
    ///
    /// # Errors
    /// [`NoLeast`].
    pub fn exact_least_of(
        &self,
        sample: &SampledQuiet<'_>,
        averaged: &LeastOfSample,
    ) -> Result<f64, NoLeast> {
        let LeastOfBox { amplitude, worst, decisive } = &averaged.0;
        let near = Near { amplitude: *amplitude, decisive, worst: worst.as_ref() };
        let exact_box = ExactBox { closeness: CLOSENESS, ..ExactBox::of(self) };
        let found = exact_box.least(&*sample.exact, near, WINDOW.lower * amplitude);
        let found = match found {
            // Far from averaging.
            Err(NoLeast::NeverQuiet { .. }) => {
                let RealInterval { lower: from, upper: to } = self.amplitude;
                exact_box.least(&*sample.exact, Near { amplitude: to, ..near }, from)
            }
            found => found,
        };
        found.map(|found| found.amplitude)
    }

    /// Whether an amplitude is quiet in a sample by averaging, at the corners of the box and where the design is decided.
    pub fn is_quiet_by_averaging(
        &self,
        sample: &SampledQuiet<'_>,
        design: &DesignPoint,
        amplitude: f64,
    ) -> bool {
        let quiet = |point: Vec<f64>| {
            let set: Result<QuietAmplitudes, NoAnswer> = (sample.averaged)(&point, self.amplitude);
            set.is_ok_and(|set| set.contains(amplitude))
        };
        self.points_near(design).into_iter().all(quiet)
    }

    /// A design with another amplitude, with the use of every limit on exact responses.
    pub fn with_amplitude(&self, design: &DesignPoint, amplitude: f64) -> DesignPoint {
        let DesignPoint { worst, decisive, .. } = design.clone();
        let at = LeastOfBox { amplitude, worst, decisive };
        self.priced(&design.others, at, Judged::Exactly)
    }

    fn points_near(&self, design: &DesignPoint) -> Vec<Vec<f64>> {
        let mut points = grid(self.over, [1, 2, 2, 2], false);
        points.extend(design.decisive.iter().chain(&design.worst).cloned());
        points
    }
}

/// A quantile with its 95 % interval; infinite where no amplitude is quiet in that share of the samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeastQuantile {
    /// The quantile.
    pub value: f64,
    /// Its interval.
    pub interval: RealInterval,
}

/// Least amplitudes of samples: of all by averaging, of some exactly. Infinite where no amplitude is quiet, or none is known to be.
#[derive(Clone, Debug)]
pub struct SampledLeast {
    averaged: Vec<f64>,
    exact: BTreeMap<usize, f64>,
}

impl SampledLeast {
    /// The amplitudes by averaging, by the number of the sample.
    pub fn new(averaged: Vec<f64>) -> Self {
        Self { averaged, exact: BTreeMap::new() }
    }

    /// Adds the exact amplitude of a sample.
    pub fn add(&mut self, sample: usize, exact: f64) {
        self.exact.insert(sample, exact);
    }

    /// Whether the exact amplitude of a sample is known.
    pub fn contains(&self, sample: usize) -> bool {
        self.exact.contains_key(&sample)
    }

    /// Samples whose exact amplitude is known.
    pub fn known(&self) -> usize {
        self.exact.len()
    }

    /// The smallest and largest ratio of exact to averaged amplitudes that is expected of other samples.
    fn ratios(&self) -> (f64, f64) {
        let ratios = self.exact.iter().filter_map(|(sample, exact)| {
            let ratio = exact / self.averaged[*sample];
            ratio.is_finite().then_some(ratio)
        });
        let (low, high) = ratios
            .fold((f64::INFINITY, 0.0_f64), |(low, high), ratio| (low.min(ratio), high.max(ratio)));
        if low > high {
            return (1.0, 1.0);
        }
        let more = 0.5 * (high - low);
        ((low - more).max(0.0), high + more)
    }

    /// An amplitude that is enough for every sample: the exact one, or the largest that is expected.
    fn enough(&self) -> Vec<f64> {
        let (_, high) = self.ratios();
        let mut best: Vec<f64> = self.averaged.iter().map(|averaged| averaged * high).collect();
        for (sample, exact) in &self.exact {
            best[*sample] = *exact;
        }
        best
    }

    /// The quantile of a probability, where no further sample is [needed](Self::needed) at most 0.5 % too large. `None` without
    /// samples.
    pub fn quantile(&self, probability: f64) -> Option<LeastQuantile> {
        let mut best = self.enough();
        ascending(&mut best);
        let [low, value, high] = self.ranks(probability)?.map(|rank| best[rank]);
        Some(LeastQuantile { value, interval: RealInterval::new(low, high) })
    }

    /// The places of the quantile and of the ends of its interval among the samples in ascending order.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
    fn ranks(&self, probability: f64) -> Option<[usize; 3]> {
        let last = self.averaged.len().checked_sub(1)?;
        let count = self.averaged.len() as f64;
        // Rounding must not add a sample.
        let rank =
            |share: f64| ((share * count - 1e-9).ceil() as usize).saturating_sub(1).min(last);
        let interval =
            binomial_interval((probability * count).round() as usize, self.averaged.len());
        Some([interval.lower, probability, interval.upper].map(rank))
    }

    /// The samples whose exact amplitude may decide the quantile, or an end of its interval, and is not known.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
    pub fn needed(&self, probability: f64) -> Vec<usize> {
        let Some([low, _, high]) = self.ranks(probability) else { return Vec::new() };
        let unknown = |sample: &usize| !self.exact.contains_key(sample);
        if self.exact.is_empty() {
            let more = (FIRST * self.averaged.len() as f64).ceil() as usize;
            let mut order: Vec<usize> = (0..self.averaged.len()).collect();
            ascending_by(&mut order, |a| self.averaged[*a]);
            let range = low.saturating_sub(more)..(high + more + 1).min(order.len());
            let elsewhere = (0..SPREAD).map(|part| part * order.len() / SPREAD);
            let mut places: Vec<usize> = range.chain(elsewhere).collect();
            places.sort_unstable();
            places.dedup();
            return places.into_iter().map(|place| order[place]).collect();
        }
        let Some(found) = self.quantile(probability) else { return Vec::new() };
        let (least, most) = self.ratios();
        if most <= least * (1.0 + NARROW) {
            return Vec::new();
        }
        let within = |sample: &usize| {
            let averaged = self.averaged[*sample];
            averaged * most >= found.interval.lower && averaged * least <= found.interval.upper
        };
        (0..self.averaged.len()).filter(|sample| unknown(sample) && within(sample)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The exact amplitudes are the averaged ones times a ratio that changes their order: the quantile is that of all exact ones.
    #[test]
    fn quantiles_are_those_of_all_exact_amplitudes() {
        let count = 2000_usize;
        let averaged: Vec<f64> =
            (0..count).map(|k| 1.0 + (k * 7919 % count) as f64 / 2000.0).collect();
        let exact = |sample: usize| averaged[sample] * (1.0 + 0.02 * libm::sin(sample as f64));
        let mut all: Vec<f64> = (0..count).map(exact).collect();
        all.sort_by(f64::total_cmp);
        for probability in [0.5, 0.9, 0.99] {
            let mut known = SampledLeast::new(averaged.clone());
            loop {
                let needed = known.needed(probability);
                if needed.is_empty() {
                    break;
                }
                for sample in needed {
                    known.add(sample, exact(sample));
                }
            }
            let found = known.quantile(probability).expect("samples");
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
            let rank = (probability * count as f64).round() as usize - 1;
            assert_eq!(found.value, all[rank], "{probability}");
            let RealInterval { lower: low, upper: high } = found.interval;
            assert!(low < found.value && found.value < high && known.known() < count / 3);
            assert!(all.contains(&low) && all.contains(&high));
        }
        assert_eq!(SampledLeast::new(Vec::new()).quantile(0.9), None);
        assert!(SampledLeast::new(Vec::new()).needed(0.9).is_empty());
    }

    /// Samples that no amplitude quiets come last.
    #[test]
    fn what_is_never_quiet_is_infinite() {
        let mut averaged: Vec<f64> = (0..95).map(|k| 1.0 + f64::from(k) / 100.0).collect();
        averaged.extend([f64::INFINITY; 5]);
        let mut known = SampledLeast::new(averaged.clone());
        for (sample, amplitude) in averaged.iter().enumerate() {
            known.add(sample, *amplitude);
        }
        let at = |probability: f64| known.quantile(probability).expect("samples").value;
        assert_eq!((at(0.95), at(0.96)), (1.94, f64::INFINITY));
        assert!(known.quantile(0.9).expect("samples").interval.upper < f64::INFINITY);
    }
}
