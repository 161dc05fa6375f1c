//! `[belt]` and `[belt.initial]`.

use quell_input::complaint::{Complaint, Fault, Origin};
use quell_input::document::{Node, Table};
use quell_model::parameter::{
    BELT_VELOCITY, DAMPING_RATIO, INITIAL_DISPLACEMENT, INITIAL_VELOCITY, NORMAL_LOAD,
    NORMAL_STIFFNESS, TANGENTIAL_STIFFNESS,
};
use quell_model::units::Quantity;
use quell_model::{Direction, Dither, Friction, LawKind};
use serde_json::Value as Json;

use crate::study::course::{Course, CoursePlace, no_constant, replaces_constant};
use crate::study::friction;
use crate::study::reader::{Found, Reader};
use crate::study::system::SystemStart;
use crate::study::vocabulary::{Choice, DRIVE, LOAD, Section};

/// Numbers of `[belt]`; `None` where a value is invalid.
#[derive(Clone, Debug, Default)]
pub(super) struct BeltTable {
    pub(super) damping_ratio: Option<f64>,
    pub(super) normal_load: Option<f64>,
    pub(super) belt_velocity: Option<f64>,
    /// Absent of a rigid contact.
    pub(super) tangential_stiffness: Option<f64>,
    /// Absent where the load is prescribed.
    pub(super) normal_stiffness: Option<f64>,
    /// Where runs begin, displacement and velocity in numbers of the equations.
    pub(super) initial: Option<SystemStart>,
    /// Velocity and load over time, where they are given.
    pub(super) drive: Option<Course>,
    pub(super) load: Option<Course>,
    /// Whether drive, load and the stiffnesses are right.
    pub(super) others_are_right: bool,
}

/// Reads `[belt]`.
pub(super) fn read(reader: &mut Reader, root: &Table) -> BeltTable {
    let Some(node) = root.get("belt") else {
        let allowed =
            "a table [belt] with damping_ratio, normal_load, belt_velocity (or their SI keys)";
        reader.complain(Complaint::new(Fault::Missing, "belt", Origin::Whole, Json::Null, allowed));
        return BeltTable::default();
    };
    let Some(table) = reader.table("belt", node) else {
        return BeltTable::default();
    };
    let in_newtons = friction::in_newtons(root);
    let read = |reader: &mut Reader| Some(numbers(reader, (node, table), in_newtons));
    reader.part(table, in_newtons, read).unwrap_or_default()
}

fn numbers(reader: &mut Reader, (node, table): (&Node, &Table), in_newtons: bool) -> BeltTable {
    reader.unknown_keys(table, Section::Belt, "belt");
    let course =
        |reader: &mut Reader, name, what| CoursePlace(what).optional(reader, table, "belt", name);
    let drive = course(reader, "drive", DRIVE);
    let load = course(reader, "load", LOAD);
    if let Some(node) = table.get("load") {
        let newtons = reader.known_scales().map_or(1.0, |scales| scales.per_unit(Quantity::Force));
        reader.remember("belt", ("load", "load"), node.origin, newtons);
    }
    let damping_ratio = reader.number(table, "belt", node.origin, DAMPING_RATIO);
    let belt_velocity = if replaces_constant(table.get("drive")) {
        no_constant(reader, table, "belt", BELT_VELOCITY, "drive");
        drive.as_ref().ok().map(|_| 0.0)
    } else {
        reader.number(table, "belt", node.origin, BELT_VELOCITY)
    };
    // With friction in newtons the normal force may be omitted.
    let normal_load = match reader.optional(table, "belt", NORMAL_LOAD) {
        found if replaces_constant(table.get("load")) => {
            no_constant(reader, table, "belt", NORMAL_LOAD, "load");
            let first = match &load {
                Ok(Some(Course::Over(knots))) => Some(knots.value(0.0)),
                _ => None,
            };
            first.filter(|_| found == Found::Absent)
        }
        Found::Absent if in_newtons => None,
        Found::Absent => reader.number(table, "belt", node.origin, NORMAL_LOAD),
        Found::Value(load) => Some(load),
        Found::Wrong => None,
    };
    let springs = [TANGENTIAL_STIFFNESS, NORMAL_STIFFNESS]
        .map(|stiffness| reader.optional(table, "belt", stiffness).if_given());
    let initial = match table.get("initial") {
        Some(node) => initial(reader, node),
        None => Some(SystemStart::Rest),
    };
    let others_are_right = drive.is_ok() && load.is_ok() && !springs.contains(&None);
    let [tangential_stiffness, normal_stiffness] = springs.map(Option::flatten);
    let (drive, load) = (drive.unwrap_or_default(), load.unwrap_or_default());
    BeltTable {
        damping_ratio,
        normal_load,
        belt_velocity,
        tangential_stiffness,
        normal_stiffness,
        initial,
        drive,
        load,
        others_are_right,
    }
}

/// Reports an elastic slider whose law has a state of its own.
pub(super) fn slider_has_one_state(reader: &mut Reader, root: &Table, law: Option<&Friction>) {
    let Some(table) = root.get("belt").and_then(Node::table) else { return };
    let Some((name, node)) =
        TANGENTIAL_STIFFNESS.keys().find_map(|name| Some((name, table.get(name)?)))
    else {
        return;
    };
    if law.is_some_and(|law| law.bristles().is_some()) {
        let key = format!("belt.{name}");
        reader.complain(Complaint::new(
            Fault::Conflict,
            key,
            node.origin,
            node.given(),
            one_state(LawKind::Lugre),
        ));
    }
}

/// Reports a normal stiffness without normal dither: the load is prescribed, so that it would change nothing.
pub(super) fn spring_has_dither(reader: &mut Reader, root: &Table, dithers: Option<&[Dither]>) {
    let Some(table) = root.get("belt").and_then(Node::table) else { return };
    let given = NORMAL_STIFFNESS.keys().find_map(|name| Some((name, table.get(name)?)));
    let is_normal = |dither: &Dither| dither.direction == Direction::Normal;
    let (Some((name, node)), Some(dithers)) = (given, dithers) else { return };
    if !dithers.iter().any(is_normal) {
        let (key, given) = (format!("belt.{name}"), node.given());
        let allowed = "left out, or normal dither, whose actuator acts through it: the mass of a belt does not move in the normal \
                       direction";
        reader.complain(Complaint::new(Fault::Conflict, key, node.origin, given, allowed));
    }
}

/// Why a law with a state has no tangential stiffness.
pub(in crate::study) fn one_state(law: LawKind) -> String {
    format!(
        "none with the law \"{}\", whose bristles are elastic themselves; a tangential stiffness makes any other law an elastic slider",
        law.name()
    )
}

fn initial(reader: &mut Reader, node: &Node) -> Option<SystemStart> {
    const PREFIX: &str = "belt.initial";
    let table = reader.table(PREFIX, node)?;
    reader.unknown_keys(table, Section::Initial, PREFIX);
    let displacement = reader.optional(table, PREFIX, INITIAL_DISPLACEMENT);
    let velocity = reader.optional(table, PREFIX, INITIAL_VELOCITY);
    let numbers = [displacement, velocity].iter().any(|found| *found != Found::Absent);
    let Some(state) = table.get("state") else {
        let values = vec![displacement.or(0.0)?, velocity.or(0.0)?];
        return Some(if numbers { SystemStart::Values(values) } else { SystemStart::Rest });
    };
    let name = reader.choice("belt.initial.state", state, Choice::State);
    if numbers {
        let allowed = "give either a named state or displacement and velocity, not both";
        let key = "belt.initial.state";
        reader.complain(Complaint::new(Fault::Conflict, key, state.origin, state.given(), allowed));
        return None;
    }
    name.map(|name| match name {
        "sliding" => SystemStart::Sliding,
        "squealing" => SystemStart::Squealing,
        _ => SystemStart::Rest,
    })
}
