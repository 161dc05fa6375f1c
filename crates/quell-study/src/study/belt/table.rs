//! `[belt]` and `[belt.initial]`.

use quell_dynamics::start::InitialState;
use quell_model::parameter::{
    BELT_VELOCITY, DAMPING_RATIO, INITIAL_DISPLACEMENT, INITIAL_VELOCITY, NORMAL_LOAD,
};
use serde_json::Value as Json;

use super::friction;
use crate::complaint::{Complaint, Fault, Origin};
use crate::study::document::{Node, Table};
use crate::study::reader::{Found, Reader};
use crate::study::vocabulary::{Choice, Section};

/// Numbers of `[belt]`; `None` where a value is invalid.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct BeltTable {
    pub(super) damping_ratio: Option<f64>,
    pub(super) normal_load: Option<f64>,
    pub(super) belt_velocity: Option<f64>,
    pub(super) initial: Option<InitialState>,
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
    reader.unknown_keys(table, Section::Belt, "belt", &["initial"]);
    let mut number = |parameter| reader.number(table, "belt", node.origin, parameter);
    let (damping_ratio, belt_velocity) = (number(DAMPING_RATIO), number(BELT_VELOCITY));
    // With friction in newtons the normal force may be omitted.
    let normal_load = match reader.optional(table, "belt", NORMAL_LOAD, None) {
        Found::Absent if friction::in_newtons(reader, root) => None,
        Found::Absent => reader.number(table, "belt", node.origin, NORMAL_LOAD),
        Found::Value(load) => Some(load),
        Found::Wrong => None,
    };
    let initial = match table.get("initial") {
        Some(node) => initial(reader, node),
        None => Some(InitialState::Rest),
    };
    BeltTable { damping_ratio, normal_load, belt_velocity, initial }
}

fn initial(reader: &mut Reader, node: &Node) -> Option<InitialState> {
    const PREFIX: &str = "belt.initial";
    let table = reader.table(PREFIX, node)?;
    reader.unknown_keys(table, Section::Initial, PREFIX, &[]);
    let displacement = reader.optional(table, PREFIX, INITIAL_DISPLACEMENT, None);
    let velocity = reader.optional(table, PREFIX, INITIAL_VELOCITY, None);
    let numbers = [displacement, velocity].iter().any(|found| *found != Found::Absent);
    let Some(state) = table.get("state") else {
        return Some(InitialState::Explicit {
            displacement: displacement.or(0.0)?,
            velocity: velocity.or(0.0)?,
        })
        .filter(|_| numbers)
        .or(Some(InitialState::Rest));
    };
    let name = reader.choice("belt.initial.state", state, Choice::State);
    if numbers {
        let allowed = "give either a named state or displacement and velocity, not both";
        let key = "belt.initial.state";
        reader.complain(Complaint::new(Fault::Conflict, key, state.origin, state.given(), allowed));
        return None;
    }
    name.map(|name| match name {
        "sliding" => InitialState::Sliding,
        "squealing" => InitialState::Squealing,
        _ => InitialState::Rest,
    })
}
