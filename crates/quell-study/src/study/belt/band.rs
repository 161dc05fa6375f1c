//! Bands of frequencies: that of `[response]`, in which a vibration level is requested, and that of noise.

use quell_model::parameter::Bounds;
use quell_model::units::Quantity;

use crate::complaint::{Complaint, Fault};
use crate::study::document::{Node, Table, Value};
use crate::study::reader::Reader;
use crate::study::vocabulary::{Section, join};

/// Reads `[response]`: the ends of the band in ω₀, `Some(None)` without a band, `None` if it is invalid.
#[expect(clippy::option_option, reason = "invalid, absent, given")]
pub(super) fn read(reader: &mut Reader, root: &Table) -> Option<Option<[f64; 2]>> {
    let Some(node) = root.get("response") else { return Some(None) };
    let table = reader.table("response", node)?;
    reader.unknown_keys(table, Section::Response, "response", &[]);
    given(reader, table, "response")
}

/// Reads the key `band` or `band_hz` of a table: the ends in ω₀, `Some(None)` without a band, `None` if it is invalid.
#[expect(clippy::option_option, reason = "invalid, absent, given")]
pub(super) fn given(reader: &mut Reader, table: &Table, prefix: &str) -> Option<Option<[f64; 2]>> {
    let (band, in_si) = (join(prefix, "band"), join(prefix, "band_hz"));
    match (table.get("band"), table.get("band_hz")) {
        (None, None) => Some(None),
        (Some(node), None) => Some(Some(ends(reader, &band, node, "ω₀")?)),
        (None, Some(node)) => in_hertz(reader, node, (&band, &in_si)).map(Some),
        (Some(_), Some(node)) => {
            let allowed = format!("give either {band} or {in_si}, not both");
            let complaint =
                Complaint::new(Fault::Conflict, in_si, node.origin, node.given(), allowed);
            reader.complain(complaint);
            None
        }
    }
}

fn in_hertz(reader: &mut Reader, node: &Node, (band, in_si): (&str, &str)) -> Option<[f64; 2]> {
    if !reader.is_si() {
        let allowed =
            format!("the study is dimensionless, but {in_si} is in SI: use {band}, in ω₀");
        let complaint = Complaint::new(Fault::Mixed, in_si, node.origin, node.given(), allowed);
        reader.complain(complaint.suggesting(Some(band.to_owned())));
        return None;
    }
    let ends = ends(reader, in_si, node, "Hz")?;
    let scales = reader.known_scales()?;
    Some(ends.map(|end| scales.from_si(Quantity::FrequencyRatio, end)))
}

/// Two frequencies in ascending order.
fn ends(reader: &mut Reader, key: &str, node: &Node, unit: &str) -> Option<[f64; 2]> {
    let Value::List(list) = &node.value else {
        let allowed = format!("an array of two frequencies in {unit}, got {}", node.kind());
        reader.wrong(key, node, allowed);
        return None;
    };
    let [low, high] = list.as_slice() else {
        let allowed = format!("two frequencies in {unit}, got {}", list.len());
        reader.wrong(key, node, allowed);
        return None;
    };
    let mut end = |place: usize, node: &Node| {
        reader.within(&format!("{key}[{place}]"), node, Bounds::NOT_NEGATIVE, unit, false)
    };
    let (low, high) = (end(0, low), end(1, high));
    let (low, high) = (low?, high?);
    if low < high {
        return Some([low, high]);
    }
    reader.wrong(key, node, format!("two frequencies in {unit}, the second above the first"));
    None
}
