//! Renders a sketch as SVG.

use super::labels::{PlacedSketch, place};
use super::part::{SketchKey, SketchPart};
use super::sheet::{MARGIN, Sketch, TEXT};
use crate::canvas::{Canvas, Stroke, TextStyle, path};
use crate::geometry::PlotPoint;
use crate::palette::{Colour, FAINT, LineStyle};
use crate::svg::{Escaped, TextAnchor};
use crate::typeset::{RichText, wrap};

/// Pitch of the lines of the key.
const PITCH: f64 = 13.5;
/// Indent of all lines of an entry but its first.
const INDENT: f64 = 10.0;
/// Width of the margin next to the key.
const SIDE: f64 = 4.0;
const LINE: f64 = 1.2;
const THIN: f64 = 0.7;
/// Fill of masses and discs.
const PALE: Colour = (0xEC, 0xEC, 0xEC);
const NO_BREAK: char = '\u{a0}';

/// Height of the sheet (pixels).
pub(super) fn height(sketch: &Sketch) -> f64 {
    let (placed, lines) = (place(sketch), key_lines(sketch));
    sheet_height(&placed, &lines)
}

fn sheet_height(placed: &PlacedSketch, lines: &[(f64, RichText)]) -> f64 {
    let key = if lines.is_empty() { 0.0 } else { MARGIN + PITCH * lines.len() as f64 };
    placed.bottom + key + MARGIN
}

/// The SVG of a sketch.
pub(super) fn svg(sketch: &Sketch) -> String {
    let (placed, lines) = (place(sketch), key_lines(sketch));
    let scale = sketch.scale();
    let height = sheet_height(&placed, &lines);
    let mut canvas = Canvas::new(sketch.room() * scale, height * scale);
    canvas.describe(&sketch.description);
    canvas.begin_group(&format!(
        "transform=\"scale({scale:.4})\" stroke-linejoin=\"round\" stroke-linecap=\"round\""
    ));
    canvas.name_group(&sketch.title);
    for (part, labels) in placed.parts.iter().zip(&placed.labels) {
        canvas.begin_group(&format!("class=\"{}\"", Escaped(part.class)));
        canvas.name_group(&part.name);
        draw_part(&mut canvas, part);
        for label in labels {
            let style =
                TextStyle { colour: part.ink.colour(), ..TextStyle::new(TEXT, TextAnchor::Start) };
            canvas.text(&label.text, label.at, style);
        }
        canvas.end_group();
    }
    canvas.begin_group("class=\"key\"");
    for (number, (left, line)) in lines.iter().enumerate() {
        let baseline = placed.bottom + MARGIN + PITCH * number as f64 + 0.9 * f64::from(TEXT);
        canvas.text(
            line,
            PlotPoint::new(SIDE + left, baseline),
            TextStyle::new(TEXT, TextAnchor::Start),
        );
    }
    canvas.end_group();
    canvas.end_group();
    canvas.into_svg()
}

fn draw_part(canvas: &mut Canvas, part: &SketchPart) {
    let colour = part.ink.colour();
    for shape in &part.shapes {
        let drawn = shape.strokes();
        for filled in drawn.fills.iter().filter(|filled| !filled.inked) {
            canvas.fill(&path(std::slice::from_ref(&filled.outline), true), PALE, 1.0);
        }
        let dashes = drawn.style.unwrap_or(LineStyle::Solid).dashes(LINE);
        let width = if dashes.is_some() { THIN + 0.2 } else { LINE };
        canvas.stroke(&path(&drawn.lines, false), &Stroke { colour, width, dashes });
        canvas.stroke(&path(&drawn.thin, false), &Stroke::solid(FAINT, THIN));
        for filled in drawn.fills.iter().filter(|filled| filled.inked) {
            canvas.fill(&path(std::slice::from_ref(&filled.outline), true), colour, 1.0);
        }
    }
}

/// The lines of the key with their indents.
fn key_lines(sketch: &Sketch) -> Vec<(f64, RichText)> {
    let room = sketch.room() - 2.0 * SIDE - INDENT;
    sketch
        .key
        .iter()
        .flat_map(|entry| {
            let lines = wrap(&key_text(entry, room), f64::from(TEXT), false, room);
            lines
                .into_iter()
                .enumerate()
                .map(|(number, line)| (if number == 0 { 0.0 } else { INDENT }, line))
        })
        .collect()
}

/// An entry as text whose items do not break, unless they are wider than the sheet.
fn key_text(entry: &SketchKey, room: f64) -> String {
    let items: Vec<String> = entry
        .items
        .iter()
        .map(|item| {
            let width = RichText::parse(item).width(f64::from(TEXT), false);
            if width > room { item.clone() } else { unbroken(item) }
        })
        .collect();
    match entry.head.as_str() {
        "" => items.join(", "),
        head if items.is_empty() => head.to_owned(),
        head => format!("{head}: {}", items.join(", ")),
    }
}

/// The text with spaces outside symbols that do not break.
fn unbroken(item: &str) -> String {
    item.replace(' ', &NO_BREAK.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::FrameSize;
    use crate::sketch::part::LabelSide;
    use crate::sketch::shape::SketchShape;

    fn sketch(width_mm: f64) -> Sketch {
        let block = SketchShape::Block {
            corner: PlotPoint::new(0.0, 0.0),
            size: FrameSize::new(60.0, 30.0),
        };
        Sketch {
            title: "<one>".to_owned(),
            description: "A mass".to_owned(),
            ..Sketch::new(width_mm)
        }
        .with(SketchPart::new("mass", "mass & name", block).label("$m_1$", &[LabelSide::Inside]))
        .with_key(SketchKey::new("mass", ["$m_1$ = 2 kg"]))
    }

    #[test]
    fn names_and_titles_are_escaped() {
        let svg = sketch(85.0).to_svg();
        assert!(
            svg.contains("<title>&lt;one&gt;</title>") && svg.contains("<desc>A mass</desc>"),
            "{svg}"
        );
        assert!(svg.contains("<g class=\"mass\"><title>mass &amp; name</title>"), "{svg}");
    }

    #[test]
    fn the_sheet_has_the_width_asked_for_and_texts_of_seven_points() {
        for width in [60.0, 85.0, 170.0] {
            let sketch = sketch(width);
            assert!(sketch.text_size() >= 7.0);
            let svg = sketch.to_svg();
            let pixels = format!("width=\"{:.2}\"", width * 96.0 / 25.4);
            assert!(svg.contains(&pixels), "{svg}");
            assert!(svg.contains("font-size=\"10\""), "{svg}");
        }
    }

    #[test]
    fn entries_of_the_key_break_between_items() {
        let items = (0..12).map(|number| format!("$k_{{{number}}}$ = {number} kN/m"));
        let sketch = sketch(60.0).with_key(SketchKey::new("springs", items));
        let lines = key_lines(&sketch);
        assert!(lines.len() > 3);
        for (left, line) in &lines {
            assert!(left + line.width(f64::from(TEXT), false) <= sketch.room());
        }
    }
}
