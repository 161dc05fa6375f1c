//! Bands of frequencies: that of `[response]`, in which a vibration level is requested, and that of noise.

use quell_input::document::{Node, Table, Value};
use quell_model::parameter::Bounds;
use quell_model::units::Quantity;

use crate::study::reader::{Keyed, Reader, WantedNumber};
use crate::study::vocabulary::Section;

/// Reads `[response]`: the ends of the band in ω₀, `Some(None)` without a band, `None` if it is invalid.
#[expect(clippy::option_option, reason = "invalid, absent, given")]
pub(in crate::study) fn read(reader: &mut Reader, root: &Table) -> Option<Option<[f64; 2]>> {
    let Some(node) = root.get("response") else { return Some(None) };
    let table = reader.table("response", node)?;
    reader.unknown_keys(table, Section::Response, "response");
    given(reader, table, "response", Bounds::NOT_NEGATIVE)
}

/// Reads the key `band` or `band_hz` of a table: the ends in the numbers of the equations, `Some(None)` without a band, `None` if it is
/// invalid.
#[expect(clippy::option_option, reason = "invalid, absent, given")]
pub(in crate::study) fn given(
    reader: &mut Reader,
    table: &Table,
    prefix: &str,
    bounds: Bounds,
) -> Option<Option<[f64; 2]>> {
    let quantity = Some(Quantity::FrequencyRatio);
    let Some(Keyed { node, key, unit }) = reader.keyed(table, prefix, "band", quantity).ok()?
    else {
        return Some(None);
    };
    let ends = match &node.value {
        Value::List(list) => <&[Node; 2]>::try_from(list.as_slice()).ok(),
        _ => None,
    };
    let Some(ends) = ends else {
        reader.wrong(&key, node, "an array of two frequencies, the second above the first");
        return None;
    };
    let wanted = WantedNumber { quantity, bounds, unit };
    let [low, high] = [0, 1]
        .map(|place: usize| reader.quantity(|| format!("{key}[{place}]"), &ends[place], wanted));
    let (low, high) = (low?, high?);
    if low < high {
        return Some(Some([low, high]));
    }
    reader.wrong(&key, node, "two frequencies, the second above the first");
    None
}
