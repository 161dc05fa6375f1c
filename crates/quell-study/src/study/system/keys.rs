//! The keys of a study of a system, table by table: for the reader, paths and the schema.

use std::sync::LazyLock;

use crate::study::vocabulary::size::{DITHER_SIZES, SizeKey};
use quell_model::parameter::actuator::ACTUATOR;
use quell_model::parameter::design::LIMITS;
use quell_model::parameter::system::{
    CONTACT_BELT_VELOCITY, CONTACT_NORMAL_DAMPING, CONTACT_NORMAL_LOAD, CONTACT_NORMAL_STIFFNESS,
    CONTACT_TANGENTIAL_STIFFNESS, FRICTION_FACTOR_MEAN, SYSTEM_DITHER_FREQUENCY, SYSTEM_MODAL_MASS,
    SYSTEM_MODE_DAMPING, SYSTEM_MODE_FREQUENCY,
};
use quell_model::parameter::{DITHER_AMPLITUDE, DITHER_PHASE, Parameter};
use quell_model::units::Quantity;

use crate::complaint::{Complaint, Fault};
use crate::study::dither_size::parameter_of;
use crate::study::document::Table;
use crate::study::reader::Reader;
use crate::study::suggest;
use crate::study::vocabulary::{
    self, Choice, CourseKey, CourseTable, DRIVE, ENVELOPE, LOAD, Role, Section, WAVE_KEYS, WaveKey,
    join,
};

/// Whether a document is the study of a system.
pub(in crate::study) fn is_described(document: &Table) -> bool {
    document.has("system")
}

/// The key of the places that a design tries.
pub(in crate::study) const PLACES: &str = "places";

/// The tables of other kinds, which exclude `[system]`.
pub(in crate::study) const OTHER_KINDS: &[&str] = &["belt", "disc"];

/// The tables of a study of a system.
pub(in crate::study) const TABLES: &[&str] = &[
    "schema",
    "title",
    "system",
    "contact",
    "friction",
    "dither",
    "parameters",
    "design",
    "actuator",
    "uncertainty",
    "sweep",
];

/// A table of a study of a system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SystemTable {
    /// Keys outside any table.
    Root,
    /// `[system]`.
    System,
    /// `[[system.mode]]`.
    Mode,
    /// `[[system.component]]`.
    Component,
    /// `[system.initial]`.
    Initial,
    /// `[[contact]]`.
    Contact,
    /// `[contact.friction]` or `[friction]`: the keys of the friction laws.
    Friction,
    /// `[[dither]]`.
    Dither,
    /// `[contact.drive]`.
    Drive,
    /// `[contact.load]`.
    Load,
    /// `[dither.envelope]`.
    Envelope,
    /// `[design]`.
    Design,
    /// `[design.limits]`.
    DesignLimits,
    /// `[[design.places]]`.
    DitherPlace,
    /// `[actuator]`.
    Actuator,
    /// `[parameters]` or the constants of a formula: names that the study chooses.
    Named,
}

/// The kind of value that a key takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SystemRole {
    /// A number of the registry, or its twin in SI.
    Number(Parameter),
    /// Another size of a dither than its peak force.
    Size(SizeKey),
    /// A diagonal or rows of numbers of a quantity.
    Matrix(Option<Quantity>),
    /// A number for each coordinate, as a table of names or an array.
    Row(Option<Quantity>),
    /// Names of coordinates or states.
    Names,
    /// Numbers, each in the unit of another key.
    Numbers,
    /// Ranges of numbers by their paths.
    Ranges,
    /// A word from a list.
    Choice(Choice),
    /// Several words from a list.
    Choices(Choice),
    /// Free text.
    Text,
    /// `true` or `false`.
    Flag,
    /// A part of the description of a waveform.
    Wave(WaveKey),
    /// A part of a drive, a load or an envelope.
    Course(CourseKey),
    /// A table.
    Table(SystemTable),
    /// A table or a list of tables.
    Tables(SystemTable),
    /// A list of tables that is set as a whole.
    List(SystemTable),
}

/// A key of a study of a system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SystemKey {
    /// Its name.
    pub name: &'static str,
    /// Its kind of value.
    pub role: SystemRole,
    /// Description, in one line.
    pub about: &'static str,
}

impl SystemKey {
    /// The quantity that its numbers measure.
    pub fn quantity(&self) -> Option<Quantity> {
        match self.role {
            SystemRole::Number(parameter) => Some(parameter.quantity),
            SystemRole::Size(size) => size.quantity(),
            SystemRole::Matrix(quantity) | SystemRole::Row(quantity) => quantity,
            SystemRole::Wave(WaveKey::Band) => Some(Quantity::FrequencyRatio),
            _ => None,
        }
    }

    /// Whether a key of this name gives the same value in another unit.
    pub(super) fn has_twin(&self, name: &str) -> bool {
        match self.role {
            SystemRole::Number(parameter) => parameter.si.iter().any(|twin| twin.key == name),
            SystemRole::Size(_) => false,
            _ => {
                let suffix = name.strip_prefix(self.name).and_then(|rest| rest.strip_prefix('_'));
                let unit = suffix.and_then(|_| self.quantity()?.si_unit());
                unit.is_some_and(|(_, known)| suffix == Some(known))
            }
        }
    }

    /// Its twins in SI: numbers of the registry list them, other keys have their name and the suffix of the unit.
    pub fn twins(&self) -> Vec<String> {
        match self.role {
            SystemRole::Number(parameter) => {
                parameter.si.iter().map(|twin| twin.key.to_owned()).collect()
            }
            // Those of the amplitude are these sizes in SI.
            SystemRole::Size(_) => Vec::new(),
            _ => twin(self.name, self.quantity()).into_iter().collect(),
        }
    }
}

impl SystemKey {
    /// The number of the registry that it gives.
    pub fn parameter(&self) -> Option<Parameter> {
        match self.role {
            SystemRole::Number(parameter) => Some(parameter),
            SystemRole::Size(size) => Some(parameter_of(size)),
            _ => None,
        }
    }

    /// All keys that give the same number, itself included.
    pub(super) fn alternatives(&self) -> Vec<String> {
        let of_amplitude = self.parameter().filter(|known| known.path == DITHER_AMPLITUDE.path);
        let Some(amplitude) = of_amplitude else {
            return [self.name.to_owned()].into_iter().chain(self.twins()).collect();
        };
        let twins = DITHER_AMPLITUDE.si.iter().map(|twin| twin.key);
        let sizes = DITHER_SIZES.iter().map(|size| size.key);
        [amplitude.key()].into_iter().chain(twins).chain(sizes).map(str::to_owned).collect()
    }
}

/// The key that gives a quantity in SI.
pub(super) fn twin(name: &str, quantity: Option<Quantity>) -> Option<String> {
    let (_, suffix) = quantity?.si_unit()?;
    Some(format!("{name}_{suffix}"))
}

const fn key(name: &'static str, role: SystemRole, about: &'static str) -> SystemKey {
    SystemKey { name, role, about }
}

const fn number(parameter: Parameter, name: &'static str) -> SystemKey {
    key(name, SystemRole::Number(parameter), parameter.about)
}

/// The keys of a table; friction laws and freely named numbers are not listed here.
pub fn system_keys(table: SystemTable) -> &'static [SystemKey] {
    match table {
        SystemTable::Root => ROOT,
        SystemTable::System => SYSTEM,
        SystemTable::Mode => MODE,
        SystemTable::Component => COMPONENT,
        SystemTable::Initial => INITIAL,
        SystemTable::Contact => CONTACT,
        SystemTable::Dither => DITHER,
        SystemTable::Drive => &DRIVE_KEYS,
        SystemTable::Load => &LOAD_KEYS,
        SystemTable::Envelope => &ENVELOPE_KEYS,
        SystemTable::Design => &DESIGN_KEYS,
        SystemTable::DesignLimits => &LIMIT_KEYS,
        SystemTable::DitherPlace => &DITHER[..PLACE_KEYS],
        SystemTable::Actuator => &ACTUATOR_KEYS,
        SystemTable::Friction | SystemTable::Named => &[],
    }
}

/// The keys of a table over time, those in SI included.
fn course(what: CourseTable) -> Vec<SystemKey> {
    let keys = what.keys().into_iter();
    keys.map(|(name, course)| match course {
        CourseKey::Shape => key(name, SystemRole::Choice(Choice::KnotShape), course.about()),
        CourseKey::File => key(name, SystemRole::Text, course.about()),
        _ => key(name, SystemRole::Course(course), course.about()),
    })
    .collect()
}

static DRIVE_KEYS: LazyLock<Vec<SystemKey>> = LazyLock::new(|| course(DRIVE));
static LOAD_KEYS: LazyLock<Vec<SystemKey>> = LazyLock::new(|| course(LOAD));
static ENVELOPE_KEYS: LazyLock<Vec<SystemKey>> = LazyLock::new(|| course(ENVELOPE));

/// The keys of a design, as those of a belt.
fn design() -> Vec<SystemKey> {
    let keys = vocabulary::keys_of(Section::Design).map(|known| {
        let role = match known.role {
            Role::Choice(choice) => SystemRole::Choice(choice),
            Role::Choices(choice) => SystemRole::Choices(choice),
            Role::AxisValues => SystemRole::Numbers,
            Role::Ranges => SystemRole::Ranges,
            Role::Number(parameter) => SystemRole::Number(parameter),
            _ => SystemRole::Names,
        };
        key(known.name, role, known.about)
    });
    let limits = SystemRole::Table(SystemTable::DesignLimits);
    let places = key(
        PLACES,
        SystemRole::List(SystemTable::DitherPlace),
        "places that are tried in turn, each by the keys of a dither that say where it acts [default: its own]",
    );
    keys.chain([key("limits", limits, Section::DesignLimits.about()), places]).collect()
}

static DESIGN_KEYS: LazyLock<Vec<SystemKey>> = LazyLock::new(design);
static LIMIT_KEYS: LazyLock<Vec<SystemKey>> =
    LazyLock::new(|| LIMITS.iter().map(|limit| number(*limit, limit.key())).collect());

/// The keys of an actuator, as those of a belt.
fn actuator() -> Vec<SystemKey> {
    let words = vocabulary::keys_of(Section::Actuator).filter_map(|known| match known.role {
        Role::Choice(choice) => Some(key(known.name, SystemRole::Choice(choice), known.about)),
        Role::Text => Some(key(known.name, SystemRole::Text, known.about)),
        _ => None,
    });
    words.chain(ACTUATOR.iter().map(|known| number(*known, known.key()))).collect()
}

static ACTUATOR_KEYS: LazyLock<Vec<SystemKey>> = LazyLock::new(actuator);

const ROOT: &[SystemKey] = &[
    key("system", SystemRole::Table(SystemTable::System), "the linear structure"),
    key("contact", SystemRole::Tables(SystemTable::Contact), "a friction contact"),
    key("friction", SystemRole::Table(SystemTable::Friction), "friction law of all contacts"),
    key("dither", SystemRole::Tables(SystemTable::Dither), "a periodic force or load"),
    key(
        "parameters",
        SystemRole::Table(SystemTable::Named),
        "named numbers for formulas: numbers, or formulas of other parameters",
    ),
    key(
        "design",
        SystemRole::Table(SystemTable::Design),
        "the least dither over a box of operating points",
    ),
    key("actuator", SystemRole::Table(SystemTable::Actuator), "the actuator that gives the dither"),
];

const SYSTEM: &[SystemKey] = &[
    key("coordinates", SystemRole::Names, "names of the coordinates"),
    key(
        "mass",
        SystemRole::Matrix(Some(Quantity::LoadMass)),
        "mass matrix: a diagonal, rows, or a Matrix Market file",
    ),
    key(
        "damping",
        SystemRole::Matrix(Some(Quantity::LoadDamping)),
        "damping and gyroscopic matrix: a diagonal, rows, or a Matrix Market file [default: 0]",
    ),
    key(
        "stiffness",
        SystemRole::Matrix(Some(Quantity::LoadStiffness)),
        "stiffness matrix without the contacts: a diagonal, rows, or a Matrix Market file",
    ),
    key("states", SystemRole::Names, "names of the states of first-order equations"),
    key(
        "matrix",
        SystemRole::Matrix(None),
        "matrix of first-order equations: rows, or a Matrix Market file",
    ),
    key("force", SystemRole::Row(Some(Quantity::Force)), "constant forces [default: 0]"),
    key("mode", SystemRole::Tables(SystemTable::Mode), "modes of the structure"),
    key("modes", SystemRole::Text, "CSV file of modes, relative to the study file"),
    key("normalisation", SystemRole::Choice(Choice::Normalisation), NORMALISATION),
    key(
        "component",
        SystemRole::Tables(SystemTable::Component),
        "a body given by its modes; several are joined by contacts",
    ),
    key(
        "frequency_response",
        SystemRole::Text,
        "CSV file of a measured receptance, relative to the study file",
    ),
    key("units", SystemRole::Choice(Choice::Units), "unit of bare numbers [default: none]"),
    key(
        "observe",
        SystemRole::Row(None),
        "the displacement that a response measures [default: tangent of the first contact]",
    ),
    key("initial", SystemRole::Table(SystemTable::Initial), "initial state [default: rest]"),
];

/// What `normalisation` says.
const NORMALISATION: &str =
    "mass: shapes of unit modal mass; max: shapes of any size with modal_mass [default: mass]";

const MODE: &[SystemKey] = &[
    number(SYSTEM_MODE_FREQUENCY, "frequency"),
    number(SYSTEM_MODE_DAMPING, "damping_ratio"),
    number(SYSTEM_MODAL_MASS, "modal_mass"),
    key("shape", SystemRole::Row(None), "displacement of each point in the mode"),
];

const COMPONENT: &[SystemKey] = &[
    key("name", SystemRole::Text, "name, the first part of the names of its points"),
    key("mode", SystemRole::Tables(SystemTable::Mode), "modes of the component"),
    key("modes", SystemRole::Text, "CSV file of modes, relative to the study file"),
    key("normalisation", SystemRole::Choice(Choice::Normalisation), NORMALISATION),
];

const INITIAL: &[SystemKey] = &[
    key("state", SystemRole::Choice(Choice::SystemState), "a named state"),
    key(
        "displacements",
        SystemRole::Row(Some(Quantity::Displacement)),
        "displacement of each coordinate [default: 0]",
    ),
    key(
        "velocities",
        SystemRole::Row(Some(Quantity::Velocity)),
        "velocity of each coordinate [default: 0]",
    ),
    key("values", SystemRole::Row(None), "the whole state"),
];

const CONTACT: &[SystemKey] = &[
    key("name", SystemRole::Text, "name of the contact [default: contact 1, 2, …]"),
    key("tangent", SystemRole::Row(None), "row of the tangential displacement"),
    key("normal", SystemRole::Row(None), "row of the approach; without it the load is prescribed"),
    key("slope", SystemRole::Row(None), "row of the slope of the surface, which turns friction"),
    key("force", SystemRole::Row(None), "effect of the friction force on first-order states"),
    number(CONTACT_NORMAL_LOAD, "normal_load"),
    number(CONTACT_NORMAL_STIFFNESS, "normal_stiffness"),
    number(CONTACT_NORMAL_DAMPING, "normal_damping"),
    number(CONTACT_TANGENTIAL_STIFFNESS, "tangential_stiffness"),
    number(CONTACT_BELT_VELOCITY, "belt_velocity"),
    key("friction", SystemRole::Table(SystemTable::Friction), "friction law of the contact"),
    key("drive", SystemRole::Table(SystemTable::Drive), "velocity of the surface over time"),
    key("load", SystemRole::Table(SystemTable::Load), "normal load over time"),
];

/// A key of waveforms that are more than a name.
const fn wave(place: usize) -> SystemKey {
    let (name, wave) = WAVE_KEYS[place];
    key(name, SystemRole::Wave(wave), wave.about())
}

/// Another size of a dither.
const fn size(place: usize) -> SystemKey {
    let size = DITHER_SIZES[place];
    key(size.key, SystemRole::Size(size), size.about)
}

/// The first keys of a dither, which say where it acts.
const PLACE_KEYS: usize = 4;

const DITHER: &[SystemKey] = &[
    key("at", SystemRole::Row(None), "row of the force over the coordinates"),
    key("contact", SystemRole::Text, "name of the contact whose load is modulated, instead of at"),
    key(
        "direction",
        SystemRole::Choice(Choice::ContactDirection),
        "normal: on the load of the contact; tangential: a force along its tangent; friction: a factor on its friction force",
    ),
    key(
        "reaction",
        SystemRole::Flag,
        "whether the structure bears the modulation of the load [default: true]",
    ),
    key("waveform", SystemRole::Choice(Choice::Waveform), "shape of the force in time"),
    wave(0),
    wave(1),
    wave(2),
    wave(3),
    wave(4),
    wave(5),
    wave(6),
    wave(7),
    wave(8),
    wave(9),
    number(DITHER_AMPLITUDE, "amplitude"),
    key(
        "mean",
        SystemRole::Number(FRICTION_FACTOR_MEAN),
        "mean of a factor on friction [default: 1]",
    ),
    size(0),
    size(1),
    size(2),
    size(3),
    size(4),
    size(5),
    size(6),
    size(7),
    size(8),
    size(9),
    size(10),
    number(SYSTEM_DITHER_FREQUENCY, "frequency"),
    number(DITHER_PHASE, "phase"),
    key("envelope", SystemRole::Table(SystemTable::Envelope), "share of the amplitude over time"),
];

/// Reports keys that a table of a system does not have.
pub(super) fn unknown_keys(reader: &mut Reader, table: &Table, prefix: &str, which: SystemTable) {
    let keys = system_keys(which);
    for (name, node) in table.iter() {
        if keys.iter().any(|key| key.name == name || key.has_twin(name)) {
            continue;
        }
        let there: Vec<&str> = keys.iter().map(|key| key.name).collect();
        let nearest = suggest::word(name, there.iter().copied());
        let complaint = Complaint::new(
            Fault::Unknown,
            join(prefix, name),
            node.origin,
            node.given(),
            there.join(", "),
        );
        reader.complain(complaint.suggesting(nearest.map(|name| join(prefix, &name))));
    }
}
