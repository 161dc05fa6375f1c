//! Projection: converts the data of the layers to pixels of the figure.

use super::axis::Mapping;
use super::canvas::Rectangle;
use super::font_sizes::FontSizes;
use super::geometry::PlotPoint;
use super::layer::{Note, Orientation};
use super::thin;
use super::typeset::{LINE_HEIGHT, RichText, wrap};

/// A point in pixels; `None` if the axes cannot represent it.
fn pixel(point: &PlotPoint, x: &Mapping, y: &Mapping) -> Option<PlotPoint> {
    Some(PlotPoint::new(x.pixel(point.x)?, y.pixel(point.y)?))
}

/// Pieces of a curve in pixels, without the parts left and right of the frame, and thinned.
pub(super) fn pixels(
    pieces: &[Vec<PlotPoint>],
    x: &Mapping,
    y: &Mapping,
    frame: Rectangle,
) -> Vec<Vec<PlotPoint>> {
    let beside = |point: PlotPoint| {
        if point.x < frame.left - 2.0 { -1 } else { i32::from(point.x > frame.right + 2.0) }
    };
    let mut drawn = Vec::new();
    for piece in pieces {
        let mapped: Vec<Option<PlotPoint>> = piece.iter().map(|point| pixel(point, x, y)).collect();
        for run in mapped.split(Option::is_none) {
            let run: Vec<PlotPoint> = run.iter().copied().flatten().collect();
            let visible = run.chunk_by(|before, after| {
                beside(*before) == 0 || beside(*before) != beside(*after)
            });
            for part in visible {
                if part.len() > 1 || beside(part[0]) == 0 {
                    drawn.push(thin::polyline(part));
                }
            }
        }
    }
    drawn
}

/// Points in pixels: those inside the frame, without points that would be drawn on top of each other.
pub(super) fn point_pixels(
    points: &[PlotPoint],
    x: &Mapping,
    y: &Mapping,
    frame: Rectangle,
) -> Vec<PlotPoint> {
    let inside = |point: &PlotPoint| {
        point.x >= frame.left - 0.5
            && point.x <= frame.right + 0.5
            && point.y >= frame.top - 0.5
            && point.y <= frame.bottom + 0.5
    };
    let drawn: Vec<PlotPoint> =
        points.iter().filter_map(|point| pixel(point, x, y)).filter(inside).collect();
    thin::scatter(&drawn)
}

/// Ends of a reference line; `None` if it lies outside the frame.
pub(super) fn reference_line_ends(
    orientation: Orientation,
    value: f64,
    x: &Mapping,
    y: &Mapping,
    frame: Rectangle,
) -> Option<Vec<PlotPoint>> {
    match orientation {
        Orientation::Vertical => {
            let x = x.pixel(value).filter(|x| *x >= frame.left && *x <= frame.right)?;
            Some(vec![PlotPoint::new(x, frame.bottom), PlotPoint::new(x, frame.top)])
        }
        Orientation::Horizontal => {
            let y = y.pixel(value).filter(|y| *y >= frame.top && *y <= frame.bottom)?;
            Some(vec![PlotPoint::new(frame.left, y), PlotPoint::new(frame.right, y)])
        }
    }
}

/// The rectangle of a note and its lines, moved into the frame if necessary; `None` if the axes cannot represent its point.
pub(super) fn note_area(
    note: &Note,
    (x, y): (&Mapping, &Mapping),
    frame: Rectangle,
    sizes: FontSizes,
) -> Option<(Rectangle, Vec<RichText>)> {
    let at = (x.pixel(note.at.x)?, y.pixel(note.at.y)?);
    let size = f64::from(sizes.note);
    let lines = wrap(&note.text, size, false, frame.width() - 8.0);
    let width = lines.iter().map(|line| line.width(size, false)).fold(0.0, f64::max);
    let height = (0.95 + LINE_HEIGHT * lines.len().saturating_sub(1) as f64) * size;
    let (left, top) = (at.0 - 0.5 * width, at.1 - 0.5 * height);
    let inner = frame.grown(-4.0);
    let left = left.min(inner.right - width).max(inner.left);
    let top = top.min(inner.bottom - height).max(inner.top);
    Some((Rectangle { left, top, right: left + width, bottom: top + height }, lines))
}
