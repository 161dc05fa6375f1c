//! Reads keys out of the mirror, turns SI into the numbers of the equations, and collects
//! every complaint.
//!
//! A study is in one system. It is in SI as soon as `belt.mass_kg` or
//! `belt.stiffness_n_per_m` is there, or where all its quantities are; then a dimensionless
//! key that has an SI twin is refused, and the other way round.

use quell_model::parameter::{Bounds, Parameter, SCALES, ScaleKey, SiTwin};
use quell_model::units::{Quantity, Scales};
use quell_model::{Invalid, Waveform};
use serde_json::Value as Json;

use super::mirror::{Node, Table, Value, given_number};
use super::suggest;
use super::vocabulary::{self, Choice, Role, Section, join};
use crate::complaint::{Complaint, Fault, Origin};

/// The system a study is written in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Units {
    /// The numbers of the equations.
    Scaled,
    /// SI; without scales where mass or stiffness are wrong.
    Si(Option<Scales>),
}

/// Where and how a parameter was written.
#[derive(Clone, Debug)]
struct Written {
    /// Path in the registry, with index.
    path: String,
    /// Path of the key that gave it.
    key: String,
    origin: Origin,
    /// What one unit of the equations is in the unit of that key.
    factor: f64,
}

/// Reads keys and collects complaints.
#[derive(Debug)]
pub(super) struct Reader {
    units: Units,
    complaints: Vec<Complaint>,
    written: Vec<Written>,
}

impl Reader {
    /// Finds out the system of a study and reads its scales.
    pub(super) fn new(root: &Table) -> Self {
        let mut reader = Self {
            units: Units::Scaled,
            complaints: Vec::new(),
            written: Vec::new(),
        };
        if is_si(root) {
            reader.units = Units::Si(None);
            if let Some(belt) = root.get("belt") {
                reader.units = Units::Si(reader.scales(belt));
            }
        }
        reader
    }

    /// The scales, in a study in SI whose mass and stiffness are right.
    pub(super) fn known_scales(&self) -> Option<Scales> {
        match self.units {
            Units::Si(scales) => scales,
            Units::Scaled => None,
        }
    }

    /// Adds a complaint.
    pub(super) fn complain(&mut self, complaint: Complaint) {
        self.complaints.push(complaint);
    }

    /// All complaints, in the order of the text.
    pub(super) fn into_complaints(mut self) -> Vec<Complaint> {
        self.complaints
            .sort_by_key(|complaint| complaint.origin.line().unwrap_or(usize::MAX));
        self.complaints
    }

    fn scales(&mut self, belt: &Node) -> Option<Scales> {
        let table = belt.table()?;
        let [mass, stiffness] = [SCALES[0], SCALES[1]].map(|scale| self.scale(table, scale, belt.origin));
        Scales::new(mass?, stiffness?).ok()
    }

    fn scale(&mut self, table: &Table, scale: ScaleKey, header: Origin) -> Option<f64> {
        let Some(node) = table.get(scale.key()) else {
            let allowed = format!(
                "{} in {} ({}, {}); a study in SI needs mass and stiffness",
                scale.bounds, scale.unit, scale.symbol, scale.about
            );
            self.complain(Complaint::new(Fault::Missing, scale.path, header, Json::Null, allowed));
            return None;
        };
        self.within(scale.path, node, scale.bounds, scale.unit, false)
    }

    /// A parameter that has to be there.
    pub(super) fn number(
        &mut self,
        table: &Table,
        prefix: &str,
        header: Origin,
        parameter: Parameter,
    ) -> Option<f64> {
        match self.optional(table, prefix, parameter, None) {
            Found::Value(value) => Some(value),
            Found::Wrong => None,
            Found::Absent => {
                let keys = self.right_keys(parameter);
                let Parameter { bounds, symbol, about, .. } = parameter;
                let or = keys.get(1).map(|key| format!("; or {}", join(prefix, key)));
                let allowed = format!("{bounds} ({symbol}, {about}){}", or.unwrap_or_default());
                let key = join(prefix, &keys[0]);
                self.complain(Complaint::new(Fault::Missing, key, header, Json::Null, allowed));
                None
            }
        }
    }

    /// A parameter that may be absent. The waveform turns a root mean square into a peak.
    pub(super) fn optional(
        &mut self,
        table: &Table,
        prefix: &str,
        parameter: Parameter,
        waveform: Option<Waveform>,
    ) -> Found {
        let twins: Vec<SiTwin> =
            parameter.si.iter().copied().filter(|twin| table.has(twin.key)).collect();
        let plain = table.get(parameter.key());
        let si = matches!(self.units, Units::Si(_));
        match (plain, twins.as_slice()) {
            (None, []) => Found::Absent,
            (Some(node), []) if !si || parameter.si.is_empty() => {
                self.plain(node, &join(prefix, parameter.key()), parameter)
            }
            (None, [twin]) if si => self.twin(table, prefix, parameter, *twin, waveform),
            (None, [first, .., last]) if si => {
                let key = join(prefix, last.key);
                let allowed = format!("say either {} or {}, not both", join(prefix, first.key), key);
                let node = table.get(last.key);
                let origin = node.map_or(Origin::Whole, |node| node.origin);
                let given = node.map_or(Json::Null, Node::given);
                self.complain(Complaint::new(Fault::Conflict, key, origin, given, allowed));
                Found::Wrong
            }
            (plain, twins) => {
                self.mixed(table, prefix, parameter, plain, twins);
                Found::Wrong
            }
        }
    }

    /// Complains about keys of the wrong system.
    fn mixed(
        &mut self,
        table: &Table,
        prefix: &str,
        parameter: Parameter,
        plain: Option<&Node>,
        twins: &[SiTwin],
    ) {
        let plain_key = join(prefix, parameter.key());
        let twin_key = join(prefix, twins.first().unwrap_or(&parameter.si[0]).key);
        if matches!(self.units, Units::Si(_)) {
            let Some(node) = plain else { return };
            let instead = if twins.is_empty() { "give" } else { "drop it and keep" };
            let allowed = format!(
                "this study is in SI, {plain_key} is dimensionless: {instead} {twin_key} ({})",
                parameter.si[0].unit
            );
            let complaint = Complaint::new(Fault::Mixed, plain_key, node.origin, node.given(), allowed);
            self.complain(complaint.suggesting(Some(twin_key)));
            return;
        }
        for twin in twins {
            let Some(node) = table.get(twin.key) else { continue };
            let key = join(prefix, twin.key);
            let allowed = format!(
                "this study is dimensionless, {key} is in SI: give {plain_key}, or make the whole \
                 study one in SI with belt.mass_kg and belt.stiffness_n_per_m"
            );
            let complaint = Complaint::new(Fault::Mixed, key, node.origin, node.given(), allowed);
            self.complain(complaint.suggesting(Some(plain_key.clone())));
        }
    }

    fn plain(&mut self, node: &Node, key: &str, parameter: Parameter) -> Found {
        let count = parameter.quantity == Quantity::Count;
        let value = self.within(key, node, parameter.bounds, "", count);
        self.remember(key, key, node.origin, 1.0);
        value.map_or(Found::Wrong, Found::Value)
    }

    fn twin(
        &mut self,
        table: &Table,
        prefix: &str,
        parameter: Parameter,
        twin: SiTwin,
        waveform: Option<Waveform>,
    ) -> Found {
        let Some(node) = table.get(twin.key) else {
            return Found::Absent;
        };
        let key = join(prefix, twin.key);
        let rms = match (twin.rms, waveform) {
            (true, Some(waveform)) => Some(waveform.root_mean_square()),
            (true, None) => None,
            (false, _) => Some(1.0),
        };
        let factor = self
            .known_scales()
            .zip(rms)
            .map(|(scales, rms)| scales.si_per_unit(parameter.quantity) * rms);
        // Without scales the sign can still be judged.
        let scale = factor.unwrap_or(1.0);
        let judged = factor.is_some() || (parameter.bounds.lower == 0.0 && parameter.bounds.upper.is_infinite());
        let bounds = if judged {
            Bounds {
                lower: parameter.bounds.lower * scale,
                upper: parameter.bounds.upper * scale,
                ..parameter.bounds
            }
        } else {
            Bounds::FINITE
        };
        let Some(given) = self.within(&key, node, bounds, twin.unit, false) else {
            return Found::Wrong;
        };
        let Some((scales, rms)) = self.known_scales().zip(rms) else {
            return Found::Wrong;
        };
        self.remember(&join(prefix, parameter.key()), &key, node.origin, scale);
        Found::Value(scales.from_si(parameter.quantity, given / rms))
    }

    /// A finite number within bounds.
    pub(super) fn within(
        &mut self,
        key: &str,
        node: &Node,
        bounds: Bounds,
        unit: &str,
        whole: bool,
    ) -> Option<f64> {
        let range = if whole {
            bounds.to_string().replacen("number", "whole number", 1)
        } else {
            bounds.to_string()
        };
        let range = if unit.is_empty() { range } else { format!("{range}, in {unit}") };
        let Value::Number(value) = node.value else {
            let advice = match &node.value {
                Value::Text(text) if text.trim().parse::<f64>().is_ok() => ", without quotes",
                _ => "",
            };
            let allowed = format!("{range}{advice}; this is {}", node.kind());
            self.wrong(key, node, allowed);
            return None;
        };
        if !bounds.contains(value) || (whole && value.fract() != 0.0) {
            self.wrong(key, node, range);
            return None;
        }
        Some(value)
    }

    /// A word out of a list.
    pub(super) fn choice(&mut self, key: &str, node: &Node, choice: Choice) -> Option<&'static str> {
        let names = choice.names();
        let list = names.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ");
        let Value::Text(text) = &node.value else {
            self.wrong(key, node, format!("one of {list}; this is {}", node.kind()));
            return None;
        };
        let found = names.iter().copied().find(|name| name == text);
        if found.is_none() {
            let nearest = suggest::word(text, names.iter().copied()).map(|name| format!("\"{name}\""));
            let complaint =
                Complaint::new(Fault::Value, key, node.origin, node.given(), format!("one of {list}"));
            self.complain(complaint.suggesting(nearest));
        }
        found
    }

    /// A word out of a list that has to be there.
    pub(super) fn needed_choice(
        &mut self,
        table: &Table,
        prefix: &str,
        header: Origin,
        name: &str,
        choice: Choice,
    ) -> Option<&'static str> {
        let key = join(prefix, name);
        let Some(node) = table.get(name) else {
            let list = choice.names().iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>();
            let allowed = format!("one of {}", list.join(", "));
            self.complain(Complaint::new(Fault::Missing, key, header, Json::Null, allowed));
            return None;
        };
        self.choice(&key, node, choice)
    }

    /// Free text.
    pub(super) fn text(&mut self, key: &str, node: &Node) -> Option<String> {
        let Value::Text(text) = &node.value else {
            self.wrong(key, node, format!("a string in quotes; this is {}", node.kind()));
            return None;
        };
        Some(text.clone())
    }

    /// Complains about a value.
    pub(super) fn wrong(&mut self, key: &str, node: &Node, allowed: impl Into<String>) {
        self.complain(Complaint::new(Fault::Value, key, node.origin, node.given(), allowed));
    }

    /// A table of the root or of `[belt]`; a complaint where it is something else.
    pub(super) fn table<'a>(&mut self, key: &str, node: &'a Node) -> Option<&'a Table> {
        let table = node.table();
        if table.is_none() {
            self.wrong(key, node, format!("a table [{key}]; this is {}", node.kind()));
        }
        table
    }

    /// Complains about keys that a table does not have.
    pub(super) fn unknown_keys(&mut self, table: &Table, section: Section, prefix: &str, also: &[&str]) {
        for (name, node) in table.iter() {
            if vocabulary::key(section, name).is_some() || also.contains(&name) {
                continue;
            }
            self.unknown_key(section, prefix, name, node);
        }
    }

    /// Complains about one unknown key.
    pub(super) fn unknown_key(&mut self, section: Section, prefix: &str, name: &str, node: &Node) {
        let index = prefix
            .split_once('[')
            .and_then(|(_, rest)| rest.trim_end_matches(']').parse().ok());
        let si = matches!(self.units, Units::Si(_));
        let there: Vec<&str> = vocabulary::keys_of(section)
            .filter(|key| match key.role {
                Role::Number(parameter) => !si || parameter.si.is_empty(),
                Role::Twin(..) | Role::Scale(_) => si,
                _ => true,
            })
            .map(|key| key.name)
            .collect();
        let complaint = Complaint::new(
            Fault::Unknown,
            join(prefix, name),
            node.origin,
            node.given(),
            there.join(", "),
        );
        self.complain(complaint.suggesting(suggest::path(section.path(), name, index)));
    }

    /// Adds what a constructor of the model said, in the words of the file. What was
    /// already complained about is not said again.
    pub(super) fn adopt(&mut self, invalid: Vec<Invalid>) {
        for complaint in invalid {
            let written = self.written.iter().find(|written| written.path == complaint.key);
            let Some(written) = written else { continue };
            let key = written.key.clone();
            if self.complaints.iter().any(|known| known.key == key) {
                continue;
            }
            let number = complaint.value.parse::<f64>();
            let value = number.map_or(Json::String(complaint.value), |number| {
                given_number(number * written.factor)
            });
            let origin = written.origin;
            self.complain(Complaint::new(Fault::Value, key, origin, value, complaint.allowed));
        }
    }

    fn remember(&mut self, path: &str, key: &str, origin: Origin, factor: f64) {
        self.written.push(Written {
            path: path.to_owned(),
            key: key.to_owned(),
            origin,
            factor,
        });
    }

    /// Keys that give a parameter in the system of this study.
    fn right_keys(&self, parameter: Parameter) -> Vec<String> {
        match self.units {
            Units::Si(_) if !parameter.si.is_empty() => {
                parameter.si.iter().map(|twin| twin.key.to_owned()).collect()
            }
            _ => vec![parameter.key().to_owned()],
        }
    }
}

/// What was found under a parameter's keys.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Found {
    /// A valid value in the numbers of the equations.
    Value(f64),
    /// Something that was complained about.
    Wrong,
    /// Nothing.
    Absent,
}

impl Found {
    /// The value, or the default where nothing was given.
    pub(super) fn or(self, default: f64) -> Option<f64> {
        match self {
            Self::Value(value) => Some(value),
            Self::Absent => Some(default),
            Self::Wrong => None,
        }
    }
}

/// Whether a study is in SI.
fn is_si(root: &Table) -> bool {
    let (mut plain, mut twins) = (false, false);
    for section in Section::ALL {
        for table in tables(root, *section) {
            for (name, _) in table.iter() {
                match vocabulary::key(*section, name).map(|key| key.role) {
                    Some(Role::Scale(_)) => return true,
                    Some(Role::Twin(..)) => twins = true,
                    Some(Role::Number(parameter)) if !parameter.si.is_empty() => plain = true,
                    _ => {}
                }
            }
        }
    }
    twins && !plain
}

/// The tables of a section.
fn tables(root: &Table, section: Section) -> Vec<&Table> {
    let node = match section {
        Section::Root | Section::Sweep => None,
        Section::Initial => root
            .get("belt")
            .and_then(Node::table)
            .and_then(|belt| belt.get("initial")),
        _ => root.get(section.path()),
    };
    match node.map(|node| &node.value) {
        Some(Value::Table(table)) => vec![table],
        Some(Value::List(list)) => list.iter().filter_map(Node::table).collect(),
        _ => Vec::new(),
    }
}
