//! Every key: those of the registry of parameters, and those that take other values.

use std::sync::LazyLock;

use quell_model::parameter::course::{OSCILLATION_FREQUENCY, OSCILLATION_PHASE};
use quell_model::parameter::{
    self, COEFFICIENT, DITHER_AMPLITUDE, MINIMUM_COEFFICIENT, Parameter, STATIC_COEFFICIENT,
    VISCOUS,
};
use quell_model::{LawKind, PARAMETERS};

use super::course::{CourseKey, CourseTable};
use super::key::{Key, Role, SCHEMA_ABOUT};
use super::section::{DocumentKind, KeyScope, Section};
use super::size::DITHER_SIZES;
use super::wave::{WAVE_KEYS, WaveKey};
use super::words::Choice;
use super::{UNITS, UNITS_ABOUT, of_systems};

/// Every key, table by table.
pub fn keys() -> &'static [Key] {
    static KEYS: LazyLock<Vec<Key>> = LazyLock::new(all);
    &KEYS
}

/// Keys of one table.
fn of_section(section: Section) -> &'static [Key] {
    static ENDS: LazyLock<Vec<usize>> = LazyLock::new(|| {
        // The keys are in the order of the tables.
        let before = |section: &Section| keys().partition_point(|key| key.section <= *section);
        Section::ALL.iter().map(before).collect()
    });
    let place = section as usize;
    let first = place.checked_sub(1).map_or(0, |before| ENDS[before]);
    &keys()[first..ENDS[place]]
}

/// Keys of one table in studies of a kind.
pub fn keys_of(section: Section, kind: DocumentKind) -> impl Iterator<Item = &'static Key> {
    of_section(section).iter().filter(move |key| key.scope.includes(kind))
}

/// The keys of every friction law, the same in studies of all kinds.
pub fn law_keys() -> impl Iterator<Item = &'static Key> {
    keys_of(Section::Friction, DocumentKind::System)
}

/// The key of a name in a table.
pub fn key(section: Section, name: &str, kind: DocumentKind) -> Option<&'static Key> {
    keys_of(section, kind).find(|key| key.name == name)
}

fn all() -> Vec<Key> {
    let mut keys = words();
    keys.extend(numbers());
    keys.extend(oscillations());
    keys.extend(own_law());
    keys.extend(disc());
    keys.extend(of_systems::keys());
    keys.extend(tables());
    keys.extend(band());
    keys.extend(axis());
    keys.extend(design());
    keys.extend(actuator());
    keys.sort_by_key(|key| key.section);
    keys
}

/// Keys outside any table, and the tables that are inside others.
fn tables() -> Vec<Key> {
    use Section as S;
    let table = |within, name, role: fn(Section) -> Role, inner: Section| Key {
        scope: inner.scope(),
        ..Key::new(within, name, role(inner), inner.about())
    };
    let one = |within, name, inner| table(within, name, Role::Table, inner);
    let several = |within, name, inner| table(within, name, Role::Tables, inner);
    let root = |inner: Section| one(S::Root, inner.path(), inner);
    vec![
        Key::new(S::Root, "schema", Role::Schema, SCHEMA_ABOUT),
        Key::new(S::Root, "title", Role::Text, "subject of the study"),
        root(S::Belt),
        root(S::Disc),
        root(S::System),
        several(S::Root, "contact", S::Contact),
        root(S::Friction),
        several(S::Root, "dither", S::Dither),
        root(S::Parameters),
        root(S::Solver),
        root(S::Response),
        root(S::Design),
        root(S::Actuator),
        root(S::Uncertainty),
        several(S::Root, "sweep", S::Sweep),
        one(S::Belt, "initial", S::Initial),
        one(S::Belt, "drive", S::Drive),
        one(S::Belt, "load", S::Load),
        one(S::Drive, "oscillation", S::DriveOscillation),
        one(S::Load, "oscillation", S::LoadOscillation),
        one(S::DiscDrive, "oscillation", S::DiscDriveOscillation),
        one(S::LoadEnvelope, "oscillation", S::LoadEnvelopeOscillation),
        one(S::Friction, "constants", S::Constants),
        several(S::Disc, "mode", S::DiscMode),
        several(S::Disc, "load", S::DiscLoad),
        one(S::Disc, "drive", S::DiscDrive),
        one(S::DiscLoad, "envelope", S::LoadEnvelope),
        several(S::System, "mode", S::Mode),
        several(S::System, "component", S::Component),
        several(S::Component, "mode", S::Mode),
        one(S::System, "initial", S::SystemInitial),
        one(S::Contact, "friction", S::Friction),
        one(S::Contact, "drive", S::Drive),
        one(S::Contact, "load", S::Load),
        one(S::Dither, "envelope", S::Envelope),
        one(S::Design, "limits", S::DesignLimits),
        // The reader of other studies says that they have no choice of places.
        Key { scope: KeyScope::EVERY, ..table(S::Design, "places", Role::List, S::DitherPlace) },
    ]
}

/// Keys that take words.
fn words() -> Vec<Key> {
    use Section::{Belt, Disc, Dither, Friction, Initial};
    let word = |section, name, choice, about| Key::new(section, name, Role::Choice(choice), about);
    let waves = WAVE_KEYS.iter().map(|&(name, wave)| {
        let role = match wave {
            WaveKey::Band => Role::Band { hertz: false },
            WaveKey::BandHz => Role::Band { hertz: true },
            other => Role::Wave(other),
        };
        Key::new(Dither, name, role, wave.about())
    });
    let direction = "direction of the force";
    let words = vec![
        word(Belt, UNITS, Choice::Units, UNITS_ABOUT),
        word(Disc, UNITS, Choice::Units, UNITS_ABOUT),
        word(Initial, "state", Choice::State, "a named state"),
        word(Friction, "law", Choice::Law, "the friction law"),
        Key {
            scope: KeyScope::BELT_OR_DISC,
            ..word(Dither, "direction", Choice::Direction, direction)
        },
        word(Dither, "waveform", Choice::Waveform, "shape of the force in time"),
    ];
    let tables = Section::ALL.iter().copied().filter(|section| section.course().is_some());
    let courses = tables.flat_map(|section| {
        let keys = section.course().map_or_else(Vec::new, CourseTable::keys);
        keys.into_iter().map(move |(name, course)| {
            let role = match course {
                CourseKey::Shape => Role::Choice(Choice::KnotShape),
                CourseKey::File => Role::Text,
                _ => Role::Course(course),
            };
            Key::new(section, name, role, course.about())
        })
    });
    words.into_iter().chain(waves).chain(courses).collect()
}

/// Keys that take a number of the registry: its own, and those in other units.
fn numbers() -> Vec<Key> {
    let table = |parameter: Parameter| {
        let table = parameter.path.strip_suffix(parameter.key()).unwrap_or_default();
        let at = |section: &&Section| section.path() == table.trim_end_matches('.');
        Section::ALL.iter().find(at).copied().unwrap_or(Section::Root)
    };
    let mut keys: Vec<Key> = Vec::new();
    for (parameter, scope) in parameters() {
        let section = table(parameter);
        let first = keys.len();
        keys.extend(Key::of_number(section, parameter));
        if parameter == DITHER_AMPLITUDE {
            let sizes = DITHER_SIZES.iter();
            keys.extend(
                sizes.map(|&size| {
                    Key::new(section, size.key, Role::Size(parameter, size), size.about)
                }),
            );
        }
        for key in &mut keys[first..] {
            // What an actuator takes is an amplitude in every kind of study.
            let is_driven = matches!(key.role, Role::Size(_, size) if size.needs_actuator());
            key.scope = if is_driven { key.scope } else { key.scope.and(scope) };
        }
    }
    keys
}

/// Amplitude, frequency and phase of what oscillates.
fn oscillations() -> impl Iterator<Item = Key> {
    let amplitude = |section: &Section| Some((*section, section.oscillates()?.amplitude?));
    let numbers = Section::ALL.iter().filter_map(amplitude).flat_map(|(section, amplitude)| {
        [amplitude, OSCILLATION_FREQUENCY, OSCILLATION_PHASE].map(|number| (section, number))
    });
    numbers.flat_map(|(section, number)| Key::of_number(section, number))
}

/// The parameters of all kinds of study, each with the kinds that have it, of questions and of friction laws.
fn parameters() -> Vec<(Parameter, KeyScope)> {
    let mut known: Vec<(Parameter, KeyScope)> = Vec::new();
    let mut add = |parameter: Parameter, scope: KeyScope| match known
        .iter_mut()
        .find(|(known, _)| *known == parameter)
    {
        Some((_, known)) => *known = known.or(scope),
        None => known.push((parameter, scope)),
    };
    for scale in parameter::SCALES {
        add(*scale, KeyScope::BELT);
    }
    for (kind, own) in DocumentKind::ALL.into_iter().zip(PARAMETERS) {
        for parameter in *own {
            add(*parameter, KeyScope::of(kind));
        }
    }
    let of_designs = parameter::design::LIMITS.iter().chain(parameter::design::CONFIDENT);
    let of_questions = of_designs.chain(parameter::actuator::ACTUATOR);
    for parameter in of_questions {
        add(*parameter, KeyScope::EVERY);
    }
    // Laws share keys: the first one defines them. The key of a coefficient also takes formulas and samples.
    let of_laws = LawKind::ALL.iter().flat_map(|law| law.parameters().iter().chain(law.options()));
    for parameter in of_laws {
        let shared = known.iter().any(|(known, _)| known.path == parameter.path);
        if !shared && parameter.path != COEFFICIENT.path {
            known.push((*parameter, KeyScope::EVERY));
        }
    }
    known
}

/// What keys of forces are.
const SLIDING_FORCE: &str =
    "friction force in sliding, instead of coefficient; the normal load may then be left out";
const STATIC_FORCE: &str = "largest friction force at rest, instead of static_coefficient";

/// Keys of a user-defined friction law.
fn own_law() -> Vec<Key> {
    let key = |name, role, about| Key::new(Section::Friction, name, role, about);
    vec![
        key(
            "coefficient",
            Role::Coefficient,
            "formula of the coefficient in the slip velocity v, measured coefficients, or the sliding coefficient of a \
             named law",
        ),
        key(
            "friction_force",
            Role::Flag,
            "whether coefficient and levels are forces [default: false]",
        ),
        key("coefficient_n", Role::FrictionForce(COEFFICIENT, "N"), SLIDING_FORCE),
        key("friction_force_n", Role::FrictionForce(COEFFICIENT, "N"), SLIDING_FORCE),
        key("static_coefficient_n", Role::FrictionForce(STATIC_COEFFICIENT, "N"), STATIC_FORCE),
        key("static_friction_force_n", Role::FrictionForce(STATIC_COEFFICIENT, "N"), STATIC_FORCE),
        key(
            "minimum_coefficient_n",
            Role::FrictionForce(MINIMUM_COEFFICIENT, "N"),
            "least friction force, instead of minimum_coefficient",
        ),
        key(
            "viscous_n_s_per_m",
            Role::FrictionForce(VISCOUS, "N·s/m"),
            "rise of the friction force with slip speed, instead of viscous",
        ),
        key(
            "file",
            Role::Text,
            "CSV file of measured slip speeds and coefficients, relative to the study file",
        ),
        key("slip_velocity", Role::Speeds { si: false }, "measured slip speeds"),
        key("slip_velocity_m_per_s", Role::Speeds { si: true }, "measured slip speeds"),
        key("terms", Role::Terms, "number of exponentials in the fit [default: the best number]"),
    ]
}

/// Keys of a disc that are not numbers of the registry.
fn disc() -> Vec<Key> {
    let key = |name, role, about| Key::new(Section::Disc, name, role, about);
    vec![
        key(
            "reference_frequency",
            Role::Reference,
            "reference for frequencies and speeds: \"critical\", the lowest critical speed of these modes, or a frequency \
             parameter k²",
        ),
        key(
            "modes_file",
            Role::Text,
            "CSV file of modes, relative to the study file, instead of computed modes",
        ),
        key(
            "rotating",
            Role::Choice(Choice::Rotating),
            "the part that rotates; centrifugal stress acts in a disc that rotates itself [default: loads]",
        ),
        key(
            "without",
            Role::Choices(Choice::Contribution),
            "contributions to the equations that are omitted",
        ),
    ]
}

/// Keys of the band of a level.
fn band() -> Vec<Key> {
    let about = "lower and upper limit of the band in which vibration levels with and without dither are compared";
    let key = |name, hertz| Key::new(Section::Response, name, Role::Band { hertz }, about);
    vec![key("band", false), key("band_hz", true)]
}

/// Keys of a design.
fn design() -> Vec<Key> {
    let key = |name, role, about| Key::new(Section::Design, name, role, about);
    vec![
        key("minimise", Role::Choice(Choice::Objective), "what is to be small"),
        key(
            "vary",
            Role::Paths,
            "paths of the numbers to choose: the amplitude of the dither and others, such as its frequency",
        ),
        key("from", Role::AxisValues, "their smallest values"),
        key("to", Role::AxisValues, "their largest values"),
        key(
            "waveforms",
            Role::Choices(Choice::Waveform),
            "waveforms that are tried in turn [default: that of the dither]",
        ),
        key(
            "start",
            Role::Choice(Choice::DesignStart),
            "runs that must end quiet: near the base response, from rest, from squeal [default: local]",
        ),
        key(
            "over",
            Role::Ranges,
            "ranges of the numbers over which the dither must be quiet, by their paths",
        ),
    ]
}

/// Keys of an actuator that are not numbers of the registry.
fn actuator() -> Vec<Key> {
    let key = |name, role, about| Key::new(Section::Actuator, name, role, about);
    vec![
        key("kind", Role::Choice(Choice::ActuatorKind), "kind of actuator"),
        key(
            "file",
            Role::Text,
            "kind \"frf\": CSV file of the force per volt or ampere, or the largest force, over frequency, relative to the study \
             file",
        ),
    ]
}

/// Keys of an axis.
fn axis() -> Vec<Key> {
    let key = |name, role, about| Key::new(Section::Sweep, name, role, about);
    vec![
        key("parameter", Role::Text, "path of the number to vary"),
        key("from", Role::AxisNumber, "first value"),
        key("to", Role::AxisNumber, "last value"),
        key("points", Role::AxisPoints, "number of values, both ends included"),
        key("values", Role::AxisValues, "the values themselves, instead of from, to and points"),
        key("spacing", Role::Choice(Choice::Spacing), "spacing of the values between the ends"),
    ]
}
