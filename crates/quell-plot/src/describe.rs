//! A figure as plain data with its style resolved, from which another renderer can draw the same figure.
//!
//! Lengths are pixels of 1/96 inch from the upper left, colours are `#rrggbb`, and texts use the syntax of this crate
//! (symbols between dollars). Frames and axis limits are those of the figure that this crate draws. The
//! Python package draws figures from this data with matplotlib.

use super::geometry::{PlotPoint, PlotRange};
use serde_json::{Value as Json, json};

use super::arrange::arrange;
use super::axis::{PlotAxis, Scale};
use super::canvas::Rectangle;
use super::colouring::{Colouring, Spread};
use super::figure::{CaptionPlacement, Figure, Legend, LegendPosition, Panel, SharedLegend};
use super::layer::{
    Layer, Marker, Note, Orientation, Points, Polyline, ReferenceLine, Region, RegionShape,
};
use super::map_layers::{Contours, Heatmap};
use super::palette::{Colour, FAINT, FRAME, GAP, LineStyle, PlotRole};

impl Figure {
    /// The figure as plain data.
    pub fn described(&self) -> Json {
        let layout = arrange(self);
        let panels = self.panels.iter().zip(&layout.panels).map(|(panel, panel_layout)| {
            let mut data = described_panel(panel);
            data["x"]["stretch"] = limits(panel_layout.x_limits);
            data["y"]["stretch"] = limits(panel_layout.y_limits);
            data["x"]["numbered"] = panel_layout.x_numbers.into();
            data["y"]["numbered"] = panel_layout.y_numbers.into();
            data["x"]["labelled"] = (!panel_layout.x_label.is_empty()).into();
            data["y"]["labelled"] = (!panel_layout.y_label.is_empty()).into();
            let Rectangle { left, top, right, bottom } = panel_layout.frame;
            data["frame"] = json!({ "left": left, "top": top, "right": right, "bottom": bottom });
            data
        });
        let panels: Vec<Json> = panels.collect();
        let sizes = layout.sizes;
        json!({
            "title": self.title,
            "caption": match self.caption_placement {
                CaptionPlacement::Below => self.caption.as_str(),
                CaptionPlacement::Apart => "",
            },
            "columns": self.columns,
            "legend": match self.legend {
                SharedLegend::None => "none",
                SharedLegend::Above => "above",
                SharedLegend::Below => "below",
            },
            "width": layout.width,
            "height": layout.height,
            "body": [layout.body.lower, layout.body.upper],
            "legend_top": layout.shared_top,
            "caption_top": layout.caption_top,
            "sizes": {
                "figure_title": sizes.figure_title,
                "title": sizes.title,
                "label": sizes.label,
                "number": sizes.number,
                "legend": sizes.legend,
                "note": sizes.note,
                "caption": sizes.caption,
            },
            "colours": { "frame": hex(FRAME), "faint": hex(FAINT), "gap": hex(GAP) },
            "panels": panels,
        })
    }
}

fn described_panel(panel: &Panel) -> Json {
    let layers: Vec<Json> = panel.layers.iter().map(described_layer).collect();
    json!({
        "title": panel.title,
        "x": described_axis(&panel.x),
        "y": described_axis(&panel.y),
        "legend": match panel.legend {
            Legend::Auto => "best",
            Legend::None => "none",
            Legend::Above => "above",
            Legend::Inside(position) => match position {
                LegendPosition::TopRight => "upper right",
                LegendPosition::TopLeft => "upper left",
                LegendPosition::BottomRight => "lower right",
                LegendPosition::BottomLeft => "lower left",
                LegendPosition::Top => "upper center",
                LegendPosition::Bottom => "lower center",
                LegendPosition::Right => "center right",
                LegendPosition::Left => "center left",
            },
        },
        "layers": layers,
    })
}

fn described_axis(axis: &PlotAxis) -> Json {
    json!({ "label": axis.label(), "log": axis.scale == Scale::Log, "ticks": axis.ticks })
}

fn limits(PlotRange { lower, upper }: PlotRange) -> Json {
    json!([lower, upper])
}

fn described_layer(layer: &Layer) -> Json {
    match layer {
        Layer::Polyline(polyline) => described_polyline(polyline),
        Layer::Points(points) => described_points(points),
        Layer::Region(region) => described_region(region),
        Layer::ReferenceLine(line) => described_reference_line(line),
        Layer::Note(note) => described_note(note),
        Layer::Heatmap(heatmap) => described_heatmap(heatmap),
        Layer::Contours(contours) => described_contours(contours),
    }
}

fn described_polyline(polyline: &Polyline) -> Json {
    let pieces: Vec<Json> = polyline.pieces.iter().map(|piece| columns(piece)).collect();
    json!({
        "kind": "line",
        "label": polyline.label,
        "colour": hex(polyline.role.colour()),
        "width": polyline.width.unwrap_or(polyline.role.width()),
        "dashes": dashes(polyline.style.unwrap_or(polyline.role.style())),
        "pieces": pieces,
    })
}

fn described_points(points: &Points) -> Json {
    json!({
        "kind": "points",
        "label": points.label,
        "colour": hex(points.role.colour()),
        "marker": match points.marker {
            Marker::Disc => "disc",
            Marker::Circle => "circle",
            Marker::Cross => "cross",
        },
        "size": points.size,
        "points": columns(&points.points),
    })
}

fn described_region(region: &Region) -> Json {
    let mut data = json!({
        "kind": "region",
        "label": region.label,
        "colour": hex(region.role.colour()),
        "opacity": region.fill.opacity(region.role),
    });
    match &region.shape {
        RegionShape::Polygon(corners) => data["polygon"] = columns(corners),
        RegionShape::AcrossX(from, to) => data["across_x"] = ends(*from, *to),
        RegionShape::AcrossY(from, to) => data["across_y"] = ends(*from, *to),
    }
    data
}

/// Ends of a strip; null where it extends to the frame.
fn ends(from: f64, to: f64) -> Json {
    json!([from, to])
}

fn described_reference_line(line: &ReferenceLine) -> Json {
    json!({
        "kind": "rule",
        "label": line.label,
        "colour": hex(line.role.colour()),
        "width": line.role.width(),
        "dashes": dashes(line.style.unwrap_or(line.role.style())),
        "vertical": line.orientation == Orientation::Vertical,
        "value": line.value,
    })
}

fn described_note(note: &Note) -> Json {
    json!({
        "kind": "note",
        "text": note.text,
        "at": [note.at.x, note.at.y],
        "colour": hex(note.role.map_or(FRAME, PlotRole::colour)),
    })
}

fn described_heatmap(heatmap: &Heatmap) -> Json {
    let colour_map = heatmap.colour_map();
    let gaps: Vec<Json> = heatmap
        .all_gaps()
        .into_iter()
        .map(|(_, label, cells)| json!({ "label": label, "cells": cells }))
        .collect();
    let colours = match &heatmap.colouring {
        Colouring::Outcomes(outcomes) => {
            let outcomes: Vec<Json> = outcomes
                .iter()
                .map(|outcome| json!({ "label": outcome.label, "colour": hex(outcome.colour()) }))
                .collect();
            json!({ "outcomes": outcomes })
        }
        Colouring::Shaded(shading) => {
            let shades: Vec<String> = shading.palette.shades(256).into_iter().map(hex).collect();
            let spread = match shading.spread {
                Spread::Linear => json!("linear"),
                Spread::Log => json!("log"),
                Spread::SignedLog(size) => json!({ "signed_log": size }),
            };
            let below = shading.below.as_ref().map(|(limit, under)| {
                json!({ "limit": limit, "label": under.label, "colour": hex(under.colour()) })
            });
            let signs = shading.sign_keys().map(|key| {
                key.map(|(label, colour)| json!({ "label": label, "colour": hex(colour) }))
            });
            json!({
                "signs": signs,
                "shades": shades,
                "range": [colour_map.range.lower, colour_map.range.upper],
                "spread": spread,
                "below": below,
            })
        }
    };
    json!({
        "kind": "grid",
        "x": heatmap.field.x(),
        "y": heatmap.field.y(),
        "values": heatmap.field.values(),
        "bar": heatmap.bar.as_ref().map(described_axis),
        "gaps": gaps,
        "colouring": colours,
    })
}

fn described_contours(contours: &Contours) -> Json {
    let levels: Vec<Json> = contours
        .levels
        .iter()
        .map(|(level, text)| json!({ "level": level, "text": text }))
        .collect();
    json!({
        "kind": "contours",
        "label": contours.label,
        "colour": hex(contours.role.colour()),
        "width": contours.width,
        "dashes": dashes(contours.role.style()),
        "x": contours.field.x(),
        "y": contours.field.y(),
        "values": contours.field.values(),
        "levels": levels,
    })
}

/// Points as a list of x and a list of y.
fn columns(points: &[PlotPoint]) -> Json {
    let x: Vec<f64> = points.iter().map(|point| point.x).collect();
    let y: Vec<f64> = points.iter().map(|point| point.y).collect();
    json!([x, y])
}

/// Lengths of dashes and gaps in line widths; empty for a solid line.
fn dashes(style: LineStyle) -> Vec<f64> {
    style.pattern().to_vec()
}

fn hex((red, green, blue): Colour) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Field, Shading};

    #[test]
    fn every_kind_of_layer_is_described_with_its_style() {
        let field =
            Field::new(vec![0.0, 1.0], vec![0.0, 1.0], vec![Some(1.0), None, Some(3.0), None])
                .expect("a field");
        let panel = Panel::new(PlotAxis::new("time").symbol("τ"), PlotAxis::new("x").log())
            .with(
                Polyline::new(
                    PlotRole::Undithered,
                    [PlotPoint::new(0.0, 1.0), PlotPoint::new(1.0, 2.0)],
                )
                .label("without"),
            )
            .with(Points::new(PlotRole::Dithered, [PlotPoint::new(0.5, 1.5)]))
            .with(Region::across_x(PlotRole::Stable, 0.0, f64::INFINITY))
            .with(ReferenceLine::vertical(0.5).label("here"))
            .with(Note::new(0.5, 1.0, "a note"))
            .with(Heatmap::new(field.clone(), Colouring::Shaded(Shading::default())))
            .with(Contours::new(field, [2.0]));
        let data = Figure::single(panel).title("all").described();
        let layers = data["panels"][0]["layers"].as_array().expect("layers");
        let kinds: Vec<&str> = layers.iter().filter_map(|layer| layer["kind"].as_str()).collect();
        assert_eq!(kinds, ["line", "points", "region", "rule", "note", "grid", "contours"]);
        assert_eq!(layers[0]["colour"], "#808080");
        assert!(!layers[0]["dashes"].as_array().expect("dashes").is_empty());
        assert!(layers[2]["across_x"][1].is_null());
        assert_eq!(layers[5]["gaps"][0]["cells"], json!([false, true, false, true]));
        assert_eq!(layers[5]["colouring"]["shades"].as_array().map(Vec::len), Some(256));
        assert_eq!(data["panels"][0]["x"]["label"], "time $τ$");
        assert_eq!(data["panels"][0]["y"]["log"], true);
    }
}
