//! How a least amplitude depends on the numbers of the structure: the derivatives of the exact threshold at the point that decides.
//!
//! At an end of the box, or at a smooth maximum inside it, they are those of the threshold at that operating point (at a maximum the
//! point itself may move: its effect is of second order). At a tip, where two thresholds meet inside the box, the tip moves, and the
//! derivatives are those of the amplitude of the tip: the operating point is determined by the two thresholds together.

use std::fmt;

use quell_dynamics::orbit::{
    NoOrbit, OrbitVerdict, Threshold, ThresholdKind, branch_thresholds, sensitivity_of_threshold,
};
use quell_model::{RefusedNumbers, System};
use quell_numerics::continuation::sensitivity::NoSensitivity;
use quell_numerics::interval::RealInterval;

/// Half the window in which the threshold is located again, relative to the amplitude.
const WINDOW: f64 = 5e-3;

/// Steps of the continuation over the window.
const STEPS: u32 = 8;

/// Distance up to which two thresholds meet, relative to the amplitude: tips are located to 10⁻⁷ of the range of the box.
const MEETS: f64 = 1e-4;

/// Step to both sides of a point inside the box, relative to its range: beyond the error of a tip, so that both of its thresholds are
/// seen.
const ASIDE: f64 = 1e-6;

/// A system at an amplitude, an operating point, and numbers of the structure.
pub type SystemOfNumbers<'a> =
    dyn Fn(f64, &[f64], &[f64]) -> Result<System, RefusedNumbers> + Sync + 'a;

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
    pub over: &'a [RealInterval],
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
    pub derivatives: Vec<Result<f64, NoSensitivity>>,
}

/// Why a least amplitude has no derivatives.
#[derive(Clone, Debug, PartialEq)]
pub enum NoLeastSensitivity {
    /// The base response was not followed around the amplitude.
    NoOrbit(NoOrbit),
    /// No threshold is at the amplitude.
    NoThreshold {
        /// The amplitude.
        amplitude: f64,
    },
    /// The threshold has no derivatives.
    NoSensitivity(NoSensitivity),
}

impl fmt::Display for NoLeastSensitivity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoOrbit(why) => why.fmt(f),
            Self::NoThreshold { amplitude } => {
                write!(f, "no threshold of the base response is at the amplitude {amplitude}")
            }
            Self::NoSensitivity(why) => why.fmt(f),
        }
    }
}

impl std::error::Error for NoLeastSensitivity {}

impl LeastAmplitude<'_> {
    /// The derivatives with respect to the numbers.
    ///
    /// # Errors
    /// [`NoLeastSensitivity`].
    pub fn sensitivity(&self) -> Result<LeastAmplitudeSensitivity, NoLeastSensitivity> {
        let inside = (0..self.point.len()).find(|place| {
            let RealInterval { lower: low, upper: high } = self.over[*place];
            self.point[*place] > low && self.point[*place] < high
        });
        let mut near = self.thresholds_at(self.point)?;
        let Some(place) = inside else {
            let deciding = self.deciding(&near, WINDOW)?;
            return self.derivatives(self.point, &near[deciding], None);
        };
        let RealInterval { lower: low, upper: high } = self.over[place];
        for aside in [-ASIDE, ASIDE] {
            let mut point = self.point.to_vec();
            point[place] = (point[place] + aside * (high - low)).clamp(low, high);
            near.extend(self.thresholds_at(&point)?);
        }
        near.retain(|threshold| (threshold.value - self.amplitude).abs() <= MEETS * self.amplitude);
        let deciding = &near[self.deciding(&near, MEETS)?];
        // Of the thresholds that meet at a tip, each changes the verdict on one side alone, or both on one side.
        let other = |threshold: &&Threshold| {
            threshold.kind != deciding.kind || threshold.contacts != deciding.contacts
        };
        let meets = near.iter().find(other).map(|threshold| (place, threshold));
        self.derivatives(self.point, deciding, meets)
    }

    /// The thresholds near the amplitude at an operating point.
    fn thresholds_at(&self, point: &[f64]) -> Result<Vec<Threshold>, NoLeastSensitivity> {
        let at = |values: &[f64]| (self.at)(values[0], point, self.numbers);
        let window =
            RealInterval::new(self.amplitude * (1.0 - WINDOW), self.amplitude * (1.0 + WINDOW));
        let found = branch_thresholds(&at, window.lower, window.upper, STEPS, None);
        Ok(found.map_err(NoLeastSensitivity::NoOrbit)?.thresholds)
    }

    /// The threshold nearest to the amplitude at which the base response becomes stable.
    fn deciding(&self, found: &[Threshold], within: f64) -> Result<usize, NoLeastSensitivity> {
        let distance = |place: &usize| (found[*place].value - self.amplitude).abs();
        (0..found.len())
            .filter(|place| found[*place].becomes == Some(OrbitVerdict::Stable))
            .filter(|place| distance(place) <= within * self.amplitude)
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))
            .ok_or(NoLeastSensitivity::NoThreshold { amplitude: self.amplitude })
    }

    fn derivatives(
        &self,
        point: &[f64],
        deciding: &Threshold,
        meets: Option<(usize, &Threshold)>,
    ) -> Result<LeastAmplitudeSensitivity, NoLeastSensitivity> {
        let mut parameters = vec![deciding.value];
        let mut sizes = vec![deciding.value];
        if let Some((place, _)) = meets {
            let RealInterval { lower: low, upper: high } = self.over[place];
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
        let mut both: Vec<&Threshold> =
            [deciding].into_iter().chain(meets.map(|(_, other)| other)).collect();
        // Either becomes quiet on one side of a tip: the one of a contact is named first.
        both.sort_by_key(|threshold| threshold.contacts.is_empty());
        let found = sensitivity_of_threshold(&at, &both, &parameters, &sizes);
        let found = found.map_err(NoLeastSensitivity::NoSensitivity)?;
        let derivatives = found.derivatives.into_iter().map(|rates| Ok(rates?[0]));
        Ok(LeastAmplitudeSensitivity {
            kind: both[0].kind,
            meets: both.get(1).map(|other| other.kind),
            derivatives: derivatives.collect(),
        })
    }
}
