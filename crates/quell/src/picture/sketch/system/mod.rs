//! The sketch of any system: its bodies in rows, springs and dampers between them and to the ground, contacts below the bodies,
//! forces from the side.
//!
//! A body is one coordinate, one state with its equation, or a group: the modes of a component, the points of a measured
//! structure, or everything where the parts are too many to be drawn one by one.

mod bodies;
mod contacts;
mod grid;
mod inputs;
mod key;
mod key_rows;
mod links;

use super::symbols;
use crate::plot::Sketch;
use crate::study::SystemStudy;

use bodies::SketchBody;
use grid::BodyGrid;
use links::SketchLink;

/// What is drawn of a system.
struct SystemDrawing<'a> {
    study: &'a SystemStudy,
    bodies: Vec<SketchBody>,
    links: Vec<SketchLink>,
    grid: BodyGrid,
}

impl SystemDrawing<'_> {
    /// The body that a coordinate or state belongs to.
    fn body_of(&self, coordinate: usize) -> Option<usize> {
        self.bodies.iter().position(|body| body.indices.contains(&coordinate))
    }

    /// The bodies with the largest entry of a row over coordinates or states in each, largest first.
    fn touched(&self, row: &[f64]) -> Vec<(usize, f64)> {
        let mut touched: Vec<(usize, f64)> = Vec::new();
        for (coordinate, &factor) in row.iter().enumerate().filter(|(_, factor)| **factor != 0.0) {
            let Some(body) = self.body_of(coordinate) else { continue };
            match touched.iter_mut().find(|(known, _)| *known == body) {
                Some((_, largest)) if factor.abs() > largest.abs() => *largest = factor,
                Some(_) => {}
                None => touched.push((body, factor)),
            }
        }
        touched.sort_by(|one, other| other.1.abs().total_cmp(&one.1.abs()));
        touched
    }
}

/// Draws a system.
pub(super) fn draw(sheet: Sketch, study: &SystemStudy) -> Sketch {
    let bodies = bodies::of(study, sheet.room());
    let links = links::of(study, &bodies);
    let grid = BodyGrid::new(sheet.room(), study, &bodies, &links);
    let drawing = SystemDrawing { study, bodies, links, grid };
    let sheet = bodies::draw(sheet, &drawing);
    let sheet = links::draw(sheet, &drawing);
    let sheet = contacts::draw(sheet, &drawing);
    let sheet = inputs::draw(sheet, &drawing);
    key::add(sheet, &drawing)
}
