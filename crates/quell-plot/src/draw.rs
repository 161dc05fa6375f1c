//! Drawing: renders a figure and its layout as strokes, fills and texts on a canvas.

use super::arrange::arrange;
use super::axis::Mapping;
use super::canvas::{Canvas, Rectangle, Stroke, TextStyle, path};
use super::envelope::{self, CurveTrace, band_opacity};
use super::figure::{CaptionPlacement, Figure, Panel};
use super::font_sizes::FontSizes;
use super::geometry::PlotPoint;
use super::layer::{Layer, Marker, Orientation, Polyline, ReferenceLine, Region, RegionShape};
use super::layout::{FigureLayout, LABEL_GAP, LegendLayout, NUMBER_GAP, PanelLayout};
use super::obstacles::Obstacles;
use super::palette::{Colour, FAINT, FRAME, PlotRole};
use super::projection::{self, reference_line_ends};
use super::svg::TextAnchor;
use super::typeset::{LINE_HEIGHT, RichText};
use super::{legend, maps, marks, reference_line_labels, thin};

const FRAME_WIDTH: f64 = 0.8;
const MAJOR_TICK: f64 = 4.5;
const MINOR_TICK: f64 = 2.5;

/// Draws a figure and returns its SVG.
pub(super) fn figure(figure: &Figure) -> String {
    let layout = arrange(figure);
    let mut canvas = Canvas::new(layout.width, layout.height);
    if figure.caption_placement == CaptionPlacement::Apart {
        canvas.describe(&figure.plain_caption());
    }
    draw_outer(&mut canvas, &layout);
    for (panel, panel_layout) in figure.panels.iter().zip(&layout.panels) {
        draw_panel(&mut canvas, panel, panel_layout, layout.sizes);
    }
    canvas.into_svg()
}

fn draw_outer(canvas: &mut Canvas, layout: &FigureLayout) {
    let middle = 0.5 * (layout.body.lower + layout.body.upper);
    let size = f64::from(layout.sizes.figure_title);
    for (number, line) in layout.title.iter().enumerate() {
        let baseline = 10.0 + 0.85 * size + 1.35 * size * number as f64;
        let setting = TextStyle {
            bold: true,
            ..TextStyle::new(layout.sizes.figure_title, TextAnchor::Middle)
        };
        // A title wider than the frames is centred between the edges instead.
        let half = 0.5 * line.width(size, true);
        let outermost = (10.0 + half, layout.width - 10.0 - half);
        let middle = if outermost.0 <= outermost.1 {
            middle.clamp(outermost.0, outermost.1)
        } else {
            0.5 * layout.width
        };
        canvas.text(line, PlotPoint::new(middle, baseline), setting);
    }
    let room = layout.body.width();
    legend::draw_rows(
        canvas,
        &layout.shared,
        PlotPoint::new(layout.body.lower, layout.shared_top),
        room,
        layout.sizes,
    );
    let size = f64::from(layout.sizes.caption);
    for (number, line) in layout.caption.iter().enumerate() {
        let baseline = layout.caption_top + 0.9 * size + 1.35 * size * number as f64;
        let setting =
            TextStyle { colour: FAINT, ..TextStyle::new(layout.sizes.caption, TextAnchor::Start) };
        canvas.text(line, PlotPoint::new(10.0, baseline), setting);
    }
}

fn draw_panel(canvas: &mut Canvas, panel: &Panel, layout: &PanelLayout, sizes: FontSizes) {
    let (x, y) = layout.mappings(panel);
    canvas.begin_clip(layout.frame);
    canvas.begin_group("stroke-linejoin=\"round\"");
    for layer in &panel.layers {
        if let Layer::Heatmap(grid) = layer {
            maps::draw_grid(canvas, grid, panel, (&x, &y), layout.frame);
        }
    }
    for layer in &panel.layers {
        if let Layer::Region(region) = layer {
            draw_region(canvas, region, &x, &y, layout.frame);
        }
    }
    for layer in &panel.layers {
        if let Layer::ReferenceLine(rule) = layer {
            let width = rule.role.width();
            let dashes = rule.style.unwrap_or(rule.role.style()).dashes(width);
            let stroke = Stroke { colour: rule.role.colour(), width, dashes };
            let ends = reference_line_ends(rule.orientation, rule.value, &x, &y, layout.frame);
            canvas.stroke(&path(ends.as_slice(), false), &stroke);
        }
    }
    let isolines = maps::Isolines::of(panel, layout, sizes);
    isolines.draw(canvas);
    for layer in &panel.layers {
        if let Layer::Polyline(line) = layer {
            draw_curve(canvas, line, &projection::pixels(&line.pieces, &x, &y, layout.frame));
        }
    }
    canvas.end_group();
    canvas.end_clip();
    draw_frame(canvas, layout, sizes, &x, &y);
    // Markers on the frame must be complete, so points are drawn over the frame and are not clipped.
    for layer in &panel.layers {
        if let Layer::Points(points) = layer {
            let drawn = projection::point_pixels(&points.points, &x, &y, layout.frame);
            marks::markers(canvas, &drawn, points.role, points.marker, points.size);
        }
    }
    if let Some(bar) = &layout.bar {
        bar.draw(canvas, layout.frame, sizes);
    }
    isolines.draw_labels(canvas, sizes);
    draw_texts(canvas, panel, layout, &isolines, sizes);
    match &layout.legend {
        LegendLayout::None => {}
        LegendLayout::Box(area) => legend::draw_box(canvas, &layout.entries, *area, sizes),
        LegendLayout::Above => {
            let (left, room) = layout.legend_span();
            let height = legend::rows_height(&layout.entries, room, sizes);
            let corner = PlotPoint::new(left, layout.frame.top - height - 2.0);
            legend::draw_rows(canvas, &layout.entries, corner, room, sizes);
        }
    }
}

/// Draws a curve: strokes, and bands where it oscillates too fast to be resolved.
fn draw_curve(canvas: &mut Canvas, line: &Polyline, pieces: &[Vec<PlotPoint>]) {
    const EDGE: f64 = 0.6;
    let stroke = legend::stroke_of(line);
    let mut strokes = Vec::new();
    for trace in pieces.iter().flat_map(|piece| envelope::traces(piece)) {
        match trace {
            CurveTrace::Line(points) => strokes.push(points),
            CurveTrace::Band { upper, lower } => {
                let outline: Vec<PlotPoint> =
                    upper.iter().chain(lower.iter().rev()).copied().collect();
                let opacity = band_opacity(stroke.colour);
                canvas.fill(&path(&[outline], true), stroke.colour, opacity);
                let edges = path(&[thin::polyline(&upper), thin::polyline(&lower)], false);
                canvas.stroke(&edges, &Stroke::solid(stroke.colour, EDGE.min(stroke.width)));
            }
        }
    }
    canvas.stroke(&path(&strokes, false), &stroke);
}

fn draw_region(canvas: &mut Canvas, region: &Region, x: &Mapping, y: &Mapping, frame: Rectangle) {
    // An end outside the axis, or one that the axis cannot represent, extends to the frame.
    let strip = |mapping: &Mapping, from: f64, to: f64, low: f64, high: f64| {
        let from = mapping.pixel(from.max(mapping.limits.lower)).unwrap_or(low);
        let to = mapping.pixel(to.min(mapping.limits.upper)).unwrap_or(high);
        (from, to)
    };
    let path = match &region.shape {
        RegionShape::Polygon(corners) => {
            let inside = |&PlotPoint { x: at, y: value }: &PlotPoint| {
                // On a logarithmic axis zero lies infinitely far down.
                let at = x.pixel(at).unwrap_or(frame.left - 10.0);
                PlotPoint::new(at, y.pixel(value).unwrap_or(frame.bottom + 10.0))
            };
            path(&[thin::polyline(&corners.iter().map(inside).collect::<Vec<_>>())], true)
        }
        RegionShape::AcrossX(from, to) => {
            let (left, right) = strip(x, from.min(*to), to.max(*from), frame.left, frame.right);
            if left >= right {
                return;
            }
            marks::outline(Rectangle { left, right, ..frame })
        }
        RegionShape::AcrossY(from, to) => {
            let (bottom, top) = strip(y, from.min(*to), to.max(*from), frame.bottom, frame.top);
            if top >= bottom {
                return;
            }
            marks::outline(Rectangle { top, bottom, ..frame })
        }
    };
    marks::fill(canvas, &path, region.role, region.fill);
}

fn draw_frame(
    canvas: &mut Canvas,
    layout: &PanelLayout,
    sizes: FontSizes,
    x: &Mapping,
    y: &Mapping,
) {
    let frame = layout.frame;
    let mut marks = Vec::new();
    let mut minor_marks = Vec::new();
    let upright = |at: f64, length: f64| {
        [
            vec![PlotPoint::new(at, frame.bottom), PlotPoint::new(at, frame.bottom - length)],
            vec![PlotPoint::new(at, frame.top), PlotPoint::new(at, frame.top + length)],
        ]
    };
    let level = |at: f64, length: f64| {
        [
            vec![PlotPoint::new(frame.left, at), PlotPoint::new(frame.left + length, at)],
            vec![PlotPoint::new(frame.right, at), PlotPoint::new(frame.right - length, at)],
        ]
    };
    for (value, _) in &layout.x_ticks.major {
        marks.extend(x.pixel(*value).map(|at| upright(at, MAJOR_TICK)).into_iter().flatten());
    }
    for (value, _) in &layout.y_ticks.major {
        marks.extend(y.pixel(*value).map(|at| level(at, MAJOR_TICK)).into_iter().flatten());
    }
    for value in &layout.x_ticks.minor {
        minor_marks.extend(x.pixel(*value).map(|at| upright(at, MINOR_TICK)).into_iter().flatten());
    }
    for value in &layout.y_ticks.minor {
        minor_marks.extend(y.pixel(*value).map(|at| level(at, MINOR_TICK)).into_iter().flatten());
    }
    canvas.stroke(&path(&minor_marks, false), &Stroke::solid(FRAME, 0.6));
    canvas.stroke(&path(&marks, false), &Stroke::solid(FRAME, FRAME_WIDTH));
    canvas.rectangle(frame, None, Some((FRAME, FRAME_WIDTH)));
    draw_numbers(canvas, layout, sizes, x, y);
    draw_labels(canvas, layout, sizes);
}

fn draw_numbers(
    canvas: &mut Canvas,
    layout: &PanelLayout,
    sizes: FontSizes,
    x: &Mapping,
    y: &Mapping,
) {
    let frame = layout.frame;
    let size = f64::from(sizes.number);
    if layout.x_numbers {
        for (value, label) in &layout.x_ticks.major {
            let Some(at) = x.pixel(*value) else { continue };
            let baseline = frame.bottom + NUMBER_GAP + 0.76 * size;
            canvas.text(
                label,
                PlotPoint::new(at, baseline),
                TextStyle::new(sizes.number, TextAnchor::Middle),
            );
        }
        if let Some(label) = layout.x_ticks.exponent_label() {
            let below = frame.bottom + NUMBER_GAP + size + LABEL_GAP + 0.8 * f64::from(sizes.label);
            canvas.text(
                &label,
                PlotPoint::new(frame.right, below),
                TextStyle::new(sizes.number, TextAnchor::End),
            );
        }
    }
    if layout.y_numbers {
        for (value, label) in &layout.y_ticks.major {
            let Some(at) = y.pixel(*value) else { continue };
            let position = PlotPoint::new(frame.left - NUMBER_GAP, at + 0.36 * size);
            canvas.text(label, position, TextStyle::new(sizes.number, TextAnchor::End));
        }
        if let Some(label) = layout.y_ticks.exponent_label() {
            let position = PlotPoint::new(frame.left - 2.0, frame.top - 6.0);
            canvas.text(&label, position, TextStyle::new(sizes.number, TextAnchor::End));
        }
    }
}

fn draw_labels(canvas: &mut Canvas, layout: &PanelLayout, sizes: FontSizes) {
    let frame = layout.frame;
    let middle = (0.5 * (frame.left + frame.right), 0.5 * (frame.top + frame.bottom));
    let size = f64::from(sizes.label);
    let setting = TextStyle::new(sizes.label, TextAnchor::Middle);
    let first = frame.bottom + NUMBER_GAP + f64::from(sizes.number) + LABEL_GAP + 0.8 * size;
    for (number, line) in layout.x_label.iter().enumerate() {
        canvas.text(line, PlotPoint::new(middle.0, first + 1.25 * size * number as f64), setting);
    }
    let upwards = setting.rotated(-90.0);
    for (number, line) in layout.y_label.iter().rev().enumerate() {
        let at = frame.left - layout.y_label_distance - 1.25 * size * number as f64;
        canvas.text(line, PlotPoint::new(at, middle.1), upwards);
    }
    let mut baseline = frame.top - 6.0;
    if layout.legend == LegendLayout::Above {
        baseline -= legend::rows_height(&layout.entries, layout.legend_span().1, sizes) + 2.0;
    }
    for line in layout.title.iter().rev() {
        canvas.text(
            line,
            PlotPoint::new(frame.left, baseline),
            TextStyle::new(sizes.title, TextAnchor::Start),
        );
        baseline -= 1.3 * f64::from(sizes.title);
    }
}

fn draw_texts(
    canvas: &mut Canvas,
    panel: &Panel,
    layout: &PanelLayout,
    isolines: &maps::Isolines,
    sizes: FontSizes,
) {
    let (x, y) = layout.mappings(panel);
    let mut obstacles = Obstacles::of(panel, layout, sizes);
    if let LegendLayout::Box(area) = &layout.legend {
        obstacles.add(*area);
    }
    isolines.label_areas().for_each(|area| obstacles.add(area));
    for layer in &panel.layers {
        match layer {
            Layer::Note(note) => {
                let shown = |value: f64, mapping: &Mapping| mapping.limits.contains(value);
                let placed = projection::note_area(note, (&x, &y), layout.frame, sizes);
                let Some((area, lines)) = placed else { continue };
                if shown(note.at.x, &x) && shown(note.at.y, &y) {
                    let colour = note.role.map_or(FRAME, PlotRole::colour);
                    draw_outlined_text(canvas, &lines, area, colour, sizes);
                }
            }
            Layer::ReferenceLine(rule) if !rule.label.is_empty() => {
                if let Some((area, lines)) =
                    reference_line_labels::place(rule, (&x, &y), layout.frame, &obstacles, sizes)
                {
                    obstacles.add(area);
                    draw_outlined_text(canvas, &lines, area, rule_ink(rule), sizes);
                    leader(canvas, panel, rule, area, &x);
                }
            }
            _ => {}
        }
    }
}

/// How much nearer than another line a label is to its own where no dot is needed (pixels).
const LEADER: f64 = 3.0;

/// Ties the label of a vertical line to it by a dot on the line, where another line is as near to the label.
fn leader(canvas: &mut Canvas, panel: &Panel, rule: &ReferenceLine, label: Rectangle, x: &Mapping) {
    if rule.orientation != Orientation::Vertical {
        return;
    }
    let Some(own) = x.pixel(rule.value) else { return };
    let is_right = label.left >= own;
    let near = if is_right { label.left } else { label.right };
    let around = label.grown((near - own).abs() + LEADER);
    let others = panel.layers.iter().filter_map(|layer| match layer {
        Layer::ReferenceLine(other) if other.orientation == Orientation::Vertical => {
            x.pixel(other.value).filter(|at| *at != own)
        }
        _ => None,
    });
    if others.into_iter().any(|at| around.left <= at && at <= around.right) {
        let middle = 0.5 * (label.top + label.bottom);
        let line = path(&[vec![PlotPoint::new(near, middle), PlotPoint::new(own, middle)]], false);
        canvas.stroke(&line, &Stroke::solid(rule_ink(rule), 0.9));
        marks::markers(canvas, &[PlotPoint::new(own, middle)], rule.role, Marker::Disc, 3.0);
    }
}

fn rule_ink(rule: &ReferenceLine) -> Colour {
    if rule.role == PlotRole::Guide { FAINT } else { rule.role.colour() }
}

/// Draws a text into its rectangle, with a white outline that keeps it readable over a curve.
fn draw_outlined_text(
    canvas: &mut Canvas,
    lines: &[RichText],
    area: Rectangle,
    colour: Colour,
    sizes: FontSizes,
) {
    let setting = TextStyle { colour, ..TextStyle::new(sizes.note, TextAnchor::Start) };
    canvas.begin_group(
        "stroke=\"#fff\" stroke-width=\"3\" stroke-opacity=\"0.9\" stroke-linejoin=\"round\" paint-order=\"stroke\"",
    );
    let size = f64::from(sizes.note);
    for (number, line) in lines.iter().rev().enumerate() {
        let baseline = area.bottom - 0.14 * size - LINE_HEIGHT * size * number as f64;
        canvas.text(line, PlotPoint::new(area.left, baseline), setting);
    }
    canvas.end_group();
}
