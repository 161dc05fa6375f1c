//! Drawing: a figure and its arrangement become strokes, fills and texts on a canvas.

use kuva::render::render::TextAnchor;

use super::arrange::{LABEL_GAP, LegendPlan, NUMBER_GAP, PanelPlan, Plan, arrange};
use super::axis::Mapping;
use super::canvas::{Canvas, Rectangle, Setting, Stroke, path};
use super::figure::{Figure, Panel};
use super::layer::{Layer, Note, Region, Rule, Shape};
use super::obstacles::{Obstacles, rule_ends};
use super::palette::{Colour, FAINT, FRAME, Role};
use super::typeset::Label;
use super::{legend, maps, marks, rules, thin};

const FRAME_WIDTH: f64 = 0.8;
const MAJOR_TICK: f64 = 4.5;
const MINOR_TICK: f64 = 2.5;

/// Font sizes (pixels).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Sizes {
    pub(super) figure_title: u32,
    pub(super) title: u32,
    pub(super) label: u32,
    pub(super) number: u32,
    pub(super) legend: u32,
    pub(super) note: u32,
    pub(super) caption: u32,
}

impl Sizes {
    /// Sizes that suit a frame this wide.
    pub(super) fn for_frame(width: f64) -> Self {
        if width >= 260.0 {
            Self {
                figure_title: 14,
                title: 12,
                label: 12,
                number: 11,
                legend: 11,
                note: 11,
                caption: 10,
            }
        } else {
            Self {
                figure_title: 13,
                title: 11,
                label: 11,
                number: 10,
                legend: 10,
                note: 10,
                caption: 10,
            }
        }
    }
}

/// Draws a figure.
pub(super) fn figure(figure: &Figure) -> String {
    let plan = arrange(figure);
    let mut canvas = Canvas::new(plan.width, plan.height);
    draw_outer(&mut canvas, &plan);
    for (panel, plan_of) in figure.panels.iter().zip(&plan.panels) {
        draw_panel(&mut canvas, panel, plan_of, plan.sizes);
    }
    canvas.into_svg()
}

fn draw_outer(canvas: &mut Canvas, plan: &Plan) {
    let middle = 0.5 * (plan.body.0 + plan.body.1);
    let size = f64::from(plan.sizes.figure_title);
    for (number, line) in plan.title.iter().enumerate() {
        let baseline = 10.0 + 0.85 * size + 1.35 * size * number as f64;
        let setting =
            Setting { bold: true, ..Setting::new(plan.sizes.figure_title, TextAnchor::Middle) };
        canvas.text(line, (middle, baseline), setting);
    }
    let room = plan.body.1 - plan.body.0;
    legend::draw_lines(canvas, &plan.shared, (plan.body.0, plan.shared_top), room, plan.sizes);
    let size = f64::from(plan.sizes.caption);
    for (number, line) in plan.caption.iter().enumerate() {
        let baseline = plan.caption_top + 0.9 * size + 1.35 * size * number as f64;
        let setting =
            Setting { colour: FAINT, ..Setting::new(plan.sizes.caption, TextAnchor::Start) };
        canvas.text(line, (10.0, baseline), setting);
    }
}

fn draw_panel(canvas: &mut Canvas, panel: &Panel, plan: &PanelPlan, sizes: Sizes) {
    let (x, y) = mappings(panel, plan);
    canvas.begin_clip(plan.frame);
    canvas.begin_group("stroke-linejoin=\"round\"");
    for layer in &panel.layers {
        if let Layer::Grid(grid) = layer {
            maps::draw_grid(canvas, grid, panel, (&x, &y), plan.frame);
        }
    }
    for layer in &panel.layers {
        if let Layer::Region(region) = layer {
            draw_region(canvas, region, &x, &y, plan.frame);
        }
    }
    for layer in &panel.layers {
        if let Layer::Rule(rule) = layer {
            let width = rule.role.width();
            let dashes = rule.style.unwrap_or(rule.role.style()).dashes(width);
            let stroke = Stroke { colour: rule.role.colour(), width, dashes };
            let ends = rule_ends(rule.direction, rule.value, &x, &y, plan.frame);
            canvas.stroke(path(ends.as_slice(), false), &stroke);
        }
    }
    let isolines = maps::Isolines::of(panel, plan, sizes);
    isolines.draw(canvas);
    for layer in &panel.layers {
        if let Layer::Line(line) = layer {
            let pieces = pixels(&line.pieces, &x, &y, plan.frame);
            canvas.stroke(path(&pieces, false), &legend::stroke_of(line));
        }
    }
    canvas.end_group();
    canvas.end_clip();
    draw_frame(canvas, plan, sizes, &x, &y);
    // A point on the frame is whole, so points lie above it and are not clipped.
    for layer in &panel.layers {
        if let Layer::Points(points) = layer {
            let drawn = point_pixels(&points.points, &x, &y, plan.frame);
            marks::markers(canvas, &drawn, points.role, points.marker, points.size);
        }
    }
    if let Some(bar) = &plan.bar {
        bar.draw(canvas, plan.frame, sizes);
    }
    isolines.print(canvas, sizes);
    draw_texts(canvas, panel, plan, &isolines, sizes);
    match &plan.legend {
        LegendPlan::None => {}
        LegendPlan::Box(area) => legend::draw_box(canvas, &plan.entries, *area, sizes),
        LegendPlan::Above => {
            let height = legend::lines_height(&plan.entries, plan.frame.width(), sizes);
            let corner = (plan.frame.left, plan.frame.top - height - 2.0);
            legend::draw_lines(canvas, &plan.entries, corner, plan.frame.width(), sizes);
        }
    }
}

/// The mappings of both axes of a panel.
pub(super) fn mappings(panel: &Panel, plan: &PanelPlan) -> (Mapping, Mapping) {
    let frame = plan.frame;
    (
        Mapping::new(&panel.x, plan.x_stretch, (frame.left, frame.right)),
        Mapping::new(&panel.y, plan.y_stretch, (frame.bottom, frame.top)),
    )
}

/// Pieces of a curve in pixels: without what lies beside the frame, and thinned.
pub(super) fn pixels(
    pieces: &[Vec<(f64, f64)>],
    x: &Mapping,
    y: &Mapping,
    frame: Rectangle,
) -> Vec<Vec<(f64, f64)>> {
    let beside = |point: (f64, f64)| {
        if point.0 < frame.left - 2.0 { -1 } else { i32::from(point.0 > frame.right + 2.0) }
    };
    let mut drawn = Vec::new();
    for piece in pieces {
        let mapped: Vec<Option<(f64, f64)>> =
            piece.iter().map(|&(at, value)| x.pixel(at).zip(y.pixel(value))).collect();
        for run in mapped.split(Option::is_none) {
            let run: Vec<(f64, f64)> = run.iter().copied().flatten().collect();
            let visible = run.chunk_by(|before, after| {
                beside(*before) == 0 || beside(*before) != beside(*after)
            });
            for part in visible {
                if part.len() > 1 || beside(part[0]) == 0 {
                    drawn.push(thin::polyline(part));
                }
            }
        }
    }
    drawn
}

/// Points in pixels: those in the frame, each print once.
pub(super) fn point_pixels(
    points: &[(f64, f64)],
    x: &Mapping,
    y: &Mapping,
    frame: Rectangle,
) -> Vec<(f64, f64)> {
    let inside = |point: &(f64, f64)| {
        point.0 >= frame.left - 0.5
            && point.0 <= frame.right + 0.5
            && point.1 >= frame.top - 0.5
            && point.1 <= frame.bottom + 0.5
    };
    let drawn: Vec<(f64, f64)> = points
        .iter()
        .filter_map(|&(at, value)| x.pixel(at).zip(y.pixel(value)))
        .filter(inside)
        .collect();
    thin::scatter(&drawn)
}

fn draw_region(canvas: &mut Canvas, region: &Region, x: &Mapping, y: &Mapping, frame: Rectangle) {
    // An end outside the axis, or without a place on it, reaches the frame.
    let strip = |mapping: &Mapping, from: f64, to: f64, low: f64, high: f64| {
        let from = mapping.pixel(from.max(mapping.stretch.0)).unwrap_or(low);
        let to = mapping.pixel(to.min(mapping.stretch.1)).unwrap_or(high);
        (from, to)
    };
    let path = match &region.shape {
        Shape::Polygon(corners) => {
            let inside = |&(at, value): &(f64, f64)| {
                // On a logarithmic axis zero lies at the far end.
                let at = x.pixel(at).unwrap_or(frame.left - 10.0);
                let value = y.pixel(value).unwrap_or(frame.bottom + 10.0);
                (at, value)
            };
            path(&[thin::polyline(&corners.iter().map(inside).collect::<Vec<_>>())], true)
        }
        Shape::AcrossX(from, to) => {
            let (left, right) = strip(x, from.min(*to), to.max(*from), frame.left, frame.right);
            if left >= right {
                return;
            }
            marks::outline(Rectangle { left, right, ..frame })
        }
        Shape::AcrossY(from, to) => {
            let (bottom, top) = strip(y, from.min(*to), to.max(*from), frame.bottom, frame.top);
            if top >= bottom {
                return;
            }
            marks::outline(Rectangle { top, bottom, ..frame })
        }
    };
    marks::fill(canvas, path, region.role, region.fill);
}

fn draw_frame(canvas: &mut Canvas, plan: &PanelPlan, sizes: Sizes, x: &Mapping, y: &Mapping) {
    let frame = plan.frame;
    let mut marks = Vec::new();
    let mut minor_marks = Vec::new();
    let upright = |at: f64, length: f64| {
        [
            vec![(at, frame.bottom), (at, frame.bottom - length)],
            vec![(at, frame.top), (at, frame.top + length)],
        ]
    };
    let level = |at: f64, length: f64| {
        [
            vec![(frame.left, at), (frame.left + length, at)],
            vec![(frame.right, at), (frame.right - length, at)],
        ]
    };
    for (value, _) in &plan.x_ticks.major {
        marks.extend(x.pixel(*value).map(|at| upright(at, MAJOR_TICK)).into_iter().flatten());
    }
    for (value, _) in &plan.y_ticks.major {
        marks.extend(y.pixel(*value).map(|at| level(at, MAJOR_TICK)).into_iter().flatten());
    }
    for value in &plan.x_ticks.minor {
        minor_marks.extend(x.pixel(*value).map(|at| upright(at, MINOR_TICK)).into_iter().flatten());
    }
    for value in &plan.y_ticks.minor {
        minor_marks.extend(y.pixel(*value).map(|at| level(at, MINOR_TICK)).into_iter().flatten());
    }
    canvas.stroke(path(&minor_marks, false), &Stroke::solid(FRAME, 0.6));
    canvas.stroke(path(&marks, false), &Stroke::solid(FRAME, FRAME_WIDTH));
    canvas.rectangle(frame, None, Some((FRAME, FRAME_WIDTH)));
    draw_numbers(canvas, plan, sizes, x, y);
    draw_labels(canvas, plan, sizes);
}

fn draw_numbers(canvas: &mut Canvas, plan: &PanelPlan, sizes: Sizes, x: &Mapping, y: &Mapping) {
    let frame = plan.frame;
    let size = f64::from(sizes.number);
    if plan.x_numbers {
        for (value, label) in &plan.x_ticks.major {
            let Some(at) = x.pixel(*value) else { continue };
            let baseline = frame.bottom + NUMBER_GAP + 0.76 * size;
            canvas.text(label, (at, baseline), Setting::new(sizes.number, TextAnchor::Middle));
        }
        if plan.x_ticks.exponent != 0 {
            let below = frame.bottom + NUMBER_GAP + size + LABEL_GAP + 0.8 * f64::from(sizes.label);
            let label = Label::parse(&format!("$×10^{{{}}}$", plan.x_ticks.exponent));
            canvas.text(&label, (frame.right, below), Setting::new(sizes.number, TextAnchor::End));
        }
    }
    if plan.y_numbers {
        for (value, label) in &plan.y_ticks.major {
            let Some(at) = y.pixel(*value) else { continue };
            let place = (frame.left - NUMBER_GAP, at + 0.36 * size);
            canvas.text(label, place, Setting::new(sizes.number, TextAnchor::End));
        }
        if plan.y_ticks.exponent != 0 {
            let label = Label::parse(&format!("$×10^{{{}}}$", plan.y_ticks.exponent));
            let place = (frame.left - 2.0, frame.top - 6.0);
            canvas.text(&label, place, Setting::new(sizes.number, TextAnchor::End));
        }
    }
}

fn draw_labels(canvas: &mut Canvas, plan: &PanelPlan, sizes: Sizes) {
    let frame = plan.frame;
    let middle = (0.5 * (frame.left + frame.right), 0.5 * (frame.top + frame.bottom));
    let size = f64::from(sizes.label);
    let setting = Setting::new(sizes.label, TextAnchor::Middle);
    let first = frame.bottom + NUMBER_GAP + f64::from(sizes.number) + LABEL_GAP + 0.8 * size;
    for (number, line) in plan.x_label.iter().enumerate() {
        canvas.text(line, (middle.0, first + 1.25 * size * number as f64), setting);
    }
    let upwards = setting.turned(-90.0);
    for (number, line) in plan.y_label.iter().rev().enumerate() {
        let at = frame.left - plan.y_label_distance - 1.25 * size * number as f64;
        canvas.text(line, (at, middle.1), upwards);
    }
    let mut baseline = frame.top - 6.0;
    if plan.legend == LegendPlan::Above {
        baseline -= legend::lines_height(&plan.entries, frame.width(), sizes) + 2.0;
    }
    for line in plan.title.iter().rev() {
        canvas.text(line, (frame.left, baseline), Setting::new(sizes.title, TextAnchor::Start));
        baseline -= 1.3 * f64::from(sizes.title);
    }
}

/// The place of a note, moved into the frame if need be; nothing when its point lies on no axis.
pub(super) fn note_area(
    note: &Note,
    (x, y): (&Mapping, &Mapping),
    frame: Rectangle,
    sizes: Sizes,
) -> Option<Rectangle> {
    let at = (x.pixel(note.at.0)?, y.pixel(note.at.1)?);
    let size = f64::from(sizes.note);
    let (width, height) = (Label::parse(&note.text).width(size, false), 0.95 * size);
    let (left, top) = (at.0 - 0.5 * width, at.1 - 0.5 * height);
    let inner = frame.grown(-4.0);
    let left = left.min(inner.right - width).max(inner.left);
    let top = top.min(inner.bottom - height).max(inner.top);
    Some(Rectangle { left, top, right: left + width, bottom: top + height })
}

fn draw_texts(
    canvas: &mut Canvas,
    panel: &Panel,
    plan: &PanelPlan,
    isolines: &maps::Isolines,
    sizes: Sizes,
) {
    let (x, y) = mappings(panel, plan);
    let mut obstacles = Obstacles::of(panel, plan, sizes);
    if let LegendPlan::Box(area) = &plan.legend {
        obstacles.add(*area);
    }
    isolines.texts().for_each(|area| obstacles.add(area));
    for layer in &panel.layers {
        match layer {
            Layer::Note(note) => {
                let shown = |value: f64, mapping: &Mapping| {
                    value >= mapping.stretch.0 && value <= mapping.stretch.1
                };
                let Some(area) = note_area(note, (&x, &y), plan.frame, sizes) else {
                    continue;
                };
                if shown(note.at.0, &x) && shown(note.at.1, &y) {
                    let colour = note.role.map_or(FRAME, Role::colour);
                    print(canvas, &note.text, area, colour, sizes);
                }
            }
            Layer::Rule(rule) if !rule.label.is_empty() => {
                if let Some(area) = rules::place(rule, (&x, &y), plan.frame, &obstacles, sizes) {
                    obstacles.add(area);
                    print(canvas, &rule.label, area, rule_ink(rule), sizes);
                }
            }
            _ => {}
        }
    }
}

fn rule_ink(rule: &Rule) -> Colour {
    if rule.role == Role::Guide { FAINT } else { rule.role.colour() }
}

/// Prints a text into its place, with a rim of paper that keeps it readable on a curve.
fn print(canvas: &mut Canvas, text: &str, area: Rectangle, colour: Colour, sizes: Sizes) {
    let setting = Setting { colour, ..Setting::new(sizes.note, TextAnchor::Start) };
    canvas.begin_group(
        "stroke=\"#fff\" stroke-width=\"2.5\" stroke-opacity=\"0.75\" stroke-linejoin=\"round\" paint-order=\"stroke\"",
    );
    canvas.text(
        &Label::parse(text),
        (area.left, area.bottom - 0.14 * f64::from(sizes.note)),
        setting,
    );
    canvas.end_group();
}
