//! A study of a belt or a disc written as the system that it describes, with the numbers of its equations.
//!
//! A belt keeps its own keys, under the names that a system has for them; a disc is written by its modes in the frame of its loads, in SI
//! where its scales are known. What a system cannot say is left out and named.

use quell_input::complaint::{Complaint, Complaints, Fault, Origin};
use quell_input::document::{Node, Table, Value};
use quell_model::disc::Contribution;
use quell_model::system::{Contact, Input, InputTarget, MassMatrix, Structure};
use quell_model::units::UnitSystem;
use quell_model::{Friction, System};
use quell_numerics::matrix::Matrix;
use serde_json::Value as Json;

use super::belt::BeltSetup;
use super::disc::DiscSetup;
use super::system::SystemStart;
use super::vocabulary::WAVE_KEYS;
use super::{Kind, Study};

/// The name of the contact of a belt.
const BELT: &str = "belt";

/// A study as a system.
#[derive(Clone, Debug)]
pub struct ConvertedStudy {
    /// The study, whose text is that of a system.
    pub study: Study,
    /// The tables of the original for which a system has no place.
    pub left_out: Vec<String>,
    /// Whether the friction of the original is given as a force.
    pub by_force: bool,
    /// Whether it names files, relative to the folder of the original.
    pub names_files: bool,
}

impl ConvertedStudy {
    /// What was left out, and what is not known, in sentences.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        if !self.left_out.is_empty() {
            let tables = self.left_out.join(", ");
            warnings.push(format!(
                "left out, as a system has no such table or not these numbers: {tables}"
            ));
        }
        if self.by_force {
            let words = "friction is given as a force, of which a contact has the load and the coefficient: only their product is known, and \
                         a contact of another load opens elsewhere; normal_load and [friction] of the disc give both";
            warnings.push(words.to_owned());
        }
        warnings
    }
}

impl Study {
    /// The study as that of a system.
    ///
    /// ```
    /// use quell_study::Study;
    ///
    /// let study = Study::parse(
    ///     "[belt]\ndamping_ratio = 0.01\nnormal_load = 1\nbelt_velocity = 0.1\n[friction]\nlaw = 'coulomb'\ncoefficient = 0.3\n",
    ///     &[],
    /// )?;
    /// let converted = study.as_system()?;
    /// assert!(converted.study.text().contains("[system]\ncoordinates = [\"x\"]\nmass = [1]\ndamping = [0.02]"));
    /// assert_eq!(converted.study.system().system(), study.system().system());
    /// # Ok::<(), quell_input::complaint::Complaints>(())
    /// ```
    ///
    /// # Errors
    /// A study of a system; a disc that varies in time, or whose friction is a formula or a measured curve.
    pub fn as_system(&self) -> Result<ConvertedStudy, Complaints> {
        let mut converted = SystemDocument { own: &self.source.document, left_out: Vec::new() };
        let document = match self.kind() {
            Kind::Belt(setup) => Ok(converted.mass(setup)),
            Kind::Disc(setup) => converted.plate(setup, self.varies_by()),
            Kind::System(_) => Err(refused(
                "system",
                "a study of a belt or a disc: this one is a system already, of which only the contacts can be replaced by fewer",
            )),
        }?;
        let left_out = converted.left_out;
        let study = Self::parse_with(&document.to_toml(), &[], &self.source.files)?;
        let by_force = matches!(self.kind(), Kind::Disc(setup) if setup.disc().law().is_none() && !setup.disc().loads().is_empty());
        Ok(ConvertedStudy { study, left_out, by_force, names_files: names_files(&document) })
    }
}

impl Study {
    /// Whether it names files, relative to its folder.
    pub fn names_files(&self) -> bool {
        names_files(&self.source.document)
    }
}

/// Whether a value is the name of a file.
fn names_files(table: &Table) -> bool {
    table.iter().any(|(key, given)| {
        let inner = given.entries().iter().filter_map(Node::table);
        key == "file" || inner.into_iter().any(names_files)
    })
}

fn refused(key: &str, allowed: impl Into<String>) -> Complaints {
    Complaint::new(Fault::Conflict, key, Origin::Whole, Json::Null, allowed.into()).into()
}

fn node(value: Value) -> Node {
    Node { value, origin: Origin::Whole }
}

/// A number; zero without a sign.
fn number(value: f64) -> Node {
    node(Value::Number(value + 0.0))
}

fn text(value: &str) -> Node {
    node(Value::Text(value.to_owned()))
}

fn row(values: &[f64]) -> Node {
    node(Value::List(values.iter().map(|value| number(*value)).collect()))
}

/// A matrix, its diagonal alone where the others are zero.
fn matrix(matrix: &Matrix) -> Node {
    let n = matrix.rows();
    let is_diagonal = (0..n).all(|i| (0..n).all(|j| i == j || matrix[(i, j)] == 0.0));
    if is_diagonal {
        return row(&(0..n).map(|i| matrix[(i, i)]).collect::<Vec<f64>>());
    }
    node(Value::List((0..n).map(|i| row(matrix.row(i))).collect()))
}

/// The document of a system that is made of another.
struct SystemDocument<'d> {
    own: &'d Table,
    left_out: Vec<String>,
}

impl SystemDocument<'_> {
    /// What every study begins with.
    fn begun(&self) -> Table {
        let mut document = Table::default();
        for key in ["schema", "title"] {
            if let Some(given) = self.own.get(key) {
                document.set(key, given.clone());
            }
        }
        document
    }

    /// Adds tables that a system has too, and names the others that the study has.
    fn keep(&mut self, document: &mut Table, kept: &[&str]) {
        for (name, given) in self.own.iter() {
            if kept.contains(&name) {
                document.set(name, given.clone());
                continue;
            }
            let is_table = given.entries().iter().any(|entry| entry.table().is_some());
            let whole = format!("[{name}]");
            let is_known = OF_EQUATIONS.contains(&name)
                || self.left_out.iter().any(|known| known.starts_with(&whole));
            if is_table && !is_known && !document.has(name) {
                self.left_out.push(whole);
            }
        }
    }

    /// One mass, by the keys of its belt.
    fn mass(&mut self, setup: &BeltSetup) -> Table {
        let own = setup.system();
        let mut document = self.begun();
        let mut structure = structure(own.system(), own.units());
        match own.initial() {
            SystemStart::Rest | SystemStart::Described { .. } => {}
            SystemStart::Values(values) => set_initial(&mut structure, "values", row(values)),
            SystemStart::Sliding => set_initial(&mut structure, "state", text("sliding")),
            SystemStart::Squealing => set_initial(&mut structure, "state", text("squealing")),
            SystemStart::Base => set_initial(&mut structure, "state", text("base")),
        }
        document.set("system", node(Value::Table(structure)));
        let mut contact = Table::default();
        contact.set("name", text(BELT));
        contact.set("tangent", row(&[1.0]));
        for (key, given) in
            self.own.get("belt").and_then(Node::table).into_iter().flat_map(Table::iter)
        {
            if let Some(name) = key_of_contact(key) {
                contact.set(name, given.clone());
            }
        }
        document.set("contact", node(Value::List(vec![node(Value::Table(contact))])));
        if let Some(law) = self.own.get("friction") {
            document.set("friction", law.clone());
        }
        let dithers = self.own.get("dither").map_or(&[][..], Node::entries);
        let dithers: Vec<Node> = dithers
            .iter()
            .filter_map(Node::table)
            .map(|table| node(Value::Table(belt_dither(table))))
            .collect();
        if !dithers.is_empty() {
            document.set("dither", node(Value::List(dithers)));
        }
        self.ask(&mut document);
        self.keep(&mut document, &["actuator"]);
        document
    }

    /// The tables that ask something, by the paths of the system; one that varies what a system does not have is left out.
    fn ask(&mut self, document: &mut Table) {
        for name in ["sweep", "design", "uncertainty"] {
            let Some(given) = self.own.get(name) else { continue };
            match asked(name, given) {
                Ok(asked) => document.set(name, asked),
                Err(NoCounterpart(path)) => self.left_out.push(format!("[{name}], by {path}")),
            }
        }
    }

    /// The modes of a plate in the frame of its loads, by the numbers of the equations.
    fn plate(
        &mut self,
        setup: &DiscSetup,
        varies_by: Option<&'static str>,
    ) -> Result<Table, Complaints> {
        if let Some(key) = varies_by {
            let allowed = "left out, or its value at a moment: a disc that varies in time is not written as a system";
            return Err(refused(key, allowed));
        }
        if !setup.parts().contains(Contribution::FollowerForce) && !setup.disc().loads().is_empty()
        {
            let allowed = "without \"follower-force\": a system has no contact without friction";
            return Err(refused("disc.without", allowed));
        }
        if setup.disc().loads().iter().any(|load| load.static_load != 0.0) {
            self.left_out.push("disc.load.static_load".to_owned());
        }
        let (system, units) = setup.in_si().map_err(|invalid| {
            let first = invalid.into_iter().next();
            first.map_or_else(
                || refused("disc", "numbers in SI"),
                |one| refused(&one.key, one.allowed),
            )
        })?;
        let mut document = self.begun();
        let mut structure = structure(&system, units);
        structure.set("observe", row(&setup.observed_row()));
        document.set("system", node(Value::Table(structure)));
        let contacts: Result<Vec<Node>, Complaints> = system
            .contacts
            .iter()
            .map(|contact| Ok(node(Value::Table(contact_table(contact)?))))
            .collect();
        let contacts = contacts?;
        if !contacts.is_empty() {
            document.set("contact", node(Value::List(contacts)));
        }
        let waveform = self.own.get("dither").and_then(|given| given.entries().first());
        let waveform = waveform.and_then(Node::table);
        let dithers =
            system.inputs.iter().filter_map(|input| load_dither(&system, input, waveform));
        let dithers: Vec<Node> = dithers.map(|table| node(Value::Table(table))).collect();
        if !dithers.is_empty() {
            document.set("dither", node(Value::List(dithers)));
        }
        self.keep(&mut document, &["actuator"]);
        Ok(document)
    }
}

/// The tables whose numbers are in the equations.
const OF_EQUATIONS: [&str; 4] = ["belt", "disc", "friction", "dither"];

fn set_initial(structure: &mut Table, key: &str, value: Node) {
    let mut initial = Table::default();
    initial.set(key, value);
    structure.set("initial", node(Value::Table(initial)));
}

fn structure(system: &System, units: UnitSystem) -> Table {
    let mut table = Table::default();
    if units != UnitSystem::None {
        table.set("units", text(units.name()));
    }
    let names = system.structure.names().iter().map(|name| text(name));
    table.set("coordinates", node(Value::List(names.collect())));
    if let Structure::Mechanical(own) = &system.structure {
        table.set("mass", matrix(&MassMatrix::matrix(own.mass())));
        table.set("damping", matrix(own.damping()));
        table.set("stiffness", matrix(own.stiffness()));
        if own.force().iter().any(|force| *force != 0.0) {
            table.set("force", row(own.force()));
        }
    }
    table
}

/// The key of a contact for a key of `[belt]`; `None` for those of the mass itself.
fn key_of_contact(key: &str) -> Option<&str> {
    match key {
        "normal_force_n" => Some("normal_load_n"),
        "drive" | "load" => Some(key),
        _ if ["normal_load", "belt_velocity", "tangential_stiffness", "normal_stiffness"]
            .iter()
            .any(|known| key.starts_with(known)) =>
        {
            Some(key)
        }
        _ => None,
    }
}

/// The dither of a belt: a force on its mass, or on the load of its contact.
fn belt_dither(own: &Table) -> Table {
    let mut table = Table::default();
    let direction = own.get("direction").map(|node| &node.value);
    let normal = matches!(direction, Some(Value::Text(word)) if word == "normal");
    if normal {
        table.set("contact", text(BELT));
    } else {
        table.set("at", row(&[1.0]));
    }
    for (key, given) in own.iter().filter(|(key, _)| normal || *key != "direction") {
        table.set(key, given.clone());
    }
    table
}

/// The path of a number of a belt in its system.
fn renamed(path: &str) -> Option<String> {
    let Some(key) = path.strip_prefix("belt.") else {
        return Some(path.to_owned());
    };
    let (first, rest) = key.split_once('.').map_or((key, ""), |(first, rest)| (first, rest));
    let own = key_of_contact(first)?;
    let dot = if rest.is_empty() { "" } else { "." };
    Some(format!("contact.{BELT}.{own}{dot}{rest}"))
}

/// A path of a number that a system does not have.
struct NoCounterpart(String);

/// A table that asks something, with the paths of the system; the first path that has no counterpart, if one has none.
fn asked(name: &str, given: &Node) -> Result<Node, NoCounterpart> {
    let named = |path: &str| renamed(path).ok_or_else(|| NoCounterpart(path.to_owned()));
    let path = |node: &mut Node| -> Result<(), NoCounterpart> {
        if let Value::Text(path) = &mut node.value {
            *path = named(path)?;
        }
        Ok(())
    };
    let keys = |table: &Table| -> Result<Table, NoCounterpart> {
        let mut other = Table::default();
        for (key, value) in table.iter() {
            other.set(&named(key)?, value.clone());
        }
        Ok(other)
    };
    let mut asked = given.clone();
    match (&mut asked.value, name) {
        (Value::List(axes), "sweep") => {
            for axis in axes.iter_mut().filter_map(Node::table_mut) {
                axis.get_mut("parameter").map_or(Ok(()), path)?;
            }
        }
        (Value::Table(axis), "sweep") => axis.get_mut("parameter").map_or(Ok(()), path)?,
        (Value::Table(design), "design") => {
            if let Some(Value::List(varied)) = design.get_mut("vary").map(|node| &mut node.value) {
                varied.iter_mut().try_for_each(path)?;
            }
            if let Some(over) = design.get_mut("over")
                && let Some(table) = over.table()
            {
                over.value = Value::Table(keys(table)?);
            }
        }
        (Value::Table(table), _) => asked.value = Value::Table(keys(table)?),
        _ => {}
    }
    Ok(asked)
}

/// A contact of a disc.
fn contact_table(contact: &Contact) -> Result<Table, Complaints> {
    let mut table = Table::default();
    table.set("name", text(&plain(&contact.name)));
    let rows =
        [("tangent", &contact.tangent), ("normal", &contact.normal), ("slope", &contact.slope)];
    for (key, given) in rows {
        if let Some(entries) = given {
            table.set(key, row(entries));
        }
    }
    table.set("normal_load", number(contact.normal_load));
    for (key, value) in
        [("normal_stiffness", contact.normal_stiffness), ("normal_damping", contact.normal_damping)]
    {
        if value != 0.0 {
            table.set(key, number(value));
        }
    }
    table.set("belt_velocity", number(contact.surface_velocity.mean()));
    table.set("friction", node(Value::Table(law_table(&contact.friction)?)));
    Ok(table)
}

/// The numbers of a law.
fn law_table(law: &Friction) -> Result<Table, Complaints> {
    if matches!(law, Friction::Expression(_) | Friction::Samples(_)) {
        let allowed = "a law of numbers: a formula or a measured curve of a disc is not written as that of a system";
        return Err(refused("friction.law", allowed));
    }
    let mut table = Table::default();
    table.set("law", text(law.kind().name()));
    for (parameter, value) in law.kind().parameters().iter().zip(law.values()) {
        table.set(parameter.key(), number(value));
    }
    Ok(table)
}

/// A name without characters that a path does not take.
fn plain(name: &str) -> String {
    name.replace(',', "")
}

/// The dither of a contact of a disc; `None` for the factor 1 on friction without dither.
fn load_dither(system: &System, input: &Input, waveform: Option<&Table>) -> Option<Table> {
    let (contact, direction) = match input.target {
        InputTarget::Friction { contact } => (contact, "friction"),
        InputTarget::NormalLoad { contact, .. } => (contact, "normal"),
        InputTarget::Force(_) => return None,
    };
    let wave = input.profile.waves().first()?;
    let mut table = Table::default();
    table.set("contact", text(&plain(&system.contacts[contact].name)));
    table.set("direction", text(direction));
    if direction == "normal" {
        table.set("reaction", node(Value::Flag(false)));
    } else {
        table.set("mean", number(input.profile.mean()));
    }
    table.set("waveform", text(wave.waveform.name()));
    for (key, given) in waveform.into_iter().flat_map(Table::iter) {
        if WAVE_KEYS.iter().any(|(known, _)| *known == key) {
            table.set(key, given.clone());
        }
    }
    table.set("amplitude", number(wave.amplitude));
    table.set("frequency", number(wave.frequency));
    table.set("phase", number(wave.phase));
    Some(table)
}
