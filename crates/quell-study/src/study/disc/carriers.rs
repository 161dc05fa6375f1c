//! The pad and the caliper of a load.

use quell_input::complaint::{Complaint, Fault, Origin};
use quell_input::document::Table;
use quell_model::disc::Carrier;
use quell_model::parameter::Parameter;
use quell_model::parameter::disc::{
    CALIPER_DAMPING, CALIPER_MASS, CALIPER_STIFFNESS, PAD_DAMPING, PAD_MASS, PAD_STIFFNESS,
};
use serde_json::Value as Json;

use crate::study::reader::Reader;

/// Reads pad and caliper of a load.
pub(super) fn read(
    reader: &mut Reader,
    table: &Table,
    header: Origin,
    path: &str,
) -> Option<(Option<Carrier>, Option<Carrier>)> {
    let pad = one(reader, table, header, path, &[PAD_MASS, PAD_DAMPING, PAD_STIFFNESS]);
    let of_caliper = [CALIPER_MASS, CALIPER_DAMPING, CALIPER_STIFFNESS];
    let caliper = one(reader, table, header, path, &of_caliper);
    let (pad, caliper) = (pad?, caliper?);
    if caliper.is_some() && pad.is_none() {
        let key = format!("{path}.{}", PAD_MASS.key());
        let allowed = "a pad (pad_mass and pad_stiffness), because a caliper carries one";
        reader.complain(Complaint::new(Fault::Missing, key, header, Json::Null, allowed));
        return None;
    }
    Some((pad, caliper))
}

/// Mass, damper and spring of one body; mass and spring are required where any of the three is given.
#[expect(clippy::option_option, reason = "invalid, absent, given")]
fn one(
    reader: &mut Reader,
    table: &Table,
    header: Origin,
    path: &str,
    names: &[Parameter; 3],
) -> Option<Option<Carrier>> {
    let given = |parameter: &Parameter| {
        table.has(parameter.key()) || parameter.si.iter().any(|twin| table.has(twin.key))
    };
    if !names.iter().any(given) {
        return Some(None);
    }
    let [mass, damping, stiffness] = *names;
    let mass = reader.number(table, path, header, mass);
    let damping = reader.optional(table, path, damping).or(0.0);
    let stiffness = reader.number(table, path, header, stiffness);
    Some(Some(Carrier { mass: mass?, damping: damping?, stiffness: stiffness? }))
}
