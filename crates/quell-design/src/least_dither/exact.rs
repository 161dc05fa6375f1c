//! The least dither by exact thresholds, near that of averaging, and its verification.

use quell_numerics::interval::RealInterval;
use quell_numerics::order::ascending_by;

use super::exact_box::{ExactBox, WINDOW};
use super::no_design::NoDesign;
use super::search::{AveragedSearch, DesignBasin, DesignPoint, Judged};
use super::verified::VerifiedPoint;
use super::{DesignProblem, KEPT, LimitedQuantity, MARGIN, OperatingPoint, ResponseSize};
use crate::NoAnswer;
use crate::actuator::ActuatorDemand;

/// A limit binds by averaging if at least this share of it is used.
const BINDS: f64 = 1.0 - 1e-6;

/// Times that a limit of the response is followed again with a further operating point.
const RESPONSE_ROUNDS: usize = 2;

/// Steps of the secant method along a limit, and the closeness to it.
const SECANT: (usize, f64) = (12, 1e-7);

/// A least dither.
#[derive(Clone, Debug, PartialEq)]
pub struct FeasibleDesign {
    /// The exact least dither.
    pub critical: DesignPoint,
    /// The dither of averaging alone.
    pub averaged: DesignPoint,
    /// The amplitude at which the answer was verified: the critical one and a margin.
    pub verified_amplitude: f64,
    /// The points at which it was verified: the one that decides first.
    pub verified: Vec<VerifiedPoint>,
    /// The amplitude from which the dither is loud again somewhere, above the verified one: `None` where every larger amplitude of the
    /// range is quiet at the points that were judged.
    pub loud_from: Result<Option<f64>, NoAnswer>,
    /// The largest loss of mean friction on the exact responses, with its operating point, or why it is unknown.
    pub friction_loss: Result<(f64, Vec<f64>), NoAnswer>,
    /// The largest size of the observed response on the exact responses, or why it is unknown.
    pub response: Result<ResponseSize, NoAnswer>,
    /// What the verified dither demands of the actuator where a limit is used most, with the operating point, or why it is unknown.
    pub drive: Result<(ActuatorDemand, Vec<f64>), NoAnswer>,
}

impl FeasibleDesign {
    /// The share by which the verified amplitude exceeds the least one: [`MARGIN`], or less where the range of amplitudes ends.
    pub fn margin(&self) -> f64 {
        let least = self.critical.amplitude;
        match self.verified_amplitude {
            verified if verified < least * (1.0 + MARGIN) => verified / least - 1.0,
            _ => MARGIN,
        }
    }

    /// The largest multiplier at the points at which the dither was verified.
    pub fn largest_multiplier(&self) -> f64 {
        self.verified.iter().map(|at| at.multiplier).fold(0.0, f64::max)
    }
}

/// Why there is no dither.
#[derive(Clone, Debug, PartialEq)]
pub struct InfeasibleDesign {
    /// The dither that comes nearest, if one is quiet everywhere without the limits.
    pub nearest: Option<DesignPoint>,
    /// Why no dither is allowed.
    pub why: NoDesign,
}

/// The answer about one waveform.
#[derive(Clone, Debug)]
pub struct Designed {
    /// The least dither, or why no dither is allowed.
    pub answer: Result<FeasibleDesign, InfeasibleDesign>,
    /// The local minima over the design variables, by averaging, the best first.
    pub basins: Vec<DesignBasin>,
    /// Every choice of the design variables that was tried by averaging, in the order of the first design variable.
    pub tried: Vec<DesignPoint>,
}

/// The least dither of a problem.
pub fn design(problem: DesignProblem<'_>) -> Designed {
    let searched = problem.averaged_search();
    let basins = searched.found.iter().map(|point| DesignBasin {
        others: point.others.clone(),
        amplitude: point.amplitude,
        objective: point.objective.clone().unwrap_or(f64::INFINITY),
    });
    let basins = basins.collect();
    let mut first_failure = None;
    let mut answer = None;
    for averaged in &searched.found {
        match problem.feasible(averaged) {
            Ok(feasible) => {
                answer = Some(feasible);
                break;
            }
            Err(why) => first_failure = first_failure.or(Some((averaged.clone(), why))),
        }
    }
    let answer = answer.ok_or_else(|| {
        let (nearest, why) = match first_failure {
            Some((nearest, why)) => (Some(nearest), why),
            None => nearest(&searched),
        };
        InfeasibleDesign { nearest, why }
    });
    let mut tried = searched.tried;
    ascending_by(&mut tried, |point| point.others.first().copied().unwrap_or(0.0));
    Designed { answer, basins, tried }
}

/// The choice that comes nearest to keeping every limit, and the limit that it exceeds.
fn nearest(searched: &AveragedSearch) -> (Option<DesignPoint>, NoDesign) {
    let point =
        searched.tried.iter().min_by(|a, b| a.use_of_limits().total_cmp(&b.use_of_limits()));
    let Some(point) = point else {
        let why = searched.refused.first().map(|(_, why)| why.clone().into());
        let nothing = NoDesign::Failed { point: Vec::new(), why: NoAnswer::NothingTried };
        return (None, why.unwrap_or(nothing));
    };
    (Some(point.clone()), exceeded(point))
}

/// The limit that a choice exceeds most.
fn exceeded(point: &DesignPoint) -> NoDesign {
    let mut worst: Option<(LimitedQuantity, f64)> = None;
    for (quantity, used) in &point.used {
        match used {
            Err(why) if matches!(quantity, LimitedQuantity::Actuator(_)) => {
                let (quantity, why) = (*quantity, why.clone());
                return NoDesign::Unlimited { quantity, point: point.worst.clone(), why };
            }
            Err(why) => {
                return NoDesign::Failed {
                    point: point.worst.clone().unwrap_or_default(),
                    why: NoAnswer::OfLimit { limit: quantity.name(), why: Box::new(why.clone()) },
                };
            }
            Ok(used) if worst.is_none_or(|(_, most)| *used > most) => {
                worst = Some((*quantity, *used));
            }
            Ok(_) => {}
        }
    }
    match (worst, &point.objective) {
        (Some((quantity, used)), _) if used > KEPT => {
            NoDesign::Limit { quantity, used, point: point.worst.clone() }
        }
        (_, Err(why)) => {
            NoDesign::Failed { point: point.worst.clone().unwrap_or_default(), why: why.clone() }
        }
        _ => NoDesign::Failed { point: Vec::new(), why: NoAnswer::NothingAllowed },
    }
}

impl DesignProblem<'_> {
    /// The exact least dither near that of averaging.
    fn feasible(&self, averaged: &DesignPoint) -> Result<FeasibleDesign, NoDesign> {
        let mut critical = self.exact_point(&averaged.others, averaged)?;
        if averaged.use_of_limits() >= BINDS || critical.use_of_limits() > KEPT {
            critical = self.at_the_limit(critical)?;
        } else if !self.others.is_empty() {
            critical = self.at_the_minimum(critical);
        }
        let (mut critical, mut verified) = self.verified(critical)?;
        let mut response = self.exact_response(&critical);
        for _ in 0..RESPONSE_ROUNDS {
            // Where a limit is exceeded at a point of the box that was not judged on the way, it is judged from there on.
            let Some(NoDesign::Limit { point: Some(point), .. }) =
                self.exceeded_by_responses(&critical)
            else {
                break;
            };
            critical.decisive.push(point);
            critical = self.at_the_limit(critical)?;
            (critical, verified) = self.verified(critical)?;
            response = self.exact_response(&critical);
        }
        if critical.use_of_limits() > KEPT {
            return Err(exceeded(&critical));
        }
        if let Some(why) = self.exceeded_by_responses(&critical) {
            return Err(why);
        }
        let verified_amplitude = self.verified_amplitude(critical.amplitude);
        let friction_loss = self.exact_loss(&critical, verified_amplitude);
        let loud_from = self.loud_from(&critical, verified_amplitude);
        let worst = critical.worst.as_ref();
        let drive = self.largest_demand(&critical.others, verified_amplitude, worst);
        Ok(FeasibleDesign {
            critical,
            averaged: averaged.clone(),
            verified_amplitude,
            verified,
            loud_from,
            friction_loss,
            response,
            drive,
        })
    }

    /// The exact least amplitude at a choice of the other design variables, near that of a neighbouring choice.
    fn exact_point(&self, others: &[f64], near: &DesignPoint) -> Result<DesignPoint, NoDesign> {
        self.exact_point_from(others, near, near.amplitude * WINDOW.lower)
    }

    /// The same, with amplitudes from `lowest` on.
    pub(super) fn exact_point_from(
        &self,
        others: &[f64],
        near: &DesignPoint,
        lowest: f64,
    ) -> Result<DesignPoint, NoDesign> {
        let quiet = |point: &[f64], range: RealInterval| {
            self.plant.exact(OperatingPoint { point, others }, range)
        };
        let found = ExactBox::of(self).least(&quiet, near.into(), lowest)?;
        Ok(self.priced(others, found, Judged::Exactly))
    }

    /// The choice on the limit: the first design variable moves until the exact amplitude uses the limit wholly.
    fn at_the_limit(&self, start: DesignPoint) -> Result<DesignPoint, NoDesign> {
        let Some(RealInterval { lower: low, upper: high }) = self.others.first().copied() else {
            return Ok(start);
        };
        let mut before = start.clone();
        let moved = |point: &DesignPoint, value: f64| {
            let mut others = point.others.clone();
            others[0] = value.clamp(low, high);
            self.exact_point(&others, point)
        };
        let step = if start.others[0] * (1.0 + 1e-3) <= high { 1e-3 } else { -1e-3 };
        let mut now = moved(&start, start.others[0] * (1.0 + step))?;
        for _ in 0..SECANT.0 {
            let (use_before, use_now) = (before.use_of_limits(), now.use_of_limits());
            if (use_now - 1.0).abs() < SECANT.1 {
                break;
            }
            let (x, y) = (before.others[0], now.others[0]);
            if use_now == use_before || x == y {
                break;
            }
            let next = y - (use_now - 1.0) * (y - x) / (use_now - use_before);
            let next = moved(&now, next)?;
            before = std::mem::replace(&mut now, next);
        }
        Ok(now)
    }

    /// The choice at a smooth minimum of the exact objective: the vertex of a parabola along each design variable.
    fn at_the_minimum(&self, start: DesignPoint) -> DesignPoint {
        const STEP: f64 = 0.01;
        let mut best = start;
        for (coordinate, RealInterval { lower, upper }) in self.others.iter().enumerate() {
            let value = best.others[coordinate];
            let at = |value: f64| {
                let mut others = best.others.clone();
                others[coordinate] = value;
                let point = self.exact_point(&others, &best).ok()?;
                let objective = point.allowed()?;
                Some((objective, point))
            };
            let size = STEP * if *lower > 0.0 { value } else { upper - lower };
            if value - size < *lower || value + size > *upper {
                continue;
            }
            let (Some(left), Some(right), Some(middle)) =
                (at(value - size), at(value + size), best.allowed())
            else {
                continue;
            };
            let curvature = left.0 - 2.0 * middle + right.0;
            let shift = 0.5 * size * (left.0 - right.0) / curvature;
            let vertex = (curvature > 0.0 && shift.abs() <= size).then(|| at(value + shift));
            let candidates = [Some(left), Some(right), vertex.flatten()];
            for (objective, point) in candidates.into_iter().flatten() {
                if best.allowed().is_none_or(|known| objective < known) {
                    best = point;
                }
            }
        }
        best
    }
}
