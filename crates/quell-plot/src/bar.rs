//! The colour bar of a map: right of the frame, as high as it, with numbers and a label.

use kuva::render::render::TextAnchor;

use super::canvas::{Canvas, Rectangle, Setting, Stroke, path};
use super::colouring::{Paintbox, SHADES, Spread};
use super::draw::Sizes;
use super::figure::Panel;
use super::layer::Layer;
use super::palette::{Colour, FRAME};
use super::raster::Raster;
use super::ticks::{Room, Ticks};
use super::typeset::{Label, wrap};

const GAP: f64 = 14.0;
const WIDTH: f64 = 11.0;
const TICK: f64 = 3.5;
const NUMBER_GAP: f64 = 6.0;
const LABEL_GAP: f64 = 6.0;
/// Height of the point that says "and beyond".
const POINT: f64 = 9.0;
/// Numbers of a signed logarithmic bar stand at least this far apart (pixels).
const APART: f64 = 17.0;

/// A colour bar with its numbers.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct BarPlan {
    inks: Vec<Colour>,
    /// Share of the bar and number of each tick.
    major: Vec<(f64, Label)>,
    minor: Vec<f64>,
    exponent: i32,
    label: Vec<Label>,
    widest: f64,
    overflows: (bool, bool),
}

impl BarPlan {
    /// The bar of a panel: of its first grid that asks for one.
    pub(super) fn of(panel: &Panel, height: f64, sizes: Sizes) -> Option<Self> {
        let (grid, quantity) = panel.layers.iter().find_map(|layer| match layer {
            Layer::Grid(grid) => grid.bar.as_ref().map(|axis| (grid, axis)),
            _ => None,
        })?;
        let paints = grid.paintbox();
        let overflows = paints.overflows(grid.field.extremes());
        let axis = paints.axis(quantity);
        let ticks = match paints.spread() {
            Spread::SignedLog(size) if quantity.ticks.is_none() => signed(&paints, size, height)
                .unwrap_or_else(|| Ticks::of(&axis, paints.range, Room::Upright(height))),
            _ => Ticks::of(&axis, paints.range, Room::Upright(height)),
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
            inks: paints.inks(),
            major: ticks
                .major
                .into_iter()
                .map(|(value, label)| (paints.share(value), label))
                .collect(),
            minor: ticks.minor.into_iter().map(|value| paints.share(value)).collect(),
            exponent: ticks.exponent,
            label,
            widest,
            overflows,
        })
    }

    /// Room it takes right of the frame.
    pub(super) fn room(&self, sizes: Sizes) -> f64 {
        let label = 1.25 * f64::from(sizes.label) * self.label.len() as f64;
        let gap = if self.label.is_empty() { 0.0 } else { LABEL_GAP };
        GAP + WIDTH + NUMBER_GAP + self.widest + gap + label
    }

    /// Whether a power of ten stands over it.
    pub(super) fn has_exponent(&self) -> bool {
        self.exponent != 0
    }

    /// Draws it beside its frame.
    pub(super) fn draw(&self, canvas: &mut Canvas, frame: Rectangle, sizes: Sizes) {
        let (left, right) = (frame.right + GAP, frame.right + GAP + WIDTH);
        let bar = Rectangle {
            left,
            right,
            top: frame.top + if self.overflows.1 { POINT } else { 0.0 },
            bottom: frame.bottom - if self.overflows.0 { POINT } else { 0.0 },
        };
        #[expect(clippy::cast_possible_truncation, reason = "fewer than 256 shades")]
        let inks = (0..SHADES).rev().map(|shade| shade as u8).collect();
        let image = Raster { width: 1, height: SHADES, inks };
        canvas.image(bar, image.address(&self.inks));
        let middle = 0.5 * (left + right);
        if self.overflows.1 {
            let point = vec![(left, bar.top), (middle, frame.top), (right, bar.top)];
            canvas.fill(path(&[point], true), self.inks[SHADES - 1], 1.0);
        }
        if self.overflows.0 {
            let point = vec![(left, bar.bottom), (middle, frame.bottom), (right, bar.bottom)];
            canvas.fill(path(&[point], true), self.inks[0], 1.0);
        }
        let mut outline = vec![(left, bar.top)];
        outline.extend(self.overflows.1.then_some((middle, frame.top)));
        outline.extend([(right, bar.top), (right, bar.bottom)]);
        outline.extend(self.overflows.0.then_some((middle, frame.bottom)));
        outline.push((left, bar.bottom));
        let place = |share: f64| bar.bottom - share * bar.height();
        let marks = |shares: &mut dyn Iterator<Item = f64>, length: f64| -> Vec<Vec<(f64, f64)>> {
            shares
                .map(|share| vec![(right, place(share)), (right - length, place(share))])
                .collect()
        };
        let minor = marks(&mut self.minor.iter().copied(), 0.55 * TICK);
        let major = marks(&mut self.major.iter().map(|(share, _)| *share), TICK);
        canvas.stroke(path(&minor, false), &Stroke::solid(FRAME, 0.6));
        canvas.stroke(path(&major, false), &Stroke::solid(FRAME, 0.8));
        canvas.stroke(path(&[outline], true), &Stroke::solid(FRAME, 0.8));
        self.draw_texts(canvas, (bar, frame), place, sizes);
    }

    fn draw_texts(
        &self,
        canvas: &mut Canvas,
        (bar, frame): (Rectangle, Rectangle),
        place: impl Fn(f64) -> f64,
        sizes: Sizes,
    ) {
        let number = f64::from(sizes.number);
        for (share, label) in &self.major {
            let at = (bar.right + NUMBER_GAP, place(*share) + 0.36 * number);
            canvas.text(label, at, Setting::new(sizes.number, TextAnchor::Start));
        }
        if self.has_exponent() {
            let label = Label::parse(&format!("$×10^{{{}}}$", self.exponent));
            let at = (bar.left, frame.top - 7.0);
            canvas.text(&label, at, Setting::new(sizes.number, TextAnchor::Start));
        }
        let size = f64::from(sizes.label);
        let middle = 0.5 * (frame.top + frame.bottom);
        let first = bar.right + NUMBER_GAP + self.widest + LABEL_GAP + 0.8 * size;
        for (line, label) in self.label.iter().enumerate() {
            let at = (first + 1.25 * size * line as f64, middle);
            let setting = Setting::new(sizes.label, TextAnchor::Middle).turned(-90.0);
            canvas.text(label, at, setting);
        }
    }
}

/// Zero and powers of ten on both sides of it; nothing when no power lies on the bar.
fn signed(paints: &Paintbox, size: f64, height: f64) -> Option<Ticks> {
    let upper = paints.range.1.abs().max(paints.range.0.abs());
    if !(size > 0.0 && upper.is_finite() && upper > size) {
        return None;
    }
    #[expect(clippy::cast_possible_truncation, reason = "decimal exponents")]
    let (first, last) = (size.log10().floor() as i32, (upper.log10() + 1e-9).floor() as i32);
    let place = |value: f64| paints.share(value) * height;
    let mut major = vec![(0.0, Label::parse("0"))];
    let mut minor = Vec::new();
    let (mut above, mut below) = (f64::INFINITY, f64::NEG_INFINITY);
    for exponent in (first..=last).rev() {
        let value = 10f64.powi(exponent);
        let clear = |at: f64| (at - place(0.0)).abs() >= APART;
        if value <= paints.range.1 && clear(place(value)) && above - place(value) >= APART {
            above = place(value);
            major.push((value, Label::parse(&format!("$10^{{{exponent}}}$"))));
        } else if value <= paints.range.1 {
            minor.push(value);
        }
        if -value >= paints.range.0 && clear(place(-value)) && place(-value) - below >= APART {
            below = place(-value);
            major.push((-value, Label::parse(&format!("$-10^{{{exponent}}}$"))));
        } else if -value >= paints.range.0 {
            minor.push(-value);
        }
    }
    (major.len() > 1).then_some(Ticks { major, minor, exponent: 0 })
}
