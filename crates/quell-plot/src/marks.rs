//! Marks: markers of points and fills of regions, for panels and legends.

use super::canvas::{Canvas, Rectangle, Stroke, path};
use super::geometry::PlotPoint;
use super::layer::{Fill, Marker};
use super::palette::{PAPER, PlotRole};

/// Draws markers at these pixels.
pub(super) fn markers(
    canvas: &mut Canvas,
    points: &[PlotPoint],
    role: PlotRole,
    marker: Marker,
    size: f64,
) {
    let half = 0.5 * size;
    let colour = role.colour();
    let shape = |corners: &[PlotPoint]| -> Vec<Vec<PlotPoint>> {
        points
            .iter()
            .map(|point| {
                corners
                    .iter()
                    .map(|corner| {
                        PlotPoint::new(point.x + half * corner.x, point.y + half * corner.y)
                    })
                    .collect()
            })
            .collect()
    };
    let outline = Stroke::solid(colour, (0.22 * size).clamp(0.8, 1.5));
    match marker {
        Marker::Disc | Marker::Circle => {
            // A stroke of zero length with round ends is a disc, and the shortest path for one.
            let dots = path(&shape(&[PlotPoint::new(0.0, 0.0)]), false);
            canvas.begin_group("stroke-linecap=\"round\"");
            canvas.stroke(&dots, &Stroke::solid(colour, size));
            if marker == Marker::Circle {
                canvas.stroke(&dots, &Stroke::solid(PAPER, size - 2.0 * outline.width));
            }
            canvas.end_group();
        }
        Marker::Cross => {
            let mut strokes = shape(&[PlotPoint::new(-0.85, -0.85), PlotPoint::new(0.85, 0.85)]);
            strokes.extend(shape(&[PlotPoint::new(-0.85, 0.85), PlotPoint::new(0.85, -0.85)]));
            canvas.stroke(&path(&strokes, false), &outline);
        }
    }
}

/// The outline of a rectangle as a path.
pub(super) fn outline(area: Rectangle) -> String {
    let corners = vec![
        PlotPoint::new(area.left, area.top),
        PlotPoint::new(area.right, area.top),
        PlotPoint::new(area.right, area.bottom),
        PlotPoint::new(area.left, area.bottom),
    ];
    path(&[corners], true)
}

/// The outline of all marked cells as one path; `columns` and `rows` are the ends of each column and row (pixels).
///
/// Neighbouring cells of a row are merged into runs, and equal runs of neighbouring rows into rectangles.
pub(super) fn union(cells: &[bool], columns: &[(f64, f64)], rows: &[(f64, f64)]) -> String {
    let mut outlines = Vec::new();
    // Runs that may still grow: their columns, and the pixels of their rows.
    let mut open: Vec<((usize, usize), (f64, f64))> = Vec::new();
    let close = |((first, last), (from, to)): ((usize, usize), (f64, f64))| {
        let (left, right) = (columns[first].0, columns[last].1);
        vec![
            PlotPoint::new(left, from),
            PlotPoint::new(right, from),
            PlotPoint::new(right, to),
            PlotPoint::new(left, to),
        ]
    };
    for (row, ends) in cells.chunks(columns.len().max(1)).zip(rows) {
        let mut runs: Vec<(usize, usize)> = Vec::new();
        for (column, _) in row.iter().enumerate().filter(|(_, marked)| **marked) {
            match runs.last_mut() {
                Some(run) if run.1 + 1 == column => run.1 = column,
                _ => runs.push((column, column)),
            }
        }
        let mut next = Vec::with_capacity(runs.len());
        for run in runs {
            let below = open.iter().position(|(known, _)| *known == run);
            let from = below.map_or(ends.0, |at| open.swap_remove(at).1.0);
            next.push((run, (from, ends.1)));
        }
        outlines.extend(open.drain(..).map(close));
        open = next;
    }
    outlines.extend(open.into_iter().map(close));
    path(&outlines, true)
}

/// Fills an outline in the colour of a role.
pub(super) fn fill(canvas: &mut Canvas, outline: &str, role: PlotRole, fill: Fill) {
    match fill.opacity(role) {
        Some(opacity) => canvas.fill(outline, role.colour(), opacity),
        None => canvas.hatch(outline, role.colour(), 0),
    }
}
