//! The canvas on which a figure is drawn: takes shapes in pixels, returns SVG text.

use std::fmt::{self, Write as _};

use super::geometry::PlotPoint;
use super::palette::{Colour, FRAME};
use super::svg::{Document, Escaped, FIGURE_NAME, Hex, Number, TextAnchor};
use super::typeset::RichText;

/// A rectangle in pixels, y downwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rectangle {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) right: f64,
    pub(super) bottom: f64,
}

impl Rectangle {
    pub(super) fn width(&self) -> f64 {
        self.right - self.left
    }

    pub(super) fn height(&self) -> f64 {
        self.bottom - self.top
    }

    pub(super) fn grown(&self, by: f64) -> Self {
        Self {
            left: self.left - by,
            top: self.top - by,
            right: self.right + by,
            bottom: self.bottom + by,
        }
    }
}

/// A stroke: colour, width in pixels, dash lengths.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Stroke {
    pub(super) colour: Colour,
    pub(super) width: f64,
    pub(super) dashes: Option<String>,
}

impl Stroke {
    pub(super) fn solid(colour: Colour, width: f64) -> Self {
        Self { colour, width, dashes: None }
    }
}

/// Style and rotation of a text.
#[derive(Debug, Clone, Copy)]
pub(super) struct TextStyle {
    pub(super) size: u32,
    pub(super) anchor: TextAnchor,
    pub(super) bold: bool,
    pub(super) colour: Colour,
    /// Rotation about its anchor, clockwise in degrees.
    pub(super) rotation: f64,
}

impl TextStyle {
    pub(super) fn new(size: u32, anchor: TextAnchor) -> Self {
        Self { size, anchor, bold: false, colour: FRAME, rotation: 0.0 }
    }

    /// The same style rotated clockwise by this angle in degrees.
    pub(super) fn rotated(self, rotation: f64) -> Self {
        Self { rotation, ..self }
    }
}

pub(super) struct Canvas {
    document: Document,
    clips: usize,
    hatches: Vec<(Colour, usize)>,
    images: usize,
}

impl Canvas {
    pub(super) fn new(width: f64, height: f64) -> Self {
        let document = Document::new(width, height);
        Self { document, clips: 0, hatches: Vec::new(), images: 0 }
    }

    /// Sets the description of the figure.
    pub(super) fn describe(&mut self, text: &str) {
        self.document.describe(text);
    }

    pub(super) fn text(
        &mut self,
        label: &RichText,
        PlotPoint { x, y }: PlotPoint,
        setting: TextStyle,
    ) {
        if label.is_empty() {
            return;
        }
        let TextStyle { size, anchor, bold, colour, rotation } = setting;
        let (x, y, colour) = (Number(x), Number(y), Hex(colour));
        let weight = if bold { " font-weight=\"bold\"" } else { "" };
        self.document.write(format_args!(
            "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" text-anchor=\"{anchor}\"{weight} fill=\"{colour}\""
        ));
        if rotation != 0.0 {
            let rotation = Number(rotation);
            self.document.write(format_args!(" transform=\"rotate({rotation},{x},{y})\""));
        }
        self.document.write(format_args!(">{}</text>", label.svg()));
    }

    /// Strokes an SVG path.
    pub(super) fn stroke(&mut self, path: &str, stroke: &Stroke) {
        if path.is_empty() {
            return;
        }
        let (colour, width) = (Hex(stroke.colour), Number(stroke.width));
        self.document.write(format_args!(
            "<path d=\"{path}\" stroke=\"{colour}\" stroke-width=\"{width}\" fill=\"none\""
        ));
        if let Some(dashes) = &stroke.dashes {
            self.document.write(format_args!(" stroke-dasharray=\"{dashes}\""));
        }
        self.document.write(format_args!(" />"));
    }

    /// Fills an SVG path.
    pub(super) fn fill(&mut self, path: &str, colour: Colour, opacity: f64) {
        let (colour, opacity) = (Hex(colour), Number(opacity));
        self.fill_with(path, format_args!("\"{colour}\" fill-opacity=\"{opacity}\""));
    }

    /// Fills an SVG path with a hatch: falling, rising or crossed strokes, depending on the style.
    pub(super) fn hatch(&mut self, path: &str, colour: Colour, style: usize) {
        let style = style % 3;
        let known = self.hatches.iter().position(|hatch| *hatch == (colour, style));
        let number = known.unwrap_or_else(|| {
            self.hatches.push((colour, style));
            let number = self.hatches.len() - 1;
            let rotation = if style == 1 { -45 } else { 45 };
            let strokes = if style == 2 { "M3.5 -1V8M-1 3.5H8" } else { "M3.5 -1V8" };
            self.document.define(format_args!(
                "<pattern id=\"{FIGURE_NAME}-hatch{number}\" patternUnits=\"userSpaceOnUse\" \
                 width=\"7\" height=\"7\" patternTransform=\"rotate({rotation})\"><path d=\"{strokes}\" \
                 stroke=\"{}\" stroke-width=\"0.8\" stroke-opacity=\"0.6\" /></pattern>",
                Hex(colour)
            ));
            number
        });
        self.fill_with(path, format_args!("\"url(#{FIGURE_NAME}-hatch{number})\""));
    }

    /// Writes a path without a stroke; `fill` is the value of its attribute, and others after it.
    fn fill_with(&mut self, path: &str, fill: fmt::Arguments<'_>) {
        if !path.is_empty() {
            self.document.write(format_args!(
                "<path d=\"{path}\" stroke=\"none\" stroke-width=\"0\" fill={fill} />"
            ));
        }
    }

    pub(super) fn rectangle(
        &mut self,
        area: Rectangle,
        fill: Option<(Colour, f64)>,
        edge: Option<(Colour, f64)>,
    ) {
        let (x, y) = (Number(area.left), Number(area.top));
        let (width, height) = (Number(area.width().max(0.0)), Number(area.height().max(0.0)));
        self.document
            .write(format_args!("<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\""));
        match fill {
            Some((colour, _)) => self.document.write(format_args!(" fill=\"{}\"", Hex(colour))),
            None => self.document.write(format_args!(" fill=\"none\"")),
        }
        if let Some((colour, width)) = edge {
            let (colour, width) = (Hex(colour), Number(width));
            self.document.write(format_args!(" stroke=\"{colour}\" stroke-width=\"{width}\""));
        }
        if let Some((_, opacity)) = fill {
            self.document.write(format_args!(" fill-opacity=\"{}\"", Number(opacity)));
        }
        self.document.write(format_args!(" />"));
    }

    /// Draws an image (a `data:` address) into a rectangle, without interpolation of its pixels.
    pub(super) fn image(&mut self, area: Rectangle, address: Option<String>) {
        let Some(address) = address else {
            return;
        };
        self.document.write(format_args!(
            "<g id=\"{FIGURE_NAME}-image{}\"><image x=\"{:.2}\" y=\"{:.2}\" width=\"{:.2}\" height=\"{:.2}\" \
             preserveAspectRatio=\"none\" style=\"image-rendering:pixelated\" href=\"{address}\" /></g>",
            self.images,
            area.left,
            area.top,
            area.width().max(0.0),
            area.height().max(0.0)
        ));
        self.images += 1;
    }

    /// Clips everything up to [`Canvas::end_clip`] to this rectangle.
    pub(super) fn begin_clip(&mut self, area: Rectangle) {
        let id = format!("{FIGURE_NAME}-clip{}", self.clips);
        self.clips += 1;
        self.document.define(format_args!(
            "<clipPath id=\"{id}\"><rect x=\"{:.2}\" y=\"{:.2}\" width=\"{:.2}\" height=\"{:.2}\" /></clipPath>",
            area.left,
            area.top,
            area.width(),
            area.height()
        ));
        self.begin_group(&format!("clip-path=\"url(#{id})\""));
    }

    pub(super) fn end_clip(&mut self) {
        self.end_group();
    }

    /// Opens a group with these SVG attributes.
    pub(super) fn begin_group(&mut self, attributes: &str) {
        self.document.write(format_args!("<g {attributes}>"));
    }

    pub(super) fn end_group(&mut self) {
        self.document.write(format_args!("</g>"));
    }

    /// Names the current group for readers of the file; nothing is written of an empty name.
    pub(super) fn name_group(&mut self, name: &str) {
        if !name.is_empty() {
            self.document.write(format_args!("<title>{}</title>", Escaped(name)));
        }
    }

    /// The finished SVG.
    pub(super) fn into_svg(self) -> String {
        self.document.finish()
    }
}

/// Paths with more points than this are written in tenths of a pixel.
const LONG_PATH: usize = 10_000;

/// Writes polylines as one SVG path; closed ones end at their start.
///
/// Each step is relative to the previous rounded point, so that rounding errors do not accumulate.
pub(super) fn path(pieces: &[Vec<PlotPoint>], closed: bool) -> String {
    let count: usize = pieces.iter().map(Vec::len).sum();
    let grain: i64 = if count > LONG_PATH { 10 } else { 1 };
    let mut path = String::with_capacity(count * 9);
    for piece in pieces {
        let mut last: Option<(i64, i64)> = None;
        for point in piece {
            let position = (hundredths(point.x, grain), hundredths(point.y, grain));
            let step = match last {
                None => {
                    path.push('M');
                    position
                }
                Some(last) => {
                    path.push('l');
                    (position.0 - last.0, position.1 - last.1)
                }
            };
            if last.is_some() && step == (0, 0) && piece.len() > 2 {
                path.pop();
                continue;
            }
            push_hundredths(&mut path, step.0);
            if step.1 >= 0 {
                path.push(' ');
            }
            push_hundredths(&mut path, step.1);
            last = Some(position);
        }
        if closed && !piece.is_empty() {
            path.push('Z');
        } else if piece.len() == 1 {
            // Programs that convert SVG leave out a path without length, and a round end needs one.
            path.push_str("h0.01");
        }
    }
    path
}

/// A coordinate in hundredths of a pixel, a multiple of `grain`.
fn hundredths(pixel: f64, grain: i64) -> i64 {
    #[expect(clippy::cast_possible_truncation, reason = "pixels are clamped to 1e5")]
    let whole = (pixel * 100.0 / grain as f64).round() as i64;
    whole * grain
}

/// Writes hundredths as a decimal number without trailing zeros.
fn push_hundredths(path: &mut String, value: i64) {
    if value < 0 {
        path.push('-');
    }
    let (whole, rest) = (value.abs() / 100, value.abs() % 100);
    let _ = match (rest, rest % 10) {
        (0, _) => write!(path, "{whole}"),
        (_, 0) => write!(path, "{whole}.{}", rest / 10),
        _ => write!(path, "{whole}.{rest:02}"),
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_is_short_and_exact_to_a_hundredth() {
        let pieces = vec![
            vec![PlotPoint::new(1.0, 2.0), PlotPoint::new(1.5, 1.25), PlotPoint::new(-0.004, 1.25)],
            vec![PlotPoint::new(3.0, 4.0)],
        ];
        assert_eq!(path(&pieces, false), "M1 2l0.5-0.75l-1.5 0M3 4h0.01");
    }

    #[test]
    fn rounding_errors_do_not_accumulate() {
        let piece: Vec<_> =
            (0..30_000).map(|step| PlotPoint::new(0.013 * f64::from(step), 0.0)).collect();
        let text = path(&[piece], false);
        let end: f64 = text
            .trim_start_matches('M')
            .split('l')
            .filter_map(|step| step.split(' ').next()?.parse::<f64>().ok())
            .sum();
        assert!((end - 0.013 * 29_999.0).abs() < 0.06, "{end}");
    }
}
