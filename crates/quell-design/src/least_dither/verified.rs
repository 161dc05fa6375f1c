//! The verification of a least dither by exact responses over the box, and its loss of friction there.

use super::no_design::NoDesign;
use super::search::{DesignPoint, grid};
use super::{DesignObjective, DesignProblem, ExactVerdict, LimitedQuantity, OperatingPoint};

/// Share of the least amplitude by which the verified dither exceeds it.
pub const MARGIN: f64 = 1e-3;

/// Rounds in which points that fail the verification are added to those that decide.
const ROUNDS: usize = 4;

/// An operating point at which the answer was verified.
#[derive(Clone, Debug, PartialEq)]
pub struct VerifiedPoint {
    /// The point of the box.
    pub point: Vec<f64>,
    /// Modulus of the deciding multiplier of the exact base response.
    pub multiplier: f64,
    /// Its growth rate, where small motions have exponents.
    pub growth_rate: Option<f64>,
}

impl DesignProblem<'_> {
    /// Verifies the dither by exact responses at the points of the box; points that fail are added to those that decide.
    pub(super) fn verified(
        &self,
        mut critical: DesignPoint,
    ) -> Result<(DesignPoint, Vec<VerifiedPoint>), NoDesign> {
        for _ in 0..ROUNDS {
            let amplitude = critical.amplitude * (1.0 + MARGIN);
            let mut points: Vec<Vec<f64>> = critical.worst.iter().cloned().collect();
            points.extend(self.points());
            let mut verified = Vec::new();
            let mut failing = Vec::new();
            for point in points {
                let at = OperatingPoint { point: &point, others: &critical.others };
                match self.plant.verdict(at, amplitude) {
                    Ok(verdict) if verdict.quiet => {
                        let ExactVerdict { multiplier, growth_rate, .. } = verdict;
                        verified.push(VerifiedPoint { point, multiplier, growth_rate });
                    }
                    Ok(_) => failing.push(point),
                    Err(why) => return Err(NoDesign::Failed { point, why }),
                }
            }
            let loud = self.plant.loud_points(self.over, &critical.others, amplitude);
            failing.extend(loud.map_err(|why| {
                let point = critical.worst.clone().unwrap_or_default();
                NoDesign::Failed { point, why }
            })?);
            if failing.is_empty() {
                return Ok((critical, verified));
            }
            critical.decisive.extend(failing);
            let others = critical.others.clone();
            let lowest = critical.amplitude;
            critical = self.exact_point_from(&others, &critical, lowest)?;
        }
        let point = critical.decisive.last().cloned().unwrap_or_default();
        Err(NoDesign::NeverQuiet { point })
    }

    /// The largest loss of mean friction in the box on the exact responses.
    pub(super) fn exact_loss(
        &self,
        critical: &DesignPoint,
        amplitude: f64,
    ) -> Result<(f64, Vec<f64>), String> {
        let wanted = self.objective == DesignObjective::FrictionLoss
            || self.limits.iter().any(|(quantity, _)| *quantity == LimitedQuantity::FrictionLoss);
        // The loss is asked for at every point only where it matters.
        let points = if wanted {
            self.points()
        } else {
            let mut points = grid(self.over, [1, 2, 2, 2], false);
            points.extend(critical.worst.clone());
            points
        };
        let mut largest: Option<(f64, Vec<f64>)> = None;
        for point in points {
            let at = OperatingPoint { point: &point, others: &critical.others };
            let loss = self.plant.exact_loss(at, amplitude)?;
            if largest.as_ref().is_none_or(|(most, _)| loss > *most) {
                largest = Some((loss, point));
            }
        }
        largest.ok_or_else(|| "the box has no points".to_owned())
    }
}
