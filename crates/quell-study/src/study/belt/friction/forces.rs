//! Friction given as forces, for drives: `friction_force_n`, `static_friction_force_n`, `viscous_n_s_per_m`.
//!
//! T = F_c + c v_r, F_s at rest, in a study in SI. With a normal force N the coefficients are F/N. For a drive, μ and N have
//! no separate meaning: without `belt.normal_force_n`, N is the larger of both forces, so that the coefficients are fractions
//! of it; the forces, and therefore every motion, do not depend on N. Only normal dither requires the normal force itself.

use quell_model::friction::Otherwise;
use quell_model::parameter::{
    Bounds, COEFFICIENT, EXPONENT, NORMAL_LOAD, Parameter, STATIC_COEFFICIENT, VISCOUS,
};
use quell_model::units::{Quantity, Scales};
use quell_model::{Direction, Dither, Friction, LawKind};
use serde_json::Value as Json;

use super::read_law::ReadLaw;
use crate::complaint::{Complaint, Fault, Origin};
use crate::study::document::{Node, Table};
use crate::study::reader::{Found, Reader};
use crate::study::vocabulary::{self, Key, Role, Section, join};

/// The keys, each with the parameter of the law that it gives.
fn keys() -> impl Iterator<Item = (&'static Key, Parameter)> {
    vocabulary::keys_of(Section::Friction).filter_map(|key| match key.role {
        Role::FrictionForce(parameter, _) => Some((key, parameter)),
        _ => None,
    })
}

/// Whether a force can give this coefficient of a law.
pub(super) fn gives(kind: LawKind, parameter: Parameter) -> bool {
    let has = |wanted: Parameter| kind.parameters().iter().any(|known| known.path == wanted.path);
    has(COEFFICIENT) && has(parameter)
}

/// Whether `[friction]` has a key in newtons.
pub(super) fn are_given(table: &Table) -> bool {
    keys().any(|(key, _)| table.has(key.name))
}

/// Whether the friction of a study in SI is given in newtons.
pub(in crate::study) fn in_newtons(reader: &Reader, root: &Table) -> bool {
    reader.is_si() && root.get("friction").and_then(Node::table).is_some_and(are_given)
}

/// Reports normal dither if the normal force is derived from friction in newtons.
pub(in crate::study) fn needs_no_normal_force(
    reader: &mut Reader,
    root: &Table,
    dithers: Option<&[Dither]>,
) {
    let normal = |dither: &Dither| dither.direction == Direction::Normal;
    if dithers.is_some_and(|dithers| dithers.iter().any(normal)) {
        let origin = root.get("dither").map_or(Origin::Whole, |node| node.origin);
        let allowed = "normal dither requires belt.normal_force_n: it modulates the normal force, which friction in \
                       newtons does not determine";
        let complaint =
            Complaint::new(Fault::Conflict, "dither.direction", origin, "normal", allowed);
        reader.complain(complaint);
    }
}

/// Reads a law whose level is given in newtons, and F if the study does not give it.
pub(super) fn read(
    reader: &mut Reader,
    table: &Table,
    header: Origin,
    kind: LawKind,
    load: Option<f64>,
) -> Option<ReadLaw> {
    if conflicts(reader, table, kind) {
        return None;
    }
    let [sliding, level, viscous] = [COEFFICIENT, STATIC_COEFFICIENT, VISCOUS]
        .map(|parameter| force(reader, table, header, kind, parameter));
    let (sliding, level, viscous) = (sliding?, level?, viscous?.unwrap_or(0.0));
    let sliding = sliding.unwrap_or(0.0);
    let scales: Scales = reader.known_scales()?;
    let given = load.map(|load| scales.to_si(Quantity::Force, load));
    let newtons = given.unwrap_or_else(|| level.unwrap_or(sliding).max(sliding));
    if newtons <= 0.0 {
        let allowed = "above 0, unless belt.normal_force_n is given: otherwise the normal force is derived from the \
                       friction force";
        let (key, node) = written(table, COEFFICIENT)?;
        reader.complain(Complaint::new(Fault::Value, key, node.origin, node.given(), allowed));
        return None;
    }
    if level.is_some_and(|level| level < sliding) {
        let (key, node) = written(table, STATIC_COEFFICIENT)?;
        let allowed = format!("at least friction.friction_force_n = {sliding} N");
        reader.complain(Complaint::new(Fault::Value, key, node.origin, node.given(), allowed));
        return None;
    }
    let mut values = Vec::new();
    for parameter in kind.parameters() {
        let value = match parameter.path {
            path if path == COEFFICIENT.path => sliding / newtons,
            path if path == STATIC_COEFFICIENT.path => level.unwrap_or(sliding) / newtons,
            path if path == VISCOUS.path => {
                scales.from_si(Quantity::PerVelocity, viscous / newtons)
            }
            path => match reader.optional(table, "friction", *parameter, None) {
                Found::Value(value) => value,
                Found::Wrong => return None,
                Found::Absent => match kind.default_of(path) {
                    Some(Otherwise::Number(number)) if path == EXPONENT.path => number,
                    _ => reader.number(table, "friction", header, *parameter)?,
                },
            },
        };
        values.push(value);
    }
    let own_load = load.is_none().then(|| scales.from_si(Quantity::Force, newtons));
    match kind.build(&values) {
        Ok(Friction::Coulomb(law)) if level.is_none() => {
            let law = Friction::Coulomb(law.without_static_level());
            Some(ReadLaw { own_load, ..ReadLaw::of(law) })
        }
        Ok(law) => Some(ReadLaw { own_load, ..ReadLaw::of(law) }),
        Err(invalid) => {
            reader.adopt(invalid);
            None
        }
    }
}

/// Reports keys in newtons that do not apply to this law or study, or that conflict with a coefficient. Returns whether any do.
fn conflicts(reader: &mut Reader, table: &Table, kind: LawKind) -> bool {
    let before = reader.complaints_so_far();
    for (key, parameter) in keys() {
        let Some(node) = table.get(key.name) else { continue };
        let path = join("friction", key.name);
        if !gives(kind, parameter) {
            continue;
        }
        if !reader.is_si() {
            let plain = parameter.path;
            let allowed = format!(
                "the study is dimensionless, but {path} is in SI: use {plain}, or convert the whole study to SI with \
                 belt.mass_kg and belt.stiffness_n_per_m"
            );
            let complaint = Complaint::new(Fault::Mixed, &path, node.origin, node.given(), allowed);
            reader.complain(complaint.suggesting(Some(plain.to_owned())));
        }
    }
    let coefficients = [COEFFICIENT.key(), STATIC_COEFFICIENT.key(), VISCOUS.key()];
    let twins = VISCOUS.si.iter().map(|twin| twin.key);
    for name in coefficients.into_iter().chain(twins) {
        let Some(node) = table.get(name) else { continue };
        let allowed =
            "friction is already given in newtons; give either forces or coefficients, not both";
        let key = join("friction", name);
        reader.complain(Complaint::new(Fault::Conflict, key, node.origin, node.given(), allowed));
    }
    let misplaced = keys().any(|(key, parameter)| table.has(key.name) && !gives(kind, parameter));
    misplaced || reader.complaints_so_far() > before
}

/// A force of the law: `Some(None)` if it is optional and absent.
#[expect(clippy::option_option, reason = "invalid, absent, given")]
fn force(
    reader: &mut Reader,
    table: &Table,
    header: Origin,
    kind: LawKind,
    parameter: Parameter,
) -> Option<Option<f64>> {
    let (key, _) = keys().find(|(_, known)| known.path == parameter.path)?;
    let path = join("friction", key.name);
    match table.get(key.name) {
        Some(node) => reader.within(&path, node, Bounds::NOT_NEGATIVE, key.unit(), false).map(Some),
        None if kind.default_of(parameter.path).is_some() => Some(None),
        None => {
            let allowed = format!(
                "{}, in {} ({}); {} is the normal force",
                Bounds::NOT_NEGATIVE,
                key.unit(),
                key.about,
                NORMAL_LOAD.si.first().map_or(NORMAL_LOAD.path, |twin| twin.key)
            );
            reader.complain(Complaint::new(Fault::Missing, path, header, Json::Null, allowed));
            None
        }
    }
}

/// The key in newtons that gives a parameter, and its value.
fn written(table: &Table, parameter: Parameter) -> Option<(String, &Node)> {
    let (key, _) = keys().find(|(_, known)| known.path == parameter.path)?;
    Some((join("friction", key.name), table.get(key.name)?))
}
