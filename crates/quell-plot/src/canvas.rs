//! The canvas on which a figure is drawn: takes shapes in pixels, collects a kuva scene, returns SVG text.

use std::fmt::Write as _;

use kuva::backend::svg::SvgBackend;
use kuva::render::color::Color;
use kuva::render::render::{PathData, Primitive, Scene, TextAnchor};

use super::fonts::FAMILY;
use super::palette::{Colour, FRAME};
use super::tspan::Tags;
use super::typeset::RichText;

/// Placeholder for the figure's own name in identifiers until its contents are known.
const PICTURE_NAME: &str = "quell-picture";

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
    scene: Scene,
    tags: Tags,
    clips: usize,
    hatches: Vec<(Colour, usize)>,
    images: Vec<String>,
}

impl Canvas {
    pub(super) fn new(width: f64, height: f64) -> Self {
        let mut scene = Scene::new(width.ceil(), height.ceil()).with_background(Some("#ffffff"));
        scene.font_family = Some(FAMILY.to_string());
        Self { scene, tags: Tags::default(), clips: 0, hatches: Vec::new(), images: Vec::new() }
    }

    pub(super) fn text(&mut self, label: &RichText, (x, y): (f64, f64), setting: TextStyle) {
        if label.is_empty() {
            return;
        }
        self.scene.add(Primitive::Text {
            x,
            y,
            content: label.encode(&mut self.tags),
            size: setting.size,
            anchor: setting.anchor,
            rotate: (setting.rotation != 0.0).then_some(setting.rotation),
            bold: setting.bold,
            color: Some(paint(setting.colour)),
        });
    }

    /// Strokes an SVG path.
    pub(super) fn stroke(&mut self, path: String, stroke: &Stroke) {
        if path.is_empty() {
            return;
        }
        self.scene.add(Primitive::Path(Box::new(PathData {
            d: path,
            fill: None,
            stroke: paint(stroke.colour),
            stroke_width: stroke.width,
            opacity: None,
            stroke_dasharray: stroke.dashes.clone(),
        })));
    }

    /// Fills an SVG path.
    pub(super) fn fill(&mut self, path: String, colour: Colour, opacity: f64) {
        self.fill_with(path, paint(colour), Some(opacity));
    }

    /// Fills an SVG path with a hatch: falling, rising or crossed strokes, depending on the style.
    pub(super) fn hatch(&mut self, path: String, colour: Colour, style: usize) {
        let style = style % 3;
        let known = self.hatches.iter().position(|hatch| *hatch == (colour, style));
        let number = known.unwrap_or_else(|| {
            self.hatches.push((colour, style));
            let number = self.hatches.len() - 1;
            let rotation = if style == 1 { -45 } else { 45 };
            let strokes = if style == 2 { "M3.5 -1V8M-1 3.5H8" } else { "M3.5 -1V8" };
            self.scene.defs.push(format!(
                "<pattern id=\"{PICTURE_NAME}-hatch{number}\" patternUnits=\"userSpaceOnUse\" \
                 width=\"7\" height=\"7\" patternTransform=\"rotate({rotation})\"><path d=\"{strokes}\" \
                 stroke=\"{}\" stroke-width=\"0.8\" stroke-opacity=\"0.6\" /></pattern>",
                paint(colour).to_svg_string()
            ));
            number
        });
        let url = format!("url(#{PICTURE_NAME}-hatch{number})");
        self.fill_with(path, Color::Css(url.into_boxed_str()), None);
    }

    fn fill_with(&mut self, path: String, fill: Color, opacity: Option<f64>) {
        if path.is_empty() {
            return;
        }
        self.scene.add(Primitive::Path(Box::new(PathData {
            d: path,
            fill: Some(fill),
            stroke: Color::None,
            stroke_width: 0.0,
            opacity,
            stroke_dasharray: None,
        })));
    }

    pub(super) fn rectangle(
        &mut self,
        area: Rectangle,
        fill: Option<(Colour, f64)>,
        edge: Option<(Colour, f64)>,
    ) {
        self.scene.add(Primitive::Rect {
            x: area.left,
            y: area.top,
            width: area.width().max(0.0),
            height: area.height().max(0.0),
            fill: fill.map_or(Color::None, |(colour, _)| paint(colour)),
            stroke: edge.map(|(colour, _)| paint(colour)),
            stroke_width: edge.map(|(_, width)| width),
            opacity: fill.map(|(_, opacity)| opacity),
        });
    }

    /// Draws an image (a `data:` address) into a rectangle, without interpolation of its pixels.
    pub(super) fn image(&mut self, area: Rectangle, address: Option<String>) {
        let Some(address) = address else {
            return;
        };
        self.begin_group(&image_name(self.images.len()));
        self.end_group();
        self.images.push(format!(
            "<image x=\"{:.2}\" y=\"{:.2}\" width=\"{:.2}\" height=\"{:.2}\" \
             preserveAspectRatio=\"none\" style=\"image-rendering:pixelated\" href=\"{address}\" />",
            area.left,
            area.top,
            area.width().max(0.0),
            area.height().max(0.0)
        ));
    }

    /// Clips everything up to [`Canvas::end_clip`] to this rectangle.
    pub(super) fn begin_clip(&mut self, area: Rectangle) {
        let id = format!("{PICTURE_NAME}-clip{}", self.clips);
        self.clips += 1;
        self.scene.defs.push(format!(
            "<clipPath id=\"{id}\"><rect x=\"{:.2}\" y=\"{:.2}\" width=\"{:.2}\" height=\"{:.2}\" /></clipPath>",
            area.left,
            area.top,
            area.width(),
            area.height()
        ));
        self.scene.add(Primitive::ClipStart {
            x: area.left,
            y: area.top,
            width: area.width(),
            height: area.height(),
            id,
        });
    }

    pub(super) fn end_clip(&mut self) {
        self.scene.add(Primitive::ClipEnd);
    }

    /// Opens a group with these SVG attributes.
    pub(super) fn begin_group(&mut self, attributes: &str) {
        self.scene.add(Primitive::GroupStart {
            transform: None,
            title: None,
            extra_attrs: Some(attributes.to_string()),
        });
    }

    pub(super) fn end_group(&mut self) {
        self.scene.add(Primitive::GroupEnd);
    }

    /// The finished SVG.
    ///
    /// Identifiers contain a hash of the contents, so that several figures can be embedded in one page.
    pub(super) fn into_svg(self) -> String {
        let drawn = SvgBackend::new().render_scene(&self.scene);
        let mut svg = self.tags.resolve(&drawn);
        // kuva has no image primitive: images are inserted into their placeholder groups.
        for (number, image) in self.images.iter().enumerate() {
            let name = format!("{}>", image_name(number));
            svg = svg.replacen(&name, &format!("{name}{image}"), 1);
        }
        let svg = svg.replace(PICTURE_NAME, &format!("q{:016x}", fingerprint(svg.as_bytes())));
        // kuva writes no view box, without which a figure does not scale in a page.
        let view_box =
            format!("<svg viewBox=\"0 0 {} {}\" role=\"img\"", self.scene.width, self.scene.height);
        svg.replacen("<svg", &view_box, 1)
    }
}

/// Fowler–Noll–Vo hash (FNV-1a, 64 bits): the same in every build, unlike the standard hasher.
fn fingerprint(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// Attribute of the placeholder group of an image.
fn image_name(number: usize) -> String {
    format!("id=\"{PICTURE_NAME}-image{number}\"")
}

fn paint((red, green, blue): Colour) -> Color {
    Color::Rgb(red, green, blue)
}

/// Paths with more points than this are written in tenths of a pixel.
const LONG_PATH: usize = 10_000;

/// Writes polylines as one SVG path; closed ones end at their start.
///
/// Each step is relative to the previous rounded point, so that rounding errors do not accumulate.
pub(super) fn path(pieces: &[Vec<(f64, f64)>], closed: bool) -> String {
    let count: usize = pieces.iter().map(Vec::len).sum();
    let grain: i64 = if count > LONG_PATH { 10 } else { 1 };
    let mut path = String::with_capacity(count * 9);
    for piece in pieces {
        let mut last: Option<(i64, i64)> = None;
        for point in piece {
            let position = (hundredths(point.0, grain), hundredths(point.1, grain));
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
            path.push_str("h0");
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
        let pieces = vec![vec![(1.0, 2.0), (1.5, 1.25), (-0.004, 1.25)], vec![(3.0, 4.0)]];
        assert_eq!(path(&pieces, false), "M1 2l0.5-0.75l-1.5 0M3 4h0");
    }

    #[test]
    fn rounding_errors_do_not_accumulate() {
        let piece: Vec<_> = (0..30_000).map(|step| (0.013 * f64::from(step), 0.0)).collect();
        let text = path(&[piece], false);
        let end: f64 = text
            .trim_start_matches('M')
            .split('l')
            .filter_map(|step| step.split(' ').next()?.parse::<f64>().ok())
            .sum();
        assert!((end - 0.013 * 29_999.0).abs() < 0.06, "{end}");
    }
}
