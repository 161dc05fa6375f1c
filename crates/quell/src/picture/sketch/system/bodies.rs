//! Draws the bodies of a system.

use super::body::BodyKind;
use super::drawing::SystemDrawing;
use crate::plot::{FrameSize, LabelSide, PlotPoint, Sketch, SketchPart, SketchShape};

/// Draws the bodies.
pub(super) fn draw(mut sheet: Sketch, drawing: &SystemDrawing<'_>) -> Sketch {
    for (place, body) in drawing.bodies.iter().enumerate() {
        let seat = drawing.grid.seat(place);
        let shape = SketchShape::Block {
            corner: PlotPoint::new(seat.left, seat.top),
            size: FrameSize::new(seat.width, seat.height),
        };
        let (class, name) = match body.kind {
            BodyKind::Mass => ("mass", body.name.clone()),
            BodyKind::State => ("state", format!("state {}", body.name)),
            BodyKind::Modes => ("modes", format!("{}: {}", body.name, body.lines.join(", "))),
            BodyKind::Group => ("group", body.lines.join(", ")),
        };
        let mut part = SketchPart::new(class, name, shape);
        if body.kind == BodyKind::Modes {
            part = resonators(part, seat.left + 0.5 * seat.width, seat.top, body.indices.len());
        }
        for line in &body.lines {
            part = part.label(line.clone(), &[LabelSide::Inside]);
        }
        sheet = sheet.with(part);
    }
    sheet
}

/// Up to three resonators on a body: springs with small masses.
fn resonators(mut part: SketchPart, middle: f64, top: f64, count: usize) -> SketchPart {
    let drawn = count.min(3);
    for place in 0..drawn {
        let across = middle + 24.0 * (place as f64 - 0.5 * (drawn as f64 - 1.0));
        let [from, to] = [top, top - 22.0].map(|level| PlotPoint::new(across, level));
        part = part.and(SketchShape::Spring { from, to });
        part = part.and(SketchShape::Block {
            corner: PlotPoint::new(across - 6.0, top - 31.0),
            size: FrameSize::new(12.0, 9.0),
        });
    }
    part
}
