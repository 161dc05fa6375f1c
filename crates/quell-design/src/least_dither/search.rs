//! The least dither by averaging, globally over the design variables other than the amplitude.
//!
//! A grid over these variables (equal ratios where a range is positive) finds the local minima of the objective among the points that
//! keep every limit; the best of them are refined by a pattern search that stays on the allowed side of the limits.

use quell_numerics::interval::RealInterval;
use quell_numerics::order::ascending_by;

use super::worst_point::{BoxSearch, LeastOfBox, NoLeast, least_of_box};
use crate::NoAnswer;
use crate::actuator::{ActuatorDemand, ActuatorLimit};
use crate::tasks::answers;

use super::{DesignObjective, DesignProblem, KEPT, LimitedQuantity, OperatingPoint};

/// Points of the grid along each design variable, by their number.
const GRID: [usize; 4] = [1, 49, 13, 6];

/// Points of the box along each coordinate where every point is judged, and while design variables are searched.
const FINE: [usize; 4] = [1, 33, 9, 5];
const COARSE: [usize; 4] = [1, 7, 3, 2];

/// Points of the box along each coordinate at which a limited response is judged while a limit is followed.
const RESPONSE_POINTS: [usize; 4] = [1, 3, 2, 2];

/// How limits of the response are judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Judged {
    /// By the linear structure.
    ByAveraging,
    /// On exact base responses.
    Exactly,
}

/// Share by which the estimate of a limited response or loss of friction, at the amplitude of averaging, may be wrong: the loss of the
/// example of the book differs by 2 % there. A choice that is off by more is not followed; one that is let in is judged exactly later.
const ESTIMATE: f64 = 0.05;

/// Share of the least amplitude that a limit on the amplitude leaves at least for the margin of the verified dither, which ends at that
/// limit. A smaller one leaves a dither that is verified where it begins to be quiet, and fails by rounding.
const LEAST_MARGIN: f64 = 1e-4;

/// Ratio to the end of the band of the vibration from which a dither is outside of it.
const BEYOND_BAND: f64 = 1.001;

/// Use of a limit up to which choices between the points of the grid are sought that keep it.
const NEAREST: f64 = 1.5;

/// Local minima that are refined.
const BASINS: usize = 4;

/// Last step of the search over design variables, as a share of their ranges, and where responses are computed at each choice.
const CLOSENESS: f64 = 1e-9;
const CLOSENESS_OF_RESPONSES: f64 = 1e-3;

/// Steps of the search over the box.
const BOX_CLOSENESS: f64 = 1e-9;

/// A choice of the design variables with its least amplitude.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignPoint {
    /// Values of the design variables other than the amplitude.
    pub others: Vec<f64>,
    /// The least amplitude that is quiet in the whole box.
    pub amplitude: f64,
    /// The objective there.
    pub objective: Result<f64, NoAnswer>,
    /// The operating point that decides; `None` where the smallest allowed amplitude is quiet everywhere.
    pub worst: Option<Vec<f64>>,
    /// Every operating point at which a loud set was climbed.
    pub decisive: Vec<Vec<f64>>,
    /// For each limit how far it is used: at most 1 where it is kept.
    pub used: Vec<(LimitedQuantity, Result<f64, NoAnswer>)>,
}

/// A local minimum of the objective over the design variables, by averaging.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignBasin {
    /// Values of the design variables other than the amplitude.
    pub others: Vec<f64>,
    /// The least amplitude.
    pub amplitude: f64,
    /// The objective.
    pub objective: f64,
}

/// What the search over design variables found.
#[derive(Clone, Debug, Default)]
pub(super) struct AveragedSearch {
    /// The local minima that keep the limits, the best first.
    pub(super) found: Vec<DesignPoint>,
    /// Every choice that was tried, whether or not it keeps the limits, in the order of the grid first.
    pub(super) tried: Vec<DesignPoint>,
    /// Why choices have no amplitude.
    pub(super) refused: Vec<(Vec<f64>, NoLeast)>,
}

impl AveragedSearch {
    /// Adds what other parts of the search found, in their order.
    fn extend(&mut self, parts: Vec<Self>) {
        for part in parts {
            self.found.extend(part.found);
            self.tried.extend(part.tried);
            self.refused.extend(part.refused);
        }
    }
}

impl DesignPoint {
    /// How far the tightest limit is used; infinite where a limit cannot be judged.
    pub fn use_of_limits(&self) -> f64 {
        let one = |used: &Result<f64, NoAnswer>| used.as_ref().map_or(f64::INFINITY, |used| *used);
        self.used.iter().map(|(_, used)| one(used)).fold(0.0, f64::max)
    }

    /// The objective where every limit is kept.
    pub(super) fn allowed(&self) -> Option<f64> {
        self.objective.as_ref().ok().copied().filter(|_| self.use_of_limits() <= KEPT)
    }

    /// The objective where every limit may be kept: those whose use is an estimate may be exceeded by its error.
    fn may_be_allowed(&self) -> Option<f64> {
        let kept = |(quantity, used): &(LimitedQuantity, Result<f64, NoAnswer>)| {
            let most = if quantity.is_of_exact_response() { 1.0 + ESTIMATE } else { 1.0 };
            used.as_ref().is_ok_and(|used| *used <= most)
        };
        self.objective.as_ref().ok().copied().filter(|_| self.used.iter().all(kept))
    }
}

/// A grid over ranges, with `counts[d]` points along each of d coordinates (two beyond the list): the last coordinate varies fastest.
pub(super) fn grid(ranges: &[RealInterval], counts: [usize; 4], in_ratios: bool) -> Vec<Vec<f64>> {
    let count = counts.get(ranges.len()).copied().unwrap_or(2);
    let mut points = vec![Vec::new()];
    for RealInterval { lower: low, upper: high } in ranges {
        let value = |k: usize| {
            let share = k as f64 / (count - 1) as f64;
            match k {
                0 => *low,
                k if k + 1 == count => *high,
                _ if in_ratios && *low > 0.0 => low * libm::exp(share * libm::log(high / low)),
                _ => low + share * (high - low),
            }
        };
        let single = low == high || count == 1;
        let values: Vec<f64> = if single { vec![*low] } else { (0..count).map(value).collect() };
        points = points
            .iter()
            .flat_map(|point: &Vec<f64>| {
                values.iter().map(|value| [point.as_slice(), &[*value]].concat())
            })
            .collect();
    }
    points
}

/// Points of a box at which every answer is judged.
pub(super) fn box_points(over: &[RealInterval]) -> Vec<Vec<f64>> {
    grid(over, FINE, false)
}

impl DesignProblem<'_> {
    /// Points of the box at which every answer is judged.
    pub(super) fn points(&self) -> Vec<Vec<f64>> {
        box_points(self.over)
    }

    /// The largest value of a quantity over the corners of the box and the point that decides.
    fn largest(
        &self,
        worst: Option<&Vec<f64>>,
        value: impl Fn(&[f64]) -> Result<f64, NoAnswer> + Sync,
    ) -> Result<f64, NoAnswer> {
        let mut points = grid(self.over, [1, 2, 2, 2], false);
        points.extend(worst.cloned());
        let values = answers(self.tasks, &points, |point| value(point));
        values.into_iter().try_fold(f64::NEG_INFINITY, |largest, value| Ok(largest.max(value?)))
    }

    /// How far a limit of the response is used on exact base responses, those of the verified dither.
    fn exactly_used(
        &self,
        (quantity, limit): (LimitedQuantity, f64),
        others: &[f64],
        amplitude: f64,
        points: &[Vec<f64>],
    ) -> Option<Result<f64, NoAnswer>> {
        if !quantity.is_of_exact_response() {
            return None;
        }
        let verified = self.verified_amplitude(amplitude);
        let shares = answers(self.tasks, points, |point| {
            self.used_exactly_at((quantity, limit), OperatingPoint { point, others }, verified)
        });
        Some(shares.into_iter().try_fold(0.0, |most: f64, used| Ok(most.max(used?))))
    }

    /// How far a limit on exact responses is used by a dither at one operating point.
    pub(super) fn used_exactly_at(
        &self,
        (quantity, limit): (LimitedQuantity, f64),
        at: OperatingPoint<'_>,
        amplitude: f64,
    ) -> Result<f64, NoAnswer> {
        let value = match quantity.of_response() {
            Some(of) => of(self.plant.exact_response(at, amplitude)?),
            None => self.plant.exact_loss(at, amplitude)?,
        };
        Ok(value.max(0.0) / limit)
    }

    /// How far a limit is used at an amplitude, at the corners of the box and the point that decides. The loss of friction is that of
    /// exact responses: averaging, which is off by several per cent near a graze, is no estimate of it.
    fn used(
        &self,
        limited: (LimitedQuantity, f64),
        others: &[f64],
        amplitude: f64,
        worst: Option<&Vec<f64>>,
    ) -> Result<f64, NoAnswer> {
        self.largest(worst, |point| {
            let at = OperatingPoint { point, others };
            match limited.0 {
                LimitedQuantity::FrictionLoss => {
                    self.used_exactly_at(limited, at, self.verified_amplitude(amplitude))
                }
                _ => self.used_by_averaging(limited, at, amplitude),
            }
        })
    }

    /// How far a limit is used by a dither at one operating point, without trajectories.
    pub(super) fn used_by_averaging(
        &self,
        (quantity, limit): (LimitedQuantity, f64),
        at: OperatingPoint<'_>,
        amplitude: f64,
    ) -> Result<f64, NoAnswer> {
        let price = || self.plant.price(at, amplitude);
        let value = match quantity {
            LimitedQuantity::Amplitude => amplitude * (1.0 + LEAST_MARGIN),
            LimitedQuantity::Stroke => price()?.stroke,
            LimitedQuantity::Velocity => price()?.velocity,
            LimitedQuantity::Power => price()?.power,
            LimitedQuantity::FrictionLoss => self.plant.averaged_loss(at, amplitude)?,
            LimitedQuantity::Actuator(limit) => self.share_of_actuator(limit, at, amplitude)?,
            // The end of the band belongs to it.
            LimitedQuantity::Band => self.plant.slowness(at)? * BEYOND_BAND,
            LimitedQuantity::ResponseRms | LimitedQuantity::ResponsePeak => {
                let size = self.plant.averaged_response(at, amplitude)?;
                quantity.of_response().map_or(0.0, |of| of(size))
            }
            LimitedQuantity::MinimumNormalLoad => {
                let left = self.plant.minimum_normal_load(at, amplitude)?;
                return Ok(if left > 0.0 { limit / left } else { f64::INFINITY });
            }
        };
        Ok(value.max(0.0) / limit)
    }

    /// What a dither demands of the actuator.
    pub(super) fn demand(
        &self,
        at: OperatingPoint<'_>,
        amplitude: f64,
    ) -> Result<ActuatorDemand, NoAnswer> {
        let actuator = self.actuator.ok_or(NoAnswer::NoActuator)?;
        Ok(self.plant.demand(at, actuator)?.at(amplitude))
    }

    /// The share of a limit of the actuator that a dither uses.
    pub(super) fn share_of_actuator(
        &self,
        limit: ActuatorLimit,
        at: OperatingPoint<'_>,
        amplitude: f64,
    ) -> Result<f64, NoAnswer> {
        Ok(self.demand(at, amplitude)?.used(limit)?)
    }

    /// What a dither demands of the actuator at the operating point where a limit is used most, among the corners of the box and the
    /// point that decides.
    pub(super) fn largest_demand(
        &self,
        others: &[f64],
        amplitude: f64,
        worst: Option<&Vec<f64>>,
    ) -> Result<(ActuatorDemand, Vec<f64>), NoAnswer> {
        let corners = grid(self.over, [1, 2, 2, 2], false);
        let mut largest: Option<(f64, ActuatorDemand, Vec<f64>)> = None;
        for point in corners.iter().chain(worst) {
            let demand = self.demand(OperatingPoint { point, others }, amplitude)?;
            let (_, used) = demand.tightest()?;
            if largest.as_ref().is_none_or(|(most, ..)| used > *most) {
                largest = Some((used, demand, point.clone()));
            }
        }
        largest.map(|(_, demand, point)| (demand, point)).ok_or(NoAnswer::EmptyBox)
    }

    /// The largest loss of mean friction at the corners of the box and the point that decides, on the exact base responses of the
    /// verified dither: averaging, which is off by several per cent near a graze, is no estimate of it.
    fn largest_loss(
        &self,
        others: &[f64],
        amplitude: f64,
        worst: Option<&Vec<f64>>,
    ) -> Result<f64, NoAnswer> {
        let verified = self.verified_amplitude(amplitude);
        self.largest(worst, |point| {
            self.plant.exact_loss(OperatingPoint { point, others }, verified)
        })
    }

    /// A choice of design variables with an amplitude, its objective and the use of every limit.
    pub(super) fn priced(&self, others: &[f64], least: LeastOfBox, judged: Judged) -> DesignPoint {
        let LeastOfBox { amplitude, worst, decisive } = least;
        let price = |of: fn(super::DitherPrice) -> f64| {
            self.largest(worst.as_ref(), |point| {
                self.plant.price(OperatingPoint { point, others }, amplitude).map(of)
            })
        };
        let objective = match self.objective {
            DesignObjective::Amplitude => Ok(amplitude),
            DesignObjective::Stroke => price(|price| price.stroke),
            DesignObjective::Velocity => price(|price| price.velocity),
            DesignObjective::Power => price(|price| price.power),
            DesignObjective::FrictionLoss => self.largest_loss(others, amplitude, worst.as_ref()),
        };
        let mut points = grid(self.over, RESPONSE_POINTS, false);
        points.extend(worst.iter().chain(&decisive).cloned());
        let exactly = |limited| match judged {
            Judged::ByAveraging => None,
            Judged::Exactly => self.exactly_used(limited, others, amplitude, &points),
        };
        let used = self.limits.iter().map(|limited| {
            let used = exactly(*limited);
            let used =
                used.unwrap_or_else(|| self.used(*limited, others, amplitude, worst.as_ref()));
            (limited.0, used)
        });
        let used = used.collect();
        DesignPoint { others: others.to_vec(), amplitude, objective, worst, decisive, used }
    }

    /// Whether every choice takes exact responses, whose loss of friction is small or limited.
    fn judges_by_responses(&self) -> bool {
        self.objective == DesignObjective::FrictionLoss
            || self.limits.iter().any(|(quantity, _)| *quantity == LimitedQuantity::FrictionLoss)
    }

    /// The least amplitude by averaging at a choice of design variables.
    pub(super) fn averaged_point(
        &self,
        others: &[f64],
        points: Vec<Vec<f64>>,
    ) -> Result<DesignPoint, NoLeast> {
        let RealInterval { lower: from, upper: to } = self.amplitude;
        let special = self.plant.special_points(self.over, others, to);
        let mut points = points;
        points.extend(special.map_err(|why| NoLeast::Failed { point: Vec::new(), why })?);
        let Self { over: ranges, tasks, .. } = *self;
        let search = BoxSearch { ranges, from, step: 0.0625, closeness: BOX_CLOSENESS, tasks };
        let quiet =
            |point: &[f64]| self.plant.averaged(OperatingPoint { point, others }, self.amplitude);
        Ok(self.priced(others, least_of_box(search, points, &quiet)?, Judged::ByAveraging))
    }

    /// The search over all design variables.
    pub(super) fn averaged_search(&self) -> AveragedSearch {
        let mut done = AveragedSearch::default();
        if self.others.is_empty() {
            match self.averaged_point(&[], self.points()) {
                Ok(point) => {
                    done.found.extend(point.may_be_allowed().map(|_| point.clone()));
                    done.tried.push(point);
                }
                Err(why) => done.refused.push((Vec::new(), why)),
            }
            return done;
        }
        let coarse = grid(self.over, COARSE, false);
        let choices = grid(self.others, GRID, true);
        let points =
            answers(self.tasks, &choices, |choice| self.averaged_point(choice, coarse.clone()));
        let mut values = Vec::new();
        for (choice, point) in choices.iter().zip(points) {
            values.push(point.as_ref().ok().and_then(DesignPoint::may_be_allowed));
            match point {
                Ok(point) => done.tried.push(point),
                Err(why) => done.refused.push((choice.clone(), why)),
            }
        }
        let starts = self.local_minima(&choices, &values);
        let refined = answers(self.tasks, &starts, |start| {
            let mut own = AveragedSearch::default();
            if let Ok(point) = self.averaged_point(&choices[*start], coarse.clone()) {
                self.refine_from(point, &mut own);
            }
            own
        });
        done.extend(refined);
        if done.found.is_empty() {
            let refined = answers(self.tasks, &nearest_choices(&done.tried), |point| {
                let mut own = AveragedSearch::default();
                let within = self.within_limits(point.clone(), &mut own.tried);
                if within.may_be_allowed().is_some() {
                    self.refine_from(within, &mut own);
                }
                own
            });
            done.extend(refined);
        }
        let value = |point: &DesignPoint| point.may_be_allowed().unwrap_or(f64::INFINITY);
        ascending_by(&mut done.found, value);
        done
    }

    /// Refines an allowed choice and judges it at every point of the box, not only the coarse ones.
    fn refine_from(&self, point: DesignPoint, done: &mut AveragedSearch) {
        let refined = self.refined(point, &mut done.tried);
        let mut points = self.points();
        points.extend(refined.decisive.iter().cloned());
        match self.averaged_point(&refined.others, points) {
            Ok(point) if point.may_be_allowed().is_some() => done.found.push(point),
            Ok(point) => done.tried.push(point),
            Err(why) => done.refused.push((refined.others, why)),
        }
    }

    /// The choice near one that exceeds a limit at which the tightest limit is used least, up to the first that keeps every limit: the
    /// choices that two limits leave may lie between two points of the grid.
    fn within_limits(&self, point: DesignPoint, tried: &mut Vec<DesignPoint>) -> DesignPoint {
        let used = |point: &DesignPoint| point.use_of_limits();
        self.pattern(point, tried, &used, &|best| best.may_be_allowed().is_some())
    }

    /// The choices on the grid that are better than their neighbours, the best first. Where neighbours are equal, as they are where
    /// the smallest allowed amplitude is quiet over a range of frequencies, the middle of the longest run stands for all.
    fn local_minima(&self, choices: &[Vec<f64>], values: &[Option<f64>]) -> Vec<usize> {
        if self.others.len() == 1 {
            return middles_of_minima(values);
        }
        let count = GRID.get(self.others.len()).copied().unwrap_or(2);
        let better = |place: usize, value: f64| {
            (0..self.others.len()).all(|coordinate| {
                let stride =
                    count.pow(u32::try_from(self.others.len() - 1 - coordinate).unwrap_or(0));
                let along = (place / stride) % count;
                let lower = along.checked_sub(1).map(|_| place - stride);
                let upper = (along + 1 < count).then_some(place + stride);
                [lower, upper].into_iter().flatten().all(|next| {
                    values.get(next).copied().flatten().is_none_or(|there| value <= there)
                })
            })
        };
        let mut minima: Vec<(usize, f64)> = (0..choices.len())
            .filter_map(|place| Some((place, values[place]?)))
            .filter(|(place, value)| better(*place, *value))
            .collect();
        ascending_by(&mut minima, |a| a.1);
        minima.truncate(BASINS);
        minima.into_iter().map(|(place, _)| place).collect()
    }

    /// A local minimum of the objective on the allowed side of the limits.
    fn refined(&self, best: DesignPoint, tried: &mut Vec<DesignPoint>) -> DesignPoint {
        let objective = |point: &DesignPoint| point.may_be_allowed().unwrap_or(f64::INFINITY);
        self.pattern(best, tried, &objective, &|_| false)
    }

    /// A local minimum of a measure by pattern search, up to the first choice that is enough.
    fn pattern(
        &self,
        mut best: DesignPoint,
        tried: &mut Vec<DesignPoint>,
        measure: &dyn Fn(&DesignPoint) -> f64,
        is_enough: &dyn Fn(&DesignPoint) -> bool,
    ) -> DesignPoint {
        let count = GRID.get(self.others.len()).copied().unwrap_or(2);
        let mut step = 1.0 / (count - 1) as f64;
        let closeness = if self.judges_by_responses() { CLOSENESS_OF_RESPONSES } else { CLOSENESS };
        while step > closeness && !is_enough(&best) {
            let mut moved = false;
            for (coordinate, RealInterval { lower, upper }) in self.others.iter().enumerate() {
                for sign in [1.0, -1.0] {
                    let mut others = best.others.clone();
                    let value = others[coordinate];
                    let size =
                        if *lower > 0.0 { value * libm::log(upper / lower) } else { upper - lower };
                    others[coordinate] = (value + sign * step * size).clamp(*lower, *upper);
                    if others == best.others {
                        continue;
                    }
                    let mut points = best.decisive.clone();
                    points.extend(grid(self.over, [1, 2, 2, 2], false));
                    let Ok(next) = self.averaged_point(&others, points) else { continue };
                    let better = measure(&next) < measure(&best);
                    tried.push(next.clone());
                    if better {
                        (best, moved) = (next, true);
                        break;
                    }
                }
            }
            if !moved {
                step *= 0.5;
            }
        }
        best
    }
}

/// The choices whose tightest limit is exceeded least, the best first.
fn nearest_choices(tried: &[DesignPoint]) -> Vec<DesignPoint> {
    let mut known: Vec<&DesignPoint> = tried
        .iter()
        .filter(|point| point.objective.is_ok() && point.use_of_limits() < NEAREST)
        .collect();
    ascending_by(&mut known, |a| a.use_of_limits());
    known.into_iter().take(BASINS).cloned().collect()
}

/// Places in a run of equal values that are tried in turn, as shares of its length: exact responses may reject some of them.
const IN_A_RUN: [f64; 7] = [0.5, 0.25, 0.75, 0.125, 0.375, 0.625, 0.875];

/// The local minima along one variable, the best first and the longest first among equal ones: of a run of equal values its middle,
/// and if it is long then places around it.
fn middles_of_minima(values: &[Option<f64>]) -> Vec<usize> {
    let at = |place: usize| values[place].unwrap_or(f64::INFINITY);
    let mut minima: Vec<(f64, usize, usize)> = Vec::new();
    let mut first = 0;
    while first < values.len() {
        let value = at(first);
        let count = (first..values.len()).take_while(|place| at(*place) == value).count();
        let above = |place: Option<usize>| place.is_none_or(|place| at(place) > value);
        let next = Some(first + count).filter(|next| *next < values.len());
        if value.is_finite() && above(first.checked_sub(1)) && above(next) {
            minima.push((value, count, first));
        }
        first += count;
    }
    minima.sort_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
    minima.truncate(BASINS);
    let mut places: Vec<usize> = Vec::new();
    for (_, count, first) in minima {
        for share in IN_A_RUN {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a share of a count"
            )]
            let place = first + (share * count as f64) as usize;
            if !places.contains(&place) {
                places.push(place);
            }
        }
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_of_the_longest_equal_run_comes_first() {
        let values = [2.0, 1.0, 1.0, 3.0, 1.0, 1.0, 1.0, f64::NAN, 1.5, 4.0]
            .map(|value: f64| (!value.is_nan()).then_some(value));
        assert_eq!(middles_of_minima(&values), [5, 4, 6, 2, 1, 8]);
        assert!(middles_of_minima(&[None, None]).is_empty());
    }

    #[test]
    fn grids_keep_both_ends() {
        let points =
            grid(&[RealInterval::new(2.0, 8.0), RealInterval::new(0.0, 1.0)], [1, 2, 3, 2], true);
        assert_eq!(points.len(), 9);
        assert_eq!(
            (points[0].as_slice(), points[8].as_slice()),
            (&[2.0, 0.0][..], &[8.0, 1.0][..])
        );
        assert!((points[3][0] - 4.0).abs() < 1e-15 && points[4][1] == 0.5);
        assert_eq!(grid(&[], [1, 2, 3, 2], true), [Vec::<f64>::new()]);
    }
}
