//! `[disc.load]` and `[[disc.load]]`.

use quell_disc::Load;
use quell_model::parameter::disc::{
    DISC_SPEED, LOAD_ANGLE, LOAD_DAMPING, LOAD_FRICTION, LOAD_MASS, LOAD_RADIUS, LOAD_STIFFNESS,
};

use crate::complaint::{Complaint, Fault, Origin};
use crate::study::mirror::{Node, Table, Value};
use crate::study::reader::{Found, Reader};
use crate::study::vocabulary::Section;

/// A load with what the file says about its place.
#[derive(Clone, Debug)]
pub(super) struct Pad {
    pub(super) load: Load,
    /// Radius over the outer radius.
    pub(super) radius: Option<f64>,
    /// Speed and where it was written.
    pub(super) speed: Option<(f64, Origin)>,
    /// Path of its table.
    pub(super) path: String,
    /// Where its table begins.
    pub(super) origin: Origin,
}

/// Reads every load; none is a free disc.
pub(super) fn read(reader: &mut Reader, disc: &Table) -> Option<Vec<Pad>> {
    let Some(node) = disc.get("load") else { return Some(Vec::new()) };
    let pads: Vec<Option<Pad>> = match &node.value {
        Value::List(list) if list.len() > 1 => list
            .iter()
            .enumerate()
            .map(|(index, node)| one(reader, node, &format!("disc.load[{index}]")))
            .collect(),
        Value::List(list) => list.iter().map(|node| one(reader, node, "disc.load")).collect(),
        _ => vec![one(reader, node, "disc.load")],
    };
    let pads: Vec<Pad> = pads.into_iter().collect::<Option<_>>()?;
    let mut speeds = pads.iter().filter_map(|pad| Some((pad.speed?, &pad.path)));
    if let Some(((first, _), path)) = speeds.next() {
        for ((speed, origin), other) in speeds {
            if speed != first {
                let allowed = format!("{first}, as {path}.speed: the loads turn together");
                let key = format!("{other}.speed");
                reader.complain(Complaint::new(Fault::Conflict, key, origin, speed, allowed));
                return None;
            }
        }
    }
    Some(pads)
}

fn one(reader: &mut Reader, node: &Node, path: &str) -> Option<Pad> {
    let table = reader.table(path, node)?;
    reader.unknown_keys(table, Section::DiscLoad, path, &[]);
    let mut strength = |parameter| reader.optional(table, path, parameter, None).or(0.0);
    let strengths = [LOAD_MASS, LOAD_DAMPING, LOAD_STIFFNESS, LOAD_FRICTION].map(&mut strength);
    let angle = strength(LOAD_ANGLE);
    let mut maybe = |parameter| match reader.optional(table, path, parameter, None) {
        Found::Value(value) => Some(Some(value)),
        Found::Absent => Some(None),
        Found::Wrong => None,
    };
    let (radius, speed) = (maybe(LOAD_RADIUS), maybe(DISC_SPEED));
    let [mass, damping, stiffness, friction] = strengths;
    let origin = table.get("speed").map_or(node.origin, |node| node.origin);
    Some(Pad {
        load: Load::new(mass?, damping?, stiffness?, friction?).at_angle(angle?.to_radians()),
        radius: radius?,
        speed: speed?.map(|speed| (speed, origin)),
        path: path.to_owned(),
        origin: table.get("radius_ratio").map_or(node.origin, |node| node.origin),
    })
}
