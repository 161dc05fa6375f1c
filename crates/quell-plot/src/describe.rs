//! A figure as plain data, with its style resolved: what another renderer needs to draw the same picture.
//!
//! Lengths are pixels of 1/96 inch from the upper left, colours `#rrggbb`, texts as they are typeset here
//! (symbols between dollars). Frames and stretches of axes are those of the picture that is drawn here. The
//! Python package draws figures from this with matplotlib.

use serde_json::{Value as Json, json};

use super::arrange::arrange;
use super::axis::{Axis, Scale};
use super::canvas::Rectangle;
use super::colouring::{Colouring, Spread};
use super::figure::{Figure, Legend, Panel, Place, SharedLegend};
use super::layer::{Direction, Layer, Line, Marker, Note, Points, Region, Rule, Shape};
use super::map_layers::{Contours, Grid};
use super::palette::{Colour, FAINT, FRAME, GAP, LineStyle, Role};

impl Figure {
    /// The figure as plain data.
    pub fn described(&self) -> Json {
        let plan = arrange(self);
        let panels = self.panels.iter().zip(&plan.panels).map(|(panel, planned)| {
            let mut data = described_panel(panel);
            data["x"]["stretch"] = stretch(planned.x_stretch);
            data["y"]["stretch"] = stretch(planned.y_stretch);
            data["x"]["numbered"] = planned.x_numbers.into();
            data["y"]["numbered"] = planned.y_numbers.into();
            data["x"]["labelled"] = (!planned.x_label.is_empty()).into();
            data["y"]["labelled"] = (!planned.y_label.is_empty()).into();
            let Rectangle { left, top, right, bottom } = planned.frame;
            data["frame"] = json!({ "left": left, "top": top, "right": right, "bottom": bottom });
            data
        });
        let panels: Vec<Json> = panels.collect();
        let sizes = plan.sizes;
        json!({
            "title": self.title,
            "caption": self.caption,
            "columns": self.columns,
            "legend": match self.legend {
                SharedLegend::None => "none",
                SharedLegend::Above => "above",
                SharedLegend::Below => "below",
            },
            "width": plan.width,
            "height": plan.height,
            "body": [plan.body.0, plan.body.1],
            "legend_top": plan.shared_top,
            "caption_top": plan.caption_top,
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
    let layers: Vec<Json> = panel.layers.iter().map(layer).collect();
    json!({
        "title": panel.title,
        "x": axis(&panel.x),
        "y": axis(&panel.y),
        "legend": match panel.legend {
            Legend::Auto => "best",
            Legend::None => "none",
            Legend::Above => "above",
            Legend::Inside(place) => match place {
                Place::TopRight => "upper right",
                Place::TopLeft => "upper left",
                Place::BottomRight => "lower right",
                Place::BottomLeft => "lower left",
                Place::Top => "upper center",
                Place::Bottom => "lower center",
                Place::Right => "center right",
                Place::Left => "center left",
            },
        },
        "layers": layers,
    })
}

fn axis(axis: &Axis) -> Json {
    json!({ "label": axis.label(), "log": axis.scale == Scale::Log, "ticks": axis.ticks })
}

fn stretch((lower, upper): (f64, f64)) -> Json {
    json!([lower, upper])
}

fn layer(layer: &Layer) -> Json {
    match layer {
        Layer::Line(it) => line(it),
        Layer::Points(it) => points(it),
        Layer::Region(it) => region(it),
        Layer::Rule(it) => rule(it),
        Layer::Note(it) => note(it),
        Layer::Grid(it) => grid(it),
        Layer::Contours(it) => contours(it),
    }
}

fn line(it: &Line) -> Json {
    let pieces: Vec<Json> = it.pieces.iter().map(|piece| columns(piece)).collect();
    json!({
        "kind": "line",
        "label": it.label,
        "colour": hex(it.role.colour()),
        "width": it.width.unwrap_or(it.role.width()),
        "dashes": dashes(it.style.unwrap_or(it.role.style())),
        "pieces": pieces,
    })
}

fn points(it: &Points) -> Json {
    json!({
        "kind": "points",
        "label": it.label,
        "colour": hex(it.role.colour()),
        "marker": match it.marker {
            Marker::Disc => "disc",
            Marker::Circle => "circle",
            Marker::Cross => "cross",
        },
        "size": it.size,
        "points": columns(&it.points),
    })
}

fn region(it: &Region) -> Json {
    let mut data = json!({
        "kind": "region",
        "label": it.label,
        "colour": hex(it.role.colour()),
        "opacity": it.fill.opacity(),
    });
    match &it.shape {
        Shape::Polygon(corners) => data["polygon"] = columns(corners),
        Shape::AcrossX(from, to) => data["across_x"] = ends(*from, *to),
        Shape::AcrossY(from, to) => data["across_y"] = ends(*from, *to),
    }
    data
}

/// Ends of a strip; null where it reaches the frame.
fn ends(from: f64, to: f64) -> Json {
    json!([from, to])
}

fn rule(it: &Rule) -> Json {
    json!({
        "kind": "rule",
        "label": it.label,
        "colour": hex(it.role.colour()),
        "width": it.role.width(),
        "dashes": dashes(it.style.unwrap_or(it.role.style())),
        "vertical": it.direction == Direction::Vertical,
        "value": it.value,
    })
}

fn note(it: &Note) -> Json {
    json!({
        "kind": "note",
        "text": it.text,
        "at": [it.at.0, it.at.1],
        "colour": hex(it.role.map_or(FRAME, Role::colour)),
    })
}

fn grid(it: &Grid) -> Json {
    let paintbox = it.paintbox();
    let gaps: Vec<Json> = it
        .all_gaps()
        .into_iter()
        .map(|(_, label, cells)| json!({ "label": label, "cells": cells }))
        .collect();
    let colours = match &it.colouring {
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
            json!({
                "shades": shades,
                "range": [paintbox.range.0, paintbox.range.1],
                "spread": spread,
                "below": below,
            })
        }
    };
    json!({
        "kind": "grid",
        "x": it.field.x(),
        "y": it.field.y(),
        "values": it.field.values(),
        "bar": it.bar.as_ref().map(axis),
        "gaps": gaps,
        "colouring": colours,
    })
}

fn contours(it: &Contours) -> Json {
    let levels: Vec<Json> =
        it.levels.iter().map(|(level, text)| json!({ "level": level, "text": text })).collect();
    json!({
        "kind": "contours",
        "label": it.label,
        "colour": hex(it.role.colour()),
        "width": it.width,
        "dashes": dashes(it.role.style()),
        "x": it.field.x(),
        "y": it.field.y(),
        "values": it.field.values(),
        "levels": levels,
    })
}

/// Points as two lists.
fn columns(points: &[(f64, f64)]) -> Json {
    let x: Vec<f64> = points.iter().map(|point| point.0).collect();
    let y: Vec<f64> = points.iter().map(|point| point.1).collect();
    json!([x, y])
}

/// Lengths of dashes and gaps in widths of the line; none of a solid line.
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
    fn every_kind_of_layer_is_told_with_its_style() {
        let field =
            Field::new(vec![0.0, 1.0], vec![0.0, 1.0], vec![Some(1.0), None, Some(3.0), None])
                .expect("a field");
        let panel = Panel::new(Axis::new("time").symbol("τ"), Axis::new("x").log())
            .with(Line::new(Role::Undithered, [(0.0, 1.0), (1.0, 2.0)]).label("without"))
            .with(Points::new(Role::Dithered, [(0.5, 1.5)]))
            .with(Region::across_x(Role::Stable, 0.0, f64::INFINITY))
            .with(Rule::vertical(0.5).label("here"))
            .with(Note::new(0.5, 1.0, "a note"))
            .with(Grid::new(field.clone(), Colouring::Shaded(Shading::default())))
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
