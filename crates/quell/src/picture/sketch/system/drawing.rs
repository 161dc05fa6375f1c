//! What is drawn of a system: its bodies, links and their positions.

use quell_numerics::order::descending_by;

use super::body::SketchBody;
use super::grid::BodyGrid;
use super::link::SketchLink;
use crate::study::SystemStudy;

/// What is drawn of a system.
pub(super) struct SystemDrawing<'a> {
    pub(super) study: &'a SystemStudy,
    pub(super) bodies: Vec<SketchBody>,
    pub(super) links: Vec<SketchLink>,
    pub(super) grid: BodyGrid,
}

impl SystemDrawing<'_> {
    /// The body that a coordinate or state belongs to.
    pub(super) fn body_of(&self, coordinate: usize) -> Option<usize> {
        self.bodies.iter().position(|body| body.indices.contains(&coordinate))
    }

    /// The bodies with the largest entry of a row over coordinates or states in each, largest first.
    pub(super) fn touched(&self, row: &[f64]) -> Vec<(usize, f64)> {
        let mut touched: Vec<(usize, f64)> = Vec::new();
        for (coordinate, &factor) in row.iter().enumerate().filter(|(_, factor)| **factor != 0.0) {
            let Some(body) = self.body_of(coordinate) else { continue };
            match touched.iter_mut().find(|(known, _)| *known == body) {
                Some((_, largest)) if factor.abs() > largest.abs() => *largest = factor,
                Some(_) => {}
                None => touched.push((body, factor)),
            }
        }
        descending_by(&mut touched, |one| one.1.abs());
        touched
    }
}
