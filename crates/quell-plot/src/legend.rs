//! Legends: one entry per label with its keys, in a box or in rows.

use super::axis_limits::AxisLimits;
use super::canvas::{Canvas, Rectangle, Stroke, TextStyle, path};
use super::colouring::{Colouring, Shading, Tint};
use super::figure::{LegendPosition, Panel};
use super::font_sizes::FontSizes;
use super::layer::{Fill, Layer, Marker, Polyline};
use super::map_layers::Heatmap;
use super::marks;
use super::palette::{Colour, FRAME, GAP, LEGEND_EDGE, PAPER, PlotRole};
use super::svg::TextAnchor;
use super::typeset::RichText;
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
    Point(PlotRole, Marker, f64),
    Patch(PlotRole, Fill),
    Tint(Colour),
    Hatch(usize),
}

/// One label with its keys.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LegendEntry {
    text: String,
    label: RichText,
    samples: Vec<LegendKey>,
}

/// The entries of these panels: equal labels share an entry, equal keys are shown once. Layers of which nothing is inside the
/// limits of their panel have no entry.
pub(super) fn entries<'a>(
    panels: impl IntoIterator<Item = (&'a Panel, AxisLimits)>,
) -> Vec<LegendEntry> {
    let mut entries: Vec<LegendEntry> = Vec::new();
    let layers = panels.into_iter().flat_map(|(panel, limits)| {
        panel.layers.iter().filter(move |layer| visibility::is_visible(layer, panel, limits))
    });
    for layer in layers {
        for (text, sample) in samples(layer).into_iter().filter(|(text, _)| !text.is_empty()) {
            match entries.iter_mut().find(|entry| entry.text == text) {
                Some(entry) if entry.samples.contains(&sample) => {}
                Some(entry) => entry.samples.push(sample),
                None => entries.push(LegendEntry {
                    text: text.to_string(),
                    label: RichText::parse(text),
                    samples: vec![sample],
                }),
            }
        }
    }
    entries
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
            .map(|(_, outcome)| tint(outcome))
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

fn width(entry: &LegendEntry, sizes: FontSizes) -> f64 {
    SAMPLE + SAMPLE_GAP + entry.label.width(f64::from(sizes.legend), false)
}

/// Width and height of a box with one entry per row.
pub(super) fn box_size(entries: &[LegendEntry], sizes: FontSizes) -> (f64, f64) {
    let widest = entries.iter().map(|entry| width(entry, sizes)).fold(0.0, f64::max);
    let height = line_height(sizes) * entries.len() as f64 - LINE_GAP;
    (widest + 2.0 * PADDING, height + 2.0 * PADDING)
}

/// The box at a position inside the frame.
pub(super) fn box_at(
    position: LegendPosition,
    frame: Rectangle,
    (width, height): (f64, f64),
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
    for entry in entries {
        draw_entry(canvas, entry, (area.left + PADDING, top), sizes);
        top += line_height(sizes);
    }
}

/// Distributes the entries over rows no wider than `room`.
fn rows(entries: &[LegendEntry], room: f64, sizes: FontSizes) -> Vec<Vec<&LegendEntry>> {
    let mut lines: Vec<(f64, Vec<&LegendEntry>)> = Vec::new();
    for entry in entries {
        let own = width(entry, sizes);
        match lines.last_mut() {
            Some((used, line)) if *used + ENTRY_GAP + own <= room => {
                *used += ENTRY_GAP + own;
                line.push(entry);
            }
            _ => lines.push((own, vec![entry])),
        }
    }
    lines.into_iter().map(|(_, line)| line).collect()
}

/// Height of the entries set in rows.
pub(super) fn lines_height(entries: &[LegendEntry], room: f64, sizes: FontSizes) -> f64 {
    line_height(sizes) * rows(entries, room, sizes).len() as f64
}

/// Draws the entries in rows, each centred between `left` and `left + room`.
pub(super) fn draw_lines(
    canvas: &mut Canvas,
    entries: &[LegendEntry],
    (left, top): (f64, f64),
    room: f64,
    sizes: FontSizes,
) {
    let mut top = top;
    for line in rows(entries, room, sizes) {
        let gaps = ENTRY_GAP * line.len().saturating_sub(1) as f64;
        let used: f64 = line.iter().map(|entry| width(entry, sizes)).sum::<f64>() + gaps;
        let mut x = left + 0.5 * (room - used).max(0.0);
        for entry in line {
            draw_entry(canvas, entry, (x, top), sizes);
            x += width(entry, sizes) + ENTRY_GAP;
        }
        top += line_height(sizes);
    }
}

fn draw_entry(canvas: &mut Canvas, entry: &LegendEntry, (left, top): (f64, f64), sizes: FontSizes) {
    let size = f64::from(sizes.legend);
    let middle = top + 0.5 * size;
    let half = 0.42 * size;
    let patch = Rectangle {
        left: left + 3.0,
        top: middle - half,
        right: left + SAMPLE - 3.0,
        bottom: middle + half,
    };
    for sample in &entry.samples {
        match sample {
            LegendKey::Stroke(stroke) => {
                let ends = vec![(left, middle), (left + SAMPLE, middle)];
                canvas.stroke(&path(&[ends], false), stroke);
            }
            LegendKey::Point(role, marker, diameter) => {
                let at = [(left + 0.5 * SAMPLE, middle)];
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
    let baseline = (left + SAMPLE + SAMPLE_GAP, middle + 0.36 * size);
    canvas.text(&entry.label, baseline, TextStyle::new(sizes.legend, TextAnchor::Start));
}
