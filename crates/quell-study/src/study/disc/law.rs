//! `[friction]` of a disc: the law of all loads, whose normal loads are their own.

use quell_input::complaint::{Complaint, Fault, Origin};
use quell_input::document::Table;
use quell_model::Friction;
use quell_model::parameter::disc::{LOAD_HALF_THICKNESS, LOAD_NORMAL};
use serde_json::Value as Json;

use super::body::{self, Body};
use crate::study::friction;
use crate::study::reader::Reader;

/// Reads the law; `Some(None)` where the loads have their friction as a force.
#[expect(clippy::option_option, reason = "invalid, absent, given")]
pub(super) fn read(
    reader: &mut Reader,
    document: &Table,
    body: Option<&Body>,
) -> Option<Option<Friction>> {
    let Some(node) = document.get("friction") else {
        let loads = body.map_or(&[][..], |body| body.loads.as_slice());
        let normal = loads.iter().find_map(|load| Some((LOAD_NORMAL, load.normal_load?)));
        let half = loads.iter().map(|load| load.half_thickness).find(|half| *half != 0.0);
        let half = half.map(|half| (LOAD_HALF_THICKNESS, half));
        let Some((parameter, value)) = normal.or(half) else { return Some(None) };
        let allowed = "only with a table [friction], whose law requires it";
        let key = parameter.path;
        reader.complain(Complaint::new(Fault::Conflict, key, Origin::Whole, value, allowed));
        return None;
    };
    let scales = body.and_then(|body| {
        let first = body.radii.first().copied().flatten();
        body::scales(&body.source, &body.metal).at(first)
    });
    reader.set_disc_scales(scales);
    let law = friction::of_a_disc(reader, node)?;
    if law.bristles().is_some() {
        let allowed = "a law of the slip velocity alone: discs take no law with a state of its own";
        let (key, name) = ("friction.law", law.kind().name());
        reader.complain(Complaint::new(Fault::Value, key, node.origin, name, allowed));
        return None;
    }
    if body.is_some_and(|body| body.loads.is_empty()) {
        let allowed = "only with a load: a free disc has no friction";
        let origin = node.origin;
        reader.complain(Complaint::new(Fault::Conflict, "friction", origin, Json::Null, allowed));
        return None;
    }
    Some(Some(law))
}
