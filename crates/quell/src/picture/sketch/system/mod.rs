//! The sketch of any system: its bodies in rows, springs and dampers between them and to the ground, contacts below the bodies,
//! forces from the side.
//!
//! A body is one coordinate, one state with its equation, or a group: the modes of a component, the points of a measured
//! structure, or everything where the parts are too many to be drawn one by one.

mod bodies;
mod body;
mod contact_place;
mod contacts;
mod drawing;
mod grid;
mod inputs;
mod key;
mod key_rows;
mod link;
mod links;
mod widths;

use crate::plot::Sketch;
use crate::study::SystemStudy;

use drawing::SystemDrawing;
use grid::BodyGrid;

/// Draws a system.
pub(super) fn draw(sheet: Sketch, study: &SystemStudy) -> Sketch {
    let bodies = body::of(study, sheet.room());
    let links = link::of(study, &bodies);
    let grid = BodyGrid::new(sheet.room(), study, &bodies, &links);
    let drawing = SystemDrawing { study, bodies, links, grid };
    let sheet = bodies::draw(sheet, &drawing);
    let sheet = links::draw(sheet, &drawing);
    let sheet = contacts::draw(sheet, &drawing);
    let sheet = inputs::draw(sheet, &drawing);
    key::add(sheet, &drawing)
}
