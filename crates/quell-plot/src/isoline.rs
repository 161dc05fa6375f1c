//! Isolines of a field by marching squares.
//!
//! Each cell of four neighbouring points is cut where its edges cross the level; the crossing of an
//! edge is found by linear interpolation. A cell whose diagonal corners lie on the same side (a
//! saddle) is resolved by the mean of its four corners. Segments are joined at shared edges into
//! polylines, closed where they return to their start. A cell with a missing corner is skipped:
//! isolines end at its border.
//!
//! For a field with bounded second derivatives the error of the lines is O(h²); for a field
//! that is linear in x and y the lines are straight up to rounding. Points exactly at the level count as above it.
//!
//! Source: W. E. Lorensen, H. E. Cline, Marching cubes, Computer Graphics 21 (1987) 163–169, in two
//! dimensions.

use super::geometry::PlotPoint;

/// One isoline.
#[derive(Debug, Clone, PartialEq)]
pub struct Isoline {
    /// The points (x, y) in order; the first is repeated at the end when the line is closed.
    pub points: Vec<PlotPoint>,
    /// Whether the line is closed.
    pub closed: bool,
}

/// No edge.
const NONE: u32 = u32::MAX;

/// All isolines of the values at `level`.
///
/// `values` are in row-major order, x varying fastest. The interpolation between grid points is linear in the
/// given coordinates: for a logarithmic axis, pass the logarithms. If the number of values is not
/// `x.len() · y.len()`, there are no lines.
#[must_use]
pub fn isolines(x: &[f64], y: &[f64], values: &[Option<f64>], level: f64) -> Vec<Isoline> {
    // Edges are counted in 32 bits, two for each point.
    let countable = values.len() < (u32::MAX / 2) as usize;
    if values.len() != x.len() * y.len() || x.len() < 2 || y.len() < 2 || !countable {
        return Vec::new();
    }
    let grid = Cells { x, y, values, level };
    let mut joints = vec![[NONE; 2]; 2 * values.len()];
    let mut crossed = Vec::new();
    for row in 0..y.len() - 1 {
        for column in 0..x.len() - 1 {
            for [one, other] in grid.cuts(column, row).into_iter().flatten() {
                for (from, to) in [(one, other), (other, one)] {
                    let joint = &mut joints[from as usize];
                    if joint[0] == NONE {
                        crossed.push(from);
                        joint[0] = to;
                    } else {
                        joint[1] = to;
                    }
                }
            }
        }
    }
    let mut lines = Vec::new();
    let mut used = vec![false; joints.len()];
    // Open lines are traced first, from their ends; the remaining lines are loops.
    let is_end = |edge: &&u32| joints[**edge as usize][1] == NONE;
    let starts = crossed.iter().filter(is_end).chain(&crossed);
    for &start in starts {
        if used[start as usize] {
            continue;
        }
        let closed = joints[start as usize][1] != NONE;
        let mut points = Vec::new();
        let mut at = start;
        while at != NONE && !used[at as usize] {
            used[at as usize] = true;
            let point = grid.crossing(at);
            if points.last() != Some(&point) {
                points.push(point);
            }
            let next =
                joints[at as usize].into_iter().find(|to| *to != NONE && !used[*to as usize]);
            at = next.unwrap_or(NONE);
        }
        if closed && points.first() != points.last() {
            points.push(points[0]);
        }
        if points.len() > 1 {
            lines.push(Isoline { points, closed });
        }
    }
    lines
}

struct Cells<'a> {
    x: &'a [f64],
    y: &'a [f64],
    values: &'a [Option<f64>],
    level: f64,
}

impl Cells<'_> {
    fn point(&self, column: usize, row: usize) -> usize {
        row * self.x.len() + column
    }

    /// The pairs of edges of a cell that are connected by a line.
    fn cuts(&self, column: usize, row: usize) -> [Option<[u32; 2]>; 2] {
        let at = |right: usize, up: usize| self.values[self.point(column + right, row + up)];
        let (Some(a), Some(b), Some(c), Some(d)) = (at(0, 0), at(1, 0), at(1, 1), at(0, 1)) else {
            return [None; 2];
        };
        let above = [a, b, c, d].map(|value| value >= self.level);
        if above == [true; 4] || above == [false; 4] {
            return [None; 2];
        }
        let (bottom, left) = (self.level_edge(column, row), self.upright_edge(column, row));
        let (right, top) = (self.upright_edge(column + 1, row), self.level_edge(column, row + 1));
        let one = |from: u32, to: u32| [Some([from, to]), None];
        // Corners counter-clockwise from the lower left.
        match above {
            [true, false, true, false] | [false, true, false, true] => {
                // The corners may be large: their mean is computed without overflow.
                let mean = 0.25 * a + 0.25 * b + 0.25 * c + 0.25 * d;
                if (mean >= self.level) == above[0] {
                    [Some([bottom, right]), Some([left, top])]
                } else {
                    [Some([left, bottom]), Some([right, top])]
                }
            }
            [a, b, c, d] if a == b && c == d => one(left, right),
            [a, b, c, d] if a == d && b == c => one(bottom, top),
            // One corner lies alone on its side.
            [a, b, c, d] if b == c && c == d && a != b => one(left, bottom),
            [a, _, c, d] if a == c && c == d => one(bottom, right),
            [a, b, _, d] if a == b && b == d => one(right, top),
            _ => one(left, top),
        }
    }

    /// The edge to the right of a point.
    fn level_edge(&self, column: usize, row: usize) -> u32 {
        #[expect(clippy::cast_possible_truncation, reason = "counted before")]
        let edge = 2 * self.point(column, row) as u32;
        edge
    }

    /// The edge above a point.
    fn upright_edge(&self, column: usize, row: usize) -> u32 {
        self.level_edge(column, row) + 1
    }

    /// The point where an edge crosses the level.
    fn crossing(&self, edge: u32) -> PlotPoint {
        let point = (edge / 2) as usize;
        let (column, row) = (point % self.x.len(), point / self.x.len());
        let upright = edge % 2 == 1;
        let next = if upright { point + self.x.len() } else { point + 1 };
        let share = match (self.values[point], self.values[next]) {
            (Some(here), Some(there)) => {
                // Halves, so that the difference of two large values does not overflow.
                ((0.5 * self.level - 0.5 * here) / (0.5 * there - 0.5 * here)).clamp(0.0, 1.0)
            }
            _ => 0.5,
        };
        let between = |axis: &[f64], at: usize| axis[at] + share * (axis[at + 1] - axis[at]);
        if upright {
            PlotPoint::new(self.x[column], between(self.y, row))
        } else {
            PlotPoint::new(between(self.x, column), self.y[row])
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{PI, TAU};

    fn axis(from: f64, to: f64, count: u32) -> Vec<f64> {
        (0..count).map(|k| from + (to - from) * f64::from(k) / f64::from(count - 1)).collect()
    }

    fn table(x: &[f64], y: &[f64], value: impl Fn(f64, f64) -> f64) -> Vec<Option<f64>> {
        y.iter().flat_map(|y| x.iter().map(|x| Some(value(*x, *y))).collect::<Vec<_>>()).collect()
    }

    fn length(line: &Isoline) -> f64 {
        line.points.windows(2).map(|p| (p[1].x - p[0].x).hypot(p[1].y - p[0].y)).sum()
    }

    fn area(line: &Isoline) -> f64 {
        let twice: f64 = line.points.windows(2).map(|p| p[0].x * p[1].y - p[1].x * p[0].y).sum();
        0.5 * twice.abs()
    }

    #[test]
    fn a_circle_has_its_area_and_length_to_second_order() {
        let radius = 0.7;
        let errors = |count: u32| {
            let x = axis(-1.0, 1.0, count);
            let lines = isolines(&x, &x, &table(&x, &x, |x, y| x * x + y * y), radius * radius);
            assert_eq!(lines.len(), 1);
            assert!(lines[0].closed && lines[0].points.first() == lines[0].points.last());
            (
                (area(&lines[0]) - PI * radius * radius).abs(),
                (length(&lines[0]) - TAU * radius).abs(),
            )
        };
        let (coarse, fine) = (errors(40), errors(160));
        // Linear interpolation misplaces a crossing by h²/8r, a chord of a cell lies h²/4r inside.
        let step: f64 = 2.0 / 39.0;
        let off = 0.375 * step * step / radius;
        assert!(coarse.0 < TAU * radius * off && coarse.1 < TAU * off, "{coarse:?}");
        // A quarter of the step: a sixteenth of the error, less a margin for where the grid lies.
        assert!(fine.0 < coarse.0 / 10.0 && fine.1 < coarse.1 / 10.0, "{coarse:?} {fine:?}");
    }

    #[test]
    fn a_plane_gives_one_straight_line_on_uneven_axes() {
        let x = vec![-1.0, -0.9, -0.2, 0.05, 0.5, 2.0];
        let y = vec![0.0, 0.3, 0.35, 1.7];
        let lines = isolines(&x, &y, &table(&x, &y, |x, y| 2.0 * x + 3.0 * y), 1.0);
        assert_eq!(lines.len(), 1);
        assert!(!lines[0].closed);
        for PlotPoint { x, y } in &lines[0].points {
            assert!((2.0 * x + 3.0 * y - 1.0).abs() < 1e-14, "{x} {y}");
        }
        // The line runs from the point on y = 0 to the one on x = -0.9 or y = 1.7, whichever comes first.
        let (first, last) = (lines[0].points[0], lines[0].points[lines[0].points.len() - 1]);
        let lowest = if first.y < last.y { first } else { last };
        assert!((lowest.x - 0.5).abs() < 1e-14 && lowest.y == 0.0);
    }

    #[test]
    fn every_case_of_a_cell_separates_the_corners_above_from_those_below() {
        let unit = [0.0, 1.0];
        for case in 0..16_u8 {
            let corner = |bit: u8| if case >> bit & 1 == 1 { 1.0 } else { 0.0 };
            // Rows: lower left, lower right, upper left, upper right.
            let values = [0, 1, 2, 3].map(|bit| Some(corner(bit)));
            let lines = isolines(&unit, &unit, &values, 0.5);
            let ones = case.count_ones();
            let diagonal = case == 0b0110 || case == 0b1001;
            let expected = if ones == 0 || ones == 4 { 0 } else { 1 + usize::from(diagonal) };
            assert_eq!(lines.len(), expected, "case {case:04b}");
            // An edge is cut if its ends lie on different sides.
            let ends: Vec<PlotPoint> = lines.iter().flat_map(|line| line.points.clone()).collect();
            let cut = |one: u8, other: u8| corner(one) != corner(other);
            let edges = [
                (cut(0, 1), (0.5, 0.0)),
                (cut(0, 2), (0.0, 0.5)),
                (cut(1, 3), (1.0, 0.5)),
                (cut(2, 3), (0.5, 1.0)),
            ];
            let mut wanted: Vec<_> =
                edges.into_iter().filter(|(cut, _)| *cut).map(|(_, at)| at).collect();
            let mut ends: Vec<_> = ends.iter().map(|end| (end.x, end.y)).collect();
            ends.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
            wanted.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
            assert_eq!(ends, wanted, "case {case:04b}");
        }
    }

    #[test]
    fn a_saddle_is_resolved_by_its_mean() {
        // High corners lower left and upper right.
        let unit = [0.0, 1.0];
        let joined = |level: f64| {
            let lines =
                isolines(&unit, &unit, &[Some(1.0), Some(0.0), Some(0.0), Some(1.0)], level);
            assert_eq!(lines.len(), 2);
            // Joined high corners: each line cuts off a low corner, (1, 0) or (0, 1).
            lines.iter().all(|line| {
                let middle = (
                    0.5 * (line.points[0].x + line.points[1].x),
                    0.5 * (line.points[0].y + line.points[1].y),
                );
                (middle.0 > 0.5) != (middle.1 > 0.5)
            })
        };
        assert!(joined(0.4) && joined(0.5));
        assert!(!joined(0.6));
    }

    #[test]
    fn a_line_ends_at_a_missing_point() {
        let x = axis(-1.0, 1.0, 21);
        let mut values = table(&x, &x, |_, y| y);
        // The point (0.3, 0) is missing; no line may enter the four cells around it.
        values[10 * 21 + 13] = None;
        let lines = isolines(&x, &x, &values, 0.01);
        assert_eq!(lines.len(), 2);
        for PlotPoint { x, .. } in lines.iter().flat_map(|line| &line.points) {
            assert!(*x < 0.2 + 1e-12 || *x > 0.4 - 1e-12, "{x}");
        }
        assert!(isolines(&x, &x, &vec![None; 441], 0.0).is_empty());
    }

    #[test]
    fn a_level_on_grid_points_gives_no_duplicate_points() {
        let x = axis(-2.0, 2.0, 5);
        let lines = isolines(&x, &x, &table(&x, &x, |x, y| x + y), 0.0);
        assert_eq!(lines.len(), 1);
        assert!(lines[0].points.windows(2).all(|pair| pair[0] != pair[1]));
        assert!((length(&lines[0]) - 32_f64.sqrt()).abs() < 1e-14);
    }

    #[test]
    fn invalid_tables_have_no_lines() {
        assert!(isolines(&[], &[], &[], 0.0).is_empty());
        assert!(isolines(&[0.0], &[0.0, 1.0], &[Some(0.0), Some(1.0)], 0.5).is_empty());
        assert!(isolines(&[0.0, 1.0], &[0.0, 1.0], &[Some(0.0)], 0.5).is_empty());
        let huge = [Some(-1e308), Some(1e308), Some(-1e308), Some(1e308)];
        assert_eq!(isolines(&[0.0, 1.0], &[0.0, 1.0], &huge, 0.0).len(), 1);
    }
}
