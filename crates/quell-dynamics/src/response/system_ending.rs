//! Where the runs of a response end, judged by periodic motions as `orbit` and `thresholds` judge them.

use quell_linear::growth::Verdict;
use quell_linear::linearised::Linearised;
use quell_linear::spectrum::spectrum;
use quell_model::System;

use crate::motion::MotionStart;
use crate::motion::orbit::{NoCycle, SettledMotion, free_cycle, is_on_sliding, settled};
use crate::orbit::OrbitVerdict;

/// Where a run ends.
#[derive(Clone, Debug, PartialEq)]
pub enum SystemEnding {
    /// On a stable periodic motion.
    Orbit {
        /// A state at which the phase of the dither is that at t = 0.
        state: Vec<f64>,
        /// Time at which the run passes that state, whole periods of the dither; 0 without dither, where the phase of the run on its
        /// cycle is not known.
        time: f64,
        /// Its period.
        period: f64,
    },
    /// At rest or in steady sliding, without dither.
    Rest,
    /// In steady sliding without dither that is unstable: the start does not disturb it.
    UnstableSliding,
    /// On no periodic motion: over its record it moves on by more than it vibrates.
    Drift,
    /// On no periodic motion that was found: its record decides.
    Record,
}

impl SystemEnding {
    /// The ending of a run from a start. An orbit that is not stable is not where a run ends.
    pub(super) fn of(system: &System, start: &MotionStart) -> Self {
        if !system.is_dithered() {
            return match free_cycle(&system.undithered(), &start.state) {
                Ok(cycle) if cycle.verdict() == OrbitVerdict::Stable => {
                    Self::Orbit { state: cycle.state, time: 0.0, period: cycle.period }
                }
                Err(NoCycle::Rest { state, .. }) if is_unstable_sliding(system, &state) => {
                    Self::UnstableSliding
                }
                Err(NoCycle::Rest { .. }) => Self::Rest,
                Ok(_) | Err(_) => Self::Record,
            };
        }
        // Noise has no period, and the phase of the dither of an orbit's state is that at t = 0.
        if start.time != 0.0 || system.has_noise() {
            return Self::Record;
        }
        match settled(system, &start.state) {
            Ok(SettledMotion { orbit, multiple, periods }) => Self::Orbit {
                time: f64::from(periods) * orbit.period / f64::from(multiple),
                state: orbit.state,
                period: orbit.period,
            },
            Err(_) => Self::Record,
        }
    }

    /// The word in outputs.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Orbit { .. } => "orbit",
            Self::Rest => "rest",
            Self::UnstableSliding => "unstable sliding",
            Self::Drift => "drift",
            Self::Record => "record",
        }
    }

    /// Period of the orbit.
    pub fn period(&self) -> Option<f64> {
        match self {
            Self::Orbit { period, .. } => Some(*period),
            Self::Rest | Self::UnstableSliding | Self::Drift | Self::Record => None,
        }
    }

    /// The ending of a run whose record has these samples: without a known motion the record may drift.
    pub(super) fn with_record(self, samples: &[f64]) -> Self {
        if self == Self::Record && drifts(samples) { Self::Drift } else { self }
    }

    /// Whether it has no vibration slower than an angular frequency: every line of an orbit is a multiple of its own frequency.
    pub(super) fn is_faster_than(&self, frequency: f64) -> bool {
        self.period().is_some_and(|period| std::f64::consts::TAU / period > frequency)
    }
}

/// Whether a state is that of steady sliding, and that is unstable.
fn is_unstable_sliding(system: &System, state: &[f64]) -> bool {
    is_on_sliding(system, state) && cannot_settle(system)
}

/// Whether steady sliding of a system is unstable, so that hardly any run can settle there.
pub(super) fn cannot_settle(system: &System) -> bool {
    let Ok(linear) = Linearised::new(system) else { return false };
    let found = spectrum(&linear, &linear.friction());
    found.is_ok_and(|found| found.growth.verdict() == Verdict::Unstable)
}

/// Whether samples move on by more than they vibrate: the line that fits them best changes by more than their peak-to-peak distance
/// from it. A record shorter than half a period of a vibration drifts too: it shows no vibration.
fn drifts(samples: &[f64]) -> bool {
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
