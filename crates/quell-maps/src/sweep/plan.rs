//! The plan of a map: the grid, the quantities, the arrays and the chunks.

use std::any::TypeId;

use super::chunks::{Chunks, points_per_chunk};
use super::grid::Grid;
use super::map_quantity::MapQuantity;
use super::points::{ChunkPoints, Subject};
use super::quantity::SETTLED;
use super::sheet::{Data, Sheet};
use crate::complaint::Complaint;
use crate::study::Study;

/// A map to be computed.
#[derive(Clone, Debug)]
pub struct Plan {
    grid: Grid,
    quantities: Vec<&'static MapQuantity>,
    sheet: Sheet,
    chunks: Chunks,
}

/// Minimum seconds to set up and store a point.
const POINT: f64 = 2e-5;

impl Plan {
    /// A plan for the axes of a study. Any quantity of a steady response adds whether it
    /// has settled.
    ///
    /// # Errors
    /// The complaint of [`Grid::of`]; a quantity whose needs the study does not meet.
    pub fn new(
        study: impl Into<Study>,
        asked: &[&'static MapQuantity],
    ) -> Result<Self, Box<Complaint>> {
        let study = study.into();
        for quantity in asked {
            quantity.accepts(&study)?;
        }
        let grid = Grid::of(&study)?;
        let mut quantities: Vec<&'static MapQuantity> = Vec::new();
        let settled = MapQuantity::named(SETTLED, "--quantity").ok();
        let settled = settled.filter(|_| asked.iter().any(|quantity| quantity.is_of_response()));
        for quantity in asked.iter().copied().chain(settled) {
            if !quantities.contains(&quantity) {
                quantities.push(quantity);
            }
        }
        let corners = grid.corner_studies();
        let subjects = corners.iter().chain([&study]).filter_map(Subject::of);
        let seconds = subjects.map(|subject| seconds(&quantities, &subject)).fold(POINT, f64::max);
        let chunks = Chunks::new(&grid.shape(), points_per_chunk(grid.len(), seconds));
        let sheet = Sheet::new(&study, &quantities);
        Ok(Self { grid, quantities, sheet, chunks })
    }

    /// The points.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The quantities shown.
    pub fn quantities(&self) -> &[&'static MapQuantity] {
        &self.quantities
    }

    /// The arrays.
    pub fn sheet(&self) -> &Sheet {
        &self.sheet
    }

    /// The chunks.
    pub fn chunks(&self) -> &Chunks {
        &self.chunks
    }

    /// Computes chunk `number`: its arrays, over its points in order.
    pub fn compute(&self, number: usize) -> Vec<Data> {
        let points = self.chunks.points(number);
        self.compute_points(points.iter().map(|(_, index)| *index))
    }

    /// Computes some points, by their index in the grid.
    pub fn compute_points(&self, indices: impl Iterator<Item = usize>) -> Vec<Data> {
        let indices: Vec<usize> = indices.collect();
        self.sheet.fill(&ChunkPoints::of(&self.grid, &indices))
    }
}

/// Estimated seconds of a point of these quantities: each computation is done once.
fn seconds(quantities: &[&MapQuantity], subject: &Subject) -> f64 {
    let mut known: Vec<TypeId> = Vec::new();
    let each = quantities.iter().map(|quantity| {
        let computation = (quantity.computation)();
        let is_new = !known.contains(&computation);
        known.push(computation);
        if is_new { (quantity.seconds)(subject) } else { 0.0 }
    });
    POINT + each.sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::status::Status;
    use crate::study::BeltStudy;

    const TEXT: &str = "schema = 1\n[belt]\ndamping_ratio = 0.01\nnormal_load = 0.5\n\
        belt_velocity = 0.1\n[friction]\nlaw = \"decreasing\"\nstatic_coefficient = 0.4\n\
        minimum_coefficient = 0.2\nreference_velocity = 0.2\n[dither]\ndirection = \"normal\"\n\
        waveform = \"sine\"\namplitude = 0.1\nfrequency_ratio = 10\n[solver]\nsettle = 5\n\
        record_periods = 2\n[[sweep]]\nparameter = \"dither.amplitude\"\nvalues = [0.1, 0.45, 0.3]\n\
        [[sweep]]\nparameter = \"belt.normal_load\"\nvalues = [0.48, 0.42, 0.5]\n";

    #[test]
    fn a_point_has_the_same_bits_beside_any_others() {
        let study = BeltStudy::parse(TEXT, &[]).expect("valid");
        let asked: Vec<&MapQuantity> = [
            "residual-vibration",
            "growth",
            "critical-amplitude",
            "dither-stroke",
            "limit-verdict",
        ]
        .iter()
        .map(|name| MapQuantity::named(name, "--quantity").expect("a quantity"))
        .collect();
        let plan = Plan::new(&study, &asked).expect("two axes");
        assert_eq!(plan.quantities().last().map(|last| last.name), Some(SETTLED));
        let all = plan.compute_points(0..plan.grid().len());
        let backwards = plan.compute_points((0..plan.grid().len()).rev());
        let status = plan.sheet().entries()[0].status;
        for point in 0..plan.grid().len() {
            let alone = plan.compute_points(std::iter::once(point));
            for ((array, alone), backwards) in all.iter().zip(&alone).zip(&backwards) {
                assert!(array.same_bits(point, alone, 0));
                assert!(array.same_bits(point, backwards, plan.grid().len() - 1 - point));
            }
        }
        // Dither of 0.45 on a load of 0.42 opens the contact; neighbouring points are unaffected.
        let Data::Codes(states) = &all[status] else {
            panic!("states are codes");
        };
        let invalid = states.iter().map(|code| *code == Status::InvalidStudy.code());
        assert_eq!(invalid.collect::<Vec<_>>(), (0..9).map(|at| at == 4).collect::<Vec<_>>());
    }
}
