//! The colour bar of a heatmap: to the right of the frame and as tall as it, with tick labels and an axis label.

use super::canvas::{Canvas, Rectangle, Stroke, TextStyle, path};
use super::colouring::{ColourMap, SHADES, Spread};
use super::figure::Panel;
use super::font_sizes::FontSizes;
use super::geometry::PlotPoint;
use super::layer::Layer;
use super::palette::{Colour, FRAME};
use super::raster::Raster;
use super::svg::TextAnchor;
use super::ticks::{Room, Ticks};
use super::typeset::{RichText, wrap};

const GAP: f64 = 14.0;
const WIDTH: f64 = 11.0;
const TICK: f64 = 3.5;
const NUMBER_GAP: f64 = 6.0;
const LABEL_GAP: f64 = 6.0;
/// Height of the pointed end that marks values beyond the scale.
const POINT: f64 = 9.0;
/// Least distance between the tick labels of a signed logarithmic bar (pixels).
const APART: f64 = 17.0;

/// A colour bar with its tick labels.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ColourBar {
    colours: Vec<Colour>,
    /// Position (as a fraction of the bar) and label of each major tick.
    major: Vec<(f64, RichText)>,
    minor: Vec<f64>,
    exponent: i32,
    label: Vec<RichText>,
    widest: f64,
    overflows: (bool, bool),
}

impl ColourBar {
    /// The bar of a panel: that of its first heatmap that requests one.
    pub(super) fn of(panel: &Panel, height: f64, sizes: FontSizes) -> Option<Self> {
        let (grid, quantity) = panel.layers.iter().find_map(|layer| match layer {
            Layer::Heatmap(grid) => grid.bar.as_ref().map(|axis| (grid, axis)),
            _ => None,
        })?;
        let colour_map = grid.colour_map();
        let overflows = colour_map.overflows(grid.field.extremes());
        let axis = colour_map.axis(quantity);
        let ticks = match colour_map.spread() {
            Spread::SignedLog(size) if quantity.ticks.is_none() => {
                signed(&colour_map, size, height)
                    .unwrap_or_else(|| Ticks::of(&axis, colour_map.range, Room::Upright(height)))
            }
            _ => Ticks::of(&axis, colour_map.range, Room::Upright(height)),
        };
        let number = f64::from(sizes.number);
        let widest =
            ticks.major.iter().map(|(_, label)| label.width(number, false)).fold(0.0, f64::max);
        let label = quantity.label();
        let label = if label.is_empty() {
            Vec::new()
        } else {
            wrap(&label, f64::from(sizes.label), false, height + 30.0)
        };
        Some(Self {
            colours: colour_map.colours(),
            major: ticks
                .major
                .into_iter()
                .map(|(value, label)| (colour_map.share(value), label))
                .collect(),
            minor: ticks.minor.into_iter().map(|value| colour_map.share(value)).collect(),
            exponent: ticks.exponent,
            label,
            widest,
            overflows,
        })
    }

    /// Width needed to the right of the frame.
    pub(super) fn room(&self, sizes: FontSizes) -> f64 {
        let label = 1.25 * f64::from(sizes.label) * self.label.len() as f64;
        let gap = if self.label.is_empty() { 0.0 } else { LABEL_GAP };
        GAP + WIDTH + NUMBER_GAP + self.widest + gap + label
    }

    /// Whether a power of ten is shown above the bar.
    pub(super) fn has_exponent(&self) -> bool {
        self.exponent != 0
    }

    /// Draws the bar next to its frame.
    pub(super) fn draw(&self, canvas: &mut Canvas, frame: Rectangle, sizes: FontSizes) {
        let (left, right) = (frame.right + GAP, frame.right + GAP + WIDTH);
        let bar = Rectangle {
            left,
            right,
            top: frame.top + if self.overflows.1 { POINT } else { 0.0 },
            bottom: frame.bottom - if self.overflows.0 { POINT } else { 0.0 },
        };
        #[expect(clippy::cast_possible_truncation, reason = "fewer than 256 shades")]
        let indices = (0..SHADES).rev().map(|shade| shade as u8).collect();
        let image = Raster { width: 1, height: SHADES, indices };
        canvas.image(bar, image.address(&self.colours));
        let middle = 0.5 * (left + right);
        if self.overflows.1 {
            let point = vec![
                PlotPoint::new(left, bar.top),
                PlotPoint::new(middle, frame.top),
                PlotPoint::new(right, bar.top),
            ];
            canvas.fill(&path(&[point], true), self.colours[SHADES - 1], 1.0);
        }
        if self.overflows.0 {
            let point = vec![
                PlotPoint::new(left, bar.bottom),
                PlotPoint::new(middle, frame.bottom),
                PlotPoint::new(right, bar.bottom),
            ];
            canvas.fill(&path(&[point], true), self.colours[0], 1.0);
        }
        let mut outline = vec![PlotPoint::new(left, bar.top)];
        outline.extend(self.overflows.1.then_some(PlotPoint::new(middle, frame.top)));
        outline.extend([PlotPoint::new(right, bar.top), PlotPoint::new(right, bar.bottom)]);
        outline.extend(self.overflows.0.then_some(PlotPoint::new(middle, frame.bottom)));
        outline.push(PlotPoint::new(left, bar.bottom));
        let position = |share: f64| bar.bottom - share * bar.height();
        let marks = |shares: &mut dyn Iterator<Item = f64>, length: f64| -> Vec<Vec<PlotPoint>> {
            shares
                .map(|share| {
                    vec![
                        PlotPoint::new(right, position(share)),
                        PlotPoint::new(right - length, position(share)),
                    ]
                })
                .collect()
        };
        let minor = marks(&mut self.minor.iter().copied(), 0.55 * TICK);
        let major = marks(&mut self.major.iter().map(|(share, _)| *share), TICK);
        canvas.stroke(&path(&minor, false), &Stroke::solid(FRAME, 0.6));
        canvas.stroke(&path(&major, false), &Stroke::solid(FRAME, 0.8));
        canvas.stroke(&path(&[outline], true), &Stroke::solid(FRAME, 0.8));
        self.draw_texts(canvas, (bar, frame), position, sizes);
    }

    fn draw_texts(
        &self,
        canvas: &mut Canvas,
        (bar, frame): (Rectangle, Rectangle),
        position: impl Fn(f64) -> f64,
        sizes: FontSizes,
    ) {
        let number = f64::from(sizes.number);
        for (share, label) in &self.major {
            let at = PlotPoint::new(bar.right + NUMBER_GAP, position(*share) + 0.36 * number);
            canvas.text(label, at, TextStyle::new(sizes.number, TextAnchor::Start));
        }
        if self.has_exponent() {
            let label = RichText::parse(&format!("$×10^{{{}}}$", self.exponent));
            let at = PlotPoint::new(bar.left, frame.top - 7.0);
            canvas.text(&label, at, TextStyle::new(sizes.number, TextAnchor::Start));
        }
        let size = f64::from(sizes.label);
        let middle = 0.5 * (frame.top + frame.bottom);
        let first = bar.right + NUMBER_GAP + self.widest + LABEL_GAP + 0.8 * size;
        for (line, label) in self.label.iter().enumerate() {
            let at = PlotPoint::new(first + 1.25 * size * line as f64, middle);
            let setting = TextStyle::new(sizes.label, TextAnchor::Middle).rotated(-90.0);
            canvas.text(label, at, setting);
        }
    }
}

/// Ticks at zero and at powers of ten on both sides of it; `None` if no power of ten lies on the bar.
fn signed(colour_map: &ColourMap, size: f64, height: f64) -> Option<Ticks> {
    let upper = colour_map.range.upper.abs().max(colour_map.range.lower.abs());
    if !(size > 0.0 && upper.is_finite() && upper > size) {
        return None;
    }
    #[expect(clippy::cast_possible_truncation, reason = "decimal exponents")]
    let (first, last) =
        (libm::log10(size).floor() as i32, (libm::log10(upper) + 1e-9).floor() as i32);
    let position = |value: f64| colour_map.share(value) * height;
    let mut major = vec![(0.0, RichText::parse("0"))];
    let mut minor = Vec::new();
    let (mut above, mut below) = (f64::INFINITY, f64::NEG_INFINITY);
    for exponent in (first..=last).rev() {
        let value = 10f64.powi(exponent);
        let clear = |at: f64| (at - position(0.0)).abs() >= APART;
        if value <= colour_map.range.upper
            && clear(position(value))
            && above - position(value) >= APART
        {
            above = position(value);
            major.push((value, RichText::parse(&format!("$10^{{{exponent}}}$"))));
        } else if value <= colour_map.range.upper {
            minor.push(value);
        }
        if -value >= colour_map.range.lower
            && clear(position(-value))
            && position(-value) - below >= APART
        {
            below = position(-value);
            major.push((-value, RichText::parse(&format!("$-10^{{{exponent}}}$"))));
        } else if -value >= colour_map.range.lower {
            minor.push(-value);
        }
    }
    (major.len() > 1).then_some(Ticks { major, minor, exponent: 0 })
}
