//! The table `[disc]`: its modes, its loads, and the contributions to the equations that are omitted.

use quell_input::complaint::Origin;
use quell_input::document::{Node, Table, Value};
use quell_model::disc::{Contribution, Contributions};
use quell_model::disc::{Load, Mode, Patch};
use quell_model::parameter::disc::MODAL_DAMPING;
use quell_model::profile::Profile;
use quell_model::units::DiscScales;

use super::super::reader::Reader;
use super::super::vocabulary::{Choice, Section};
use super::loads::{LoadScales, Pad};
use super::modes::{self, ModeSource};
use super::plate::Metal;
use super::{loads, rotation};

/// The contents of `[disc]`.
pub(super) struct Body {
    pub(super) source: ModeSource,
    pub(super) metal: Metal,
    pub(super) modes: Vec<Mode>,
    pub(super) loads: Vec<Load>,
    pub(super) radii: Vec<Option<f64>>,
    pub(super) speed: f64,
    /// The speed over time.
    pub(super) drive: Option<Profile>,
    pub(super) parts: Contributions,
    /// Centrifugal stiffening of each mode.
    pub(super) centrifugal: Vec<f64>,
    pub(super) warnings: Vec<String>,
}

impl Body {
    pub(super) fn read(reader: &mut Reader, table: &Table, header: Origin) -> Option<Self> {
        reader.unknown_keys(table, Section::Disc, "disc");
        let damping = reader.optional(table, "disc", MODAL_DAMPING).or(0.0);
        let parts = without(reader, table);
        let metal = Metal::read(reader, table, header);
        let source = modes::read(reader, table, header);
        let centrifugal = rotation::read(reader, table, source.as_ref());
        let scales = match (&source, &metal) {
            (Some(source), Some(metal)) => scales(source, metal),
            // The error has been reported already; the loads are still checked.
            _ => LoadScales { disc: Some(UNIT), outer_radius_m: Some(1.0) },
        };
        let pads = loads::read(reader, table, scales);
        reader.set_disc_scales(scales.disc);
        let (pads, source) = (pads?, source?);
        let drive = rotation::drive(reader, table, &pads).ok()?;
        let (damping, parts, metal) = (damping?, parts?, metal?);
        let centrifugal = centrifugal?;
        let radii: Vec<Option<f64>> = pads.iter().map(|pad| pad.radius).collect();
        let (modes, shapes, warnings) = modes::at_loads(reader, &source, &pads, damping)?;
        let patches = patches(reader, &source, &pads, &modes)?;
        let speed = pads.iter().find_map(|pad| pad.speed.map(|(speed, _)| speed)).unwrap_or(0.0);
        let drive = drive.map(|course| course.profile(speed));
        let half_thickness = |pad: &Pad| {
            let known = metal.material.as_ref().zip(pad.radius).map(|(material, radius)| {
                0.5 * material.thickness() / (radius * material.outer_radius())
            });
            // Only a friction law needs it.
            pad.half_thickness.or(known.filter(|_| pad.load.normal_load.is_some())).unwrap_or(0.0)
        };
        let halves: Vec<f64> = pads.iter().map(half_thickness).collect();
        let loads = pads
            .into_iter()
            .zip(shapes)
            .zip(patches)
            .zip(halves)
            .map(|(((Pad { load, radius, .. }, shapes), patch), half_thickness)| Load {
                half_thickness,
                shapes,
                radius_ratio: radius,
                patch,
                ..load
            })
            .collect();
        let centrifugal = rotation::stiffening(&source, centrifugal, modes.len());
        Some(Self {
            source,
            metal,
            modes,
            loads,
            radii,
            speed,
            drive,
            parts,
            centrifugal,
            warnings,
        })
    }
}

/// The patches of the loads that are not points.
fn patches(
    reader: &mut Reader,
    source: &ModeSource,
    pads: &[Pad],
    modes: &[Mode],
) -> Option<Vec<Option<Patch>>> {
    let plate = match source {
        ModeSource::Plate(plate) => Some(&**plate),
        ModeSource::List(_) | ModeSource::File { .. } => None,
    };
    let diameters = modes.iter().map(|mode| mode.diameters).max().unwrap_or(0);
    let patches: Vec<Option<Option<Patch>>> = pads
        .iter()
        .map(|pad| match &pad.patch {
            None => Some(None),
            Some(size) => size.around(reader, &pad.path, pad.radius, diameters, plate).map(Some),
        })
        .collect();
    patches.into_iter().collect()
}

/// Placeholder for unknown scales.
const UNIT: DiscScales =
    DiscScales { reference_hz: 1.0, plate_mass_kg: Some(1.0), load_radius_m: Some(1.0) };

/// Scales that convert the numbers of a disc to SI.
pub(super) fn scales(source: &ModeSource, metal: &Metal) -> LoadScales {
    let plate = match source {
        ModeSource::Plate(plate) => Some(&plate.plate),
        _ => None,
    };
    let material = metal.material.as_ref();
    let computed = plate.zip(material).map(|(plate, material)| material.plate_mass(plate));
    let disc = source.reference_hz(material).map(|reference_hz| DiscScales {
        reference_hz,
        plate_mass_kg: computed.or(metal.mass_kg),
        load_radius_m: None,
    });
    LoadScales { disc, outer_radius_m: metal.outer_radius_m }
}

/// `without = ["damper", …]`.
fn without(reader: &mut Reader, table: &Table) -> Option<Contributions> {
    let mut parts = Contributions::ALL;
    let Some(node) = table.get("without") else { return Some(parts) };
    let one = [node.clone()];
    let list: &[Node] = match &node.value {
        Value::List(list) => list,
        _ => &one,
    };
    let mut right = true;
    for (index, node) in list.iter().enumerate() {
        let key = format!("disc.without[{index}]");
        match reader.choice(&key, node, Choice::Contribution).and_then(Contribution::from_name) {
            Some(part) => parts = parts.without(part),
            None => right = false,
        }
    }
    right.then_some(parts)
}
