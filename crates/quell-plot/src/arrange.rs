//! Arrangement: computes the positions of the frames, margins and texts of a figure.
//!
//! All frames of a figure have the same size. The left margin of a column fits its widest
//! tick labels; the upper margin of a row fits its tallest title and legend.

use super::axis_limits::{AxisLimits, axis_limits, widen_to_equal_scales};
use super::canvas::Rectangle;
use super::colour_bar::ColourBar;
use super::figure::{CaptionPlacement, Figure, Legend, Panel, SharedLegend, Sharing, Size};
use super::font_sizes::FontSizes;
use super::geometry::{FrameSize, PlotRange};
use super::grid::{FrameGrid, columns_of};
use super::layer::Layer;
use super::layout::{FigureLayout, LABEL_GAP, LegendLayout, NUMBER_GAP, PanelLayout};
use super::legend::{self, LegendEntry, LegendPanel};
use super::obstacles::Obstacles;
use super::ticks::{Room, Ticks};
use super::typeset::{RichText, wrap};

const EDGE: f64 = 10.0;

/// Margins of all columns and rows.
#[derive(Debug, Clone, Default)]
struct Margins {
    left: Vec<f64>,
    right: Vec<f64>,
    top: Vec<f64>,
    bottom: Vec<f64>,
}

/// Space that a figure needs around its frames, across and upright.
fn surroundings(figure: &Figure, columns: usize, frame: FrameSize, sizes: FontSizes) -> FrameSize {
    let (_, margins) = measure(figure, columns, frame, sizes);
    let across: f64 = margins.left.iter().chain(&margins.right).sum();
    let width = across + frame.width * columns as f64;
    let body = PlotRange::new(margins.left[0], width - margins.right[columns - 1]);
    let outer = outer(figure, width, body, frame, sizes);
    let below = match figure.legend {
        SharedLegend::Below => outer.shared_height,
        _ => 0.0,
    };
    let margins: f64 = margins.top.iter().chain(&margins.bottom).sum();
    FrameSize::new(across, margins + outer.head + outer.caption_height + below)
}

/// Arranges a figure.
pub(super) fn arrange(figure: &Figure) -> FigureLayout {
    let FrameGrid { columns, frame, sizes } = FrameGrid::of(figure, surroundings);
    let rows = figure.panels.len().div_ceil(columns).max(1);
    let (mut panels, margins) = measure(figure, columns, frame, sizes);

    let body_left = margins.left.first().copied().unwrap_or(0.0);
    let width = match figure.size {
        Size::Wide(width) => width,
        _ => (margins.left.iter().chain(&margins.right).sum::<f64>()
            + frame.width * columns as f64)
            .ceil(),
    };
    let last_right = margins.right.last().copied().unwrap_or(0.0);
    let body = PlotRange::new(body_left, width - last_right);
    let outer = outer(figure, width, body, frame, sizes);

    let mut top = outer.head;
    for row in 0..rows {
        top += margins.top[row];
        let mut left = 0.0;
        for column in 0..columns {
            left += margins.left[column];
            if let Some(layout) = panels.get_mut(row * columns + column) {
                layout.frame =
                    Rectangle { left, top, right: left + frame.width, bottom: top + frame.height };
                if let LegendLayout::Box(area) = &mut layout.legend {
                    *area = Rectangle {
                        left: area.left + left,
                        top: area.top + top,
                        right: area.right + left,
                        bottom: area.bottom + top,
                    };
                }
            }
            left += frame.width + margins.right[column];
        }
        top += frame.height + margins.bottom[row];
    }
    let shared_top = match figure.legend {
        SharedLegend::Below => top,
        _ => outer.head - outer.shared_height,
    };
    if figure.legend == SharedLegend::Below {
        top += outer.shared_height;
    }
    FigureLayout {
        width,
        height: (top + outer.caption_height).ceil(),
        sizes,
        panels,
        title: outer.title,
        caption: outer.caption,
        caption_top: top,
        shared: outer.shared,
        shared_top,
        body,
    }
}

/// Texts around the panels.
struct Outer {
    title: Vec<RichText>,
    caption: Vec<RichText>,
    shared: Vec<LegendEntry>,
    /// Height of everything above the panels.
    head: f64,
    shared_height: f64,
    caption_height: f64,
}

fn outer(
    figure: &Figure,
    width: f64,
    body: PlotRange,
    frame: FrameSize,
    sizes: FontSizes,
) -> Outer {
    let line = |size: u32| 1.35 * f64::from(size);
    let room = width - 2.0 * EDGE;
    let title = lines(&figure.title, sizes.figure_title, true, room);
    let caption = match figure.caption_placement {
        CaptionPlacement::Below => lines(&figure.caption, sizes.caption, false, room),
        CaptionPlacement::Apart => Vec::new(),
    };
    let shared = match figure.legend {
        SharedLegend::None => Vec::new(),
        SharedLegend::Above | SharedLegend::Below => {
            let limits = axis_limits(figure, columns_of(figure));
            let panels = figure.panels.iter().zip(limits);
            legend::entries(panels.map(|(panel, limits)| LegendPanel { panel, limits, frame }))
        }
    };
    let shared_height = if shared.is_empty() {
        0.0
    } else {
        legend::rows_height(&shared, body.width(), sizes) + 6.0
    };
    let mut head = EDGE + line(sizes.figure_title) * title.len() as f64;
    if figure.legend == SharedLegend::Above {
        head += shared_height;
    }
    let caption_height =
        if caption.is_empty() { 0.0 } else { line(sizes.caption) * caption.len() as f64 + EDGE };
    Outer { title, caption, shared, head, shared_height, caption_height }
}

fn lines(source: &str, size: u32, bold: bool, room: f64) -> Vec<RichText> {
    let lines =
        if source.is_empty() { Vec::new() } else { wrap(source, f64::from(size), bold, room) };
    lines.into_iter().filter(|line| !line.is_empty()).collect()
}

/// Lays out every panel for a frame at the origin, and computes the margins around the frames.
fn measure(
    figure: &Figure,
    columns: usize,
    frame: FrameSize,
    sizes: FontSizes,
) -> (Vec<PanelLayout>, Margins) {
    let count = figure.panels.len();
    let rows = count.div_ceil(columns).max(1);
    let intended = columns_of(figure);
    let mut axis_limits = axis_limits(figure, intended);
    widen_to_equal_scales(figure, &mut axis_limits, frame);
    // Panels in fewer columns than intended have other neighbours, whose limits may differ.
    let shares = |sharing: Sharing| match sharing {
        Sharing::Separate => false,
        Sharing::Aligned => columns == intended,
        Sharing::All => true,
    };
    let mut margins = Margins {
        left: vec![EDGE; columns],
        right: vec![EDGE; columns],
        top: vec![6.0; rows],
        bottom: vec![EDGE; rows],
    };
    let mut layouts: Vec<PanelLayout> = Vec::with_capacity(count);
    for (index, panel) in figure.panels.iter().enumerate() {
        let column = index % columns;
        let x_numbers = !shares(figure.sharing_x) || index + columns >= count;
        let y_numbers = !shares(figure.sharing_y) || column == 0;
        let mut layout =
            lay_out_panel(figure, panel, axis_limits[index], frame, sizes, (x_numbers, y_numbers));
        if columns != intended && layout.title.is_empty() {
            // A panel that has left its column takes the title of that column.
            let head = &figure.panels[index % intended];
            layout.title = lines(&head.title, sizes.title, false, frame.width);
        }
        widen(&mut margins, column, &layout, sizes);
        layouts.push(layout);
    }
    for (index, layout) in layouts.iter_mut().enumerate() {
        let (row, column) = (index / columns, index % columns);
        let overhang = |margin: f64| (margin - EDGE).max(0.0);
        layout.legend_overhang = (overhang(margins.left[column]), overhang(margins.right[column]));
        heighten(&mut margins, row, layout, sizes);
    }
    // The y labels of one column are aligned.
    for column in 0..columns {
        let mine = || (column..count).step_by(columns);
        let widest = mine().map(|index| layouts[index].y_label_distance).fold(0.0, f64::max);
        mine().for_each(|index| layouts[index].y_label_distance = widest);
    }
    (layouts, margins)
}

fn lay_out_panel(
    figure: &Figure,
    panel: &Panel,
    limits: AxisLimits,
    frame: FrameSize,
    sizes: FontSizes,
    (x_numbers, y_numbers): (bool, bool),
) -> PanelLayout {
    let number_size = f64::from(sizes.number);
    let AxisLimits { x: x_limits, y: y_limits } = limits;
    let x_ticks = Ticks::of(&panel.x, x_limits, Room::Across(frame.width, number_size));
    let y_ticks = Ticks::of(&panel.y, y_limits, Room::Upright(frame.height));
    let widest =
        y_ticks.major.iter().map(|(_, label)| label.width(number_size, false)).fold(0.0, f64::max);
    let label = |wanted: bool, text: String, room: f64| {
        if wanted { lines(&text, sizes.label, false, room) } else { Vec::new() }
    };
    // The exponent of x stands at the right of its label, which is centred.
    let label_room = x_ticks.exponent_label().map_or(frame.width + 1.6 * EDGE, |exponent| {
        frame.width - 2.0 * (exponent.width(number_size, false) + 4.0)
    });
    let entries = match (figure.legend, panel.legend) {
        (SharedLegend::None, Legend::Auto | Legend::Inside(_) | Legend::Above) => {
            legend::entries([LegendPanel { panel, limits, frame }])
        }
        _ => Vec::new(),
    };
    let mut layout = PanelLayout {
        frame: Rectangle { left: 0.0, top: 0.0, right: frame.width, bottom: frame.height },
        x_limits,
        y_limits,
        x_ticks,
        y_ticks,
        x_numbers,
        y_numbers,
        x_label: label(x_numbers, panel.x.label(), label_room),
        y_label: label(y_numbers, panel.y.label(), frame.height + 30.0),
        title: lines(&panel.title, sizes.title, false, frame.width),
        y_label_distance: NUMBER_GAP + widest + LABEL_GAP + 0.2 * f64::from(sizes.label),
        entries,
        legend: LegendLayout::None,
        legend_overhang: (0.0, 0.0),
        bar: ColourBar::of(panel, frame.height, sizes),
    };
    if !layout.entries.is_empty() {
        layout.legend = match panel.legend {
            Legend::Inside(position) => {
                let room = layout.frame.width();
                let size = legend::box_size(&layout.entries, room, sizes);
                LegendLayout::Box(legend::box_at(position, layout.frame, size))
            }
            // A heatmap fills the frame.
            Legend::Auto if has_grid(panel) => LegendLayout::Above,
            Legend::Auto => free_position(panel, &layout, sizes),
            Legend::None | Legend::Above => LegendLayout::Above,
        };
    }
    layout
}

fn has_grid(panel: &Panel) -> bool {
    panel.layers.iter().any(|layer| matches!(layer, Layer::Heatmap(_)))
}

/// The first position where the legend covers nothing.
fn free_position(panel: &Panel, layout: &PanelLayout, sizes: FontSizes) -> LegendLayout {
    use super::figure::LegendPosition::{
        Bottom, BottomLeft, BottomRight, Left, Right, Top, TopLeft, TopRight,
    };
    let size = legend::box_size(&layout.entries, f64::INFINITY, sizes);
    let fits =
        size.width <= 0.7 * layout.frame.width() && size.height <= 0.7 * layout.frame.height();
    let obstacles = Obstacles::of(panel, layout, sizes);
    [TopRight, TopLeft, BottomRight, BottomLeft, Right, Left, Top, Bottom]
        .into_iter()
        .map(|position| legend::box_at(position, layout.frame, size))
        .find(|area| fits && obstacles.covered_by(area.grown(3.0)) == 0)
        .map_or(LegendLayout::Above, LegendLayout::Box)
}

/// Widens the margins left and right of a column for this panel.
fn widen(margins: &mut Margins, column: usize, layout: &PanelLayout, sizes: FontSizes) {
    let (number, label) = (f64::from(sizes.number), f64::from(sizes.label));
    let widen = |margin: &mut f64, wanted: f64| *margin = margin.max(wanted);
    let mut left = EDGE;
    if layout.y_numbers {
        left += layout.y_label_distance - LABEL_GAP;
    }
    if !layout.y_label.is_empty() {
        left += LABEL_GAP + 1.25 * label * layout.y_label.len() as f64 - 2.0;
    }
    widen(&mut margins.left[column], left);
    let overhang = |ticks: &Ticks, first: bool| {
        let end = if first { ticks.major.first() } else { ticks.major.last() };
        end.map_or(0.0, |(_, text)| 0.5 * text.width(number, false))
    };
    if layout.x_numbers {
        widen(&mut margins.right[column], overhang(&layout.x_ticks, false) + 4.0);
        widen(&mut margins.left[column], overhang(&layout.x_ticks, true) + 4.0);
    }
    if let Some(bar) = &layout.bar {
        widen(&mut margins.right[column], bar.room(sizes) + EDGE);
    }
}

/// Heightens the margins above and below a row for this panel, whose columns have their widths.
fn heighten(margins: &mut Margins, row: usize, layout: &PanelLayout, sizes: FontSizes) {
    let (number, label) = (f64::from(sizes.number), f64::from(sizes.label));
    let widen = |margin: &mut f64, wanted: f64| *margin = margin.max(wanted);
    let mut top = 6.0 + 1.3 * f64::from(sizes.title) * layout.title.len() as f64;
    if layout.legend == LegendLayout::Above {
        top += legend::rows_height(&layout.entries, layout.legend_span().1, sizes) + 2.0;
    }
    let exponent = layout.bar.as_ref().is_some_and(ColourBar::has_exponent);
    if (layout.y_ticks.exponent != 0 && layout.y_numbers) || exponent {
        top = top.max(number + 8.0);
    }
    widen(&mut margins.top[row], top);
    let mut bottom = EDGE;
    if layout.x_numbers {
        bottom += NUMBER_GAP + number;
    }
    if !layout.x_label.is_empty() || (layout.x_ticks.exponent != 0 && layout.x_numbers) {
        bottom += LABEL_GAP + 1.25 * label * layout.x_label.len().max(1) as f64;
    }
    widen(&mut margins.bottom[row], bottom);
}
