//! Thinning: reduces the number of points without a visible change.
//!
//! Of consecutive points in one half-pixel column of the figure, only the first, lowest, highest
//! and last are kept (so no extremum is lost); then points that lie within a twentieth of a pixel
//! of the stroke between their neighbours are dropped. This works for any curve, including one that reverses in x.

use super::geometry::PlotPoint;

/// Width of a column (pixels).
const COLUMN: f64 = 0.5;
/// Maximum displacement of the stroke (pixels).
const SLACK: f64 = 0.05;
/// Scattered points closer than this are merged (pixels).
const GRAIN: f64 = 0.25;

/// Thins a polyline; input and output in pixels.
pub(super) fn polyline(points: &[PlotPoint]) -> Vec<PlotPoint> {
    if points.len() <= 64 {
        return points.to_vec();
    }
    let mut kept = Vec::new();
    for run in points.chunk_by(|before, after| column(before.x) == column(after.x)) {
        keep_extremes(run, &mut kept);
    }
    straighten(&kept)
}

fn column(x: f64) -> i64 {
    #[expect(clippy::cast_possible_truncation, reason = "pixels are clamped to 1e5")]
    let column = (x / COLUMN).floor() as i64;
    column
}

fn keep_extremes(run: &[PlotPoint], kept: &mut Vec<PlotPoint>) {
    if run.len() <= 4 {
        kept.extend_from_slice(run);
        return;
    }
    let (mut lowest, mut highest) = (0, 0);
    for (index, point) in run.iter().enumerate() {
        if point.y < run[lowest].y {
            lowest = index;
        }
        if point.y > run[highest].y {
            highest = index;
        }
    }
    let mut indices = [0, lowest.min(highest), lowest.max(highest), run.len() - 1].to_vec();
    indices.dedup();
    kept.extend(indices.into_iter().map(|index| run[index]));
}

/// Drops points whose removal moves the stroke by less than the slack.
///
/// From each kept point, the cone of directions that pass close enough to all later points is
/// narrowed until it is empty; the previous point is the next kept one.
fn straighten(points: &[PlotPoint]) -> Vec<PlotPoint> {
    let Some(&first) = points.first() else {
        return Vec::new();
    };
    let mut kept = vec![first];
    let mut anchor = first;
    let mut cone: Option<(f64, f64, f64)> = None; // reference direction, least and greatest deviation
    let mut reach = 0.0_f64;
    let mut previous = first;
    for &point in &points[1..] {
        let (dx, dy) = (point.x - anchor.x, point.y - anchor.y);
        let distance = libm::hypot(dx, dy);
        if distance <= SLACK && cone.is_none() {
            previous = point;
            continue;
        }
        let opening = libm::asin(SLACK / distance.max(SLACK));
        let narrowed = match cone {
            None => Some((libm::atan2(dy, dx), -opening, opening)),
            Some((reference, least, greatest)) => {
                let turn = wrap(libm::atan2(dy, dx) - reference);
                // A stroke that reverses is not straight even if its direction lies in the cone.
                let inside = turn >= least && turn <= greatest && distance >= reach;
                inside.then(|| (reference, least.max(turn - opening), greatest.min(turn + opening)))
            }
        };
        if narrowed.is_some() {
            cone = narrowed;
            reach = reach.max(distance);
        } else {
            kept.push(previous);
            anchor = previous;
            let (dx, dy) = (point.x - anchor.x, point.y - anchor.y);
            reach = libm::hypot(dx, dy);
            let opening = libm::asin(SLACK / reach.max(SLACK));
            cone = (reach > SLACK).then(|| (libm::atan2(dy, dx), -opening, opening));
        }
        previous = point;
    }
    if points.len() > 1 {
        kept.push(previous);
    }
    kept
}

fn wrap(angle: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    (angle + PI).rem_euclid(TAU) - PI
}

/// Scattered points without those that would be drawn on top of an earlier one.
pub(super) fn scatter(points: &[PlotPoint]) -> Vec<PlotPoint> {
    let mut seen = std::collections::HashSet::new();
    #[expect(clippy::cast_possible_truncation, reason = "pixels are clamped to 1e5")]
    let grain = |pixel: f64| (pixel / GRAIN).round() as i64;
    points
        .iter()
        .copied()
        .filter(|PlotPoint { x, y }| seen.insert((grain(*x), grain(*y))))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(count: u32) -> Vec<PlotPoint> {
        (0..count)
            .map(|step| {
                let x = 500.0 * f64::from(step) / f64::from(count);
                PlotPoint::new(x, 100.0 + 80.0 * (3.7 * x).sin() * (0.01 * x).cos())
            })
            .collect()
    }

    #[test]
    fn extremes_of_every_column_are_kept() {
        let mut points = wave(100_000);
        points[56_789].y = 199.0;
        let thin = polyline(&points);
        assert!(thin.len() < 6_000, "{}", thin.len());
        assert_eq!(thin.first(), points.first());
        assert_eq!(thin.last(), points.last());
        assert!(thin.contains(&points[56_789]));
        for run in points.chunk_by(|a, b| column(a.x) == column(b.x)) {
            let by_height = |a: &&PlotPoint, b: &&PlotPoint| a.y.total_cmp(&b.y);
            let ends = [run.iter().min_by(by_height), run.iter().max_by(by_height)];
            for extreme in ends.into_iter().flatten() {
                let distance = thin
                    .windows(2)
                    .filter(|ends| (ends[0].x - extreme.x).abs() < 20.0)
                    .map(|ends| distance(*extreme, ends[0], ends[1]))
                    .fold(f64::INFINITY, f64::min);
                assert!(distance < 2.0 * SLACK, "{extreme:?} lies {distance} off");
            }
        }
    }

    fn distance(point: PlotPoint, from: PlotPoint, to: PlotPoint) -> f64 {
        let (dx, dy) = (to.x - from.x, to.y - from.y);
        let (px, py) = (point.x - from.x, point.y - from.y);
        let length = dx * dx + dy * dy;
        let along = if length > 0.0 { ((px * dx + py * dy) / length).clamp(0.0, 1.0) } else { 0.0 };
        (px - along * dx).hypot(py - along * dy)
    }

    #[test]
    fn the_stroke_moves_by_less_than_the_slack() {
        let circle: Vec<_> = (0..20_000)
            .map(|step| {
                let angle = 1e-3 * f64::from(step);
                PlotPoint::new(150.0 * angle.cos(), 150.0 * angle.sin())
            })
            .collect();
        let thin = straighten(&circle);
        assert!(thin.len() < 1_000 && thin.len() > 50, "{}", thin.len());
        for ends in thin.windows(2) {
            let middle = (0.5 * (ends[0].x + ends[1].x), 0.5 * (ends[0].y + ends[1].y));
            assert!((middle.0.hypot(middle.1) - 150.0).abs() < 2.0 * SLACK);
        }
    }

    #[test]
    fn a_reversing_stroke_keeps_its_reversal_point() {
        let mut points: Vec<_> =
            (0..100).map(|step| PlotPoint::new(f64::from(step), 0.0)).collect();
        points.extend((0..100).map(|step| PlotPoint::new(99.0 - f64::from(step), 0.0)));
        assert!(straighten(&points).contains(&PlotPoint::new(99.0, 0.0)));
    }

    #[test]
    fn coincident_points_are_drawn_once() {
        let points =
            vec![PlotPoint::new(1.0, 1.0), PlotPoint::new(1.01, 1.0), PlotPoint::new(5.0, 1.0)];
        assert_eq!(scatter(&points), vec![PlotPoint::new(1.0, 1.0), PlotPoint::new(5.0, 1.0)]);
    }
}
