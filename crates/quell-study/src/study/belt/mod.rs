//! The study of a mass on a moving belt: `[belt]`, `[friction]`, `[dither]`, `[solver]`, `[response]`.

mod described;
mod dither;
mod number;
mod solver;
mod table;
mod template;
pub(in crate::study) mod units;

use std::sync::Arc;

use quell_dynamics::response::Solver;
use quell_input::document::Table;
use quell_model::parameter::NORMAL_LOAD;
use quell_model::units::{Quantity, Scales, UnitSystem};
use quell_model::{Belt, Dither, Friction, LawKind};

use super::StudyOf;
use super::actuator;
use super::band;
use super::design::{self, DesignContext};
use super::disc::DiscSetup;
use super::friction;
use super::path::key_at;
use super::reader::{EquationScale, Reader};
use super::study_kind::{StudyKind, wrong_kind};
use super::vocabulary::DocumentKind;

use super::friction::Measured;
use super::passivity;
use super::plausible;
use super::system::SystemSetup;

use described::BeltRun;
use table::BeltTable;
pub(in crate::study) use table::one_state;

/// A checked study of a belt.
pub type BeltStudy = StudyOf<BeltSetup>;

/// The parts of a study that only a belt has.
#[derive(Clone, Debug, PartialEq)]
pub struct BeltSetup {
    belt: Belt,
    solver: Solver,
    /// The samples of a measured law.
    measured: Option<Arc<Measured>>,
    /// The study of its system, in the units of answers.
    system: SystemSetup,
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
        let mut setup = Self::assembled(reader, document)?;
        let SystemSetup { system, warnings, .. } = &mut setup.system;
        let units = setup.belt.scales().map(|scales| scales.units());
        let unlikely = units.map(|units| plausible::warnings(system, units, false));
        warnings.extend(unlikely.into_iter().flatten());
        warnings.extend(passivity::warnings(&system.contacts, units.unwrap_or_default()));
        Some(setup)
    }
}

impl BeltSetup {
    /// Name of the kind.
    pub const NAME: &'static str = "belt";

    /// The belt in the numbers of the equations.
    pub fn belt(&self) -> &Belt {
        &self.belt
    }

    /// The study of its system, in the units of answers.
    pub fn system(&self) -> &SystemSetup {
        &self.system
    }

    /// Reads the study of a belt without its warnings; `None` if something is wrong, which has then been reported.
    pub(super) fn assembled(reader: &mut Reader, document: &Table) -> Option<Self> {
        let mut belt = table::read(reader, document);
        let friction = friction::read(reader, document, belt.normal_load);
        let (dithers, sizes) = dither::read(reader, document).unzip();
        if let Some(load) = friction.as_ref().and_then(|read| read.own_load) {
            belt.normal_load = Some(load);
            friction::needs_no_normal_force(reader, document, dithers.as_deref());
        }
        let (friction, measured) =
            friction.map_or((None, None), |read| (Some(read.law), read.measured));
        let solver = solver::read(reader, document);
        let band = band::read(reader, document);
        let first = dithers.as_deref().and_then(<[Dither]>::first);
        let waveform = first.map(|dither| &dither.waveform);
        let scale = reader.units().scale;
        // What is asked for is in the units of answers.
        if reader.known_scales().is_some() {
            reader.set_scale(EquationScale::OfTheFile);
        }
        let design =
            design::read(reader, document, DesignContext { waveform, document, places: &[] });
        let actuator = actuator::read(reader, document);
        reader.set_scale(scale);
        let initial = belt.initial.take();
        table::spring_has_dither(reader, document, dithers.as_deref());
        table::slider_has_one_state(reader, document, friction.as_ref());
        let belt = build(reader, belt, friction, dithers)?.in_si(reader.known_scales());
        let run = BeltRun {
            initial: initial?,
            solver: solver?,
            band: band?,
            design: design?,
            actuator: actuator?,
            sizes: sizes?,
        };
        let solver = run.solver;
        let (belt, system) = described::system(reader, belt, run)?;
        Some(Self { belt, solver, measured, system })
    }
}

impl BeltStudy {
    /// The belt in the numbers of the equations.
    pub fn belt(&self) -> &Belt {
        &self.kind().belt
    }

    /// Accuracy and length of the computations.
    pub fn solver(&self) -> &Solver {
        &self.kind().solver
    }

    /// Mass and stiffness of a study with units.
    pub fn scales(&self) -> Option<Scales> {
        self.kind().belt.scales()
    }

    /// The units of answers, and of the system of the belt.
    pub fn units(&self) -> UnitSystem {
        self.kind().system.units()
    }

    /// What the key at a path gives for one number of the equations, and the path of that number; `None` where the study has no such
    /// number, or the key gives several.
    pub fn per_one(&self, path: &str) -> Option<(String, f64)> {
        let address = key_at(path, DocumentKind::Belt).ok()?;
        let number = number::number_of_the_equations(path, &address);
        self.number(&number)?;
        Some((number, number::per_one(self.belt(), path)?))
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
    let BeltTable { drive, load: loads, normal_stiffness, others_are_right, .. } = table;
    let whole = Belt::new(damping, load, velocity, law, dithers);
    let driven = whole.and_then(|belt| match drive {
        Some(drive) => belt.driven(drive.profile(velocity)),
        None => Ok(belt),
    });
    let loaded = driven.and_then(|belt| match loads {
        Some(loads) => belt.loaded(loads.profile(load)),
        None => Ok(belt),
    });
    let sprung = loaded.and_then(|belt| belt.with_normal_stiffness(normal_stiffness));
    match sprung.and_then(|belt| belt.with_tangential_stiffness(stiffness)) {
        Ok(belt) => (known && others_are_right).then_some(belt),
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
