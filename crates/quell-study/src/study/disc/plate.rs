//! The plate of `[disc]`, its modes and its material.

use std::sync::Arc;

use quell_disc::plate::{ModeSet, ModeSetError, Plate, PlateMaterial, Reference};
use quell_input::complaint::{Complaint, Fault, Origin};
use quell_input::document::{Node, Table, Value};
use quell_model::parameter::Bounds;
use quell_model::parameter::disc::{
    DENSITY, INNER_RADIUS_RATIO, NODAL_DIAMETERS, OUTER_RADIUS, PLATE_MASS, POISSON_RATIO,
    RADIAL_MODES, THICKNESS, YOUNGS_MODULUS,
};
use serde_json::Value as Json;

use crate::study::reader::{Found, Reader};

/// A plate and its modes.
#[derive(Clone, Debug, PartialEq)]
pub struct PlateModes {
    /// The plate.
    pub plate: Plate,
    /// Modes for each number of nodal diameters, N_r.
    pub radial_modes: usize,
    /// Largest number of nodal diameters, N_θ.
    pub nodal_diameters: u32,
    /// Reference of all frequencies.
    pub reference: Reference,
    /// The modes.
    pub set: ModeSet,
}

/// Reads the plate and computes its modes, unless they are known from another reading.
pub(super) fn read(reader: &mut Reader, table: &Table, header: Origin) -> Option<Arc<PlateModes>> {
    let inner = reader.number(table, "disc", header, INNER_RADIUS_RATIO);
    let poisson = reader.optional(table, "disc", POISSON_RATIO).or(0.3);
    let radial = reader.optional(table, "disc", RADIAL_MODES).or(1.0);
    let diameters = reader.optional(table, "disc", NODAL_DIAMETERS).or(2.0);
    let reference = reference(reader, table);
    let plate = Plate::new(inner?, poisson?).ok()?;
    let reference = reference?;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "whole numbers within the bounds of the registry"
    )]
    let (radial_modes, nodal_diameters) = (radial? as usize, diameters? as u32);
    let same = |known: &PlateModes| {
        known.plate == plate
            && (known.radial_modes, known.nodal_diameters) == (radial_modes, nodal_diameters)
            && known.reference == reference
    };
    let modes = reader.computed().get(same, || {
        let set = ModeSet::new(&plate, radial_modes, nodal_diameters, reference)?;
        Ok(PlateModes { plate, radial_modes, nodal_diameters, reference, set })
    });
    match modes {
        Ok(modes) => Some(modes),
        Err(why) => {
            let node = table.get("nodal_diameters");
            let origin = node.map_or(header, |node| node.origin);
            let given = node.map_or(Json::Null, Node::given);
            let key = "disc.nodal_diameters";
            let allowed = match why {
                ModeSetError::NoCriticalSpeed => {
                    "at least 1, unless disc.reference_frequency is a number: modes without nodal diameters have no \
                     critical speed"
                        .to_owned()
                }
                why => format!("such that all modes can be computed: {why}"),
            };
            reader.complain(Complaint::new(Fault::Value, key, origin, given, allowed));
            None
        }
    }
}

/// `reference_frequency`: "critical" or k².
pub(super) fn reference(reader: &mut Reader, table: &Table) -> Option<Reference> {
    let key = "disc.reference_frequency";
    let Some(node) = table.get("reference_frequency") else { return Some(Reference::Critical) };
    match &node.value {
        Value::Text(word) if word == "critical" => Some(Reference::Critical),
        Value::Number(_) => {
            reader.within(key, node, Bounds::POSITIVE, "", false).map(Reference::FrequencyParameter)
        }
        _ => {
            let allowed =
                "\"critical\", or a frequency parameter k² > 0 that fixes ω_ref for the disc";
            reader.wrong(key, node, allowed);
            None
        }
    }
}

/// What a study says of the metal and the size of its plate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Metal {
    /// Material and size, where all four numbers are given.
    pub(super) material: Option<PlateMaterial>,
    /// Outer radius a, m.
    pub(super) outer_radius_m: Option<f64>,
    /// Mass M_p of the plate whose modes are listed, kg.
    pub(super) mass_kg: Option<f64>,
}

impl Metal {
    /// Listed modes may come with the mass and the outer radius alone.
    pub(super) fn read(reader: &mut Reader, table: &Table, header: Origin) -> Option<Self> {
        let listed = table.get("mode").is_some() || table.get("modes_file").is_some();
        let mass_kg = match table.get(PLATE_MASS.key()) {
            Some(node) if !listed => {
                let allowed = "only with listed modes ([[disc.mode]] or disc.modes_file): the mass of a plate whose modes are \
                               computed is that of its material";
                let key = PLATE_MASS.path;
                let given = node.given();
                reader.complain(Complaint::new(Fault::Conflict, key, node.origin, given, allowed));
                None
            }
            _ => reader.optional(table, "disc", PLATE_MASS).if_given(),
        };
        let of_material = [YOUNGS_MODULUS, DENSITY, THICKNESS];
        if listed && of_material.iter().all(|parameter| table.get(parameter.key()).is_none()) {
            let outer_radius_m = reader.optional(table, "disc", OUTER_RADIUS).if_given()?;
            return Some(Self { material: None, outer_radius_m, mass_kg: mass_kg? });
        }
        let material = material(reader, table, header)?;
        let outer_radius_m = material.as_ref().map(PlateMaterial::outer_radius);
        Some(Self { material, outer_radius_m, mass_kg: mass_kg? })
    }
}

/// Material and size of the plate; either all four are given or none.
#[expect(clippy::option_option, reason = "invalid, absent, given")]
fn material(reader: &mut Reader, table: &Table, header: Origin) -> Option<Option<PlateMaterial>> {
    let parameters = [YOUNGS_MODULUS, DENSITY, THICKNESS, OUTER_RADIUS];
    if parameters.iter().all(|parameter| table.get(parameter.key()).is_none()) {
        return Some(None);
    }
    let [modulus, density, thickness, radius] =
        parameters.map(|parameter| match reader.optional(table, "disc", parameter) {
            Found::Value(value) => Some(value),
            Found::Wrong => None,
            Found::Absent => {
                let allowed = format!(
                    "{} ({}, {}); values in hertz and rpm require modulus, density, thickness and outer radius",
                    parameter.bounds, parameter.symbol, parameter.about
                );
                reader.complain(Complaint::new(
                    Fault::Missing,
                    parameter.path,
                    header,
                    Json::Null,
                    allowed,
                ));
                None
            }
        });
    if let Ok(material) = PlateMaterial::new(modulus?, density?, thickness?, radius?) {
        return Some(Some(material));
    }
    let node = table.get(THICKNESS.key())?;
    // Each is already positive: the only remaining error is a plate as thick as it is wide.
    let allowed = format!("a thickness below {} = {}", OUTER_RADIUS.path, radius?);
    reader.wrong(THICKNESS.path, node, allowed);
    None
}
