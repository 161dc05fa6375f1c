//! `[disc.load]` and `[[disc.load]]`.

use quell_input::complaint::{Complaint, Fault, Origin};
use quell_input::document::{Node, Table, Value};
use quell_model::disc::Load;
use quell_model::parameter::disc::{
    DISC_SPEED, LOAD_ANGLE, LOAD_DAMPING, LOAD_DITHER_PHASE, LOAD_FRICTION, LOAD_HALF_THICKNESS,
    LOAD_MASS, LOAD_NORMAL, LOAD_RADIUS, LOAD_SLIP_RATIO, LOAD_STATIC, LOAD_STIFFNESS,
};
use quell_model::units::{DiscScales, Quantity, measure};

use super::carriers;
use super::patch::PatchSize;
use crate::study::course::CoursePlace;
use crate::study::reader::{Reader, WantedNumber};
use crate::study::vocabulary::{KeyUnit, LOAD_ENVELOPE, Section, join};

/// The table of the speed over time.
pub(super) const DRIVE: &str = "drive";

/// Scales that convert the numbers of loads to SI, each at its own radius.
#[derive(Clone, Copy, Debug)]
pub(super) struct LoadScales {
    /// Scales of the disc; `None` where they are not known.
    pub(super) disc: Option<DiscScales>,
    /// Outer radius a, m.
    pub(super) outer_radius_m: Option<f64>,
}

impl LoadScales {
    /// At a load of this radius over the outer radius.
    pub(super) fn at(&self, radius_ratio: Option<f64>) -> Option<DiscScales> {
        let load_radius_m = radius_ratio.zip(self.outer_radius_m).map(|(ratio, a)| ratio * a);
        self.disc.map(|scales| DiscScales { load_radius_m, ..scales })
    }
}

/// A load with its position in the study file.
#[derive(Clone, Debug)]
pub(super) struct Pad {
    pub(super) load: Load,
    /// Radius over the outer radius.
    pub(super) radius: Option<f64>,
    /// Half the thickness of the disc over the radius, if it is given.
    pub(super) half_thickness: Option<f64>,
    /// The area over which it is distributed, if it is no point.
    pub(super) patch: Option<PatchSize>,
    /// Speed and where it was written.
    pub(super) speed: Option<(f64, Origin)>,
    /// Path of its table.
    pub(super) path: String,
    /// Where its table begins.
    pub(super) origin: Origin,
}

/// Reads every load; a disc without loads is free.
pub(super) fn read(reader: &mut Reader, disc: &Table, scales: LoadScales) -> Option<Vec<Pad>> {
    let Some(node) = disc.get("load") else { return Some(Vec::new()) };
    let pads: Vec<Option<Pad>> = match &node.value {
        Value::List(list) if list.len() > 1 => list
            .iter()
            .enumerate()
            .map(|(index, node)| one(reader, node, &format!("disc.load[{index}]"), scales))
            .collect(),
        Value::List(list) => {
            list.iter().map(|node| one(reader, node, "disc.load", scales)).collect()
        }
        _ => vec![one(reader, node, "disc.load", scales)],
    };
    let pads: Vec<Pad> = pads.into_iter().collect::<Option<_>>()?;
    let mut speeds = pads.iter().filter_map(|pad| Some((pad.speed?, &pad.path)));
    if let Some(((first, _), path)) = speeds.next() {
        for ((speed, origin), other) in speeds {
            if speed != first {
                let allowed =
                    format!("must equal {path}.speed = {first}: all loads rotate together");
                let key = format!("{other}.speed");
                reader.complain(Complaint::new(Fault::Conflict, key, origin, speed, allowed));
                return None;
            }
        }
    }
    Some(pads)
}

fn one(reader: &mut Reader, node: &Node, path: &str, scales: LoadScales) -> Option<Pad> {
    let table = reader.table(path, node)?;
    refuse_drive(reader, table, path);
    reader.unknown_keys(table, Section::DiscLoad, path);
    let radius = reader.optional(table, path, LOAD_RADIUS).if_given();
    reader.set_disc_scales(scales.at(radius.flatten()));
    let mut strength = |parameter| reader.optional(table, path, parameter).or(0.0);
    let strengths = [LOAD_MASS, LOAD_DAMPING, LOAD_STIFFNESS, LOAD_FRICTION].map(&mut strength);
    let (angle, phase) = (strength(LOAD_ANGLE), strength(LOAD_DITHER_PHASE));
    let static_load = strength(LOAD_STATIC);
    let speed = speed(reader, table, path);
    let [mass, damping, stiffness, friction] = strengths;
    let (pad, caliper) = carriers::read(reader, table, node.origin, path)?;
    let mut maybe = |parameter| reader.optional(table, path, parameter).if_given();
    let (normal_load, half_thickness) = (maybe(LOAD_NORMAL)?, maybe(LOAD_HALF_THICKNESS)?);
    let slip_ratio = reader.optional(table, path, LOAD_SLIP_RATIO).if_given()?;
    let share = CoursePlace(LOAD_ENVELOPE).optional(reader, table, path, "envelope").ok()?;
    let patch = PatchSize::read(reader, table, path)?;
    let twins = DISC_SPEED.si.iter().map(|twin| twin.key);
    let given = [DISC_SPEED.key()].into_iter().chain(twins).find_map(|key| table.get(key));
    let origin = given.map_or(node.origin, |node| node.origin);
    Some(Pad {
        load: Load {
            share: share.map(|course| course.profile(1.0)),
            static_load: static_load?,
            slip_ratio,
            normal_load,
            pad,
            caliper,
            ..Load::new(mass?, damping?, stiffness?, friction?)
                .at_angle(angle?.to_radians())
                .dithered_at(phase?.to_radians())
        },
        radius: radius?,
        half_thickness,
        patch,
        speed: speed?.map(|speed| (speed, origin)),
        path: path.to_owned(),
        origin: table.get("radius_ratio").map_or(node.origin, |node| node.origin),
    })
}

/// The speed of the loads; one along the surface, such as `36 km/h`, is that at the radius of the load.
#[expect(clippy::option_option, reason = "invalid, absent, given")]
fn speed(reader: &mut Reader, table: &Table, path: &str) -> Option<Option<f64>> {
    let along = table.get(DISC_SPEED.key()).filter(|node| match &node.value {
        Value::Text(text) => {
            measure::read(text, Some("m/s")).is_ok_and(|_| measure::has_unit(text))
        }
        _ => false,
    });
    let alone = DISC_SPEED.si.iter().all(|twin| !table.has(twin.key));
    let Some(node) = along.filter(|_| alone) else {
        return reader.optional(table, path, DISC_SPEED).if_given();
    };
    let quantity = Some(Quantity::Velocity);
    let wanted = WantedNumber { quantity, bounds: DISC_SPEED.bounds, unit: KeyUnit::Suffix("m/s") };
    reader.quantity(|| join(path, DISC_SPEED.key()), node, wanted).map(Some)
}

/// Reports a speed over time of one load.
fn refuse_drive(reader: &mut Reader, table: &Table, path: &str) {
    let Some(node) = table.get(DRIVE) else { return };
    let allowed =
        "left out: all loads rotate together, and [disc.drive] gives their speed over time";
    let (key, origin, given) = (format!("{path}.{DRIVE}"), node.origin, node.given());
    reader.complain(Complaint::new(Fault::Conflict, key, origin, given, allowed));
}
