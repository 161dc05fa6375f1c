//! The exact least amplitude at single operating points: what a dither that follows the operating point needs.

use super::{DesignObjective, DesignProblem, OperatingPoint};
use crate::NoAnswer;
use quell_numerics::interval::RealInterval;

/// Window about the amplitude of averaging in which the exact one is sought first, as factors.
const WINDOW: RealInterval = RealInterval::new(0.85, 1.15);

/// The least dither at one operating point.
#[derive(Clone, Debug, PartialEq)]
pub struct ScheduledDither {
    /// The operating point.
    pub point: Vec<f64>,
    /// The exact least amplitude there, or why it is unknown.
    pub amplitude: Result<f64, NoAnswer>,
    /// The objective there.
    pub objective: Result<f64, NoAnswer>,
}

impl DesignProblem<'_> {
    /// The least amplitude that is quiet at one operating point, with the other design variables of a design: that of a box of this
    /// point alone, without limits.
    pub fn scheduled(&self, point: &[f64], others: &[f64]) -> ScheduledDither {
        let at = OperatingPoint { point, others };
        let amplitude = self.least_at(at);
        let objective = amplitude.clone().and_then(|amplitude| self.objective_at(at, amplitude));
        ScheduledDither { point: point.to_vec(), amplitude, objective }
    }

    /// The exact least amplitude at a point: near that of averaging, below which a point is loud, or else in the whole range.
    fn least_at(&self, at: OperatingPoint<'_>) -> Result<f64, NoAnswer> {
        let RealInterval { lower: from, upper: to } = self.amplitude;
        let averaged = self.plant.averaged(at, self.amplitude)?.least_from(from);
        if let Some(averaged) = averaged {
            let (low, high) =
                ((averaged * WINDOW.lower).max(from), (averaged * WINDOW.upper).min(to));
            if low < high
                && let Ok(near) = self.plant.exact(at, RealInterval::new(low, high))
                && let Some(least) = near.least_from(low)
                && (least > low || low == from)
            {
                return Ok(least);
            }
        }
        self.plant.exact(at, self.amplitude)?.least_from(from).ok_or(NoAnswer::NeverQuiet)
    }

    /// The objective of an amplitude at one operating point.
    fn objective_at(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<f64, NoAnswer> {
        let price = || self.plant.price(at, amplitude);
        match self.objective {
            DesignObjective::Amplitude => Ok(amplitude),
            DesignObjective::Stroke => price().map(|price| price.stroke),
            DesignObjective::Velocity => price().map(|price| price.velocity),
            DesignObjective::Power => price().map(|price| price.power),
            DesignObjective::FrictionLoss => {
                self.plant.exact_loss(at, self.verified_amplitude(amplitude))
            }
        }
    }
}
