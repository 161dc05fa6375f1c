//! `[[dither]]`: forces on coordinates and modulations of the load of a contact, periodic or noise.

use std::sync::Arc;

use quell_input::complaint::{Complaint, Fault, Origin};
use quell_input::document::{Node, Table, Value};
use quell_input::nearest;
use quell_model::Contact;
use quell_model::digits::digits;
use quell_model::parameter::system::{
    FRICTION_FACTOR, FRICTION_FACTOR_MEAN, SYSTEM_DITHER_FREQUENCY,
};
use quell_model::parameter::{Bounds, DITHER_AMPLITUDE, DITHER_PHASE};
use quell_model::profile::{Profile, Wave};
use quell_model::system::{Input, InputTarget};

use super::contact::listed;
use super::rows::{RowBasis, SameBasis};
use crate::study::band;
use crate::study::course::{Course, CoursePlace};
use crate::study::design::DitherPlace;
use crate::study::dither_size::{self, SizedAmplitude};
use crate::study::path::is_factor;
use crate::study::reader::Reader;
use crate::study::vocabulary::size::DITHER_SIZES;
use crate::study::vocabulary::{self, DocumentKind, Section};
use crate::study::vocabulary::{Choice, ENVELOPE, FRICTION, join};
use crate::study::waveform;

/// The key of the places that a design tries.
pub(in crate::study) const PLACES: &str = "places";

/// The contacts that a dither can modulate.
#[derive(Clone, Copy)]
pub(super) struct DitherContext<'a> {
    pub(super) basis: &'a Arc<RowBasis>,
    /// Names of all contacts.
    pub(super) names: &'a [String],
    /// The contacts, if all are right.
    pub(super) contacts: Option<&'a [Contact]>,
    /// Whether the study has a table `[actuator]`.
    pub(super) has_actuator: bool,
}

/// What a dither is read by in addition to its own table.
#[derive(PartialEq)]
struct DitherSurroundings {
    basis: SameBasis,
    has_actuator: bool,
    /// The contact on which it acts: its place and its rows.
    contact: Option<(usize, [Option<Vec<f64>>; 3])>,
}

impl DitherSurroundings {
    fn of(table: &Table, context: DitherContext<'_>) -> Self {
        let DitherContext { basis, names, contacts, has_actuator } = context;
        let name = table.get("contact").map(|node| &node.value);
        let index =
            names.iter().position(|known| matches!(name, Some(Value::Text(name)) if name == known));
        let contact = index.and_then(|index| {
            let Contact { force, tangent, normal, .. } = contacts?.get(index)?;
            Some((index, [force.clone(), tangent.clone(), normal.clone()]))
        });
        Self { basis: SameBasis(Arc::clone(basis)), has_actuator, contact }
    }
}

/// The inputs, and the table of each with the size that gives its amplitude.
pub(super) type ReadDithers = (Vec<Input>, Vec<(String, SizedAmplitude)>);

/// Reads every dither, with the size that gives its amplitude; `None` if one is wrong.
pub(super) fn read(
    reader: &mut Reader,
    document: &Table,
    context: DitherContext<'_>,
) -> Option<ReadDithers> {
    let tables = listed(reader, document, "", "dither");
    let (inputs, sizes): (Vec<Option<Input>>, Vec<_>) = tables
        .iter()
        .map(|(prefix, node, table)| {
            let around = DitherSurroundings::of(table, context);
            let read =
                reader.part(table, around, |reader| one(reader, (prefix, *node, *table), context));
            let (input, size) = read.unzip();
            (input, size.map(|size| (prefix.clone(), size)))
        })
        .unzip();
    one_mean(reader, &tables, &inputs);
    let whole: Option<Vec<Input>> = inputs.iter().cloned().collect();
    if let Some(contacts) = context.contacts {
        stays_pressed(reader, &tables, &inputs, (contacts, context.basis.names.len()));
    }
    whole.zip(sizes.into_iter().collect())
}

/// Names of the contacts whose load a dither modulates.
pub(super) fn modulated(document: &Table) -> Vec<String> {
    let entries = document.get("dither").map_or(&[][..], Node::entries);
    let word = |table: &Table, key: &str| match table.get(key).map(|node| &node.value) {
        Some(Value::Text(word)) => Some(word.clone()),
        _ => None,
    };
    let normal = entries
        .iter()
        .filter_map(Node::table)
        .filter(|table| word(table, "direction").as_deref() == Some("normal"));
    normal.filter_map(|table| word(table, "contact")).collect()
}

/// The places of `[design]`, of which each says where the dither acts as its own table would; `None` if one is wrong.
pub(super) fn places(
    reader: &mut Reader,
    document: &Table,
    context: DitherContext<'_>,
) -> Option<Vec<DitherPlace>> {
    let Some(design) = document.get("design").and_then(Node::table) else {
        return Some(Vec::new());
    };
    let is_list = |node: &&Node| matches!(&node.value, Value::List(list) if !list.is_empty());
    if let Some(node) = design.get(PLACES).filter(|node| !is_list(node)) {
        let allowed = format!(
            "an array of at least one place, such as [{{ at = {{ x = 1.0 }} }}]; got {}",
            node.kind()
        );
        reader.wrong("design.places", node, allowed);
        return None;
    }
    let before = reader.complaints_so_far();
    let listed = listed(reader, design, "design", PLACES);
    let places = listed.into_iter().map(|(prefix, node, table)| {
        reader.unknown_keys(table, Section::DitherPlace, &prefix);
        target(reader, &prefix, node, table, context)?;
        Some(DitherPlace { name: place_in_words(table), keys: table.clone() })
    });
    let places: Option<Vec<DitherPlace>> = places.collect();
    if let (Some(known), Some(node)) = (&places, design.get(PLACES))
        && let Some(twice) = (1..known.len())
            .find(|own| known[..*own].iter().any(|one| one.name == known[*own].name))
    {
        let allowed = format!("each place once; {} is given twice", known[twice].name);
        reader.wrong("design.places", node, allowed);
    }
    places.filter(|_| reader.complaints_so_far() == before)
}

/// Where a dither acts, in words: the entries of its row, or its contact.
fn place_in_words(table: &Table) -> String {
    let Some(at) = table.get("at") else {
        let words = |key: &str| match table.get(key).map(|node| &node.value) {
            Some(Value::Text(word)) => word.clone(),
            _ => String::new(),
        };
        return format!("{} ({})", words("contact"), words("direction"));
    };
    let mut entries = Vec::new();
    entries_in_words(at, "", &mut entries);
    let mut words = String::new();
    for (name, factor) in entries {
        let (sign, size) = match factor.strip_prefix('-') {
            Some(size) => ("− ", size),
            None if words.is_empty() => ("", factor.as_str()),
            None => ("+ ", factor.as_str()),
        };
        let space = if words.is_empty() { "" } else { " " };
        let times =
            if size == "1" && !name.is_empty() { String::new() } else { format!("{size} ") };
        words.push_str(format!("{space}{sign}{times}{name}").trim_end());
    }
    words
}

/// The entries of a row with their factors.
fn entries_in_words(node: &Node, name: &str, entries: &mut Vec<(String, String)>) {
    match &node.value {
        Value::Table(table) => {
            for (inner, node) in table.iter() {
                let dot = if name.is_empty() { "" } else { "." };
                entries_in_words(node, &format!("{name}{dot}{inner}"), entries);
            }
        }
        Value::Number(factor) => entries.push((name.to_owned(), factor.to_string())),
        Value::Text(formula) => entries.push((name.to_owned(), format!("({formula})"))),
        _ => entries.push((name.to_owned(), node.given().to_string())),
    }
}

/// The table of a dither, counted from 0.
pub(super) fn table_mut(document: &mut Table, dither: usize) -> Option<&mut Table> {
    let node = document.get_mut("dither")?;
    match &mut node.value {
        Value::List(list) => list.get_mut(dither).and_then(Node::table_mut),
        Value::Table(table) if dither == 0 => Some(table),
        _ => None,
    }
}

/// Lets a dither act at a place.
pub(super) fn put_at(table: &mut Table, place: &DitherPlace) {
    for key in vocabulary::keys_of(Section::DitherPlace, DocumentKind::System) {
        table.remove(key.name);
    }
    for (name, node) in place.keys.iter() {
        table.set(name, node.clone());
    }
}

fn one(
    reader: &mut Reader,
    (prefix, node, table): (&str, &Node, &Table),
    context: DitherContext<'_>,
) -> Option<(Input, SizedAmplitude)> {
    reader.unknown_keys(table, Section::Dither, prefix);
    let target = target(reader, prefix, node, table, context);
    let is_noise = waveform::is_noise(table);
    let read = waveform::read(reader, table, (prefix, node.origin), |reader| {
        band::given(reader, table, prefix, Bounds::POSITIVE)
    });
    let (waveform, middle) = read.unzip();
    let wave = (waveform.as_ref(), context.has_actuator);
    let mean = mean(reader, (prefix, node, table), target.as_ref());
    let amplitude = if is_factor(table) {
        factor(reader, (prefix, node, table))
    } else {
        dither_size::read(reader, table, (prefix, node.origin), wave)
    };
    let (frequency, phase) = if is_noise {
        (middle.flatten(), Some(0.0))
    } else {
        let parameter = SYSTEM_DITHER_FREQUENCY;
        let frequency = reader.number(table, prefix, node.origin, parameter);
        (frequency, reader.optional(table, prefix, DITHER_PHASE).or(0.0))
    };
    let envelope =
        CoursePlace(ENVELOPE).optional(reader, table, prefix, "envelope").map(Course::knots);
    let wave = Wave {
        waveform: waveform?,
        amplitude: amplitude.as_ref()?.so_far(),
        frequency: frequency?,
        phase: phase?,
        envelope: envelope.ok()?,
    };
    Some((Input { target: target?, profile: Profile::constant(mean?).with(wave) }, amplitude?))
}

/// The amplitude of a factor on friction.
fn factor(
    reader: &mut Reader,
    (prefix, node, table): (&str, &Node, &Table),
) -> Option<SizedAmplitude> {
    let twins = DITHER_AMPLITUDE.si.iter().map(|twin| twin.key);
    let of_a_force = twins.chain(DITHER_SIZES.iter().map(|size| size.key));
    for name in of_a_force.filter(|name| table.has(name)) {
        let Some(other) = table.get(name) else { continue };
        let allowed = format!(
            "left out: a factor on friction has no force; its amplitude is {}",
            join(prefix, FRICTION_FACTOR.key())
        );
        let key = join(prefix, name);
        reader.complain(Complaint::new(Fault::Conflict, key, other.origin, other.given(), allowed));
        return None;
    }
    let amplitude = reader.number(table, prefix, node.origin, FRICTION_FACTOR)?;
    Some(SizedAmplitude::Known(amplitude, None))
}

/// The mean of what a dither adds: that of a factor on friction, and zero of a force or a load.
fn mean(
    reader: &mut Reader,
    (prefix, _, table): (&str, &Node, &Table),
    target: Option<&InputTarget>,
) -> Option<f64> {
    let given = reader.optional(table, prefix, FRICTION_FACTOR_MEAN).if_given()?;
    match (given, target?) {
        (mean, InputTarget::Friction { .. }) => Some(mean.unwrap_or(1.0)),
        (None, _) => Some(0.0),
        (Some(mean), _) => {
            let key = join(prefix, FRICTION_FACTOR_MEAN.key());
            let origin =
                table.get(FRICTION_FACTOR_MEAN.key()).map_or(Origin::Whole, |node| node.origin);
            let allowed =
                "left out: only a factor on friction (direction = \"friction\") has a mean";
            reader.complain(Complaint::new(Fault::Conflict, key, origin, mean, allowed));
            None
        }
    }
}

/// Where a dither enters: `at`, or `contact`.
fn target(
    reader: &mut Reader,
    prefix: &str,
    node: &Node,
    table: &Table,
    context: DitherContext<'_>,
) -> Option<InputTarget> {
    let Some(at) = table.get("at") else {
        let Some(contact) = table.get("contact") else {
            // Of a contact the direction is needed too: a study that has one acts on a contact.
            let key = if table.has("direction") { "contact" } else { "at" };
            let allowed = match key {
                "contact" => "the name of the contact on which the dither acts",
                _ => {
                    "a row over the coordinates, such as { x = 1.0 }, or in its place contact and direction, the name of the contact \
                     on which the dither acts and how"
                }
            };
            reader.missing(join(prefix, key), node.origin, allowed);
            return None;
        };
        return of_contact(reader, prefix, node, table, contact, context);
    };
    for name in ["contact", "direction", "reaction"] {
        if let Some(other) = table.get(name) {
            let key = join(prefix, name);
            let allowed = format!(
                "give either {}, a force on coordinates, or contact and direction, not both",
                join(prefix, "at")
            );
            let complaint =
                Complaint::new(Fault::Conflict, key, other.origin, other.given(), allowed);
            reader.complain(complaint);
            return None;
        }
    }
    let key = join(prefix, "at");
    let row = context.basis.row_not_zero(reader, &key, at)?;
    Some(InputTarget::Force(row))
}

fn of_contact(
    reader: &mut Reader,
    prefix: &str,
    node: &Node,
    table: &Table,
    contact: &Node,
    context: DitherContext<'_>,
) -> Option<InputTarget> {
    let direction =
        reader.needed_choice(table, prefix, node.origin, "direction", Choice::ContactDirection);
    let key = join(prefix, "contact");
    let name = reader.text(&key, contact)?;
    let Some(index) = context.names.iter().position(|known| *known == name) else {
        let listed = context.names.join(", ");
        let nearest = nearest::word(&name, context.names.iter().map(String::as_str));
        let complaint = Complaint::new(
            Fault::Value,
            key,
            contact.origin,
            name,
            format!("the name of a contact: {listed}"),
        );
        reader.complain(complaint.suggesting(nearest));
        return None;
    };
    let reaction = match table.get("reaction").map(|node| (node, &node.value)) {
        None => None,
        Some((_, Value::Flag(flag))) => Some(*flag),
        Some((node, _)) => {
            let allowed = format!("true or false; got {}", node.kind());
            reader.wrong(&join(prefix, "reaction"), node, allowed);
            return None;
        }
    };
    let found = context.contacts?.get(index)?;
    let direction = direction?;
    if direction == FRICTION {
        if let (Some(flag), Some(node)) = (reaction, table.get("reaction")) {
            let allowed = "left out: a factor on friction adds no load";
            let key = join(prefix, "reaction");
            reader.complain(Complaint::new(Fault::Conflict, key, node.origin, flag, allowed));
            return None;
        }
        return Some(InputTarget::Friction { contact: index });
    }
    if direction == "tangential" {
        let along = found.force.as_ref().or(found.tangent.as_ref());
        if along.is_none() {
            reader.wrong(&key, contact, "a contact with a tangent, along which the force acts");
        }
        return along.cloned().map(InputTarget::Force);
    }
    let compliant = found.normal.is_some();
    if reaction == Some(true) && !compliant {
        let at = table.get("reaction").map_or(node, |node| node);
        let allowed =
            "the load of a contact without normal is prescribed: guides bear its modulation";
        let key = join(prefix, "reaction");
        reader.complain(Complaint::new(Fault::Conflict, key, at.origin, true, allowed));
        return None;
    }
    let reaction = compliant && reaction.unwrap_or(true);
    Some(InputTarget::NormalLoad { contact: index, reaction })
}

/// Reports a second factor on the friction of a contact that has a mean: factors are added, and their mean is given once.
fn one_mean(reader: &mut Reader, tables: &[(String, &Node, &Table)], inputs: &[Option<Input>]) {
    let mut seen = Vec::new();
    for (input, (prefix, node, _)) in inputs.iter().zip(tables) {
        let Some(Input { target: InputTarget::Friction { contact }, profile }) = input else {
            continue;
        };
        if seen.contains(contact) && profile.mean() != 0.0 {
            let key = join(prefix, FRICTION_FACTOR_MEAN.key());
            let allowed = "0 for a further factor on the friction of a contact: the factors are added, and the first has their mean";
            let given = profile.mean();
            reader.complain(Complaint::new(Fault::Conflict, key, node.origin, given, allowed));
        }
        seen.push(*contact);
    }
}

/// Reports loads that are prescribed and modulated so much that they would vanish.
fn stays_pressed(
    reader: &mut Reader,
    tables: &[(String, &Node, &Table)],
    inputs: &[Option<Input>],
    (contacts, coordinates): (&[Contact], usize),
) {
    for (index, contact) in contacts.iter().enumerate() {
        let mut fall = 0.0;
        let mut last = None;
        for (input, table) in inputs.iter().zip(tables) {
            let Some(Input { target: InputTarget::NormalLoad { contact, .. }, profile }) = input
            else {
                continue;
            };
            if *contact == index {
                fall += profile.waves().iter().map(|wave| -wave.range().lower).sum::<f64>();
                last = Some(table);
            }
        }
        let Some(allowed) = lifted(contact, fall, (contacts.len(), coordinates)) else { continue };
        let Some((prefix, _, table)) = last else { continue };
        let twins = DITHER_AMPLITUDE.si.iter().map(|twin| twin.key);
        let sizes = DITHER_SIZES.iter().map(|size| size.key);
        let written = [DITHER_AMPLITUDE.key()]
            .into_iter()
            .chain(twins)
            .chain(sizes)
            .find_map(|name| Some((join(prefix, name), table.get(name)?)));
        if let Some((key, node)) = written {
            reader.wrong(&key, node, allowed);
        }
    }
}

/// What is allowed where modulations that fall so far below their means together lift a contact whose load is prescribed, in a system of so
/// many contacts and coordinates; `None` if it stays pressed.
pub(super) fn lifted(
    contact: &Contact,
    fall: f64,
    (contacts, coordinates): (usize, usize),
) -> Option<String> {
    // The engine of one mass takes a load that touches zero.
    let may_touch = contacts == 1 && coordinates == 1;
    let least = contact.load().bounds().lower;
    let is_too_much = fall > least || (fall == least && !may_touch);
    let few = if may_touch { "at most" } else { "less than" };
    (contact.normal.is_none() && is_too_much).then(|| {
        let [least, fall] = [least, fall].map(|load| digits(load, 6));
        format!(
            "such that the modulations of contact {} take off {few} its load {least}: they take off {fall}, and a prescribed load must stay positive",
            contact.name
        )
    })
}
