//! Thinning: reduces the number of points without a visible change.
//!
//! Of consecutive points in one half-pixel column of the figure, only the first, lowest, highest
//! and last are kept (so no extremum is lost); then points that lie within a twentieth of a pixel
//! of the stroke between their neighbours are dropped. This works for any curve, including one that reverses in x.

/// Width of a column (pixels).
const COLUMN: f64 = 0.5;
/// Maximum displacement of the stroke (pixels).
const SLACK: f64 = 0.05;
/// Scattered points closer than this are merged (pixels).
const GRAIN: f64 = 0.25;

/// Thins a polyline; input and output in pixels.
pub(super) fn polyline(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    if points.len() <= 64 {
        return points.to_vec();
    }
    let mut kept = Vec::new();
    for run in points.chunk_by(|before, after| column(before.0) == column(after.0)) {
        keep_extremes(run, &mut kept);
    }
    straighten(&kept)
}

fn column(x: f64) -> i64 {
    #[expect(clippy::cast_possible_truncation, reason = "pixels are clamped to 1e5")]
    let column = (x / COLUMN).floor() as i64;
    column
}

fn keep_extremes(run: &[(f64, f64)], kept: &mut Vec<(f64, f64)>) {
    if run.len() <= 4 {
        kept.extend_from_slice(run);
        return;
    }
    let (mut lowest, mut highest) = (0, 0);
    for (index, point) in run.iter().enumerate() {
        if point.1 < run[lowest].1 {
            lowest = index;
        }
        if point.1 > run[highest].1 {
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
fn straighten(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let Some(&first) = points.first() else {
        return Vec::new();
    };
    let mut kept = vec![first];
    let mut anchor = first;
    let mut cone: Option<(f64, f64, f64)> = None; // reference direction, least and greatest deviation
    let mut reach = 0.0_f64;
    let mut previous = first;
    for &point in &points[1..] {
        let (dx, dy) = (point.0 - anchor.0, point.1 - anchor.1);
        let distance = dx.hypot(dy);
        if distance <= SLACK && cone.is_none() {
            previous = point;
            continue;
        }
        let opening = (SLACK / distance.max(SLACK)).asin();
        let narrowed = match cone {
            None => Some((dy.atan2(dx), -opening, opening)),
            Some((reference, least, greatest)) => {
                let turn = wrap(dy.atan2(dx) - reference);
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
            let (dx, dy) = (point.0 - anchor.0, point.1 - anchor.1);
            reach = dx.hypot(dy);
            let opening = (SLACK / reach.max(SLACK)).asin();
            cone = (reach > SLACK).then(|| (dy.atan2(dx), -opening, opening));
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
pub(super) fn scatter(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut seen = std::collections::HashSet::new();
    #[expect(clippy::cast_possible_truncation, reason = "pixels are clamped to 1e5")]
    let grain = |pixel: f64| (pixel / GRAIN).round() as i64;
    points.iter().copied().filter(|(x, y)| seen.insert((grain(*x), grain(*y)))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(count: u32) -> Vec<(f64, f64)> {
        (0..count)
            .map(|step| {
                let x = 500.0 * f64::from(step) / f64::from(count);
                (x, 100.0 + 80.0 * (3.7 * x).sin() * (0.01 * x).cos())
            })
            .collect()
    }

    #[test]
    fn extremes_of_every_column_are_kept() {
        let mut points = wave(100_000);
        points[56_789].1 = 199.0;
        let thin = polyline(&points);
        assert!(thin.len() < 6_000, "{}", thin.len());
        assert_eq!(thin.first(), points.first());
        assert_eq!(thin.last(), points.last());
        assert!(thin.contains(&points[56_789]));
        for run in points.chunk_by(|a, b| column(a.0) == column(b.0)) {
            let by_height = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
            let ends = [run.iter().min_by(by_height), run.iter().max_by(by_height)];
            for extreme in ends.into_iter().flatten() {
                let distance = thin
                    .windows(2)
                    .filter(|ends| (ends[0].0 - extreme.0).abs() < 20.0)
                    .map(|ends| distance(*extreme, ends[0], ends[1]))
                    .fold(f64::INFINITY, f64::min);
                assert!(distance < 2.0 * SLACK, "{extreme:?} lies {distance} off");
            }
        }
    }

    fn distance(point: (f64, f64), from: (f64, f64), to: (f64, f64)) -> f64 {
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        let (px, py) = (point.0 - from.0, point.1 - from.1);
        let length = dx * dx + dy * dy;
        let along = if length > 0.0 { ((px * dx + py * dy) / length).clamp(0.0, 1.0) } else { 0.0 };
        (px - along * dx).hypot(py - along * dy)
    }

    #[test]
    fn the_stroke_moves_by_less_than_the_slack() {
        let circle: Vec<_> = (0..20_000)
            .map(|step| {
                let angle = 1e-3 * f64::from(step);
                (150.0 * angle.cos(), 150.0 * angle.sin())
            })
            .collect();
        let thin = straighten(&circle);
        assert!(thin.len() < 1_000 && thin.len() > 50, "{}", thin.len());
        for ends in thin.windows(2) {
            let middle = (0.5 * (ends[0].0 + ends[1].0), 0.5 * (ends[0].1 + ends[1].1));
            assert!((middle.0.hypot(middle.1) - 150.0).abs() < 2.0 * SLACK);
        }
    }

    #[test]
    fn a_reversing_stroke_keeps_its_reversal_point() {
        let mut points: Vec<_> = (0..100).map(|step| (f64::from(step), 0.0)).collect();
        points.extend((0..100).map(|step| (99.0 - f64::from(step), 0.0)));
        assert!(straighten(&points).contains(&(99.0, 0.0)));
    }

    #[test]
    fn coincident_points_are_drawn_once() {
        let points = vec![(1.0, 1.0), (1.01, 1.0), (5.0, 1.0)];
        assert_eq!(scatter(&points), vec![(1.0, 1.0), (5.0, 1.0)]);
    }
}
