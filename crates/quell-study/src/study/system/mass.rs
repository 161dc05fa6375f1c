//! The mass matrix: symmetric and positive definite, or refused with the place.

use quell_input::complaint::{Complaint, Fault, Origin};
use quell_input::document::{Node, Table, Value};
use quell_model::system::MassMatrix;
use quell_numerics::matrix::Matrix;
use serde_json::Value as Json;

use super::matrices::matrix;
use super::names::PREFIX;

use crate::study::reader::Reader;
use crate::study::vocabulary::join;

/// Largest difference of entries that count as equal, relative to the masses of their coordinates.
const SYMMETRIC: f64 = 1e-12;

/// Reads `mass`.
pub(super) fn read(
    reader: &mut Reader,
    table: &Table,
    header: Origin,
    names: &[String],
) -> Option<MassMatrix> {
    let n = names.len();
    let Some(matrix) = matrix(reader, table, "mass", n).ok()? else {
        let allowed = format!("a diagonal of {n} numbers, or {n} rows of {n} numbers");
        reader.missing(join(PREFIX, "mass"), header, allowed);
        return None;
    };
    let (key, node) = ["mass", "mass_kg"]
        .into_iter()
        .find_map(|name| Some((join(PREFIX, name), table.get(name)?)))?;
    if let Err(wrong) = definite(&matrix, names) {
        report(reader, &key, node, &wrong);
        return None;
    }
    if matrix == Matrix::identity(n) {
        return Some(MassMatrix::identity(n));
    }
    Some(MassMatrix::dense(matrix))
}

/// Why a matrix is no mass matrix.
struct WrongMass {
    /// Row and column, where they are known.
    at: (usize, usize),
    allowed: String,
}

/// Reports a wrong mass matrix at its entry.
fn report(reader: &mut Reader, key: &str, whole: &Node, wrong: &WrongMass) {
    let (i, j) = wrong.at;
    let Value::List(list) = &whole.value else {
        // In a file entries count from 1.
        let allowed = format!("{}; at entry ({}, {}) of the file", wrong.allowed, i + 1, j + 1);
        reader.complain(Complaint::new(Fault::Value, key, whole.origin, Json::Null, allowed));
        return;
    };
    let Some(row) = list.get(i) else { return };
    let (at, node) = match &row.value {
        Value::List(entries) => (format!("{key}[{i}][{j}]"), entries.get(j).unwrap_or(row)),
        _ => (format!("{key}[{i}]"), row),
    };
    let (origin, given) = (node.origin, node.given());
    reader.complain(Complaint::new(Fault::Value, at, origin, given, wrong.allowed.as_str()));
}

/// Whether a matrix is symmetric and positive definite: Cholesky's decomposition exists.
fn definite(matrix: &Matrix, names: &[String]) -> Result<(), WrongMass> {
    let n = matrix.rows();
    for i in 0..n {
        if matrix[(i, i)] <= 0.0 {
            let allowed = format!("above 0: the mass of {} must be positive", names[i]);
            return Err(WrongMass { at: (i, i), allowed });
        }
    }
    let mut is_diagonal = true;
    for i in 0..n {
        for j in 0..i {
            let (lower, upper) = (matrix[(i, j)], matrix[(j, i)]);
            is_diagonal &= lower == 0.0 && upper == 0.0;
            let scale = (matrix[(i, i)] * matrix[(j, j)]).sqrt();
            if (lower - upper).abs() > SYMMETRIC * scale {
                let allowed = format!("{upper}, as in [{j}][{i}]: a mass matrix is symmetric");
                return Err(WrongMass { at: (i, j), allowed });
            }
        }
    }
    if is_diagonal {
        return Ok(());
    }
    let mut factor = Matrix::zeros(n, n);
    for i in 0..n {
        for j in 0..=i {
            let known: f64 =
                factor.row(i)[..j].iter().zip(&factor.row(j)[..j]).map(|(a, b)| a * b).sum();
            let rest = matrix[(i, j)] - known;
            if i != j {
                factor[(i, j)] = rest / factor[(j, j)];
                continue;
            }
            // What elimination leaves of a singular matrix is the rounding of its entries.
            if rest <= 4.0 * n as f64 * f64::EPSILON * matrix[(i, i)] {
                let allowed = format!(
                    "such that the mass matrix is positive definite; here it is singular or indefinite: the row of {} \
                     depends on the rows before it, or some motion has no positive kinetic energy",
                    names[i]
                );
                return Err(WrongMass { at: (i, i), allowed });
            }
            factor[(i, i)] = rest.sqrt();
        }
    }
    Ok(())
}
