//! Marks: markers of points and fillings of regions, for panels and legends alike.

use super::canvas::{Canvas, Rectangle, Stroke, path};
use super::layer::{Fill, Marker};
use super::palette::{PAPER, Role};

/// Draws markers at these pixels.
pub(super) fn markers(
    canvas: &mut Canvas,
    points: &[(f64, f64)],
    role: Role,
    marker: Marker,
    size: f64,
) {
    let half = 0.5 * size;
    let colour = role.colour();
    let shape = |corners: &[(f64, f64)]| -> Vec<Vec<(f64, f64)>> {
        points
            .iter()
            .map(|point| {
                corners
                    .iter()
                    .map(|corner| (point.0 + half * corner.0, point.1 + half * corner.1))
                    .collect()
            })
            .collect()
    };
    let outline = Stroke::solid(colour, (0.22 * size).clamp(0.8, 1.5));
    match marker {
        Marker::Disc | Marker::Circle => {
            // A stroke of no length with round ends is a disc, and the shortest way to write one.
            let dots = path(&shape(&[(0.0, 0.0)]), false);
            canvas.begin_group("stroke-linecap=\"round\"");
            canvas.stroke(dots.clone(), &Stroke::solid(colour, size));
            if marker == Marker::Circle {
                canvas.stroke(dots, &Stroke::solid(PAPER, size - 2.0 * outline.width));
            }
            canvas.end_group();
        }
        Marker::Square => {
            let corners = [(-0.88, -0.88), (0.88, -0.88), (0.88, 0.88), (-0.88, 0.88)];
            canvas.fill(path(&shape(&corners), true), colour, 1.0);
        }
        Marker::Triangle => {
            let corners = [(0.0, -1.15), (1.0, 0.6), (-1.0, 0.6)];
            canvas.fill(path(&shape(&corners), true), colour, 1.0);
        }
        Marker::Diamond => {
            let corners = [(0.0, -1.2), (1.0, 0.0), (0.0, 1.2), (-1.0, 0.0)];
            canvas.fill(path(&shape(&corners), true), colour, 1.0);
        }
        Marker::Plus => {
            let mut strokes = shape(&[(-1.0, 0.0), (1.0, 0.0)]);
            strokes.extend(shape(&[(0.0, -1.0), (0.0, 1.0)]));
            canvas.stroke(path(&strokes, false), &outline);
        }
        Marker::Cross => {
            let mut strokes = shape(&[(-0.85, -0.85), (0.85, 0.85)]);
            strokes.extend(shape(&[(-0.85, 0.85), (0.85, -0.85)]));
            canvas.stroke(path(&strokes, false), &outline);
        }
    }
}

/// The outline of a rectangle as a path.
pub(super) fn outline(area: Rectangle) -> String {
    let corners = vec![
        (area.left, area.top),
        (area.right, area.top),
        (area.right, area.bottom),
        (area.left, area.bottom),
    ];
    path(&[corners], true)
}

/// Fills an outline as a role's region.
pub(super) fn fill(canvas: &mut Canvas, outline: String, role: Role, fill: Fill) {
    match fill {
        Fill::Shade => canvas.fill(outline, role.colour(), 0.16),
        Fill::Solid => canvas.fill(outline, role.colour(), 0.38),
        Fill::Hatched => canvas.hatch(outline, role.colour()),
    }
}
