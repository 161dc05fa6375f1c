//! Legends: one entry per label with its keys, in a box or in rows.

use super::axis::Mapping;
use super::axis_limits::AxisLimits;
use super::canvas::{Canvas, Rectangle, Stroke, TextStyle, path};
use super::colouring::{Colouring, Shading, Tint};
use super::envelope::{self, CurveTrace, band_opacity};
use super::figure::{LegendPosition, Panel};
use super::font_sizes::FontSizes;
use super::geometry::{FrameSize, PlotPoint};
use super::layer::{Fill, Layer, Marker, Polyline};
use super::map_layers::Heatmap;
use super::marks;
use super::palette::{Colour, FRAME, GAP, LEGEND_EDGE, PAPER, PlotRole};
use super::projection;
use super::svg::TextAnchor;
use super::typeset::{RichText, wrap};
use super::visibility;

const SAMPLE: f64 = 26.0;
const SAMPLE_GAP: f64 = 6.0;
const ENTRY_GAP: f64 = 18.0;
/// Edge of a tinted key.
const GREY_EDGE: Colour = (0x80, 0x80, 0x80);
const PADDING: f64 = 6.0;
/// Least diameter of a marker in the legend (pixels).
const LEAST_KEY: f64 = 4.0;
const LINE_GAP: f64 = 5.0;

/// The symbol next to a label.
#[derive(Debug, Clone, PartialEq)]
enum LegendKey {
    Stroke(Stroke),
    Band(Colour),
    Point(PlotRole, Marker, f64),
    Patch(PlotRole, Fill),
    Tint(Colour),
    Hatch(usize),
}

/// One label with its keys.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LegendEntry {
    text: String,
    samples: Vec<LegendKey>,
}

/// One entry with its label broken into lines.
struct SetEntry<'a> {
    samples: &'a [LegendKey],
    lines: Vec<RichText>,
    width: f64,
}

impl LegendEntry {
    /// The entry no wider than `room`, unless one word is.
    fn set(&self, room: f64, sizes: FontSizes) -> SetEntry<'_> {
        let (size, indent) = (f64::from(sizes.legend), SAMPLE + SAMPLE_GAP);
        let lines = wrap(&self.text, size, false, room - indent);
        let widest = lines.iter().map(|line| line.width(size, false)).fold(0.0, f64::max);
        SetEntry { samples: &self.samples, lines, width: indent + widest }
    }
}

impl SetEntry<'_> {
    fn height(&self, sizes: FontSizes) -> f64 {
        line_height(sizes) * self.lines.len().max(1) as f64
    }
}

/// Label of the bands that stand for oscillations too fast to be drawn.
const BAND: &str = "band: extremes of each oscillation";

/// A panel whose layers have entries: its limits, and the width and height of its frame (pixels).
#[derive(Debug, Clone, Copy)]
pub(super) struct LegendPanel<'a> {
    pub(super) panel: &'a Panel,
    pub(super) limits: AxisLimits,
    pub(super) frame: FrameSize,
}

/// The entries of these panels: equal labels share an entry, equal keys are shown once. Layers of which nothing is inside the
/// limits of their panel have no entry.
pub(super) fn entries<'a>(panels: impl IntoIterator<Item = LegendPanel<'a>>) -> Vec<LegendEntry> {
    let mut entries: Vec<LegendEntry> = Vec::new();
    let mut bands: Vec<LegendEntry> = Vec::new();
    for place in panels {
        let visible = |layer: &&Layer| visibility::is_visible(layer, place.panel, place.limits);
        for layer in place.panel.layers.iter().filter(visible) {
            for (text, sample) in samples(layer).into_iter().filter(|(text, _)| !text.is_empty()) {
                add(&mut entries, text, sample);
            }
            if let Some(colour) = band_of(layer, place) {
                add(&mut bands, BAND, LegendKey::Band(colour));
            }
        }
    }
    entries.append(&mut bands);
    entries
}

fn add(entries: &mut Vec<LegendEntry>, text: &str, sample: LegendKey) {
    match entries.iter_mut().find(|entry| entry.text == text) {
        Some(entry) if entry.samples.contains(&sample) => {}
        Some(entry) => entry.samples.push(sample),
        None => entries.push(LegendEntry { text: text.to_string(), samples: vec![sample] }),
    }
}

/// The colour of the band as which a part of this curve is drawn.
fn band_of(layer: &Layer, place: LegendPanel) -> Option<Colour> {
    let Layer::Polyline(line) = layer else { return None };
    let FrameSize { width, height } = place.frame;
    let frame = Rectangle { left: 0.0, top: 0.0, right: width, bottom: height };
    let x = Mapping::new(&place.panel.x, place.limits.x, 0.0, width);
    let y = Mapping::new(&place.panel.y, place.limits.y, height, 0.0);
    let pieces = projection::pixels(&line.pieces, &x, &y, frame);
    let is_band = |piece: &Vec<PlotPoint>| {
        envelope::traces(piece).iter().any(|trace| matches!(trace, CurveTrace::Band { .. }))
    };
    pieces.iter().any(is_band).then(|| line.role.colour())
}

fn samples(layer: &Layer) -> Vec<(&str, LegendKey)> {
    let (label, sample) = match layer {
        Layer::Polyline(line) => (&line.label, LegendKey::Stroke(stroke_of(line))),
        Layer::Points(points) => {
            (&points.label, LegendKey::Point(points.role, points.marker, points.size))
        }
        Layer::Region(region) => (&region.label, LegendKey::Patch(region.role, region.fill)),
        Layer::Contours(lines) => {
            (&lines.label, LegendKey::Stroke(Stroke::solid(lines.role.colour(), lines.width)))
        }
        Layer::Heatmap(grid) => return samples_of_grid(grid),
        Layer::ReferenceLine(_) | Layer::Note(_) => return Vec::new(),
    };
    vec![(label.as_str(), sample)]
}

/// Keys for the outcomes that occur, for values below the scale, and for each reason why points have no value.
fn samples_of_grid(grid: &Heatmap) -> Vec<(&str, LegendKey)> {
    let has = |test: &dyn Fn(f64) -> bool| {
        grid.field.values().iter().any(|value| value.is_some_and(test))
    };
    let tint = |tint| (Tint::label(tint), LegendKey::Tint(Tint::colour(tint)));
    let mut samples: Vec<(&str, LegendKey)> = match &grid.colouring {
        Colouring::Outcomes(outcomes) => outcomes
            .iter()
            .enumerate()
            .filter(|(number, _)| has(&|value| value.round() == *number as f64))
            .map(|(number, outcome)| {
                (Tint::label(outcome), LegendKey::Tint(outcome.outcome_colour(number)))
            })
            .collect(),
        Colouring::Shaded(Shading { below: Some((limit, below)), .. }) => {
            if has(&|value| value < *limit) { vec![tint(below)] } else { Vec::new() }
        }
        Colouring::Shaded(shading) => {
            let [negative, positive] = shading.sign_keys();
            let occurring = [
                negative.filter(|_| has(&|value| value < 0.0)),
                positive.filter(|_| has(&|value| value > 0.0)),
            ];
            let keys = occurring.into_iter().flatten();
            keys.map(|(word, colour)| (word, LegendKey::Tint(colour))).collect()
        }
    };
    samples.extend(
        grid.all_gaps().into_iter().map(|(style, label, _)| (label, LegendKey::Hatch(style))),
    );
    samples
}

/// The stroke of a line, from its role and its own settings.
pub(super) fn stroke_of(line: &Polyline) -> Stroke {
    let width = line.width.unwrap_or(line.role.width());
    let dashes = line.style.unwrap_or(line.role.style()).dashes(width);
    Stroke { colour: line.role.colour(), width, dashes }
}

fn line_height(sizes: FontSizes) -> f64 {
    f64::from(sizes.legend) + LINE_GAP
}

/// Width and height of a box with one entry per row, no wider than `room`.
pub(super) fn box_size(entries: &[LegendEntry], room: f64, sizes: FontSizes) -> FrameSize {
    let set: Vec<SetEntry> = set_in_box(entries, room, sizes);
    let widest = set.iter().map(|entry| entry.width).fold(0.0, f64::max);
    let height = set.iter().map(|entry| entry.height(sizes)).sum::<f64>() - LINE_GAP;
    FrameSize::new(widest + 2.0 * PADDING, height + 2.0 * PADDING)
}

fn set_in_box(entries: &[LegendEntry], room: f64, sizes: FontSizes) -> Vec<SetEntry<'_>> {
    entries.iter().map(|entry| entry.set(room - 2.0 * PADDING, sizes)).collect()
}

/// The box at a position inside the frame.
pub(super) fn box_at(
    position: LegendPosition,
    frame: Rectangle,
    FrameSize { width, height }: FrameSize,
) -> Rectangle {
    const MARGIN: f64 = 8.0;
    let inner = frame.grown(-MARGIN);
    let left = match position {
        LegendPosition::TopLeft | LegendPosition::BottomLeft | LegendPosition::Left => inner.left,
        LegendPosition::TopRight | LegendPosition::BottomRight | LegendPosition::Right => {
            inner.right - width
        }
        LegendPosition::Top | LegendPosition::Bottom => 0.5 * (inner.left + inner.right - width),
    };
    let top = match position {
        LegendPosition::TopLeft | LegendPosition::TopRight | LegendPosition::Top => inner.top,
        LegendPosition::BottomLeft | LegendPosition::BottomRight | LegendPosition::Bottom => {
            inner.bottom - height
        }
        LegendPosition::Left | LegendPosition::Right => 0.5 * (inner.top + inner.bottom - height),
    };
    Rectangle { left, top, right: left + width, bottom: top + height }
}

/// Draws a box with one entry per row.
pub(super) fn draw_box(
    canvas: &mut Canvas,
    entries: &[LegendEntry],
    area: Rectangle,
    sizes: FontSizes,
) {
    canvas.rectangle(area, Some((PAPER, 0.94)), Some((LEGEND_EDGE, 0.7)));
    let mut top = area.top + PADDING;
    // A hair more than the widest line, which must not break again.
    for entry in set_in_box(entries, area.width() + 0.01, sizes) {
        draw_entry(canvas, &entry, PlotPoint::new(area.left + PADDING, top), sizes);
        top += entry.height(sizes);
    }
}

/// Distributes the entries over rows no wider than `room`.
fn rows(entries: &[LegendEntry], room: f64, sizes: FontSizes) -> Vec<Vec<SetEntry<'_>>> {
    let mut rows: Vec<(f64, Vec<SetEntry>)> = Vec::new();
    for entry in entries.iter().map(|entry| entry.set(room, sizes)) {
        match rows.last_mut() {
            Some((used, row)) if *used + ENTRY_GAP + entry.width <= room => {
                *used += ENTRY_GAP + entry.width;
                row.push(entry);
            }
            _ => rows.push((entry.width, vec![entry])),
        }
    }
    rows.into_iter().map(|(_, row)| row).collect()
}

fn row_height(row: &[SetEntry], sizes: FontSizes) -> f64 {
    row.iter().map(|entry| entry.height(sizes)).fold(0.0, f64::max)
}

/// Height of the entries set in rows.
pub(super) fn rows_height(entries: &[LegendEntry], room: f64, sizes: FontSizes) -> f64 {
    rows(entries, room, sizes).iter().map(|row| row_height(row, sizes)).sum()
}

/// Draws the entries in rows, centred between `left` and `left + room`; rows of one entry each are aligned to the left.
pub(super) fn draw_rows(
    canvas: &mut Canvas,
    entries: &[LegendEntry],
    PlotPoint { x: left, y: top }: PlotPoint,
    room: f64,
    sizes: FontSizes,
) {
    let mut top = top;
    let rows = rows(entries, room, sizes);
    let is_list = rows.len() > 1 && rows.iter().all(|row| row.len() == 1);
    let widest = rows.iter().flatten().map(|entry| entry.width).fold(0.0, f64::max);
    for row in rows {
        let gaps = ENTRY_GAP * row.len().saturating_sub(1) as f64;
        let used = row.iter().map(|entry| entry.width).sum::<f64>() + gaps;
        let used = if is_list { widest } else { used };
        let mut x = left + 0.5 * (room - used).max(0.0);
        for entry in &row {
            draw_entry(canvas, entry, PlotPoint::new(x, top), sizes);
            x += entry.width + ENTRY_GAP;
        }
        top += row_height(&row, sizes);
    }
}

fn draw_entry(
    canvas: &mut Canvas,
    entry: &SetEntry,
    PlotPoint { x: left, y: top }: PlotPoint,
    sizes: FontSizes,
) {
    let size = f64::from(sizes.legend);
    let middle = top + 0.5 * size;
    let half = 0.42 * size;
    let patch = Rectangle {
        left: left + 3.0,
        top: middle - half,
        right: left + SAMPLE - 3.0,
        bottom: middle + half,
    };
    for (number, sample) in entry.samples.iter().enumerate() {
        // Bands of several colours stand side by side.
        let share = patch.width() / entry.samples.len() as f64;
        let part = Rectangle {
            left: patch.left + share * number as f64,
            right: patch.left + share * (number + 1) as f64,
            ..patch
        };
        match sample {
            LegendKey::Stroke(stroke) => {
                let ends =
                    vec![PlotPoint::new(left, middle), PlotPoint::new(left + SAMPLE, middle)];
                canvas.stroke(&path(&[ends], false), stroke);
            }
            LegendKey::Band(colour) => {
                canvas.fill(&marks::outline(part), *colour, band_opacity(*colour));
                canvas.rectangle(part, None, Some((*colour, 0.6)));
            }
            LegendKey::Point(role, marker, diameter) => {
                let at = [PlotPoint::new(left + 0.5 * SAMPLE, middle)];
                marks::markers(canvas, &at, *role, *marker, diameter.max(LEAST_KEY));
            }
            LegendKey::Tint(colour) => {
                canvas.rectangle(patch, Some((*colour, 1.0)), Some((GREY_EDGE, 0.6)));
            }
            LegendKey::Hatch(style) => {
                canvas.fill(&marks::outline(patch), GAP, 1.0);
                canvas.hatch(&marks::outline(patch), FRAME, *style);
                canvas.rectangle(patch, None, Some((FRAME, 0.6)));
            }
            LegendKey::Patch(role, fill) => {
                marks::fill(canvas, &marks::outline(patch), *role, *fill);
                canvas.rectangle(patch, None, Some((role.colour(), 0.6)));
            }
        }
    }
    for (number, line) in entry.lines.iter().enumerate() {
        let below = line_height(sizes) * number as f64;
        let baseline = PlotPoint::new(left + SAMPLE + SAMPLE_GAP, middle + 0.36 * size + below);
        canvas.text(line, baseline, TextStyle::new(sizes.legend, TextAnchor::Start));
    }
}
