//! The study of a mass on a moving belt: `[belt]`, `[friction]`, `[dither]`, `[solver]`, `[response]`.

mod dither;
mod number;
mod solver;
mod table;
mod template;
pub(in crate::study) mod units;

use std::sync::Arc;

use quell_design::actuator::Actuator;
use quell_dynamics::response::Solver;
use quell_dynamics::start::InitialState;
use quell_input::complaint::Complaints;
use quell_input::document::Table;
use quell_model::parameter::NORMAL_LOAD;
use quell_model::units::{Quantity, Scales, UnitSystem};
use quell_model::{Belt, Dither, Friction, LawKind, System};

use super::StudyOf;
use super::actuator;
use super::band;
use super::design::{self, Design, DesignContext};
use super::disc::DiscSetup;
use super::dither_size::GivenSize;
use super::friction;
use super::path::key_at;
use super::reader::{EquationScale, Reader};
use super::study_kind::{StudyKind, wrong_kind};
use super::vocabulary::DocumentKind;

use super::friction::Measured;
use super::system::{DescribedSystem, SystemSetup, SystemStudy};

use table::BeltTable;
pub(in crate::study) use table::one_state;

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
    /// The design that is asked for.
    design: Option<Design>,
    /// The actuator that gives the dither.
    actuator: Option<Actuator>,
    /// Amplitudes that are given by another size than a peak force.
    sizes: Arc<[GivenSize]>,
}

impl StudyKind for BeltSetup {
    fn reader(document: &Table) -> Reader {
        units::reader(document)
    }

    fn read(reader: &mut Reader, document: &Table) -> Option<Self> {
        if let Some(node) = document.get("disc") {
            reader.complain(wrong_kind(Self::NAME, DiscSetup::NAME, node.origin));
            return None;
        }
        if let Some(node) = document.get("system") {
            reader.complain(wrong_kind(Self::NAME, SystemSetup::NAME, node.origin));
            return None;
        }
        let mut belt = table::read(reader, document);
        let friction = friction::read(reader, document, belt.normal_load);
        let read_dithers = dither::read(reader, document);
        let dithers: Option<Vec<Dither>> = read_dithers
            .as_ref()
            .map(|read| read.iter().map(|(dither, ..)| dither.clone()).collect());
        if let Some(load) = friction.as_ref().and_then(|read| read.own_load) {
            belt.normal_load = Some(load);
            friction::needs_no_normal_force(reader, document, dithers.as_deref());
        }
        let (friction, measured) =
            friction.map_or((None, None), |read| (Some(read.law), read.measured));
        let solver = solver::read(reader, document);
        let band = band::read(reader, document);
        let first = dithers.as_deref().and_then(<[Dither]>::first);
        let context =
            DesignContext { waveform: first.map(|dither| &dither.waveform), document, places: &[] };
        let design = design::read(reader, document, context);
        let actuator = actuator::read(reader, document);
        let known = actuator.as_ref().and_then(Option::as_ref);
        let sized =
            read_dithers.and_then(|read| dither::sized(reader, read, known, belt.damping_ratio));
        let (dithers, sizes) = sized.unzip();
        let initial = belt.initial;
        table::slider_has_one_state(reader, document, friction.as_ref());
        let built = build(reader, belt, friction, dithers);
        Some(Self {
            belt: built?.in_si(reader.known_scales()),
            initial: initial?,
            solver: solver?,
            band: band?,
            measured,
            design: design?,
            actuator: actuator?,
            sizes: sizes?.into(),
        })
    }
}

impl BeltSetup {
    /// Name of the kind.
    pub const NAME: &'static str = "belt";

    /// The belt in the numbers of the equations.
    pub fn belt(&self) -> &Belt {
        &self.belt
    }

    /// The units of answers, and of the system of the belt.
    pub fn units(&self) -> UnitSystem {
        self.belt.scales().map_or(UnitSystem::None, |scales| scales.units())
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

    /// Mass and stiffness of a study with units.
    pub fn scales(&self) -> Option<Scales> {
        self.kind().belt.scales()
    }

    /// The units of answers, and of the system of the belt.
    pub fn units(&self) -> UnitSystem {
        self.kind().units()
    }

    /// What the key at a path gives for one number of the equations, and the path of that number; `None` where the study has no such
    /// number, or the key gives several.
    pub fn per_one(&self, path: &str) -> Option<(String, f64)> {
        let address = key_at(path, DocumentKind::Belt).ok()?;
        let number = number::number_of_the_equations(path, &address);
        self.number(&number)?;
        Some((number, number::per_one(self.belt(), path)?))
    }

    /// The system of the belt, in the units of a study that has units.
    ///
    /// # Errors
    /// A complaint about a law whose numbers are out of their bounds in these units.
    pub fn system(&self) -> Result<System, Complaints> {
        super::template::Template::system(self.kind())
    }

    /// The belt as a system, with the given row and start.
    pub fn as_system(&self, described: DescribedSystem) -> SystemStudy {
        self.map_kind(described.into())
    }

    /// The design that the study asks for.
    pub fn design(&self) -> Option<&Design> {
        self.kind().design.as_ref()
    }

    /// The actuator that gives the dither.
    pub fn actuator(&self) -> Option<&Actuator> {
        self.kind().actuator.as_ref()
    }

    /// The same in the units of [`BeltStudy::system`].
    pub fn actuator_in_units(&self) -> Option<Actuator> {
        actuator::read(&mut self.reader_in_units(), &self.source.document).flatten()
    }

    /// The design in these units.
    pub fn design_in_units(&self) -> Option<Design> {
        let first = self.belt().dithers().first();
        let context = DesignContext {
            waveform: first.map(|dither| &dither.waveform),
            document: &self.source.document,
            places: &[],
        };
        design::read(&mut self.reader_in_units(), &self.source.document, context).flatten()
    }

    fn reader_in_units(&self) -> Reader {
        let source = &self.source;
        Reader::in_units(self.units(), EquationScale::OfTheFile)
            .with(source.files.to_read_again(), source.computed.clone())
    }

    /// The amplitudes that the study gives by another size than a peak force.
    pub fn given_sizes(&self) -> &[GivenSize] {
        &self.kind().sizes
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
    // That a law with a state has none is reported with the key.
    let stiffness = table.tangential_stiffness.filter(|_| law.bristles().is_none());
    let BeltTable { drive, load: loads, courses_are_right, .. } = table;
    let whole = Belt::new(damping, load, velocity, law, dithers);
    let driven = whole.and_then(|belt| match drive {
        Some(drive) => belt.driven(drive.profile(velocity)),
        None => Ok(belt),
    });
    let loaded = driven.and_then(|belt| match loads {
        Some(loads) => belt.loaded(loads.profile(load)),
        None => Ok(belt),
    });
    match loaded.and_then(|belt| belt.with_tangential_stiffness(stiffness)) {
        Ok(belt) => (known && courses_are_right).then_some(belt),
        Err(invalid) => {
            // With units the normal load is reported in newtons.
            let newtons =
                reader.known_scales().map(|scales| scales.to_units(Quantity::Force, load));
            reader.adopt(invalid.map(|mut complaint| {
                let amplitude =
                    complaint.key.starts_with("dither") && complaint.key.ends_with(".amplitude");
                if let Some(newtons) = newtons.filter(|_| amplitude) {
                    complaint.allowed = format!(
                        "such that the sum of the normal dither peaks is at most {} = {newtons} N: more would pull the \
                         contact apart, which this model does not describe",
                        NORMAL_LOAD.key()
                    );
                }
                complaint
            }));
            None
        }
    }
}
