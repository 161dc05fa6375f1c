//! The study of a mass on a moving belt: `[belt]`, `[friction]`, `[dither]`, `[solver]`, `[response]`.

mod band;
mod dither;
pub(in crate::study) mod friction;
mod solver;
mod table;

use std::path::Path;
use std::sync::Arc;

use quell_dynamics::response::Solver;
use quell_dynamics::start::InitialState;
use quell_model::parameter::NORMAL_LOAD;
use quell_model::units::{Quantity, Scales};
use quell_model::{Belt, Dither, Friction, LawKind};

use super::StudyOf;
use super::document::Table;
use super::reader::Reader;
use super::study_kind::{Given, StudyKind, not_of_a_belt};

pub use friction::Measured;
use table::BeltTable;

/// A checked study of a belt.
pub type BeltStudy = StudyOf<BeltSetup>;

/// The parts of a study that only a belt has.
#[derive(Clone, Debug, PartialEq)]
pub struct BeltSetup {
    belt: Belt,
    initial: InitialState,
    solver: Solver,
    band: Option<[f64; 2]>,
    /// The samples of a measured law.
    measured: Option<Arc<Measured>>,
}

impl StudyKind for BeltSetup {
    fn reader(document: &Table) -> Reader {
        Reader::new(document)
    }

    fn tables(_: &Table) -> &'static [&'static str] {
        &["schema", "title", "belt", "friction", "dither", "solver", "response", "sweep"]
    }

    fn read(reader: &mut Reader, document: &Table, given: Given<'_, Self>) -> Option<Self> {
        if let Some(node) = document.get("disc") {
            reader.complain(not_of_a_belt(node.origin));
            return None;
        }
        let mut belt = table::read(reader, document);
        let known = given.known.and_then(|setup| setup.measured.as_deref());
        let context =
            friction::LawContext { folder: given.folder, known, normal_load: belt.normal_load };
        let friction = friction::read(reader, document, context);
        let dithers = dither::read(reader, document);
        if let Some(load) = friction.as_ref().and_then(|read| read.own_load) {
            belt.normal_load = Some(load);
            friction::needs_no_normal_force(reader, document, dithers.as_deref());
        }
        let (friction, measured) =
            friction.map_or((None, None), |read| (Some(read.law), read.measured));
        let solver = solver::read(reader, document);
        let band = band::read(reader, document);
        let initial = belt.initial;
        let built = build(reader, belt, friction, dithers);
        Some(Self {
            belt: built?.in_si(reader.known_scales()),
            initial: initial?,
            solver: solver?,
            band: band?,
            measured: measured.map(Arc::new),
        })
    }

    fn data_file(&self) -> Option<&Path> {
        self.measured.as_ref().and_then(|measured| measured.file.as_deref())
    }

    fn file_settings(&self) -> Vec<(String, String)> {
        self.measured.iter().map(|measured| measured.settings()).collect()
    }
}

impl BeltSetup {
    /// The belt in the numbers of the equations.
    pub fn belt(&self) -> &Belt {
        &self.belt
    }
}

impl BeltStudy {
    /// The belt in the numbers of the equations.
    pub fn belt(&self) -> &Belt {
        &self.kind().belt
    }

    /// Initial state of a run.
    pub fn initial(&self) -> InitialState {
        self.kind().initial
    }

    /// Accuracy and length of the computations.
    pub fn solver(&self) -> &Solver {
        &self.kind().solver
    }

    /// The band in which the level of the response is reported, in ω₀.
    pub fn band(&self) -> Option<[f64; 2]> {
        self.kind().band
    }

    /// Mass and stiffness of a study in SI.
    pub fn scales(&self) -> Option<Scales> {
        self.kind().belt.scales()
    }

    /// The samples of a measured law.
    pub fn measured(&self) -> Option<&Measured> {
        self.kind().measured.as_deref()
    }
}

/// Builds the belt. A value already reported as invalid is replaced by a placeholder, so that relations between the other
/// values are checked at the same time.
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
        Err(invalid) => {
            // In SI the normal load is reported in newtons.
            let newtons = reader.known_scales().map(|scales| scales.to_si(Quantity::Force, load));
            reader.adopt(invalid.map(|mut complaint| {
                let amplitude =
                    complaint.key.starts_with("dither") && complaint.key.ends_with(".amplitude");
                if let Some(newtons) = newtons.filter(|_| amplitude) {
                    complaint.allowed = format!(
                        "such that the sum of the normal dither peaks is at most {} = {newtons} N: more would pull the \
                         contact apart, which this model does not describe",
                        NORMAL_LOAD.si.first().map_or(NORMAL_LOAD.path, |twin| twin.key)
                    );
                }
                complaint
            }));
            None
        }
    }
}
