//! What is already drawn in a frame, so that texts and legends can keep clear of it.

use super::arrange::PanelPlan;
use super::axis::Mapping;
use super::canvas::Rectangle;
use super::draw::{self, Sizes};
use super::figure::Panel;
use super::layer::{Direction, Layer};

/// Strokes, points and texts of a panel (pixels).
#[derive(Debug, Default)]
pub(super) struct Obstacles {
    strokes: Vec<Vec<(f64, f64)>>,
    texts: Vec<Rectangle>,
}

impl Obstacles {
    /// The curves, points, rules and notes of a panel.
    pub(super) fn of(panel: &Panel, plan: &PanelPlan, sizes: Sizes) -> Self {
        let (x, y) = draw::mappings(panel, plan);
        let mut obstacles = Self::default();
        for layer in &panel.layers {
            match layer {
                Layer::Line(line) => {
                    obstacles.strokes.extend(draw::pixels(&line.pieces, &x, &y, plan.frame));
                }
                Layer::Points(points) => {
                    let drawn = draw::point_pixels(&points.points, &x, &y, plan.frame);
                    obstacles.strokes.extend(drawn.into_iter().map(|point| vec![point, point]));
                }
                Layer::Rule(rule) => {
                    obstacles.strokes.extend(rule_ends(
                        rule.direction,
                        rule.value,
                        &x,
                        &y,
                        plan.frame,
                    ));
                }
                Layer::Note(note) => {
                    obstacles.texts.extend(draw::note_area(note, (&x, &y), plan.frame, sizes));
                }
                Layer::Contours(lines) => {
                    for level in lines.lines(&panel.x, &panel.y) {
                        obstacles.strokes.extend(draw::pixels(&level, &x, &y, plan.frame));
                    }
                }
                Layer::Region(_) | Layer::Grid(_) => {}
            }
        }
        obstacles
    }

    /// Adds a text.
    pub(super) fn add(&mut self, area: Rectangle) {
        self.texts.push(area);
    }

    /// How many strokes and texts this rectangle would cover.
    pub(super) fn covered_by(&self, area: Rectangle) -> usize {
        let texts = self.texts.iter().filter(|text| overlap(text, &area)).count();
        let strokes = self
            .strokes
            .iter()
            .flat_map(|stroke| stroke.windows(2))
            .filter(|ends| crosses(ends[0], ends[1], &area))
            .count();
        // Text over text is worse than text over a line.
        20 * texts + strokes
    }
}

/// Ends of a rule; nothing when it lies outside the frame.
pub(super) fn rule_ends(
    direction: Direction,
    value: f64,
    x: &Mapping,
    y: &Mapping,
    frame: Rectangle,
) -> Option<Vec<(f64, f64)>> {
    match direction {
        Direction::Vertical => {
            let x = x.pixel(value).filter(|x| *x >= frame.left && *x <= frame.right)?;
            Some(vec![(x, frame.bottom), (x, frame.top)])
        }
        Direction::Horizontal => {
            let y = y.pixel(value).filter(|y| *y >= frame.top && *y <= frame.bottom)?;
            Some(vec![(frame.left, y), (frame.right, y)])
        }
    }
}

fn overlap(one: &Rectangle, other: &Rectangle) -> bool {
    one.left < other.right
        && other.left < one.right
        && one.top < other.bottom
        && other.top < one.bottom
}

/// Whether a stroke passes through a rectangle (Liang–Barsky).
fn crosses(from: (f64, f64), to: (f64, f64), area: &Rectangle) -> bool {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for (step, room) in [
        (-dx, from.0 - area.left),
        (dx, area.right - from.0),
        (-dy, from.1 - area.top),
        (dy, area.bottom - from.1),
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
    fn a_stroke_crosses_what_it_passes_through() {
        let area = Rectangle { left: 0.0, top: 0.0, right: 10.0, bottom: 10.0 };
        assert!(crosses((-5.0, 5.0), (15.0, 5.0), &area));
        assert!(crosses((5.0, 5.0), (5.0, 5.0), &area));
        assert!(!crosses((-5.0, 12.0), (15.0, 11.0), &area));
        assert!(!crosses((-5.0, 5.0), (-1.0, 5.0), &area));
        assert!(!crosses((8.0, 14.0), (14.0, 8.0), &area));
    }
}
