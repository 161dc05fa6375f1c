//! Outlines of the shapes of mechanical drawings: coils, dashpots, hatching, belts, arrows, arcs and waves.

use std::f64::consts::{PI, TAU};

use crate::canvas::Rectangle;
use crate::geometry::{PlotPoint, PlotRange};
use crate::palette::LineStyle;

/// Half the width of a coil spring.
const COIL: f64 = 5.0;
/// Pitch and length of the strokes of a hatching.
const HATCH: f64 = 5.0;

/// A periodic wave as a small symbol.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WaveGlyph {
    /// ∿
    Sine,
    /// ⊓⊔
    Square,
    /// △▽
    Triangle,
    /// A wave and a pause.
    Burst,
    /// A wave of another shape.
    Other,
}

/// A closed area and its fill.
pub(super) struct FilledArea {
    pub(super) outline: Vec<PlotPoint>,
    /// Whether it has the ink of the part; else it is a pale surface.
    pub(super) inked: bool,
}

/// What is drawn of a shape.
#[derive(Default)]
pub(super) struct ShapeStrokes {
    /// Solid lines of the usual width.
    pub(super) lines: Vec<Vec<PlotPoint>>,
    /// Thin lines, such as hatching.
    pub(super) thin: Vec<Vec<PlotPoint>>,
    pub(super) fills: Vec<FilledArea>,
    /// Closed lines with a hole: the outlines of a ring.
    pub(super) style: Option<LineStyle>,
}

/// The rectangle around some points; empty at the origin without points.
pub(super) fn bounds<'a>(points: impl Iterator<Item = &'a PlotPoint>) -> Rectangle {
    let mut area: Option<Rectangle> = None;
    for &PlotPoint { x, y } in points {
        let known = area.get_or_insert(Rectangle { left: x, top: y, right: x, bottom: y });
        known.left = known.left.min(x);
        known.top = known.top.min(y);
        known.right = known.right.max(x);
        known.bottom = known.bottom.max(y);
    }
    area.unwrap_or(Rectangle { left: 0.0, top: 0.0, right: 0.0, bottom: 0.0 })
}

/// A closed outline.
pub(super) fn corners(area: Rectangle) -> Vec<PlotPoint> {
    let Rectangle { left, top, right, bottom } = area;
    vec![
        PlotPoint::new(left, top),
        PlotPoint::new(right, top),
        PlotPoint::new(right, bottom),
        PlotPoint::new(left, bottom),
        PlotPoint::new(left, top),
    ]
}

/// The point at a distance along and across the line between two points (to the right of it, y downwards).
pub(super) fn along(from: PlotPoint, to: PlotPoint, distance: f64, across: f64) -> PlotPoint {
    let (dx, dy) = (to.x - from.x, to.y - from.y);
    let length = libm::hypot(dx, dy).max(f64::MIN_POSITIVE);
    let (ux, uy) = (dx / length, dy / length);
    PlotPoint::new(from.x + distance * ux - across * uy, from.y + distance * uy + across * ux)
}

pub(super) fn zigzag(from: PlotPoint, to: PlotPoint) -> Vec<PlotPoint> {
    let whole = from.distance(to);
    // A long lead does not lengthen the coils.
    let coils = whole.min(34.0) * 0.7;
    let lead = 0.5 * (whole - coils);
    let turns = 4;
    let mut points = vec![from, along(from, to, lead, 0.0)];
    for number in 0..2 * turns {
        let distance = lead + coils * (f64::from(number) + 0.5) / f64::from(2 * turns);
        let side = if number % 2 == 0 { COIL } else { -COIL };
        points.push(along(from, to, distance, side));
    }
    points.extend([along(from, to, whole - lead, 0.0), to]);
    points
}

pub(super) fn dashpot(from: PlotPoint, to: PlotPoint) -> [Vec<PlotPoint>; 4] {
    let whole = from.distance(to);
    let half = 0.5 * (whole.min(24.0) * 0.5);
    let middle = 0.5 * whole;
    let at = |distance: f64, across: f64| along(from, to, distance, across);
    let (open, back) = (middle - half, middle + half);
    [
        vec![from, at(middle, 0.0)],
        vec![at(middle, -3.5), at(middle, 3.5)],
        vec![at(open, -5.0), at(back, -5.0), at(back, 5.0), at(open, 5.0)],
        vec![at(back, 0.0), to],
    ]
}

/// Short strokes on the left of a line, seen from `from` to `to`.
pub(super) fn hatching(from: PlotPoint, to: PlotPoint) -> Vec<Vec<PlotPoint>> {
    let whole = from.distance(to);
    let mut strokes = Vec::new();
    let mut distance = 1.0;
    while distance < whole {
        let foot = (distance - HATCH).max(-1.0);
        strokes.push(vec![along(from, to, distance, 0.0), along(from, to, foot, -HATCH)]);
        distance += HATCH;
    }
    strokes
}

pub(super) fn belt(
    drawn: &mut ShapeStrokes,
    PlotRange { lower: left, upper: right }: PlotRange,
    top: f64,
    radius: f64,
) {
    let middle = top + radius;
    let centres = [PlotPoint::new(left + radius, middle), PlotPoint::new(right - radius, middle)];
    for centre in centres {
        drawn.thin.push(circle(centre, radius - 2.5));
        drawn.fills.push(FilledArea { outline: circle(centre, 1.5), inked: true });
    }
    let mut outline = arc(centres[0], radius, 90.0, 270.0);
    outline.extend(arc(centres[1], radius, 270.0, 450.0));
    outline.push(outline[0]);
    drawn.lines.push(outline);
}

pub(super) fn arrow(drawn: &mut ShapeStrokes, from: PlotPoint, to: PlotPoint) {
    let whole = from.distance(to);
    drawn.lines.push(vec![from, along(from, to, (whole - 4.0).max(0.0), 0.0)]);
    let foot = whole - 7.0;
    let head = vec![to, along(from, to, foot, -3.0), along(from, to, foot, 3.0), to];
    drawn.fills.push(FilledArea { outline: head, inked: true });
}

pub(super) fn turn(
    drawn: &mut ShapeStrokes,
    centre: PlotPoint,
    radius: f64,
    (from, to): (f64, f64),
) {
    let points = arc(centre, radius, from, to);
    let Some(&end) = points.last() else { return };
    // The head points along the tangent at its middle.
    let sign = if to > from { 1.0 } else { -1.0 };
    let slope = (to - sign * 90.0 / radius.max(1.0) * 2.0).to_radians();
    let (ux, uy) = (-sign * libm::sin(slope), -sign * libm::cos(slope));
    let back = |distance: f64, across: f64| {
        PlotPoint::new(end.x - distance * ux - across * uy, end.y - distance * uy + across * ux)
    };
    let tip = back(-4.0, 0.0);
    drawn
        .fills
        .push(FilledArea { outline: vec![tip, back(3.0, 3.0), back(3.0, -3.0), tip], inked: true });
    drawn.lines.push(points);
}

/// Points along a circle between two angles (degrees, counter-clockwise).
pub(super) fn arc(centre: PlotPoint, radius: f64, from: f64, to: f64) -> Vec<PlotPoint> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
    let steps = ((to - from).abs() / 5.0).ceil().clamp(1.0, 360.0) as usize;
    let point = |step: usize| {
        let angle = (from + (to - from) * step as f64 / steps as f64).to_radians();
        PlotPoint::new(centre.x + radius * libm::cos(angle), centre.y - radius * libm::sin(angle))
    };
    (0..=steps).map(point).collect()
}

pub(super) fn circle(centre: PlotPoint, radius: f64) -> Vec<PlotPoint> {
    arc(centre, radius, 0.0, 360.0)
}

pub(super) fn sector(centre: PlotPoint, radii: (f64, f64), angles: (f64, f64)) -> Vec<PlotPoint> {
    let mut outline = arc(centre, radii.0, angles.0, angles.1);
    outline.extend(arc(centre, radii.1, angles.1, angles.0));
    outline.push(outline[0]);
    outline
}

pub(super) fn wave(at: PlotPoint, glyph: WaveGlyph) -> Vec<PlotPoint> {
    let (width, height) = (16.0, 4.0);
    // Phase in turns, and the value there.
    let samples: Vec<(f64, f64)> = match glyph {
        WaveGlyph::Sine => (0..=36)
            .map(|step| f64::from(step) / 24.0)
            .map(|phase| (phase, libm::sin(TAU * phase)))
            .collect(),
        WaveGlyph::Burst => (0..=36)
            .map(|step| f64::from(step) / 24.0)
            .map(|phase| (phase, if phase < 1.0 { libm::sin(2.0 * TAU * phase) } else { 0.0 }))
            .collect(),
        WaveGlyph::Other => (0..=36)
            .map(|step| f64::from(step) / 24.0)
            .map(|phase| (phase, 0.7 * libm::sin(TAU * phase) + 0.5 * libm::cos(2.0 * TAU * phase)))
            .collect(),
        WaveGlyph::Square => vec![
            (0.0, 0.0),
            (0.0, 1.0),
            (0.5, 1.0),
            (0.5, -1.0),
            (1.0, -1.0),
            (1.0, 1.0),
            (1.5, 1.0),
            (1.5, 0.0),
        ],
        WaveGlyph::Triangle => {
            (0..=6).map(|step| f64::from(step) / 4.0).map(|p| (p, triangle(p))).collect()
        }
    };
    let place = |(phase, value): (f64, f64)| {
        PlotPoint::new(at.x + width * (phase / 1.5 - 0.5), at.y - height * value)
    };
    samples.into_iter().map(place).collect()
}

/// A triangle wave of period 1 that rises through 0 at 0.
pub(super) fn triangle(phase: f64) -> f64 {
    libm::asin(libm::sin(TAU * phase)) * 2.0 / PI
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spring_ends_at_its_ends_and_has_its_coils_between_them() {
        let points = zigzag(PlotPoint::new(10.0, 20.0), PlotPoint::new(10.0, 80.0));
        assert_eq!(
            (points[0], points[points.len() - 1]),
            (PlotPoint::new(10.0, 20.0), PlotPoint::new(10.0, 80.0))
        );
        let area = bounds(points.iter());
        assert!((area.left - 5.0).abs() < 1e-12 && (area.right - 15.0).abs() < 1e-12);
    }

    #[test]
    fn angles_are_counted_counter_clockwise_from_the_right() {
        let points = arc(PlotPoint::new(0.0, 0.0), 2.0, 0.0, 90.0);
        let end = points[points.len() - 1];
        assert!(end.x.abs() < 1e-12 && (end.y + 2.0).abs() < 1e-12);
    }
}
