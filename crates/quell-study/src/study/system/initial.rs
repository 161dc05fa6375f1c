//! `[system.initial]` and `observe`.

use quell_input::complaint::{Complaint, Fault};
use quell_input::document::Table;
use quell_model::units::Quantity;
use quell_model::{Contact, Structure};

use super::rows::RowBasis;
use crate::study::reader::{Keyed, Reader, Reported, WantedNumber};
use crate::study::vocabulary::Section;
use crate::study::vocabulary::{Choice, join};

/// Where a run begins.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum SystemStart {
    /// Every coordinate and velocity is 0.
    #[default]
    Rest,
    /// Steady sliding without dither.
    Sliding,
    /// The limit cycle without dither.
    Squealing,
    /// The dithered response that continues steady sliding.
    Base,
    /// The whole state: displacements, then velocities, or the states of first-order equations.
    Values(Vec<f64>),
    /// A whole state that the study determines without giving its numbers, such as a small motion.
    Described {
        /// The state.
        state: Vec<f64>,
        /// What it is, after "from".
        words: String,
    },
}

const PREFIX: &str = "system.initial";

/// Reads `[system.initial]`.
pub(super) fn read(
    reader: &mut Reader,
    system: &Table,
    basis: &RowBasis,
    first_order: bool,
) -> Option<SystemStart> {
    let Some(node) = system.get("initial") else { return Some(SystemStart::Rest) };
    let table = reader.table(PREFIX, node)?;
    reader.unknown_keys(table, Section::SystemInitial, PREFIX);
    let given: Vec<&str> = table.iter().map(|(name, _)| name).collect();
    let kinds = ["state", "values", "displacements", "velocities"]
        .map(|kind| given.iter().any(|name| name.starts_with(kind)));
    let exclusive = match kinds {
        [true, true, ..] | [true, _, true, _] | [true, _, _, true] => Some("state"),
        [_, true, true, _] | [_, true, _, true] => Some("values"),
        _ => None,
    };
    if let Some(name) = exclusive
        && let Some(node) = table.get(name)
    {
        let allowed = "give one of state, displacements and velocities, or values";
        let key = join(PREFIX, name);
        reader.complain(Complaint::new(Fault::Conflict, key, node.origin, node.given(), allowed));
        return None;
    }
    if let Some(node) = table.get("state") {
        let name = reader.choice("system.initial.state", node, Choice::SystemState)?;
        return Some(match name {
            "sliding" => SystemStart::Sliding,
            "squealing" => SystemStart::Squealing,
            "base" => SystemStart::Base,
            _ => SystemStart::Rest,
        });
    }
    let basis = basis.without_points();
    if first_order {
        return of_states(reader, table, &basis);
    }
    if let Some(node) = table.get("values") {
        let velocities = basis.names.iter().map(|name| format!("velocity.{name}"));
        let whole = basis.names.iter().cloned().chain(velocities).collect();
        let state = RowBasis::of(whole, "displacement and velocity");
        let wanted = WantedNumber::finite(None);
        let values = state.row(reader, &join(PREFIX, "values"), node, wanted)?;
        return Some(SystemStart::Values(values));
    }
    let mut half = |name: &str, quantity: Quantity| match reader
        .keyed(table, PREFIX, name, Some(quantity))
        .ok()?
    {
        Some(Keyed { node, key, unit }) => {
            let wanted = WantedNumber { unit, ..WantedNumber::finite(Some(quantity)) };
            basis.row(reader, &key, node, wanted)
        }
        None => Some(vec![0.0; basis.names.len()]),
    };
    let displacements = half("displacements", Quantity::Displacement);
    let velocities = half("velocities", Quantity::Velocity);
    let values = [displacements?, velocities?].concat();
    Some(if kinds == [false; 4] { SystemStart::Rest } else { SystemStart::Values(values) })
}

fn of_states(reader: &mut Reader, table: &Table, basis: &RowBasis) -> Option<SystemStart> {
    for name in ["displacements", "velocities"] {
        if let Some(node) = table.get(name) {
            let allowed = "first-order equations have states: give values = { … }";
            let key = join(PREFIX, name);
            let complaint =
                Complaint::new(Fault::Conflict, key, node.origin, node.given(), allowed);
            reader.complain(complaint);
            return None;
        }
    }
    let Some(node) = table.get("values") else { return Some(SystemStart::Rest) };
    let key = join(PREFIX, "values");
    let values = basis.row(reader, &key, node, WantedNumber::finite(None))?;
    Some(SystemStart::Values(values))
}

/// Reads `observe`: a row over the coordinates or states, by default the tangent of the first contact that has one.
pub(super) fn observe(
    reader: &mut Reader,
    system: &Table,
    basis: &RowBasis,
) -> Result<Option<Vec<f64>>, Reported> {
    let Some(node) = system.get("observe") else { return Ok(None) };
    basis.row_not_zero(reader, "system.observe", node).map(Some).ok_or(Reported)
}

/// The row that is observed where the study gives none: a tangent, else a normal, else the first coordinate.
pub(super) fn default_row(contacts: &[Contact], structure: &Structure) -> Vec<f64> {
    let tangent = contacts.iter().find_map(|contact| contact.tangent.clone());
    let normal = || contacts.iter().find_map(|contact| contact.normal.clone());
    let first = || (0..structure.size()).map(|index| f64::from(index == 0)).collect();
    tangent.or_else(normal).unwrap_or_else(first)
}
