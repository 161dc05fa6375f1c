//! Dithers and constant forces: arrows at the bodies they act on, waves next to the load or friction that they modulate.

use quell_model::Waveform;
use quell_model::system::InputTarget;

use super::body::BodyKind;
use super::contacts;
use super::drawing::SystemDrawing;
use super::grid;
use crate::picture::sketch::symbols::{glyph, index, indexed};
use crate::plot::{LabelSide, PlotPoint, Sketch, SketchInk, SketchPart, SketchShape};

use LabelSide::{Above, Below, Left, Right};

/// Draws the inputs and the constant forces.
pub(super) fn draw(mut sheet: Sketch, drawing: &SystemDrawing<'_>) -> Sketch {
    let inputs = &drawing.study.system().inputs;
    let mut rows = vec![0_usize; drawing.bodies.len()];
    for (place, input) in inputs.iter().enumerate() {
        let symbol = indexed("u", &index(place, inputs.len()));
        let form = input.profile.waves().first().map_or(&Waveform::Sine, |wave| &wave.waveform);
        match &input.target {
            InputTarget::Force(row) => {
                for (body, factor) in drawing.touched(row) {
                    let label = if factor < 0.0 { format!("−{symbol}") } else { symbol.clone() };
                    sheet = force(sheet, drawing, (body, rows[body]), form, &label);
                    rows[body] += 1;
                }
            }
            InputTarget::NormalLoad { contact, .. } => {
                sheet = modulation(sheet, drawing, *contact, form, (&symbol, true));
            }
            InputTarget::Friction { contact } => {
                sheet = modulation(sheet, drawing, *contact, form, (&symbol, false));
            }
        }
    }
    constant_forces(sheet, drawing)
}

/// An arrow at the left side of a body.
fn force(
    sheet: Sketch,
    drawing: &SystemDrawing<'_>,
    (body, row): (usize, usize),
    form: &Waveform,
    label: &str,
) -> Sketch {
    let seat = drawing.grid.seat(body);
    let level = if drawing.bodies[body].kind == BodyKind::State {
        seat.top + 0.5 * seat.height
    } else {
        seat.top + grid::SPRINGS + grid::FORCE * row as f64 + 12.0
    };
    let wave =
        SketchShape::Wave { at: PlotPoint::new(seat.left - 31.0, level), glyph: glyph(form) };
    let arrow = SketchShape::Arrow {
        from: PlotPoint::new(seat.left - 20.0, level),
        to: PlotPoint::new(seat.left - 1.0, level),
    };
    let name = format!("{} dither at {}", form.name(), drawing.bodies[body].name);
    let part = SketchPart::new("dither", name, wave).and(arrow).ink(SketchInk::Input);
    sheet.with(part.label(label, &[Below, Above, Left]))
}

/// A wave next to the load or the friction of a contact.
fn modulation(
    sheet: Sketch,
    drawing: &SystemDrawing<'_>,
    contact: usize,
    form: &Waveform,
    (symbol, is_load): (&str, bool),
) -> Sketch {
    let Some(spot) = contacts::spot(drawing, contact) else { return sheet };
    let (at, of) = if is_load {
        (spot.load.moved(-30.0, -2.0), "normal load")
    } else {
        (spot.friction.moved(-28.0, 0.0), "friction")
    };
    let name = &drawing.study.system().contacts[contact].name;
    let name = format!("{} dither of the {of} of contact {name}", form.name());
    let shape = SketchShape::Wave { at, glyph: glyph(form) };
    let part = SketchPart::new("dither", name, shape).ink(SketchInk::Input);
    sheet.with(part.label(symbol, &[Left, Below, Above]))
}

/// Arrows at the right side of the bodies with a constant force.
fn constant_forces(mut sheet: Sketch, drawing: &SystemDrawing<'_>) -> Sketch {
    let force = drawing.study.system().structure.force();
    for (place, body) in drawing.bodies.iter().enumerate() {
        let acts = body.indices.iter().any(|&index| force[index] != 0.0);
        // The equation of a state contains it.
        if !acts || body.kind == BodyKind::State {
            continue;
        }
        let seat = drawing.grid.seat(place);
        let level = seat.top + grid::SPRINGS + 12.0;
        let shape = SketchShape::Arrow {
            from: PlotPoint::new(seat.right() + 1.0, level),
            to: PlotPoint::new(seat.right() + 24.0, level),
        };
        let name = format!("constant force at {}", body.name);
        let part = SketchPart::new("force", name, shape);
        let number = (place + 1).to_string();
        sheet = sheet.with(part.label(indexed("p", &number), &[Below, Right, Above]));
    }
    sheet
}
