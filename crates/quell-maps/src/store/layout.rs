//! The arrays of a store in terms of Zarr v3: names, shapes, fill values, attributes.
//!
//! A store is a group with one coordinate array per axis and the arrays of the map, which all have the same chunk shape.
//! `dimension_names` relate arrays to axes; consolidated metadata in the group lets a reader open the store in one step.
//! Attributes follow the CF conventions: `long_name`, `units`, `flag_values`, `flag_meanings`, `ancillary_variables`. Nothing
//! that depends on the run (time, threads, machine) is written, so the bytes of a map do not depend on how it was computed.

use std::sync::Arc;

use serde_json::{Map, Value as Json, json};
use zarrs::array::codec::{BytesCodec, Crc32cCodec};
use zarrs::array::{Array, ArrayBuilder, ArrayCreateError, DataType, FillValue, data_type};
use zarrs::metadata::v3::GroupMetadataV3;

use super::identity::StudyTexts;
use crate::cite::{Task, sources_of};
use crate::dataset::readable;
use crate::status::Status;
use crate::sweep::{Content, GridAxis, MISSING, MapArray, Plan};

/// An array that is described and encoded here, and written by the store.
pub(super) type Described = Array<()>;

/// The arrays of a plan.
#[derive(Debug)]
pub(super) struct StoreLayout {
    /// One per axis.
    pub(super) coordinates: Vec<Described>,
    /// One per field of the sheet, in its order.
    pub(super) fields: Vec<Described>,
    /// Sources of the quantities, one per line.
    references: String,
}

impl StoreLayout {
    pub(super) fn new(plan: &Plan) -> Result<Self, ArrayCreateError> {
        let axes = plan.grid().axes();
        let coordinates: Vec<Described> = axes.iter().map(coordinate).collect::<Result<_, _>>()?;
        let fields = plan.sheet().fields().iter().map(|described| field(plan, described));
        let fields: Vec<Described> = fields.collect::<Result<_, _>>()?;
        Ok(Self { coordinates, fields, references: references(plan) })
    }

    /// Metadata of the group as JSON: the study that created the store, and a copy of the metadata of every array.
    pub(super) fn group(&self, begun: &StudyTexts) -> Json {
        let mut attributes = Map::new();
        if let Some(title) = &begun.title {
            attributes.insert("title".into(), title.as_str().into());
        }
        let source = concat!("quell ", env!("CARGO_PKG_VERSION"), " map");
        attributes.insert("source".into(), source.into());
        attributes.insert("quell_version".into(), env!("CARGO_PKG_VERSION").into());
        attributes.insert("study".into(), begun.study.as_str().into());
        attributes.insert("changes".into(), begun.changes.as_str().into());
        attributes.insert("references".into(), self.references.as_str().into());
        let group = GroupMetadataV3::new().with_attributes(attributes);
        let mut group = serde_json::to_value(group).unwrap_or_default();
        let described: Map<String, Json> =
            self.arrays().map(|array| (name(array).to_owned(), metadata(array))).collect();
        group["consolidated_metadata"] =
            json!({ "kind": "inline", "must_understand": false, "metadata": described });
        group
    }

    /// Every array.
    pub(super) fn arrays(&self) -> impl Iterator<Item = &Described> {
        self.coordinates.iter().chain(&self.fields)
    }
}

/// Name of an array inside the group.
pub(super) fn name(array: &Described) -> &str {
    array.path().as_str().trim_start_matches('/')
}

/// Metadata of an array as JSON.
pub(super) fn metadata(array: &Described) -> Json {
    serde_json::to_value(array.metadata()).unwrap_or_default()
}

fn lengths(shape: &[usize]) -> Vec<u64> {
    shape.iter().map(|&length| length as u64).collect()
}

fn describe(
    name: &str,
    (shape, chunk): (&[usize], &[usize]),
    (data_type, fill): (DataType, FillValue),
    dimensions: Vec<String>,
    attributes: Json,
) -> Result<Described, ArrayCreateError> {
    let attributes = match attributes {
        Json::Object(attributes) => attributes,
        _ => Map::new(),
    };
    ArrayBuilder::new(lengths(shape), lengths(chunk), data_type, fill)
        .array_to_bytes_codec(Arc::new(BytesCodec::little()))
        .bytes_to_bytes_codecs(vec![Arc::new(Crc32cCodec::new())])
        .dimension_names(Some(dimensions))
        .attributes(attributes)
        .build(Arc::new(()), &format!("/{name}"))
}

fn coordinate(axis: &GridAxis) -> Result<Described, ArrayCreateError> {
    let length = [axis.values.len()];
    let mut attributes = json!({ "long_name": axis.about, "parameter": axis.path });
    put_unit(&mut attributes, axis.unit);
    let kind = (data_type::float64(), FillValue::from(f64::NAN));
    describe(&axis.name, (&length, &length), kind, vec![axis.name.clone()], attributes)
}

/// Adds a machine-readable unit, and the scale of the numbers.
fn put_unit(attributes: &mut Json, unit: &str) {
    let (unit, scaling) = readable(unit);
    attributes["units"] = unit.into();
    if !scaling.is_empty() {
        attributes["scaling"] = scaling.into();
    }
}

fn field(plan: &Plan, field: &MapArray) -> Result<Described, ArrayCreateError> {
    let mut attributes = json!({ "long_name": field.about });
    if !field.unit.is_empty() {
        put_unit(&mut attributes, &field.unit);
    }
    if let Some(status) = &field.status {
        attributes["ancillary_variables"] = status.as_str().into();
    }
    let kind = match &field.content {
        Content::Numbers => (data_type::float64(), FillValue::from(f64::NAN)),
        Content::Codes(meanings) => {
            let codes: Vec<u8> = meanings.iter().map(|(code, _)| *code).collect();
            let names: Vec<&str> = meanings.iter().map(|(_, name)| *name).collect();
            attributes["flag_values"] = codes.into();
            attributes["flag_meanings"] = names.join(" ").into();
            if field.status.is_none() {
                attributes["comment"] = reasons(meanings).into();
            }
            (data_type::uint8(), FillValue::from(MISSING))
        }
    };
    let chunks = plan.chunks();
    let dimensions = plan.grid().axes().iter().map(|axis| axis.name.clone()).collect();
    let shapes = (chunks.shape(), chunks.chunk_shape());
    describe(&field.name, shapes, kind, dimensions, attributes)
}

/// The meaning of each status code, one per line.
fn reasons(meanings: &[(u8, &str)]) -> String {
    let states = meanings.iter().filter_map(|(code, _)| Status::of_code(*code));
    let lines: Vec<String> =
        states.map(|status| format!("{}: {}", status.name(), status.about())).collect();
    lines.join("\n")
}

/// The sources of the computed quantities, one per line.
fn references(plan: &Plan) -> String {
    let used = |task: Task| plan.quantities().iter().any(|quantity| quantity.task == task);
    let citations = sources_of(plan.grid().study()).citations;
    let cited: Vec<String> = citations
        .iter()
        .filter(|citation| used(citation.task))
        .map(|citation| format!("{}: {}", citation.source.reference(), citation.used))
        .collect();
    cited.join("\n")
}
