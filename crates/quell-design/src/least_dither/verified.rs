//! The verification of a least dither by exact responses over the box, and its loss of friction there.

use std::cmp::Ordering;

use quell_numerics::interval::RealInterval;

use super::between_points::Towards;
use super::no_design::NoDesign;
use super::search::{DesignPoint, grid};
use super::{
    DesignObjective, DesignProblem, DesignStart, ExactVerdict, KEPT, LimitedQuantity,
    OperatingPoint, ResponseSize,
};
use crate::NoAnswer;
use crate::tasks::answers;

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
            let amplitude = self.verified_amplitude(critical.amplitude);
            let mut points: Vec<Vec<f64>> = critical.worst.iter().cloned().collect();
            points.extend(self.points());
            let line = self.line(&points);
            let dips =
                self.averaged_extremes(&line, (&critical.others, amplitude), &[Towards::Loud]);
            points.extend(dips.into_iter().map(|point| vec![point]));
            let mut verified = Vec::new();
            let mut failing = Vec::new();
            let verdicts = answers(self.tasks, &points, |point| {
                let at = OperatingPoint { point, others: &critical.others };
                self.plant.verdict(at, amplitude)
            });
            for (point, verdict) in points.into_iter().zip(verdicts) {
                match verdict {
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
            // The next least amplitude is above the one that failed; at the critical one itself a response may graze.
            critical = self.exact_point_from(&others, &critical, amplitude)?;
        }
        let point = critical.decisive.last().cloned().unwrap_or_default();
        Err(NoDesign::NeverQuiet { point })
    }

    /// Where the quiet amplitudes that a verified one belongs to end, at the corners of the box and the points that decide.
    pub(super) fn loud_from(
        &self,
        critical: &DesignPoint,
        verified: f64,
    ) -> Result<Option<f64>, NoAnswer> {
        if self.start != DesignStart::Local {
            return Err(NoAnswer::BeyondLeast);
        }
        let to = self.amplitude.upper;
        let mut points = grid(self.over, [1, 2, 2, 2], false);
        points.extend(critical.worst.iter().chain(&critical.decisive).cloned());
        points.sort_by(|a, b| a.partial_cmp(b).unwrap_or(Ordering::Equal));
        points.dedup();
        let mut first: Option<f64> = None;
        let sets = answers(self.tasks, &points, |point| {
            let at = OperatingPoint { point, others: &critical.others };
            self.plant.exact(at, RealInterval::new(verified, to.max(verified)))
        });
        for quiet in sets {
            let quiet = quiet?;
            let interval = quiet.intervals().iter().find(|interval| interval.lower <= verified);
            let end = interval.map_or(verified, |interval| interval.upper);
            if end < to {
                first = Some(first.map_or(end, |known: f64| known.min(end)));
            }
        }
        Ok(first)
    }

    /// The largest loss of mean friction in the box on the exact responses.
    pub(super) fn exact_loss(
        &self,
        critical: &DesignPoint,
        amplitude: f64,
    ) -> Result<(f64, Vec<f64>), NoAnswer> {
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
        let losses = answers(self.tasks, &points, |point| {
            let at = OperatingPoint { point, others: &critical.others };
            self.plant.exact_loss(at, amplitude)
        });
        for (point, loss) in points.into_iter().zip(losses) {
            let loss = loss?;
            if largest.as_ref().is_none_or(|(most, _)| loss > *most) {
                largest = Some((loss, point));
            }
        }
        largest.ok_or(NoAnswer::EmptyBox)
    }

    /// The limits that exact responses decide.
    fn limits_of_responses(&self) -> impl Iterator<Item = (LimitedQuantity, f64)> {
        self.limits.iter().copied().filter(|(quantity, _)| quantity.is_of_exact_response())
    }

    /// The largest size of the observed response in the box on the exact responses of the verified dither: at every point where a
    /// limit is on it.
    pub(super) fn exact_response(&self, critical: &DesignPoint) -> Result<ResponseSize, NoAnswer> {
        let mut largest = ResponseSize { rms: 0.0, peak: 0.0 };
        let points = self.points_of_response(critical);
        let sizes = answers(self.tasks, &points, |point| {
            let at = OperatingPoint { point, others: &critical.others };
            self.plant.exact_response(at, self.verified_amplitude(critical.amplitude))
        });
        for size in sizes {
            largest = largest.or_larger(size?);
        }
        Ok(largest)
    }

    fn points_of_response(&self, critical: &DesignPoint) -> Vec<Vec<f64>> {
        let is_limited = self.limits_of_responses().next().is_some();
        let mut points =
            if is_limited { self.points() } else { grid(self.over, [1, 2, 2, 2], false) };
        points.extend(critical.worst.clone());
        if is_limited {
            points.extend(critical.decisive.iter().cloned());
        }
        points
    }

    /// The limit on exact responses that the verified dither exceeds most in the box, with its operating point; or a point at which
    /// a response is unknown.
    pub(super) fn exceeded_by_responses(&self, critical: &DesignPoint) -> Option<NoDesign> {
        let limits: Vec<_> = self.limits_of_responses().collect();
        let amplitude = self.verified_amplitude(critical.amplitude);
        let mut most: Option<(f64, LimitedQuantity, Vec<f64>)> = None;
        for limited in limits {
            let points = self.points_of_response(critical);
            let shares = answers(self.tasks, &points, |point| {
                let at = OperatingPoint { point, others: &critical.others };
                self.used_exactly_at(limited, at, amplitude)
            });
            for (point, used) in points.into_iter().zip(shares) {
                match used {
                    Err(why) => return Some(NoDesign::Failed { point, why }),
                    Ok(used) if used > most.as_ref().map_or(KEPT, |(most, ..)| *most) => {
                        most = Some((used, limited.0, point));
                    }
                    Ok(_) => {}
                }
            }
        }
        most.map(|(used, quantity, point)| NoDesign::Limit { quantity, used, point: Some(point) })
    }
}
