//! The linear structure: matrices over named coordinates, first-order equations, modes, or a measured frequency response.

use quell_model::system::{MassMatrix, Mechanical, StateSpace, Structure};
use quell_model::units::Quantity;
use quell_numerics::matrix::Matrix;

use super::mass;
use super::numbers::{Keyed, Numbers, Reported, Wanted, missing};
use super::rows::Basis;
use crate::complaint::{Complaint, Fault, Origin};
use crate::study::document::{Node, Table, Value};
use crate::study::reader::Reader;
use crate::study::vocabulary::join;

/// The largest number of coordinates, states or modes.
pub(super) const MOST_COORDINATES: usize = 2000;

/// The prefix of the keys read here.
pub(super) const PREFIX: &str = "system";

/// A structure as far as it could be read.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Body {
    /// The names of rows; known even where a matrix is wrong.
    pub(super) basis: Option<Basis>,
    pub(super) structure: Option<Structure>,
}

/// Reads `coordinates`, `mass`, `damping`, `stiffness` and `force`.
pub(super) fn mechanical(
    reader: &mut Reader,
    numbers: &Numbers,
    table: &Table,
    header: Origin,
) -> Body {
    let Some(names) = names(reader, table, "coordinates") else { return Body::default() };
    let n = names.len();
    let mass = mass::read(reader, numbers, table, header, &names);
    let damping = matrix(reader, numbers, table, "damping", n);
    let stiffness = matrix(reader, numbers, table, "stiffness", n);
    if matches!(stiffness, Ok(None)) {
        let allowed = "a diagonal or rows; 0 for a body without springs";
        missing(reader, join(PREFIX, "stiffness"), header, allowed);
    }
    let basis = Basis::of(names, "coordinate");
    let force = force(reader, numbers, table, &basis);
    let build = || {
        let damping = damping.ok()?.unwrap_or_else(|| Matrix::zeros(n, n));
        let structure = Mechanical::new(basis.names.clone(), mass?, damping, stiffness.ok()??);
        Some(structure.under(force?).into())
    };
    let structure = build();
    Body { structure, basis: Some(basis) }
}

/// Reads `states`, `matrix` and `force`.
pub(super) fn first_order(
    reader: &mut Reader,
    numbers: &Numbers,
    table: &Table,
    header: Origin,
) -> Body {
    let Some(names) = names(reader, table, "states") else { return Body::default() };
    let n = names.len();
    let matrix = matrix(reader, numbers, table, "matrix", n);
    if matches!(matrix, Ok(None)) {
        missing(reader, join(PREFIX, "matrix"), header, format!("{n} rows of {n} numbers"));
    }
    let basis = Basis::of(names, "state");
    let force = force(reader, numbers, table, &basis);
    let build = || Some(StateSpace::new(basis.names.clone(), matrix.ok()??).under(force?).into());
    let structure = build();
    Body { structure, basis: Some(basis) }
}

/// A structure of which only the names are known: one of a measured frequency response.
pub(super) fn of_names(
    reader: &mut Reader,
    numbers: &Numbers,
    table: &Table,
    names: Vec<String>,
) -> Body {
    let n = names.len();
    let zeros = || Matrix::zeros(n, n);
    let structure = Mechanical::new(names.clone(), MassMatrix::identity(n), zeros(), zeros());
    let basis = Basis::of(names, "point");
    let force = force(reader, numbers, table, &basis);
    Body { structure: force.map(|force| structure.under(force).into()), basis: Some(basis) }
}

/// Constant forces; of first-order equations constant rates.
pub(super) fn force(
    reader: &mut Reader,
    numbers: &Numbers,
    table: &Table,
    basis: &Basis,
) -> Option<Vec<f64>> {
    let before = reader.complaints_so_far();
    let found = numbers.array(reader, table, PREFIX, "force", Some(Quantity::Force));
    let Some(Keyed { node, key, twin }) = found else {
        let right = reader.complaints_so_far() == before;
        return right.then(|| vec![0.0; basis.names.len()]);
    };
    let wanted = Wanted { twin, ..Wanted::finite(Some(Quantity::Force)) };
    basis.row(reader, numbers, &key, node, wanted)
}

/// Names of coordinates or states, each once.
fn names(reader: &mut Reader, table: &Table, key: &str) -> Option<Vec<String>> {
    let node = table.get(key)?;
    let key = join(PREFIX, key);
    let Value::List(list) = &node.value else {
        reader.wrong(&key, node, format!("an array of names; got {}", node.kind()));
        return None;
    };
    if list.is_empty() || list.len() > MOST_COORDINATES {
        let allowed = format!("an array of 1 to {MOST_COORDINATES} names; got {}", list.len());
        reader.complain(Complaint::new(Fault::Value, key, node.origin, list.len(), allowed));
        return None;
    }
    let mut names: Vec<String> = Vec::with_capacity(list.len());
    let mut right = true;
    for (index, node) in list.iter().enumerate() {
        let at = format!("{key}[{index}]");
        match &node.value {
            Value::Text(text) if names.contains(text) => {
                reader.wrong(&at, node, "a name that no other coordinate has");
                right = false;
            }
            Value::Text(text) if is_plain_name(text) => names.push(text.clone()),
            _ => {
                reader.wrong(&at, node, NAME);
                right = false;
            }
        }
    }
    right.then_some(names)
}

/// What a name of a coordinate, a component or a contact must be.
pub(super) const NAME: &str = "a name in quotes without the characters . [ ] = ,";

/// Whether a name can be part of a path.
pub(super) fn is_plain_name(name: &str) -> bool {
    !name.trim().is_empty() && name.trim() == name && !name.contains(['.', '[', ']', '=', ','])
}

/// A square matrix of size `n`, if it is given: a diagonal or rows.
pub(super) fn matrix(
    reader: &mut Reader,
    numbers: &Numbers,
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
    let before = reader.complaints_so_far();
    let found = numbers.array(reader, table, PREFIX, name, quantity);
    let Some(Keyed { node, key, twin }) = found else {
        return if reader.complaints_so_far() == before { Ok(None) } else { Err(Reported) };
    };
    let wanted = Wanted { twin, ..Wanted::finite(quantity) };
    let diagonal_allowed = name != "matrix" || n == 1;
    entries(reader, numbers, &key, node, wanted, n, diagonal_allowed).map(Some).ok_or(Reported)
}

fn entries(
    reader: &mut Reader,
    numbers: &Numbers,
    key: &str,
    node: &Node,
    wanted: Wanted,
    n: usize,
    diagonal_allowed: bool,
) -> Option<Matrix> {
    let diagonal =
        if diagonal_allowed { format!("a diagonal of {n} numbers, or ") } else { String::new() };
    let shape = format!("{diagonal}{n} rows of {n} numbers");
    let Value::List(list) = &node.value else {
        reader.wrong(key, node, format!("{shape}; got {}", node.kind()));
        return None;
    };
    let rows = list.iter().filter(|node| matches!(node.value, Value::List(_))).count();
    let is_diagonal = rows == 0 && diagonal_allowed;
    if list.len() != n || (rows > 0 && rows < n) || (rows == 0 && !diagonal_allowed) {
        let got = if rows == 0 { "numbers" } else { "rows" };
        let allowed = format!("{shape}, one for each name; got {} {got}", list.len());
        reader.complain(Complaint::new(Fault::Value, key, node.origin, list.len(), allowed));
        return None;
    }
    let mut matrix = Matrix::zeros(n, n);
    let mut right = true;
    for (i, node) in list.iter().enumerate() {
        if is_diagonal {
            let number = numbers.number(reader, || format!("{key}[{i}]"), node, wanted);
            right &= number.is_some();
            matrix[(i, i)] = number.unwrap_or(f64::NAN);
            continue;
        }
        let Value::List(row) = &node.value else { continue };
        if row.len() != n {
            let allowed = format!("a row of {n} numbers; got {}", row.len());
            let at = format!("{key}[{i}]");
            reader.complain(Complaint::new(Fault::Value, at, node.origin, row.len(), allowed));
            right = false;
            continue;
        }
        for (j, node) in row.iter().enumerate() {
            let number = numbers.number(reader, || format!("{key}[{i}][{j}]"), node, wanted);
            right &= number.is_some();
            matrix[(i, j)] = number.unwrap_or(f64::NAN);
        }
    }
    right.then_some(matrix)
}
