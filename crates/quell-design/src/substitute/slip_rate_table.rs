//! A table over the slip speed, between whose points programs interpolate linearly, and beyond whose last point the value stays.
//!
//! Points of the curve are chosen by the method of Douglas and Peucker (`douglas1973`) with vertical distances: an interval is
//! divided at its farthest point until every point of the curve is within the tolerance of the line.

use super::SpeedCurve;

/// A friction coefficient over the slip speed, linear between points.
#[derive(Clone, Debug, PartialEq)]
pub struct SlipRateTable {
    /// Slip speed and coefficient, in ascending order of speed.
    pub points: Vec<(f64, f64)>,
    /// The largest difference of μ at the points of the curve.
    pub largest_error: f64,
}

impl SlipRateTable {
    /// The table of a curve with few points and differences up to a tolerance.
    pub fn of(curve: &SpeedCurve, tolerance: f64) -> Self {
        let points: Vec<(f64, f64)> =
            curve.speeds.iter().copied().zip(curve.coefficients.iter().copied()).collect();
        let mut kept = vec![false; points.len()];
        let last = points.len() - 1;
        (kept[0], kept[last]) = (true, true);
        let mut intervals = vec![(0, last)];
        while let Some((from, to)) = intervals.pop() {
            let off =
                |i: usize| (between(points[from], points[to], points[i].0) - points[i].1).abs();
            let farthest = (from + 1..to).max_by(|i, j| off(*i).total_cmp(&off(*j)));
            if let Some(middle) = farthest.filter(|i| off(*i) > tolerance) {
                kept[middle] = true;
                intervals.extend([(from, middle), (middle, to)]);
            }
        }
        let chosen = points.iter().zip(kept).filter_map(|(point, kept)| kept.then_some(*point));
        let table = Self { points: chosen.collect(), largest_error: 0.0 };
        let largest_error = curve.largest_error(|v| table.coefficient(v), |_| true);
        Self { largest_error, ..table }
    }

    /// μ at a slip speed.
    pub fn coefficient(&self, speed: f64) -> f64 {
        let next = self.points.partition_point(|point| point.0 < speed);
        match (self.points.get(next.wrapping_sub(1)), self.points.get(next)) {
            (Some(before), Some(after)) => between(*before, *after, speed),
            (Some(only), None) | (None, Some(only)) => only.1,
            (None, None) => f64::NAN,
        }
    }
}

/// The line through two points, at a speed.
fn between(from: (f64, f64), to: (f64, f64), speed: f64) -> f64 {
    from.1 + (to.1 - from.1) * ((speed - from.0) / (to.0 - from.0))
}
