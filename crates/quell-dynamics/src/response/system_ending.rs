//! Where the runs of a response end, by the judge of `attractor`, `basins` and `bifurcation`.

use std::f64::consts::TAU;

use quell_linear::growth::Verdict;
use quell_linear::pure_slip::period;
use quell_model::System;

use crate::attractor::{MotionKind, NoEnd, SystemAttractor, end_of_run};
use crate::motion::{Motion, MotionEnd, MotionStart, MotionStopped};
use crate::orbit::{is_on_sliding, sliding_verdict};

/// Where a run ends.
#[derive(Clone, Debug, PartialEq)]
pub enum SystemEnding {
    /// On this motion.
    Motion {
        /// The motion.
        found: Box<SystemAttractor>,
        /// Its period, if it repeats itself.
        period: Option<f64>,
    },
    /// In steady sliding without dither that is unstable: the start does not disturb it.
    UnstableSliding,
    /// On no motion that was found: over its record it moves on by more than it vibrates.
    Drift,
    /// On no motion that was found, for this reason; its record decides.
    Record(Option<NoEnd>),
}

impl SystemEnding {
    /// The ending of a run from a start, which has settled until `end`.
    pub(super) fn of(system: &System, row: &[f64], start: &MotionStart, end: &MotionEnd) -> Self {
        // Noise has no period, and the phase of the dither of a motion that is found is that at t = 0.
        if system.has_noise() || system.is_dithered() && start.time != 0.0 {
            return Self::Record(None);
        }
        // The judge displaces a run from unstable sliding, which rounding alone need not do.
        if !system.is_dithered() && is_unstable_sliding(system, &end.state) {
            return Self::UnstableSliding;
        }
        Self::judged(system, row, start)
    }

    /// The ending of a run from a start by the judge, which displaces it from unstable sliding.
    pub(super) fn judged(system: &System, row: &[f64], start: &MotionStart) -> Self {
        let found = match end_of_run(system, row, &start.state) {
            Ok(end) => end.attractor,
            Err(why) => return Self::Record(Some(why)),
        };
        match found.kind {
            MotionKind::Rest
                if !system.is_dithered() && is_unstable_sliding(system, &found.state) =>
            {
                Self::UnstableSliding
            }
            MotionKind::Cycle { period, .. } => {
                Self::Motion { found: Box::new(found), period: Some(period) }
            }
            MotionKind::Periodic { periods, .. } => Self::Motion {
                found: Box::new(found),
                period: period(system).map(|period| f64::from(periods) * period),
            },
            MotionKind::QuasiPeriodic { .. }
            | MotionKind::NotPeriodic { .. }
            | MotionKind::Rest => Self::Motion { found: Box::new(found), period: None },
        }
    }

    /// The word in outputs.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Motion { found, .. } => found.kind_name(),
            Self::UnstableSliding => "unstable-sliding",
            Self::Drift => "drift",
            Self::Record(_) => "unknown",
        }
    }

    /// The motion, if it was found.
    pub fn motion(&self) -> Option<&SystemAttractor> {
        match self {
            Self::Motion { found, .. } => Some(found),
            Self::UnstableSliding | Self::Drift | Self::Record(_) => None,
        }
    }

    /// Why the motion is not known.
    pub fn why(&self) -> Option<String> {
        match self {
            Self::Record(Some(why)) => Some(why.to_string()),
            Self::Record(None) => Some("no stable motion that repeats itself is known".to_owned()),
            Self::Motion { .. } | Self::UnstableSliding | Self::Drift => None,
        }
    }

    /// Period of a motion that repeats itself.
    pub fn period(&self) -> Option<f64> {
        match self {
            Self::Motion { period, .. } => *period,
            Self::UnstableSliding | Self::Drift | Self::Record(_) => None,
        }
    }

    /// Whether it is at rest or in steady sliding, where a run stays.
    pub(super) fn is_rest(&self) -> bool {
        self.motion().is_some_and(|found| found.kind == MotionKind::Rest)
    }

    /// The ending of a run whose record has these samples: without a known motion the record may drift.
    pub(super) fn with_record(self, samples: &[f64]) -> Self {
        match self {
            Self::Record(_) if drifts(samples) => Self::Drift,
            ending => ending,
        }
    }

    /// Whether it has no vibration slower than an angular frequency: every line of an orbit is a multiple of its own frequency.
    pub(super) fn is_faster_than(&self, frequency: f64) -> bool {
        self.period().is_some_and(|period| TAU / period > frequency)
    }

    /// Where the record of a run begins that has settled until `end`: on the motion that repeats itself, at the phase of the run and of
    /// its dither; of the places of a longer motion, whole periods of the dither apart, at that nearest to the run.
    ///
    /// # Errors
    /// [`MotionStopped`].
    pub(super) fn record_from(
        &self,
        motion: &Motion<'_>,
        tolerance: f64,
        end: &MotionEnd,
    ) -> Result<MotionStart, MotionStopped> {
        let (found, period) = match self {
            Self::Motion { found, period: Some(period) } => (found, period),
            Self::Motion { found, .. } if found.kind == MotionKind::Rest => {
                return Ok(MotionStart { time: end.time, state: found.state.clone() });
            }
            _ => return Ok(end.restart()),
        };
        let places = match found.kind {
            MotionKind::Periodic { periods, .. } => periods,
            _ => 1,
        };
        let step = period / f64::from(places);
        let mut from = MotionStart { time: 0.0, state: found.state.clone() };
        let mut nearest: Option<(f64, MotionStart)> = None;
        for place in 0..places {
            let until = f64::from(place).mul_add(step, end.time.rem_euclid(step));
            from = motion.run(&from, until, tolerance, &mut ())?.restart();
            let pairs = from.state.iter().zip(&end.state);
            let distance = pairs.map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
            if nearest.as_ref().is_none_or(|(least, _)| distance < *least) {
                nearest = Some((distance, from.clone()));
            }
        }
        Ok(nearest.map_or_else(|| end.restart(), |(_, start)| start))
    }
}

/// Whether a state is that of steady sliding, and that is unstable.
fn is_unstable_sliding(system: &System, state: &[f64]) -> bool {
    is_on_sliding(system, state) && cannot_settle(system)
}

/// Whether steady sliding of a system is unstable, so that hardly any run can settle there.
pub(super) fn cannot_settle(system: &System) -> bool {
    sliding_verdict(system) == Ok(Verdict::Unstable)
}

/// Whether samples move on by more than they vibrate: the line that fits them best changes by more than their peak-to-peak distance
/// from it. A record shorter than half a period of a vibration drifts too: it shows no vibration.
pub(super) fn drifts(samples: &[f64]) -> bool {
    let count = samples.len() as f64;
    let middle = 0.5 * (count - 1.0);
    let mean = samples.iter().sum::<f64>() / count;
    let places = || samples.iter().enumerate().map(|(place, value)| (place as f64 - middle, value));
    let (along, squares) = places().fold((0.0, 0.0), |(along, squares), (place, value)| {
        (along + place * (value - mean), squares + place * place)
    });
    let slope = along / squares;
    let (least, most) =
        places().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), (place, value)| {
            let off = value - mean - slope * place;
            (a.min(off), b.max(off))
        });
    (slope * count).abs() > most - least
}

#[cfg(test)]
mod tests {
    use super::drifts;

    #[test]
    fn a_vibration_about_a_line_drifts_if_the_line_rises_by_more() {
        let with = |slope: f64| -> Vec<f64> {
            (0..256).map(|i| f64::from(i) / 256.0).map(|t| slope * t + (40.0 * t).sin()).collect()
        };
        assert!(!drifts(&with(0.0)) && !drifts(&with(1.9)) && drifts(&with(2.3)));
        // A sixth of a period.
        let part: Vec<f64> = (0..256).map(|i| (f64::from(i) / 256.0).sin()).collect();
        assert!(drifts(&part));
        assert!(!drifts(&[0.3; 256]));
    }
}
