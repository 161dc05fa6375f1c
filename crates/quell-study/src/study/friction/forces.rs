//! Friction given as forces, for drives and joints: `coefficient_n`, `static_coefficient_n`, `minimum_coefficient_n` and
//! `viscous_n_s_per_m`, or, in a study without units, the bare keys with `friction_force = true`.
//!
//! T = F_c + c v_r, F_s at rest. With a normal load N the coefficients are F/N. Without one N is 1 N (1 without units), so that
//! coefficients are forces in newtons; the motion does not depend on N. Only normal dither needs the normal load itself.

use quell_input::complaint::{Complaint, Fault, Origin};
use quell_input::document::{Node, Table, Value};
use quell_model::LawKind;
use quell_model::parameter::{
    Bounds, COEFFICIENT, MINIMUM_COEFFICIENT, Parameter, STATIC_COEFFICIENT, VISCOUS,
};
use quell_model::units::{Quantity, UnitSystem};
use quell_model::{Direction, Dither};

use super::law_place::LawPlace;
use crate::study::reader::{Found, Reader, Reported, WantedNumber};
use crate::study::vocabulary::{self, Key, KeyUnit, Role, join};

/// The key that says that bare keys are forces.
const FLAG: &str = "friction_force";

/// The numbers of laws that a force can give.
const LEVELS: [Parameter; 4] = [COEFFICIENT, STATIC_COEFFICIENT, MINIMUM_COEFFICIENT, VISCOUS];

/// The keys, each with the number of the law that it gives.
fn keys() -> impl Iterator<Item = (&'static Key, Parameter)> {
    vocabulary::law_keys().filter_map(|key| match key.role {
        Role::FrictionForce(parameter, _) => Some((key, parameter)),
        _ => None,
    })
}

/// Whether a force can give this number of a law.
pub(super) fn gives(parameter: Parameter) -> bool {
    LEVELS.iter().any(|known| known.path == parameter.path)
}

/// Whether a law has a number that a force gives.
pub(super) fn belongs(kind: LawKind, parameter: Parameter) -> bool {
    LawKind::NUMERIC.contains(&kind)
        && kind.parameters().iter().any(|known| known.path == parameter.path)
}

/// Whether a table has friction as forces.
pub(in crate::study) fn are_given(table: &Table) -> bool {
    table.has(FLAG) || keys().any(|(key, _)| table.has(key.name))
}

/// Whether the friction of a study is given as forces.
pub(in crate::study) fn in_newtons(root: &Table) -> bool {
    root.get("friction").and_then(Node::table).is_some_and(are_given)
}

/// The key in newtons that gives a number in a table.
pub(super) fn key_in(table: &Table, parameter: Parameter) -> Option<&'static str> {
    let mut of = keys().filter(|(_, known)| known.path == parameter.path);
    of.find(|(key, _)| table.has(key.name)).map(|(key, _)| key.name)
}

/// Reports a missing force.
pub(super) fn missing(reader: &mut Reader, path: &str, header: Origin, parameter: Parameter) {
    let Some((key, _)) = keys().find(|(_, known)| known.path == parameter.path) else { return };
    let allowed =
        format!("{}, in {} ({})", Bounds::NOT_NEGATIVE, key.unit(UnitSystem::None), key.about);
    reader.missing(join(path, key.name), header, allowed);
}

/// Reports normal dither where friction is given as forces without a normal load.
pub(in crate::study) fn needs_no_normal_force(
    reader: &mut Reader,
    root: &Table,
    dithers: Option<&[Dither]>,
) {
    let normal = |dither: &Dither| dither.direction == Direction::Normal;
    if dithers.is_some_and(|dithers| dithers.iter().any(normal)) {
        let origin = root.get("dither").map_or(Origin::Whole, |node| node.origin);
        let allowed = "normal dither requires belt.normal_load: it modulates the normal force, which friction given as a force does \
                       not determine";
        let complaint =
            Complaint::new(Fault::Conflict, "dither.direction", origin, "normal", allowed);
        reader.complain(complaint);
    }
}

/// Forces over which load the levels of a law are.
pub(super) struct ForceLevels<'a> {
    path: &'a str,
    /// Whether the forces are given by bare keys.
    bare: bool,
    /// The normal load in the numbers of the equations.
    load: f64,
    /// The same where the study does not give it.
    pub(super) own_load: Option<f64>,
}

impl<'a> ForceLevels<'a> {
    /// The levels of a law; `Ok(None)` where they are coefficients.
    pub(super) fn of(
        reader: &mut Reader,
        table: &Table,
        place: LawPlace<'a>,
        kind: LawKind,
    ) -> Result<Option<Self>, Reported> {
        if !are_given(table) {
            return Ok(None);
        }
        let LawPlace { path, normal_load, .. } = place;
        let bare = match table.get(FLAG).map(|node| (node, &node.value)) {
            None => false,
            Some((_, Value::Flag(flag))) => *flag,
            Some((node, _)) => {
                let allowed = format!("true or false; got {}", node.kind());
                reader.wrong(&join(path, FLAG), node, allowed);
                return Err(Reported);
            }
        };
        let before = reader.complaints_so_far();
        for (key, parameter) in keys() {
            let Some(node) = table.get(key.name) else { continue };
            if !belongs(kind, parameter) {
                // The key has been reported.
                return Err(Reported);
            }
            if !reader.units().take_suffixes() {
                reader.without_units(
                    &join(path, key.name),
                    node,
                    Some(join(path, parameter.key())),
                );
            }
        }
        let coefficients = LEVELS.iter().flat_map(Parameter::keys);
        for name in coefficients.filter(|_| !bare) {
            let Some(node) = table.get(name) else { continue };
            let allowed = "friction is already given in newtons; give either forces or coefficients, not both";
            let (key, given) = (join(path, name), node.given());
            reader.complain(Complaint::new(Fault::Conflict, key, node.origin, given, allowed));
        }
        if reader.complaints_so_far() > before {
            return Err(Reported);
        }
        // One newton; of a study without units one unit.
        let one = reader.units().of_si(Quantity::Force).unwrap_or(1.0);
        let own_load = normal_load.is_none().then_some(one);
        let load = normal_load.unwrap_or(one);
        Ok((bare || table_has_force(table)).then_some(Self { path, bare, load, own_load }))
    }

    /// A level of the law from its force.
    pub(super) fn value(&self, reader: &mut Reader, table: &Table, parameter: Parameter) -> Found {
        let viscous = parameter.path == VISCOUS.path;
        let Some((name, unit)) = (if self.bare {
            table.get(parameter.key()).map(|_| (parameter.key(), KeyUnit::Study))
        } else {
            let unit = if viscous { "N·s/m" } else { "N" };
            key_in(table, parameter).map(|name| (name, KeyUnit::Suffix(unit)))
        }) else {
            return Found::Absent;
        };
        let Some(node) = table.get(name) else { return Found::Absent };
        // A force over a velocity, like a damper.
        let quantity = if viscous { Quantity::LoadDamping } else { Quantity::Force };
        let wanted = WantedNumber { quantity: Some(quantity), bounds: Bounds::NOT_NEGATIVE, unit };
        match reader.quantity(|| join(self.path, name), node, wanted) {
            Some(force) => Found::Value(force / self.load),
            None => Found::Wrong,
        }
    }
}

fn table_has_force(table: &Table) -> bool {
    keys().any(|(key, _)| table.has(key.name))
}
