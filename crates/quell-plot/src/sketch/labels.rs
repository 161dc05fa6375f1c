//! Positions of the labels of a sketch: each at the first free side of its part.

use super::outline::bounds;
use super::part::{LabelSide, SketchPart};
use super::shape::SketchShape;
use super::sheet::{MARGIN, Sketch, TEXT};
use crate::canvas::Rectangle;
use crate::geometry::PlotPoint;
use crate::obstacles::Obstacles;
use crate::typeset::RichText;

/// Distance of a label from its part.
const GAP: f64 = 3.0;
/// Height of a text above and below its middle, as fractions of its size.
const HALF: f64 = 0.52;

/// A label with its position.
pub(super) struct SketchText {
    pub(super) text: RichText,
    /// Left end of the baseline.
    pub(super) at: PlotPoint,
}

/// The parts of a sketch in their final positions, and its labels, part by part.
pub(super) struct PlacedSketch {
    pub(super) parts: Vec<SketchPart>,
    pub(super) labels: Vec<Vec<SketchText>>,
    pub(super) collisions: Vec<String>,
    /// Lower edge of the drawing.
    pub(super) bottom: f64,
}

/// Centres the parts of a sketch and places the labels.
pub(super) fn place(sketch: &Sketch) -> PlacedSketch {
    let room = sketch.room();
    let areas = sketch.parts.iter().flat_map(|part| &part.shapes).map(SketchShape::area);
    let ends: Vec<PlotPoint> = areas
        .flat_map(|area| {
            [PlotPoint::new(area.left, area.top), PlotPoint::new(area.right, area.bottom)]
        })
        .collect();
    let whole = bounds(ends.iter());
    let shift = PlotPoint::new(0.5 * (room - whole.left - whole.right), 0.0);
    let parts: Vec<SketchPart> = sketch
        .parts
        .iter()
        .map(|part| SketchPart {
            shapes: part.shapes.iter().map(|shape| shape.moved(shift)).collect(),
            ..part.clone()
        })
        .collect();
    // LabelPlacer may reach above the shapes; the whole is moved down afterwards.
    let mut labels = LabelPlacer::new(&parts, room);
    let placed: Vec<Vec<SketchText>> = parts.iter().map(|part| labels.of(part)).collect();
    let LabelPlacer { mut collisions, texts, .. } = labels;
    if whole.left + shift.x < 0.0 {
        collisions.push(format!("the parts are wider than the sheet of {room:.0} pixels"));
    }
    let top = texts.iter().map(|area| area.top).fold(whole.top, f64::min);
    let bottom = texts.iter().map(|area| area.bottom).fold(whole.bottom, f64::max);
    let down = MARGIN - top;
    let moved = |part: SketchPart| SketchPart {
        shapes: part.shapes.iter().map(|shape| shape.moved(PlotPoint::new(0.0, down))).collect(),
        ..part
    };
    let lowered = |label: SketchText| SketchText {
        at: PlotPoint::new(label.at.x, label.at.y + down),
        ..label
    };
    PlacedSketch {
        parts: parts.into_iter().map(moved).collect(),
        labels: placed.into_iter().map(|part| part.into_iter().map(lowered).collect()).collect(),
        collisions,
        bottom: bottom + down,
    }
}

/// The labels placed so far.
struct LabelPlacer {
    obstacles: Obstacles,
    texts: Vec<Rectangle>,
    collisions: Vec<String>,
    room: f64,
}

impl LabelPlacer {
    fn new(parts: &[SketchPart], room: f64) -> Self {
        let mut obstacles = Obstacles::default();
        for shape in parts.iter().flat_map(|part| &part.shapes) {
            shape.barriers().into_iter().for_each(|line| obstacles.add_stroke(line));
        }
        // Texts inside boxes are placed first in effect: their boxes keep others out.
        Self { obstacles, texts: Vec::new(), collisions: Vec::new(), room }
    }

    /// Places the labels of a part. Several labels inside it share its height.
    fn of(&mut self, part: &SketchPart) -> Vec<SketchText> {
        let Some(first) = part.shapes.first() else { return Vec::new() };
        let area = first.area();
        let inside = part.labels.iter().filter(|label| label.sides.contains(&LabelSide::Inside));
        let inside = inside.count();
        let mut line = 0;
        part.labels
            .iter()
            .map(|label| {
                let text = RichText::parse(&label.text);
                let width = text.width(f64::from(TEXT), false);
                let spot = if label.sides.contains(&LabelSide::Inside) {
                    line += 1;
                    self.inside(&area, width, (line - 1, inside), &label.text)
                } else {
                    self.beside(&area, width, label.sides.as_slice(), &label.text)
                };
                self.texts.push(spot);
                self.obstacles.add(spot);
                let middle = 0.5 * (spot.top + spot.bottom);
                SketchText { text, at: PlotPoint::new(spot.left, middle + 0.35 * f64::from(TEXT)) }
            })
            .collect()
    }

    /// A line of several inside a box, which must be large enough.
    fn inside(
        &mut self,
        area: &Rectangle,
        width: f64,
        (line, lines): (usize, usize),
        text: &str,
    ) -> Rectangle {
        let size = f64::from(TEXT);
        let middle = 0.5 * (area.left + area.right);
        let pitch = 1.25 * size;
        let first = 0.5 * (area.top + area.bottom) - 0.5 * pitch * (lines - 1) as f64;
        let level = first + pitch * line as f64;
        let spot = text_area(PlotPoint::new(middle - 0.5 * width, level), width);
        if spot.left < area.left || spot.right > area.right {
            self.collisions.push(format!("“{text}” is wider than its box"));
        }
        if spot.top < area.top || spot.bottom > area.bottom {
            self.collisions.push(format!("“{text}” is higher than its box"));
        }
        if self.texts.iter().any(|other| overlap(other, &spot)) {
            self.collisions.push(format!("“{text}” covers another text"));
        }
        spot
    }

    /// A text next to a part.
    fn beside(
        &mut self,
        area: &Rectangle,
        width: f64,
        sides: &[LabelSide],
        text: &str,
    ) -> Rectangle {
        let half = HALF * f64::from(TEXT);
        let (across, down) = (0.5 * (area.left + area.right), 0.5 * (area.top + area.bottom));
        let at = |side: LabelSide, away: f64, aside: f64| match side {
            LabelSide::Above => {
                PlotPoint::new(across - 0.5 * width + aside, area.top - GAP - half - away)
            }
            LabelSide::Below => {
                PlotPoint::new(across - 0.5 * width + aside, area.bottom + GAP + half + away)
            }
            LabelSide::Left => PlotPoint::new(area.left - GAP - width - away, down + aside),
            LabelSide::Right => PlotPoint::new(area.right + GAP + away, down + aside),
            LabelSide::Inside => PlotPoint::new(across - 0.5 * width, down),
        };
        let mut best: Option<(usize, Rectangle)> = None;
        for (away, aside) in OFFSETS {
            for &side in sides {
                let spot = text_area(at(side, *away, *aside), width);
                let outside = spot.left < 0.0 || spot.right > self.room;
                let cost = self.obstacles.covered_by(spot) + if outside { 100 } else { 0 };
                if best.is_none_or(|(least, _)| cost < least) {
                    best = Some((cost, spot));
                }
            }
            if best.is_some_and(|(cost, _)| cost == 0) {
                break;
            }
        }
        let (cost, spot) = best.unwrap_or((0, text_area(PlotPoint::new(across, down), width)));
        if cost > 0 {
            self.collisions.push(format!("“{text}” covers something or leaves the sheet"));
        }
        spot
    }
}

/// Shifts away from the part and along its side, in the order in which they are tried.
const OFFSETS: &[(f64, f64)] = &[
    (0.0, 0.0),
    (0.0, 6.0),
    (0.0, -6.0),
    (3.0, 0.0),
    (0.0, 12.0),
    (0.0, -12.0),
    (6.0, 0.0),
    (6.0, 8.0),
    (6.0, -8.0),
    (10.0, 0.0),
];

/// The rectangle of a text whose left end and middle height are given.
fn text_area(PlotPoint { x: left, y: middle }: PlotPoint, width: f64) -> Rectangle {
    let half = HALF * f64::from(TEXT);
    Rectangle { left, top: middle - half, right: left + width, bottom: middle + half }
}

fn overlap(one: &Rectangle, other: &Rectangle) -> bool {
    one.left < other.right
        && other.left < one.right
        && one.top < other.bottom
        && other.top < one.bottom
}

#[cfg(test)]
mod tests {
    use crate::geometry::{FrameSize, PlotPoint};
    use crate::sketch::part::{LabelSide, SketchPart};
    use crate::sketch::shape::SketchShape;
    use crate::sketch::sheet::Sketch;

    fn spot(x: f64, text: &str) -> SketchPart {
        let sides = [LabelSide::Above, LabelSide::Below];
        SketchPart::new("note", text, SketchShape::Spot { at: PlotPoint::new(x, 50.0) })
            .label(text, &sides)
    }

    #[test]
    fn labels_avoid_each_other_and_lines() {
        let wall = SketchShape::Ground {
            from: PlotPoint::new(0.0, 42.0),
            to: PlotPoint::new(200.0, 42.0),
        };
        let sketch = Sketch::new(85.0)
            .with(SketchPart::new("ground", "wall", wall))
            .with(spot(90.0, "first"))
            .with(spot(110.0, "second"));
        assert_eq!(sketch.collisions(), Vec::<String>::new());
    }

    #[test]
    fn collisions_that_cannot_be_avoided_are_listed() {
        let mut sketch = Sketch::new(85.0);
        for number in 0..20 {
            sketch = sketch.with(spot(100.0, &format!("label {number}")));
        }
        assert!(!sketch.collisions().is_empty());
        let block = SketchShape::Block {
            corner: PlotPoint::new(0.0, 0.0),
            size: FrameSize::new(20.0, 20.0),
        };
        let narrow =
            SketchPart::new("mass", "m", block).label("far too wide", &[LabelSide::Inside]);
        assert_eq!(
            Sketch::new(85.0).with(narrow).collisions(),
            ["“far too wide” is wider than its box"]
        );
        let line =
            SketchShape::Spring { from: PlotPoint::new(0.0, 0.0), to: PlotPoint::new(900.0, 0.0) };
        assert_eq!(
            Sketch::new(85.0).with(SketchPart::new("spring", "k", line)).collisions().len(),
            1
        );
    }
}
