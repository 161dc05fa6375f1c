//! The study file: text, its mirror, and the checked study.
//!
//! `study.toml` → [`mirror::Table`] → [`Study`], which is valid by construction. Every
//! complaint is told at once, with key, line, value, what is allowed, and the nearest
//! right key.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use quell_model::parameter::NORMAL_LOAD;
use quell_model::units::{Quantity, Scales};
use quell_model::{Belt, Dither, Friction, LawKind};
use serde_json::Value as Json;

use crate::complaint::{Complaint, Failure, Fault};
use crate::input::Inputs;
use belt::BeltTable;
use mirror::{Table, Value};
use reader::Reader;
use vocabulary::{NOT_BUILT, SCHEMA_VERSION, Section};

mod belt;
mod change;
mod data_file;
pub mod disc;
mod dither;
mod file;
mod friction;
mod measures;
pub mod mirror;
mod reader;
mod response;
mod revision;
mod solver;
mod subject;
pub mod suggest;
mod sweep;
pub mod vocabulary;

pub use change::Change;
pub use disc::DiscStudy;
pub use friction::Measured;
pub use quell_dynamics::response::Solver;
pub use quell_dynamics::start::InitialState;
pub use subject::Subject;
pub use sweep::{Axis, Sweep};

/// A checked study of a belt.
#[derive(Clone, Debug, PartialEq)]
pub struct Study {
    title: Option<String>,
    belt: Belt,
    initial: InitialState,
    solver: Solver,
    band: Option<[f64; 2]>,
    scales: Option<Scales>,
    sweeps: Vec<Sweep>,
    mirror: Table,
    text: String,
    /// Where files that the study names are looked for.
    folder: PathBuf,
    /// The file that it was read from; `-` is standard input.
    file: Option<PathBuf>,
    /// The samples of a measured law.
    measured: Option<Arc<Measured>>,
    changes: Vec<String>,
}

impl Study {
    /// Reads and checks a study file (`-` is standard input) after changing it.
    ///
    /// # Errors
    /// Every complaint at once.
    pub fn read(path: &Path, changes: &[Change]) -> Result<Self, Failure> {
        let text = file::text(path)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let study = Self::parse_in(&text, changes, folder).map_err(Failure::Wrong)?;
        Ok(study.read_from(file::place(path)))
    }

    /// The same study, which was read from this file.
    fn read_from(self, file: PathBuf) -> Self {
        Self { file: Some(file), ..self }
    }

    /// The files that it was read from: none of them is an output.
    pub fn inputs(&self) -> Inputs {
        let data = self.measured.as_ref().and_then(|measured| measured.file.as_deref());
        file::inputs(self.file.as_deref(), &self.folder, data)
    }

    /// Checks the text of a study after changing it; files that it names are looked for where the program runs.
    ///
    /// # Errors
    /// Every complaint at once.
    pub fn parse(text: &str, changes: &[Change]) -> Result<Self, Vec<Complaint>> {
        Self::parse_in(text, changes, Path::new(""))
    }

    /// Checks the text of a study after changing it; files that it names are looked for in `folder`.
    ///
    /// # Errors
    /// Every complaint at once.
    pub fn parse_in(text: &str, changes: &[Change], folder: &Path) -> Result<Self, Vec<Complaint>> {
        revision::changed(text, changes, |mirror, told| {
            let study = Self::check(mirror, text, folder, None)?;
            Ok(Self { changes: told, ..study })
        })
    }

    /// The same study with one number changed, by any path of the file, SI twins included.
    ///
    /// # Errors
    /// Every complaint about the changed study.
    pub fn with(&self, path: &str, value: f64) -> Result<Self, Vec<Complaint>> {
        let mut mirror = self.mirror.clone();
        Change::number(path, value, "change")
            .apply(&mut mirror)
            .map_err(|complaint| vec![*complaint])?;
        let mut study = self.check_again(mirror)?;
        study.changes.clone_from(&self.changes);
        study.changes.push(format!("{path}={value:?}"));
        Ok(study)
    }

    /// Every value of the study after its changes as `path = value`, in the order of paths;
    /// neither title nor axes. Two studies with equal settings compute the same.
    pub fn settings(&self) -> Vec<(String, String)> {
        revision::settings(&self.mirror, self.measured.iter().map(|measured| measured.settings()))
    }

    /// The samples of a measured law.
    pub fn measured(&self) -> Option<&Measured> {
        self.measured.as_deref()
    }

    /// The study at one point of a map: its numbers set through the same path as `--set`, in
    /// order, and no axes. It is the study that the file would give with these changes.
    ///
    /// # Errors
    /// Every complaint about the changed study.
    pub fn at<'a>(
        &self,
        numbers: impl IntoIterator<Item = (&'a str, f64)>,
    ) -> Result<Self, Vec<Complaint>> {
        let (mirror, changes) = revision::at(&self.mirror, &self.changes, numbers)?;
        Ok(Self { changes, ..self.check_again(mirror)? })
    }

    /// The same study with these axes in place of its own.
    ///
    /// # Errors
    /// Every complaint about the axes.
    pub fn sweeping(&self, axes: &[Table]) -> Result<Self, Vec<Complaint>> {
        let mut mirror = self.mirror.clone();
        sweep::replace(&mut mirror, axes);
        measures::resolve(&mut mirror);
        let mut study = self.check_again(mirror)?;
        study.changes = sweep::told(&self.changes, axes);
        Ok(study)
    }

    /// Checks the changed mirror of this study; files are not read again.
    fn check_again(&self, mirror: Table) -> Result<Self, Vec<Complaint>> {
        let study = Self::check(mirror, &self.text, &self.folder, self.measured.as_deref())?;
        Ok(Self { file: self.file.clone(), ..study })
    }

    fn check(
        mirror: Table,
        text: &str,
        folder: &Path,
        known: Option<&Measured>,
    ) -> Result<Self, Vec<Complaint>> {
        let mut reader = Reader::new(&mirror);
        let title = root(&mut reader, &mirror, ROOT);
        if let Some(node) = mirror.get("disc") {
            reader.complain(subject::not_of_a_belt(node.origin));
            return Err(reader.into_complaints());
        }
        let mut belt = belt::read(&mut reader, &mirror);
        let given = friction::Given { folder, known, normal_load: belt.normal_load };
        let friction = friction::read(&mut reader, &mirror, given);
        let dithers = dither::read(&mut reader, &mirror);
        if let Some(load) = friction.as_ref().and_then(|read| read.own_load) {
            belt.normal_load = Some(load);
            friction::needs_no_normal_force(&mut reader, &mirror, dithers.as_deref());
        }
        let (friction, measured) =
            friction.map_or((None, None), |read| (Some(read.law), read.measured));
        let solver = solver::read(&mut reader, &mirror);
        let band = response::read(&mut reader, &mirror);
        let sweeps = sweep::read(&mut reader, &mirror);
        let built = build(&mut reader, belt, friction, dithers);
        let scales = reader.known_scales();
        let complaints = reader.into_complaints();
        let parts = (built, belt.initial, solver, band, sweeps);
        let (Some(belt), Some(initial), Some(solver), Some(band), Some(sweeps)) = parts else {
            return Err(complaints);
        };
        if !complaints.is_empty() {
            return Err(complaints);
        }
        let study = Self {
            title,
            belt,
            initial,
            solver,
            band,
            scales,
            sweeps,
            mirror,
            text: text.to_owned(),
            folder: folder.to_owned(),
            file: None,
            measured: measured.map(Arc::new),
            changes: Vec::new(),
        };
        revision::ends_valid(&study.mirror, &study.sweeps, |number| study.at(number))?;
        Ok(study)
    }

    /// Title, if the file gives one.
    pub fn title(&self) -> Option<&str> {
        self.title.as_deref()
    }

    /// The belt in the numbers of the equations.
    pub fn belt(&self) -> &Belt {
        &self.belt
    }

    /// Where a run starts.
    pub fn initial(&self) -> InitialState {
        self.initial
    }

    /// Accuracy and length of the computations.
    pub fn solver(&self) -> &Solver {
        &self.solver
    }

    /// The band in which a level of the response is asked for, in ω₀.
    pub fn band(&self) -> Option<[f64; 2]> {
        self.band
    }

    /// Mass and stiffness of a study in SI.
    pub fn scales(&self) -> Option<Scales> {
        self.scales
    }

    /// The axes of a map, in order.
    pub fn sweeps(&self) -> &[Sweep] {
        &self.sweeps
    }

    /// Changes made to the text, as `path=value`.
    pub fn changes(&self) -> &[String] {
        &self.changes
    }

    /// The text of the file as it was read, without changes.
    pub fn text(&self) -> &str {
        &self.text
    }
}

/// Tables and keys of a belt study outside any table.
const ROOT: &[&str] =
    &["schema", "title", "belt", "friction", "dither", "solver", "response", "sweep"];

/// Reads what stands outside the tables; the title.
fn root(reader: &mut Reader, mirror: &Table, names: &[&str]) -> Option<String> {
    let tables: Vec<&str> = Section::ALL.iter().map(|section| section.path()).collect();
    for (name, node) in mirror.iter() {
        if NOT_BUILT.contains(&name) {
            let allowed =
                format!("[{name}] is not built yet; this version computes belts and discs");
            reader.complain(Complaint::new(
                Fault::NotBuilt,
                name,
                node.origin,
                Json::Null,
                allowed,
            ));
        } else if vocabulary::key(Section::Root, name).is_none() && !tables.contains(&name) {
            let nearest = suggest::word(name, names.iter().copied())
                .or_else(|| suggest::path("", name, None));
            let complaint =
                Complaint::new(Fault::Unknown, name, node.origin, node.given(), names.join(", "));
            reader.complain(complaint.suggesting(nearest));
        }
    }
    // A study without a version is of the present one.
    if let Some(node) = mirror.get("schema")
        && node.value != Value::Number(f64::from(SCHEMA_VERSION))
    {
        let allowed = format!("{SCHEMA_VERSION}, the only version of study files, or left out");
        reader.wrong("schema", node, allowed);
    }
    mirror.get("title").and_then(|node| reader.text("title", node))
}

/// Puts the belt together. What was already complained about is stood in for, so that
/// relations between the rest are judged at the same time.
fn build(
    reader: &mut Reader,
    table: BeltTable,
    friction: Option<Friction>,
    dithers: Option<Vec<Dither>>,
) -> Option<Belt> {
    let dithers = dithers?;
    let stand_in = || LawKind::Stribeck.build(&[0.0, 0.0, 1.0]).ok();
    let known = friction.is_some();
    let law = friction.or_else(stand_in)?;
    let number = |value: Option<f64>| value.unwrap_or(f64::NAN);
    let (damping, load, velocity) =
        (number(table.damping_ratio), number(table.normal_load), number(table.belt_velocity));
    match Belt::new(damping, load, velocity, law, dithers) {
        Ok(belt) => known.then_some(belt),
        Err(mut invalid) => {
            // In SI the normal load is told in newtons.
            if let Some(scales) = reader.known_scales() {
                let newtons = scales.to_si(Quantity::Force, load);
                for complaint in &mut invalid {
                    if complaint.key.starts_with("dither") && complaint.key.ends_with(".amplitude")
                    {
                        complaint.allowed = format!(
                            "such that the peaks of normal dither together stay at most \
                             {} = {newtons} N: more would pull the contact apart, which this \
                             model does not describe",
                            NORMAL_LOAD.si.first().map_or(NORMAL_LOAD.path, |twin| twin.key)
                        );
                    }
                }
            }
            reader.adopt(invalid);
            None
        }
    }
}
