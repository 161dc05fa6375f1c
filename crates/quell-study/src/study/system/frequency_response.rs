//! A measured frequency response in place of matrices: `frequency_response = "frf.csv"`.
//!
//! Its names are those of points that rows of contacts and dithers use, or `CONTACT.tangent` and `CONTACT.normal`.

use std::sync::Arc;

use quell_input::complaint::{Complaint, Fault};
use quell_input::document::Node;
use quell_input::frequency_response::{self, FrequencyResponse};
use quell_model::Contact;
use quell_model::system::{Input, InputTarget};

use crate::study::reader::Reader;
use crate::study::without_units::WithoutUnits;

/// Path of the file's key.
const KEY: &str = "system.frequency_response";

/// Reads the file of the key.
pub(super) fn read(reader: &mut Reader, node: &Node) -> Option<Arc<FrequencyResponse>> {
    let name = reader.text(KEY, node)?;
    let has_units = reader.units().take_suffixes();
    let found =
        reader.files().parsed(KEY, &name, frequency_response::WANTED, frequency_response::parse);
    let found = reader.in_file((KEY, node), &name, found)?;
    let in_units = if found.in_hertz && !has_units { Err(WithoutUnits::Hertz) } else { Ok(found) };
    reader.in_file((KEY, node), &name, in_units)
}

/// Reports pairs of an output and an input that the contacts and dithers use and the file lacks.
pub(super) fn check_pairs(
    reader: &mut Reader,
    node: &Node,
    response: &FrequencyResponse,
    contacts: &[Contact],
    inputs: &[Input],
) {
    let used = |rows: Vec<&Vec<f64>>| -> Vec<usize> {
        let is_used = |index: &usize| rows.iter().any(|row| row[*index] != 0.0);
        (0..response.names.len()).filter(is_used).collect()
    };
    let acting = contacts.iter().flat_map(|contact| contact.tangent.iter().chain(&contact.normal));
    let slopes = contacts.iter().flat_map(|contact| &contact.slope);
    let forces = inputs.iter().filter_map(|input| match &input.target {
        InputTarget::Force(row) => Some(row),
        _ => None,
    });
    let outputs = used(acting.clone().chain(slopes).collect());
    let inputs = used(acting.chain(forces).collect());
    for &output in &outputs {
        for &input in &inputs {
            if response.receptance(output, input).is_none() {
                let allowed = format!(
                    "a file with the response of {} to a force at {}, which the contacts need",
                    response.names[output], response.names[input]
                );
                let given = node.given();
                reader.complain(Complaint::new(Fault::Path, KEY, node.origin, given, allowed));
                return;
            }
        }
    }
}
