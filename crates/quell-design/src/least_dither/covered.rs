//! How far one dither reaches where none serves the whole box: the largest part of the box in which it is quiet and keeps the limits.
//!
//! Averaging finds the dither and the part of a grid over the box; for a box of one coordinate its ends are then exact.

use super::search::grid;
use super::{DesignProblem, LimitedQuantity, OperatingPoint};
use crate::tasks::answers;

/// Points of the box along its coordinate, amplitudes that are tried, and choices of each other design variable.
const POINTS: usize = 65;
const AMPLITUDES: usize = 65;
const CHOICES: [usize; 4] = [1, 13, 5, 3];

/// Closeness of the ends, as a share of the range.
const CLOSENESS: f64 = 1e-7;

/// The part of a box that one dither serves.
#[derive(Clone, Debug, PartialEq)]
pub struct CoveredBox {
    /// Both ends of the coordinate of the box.
    pub ends: (f64, f64),
    /// The amplitude.
    pub amplitude: f64,
    /// Values of the other design variables.
    pub others: Vec<f64>,
    /// Why it is unknown, below and above these ends, whether the dither is quiet; `None` where it is not, or where the box ends.
    pub unknown_beyond: [Option<String>; 2],
}

impl CoveredBox {
    /// Whether it is the whole box.
    pub fn is_whole(&self, (low, high): (f64, f64)) -> bool {
        self.ends.0 <= low && self.ends.1 >= high
    }
}

/// The largest part of a box of one coordinate for which one dither suffices.
///
/// # Errors
/// A box of another number of coordinates, or no dither that is quiet in a part of it.
pub fn covered(problem: DesignProblem<'_>) -> Result<CoveredBox, String> {
    let [(low, high)] = problem.over else {
        return Err(match problem.over.len() {
            0 => "the study has one operating point",
            _ => "only for a box of one coordinate is the largest part searched",
        }
        .to_owned());
    };
    let points: Vec<f64> =
        grid(&[(*low, *high)], [1, POINTS, 2, 2], false).into_iter().flatten().collect();
    let mut best: Option<(f64, f64, Vec<f64>)> = None;
    for others in grid(problem.others, CHOICES, true) {
        for (amplitude, length) in problem.lengths(&others, &points) {
            if best.as_ref().is_none_or(|(most, ..)| length > *most) {
                best = Some((length, amplitude, others.clone()));
            }
        }
    }
    let (length, amplitude, others) = best.ok_or("no dither is quiet anywhere in the box")?;
    if length == 0.0 {
        return Err("no dither is quiet in a part of the box".to_owned());
    }
    problem.exact_part(&points, amplitude, others)
}

impl DesignProblem<'_> {
    /// Amplitudes with the length of the largest part of the box in which each is quiet and allowed, by averaging.
    fn lengths(&self, others: &[f64], points: &[f64]) -> Vec<(f64, f64)> {
        let (from, to) = self.amplitude;
        let sets: Vec<_> = points
            .iter()
            .map(|point| {
                self.plant.averaged(OperatingPoint { point: &[*point], others }, (from, to))
            })
            .collect();
        let mut amplitudes: Vec<f64> =
            grid(&[(from, to)], [1, AMPLITUDES, 2, 2], true).into_iter().flatten().collect();
        // The ends of quiet sets are where the part changes.
        amplitudes.extend(sets.iter().flatten().flat_map(|set| {
            set.intervals().iter().map(|(low, _)| low * (1.0 + 1e-9)).filter(|low| *low <= to)
        }));
        let length = |amplitude: f64| {
            let serves = |place: usize| {
                sets[place].as_ref().is_ok_and(|set| set.contains(amplitude))
                    && self.keeps_limits(points[place], others, amplitude)
            };
            let run = longest_run(points.len(), serves);
            (amplitude, run.map_or(0.0, |(first, last)| points[last] - points[first]))
        };
        amplitudes.into_iter().map(length).collect()
    }

    /// Whether a dither keeps every limit at a point, by averaging.
    fn keeps_limits(&self, point: f64, others: &[f64], amplitude: f64) -> bool {
        let at = OperatingPoint { point: &[point], others };
        let price = || self.plant.price(at, amplitude);
        self.limits.iter().all(|(quantity, limit)| {
            let value = match quantity {
                LimitedQuantity::Amplitude => Ok(amplitude),
                LimitedQuantity::Stroke => price().map(|price| price.stroke),
                LimitedQuantity::Velocity => price().map(|price| price.velocity),
                LimitedQuantity::Power => price().map(|price| price.power),
                // Where averaging is near enough; `serves` judges exactly.
                LimitedQuantity::FrictionLoss => self.plant.averaged_loss(at, amplitude),
                LimitedQuantity::Actuator(limit) => self.share_of_actuator(*limit, at, amplitude),
                LimitedQuantity::ResponseRms | LimitedQuantity::ResponsePeak => {
                    let size = self.plant.averaged_response(at, amplitude);
                    size.map(|size| quantity.of_response().map_or(0.0, |of| of(size)))
                }
                LimitedQuantity::MinimumNormalLoad => {
                    let load = self.plant.minimum_normal_load(at, amplitude);
                    return load.is_ok_and(|load| load >= *limit);
                }
            };
            value.is_ok_and(|value| value <= *limit)
        })
    }

    /// Whether a dither is quiet and allowed at a point, exactly; or why it is unknown whether it is quiet.
    fn serves(&self, point: f64, others: &[f64], amplitude: f64) -> Result<bool, String> {
        let at = OperatingPoint { point: &[point], others };
        let quiet = self.plant.verdict(at, amplitude)?.quiet;
        let others_kept = || {
            self.limits.iter().all(|(quantity, limit)| match quantity {
                LimitedQuantity::FrictionLoss => {
                    self.plant.exact_loss(at, amplitude).is_ok_and(|loss| loss <= *limit)
                }
                LimitedQuantity::ResponseRms | LimitedQuantity::ResponsePeak => {
                    let size = self.plant.exact_response(at, amplitude);
                    let value = size.map(|size| quantity.of_response().map_or(0.0, |of| of(size)));
                    value.is_ok_and(|value| value <= *limit)
                }
                _ => self.keeps_averaged_limits(at.point[0], others, amplitude),
            })
        };
        Ok(quiet && others_kept())
    }

    /// Whether a dither keeps the limits that are judged without trajectories.
    fn keeps_averaged_limits(&self, point: f64, others: &[f64], amplitude: f64) -> bool {
        let limits: Vec<_> = self
            .limits
            .iter()
            .copied()
            .filter(|(quantity, _)| {
                *quantity != LimitedQuantity::FrictionLoss && quantity.of_response().is_none()
            })
            .collect();
        DesignProblem { limits: &limits, ..*self }.keeps_limits(point, others, amplitude)
    }

    /// The longest part that a dither serves exactly, its ends by bisection.
    fn exact_part(
        &self,
        points: &[f64],
        amplitude: f64,
        others: Vec<f64>,
    ) -> Result<CoveredBox, String> {
        // Points between those of the grid at which the dither is loud.
        let loud = self.plant.loud_points(self.over, &others, amplitude)?;
        let mut points: Vec<f64> =
            points.iter().copied().chain(loud.into_iter().flatten()).collect();
        points.sort_by(f64::total_cmp);
        let serves = |point: f64| self.serves(point, &others, amplitude);
        let served: Vec<bool> = answers(self.tasks, &points, |point| serves(*point) == Ok(true));
        let (first, last) = longest_run(points.len(), |place| served[place])
            .ok_or("by exact responses the dither of averaging is quiet nowhere in the box")?;
        let end = |inside: f64, outside: Option<&f64>| {
            let Some(&outside) = outside else { return (inside, None) };
            let (mut inside, mut outside) = (inside, outside);
            while (outside - inside).abs() > CLOSENESS * (points[points.len() - 1] - points[0]) {
                let middle = f64::midpoint(inside, outside);
                if serves(middle) == Ok(true) {
                    inside = middle;
                } else {
                    outside = middle;
                }
            }
            (inside, serves(outside).err())
        };
        let below = first.checked_sub(1).and_then(|place| points.get(place));
        let (low, unknown_below) = end(points[first], below);
        let (high, unknown_above) = end(points[last], points.get(last + 1));
        let unknown_beyond = [unknown_below, unknown_above];
        Ok(CoveredBox { ends: (low, high), amplitude, others, unknown_beyond })
    }
}

/// The longest run of numbers below `count` that pass: its first and last.
fn longest_run(count: usize, passes: impl Fn(usize) -> bool) -> Option<(usize, usize)> {
    let mut longest: Option<(usize, usize)> = None;
    let mut since = None;
    for place in 0..=count {
        if place < count && passes(place) {
            since = since.or(Some(place));
        } else if let Some(first) = since.take() {
            let last = place - 1;
            if longest.is_none_or(|(from, to)| last - first > to - from) {
                longest = Some((first, last));
            }
        }
    }
    longest
}

#[cfg(test)]
mod tests {
    use super::longest_run;

    #[test]
    fn the_longest_run_is_found() {
        let passing = |list: &'static [bool]| longest_run(list.len(), |place| list[place]);
        assert_eq!(passing(&[true, false, true, true, false]), Some((2, 3)));
        assert_eq!(passing(&[true, true]), Some((0, 1)));
        assert_eq!(passing(&[false]), None);
    }
}
