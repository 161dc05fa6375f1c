//! Rows over the coordinates: tables of names or arrays.

use std::sync::Arc;

use quell_input::complaint::{Complaint, Fault};
use quell_input::document::{Node, Table, Value};
use quell_input::nearest;
use quell_numerics::matrix::Matrix;

use crate::study::reader::{Reader, WantedNumber};

/// The names over which rows are written.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::study) struct RowBasis {
    /// Names of the coordinates or states: an array has one number for each.
    pub(super) names: Vec<String>,
    /// What a name is.
    pub(super) what: &'static str,
    /// ShapePoints of modal structures: a name of a point stands for its row over the modal coordinates.
    pub(super) points: Option<ShapePoints>,
}

/// A basis that was read once.
#[derive(Clone, Debug)]
pub(super) struct SameBasis(pub(super) Arc<RowBasis>);

impl PartialEq for SameBasis {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// ShapePoints of a structure given by its modes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ShapePoints {
    pub(super) names: Vec<String>,
    /// A row over the modal coordinates for each point.
    pub(super) rows: Matrix,
}

impl RowBasis {
    /// Coordinates or states.
    pub(super) fn of(names: Vec<String>, what: &'static str) -> Self {
        Self { names, what, points: None }
    }

    /// The same names without points: rows that modes do not turn into points, such as an initial state.
    pub(super) fn without_points(&self) -> Self {
        Self { points: None, ..self.clone() }
    }

    /// Reads a row.
    pub(super) fn row(
        &self,
        reader: &mut Reader,
        key: &str,
        node: &Node,
        wanted: WantedNumber,
    ) -> Option<Vec<f64>> {
        match &node.value {
            Value::List(list) => self.array(reader, key, node, list, wanted),
            Value::Table(table) => {
                let mut row = vec![0.0; self.names.len()];
                self.table(reader, key, "", table, wanted, &mut row).then_some(row)
            }
            _ => {
                let allowed = format!(
                    "a table of names, such as {{ {} = 1.0 }}, or an array of {} numbers; got {}",
                    self.candidates().first().copied().unwrap_or("x"),
                    self.names.len(),
                    node.kind()
                );
                reader.wrong(key, node, allowed);
                None
            }
        }
    }

    /// Reads a row that must not vanish.
    pub(super) fn row_not_zero(
        &self,
        reader: &mut Reader,
        key: &str,
        node: &Node,
    ) -> Option<Vec<f64>> {
        let row = self.row(reader, key, node, WantedNumber::finite(None))?;
        if row.iter().all(|entry| *entry == 0.0) {
            let allowed = format!("a row with at least one {} whose number is not 0", self.what);
            reader.wrong(key, node, allowed);
            return None;
        }
        Some(row)
    }

    fn array(
        &self,
        reader: &mut Reader,
        key: &str,
        node: &Node,
        list: &[Node],
        wanted: WantedNumber,
    ) -> Option<Vec<f64>> {
        if list.len() != self.names.len() {
            let allowed = format!(
                "an array of {} numbers, one for each {}; got {}",
                self.names.len(),
                self.what,
                list.len()
            );
            reader.wrong(key, node, allowed);
            return None;
        }
        let row: Vec<Option<f64>> = list
            .iter()
            .enumerate()
            .map(|(index, node)| reader.quantity(|| format!("{key}[{index}]"), node, wanted))
            .collect();
        row.into_iter().collect()
    }

    /// Adds the entries of a table; nested tables are names with a dot, such as `rotor.pad_x`.
    fn table(
        &self,
        reader: &mut Reader,
        key: &str,
        first: &str,
        table: &Table,
        wanted: WantedNumber,
        row: &mut [f64],
    ) -> bool {
        let mut right = true;
        for (name, node) in table.iter() {
            let name = if first.is_empty() { name.to_owned() } else { format!("{first}.{name}") };
            let path = || format!("{key}.{name}");
            if let Value::Table(inner) = &node.value
                && self.starts_a_name(&name)
            {
                right &= self.table(reader, key, &name, inner, wanted, row);
                continue;
            }
            let Some(target) = self.find(&name) else {
                self.unknown(reader, path(), key, &name, node);
                right = false;
                continue;
            };
            let Some(number) = reader.quantity(path, node, wanted) else {
                right = false;
                continue;
            };
            match target {
                Target::Coordinate(index) => row[index] += number,
                Target::Point(point) => {
                    for (entry, of_point) in row.iter_mut().zip(point) {
                        *entry += number * of_point;
                    }
                }
            }
        }
        right
    }

    /// The row of a name, if there is one.
    pub(super) fn named(&self, name: &str) -> Option<Vec<f64>> {
        Some(match self.find(name)? {
            Target::Point(row) => row.to_vec(),
            Target::Coordinate(index) => {
                let mut row = vec![0.0; self.names.len()];
                row[index] = 1.0;
                row
            }
        })
    }

    fn find(&self, name: &str) -> Option<Target<'_>> {
        if let Some(points) = &self.points
            && let Some(index) = points.names.iter().position(|known| known == name)
        {
            return Some(Target::Point(points.rows.row(index)));
        }
        self.names.iter().position(|known| known == name).map(Target::Coordinate)
    }

    fn starts_a_name(&self, first: &str) -> bool {
        self.candidates()
            .iter()
            .any(|name| name.strip_prefix(first).is_some_and(|rest| rest.starts_with('.')))
    }

    /// The names that a row may use.
    pub(super) fn candidates(&self) -> Vec<&str> {
        let of_points = self.points.iter().flat_map(|points| points.names.iter());
        of_points.chain(&self.names).map(String::as_str).collect()
    }

    fn unknown(&self, reader: &mut Reader, path: String, key: &str, name: &str, node: &Node) {
        let names = self.candidates();
        // Rows are meant to name points where there are any.
        let meant = self.points.as_ref().map_or(&self.names, |points| &points.names);
        let nearest = nearest::word(name, meant.iter().map(String::as_str));
        let mut listed = names.iter().take(12).copied().collect::<Vec<_>>().join(", ");
        if names.len() > 12 {
            listed += ", …";
        }
        let complaint = Complaint::new(Fault::Unknown, path, node.origin, node.given(), listed);
        reader.complain(complaint.suggesting(nearest.map(|name| format!("{key}.{name}"))));
    }
}

/// What a name of a row stands for.
enum Target<'b> {
    Coordinate(usize),
    Point(&'b [f64]),
}
