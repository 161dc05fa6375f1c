//! Square matrices: a diagonal, rows, or a file.

use std::sync::Arc;

use quell_input::complaint::{Complaint, Fault};
use quell_input::document::{Node, Table, Value};
use quell_input::files::{Files, WantedFile};
use quell_input::matrix_market::{self, WrongMatrix};
use quell_input::wrong_file::WrongFile;
use quell_model::units::Quantity;
use quell_numerics::matrix::Matrix;

use super::names::PREFIX;
use crate::study::reader::{Keyed, Reader, Reported, WantedNumber};
use crate::study::vocabulary::{KeyUnit, join};

/// A square matrix of size `n`, if it is given: a diagonal, rows or a file.
pub(super) fn matrix(
    reader: &mut Reader,
    table: &Table,
    name: &'static str,
    n: usize,
) -> Result<Option<Matrix>, Reported> {
    let quantity = match name {
        "mass" => Some(Quantity::LoadMass),
        "damping" => Some(Quantity::LoadDamping),
        "stiffness" => Some(Quantity::LoadStiffness),
        _ => None,
    };
    let found = reader.keyed(table, PREFIX, name, quantity)?;
    let Some(Keyed { node, key, unit }) = found else { return Ok(None) };
    let wanted = WantedNumber { unit, ..WantedNumber::finite(quantity) };
    if let Value::Table(given) = &node.value {
        let found = in_file(reader, &key, node, given, n);
        let one = match (quantity, unit) {
            (Some(quantity), KeyUnit::Suffix(_)) => {
                reader.units().in_equations(1.0, quantity, unit)
            }
            _ => None,
        };
        return found.map(|matrix| Some(scaled(matrix, one.unwrap_or(1.0)))).ok_or(Reported);
    }
    let diagonal_allowed = name != "matrix" || n == 1;
    entries(reader, &key, node, wanted, n, diagonal_allowed).map(Some).ok_or(Reported)
}

/// What the file of a matrix must be: at most a dense matrix of the largest number of coordinates, with some twenty characters an
/// entry.
const MATRIX_FILE: WantedFile = WantedFile { what: "a Matrix Market file", largest: 128 };

/// The matrix of `n` rows and columns in a file.
///
/// # Errors
/// Why it cannot be read, or the line that is wrong.
fn entries_in_file(
    files: &mut Files,
    key: &str,
    name: &str,
    n: usize,
) -> Result<Arc<Matrix>, WrongFile<WrongMatrix>> {
    let parse = |text: &str| matrix_market::parse(text, n).map_err(WrongFile::Contents);
    let matrix = files.parsed(key, name, MATRIX_FILE, parse)?;
    if matrix.rows() != n {
        // It was read for another table; the parser says what is wrong here.
        return parse(&files.text(key, name, MATRIX_FILE)?).map(Arc::new);
    }
    Ok(matrix)
}

/// The matrix of a table with the name of a file.
fn in_file(reader: &mut Reader, key: &str, node: &Node, given: &Table, n: usize) -> Option<Matrix> {
    const FILE: &str = "file";
    let Some(name) = given.get(FILE).filter(|_| given.iter().count() == 1) else {
        let allowed = "a table with the key file alone, such as { file = \"matrix.mtx\" }";
        reader.wrong(key, node, allowed);
        return None;
    };
    let key = join(key, FILE);
    let text = reader.text(&key, name)?;
    let found = entries_in_file(reader.files(), &key, &text, n);
    let matrix = reader.in_file((&key, name), &text, found)?;
    Some(Matrix::clone(&matrix))
}

/// A matrix in another unit.
fn scaled(mut matrix: Matrix, factor: f64) -> Matrix {
    if factor != 1.0 {
        for entry in matrix.as_mut_slice() {
            *entry *= factor;
        }
    }
    matrix
}

fn entries(
    reader: &mut Reader,
    key: &str,
    node: &Node,
    wanted: WantedNumber,
    n: usize,
    diagonal_allowed: bool,
) -> Option<Matrix> {
    let diagonal =
        if diagonal_allowed { format!("a diagonal of {n} numbers, or ") } else { String::new() };
    let shape = format!("{diagonal}{n} rows of {n} numbers");
    let Value::List(list) = &node.value else {
        let file = "{ file = \"matrix.mtx\" }";
        reader.wrong(key, node, format!("{shape}, or {file}; got {}", node.kind()));
        return None;
    };
    let rows = list.iter().filter(|node| matches!(node.value, Value::List(_))).count();
    let is_diagonal = rows == 0 && diagonal_allowed;
    if list.len() != n || (rows > 0 && rows < n) || (rows == 0 && !diagonal_allowed) {
        let got = if rows == 0 { "numbers" } else { "rows" };
        let allowed = format!("{shape}, one for each name; got {} {got}", list.len());
        reader.complain(Complaint::new(Fault::Value, key, node.origin, node.given(), allowed));
        return None;
    }
    let mut matrix = Matrix::zeros(n, n);
    let mut right = true;
    for (i, node) in list.iter().enumerate() {
        if is_diagonal {
            let number = reader.quantity(|| format!("{key}[{i}]"), node, wanted);
            right &= number.is_some();
            matrix[(i, i)] = number.unwrap_or(f64::NAN);
            continue;
        }
        let Value::List(row) = &node.value else { continue };
        if row.len() != n {
            let allowed = format!("a row of {n} numbers; got {}", row.len());
            reader.wrong(&format!("{key}[{i}]"), node, allowed);
            right = false;
            continue;
        }
        for (j, node) in row.iter().enumerate() {
            let number = reader.quantity(|| format!("{key}[{i}][{j}]"), node, wanted);
            right &= number.is_some();
            matrix[(i, j)] = number.unwrap_or(f64::NAN);
        }
    }
    right.then_some(matrix)
}
