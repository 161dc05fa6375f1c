//! The linear structure: matrices over named coordinates, first-order equations, modes, or a measured frequency response.

use std::sync::Arc;

use quell_input::complaint::Origin;
use quell_input::document::Table;
use quell_model::system::{MassMatrix, Mechanical, StateSpace, Structure};
use quell_model::units::Quantity;
use quell_numerics::matrix::Matrix;

use super::mass;
use super::matrices::matrix;
use super::names::{PREFIX, names};
use super::rows::RowBasis;
use crate::study::reader::{Keyed, Reader, WantedNumber};
use crate::study::vocabulary::join;

/// A structure as far as it could be read.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ReadStructure {
    /// The names of rows; known even where a matrix is wrong.
    pub(super) basis: Option<Arc<RowBasis>>,
    pub(super) structure: Option<Structure>,
}

/// Reads `coordinates`, `mass`, `damping`, `stiffness` and `force`.
pub(super) fn mechanical(reader: &mut Reader, table: &Table, header: Origin) -> ReadStructure {
    let Some(names) = names(reader, table, "coordinates") else { return ReadStructure::default() };
    let n = names.len();
    let mass = mass::read(reader, table, header, &names);
    let damping = matrix(reader, table, "damping", n);
    let stiffness = matrix(reader, table, "stiffness", n);
    if matches!(stiffness, Ok(None)) {
        let allowed = "a diagonal or rows; 0 for a body without springs";
        reader.missing(join(PREFIX, "stiffness"), header, allowed);
    }
    let basis = RowBasis::of(names, "coordinate");
    let force = force(reader, table, &basis);
    let build = || {
        let damping = damping.ok()?.unwrap_or_else(|| Matrix::zeros(n, n));
        let structure = Mechanical::new(basis.names.clone(), mass?, damping, stiffness.ok()??);
        Some(structure.under(force?).into())
    };
    let structure = build();
    ReadStructure { structure, basis: Some(basis.into()) }
}

/// Reads `states`, `matrix` and `force`.
pub(super) fn first_order(reader: &mut Reader, table: &Table, header: Origin) -> ReadStructure {
    let Some(names) = names(reader, table, "states") else { return ReadStructure::default() };
    let n = names.len();
    let matrix = matrix(reader, table, "matrix", n);
    if matches!(matrix, Ok(None)) {
        reader.missing(join(PREFIX, "matrix"), header, format!("{n} rows of {n} numbers"));
    }
    let basis = RowBasis::of(names, "state");
    let force = force(reader, table, &basis);
    let build = || Some(StateSpace::new(basis.names.clone(), matrix.ok()??).under(force?).into());
    let structure = build();
    ReadStructure { structure, basis: Some(basis.into()) }
}

/// A structure of which only the names are known: one of a measured frequency response.
pub(super) fn of_names(reader: &mut Reader, table: &Table, names: Vec<String>) -> ReadStructure {
    let n = names.len();
    let zeros = || Matrix::zeros(n, n);
    let structure = Mechanical::new(names.clone(), MassMatrix::identity(n), zeros(), zeros());
    let basis = RowBasis::of(names, "point");
    let force = force(reader, table, &basis);
    ReadStructure {
        structure: force.map(|force| structure.under(force).into()),
        basis: Some(basis.into()),
    }
}

/// Constant forces; of first-order equations constant rates.
pub(super) fn force(reader: &mut Reader, table: &Table, basis: &RowBasis) -> Option<Vec<f64>> {
    let quantity = Some(Quantity::Force);
    let Some(Keyed { node, key, unit }) = reader.keyed(table, PREFIX, "force", quantity).ok()?
    else {
        return Some(vec![0.0; basis.names.len()]);
    };
    let wanted = WantedNumber { unit, ..WantedNumber::finite(quantity) };
    basis.row(reader, &key, node, wanted)
}
