//! The keys that only the study of a system has.

use quell_model::units::Quantity;

use super::key::{Key, Role, RowUnit};
use super::section::{KeyScope, Section};
use super::words::Choice;
use super::{UNITS, UNITS_ABOUT};

/// The keys of the tables of a system, and those that its dithers have alone.
pub(super) fn keys() -> Vec<Key> {
    let mut keys = structure();
    keys.extend(modes());
    keys.extend(initial());
    keys.extend(contact());
    keys.extend(dither());
    keys
}

/// A matrix or a row without a unit.
const PLAIN: RowUnit = RowUnit { quantity: None, si: false };

/// Numbers of a quantity: the bare key, and that with the unit as its suffix.
fn measured(
    section: Section,
    name: &'static str,
    role: fn(RowUnit) -> Role,
    quantity: Quantity,
    about: &'static str,
) -> impl Iterator<Item = Key> {
    let suffix = quantity.si_unit().map(|(_, suffix)| &*format!("{name}_{suffix}").leak());
    let of = move |name, si| {
        Key::new(section, name, role(RowUnit { quantity: Some(quantity), si }), about)
    };
    [of(name, false)].into_iter().chain(suffix.map(|name| of(name, true)))
}

const MODES: &str = "CSV file of modes, relative to the study file";
const NORMALISATION: &str =
    "mass: shapes of unit modal mass; max: shapes of any size with modal_mass [default: mass]";

fn structure() -> Vec<Key> {
    let own = |name, role, about| Key::new(Section::System, name, role, about);
    let matrix =
        |name, quantity, about| measured(Section::System, name, Role::Matrix, quantity, about);
    let mut keys = vec![own("coordinates", Role::Names, "names of the coordinates")];
    keys.extend(matrix(
        "mass",
        Quantity::LoadMass,
        "mass matrix: a diagonal, rows, or a Matrix Market file",
    ));
    keys.extend(matrix(
        "damping",
        Quantity::LoadDamping,
        "damping and gyroscopic matrix: a diagonal, rows, or a Matrix Market file [default: 0]",
    ));
    keys.extend(matrix(
        "stiffness",
        Quantity::LoadStiffness,
        "stiffness matrix without the contacts: a diagonal, rows, or a Matrix Market file",
    ));
    keys.extend([
        own("states", Role::Names, "names of the states of first-order equations"),
        own(
            "matrix",
            Role::Matrix(PLAIN),
            "matrix of first-order equations: rows, or a Matrix Market file",
        ),
    ]);
    let forces = "constant forces [default: 0]";
    keys.extend(measured(Section::System, "force", Role::Row, Quantity::Force, forces));
    keys.extend([
        own("modes", Role::Text, MODES),
        own("normalisation", Role::Choice(Choice::Normalisation), NORMALISATION),
        own(
            "frequency_response",
            Role::Text,
            "CSV file of a measured receptance, relative to the study file",
        ),
        own(UNITS, Role::Choice(Choice::Units), UNITS_ABOUT),
        own(
            "observe",
            Role::Row(PLAIN),
            "the displacement that a response measures [default: tangent of the first contact]",
        ),
    ]);
    keys
}

fn modes() -> Vec<Key> {
    let own = |name, role, about| Key::new(Section::Component, name, role, about);
    vec![
        Key::new(
            Section::Mode,
            "shape",
            Role::Row(PLAIN),
            "displacement of each point in the mode",
        ),
        own("name", Role::Text, "name, the first part of the names of its points"),
        own("modes", Role::Text, MODES),
        own("normalisation", Role::Choice(Choice::Normalisation), NORMALISATION),
    ]
}

fn initial() -> Vec<Key> {
    let own = |name, role, about| Key::new(Section::SystemInitial, name, role, about);
    let row =
        |name, quantity, about| measured(Section::SystemInitial, name, Role::Row, quantity, about);
    let mut keys = vec![own("state", Role::Choice(Choice::SystemState), "a named state")];
    keys.extend(row(
        "displacements",
        Quantity::Displacement,
        "displacement of each coordinate [default: 0]",
    ));
    keys.extend(row("velocities", Quantity::Velocity, "velocity of each coordinate [default: 0]"));
    keys.push(own("values", Role::Row(PLAIN), "the whole state"));
    keys
}

fn contact() -> Vec<Key> {
    let own = |name, role, about| Key::new(Section::Contact, name, role, about);
    vec![
        own("name", Role::Text, "name of the contact [default: contact 1, 2, …]"),
        own("tangent", Role::Row(PLAIN), "row of the tangential displacement"),
        own("normal", Role::Row(PLAIN), "row of the approach; without it the load is prescribed"),
        own("slope", Role::Row(PLAIN), "row of the slope of the surface, which turns friction"),
        own("force", Role::Row(PLAIN), "effect of the friction force on first-order states"),
    ]
}

fn dither() -> Vec<Key> {
    let place = [
        ("at", Role::Row(PLAIN), "row of the force over the coordinates"),
        ("contact", Role::Text, "name of the contact whose load is modulated, instead of at"),
        (
            "direction",
            Role::Choice(Choice::ContactDirection),
            "normal: on the load of the contact; tangential: a force along its tangent; friction: a factor on its friction force",
        ),
        (
            "reaction",
            Role::Flag,
            "whether the structure bears the modulation of the load [default: true]",
        ),
    ];
    let places = [Section::Dither, Section::DitherPlace].into_iter().flat_map(|section| {
        place.into_iter().map(move |(name, role, about)| Key::new(section, name, role, about))
    });
    let of_systems = |key| Key { scope: KeyScope::SYSTEM, ..key };
    places.map(of_systems).collect()
}
