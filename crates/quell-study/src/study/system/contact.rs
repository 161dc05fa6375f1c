//! `[[contact]]`: rows, load, moving surface and friction law.

use std::sync::Arc;

use quell_input::complaint::{Complaint, Fault};
use quell_input::document::{Node, Table, Value};
use quell_model::friction::Surroundings;
use quell_model::parameter::Parameter;
use quell_model::parameter::system::{
    CONTACT_BELT_VELOCITY, CONTACT_NORMAL_DAMPING, CONTACT_NORMAL_LOAD, CONTACT_NORMAL_STIFFNESS,
    CONTACT_TANGENTIAL_STIFFNESS,
};
use quell_model::profile::Profile;
use quell_model::{Contact, Friction, LawKind, System};
use quell_numerics::interval::RealInterval;

use super::names::{MOST_COORDINATES, NAME, is_plain_name};
use super::rows::{RowBasis, SameBasis};
use serde_json::Value as Json;

use crate::study::belt::one_state;
use crate::study::course::{CoursePlace, no_constant, replaces_constant};
use crate::study::friction::{self, LawPlace, ReadLaw};
use crate::study::reader::{Found, Reader};
use crate::study::vocabulary::Section;
use crate::study::vocabulary::{DRIVE, LOAD, join};

/// What contacts need to know of the rest of the study.
#[derive(Clone, Copy)]
pub(super) struct ContactContext<'a> {
    pub(super) basis: &'a Arc<RowBasis>,
    /// Whether the equations are of first order.
    pub(super) first_order: bool,
    /// Whether the names are those of a measured frequency response, which may name rows of contacts.
    pub(super) measured: bool,
    /// The law of contacts without one of their own.
    pub(super) shared: Option<&'a Node>,
    /// Names of the contacts whose load a dither modulates.
    pub(super) modulated: &'a [String],
}

/// What a contact is read by in addition to its own table.
struct ContactSurroundings {
    basis: SameBasis,
    first_order: bool,
    measured: bool,
    shared: Option<Table>,
    modulated: bool,
}

impl PartialEq for ContactSurroundings {
    fn eq(&self, other: &Self) -> bool {
        let shared = match (&self.shared, &other.shared) {
            (Some(own), Some(other)) => own.is_same(other),
            (own, other) => own.is_none() && other.is_none(),
        };
        let own = (&self.basis, self.first_order, self.measured, self.modulated);
        shared && own == (&other.basis, other.first_order, other.measured, other.modulated)
    }
}

/// Each table of a list with its prefix; a single one has no index.
pub(super) fn listed<'t>(
    reader: &mut Reader,
    parent: &'t Table,
    prefix: &str,
    name: &str,
) -> Vec<(String, &'t Node, &'t Table)> {
    let Some(node) = parent.get(name) else { return Vec::new() };
    let path = join(prefix, name);
    let several = node.entries();
    if several.len() > MOST_COORDINATES {
        let allowed = format!("at most {MOST_COORDINATES} tables; got {}", several.len());
        let count = several.len();
        reader.complain(Complaint::new(Fault::Value, path, node.origin, count, allowed));
        return Vec::new();
    }
    let single = several.len() == 1;
    let mut found = Vec::with_capacity(several.len());
    for (index, node) in several.iter().enumerate() {
        let at = if single { path.clone() } else { format!("{path}[{index}]") };
        match node.table() {
            Some(table) => found.push((at, node, table)),
            None => {
                reader.wrong(&at, node, format!("a table [[{path}]]; got {}", node.kind()));
            }
        }
    }
    found
}

/// A contact as it was read.
#[derive(Clone)]
pub(super) struct ReadContact {
    pub(super) contact: Contact,
    /// Whether its friction coefficient was negative.
    pub(super) reversed: bool,
}

impl ReadContact {
    /// The warning about a negative coefficient.
    pub(super) fn warning(&self) -> Option<String> {
        self.reversed.then(|| {
            format!(
                "The friction coefficient of contact {} is negative: it is read as that of a surface that moves in the other direction.",
                self.contact.name
            )
        })
    }
}

/// Reads every contact; `None` if one is wrong.
pub(super) fn read(
    reader: &mut Reader,
    document: &Table,
    context: ContactContext<'_>,
) -> Option<Vec<ReadContact>> {
    let tables = listed(reader, document, "", "contact");
    if let Some(shared) = context.shared
        && tables.iter().all(|(.., table)| table.has("friction"))
    {
        let allowed = "left out: every contact has a law of its own, in [contact.friction]";
        let complaint =
            Complaint::new(Fault::Conflict, "friction", shared.origin, Json::Null, allowed);
        reader.complain(complaint);
    }
    let mut names: Vec<String> = Vec::new();
    let contacts: Vec<Option<ReadContact>> = tables
        .into_iter()
        .enumerate()
        .map(|(index, (prefix, node, table))| {
            let name = name(reader, table, &prefix, index, &mut names);
            // A contact without a law of its own has the shared one.
            let shared = context.shared.and_then(Node::table).filter(|_| !table.has("friction"));
            let around = ContactSurroundings {
                basis: SameBasis(Arc::clone(context.basis)),
                first_order: context.first_order,
                measured: context.measured,
                shared: shared.cloned(),
                modulated: name.as_ref().is_some_and(|name| context.modulated.contains(name)),
            };
            let modulated = around.modulated;
            let read = reader.part(table, around, |reader| {
                one(reader, (table, node), (&prefix, index), modulated, context)
            })?;
            let contact = Contact { name: name.unwrap_or_default(), ..read.contact };
            Some(ReadContact { contact, ..read })
        })
        .collect();
    contacts.into_iter().collect()
}

/// Names of the contacts of a document, as far as they are given.
pub(super) fn names(document: &Table) -> Vec<String> {
    let entries = document.get("contact").map_or(&[][..], Node::entries);
    let tables = entries.iter().filter_map(Node::table);
    let name = |(index, table): (usize, &Table)| match table.get("name").map(|node| &node.value) {
        Some(Value::Text(text)) => text.clone(),
        _ => default_name(index),
    };
    tables.enumerate().map(name).collect()
}

fn default_name(index: usize) -> String {
    format!("contact {}", index + 1)
}

fn name(
    reader: &mut Reader,
    table: &Table,
    prefix: &str,
    index: usize,
    earlier: &mut Vec<String>,
) -> Option<String> {
    let Some(node) = table.get("name") else {
        earlier.push(default_name(index));
        return earlier.last().cloned();
    };
    let key = join(prefix, "name");
    let text = reader.text(&key, node)?;
    if !is_plain_name(&text) {
        reader.wrong(&key, node, NAME);
        return None;
    }
    if earlier.contains(&text) {
        reader.wrong(&key, node, "a name that no other contact has");
        return None;
    }
    earlier.push(text.clone());
    Some(text)
}

fn one(
    reader: &mut Reader,
    (table, node): (&Table, &Node),
    (prefix, index): (&str, usize),
    modulated: bool,
    context: ContactContext<'_>,
) -> Option<ReadContact> {
    reader.unknown_keys(table, Section::Contact, prefix);
    let ContactContext { first_order, .. } = context;
    let before = reader.complaints_so_far();
    let rows = ["tangent", "normal", "slope", "force"]
        .map(|name| row(reader, table, prefix, name, index, context));
    let rows_are_right = reader.complaints_so_far() == before;
    let [tangent, normal, slope, force] = rows;
    if first_order && tangent.is_some() && !table.has("force") {
        let allowed = "the effect of the friction force on each state, which stands for M⁻¹t: first-order equations have \
                       no mass matrix";
        reader.missing(join(prefix, "force"), node.origin, allowed);
    }
    let shared = context.shared.and_then(Node::table);
    let friction = table.get("friction").and_then(Node::table).or(shared);
    let needs_load = friction.is_none_or(|table| !friction::are_given_as_forces(table));
    let (load, velocity) = over_time(reader, table, prefix, node, needs_load);
    let mut number = |parameter| reader.optional(table, prefix, parameter).if_given();
    let (stiffness, damping) = (number(CONTACT_NORMAL_STIFFNESS), number(CONTACT_NORMAL_DAMPING));
    let spring = number(CONTACT_TANGENTIAL_STIFFNESS);
    // Of a number that is wrong nothing more is said.
    let has_normal = normal.is_some() || table.has("normal");
    if !modulated && !has_normal && stiffness.is_some() && damping.is_some() {
        without_normal(reader, table, prefix, &["normal_stiffness", "normal_damping"]);
    }
    let known = load.as_ref().and_then(Option::as_ref).map(|load| load.value(0.0));
    let law = law(reader, table, node, prefix, (tangent.is_none(), known), context);
    if !rows_are_right {
        return None;
    }
    let (ReadLaw { law, reversed, own_load, .. }, velocity) = (law?, velocity?);
    // Negative friction is friction of a surface that moves in the other direction; it exists only without a tangent,
    // where the slip velocity is that of the surface.
    let velocity = if reversed { velocity.reversed() } else { velocity };
    let fastest = velocity.bounds().magnitude();
    let load = load?.or(own_load.map(Profile::constant))?;
    let steady = load.value(0.0);
    // Without dither; with it the equations as a whole decide.
    let around = Surroundings { normal_load: steady, slip: fastest };
    let law = placed(reader, (table, node, prefix), law, &around)?;
    let tangential_stiffness = spring?;
    let name = "tangential_stiffness";
    let given = table.iter().find(|(known, _)| known.starts_with(name));
    if let Some((name, node)) = given.filter(|_| law.bristles().is_some()) {
        let (key, allowed) = (join(prefix, name), one_state(law.kind()));
        reader.complain(Complaint::new(Fault::Conflict, key, node.origin, node.given(), allowed));
        return None;
    }
    let contact = Contact {
        name: String::new(),
        tangent,
        force,
        normal,
        slope,
        normal_load: steady,
        normal_stiffness: stiffness?.unwrap_or(0.0),
        normal_damping: damping?.unwrap_or(0.0),
        surface_velocity: velocity,
        friction: law,
        tangential_stiffness,
        varying_load: (load != Profile::constant(steady)).then_some(load),
    };
    Some(ReadContact { contact, reversed })
}

/// Load and surface velocity of a contact, constant or over time; `None` if wrong. Friction that is given as forces needs no load.
#[expect(clippy::option_option, reason = "invalid, absent, given")]
fn over_time(
    reader: &mut Reader,
    table: &Table,
    prefix: &str,
    node: &Node,
    needs_load: bool,
) -> (Option<Option<Profile>>, Option<Profile>) {
    let mut profile = |name: &str, what, parameter: Parameter, needed: bool| {
        let course = CoursePlace(what).optional(reader, table, prefix, name);
        if replaces_constant(table.get(name)) {
            no_constant(reader, table, prefix, parameter, name);
            return course.ok().flatten().map(|course| Some(course.profile(0.0)));
        }
        let found = reader.optional(table, prefix, parameter);
        if found == Found::Absent && needed {
            reader.missing_number(prefix, node.origin, parameter);
            return None;
        }
        let constant = found.if_given()?;
        Some(match (course.ok()?, constant) {
            (Some(course), Some(constant)) => Some(course.profile(constant)),
            (_, constant) => constant.map(Profile::constant),
        })
    };
    let load = profile("load", LOAD, CONTACT_NORMAL_LOAD, needs_load);
    let velocity = profile("drive", DRIVE, CONTACT_BELT_VELOCITY, true).flatten();
    let before = reader.complaints_so_far();
    if let Some(Some(profile)) = &load {
        stays_loaded(reader, table, prefix, profile);
    }
    let right = reader.complaints_so_far() == before;
    (load.filter(|_| right), velocity)
}

/// Reports a load over time that reaches zero; a constant one has bounds.
fn stays_loaded(reader: &mut Reader, table: &Table, prefix: &str, load: &Profile) {
    let RealInterval { lower: least, .. } = load.bounds();
    if let Some(node) = table.get("load").filter(|_| least <= 0.0) {
        let key = join(prefix, "load");
        let allowed = "such that the load stays greater than 0: without load there is no contact";
        reader.complain(Complaint::new(Fault::Value, key, node.origin, least, allowed));
    }
}

/// A row of a contact. Rows of a measured frequency response may have the name of the contact, as `pad.tangent`.
fn row(
    reader: &mut Reader,
    table: &Table,
    prefix: &str,
    name: &'static str,
    index: usize,
    context: ContactContext<'_>,
) -> Option<Vec<f64>> {
    let ContactContext { basis, first_order, measured, .. } = context;
    let Some(node) = table.get(name) else {
        let own = match table.get("name").map(|node| &node.value) {
            Some(Value::Text(text)) => text.clone(),
            _ => default_name(index),
        };
        let place = basis.names.iter().position(|known| *known == format!("{own}.{name}"));
        let place = place.filter(|_| measured)?;
        return Some(basis.names.iter().enumerate().map(|(i, _)| f64::from(i == place)).collect());
    };
    let key = join(prefix, name);
    let refused = match (first_order, name) {
        (true, "normal" | "slope") => Some(
            "only mechanical systems with coordinates have it: the reaction of a normal contact needs their mass matrix",
        ),
        (false, "force") => {
            Some("only first-order systems with states have it; friction acts along tangent")
        }
        _ => None,
    };
    if let Some(allowed) = refused {
        reader.complain(Complaint::new(Fault::Conflict, key, node.origin, node.given(), allowed));
        return None;
    }
    basis.row_not_zero(reader, &key, node)
}

/// Reports stiffness and damping of a contact without a normal row.
fn without_normal(reader: &mut Reader, table: &Table, prefix: &str, names: &[&str]) {
    for (name, node) in table.iter() {
        let compliant = names.iter().any(|known| name.starts_with(known));
        if compliant && node.value != Value::Number(0.0) {
            let key = join(prefix, name);
            let allowed = format!(
                "requires the row {}, or a dither of the load (direction = \"normal\"), whose actuator acts through it: without them the \
                 load is prescribed",
                join(prefix, "normal")
            );
            reader.complain(Complaint::new(
                Fault::Conflict,
                key,
                node.origin,
                node.given(),
                allowed,
            ));
        }
    }
}

/// The law of a contact: its own or the shared one.
fn law(
    reader: &mut Reader,
    table: &Table,
    contact: &Node,
    prefix: &str,
    (may_be_reversed, normal_load): (bool, Option<f64>),
    context: ContactContext<'_>,
) -> Option<ReadLaw> {
    let (path, node) = match (table.get("friction"), context.shared) {
        (Some(node), _) => (join(prefix, "friction"), node),
        (None, Some(node)) => ("friction".to_owned(), node),
        (None, None) => {
            let allowed = "a table [contact.friction] with law and its parameters, or one [friction] for all contacts";
            reader.missing(join(prefix, "friction"), contact.origin, allowed);
            return None;
        }
    };
    let place = LawPlace { path: &path, normal_load, may_be_reversed };
    friction::read_table(reader, node, place)
}

/// The warning about a contact whose friction acts on nothing.
pub(super) fn without_rows(contacts: &[Contact]) -> impl Iterator<Item = String> {
    let idle = contacts.iter().filter(|contact| {
        contact.tangent.is_none() && contact.normal.is_none() && contact.slope.is_none()
    });
    idle.map(|contact| {
        format!(
            "contact {} has neither tangent nor normal nor slope: its friction acts on nothing",
            contact.name
        )
    })
}

/// Whether a law has values that are proven, or read from a file, up to some slip speed.
fn has_range(law: &Friction) -> bool {
    matches!(law.kind(), LawKind::Expression | LawKind::Samples)
}

/// The laws of a system in the surroundings of their contacts, dither included, which its whole equations decide.
pub(super) fn placed_in(reader: &mut Reader, document: &Table, system: &mut System) -> Option<()> {
    let dithered = system.is_dithered();
    if !dithered || !system.contacts.iter().any(|contact| has_range(&contact.friction)) {
        return Some(());
    }
    let tables = listed(reader, document, "", "contact");
    for (index, (prefix, node, table)) in tables.into_iter().enumerate() {
        let around = system.surroundings(index);
        let law = system.contacts[index].friction.clone();
        system.contacts[index].friction = placed(reader, (table, node, &prefix), law, &around)?;
    }
    Some(())
}

/// The law in the surroundings of its contact: a formula is proven up to the slip speeds that are expected there.
fn placed(
    reader: &mut Reader,
    (table, contact, prefix): (&Table, &Node, &str),
    law: Friction,
    surroundings: &Surroundings,
) -> Option<Friction> {
    if !has_range(&law) {
        return Some(law);
    }
    match law.placed(surroundings) {
        Ok(law) => Some(law),
        Err(invalid) => {
            let (path, friction) = match table.get("friction") {
                Some(node) => (join(prefix, "friction"), node),
                None => ("friction".to_owned(), contact),
            };
            for wrong in invalid {
                let name = wrong.key.rsplit('.').next().unwrap_or_default().to_owned();
                let node = friction.table().and_then(|table| table.get(&name)).unwrap_or(friction);
                reader.wrong(&join(&path, &name), node, wrong.allowed);
            }
            None
        }
    }
}
