//! `[disc]`: the study of an annular disc under rotating loads.
//!
//! Modes are computed from the plate, listed as `[[disc.mode]]`, or read from a CSV file; loads are one `[disc.load]` or
//! several `[[disc.load]]`, each at a point or over an area, on the ground or on a pad and a caliper; `without` switches contributions off; `[friction]` gives the friction of all
//! loads by a law instead of a force each; `[dither]` modulates every load's friction, `[disc.load.envelope]` gives a load over time
//! and `[disc.drive]` the speed. `[design]` asks for the least dither over a range of speeds.

mod body;
mod carriers;
mod dither;
mod driven;
mod law;
mod loads;
mod modes;
mod patch;
mod plate;
mod rotation;
mod template;

use std::sync::Arc;

use quell_design::actuator::Actuator;
use quell_disc::plate::PlateMaterial;
use quell_input::complaint::{Complaint, Fault, Origin};
use quell_input::document::Table;
use quell_model::disc::{Contribution, Contributions, DiscDither};
use quell_model::parameter::disc::LOAD_SLIP_RATIO;
use quell_model::units::{DiscScales, UnitSystem, measure};
use quell_model::{Disc, InvalidValues, System};

use super::StudyOf;
use super::address::units_of;
use super::design::{self, Design, DesignContext};
use super::dither_size::GivenSize;
use super::path;
use super::reader::{EquationScale, Reader};
use super::study_kind::StudyKind;
use super::system::{SystemSetup, SystemStart, SystemStudy};
use super::template::Template;
use super::vocabulary::{Choice, Role, Section, UNITS};

pub use modes::{Listed, ModeSource};
pub use plate::PlateModes;

use body::Body;
use dither::ReadDiscDither;
use driven::DiscActuator;

/// A checked study of a disc.
pub type DiscStudy = StudyOf<DiscSetup>;

/// The parts of a study that only a disc has.
#[derive(Clone, Debug, PartialEq)]
pub struct DiscSetup {
    disc: Disc,
    parts: Contributions,
    plate: Arc<PlateSetup>,
    /// The design that is asked for.
    design: Option<Design>,
    /// The actuator that gives the dither.
    driven: Option<DiscActuator>,
}

/// The parts that most points of a map share.
#[derive(Clone, Debug, PartialEq)]
struct PlateSetup {
    source: ModeSource,
    material: Option<PlateMaterial>,
    radii: Vec<Option<f64>>,
    warnings: Vec<String>,
}

impl StudyKind for DiscSetup {
    fn reader(document: &Table) -> Reader {
        Reader::in_units(units_of(document), EquationScale::Disc(None))
    }

    fn read(reader: &mut Reader, document: &Table) -> Option<Self> {
        let table = document.get("disc").and_then(|node| reader.table("disc", node));
        if let Some(node) = table.and_then(|table| table.get(UNITS)) {
            reader.choice("disc.units", node, Choice::Units);
        }
        let read = table.map(|table| {
            let origin = document.get("disc").map_or(Origin::Whole, |node| node.origin);
            Body::read(reader, table, origin)
        });
        let dither = dither::read(reader, document);
        let read = read.flatten();
        let law = law::read(reader, document, read.as_ref());
        let waveform = dither.as_ref().map(|read| &read.shape.waveform);
        let design =
            design::read(reader, document, DesignContext { waveform, document, places: &[] });
        let actuator = driven::read(reader, document);
        let (body, read, law, design, actuator) = (read?, dither?, law?, design?, actuator?);
        let ReadDiscDither { dither, shape, driven: size } = read;
        let shaken = body.loads.iter().find_map(|load| load.slip_ratio);
        if let Some(ratio) = shaken.filter(|_| !matches!(dither, DiscDither::Tangential { .. })) {
            let allowed = "only with tangential dither, whose force it determines";
            let key = LOAD_SLIP_RATIO.path;
            reader.complain(Complaint::new(Fault::Conflict, key, Origin::Whole, ratio, allowed));
        }
        if reader.complaints_so_far() > 0 {
            return None;
        }
        let Body { source, metal, modes, loads, radii, parts, warnings, .. } = body;
        let scales = body::scales(&source, &metal);
        let material = metal.material;
        let disc = Disc::dithered_by(modes, loads, (dither, shape), body.speed);
        let disc = disc.and_then(|disc| match body.drive {
            Some(drive) => disc.driven(drive),
            None => Ok(disc),
        });
        let disc = disc.and_then(|disc| disc.stiffened(body.centrifugal));
        let disc = disc.and_then(|disc| match law {
            Some(law) => disc.under_law(law),
            None => Ok(disc),
        });
        match disc {
            Ok(disc) => {
                let disc = disc.in_si(scales.disc, scales.outer_radius_m);
                let (disc, driven) = match actuator {
                    Some(actuator) => {
                        let (disc, driven) = driven::driven(reader, disc, parts, actuator, size)?;
                        (disc, Some(driven))
                    }
                    None => (disc, None),
                };
                let plate = Arc::new(PlateSetup { source, material, radii, warnings });
                Some(Self { disc, parts, plate, design, driven })
            }
            Err(invalid) => {
                // The reader knows where most numbers were written; the others are reported by key alone.
                reader.adopt(invalid.clone());
                if reader.complaints_so_far() == 0 {
                    for wrong in invalid {
                        let (key, value) = (wrong.key, wrong.value);
                        let complaint =
                            Complaint::new(Fault::Value, key, Origin::Whole, value, wrong.allowed);
                        reader.complain(complaint);
                    }
                }
                None
            }
        }
    }
}

impl DiscSetup {
    /// Name of the kind.
    pub const NAME: &'static str = "disc";

    /// The disc in the numbers of the equations, whole.
    pub fn disc(&self) -> &Disc {
        &self.disc
    }

    /// The equations of its modes with the contributions that are switched on.
    pub(super) fn equations(&self) -> System {
        self.disc.system_of(self.parts)
    }

    /// The contributions that are switched on.
    pub(super) fn parts(&self) -> Contributions {
        self.parts
    }

    /// The equations in SI, or scaled where the scales of the disc are not known.
    pub(super) fn in_si(&self) -> Result<(System, UnitSystem), InvalidValues> {
        match self.disc.system_in_si(self.parts) {
            Some(system) => Ok((system?, UnitSystem::Si)),
            None => Ok((self.equations(), UnitSystem::None)),
        }
    }

    /// The row of the deflection under the first load; of the first coordinate where there is no load.
    pub(super) fn observed_row(&self) -> Vec<f64> {
        if self.disc.loads().is_empty() {
            return (0..self.disc.coordinates()).map(|index| f64::from(index == 0)).collect();
        }
        self.disc.surface_row(0)
    }
}

impl DiscStudy {
    /// The disc in the numbers of the equations, whole.
    pub fn disc(&self) -> &Disc {
        &self.kind().disc
    }

    /// The design that the study asks for.
    pub fn design(&self) -> Option<&Design> {
        self.kind().design.as_ref()
    }

    /// The actuator that gives the dither, in SI.
    pub fn actuator(&self) -> Option<&Actuator> {
        self.kind().driven.as_ref().map(|driven| &driven.actuator)
    }

    /// The amplitude that the study gives by what its actuator takes.
    pub fn given_sizes(&self) -> &[GivenSize] {
        self.kind().driven.as_ref().map_or(&[], |driven| &driven.sizes)
    }

    /// The disc as the system of its modes, whose runs begin there.
    pub fn starting_from(&self, initial: SystemStart) -> SystemStudy {
        let setup = self.kind().system(&self.source.document);
        self.map_kind(SystemSetup { initial, ..setup })
    }

    /// The row of the deflection under the first load; of the first coordinate where there is no load.
    pub fn observed_row(&self) -> Vec<f64> {
        self.kind().observed_row()
    }

    /// The contributions that are switched on.
    pub fn parts(&self) -> Contributions {
        self.kind().parts
    }

    /// Names of the contributions that are switched off.
    pub fn without(&self) -> Vec<&'static str> {
        let off = |part: &&Contribution| !self.kind().parts.contains(**part);
        Contribution::ALL.iter().filter(off).map(|part| part.name()).collect()
    }

    /// Where the modes come from.
    pub fn source(&self) -> &ModeSource {
        &self.kind().plate.source
    }

    /// Material and size of the plate, where the study gives them.
    pub fn material(&self) -> Option<&PlateMaterial> {
        self.kind().plate.material.as_ref()
    }

    /// Radius of each load over the outer radius, where the study gives it.
    pub fn radii(&self) -> &[Option<f64>] {
        &self.kind().plate.radii
    }

    /// Warnings about the study.
    pub fn warnings(&self) -> &[String] {
        &self.kind().plate.warnings
    }

    /// ω_ref in hertz, if the material or listed frequencies determine it.
    pub fn reference_hz(&self) -> Option<f64> {
        self.kind().plate.source.reference_hz(self.kind().plate.material.as_ref())
    }

    /// Scales that convert dimensionless numbers to SI at a load, if the study determines them.
    pub fn scales(&self, load: usize) -> Option<DiscScales> {
        self.kind().disc.scales(load)
    }

    /// Whether a key of the study gives a load, its speed or the dither's frequency in SI: plain numbers of speeds and
    /// frequencies are in hertz then.
    pub fn is_si(&self) -> bool {
        is_si(&self.source.document)
    }
}

/// [`DiscStudy::is_si`] of a document.
fn is_si(document: &Table) -> bool {
    let mut given = Vec::new();
    for (name, node) in document.iter() {
        node.leaves(name, &mut given);
    }
    let said = |(path, value): &(String, String)| {
        let Ok(found) = path::follow(document, path) else { return false };
        let key = found.key;
        let of_motion = !matches!(key.section, Section::Disc | Section::DiscMode);
        let quoted = || {
            let has_unit = key.quantity().is_some_and(|quantity| quantity.si_unit().is_some());
            has_unit && measure::has_unit(value.trim_matches('"'))
        };
        match key.role {
            Role::Twin(..) => true,
            Role::Course(course) => course.si() == Some(true),
            _ => of_motion && quoted(),
        }
    };
    !units_of(document).is_none() || given.iter().any(said)
}
