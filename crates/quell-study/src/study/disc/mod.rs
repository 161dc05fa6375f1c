//! `[disc]`: the study of an annular disc under rotating loads.
//!
//! Modes are computed from the plate, listed as `[[disc.mode]]`, or read from a CSV file; loads are one `[disc.load]` or
//! several `[[disc.load]]`; `without` switches contributions off; `[dither]` modulates every load's friction.

mod body;
mod loads;
mod modes;
mod modes_file;
mod plate;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use quell_disc::plate::PlateMaterial;
use quell_model::Direction;
use quell_model::Disc;
use quell_model::disc::DiscDither;
use quell_model::disc::{Contribution, Contributions};
use quell_model::parameter::DITHER_FREQUENCY_RATIO;
use quell_model::parameter::disc::DISC_DITHER_AMPLITUDE;
use quell_model::units::DiscScales;
use serde_json::Value as Json;

use super::change::Change;
use super::mirror::{Table, Value};
use super::reader::{Found, Reader};
use super::sweep::{self, Sweep};
use super::vocabulary::{self, Choice, Role, join};
use super::{file, measures, revision, root};
use crate::complaint::{Complaint, Fault, Origin};
use crate::input::Inputs;

pub use modes::{Listed, ModeSource};
pub use plate::PlateModes;

use body::Body;

/// Tables and keys of a disc study outside any table.
const ROOT: &[&str] = &["schema", "title", "disc", "dither", "sweep"];

/// A checked study of a disc.
#[derive(Clone, Debug)]
pub struct DiscStudy {
    disc: Disc,
    parts: Contributions,
    common: Arc<Common>,
    /// The file that it was read from; `-` is standard input.
    file: Option<PathBuf>,
}

/// What does not change along the axes of a map that set numbers of the equations.
#[derive(Clone, Debug)]
struct Common {
    title: Option<String>,
    source: ModeSource,
    material: Option<PlateMaterial>,
    radii: Vec<Option<f64>>,
    warnings: Vec<String>,
    sweeps: Vec<Sweep>,
    mirror: Table,
    text: String,
    folder: PathBuf,
    changes: Vec<String>,
}

impl DiscStudy {
    /// Checks the text of a study after changing it; a file of modes is looked for in `folder`.
    ///
    /// # Errors
    /// Every complaint at once.
    pub fn parse(text: &str, changes: &[Change], folder: &Path) -> Result<Self, Vec<Complaint>> {
        revision::changed(text, changes, |mirror, told| {
            Self::check(mirror, text, folder, told, None)
        })
    }

    /// The study at one point of a map: its numbers set through the same path as `--set`, in order, and no axes.
    ///
    /// # Errors
    /// Every complaint about the changed study.
    pub fn at<'a>(
        &self,
        numbers: impl IntoIterator<Item = (&'a str, f64)>,
    ) -> Result<Self, Vec<Complaint>> {
        let common = &self.common;
        let (mirror, changes) = revision::at(&common.mirror, &common.changes, numbers)?;
        let study =
            Self::check(mirror, &common.text, &common.folder, changes, Some(&common.source))?;
        Ok(Self { file: self.file.clone(), ..study })
    }

    /// The same study, which was read from this file.
    pub(super) fn read_from(self, file: PathBuf) -> Self {
        Self { file: Some(file), ..self }
    }

    /// The files that it was read from: none of them is an output.
    pub fn inputs(&self) -> Inputs {
        let modes = match &self.common.source {
            ModeSource::File { path, .. } => Some(path.as_path()),
            ModeSource::Plate(_) | ModeSource::List(_) => None,
        };
        file::inputs(self.file.as_deref(), &self.common.folder, modes)
    }

    /// The same study with these axes in place of its own.
    ///
    /// # Errors
    /// Every complaint about the axes.
    pub fn sweeping(&self, axes: &[Table]) -> Result<Self, Vec<Complaint>> {
        let common = &self.common;
        let mut mirror = common.mirror.clone();
        sweep::replace(&mut mirror, axes);
        measures::resolve(&mut mirror);
        let told = sweep::told(&common.changes, axes);
        let study = Self::check(mirror, &common.text, &common.folder, told, Some(&common.source))?;
        Ok(Self { file: self.file.clone(), ..study })
    }

    /// The disc at one point of a map, the same as that of [`DiscStudy::at`]: without reading the study again where
    /// the numbers are ones of the equations. `None` where they make no valid study.
    pub fn disc_at(&self, numbers: &[(&str, f64)]) -> Option<Disc> {
        let direct = |path: &str| {
            let key = path.rsplit('.').next().unwrap_or_default();
            let load = path.starts_with("disc.load")
                && ["mass", "damping", "stiffness", "friction", "speed"].contains(&key);
            load && (path.contains('[') || self.disc.loads().len() == 1)
                || (path.starts_with("dither") && !path.contains('['))
        };
        if numbers.iter().all(|(path, _)| direct(path) && self.disc.get(path).is_some()) {
            let mut disc = self.disc.clone();
            for (path, value) in numbers {
                disc = disc.with(path, *value).ok()?;
            }
            return Some(disc);
        }
        self.at(numbers.iter().copied()).ok().map(|study| study.disc)
    }

    fn check(
        mirror: Table,
        text: &str,
        folder: &Path,
        changes: Vec<String>,
        known: Option<&ModeSource>,
    ) -> Result<Self, Vec<Complaint>> {
        let mut reader = Reader::of_a_disc();
        let title = root(&mut reader, &mirror, ROOT);
        for name in ["belt", "friction", "solver"] {
            if let Some(node) = mirror.get(name) {
                let allowed =
                    format!("a study is of a belt or of a disc; [{name}] is about a belt");
                let complaint =
                    Complaint::new(Fault::Conflict, name, node.origin, Json::Null, allowed);
                reader.complain(complaint);
            }
        }
        let table = mirror.get("disc").and_then(|node| reader.table("disc", node));
        let read = table.map(|table| {
            let origin = mirror.get("disc").map_or(Origin::Whole, |node| node.origin);
            Body::read(&mut reader, table, origin, folder, known)
        });
        let dither = dither(&mut reader, &mirror);
        let sweeps = sweep::read(&mut reader, &mirror);
        let complaints = reader.complaints_so_far();
        let (Some(body), Some(dither), Some(sweeps)) = (read.flatten(), dither, sweeps) else {
            return Err(reader.into_complaints());
        };
        if complaints > 0 {
            return Err(reader.into_complaints());
        }
        let Body { source, material, modes, loads, radii, speed, parts, warnings } = body;
        let disc = match Disc::new(modes, loads, dither, speed) {
            Ok(disc) => disc,
            Err(invalid) => {
                // The reader knows where each number was written; what it does not know is told plainly.
                let plain: Vec<Complaint> = invalid
                    .iter()
                    .map(|it| {
                        let (key, value) = (it.key.clone(), it.value.clone());
                        Complaint::new(Fault::Value, key, Origin::Whole, value, it.allowed.clone())
                    })
                    .collect();
                reader.adopt(invalid);
                let told = reader.into_complaints();
                return Err(if told.is_empty() { plain } else { told });
            }
        };
        let common = Common {
            title,
            source,
            material,
            radii,
            warnings,
            sweeps,
            mirror,
            text: text.to_owned(),
            folder: folder.to_owned(),
            changes,
        };
        let study = Self { disc, parts, common: Arc::new(common), file: None };
        revision::ends_valid(&study.common.mirror, study.sweeps(), |number| study.at(number))?;
        Ok(study)
    }

    /// Title, if the file gives one.
    pub fn title(&self) -> Option<&str> {
        self.common.title.as_deref()
    }

    /// The disc in the numbers of the equations, whole.
    pub fn disc(&self) -> &Disc {
        &self.disc
    }

    /// The contributions that are left.
    pub fn parts(&self) -> Contributions {
        self.parts
    }

    /// Names of the contributions that are switched off.
    pub fn without(&self) -> Vec<&'static str> {
        let off = |part: &&Contribution| !self.parts.contains(**part);
        Contribution::ALL.iter().filter(off).map(|part| part.name()).collect()
    }

    /// Where the modes come from.
    pub fn source(&self) -> &ModeSource {
        &self.common.source
    }

    /// Material and size of the plate, where the study gives them.
    pub fn material(&self) -> Option<&PlateMaterial> {
        self.common.material.as_ref()
    }

    /// Radius of each load over the outer radius, where the study gives it.
    pub fn radii(&self) -> &[Option<f64>] {
        &self.common.radii
    }

    /// What a reader of the results should know.
    pub fn warnings(&self) -> &[String] {
        &self.common.warnings
    }

    /// The axes of a map, in order.
    pub fn sweeps(&self) -> &[Sweep] {
        &self.common.sweeps
    }

    /// Changes made to the text, as `path=value`.
    pub fn changes(&self) -> &[String] {
        &self.common.changes
    }

    /// The text of the file as it was read, without changes.
    pub fn text(&self) -> &str {
        &self.common.text
    }

    /// Every value of the study after its changes as `path = value`, in the order of paths, and the modes of a file with it;
    /// neither title nor axes.
    pub fn settings(&self) -> Vec<(String, String)> {
        let listed = match self.common.source {
            ModeSource::File { .. } => self.disc.modes(),
            _ => &[],
        };
        let modes = listed.iter().enumerate().map(|(index, mode)| {
            let numbers = format!(
                "{} {:?} {:?} {:?}",
                mode.diameters, mode.ratio, mode.shape_at_load, mode.damping
            );
            (format!("disc.modes_file[{index}]"), numbers)
        });
        revision::settings(&self.common.mirror, modes)
    }

    /// Hertz of a frequency of one ω_ref, where material or listed frequencies tell it.
    pub fn reference_hz(&self) -> Option<f64> {
        self.common.source.reference_hz(self.common.material.as_ref())
    }

    /// What turns numbers of the equations into SI at a load, where the study says enough.
    pub fn scales(&self, load: usize) -> Option<DiscScales> {
        let scales = body::scales(&self.common.source, self.common.material.as_ref());
        scales.at(self.common.radii.get(load).copied().flatten())
    }

    /// Whether a key of the study gives a load, its speed or the dither's frequency in SI: plain numbers of speeds and
    /// frequencies are in hertz then.
    pub fn is_si(&self) -> bool {
        let said = |path: &str| {
            let role = vocabulary::resolve(path).map(|address| address.key.role);
            matches!(role, Ok(Role::Twin(..)))
        };
        self.settings().iter().any(|(path, _)| said(path))
    }
}

/// `[dither]` of a disc.
fn dither(reader: &mut Reader, mirror: &Table) -> Option<DiscDither> {
    let Some(node) = mirror.get("dither") else { return Some(DiscDither::None) };
    let node = match &node.value {
        Value::List(list) if list.len() == 1 => &list[0],
        _ => node,
    };
    let table = reader.table("dither", node)?;
    let keys = ["direction", "waveform", "amplitude", "frequency_ratio", "frequency_hz"];
    for (name, node) in table.iter().filter(|(name, _)| !keys.contains(name)) {
        let nearest = super::suggest::word(name, keys).map(|word| join("dither", &word));
        let complaint = Complaint::new(
            Fault::Unknown,
            join("dither", name),
            node.origin,
            node.given(),
            keys.join(", "),
        );
        reader.complain(complaint.suggesting(nearest));
    }
    let direction = reader
        .needed_choice(table, "dither", node.origin, "direction", Choice::Direction)
        .and_then(Direction::from_name);
    let waveform = match table.get("waveform") {
        None => Some("sine"),
        Some(node) => match reader.choice("dither.waveform", node, Choice::Waveform) {
            Some("sine") => Some("sine"),
            Some(_) => {
                reader.wrong("dither.waveform", node, "\"sine\", the waveform of a disc's dither");
                None
            }
            None => None,
        },
    };
    let amplitude = match reader.optional(table, "dither", DISC_DITHER_AMPLITUDE, None) {
        // The dissertation's tangential dither.
        Found::Absent => Some(1.0),
        found => found.or(1.0),
    };
    let frequency_ratio = reader.number(table, "dither", node.origin, DITHER_FREQUENCY_RATIO);
    waveform?;
    let (amplitude, frequency_ratio) = (amplitude?, frequency_ratio?);
    Some(match direction? {
        Direction::Normal => DiscDither::Normal { amplitude, frequency_ratio },
        Direction::Tangential => DiscDither::Tangential { amplitude, frequency_ratio },
    })
}
