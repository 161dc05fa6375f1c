//! Drawing of maps: the image of a field, hatched gaps, isolines with their labels.

use super::axis::{Mapping, PlotAxis};
use super::canvas::{Canvas, Rectangle, Stroke, TextStyle, path};
use super::field::borders;
use super::figure::Panel;
use super::font_sizes::FontSizes;
use super::geometry::PlotPoint;
use super::layer::{Layer, ReferenceLine};
use super::layout::{LegendLayout, PanelLayout};
use super::line_labels::{self, LevelLines, OccupancyMap, PlacedLabel};
use super::map_layers::Heatmap;
use super::palette::{Colour, FRAME, GAP};
use super::projection::{self, reference_line_ends};
use super::raster::raster;
use super::svg::TextAnchor;
use super::{marks, thin};

/// Draws the image of a field and hatches the cells without a value.
pub(super) fn draw_grid(
    canvas: &mut Canvas,
    grid: &Heatmap,
    panel: &Panel,
    (x, y): (&Mapping, &Mapping),
    frame: Rectangle,
) {
    let colour_map = grid.colour_map();
    let image = raster(&grid.field, &colour_map, (&panel.x, &panel.y), (x, y), frame);
    canvas.image(frame, image.address(&colour_map.colours()));
    let gaps = grid.all_gaps();
    if gaps.is_empty() {
        return;
    }
    let columns = ends(&panel.x, grid.field.x(), x);
    let rows = ends(&panel.y, grid.field.y(), y);
    for (style, _, cells) in gaps {
        let outline = marks::union(&cells, &columns, &rows);
        canvas.fill(&outline, GAP, 1.0);
        canvas.hatch(&outline, FRAME, style);
    }
}

/// Both ends of each cell along an axis (pixels).
fn ends(axis: &PlotAxis, values: &[f64], mapping: &Mapping) -> Vec<(f64, f64)> {
    let positions: Vec<f64> = borders(values, axis.scale)
        .into_iter()
        .map(|border| mapping.pixel_of_position(border))
        .collect();
    positions.windows(2).map(|pair| (pair[0], pair[1])).collect()
}

/// The isolines of a panel, ready to draw.
#[derive(Debug, Default)]
pub(super) struct Isolines {
    levels: Vec<LevelLines>,
    /// Colour and width of each level.
    strokes: Vec<(Colour, f64)>,
    placed: Vec<PlacedLabel>,
    size: f64,
}

impl Isolines {
    /// The isolines of all layers, with labels placed clear of everything else.
    pub(super) fn of(panel: &Panel, layout: &PanelLayout, sizes: FontSizes) -> Self {
        let (x, y) = layout.mappings(panel);
        let mut isolines = Self { size: f64::from(sizes.number), ..Self::default() };
        for layer in &panel.layers {
            let Layer::Contours(lines) = layer else {
                continue;
            };
            for (pieces, (_, text)) in lines.lines(&panel.x, &panel.y).iter().zip(&lines.levels) {
                isolines.levels.push(LevelLines {
                    text: super::typeset::RichText::parse(text),
                    pieces: projection::pixels(pieces, &x, &y, layout.frame),
                });
                isolines.strokes.push((lines.role.colour(), lines.width));
            }
        }
        if !isolines.levels.is_empty() {
            let mut occupied = occupied(panel, layout, (&x, &y), sizes);
            isolines.placed = line_labels::place(&isolines.levels, &mut occupied, isolines.size);
        }
        isolines
    }

    /// Draws the lines, interrupted at their labels.
    pub(super) fn draw(&self, canvas: &mut Canvas) {
        for (number, (level, stroke)) in self.levels.iter().zip(&self.strokes).enumerate() {
            let pieces: Vec<_> = line_labels::opened(number, &level.pieces, &self.placed)
                .iter()
                .map(|piece| thin::polyline(piece))
                .collect();
            canvas.stroke(&path(&pieces, false), &Stroke::solid(stroke.0, stroke.1));
        }
    }

    /// Draws the labels, each with a white outline.
    pub(super) fn draw_labels(&self, canvas: &mut Canvas, sizes: FontSizes) {
        if self.placed.is_empty() {
            return;
        }
        canvas.begin_group(
            "stroke=\"#fff\" stroke-width=\"2\" stroke-opacity=\"0.6\" stroke-linejoin=\"round\" paint-order=\"stroke\"",
        );
        for text in &self.placed {
            let (sin, cos) = libm::sincos(text.rotation.to_radians());
            let drop = 0.36 * self.size;
            let position = PlotPoint::new(text.centre.x - drop * sin, text.centre.y + drop * cos);
            let colour = self.strokes[text.level].0;
            let setting = TextStyle {
                colour: if colour == (0, 0, 0) { FRAME } else { colour },
                ..TextStyle::new(sizes.number, TextAnchor::Middle)
            };
            canvas.text(&self.levels[text.level].text, position, setting.rotated(text.rotation));
        }
        canvas.end_group();
    }

    /// Axis-aligned rectangles around the labels.
    pub(super) fn label_areas(&self) -> impl Iterator<Item = Rectangle> {
        self.placed.iter().map(|text| {
            let half = 0.5 * self.levels[text.level].text.width(self.size, false);
            let (sin, cos) = libm::sincos(text.rotation.to_radians());
            let across = half * cos.abs() + 0.5 * self.size * sin.abs();
            let up = half * sin.abs() + 0.5 * self.size * cos.abs();
            Rectangle {
                left: text.centre.x - across,
                top: text.centre.y - up,
                right: text.centre.x + across,
                bottom: text.centre.y + up,
            }
        })
    }
}

/// Everything that labels of isolines must not cover, except the isolines themselves.
fn occupied(
    panel: &Panel,
    layout: &PanelLayout,
    (x, y): (&Mapping, &Mapping),
    sizes: FontSizes,
) -> OccupancyMap {
    let frame = layout.frame;
    let mut occupied = OccupancyMap::new(frame);
    for layer in &panel.layers {
        match layer {
            Layer::Polyline(line) => {
                for piece in projection::pixels(&line.pieces, x, y, frame) {
                    occupied.stroke(&piece);
                }
            }
            Layer::Points(points) => {
                let half = 0.5 * points.size;
                for PlotPoint { x: left, y: top } in
                    projection::point_pixels(&points.points, x, y, frame)
                {
                    let mark = Rectangle { left, top, right: left, bottom: top };
                    occupied.area(mark.grown(half));
                }
            }
            Layer::ReferenceLine(ReferenceLine { orientation, value, .. }) => {
                if let Some(ends) = reference_line_ends(*orientation, *value, x, y, frame) {
                    occupied.stroke(&ends);
                }
            }
            Layer::Note(note) => {
                if let Some(area) = projection::note_area(note, (x, y), frame, sizes) {
                    occupied.area(area.0.grown(1.0));
                }
            }
            Layer::Region(_) | Layer::Heatmap(_) | Layer::Contours(_) => {}
        }
    }
    if let LegendLayout::Box(area) = &layout.legend {
        occupied.area(area.grown(2.0));
    }
    occupied
}
