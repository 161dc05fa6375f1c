//! The identity of the map of a store, to check that a study computes the same map.
//!
//! It contains the values of the study after its changes (not the text: comments and order do not matter), the axes, the
//! quantities, the chunk shape, and the version of Quell, because another version may give other bits. Numbers are compared by
//! the digits that read back as the same number.
//!
//! The texts of the first study ([`StudyTexts`]) are stored too, but not compared: the metadata of the store are built from
//! them, so that every process knows the bytes that the metadata must have.

use serde_json::{Map, Value as Json, json};

use crate::sweep::Plan;

/// Version of the store format.
const FORMAT: u32 = 3;

/// Maximum number of differences that are named.
const NAMED: usize = 6;

/// The texts of the study that created a store. They do not affect any number: a study with other texts may continue the
/// store, whose metadata remain those of the first study.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct StudyTexts {
    /// Title of the study, if any.
    pub(super) title: Option<String>,
    /// Text of the study.
    pub(super) study: String,
    /// Its changes, one a line.
    pub(super) changes: String,
}

impl StudyTexts {
    /// Reads the texts from an [`identity`]; missing ones are empty.
    pub(super) fn of(identity: &Json) -> Self {
        let text = |key: &str| identity["provenance"][key].as_str().map(str::to_owned);
        Self {
            title: text("title"),
            study: text("study").unwrap_or_default(),
            changes: text("changes").unwrap_or_default(),
        }
    }
}

/// The identity of the map of a plan.
pub(super) fn identity(plan: &Plan) -> Json {
    let grid = plan.grid();
    // What the study says of a number of an axis does not matter.
    let settings = grid.study().settings_varying(grid.parameters());
    let settings: Map<String, Json> =
        settings.into_iter().map(|(path, value)| (path, value.into())).collect();
    let axes: Map<String, Json> = grid
        .axes()
        .iter()
        .map(|axis| {
            let values: Vec<String> =
                axis.values.iter().map(|value| format!("{value:?}")).collect();
            (axis.path.clone(), values.into())
        })
        .collect();
    let names: Vec<&str> = plan.quantities().iter().map(|quantity| quantity.name).collect();
    json!({
        "format": FORMAT,
        "quell": env!("CARGO_PKG_VERSION"),
        "study": settings,
        "axes": axes,
        "quantities": names,
        "chunk": plan.chunks().chunk_shape(),
        "provenance": {
            "title": grid.study().title(),
            "study": grid.study().text(),
            "changes": grid.study().changes().join("\n"),
        },
    })
}

/// Descriptions of the differences between the store and the plan; empty if they agree. A store of another format says nothing else.
pub(super) fn differences(store: &Json, plan: &Json) -> Vec<String> {
    let both = |field: &str| [plan, store].map(|identity| plain(&identity[field]));
    let [here, there] = both("format");
    if here != there {
        return vec![format!(
            "the version of the store format is {here} here and {there} in the store, whose map has to be computed again"
        )];
    }
    let mut found = Vec::new();
    let [here, there] = both("quell");
    if here != there {
        found.push(format!(
            "the version of Quell is {here} here and {there} in the store: bits may differ"
        ));
    }
    settings(&store["study"], &plan["study"], &mut found);
    axes(&store["axes"], &plan["axes"], &mut found);
    if store["quantities"] != plan["quantities"] {
        found.push(format!(
            "the quantities are {} here and {} in the store",
            list(&plan["quantities"]),
            list(&store["quantities"])
        ));
    }
    if found.is_empty() && store["chunk"] != plan["chunk"] {
        found.push(format!(
            "the chunk shape is {} here and {} in the store",
            plan["chunk"], store["chunk"]
        ));
    }
    if found.len() > NAMED {
        let more = found.len() - NAMED;
        found.truncate(NAMED);
        found.push(format!("and {more} more"));
    }
    found
}

fn settings(store: &Json, plan: &Json, found: &mut Vec<String>) {
    let empty = Map::new();
    let (there, here) = (store.as_object().unwrap_or(&empty), plan.as_object().unwrap_or(&empty));
    for (path, value) in here {
        match there.get(path) {
            Some(other) if other == value => {}
            Some(other) => {
                found.push(format!(
                    "{path} is {} here and {} in the store",
                    plain(value),
                    plain(other)
                ));
            }
            None => found.push(format!("{path} = {} is missing in the store", plain(value))),
        }
    }
    for (path, value) in there.iter().filter(|(path, _)| !here.contains_key(*path)) {
        found.push(format!("{path} = {} is only in the store", plain(value)));
    }
}

fn axes(store: &Json, plan: &Json, found: &mut Vec<String>) {
    let empty = Map::new();
    let (there, here) = (store.as_object().unwrap_or(&empty), plan.as_object().unwrap_or(&empty));
    if !here.keys().eq(there.keys()) {
        let names = |axes: &Map<String, Json>| axes.keys().cloned().collect::<Vec<_>>().join(", ");
        found.push(format!("the axes are {} here and {} in the store", names(here), names(there)));
        return;
    }
    for (path, values) in here {
        if there.get(path) != Some(values) {
            let other = there.get(path).unwrap_or(&Json::Null);
            found.push(format!(
                "{path} has the values {} here and {} in the store",
                range(values),
                range(other)
            ));
        }
    }
}

fn range(values: &Json) -> String {
    match values.as_array().map(Vec::as_slice) {
        Some([only]) => plain(only),
        Some([first, .., last]) => {
            let count = values.as_array().map_or(0, Vec::len);
            format!("{} … {} ({count} values)", plain(first), plain(last))
        }
        _ => "none".to_owned(),
    }
}

fn list(names: &Json) -> String {
    let names = names.as_array().map(Vec::as_slice).unwrap_or_default();
    names.iter().map(plain).collect::<Vec<_>>().join(", ")
}

fn plain(value: &Json) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}
