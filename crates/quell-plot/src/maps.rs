//! Drawing of maps: the image of a field, hatched gaps, isolines with their numbers.

use kuva::render::render::TextAnchor;

use super::arrange::{LegendPlan, PanelPlan};
use super::axis::{Axis, Mapping};
use super::canvas::{Canvas, Rectangle, Setting, Stroke, path};
use super::draw::{self, Sizes};
use super::field::borders;
use super::figure::Panel;
use super::layer::{Layer, Rule};
use super::line_labels::{self, LevelLines, Occupied, Placed};
use super::map_layers::Grid;
use super::obstacles::rule_ends;
use super::palette::{Colour, FRAME, GAP};
use super::raster::raster;
use super::{marks, thin};

/// Draws the image of a field and hatches what has no value.
pub(super) fn draw_grid(
    canvas: &mut Canvas,
    grid: &Grid,
    panel: &Panel,
    (x, y): (&Mapping, &Mapping),
    frame: Rectangle,
) {
    let paints = grid.paintbox();
    let image = raster(&grid.field, &paints, (&panel.x, &panel.y), (x, y), frame);
    canvas.image(frame, image.address(&paints.inks()));
    let gaps = grid.all_gaps();
    if gaps.is_empty() {
        return;
    }
    let columns = ends(&panel.x, grid.field.x(), x);
    let rows = ends(&panel.y, grid.field.y(), y);
    for (style, _, cells) in gaps {
        let outline = marks::union(&cells, &columns, &rows);
        canvas.fill(outline.clone(), GAP, 1.0);
        canvas.hatch(outline, FRAME, style);
    }
}

/// Pixels of both ends of each cell along an axis.
fn ends(axis: &Axis, values: &[f64], mapping: &Mapping) -> Vec<(f64, f64)> {
    let places: Vec<f64> =
        borders(values, axis.scale).into_iter().map(|border| mapping.place(border)).collect();
    places.windows(2).map(|pair| (pair[0], pair[1])).collect()
}

/// The isolines of a panel, ready to draw.
#[derive(Debug, Default)]
pub(super) struct Isolines {
    levels: Vec<LevelLines>,
    /// Colour and width of each level.
    strokes: Vec<(Colour, f64)>,
    placed: Vec<Placed>,
    size: f64,
}

impl Isolines {
    /// The isolines of all layers, their numbers clear of everything else.
    pub(super) fn of(panel: &Panel, plan: &PanelPlan, sizes: Sizes) -> Self {
        let (x, y) = draw::mappings(panel, plan);
        let mut isolines = Self { size: f64::from(number_size(sizes)), ..Self::default() };
        for layer in &panel.layers {
            let Layer::Contours(lines) = layer else {
                continue;
            };
            for (pieces, (_, text)) in lines.lines(&panel.x, &panel.y).iter().zip(&lines.levels) {
                isolines.levels.push(LevelLines {
                    text: super::typeset::Label::parse(text),
                    pieces: draw::pixels(pieces, &x, &y, plan.frame),
                });
                isolines.strokes.push((lines.role.colour(), lines.width));
            }
        }
        if !isolines.levels.is_empty() {
            let mut occupied = occupied(panel, plan, (&x, &y), sizes);
            isolines.placed = line_labels::place(&isolines.levels, &mut occupied, isolines.size);
        }
        isolines
    }

    /// Strokes the lines, open under their numbers.
    pub(super) fn draw(&self, canvas: &mut Canvas) {
        for (number, (level, stroke)) in self.levels.iter().zip(&self.strokes).enumerate() {
            let pieces: Vec<_> = line_labels::opened(number, &level.pieces, &self.placed)
                .iter()
                .map(|piece| thin::polyline(piece))
                .collect();
            canvas.stroke(path(&pieces, false), &Stroke::solid(stroke.0, stroke.1));
        }
    }

    /// Prints the numbers, each with a rim of paper.
    pub(super) fn print(&self, canvas: &mut Canvas, sizes: Sizes) {
        if self.placed.is_empty() {
            return;
        }
        canvas.begin_group(
            "stroke=\"#fff\" stroke-width=\"2\" stroke-opacity=\"0.6\" stroke-linejoin=\"round\" paint-order=\"stroke\"",
        );
        for text in &self.placed {
            let (sin, cos) = text.turn.to_radians().sin_cos();
            let drop = 0.36 * self.size;
            let place = (text.centre.0 - drop * sin, text.centre.1 + drop * cos);
            let colour = self.strokes[text.level].0;
            let setting = Setting {
                colour: if colour == (0, 0, 0) { FRAME } else { colour },
                ..Setting::new(number_size(sizes), TextAnchor::Middle)
            };
            canvas.text(&self.levels[text.level].text, place, setting.turned(text.turn));
        }
        canvas.end_group();
    }

    /// Upright rectangles around the numbers.
    pub(super) fn texts(&self) -> impl Iterator<Item = Rectangle> {
        self.placed.iter().map(|text| {
            let half = 0.5 * self.levels[text.level].text.width(self.size, false);
            let (sin, cos) = text.turn.to_radians().sin_cos();
            let across = half * cos.abs() + 0.5 * self.size * sin.abs();
            let up = half * sin.abs() + 0.5 * self.size * cos.abs();
            Rectangle {
                left: text.centre.0 - across,
                top: text.centre.1 - up,
                right: text.centre.0 + across,
                bottom: text.centre.1 + up,
            }
        })
    }
}

/// Numbers on lines are a little smaller than those on axes.
fn number_size(sizes: Sizes) -> u32 {
    sizes.number - 1
}

/// What numbers on isolines must not cover: all but the isolines themselves.
fn occupied(
    panel: &Panel,
    plan: &PanelPlan,
    (x, y): (&Mapping, &Mapping),
    sizes: Sizes,
) -> Occupied {
    let frame = plan.frame;
    let mut occupied = Occupied::new(frame);
    for layer in &panel.layers {
        match layer {
            Layer::Line(line) => {
                for piece in draw::pixels(&line.pieces, x, y, frame) {
                    occupied.stroke(&piece);
                }
            }
            Layer::Points(points) => {
                let half = 0.5 * points.size;
                for (left, top) in draw::point_pixels(&points.points, x, y, frame) {
                    let mark = Rectangle { left, top, right: left, bottom: top };
                    occupied.area(mark.grown(half));
                }
            }
            Layer::Rule(Rule { direction, value, .. }) => {
                if let Some(ends) = rule_ends(*direction, *value, x, y, frame) {
                    occupied.stroke(&ends);
                }
            }
            Layer::Note(note) => {
                if let Some(area) = draw::note_area(note, (x, y), frame, sizes) {
                    occupied.area(area.grown(1.0));
                }
            }
            Layer::Region(_) | Layer::Grid(_) | Layer::Contours(_) => {}
        }
    }
    if let LegendPlan::Box(area) = &plan.legend {
        occupied.area(area.grown(2.0));
    }
    occupied
}
