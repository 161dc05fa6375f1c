//! How a least amplitude depends on the numbers of the structure: the derivatives of the exact threshold at the point that decides.
//!
//! At an end of the box, or at a smooth maximum inside it, they are those of the threshold at that operating point (at a maximum the
//! point itself may move: its effect is of second order). At a tip, where two thresholds meet inside the box, the tip moves, and the
//! derivatives are those of the amplitude of the tip: the operating point is determined by the two thresholds together.

use quell_dynamics::motion::orbit::{MotionThreshold, motion_sensitivity, motion_thresholds};
use quell_dynamics::orbit::OrbitVerdict;
use quell_dynamics::orbit::threshold::ThresholdKind;
use quell_model::System;

/// Half the window in which the threshold is located again, relative to the amplitude.
const WINDOW: f64 = 5e-3;

/// Steps of the continuation over the window.
const STEPS: u32 = 8;

/// Distance up to which two thresholds meet, relative to the amplitude: tips are located to 10⁻⁷ of the range of the box.
const MEETS: f64 = 1e-4;

/// Steps from a tip into the box on both sides, relative to its range: the search may end on the side on which nothing is loud.
const ASIDE: [f64; 3] = [0.0, -1e-5, 1e-5];

/// A system at an amplitude, an operating point, and numbers of the structure.
pub type SystemOfNumbers<'a> = dyn Fn(f64, &[f64], &[f64]) -> Result<System, String> + Sync + 'a;

/// A least amplitude whose derivatives are wanted.
#[derive(Clone, Copy)]
pub struct LeastAmplitude<'a> {
    /// The structure.
    pub at: &'a SystemOfNumbers<'a>,
    /// The exact least amplitude.
    pub amplitude: f64,
    /// The operating point that decides.
    pub point: &'a [f64],
    /// The box of operating points.
    pub over: &'a [(f64, f64)],
    /// Values of the numbers by which the amplitude is differentiated, none of them 0.
    pub numbers: &'a [f64],
}

/// The derivatives of a least amplitude.
#[derive(Clone, Debug, PartialEq)]
pub struct LeastAmplitudeSensitivity {
    /// The kind of the threshold.
    pub kind: ThresholdKind,
    /// The kind of the other threshold, at a tip.
    pub meets: Option<ThresholdKind>,
    /// The derivative with respect to each number, or why it is unknown.
    pub derivatives: Vec<Result<f64, String>>,
}

impl LeastAmplitude<'_> {
    /// The derivatives with respect to the numbers.
    ///
    /// # Errors
    /// Why the threshold has none: it was not found, or its equations are singular.
    pub fn sensitivity(&self) -> Result<LeastAmplitudeSensitivity, String> {
        let inside = (0..self.point.len()).find(|place| {
            let (low, high) = self.over[*place];
            self.point[*place] > low && self.point[*place] < high
        });
        let asides: &[f64] = if inside.is_some() { &ASIDE } else { &ASIDE[..1] };
        let mut last = None;
        for aside in asides {
            let mut point = self.point.to_vec();
            if let Some(place) = inside {
                let (low, high) = self.over[place];
                point[place] = (point[place] + aside * (high - low)).clamp(low, high);
            }
            match self.at_point(&point, inside) {
                Ok(found) => return Ok(found),
                Err(why) => last = last.or(Some(why)),
            }
        }
        Err(last.unwrap_or_else(|| "the threshold was not found".to_owned()))
    }

    fn at_point(
        &self,
        point: &[f64],
        inside: Option<usize>,
    ) -> Result<LeastAmplitudeSensitivity, String> {
        let at = |values: &[f64]| (self.at)(values[0], point, self.numbers);
        let window = (self.amplitude * (1.0 - WINDOW), self.amplitude * (1.0 + WINDOW));
        let found = motion_thresholds(&at, window, STEPS, None).map_err(|why| why.to_string())?;
        let distance = |threshold: &&MotionThreshold| (threshold.value - self.amplitude).abs();
        let of_tip = if inside.is_some() { MEETS } else { WINDOW };
        let deciding = found
            .thresholds
            .iter()
            .filter(|threshold| threshold.becomes == Some(OrbitVerdict::Stable))
            .filter(|threshold| distance(threshold) <= of_tip * self.amplitude)
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))
            .ok_or_else(|| {
                format!("no threshold of the base response is at the amplitude {}", self.amplitude)
            })?;
        let meets = inside.and_then(|place| {
            let near = |other: &&MotionThreshold| {
                let apart = (other.value - deciding.value).abs();
                other.value != deciding.value && apart <= MEETS * self.amplitude
            };
            Some((place, found.thresholds.iter().find(near)?))
        });
        self.derivatives(point, deciding, meets)
    }

    fn derivatives(
        &self,
        point: &[f64],
        deciding: &MotionThreshold,
        meets: Option<(usize, &MotionThreshold)>,
    ) -> Result<LeastAmplitudeSensitivity, String> {
        let mut parameters = vec![deciding.value];
        let mut sizes = vec![deciding.value];
        if let Some((place, _)) = meets {
            let (low, high) = self.over[place];
            parameters.push(point[place]);
            sizes.push(if point[place] == 0.0 { high - low } else { point[place].abs() });
        }
        let determined = parameters.len();
        parameters.extend(self.numbers);
        sizes.extend(self.numbers.iter().map(|number| number.abs()));
        let at = |values: &[f64]| {
            let mut point = point.to_vec();
            if let Some((place, _)) = meets {
                point[place] = values[1];
            }
            (self.at)(values[0], &point, &values[determined..])
        };
        let both: Vec<&MotionThreshold> =
            [deciding].into_iter().chain(meets.map(|(_, other)| other)).collect();
        let found = motion_sensitivity(&at, &both, &parameters, &sizes);
        let found = found.map_err(|why| why.to_string())?;
        let derivatives = found.derivatives.into_iter().map(|rates| match rates {
            Ok(rates) => Ok(rates[0]),
            Err(why) => Err(why.to_string()),
        });
        Ok(LeastAmplitudeSensitivity {
            kind: deciding.kind,
            meets: meets.map(|(_, other)| other.kind),
            derivatives: derivatives.collect(),
        })
    }
}
