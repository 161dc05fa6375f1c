//! Modes of a disc: computed, listed, or read from a file; and their shapes at the loads.

use std::fmt;
use std::sync::Arc;

use quell_disc::plate::PlateMaterial;
use quell_input::complaint::{Complaint, Fault, Origin};
use quell_input::disc_modes_file::{self, ModeLine};
use quell_input::document::{Node, Table, Value};
use quell_model::disc::Mode;
use quell_model::parameter::disc::{
    MODE_CENTRIFUGAL, MODE_DAMPING, MODE_DIAMETERS, MODE_FREQUENCY, MODE_RATIO, MODE_SHAPE_AT_LOAD,
};
use serde_json::Value as Json;

use super::loads::Pad;
use super::plate::{self, PlateModes};
use crate::study::reader::Reader;
use crate::study::vocabulary::Section;

/// Where the modes of a study come from.
#[derive(Clone, Debug, PartialEq)]
pub enum ModeSource {
    /// Computed from the plate.
    Plate(Arc<PlateModes>),
    /// Listed as `[[disc.mode]]`.
    List(Listed),
    /// Read from a CSV file.
    File {
        /// The name of the file, as the study gives it.
        name: String,
        /// The modes in the file.
        listed: Listed,
    },
}

impl ModeSource {
    /// ω_ref in hertz, if the material or listed frequencies determine it.
    pub fn reference_hz(&self, material: Option<&PlateMaterial>) -> Option<f64> {
        match self {
            Self::Plate(plate) => Some(material?.hertz(&plate.plate, plate.set.reference())),
            Self::List(listed) | Self::File { listed, .. } => listed.reference_hz,
        }
    }
}

/// Modes given by hand.
#[derive(Clone, Debug, PartialEq)]
pub struct Listed {
    /// The modes, each with its own damping where it has one.
    pub modes: Vec<ListedMode>,
    /// ω_ref in hertz, where the modes were given in hertz.
    pub reference_hz: Option<f64>,
}

/// A mode given by hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ListedMode {
    /// Nodal diameters.
    pub diameters: usize,
    /// Frequency over ω_ref.
    pub ratio: f64,
    /// Shape at the load.
    pub shape_at_load: f64,
    /// Damping ratio; `None` for that of the disc.
    pub damping: Option<f64>,
    /// Centrifugal stiffening; `None` for that of the disc.
    pub centrifugal: Option<f64>,
}

/// Reads the modes: computed, listed, or from a file.
pub(super) fn read(reader: &mut Reader, table: &Table, header: Origin) -> Option<ModeSource> {
    let (list, file) = (table.get("mode"), table.get("modes_file"));
    let given = list.map(|node| ("disc.mode", node)).or(file.map(|node| ("disc.modes_file", node)));
    let Some((key, node)) = given else {
        return plate::read(reader, table, header).map(ModeSource::Plate);
    };
    let plate = ["inner_radius_ratio", "poisson_ratio", "radial_modes", "nodal_diameters"];
    let others = plate.into_iter().chain(["reference_frequency"]);
    let mut right = true;
    for name in others.chain(list.and(file).map(|_| "modes_file")) {
        // Listed frequencies use the "critical" reference anyway.
        let critical = |node: &Node| node.value == Value::Text("critical".to_owned());
        if let Some(other) = table.get(name).filter(|node| !critical(node)) {
            let allowed = format!("the modes are already given by {key}; remove this key");
            let key = format!("disc.{name}");
            let given = other.given();
            reader.complain(Complaint::new(Fault::Conflict, key, other.origin, given, allowed));
            right = false;
        }
    }
    if !right {
        return None;
    }
    if list.is_some() {
        return listed(reader, node).map(ModeSource::List);
    }
    let name = reader.text(key, node)?;
    let (files, parse) = (reader.files(), disc_modes_file::parse);
    let lines: Result<Arc<Vec<ModeLine>>, _> =
        files.parsed(key, &name, disc_modes_file::WANTED, parse);
    let lines = reader.in_file((key, node), &name, lines)?;
    let listed = reader.in_file((key, node), &name, together(&lines))?;
    Some(ModeSource::File { name, listed })
}

/// `[[disc.mode]]`.
fn listed(reader: &mut Reader, node: &Node) -> Option<Listed> {
    let Value::List(list) = &node.value else {
        reader.wrong("disc.mode", node, format!("tables [[disc.mode]]; got {}", node.kind()));
        return None;
    };
    if list.is_empty() {
        reader.wrong("disc.mode", node, "at least one mode");
        return None;
    }
    let lines: Vec<Option<ModeLine>> = list
        .iter()
        .enumerate()
        .map(|(index, node)| line(reader, node, &format!("disc.mode[{index}]")))
        .collect();
    let lines: Vec<ModeLine> = lines.into_iter().collect::<Option<_>>()?;
    match together(&lines) {
        Ok(listed) => Some(listed),
        Err(why) => {
            let complaint =
                Complaint::new(Fault::Value, "disc.mode", node.origin, Json::Null, why.to_string());
            reader.complain(complaint);
            None
        }
    }
}

fn line(reader: &mut Reader, node: &Node, path: &str) -> Option<ModeLine> {
    let table = reader.table(path, node)?;
    reader.unknown_keys(table, Section::DiscMode, path);
    let mut maybe = |parameter| reader.optional(table, path, parameter).if_given();
    let (hertz, damping) = (maybe(MODE_FREQUENCY), maybe(MODE_DAMPING));
    let centrifugal = maybe(MODE_CENTRIFUGAL);
    let diameters = reader.number(table, path, node.origin, MODE_DIAMETERS);
    let shape_at_load = reader.number(table, path, node.origin, MODE_SHAPE_AT_LOAD);
    let hertz = hertz?;
    let ratio = match hertz {
        // Only one of the two may be given.
        Some(_) => {
            if let Some(other) = table.get(MODE_RATIO.key()) {
                let allowed = "give either ratio or frequency_hz, not both";
                let (key, given) = (format!("{path}.ratio"), other.given());
                reader.complain(Complaint::new(Fault::Conflict, key, other.origin, given, allowed));
                return None;
            }
            None
        }
        None => Some(reader.number(table, path, node.origin, MODE_RATIO)?),
    };
    Some(ModeLine {
        diameters: diameters?,
        ratio,
        hertz,
        shape_at_load: shape_at_load?,
        damping: damping?,
        centrifugal: centrifugal?,
    })
}

/// Why modes with their frequencies as given make no list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum MixedModes {
    /// Frequencies in hertz, and no mode defines the critical speed.
    NoDiameter,
    /// Some have ratios and others frequencies in hertz.
    Units,
}

impl fmt::Display for MixedModes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NoDiameter => {
                "modes with at least one nodal diameter, which define the critical speed; otherwise give ratios"
            }
            Self::Units => "modes that either all have a ratio or all have a frequency_hz",
        })
    }
}

/// Modes of the lines; frequencies in hertz are measured in the lowest critical speed of the list.
fn together(lines: &[ModeLine]) -> Result<Listed, MixedModes> {
    let in_hertz = lines.iter().filter(|line| line.ratio.is_none()).count();
    let reference_hz = match in_hertz {
        0 => None,
        count if count == lines.len() => {
            let speeds = lines.iter().filter(|line| line.diameters > 0.0);
            let lowest = speeds
                .filter_map(|line| Some(line.hertz? / line.diameters))
                .reduce(f64::min)
                .ok_or(MixedModes::NoDiameter)?;
            Some(lowest)
        }
        _ => return Err(MixedModes::Units),
    };
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a whole number within the bounds of the registry"
    )]
    let modes = lines
        .iter()
        .map(|line| ListedMode {
            diameters: line.diameters as usize,
            ratio: match (line.ratio, line.hertz, reference_hz) {
                (Some(ratio), _, _) => ratio,
                (None, Some(hertz), Some(reference)) => hertz / reference,
                (None, _, _) => f64::NAN,
            },
            shape_at_load: line.shape_at_load,
            damping: line.damping,
            centrifugal: line.centrifugal,
        })
        .collect();
    Ok(Listed { modes, reference_hz })
}

/// Modes with their shapes at the first load, the shapes at each load at another radius, warnings.
type AtLoads = (Vec<Mode>, Vec<Option<Vec<f64>>>, Vec<String>);

/// The modes of a plate at a radius.
struct ModesAtRadius {
    plate: Arc<PlateModes>,
    radius: f64,
    damping: f64,
    modes: Vec<Mode>,
}

/// Evaluates the modes at the loads.
pub(super) fn at_loads(
    reader: &mut Reader,
    source: &ModeSource,
    pads: &[Pad],
    damping: f64,
) -> Option<AtLoads> {
    let plate = match source {
        ModeSource::List(listed) | ModeSource::File { listed, .. } => {
            let modes = listed.modes.iter().map(|mode| Mode {
                diameters: mode.diameters,
                ratio: mode.ratio,
                shape_at_load: mode.shape_at_load,
                damping: mode.damping.unwrap_or(damping),
            });
            return Some((modes.collect(), vec![None; pads.len()], Vec::new()));
        }
        ModeSource::Plate(plate) => plate,
    };
    let inner = plate.plate.inner_radius_ratio();
    let mut warnings = Vec::new();
    let mut right = true;
    for pad in pads {
        let mut refuse = |fault: Fault, given: Json| {
            let key = format!("{}.radius_ratio", pad.path);
            let allowed = format!(
                "a number in [{inner}, 1], between the clamp (disc.inner_radius_ratio) and the edge"
            );
            reader.complain(Complaint::new(fault, key, pad.origin, given, allowed));
            right = false;
        };
        match pad.radius {
            None => refuse(Fault::Missing, Json::Null),
            Some(radius) if radius < inner => refuse(Fault::Value, radius.into()),
            Some(radius) if radius == inner => warnings.push(format!(
                "{} is at the clamp (radius_ratio = inner_radius_ratio = {inner}), where the disc does not move, so it \
                 couples to no mode",
                pad.path
            )),
            Some(_) => {}
        }
    }
    if !right {
        return None;
    }
    // Without a load the shapes are given at the edge; nothing depends on them.
    let first = pads.first().and_then(|pad| pad.radius).unwrap_or(1.0);
    let mut at = |radius: f64| {
        let is = |known: &ModesAtRadius| {
            Arc::ptr_eq(&known.plate, plate) && (known.radius, known.damping) == (radius, damping)
        };
        let compute = || {
            let modes = plate.set.at_radius(radius, damping).ok_or(())?;
            Ok::<_, ()>(ModesAtRadius { plate: Arc::clone(plate), radius, damping, modes })
        };
        reader.computed().get(is, compute).ok()
    };
    let modes = at(first)?.modes.clone();
    let shapes = pads
        .iter()
        .map(|pad| {
            let radius = pad.radius.filter(|radius| *radius != first)?;
            Some(at(radius)?.modes.iter().map(|mode| mode.shape_at_load).collect())
        })
        .collect();
    Some((modes, shapes, warnings))
}
