//! Obstacles: the drawn content of a frame that texts and legends must avoid.

use super::canvas::Rectangle;
use super::figure::Panel;
use super::font_sizes::FontSizes;
use super::geometry::PlotPoint;
use super::layer::Layer;
use super::layout::PanelLayout;
use super::projection::{self, reference_line_ends};

/// Strokes, points and texts of a panel (pixels).
#[derive(Debug, Default)]
pub(super) struct Obstacles {
    strokes: Vec<Vec<PlotPoint>>,
    texts: Vec<Rectangle>,
}

impl Obstacles {
    /// The curves, points, reference lines, isolines and notes of a panel.
    pub(super) fn of(panel: &Panel, layout: &PanelLayout, sizes: FontSizes) -> Self {
        let (x, y) = layout.mappings(panel);
        let mut obstacles = Self::default();
        for layer in &panel.layers {
            match layer {
                Layer::Polyline(line) => {
                    obstacles.strokes.extend(projection::pixels(
                        &line.pieces,
                        &x,
                        &y,
                        layout.frame,
                    ));
                }
                Layer::Points(points) => {
                    let drawn = projection::point_pixels(&points.points, &x, &y, layout.frame);
                    obstacles.strokes.extend(drawn.into_iter().map(|point| vec![point, point]));
                }
                Layer::ReferenceLine(rule) => {
                    obstacles.strokes.extend(reference_line_ends(
                        rule.orientation,
                        rule.value,
                        &x,
                        &y,
                        layout.frame,
                    ));
                }
                Layer::Note(note) => {
                    let placed = projection::note_area(note, (&x, &y), layout.frame, sizes);
                    obstacles.texts.extend(placed.map(|(area, _)| area));
                }
                Layer::Contours(lines) => {
                    for level in lines.lines(&panel.x, &panel.y) {
                        obstacles.strokes.extend(projection::pixels(&level, &x, &y, layout.frame));
                    }
                }
                Layer::Region(_) | Layer::Heatmap(_) => {}
            }
        }
        obstacles
    }

    /// Adds a text.
    pub(super) fn add(&mut self, area: Rectangle) {
        self.texts.push(area);
    }

    /// Adds a line.
    pub(super) fn add_stroke(&mut self, line: Vec<PlotPoint>) {
        self.strokes.push(line);
    }

    /// Whether this rectangle would cover a text.
    pub(super) fn covers_text(&self, area: Rectangle) -> bool {
        self.texts.iter().any(|text| overlap(text, &area))
    }

    /// Weighted number of strokes and texts that this rectangle would cover.
    pub(super) fn covered_by(&self, area: Rectangle) -> usize {
        let texts = self.texts.iter().filter(|text| overlap(text, &area)).count();
        let strokes = self
            .strokes
            .iter()
            .flat_map(|stroke| stroke.windows(2))
            .filter(|ends| crosses(ends[0], ends[1], &area))
            .count();
        // Covering a text is worse than covering a line.
        20 * texts + strokes
    }
}

fn overlap(one: &Rectangle, other: &Rectangle) -> bool {
    one.left < other.right
        && other.left < one.right
        && one.top < other.bottom
        && other.top < one.bottom
}

/// Whether a line segment intersects a rectangle (Liang–Barsky).
fn crosses(from: PlotPoint, to: PlotPoint, area: &Rectangle) -> bool {
    let (dx, dy) = (to.x - from.x, to.y - from.y);
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for (step, room) in [
        (-dx, from.x - area.left),
        (dx, area.right - from.x),
        (-dy, from.y - area.top),
        (dy, area.bottom - from.y),
    ] {
        if step == 0.0 {
            if room < 0.0 {
                return false;
            }
        } else if step < 0.0 {
            enter = enter.max(room / step);
        } else {
            leave = leave.min(room / step);
        }
    }
    enter <= leave
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn segments_that_intersect_a_rectangle_are_detected() {
        let area = Rectangle { left: 0.0, top: 0.0, right: 10.0, bottom: 10.0 };
        assert!(crosses(PlotPoint::new(-5.0, 5.0), PlotPoint::new(15.0, 5.0), &area));
        assert!(crosses(PlotPoint::new(5.0, 5.0), PlotPoint::new(5.0, 5.0), &area));
        assert!(!crosses(PlotPoint::new(-5.0, 12.0), PlotPoint::new(15.0, 11.0), &area));
        assert!(!crosses(PlotPoint::new(-5.0, 5.0), PlotPoint::new(-1.0, 5.0), &area));
        assert!(!crosses(PlotPoint::new(8.0, 14.0), PlotPoint::new(14.0, 8.0), &area));
    }
}
